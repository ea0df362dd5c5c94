"""Who is at work on something, as he says of himself in the file of his claim."""

import json
import os
import secrets
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from ..owners import boot, numbering, start_of
from ..writing import printable

# What a claim says, and of which kind it is.
_KINDS = {"host": str, "pid": int, "since": str, "boot": str, "numbering": str, "started": str, "locked": bool}
_LONGEST = 64


@dataclass(frozen=True)
class Owner:
    """A process that is at work on something.

    Attributes
    ----------
    host : str
        Name of its machine.
    pid : int
    since : str
        When it began, by its own clock.
    """

    host: str = "unknown"
    pid: int = 0
    since: str = "unknown"

    def __str__(self) -> str:
        return f"host {self.host}, pid {self.pid}, since {self.since}"


def describe(locked: bool) -> bytes:
    """What this process says of itself; never the same twice.

    Parameters
    ----------
    locked : bool
        Whether it holds a lock on the file.
    """
    record = {
        "host": os.uname().nodename,
        "pid": os.getpid(),
        "since": datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S UTC"),
        "boot": boot(),
        "numbering": numbering(),
        "started": start_of(os.getpid()),
        "locked": locked,
        "token": secrets.token_hex(8),
    }
    return json.dumps(record).encode()


def parse(text: bytes) -> dict[str, Any]:
    """What a claim says; nothing if it was just created, or is none of ours."""
    try:
        record = json.loads(text)
        return record if all(type(record[name]) is kind for name, kind in _KINDS.items()) else {}
    except (ValueError, LookupError, TypeError, RecursionError):
        return {}


def owner_in(record: dict[str, Any]) -> Owner:
    """The owner of whom a claim speaks; unknown if it says nothing."""
    if not record:
        return Owner()
    return Owner(printable(record["host"], _LONGEST), record["pid"], printable(record["since"], _LONGEST))
