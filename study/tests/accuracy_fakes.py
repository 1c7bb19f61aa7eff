# A lab whose cells cost nothing: errors and times are those of a model, so that what a plan finds out is known.
from types import SimpleNamespace

from analysis.core.records import Record
from analysis.core.registry import Registry
from study.core.cell import Contender

SPEED = {"lib_a/fast": 10.0, "lib_a/slow": 100.0, "lib_b/even": 10.2, "lib_dense/llt": 40.0, "own/code": 2.0}  # µs a pass
SERVED = {"lib_a/fast": ["rattle", "tangent"], "lib_b/even": ["saddle-point"], "own/code": ["rattle", "saddle-point"]}
ORDER = {"penalty": 10.0, "saddle-point": 5.0, "rattle": 2.0}  # by scheme: error in m at a step of 1 s, of second order


def registry():
    def variant(name):
        return {"name": name, "description": "", "dense": "dense" in name, "settings": SERVED.get(name, [])}
    return Registry({"blas": [], "implementations": [
        {"folder": folder, "available": True, "library": "none" if folder == "own" else folder,
         "variants": [variant(name) for name in SPEED if name.startswith(folder + "/")]}
        for folder in dict.fromkeys(name.split("/")[0] for name in SPEED)]})


SETTINGS = {"duration": 5.0, "longest": 4.0, "processes": [3, 5], "settings": ["default", "saddle", "every-step", "rattle"],
            "errors": [1e-3, 1e-5], "seconds": 100,
            "columns": [{"loops": 10, "fills": [1.0], "seconds": 60}, {"pairs": 10, "seconds": 40}]}


class Lab:
    """`column`: of whose name records are. `lost`: {variant: status of its motions}; `wrong`: variants whose error is
    tenfold."""

    def __init__(self, column, settings=SETTINGS, lost=(), wrong=(), budget=1e9, variants=tuple(SPEED)):
        self.column, self.settings, self.registry = column, settings, registry()
        self.contenders = [Contender(name, name) for name in variants]
        self.lost, self.wrong, self.left, self.budget = dict(lost), wrong, budget, budget
        self.records, self.asked = {}, []

    def tell(self, text):
        pass

    def contender(self, name):
        return next((one for one in self.contenders if one.name == name), None)

    def one(self, cell):
        return self.run([cell])[0]

    def run(self, cells, drop=False):
        return [self._record(cell.settled(), drop) for cell in cells]

    def skip(self, cell, status, reason):
        return self._keep(cell.settled(), status, reason, {})

    def _record(self, cell, drop):
        if f"{self.column}/{cell.file_name()}" in self.records:
            return self.records[f"{self.column}/{cell.file_name()}"]
        if drop and self.left <= 0:
            return self._keep(cell, "dropped", "the budget was spent", {})
        self.asked.append(cell)
        self.left -= 1
        return self._keep(cell, "done", "", self._bench(cell) if cell.kind == "bench" else self._motion(cell))

    def _keep(self, cell, status, reason, output):
        name = f"{self.column}/{cell.file_name()}"
        self.records[name] = Record(name, cell.document(), status, reason, 0.01, [], {}, output)
        return self.records[name]

    def _motion(self, cell):
        name, words = cell.contenders[0].variant, options(cell)
        step, status = float(words["--step"]), self.lost.get(name, "ok")
        error = ORDER[words["--scheme"]] * step**2 * (10 if name in self.wrong else 1)
        return {"status": status, "status_reason": "because" if name in self.lost else "", "steps": round(5.0 / step),
                "variables": variables(cell), "tangent_nonzeros": 124, "passes_per_step": 2.0,
                "factorizations_per_step": 1.0 if "--tangent" in words else 2.0, "position_error_max": error,
                "step_us": {"median": 2 * SPEED[name]}}

    def _bench(self, cell):
        words, rows = options(cell), {}
        for one in cell.contenders:
            name = f"{one.variant}/{cell.scene}"
            slow = min(SPEED[each.variant] for each in cell.contenders) * float(words.get("--slower-than", 1e9))
            if SPEED[one.variant] > slow:
                rows[name] = {"error_occurred": True, "error_message": "slower: at least 6 times the fastest",
                              "stretch_us": [0], "cpu_us": [0]}
                continue
            steps = int(words["--steps"])
            noise = 1 + 1e-3 * (int(words["--seed"]) % 3)
            rows[name] = {"steps": steps, "passes": 2 * steps, "variables": variables(cell), "step_us": 1.0,
                          } | dict.fromkeys(("stretch_us", "cpu_us"), [2 * SPEED[one.variant] * steps * noise] * 3)
        return {"rows": rows}


def variables(cell):
    return 2 * int(cell.scene.split(",")[0].removeprefix("four-bar:")) + 2


def options(cell):
    words = [*map(str, cell.settings), ""]
    return {word: words[place + 1] for place, word in enumerate(words) if word.startswith("--")}


def view(lab):
    return SimpleNamespace(settings=lab.settings, registry=lab.registry)
