# Runs Snakemake, or what draws pages, in the background and shows the part, the cells done of all and the time left.
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time

from analysis.core.files import ROOT, StudyError, read_json, write_json
from study.core import child
from study.core.job import FRONT
from study.core.profile import planned


class Display:
    """One line that is rewritten on a terminal; a line now and then elsewhere."""
    EVERY = 20.0  # s

    def __init__(self):
        self.terminal, self.shown, self.stage, self.when = sys.stdout.isatty(), "", None, 0.0

    def show(self, stage, text=""):
        line, now = f"{stage}: {text}" if text else stage, time.monotonic()
        if self.terminal:
            print(f"\r\033[K{line[:110]}", end="", flush=True)
        elif stage != self.stage or (line != self.shown and now - self.when > self.EVERY):
            print(line, flush=True)
        else:
            return
        self.stage, self.shown, self.when = stage, line, now

    def end(self):
        if self.terminal and self.shown:
            print(flush=True)
        self.shown = ""


def set_up(log):
    """Runs study/setup, unless MBS_PROGRAM stands in for what it builds."""
    if "MBS_PROGRAM" not in os.environ:
        build([str(ROOT / "study" / "setup")], "set-up", log)


def build(command, stage, log):
    """Runs a command that builds; shows its last line while it works, and its end if it fails, which is a StudyError."""
    log.parent.mkdir(parents=True, exist_ok=True)
    display, lines = Display(), []
    display.show(stage)
    with open(log, "a", encoding="utf-8") as file, child.with_all(command) as process:
        for line in process.stdout:
            lines = lines[-20:] + [line.rstrip()]
            file.write(line)
            display.show(stage, line.strip())
        code = process.wait()
    display.end()
    if code != 0:
        print("\n".join(lines), file=sys.stderr)
        raise StudyError(f"{stage} failed, see above (log: {log})")


def run_workflow(studyset, columns, stored=False):
    """Runs the workflow to its end; of what is `stored` the pages alone, without it. `columns`: {part: {column: seconds}}. Raises
    StudyError, or KeyboardInterrupt once all children are gone."""
    write_json(studyset.folder / ".parts.json", list(columns))
    studyset.progress.unlink(missing_ok=True)
    now, since = None, 0.0  # the part and its column at work, and when they began

    def show(display):
        nonlocal now, since
        if studyset.progress.exists():
            known = read_json(studyset.progress)
            part, column, text = known["part"], known["column"], known["text"]
            if (part, column) != now:
                now, since = (part, column), time.monotonic()
            ahead = planned({one: {name: seconds for name, seconds in names.items() if not studyset.stamp(one, name).exists()}
                             for one, names in columns.items()})
            display.show(f"[{list(columns).index(part) + 1}/{len(columns)}] {part}", f"{column}: {known['cells']}, at most "
                         f"{duration(ahead - (time.monotonic() - since))} left" + (f"; {text}" if text else ""))
        elif not any(columns.values()):
            display.show("pages")
    pages = ["/usr/bin/python3", "-m", "study.core.job", ".", "pages"]
    follow(studyset, pages if stored else snakemake(studyset, ROOT / "study" / "Snakefile", "--cores", "all", "--scheduler", "greedy"), show)


def snakemake(studyset, snakefile, *words):
    return ["/usr/bin/python3", "-m", "snakemake", *words, "--snakefile", str(snakefile), "--directory", str(studyset.folder),
            "--rerun-triggers", "mtime", "--rerun-incomplete", "--nolock", "--nocolor"]


def follow(studyset, command, show, ends=(signal.SIGTERM, signal.SIGKILL)):
    """Runs a command to its end; meanwhile `show` is called with a Display. `ends`: signals that stop it and all that it started here, each
    after the one before."""
    display = Display()
    with open(studyset.log, "a", encoding="utf-8") as log:
        begin = log.tell()
        process = subprocess.Popen(child.tied('exec "$@"', *command), stdout=log, stderr=subprocess.STDOUT, cwd=studyset.folder,
                                   start_new_session=True, env=os.environ | {FRONT: str(os.getpid())})
        try:
            while process.poll() is None:
                show(display)
                time.sleep(0.15)
        finally:
            for sign in ends:
                if process.poll() is None:
                    os.killpg(process.pid, sign)
                    with contextlib.suppress(subprocess.TimeoutExpired):
                        process.wait(timeout=10)
            display.end()
    if process.returncode != 0 and shutil.disk_usage(studyset.folder).free < 2**20:
        raise StudyError(f"no space is left for {studyset.folder}; what is finished is kept: make room and run it again")
    if process.returncode != 0:
        raise StudyError(f"{_why(studyset.log, begin)} (log: {studyset.log})")


def _why(log, begin):
    """What a log says from there on of a failure: the first error of a job, else its last words."""
    with open(log, encoding="utf-8", errors="replace") as file:
        file.seek(begin)
        lines = [line.strip() for line in file]
    if said := [line for line in lines if line.startswith("error: ")]:
        return said[0].removeprefix("error: ")
    wrong = [line for line in lines[-12:] if "rror" in line]
    return f"a stage failed: {(wrong or lines or ['no word of it'])[-1][:300]}"


def duration(seconds):
    minutes, seconds = divmod(max(0, round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {seconds} s" if minutes else f"{seconds} s"
