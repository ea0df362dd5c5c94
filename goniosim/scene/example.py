"""Commented scene files to begin with, one for each kind of material."""

from importlib.resources import files


def example(name: str) -> str:
    """Return the text of an example.

    Parameters
    ----------
    name : str
        ``quickstart``, ``plastic``, ``metal``, ``slab`` or ``study``.

    Returns
    -------
    str
        YAML with comments.
    """
    return (files("goniosim.scene") / "examples" / f"{name}.yaml").read_text(encoding="utf-8")
