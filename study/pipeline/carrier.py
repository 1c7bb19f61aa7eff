# What a study with a page of its own does between its command line and that page.
import contextlib
import importlib
import os
from pathlib import Path

from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, need_unchanged
from study.pipeline.prepare import need_modules, only_one, only_one_measuring, set_up, writable


def layout_of(options, name, needed):
    """The layout of --results, or of results/local/NAME; StudyError if --stored finds no file `needed`."""
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / name)
    if options.stored and not (layout.results / needed).exists():
        raise StudyError(f"{layout.results} holds no results (no {needed})")
    return layout


def carry_out(layout, options, name, run, timed=True, more_set_up=lambda: None):
    """Sets up, calls run(layout, options) and writes figures and page, those of analysis/NAME/report.py;
    with --stored the page only. Alone in the results directory and, if `timed`, on the machine."""
    writable(layout.results)
    _need_folders(getattr(options, "only", []))
    measures = timed and not options.stored
    with only_one(layout), only_one_measuring() if measures else contextlib.nullcontext():
        if "MBS_PROGRAM" not in os.environ and not options.stored:
            set_up(layout)
            more_set_up()
        need_modules()
        if options.stored:
            need_unchanged(layout.results)
        else:
            run(layout, options)
        _write(layout, name)
    return 0


def _need_folders(names):
    """StudyError if one is of no folder: said before set-up, which takes minutes."""
    if "MBS_PROGRAM" in os.environ:
        return
    folders = [path.parent.name for path in sorted((ROOT / "implementations").glob("*/README.md"))]
    for name in names:
        if name.partition("/")[0] not in folders:
            raise StudyError(f"--only: unknown implementation '{name}'; known folders: {', '.join(folders)}")


def _write(layout, name):
    from analysis.loader import TableError  # these need modules that may have been missing until now
    try:
        importlib.import_module(f"analysis.{name}.report").write(layout.results)
    except TableError as error:
        raise StudyError(str(error)) from error
    print(f"report: {layout.results / f'{name}.html'}")
