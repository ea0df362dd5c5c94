"""The control groups around this process, which limit what it may take of the machine."""

from collections.abc import Iterator
from pathlib import Path


def groups(controller: str, root: Path = Path("/")) -> Iterator[tuple[Path, bool]]:
    """Folders of this process's groups of a controller and of those around them, from the inside out.

    Parameters
    ----------
    controller : str
        ``memory`` or ``cpu``.
    root : Path
        Where ``proc`` and ``sys`` are.

    Yields
    ------
    folder : Path
    is_first : bool
        Whether it is a group of version 1, whose files have other names.
    """
    for line in text(root / "proc/self/cgroup").splitlines():
        _, _, rest = line.partition(":")
        controllers, mark, path = rest.partition(":")
        # What stands in for the kernel in some containers may say other things here.
        if not mark or (controllers and controller not in controllers.split(",")):
            continue
        top = root / "sys/fs/cgroup" / (controller if controllers else "")
        group = top / path.lstrip("/")
        # Within a container its own group is at the top, whatever its path is outside.
        for folder in (group, *group.parents):
            if folder == top.parent:
                break
            yield folder, bool(controllers)


def text(path: Path) -> str:
    """What a file of the kernel says; nothing if it cannot be read."""
    try:
        return path.read_text()
    except (OSError, UnicodeDecodeError):
        return ""
