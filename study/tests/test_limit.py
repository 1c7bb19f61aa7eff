# The limit: what is asked for, of whom, and who is left out; a tiny run on the real program.
import json
import os
import subprocess
from types import SimpleNamespace

import pandas
import pytest

from analysis.core.files import digest, read_json
from analysis.core.registry import Registry
from study.core import contest
from study.core.cell import Contender
from study.families import plan as families
from study.limit import plan
from study.tests.conftest import FAKE, ROOT, environment, study
from study.tools import fragments

REGISTRY = Registry({"implementations": [
    {"folder": "one", "available": True, "library": "L", "variants": [{"name": "one/a"}, {"name": "one/b"}]},
    {"folder": "own", "available": True, "library": "none", "variants": [{"name": "own/x", "settings": ["saddle-point"]},
                                                                         {"name": "own/y", "settings": []}]}]})
SETTINGS = {"loops": [10, 40], "large": [49], "problems": ["A01"], "examples": ["coupler"], "fills": [0.5], "batches": [10],
            "sets": [8, 64], "swept": 100, "patience": 0.1, "processes": 2, "samples": 3}


class Asked:
    """A lab that runs nothing and keeps what it is asked for; the gate agrees with all but `wrong`."""
    wrong = ()

    def __init__(self, names=("one/a", "one/b", "own/x", "own/y"), **changes):
        self.contenders = [Contender(name, name, "openblas") for name in names]
        self.settings, self.registry, self.cells, self.skipped = SETTINGS | changes, REGISTRY, [], []

    def contender(self, name):
        return next((one for one in self.contenders if one.name == name), None)

    def run(self, cells, drop=False):
        self.cells += cells
        return [SimpleNamespace(done=True, status="done", verdicts={
            one.name: ("disagrees" if one.name in self.wrong else "agrees", "") for one in cell.contenders}) for cell in cells if cell.kind == "check"]

    def one(self, cell):
        self.cells.append(cell)

    def skip(self, cell, status, reason):
        self.skipped.append((cell.scene, cell.contenders[0].name, status, reason))


def rows(**times):
    """Of a process; a time in µs a step, or a status."""
    return pandas.DataFrame([{"implementation": name.replace("_", "/"), "status": "ok" if isinstance(time, float) else time,
                              "step_us": time if isinstance(time, float) else float("nan")} for name, time in times.items()],
                        columns=["implementation", "status", "step_us"])


@pytest.fixture
def measured(monkeypatch):
    """What `measure` was asked for; `said` gives its rows."""
    found = SimpleNamespace(asked=[], said=lambda scene, names: rows(**{name.replace("/", "_"): 1.0 for name in names}))

    def measure(lab, scene, contenders, *, role, settings, **more):
        names = [one.name for one in contenders]
        found.asked.append((role, scene, names, settings))
        return found.said(scene, names)
    for module in (plan, contest):
        monkeypatch.setattr(module, "measure", measure)
        monkeypatch.setattr(module, "rows_of", lambda table: table)
    return found


def test_the_fastest_library_is_timed_beside_itself_where_a_control_is_asked_for(measured):
    times = {"one/a": 2.0, "one/b": 1.5, "own/x": 1.0, "own/y": 1.2}
    measured.said = lambda scene, names: rows(**{name.replace("/", "_"): times[name] for name in names if name in times})
    for control, twins in ((False, []), (True, ["one/b+twin"])):
        contest.contests(Asked(), "ladder:2", [contest.Form("penalty", Asked().contenders, 2, 1)], own=REGISTRY.own, always=True, control=control)
        assert measured.asked[-1][2] == [*times, *twins]


def test_the_gates_of_all_forms_run_at_once_after_the_looks(measured):
    lab, batches = Asked(), []
    lab.run = lambda cells, drop: batches.append([cell.role for cell in cells]) or Asked.run(lab, cells, drop)
    forms = [contest.Form(role, lab.contenders, 2, 1) for role in ("penalty", "saddle-point")]
    assert len(contest.contests(lab, "ladder:2", forms, own=REGISTRY.own)) == 2
    assert [role for role, *_ in measured.asked] == ["penalty-look", "saddle-point-look", "penalty", "saddle-point"]
    assert batches == [["penalty-gate", "saddle-point-gate"]]


def test_the_gate_compares_fewer_steps_of_the_slow(measured):
    times = {"one/a": 1.0, "one/b": 9.0, "own/x": 0.5, "own/y": 12.0}
    measured.said = lambda scene, names: rows(**{name.replace("/", "_"): times[name] for name in names if name in times})
    lab = Asked()
    contest.contests(lab, "ladder:2", [contest.Form("penalty", lab.contenders, 2, 1, ("--scheme", "penalty"))], own=REGISTRY.own)
    checks = {cell.settings: [one.name for one in cell.contenders] for cell in lab.cells if cell.kind == "check"}
    assert [(words[:2], words[2:4], sorted(names)) for words, names in checks.items()] == [
        (("--scheme", "penalty"), ("--time-limit", "60"), ["one/a", "own/x"]), (("--scheme", "penalty"), ("--steps", 16), ["one/b", "own/y"])]
    assert measured.asked[-1][2] == ["one/a", "own/x"]


