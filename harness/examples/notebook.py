#!/usr/bin/env python3
"""A full car from Python: cells (`# %%`) for an editor that has them, or one script: notebook.py [car.json]"""
# %% The scene, and who is expected to be fastest on it: with the project's own code, which "auto" may choose, and of libraries alone
import sys
from pathlib import Path

import numpy

import mbs

car = mbs.Scene(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "car.json")
told = car.describe(1e-3)
best = {}
for one in told["recommendation"]:  # each layer's fastest first
    best.setdefault(one["layer"], one["implementation"])
print(told["variables"], "variables;", told["degrees_of_freedom"], "degrees of freedom; own code:", best.get("own"),
      "library:", best.get("library"))

# %% It settles, then a wind comes up over a second
STEP, STEPS = 1e-3, 3000
t = STEP * numpy.arange(1, STEPS + 1)
wind = 2000 * numpy.clip(t - 1, 0, 1)
still = numpy.zeros(STEPS)
inputs = {f"road {wheel}": still for wheel in ("FL", "FR", "RL", "RR")}
inputs |= {"front stiffness": still + 25000, "wind": wind}
frame = mbs.simulate(car, STEP * STEPS, step=STEP, inputs=inputs, every=10)
roll = (frame["travel FL"] - frame["travel FR"]).rename("roll")
print(frame.attrs, roll.iloc[[0, 100, -1]].round(4).to_dict(), sep="\n")

# %% What if: the same moment with softer and stiffer front springs
stepper = mbs.Stepper(car, step=STEP)
stepper.step(1000)
moment = stepper.save()
body = stepper.outputs.index("body.z")
for stiffness in (20000, 25000, 30000):
    stepper.restore(moment)
    stepper.set("front stiffness", stiffness)
    stepper.step(500)
    print(stiffness, round(float(stepper.values[body]), 5))

# %% Many cars at once
masses = numpy.linspace(1000, 1500, 11)
cars = [mbs.Scene(car) for _ in masses]
for one, mass in zip(cars, masses):
    one["bodies/body/mass"] = float(mass)
heights = mbs.simulate_all(cars, 2.0, step=STEP, every=100, threads=2)["body.z"].unstack("scene")
print(heights.iloc[-1].round(4).to_list())
