# Families of real mechanisms at their own fill: who is fastest on each, by size, in both forms of the step.
from analysis.core.files import RULE, read_json
from analysis.core.timing import LEFT_OUT
from analysis.families.rule import shape
from analysis.families.tables import SCHEMES
from study.core.cell import Cell
from study.core.contest import Form, about, contests, controls_of, elsewhere, times_of, usual
from study.core.profile import by_share
from study.core.setting import Setting

SETTINGS = {"scenes": [str], "processes": dict.fromkeys(SCHEMES, int), "samples": int}
FAR = 8.0  # times the fastest library
STEPS = 100  # of the stretch that is timed, but on the four-bar: others take about the same passes all along
LOOK, PROCESSES = 40, 3  # steps of a look; processes where a step takes long
SHORT_S, LONG_S = 0.002, 0.01  # of a step: up to the one the four-bar keeps its stretch, above the other stretches are shorter
MOST_S = 0.25  # of a step, beyond which a form is not timed: the gate, in long double, would take longer than all else
FLOPS, ENTRIES = 2e-9, 2e-8  # s a step, about, for one operation of `mbs describe` and one non-zero of L


def mechanisms(lab):
    listed = lab.settings["scenes"]
    controls = controls_of(listed)
    here, looks, compared = usual(lab), {}, read_json(RULE).get("candidates", {})  # the next rule needs their times where others were faster
    for scene, record in zip(listed, about(lab, listed)) if here else []:
        elsewhere(lab, Cell("bench", scene, role="penalty-look"))
        forms = []
        for scheme in SCHEMES:
            setting, step_s = Setting(scheme), expected(record, scheme)
            chosen = [one for one in here if lab.registry.serves(one.variant, *setting.needs)]
            behind = [one for one in chosen if falling(one.name, looks.get((shape(scene), scheme), []))]
            for one in chosen if step_s > MOST_S else behind:
                lab.skip(Cell("bench", scene, (one,), role=f"{scheme}-look{LEFT_OUT}"), "excluded",
                         f"a step would take above {MOST_S:g} s" if step_s > MOST_S else
                         f"on smaller ones of the family more than {FAR:g} times as slow as the fastest library, and more so with size")
            if step_s > MOST_S:
                continue
            shorter = LONG_S / max(step_s, LONG_S)
            look = max(4, round(LOOK * shorter))
            processes = lab.settings["processes"][scheme]
            forms.append(Form(scheme, [one for one in chosen if one not in behind], min(processes, PROCESSES if shorter < 1 else 99),
                              lab.settings["samples"], setting.words(), compared.get(scheme, ()), look=look,
                              patience=max(1.0, 2 * look * step_s),
                              stretch=() if scene.startswith("four-bar:") and step_s < SHORT_S else ("--steps", max(4, round(STEPS * shorter)))))
        for form, rows in zip(forms, contests(lab, scene, forms, own=lab.registry.own, control=scene in controls)):
            looks.setdefault((shape(scene), form.role), []).append(multiples(rows, lab.registry.libraries))


def expected(record, scheme):
    """s a step, about: by what the program counts of the factorization; infinite where that was too much to count."""
    if not record.done:
        return 0.0
    order = record.output["elimination"]["orderings"]["AMD" if scheme == "penalty" else "saddle-point"]
    return FLOPS * order["flops"] + ENTRIES * order["factor_nonzeros"] if order else float("inf")


def multiples(rows, libraries):
    """{name: time of the look over the fastest library's}; of who was left out as too slow: infinite."""
    times = times_of(rows)
    slow = dict.fromkeys(rows[rows.status == "slower"].implementation, float("inf"))
    return slow | (times / times[times.index.isin(libraries)].min()).dropna().to_dict()


def falling(name, before):
    """Whether somebody falls behind the libraries in the looks of smaller sizes."""
    known = [one[name] for one in before if name in one]
    return known[-1:] == [float("inf")] or len(known) > 1 and known[-1] > FAR and known[-1] > known[-2]


columns, run = by_share({"mechanisms": (1.0, mechanisms)})