def test_families_have_controls_from_small_to_large(monkeypatch):
    asked = []
    monkeypatch.setattr(families, "about", lambda lab, scenes: [SimpleNamespace(done=False)] * len(scenes))
    monkeypatch.setattr(families, "contests", lambda lab, scene, forms, *, control, **_: asked.append((scene, control)) or [rows() for _ in forms])
    families.run(Asked(scenes=[f"chain:{n}" for n in range(6)], processes={"penalty": 2, "saddle-point": 2}), "mechanisms")
    assert {scene for scene, control in asked if control} == {"chain:0", "chain:2", "chain:4"} and len(asked) == 6


def test_who_is_not_timed_at_one_size_is_not_tried_at_a_larger_one(measured):
    measured.said = lambda scene, names: rows(**{name.replace("/", "_"): "slower" if name == "one/b" else 1.0 for name in names})
    lab = Asked()
    plan.run(lab, "sizes")
    assert [(scene, names) for _, scene, names, _ in measured.asked] == [
        ("four-bar:10", ["limit/limit", "one/a", "one/b", "own/x", "own/y"]),
        ("four-bar:40", ["limit/limit", "one/a", "own/x", "own/y"]), ("four-bar:49", ["limit/limit", "own/x", "own/y"])]
    assert lab.skipped == [("four-bar:40", "one/b", "excluded", "not timed at N = 10: slower")]
    assert [(cell.kind, cell.settings) for cell in lab.cells if cell.role == "bounds"] == [("limit", (10, 40, 49))]
    assert {cell.scene for cell in lab.cells if cell.kind == "check"} == {"four-bar:10", "four-bar:40"}
    assert ["--patience" in settings for _, _, _, settings in measured.asked] == [True, True, False]


def test_a_size_that_the_budget_dropped_excludes_nobody(measured):
    measured.said = lambda scene, names: rows(**{name.replace("/", "_"): "dropped" for name in names})
    lab = Asked()
    plan.run(lab, "sizes")
    assert lab.skipped == [] and not [cell for cell in lab.cells if cell.kind == "check"]


def test_growth_is_of_own_code_that_serves_the_form(measured):
    plan.run(Asked(), "growth")
    [(role, scene, names, settings)] = measured.asked
    assert (role, scene, names) == ("growth", "four-bar:49", ["own/x"])
    assert settings[:2] == ("--scheme", "saddle-point") and settings[2:] == plan.FIRST


def test_growth_tries_nobody_at_a_larger_size_who_was_too_slow_at_one(measured):
    measured.said = lambda scene, names: rows(**{name.replace("/", "_"): "slower" for name in names})
    lab = Asked(large=[49, 160])
    plan.run(lab, "growth")
    assert [names for _, _, names, _ in measured.asked] == [["own/x"], []]
    assert lab.skipped == [("four-bar:160", "own/x", "excluded", "not timed at N = 49: slower")]


def test_three_scenes_have_a_control(measured):
    measured.said = lambda scene, names: rows(one_a=2.0, one_b=3.0)
    plan.run(Asked(problems=[], examples=[], fills=[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]), "scenes")
    assert [scene for role, scene, names, _ in measured.asked if role == "fill" and "one/a+twin" in names] == [
        f"four-bar:49,fill={fill}" for fill in (0.1, 0.3, 0.5)]


def test_after_a_look_at_everyone_those_are_timed_that_are_near_and_agree(measured):
    """A look is a few steps; who does not serve the scene, is far behind or disagrees is not timed further."""
    measured.said = lambda scene, names: rows(one_a=2.0, one_b=4.1, own_x=9.0, own_y="unsupported")
    lab = Asked()
    plan.run(lab, "scenes")
    assert [(role, scene.rpartition("/")[2]) for role, scene, _, _ in measured.asked[::2]] == [
        ("problem-look", "a01_pendulum.json"), ("fill-look", "four-bar:49,fill=0.5"), ("example-look", "coupler.json")]
    (_, _, looked, look), (role, _, names, problem), _, (_, _, _, fill), *_ = measured.asked
    assert len(looked) == 4 and role == "problem" and names == ["one/a", "own/x", "one/a+twin"]
    assert "--steps" in look and "--steps" not in problem
    assert problem[problem.index("--step") + 1] == "0.001" and "--step" not in fill
    gates = [cell for cell in lab.cells if cell.kind == "check" and "pendulum" in cell.scene]
    assert [[one.name for one in cell.contenders] for cell in gates] == [names[:2], ["one/b"]] and gates[0].settings[:2] == ("--step", "0.001")
    lab.wrong, measured.asked[:] = ("one/a",), []
    plan.run(lab, "scenes")
    assert measured.asked[1][2] == ["own/x"]


