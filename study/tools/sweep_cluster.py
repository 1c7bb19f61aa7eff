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
    is kept beside the table until it is there."""
    if not (cluster / "array").is_file():
        raise StudyError(f"--cluster: {cluster} has no script array: study/cluster/README.md says what it does")
    folder = Path(f"{table}.parts").absolute()
    home(folder).mkdir(parents=True, exist_ok=True)
    parts, program = [folder / f"part-{number}" for number in range(1, count + 1)], str(ROOT / program_of())
    with locks.only_one(folder):
        end_jobs(folder, cluster)
        command = shlex.join([program, "sweep", *words, "--resume"])
        write_text(folder / "part.sh", "# Runs one part; a lane that fails is a row, and no failure of the part.\n"
                   f"cd {shlex.quote(os.getcwd())}\n"
                   f'{command} --shard "$1/{count}" --output {shlex.quote(str(folder))}/part-"$1" || [ $? = 1 ]\n')
        try:
            _array(folder, cluster, parts)
        finally:
            end_jobs(folder, cluster)
        for number, part in enumerate(parts, 1):
            if not part.exists():
                log = folder / f"log-{number}"
                said = _last(log.read_text(errors="replace") if log.exists() else "", "it has said nothing")
                raise StudyError(f"part {number} of {count} is not done: {said}; the same command goes on where it was")
        done = subprocess.run([program, "merge-sweep", *map(str, parts), "--output", str(table)], capture_output=True, text=True)
        if done.returncode >= USAGE or done.returncode < 0:
            raise StudyError(_last(done.stderr, "mbs merge-sweep does not work"))
        for path in [*parts, *folder.glob("log-*")]:
            path.unlink(missing_ok=True)


def _array(folder, cluster, parts):
    given = subprocess.run([str(cluster / "array"), str(len(parts)), str(folder / "part.sh")], cwd=folder, capture_output=True, text=True)
    if given.returncode:
        raise StudyError(f"{cluster / 'array'}: {_last(given.stderr, 'failed')}")
    display = Display()
    while runs(folder, cluster, given.stdout.strip()):
        display.show("sweep", f"{sum(part.exists() for part in parts)} of {len(parts)} parts")
        time.sleep(1)
    display.end()


def _last(text, otherwise):
    """The last line of what a program said."""
    return (text.strip().splitlines() or [otherwise])[-1][:300]
