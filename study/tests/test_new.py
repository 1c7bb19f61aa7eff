# study/new: what it writes compiles and is in the list; what it cannot write it leaves alone.
import subprocess

import pytest

from analysis.core.files import StudyError
from study.tests.conftest import ROOT
from study.tools import new


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A list of implementations to write to."""
    base = tmp_path / "implementations"
    base.mkdir()
    (base / "CMakeLists.txt").write_text("include(registry.cmake)\n\nmbs_registry(\n  eigen_dense\n)\n")
    monkeypatch.setattr(new, "ROOT", tmp_path)
    monkeypatch.setattr(new, "LIST", base / "CMakeLists.txt")
    return base


@pytest.mark.parametrize("library", new.LIBRARIES)
def test_what_it_writes_compiles_without_a_warning(repository, library, capsys):
    new.new(["my_first", "--library", library])
    said = capsys.readouterr().out
    commands = [line.split("#")[0].split() for line in said.splitlines() if line.startswith("  ")]
    assert [words[0] for words in commands] == ["cmake", "build/mbs", "study/add"] and "CONTRIBUTING.md" in said
    folder = repository / "my_first"
    assert sorted(path.name for path in folder.iterdir()) == [
        "CMakeLists.txt", "README.md", "implementation.cpp", "simulation.cpp", "simulation.hpp"]
    assert all("@" not in path.read_text() for path in folder.iterdir())
    described = (folder / "implementation.cpp").read_text()
    assert "version = \"TODO" not in described and ("ilaver_" in described) == (library == "blas")  # it stands in every record
    assert "Unsupported" in (folder / "simulation.cpp").read_text()  # a dense one refuses what does not fit into memory
    for source in folder.glob("*.cpp"):
        done = subprocess.run(["g++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                               "-I", ROOT / "harness" / "include", "-isystem", "/usr/include/eigen3", source],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_it_is_the_last_of_the_list(repository):
    new.new(["my_first"])
    assert new.listed() == ["eigen_dense", "my_first"]


@pytest.mark.parametrize("name, words", [("Upper", "is no name"), ("1st", "is no name"), ("a-b", "is no name"),
                                         ("../evil", "is no name"),
                                         *((name, "of C\\+\\+ or of the harness") for name in (
                                             "class", "int", "namespace", "std", "available", "null", "reference", "limit", "control",
                                             "main", "mbs", "mbs_registry", "a__b", "all", "test")),
                                         ("eigen_dense", "exists already")])
def test_what_cannot_be_a_folder_is_refused(repository, name, words):
    before = (repository / "CMakeLists.txt").read_text()
    with pytest.raises(StudyError, match=words):
        new.new([name])
    assert (repository / "CMakeLists.txt").read_text() == before
    assert [path.name for path in repository.iterdir()] == ["CMakeLists.txt"]
