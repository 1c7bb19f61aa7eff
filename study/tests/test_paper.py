# study/paper: the paper in the repository is of its set, and each way to be wrong is found. No LaTeX is needed.
import io
import re
import shutil
from types import SimpleNamespace

import numpy
import pandas
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text

from analysis.core import timing
from analysis.core.files import ROOT, read_json, write_json
from analysis.core.style import Look
from analysis.map import figures as maps
from study.tests.conftest import study
from study.tools import fragments, store
from study.tools.merge import machine
from study.tools.paper import artifact, audit, claims as claims_, figures, known as known_sets, main, tables
from study.tools.paper.claims import _mixed, claims
from study.tools.paper.known import Known
from study.tools.paper.numbers import NOT_MEASURED, Number, numbers

TEXT = audit.source()
BIBLIOGRAPHY = (ROOT / "paper" / "references.bib").read_text(encoding="utf-8")
CLAIMS = {one.name: (True, "") for one in claims()}
pytestmark = pytest.mark.xdist_group("test_paper.py")


@pytest.fixture(scope="module")
def known():
    return Known(fragments.main_set())


@pytest.fixture(scope="module")
def found(known):
    return numbers(known)


def wrong(text, found, claimed=CLAIMS):
    return list(audit.of_text(text, found, claimed))


def in_text(addition):
    """The paper with a sentence more."""
    return TEXT.replace(r"\section{Threats", addition + "\n" + r"\section{Threats")


def test_the_paper_is_of_the_set_that_the_rule_names(known, found, monkeypatch):
    monkeypatch.setattr(store, "of_records", lambda kept: [])  # of which test_repository.py has each set drawn again
    claimed = artifact.judged(known)
    assert [one for one in audit.audit(known, TEXT, found, claimed)] == []
    assert f"`{known.folder.name}`" in artifact.FILE.read_text(encoding="utf-8")


def test_readme_rule_and_paper_are_of_one_commit(known):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    rule = read_json(fragments.RULE)
    assert (rule["set"], rule["commit"]) == (known.folder.name, known.context["commit"])
    assert set(re.findall(r"results/([\w.+-]+)[/`]", readme)) - {"local"} == {known.folder.name}
    assert len(known.compared) >= 2 and all((one.context["commit"], one.facts["profile"]) == (rule["commit"], "full") for one in known.compared)
    assert all(rule["commit"][:10] in text for text in (readme, artifact.FILE.read_text(encoding="utf-8")))


def test_every_number_has_a_source_and_most_are_measured(found):
    assert all(one.table for one in found.values() if one.text != NOT_MEASURED)
    assert sum(one.text != NOT_MEASURED for one in found.values()) > 60
    assert all(len(set(one.records)) == len(one.records) for one in found.values())


def test_a_number_of_several_machines_has_records_of_each(known, found):
    mine = [one for name, one in found.items() if name.startswith("machines.") and not one.table.startswith("set.json")]
    assert all({record.partition("/")[0] for record in one.records} == {it.folder.name for it in known.sets} for one in mine) and len(mine) > 8


def test_the_appendix_has_the_first_record_of_each_number_and_a_table_has_all():
    both = "t/x", ("r/1.json", "r/2.json")
    found = {"a.one": Number("1", *both), "a.two": Number("2", *both), "b.one": Number("3", "f", ())}
    first, second = tables.of_numbers(found).splitlines()
    assert "r/\\allowbreak{}1 +1" in first and all(rf"{{where:{name}}}" in first for name in ("a.one", "a.two")) and "{where:b.one}" in second
    rows = pandas.read_csv(io.StringIO(tables.all_numbers(found)), keep_default_na=False)
    assert list(rows.records) == ["r/1.json r/2.json"] * 2 + [""]


def test_controls_are_those_by_which_the_set_is_judged(known, found):
    tables = [known.tables(part)["controls"] for part in machine.CONTROLLED]
    assert f"{sum(map(len, tables))} times a contender" in found["design.controls"].text
    assert f"{sum(table.decided.sum() for table in tables)} were falsely decided" in found["design.controls"].text


@pytest.mark.parametrize("typed", ["KLU takes 1.31 times as long.", "On 19 mechanisms it leads.", r"\caption{At $n=82$ it is fast.}",
                                   "10\\,µs a step", r"It takes \texttt{1.31} times as long.", r"\texttt{~12~µs} a step"])
