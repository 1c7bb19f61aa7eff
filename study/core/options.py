# What the command lines of the studies share.
import argparse
import math

from analysis.core.errors import StudyError


class Parser(argparse.ArgumentParser):
    """Its errors are one line, like those of everything else."""

    def error(self, message):
        raise StudyError(f"{message} (see {self.prog} --help)")


def positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return float(f"{value:g}")  # as it is passed on


def loops(text):
    return _count(text, "loops")


def rounds(text):
    return _count(text, "rounds")


def _count(text, what):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of {what} (1, 2, ...)")
    return int(text)


def need_steps(duration, steps):
    """StudyError if a run of `duration` (s) in one of `steps` (s) is none that `mbs` would begin."""
    for step in steps:
        if not 1 <= round(duration / step) <= 1e8:
            raise StudyError(f"{duration:g} s in steps of {step:g} s are {duration / step:.3g} steps: "
                             "a run has 1 to 1e8")
