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
    """One line that is rewritten on a terminal; elsewhere one with the time since the start, where its subject (what
    stands before the first comma or colon) is new, and after half a minute."""
    quiet = False
    EVERY = 30.0  # s, at most, between lines: as far as there is something to tell
    KEPT = 0.05   # s: a shorter step of what is done was read from the results, and predicts nothing

    def __init__(self):
        self.terminal, self.subject = sys.stdout.isatty(), ""
        self.began = self.shown = self.changed = time.monotonic()
        self.share, self.fresh = 0.0, None  # what is done; when, and at which share, work began

    def __call__(self, text, share=None):
        """`share`: what is done (0 to 1) of what is told about; from it the rest is estimated."""
        if self.quiet:
            return
        now, subject = time.monotonic(), text.split(":")[0].split(",")[0]
        text += "" if share is None else f" ({100 * share:.0f} % done{self._left(share, now)})"
        if self.terminal:
            print(f"\r\033[K{text[:100]}", end="", flush=True)
        elif subject != self.subject or now - self.shown > self.EVERY:
            self.subject, self.shown = subject, now
            print(f"[{duration(now - self.began)}] {text}", flush=True)

    def _left(self, share, now):
        if share < self.share:  # another part
            self.share, self.fresh = 0.0, None
        if share > self.share:
            if self.fresh is None and now - self.changed > self.KEPT:
                self.fresh = self.changed, self.share
            self.changed, self.share = now, share
        if self.fresh is None:
            return ""
        began, at = self.fresh
        return f", about {duration((self.changed - began) / (share - at) * (1 - share))} left"

    def end(self):
        if self.terminal and not self.quiet:
            print()


def duration(seconds):
    """The text "1 min 20 s"."""
    seconds = max(0, round(seconds))
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60} min {seconds % 60} s"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"
