"""Files appear whole or not at all, and what goes wrong is said in one line."""

import errno
import os

import pytest

from goniosim.errors import OutputError
from goniosim.writing import make_folder, printable, replacing, write_text


def test_a_file_appears_whole_and_leaves_nothing_beside_it(tmp_path):
    write_text(tmp_path / "file.txt", "first\n")
    with replacing(tmp_path / "file.txt") as temporary:
        temporary.write_text("second\n")
        assert (tmp_path / "file.txt").read_text() == "first\n"
        # Nobody takes it for the finished file.
        assert temporary.name.startswith(".") and temporary.suffix == ".part"
    assert (tmp_path / "file.txt").read_text() == "second\n"
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]


@pytest.mark.parametrize("error", [ValueError("a bug"), KeyboardInterrupt()])
def test_an_earlier_file_survives_what_goes_wrong(tmp_path, error):
    write_text(tmp_path / "file.txt", "first\n")
    with pytest.raises(type(error)), replacing(tmp_path / "file.txt") as temporary:
        temporary.write_text("half of the sec")
        raise error
    assert (tmp_path / "file.txt").read_text() == "first\n"
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]


def test_a_full_disk_is_explained(tmp_path):
    write_text(tmp_path / "file.txt", "first\n")
    refused = pytest.raises(OutputError, match="file.txt: cannot be written: No space left.*free some space")
    with refused, replacing(tmp_path / "file.txt"):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]


def test_errors_without_a_number_are_explained_too(tmp_path):
    """Those of HDF5 have a text only, and it may have several lines."""
    refused = pytest.raises(OutputError, match="cannot be written: unable to flush the file; check the permissions")
    with refused, replacing(tmp_path / "file.txt"):
        raise OSError("unable to flush\nthe file")


def test_a_folder_in_the_way(tmp_path):
    (tmp_path / "file.txt").mkdir()
    with pytest.raises(OutputError, match="file.txt: cannot be written: Is a directory"):
        write_text(tmp_path / "file.txt", "text")
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]
    (tmp_path / "plain").write_text("")
    with pytest.raises(OutputError, match="the folder cannot be created: Not a directory"):
        make_folder(tmp_path / "plain" / "folder")


def test_a_link_stays_a_link_and_long_names_fit(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link.txt").symlink_to(tmp_path / "real" / "file.txt")
    write_text(tmp_path / "link.txt", "text")
    assert (tmp_path / "link.txt").is_symlink() and (tmp_path / "real" / "file.txt").read_text() == "text"
    write_text(tmp_path / ("n" * 255), "text")
    assert (tmp_path / ("n" * 255)).read_text() == "text"


def test_a_terminal_shows_and_does_not_obey():
    assert printable("\x1b[2J\x9b1m\x7f\n\t\u202e\udce9 µ 漆") == "\\x1b[2J\\x9b1m\\x7f\\n\\t\\u202e\\udce9 µ 漆"
    assert printable("a" * 300, most=200) == "a" * 200 + "..." and printable("abc", most=3) == "abc"


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir])
def test_what_is_no_file_is_refused_before_the_work_and_after_it(tmp_path, make):
    """As root a device of the system would be gone for good."""
    make(tmp_path / "there")
    with (
        pytest.raises(OutputError, match="exists and is not a regular file|Is a directory"),
        replacing(tmp_path / "there"),
    ):
        pytest.fail("nothing is written that cannot be put into place")
    with (
        pytest.raises(OutputError, match="exists and is not a regular file|Is a directory"),
        replacing(tmp_path / "later"),
    ):
        make(tmp_path / "later")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["later", "there"]
    assert not any(path.is_file() for path in tmp_path.iterdir())


def test_a_link_to_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(tmp_path / "pipe")
    with pytest.raises(OutputError, match="link: exists and is not a regular file"):
        write_text(tmp_path / "link", "text")
    assert (tmp_path / "pipe").is_fifo()


def test_a_read_only_file_is_refused_by_whoever_it_is(tmp_path):
    write_text(tmp_path / "file.txt", "first\n")
    (tmp_path / "file.txt").chmod(0o444)
    with pytest.raises(OutputError, match="exists and is read-only"):
        write_text(tmp_path / "file.txt", "second\n")
    assert (tmp_path / "file.txt").read_text() == "first\n"
