"""What the operating system refuses is one line with its remedy, wherever it comes up."""

import errno
import os
import threading

import pytest

from goniosim import cores
from goniosim.errors import OutputError, RefusalError
from goniosim.report.drawing import studio
from goniosim.store import reserve_output, write_result
from synthetic import make_result

LONG = "n" * 300


def _refused(outcome, code, *words):
    found, out, err = outcome
    assert (found, out) == (code, "")
    assert err.startswith("goniosim: error: ") and err.count("\n") == 1
    assert "bug" not in err
    assert all(word in err for word in words)


@pytest.fixture
def no_tracing(monkeypatch):
    monkeypatch.setattr("goniosim.engine.warm_up", lambda scene: pytest.fail("too late"))


@pytest.mark.parametrize("output", [f"{LONG}.h5", f"{LONG}/a.h5", f"new/{LONG}/a.h5"])
def test_a_name_that_is_too_long_is_refused_before_tracing(goniosim, folder, no_tracing, output):
    _refused(goniosim("simulate", "scene.yaml", "-o", output), 4, "File name too long", "choose a shorter name")


@pytest.mark.parametrize("output", ["loop", "loop/a.h5", "scene.yaml/a.h5", "."])
def test_a_path_that_leads_nowhere_is_refused_before_tracing(goniosim, folder, no_tracing, output):
    (folder / "loop").symlink_to("loop")
    _refused(goniosim("simulate", "scene.yaml", "-o", output), 4, output.split("/")[0])
    assert sorted(path.name for path in folder.iterdir()) == ["loop", "scene.yaml", "study.yaml"]


def test_a_link_to_itself_is_named_as_such(folder):
    (folder / "loop").symlink_to("loop")
    with pytest.raises(OutputError, match="symbolic links.*mend the links"):
        reserve_output("loop", 100)


@pytest.mark.parametrize("command", ["info", "plot", "compare"])
@pytest.mark.parametrize("name", [LONG, f"{LONG}/a", "scene.yaml/a"])
def test_results_that_cannot_be_opened_are_5(goniosim, folder, command, name):
    _refused(goniosim(command, name), 5, "cannot be opened")


def test_folders_of_figures_and_reports_are_outputs(goniosim, folder):
    write_result(make_result(), folder / "r.h5")
    for command in ("plot", "compare"):
        _refused(goniosim(command, "r.h5", "-o", LONG), 4, "File name too long", "choose a shorter name")
        _refused(goniosim(command, "r.h5", "-o", "scene.yaml"), 4, "scene.yaml", "choose another place")
    os.rename("r.h5", f"{'n' * 251}.h5")
    for command in ("plot", "compare"):
        _refused(goniosim(command, f"{'n' * 251}.h5"), 4, "File name too long", "choose a shorter name")


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (OSError(errno.EMFILE, os.strerror(errno.EMFILE), "a.h5"), 10, ("a.h5: Too many open files", "ulimit -n")),
        (BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN)), 10, ("temporarily unavailable", "ulimit -u")),
        (BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE)), 10, ("Broken pipe",)),
        (FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT)), 10, ("current folder is gone", "cd")),
        (MemoryError(), 4, ("memory ran out", "fewer or smaller files")),
    ],
)
def test_what_nobody_foresaw_is_no_bug(goniosim, monkeypatch, error, code, words):
    def refuse(path):
        raise error

    monkeypatch.setattr("goniosim.store.open_result", refuse)
    _refused(goniosim("info", "x.h5"), code, *words)


@pytest.fixture
def few_threads(monkeypatch):
    """The system starts two threads and no more."""
    start = threading.Thread.start
    running = []

    def limited(thread):
        running[:] = [other for other in running if other.is_alive()]
        if len(running) == limited.most:
            raise RuntimeError("can't start new thread")
        start(thread)
        running.append(thread)

    limited.most = 2
    monkeypatch.setattr(threading.Thread, "start", limited)
    return limited


