# Runs `mbs describe` and `mbs simulate` for the viewer, passing errors on.
import json
import math
import os
from pathlib import Path

from analysis.core.errors import StudyError
from analysis.core.files import ROOT
from study.core import child
from study.core.executor import program_of
from study.tools.viewer.scene import from_description

STEPS = (1.25e-3, 1.25e-4, 1.25e-5, 1.25e-6)  # s; tried in this order until the run is right
STEPS_AT_MOST = 8000     # of an automatic step: 10 s of the first
SECONDS_AT_MOST = 60     # of computing, where the duration is not asked for
TRIAL_STEPS = 20
STEPS_OF_A_RUN = 1e8     # at most: mbs refuses more


def describe(scene):
    """The Scene of `mbs describe SCENE --json`. Raises StudyError with the program's own words."""
    code, out, words = _run("describe", scene, "--json")
    if code != 0:
        raise StudyError(_failure("describe", code, words))
    try:
        return from_description(json.loads(out), Path(scene).name)
    except json.JSONDecodeError as error:
        raise StudyError(f"`mbs describe {scene} --json` gave no JSON: {error}") from error


def simulate(place, scene, options, frames, csv, outputs, say):
    """Writes the trajectory `csv` of `scene`, which is at `place`, in about `frames` rows, and its outputs at the same times to `outputs`
    unless that is None; returns a line on what was run. A step or duration that is not given is chosen. `say` tells the user."""
    how = ["--implementation", options.implementation, "--scheme", scene.scheme]
    for step in (options.step,) if options.step else STEPS:
        duration = options.duration or _affordable(place, how, step, min(10.0, STEPS_AT_MOST * step, scene.end), say)
        say(f"simulating {duration:g} s in steps of {step:g} s with {options.implementation}, {scene.scheme} form")
        written = ["--trajectory", csv, "--every", _every(duration / step, frames), *(["--output", outputs] if outputs else [])]
        code, _, words = _simulate(place, how, step, duration, written)
        if code != 1 or options.step:
            break
        say(f"  {words[-1].strip() if words else 'without a word'}")
    if code != 0:
        raise StudyError(_failure("simulate", code, words) + ("" if options.step else " (choose a --step)" if code == 1 else ""))
    for line in words:  # warnings, and what is not accurate
        say(f"  {line}")
    return f"{options.implementation}, {scene.scheme} form, step {step:g} s"


def _every(steps, frames):
    """Write every so many steps: the fewest that make at most `frames` rows, better a divisor of `steps`, so that the last is written too."""
    steps = max(1, round(min(steps, STEPS_OF_A_RUN)))
    most = min(frames, steps)
    return next((steps // rows for rows in range(most, most // 2, -1) if steps % rows == 0), math.ceil(steps / frames))


def _affordable(place, how, step, duration, say):
    """`duration`, or as much of it as a trial says can be computed in SECONDS_AT_MOST."""
    code, out, _ = _simulate(place, how, step, TRIAL_STEPS * step, ["--json"])
    if code != 0:
        return duration  # the run itself will say what is wrong
    seconds_a_step = json.loads(out)["step_us"]["median"] * 1e-6
    fits = SECONDS_AT_MOST / max(seconds_a_step, 1e-9) * step
    if fits >= duration:
        return duration
    fits = float(f"{max(fits, TRIAL_STEPS * step):.1g}")
    say(f"{duration:g} s would take about {duration / step * seconds_a_step / 60:.0f} minutes: only {fits:g} s of it (ask for more with --duration)")
    return fits


def _simulate(place, how, step, duration, more):
    return _run("simulate", place, *how, "--step", repr(step), "--duration", repr(duration), *more)


def _run(command, scene, *more):
    """(exit status, standard output, lines of standard error)"""
    if not os.access(ROOT / program_of(), os.X_OK):  # an absolute MBS_PROGRAM stays as it is
        raise StudyError(f"{program_of()} is not built yet: run study/setup")
    place = os.path.abspath(scene) if os.path.isfile(scene) else scene  # a child runs elsewhere
    ended = child.run([program_of(), command, place, *map(str, more)])
    return ended.code, ended.stdout, [line for line in ended.stderr.splitlines() if line.strip()]


def _failure(command, code, words):
    end = f"signal {-code}" if code < 0 else f"status {code}"
    return words[-1].strip() if words else f"mbs {command} ended with {end}, without a word"
