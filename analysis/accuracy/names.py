# How settings and steps are written and marked in the figures of this package.
import matplotlib.pyplot as plt

SHADES = {kind: plt.get_cmap(name) for kind, name in (
    ("penalty", "Blues"), ("saddle", "Greens"), ("rattle", "Oranges"), ("multistep6", "Reds"), ("precision", "Purples"),
    ("tangent", "Greys"))}


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


def colours(settings):
    """{setting: its colour}: those of its kind, the darkest first."""
    found, used = {}, {}
    for setting in dict.fromkeys(settings):
        kind = family(setting)
        found[setting] = SHADES[kind](0.9 - 0.2 * (used.setdefault(kind, 0) % 4))
        used[kind] += 1
    return found


def step(seconds):
    """"1.25 ms" or "39 µs"."""
    return f"{1e3 * seconds:.3g} ms" if seconds >= 1e-4 else f"{1e6 * seconds:.3g} µs"
