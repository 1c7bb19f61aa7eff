# Error against time: for each subject the curves of all settings, the times of what may be fastest; pairs of settings.
from analysis.accuracy.pairs import PAIRS, STEP
from analysis.accuracy.subjects import columns as listed
from analysis.core.files import StudyError
from analysis.core.gather import gather
from study.accuracy import work
from study.accuracy.runs import Runs

SETTINGS = {"duration": float, "longest": float, "processes": [int], "settings": [str], "errors": [float], "columns": [dict]}
DENSE = 1000   # variables, of dense contenders at most
BEHIND = 10.0  # times the fastest of its kind with the default setting: who is slower is not timed in pairs


def columns(settings):
    found = {name: float(entry["seconds"]) for name, (_, entry) in listed(settings).items()}
    if sum(found.values()) > settings["seconds"]:
        raise StudyError(f"accuracy: its columns add up to {sum(found.values()):g} s, more than {settings['seconds']:g} s")
    return found


def run(lab, column):
    kind, entry = listed(lab.settings)[column]
    if kind == "pairs":
        _pairs(lab, entry)
    else:
        work.run(lab, kind, entry)


def _pairs(lab, entry):
    """Two settings of one implementation at one step: their processes follow each other, a number after the other; runs of their own tell the class
    of their errors."""
    runs = Runs(lab, "pairs", entry)
    runs.refer()
    groups, scene = _groups(runs), runs.subject.scene
    for number in range(1, lab.settings["processes"][1] + 1):
        for name, kinds in groups.items():
            for dense, contenders in kinds:
                lab.tell(f"{scene}: {name}, process {number}")
                runs.time("pair", scene, name, STEP, contenders, number, dense)
        if number == 1:
            runs.simulate(_own(runs, groups))


def _groups(runs):
    """{setting: [(dense, contenders)]}: who serves it and another one of a pair with it, and is not too slow for that.
    Timed together are dense ones, whose stretch is shorter, other libraries, code without one."""
    dense, found = runs.lab.registry.dense, {}
    for group in runs.layers.values():
        for kind in (False, True):
            mine = [one for one in group if (one.variant in dense) == kind]
            if kind and 2 * runs.subject.loops + 2 > DENSE:
                for one in mine:
                    runs.lab.skip(runs.run_cell(one, "default", STEP), "excluded", f"a dense step of more than {DENSE} variables takes too long")
                continue
            quick = runs.quick(runs.subject.scene, STEP, mine, BEHIND, kind)
            for name, mine in _serving(runs, [one for one in mine if one in quick]).items():  # in the order of the registry
                found.setdefault(name, []).append((kind, mine))
    return found


def _serving(runs, contenders):
    """{setting: those that serve it and another one of a pair with it}"""
    asked = [both for pairs in PAIRS.values() for both in pairs if set(both) <= set(runs.settings)]
    serving = gather((name, one) for both in asked for one in runs.serving(both[0], runs.serving(both[1], contenders)) for name in both)
    return {name: [one for one in contenders if one in some] for name, some in serving.items()}


def _own(runs, groups):
    """Runs of everyone who was timed; of one implementation all over the same duration."""
    rows = runs.measured().loc[lambda rows: (rows.status == "ok") & (rows.role == "pair")]
    slowest = rows.groupby("implementation").step_us.max()
    return [(one, name, STEP, runs.subject.scene, duration) for name, kinds in groups.items() for _, contenders in kinds
            for one in contenders if one.name in slowest.index
            for duration in [runs.duration(1e-6 * slowest[one.name] / STEP)] if duration]
