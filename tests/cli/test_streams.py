"""Standard streams that are closed, full, or that nobody reads cost no result and make no noise."""

import errno
import os
import subprocess
import sys
import threading

import pytest
from goniosim_cli import streams
from goniosim_cli.streams import _Lenient

from goniosim.store import open_result, write_result
from synthetic import make_result

GONIOSIM = f"{sys.executable} -c 'from goniosim_cli.main import main; main()'"
FULL = os.path.exists("/dev/full")


def _shell(command, folder, **variables):
    """Run a command line with ``{}`` for goniosim; return exit code, stdout, stderr."""
    run = subprocess.run(
        ["bash", "-c", command.format(GONIOSIM)],
        cwd=folder,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=300,
    )
    return run.returncode, run.stdout, run.stderr


def test_without_any_stream_the_result_is_whole(folder):
    """Its file does not become standard output or standard error."""
    code, _, _ = _shell("{} simulate scene.yaml -v 0<&- 1>&- 2>&-", folder)
    assert code == 0
    assert open_result(folder / "small.h5").status == "complete"


@pytest.mark.skipif(not FULL, reason="the system has no /dev/full")
def test_an_output_that_takes_nothing_is_said(folder):
    code, _, err = _shell("{} --help > /dev/full", folder)
    assert code == 4
    assert err == (
        "goniosim: error: standard output cannot be written: No space left on device; "
        "redirect it elsewhere (the files that this command writes are complete)\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("streams", "code"),
    [
        ("2>&-", 0),
        ("1>&-", 0),
        ("2>/dev/full", 0),
        (">/dev/full", 4),
        (">/dev/full 2>&1", 4),
        (">/dev/full 2>&-", 4),
        ("1</dev/null", 4),
        ("2>&1 | true; exit ${{PIPESTATUS[0]}}", 0),
        ("2> >(true)", 0),
    ],
)
def test_no_state_of_the_streams_costs_the_result(folder, streams, code):
    assert _shell(f"{{}} simulate scene.yaml -v {streams}", folder)[0] == code
    assert open_result(folder / "small.h5").status == "complete"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("{} info result.h5 > /dev/full", 4),
        ("{} info result.h5 1>&-", 0),
        ("{} nonsense 2> /dev/full", 2),
        ("{} nonsense 2>&-", 2),
        ("{} info absent.h5 2>&-", 5),
        ("{} info absent.h5 --debug 2> /dev/full", 5),
        ("{} plot result.h5 > /dev/full", 4),
    ],
)
def test_every_command_keeps_its_exit_code(folder, command, code):
    write_result(make_result(), folder / "result.h5")
    found, _, err = _shell(command, folder)
    assert found == code
    assert "Traceback" not in err and "Exception ignored" not in err


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
def test_names_are_printed_in_any_encoding(folder, encoding):
    write_result(make_result(), folder / "käse-π.h5")
    code, out, err = _shell("{} info käse-π.h5", folder, PYTHONIOENCODING=encoding)
    assert (code, err) == (0, "") and "se-" in out


@pytest.fixture
def raw():
    reading, writing = os.pipe()
    with _Lenient(writing, "w") as stream:
        yield reading, stream
    os.close(reading)


def test_a_stream_takes_what_it_is_given(raw):
    reading, stream = raw
    assert stream.write(b"one") == 3
    assert os.read(reading, 10) == b"one" and stream.error is None


def test_the_first_error_is_kept_and_nothing_more_is_tried(raw, monkeypatch):
    _, stream = raw
    monkeypatch.setattr(streams, "PATIENCE", 0.0)
    os.set_blocking(stream.fileno(), False)
    much = b"x" * 10_000_000
    assert stream.write(much) == len(much)
    assert stream.error.errno == errno.EAGAIN
    assert stream.write(b"more") == 4


def test_a_slow_reader_gets_everything(raw):
    reading, stream = raw
    os.set_blocking(stream.fileno(), False)
    much = bytes(range(256)) * 2000
    got = []

    def read():
        while sum(map(len, got)) < len(much):
            got.append(os.read(reading, 65536))

    reader = threading.Thread(target=read)
    reader.start()
    assert stream.write(much) == len(much)
    reader.join()
    assert b"".join(got) == much and stream.error is None


def test_messages_hold_no_control_characters(goniosim, folder):
    code, _, err = goniosim("info", "a\nb\x1b[31m\x9b.h5")
    assert code == 5
    assert err.startswith("goniosim: error: a\\nb\\x1b[31m\\x9b.h5: ") and err.count("\n") == 1
