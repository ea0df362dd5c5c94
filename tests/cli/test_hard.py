"""`goniosim hard`: table, JSON, Markdown, exit codes."""

import json

from goniosim.hard import CASES, Case, check

NAME = "dark_stack"


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
    assert {"case", "checked", "expected", "got", "deviation", "verdict"} <= found[0].keys()
    assert {row["verdict"] for row in found} == {"holds"}


def test_list_names_every_case_and_checks_none(goniosim):
    code, out, err = goniosim("hard", "--list")
    assert code == 0
    assert all(name in out for name in CASES)
    assert "holds" not in out


def test_an_unknown_name_is_refused_with_the_nearest(goniosim):
    code, out, err = goniosim("hard", "dark_stak")
    assert code == 3
    assert "dark_stak: no hard case has this name; did you mean dark_stack?" in err


def test_a_failed_check_makes_the_exit_code_1(goniosim, monkeypatch):
    def fails(scene):
        """Fail."""
        yield check.absolute("one", 1.0, 2.0, 0.5)

    monkeypatch.setitem(CASES, NAME, Case(NAME, "none", fails))
    code, out, err = goniosim("hard", NAME)
    assert code == 1
    assert "1 failed: dark_stack" in out
