# The command lines of study/run and study/figures.
import argparse
import fcntl
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from study.pipeline import cells, estimate, profile as profiles
from study.pipeline.errors import StudyError
from study.pipeline.front import Display, run_workflow
from study.pipeline.layout import ROOT, Layout, fingerprint, program, read_json, write_json

MODULES = {"yaml": "python3-yaml", "pandas": "python3-pandas", "scipy": "python3-scipy",
           "matplotlib": "python3-matplotlib", "jinja2": "python3-jinja2", "snakemake": "snakemake"}


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise StudyError(f"{message} (see {self.prog} --help)")


def main(arguments):
    command, *rest = arguments
    try:
        return {"run": run, "figures": figures}[command](rest)
    except StudyError as error:
        print(f"study/{command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\ninterrupted; only complete files are kept. To resume:\n  "
              + shlex.join([f"study/{command}", *rest]), file=sys.stderr)
        return 130


def run(arguments):
    parser = Parser(prog="study/run", description="Set-up, verify, measure, collect, figures, report.")
    parser.add_argument("--profile", default="quick", help=", ".join(profiles.names()) + " (quick)")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--dry-run", action="store_true",
                        help="say what would run and how long; build and install nothing")
    parser.add_argument("--list", action="store_true", help="list profiles and implementations")
    parser.add_argument("--results", metavar="DIR", help="results directory (results/local/PROFILE)")
    options = parser.parse_args(arguments)
    if options.list:
        return list_choices()
    if options.profile not in profiles.names():
        profiles.load(options.profile)  # raises
    name = "-".join([options.profile, *(only.replace("/", ".") for only in options.only)])
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / name)
    if options.dry_run:
        return dry_run(options, layout)
    writable(layout.results)
    with only_one(layout):
        if "MBS_PROGRAM" not in os.environ:
            set_up(layout)
        need_modules()
        profile = profiles.load(options.profile)
        start(layout, profile, options.only)
        variants = read_json(layout.run)["variants"]
        run_workflow(layout, profile.columns, estimate.work(profile, len(variants)))
    print(f"report: {layout.results / 'report.html'}")
    return 0


def figures(arguments):
    parser = Parser(prog="study/figures", description="Draws figures and report from stored results.")
    parser.add_argument("results", nargs="?", default=str(ROOT / "results" / "reference"))
    layout = Layout(Path(parser.parse_args(arguments).results).absolute())
    if not layout.run.exists():
        raise StudyError(f"{layout.results} holds no results (no run.json)")
    need_modules()
    writable(layout.results)
    profile = profiles.read(layout.results / "profile.yaml", read_json(layout.run)["profile"])
    with only_one(layout):
        run_workflow(layout, profile.columns, {}, stored=True)
    print(f"report: {layout.results / 'report.html'}")
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
        variants = select(registry(), options.only)
    else:
        variants = options.only or folders_of_list()
        print("build/mbs is not built yet: counting one variant for each implementation folder")
    plan = estimate.work(profile, len(variants))
    print(f"profile {profile.name}: {profile.title}\nresults: {layout.results}")
    print(f"implementations: {', '.join(variants)}")
    for variables, scenes in profile.columns.items():
        fills = [s.label if s.fill is None else f"{100 * s.fill:.0f} %" for s in scenes]
        seconds = plan["verify", variables].left() + plan["measure", variables].left()
        done = layout.measured(variables).exists()
        print(f"  n = {variables:4}  fills {', '.join(fills)}: "
              + ("done" if done else f"about {estimate.duration(seconds)}"))
        for stage in ("verify", "measure"):
            plan[stage, variables].done = plan[stage, variables].cells if done else 0
    minutes = sum(work.left() for work in plan.values()) / 60
    print(f"estimated: {minutes:.1f} minutes, besides set-up and build")
    return 0


def set_up(layout):
    """Runs study/setup; shows its last line while it works and all of its end if it fails."""
    display = Display()
    display.show("set-up")
    with open(layout.log, "a", encoding="utf-8") as log:
        process = subprocess.Popen([str(ROOT / "study" / "setup")], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace")
        lines = []
        for line in process.stdout:
            lines = lines[-20:] + [line.rstrip()]
            log.write(line)
            display.show("set-up", line.strip())
    display.end()
    if process.wait() != 0:
        print("\n".join(lines), file=sys.stderr)
        raise StudyError(f"set-up failed, see above (log: {layout.log})")


def start(layout, profile, only):
    """Records what this results directory is for, or refuses one that is for something else."""
    known = registry()
    run_record = {"profile": profile.name, "only": only, "variants": select(known, only),
                  "context": cells.context(), "program": digest(ROOT / program())}
    text = (profiles.FOLDER / f"{profile.name}.yaml").read_text()
    stored_text = layout.results / "profile.yaml"
    if layout.run.exists():
        stored = read_json(layout.run)
        old, new = fingerprint(stored["context"]), fingerprint(run_record["context"])
        differing = [f"{key} '{old[key]}', now '{new[key]}'" for key in old if old[key] != new[key]]
        differing += [key for key in ("profile", "variants", "program") if stored[key] != run_record[key]]
        differing += [] if stored_text.read_text() == text else ["the profile's settings"]
        if differing:
            raise StudyError(f"{layout.results} holds results of something else ({differing[0]}); "
                             "results are never merged: name another directory with --results, "
                             "or move this one away")
        return
    write_json(layout.registry, known)
    stored_text.write_text(text)
    write_json(layout.run, run_record)


def digest(path):
    """Tells two builds of one commit apart while there are uncommitted changes."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def registry():
    """`mbs list --json`."""
    if not (ROOT / program()).exists():
        raise StudyError(f"{program()} is missing: build it with study/setup")
    result = subprocess.run([program(), "list", "--json"], cwd=ROOT, capture_output=True, text=True)
    try:
        return json.loads(result.stdout)
    except ValueError as error:
        raise StudyError(f"`{program()} list --json` does not work: {result.stderr.strip()}"
                         ) from error


def select(known, only):
    """Names "folder/variant" that `only` selects, in the registry's order; all available if empty."""
    entries = {entry["folder"]: entry for entry in known["implementations"]}
    names = [variant["name"] for entry in entries.values() if entry["available"]
             for variant in entry["variants"]]
    for name in only:
        entry = entries.get(name.split("/")[0])
        if entry and not entry["available"]:
            raise StudyError(f"--only {name}: unavailable: {entry['reason']}")
        if name not in entries and name not in names:
            raise StudyError(f"--only: unknown implementation '{name}'; known: "
                             f"{', '.join([*entries, *names])}")
    return [name for name in names if not only or name in only or name.split("/")[0] in only]


def folders_of_list():
    text = (ROOT / "implementations" / "CMakeLists.txt").read_text()
    found = re.search(r"mbs_registry\(([^)]*)\)", text)
    return found.group(1).split() if found else []


def need_modules(*modules):
    import importlib.util
    for module in modules or MODULES:
        if importlib.util.find_spec(module) is None:
            raise StudyError(f"Python module {module} is missing for /usr/bin/python3: run "
                             f"study/setup, or apt-get install {MODULES[module]}")


def writable(results):
    try:
        results.mkdir(parents=True, exist_ok=True)
        probe = results / ".writable"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise StudyError(f"cannot write to {results}: {error.strerror}") from error
    if shutil.disk_usage(results).free < 100 * 2**20:
        raise StudyError(f"less than 100 MB free for {results}")


def only_one(layout):
    """Holds the results directory; the lock vanishes with its process."""
    file = open(layout.results / ".lock", "w", encoding="utf-8")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise StudyError(f"another study is running in {layout.results}") from error
    return file


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
