# The fake program as study/accuracy runs it: three steps, two implementations.
import tempfile

import pytest

from study.accuracy_study import bench, settings, subjects
from study.pipeline.contenders import Contender
from study.pipeline.layout import Layout
from study.tests.conftest import FAKE

STEPS = (1e-2, 5e-3, 2.5e-3)
BOTH = ("good_dense/first", "good_sparse/only")


@pytest.fixture
def fake(tmp_path, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(subjects, "STEPS", STEPS)
    return bench.Bench(Layout(tmp_path / "results"), {"own|system": {}}, 4.0)


def admitted(refused=(), **served):
    names = {"good_dense/first": True, "good_sparse/only": False}
    return settings.Entries({name: Contender(name, name) for name in names}, names,
                            {name: [settings.Setting(one) for one in served.get(name.split("_")[1][:5], (
                                "default",))] for name in names}, dict(refused))
