# The columns of accuracy as a profile lists them: sizes of the N-four-bar, standard problems, sizes for pairs of settings.
from analysis.core.errors import StudyError

KEYS = {"loops": {"seconds", "fills"}, "problem": {"seconds"}, "pairs": {"seconds"}}  # beside the kind itself
PREFIX = {"loops": "four-bar-", "problem": "", "pairs": "pairs-"}


def columns(settings):
    """{column: (kind, entry)}; kind: "loops", "problem" or "pairs"."""
    found = {}
    for entry in settings["columns"]:
        kind = next((kind for kind, keys in KEYS.items() if isinstance(entry, dict) and set(entry) == {kind} | keys), None)
        if kind is None:
            raise StudyError(f"accuracy: columns: {entry} needs seconds and one of loops (with fills), problem, pairs")
        found[PREFIX[kind] + str(entry[kind]).replace(" ", "-")] = kind, entry
    return found
