# What the command lines of the studies share: values, the results directory, the report at the end.
import argparse
import math
from pathlib import Path

from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT


def positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return float(f"{value:g}")  # as it is passed on


def loops(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of loops (1, 2, ...)")
    return int(text)


def results(options, name, needed):
    """The layout of --results, or of results/local/NAME; StudyError if --stored finds no file `needed`."""
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / name)
    if options.stored and not (layout.results / needed).exists():
        raise StudyError(f"{layout.results} holds no results (no {needed})")
    return layout


def report(layout, name, write):
    """Writes figures and page and says where NAME.html is. `write`: that of analysis/NAME/report.py."""
    from analysis.loader import TableError  # it needs modules that may have been missing until now
    try:
        write(layout.results)
    except TableError as error:
        raise StudyError(str(error)) from error
    print(f"report: {layout.results / f'{name}.html'}")
