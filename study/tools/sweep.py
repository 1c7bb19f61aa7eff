# study/sweep: what a table of `mbs sweep` shows. All parameters with one result, and that over two of them. With --cluster the table is made
# first: its parts as an array job of a cluster.
import os
import re
import shlex
import subprocess
import time
import zlib
from pathlib import Path

import matplotlib.pyplot as plt
import numpy
import pandas
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from scipy.stats import binned_statistic_2d

from analysis.core import style
from analysis.core.files import ROOT, StudyError, digest, write_text
from analysis.core.outcomes import FINISHED
from study.core import locks
from study.core.cluster import end_jobs, profile_folder, state
from study.core.executor import USAGE, program_of
from study.core.front import Display
from study.core.node import home
from study.core.options import Parser

LINES = 2000  # of parallel coordinates, at most, of finished lanes and of failed ones
PARTS = 16    # of a sweep on a cluster
CELLS = 40    # of a surface along a parameter, at most
LATENCY = 60  # s until a file of a node is seen here: as study/cluster/slurm has it for study/run
FAILED = "#c9403a"


def sweep(arguments):
    parser = Parser(prog="study/sweep", description="Draws the table of `mbs sweep`: parallel coordinates of what was varied, "
                    "and one result over two of the parameters. Lanes that failed are red.")
    parser.add_argument("table", help="TABLE.csv or TABLE.csv.gz")
    parser.add_argument("--output", metavar="FILE.png", help="the picture (TABLE.png, here)")
    parser.add_argument("--of", metavar="COLUMN", help="the result that is shown (the first output, else the violation)")
    parser.add_argument("--over", nargs=2, metavar="PARAMETER", help="the two of the surface (the first two that vary)")
    parser.add_argument("--cluster", metavar="PROFILE", help="make the table first, on a cluster (study/cluster/README.md): "
                        "study/sweep TABLE --cluster slurm --parts K -- SCENE and what mbs sweep takes")
    parser.add_argument("--parts", type=int, metavar="K", help=f"jobs of its array ({PARTS})")
    here = arguments.index("--") if "--" in arguments else len(arguments)
    options, words = parser.parse_args(arguments[:here]), arguments[here + 1:]
    if (options.cluster is None) != (not words):
        raise StudyError("found one of --cluster PROFILE and -- SCENE …, allowed are both or none (see study/sweep --help)")
    if options.parts is not None and (options.parts < 1 or not words):
        raise StudyError(f"--parts: found {options.parts}{'' if words else ' without --cluster'}, allowed is 1 or more, with --cluster")
    if words:
        on_cluster(words, options.table, options.parts or PARTS, profile_folder(options.cluster))
    table, parameters, result = read(options.table, options.of)
    over = options.over or [name for name in parameters if table[name].nunique() > 1][:2] or parameters[:1]
    if unknown := [name for name in over if name not in parameters]:
        raise StudyError(f"--over: found {unknown[0]!r}, allowed are {', '.join(parameters)}")
    name = options.output or re.sub(r"(\.csv)?(\.gz)?$", "", Path(options.table).name) + ".png"
    if not name.endswith(".png") or Path(name).resolve() == Path(options.table).resolve():
        raise StudyError(f"--output: found {name!r}, allowed is another file that ends with .png")
    figure, (left, right) = plt.subplots(1, 2, figsize=(5 + 1.2 * len(parameters) + 6, 5), layout="constrained",
                                         width_ratios=(4 + 1.2 * len(parameters), 6))
    lines(left, table, [*parameters, result])
    if len(over) == 2:
        surface(right, table, over, result)
    else:
        curve(right, table, over[0], result)
    style.save(figure, name)
    failed = int((~table["finished"]).sum())
    print(f"{name}: {result} of {len(table)} lanes" + (f", {failed} of them failed" if failed else ""))


def read(path, of):
    """(table with a column `finished`, names of parameters, name of the result). Raises StudyError."""
    try:
        table = pandas.read_csv(path)
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise StudyError(f"{path}: no table can be read ({' '.join(str(error).split())[:150]})") from error
    names = [*table.columns]
    if "status" not in names[1:] or not len(table):
        raise StudyError(f"{path}: found no lanes, allowed is a table of `mbs sweep`")
    parameters = names[:names.index("status")]
    numbers = set(table.select_dtypes("number"))
    results = [name for name in names[names.index("status"):] if name in numbers and table[name].notna().any()]
    outputs = names[names.index("constraint_violation_max") + 1:] if "constraint_violation_max" in names else []
    result = of or next((name for name in outputs if name in results), "constraint_violation_max")
    if result not in results:
        raise StudyError(f"--of: found {result!r}, allowed are {', '.join(results) or 'none: no lane has a result'}")
    if wrong := [name for name in parameters if name not in numbers]:
        raise StudyError(f"{path}: {wrong[0]} has something else than numbers")
    broken = ~numpy.isfinite(table[parameters]).all(axis=1) | table["status"].isna()
    if broken.any():
        raise StudyError(f"{path}, line {broken.argmax() + 2}: found a row that is cut short, allowed are numbers for "
                         f"{', '.join(parameters)}, and a status")
    table["finished"] = table["status"].isin(FINISHED)
    return table, parameters, result


