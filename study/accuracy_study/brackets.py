# Steps between those of a curve: halvings that just miss a required error would cost a factor of two.
from analysis.accuracy.front import FINISHED, fastest
from study.accuracy_study.bench import row

# Of the longer of two steps: half-way on a logarithmic scale, nearly, and the times at which errors are judged
# stay multiples of it (below 5 ms).
BETWEEN = 2 / 3
WORTH = 2.0  # the shorter step meets the error in at most this times the least time of all


def refine(bench, subject, entries, table, errors, tell):
    """The rows of runs between the two steps that bracket one of `errors`, of curves near the fastest there."""
    chosen = dict.fromkeys(place for error in errors for place in _places(table, error))
    found = []
    for number, (variant, name, step) in enumerate(chosen, start=1):
        tell(f"{subject.name}: between steps, {number} of {len(chosen)}")
        setting = entries.setting(variant, name)
        record = bench.steady("work", subject, entries.contenders[variant], setting, step)
        found.append(row(subject, variant, setting, step, record))
    return found


def _places(table, error):
    """(implementation, setting, step) between the longest step that meets `error` and the next longer one."""
    best = fastest(table, error) if "error" in table else None
    if best is None:
        return
    for (variant, name), curve in table[table["rounds"] > 0].groupby(["implementation", "setting"], sort=False):
        meeting = curve[curve.status.isin(FINISHED) & (curve.error <= error)]
        if meeting.empty:
            continue
        finer = meeting.loc[meeting.step.idxmax()]
        longer = curve.step[curve.step > 1.001 * finer.step]
        if len(longer) and finer.time <= WORTH * best.time:
            yield variant, name, float(f"{BETWEEN * longer.min():g}")
