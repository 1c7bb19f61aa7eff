#!/usr/bin/python3
# Stands in for `mbs` in tests: same command lines and output, invented numbers, and the misbehaviour that its
# implementation names say. FAKE_MACHINE and FAKE_COMMIT change the fingerprint, FAKE_DIRTY makes the tree dirty,
# FAKE_CRASH is a contender that ends its process, FAKE_NEW is one more variant and how many times good_sparse/only's time it takes: "new_one/only=0.5".
import json
import math
import os
import random
import re
import signal
import sys
import time

GOOD = {"good_dense/first": 3, "good_dense/second": 3.0, "good_sparse/only": 1}
BAD = ["bad/crash", "bad/hang", "bad/memory", "bad/large", "bad/wrong", "bad/slow", "bad/crawl",
       "bad/passes", "bad/nan"]


def variants():
    return list(GOOD) + (BAD if os.environ.get("FAKE_BAD") else []) + newcomers()


def newcomers():
    return [os.environ["FAKE_NEW"].partition("=")[0]] if "FAKE_NEW" in os.environ else []


def context():
    return {"date": "2024-01-01T00:00:00+00:00", "num_cpus": 2, "mbs_version": "0.1.0",
            "commit": os.environ.get("FAKE_COMMIT", "abc1234"), "dirty": os.environ.get("FAKE_DIRTY", "false"),
            "compiler": os.environ.get("FAKE_COMPILER", "fake 1.0"), "flags": "-O3", "build_type": "Release",
            "blas": option("--blas", "system"),
            "blas_loaded": f"/usr/lib/lib{option('--blas', 'fake')}.so", "libraries": "Fake 1.0",
            "cpu_model": "Fake CPU",
            "machine": os.environ.get("FAKE_MACHINE", "m1"), "kernel": "Linux", "command": "mbs"}


def option(name, default=None):
    for index, word in enumerate(sys.argv):
        if word == name:
            return sys.argv[index + 1]
        if word.startswith(name + "="):
            return word.split("=", 1)[1]
    return default


def options(name):
    return [sys.argv[i + 1] for i, word in enumerate(sys.argv) if word == name]


def misbehave(name):
    if name in ("bad/crash", os.environ.get("FAKE_CRASH")):
        print(f"mbs bench: ended by SIGSEGV in {name}/{sys.argv[2]}", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)
    if name == "bad/hang":
        time.sleep(1000)
    if name == "bad/memory":
        print("terminate called: std::bad_alloc", file=sys.stderr)
        os.abort()
    if name == "bad/large":
        print("mbs: not enough memory for this scene with this implementation", file=sys.stderr)
        sys.exit(2)


def step_us(name, n, fill):
    if name == "null/null":
        return 0.01
    if name == "bad/slow":
        return 1e4 * n
    if name in newcomers():
        return float(os.environ["FAKE_NEW"].partition("=")[2]) * step_us("good_sparse/only", n, fill)
    sparse = 0.3 * n + 3e-4 * (fill * n * n) ** 1.4
    dense = 2 + 0.05 * n + 1e-5 * n**3
    return sparse if "sparse" in name else dense * (1.05 if name.endswith("second") else 1)


def bench(scene):
    """All implementations take turns in one process; what disturbs one turn disturbs all of it."""
    if "--operations" in sys.argv:
        return operations(scene)
    names = options("--implementation")
    for name in names:
        misbehave(name)
    n = 2 * int(re.match(r"four-bar:(\d+)", scene).group(1)) + 2
    asked = re.search(r"fill=([\d.]+)", scene)
    fill = float(asked.group(1)) if asked else (6 * n - 8) / n**2
    steps, rng, rows = int(option("--steps", "100")), random.Random(), []
    repetitions, layout = int(option("--benchmark_repetitions", "3")), {name: rng.uniform(0.98, 1.02) for name in names}
    if "bad/crawl" in names:
        time.sleep(0.1 * steps * (repetitions + 1))
    least = min(step_us(name, n, fill) for name in names)
    for repetition in range(repetitions):
        disturbed = rng.uniform(0.97, 1.3)
        rows += [row_of(name, scene, n, fill, steps, repetition,
                        step_us(name, n, fill) * layout[name] * disturbed * rng.uniform(0.99, 1.01))
                 for name in names]
    slower = float(option("--slower-than", "inf"))
    for row in rows:
        if asked:
            row["fill_seed"] = 1
        name = row["name"].rsplit("/", 1)[0]
        if step_us(name, n, fill) > slower * least:
            row |= {"error_occurred": True, "error_message": f"slower: more than {slower:g} times the fastest"}
    rows.append({"name": f"{names[0]}/{scene}_median", "run_type": "aggregate", "real_time": 1.0})
    text = json.dumps({"context": context(), "benchmarks": rows})
    if option("--benchmark_out"):
        open(option("--benchmark_out"), "w").write(text)
    if option("--benchmark_format") == "json":
        print(text)
    sys.exit(any(row.get("error_occurred", False) for row in rows))


def row_of(name, scene, n, fill, steps, repetition, one):
    row = {"name": f"{name}/{scene}", "run_name": f"{name}/{scene}", "run_type": "iteration",
           "repetitions": 3, "repetition_index": repetition, "iterations": 5,
           "real_time": one * steps, "cpu_time": one * steps, "time_unit": "us",
           "steps": steps, "passes": 2 * steps + (name == "bad/passes"), "steps_at_limit": 1,
           "step_us": one, "setup_us": 50.0, "variables": n, "constraints": n - 1,
           "fill_percent": 100 * fill, "penalty": 1e10, "step": 1.25e-3, "tolerance": 1e-9,
           "max_passes": 20, "start": 0.1, "position_error": 1e-6,
           "constraint_violation": 1e-12, "energy_drift": 1e-7}
    if "--phases" in sys.argv:
        row |= {"phase_evaluation": .2, "phase_assembly": .2, "phase_factorization": .3,
                "phase_solve": .1, "phase_projection": .1, "phase_other": .1}
    if name == "bad/nan":
        row |= {"error_occurred": True, "error_message": "diverged: NaN at step 100"}
    return row


