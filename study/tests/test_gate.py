# The gate's processes: who is asked alone after one that ended early.
from types import SimpleNamespace

import pytest

from study.core.cell import Contender
from study.core.contest import Asked, verdicts


@pytest.mark.parametrize("seconds, asked", [(30.0, 1), (29.0, 3)])
def test_where_the_reference_took_all_the_time_nobody_is_asked_alone(seconds, asked):
    cells = []

    def run(given, drop):
        cells.extend(given)
        return [SimpleNamespace(done=False, status="timeout", verdicts={one.name: ("timeout", "") for one in cell.contenders})
                for cell in given]
    asked_of = [Asked("four-bar:1", [Contender("one/a", "one/a"), Contender("one/b", "one/b")])]
    [found] = verdicts(SimpleNamespace(run=run), asked_of, each=10.0, seconds=seconds)
    assert len(cells) == asked and set(found.values()) == {("timeout", "")}
