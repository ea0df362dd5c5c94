"""`goniosim hard`: table, JSON, Markdown, exit codes."""

import json
import os
from pathlib import Path

import pytest

from goniosim.errors import OutputError
from goniosim.hard import CASES, Case, check
from goniosim.hard.page import refuse_loss

NAME = "dark_stack"
OTHER = "smooth_stacks"


@pytest.fixture
def quick(monkeypatch):
    """Cases that are checked at once; returns the names of those that were."""
    done = []

    def of(name):
        def holds(scene):
            """Hold."""
            done.append(name)
            yield check.absolute("one", 1.0, 1.0, 0.5)

        return Case(name, "none", holds)

    for name in (NAME, OTHER):
        monkeypatch.setitem(CASES, name, of(name))
    return done


def test_one_case_as_a_table_and_as_markdown(goniosim, tmp_path):
    page = tmp_path / "pages" / "hard.md"
    code, out, _ = goniosim("hard", NAME, "-o", page)
    assert code == 0
    assert CASES[NAME].title in out and "1 case, " in out
    assert CASES[NAME].why in page.read_text()
    assert "| checked | expected | got | deviation | verdict |" in page.read_text()


def test_json_has_a_row_for_each_check(goniosim):
    code, out, err = goniosim("hard", NAME, "--json")
    found = json.loads(out)
    assert {row["case"] for row in found} == {NAME}
    assert {"case", "title", "seconds", "checked", "expected", "got", "deviation", "verdict"} <= found[0].keys()
    assert {row["verdict"] for row in found} == {"holds"}


def test_what_is_no_page_is_refused_before_the_work(goniosim, quick, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "thesis.md").write_text("# My thesis\n")
    (tmp_path / "empty.md").write_text("")
    (tmp_path / "old.md").write_text("# Hard cases\n")
    (tmp_path / "old.md").chmod(0o444)
    before = sorted(os.listdir(tmp_path))
    for name, why in {
        "pipe": "exists and is not a regular file, so it is not replaced",
        "thesis.md": "exists and is not a page of goniosim hard, so it is not overwritten",
        "empty.md": "exists and is not a page of goniosim hard",
        "old.md": "exists and is read-only, so it is not overwritten",
        ".": "Is a directory",
        "thesis.md/page.md": "the folder cannot be created: File exists",
    }.items():
        code, out, err = goniosim("hard", NAME, "-o", tmp_path / name)
        assert code == 4, name
        assert why in err and err.count("\n") == 1, name
    assert not quick and sorted(os.listdir(tmp_path)) == before
    assert (tmp_path / "pipe").is_fifo()


def test_no_stream_is_taken_for_a_file(goniosim, quick, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = goniosim("hard", NAME, "-o", "-")
    assert code == 2 and "the page is a file, not a stream" in err
    assert not quick and not os.listdir(tmp_path)


def test_a_page_is_replaced_by_one_of_the_same_cases_or_of_more(goniosim, quick, tmp_path):
    page = tmp_path / "hard.md"
    for names in ([NAME], [NAME], [NAME, OTHER]):
        assert goniosim("hard", *names, "-o", page)[0] == 0
    done = len(quick)
    code, out, err = goniosim("hard", NAME, "-o", page)
    assert code == 4 and len(quick) == done
    assert "holds 1 of the hard cases that the new page would not, so it is not overwritten" in err
    assert OTHER in page.read_text()


def test_make_hard_may_renew_the_page_of_the_documentation():
    page = Path(__file__).parents[2] / "docs" / "hard_cases.md"
    refuse_loss(page, CASES.values())
    with pytest.raises(OutputError, match="of the hard cases that the new page would not"):
        refuse_loss(page, [CASES[NAME]])


def test_overwrite_replaces_any_file_but_no_pipe(goniosim, quick, tmp_path):
    (tmp_path / "thesis.md").write_text("# My thesis\n")
    assert goniosim("hard", NAME, "-o", tmp_path / "thesis.md", "--overwrite")[0] == 0
    assert (tmp_path / "thesis.md").read_text().startswith("# Hard cases\n")
    os.mkfifo(tmp_path / "pipe")
    assert goniosim("hard", NAME, "-o", tmp_path / "pipe", "--overwrite")[0] == 4
    assert (tmp_path / "pipe").is_fifo()


def test_list_names_every_case_and_checks_none(goniosim):
    code, out, err = goniosim("hard", "--list")
    assert code == 0
    assert all(name in out for name in CASES)
    assert "holds" not in out
    code, out, err = goniosim("hard", "--list", "--json")
    assert code == 0
    assert json.loads(out) == [{"name": each.name, "topic": each.topic, "title": each.title} for each in CASES.values()]


@pytest.mark.parametrize(
    "name, remedy",
    {
        "dark_stak": "did you mean dark_stack?",
        "grazing": "did you mean alpha_meets_grazing, normal_to_grazing or mirror_from_normal_to_grazing?",
        "matched-index": "did you mean matched_index?",
        "configs/hard/matched_indx.yaml": "did you mean matched_index?",
        "xyz": "see goniosim hard --list",
        "_": "see goniosim hard --list",
        ".yaml": "see goniosim hard --list",
    }.items(),
)
def test_an_unknown_name_is_refused_with_what_was_meant(goniosim, name, remedy):
    code, out, err = goniosim("hard", name)
    assert code == 2
    assert f"{name}: no hard case has this name; {remedy}" in err


def test_the_path_of_a_scene_is_a_name(goniosim):
    code, out, err = goniosim("hard", "configs/hard/matched_index.yaml", "matched_index", "--list", "--json")
    assert code == 0
    assert [case["name"] for case in json.loads(out)] == ["matched_index"]


def test_a_failed_check_makes_the_exit_code_1(goniosim, monkeypatch):
    def fails(scene):
        """Fail."""
        yield check.absolute("one", 1.0, 2.0, 0.5)
        yield check.absolute("two", 2.0, 2.0, 0.5)
        yield check.absolute("three", 3.0, 2.0, 0.5)

    monkeypatch.setitem(CASES, NAME, Case(NAME, "none", fails))
    code, out, err = goniosim("hard", NAME)
    assert code == 1
    assert "1 case, 3 checks: 2 checks failed, in 1 case: dark_stack, in " in out
