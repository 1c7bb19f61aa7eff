# The one list of parts: study/parts.yaml.
from analysis.core.errors import StudyError
from analysis.core.files import ROOT

LIST = ROOT / "study" / "parts.yaml"


def parts():
    """{name: its question}, in order."""
    import yaml  # here, so that a bad command line is refused before anything is installed
    listed = yaml.safe_load(LIST.read_text(encoding="utf-8"))
    return {name: question for name, question in listed.items() if (ROOT / "study" / name / "plan.py").exists()}


def need_parts(names):
    """StudyError if one is no part."""
    for name in names:
        if name not in parts():
            raise StudyError(f"unknown part '{name}'; known: {', '.join(parts())}")
