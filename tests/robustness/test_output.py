"""An output that cannot be written is found before the computation; finished work is never lost."""

import errno
import os
import resource
import stat
import subprocess
import sys
import textwrap

import pytest

from goniosim.errors import OutputError
from goniosim.store import open_result, reserve_output, write_result
from synthetic import make_result


@pytest.fixture
def folder(tmp_path):
    """An empty folder for outputs."""
    (tmp_path / "out").mkdir()
    return tmp_path / "out"


@pytest.fixture
def rescued(tmp_path, monkeypatch):
    """A temporary directory in which nothing lies yet."""
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    return tmp_path / "temporary"


def refusal(path, size=1000):
    """The one line with which a reservation is refused."""
    with pytest.raises(OutputError) as caught:
        reserve_output(path, size)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    return message


def test_reserved_and_written(folder):
    with reserve_output(folder / "r.h5", 5_000_000) as reservation:
        (temporary,) = folder.iterdir()
        assert temporary.name.startswith(".r.h5.") and temporary.stat().st_size == 5_000_000
        write_result(make_result(name="first"), folder / "r.h5", reservation=reservation)
    assert [path.name for path in folder.iterdir()] == ["r.h5"]
    assert open_result(folder / "r.h5").name == "first"


def test_a_file_larger_than_predicted(folder):
    with reserve_output(folder / "r.h5", 1) as reservation:
        write_result(make_result(), folder / "r.h5", reservation=reservation)
    assert open_result(folder / "r.h5").name == "synthetic"


def test_released(folder):
    """By hand, twice, and by an exception on the way."""
    reservation = reserve_output(folder / "r.h5", 1000)
    reservation.release()
    reservation.release()
    with pytest.raises(KeyboardInterrupt), reserve_output(folder / "r.h5", 1000):
        raise KeyboardInterrupt
    assert list(folder.iterdir()) == []


def test_an_earlier_result_is_replaced(folder):
    write_result(make_result(name="first"), folder / "r.h5")
    with reserve_output(folder / "r.h5", 1000):
        assert open_result(folder / "r.h5").name == "first"
    write_result(make_result(name="second"), folder / "r.h5")
    assert open_result(folder / "r.h5").name == "second"
    assert len(list(folder.iterdir())) == 1


def test_a_damaged_result_is_replaced(folder):
    write_result(make_result(), folder / "r.h5")
    (folder / "r.h5").write_bytes((folder / "r.h5").read_bytes()[:4000])
    write_result(make_result(), folder / "r.h5")
    assert open_result(folder / "r.h5").name == "synthetic"


def test_a_link_stays_a_link(folder):
    (folder / "real").mkdir()
    (folder / "link.h5").symlink_to(folder / "real" / "r.h5")
    write_result(make_result(), folder / "link.h5")
    assert (folder / "link.h5").is_symlink()
    assert open_result(folder / "real" / "r.h5").name == "synthetic"


def test_relative_and_long_names(folder, monkeypatch):
    """255 bytes are the limit for a name; the temporary file needs one too."""
    monkeypatch.chdir(folder)
    for name in ("r.h5", "x" * 252 + ".h5"):
        write_result(make_result(), name)
        assert open_result(name).name == "synthetic"


def test_the_umask_decides_who_may_read(folder):
    before = os.umask(0o027)
    try:
        write_result(make_result(), folder / "r.h5")
    finally:
        os.umask(before)
    assert stat.S_IMODE((folder / "r.h5").stat().st_mode) == 0o640


def test_a_foreign_file_is_kept(folder, rescued):
    for content in (b"my thesis", b""):
        (folder / "r.h5").write_bytes(content)
        assert "not a goniosim result" in refusal(folder / "r.h5")
        with pytest.raises(OutputError, match="not a goniosim result"):
            write_result(make_result(), folder / "r.h5")
        assert (folder / "r.h5").read_bytes() == content
    assert len(list(folder.iterdir())) == 1


def test_a_foreign_file_that_appears_meanwhile_is_kept(folder, rescued):
    with reserve_output(folder / "r.h5", 1000) as reservation:
        (folder / "r.h5").write_bytes(b"my thesis")
        with pytest.raises(OutputError, match="the result was saved as"):
            write_result(make_result(), folder / "r.h5", reservation=reservation)
    assert (folder / "r.h5").read_bytes() == b"my thesis"
    assert len(list(folder.iterdir())) == 1


def test_places_that_take_no_file(folder):
    """Also for the administrator, whom permissions do not stop."""
    (folder / "file").write_bytes(b"")
    assert "is a folder" in refusal(folder)
    assert "does not exist" in refusal(folder / "missing" / "r.h5")
    assert "is not a folder" in refusal(folder / "file" / "r.h5")
    assert "takes no new file" in refusal("/proc/r.h5")
    assert "not a goniosim result" in refusal("/dev/null")


