# study/new NAME: writes implementations/NAME/, which compiles and does nothing yet, and its line in the list.
import re
import shutil
from pathlib import Path

from analysis.core.files import ROOT, StudyError, read_yaml, write_text
from analysis.core.text import layout
from study.core.options import Parser

SKELETON = ROOT / "study" / "tools" / "skeleton"
LIST = ROOT / "implementations" / "CMakeLists.txt"
LIBRARIES = read_yaml(SKELETON.with_name("libraries.yaml"))
NAME = re.compile(r"[a-z][a-z0-9_]*")
NAMES = read_yaml(SKELETON.with_name("names.yaml"))


def new(arguments):
    parser = Parser(prog="study/new", description="Writes the folder of a new implementation: it compiles, is in the list, and has empty "
                    "functions to fill in: predict, constraints, Jacobian, residual, tangent, factorize, solve, correct, project, the step.")
    parser.add_argument("name", metavar="NAME", help="its folder: lower case, digits, _")
    parser.add_argument("--library", default="none", choices=list(LIBRARIES), help="what it links (none)")
    options = parser.parse_args(arguments)
    folder = ROOT / "implementations" / options.name
    if not NAME.fullmatch(options.name):
        raise StudyError(f"'{options.name}' is no name: a letter from a to z, then such letters, digits or _")
    if options.name in (*NAMES["keywords"], *NAMES["taken"]) or re.match("(mbs|implementation)_", options.name) or "__" in options.name:
        raise StudyError(f"'{options.name}' is a name of C++ or of the harness: take another name")
    if folder.exists() or options.name in listed():
        raise StudyError(f"implementations/{options.name} exists already: take another name")
    try:
        values = LIBRARIES[options.library] | {"NAME": options.name}
        for path in sorted(SKELETON.iterdir()):
            stem, _, only = path.name.partition("@")
            if only in ("", options.library):
                write_text(folder / stem, re.sub("@([A-Z]+)@", lambda one: values[one[1]], path.read_text(encoding="utf-8")))
        before, after = LIST.read_text(encoding="utf-8").rsplit(")", 1)
        write_text(LIST, f"{before.rstrip()}\n  {options.name}\n){after}")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    print(layout(Path(__file__).with_name("new.txt.j2")).render(name=options.name))


def listed():
    return LIST.read_text(encoding="utf-8").split("mbs_registry(")[1].split(")")[0].split()
