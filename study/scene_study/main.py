# study/scenes: runs the standard problems and the cost of modelling, writes tables and a report.
import argparse
import os

from study.pipeline.carrier import layout_of
from study.pipeline.contenders import from_json
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import Parser, add_only, add_results
from study.pipeline.prepare import (digest, digest_of_scene, need_modules, only_one,
                                    only_one_measuring, set_up, start_named, writable)
from study.pipeline.progress import Teller


class _Parser(Parser):
    """Its help ends with the names of the problems, read only when it is asked for."""

    def format_help(self):
        try:
            from study.scene_study import problems
        except ImportError:
            self.epilog = "Names of the problems: study/problems.yaml."
        else:
            self.formatter_class = argparse.RawDescriptionHelpFormatter
            self.epilog = "problems, by any of their names:\n" + "\n".join(
                "  " + " | ".join(problem.names) for problem in problems.read_list()[1])
        return super().format_help()


def scenes(arguments):
    parser = _Parser(prog="study/scenes", description="Standard problems: gate, accuracy, conserved "
                     "energy. Modelling: what each piece costs.\n"
                     "Writes tables and scenes.html; about ten minutes.")
    add_only(parser)
    parser.add_argument("--problems", nargs="+", metavar="NAME",
                        help="only these standard problems, by name, title or scene file as listed "
                        "below; none: no problem")
    parser.add_argument("--rounds", type=int, default=7,
                        help="rounds of the modelling measurement, 0 for none (7)")
    add_results(parser, "scenes")
    options = parser.parse_args(arguments)
    if options.rounds < 0:
        raise StudyError(f"--rounds is {options.rounds}: it must be at least 0")
    layout = layout_of(options, "scenes", "run.json")
    writable(layout.results)
    with only_one(layout), only_one_measuring():
        if "MBS_PROGRAM" not in os.environ and not options.stored:
            set_up(layout)
        need_modules("yaml", "pandas", "matplotlib", "jinja2", "scipy")
        _run(layout, options)
    return 0


def _run(layout, options):
    from study.scene_study import modelling, problems  # they need the modules
    preferred, listed = problems.read_list()
    chosen = _choose(listed, options.problems)
    if not options.stored:
        start_named(layout, "scenes", options.only, {problems.LIST.name: digest(problems.LIST)} | {
            problem.scene: digest_of_scene(problem.scene) for problem in listed})
    run = read_run(layout)
    contenders = [one for one in from_json(run["contenders"]).values()
                  if one.ranked and not one.missing]
    compared = problems.compared_of(preferred, [one.name for one in contenders])
    raw, tell = layout.results / "raw", Teller()
    if options.stored:
        tell.quiet = True
    found = {problem: problems.run_problem(
        problem, raw, contenders, compared, run["contexts"],
        lambda text, share=place / len(chosen): tell(text, share), options.stored)
        for place, problem in enumerate(chosen)}
    rounds = (len(list((raw / "modelling").glob("round*"))) if options.stored else options.rounds)
    pieces = modelling.measure(raw, contenders, run["contexts"], rounds, tell, options.stored)
    tell.end()
    tables = problems.tables(found, compared, lambda folder, name, step:
                             f"raw/{folder}/{name.replace('/', '.')}-{step:g}.json")
    tables["modelling"] = modelling.rows(pieces, lambda name, loops, case, number: (
        f"raw/modelling/round{number}/{name.replace('/', '.')}-{loops}-"
        f"{modelling.label(case)}.json"))
    for name, table in tables.items():
        write_csv(layout.results / f"{name}.csv", table)
    from analysis.scenes.report import write
    write(layout.results, compared)
    print(f"report: {layout.results / 'scenes.html'}")


def _choose(listed, names):
    if names is None:
        return listed
    known = {name.lower(): problem for problem in listed for name in problem.names}
    unknown = [name for name in names if name.lower() not in known and name.lower() != "none"]
    if unknown:
        raise StudyError(f"--problems: unknown problem '{unknown[0]}'; known: "
                         f"{', '.join(problem.name for problem in listed)}")
    return list(dict.fromkeys(known[name.lower()] for name in names if name.lower() in known))
