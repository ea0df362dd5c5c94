"""Where compiled code is kept: a folder that is ours alone, named after the sources.

Numba's cache looks only at the file that holds a function, not at the functions inlined into
it. The folder is therefore named after a hash of every source file that may contain
compiled code: an edit anywhere means a new folder, never stale machine code.

What lies in the folder is run. So nobody else may be able to put anything there: every level that we
make is a real directory, owned by this user, of mode 700; and nobody but this user and root may
rename or replace the folders above it.
"""

import hashlib
import os
import platform
import secrets
import stat
import tempfile
from pathlib import Path

from .environment import numba_version

_PACKAGE = Path(__file__).resolve().parent.parent
_COMPILED = ("optics", "slices", "integration", "engine", "models")
_OTHERS = stat.S_IRWXG | stat.S_IRWXO

# Why a place was passed over or compiled code not kept, for those who ask: one line each.
notices = []


class _NotOurs(Exception):
    """Others could change what lies here."""


def source_hash():
    """Hash of all sources that may hold compiled code, of numba's version and of its setting."""
    digest = hashlib.sha256(f"{numba_version} {platform.python_version()}".encode())
    for folder in _COMPILED:
        for path in sorted((_PACKAGE / folder).rglob("*.py")):
            digest.update(str(path.relative_to(_PACKAGE)).encode())
            digest.update(path.read_bytes())
    digest.update(Path(__file__).with_name("__init__.py").read_bytes())
    return digest.hexdigest()[:16]


def cache_folder():
    """First usable of: $NUMBA_CACHE_DIR, $XDG_CACHE_HOME or ~/.cache, the system's temporary folder.

    Returns
    -------
    Path or None
        None if there is no such place: then every run compiles anew.
    """
    name = source_hash()
    for find, levels in ((_chosen, ()), (_home, ()), (_temporary, (f"cache-{_user()}",))):
        parent = None
        try:
            parent = find()
            if parent is not None:
                return private_folder(Path(parent), [*levels, "goniosim", name])
        except (OSError, _NotOurs) as error:
            reason = getattr(error, "strerror", None) or error
            notices.append(f"compiled code is not kept in {parent or 'a temporary folder'}: {reason}")
    return None


def _chosen():
    return os.environ.get("NUMBA_CACHE_DIR") or None


def _home():
    folder = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(folder):
        folder = os.path.expanduser("~/.cache")
    # Still a tilde if nobody knows where this user is at home.
    return folder if os.path.isabs(folder) else None


def _temporary():
    return tempfile.gettempdir()


def _user():
    return os.getuid() if hasattr(os, "getuid") else "user"


def private_folder(parent, names):
    """Make a folder below another, each level of it ours alone.

    Parameters
    ----------
    parent : Path
        Belongs to the user; created if it is missing, may be a link.
    names : list of str
        The levels below it.

    Returns
    -------
    Path

    Raises
    ------
    OSError
        The folder cannot be made, or takes no files.
    _NotOurs
        Somebody else could put files there.
    """
    for missing in reversed([level for level in (parent, *parent.parents) if not level.exists()]):
        missing.mkdir(0o700, exist_ok=True)
    # Links are followed now and never again.
    folder = Path(os.path.realpath(parent))
    if os.name == "posix":
        for above in (folder, *folder.parents):
            _check_above(above)
    for name in names:
        folder = folder / name
        _make_level(folder)
    with tempfile.TemporaryFile(dir=folder):
        return folder


def _check_above(folder):
    """Make sure that nobody but the user and root can replace what lies in a folder of the user's choice."""
    found = os.stat(folder)
    # In a container root may have another number, but the root of all folders is still root's.
    if found.st_uid not in (os.getuid(), 0, os.stat("/").st_uid):
        raise _NotOurs(f"{folder} belongs to another user")
    # Where the sticky bit is set, as in /tmp, everybody may add files, but only replace his own.
    if _others_may_write(found) and not found.st_mode & stat.S_ISVTX:
        raise _NotOurs(f"others may change {folder}")


def _others_may_write(found):
    if found.st_mode & stat.S_IWOTH:
        return True
    return bool(found.st_mode & stat.S_IWGRP) and not _is_private_group(found.st_gid)


def _is_private_group(number):
    """Whether a group holds just this user, as many systems give one to each."""
    import grp
    import pwd

    try:
        group, user = grp.getgrgid(number), pwd.getpwuid(os.getuid())
    except KeyError:
        return False
    return group.gr_name == user.pw_name and set(group.gr_mem) <= {user.pw_name}


def _make_level(folder):
    try:
        os.mkdir(folder, 0o700)
    except FileExistsError:
        _take_over(folder)


def _take_over(folder):
    """Use a folder that is there already, if it is ours."""
    found = os.lstat(folder)
    if not stat.S_ISDIR(found.st_mode):
        raise _NotOurs(f"{folder} is not a folder")
    if os.name != "posix":
        return
    if found.st_uid != os.getuid():
        raise _NotOurs(f"{folder} belongs to another user")
    if found.st_mode & _OTHERS:
        os.chmod(folder, 0o700)
    if _others_may_write(found):
        # Who knows what others left in it: it stays, but out of the way.
        os.rename(folder, folder.with_name(f"{folder.name}.{secrets.token_hex(4)}.untrusted"))
        os.mkdir(folder, 0o700)


CACHE_FOLDER = cache_folder()