def test_processes_of_batches_take_turns_over_all_cells():
    lab = Asked(batches=[10, 40])
    plan.run(lab, "batches")
    assert [cell.number for cell in lab.cells] == [1] * 4 + [2] * 4
    assert [cell.settings[2] for cell in lab.cells[:4]] == [8, 64, 8, 64] and all(cell.timed for cell in lab.cells)
    assert len({cell.settled().file_name() for cell in lab.cells}) == 8
    assert not Asked(names=()).cells


def test_sweeps_are_asked_of_those_that_take_part():
    lab = Asked(names=("compiled_chains/sweeps", "one/a"))
    plan.run(lab, "sweeps")
    assert [(cell.scene, cell.number, cell.program) for cell in lab.cells] == [("four-bar:10", 1, plan.SWEEP), ("four-bar:10", 2, plan.SWEEP)]
    assert ("--lanes", 100) == lab.cells[0].settings[-4:-2] and lab.cells[0].timed


def swept(tmp_path, table="table", end=""):
    """`sweep_process` on a program that stands in for `mbs`: its last word is the output."""
    program = tmp_path / "mbs"
    program.write_text(f"#!/bin/sh\nfor out; do :; done\necho {table} > $out\n{end or 'echo 5 lanes: 5 ok'}\n")
    program.chmod(0o755)
    return subprocess.run([ROOT / "study/limit/sweep_process", "four-bar:1", "--implementation", "a/b", "--vary", "x=1:2:3", "--lanes", "5",
                           "--duration", "0.1"], env=os.environ | {"MBS_PROGRAM": str(program)}, capture_output=True, text=True, check=False)


def test_a_sweep_by_one_and_by_two_jobs_must_give_one_table(tmp_path):
    done = swept(tmp_path, "$*")
    assert (done.returncode, done.stderr) == (1, "the tables by one and two jobs differ\n")
    found = json.loads(swept(tmp_path).stdout)
    assert [row["jobs"] for row in found["rows"]] == [1, 2] and all(row["wall_s"] > 0 < row["merge_s"] for row in found["rows"])
    assert (found["bytes"], found["lanes"]) == (len("table\n"), 5)


@pytest.mark.parametrize("failed, status, code", [(1, 1, 0), (5, 1, 2), (1, 2, 2)])
def test_a_sweep_may_have_lanes_that_fail(tmp_path, failed, status, code):
    said = f"mbs: a/b on four-bar:1: {failed} of 5 lanes failed: …"
    done = swept(tmp_path, end=f"echo '{said}' >&2; exit {status}")
    assert (done.returncode, done.stderr) == (code, f"{said}\n" if code else "")