def test_a_typed_number_is_found(found, typed):
    assert [one for one in wrong(in_text(typed), found) if "is typed" in one]


@pytest.mark.parametrize("name", ["four-bar:49,fill=0.50", "-{}-tolerance 1e-6", "results/set2/x.csv", r"\val{set.name}"])
def test_a_name_may_have_digits(found, name):
    assert wrong(in_text(rf"\texttt{{{name}}}"), found) == []


def test_a_measured_number_may_not_be_called_given(found):
    name, one = next((name, one) for name, one in found.items() if one.records and one.text.replace(".", "").isdigit() and len(one.text) > 3)
    assert any(f"is the measured number {name}" in line for line in wrong(in_text(rf"\given{{{one.text}}}"), found))


@pytest.mark.parametrize("addition, said", [
    (r"\val{real.nothing}", "the value 'real.nothing', which is not defined"), (r"\studytable{prizes}", "the table 'prizes', which is not defined"),
    (r"\studyfigure{f8}", "the figure 'f8', which is not defined"), (r"\holds{flat}", "the claim 'flat', which is not defined"),
    (r"\either{flat}{yes}{no}{unknown}", "the claim 'flat', which is not defined")])
def test_an_unknown_name_is_found(found, addition, said):
    assert any(said in line for line in wrong(in_text(addition), found))


def test_what_is_not_used_is_found(found):
    assert "the value 'real.more' is defined and not used" in wrong(TEXT, found | {"real.more": Number("3", "families/winners")})
    assert "the claim 'more' is defined and not used" in wrong(TEXT, found, CLAIMS | {"more": (True, "")})


@pytest.mark.parametrize("truth", [False, None])
def test_a_claim_that_does_not_hold_is_found(found, truth):
    assert any("the claim 'sparse' does not hold" in line for line in wrong(TEXT, found, CLAIMS | {"sparse": (truth, "")}))
    assert wrong(TEXT, found, CLAIMS | {"batches": (truth, "")}) == []  # for which the paper has a sentence each


@pytest.mark.parametrize("text, bibliography, said", [
    (TEXT + r"\cite{nobody}", BIBLIOGRAPHY, "no 'nobody'"), (TEXT.replace(r"\cite{amd}", ""), BIBLIOGRAPHY, "'amd' of references.bib is not cited"),
    (TEXT, BIBLIOGRAPHY.replace("doi = {10.1137/0805005}", "year = {1995}"), "'vanderbei1995' of references.bib has no DOI"),
    (TEXT + r"\tag{99}", BIBLIOGRAPHY, "no equation (99)")])
def test_references_and_equations(text, bibliography, said):
    assert any(said in line for line in audit.of_references(text, bibliography))


def test_a_dirty_or_mixed_or_stale_set_is_found(known, tmp_path):
    copy = Known(shutil.copytree(known.folder, tmp_path / known.folder.name))
    write_json(copy.folder / "set.json", known.facts | {"parts": ["realtime", "stability"]})  # all records take seconds to read
    assert all(" lacks " in fault for fault in store.faults(copy))
    context = next(path for path in sorted((copy.folder / "contexts").glob("*.json")))
    write_json(context, read_json(context) | {"dirty": "true", "commit": "0" * 40})
    digests = copy.folder / "realtime" / "tables.json"
    write_json(digests, read_json(digests) | {"records": "0" * 64})
    with open(copy.folder / "stability" / "windows.csv", "a", encoding="utf-8") as file:
        file.write("\n")
    said = "\n".join(store.faults(copy))
    for part in ("dirty tree", "another commit", "not those of its records", "windows.csv is not as it was written"):
        assert part in said


@pytest.fixture
def beside(known, tmp_path, monkeypatch):
    """The set in a results folder of its own as `first`, with others beside it whose facts are changed: name=facts."""
    monkeypatch.setattr(known_sets, "ROOT", tmp_path)
    monkeypatch.setattr(fragments, "main_set", lambda: tmp_path / "results" / "first")
    monkeypatch.setattr(audit, "faults", lambda one: [])  # of the records, which are the main set's: judged with it

    def change(**others):
        facts = read_json(known.folder / "set.json")
        for name, context in {"first": {}, **others}.items():
            (tmp_path / "results" / name).mkdir(parents=True)
            for path in known.folder.iterdir():
                if path.name != "set.json":
                    (tmp_path / "results" / name / path.name).symlink_to(path)
            write_json(tmp_path / "results" / name / "set.json", facts | {"context": facts["context"] | context})
        return Known(tmp_path / "results" / "first")
    return change


