# A small table set, valid until a test damages it.
import csv
import json

import pytest

from analysis.loader import NUMBERS, PHASES, TEXT


def timing(implementation, round_number, repetition, step_us, **more):
    return {"kind": "timing", "scene": "four-bar:4", "implementation": implementation,
            "folder": implementation.split("/")[0], "variant": implementation.split("/")[1],
            "variables": 10, "fill_percent": 52, "status": "ok", "round": round_number,
            "repetition": repetition, "stretch_steps": 100, "step_us": step_us,
            "stretch_us": 100 * step_us, "setup_us": 5, "passes": 220, "machine": "m",
            "commit": "c", "dirty": "false", "raw_file": "raw/x.json"} | more


def write(path, name, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, [*TEXT[name], *NUMBERS[name]], restval="")
        writer.writeheader()
        writer.writerows(rows)


@pytest.fixture
def tables(tmp_path):
    """(folder, rows of tidy.csv); call write(folder / "tidy.csv", "tidy", rows) after a change."""
    rows = [timing(name, r, k, level + 0.01 * k) for name, level in (("a/x", 1.0), ("b/y", 2.0))
            for r in (1, 2, 3) for k in (1, 2, 3)]
    rows.append(timing("a/x", 1, 1, 1.0, kind="phases")
                | {f"phase_{phase}": 1 / 6 for phase in PHASES})
    write(tmp_path / "tidy.csv", "tidy", rows)
    write(tmp_path / "verification.csv", "verification", [])
    write(tmp_path / "accuracy.csv", "accuracy", [])
    variants = [{"name": name, "description": ""} for name in ("a/x", "b/y", "c/z")]
    entry = {"folder": "a", "variants": variants, "available": True, "reason": "", "library": "L",
             "version": "1", "licence": "MIT"}
    context = dict.fromkeys(("cpu_model", "machine", "kernel", "commit", "dirty", "compiler",
                             "flags", "build_type", "libraries", "blas_loaded"), "?")
    for name, data in (("implementations", {"implementations": [entry]}), ("context", context),
                       ("run", {"profile": "smoke", "only": []})):
        (tmp_path / f"{name}.json").write_text(json.dumps(data))
    return tmp_path, rows
