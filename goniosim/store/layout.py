"""Every dataset and attribute of a result file in one table.

The writer and the reader follow this table, and a test holds `data_schema.md`
against it. Upper-case parts of a path stand for names that vary:
``COMPONENT`` for a component or one of its orders
(``reflection/internal/order_2``), ``ENTRY`` for an entry of the audit,
``SAMPLED`` for a component with ``_`` in place of ``/``.
"""

import re
from dataclasses import dataclass

import numpy as np

from goniosim.result import AUDIT_ENTRIES
from goniosim.store.kinds import RESULT

FILETYPE = RESULT.filetype
SCHEMA_VERSION = RESULT.schema_version
COMPONENTS = ("reflection/direct", "reflection/internal", "transmission")

SIZES = {
    "direction": "M",
    "channel": "C",
    "row": "R",
    "column": "K",
    "row_edges": "R + 1",
    "column_edges": "K + 1",
    "batch": "B",
    "row_block": "Rb",
    "column_block": "Kb",
    "checkpoint": "P",
}

# netCDF wants the scale of a dimension in the group of its users or above it.
SCALES = {
    "direction": "direction",
    "channel": "channel",
    "row": "row",
    "column": "column",
    "row_edges": "cells/row_edges",
    "column_edges": "cells/column_edges",
    "batch": "batch",
    "row_block": "row_block",
    "column_block": "column_block",
    "checkpoint": "cost/checkpoint",
}


# No number of a result comes near it, and its square and sums of such are finite still.
_HUGE = 1e100


@dataclass(frozen=True)
class Range:
    """Which numbers a dataset may hold; whatever the range, they are finite.

    Attributes
    ----------
    low, high : float
        Both included.
    open_high : bool
        Whether ``high`` itself is excluded.
    """

    low: float = -_HUGE
    high: float = _HUGE
    open_high: bool = False

    def holds(self, values: np.ndarray) -> bool:
        """Whether all numbers of an array lie in the range and are finite."""
        if not values.size:
            return True
        # A NaN anywhere makes both of them NaN, and every comparison false.
        low, high = values.min(), values.max()
        below = high < self.high if self.open_high else high <= self.high
        return bool(self.low <= low and below)

    def __str__(self) -> str:
        if self == ANY:
            return f"finite and below {_HUGE:g}"
        if self.high == _HUGE:
            return f"finite and {self.low:g} or more, below {_HUGE:g}"
        return f"from {self.low:g} to {'below ' if self.open_high else ''}{self.high:g}"


ANY = Range()
NOT_NEGATIVE = Range(0)
POLAR = Range(0, 90, open_high=True)
AZIMUTH = Range(0, 360, open_high=True)
FLAG = Range(0, 1)
# As many as a scene may ask for rays.
COUNT = Range(0, 1e15)


@dataclass(frozen=True)
class Dataset:
    """One dataset, or one family of datasets, of a result file.

    Attributes
    ----------
    path : str
        Path in the file, with upper-case placeholders.
    dims : tuple of str
        Names of the axes; their lengths are in `SIZES`.
    dtype : str
        ``float64``, ``int64``, ``bool``, ``text`` or ``bytes``.
    unit, meaning : str
        Written to the attributes ``units`` and ``long_name``.
    range : Range
        Of its numbers.
    """

    path: str
    dims: tuple[str, ...]
    dtype: str
    unit: str
    meaning: str
    range: Range = ANY

    @property
    def is_scale(self) -> bool:
        """Whether this dataset is the scale of a dimension."""
        return self.path in SCALES.values()


@dataclass(frozen=True)
class Attribute:
    """One attribute, or one family of attributes, of a group (``/``: of the root)."""

    group: str
    name: str
    dtype: str
    meaning: str


CHECKSUMS = (
    Dataset("checksums/file", (), "text", "1", "the seal: schema, length and digest of the file"),
    Dataset("checksums/content", (), "text", "1", "digest of every group and dataset with its attributes, as JSON"),
)

_SLICE = ("direction", "channel", "row", "column")
_CELL = ("direction", "row", "column")
_TOTAL = ("direction", "channel")
_BLOCKS = ("direction", "batch", "channel", "row_block", "column_block")
_COST = ("direction", "checkpoint")

