# The stages of study/accuracy: what is chosen, how long it may take, gate, curves, regions, pairs.
from dataclasses import dataclass

from analysis.accuracy.tangents import tangents
from analysis.accuracy.winners import winners
from study.accuracy_study import bench, estimate, fills, gate, pairs, regions, settings, subjects, work
from study.pipeline.contenders import from_json, own
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import need_steps
from study.pipeline.prepare import digest, digest_of_scene, registry, select, start_named
from study.pipeline.progress import Teller
from study.scenes import problems
from study.scenes.main import _choose as choose_problems

LOOPS = (2, 10, 40, 200)


@dataclass(frozen=True)
class Choice:
    """What is to be done."""
    parts: tuple
    loops: dict       # {part: sizes of the N-four-bar}
    problems: list    # those of study/problems.yaml that are not N-four-bars
    served: dict      # {variant: [Setting]}
    dense: dict       # {variant: bool}
    own: frozenset    # variants that stand on no library
    duration: float
    time_limit: float


def choose(options, known):
    names = select(known, options.only)
    need_steps(options.duration, [min(subjects.STEPS)])
    wanted = choose_problems(problems.read_list()[1], options.problems)
    chains = [one.name for one in wanted if one.scene.startswith("four-bar:")]
    if options.problems and chains:
        raise StudyError(f"--problems: {chains[0]} is an N-four-bar: name its size with --loops")
    sizes = {"work": LOOPS, "regions": regions.LOOPS, "forms": pairs.FORM_LOOPS,
             "precision": pairs.PRECISION_LOOPS}
    if options.loops:
        sizes = {part: tuple(sorted(set(options.loops))) for part in sizes}
    offers = settings.variants(known)
    return Choice(tuple(options.parts), sizes,
                  [one for one in wanted if not one.scene.startswith("four-bar:")]
                  if "work" in options.parts else [],
                  settings.served(known, settings.read_list(), names),
                  {name: bool(offers[name].get("dense")) for name in names}, frozenset(own(known)),
                  options.duration, options.time_limit)


def sentence(choice):
    curves, seconds = estimate.total(choice)
    return (f"{len(choice.served)} implementations, {curves} curves: about "
            f"{max(1, round(seconds / 60))} minutes on a quiet machine")


def run(layout, options):
    """Everything that `options` choose; tables in the results directory."""
    import pandas
    choice, tell = choose(options, registry()), Teller()
    start_named(layout, "accuracy", options.only, {
        "duration": options.duration, "time_limit": options.time_limit,
        settings.LIST.name: digest(settings.LIST), problems.LIST.name: digest(problems.LIST)} | {
        one.scene: digest_of_scene(one.scene) for one in problems.read_list()[1]})
    recorded = read_run(layout)
    print(sentence(choice), flush=True)
    place = bench.Bench(layout, recorded["contexts"], choice.time_limit)
    contenders = {one.variant: one for one in from_json(recorded["contenders"]).values()
                  if one.ranked and not one.missing}

    def store(name, rows):
        write_csv(layout.results / f"{name}.csv", pandas.DataFrame(rows))
    entries = admit(place, contenders, choice, store, tell)
    tables = _work(place, entries, choice, store, tell)
    if "regions" in choice.parts:
        store("fills", fills.check(place, entries, tell))
        found = regions.measure(place, tables, entries, choice.loops["regions"], tell)
        store("regions", found)
        store("winners", winners(found))
    if "pairs" in choice.parts:
        for kind, both in (("forms", pairs.FORMS), ("precision", pairs.PRECISIONS)):
            store(kind, pairs.measure(place, entries, kind, both, choice.loops[kind], tell))
    tell.end()


def admit(place, contenders, choice, store, tell):
    """The gate of every setting; Entries with what it refuses."""
    rows = []
    for setting in settings.read_list():
        group = [one for name, one in contenders.items() if setting in choice.served[name]]
        if group:
            tell(f"gate: {setting.name}")
            rows += gate.check(place, setting, group)
    store("gate", rows)
    return settings.Entries(contenders, choice.dense, {name: choice.served[name] for name in contenders},
                            gate.refused(rows), choice.own)


def _work(place, entries, choice, store, tell):
    """work.csv and references.csv; regions need curves of their sizes, too."""
    import pandas
    loops = {count for part in ("work", "regions") if part in choice.parts
             for count in choice.loops[part]}
    measured = [subjects.chain(count, choice.duration) for count in sorted(loops)]
    lost = []
    compared = problems.compared_of(problems.read_list()[0], list(entries.contenders))
    for problem in choice.problems:
        tell(f"{problem.name}: reference")
        try:
            measured.append(subjects.problem(problem, place, settings.read_list()[0],
                                             entries.contenders[compared[0]]))
        except StudyError as error:
            lost.append({"subject": problem.name, "title": problem.title, "reference": f"none: {error}"})
    store("references", pandas.DataFrame(subjects.rows(measured) + lost, columns=subjects.COLUMNS))
    tables = [work.measure(place, subject, entries, tell) for subject in measured]
    table = pandas.concat(tables, ignore_index=True) if tables else pandas.DataFrame(
        columns=["subject", "implementation", "setting", "step", "status", "error", "time", "rounds"])
    store("work", table)
    store("tangents", tangents(table))
    return table
