"""Every way in which a command can fail has its message and its exit code."""

import pytest

from goniosim import errors
from goniosim.store import write_result
from synthetic import make_result


def _one_line(err, *words):
    assert err.endswith("\n")
    assert err.count("\n") == 1
    assert err.startswith("goniosim: error: ")
    assert all(word in err for word in words)


@pytest.fixture
def result_file(folder):
    write_result(make_result(), folder / "result.h5")
    return folder / "result.h5"


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (errors.OutputError, 4),
        (errors.ForeignFileError, 5),
        (errors.DamagedFileError, 6),
        (errors.NewerSchemaError, 7),
        (errors.UnusableResultError, 8),
        (errors.RefusalError, 10),
    ],
)
def test_known_errors_are_one_line_with_their_own_code(goniosim, monkeypatch, error, code):
    def fail(path):
        raise error(f"{path}: this is why")

    monkeypatch.setattr("goniosim.store.open_result", fail)
    outcome = goniosim("info", "x.h5")
    assert outcome == (code, "", "goniosim: error: x.h5: this is why\n")


def test_all_mistakes_of_a_scene_are_listed_and_counted(goniosim, folder):
    text = (folder / "scene.yaml").read_text()
    (folder / "scene.yaml").write_text(text.replace("alpha: 0.2", "alpha: 2").replace("tau: 0.2", "tau: -1"))
    code, out, err = goniosim("check", "scene.yaml")
    lines = err.splitlines()
    assert (code, out) == (3, "")
    assert [line.split(" ")[0] for line in lines[:3]] == ["scene.yaml:4:", "scene.yaml:5:", "scene.yaml:6:"]
    assert lines[3:] == ["goniosim: error: 3 mistakes"]


def test_a_single_mistake_is_not_several(goniosim, folder):
    code, _, err = goniosim("simulate", "absent.yaml")
    assert code == 3
    assert err.splitlines() == [
        "absent.yaml: there is no such file: check the path",
        "goniosim: error: 1 mistake",
    ]


@pytest.mark.parametrize("arguments", [[], ["nonsense"], ["simulate"], ["info", "--nonsense", "x"]])
def test_a_wrong_command_line_is_2(goniosim, arguments):
    code, _, err = goniosim(*arguments)
    assert code == 2
    assert "Usage: " in err


@pytest.mark.parametrize("number", ["1e7.5", "-3", "1.5", "nan", "1e400000000000000000000"])
def test_a_number_of_rays_that_is_none_is_2(goniosim, folder, number):
    code, _, err = goniosim("simulate", "scene.yaml", f"--rays={number}")
    assert code == 2
    assert "is not a whole number such as 10000000 or 1e7" in err


@pytest.mark.parametrize("option", ["--rays", "--seed"])
@pytest.mark.parametrize("number", ["1e99999999", "0e99999999", "9" * 5000])
def test_a_number_too_large_to_write_out_is_refused_at_once(goniosim, folder, option, number):
    code, _, err = goniosim("simulate", "scene.yaml", option, number)
    assert code == 2
    assert "is too large" in err and len(err) < 500


@pytest.mark.parametrize("number", ["1e99999999", "9" * 5000, "0x" + "f" * 5000, ".inf", str(2**63)])
def test_such_a_number_in_a_scene_is_3(goniosim, folder, number):
    text = (folder / "scene.yaml").read_text().replace("rays: 1e4", f"rays: {number}")
    (folder / "large.yaml").write_text(text)
    for arguments in (["large.yaml"], ["scene.yaml", "--set", f"simulation.rays={number}"]):
        code, _, err = goniosim("check", *arguments)
        assert code == 3
        assert err.splitlines()[-1] == "goniosim: error: 1 mistake" and len(err) < 1000


def test_output_that_cannot_be_written_is_4_before_anything_is_traced(goniosim, folder, monkeypatch):
    monkeypatch.setattr("goniosim.engine.warm_up", lambda scene: pytest.fail("too late"))
    (folder / "file").write_text("")
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "file/result.h5")
    assert (code, out) == (4, "")
    _one_line(err, "file")


def test_another_file_is_not_overwritten(goniosim, folder):
    code, _, err = goniosim("simulate", "scene.yaml", "-o", "study.yaml")
    assert code == 4
    _one_line(err, "study.yaml", "is not a goniosim result")
    assert (folder / "study.yaml").read_text().startswith("study:")


@pytest.mark.parametrize("command", ["info", "plot"])
def test_foreign_files_are_5(goniosim, folder, command):
    code, _, err = goniosim(command, "scene.yaml")
    assert code == 5
    _one_line(err, "scene.yaml")


@pytest.mark.parametrize("command", ["info", "plot"])
def test_damaged_files_are_6(goniosim, result_file, command):
    content = bytearray(result_file.read_bytes())
    content[len(content) // 2] ^= 1
    result_file.write_bytes(content)
    code, _, err = goniosim(command, result_file)
    assert code == 6
    _one_line(err, "result.h5")


def test_a_direction_that_is_not_there_is_8(goniosim, result_file):
    code, _, err = goniosim("plot", result_file, "--theta", "12.5")
    assert code == 8
    _one_line(err, "12.5", "0, 60")


def test_ctrl_c_during_any_command_is_130(goniosim, monkeypatch):
    def interrupt(path):
        raise KeyboardInterrupt

    monkeypatch.setattr("goniosim.store.open_result", interrupt)
    assert goniosim("info", "x.h5") == (130, "", "goniosim: interrupted\n")


@pytest.fixture
def bug(monkeypatch):
    def fail(path):
        raise ZeroDivisionError("of two\nlines")

    monkeypatch.setattr("goniosim.store.open_result", fail)


def test_a_bug_is_called_one(goniosim, bug):
    code, _, err = goniosim("info", "x.h5")
    assert code == 1
    _one_line(err, "ZeroDivisionError: of two lines", "bug in goniosim", "--debug")


@pytest.mark.parametrize("arguments", [["--debug", "info", "x.h5"], ["info", "x.h5", "--debug"]])
def test_debug_before_or_after_the_command_shows_the_traceback(goniosim, bug, arguments):
    code, _, err = goniosim(*arguments)
    assert code == 1
    assert err.startswith("Traceback (most recent call last):")
    assert "in fail" in err


def test_debug_shows_the_traceback_of_known_errors_too(goniosim, folder):
    code, _, err = goniosim("--debug", "info", "absent.h5")
    assert code == 5
    assert err.startswith("Traceback")
    assert err.splitlines()[-1].startswith("goniosim: error: absent.h5")


def test_a_reader_that_leaves_early_is_no_error(python, result_file):
    script = """
import os, sys
reading, writing = os.pipe()
os.close(reading)
os.dup2(writing, 1)
from goniosim_cli.main import main
main()
"""
    process = python(script, "info", result_file)
    _, err = process.communicate()
    assert (process.returncode, err) == (0, "")
