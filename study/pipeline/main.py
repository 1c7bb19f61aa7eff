# The command lines of study/run, study/figures and study/compare, and the way into study/view.
import importlib
import os
import re
import shlex
import signal
import sys
from pathlib import Path

from study.pipeline import child, estimate, profile as profiles
from study.pipeline.contenders import Contender, contenders, from_json
from study.pipeline.errors import StudyError
from study.pipeline.front import run_workflow
from study.pipeline.layout import Layout, ROOT, program, read_run
from study.pipeline.options import Parser
from study.pipeline.prepare import (need_modules, only_one, only_one_measuring, registry,
                                    reopen_incomplete, select, set_up, start, writable)
from study.pipeline.progress import duration


STUDIES = {"view": "study.viewer.main", "scenes": "study.scene_study.main",
           "stability": "study.stability_study.main", "accuracy": "study.accuracy_study.main",
           "realtime": "study.realtime_study.main", "extremes": "study.extremes_study.main",
           "advise": "study.advise_study.main", "limit": "study.limit_study.main",
           "against": "study.pipeline.against"}


def main(arguments):
    command, *rest = arguments
    child.end_on_signals()
    try:
        if command == "run" and "--engines" in rest:
            return importlib.import_module("study.engines.main").engines(rest)
        if command in STUDIES:  # imported only now: they need modules that others do without
            return getattr(importlib.import_module(STUDIES[command]), command)(rest)
        return {"run": run, "figures": figures, "compare": compare}[command](rest)
    except StudyError as error:
        print(f"study/{command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as cause:
        print("\ninterrupted; only complete files are kept. To resume:\n  "
              + shlex.join([f"study/{command}", *rest]), file=sys.stderr)
        return 128 + (cause.number if isinstance(cause, child.Signalled) else signal.SIGINT)


def run(arguments):
    parser = Parser(prog="study/run", description="Verifies, measures, draws and reports.")
    parser.add_argument("--profile", default="quick", help=", ".join(profiles.names()) + " (quick)")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--dry-run", action="store_true",
                        help="say what would run and how long; build and install nothing")
    parser.add_argument("--list", action="store_true", help="list profiles and implementations")
    parser.add_argument("--results", metavar="DIR",
                        help="results directory (results/local/PROFILE)")
    parser.add_argument("--engines", nargs="*", metavar="ENGINE",
                        help="something else: other engines beside ours (study/run --engines --help)")
    options = parser.parse_args(arguments)
    if options.list:
        return list_choices()
    if options.profile not in profiles.names():
        profiles.load(options.profile)  # raises
    if options.results == "":
        raise StudyError("--results is empty: it must be a directory")
    name = "-".join([options.profile, *(only.replace("/", ".") for only in options.only)])
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / name)
    if options.dry_run:
        return dry_run(options, layout)
    writable(layout.results)
    with only_one(layout), only_one_measuring():
        if "MBS_PROGRAM" not in os.environ:
            set_up(layout)
        need_modules()
        profile = profiles.load(options.profile)
        start(layout, profile, options.only)
        reopen_incomplete(layout, profile)
        taking_part = from_json(read_run(layout)["contenders"]).values()
        plan = estimate.work(profile, taking_part)
        seconds = sum(work.left() for work in plan.values())
        print(f"{len(taking_part)} contenders; a whole run of profile {profile.name} takes about "
              f"{duration(seconds)}")
        run_workflow(layout, profile.columns, plan)
    print(f"report: {layout.results / 'report.html'}")
    return 0


def figures(arguments):
    parser = Parser(prog="study/figures", description="Draws all from stored results.")
    parser.add_argument("results", nargs="?", default=str(ROOT / "results" / "reference"))
    layout = Layout(Path(parser.parse_args(arguments).results).absolute())
    if not layout.run.exists():
        raise StudyError(f"{layout.results} holds no results (no run.json)")
    need_modules()
    writable(layout.results)
    profile = profiles.read(layout.results / "profile.yaml", read_run(layout)["profile"])
    with only_one(layout):
        run_workflow(layout, profile.columns, {}, stored=True)
    print(f"report: {layout.results / 'report.html'}")
    return 0


def compare(arguments):
    parser = Parser(prog="study/compare", description="Do two runs give the same map? Says in how "
                    "many cells that both decided the winner is the same, and draws both.")
    parser.add_argument("first", help="results directory")
    parser.add_argument("second", help="another one, of the same profile")
    parser.add_argument("--output", nargs="+", default=["comparison.png"], metavar="FILE",
                        help=".png or .svg (comparison.png)")
    options = parser.parse_args(arguments)
    need_modules()
    from analysis.repeat import main as repeat  # it needs the modules
    repeat([options.first, options.second, *options.output])
    print(f"figure: {', '.join(options.output)}")
    return 0


def list_choices():
    need_modules("yaml")
    print("profiles:")
    for name in profiles.names():
        print(f"  {name:28} {profiles.load(name).title}")
    print("implementations:")
    for entry in registry()["implementations"]:
        for variant in entry["variants"] if entry["available"] else []:
            print(f"  {variant['name']:28} {variant['description']}")
        if not entry["available"]:
            print(f"  {entry['folder']:28} unavailable: {entry['reason']}")
    return 0


def dry_run(options, layout):
    need_modules("yaml")
    profile = profiles.load(options.profile)
    if (ROOT / program()).exists():
        known = registry()
        variants = select(known, options.only)
        taking_part = contenders(profile, known, variants, {})
    else:
        taking_part = [Contender(name, name) for name in options.only or folders_of_list()]
        print("build/mbs is not built yet: counting one variant for each implementation folder")
    plan = estimate.work(profile, taking_part)
    print(f"profile {profile.name}: {profile.title}\nresults: {layout.results}")
    print(f"implementations: {', '.join(one.name for one in taking_part if one.ranked)}")
    others = [one for one in taking_part if not one.ranked]
    for one in others:
        print(f"  beside them {one.name}" + (f": unavailable: {one.missing}" if one.missing else
              f" at n = {', '.join(map(str, one.columns))}"))
    for variables, scenes in profile.columns.items():
        fills = [s.label if s.fill is None else f"{100 * s.fill:.0f} %" for s in scenes]
        seconds = plan["verify", variables].left() + plan["measure", variables].left()
        done = layout.measured(variables).exists()
        print(f"  n = {variables:4}  fills {', '.join(fills)}: "
              + ("done" if done else f"about {duration(seconds)}"))
        for stage in ("verify", "measure"):
            plan[stage, variables].done = plan[stage, variables].cells if done else 0
    if layout.refined_stamp.exists():
        plan["refine", 0].done = plan["refine", 0].cells
    print(f"  refinement of the maps: {duration(profile.refine['seconds'])}")
    builds = sorted({one.build for one in others if one.build})
    if builds:
        print(f"  further builds, by set-up: {', '.join(builds)}")
    minutes = sum(work.left() for work in plan.values()) / 60
    print(f"estimated: {minutes:.1f} minutes, besides set-up and build")
    return 0


def folders_of_list():
    text = (ROOT / "implementations" / "CMakeLists.txt").read_text()
    found = re.search(r"mbs_registry\(([^)]*)\)", text)
    return found.group(1).split() if found else []


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