ANOTHER, OLD = {"cpu_model": "Another processor"}, {"commit": "0" * 40}


def names(sets):
    return [one.folder.name for one in sets]


def test_a_set_of_another_machine_and_the_same_build_is_compared(beside):
    both = beside(second=ANOTHER)
    assert list(audit.of_sets(both)) == [] and names(both.compared) == names(both.sets) == ["first", "second"]
    assert "Beside it, of the same build, to compare processors: `second`" in artifact.places(both, {}).set()
    assert f"on 2 processors (sets first, second, commit {both.context['commit'][:10]}) the same library is fastest" in fragments.fragment("cases")
    assert all(len(set(one.winners)) == 1 for one in both.agreed) and both.agreed
    count = numbers(both)
    assert count["machines.same"].text == count["machines.all"].text != "0" and count["machines.differ"].text == "0"
    assert (count["machines.rate"].text, count["machines.vector"].text) == ("1 on second", "1 on second")
    assert "Another processor" in tables.machines(both) and tables.differs(both) == "None."
    assert {"first", "second"} == set(audit.stamp(both)["tables"])


@pytest.mark.parametrize("context, said", [
    (ANOTHER | {"libraries": "Eigen 9"}, "libraries is 'Eigen 9'"),
    (ANOTHER | {"dirty": "true"}, "tree with changes"), ({}, "a set of this build already")])
def test_a_set_that_is_compared_with_none_is_refused(beside, context, said):
    other = beside(second=context)
    assert other.compared == [] and any(said in line and "remove it" in line for line in audit.of_sets(other))


def test_a_set_alone_is_compared_with_none(beside):
    alone = beside()
    assert alone.compared == [] and names(alone.sets) == ["first"] and "Beside" not in artifact.places(alone, {}).set()
    claimed, count = artifact.judged(alone), numbers(alone)
    assert [claimed[name][0] for name in ("compared", "machines", "vector")] == [None] * 3
    assert "`study/merge SET SET`" in artifact.places(alone, claimed).claims() and count["machines.first"].text == NOT_MEASURED
    assert "first" in tables.machines(alone) and "Not measured" in tables.differs(alone) and "processors" not in fragments.fragment("cases")


def test_sets_of_another_commit_wait_for_their_turn(beside):
    three = beside(newer=OLD, other=ANOTHER)
    assert names(three.compared) == names(three.sets) == ["first", "other"] and list(audit.of_sets(three)) == []


def test_a_set_of_another_commit_is_no_partner(beside):
    alone = beside(newer=ANOTHER | OLD)
    assert alone.compared == [] and artifact.judged(alone)["compared"][0] is None and list(audit.of_sets(alone)) == []


def test_built_files_of_another_set_are_found(known, tmp_path, monkeypatch):
    monkeypatch.setattr(audit, "STAMP", tmp_path / "set.json")
    assert list(audit.built(known)) == []  # nothing was built
    write_json(audit.STAMP, audit.stamp(known))
    assert list(audit.built(known)) == []
    write_json(audit.STAMP, audit.stamp(known) | {"set": "another"})
    assert "is of another at" in next(audit.built(known))


def test_an_old_artifact_is_found(known, tmp_path, monkeypatch):
    monkeypatch.setattr(artifact, "FILE", tmp_path / "ARTIFACT.md")
    artifact.FILE.write_text((ROOT / "paper" / "ARTIFACT.md").read_text(encoding="utf-8").replace("| claim |", "| claims |"), encoding="utf-8")
    claimed = artifact.judged(known)
    assert list(artifact.stale(known, claimed))
    assert artifact.refresh(known, claimed) and not list(artifact.stale(known, claimed))


