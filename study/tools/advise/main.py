# study/advise: the command line; one question, its results directory, its answer.
import json
import math
import sys
import time
from functools import partial

from analysis.core.files import ROOT, StudyError, digest, write_json
from study.core import locks
from study.core.cell import scene_name
from study.core.executor import program_of
from study.core.options import Parser, directory, positive
from study.core.studyset import describe, listed, need_own, select, writable
from study.tools.advise.advice import Question, advise as seek
from study.tools.advise.answer import as_json, text
from study.tools.advise.choice import LEAST_STEPS, MOST_STEPS
from study.tools.advise.evidence import BEGUN, QUESTIONS
from study.tools.advise.probe import catalogue
from study.tools.advise.runner import REPEATS, Runner, folder_of
from study.tools.advise.validate import questions, validate
from study.tools.shelf import open_shelf

DURATION, BUDGET, LONGEST = 20.0, 45.0, 1e6  # s
OF_A_QUESTION = ("--error", "--deadline-us", "--step", "--duration", "--budget", "--json")
DEFAULT = ROOT / "results" / "local" / "advice"


def advise(arguments):
    parser = Parser(prog="study/advise", description="Which implementation, step and settings simulate SCENE with positions as accurate as E, "
                    "in the least time? Runs pilots of that very scene; takes about a minute. Exit status 1: no setting is good enough.")
    parser.add_argument("scene", nargs="*", metavar="SCENE", help="four-bar:N, one of mbs list --scenes, or a JSON file; "
                        "with --validate: kinds of mechanisms from its list, or any scenes")
    parser.add_argument("--error", type=positive, metavar="E", help="largest position error of any point over the whole time, m")
    parser.add_argument("--deadline-us", type=positive, metavar="D", help="99 %% of the steps must be done within D microseconds")
    parser.add_argument("--step", type=seconds, metavar="S", help="only steps of S seconds, also as a fraction (1/60): for a loop with a fixed "
                        "frame. If a frame takes k steps, give a k-th of it (1/240 for four of them), and a k-th of its time as --deadline-us")
    parser.add_argument("--duration", type=positive, metavar="T", help=f"simulated time ({DURATION:g} s, or up to where the drivers end)")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="only these implementations (folder or folder/variant)")
    parser.add_argument("--budget", type=positive, metavar="S", help=f"seconds for all pilots and timings ({BUDGET:g}). The answer says what did "
                        "not fit")
    parser.add_argument("--json", action="store_true", help="print everything as JSON (study/tools/advise/README.md)")
    parser.add_argument("--results", type=directory, metavar="DIR", help="where raw files are kept (results/local/advice/, one folder a "
                        "question); with --validate its tables and page, too")
    parser.add_argument("--wait", action="store_true", help="queue behind a study that is running")
    parser.add_argument("--validate", action="store_true", help="hold the advice against an exhaustive search on families of mechanisms and "
                        "standard problems, or those named; some minutes a mechanism")
    options = parser.parse_args(arguments)
    if options.validate:
        return _validate(options)
    if options.results:
        need_own(options.results)
    if len(options.scene) != 1 or options.error is None:
        raise StudyError("one SCENE and --error E are needed (see study/advise --help)")
    answer = ask(options)
    print(json.dumps(answer, indent=1, allow_nan=False) if options.json else text(answer))
    return 0 if answer["met"] else 1


def _validate(options):
    if given := [name for name in OF_A_QUESTION if getattr(options, name.strip("-").replace("-", "_"))]:
        raise StudyError(f"--validate asks questions of its own: {', '.join(given)} do{'es' * (len(given) == 1)} not go with it, only --only and "
                         "--results do")
    questions(options.scene)  # before anything is written
    results = options.results or DEFAULT / "validation"
    need_own(results, BEGUN, {".lock", QUESTIONS})  # of a clone, it has no lock
    writable(results)
    return validate(options, ask, runner_of, results)


def ask(options, folder=None):
    """The answer to one question; its records and advice.json are kept."""
    began = time.monotonic()
    known = listed()
    names = select(known, options.only)
    scene = scene_name(options.scene[0])
    described = describe(scene)
    question = Question(options.scene[0], options.error, duration(options.scene[0], options.duration, described),
                        options.deadline_us, options.budget or BUDGET, options.step)
    _need_possible(question)
    inputs = question._asdict() | {"scene": scene, "file": digest(ROOT / scene) if (ROOT / scene).is_file() else "", "repeats": REPEATS}
    folder = folder or options.results or DEFAULT / folder_of(scene, inputs, names, digest(ROOT / program_of()))
    writable(folder)
    spent = time.monotonic() - began
    say = partial(print, file=sys.stderr, flush=True)  # standard output may be JSON
    with locks.only_one(folder), locks.only_one_study(options.wait, say):
        clock = {"budget": question.budget, "began": time.monotonic() - spent}  # without the time of waiting
        run = runner_of(folder, inputs, described, names, known, question.deadline_us, options.json, **clock)
        advice = seek(question, catalogue(), described, {name: known.variants[name] for name in names}, run, bool(options.only))
        run.lab.display.end()
        answer = as_json(advice, run, folder)
        write_json(folder / "advice.json", answer)
    return answer


def runner_of(folder, inputs, described, names, known, deadline_us=None, quiet=False, **clock):
    """The Runner of a scene and its records in `folder`; `clock`: `budget` and `began`."""
    lab, contenders = open_shelf(folder, "advise", known, names, names, quiet, question=inputs)
    return Runner(lab, inputs["scene"], described["variables"], contenders, deadline_us, end=described["drivers_end"], **clock)


def seconds(text):
    """A number or a fraction of numbers; ValueError, which argparse tells, for others."""
    over, _, under = text.partition("/")
    value = float(over) / (float(under) if under and positive(under) else 1.0)
    return positive(f"{value:g}") and float(f"{value:.12g}")  # as it is passed on


def _need_possible(question):
    """StudyError if a step is given in which there is nothing to advise on."""
    least, most = question.duration / MOST_STEPS, question.duration / LEAST_STEPS
    if question.step and not least <= question.step <= most:
        raise StudyError(f"--step {question.step:g}: a run of {question.duration:g} s has {LEAST_STEPS} to {MOST_STEPS:g} steps, so from {least:g} "
                         f"to {most:g} s each")
    if question.step and question.deadline_us and question.deadline_us > 1.000001e6 * question.step:
        raise StudyError(f"--deadline-us {question.deadline_us:g}: more than the step itself, {1e6 * question.step:g} us, is not in real time")


def duration(scene, asked, described):
    """The simulated time: what is asked for, or the usual one, if the scene lasts that long."""
    if described["free_points"] == 0:
        raise StudyError(f"{scene} has no free points: there is no position error to advise on")
    end = described["drivers_end"] or math.inf
    if asked and asked > end:
        raise StudyError(f"--duration {asked:g}: the drivers of {scene} end at {end:g} s")
    if asked and asked > LONGEST:
        raise StudyError(f"--duration {asked:g}: at most {LONGEST:g} s")
    return asked or min(DURATION, end)
