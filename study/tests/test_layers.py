# The common layer imports nothing from above it, no modules import each other in a circle, and a part can be deleted.
import ast
import re
import subprocess
import sys
from functools import cache

import yaml

from analysis.core import site, view as lists
from analysis.core.files import ROOT, write_json
from analysis.core.view import pages, parts

BUILDS_UPON = {("accuracy", "scenes"),  # standard problems with their references
               ("extremes", "scenes"),  # the same problems
               ("engines", "scenes"),   # equations of motion
               ("limit", "scenes"),     # the same scenes
               ("families", "limit"),   # looks, gates and times of a scene
               ("tuning", "limit")}     # cells and verdicts of a scene
TOOLS_UPON = {"merge": {"families", "map"}, "paper": set(parts())}  # which ask for what these parts have found
SHARED = {"fragments", "merge", "shelf", "store"}  # what tools take from each other
PATHS = [path for path in subprocess.run(["git", "ls-files", "study/*.py", "analysis/*.py"], cwd=ROOT, capture_output=True,
                                         text=True, check=True).stdout.split("\n")[:-1] if (ROOT / path).exists()]


def module(path):
    return path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


MODULES = {module(path): path for path in PATHS}


def imported(name):
    """Modules that a module imports, those inside of functions too."""
    found = set()
    for node in ast.walk(ast.parse((ROOT / MODULES[name]).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {one.name for one in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: imports are absolute"
            found |= {f"{node.module}.{one.name}" if f"{node.module}.{one.name}" in MODULES else node.module
                      for one in node.names}
    return found


def base(name):
    return name.partition(".")[0]


OURS = {"study", "analysis"}


@cache
def graph():  # not as this file is imported, which each worker does
    return {name: {one for one in imported(name) if base(one) in OURS} for name in MODULES}


def layer(name):
    """"study.core", "analysis.map", …"""
    return ".".join(name.split(".")[:2])


def part(name):
    return name.split(".")[1] if "." in name else ""


def wrong(pairs):
    return sorted(f"{name} imports {one}" for name, one in pairs)


def edges():
    return [(name, one) for name, found in graph().items() for one in found if layer(name) != layer(one)]


def test_there_is_something_to_look_at():
    assert {"study.core.lab", "analysis.core.records", "study.tools.store"} <= set(graph())
    assert "study.core.executor" in graph()["study.core.lab"]


def test_what_is_imported_is_there():
    assert wrong((name, one) for name, found in graph().items() for one in found
                 if one not in MODULES and one not in ("study", "analysis", "study.tools")) == []


def test_the_common_layer_imports_nothing_from_above():
    allowed = {"analysis.core": set(), "study.core": {"analysis.core"}}
    assert wrong((name, one) for name, one in edges() if layer(name) in allowed and layer(one) not in allowed[layer(name)]) == []


def test_the_common_layer_names_nothing_from_above():
    """Not as a text, either, from which a module could be loaded; parts come from their list."""
    above = {path.split("/")[1] for path in PATHS if path.count("/") > 1} - {"core", "tests"}
    named = []
    for name in graph():
        if layer(name).endswith(".core"):
            tree = ast.parse((ROOT / MODULES[name]).read_text(encoding="utf-8"))
            named += [(name, node.value) for node in ast.walk(tree) if isinstance(node, ast.Constant) and re.match(r"(study|analysis)\.(?!core)\w", str(node.value))]
            named += [(name, one.value) for node in ast.walk(tree) if isinstance(node, ast.Call) for one in node.args
                      if isinstance(one, ast.Constant) and one.value in above]
    assert named == []


def test_of_a_part_others_know_only_what_is_said_here():
    allowed = {**{f"analysis.{one['folder']}": set(one["parts"]) for one in pages().values()},
               **{f"study.tools.{name}": known for name, known in TOOLS_UPON.items()}}
    outside = [(name, one) for name, one in edges() if part(one) in parts() and part(name) not in (*parts(), "tests")]
    assert wrong((name, one) for name, one in outside
                 if part(one) not in next((known for place, known in allowed.items() if name.startswith(f"{place}.")), ())) == []


def test_without_a_part_the_site_has_no_page_that_needs_it(tmp_path, monkeypatch):
    known = yaml.safe_load(lists.LIST.read_text(encoding="utf-8"))
    del known["parts"]["map"]
    write_json(tmp_path / "parts.yaml", known)
    monkeypatch.setattr(lists, "LIST", tmp_path / "parts.yaml")
    context = {"commit": "0" * 40, "dirty": False, "cpu_model": "P", "num_cpus": 1, "compiler": "", "flags": "", "kernel": "", "machine": ""}
    write_json(tmp_path / "set.json", {"profile": "quick", "only": [], "parts": ["families"], "programs": {}, "context": context, "date": ""})
    write_json(tmp_path / "registry.json", {"implementations": []})
    site.write_index(tmp_path)
    assert "explore.html" not in (tmp_path / "index.html").read_text() and not (tmp_path / "explore.html").exists()


def test_parts_import_their_twin_and_only_those_that_they_build_upon():
    between = [(name, one) for name, one in edges() if {part(name), part(one)} <= set(parts())]
    assert wrong((name, one) for name, one in between if part(name) != part(one)
                 and (part(name), part(one)) not in BUILDS_UPON) == []
    for first in parts():  # and of a part and its twin only one imports the other
        assert not {("study." + first, "analysis." + first), ("analysis." + first, "study." + first)} <= {
            (layer(name), layer(one)) for name, one in between}, first


def test_of_each_other_tools_import_only_what_they_share():
    between = [(name, one) for name, found in graph().items() for one in found if layer(name) == layer(one) == "study.tools"]
    assert wrong((name, one) for name, one in between if name.split(".")[2] != one.split(".")[2] and one.split(".")[2] not in SHARED) == []


def test_nothing_imports_tools_or_tests():
    assert wrong((name, one) for name, one in edges() if layer(one) == "study.tools" and layer(name) != "study.tests") == []
    assert wrong((name, one) for name, one in edges() if layer(one).endswith(".tests") and not layer(name).endswith(".tests")) == []


def test_no_modules_import_each_other_in_a_circle():
    left = {name: {one for one in found if one in graph() and one != name} for name, found in graph().items()}
    while free := [name for name, found in left.items() if not found & set(left)]:
        for name in free:
            del left[name]
    assert {name: sorted(found & set(left)) for name, found in left.items()} == {}


def test_all_that_is_imported_is_looked_for_before():
    """study/run reads the plans before its set-up installs what is missing: python.sh has to see to it."""
    needed = {base(one) for name in MODULES if not layer(name).endswith(".tests") for one in imported(name)} - OURS - sys.stdlib_module_names
    looked_for = re.search(r'"(.+)"\.split', (ROOT / "study" / "python.sh").read_text(encoding="utf-8"))[1].split()
    assert needed - {"markupsafe"} | {"snakemake"} == set(looked_for)  # which comes with jinja2; which is run
