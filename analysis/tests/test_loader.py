# The loader accepts what results/README.md describes and names what does not fit.
import json

import pytest

from analysis.loader import TableError, load
from analysis.tests.conftest import write


def test_valid_tables(tables):
    results = load(tables[0])
    assert results.implementations == ["a/x", "b/y"]  # registry order, absent ones left out
    assert len(results.samples()) == 18
    assert results.tidy.step_us.dtype == float and results.tidy.reason.eq("").all()


@pytest.mark.parametrize("change, message", [
    ({"status": "fine"}, "status is none of"),
    ({"step_us": "fast"}, "line 2: step_us is no finite number: 'fast'"),
    ({"step_us": "inf"}, "step_us is no finite number"),
    ({"step_us": "nan"}, "step_us is no finite number"),
    ({"step_us": ""}, "an ok row needs a positive step_us"),
    ({"step_us": -1}, "an ok row needs a positive step_us"),
    ({"status": "crashed"}, "needs a reason"),
    ({"repetition": 2}, "the same sample twice"),
    ({"machine": "other"}, "several machines or commits"),
    ({"commit": "other"}, "several machines or commits"),
    ({"kind": "guess"}, "kind is none of timing, phases"),
])
def test_damaged_rows_are_refused(tables, change, message):
    folder, rows = tables
    rows[0] |= change
    write(folder / "tidy.csv", "tidy", rows)
    with pytest.raises(TableError, match=message):
        load(folder)


def test_phase_shares_must_add_up(tables):
    folder, rows = tables
    rows[-1]["phase_solve"] = 0.5
    write(folder / "tidy.csv", "tidy", rows)
    with pytest.raises(TableError, match="add up to 1"):
        load(folder)


@pytest.mark.parametrize("name", ["tidy", "verification", "accuracy"])
def test_missing_and_unknown_columns(tables, name):
    path = tables[0] / f"{name}.csv"
    text = path.read_text()
    path.write_text(text.replace("implementation", "implementor", 1))
    with pytest.raises(TableError, match="columns are missing: implementation"):
        load(tables[0])
    header, rest = text.split("\n", 1)
    path.write_text(f"{header.strip()},extra\n" + "".join(f"{line},1\n" for line in rest.split()))
    with pytest.raises(TableError, match="unknown columns: extra"):
        load(tables[0])


def test_missing_file(tables):
    (tables[0] / "context.json").unlink()
    with pytest.raises(TableError, match="context.json: cannot be read"):
        load(tables[0])


def test_pairs_come_from_the_registry(tables):
    folder, _ = tables
    assert load(folder).pairs == []
    path = folder / "implementations.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"blas": [{"name": "atlas"}]}))
    assert load(folder).pairs == [{"name": "atlas"}]