def test_claims_are_told_of_a_set_that_has_a_few_parts(known, tmp_path):
    for name in ("set.json", "registry.json", "profile.yaml", "contexts", "realtime"):
        (tmp_path / name).symlink_to(known.folder / name)
    done = study("paper", "--claims", tmp_path)
    assert done.returncode == 0 and len(done.stdout.splitlines()) == len(claims())
    holds, said = claims()[-1].found(known)
    assert f"{artifact.SAYS[holds]}: {claims()[-1].text} ({said})" in done.stdout and f"not measured: {claims()[0].text}\n" in done.stdout


@pytest.mark.parametrize("verdicts, holds", [
    (["held", "held"], True), (["held", "held where measured"], None), (["held where measured", "not held"], False), (["held", "open"], False),
    (["not measured"], None)])
def test_batches_hold_where_all_of_them_do(verdicts, holds):
    row = {"what": "throughput of batches", "sign": "≥", "bound": 4.0, "worst": 4.0, "low": 4.0, "high": 4.0}
    rows = pandas.DataFrame([row | {"verdict": one} for one in verdicts])
    [claim] = [one for one in claims() if one.name == "batches"]
    assert claim.found(SimpleNamespace(tables=lambda part: {"held": rows}))[0] is holds


@pytest.mark.parametrize("pages, warning, said", [
    (12, "LaTeX Font Warning: Font shape `T1/x' undefined", ""), (9, "", "10 to 14 pages"), (15, "", "10 to 14 pages"),
    (12, "LaTeX Warning: Reference `tab:x' on page 3 undefined on input line 7.", "Reference `tab:x' on page 3 undefined"),
    (12, "LaTeX Warning: Citation 'who' on page 3 undefined on input line 7.", "Citation 'who' on page 3 undefined")])
def test_a_paper_of_too_many_pages_or_with_unknown_references_is_an_error(tmp_path, monkeypatch, capsys, pages, warning, said):
    monkeypatch.setattr(audit, "BUILD", tmp_path)
    monkeypatch.setattr(main.subprocess, "run", lambda *_, **__: SimpleNamespace(returncode=0, stdout=""))
    (tmp_path / "paper.log").write_text(f"{warning}\nOutput written on build/paper.pdf ({pages} pages, 1 bytes).\n")
    assert main.build() == (1 if said else 0) and said in capsys.readouterr().out


@pytest.fixture(scope="module")
def printed(known):
    """The map as the paper prints it."""
    draw, height = figures.DRAWN["map"]
    return figures.fit(draw(known), height)


def test_figures_are_of_print_size(printed):
    box = printed.get_tightbbox(printed.canvas.get_renderer())
    assert (box.width, box.height) == pytest.approx((figures.TEXT, figures.DRAWN["map"][1]), abs=0.03)


def test_steps_that_the_budget_dropped_are_counted(known):
    figure, rows = figures.steps(known), known.tables("realtime")["steps"]
    mine = rows[(rows.scheme == "penalty") & (rows.loops == 40) & rows.implementation.isin([one.get_text() for one in figure.axes[0].get_yticklabels()])]
    lost = int((mine.status == "dropped").sum())
    assert lost and f"not drawn: {lost} that the budget dropped" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_latex_prints_what_was_meant():
    assert tables.tex("`mbs` --step 2-3 -8.1 (-1e-6)") == r"\texttt{mbs} -{}-step 2-3 \(-\)8.1 (\(-\)1e-6)"


def test_letters_are_large_enough_to_print(printed):
    assert min(text.get_fontsize() for text in printed.findobj(Text) if text.get_text()) >= 6
    assert not re.findall(r"\\tiny|\\fontsize\{[0-5](?!\d)", TEXT)


def test_each_cell_of_the_map_names_its_winner_within_it(known, printed):
    axes, renderer = printed.axes[0], printed.canvas.get_renderer()
    cells = [one.get_window_extent(renderer) for one in axes.patches]
    boxes = [one.get_window_extent(renderer) for one in axes.texts]
    assert boxes and all(any(cell.x0 <= box.x0 < box.x1 <= cell.x1 and cell.y0 <= box.y0 < box.y1 <= cell.y1 and cell.height < 0.5 * axes.bbox.height
                             for cell in cells) for box in boxes)
    for text in axes.texts:
        name = re.match(r"[^?=]+?/[a-z]+", text.get_text().replace("\n", ""))[0]
        assert len([one for one in known.registry.variants if one.endswith(name)]) == 1, name


