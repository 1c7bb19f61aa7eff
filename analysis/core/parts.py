# The one list of parts, and of pages beside theirs: study/parts.yaml.
from functools import cache

from analysis.core.files import ROOT, from_yaml

LIST = ROOT / "study" / "parts.yaml"


def parts():
    """{name: its question}, in order."""
    return _listed(LIST)["parts"]


def pages():
    """{name: its folder in analysis/ and its title}, of those whose parts are there."""
    return {name: one for name, one in _listed(LIST)["pages"].items() if parts().keys() >= set(one["parts"])}


@cache
def _listed(path):
    return from_yaml(path.read_text(encoding="utf-8"))
