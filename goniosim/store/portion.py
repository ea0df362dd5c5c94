"""Portions of simulations on the disk: what a shard has of one material, until all are joined."""

import math
import uuid
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import h5py

from goniosim.errors import OutputError
from goniosim.store import access
from goniosim.store.decoding import shaped, values
from goniosim.store.encoding import FORMAT, reserve_seal, sealed, write_attributes, write_dataset
from goniosim.store.kinds import PORTION
from goniosim.store.layout import describe
from goniosim.store.opening import decoding, opened
from goniosim.store.output import rescue, reserve_output
from goniosim.writing import StrPath

_LARGEST = 1 << 62


@dataclass(frozen=True)
class Portion:
    """What a portion file says of itself; each is an attribute of its root.

    Attributes
    ----------
    goniosim_version : str
    created_utc : str
        When it was last written, ISO 8601.
    name : str
        Of the material.
    config_yaml : str
        The scene, without its threads.
    config_hash : str
    shard, shards : int
        Its shard, from 1, and how many there are.
    first, end : int
        Pieces of the scene that belong to it: from ``first`` to before ``end``.
    done_rays, total_rays : int
        Light paths that it holds, and that belong to it.
    milliseconds : int
        Of wall-clock time that were spent on it.
    noise : str
        A number: the largest noise of a slice in the directions that it has begun, in sr^-1/2; empty if nobody knows.
    """

    goniosim_version: str
    created_utc: str
    name: str
    config_yaml: str
    config_hash: str
    shard: int
    shards: int
    first: int
    end: int
    done_rays: int
    total_rays: int
    milliseconds: int
    noise: str

    @property
    def is_whole(self) -> bool:
        """Whether nothing is missing."""
        return self.done_rays == self.total_rays

    def check(self) -> None:
        """Raise a ValueError if it says what no portion can say."""
        sound = 1 <= self.shard <= self.shards and 0 <= self.first < self.end and 0 < self.done_rays <= self.total_rays
        if not sound:
            raise ValueError("numbers that contradict each other")
        if self.noise and not 0.0 <= float(self.noise) < math.inf:
            raise ValueError("a noise that is none")


def write_portion(portion: Portion, state: bytes, path: StrPath, *, rescued: bool = True) -> None:
    """Write a portion file, whole or not at all.

    Parameters
    ----------
    portion : Portion
    state : bytes
        As `goniosim.engine.trace_portion` returns it.
    path : path-like
        An earlier portion there is replaced.
    rescued : bool
        Whether one that cannot be written is saved in the temporary directory instead.

    Raises
    ------
    OutputError
        If it cannot be written there; the message says where a rescued one was saved.
    """
    parts = _encode(portion, state)
    try:
        with reserve_output(path, sum(map(len, parts)), PORTION) as reservation:
            reservation.commit(parts, lambda: None)
    except OutputError as error:
        if not rescued:
            raise
        raise OutputError(f"{error}; {rescue(parts, path)}") from error


def read_portion(path: StrPath, *, whole: bool = True) -> tuple[Portion, bytes]:
    """Read a portion file.

    Parameters
    ----------
    path : path-like
    whole : bool
        Whether every byte is checked, and the state read; otherwise the state that is returned is empty.

    Returns
    -------
    Portion, bytes

    Raises
    ------
    ForeignFileError
        If it is missing, or none.
    DamagedFileError
        If it was truncated or altered.
    NewerSchemaError
        If its major schema version is newer than this goniosim reads.
    """
    with opened(path, PORTION, whole=whole) as (file, ours), decoding(path, PORTION.remedy):
        held = {name: access.attribute(file, name) for name in ours.attributes("")}
        portion = Portion(**{field.name: _typed(held, field.name, field.type) for field in fields(Portion)})
        portion.check()
        return portion, _state(file) if whole else b""


def _typed(held: Mapping[str, object], name: str, kind: Any) -> Any:
    found = held.get(name)
    if not isinstance(found, kind) or (isinstance(found, int) and not 0 <= found <= _LARGEST):
        raise ValueError(f"the attribute {name} is missing, or none of its kind")
    return found


def _state(file: h5py.File) -> bytes:
    entry = describe("state")
    found: bytes = values(shaped(file, "state", entry, {}), entry)
    return found


def _encode(portion: Portion, state: bytes) -> tuple[memoryview | bytes, ...]:
    with h5py.File(uuid.uuid4().hex, "w", driver="core", backing_store=False, libver=FORMAT) as file:
        place = reserve_seal(file)
        write_dataset(file, "state", state, describe("state"))
        kind = {"filetype": PORTION.filetype, "schema_version": PORTION.schema_version}
        write_attributes(file, {**kind, **asdict(portion)})
        return sealed(file, PORTION, place)
