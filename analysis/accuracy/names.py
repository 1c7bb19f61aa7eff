# How settings and steps are written and marked in the figures of this package.
DASHES = {"penalty": "-", "saddle": (0, (5, 1.5)), "rattle": (0, (1, 1)), "multistep6": (0, (3, 1, 1, 1, 1, 1)),
          "precision": (0, (6, 1.5, 1, 1.5)), "tangent": (0, (2, 1))}


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