DATASETS = (
    Dataset("direction", ("direction",), "int64", "1", "number of the incident direction", NOT_NEGATIVE),
    Dataset("channel", ("channel",), "text", "1", "name of the colour channel"),
    Dataset("row", ("row",), "float64", "degree", "row coordinate at the centre of the row", NOT_NEGATIVE),
    Dataset("column", ("column",), "float64", "degree", "azimuth at the centre of the column", NOT_NEGATIVE),
    Dataset("batch", ("batch",), "int64", "1", "number of the batch of replicates", NOT_NEGATIVE),
    Dataset("row_block", ("row_block",), "int64", "1", "first row of the block", NOT_NEGATIVE),
    Dataset("column_block", ("column_block",), "int64", "1", "first column of the block", NOT_NEGATIVE),
    Dataset("incident/theta_deg", ("direction",), "float64", "degree", "polar angle of the incident light", POLAR),
    Dataset("incident/phi_deg", ("direction",), "float64", "degree", "azimuth of the incident light", AZIMUTH),
    Dataset("incident/rays", ("direction",), "int64", "1", "rays traced from the direction", NOT_NEGATIVE),
    Dataset("channels/name", ("channel",), "text", "1", "name of the colour channel"),
    Dataset(
        "cells/row_edges", ("row_edges",), "float64", "degree", "row coordinate at the edges of the rows", Range(0, 90)
    ),
    Dataset(
        "cells/column_edges",
        ("column_edges",),
        "float64",
        "degree",
        "azimuth at the edges of the columns",
        Range(0, 360),
    ),
    Dataset("cells/valid", _CELL, "bool", "1", "whether the cell lies wholly above the horizon", FLAG),
    Dataset("cells/solid_angle", _CELL, "float64", "sr", "solid angle of the part above the horizon", NOT_NEGATIVE),
    Dataset(
        "cells/projected_solid_angle",
        _CELL,
        "float64",
        "sr",
        "integral of cos(theta_v) over the part above the horizon",
        NOT_NEGATIVE,
    ),
    Dataset("COMPONENT/energy", _SLICE, "float64", "1", "fraction of the incident flux", NOT_NEGATIVE),
    Dataset("COMPONENT/stderr", _SLICE, "float64", "1", "standard error of energy", NOT_NEGATIVE),
    Dataset("COMPONENT/bsdf", _SLICE, "float64", "sr-1", "BSDF averaged over the cell", NOT_NEGATIVE),
    Dataset("COMPONENT/bsdf_stderr", _SLICE, "float64", "sr-1", "standard error of bsdf", NOT_NEGATIVE),
    Dataset("COMPONENT/hits", _CELL, "int64", "1", "paths that deposited energy in the cell", COUNT),
    Dataset("COMPONENT/uncertain", _SLICE, "bool", "1", "whether too few paths or replicates reach the cell", FLAG),
    Dataset("COMPONENT/albedo", _TOTAL, "float64", "1", "sum of energy over the cells", NOT_NEGATIVE),
    Dataset("COMPONENT/albedo_stderr", _TOTAL, "float64", "1", "standard error of albedo", NOT_NEGATIVE),
    Dataset("COMPONENT/estimator", ("direction",), "text", "1", "what made the numbers of the direction"),
    Dataset("COMPONENT/node_bias", ("direction",), "float64", "sr-0.5", "floor that nodes may leave", NOT_NEGATIVE),
    Dataset("COMPONENT/batches", _BLOCKS, "float64", "1", "energy in blocks of cells, by batches of replicates"),
    Dataset("COMPONENT/paths", ("direction",), "int64", "1", "light paths of the direction", COUNT),
    Dataset("COMPONENT/replicates", ("direction",), "int64", "1", "replicates of the direction", COUNT),
    *(Dataset(f"audit/{entry}", _TOTAL, "float64", "1", meaning) for entry, meaning in AUDIT_ENTRIES.items()),
    Dataset("audit/ENTRY_stderr", _TOTAL, "float64", "1", "standard error of the audit entry", NOT_NEGATIVE),
    Dataset(
        "audit/direct_integrated", _TOTAL, "float64", "1", "direct reflection integrated over the cells", NOT_NEGATIVE
    ),
    Dataset(
        "audit/direct_integrated_stderr", _TOTAL, "float64", "1", "standard error of direct_integrated", NOT_NEGATIVE
    ),
    Dataset("audit/rays", ("direction",), "int64", "1", "rays that the audit rests on", COUNT),
    Dataset("cost/checkpoint", ("checkpoint",), "int64", "1", "number of the checkpoint", NOT_NEGATIVE),
    Dataset("cost/rays", _COST, "float64", "1", "rays up to the checkpoint", NOT_NEGATIVE),
    Dataset("cost/seconds", _COST, "float64", "s", "elapsed time of tracing, shared out", NOT_NEGATIVE),
    Dataset("cost/cpu_seconds", _COST, "float64", "s", "processor time of tracing", NOT_NEGATIVE),
    Dataset("cost/error_SAMPLED", _COST, "float64", "sr-0.5", "noise floor of the component", NOT_NEGATIVE),
    Dataset("state", (), "bytes", "1", "what goniosim goes on from, if the run was interrupted"),
    *CHECKSUMS,
)

