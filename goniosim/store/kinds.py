"""The kinds of file that goniosim writes, and how each of them calls itself."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Kind:
    """One kind of file.

    Attributes
    ----------
    name : str
        In the first line of the seal.
    filetype : str
        The attribute of the root.
    schema_version : str
        MAJOR.MINOR, of the files that are written.
    what : str
        What such a file is, and which command wrote it.
    remedy : str
        What the user can do if one is damaged.
    """

    name: str
    filetype: str
    schema_version: str
    what: str
    writer: str
    remedy: str

    @property
    def mark(self) -> bytes:
        """How the seal begins, in every version of the schema."""
        return f"goniosim {self.name}, schema ".encode()


RESULT = Kind(
    name="result",
    filetype="goniosim-result",
    schema_version="1.4",
    what="a goniosim result",
    writer="name a file that a simulation wrote",
    remedy="restore it from a copy or simulate again",
)
MODELS = Kind(
    name="models",
    filetype="goniosim-models",
    schema_version="1.2",
    what="a file of integrated models",
    writer="name a models.h5 that a comparison wrote",
    remedy="restore it from a copy or compare again",
)
PORTION = Kind(
    name="portion",
    filetype="goniosim-portion",
    schema_version="1.0",
    what="a portion of a simulation",
    writer="name a file that a shard wrote",
    remedy="run its shard again",
)
KINDS = (RESULT, MODELS, PORTION)
