# study/merge SET SET …: which winners and equivalence sets hold on all machines, which depend on the processor.
import base64
from pathlib import Path

import matplotlib.pyplot as plt
import pandas
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from analysis.core.files import ROOT, StudyError, write_json, write_text
from analysis.core.registry import ANCHOR
from analysis.core.site import template
from analysis.core.style import Look, number_axis, save
from analysis.core.text import layout
from study.core.options import Parser, directory
from study.core.studyset import opened
from study.tools.merge import agreement, machine

HERE = Path(__file__).parent
ORDER = {"differs": 0, "open": 1, "several": 2, "decided": 3}  # of rows: what a reader looks for comes first


def merge(arguments):
    parser = Parser(prog="study/merge", description="Merges sets of one commit and the same libraries, from several machines (or days): "
                    "a page and a table of what holds on all of them.")
    parser.add_argument("sets", nargs="+", type=directory, metavar="SET", help="directories of two sets or more")
    parser.add_argument("--to", type=directory, default=ROOT / "results" / "local" / "merged", metavar="DIR",
                        help="where page and table go (results/local/merged)")
    parser.add_argument("--fresh", type=directory, metavar="SET", help="a further set: in how many decided cells does it have the same winner?")
    parser.add_argument("--other-builds", action="store_true", help="sets of other commits, libraries or changed trees too: do they say the same?")
    options = parser.parse_args(arguments)
    if len(options.sets) < 2:
        raise StudyError("needs two sets or more")
    sets = [opened(folder) for folder in options.sets]
    fresh = opened(options.fresh) if options.fresh else None
    seen = {}  # {digest of records: whose}
    for one in filter(None, (*sets, fresh)):
        need_alike(sets[0], one, options.other_builds)
        for records in machine.origins(one):
            if (known := seen.setdefault(records, one)) is not one:
                raise StudyError(f"{one.folder} holds records of {known.folder}: it is that set or a copy, and says nothing new")
    if options.to.exists() and any(options.to.iterdir()) and not (options.to / "agreement.csv").exists():
        raise StudyError(f"{options.to} is not empty and holds no merged sets: name another directory with --to")
    agreed, alone = agreement.agreements(sets)
    if not agreed:
        raise StudyError("the sets have no question in common: each needs the map or the families")
    machines = labels(sets)
    spread = agreement.components(agreed, [one.facts["context"]["machine"] for one in sets])
    if "day" in spread:
        agreed = [one._replace(day=(spread["day"][0] / 100) ** 2) for one in agreed]
    sure = agreement.sure(agreed)
    table = pandas.DataFrame(row(one, machines) | {"sure": one.question in sure} for one in agreed)
    counts = {layer: {verdict: (int((rows.verdict == verdict).sum()), int(rows.sure[rows.verdict == verdict].sum())) for verdict in ORDER}
              for layer, rows in table.groupby("layer", sort=False)}
    options.to.mkdir(parents=True, exist_ok=True)
    write_text(options.to / "agreement.csv", table.to_csv(index=False))
    libraries = agreement.mechanisms(sets, agreed)
    about = [{"label": label, "facts": one.facts, "rates": machine.rates(one), "controls": machine.controls(one)} for label, one in zip(machines, sets)]
    known = {"counts": counts, "layers": agreement.LAYERS, "held": agreement.held(agreed, fresh) if fresh else {},
             "spread": {agreement.SOURCES[source]: one for source, one in spread.items()}}
    write_text(options.to / "index.html", template(HERE / "page.html.j2").render(
        known, machines=about, alone=alone, fresh=fresh.facts if fresh else None, rates=machine.RATES,
        rows=table.sort_values("verdict", key=lambda one: one.map(ORDER), kind="stable").to_dict("records"), own=sets[0].registry.own,
        gains={name: one for name, one in machine.beside(sets).items() if name in sets[0].registry.variants}, anchor=ANCHOR, day="day" in spread,
        mechanisms=agreement.shares(libraries), claims=machine.claims(sets), figure=_drawn(libraries, sets, options.to / "mechanisms.svg")))
    if fresh:
        write_json(options.to / "fresh.json", {"sets": [one.folder.name for one in sets], "run": _about(fresh), "held": known["held"]})
    print(layout(HERE / "said.txt.j2").render(known, labels=machines, page=options.to / "index.html", agreed={
        layer: [one for one in agreed if one.question.layer == layer] for layer in counts}))


def _drawn(libraries, sets, path):
    """The picture's file in base 64; None without mechanisms. A mark a mechanism, by size and non-zeros a column of its factor, in the colour of the
    library that loses least on the machine where it is worst; hatched where no library is among the best on all machines."""
    if not libraries:
        return None
    features = machine.table(sets[0].folder, "families", "mechanisms").set_index("scene").reindex([one.question.scene for one in libraries])
    look, shown = Look(sets[0].registry), {}
    figure, axes = plt.subplots(figsize=(8.6, 5.4))
    for one in filter(lambda one: one.robust, libraries):
        known, colour = features.loc[one.question.scene], look.colour(one.robust)
        shown[one.robust] = colour
        differs = one.verdict == "differs"
        axes.scatter(known.n, known.per_column, s=70, facecolor="white" if differs else colour, edgecolor=colour, hatch="/////" if differs else None)
    for axis in (axes.xaxis, axes.yaxis):
        number_axis(axis)
    axes.set(xlabel="variables n", ylabel="non-zeros a column of the factor L (AMD's order)", title="The library that loses least on the machine where it is worst")
    axes.grid(True, which="major")
    axes.set_axisbelow(True)
    handles = [Line2D([], [], marker="o", linestyle="none", markersize=8, color=colour, label=name) for name, colour in sorted(shown.items())]
    hatched = Patch(facecolor="white", edgecolor="#444444", hatch="/////", label="depends on the machine")
    axes.legend(handles=[*handles, hatched], loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    save(figure, path, "; ".join(f"{one.facts['context']['cpu_model']}, {one.facts['date'][:10]}" for one in sets))
    plt.close(figure)
    return base64.b64encode(path.read_bytes()).decode()


def _about(fresh):
    """What tells a run that is not stored: the digests are of its records, a column each."""
    context = fresh.facts["context"]
    return {"processor": context["cpu_model"], "commit": context["commit"], "date": fresh.facts["date"], "profile": fresh.facts["profile"],
            "records": sorted(machine.origins(fresh))}


def need_alike(first, other, builds=False):
    """StudyError naming why two sets are not to be merged. `builds`: they may be of other ones."""
    why = machine.no_evidence(other)
    what = f"{other.folder} is no evidence: {why}" if why else "" if builds else agreement.unlike(first, other)
    if what:
        raise StudyError(f"{what}: such sets are not merged")


def labels(sets):
    """A name for each: its processor, its date where two have the same, and its folder where these are the same too."""
    names = [one.facts["context"]["cpu_model"] for one in sets]
    for more in ([one.facts["date"] for one in sets], [one.folder for one in sets]):
        names = [f"{name}, {its}" if names.count(name) > 1 else name for name, its in zip(names, more)]
    return names


def row(one, machines):
    found = {"part": one.question.part, "scene": one.question.scene, "form": one.question.form, "layer": one.question.layer,
             "variables": one.question.variables, "verdict": one.verdict, "common": " ".join(one.common), "robust": one.robust,
             "worst": one.worst.get(one.robust)}
    for place, label in enumerate(machines):
        margin = one.machines[place].margin
        found |= {f"winner: {label}": one.winners[place], f"margin: {label}": margin.value, f"low: {label}": margin.low,
                  f"high: {label}": margin.high, f"inside: {label}": " ".join(one.sets[place])}
    return found
