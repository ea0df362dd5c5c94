"""Every dataset and attribute of a file of integrated models, built from the table of result files.

``MATERIAL`` stands for the name of a material, ``MODEL`` for the name of a model with its options.
A test holds `data_schema.md` against this table.
"""

from dataclasses import replace

from goniosim.store import layout
from goniosim.store.kinds import MODELS
from goniosim.store.layout import CHECKSUMS, Attribute, Dataset

FILETYPE = MODELS.filetype
SCHEMA_VERSION = MODELS.schema_version
# `reflection`: all that is reflected, where a model does not tell direct from internal paths.
COMPONENTS = (*layout.COMPONENTS, "reflection")
VALUES = ("energy", "stderr", "bsdf", "bsdf_stderr")

# What a model shares with the result it was integrated for; no audit, no cost.
COORDINATES = ("direction", "channel", "row", "column")
FOLDERS = ("incident", "channels", "cells")
SHARED = tuple(
    dataset for dataset in layout.DATASETS if dataset.path in COORDINATES or dataset.path.split("/")[0] in FOLDERS
)
_OF_A_MODEL = tuple(layout.describe(f"{layout.COMPONENTS[0]}/{name}") for name in VALUES)
DATASETS = (
    *(
        replace(dataset, path=f"{group}/{dataset.path}")
        for group, datasets in (("MATERIAL", SHARED), ("MATERIAL/MODEL", _OF_A_MODEL))
        for dataset in datasets
    ),
    *CHECKSUMS,
)

ATTRIBUTES = (
    Attribute("/", "filetype", "text", f"always `{FILETYPE}`"),
    Attribute("/", "schema_version", "text", "version of this schema, MAJOR.MINOR"),
    Attribute("/", "goniosim_version", "text", "version of the program that wrote the file"),
    Attribute("/", "created_utc", "text", "time of the comparison, ISO 8601"),
    Attribute("/", "materials", "text", "names of the materials, one in a line"),
    Attribute(
        "/", "PROVENANCE", "text", "any further text: versions, git revision, command line, machine, threads, sub-cells"
    ),
    Attribute("MATERIAL", "name", "text", "name of the material"),
    Attribute("MATERIAL", "config_yaml", "text", "the scene of the result that was compared"),
    Attribute("MATERIAL", "config_hash", "text", "identity of the scene of that result"),
    Attribute("MATERIAL", "main_component", "text", "the component by which the models were ranked"),
    Attribute("MATERIAL", "models", "text", "names of the groups MODEL, one in a line, in the order of comparison"),
    Attribute("MATERIAL/cells", "parametrization", "text", "`classic` or `half`"),
    Attribute("MATERIAL/MODEL", "model", "text", "name of the model"),
    Attribute("MATERIAL/MODEL", "options", "text", "NAME=VALUE, with commas between; those not at their default"),
    Attribute("MATERIAL/MODEL/cells", "parametrization", "text", "`classic` or `half`"),
    Attribute("MATERIAL/MODEL/COMPONENT", "contains_delta", "int8", "1 if some energy leaves in exactly one direction"),
)

# Every other text attribute of the root is provenance.
NOT_PROVENANCE = ("filetype", "schema_version", "materials")


def describe(path: str) -> Dataset:
    """Find the row of the table of results that describes a dataset.

    Parameters
    ----------
    path : str
        Below a material, or below a model.

    Returns
    -------
    goniosim.store.layout.Dataset
        Its path is that of a result file.

    Raises
    ------
    KeyError
        If the schema has no such dataset.
    """
    component, _, name = path.rpartition("/")
    if component in COMPONENTS and name in VALUES:
        return layout.describe(f"{layout.COMPONENTS[0]}/{name}")
    entry = layout.describe(path)
    if entry not in SHARED:
        raise KeyError(f"the schema of models has no dataset {path}")
    return entry
