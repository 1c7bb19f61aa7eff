# Error against time: for each subject the curves of all settings, the times of what may be fastest; pairs of settings.
from analysis.accuracy.subjects import columns as listed
from analysis.core.files import StudyError
from study.accuracy import pairs, work

SETTINGS = {"duration": float, "longest": float, "processes": [int], "settings": [str], "errors": [float], "columns": [dict]}


def columns(settings):
    found = {name: float(entry["seconds"]) for name, (_, entry) in listed(settings).items()}
    if sum(found.values()) > settings["seconds"]:
        raise StudyError(f"accuracy: its columns add up to {sum(found.values()):g} s, more than {settings['seconds']:g} s")
    return found


def run(lab, column):
    kind, entry = listed(lab.settings)[column]
    if kind == "pairs":
        pairs.run(lab, entry)
    else:
        work.run(lab, kind, entry)