ATTRIBUTES = (
    Attribute("/", "filetype", "text", f"always `{FILETYPE}`"),
    Attribute("/", "schema_version", "text", "version of this schema, MAJOR.MINOR"),
    Attribute("/", "goniosim_version", "text", "version of the program that wrote the file"),
    Attribute("/", "created_utc", "text", "time of the simulation, ISO 8601"),
    Attribute("/", "config_yaml", "text", "the simulated scene, complete with defaults and overrides"),
    Attribute(
        "/",
        "config_hash",
        "text",
        "identity of the scene: all that determines the numbers but for their noise, the seed included; "
        "not rays, target, threads and name. SHA-256, hexadecimal",
    ),
    Attribute("/", "seed", "uint64", "seed of the random numbers"),
    Attribute("/", "status", "text", "`complete`, or `partial` after an interruption"),
    Attribute("/", "target_reached", "uint64", "1 if the target of the simulation was reached, 0 if not; or absent"),
    Attribute("/", "name", "text", "name of the material"),
    Attribute("/", "estimator", "text", "that of all sampled components and directions if they agree, else `mixed`"),
    Attribute("/", "PROVENANCE", "text", "any further text: versions, git revision, command line, machine, threads"),
    Attribute("cells", "parametrization", "text", "`classic` or `half`"),
    Attribute("COMPONENT", "contains_delta", "int8", "1 if some energy leaves in exactly one direction"),
    Attribute("effects", "EFFECT", "int8", "1 if the scene called for the effect, 0 if not"),
)

# Every other text attribute of the root comes from, and goes back to, `Result.provenance`.
NOT_PROVENANCE = (
    "filetype",
    "schema_version",
    "config_yaml",
    "config_hash",
    "seed",
    "status",
    "target_reached",
    "name",
    "estimator",
)

_PLACEHOLDERS = {
    "COMPONENT": rf"(?:{'|'.join(COMPONENTS)})(?:/order_\d+(?:_and_more)?)?",
    "ENTRY": "|".join(AUDIT_ENTRIES),
    "SAMPLED": "|".join(name.replace("/", "_") for name in COMPONENTS),
}


def _pattern(path: str) -> re.Pattern[str]:
    for placeholder, expression in _PLACEHOLDERS.items():
        path = path.replace(placeholder, f"(?:{expression})")
    return re.compile(path)


_PATTERNS = [(_pattern(dataset.path), dataset) for dataset in DATASETS]


def angles_of(path: str, entry: Dataset) -> dict[str, str]:
    """Names and paths of the angles that stand beside a dataset with an axis of directions, as its coordinates."""
    if "direction" not in entry.dims or entry.is_scale or path.startswith("incident/"):
        return {}
    return {name: f"incident/{name}" for name in ("theta_deg", "phi_deg")}


def describe(path: str) -> Dataset:
    """Find the row of the table that describes a dataset.

    Parameters
    ----------
    path : str
        Path in the file without a leading slash.

    Returns
    -------
    Dataset

    Raises
    ------
    KeyError
        If the schema has no such dataset.
    """
    for pattern, dataset in _PATTERNS:
        if pattern.fullmatch(path):
            return dataset
    raise KeyError(f"the schema has no dataset {path}")
