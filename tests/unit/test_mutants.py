"""The deliberate bugs of `make mutants` still have their places, and the tests that have to catch them are there."""

import ast
import re
from collections import Counter

from mutants import document
from mutants.catalogue import ROOT, catalogue, in_words

MUTANTS = catalogue()


def test_every_mutant_has_its_place_and_changes_something_that_still_is_python():
    wrong = []
    for mutant in MUTANTS:
        source = (ROOT / mutant.file).read_text()
        try:
            changed = [mutant.applied(source, size) for size in mutant.sizes or (None,)]
        except ValueError as error:
            wrong.append(str(error))
            continue
        assert source not in changed and len(set(changed)) == len(changed), mutant.name
        for each in changed:
            ast.parse(each, mutant.name)
    assert not wrong, "\n".join(wrong)


def test_the_tests_that_have_to_catch_them_are_there():
    for mutant in MUTANTS:
        assert mutant.tests, mutant.name
        for test in mutant.tests:
            path, _, name = test.partition("::")
            text = (ROOT / path).read_text()
            assert not name or re.search(rf"^def {name.partition('[')[0]}\(", text, re.MULTILINE), test


def test_there_are_enough_of_every_kind():
    assert len(MUTANTS) >= 120
    assert max(Counter(mutant.name for mutant in MUTANTS).values()) == 1
    rooms = Counter(mutant.file.split("/")[1] for mutant in MUTANTS)
    for room in ("optics", "slices", "engine", "models", "compare", "store", "cluster", "scene", "integration"):
        assert rooms[room] >= 4, room
    estimators = Counter(mutant.name.split("-")[0] for mutant in MUTANTS if mutant.room == "estimators")
    assert min(estimators[name] for name in ("connection", "split", "operator")) >= 5


def test_sizes_begin_with_the_largest():
    """That is the one that has to be caught."""
    for mutant in MUTANTS:
        # The cap is not a factor, and shows if it is low.
        biases = [abs(size - 1.0) for size in mutant.sizes if 0.1 < size < 10.0]
        assert biases == sorted(biases, reverse=True), mutant.name
    assert [in_words(size) for size in (0.5, 1.02, 1.0 + 1e-8, 50)] == ["0.5", "1.02", "1 + 1e-08", "50"]


def test_the_page_tells_how_large_the_bugs_are(tmp_path, monkeypatch):
    monkeypatch.setattr(document, "PATH", tmp_path / "mutants.md")
    graded = {mutant.name: mutant for mutant in MUTANTS if mutant.sizes}
    outcomes = [(each, "tests/x.py::test_x", each.sizes[:1], each.sizes[1]) for each in graded.values()]
    outcomes[0] = (*outcomes[0][:2], outcomes[0][0].sizes, None)
    document.write(outcomes)
    page = (tmp_path / "mutants.md").read_text()
    assert "SIZE" not in page and "empty where all of them were seen" in page
    assert "| The edges of rows are 0.0001 of a cell too low. |" in page
    assert "| row-edges-shifted | share of a cell | 0.0001 | 0.0001 | 1e-05 |" in page
    assert f"| {outcomes[0][0].name} | factor | 1.5 | 1.02 |  |" in page


def test_the_page_in_the_repository_has_no_gaps():
    assert "SIZE" not in document.PATH.read_text()
