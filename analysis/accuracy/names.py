# How implementations, settings and steps are written and coloured in the figures of this package.
from types import SimpleNamespace

import matplotlib.pyplot as plt
import pandas

from analysis.style import Look

FAMILIES = {  # first word of a setting: the colours of its kind
    "penalty": plt.get_cmap("Blues"), "saddle": plt.get_cmap("Greens"),
    "rattle": plt.get_cmap("Oranges"), "multistep6": plt.get_cmap("Reds"), "precision": plt.get_cmap("Purples"),
    "tangent": plt.get_cmap("Greys")}


def look(registry):
    """Colours and markers of implementations, by their place in the registry."""
    return Look(SimpleNamespace(registry=registry, tidy=pandas.DataFrame({"blas": [], "build": []})))


def family(setting):
    """The kind of a setting, by its name in study/settings.yaml."""
    words = setting.split()
    if "mixed" in words or "single" in words:
        return "precision"
    if words[0].startswith("rattle"):
        return "rattle"
    if words[0] in ("saddle", "multistep6"):
        return words[0]
    return "tangent" if words[0] in ("every-step", "kept") else "penalty"


def step(seconds):
    """"1.25 ms" or "39 µs"."""
    return f"{1e3 * seconds:.3g} ms" if seconds >= 1e-4 else f"{1e6 * seconds:.3g} µs"
