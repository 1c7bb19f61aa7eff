# The command lines of the study: study/run, study/figures, study/store; and the way into the tools beside the parts.
import importlib
import os
import shlex
import signal
import sys

from analysis.core.files import ROOT, StudyError, read_object
from analysis.core.view import parts
from study.core import child, cluster, locks, profile as profiles
from study.core.front import duration, run_workflow, set_up
from study.core.options import Parser, directory
from study.core.studyset import StudySet, beginning, listed, need_own, need_records, opened, reopen, select, start, unfinished, writable

TOOLS = {"view": "viewer.main", "advise": "advise.main", "against": "against", "merge": "merge.main", "add": "add", "store": "store",
         "new": "new", "paper": "paper.main", "sweep": "sweep"}  # in study/tools


def main(arguments):
    """The exit status: what a command returns, 0 if that is nothing."""
    command, *rest = arguments
    child.end_on_signals()
    try:
        if command in TOOLS:  # imported only now: that takes a second
            return getattr(importlib.import_module(f"study.tools.{TOOLS[command]}"), command)(rest) or 0
        return {"run": run, "figures": figures}[command](rest) or 0
    except StudyError as error:
        print(f"study/{command}: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # of `study/run --list | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 128 + signal.SIGPIPE
    except OSError as error:
        print(f"study/{command}: {error.filename or 'the system'}: {error.strerror}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as cause:
        print("\ninterrupted; what is finished is kept. To resume:\n  " + shlex.join([f"study/{command}", *rest]), file=sys.stderr)
        return 128 + (cause.args[0] if cause.args else signal.SIGINT)


def run(arguments):
    parser = Parser(prog="study/run", description="Runs the study: checks that all agree, measures, draws one site of pages.",
                    epilog="If it was interrupted, the same command goes on where it was. Parts and profiles: study/run --list.")
    parser.add_argument("--profile", default="quick", help=f"how much: {', '.join(profiles.names())} (quick)")
    parser.add_argument("--part", nargs="+", default=[], metavar="NAME", help="only these parts")
    parser.add_argument("--only", nargs="+", default=[], metavar="IMPLEMENTATION", help="only these implementations (folder or folder/variant)")
    parser.add_argument("--results", type=directory, metavar="DIR", help="results directory (results/local/PROFILE, with --only PROFILE-IMPLEMENTATION)")
    parser.add_argument("--dry-run", action="store_true", help="say what would run and for how long; build nothing")
    parser.add_argument("--list", action="store_true", help="list parts, profiles and implementations")
    parser.add_argument("--wait", action="store_true", help="queue behind a study that is running")
    parser.add_argument("--cluster", metavar="PROFILE", help="as jobs of a cluster: slurm, or a folder like study/cluster/slurm")
    options = parser.parse_args(arguments)
    if options.list:
        return list_choices()
    if unknown := [name for name in options.part if name not in parts()]:
        raise StudyError(f"unknown part '{unknown[0]}'; known: {', '.join(parts())}")
    chosen = [part for part in parts() if not options.part or part in options.part]
    profile = profiles.load(options.profile, chosen)
    name = "-".join([profile.name, *(only.replace("/", ".") for only in options.only)])
    folder = options.results or ROOT / "results" / "local" / name
    need_own(folder)
    way = cluster.profile_folder(options.cluster) if options.cluster is not None else None
    if way and options.wait:
        raise StudyError("--wait: found with --cluster, whose jobs wait in its queue: leave it out")
    if options.dry_run:
        return dry_run(profile, chosen, folder, options.only, way)
    writable(folder)
    if way:
        cluster.run(profile, options.only, chosen, folder, way, profiles.columns_of(profile, chosen))
    else:
        _run_here(profile, options.only, chosen, folder, options.wait)
    for part in parts():  # what else ran while they timed
        path = folder / part / "answers.json"
        if said := path.exists() and read_object(path).get("disturbance"):
            print(f"{part}: {said}")
    print(f"site: {folder / 'index.html'}")


def _run_here(profile, only, chosen, folder, wait):
    with locks.only_one(folder), locks.only_one_study(wait):
        set_up(folder / "run.log")
        with beginning(folder):
            studyset = start(folder, profile, only, chosen)
        columns = profiles.columns_of(profile, chosen)
        reopen(studyset, columns)
        print(f"{len(studyset.contenders)} implementations, {len(columns)} parts: at most "
              f"{duration(profiles.planned(unfinished(studyset, columns)))}; the site grows in {folder}/index.html")
        run_workflow(studyset, columns)


def figures(arguments):
    parser = Parser(prog="study/figures", description="Draws every table, figure and page of a set again, from its records.")
    parser.add_argument("set", nargs="?", type=directory, help="its directory (the main one of results/)")
    folder = parser.parse_args(arguments).set or importlib.import_module("study.tools.fragments").main_set()
    studyset = opened(folder)
    writable(folder)
    with locks.only_one(folder):
        need_records(studyset)
        run_workflow(studyset, {part: [] for part in parts() if part in studyset.facts["parts"]}, stored=True)
    print(f"site: {folder / 'index.html'}")


def list_choices():
    print("parts:")
    for part, question in parts().items():
        print(f"  {part:28} {question}")
    print("profiles:")
    for name in profiles.names():
        print(f"  {name:28} {profiles.load(name, []).title}")
    print("implementations:")
    for entry in listed().entries:
        for variant in entry["variants"] if entry["available"] else []:
            if not variant.get("tried_for"):
                print(f"  {variant['name']:28} {variant['description']}")
        if not entry["available"]:
            print(f"  {entry['folder']:28} unavailable: {entry['reason']}")


def dry_run(profile, chosen, folder, only, way):
    if only and (ROOT / "build" / "mbs").exists():
        select(listed(), only)
    print(f"profile {profile.name}: {profile.title}\nresults: {folder}\nleft out: {profile.dropped}")
    columns = profiles.columns_of(profile, chosen)
    left = unfinished(StudySet(folder), columns)
    if way:
        return cluster.dry_run(left)
    for part, names in columns.items():
        print(f"  {part:10} {'at most ' + duration(profiles.planned({part: left[part]})) if left[part] else 'done'}: {', '.join(names)}")
    print(f"at most {duration(profiles.planned(left))}, besides set-up and build")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
