# The one list of parts, and of pages beside theirs: study/parts.yaml.
from functools import cache

import yaml

from analysis.core.files import ROOT

LIST = ROOT / "study" / "parts.yaml"


@cache
def parts():
    """{name: its question}, in order."""
    return _listed()["parts"]


def pages():
    """{name: its folder in analysis/ and its title}, of those whose parts are there."""
    return {name: one for name, one in _listed()["pages"].items() if parts().keys() >= set(one["parts"])}


def _listed():
    return yaml.safe_load(LIST.read_text(encoding="utf-8"))