def test_winners_of_the_map_differ_in_grey(known):
    cells, look = known.tables("map")["cells"], Look(known.registry)
    greys = sorted(numpy.dot(to_rgb(look.colour(name)), (0.299, 0.587, 0.114))
                   for name in set(cells.winner[(cells.layer == "libraries") & (cells.winner != "")]))
    assert min(numpy.diff(greys)) > 0.08


def test_the_map_says_where_machines_agree(known, printed):
    labels = [text.get_text() for text in printed.legends[0].get_texts()]
    verdicts = [one for one in known.on_the_map.values() if one in maps.MARKS]
    marks = [line.get_marker() for line in printed.axes[0].lines if line.get_marker() in ("o", "X")]
    assert sorted(marks) == sorted(maps.MARKS[one][0] for one in verdicts) and {maps.MARKS[one][2] for one in verdicts} <= {*labels}


def test_a_set_that_is_not_stored_is_refused(tmp_path):
    done = study("paper", "--audit", tmp_path)
    assert done.returncode == 2 and "is no stored set" in done.stderr


def test_what_is_expected_has_its_interval():
    said = claims_.extreme([(1.2, 1.1, 1.3), (1.5, 1.4, 1.6), (2.0, 0.0, float("inf"))])
    assert said == "1.2 (1.1 to 1.3); 1 not bounded" and claims_.extreme([(1.2, 1.1, 1.3), (1.5, 1.4, 1.6)], most=True) == "1.5 (1.4 to 1.6)"


@pytest.mark.parametrize("status, holds", [("ok", True), ("diverged", False), ("dropped", None)])
def test_a_smaller_factor_may_be_ok(status, holds):
    maps_ = pandas.DataFrame({"loops": [1.0] * 2, "step": [1e-3] * 2, "precision": "double", "scheme": "penalty", "penalty_asked": ["1e5", "1e9"],
                              "status": [status, "ok"]})
    windows = pandas.DataFrame({"loops": [1.0], "step": [1e-3], "precision": ["double"], "lower": [1e7]})
    [claim] = [one for one in claims() if one.name == "cautious"]
    assert claim.found(SimpleNamespace(tables=lambda part: {"maps": maps_, "windows": windows}))[0] is holds


@pytest.mark.parametrize("share, fill, holds", [(0.8, 0.5, True), (0.4, 0.5, False), (0.8, None, None)])
def test_phases_of_filled_cells(share, fill, holds):
    shares = {f"phase_{phase}": [(1 - share) / 5] for phase in timing.PHASES} | {"phase_factorization": [share]}
    rows = pandas.DataFrame({"kind": ["phases"], "status": ["ok"], "fill_asked": [float("nan") if fill is None else fill], "variables": [10],
                             "implementation": ["hybrid_dense/llt"], "scene": ["four-bar:4"], "step_us": [2.0]} | shares)
    [claim] = [one for one in claims() if one.name == "filled"]
    assert claim.found(SimpleNamespace(tables=lambda part: {"tidy": rows}))[0] is holds


def test_without_an_interval_a_claim_is_not_measured():
    def of(found, name, **columns):
        return found(SimpleNamespace(tables=lambda part: {name: pandas.DataFrame(columns)}))[0]
    mixed = {"kind": ["precision"], "second": ["mixed"], "ratio": [0.5], "first_class": [1e-3], "second_class": [1e-3]}
    assert of(_mixed, "pairs", **mixed, low=[0.45], high=[0.55]) is False
    assert of(_mixed, "pairs", **mixed, low=[0.0], high=[float("inf")]) is None
    assert of(_mixed, "pairs", **mixed | {"second_class": [1e-2]}, low=[0.45], high=[0.55]) is None
    [engines], engine = [one.found for one in claims() if one.name == "engines"], {"side": ["library"], "ratio": [0.5], "low": [0.4]}
    assert of(engines, "equal_error", **engine, engine=["ode"], high=[0.6]) is False
    assert of(engines, "equal_error", **engine, engine=["ode"], high=[float("inf")]) is None
    assert of(engines, "equal_error", **engine, engine=["ode+native"], high=[0.6]) is None
