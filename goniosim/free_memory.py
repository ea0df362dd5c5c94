"""How much memory this process may still take, as far as the system tells."""

from pathlib import Path

from .containers import groups, text

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

# Name of the limit and of the use in a memory group, and the entries of its statistics that make room when asked.
_V2 = ("memory.max", "memory.current", ("active_file", "inactive_file"))
_V1 = ("memory.limit_in_bytes", "memory.usage_in_bytes", ("total_active_file", "total_inactive_file"))


def free_memory(root: Path = Path("/")) -> tuple[int, str] | None:
    """Memory that this process may still take.

    Parameters
    ----------
    root : Path
        Where ``proc`` and ``sys`` are.

    Returns
    -------
    (int, str) or None
        Bytes, and what sets the limit; the least of the memory that is available, the limits of the containers
        around this process and its limit on address space. None where nothing is known.
    """
    found = [*_available(root), *_container(root), *_address_space(root)]
    return min(found, default=None)


def resident_memory(root: Path = Path("/")) -> int:
    """Bytes of memory that this process holds; 0 where unknown."""
    return _fields(root / "proc/self/status").get("VmRSS", 0)


def _available(root: Path) -> list[tuple[int, str]]:
    meminfo = _fields(root / "proc/meminfo")
    return [(meminfo["MemAvailable"], "available on this machine")] if "MemAvailable" in meminfo else []


def _container(root: Path) -> list[tuple[int, str]]:
    """What is left in this process's group and in those around it."""
    found = []
    for folder, is_first in groups("memory", root):
        found += _left(folder, *(_V1 if is_first else _V2))
    return [(left, "left of the container's limit") for left in found]


def _left(folder: Path, limit: str, use: str, reclaimable: tuple[str, ...]) -> list[int]:
    try:
        # A group without a limit says "max", or a number near 2^63.
        room = int(text(folder / limit)) - int(text(folder / use))
    except ValueError:
        return []
    rows = [line.split() for line in text(folder / "memory.stat").splitlines()]
    statistics = {row[0]: int(row[1]) for row in rows if len(row) == 2 and row[1].isdecimal()}
    return [max(0, room + sum(statistics.get(name, 0) for name in reclaimable))]


def _address_space(root: Path) -> list[tuple[int, str]]:
    size = _fields(root / "proc/self/status").get("VmSize")
    limit = resource.getrlimit(resource.RLIMIT_AS)[0] if resource else -1
    if size is None or limit < 0 or limit == resource.RLIM_INFINITY:
        return []
    return [(max(0, limit - size), "left of the limit on address space (ulimit -v)")]


def _fields(path: Path) -> dict[str, int]:
    """Entries such as ``VmRSS:  1234 kB``, in bytes."""
    rows = [line.split() for line in text(path).splitlines()]
    return {row[0].rstrip(":"): 1024 * int(row[1]) for row in rows if len(row) == 3 and row[2] == "kB"}
