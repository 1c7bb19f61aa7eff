# The one list of parts: study/parts.yaml.
import yaml

from analysis.core.errors import StudyError
from analysis.core.files import ROOT

LIST = ROOT / "study" / "parts.yaml"


def parts():
    """{name: its question}, in order."""
    return yaml.safe_load(LIST.read_text(encoding="utf-8"))


def need_parts(names):
    """StudyError if one is no part."""
    for name in names:
        if name not in parts():
            raise StudyError(f"unknown part '{name}'; known: {', '.join(parts())}")
