# study/merge SET SET …: which winners and equivalence sets hold on all machines, which depend on the processor.
from pathlib import Path

import pandas

from analysis.core import schema, site
from analysis.core.files import ROOT, StudyError, write_json, write_text
from analysis.core.gather import gather
from analysis.core.registry import ANCHOR
from analysis.core.text import layout
from analysis.core.view import View, parts
from analysis.map.carry import SOURCES
from analysis.map.ledger import beside
from study.core.options import Parser, directory
from study.core.studyset import opened
from study.tools.merge import agreement, machine

HERE = Path(__file__).parent
ORDER = {"differs": 0, "open": 1, "several": 2, "decided": 3}  # of rows: what a reader looks for comes first


def merge(arguments):
    parser = Parser(prog="study/merge", description="Merges sets of one commit and the same libraries, from several machines (or days): "
                    "pages and a table of what holds on all of them.")
    parser.add_argument("sets", nargs="+", type=directory, metavar="SET", help="directories of two sets or more")
    parser.add_argument("--to", type=directory, default=ROOT / "results" / "local" / "merged", metavar="DIR",
                        help="where pages and table go (results/local/merged)")
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
    about = [{"label": label, "facts": one.facts, "rates": machine.rates(one), "controls": machine.controls(one),
              "spread": dict(machine.table(one.folder, "map", "spread")[["source", "percent"]].values)} for label, one in zip(machines, sets)]
    known = {"counts": counts, "layers": agreement.LAYERS, "held": agreement.held(agreed, fresh) if fresh else {},
             "spread": {agreement.SOURCES[source]: one for source, one in spread.items()}}
    write_text(options.to / "index.html", site.template(HERE / "page.html.j2").render(
        known, part="index", parts=_pages(sets, about, agreed, options.to), title="What holds on several machines?", machines=about,
        alone=alone, fresh=fresh.facts if fresh else None, rates=machine.RATES,
        rows=table.sort_values("verdict", key=lambda one: one.map(ORDER), kind="stable").to_dict("records"), own=sets[0].registry.own,
        gains={name: one for name, one in machine.beside(sets).items() if name in sets[0].registry.variants}, anchor=ANCHOR, day="day" in spread,
        mechanisms=agreement.shares(libraries), claims=beside([machine.table(one.folder, "map", "claims") for one in sets]), sources=SOURCES))
    if fresh:
        write_json(options.to / "fresh.json", {"sets": [one.folder.name for one in sets], "run": _about(fresh), "held": known["held"]})
    print(layout(HERE / "said.txt.j2").render(known, labels=machines, page=options.to / "index.html", agreed={
        layer: [one for one in agreed if one.question.layer == layer] for layer in counts}))


def _pages(sets, machines, agreed, to):
    """Writes a page for each part that all have, with what each set's own page says and its figures; {part: question} of these."""
    verdicts = gather((one.question.layer, one) for one in sorted(agreed, key=lambda one: one.question.form, reverse=True))  # penalty last
    verdicts = {layer: {one.question.scene: one.verdict for one in some} for layer, some in verdicts.items()}
    pages = {part: question for part, question in parts().items() if all((one.folder / part / schema.DIGESTS).exists() for one in sets)}
    said = [site.answers_of(one.folder) for one in sets]
    for part, question in pages.items():
        more = {"agreed": verdicts} if part in machine.PARTS else {}
        drawn = [site.draw(machine.tables(one.folder, part), View(one.folder, part), to / part / f"{place}", **more)
                 for place, one in enumerate(sets, 1)]
        write_text(to / f"{part}.html", site.template(HERE / "part.html.j2").render(
            part=part, parts=pages, title=question, machines=machines, drawn=drawn, said=[one[part] for one in said]))
    return pages


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
