# The N-four-bar over step and penalty factor: one untimed run a cell of the maps; whole runs with all automatic.
from study.core.cell import Cell
from study.core.profile import by_share
from study.core.setting import Setting

SETTINGS = {"loops": [int], "powers": [float], "decades": [float], "duration": float, "whole": {...: [int]}}
IMPLEMENTATIONS = {"double": "csc_klu/refactor", "single": "compiled_ldl/fronts"}
FORMS = ("penalty", "saddle-point")
STEP, WHOLE = 1.25e-3, 20.0
AUTOMATIC = "auto"


def maps(lab):
    steps = [STEP * 2.0**power for power in lab.settings["powers"]]
    scaled = [AUTOMATIC, *(10.0**power for power in lab.settings["decades"])]
    # Who draws which map, where it takes part and serves it.
    served = {(scheme, precision): one for precision, name in IMPLEMENTATIONS.items() for one in [lab.contender(name)] for scheme in FORMS
              if one and lab.registry.serves(name, scheme, precision)}
    lab.run([Cell("describe", f"four-bar:{loops}", (), ("--step", f"{step:g}", "--precision", precision), "window")
             for loops in lab.settings["loops"] for precision in dict.fromkeys(one for _, one in served)
             for step in steps])
    lab.run([Cell("simulate", f"four-bar:{loops}", (one,), words(scheme, precision, step, value, lab.settings["duration"]), "map")
             for loops in lab.settings["loops"] for (scheme, precision), one in served.items() for step in steps for value in scaled],
            drop=True)


def words(scheme, precision, step, scaled, duration):
    """Of one run. `scaled`: alpha step^2 / 4, or AUTOMATIC."""
    penalty = AUTOMATIC if scaled == AUTOMATIC else f"{4 * scaled / step**2:.8g}"
    return ("--scheme", scheme, "--precision", precision, "--penalty", penalty, "--step", f"{step:g}",
            "--duration", f"{duration:g}", "--judge-every", "1")


def whole(lab):
    one = lab.contender(IMPLEMENTATIONS["double"])
    cells = [Cell("simulate", f"four-bar:{loops}", (one,), words(scheme, "double", STEP, AUTOMATIC, WHOLE), "whole", seconds=300)
             for scheme, sizes in lab.settings["whole"].items()
             if one and lab.registry.serves(one.variant, *Setting(scheme).needs) for loops in sizes]
    lab.run(sorted(cells, key=lambda cell: int(cell.scene.partition(":")[2])), drop=True)


columns, run = by_share({"maps": (0.7, maps), "whole": (0.3, whole)})