def lines(axes, table, columns):
    """Each lane a line over axes of its own scale; the colour goes by the last column."""
    result, low, high = columns[-1], table[columns].min(), table[columns].max()
    known = counted(table, result)
    low[result], high[result] = table.loc[known, result].min(), table.loc[known, result].max()
    shares = (table[columns] - low) / (high - low).where(high > low, 1)
    shares[result] = shares[result].where(known, -0.12)  # a lane whose result does not count ends below
    places = numpy.arange(len(columns))
    for finished in (True, False):
        chosen = shares[table["finished"] == finished]
        if len(chosen) > LINES:  # at random: rows at one distance go with the periods of a grid
            chosen = chosen.sample(LINES, random_state=0)
        ways = numpy.stack([numpy.broadcast_to(places, chosen.shape), chosen.to_numpy()], axis=2)
        look = ({"array": chosen[result].to_numpy(), "cmap": plt.get_cmap("viridis"), "norm": Normalize(0, 1)} if finished else
                {"color": FAILED})
        axes.add_collection(LineCollection(ways, linewidths=0.8, alpha=min(1, 0.15 + 30 / max(len(ways), 1)), **look, zorder=1 if finished else 2))
    axes.set(xlim=(-0.3, len(columns) - 0.7), ylim=(-0.2, 1.12), xticks=places, yticks=[])
    axes.set_xticklabels(columns, rotation=20, ha="right")
    for place, name in zip(places, columns):
        axes.axvline(place, color="#444444", linewidth=0.8, zorder=3)
        for y, value in ((1.03, high[name]), (-0.06, low[name])):
            axes.text(place, y, f"{value:.4g}", ha="center", fontsize=8, zorder=4, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
    axes.spines[:].set_visible(False)
    shown = min(LINES, int(table["finished"].sum()))
    title = "Lanes" if shown == table["finished"].sum() else f"{shown} of the lanes that finished"
    axes.set_title(title + ("" if table["finished"].all() else "; red: failed"))


def counted(table, result):
    """Which lanes' results count: of those that finished, where there are any. One that failed has that of a part of its motion."""
    there = table[result].notna()
    return there & table["finished"] if (there & table["finished"]).any() else there


def surface(axes, table, over, result):
    """Median of the result in each cell of two parameters; a cross where a lane failed."""
    bins = [edges(table[name].to_numpy()) for name in over]
    known, failed = table[counted(table, result)], table[~table["finished"]]
    values = binned_statistic_2d(known[over[0]], known[over[1]], known[result], "median", bins).statistic
    lost = numpy.argwhere(numpy.histogram2d(failed[over[0]], failed[over[1]], bins)[0])
    axes.figure.colorbar(axes.pcolormesh(*bins, values.T, cmap="viridis"), ax=axes, label=result)
    middles = [(edge[:-1] + edge[1:]) / 2 for edge in bins]
    axes.plot(middles[0][lost[:, 0]], middles[1][lost[:, 1]], "x", color=FAILED, markersize=5)
    axes.set(xlabel=over[0], ylabel=over[1], title=f"{result}, median of a cell" + ("; crosses: lanes failed" if len(lost) else ""))


def edges(values):
    """Of a parameter's cells: one a value where these are few, else of one width, so many that cells of two parameters have some values each."""
    distinct = numpy.unique(values)
    if 1 < len(distinct) <= CELLS:
        inner = (distinct[:-1] + distinct[1:]) / 2
        return numpy.concatenate([[2 * distinct[0] - inner[0]], inner, [2 * distinct[-1] - inner[-1]]])
    return numpy.histogram_bin_edges(values, int(numpy.clip(numpy.sqrt(len(values) / 4), 4, CELLS)) if len(distinct) > 1 else 1)


def curve(axes, table, name, result):
    finished = table[table["finished"]]
    axes.plot(finished[name], finished[result], ".", color="#0b5cad")
    failed = table.loc[~table["finished"], name]
    axes.plot(failed, numpy.zeros(len(failed)), "x", color=FAILED, transform=axes.get_xaxis_transform(), clip_on=False)
    axes.set(xlabel=name, ylabel=result, title=result + ("; crosses: lanes failed" if len(failed) else ""))


def on_cluster(words, table, count, profile):
    """Makes the table that one process would have written. `words`: what `mbs sweep` gets besides its output; `count`: parts; `profile`: the
    cluster's folder. What is done of parts is kept beside the table until it is there. A table that these words made of this scene with this
    program stays as it is."""
    if not (profile / "array").is_file():
        raise StudyError(f"--cluster: {profile} has no script array: study/cluster/README.md says what it does")
    folder = Path(f"{table}.parts").absolute()
    script, there = _script(words, count, folder), Path(table).exists()
    if there and _text(folder / "made") != _made(script, Path(table)):
        raise StudyError(f"{table}: found a file that this command did not make with this scene and this program, allowed is another name; "
                         "without --cluster it is drawn")
    if _text(folder / "part.sh") != script:
        _mbs("sweep", *words, "--output", str(table), "--check")
    home(folder).mkdir(parents=True, exist_ok=True)
    parts = [folder / f"part-{number}" for number in range(1, count + 1)]
    with locks.only_one(folder):
        end_jobs(folder, profile)
        if not there:
            write_text(folder / "part.sh", script)
            merged = _merged(folder, profile, parts, Path(table).name)
            write_text(folder / "made", _made(script, merged))  # before the table: a kill leaves none that is not known
            os.replace(merged, table)
        for path in [*parts, *(path for kind in ("done", "failed", "log") for path in folder.glob(f"{kind}-*"))]:
            path.unlink(missing_ok=True)


def _script(words, count, folder):
    """Runs one part; a lane that fails is a row, and no failure of the part. A part that is there may be another sweep's: only
    what `mbs` has taken as its own is done. Its first line says what the table depends on besides: the program and the scene."""
    program, beside = ROOT / program_of(), shlex.quote(str(folder))
    inputs = [digest(path) for path in [program, *(Path(word) for word in words if os.path.isfile(word))]]
    return (f"# {' '.join(inputs)}\n"
            f"cd {shlex.quote(os.getcwd())}\n"
            f"{shlex.join([str(program), 'sweep', *words, '--resume'])}"
            f' --shard "$1/{count}" --output {beside}/part-"$1" || [ $? = 1 ] || {{ touch {beside}/failed-"$1"; exit 2; }}\n'
            f'touch {beside}/done-"$1"\n')


def _made(script, table):
    """Tells a table that the script's parts gave from any other."""
    return digest(script + digest(table))


def _merged(folder, profile, parts, name):
    """Path of the table of all parts, which are run as far as they are not there."""
    done, failed = ([folder / f"{kind}-{number}" for number in range(1, len(parts) + 1)] for kind in ("done", "failed"))
    for mark in [*done, *failed]:
        mark.unlink(missing_ok=True)
    try:
        given = subprocess.run([str(profile / "array"), str(len(done)), str(folder / "part.sh")], cwd=folder, capture_output=True, text=True)
        if given.returncode:
            raise StudyError(f"{profile / 'array'}: {_last(given.stderr, 'failed')}")
        display = Display()
        while state(folder, profile, given.stdout.strip()) == "running":
            display.show("sweep", f"{sum(mark.exists() for mark in done)} of {len(done)} parts")
            time.sleep(1)
        display.end()
    finally:
        end_jobs(folder, profile)
    end = time.monotonic() + LATENCY  # what was killed leaves no mark
    while time.monotonic() < end and not all(one.exists() or other.exists() for one, other in zip(done, failed)):
        time.sleep(1)
    for number, mark in enumerate(done, 1):
        if not mark.exists():
            raise StudyError(f"part {number} of {len(parts)} is not done: {_last(_text(folder / f'log-{number}'), 'it has said nothing')}; "
                             "the same command goes on where it was")
    merged = folder / f"merged-{name}"
    _mbs("merge-sweep", *map(str, parts), "--output", str(merged))
    return merged


def _mbs(*words):
    """StudyError with the last line of `mbs` where it refuses these words, or does not work."""
    done = subprocess.run([str(ROOT / program_of()), *words], capture_output=True, text=True)
    if not 0 <= done.returncode < USAGE:
        raise StudyError(_last(done.stderr, f"mbs {words[0]} does not work"))


def _text(path):
    return path.read_text(errors="replace") if path.exists() else ""


def _last(text, otherwise):
    """The last line of what a program said."""
    return (text.strip().splitlines() or [otherwise])[-1][:300]
