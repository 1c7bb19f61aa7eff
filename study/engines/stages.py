# The stages of study/run --engines: what is chosen, the gate of ours, curves of ours and theirs, common rounds.
import argparse
from dataclasses import dataclass

from analysis.engines.equal_error import errors_of, table
from study.accuracy_study import bench, estimate, stages as accuracy, subjects as references, work
from study.accuracy_study.settings import Entries, LIST as OUR_LIST
from study.engines import curves, programs, rounds, settings, subjects
from study.pipeline.contenders import from_json
from study.pipeline.layout import read_run, write_csv
from study.pipeline.prepare import digest, registry, start_named
from study.pipeline.progress import Teller

LOOPS = (1, 2, 5, 10, 20, 40)
CURVE_S = 3.0    # of the time limit: a setting's curves of one size, long and short, and its share of the rounds


@dataclass(frozen=True)
class Place:
    """Where runs are made."""
    engines: programs.Bench
    ours: bench.Bench
    entries: Entries
    listed: dict  # {engine: [Setting]}

    def setting_of(self, engine, name):
        return next(one for one in self.listed[engine] if one.name == name)


def choose(options):
    """(Choice of study/accuracy, {engine: [Setting]})"""
    settings.need_known(options.engines)
    listed = settings.read_list()
    wanted = argparse.Namespace(only=options.only, problems=["none"], loops=options.loops or LOOPS,
                                parts=("work",), duration=options.duration, time_limit=options.time_limit)
    return accuracy.choose(wanted, registry()), {
        engine: found for engine, found in listed.items() if not options.engines or engine in options.engines}


def sentence(choice, listed):
    """How long it may take, on a quiet machine."""
    number, seconds = estimate.total(choice)
    settings_count = sum(map(len, listed.values()))
    theirs = CURVE_S * choice.time_limit * settings_count * len(choice.loops["work"])
    return (f"{len(listed)} engines, {settings_count} settings, beside {len(choice.served)} implementations, "
            f"{number} curves: about {max(1, round((1.3 * seconds + theirs) / 60))} minutes on a quiet machine")


def run(layout, options):
    """Everything that `options` choose; tables in the results directory."""
    import pandas
    (choice, listed), missing, tell = choose(options), programs.built(), Teller()
    start_named(layout, "engines", options.only, {
        "duration": options.duration, "time_limit": options.time_limit, "engines": list(listed),
        OUR_LIST.name: digest(OUR_LIST), f"engines/{settings.LIST.name}": digest(settings.LIST)} | {
        f"engine_{engine}": missing.get(engine) or digest(programs.program(engine)) for engine in listed})
    print(sentence(choice, listed), flush=True)
    for engine in listed:
        if missing.get(engine):
            print(f"{engine}: left out, {missing[engine]}", flush=True)

    def store(name, rows):
        write_csv(layout.results / f"{name}.csv", pandas.DataFrame(rows))
    place = _place(layout, choice, listed, store, tell)
    measured = subjects.all_of(choice.loops["work"], choice.duration)
    store("references", references.rows(measured))
    found = {"engines": [], "work": [], "rounds": []}
    for subject in measured:
        theirs = pandas.DataFrame(curves.measure(place.engines, subject, listed, missing, tell))
        for column in ("time", "error"):  # of a subject that nobody finishes
            theirs[column] = theirs.get(column, float("nan"))
        ours = work.measure(place.ours, subject, place.entries, tell, errors_of(theirs))
        compared = pandas.DataFrame(rounds.measure(subject, theirs, ours, place, tell))
        for name, one in zip(found, (theirs, ours, compared)):
            found[name].append(one)
            store(name, pandas.concat(found[name], ignore_index=True))
    tell.end()
    store("equal_error", table(*(pandas.concat(found[name], ignore_index=True) for name in found)))


def _place(layout, choice, listed, store, tell):
    recorded = read_run(layout)
    ours = bench.Bench(layout, recorded["contexts"], choice.time_limit)
    contenders = {one.variant: one for one in from_json(recorded["contenders"]).values()
                  if one.ranked and not one.missing}
    entries = accuracy.admit(ours, contenders, choice, store, tell)
    return Place(programs.Bench(layout, choice.time_limit), ours, entries, listed)