def operations(scene):
    """Table 2's operations, as `mbs bench --operations` reports them."""
    name, n = option("--implementation"), 2 * int(scene.split(":")[1]) + 2
    rows = [{"name": f"{name}/{scene}/{operation}", "run_name": f"{name}/{scene}/{operation}",
             "run_type": "iteration", "repetition_index": repetition, "iterations": 7,
             "real_time": (one := time_us * n * random.uniform(0.97, 1.03)), "cpu_time": one, "time_unit": "us",
             "variables": n, "constraints": n - 1, "fill_percent": 40.0}
            for repetition in range(int(option("--benchmark_repetitions", "1")))
            for operation, time_us in (("jacobian_evaluation", 0.01), ("rank_k_update", 0.03),
                                       ("matrix_addition", 0.002))]
    open(option("--benchmark_out"), "w").write(json.dumps(
        {"context": context(), "benchmarks": rows}))


def check(scene):
    rows = []
    for name in options("--implementation"):
        good = name != "bad/wrong"
        checks = [{"name": "lock-step", "value": 1e-13 if good else 0.4, "tolerance": 1e-10,
                   "passed": good, "detail": ""},
                  {"name": "convergence-order", "value": 2.01, "tolerance": 0.1, "passed": True,
                   "detail": ""}]
        reason = "" if good else "lock-step: q differs by 0.4 m"
        if good and option("--tolerance"):  # asked for a looser one than the automatic
            reason, good = "exact: position error", False
            checks.append({"name": "exact", "value": 1.0, "tolerance": 0.1, "passed": False, "detail": ""})
        rows.append({"scene": scene, "implementation": name,
                     "verdict": "agrees" if good else "disagrees", "reason": reason, "checks": checks})
    open(option("--json"), "w").write(json.dumps({"context": context(), "rows": rows}))
    sys.exit(any(row["verdict"] != "agrees" for row in rows))


def simulate(scene):
    misbehave(option("--implementation"))
    n = 2 * int(re.match(r"four-bar:(\d+)", scene).group(1)) + 2
    lost = option("--penalty") == "1e8" and n > 50
    name, duration, step = (option(key) for key in ("--implementation", "--duration", "--step"))
    duration, step = float(duration), float(step or 1.25e-3)
    one, passes = step_us(name, n, 0.1), 2.0 if option("--scheme") == "saddle-point" else 2.2
    lost = lost or option("--precision") == "single" and n == 42 and duration > 0.5
    repeats = int(option("--repeats", "1"))
    print(json.dumps({
        "scene": scene, "implementation": name, "variables": n, "constraints": n - 1,
        "step": step, "duration": duration, "penalty": 1e8 if lost else 1e10,
        "tolerance": 1e-9, "status": "diverged" if lost else "ok",
        "status_reason": "NaN in q" if lost else "", "failed_at": 0.71 if lost else None,
        "steps": round(duration / step), "passes_per_step": passes, "factorizations_per_step": passes,
        "position_error_max": None if lost else 1e-3 * (step / 1.25e-3) ** 2, "steps_at_limit": 0,
        "energy_drift_max": 1e-4, "constraint_violation_max": 1e-11, "setup_us": 40.0,
        "tangent_nonzeros": 6 * n - 8,
        "repeats": repeats,
        "least_us": {"mean": 0.9 * one * passes, "median": 0.9 * one} if repeats > 1 else None,
        "step_us": {"mean": one * passes, "median": one, "p99": 9.0, "max": math.pi}}))
    sys.exit(lost)


def describe(_):
    step = float(option("--step"))
    print(json.dumps({"penalty_window": {
        "step": step, "automatic": 2e3 / step**2, "lower": 1e2 / step**2, "lower_from": "slowest mode",
        "upper": 1e5 / step**2, "upper_from": "cancellation"}}))


def registry():
    folders = {}
    for name in variants():
        variant = {"name": name, "description": f"fake {name}", "dense": "dense" in name,
                   "unsymmetric": False, "operations": name == "good_sparse/only"}
        if name == "good_dense/first":
            variant["settings"] = ["saddle-point", "single"]
        folders.setdefault(name.split("/")[0], []).append(variant)
    entries = [{"folder": folder, "description": "a fake", "library": "Fake", "version": "1.0",
                "licence": "MIT", "available": True, "reason": "", "variants": found}
               for folder, found in folders.items()]
    entries.append({"folder": "absent", "description": "", "library": "", "version": "",
                    "licence": "", "available": False, "reason": "Foo is not installed",
                    "variants": []})
    pairs = [{"name": name, "blas": name, "lapack": name, "available": name != "atlas",
              "reason": "libatlas3-base is not installed" if name == "atlas" else ""}
             for name in ("reference", "openblas", "openblas-reference", "atlas")]
    print(json.dumps({"implementations": entries, "blas": pairs}))


if __name__ == "__main__":
    {"list": lambda _: registry(), "bench": bench, "check": check, "simulate": simulate,
     "describe": describe}[
        sys.argv[1]](sys.argv[2])