@pytest.mark.skipif(os.geteuid() == 0, reason="permissions do not stop the administrator")
def test_a_folder_without_permission(folder):
    folder.chmod(0o500)
    assert "Permission denied" in refusal(folder / "r.h5")


def test_no_room(folder):
    """No disk has an exbibyte."""
    message = refusal(folder / "r.h5", 2**60)
    assert "no room for about" in message and "choose another place" in message
    assert list(folder.iterdir()) == []


def test_no_room_where_nothing_can_be_allocated_ahead(folder, monkeypatch):
    def unsupported(*_):
        raise OSError(errno.EOPNOTSUPP, "not supported")

    monkeypatch.setattr(os, "posix_fallocate", unsupported)
    assert "no room for about" in refusal(folder / "r.h5", 2**60)
    monkeypatch.delattr(os, "posix_fallocate")
    assert "no room for about" in refusal(folder / "r.h5", 2**60)
    assert list(folder.iterdir()) == []
    with reserve_output(folder / "r.h5", 1000) as reservation:
        write_result(make_result(), folder / "r.h5", reservation=reservation)
    assert open_result(folder / "r.h5").name == "synthetic"


def test_finished_work_is_rescued(folder, rescued):
    """The folder disappears while the rays are traced."""
    reservation = reserve_output(folder / "r.h5", 1000)
    (temporary,) = folder.iterdir()
    temporary.unlink()
    folder.rmdir()
    with pytest.raises(OutputError) as caught:
        write_result(make_result(name="long-work"), folder / "r.h5", reservation=reservation)
    (saved,) = rescued.iterdir()
    assert f"the result was saved as {saved} instead" in str(caught.value)
    assert open_result(saved).name == "long-work"


def test_finished_work_is_rescued_without_a_reservation(folder, rescued):
    with pytest.raises(OutputError, match="does not exist.*the result was saved as"):
        write_result(make_result(name="long-work"), folder / "missing" / "r.h5")
    (saved,) = rescued.iterdir()
    assert open_result(saved).name == "long-work"


def test_full_disk_at_the_end(folder, rescued, monkeypatch):
    """The disk fills up after the check: the earlier result survives, the new one is rescued.

    It is full as long as the temporary file lies beside the earlier result.
    """
    write_result(make_result(name="first"), folder / "r.h5")
    pwrite = os.pwrite
    with reserve_output(folder / "r.h5", 1000) as reservation:

        def full(descriptor, data, position):
            if position > 0 and len(list(folder.iterdir())) > 1:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return pwrite(descriptor, data[:100_000], position)

        monkeypatch.setattr(os, "pwrite", full)
        with pytest.raises(OutputError, match="No space left.*the result was saved as"):
            write_result(make_result(name="second"), folder / "r.h5", reservation=reservation)
    assert [path.name for path in folder.iterdir()] == ["r.h5"]
    assert open_result(folder / "r.h5").name == "first"
    assert open_result(next(rescued.iterdir())).name == "second"


LIMITED = """
    import resource, sys, tempfile
    sys.path.insert(0, {tests!r})
    from pathlib import Path
    from synthetic import make_result
    from goniosim.errors import OutputError
    from goniosim.store import reserve_output, write_result

    folder = Path({folder!r})
    tempfile.tempdir = str(folder)
    limit = 20_000
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    path = folder / "r.h5"
    for attempt in (
        lambda: reserve_output(path, 10 * limit),
        lambda: write_result(make_result(), path),
        lambda: write_result(make_result(), path, reservation=reserve_output(path, limit)),
    ):
        try:
            attempt()
        except OutputError as error:
            print(error)
        print(sorted(path.name for path in folder.iterdir()))
"""


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="the system has no limit on file sizes")
def test_limit_on_file_sizes(folder):
    """A real write that really fails, in a process of its own: the signal is ignored, the error is ours.

    No place takes the file here, so the message must say that the rescue failed as well.
    """
    tests = os.path.dirname(os.path.dirname(__file__))
    script = textwrap.dedent(LIMITED).format(tests=tests, folder=str(folder))
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert run.stderr == ""
    reserved, _, written, _, used, _ = run.stdout.splitlines()
    assert "no room for about 0.2 MB" in reserved
    assert "no room for about" in written and "nor could the result be saved" in written
    assert "cannot be written: File too large" in used and "nor could the result be saved" in used
    assert run.stdout.splitlines()[1::2] == ["[]"] * 3


def test_a_result_that_is_read_only_is_not_replaced(folder):
    write_result(make_result(), folder / "r.h5")
    (folder / "r.h5").chmod(0o444)
    assert "is read-only" in refusal(folder / "r.h5")