def million(tmp_path, *, commit="HEAD", dirty="false", rows=50):
    """`study/limit/million` with 50 lanes of a program that says which one it was of each command, and `rows` of which it is a table."""
    program, log = tmp_path / "mbs", tmp_path / "log"
    program.write_text(f"""#!/bin/sh
case $1 in sweep|merge-sweep) ;; *) exec {FAKE} "$@" ;; esac
echo "$@" >> {log}
for out; do :; done
case $* in *1/10*) echo '5 lanes: 5 ok' ;; *) echo 'mbs: 1 of 50 lanes failed: …' >&2; code=1 ;; esac
echo mass,status > $out
for lane in $(seq {rows - 1}); do echo $lane,ok; done >> $out
echo 1,diverged >> $out
exit ${{code:-0}}
""")
    program.chmod(0o755)
    head = subprocess.run(["git", "rev-parse", commit], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip() or commit
    done = subprocess.run([ROOT / "study/limit/million", "four-bar:10", "--lanes", "50", "--nodes", "10", "--results", tmp_path / "kept"],
                          env=environment(program, FAKE_COMMIT=head, FAKE_DIRTY=dirty), capture_output=True, text=True, check=False)
    return done, log.read_text().splitlines() if log.exists() else []


def test_a_large_sweep_is_recorded(tmp_path):
    done, ran = million(tmp_path)
    assert done.returncode == 0, done.stderr
    [path] = (tmp_path / "kept").iterdir()
    kept = read_json(path)
    assert path.name == "four-bar-10.json" and kept["outcomes"] == {"ok": 49, "diverged": 1} and kept["context"]["dirty"] == "false"
    assert [(row["jobs"], row["lanes"]) for row in (*kept["part"], kept["whole"])] == [(jobs, 5) for jobs in (1, 2, 2, 1) * 2 + (1, 2)] + [(2, 50)]
    assert [("--shard 1/10" in words, words.split()[0]) for words in ran] == [(True, "sweep")] * 10 + [(False, "sweep"), (False, "merge-sweep")]
    assert kept["gain"] == fragments.gain(kept["part"]) and kept["gain"]["turns"] == 5
    assert max(row["memory_mb"] for row in (*kept["part"], kept["whole"])) < 60, "of the program, not of who started it"
    assert kept["whole"]["command"].startswith("build/mbs sweep four-bar:10 ") and str(tmp_path) not in path.read_text()
    assert (tmp_path / "mbs").exists() and kept["program"] == digest(tmp_path / "mbs") and len(kept["table"]) == 64
    assert fragments.million([kept]) in done.stdout


@pytest.mark.parametrize("how, said", [({"dirty": "true"}, "a dirty tree"), ({"commit": "0" * 40}, "no commit of this repository"),
                                       ({"rows": 40}, "the table has 40 rows, the sweep 50 lanes")])
def test_a_large_sweep_that_is_no_evidence_is_not_recorded(tmp_path, how, said):
    done, ran = million(tmp_path, **how)
    assert done.returncode == 1 and said in done.stderr and not (tmp_path / "kept").exists()
    assert bool(ran) == ("rows" in how)


def test_what_is_shown_of_a_large_sweep_is_projected_beside_what_was_observed():
    part = [{"jobs": jobs, "wall_s": wall, "memory_mb": 10.0, "lanes": 100} for jobs, wall in ((1, 2.0), (2, 1.0), (2, 1.0), (1, 1.5), (1, 9.0), (2, 5.0))]
    record = {"scene": "s:1", "implementation": "a/b", "lanes": 1000, "nodes": 10, "part": part,
              "whole": {"wall_s": 12.5, "memory_mb": 30.0, "command": "build/mbs sweep s:1"}, "merge": {"wall_s": 3.0, "memory_mb": 4.0},
              "context": {"commit": "c" * 40, "cpu_model": "P", "num_cpus": 2}, "program": "d" * 64, "table": "e" * 64, "bytes": 2e6,
              "outcomes": {"ok": 990, "diverged": 10}}
    shown = dict(line.strip("| ").split(" | ") for line in fragments.million([record]).splitlines()[2:])
    assert [shown[name] for name in ("lanes a second, the part by one job", "the part by two jobs",
                                     "two jobs over one, turn by turn: median (least to most)", "all lanes by two jobs",
                                     "all lanes by two jobs, projected from the part, s", "observed, s", "outcomes",
                                     "projected: parts on as many nodes at once, then the table, s", "memory of the largest process, MB")] == [
        "50", "100", "1.8 (1.5 to 2; turns: 3)", "80", "10", "12.5", "10 diverged, 990 ok", "4 (10 nodes)", "30"]
    assert fragments.million([]) == "No record is stored.\n"


def test_nothing_is_asked_where_nobody_takes_part(measured):
    lab = Asked(names=())
    for column in plan.columns({"seconds": 1.0}):
        plan.run(lab, column)
    assert not [cell for cell in lab.cells if cell.contenders]


def test_the_columns_share_the_budget():
    assert sum(plan.columns({"seconds": 100.0}).values()) == pytest.approx(100)


@pytest.mark.parametrize("profile", ["smoke", "quick", "full"])
def test_what_a_profile_names_exists(profile):
    import yaml
    settings = yaml.safe_load((ROOT / "study/profiles" / f"{profile}.yaml").read_text())["parts"]["limit"]
    found = plan.listed(settings)
    assert len(found) == sum(len(settings[key]) for key in ("problems", "examples", "fills"))
    assert all((ROOT / scene).is_file() for scene, _, _ in found if scene.endswith(".json"))


@pytest.mark.slow
def test_a_tiny_study_on_the_real_program(tmp_path):
    done = study("run", "--profile", "smoke", "--part", "limit", "--only", "csc_klu/refactor", "compiled_chains/sweeps", "--results",
                 tmp_path / "set")
    assert done.returncode == 0, done.stderr
    steps, held, batches = (pandas.read_csv(tmp_path / "set/limit" / f"{name}.csv") for name in ("steps", "held", "batches"))
    first = steps[(steps.form == "penalty") & (steps.loops == 1)]
    assert list(first.implementation) == ["limit/limit", "csc_klu/refactor", "compiled_chains/sweeps"]
    assert first.multiple.iloc[0] == 1 and len(held) > 5
    assert list(batches.status) in (["unsupported", "ok"], ["ok", "unsupported"], ["dropped", "dropped"])
    assert "What our own code is held to" in (tmp_path / "set/limit.html").read_text()
