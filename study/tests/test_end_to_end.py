# The smoke profile's map on the real program.
import pytest

from analysis.core import schema

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("smoke")]


def test_the_map_of_the_smoke_profile(smoke):
    tidy = schema.read_table(smoke, "map", "tidy")
    assert set(tidy.status) <= {"ok", "excluded", "unavailable", "unsupported", "dropped"}, tidy[tidy.status != "ok"]
    # Its kernels are for chains, which artificial fill ends.
    assert set(tidy.implementation[tidy.status == "unsupported"]) <= {"compiled_chains/sweeps"}
    timed = tidy[(tidy.status == "ok") & tidy.kind.isin(["timing", "phases"]) & (tidy.implementation != "null/null")]
    assert (timed.groupby("scene").passes.nunique() == 1).all() and (timed.position_error < 1e-3).all()
    assert {"csc_klu/refactor", "eigen_dense/llt", "starting_dense/gesv"} <= set(timed.implementation)
    assert set(timed.blas[timed.implementation == "starting_dense/gesv"]) <= {"reference"}
    cells = schema.read_table(smoke, "map", "cells")
    assert set(cells.layer) == {"libraries", "all"} and (cells.winner != "").all()
    assert not set(cells.winner[cells.layer == "libraries"]) & {"compiled_ldl/fronts", "compiled_chains/sweeps"}
    verified = schema.read_table(smoke, "map", "verification")
    assert set(verified.verdict) <= {"agrees", "unsupported"}
