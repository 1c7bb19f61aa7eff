# What the command lines of the studies share.
import argparse
import math


def positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return float(f"{value:g}")  # as it is passed on


def loops(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of loops (1, 2, ...)")
    return int(text)


def add_only(parser, whose="these implementations"):
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help=f"only {whose} (folder or folder/variant)")


def add_results(parser, name):
    parser.add_argument("--results", metavar="DIR", help=f"results directory (results/local/{name})")
    parser.add_argument("--stored", action="store_true",
                        help="figures and page again from stored tables, without running anything")
