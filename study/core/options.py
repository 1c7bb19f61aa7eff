# What the command lines of the studies share.
import argparse
import math
from pathlib import Path

from analysis.core.files import StudyError


class Parser(argparse.ArgumentParser):
    """Its errors are one line, like those of everything else."""

    def error(self, message):
        raise StudyError(f"{message} (see {self.prog} --help)")


def directory(text):
    """Its absolute path; an empty text never stands for a default."""
    if not text:
        raise argparse.ArgumentTypeError("an empty name is no directory")
    return Path(text).absolute()


def positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return float(f"{value:g}")  # as it is passed on


def rounds(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of rounds (1, 2, ...)")
    return int(text)