def test_fewer_threads_where_fewer_are_granted(few_threads):
    assert cores.granted_threads(1) == 1
    assert cores.granted_threads(8) == 2
    few_threads.most = 0
    with pytest.raises(RefusalError, match="ulimit -u"):
        cores.granted_threads(8)


def test_a_simulation_makes_do_with_the_threads_it_gets(goniosim, folder, few_threads):
    # One more gives signs of life to other processes.
    few_threads.most = 3
    code, _, _ = goniosim("simulate", "scene.yaml", "-q", "--threads", "8", "-o", "few.h5")
    assert code == 0
    code, out, _ = goniosim("info", "few.h5")
    assert code == 0 and "threads            2" in " ".join(out.split("\n"))


def test_the_last_thread_is_for_the_work(goniosim, folder, few_threads):
    few_threads.most = 1
    assert goniosim("simulate", "scene.yaml", "-q", "--threads", "8") == (0, "", "")


def test_without_a_thread_a_simulation_is_refused(goniosim, folder, few_threads):
    few_threads.most = 0
    _refused(goniosim("simulate", "scene.yaml", "-q"), 10, "the system starts no thread")


def test_why_compiled_code_is_not_kept_is_said_to_those_who_ask(goniosim, folder, monkeypatch):
    monkeypatch.setattr("goniosim._jit.folder.notices", ["compiled code is not kept in /x: others may change /x"])
    for verbose in (False, True):
        code, _, err = goniosim("simulate", "scene.yaml", "--rays", "1e3", "-o", f"{verbose}.h5", *["-v"] * verbose)
        assert code == 0 and ("others may change /x" in err) == verbose


def _draw(path):
    from matplotlib.figure import Figure

    return Figure()


def test_figures_are_drawn_here_where_there_are_no_processes_to_share(tmp_path, monkeypatch):
    """As without /dev/shm, and where no further process is granted."""

    def refuse(*arguments):
        raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))

    monkeypatch.setattr(studio, "ProcessPoolExecutor", refuse)
    made = studio.Studio(2)
    assert made.draw([(tmp_path / "a", ("png",), _draw, None)]) == [tmp_path / "a.png"]
    made.close()

    class Refusing:
        submit = refuse

        def shutdown(self, **options):
            pass

    monkeypatch.setattr(studio, "ProcessPoolExecutor", lambda *arguments: Refusing())
    made = studio.Studio(2)
    assert made.draw([(tmp_path / "b", ("png",), _draw, None)]) == [tmp_path / "b.png"]
    made.close()


@pytest.mark.slow
def test_settings_of_matplotlib_change_nothing(start, folder, monkeypatch):
    """Neither a backend that does not exist, nor files of settings that are odd, wrong, or no text at all."""
    write_result(make_result(), folder / "r.h5")
    (folder / "odd").write_bytes(b"lines.linewidth: 9\nfont.size: abc\n")
    (folder / "no-text").write_bytes(b"font.size: \xff\n")
    settings = ["MPLBACKEND=", "MPLBACKEND=foo", "MATPLOTLIBRC=odd", "MATPLOTLIBRC=no-text", "MPLCONFIGDIR=/proc/x"]
    drawn = []
    for setting in settings:
        with monkeypatch.context() as changed:
            changed.setenv(*setting.split("="))
            process = start("plot", "r.h5", "-o", "figures", "--theta", "60")
            _, err = process.communicate(timeout=120)
        assert (process.returncode, err) == (0, ""), setting
        drawn.append([path.read_bytes() for path in sorted((folder / "figures").iterdir())])
    assert all(each == drawn[0] for each in drawn)


def test_a_date_for_reproducible_builds_is_none_of_the_figures(goniosim, folder, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "abc")
    write_result(make_result(rows=2, columns=4), folder / "r.h5")
    code, _, err = goniosim("plot", "r.h5", "--theta", "60", "--format", "pdf")
    assert (code, err) == (0, "") and os.environ["SOURCE_DATE_EPOCH"] == "abc"
