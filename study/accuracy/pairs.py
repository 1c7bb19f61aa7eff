# Two settings of one implementation at one step: their processes follow each other, a number after the other; runs of
# their own tell the class of their errors.
from analysis.accuracy.pairs import PAIRS, STEP
from study.accuracy.runs import Runs


def run(lab, entry):
    runs = Runs(lab, "pairs", entry)
    runs.refer(None)
    groups = _groups(runs)
    scene = runs.subject.scene
    for number in range(1, lab.settings["processes"][1] + 1):
        for name, contenders in groups.items():
            for mine in _kinds(runs, contenders):
                lab.tell(f"{scene}: {name}, process {number}")
                runs.time("pair", scene, name, STEP, mine, number, mine[0].variant in lab.registry.dense)
        if number == 1:
            runs.simulate(_own(runs, groups))


def _groups(runs):
    """{setting: contenders that serve it and another one of a pair with it}"""
    found = {}
    contenders = [one for group in runs.layers.values() for one in group]
    for pairs in PAIRS.values():
        for both in pairs:
            if set(both) <= set(runs.settings):
                serving = runs.serving(both[0], runs.serving(both[1], contenders))
                for name in both:
                    found[name] = found.get(name, []) + [one for one in serving if one not in found.get(name, [])]
    return found


def _kinds(runs, contenders):
    """Those who are timed together: dense ones, whose stretch is shorter, other libraries, code without one."""
    dense, own = runs.lab.registry.dense, runs.lab.registry.own
    kinds = {}
    for one in contenders:
        kinds.setdefault((one.variant in dense, one.variant in own), []).append(one)
    return kinds.values()


def _own(runs, groups):
    """Runs of everyone who was timed, as long as they are not too long."""
    timed = runs.measured()
    times = timed[timed.status == "ok"].drop_duplicates(["implementation", "setting"]).set_index(["implementation", "setting"])
    jobs = []
    for name, contenders in groups.items():
        for one in contenders:
            if (one.name, name) in times.index:
                duration = runs.duration(1e-6 * times.step_us[one.name, name] / STEP)
                if duration:
                    jobs.append((one, name, STEP, runs.subject.scene, duration))
    return jobs
