# study/run --cluster: the columns of a set as jobs of a cluster. This machine measures nothing: it hands jobs over, watches
# them and draws. What a node does is node.py's; how a cluster is spoken to is a profile's: study/cluster/README.md.
import signal
import subprocess
import time
from pathlib import Path

from analysis.core.files import ROOT, StudyError, write_json
from study.core import locks, studyset as sets
from study.core.front import duration, follow, snakemake
from study.core.node import forget, home, own_sets, refusals

PROFILES = ROOT / "study" / "cluster"
GRACE = 15  # minutes over a budget: the last cell's limit, at most 600 s, and what a node does first
ENDING = 120  # s that jobs may take to end


def profile_folder(name):
    """Of a name in study/cluster, or a path; StudyError if it is no profile."""
    folder = PROFILES / name if (PROFILES / name).is_dir() else Path(name).absolute()
    if missing := [one for one in ("config.yaml", "submit", "status", "cancel") if not (folder / one).is_file()]:
        known = ", ".join(sorted(path.parent.name for path in PROFILES.glob("*/config.yaml")))
        raise StudyError(f"--cluster: {folder} is no profile ({missing[0]} is missing); known: {known}")
    return folder


def dry_run(columns):
    jobs = [(part, column, seconds + 60 * GRACE) for part, names in columns.items() for column, seconds in names.items()]
    for part, column, seconds in jobs:
        print(f"  {part:10} {column:24} at most {duration(seconds)} of a node")
    print(f"{len(jobs)} jobs, at most {sum(seconds for _, _, seconds in jobs) / 3600:.2f} node-hours")


def run(profile, only, chosen, folder, cluster, columns):
    """Runs a set to its end, then those that nodes of another kind began beside it; not those of a failed control, which are no evidence and
    wait for one node. `cluster`: the profile's folder."""
    with locks.only_one(folder):
        end_jobs(folder, cluster)
        _plan(profile, only, chosen, folder, columns)
        if not (folder / "set.json").exists():
            _workflow(sets.StudySet(folder), cluster, columns, "set.json")
        known = sets.opened(folder)  # of a question that is still the same; that the nodes are its own they see themselves
        write_json(folder / "set.json", known.facts | sets.kept_facts(known, profile, only, chosen))
        studyset = sets.StudySet(folder)
        studyset.clear()
        sets.reopen(studyset, columns)
        _workflow(studyset, cluster, columns, "all")
    for host, reason in refusals(folder).items():
        print(f"{host} is not of this set: {reason}")
    for own in own_sets(folder):
        if (home(own) / "only").exists():
            print(f"{own} is of one node whose A/A control failed, and no evidence: it is not run further (all the same: --results {own})")
            continue
        print(f"a set of its own: {own}")
        run(profile, only, chosen, own, cluster, columns)


def _plan(profile, only, chosen, folder, columns):
    (home(folder) / "refused").mkdir(parents=True, exist_ok=True)
    forget(folder)
    write_json(home(folder) / "plan.json", {"profile": profile.name, "only": only, "parts": chosen, "columns": columns, "grace": GRACE})


def _workflow(studyset, cluster, columns, target):
    command = snakemake(studyset, PROFILES / "Snakefile", target, "--profile", str(cluster))
    stamps = [studyset.stamp(part, column) for part, names in columns.items() for column in names]

    def show(display):
        display.show("cluster", f"{sum(stamp.exists() for stamp in stamps)} of {len(stamps)} columns")
        time.sleep(1)  # they are asked for over a network
    try:
        follow(studyset, command, show, (signal.SIGINT, signal.SIGTERM, signal.SIGKILL))
    except StudyError as error:
        told = "; ".join(f"{host} is not of this set: {reason}" for host, reason in refusals(studyset.folder).items())
        raise StudyError(f"{error}; {told}" if told else str(error)) from error
    finally:
        end_jobs(studyset.folder, cluster)


def end_jobs(folder, cluster):
    """Cancels the jobs that this run, or one that was killed, has left in the queue, and waits until they are gone."""
    path, end = home(folder) / "jobs", time.monotonic() + ENDING
    if ids := [one for one in path.read_text().split() if state(folder, cluster, one) == "running"] if path.exists() else []:
        subprocess.run([str(cluster / "cancel"), *ids], cwd=folder, check=False)
    while any(state(folder, cluster, one) == "running" for one in ids):
        if time.monotonic() > end:
            raise StudyError(f"jobs {' '.join(ids)} do not end: the cluster does not answer, or keeps them; try again later")
        time.sleep(1)
    path.unlink(missing_ok=True)


def state(folder, cluster, job):
    return subprocess.run([str(cluster / "status"), job], cwd=folder, capture_output=True, text=True, check=False).stdout.strip()
