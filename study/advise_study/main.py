# study/advise: the command line; one question, its results directory, its answer.
import hashlib
import json
import math
import re
from pathlib import Path

from study.pipeline.contenders import from_json
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, read_run, write_json
from study.pipeline.options import Parser, positive
from study.pipeline.prepare import (digest_of_scene, need_modules, only_one, only_one_measuring,
                                    registry, select, start_named, writable)
from study.pipeline.progress import Teller

DURATION, BUDGET, LONGEST = 20.0, 45.0, 1e6  # s
OF_A_QUESTION = ("SCENE", "--error", "--deadline-us", "--step", "--duration", "--budget", "--json", "--plot")
DEFAULT = ROOT / "results" / "local" / "advice"


def advise(arguments):
    options = _parser().parse_args(arguments)
    need_modules("yaml", "pandas", "matplotlib", "jinja2")
    if options.plot and Path(options.plot).suffix not in (".svg", ".png"):
        raise StudyError(f"--plot {options.plot}: the name must end in .svg or .png")
    if options.plot and not Path(options.plot).absolute().parent.is_dir():
        raise StudyError(f"--plot {options.plot}: there is no such directory")
    if options.validate:
        _nothing_beside_validate(options)
        from study.advise_study.validate import validate
        return validate(options)
    if not options.scene or options.error is None:
        raise StudyError("a SCENE and --error E are needed (see study/advise --help)")
    Teller.quiet = options.json
    answer, advice = ask(options)
    from study.advise_study.answer import text
    print(json.dumps(answer, indent=1) if options.json else text(answer))
    if options.plot:
        from analysis.advice.figure import draw, write
        write(draw(answer), options.plot)
    return 0 if answer["met"] else 1


def _nothing_beside_validate(options):
    given = [name for name in OF_A_QUESTION if getattr(options, name.strip("-").replace("-", "_").lower())]
    if given:
        raise StudyError(f"--validate asks questions of its own: {', '.join(given)} "
                         f"do{'es' * (len(given) == 1)} not go with it, only --only and --results do")


def ask(options, folder=None):
    """(answer, Advice) of one question; its raw files and advice.json are kept."""
    from study.advise_study.advice import Question, advise as seek  # these need the modules
    from study.advise_study.answer import as_json
    from study.advise_study.runner import REPEATS, describe, scene_name
    from study.advise_study.settings import catalogue
    known = registry()
    names = select(known, options.only)
    scene = scene_name(options.scene)
    described = describe(scene)
    question = Question(options.scene, options.error, duration(options.scene, options.duration, described),
                        options.deadline_us, options.budget or BUDGET, options.step)
    _need_possible(question)
    inputs = {"scene": scene, "file": digest_of_scene(scene), "error": question.error,
              "duration": question.duration, "deadline_us": question.deadline_us,
              "budget": question.budget, "step": question.step, "repeats": REPEATS}
    layout = Layout(Path(folder or options.results or DEFAULT / _folder(inputs, names)).absolute())
    writable(layout.results)
    with only_one(layout), only_one_measuring():
        start_named(layout, "advise", names, inputs)
        variants, runner = runner_of(layout, scene, known, question.deadline_us)
        tell = Teller()
        advice = seek(question, catalogue(), described, variants, runner, tell)
        tell.end()
        answer = as_json(advice, runner, described, variants, layout)
        write_json(layout.results / "advice.json", answer)
    return answer, advice


def runner_of(layout, scene, known, deadline_us=None):
    """({name: what `mbs list --json` says of a variant that takes part, and its library}, Runner)"""
    from study.advise_study.runner import Runner  # it needs the modules
    run = read_run(layout)
    contenders = from_json(run["contenders"])
    variants = {variant["name"]: variant | {"library": entry.get("library")} for entry in known["implementations"]
                for variant in entry.get("variants", [])
                if variant["name"] in contenders and not contenders[variant["name"]].missing}
    return variants, Runner(layout, scene, contenders, run["contexts"], deadline_us)


def _parser():
    parser = Parser(prog="study/advise", description="Which implementation, step and settings "
                    "simulate SCENE with positions as accurate as E, in the least time? Runs pilots of "
                    "that very scene, under a minute for four-bar:40; exit status 1 if no setting is "
                    "good enough.")
    parser.add_argument("scene", nargs="?", metavar="SCENE", help="four-bar:N or a JSON file")
    parser.add_argument("--error", type=positive, metavar="E",
                        help="largest position error of any point over the whole time, m")
    parser.add_argument("--deadline-us", type=positive, metavar="D",
                        help="99 %% of the steps must be done within D microseconds")
    parser.add_argument("--step", type=seconds, metavar="S",
                        help="only steps of S seconds, also as a fraction (1/60): for a loop with a fixed frame. A "
                        "frame of 1/60 s is one step of 1/60 s, or k steps of 1/(60 k) s, each of which then has a "
                        "k-th of the frame's time as its deadline")
    parser.add_argument("--duration", type=positive, metavar="T",
                        help=f"simulated time ({DURATION:g} s, or up to where the drivers end)")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--budget", type=positive, metavar="S",
                        help=f"for pilots and timings ({BUDGET:g} s); what is left out then is said")
    parser.add_argument("--json", action="store_true", help="print everything as JSON (study/advise_study/README.md)")
    parser.add_argument("--plot", metavar="FILE", help="draw the pilots and the choice (.svg or .png)")
    parser.add_argument("--results", metavar="DIR",
                        help="where raw files are kept (results/local/advice/, one folder a question)")
    parser.add_argument("--validate", action="store_true", help="hold the advice against an exhaustive "
                        "search on scenes with exact solutions; about 20 minutes")
    return parser


def seconds(text):
    """A number or a fraction of numbers; ValueError, which argparse tells, for others."""
    over, _, under = text.partition("/")
    if not under:
        return positive(text)
    return positive(str(positive(over) / positive(under)))


def _need_possible(question):
    """StudyError if a step is given in which there is nothing to advise on."""
    from study.advise_study.choice import LEAST_STEPS, MOST_STEPS
    least, most = question.duration / MOST_STEPS, question.duration / LEAST_STEPS
    if question.step and not least <= question.step <= most:
        raise StudyError(f"--step {question.step:g}: a run of {question.duration:g} s has {LEAST_STEPS} to "
                         f"{MOST_STEPS:g} steps, so from {least:g} to {most:g} s each")
    if question.step and question.deadline_us and question.deadline_us > 1.000001e6 * question.step:
        raise StudyError(f"--deadline-us {question.deadline_us:g}: more than the step itself, "
                         f"{1e6 * question.step:g} us, is not in real time")


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


def _folder(inputs, names):
    """One a question, so that an edited scene file asks another one."""
    from study.pipeline.layout import program
    from study.pipeline.prepare import digest
    text = json.dumps([inputs, names, digest(ROOT / program())])
    stem = re.sub(r"[^A-Za-z0-9]+", "-", Path(inputs["scene"]).stem).strip("-")
    return f"{stem}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"
