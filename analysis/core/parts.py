# The one list of parts: study/parts.yaml.
from functools import cache

import yaml

from analysis.core.files import ROOT

LIST = ROOT / "study" / "parts.yaml"


@cache
def parts():
    """{name: its question}, in order."""
    return yaml.safe_load(LIST.read_text(encoding="utf-8"))
