# One run a cell of the map, as a raw file; its row of the table; the window of the penalty factor.
import json
import shlex
from dataclasses import dataclass

from study.pipeline import child, runs
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import program

AUTOMATIC = "auto"
DENSE_LOOPS = 20  # a dense implementation runs up to this size


@dataclass(frozen=True)
class Cell:
    loops: int
    scheme: str
    precision: str
    contender: Contender
    step: float
    scaled: float | str  # alpha step^2 / 4 in kg/m^2, or AUTOMATIC

    @property
    def penalty(self):
        """The value of --penalty."""
        if self.scaled == AUTOMATIC:
            return AUTOMATIC
        return f"{4 * self.scaled / self.step**2:.8g}"

    def path(self, layout, duration):
        scaled = self.scaled if self.scaled == AUTOMATIC else f"{self.scaled:g}"
        return (layout.results / "raw" / f"{self.loops}" / f"{self.scheme}-{self.precision}"
                / f"{self.contender.file_name}-{self.step:g}-{scaled}-{duration:g}s.json")


def run(cell, layout, contexts, duration, seconds):
    """The record of one simulation, judged after every step; an existing file is never run again."""
    return runs.simulate(
        cell.path(layout, duration), cell.contender, f"four-bar:{cell.loops}", step=cell.step,
        duration=duration, every=0, context=contexts[cell.contender.environment], seconds=seconds,
        more=["--scheme", cell.scheme, "--precision", cell.precision, "--penalty", cell.penalty,
              "--judge-every", 1])


def row(cell, record, layout, duration):
    """The row of stability.csv of a run."""
    status, reason = runs.status(record)
    summary = record.get("summary", {})
    penalty = summary.get("penalty", None if cell.penalty == AUTOMATIC else float(cell.penalty))
    return {"loops": cell.loops, "scheme": cell.scheme, "precision": cell.precision,
            "implementation": cell.contender.variant, "step": cell.step,
            "penalty_asked": cell.penalty, "penalty": penalty,
            "alpha_dt2_4": penalty and float(f"{penalty * cell.step**2 / 4:.6g}"),
            "status": status, "status_reason": reason} | {
                key: summary.get(key) for key in (
                    "failed_at", "position_error_max", "energy_drift_max", "passes_per_step",
                    "steps_at_limit")} | {
            "raw_file": layout.relative(cell.path(layout, duration)),
            "command": runs.typed(record)}


def windows(loops, steps, precisions):
    """The rows of windows.csv: what `mbs describe` says of the penalty factor."""
    return [{"loops": count, "precision": precision} | _window(count, step, precision)
            for count in loops for precision in precisions for step in steps]


def _window(count, step, precision):
    command = [program(), "describe", f"four-bar:{count}", "--step", f"{step:g}", "--precision", precision, "--json"]
    ended = child.run(command, 60, runs.MEMORY_MB)
    try:
        window = json.loads(ended.stdout)["penalty_window"]
    except (ValueError, KeyError) as error:
        raise StudyError(ended.reason.partition("mbs: ")[2] or
                         f"`{shlex.join(command)}` does not work: {ended.reason}") from error
    return {key: window[key] for key in ("step", "lower", "lower_from", "upper", "upper_from")}
