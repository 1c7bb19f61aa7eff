# Reads the CSV of `mbs simulate --trajectory`, however long: only the rows that are shown are kept.
import os
from collections import Counter, namedtuple
from contextlib import contextmanager

import numpy

from analysis.core.files import StudyError

CURVES = ("kinetic_energy", "potential_energy", "constraint_violation")
LONGEST = 2**24  # bytes that are read of a line: a hundred times what the largest scenes need
START_TOLERANCE = 1e-3  # of the scene's extent: a start farther off is another scene's


# positions: (frames, points, dimension), m; curves: the columns of CURVES by name, one value a frame, or {} if the file lacks them; outputs: the
# scene's own by name, each {column: one value a frame}.
Motion = namedtuple("Motion", "times positions curves outputs")


def read(path, scene, frames, outputs=None):
    """The Motion in the CSV of `mbs simulate --trajectory`, and in that of its `--output`, whose rows are at the same times: about `frames` of
    them, equally spaced, and the last. A frame's constraint violation is the largest of all rows since the frame before."""
    with _opened(path) as (file, columns):
        places, curves = _places(path, columns, scene)
        table, largest = _table(path, file, columns, frames)
    positions = table[:, places].reshape(len(table), len(scene.points), scene.dimension)
    motion = Motion(table[:, 0], positions, {name: table[:, place] for name, place in zip(CURVES, curves)}, {})
    if curves:
        motion.curves["constraint_violation"] = largest[:, curves[-1]]
    _same_start(path, motion, scene)
    if outputs:
        with _opened(outputs) as (file, columns):
            table, _ = _table(outputs, file, columns, frames)
        motion.outputs.update({name: {column: table[:, place] for place, column in enumerate(columns) if name in (
            column, column.rpartition(".")[0])} for name in scene.outputs})
    return motion


@contextmanager
def _opened(path):
    """(the file at `path`, names of its columns); StudyError if it cannot be read, or is a device or a pipe, which may have no end and cannot
    be read twice."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise StudyError(f"{path} is no regular file")
    try:
        with open(path, "rb") as file:
            yield file, _columns(path, file.readline(LONGEST))
    except OSError as error:
        raise StudyError(f"cannot read {path}: {error.strerror}") from error


def _columns(path, line):
    if not line.strip():
        raise StudyError(f"{path} is empty: it must be the CSV of `mbs simulate --trajectory`")
    columns = line.decode("utf-8", "replace").rstrip("\r\n").split(",")
    if columns[0] != "t":
        raise StudyError(f"{path} is no trajectory: its first column is {columns[0][:40]!r}, "
                         "not t (write one with `mbs simulate SCENE --trajectory FILE`)")
    if doubled := [name for name, count in Counter(columns).items() if count > 1]:
        raise StudyError(f"{path} has the column {doubled[0]} more than once")
    return columns


def _places(path, columns, scene):
    """Columns of all positions, point by point, then of CURVES if they are there."""
    place = {name: index for index, name in enumerate(columns)}
    wanted, speeds = ([f"{name}.{v}{axis}" for name, _ in scene.points for axis in "xyz"[:scene.dimension]] for v in ("", "v"))
    missing = [name for name in wanted if name not in place]
    foreign = sorted(place.keys() - {"t", *CURVES, *wanted, *speeds}, key=place.get)
    if missing or foreign:
        what = f"it lacks the column {missing[0]}" if missing else f"it has the column {foreign[0]}"
        more = len(missing or foreign) - 1
        raise StudyError(f"{path} is a trajectory of another scene than {scene.name}: {what}" + (f" and {more} more" if more else ""))
    found = [name for name in CURVES if name in place]
    if found and len(found) < len(CURVES):
        raise StudyError(f"{path} has {found[0]} but not all of {', '.join(CURVES)}")
    return [[place[name] for name in names] for names in (wanted, found)]


def _table(path, file, columns, frames):
    """(the rows that are shown, of each the largest values since the one before), two arrays; StudyError naming the line of a row that is not
    whole or does not come after the one before."""
    if (count := sum(1 for _ in _lines(file))) < 2:
        raise StudyError(f"{path} has {count} row(s): a motion needs two at least")
    every, shown, largest, since, last = max(1, -(-(count - 1) // frames)), [], [], -numpy.inf, -numpy.inf
    for row, line in enumerate(_lines(file)):
        try:
            values = numpy.array(line.split(b","), dtype=float)
        except ValueError:
            values = numpy.empty(0)
        if len(values) != len(columns) or not numpy.isfinite(values).all():
            raise StudyError(f"{path}, line {row + 2}: not {len(columns)} finite numbers, as the header has columns: is the file complete?")
        if values[0] <= last:
            raise StudyError(f"{path}, line {row + 2}: the time {values[0]:g} s does not come after {last:g} s")
        last, since = values[0], numpy.maximum(since, values)
        if row % every == 0 or row == count - 1:
            shown.append(values)
            largest.append(since)
            since = -numpy.inf
    return numpy.array(shown), numpy.array(largest)


def _lines(file):
    """Of the rows below the header. One that is too long comes in pieces, which are no rows."""
    file.seek(0)
    file.readline(LONGEST)
    return iter(lambda: file.readline(LONGEST), b"")


def _same_start(path, motion, scene):
    """A trajectory from t = 0 must start where the scene does."""
    start = numpy.asarray(scene.start, dtype=float)
    if motion.times[0] != 0 or not len(start):
        return
    away = numpy.abs(motion.positions[0] - start).max(axis=1)
    worst = int(away.argmax())
    if away[worst] > START_TOLERANCE * max(numpy.ptp(start, axis=0).max(), 1e-12):
        raise StudyError(f"{path} is a trajectory of another scene than {scene.name}: {scene.points[worst][0]} starts {away[worst]:.3g} m away "
                         "from where the scene has it")
