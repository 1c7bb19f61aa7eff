# The smoke profile through the real program: every stage, then again from what is stored.
import os
import subprocess

import pandas

from study.tests.conftest import ROOT


def test_smoke_on_the_real_program(tmp_path):
    program = os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
    assert os.access(program, os.X_OK), f"{program} is missing: run study/setup"
    results, environment = tmp_path / "results", os.environ | {"MBS_PROGRAM": program,
                                                              "TMPDIR": str(tmp_path)}

    def run(*arguments):
        return subprocess.run([ROOT / "study" / arguments[0], *arguments[1:]], text=True,
                              capture_output=True, env=environment, timeout=900)
    first = run("run", "--profile", "smoke", "--results", results)
    assert first.returncode == 0, first.stderr
    tidy = pandas.read_csv(results / "tidy.csv")
    assert set(tidy.status) <= {"ok", "not-reached", "unavailable", "unsupported"}, tidy[tidy.status != "ok"]
    # Its kernels are for chains, which artificial fill ends.
    assert set(tidy.implementation[tidy.status == "unsupported"]) <= {"compiled_ldl/chains"}
    operations = tidy[tidy.kind == "operations"]
    assert set(operations.status) == {"ok"} and (operations.operation_us > 0).all()
    assert {"csc_klu/refactor", "ublas_sparse/plain"} <= set(operations.implementation)
    samples = tidy[(tidy.status == "ok") & tidy.kind.isin(["timing", "phases"])
                   & (tidy.implementation != "null/null")]
    assert (samples.groupby("scene").passes.nunique() == 1).all()
    assert (samples.position_error < 1e-3).all()
    pairs = samples[samples.folder == "armadillo_dense"].groupby("implementation").blas.unique()
    assert pairs["armadillo_dense/potrf"] == ["openblas"]
    assert pairs["armadillo_dense/potrf+reference"] == ["reference"]
    assert "refined" in set(samples.stage)
    verified = pandas.read_csv(results / "verification.csv")
    assert set(verified.verdict) <= {"agrees", "unsupported"}
    assert set(verified.implementation[verified.verdict == "unsupported"]) <= {"compiled_ldl/chains"}
    stored = (results / "tidy.csv").read_bytes()
    assert run("figures", results).returncode == 0
    assert (results / "tidy.csv").read_bytes() == stored
