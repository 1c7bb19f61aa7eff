# study/sweep --cluster: the parts of a sweep as an array job of a cluster, then the table that one process would have written.
import os
import shlex
import subprocess
import time
from pathlib import Path

from analysis.core.errors import StudyError
from analysis.core.files import ROOT, write_text
from study.core import locks
from study.core.cluster import end_jobs, runs
from study.core.executor import USAGE, program_of
from study.core.front import Display
from study.core.node import home


def run(words, table, count, cluster):
    """`words`: what `mbs sweep` gets besides its output; `count`: parts; `cluster`: the profile's folder. What is done of parts
    is kept beside the table until it is there. A table that these words made stays as it is."""
    if not (cluster / "array").is_file():
        raise StudyError(f"--cluster: {cluster} has no script array: study/cluster/README.md says what it does")
    folder = Path(f"{table}.parts").absolute()
    script = _script(words, count, folder)
    if Path(table).exists() and _text(folder / "part.sh") != script:
        raise StudyError(f"{table}: found a file that this command did not make, allowed is another name; without --cluster it is drawn")
    home(folder).mkdir(parents=True, exist_ok=True)
    parts = [folder / f"part-{number}" for number in range(1, count + 1)]
    with locks.only_one(folder):
        end_jobs(folder, cluster)
        if not Path(table).exists():
            write_text(folder / "part.sh", script)
            _make(table, folder, cluster, parts)
        for path in [*parts, *folder.glob("done-*"), *folder.glob("log-*")]:
            path.unlink(missing_ok=True)


def _script(words, count, folder):
    """Runs one part; a lane that fails is a row, and no failure of the part. A part that is there may be another sweep's: only
    what `mbs` has taken as its own is done."""
    command, beside = shlex.join([str(ROOT / program_of()), "sweep", *words, "--resume"]), shlex.quote(str(folder))
    return (f"cd {shlex.quote(os.getcwd())}\n"
            f'{command} --shard "$1/{count}" --output {beside}/part-"$1" || [ $? = 1 ] || exit 2\n'
            f'touch {beside}/done-"$1"\n')


def _make(table, folder, cluster, parts):
    done = [folder / f"done-{number}" for number in range(1, len(parts) + 1)]
    for mark in done:
        mark.unlink(missing_ok=True)
    try:
        given = subprocess.run([str(cluster / "array"), str(len(done)), str(folder / "part.sh")], cwd=folder, capture_output=True, text=True)
        if given.returncode:
            raise StudyError(f"{cluster / 'array'}: {_last(given.stderr, 'failed')}")
        display = Display()
        while runs(folder, cluster, given.stdout.strip()):
            display.show("sweep", f"{sum(mark.exists() for mark in done)} of {len(done)} parts")
            time.sleep(1)
        display.end()
    finally:
        end_jobs(folder, cluster)
    for number, mark in enumerate(done, 1):
        if not mark.exists():
            raise StudyError(f"part {number} of {len(parts)} is not done: {_last(_text(folder / f'log-{number}'), 'it has said nothing')}; "
                             "the same command goes on where it was")
    merged = subprocess.run([str(ROOT / program_of()), "merge-sweep", *map(str, parts), "--output", str(table)], capture_output=True, text=True)
    if merged.returncode >= USAGE or merged.returncode < 0:
        raise StudyError(_last(merged.stderr, "mbs merge-sweep does not work"))


def _text(path):
    return path.read_text(errors="replace") if path.exists() else ""


def _last(text, otherwise):
    """The last line of what a program said."""
    return (text.strip().splitlines() or [otherwise])[-1][:300]
