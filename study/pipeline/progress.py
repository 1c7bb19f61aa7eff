# How jobs tell the front what they do (lines of JSON in one file of the results directory), and how
# a study that runs alone tells its user.
import json
import sys
import time


class Progress:
    """Appends events of one stage and column."""

    def __init__(self, layout, stage, variables):
        self.path, self.stage, self.variables = layout.progress, stage, variables
        self.last = time.monotonic()

    def done(self, cells=1, text=""):
        """`cells` more are finished; seconds since the last call tell fresh from resumed ones."""
        now = time.monotonic()
        event = {"stage": self.stage, "variables": self.variables, "cells": cells, "text": text,
                 "seconds": round(now - self.last, 4)}
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(json.dumps(event) + "\n")
        self.last = now


class Quiet:
    """Progress that nobody is told."""

    def done(self, cells=1, text=""):
        pass


class Reader:
    """Follows the events that Progress appends."""

    def __init__(self, layout):
        layout.progress.write_text("")
        self.file = open(layout.progress, encoding="utf-8")
        self.rest = ""

    def events(self):
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        return [json.loads(line) for line in lines if line]


class Teller:
    """One line that is rewritten on a terminal; a line now and then elsewhere."""
    quiet = False

    def __init__(self):
        self.terminal, self.last = sys.stdout.isatty(), ""

    def __call__(self, text):
        if self.quiet:
            return
        if self.terminal:
            print(f"\r\033[K{text[:100]}", end="", flush=True)
        elif text.split(":")[0].split(",")[0] != self.last:
            self.last = text.split(":")[0].split(",")[0]
            print(text, flush=True)

    def end(self):
        if self.terminal and not self.quiet:
            print()
