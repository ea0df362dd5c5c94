"""Nobody but the user can put compiled code where it would be run."""

import os
import stat

import pytest

from goniosim._jit.folder import _NotOurs, private_folder

SOMEBODY_ELSE = 12345


def _mode(path):
    return stat.S_IMODE(os.stat(path).st_mode)


@pytest.fixture
def belongs_to(monkeypatch):
    """Let a folder seem to be another user's; only root could give it away for real."""
    owners = {}

    def pretend(path, uid=SOMEBODY_ELSE):
        owners[os.path.realpath(path)] = uid

    for name in ("stat", "lstat"):
        real = getattr(os, name)

        def answer(path, *arguments, real=real, **options):
            found = real(path, *arguments, **options)
            owner = owners.get(os.path.abspath(path)) if isinstance(path, (str, os.PathLike)) else None
            if owner is None:
                return found
            fields = list(found)
            fields[stat.ST_UID] = owner
            return os.stat_result(fields)

        monkeypatch.setattr(os, name, answer)
    return pretend


@pytest.fixture
def umask():
    """Everybody may read and write what is created."""
    before = os.umask(0)
    yield
    os.umask(before)


def test_every_level_is_for_the_user_alone(tmp_path, umask):
    found = private_folder(tmp_path / "cache", ["goniosim", "hash"])
    assert found == tmp_path / "cache" / "goniosim" / "hash"
    assert _mode(found) == _mode(found.parent) == 0o700
    (found / "kernel").write_text("kept")
    assert (private_folder(tmp_path / "cache", ["goniosim", "hash"]) / "kernel").exists()


def test_what_others_could_read_is_tightened(tmp_path):
    found = private_folder(tmp_path, ["goniosim", "hash"])
    for level in (found, found.parent):
        level.chmod(0o755)
    (found / "kernel").write_text("kept")
    assert private_folder(tmp_path, ["goniosim", "hash"]) == found
    assert _mode(found) == _mode(found.parent) == 0o700
    assert (found / "kernel").exists()


@pytest.mark.parametrize("level", ["goniosim", "goniosim/hash"])
def test_what_others_could_write_is_not_believed(tmp_path, level):
    """It stays, but out of the way."""
    planted = private_folder(tmp_path, ["goniosim", "hash"]) / "planted"
    planted.write_text("evil")
    (tmp_path / level).chmod(0o777)
    found = private_folder(tmp_path, ["goniosim", "hash"])
    assert list(found.iterdir()) == [] and _mode(found) == 0o700
    assert [path.read_text() for path in tmp_path.rglob("planted")] == ["evil"]


@pytest.mark.parametrize("level", ["goniosim", "goniosim/hash"])
def test_a_link_that_somebody_planted_is_refused(tmp_path, level):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / level).parent.mkdir(exist_ok=True)
    (tmp_path / level).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(_NotOurs, match="is not a folder"):
        private_folder(tmp_path, ["goniosim", "hash"])
    assert list((tmp_path / "elsewhere").iterdir()) == []


@pytest.mark.parametrize("level", ["goniosim", "goniosim/hash"])
def test_a_folder_of_somebody_else_is_refused(tmp_path, belongs_to, level):
    private_folder(tmp_path, ["goniosim", "hash"])
    belongs_to(tmp_path / level)
    with pytest.raises(_NotOurs, match=f"{level} belongs to another user"):
        private_folder(tmp_path, ["goniosim", "hash"])


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder away")
def test_a_folder_that_really_is_somebody_elses_is_refused(tmp_path):
    found = private_folder(tmp_path, ["goniosim", "hash"])
    os.chown(found, SOMEBODY_ELSE, SOMEBODY_ELSE)
    with pytest.raises(_NotOurs, match="belongs to another user"):
        private_folder(tmp_path, ["goniosim", "hash"])


def test_the_users_own_links_are_followed(tmp_path):
    """As where ~/.cache lies on another disk."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "cache").symlink_to(tmp_path / "disk")
    assert private_folder(tmp_path / "cache", ["goniosim"]) == tmp_path / "disk" / "goniosim"


def test_a_place_where_others_can_replace_folders_is_refused(tmp_path, belongs_to):
    """A shared place must have the sticky bit, as /tmp has, and belong to root or the user."""
    shared = tmp_path / "shared"
    (shared / "mine").mkdir(parents=True)
    shared.chmod(0o777)
    for parent in (shared, shared / "mine"):
        with pytest.raises(_NotOurs, match=f"others may change {shared}"):
            private_folder(parent, ["goniosim"])
    assert list(shared.rglob("goniosim")) == []
    shared.chmod(0o1777)
    assert private_folder(shared, ["goniosim"]) == shared / "goniosim"
    belongs_to(shared)
    with pytest.raises(_NotOurs, match=f"{shared} belongs to another user"):
        private_folder(shared, ["goniosim"])


def test_the_group_of_just_this_user_is_nobody_else(tmp_path, monkeypatch):
    """Many systems give each user a group of his own, and let it write by default."""
    shared = tmp_path / "shared"
    shared.mkdir()
    shared.chmod(0o775)
    monkeypatch.setattr("goniosim._jit.folder._is_private_group", lambda number: True)
    assert private_folder(shared, ["goniosim"]) == shared / "goniosim"
    monkeypatch.setattr("goniosim._jit.folder._is_private_group", lambda number: False)
    with pytest.raises(_NotOurs, match="others may change"):
        private_folder(shared, ["goniosim"])
