# Reads the tables of one results directory and refuses what does not fit their description.
import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy
import pandas

STATUSES = {"ok", "disagrees", "excluded", "crashed", "timeout", "out-of-memory", "unsupported",
            "unavailable", "passes-differ", "not-reached"}
FAILURES = ("disagrees", "crashed", "timeout", "out-of-memory", "unsupported", "passes-differ")
PHASES = ("evaluation", "assembly", "factorization", "solve", "projection", "other")
NULL = "null/null"

TEXT = {"tidy": ["kind", "stage", "scene", "implementation", "folder", "variant", "blas", "build",
                 "operation", "status", "reason", "machine", "commit", "dirty", "raw_file"],
        "verification": ["scene", "implementation", "verdict", "reason", "check", "passed",
                         "detail"],
        "accuracy": ["scene", "implementation", "penalty_asked", "status", "status_reason",
                     "raw_file"]}
NUMBERS = {"tidy": ["variables", "fill_asked", "fill_percent", "round", "repetition",
                    "stretch_steps", "iterations", "stretch_us", "step_us", "passes",
                    "steps_at_limit", "setup_us", "constraints", "penalty", "step", "tolerance",
                    "max_passes", "start", "fill_seed", "position_error",
                    "constraint_violation", "energy_drift", "operation_us", "pilot_step_us",
                    "pilot_ratio",
                    *(f"phase_{phase}" for phase in PHASES)],
           "verification": ["variables", "fill_asked", "value", "tolerance"],
           "accuracy": ["variables", "penalty", "step", "tolerance", "duration", "failed_at",
                        "steps", "passes_per_step", "position_error_max", "energy_drift_max",
                        "constraint_violation_max", "setup_us", "step_us_median", "step_us_p99",
                        "step_us_max"]}


class TableError(ValueError):
    """A table that does not fit results/README.md: file, what and where, in one line."""


@dataclass(frozen=True)
class Results:
    """Everything a figure or the report may use."""
    tidy: pandas.DataFrame
    verification: pandas.DataFrame
    accuracy: pandas.DataFrame
    context: dict      # machine, build and library versions, the same for every raw file
    run: dict          # profile name, selection, variants
    registry: list     # entries of `mbs list --json`, in the order that figures use
    pairs: list = field(default_factory=list)  # BLAS + LAPACK pairs of `mbs list --json`

    @property
    def variants(self):
        """{name: what `mbs list --json` says of it and of its folder}, in the registry's order."""
        return {variant["name"]: entry | variant
                for entry in self.registry for variant in entry["variants"]}

    @property
    def implementations(self):
        """Names that take part in rankings, in the registry's order."""
        present = set(self.tidy.implementation)
        return [name for name in self.variants if name in present]

    def samples(self, natural_only=False):
        """Timed samples of verified cells that are ranked: no alternatives, no null control."""
        tidy = self.tidy
        chosen = ((tidy.kind == "timing") & (tidy.status == "ok")
                  & tidy.implementation.isin(list(self.variants)))
        return tidy[chosen & tidy.fill_asked.isna()] if natural_only else tidy[chosen]

    def alternatives(self, variant):
        """Timed samples of `variant` and of it on other BLAS pairs or builds, "variant+name"."""
        tidy = self.tidy
        mine = tidy.folder + "/" + tidy.variant == variant
        return tidy[(tidy.kind == "timing") & (tidy.status == "ok") & mine]

    def natural_failures(self, variables):
        """Whether an implementation failed or disagrees on the natural scene of this size."""
        tidy = self.tidy
        scene = (tidy.variables == variables) & tidy.fill_asked.isna() & (tidy.kind == "timing")
        ranked = tidy.implementation.isin(list(self.variants))
        return bool((scene & ranked & tidy.status.isin(FAILURES)).any())


def load(results):
    """All of a results directory; TableError if a table is damaged."""
    folder = Path(results)
    tables = {name: read_table(folder / f"{name}.csv", name) for name in TEXT}
    _check_tidy(folder / "tidy.csv", tables["tidy"])
    listed = _json(folder / "implementations.json")
    return Results(**tables, context=_json(folder / "context.json"), run=_json(folder / "run.json"),
                   registry=listed["implementations"], pairs=listed.get("blas", []))


def read_table(path, name):
    """One table with text as str ("" if empty) and numbers as float (NaN if empty)."""
    try:
        table = pandas.read_csv(path, dtype=str, keep_default_na=False)
    except (OSError, ValueError) as error:
        raise TableError(f"{path}: cannot be read: {error}") from error
    missing = [column for column in TEXT[name] + NUMBERS[name] if column not in table.columns]
    if missing:
        raise TableError(f"{path}: columns are missing: {', '.join(missing)}")
    unknown = [column for column in table.columns if column not in TEXT[name] + NUMBERS[name]]
    if unknown:
        raise TableError(f"{path}: unknown columns: {', '.join(unknown)}")
    for column in NUMBERS[name]:
        numbers = pandas.to_numeric(table[column].replace("", numpy.nan), errors="coerce")
        wrong = table.index[(table[column] != "") & ~numpy.isfinite(numbers)]
        if len(wrong):
            raise TableError(f"{path}: line {wrong[0] + 2}: {column} is no finite number: "
                             f"'{table[column][wrong[0]]}'")
        table[column] = numbers.astype(float)
    return table


def _check_tidy(path, tidy):
    def require(condition, what):
        if not condition.all():
            raise TableError(f"{path}: line {tidy.index[~condition][0] + 2}: {what}")
    require(tidy.status.isin(STATUSES), f"status is none of {', '.join(sorted(STATUSES))}")
    require(tidy.kind.isin(["timing", "phases", "operations"]),
            "kind is none of timing, phases, operations")
    ok = tidy.status == "ok"
    timed = tidy.step_us.where(tidy.kind != "operations", tidy.operation_us)
    require(~ok | (timed > 0), "an ok row needs a positive step_us or operation_us")
    require(ok | (tidy.reason != ""), "a row that is not ok needs a reason")
    timed = tidy[ok & (tidy.kind == "timing")]
    doubled = timed.duplicated(["scene", "implementation", "round", "repetition"])
    require(~doubled.reindex(tidy.index, fill_value=False), "the same sample twice")
    shares = tidy[[f"phase_{phase}" for phase in PHASES]]
    measured = shares.notna().any(axis=1) & (tidy.kind == "phases")
    require(~measured | ((shares.sum(axis=1) - 1).abs() < 1e-6), "phase shares must add up to 1")
    if tidy.machine.nunique() > 1 or tidy.commit.nunique() > 1:
        raise TableError(f"{path}: rows of several machines or commits: they must not be mixed")


def _json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise TableError(f"{path}: cannot be read: {error}") from error


def plain_table(path):
    """A CSV file as pandas takes it; TableError if it cannot."""
    try:
        return pandas.read_csv(path)
    except (OSError, ValueError) as error:
        raise TableError(f"{path}: cannot be read: {error}") from error
