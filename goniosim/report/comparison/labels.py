"""Words in figures: short names of materials, names and errors of models."""

from .. import text
from ..drawing import letters

# Points.
NAME_SIZE, ERROR_SIZE = 7.5, 7.0
UNIT = "sr$^{-1/2}$"


def short_names(names):
    """Drop what the names have in common, and what is not needed to tell them apart.

    Parameters
    ----------
    names : list of str
        Parts are separated by ``-``, as in ``M1-alpha0_0.2-alpha1_0.001-tau_0.2``.

    Returns
    -------
    list of str
        The fewest leading parts, without those that all names share, that keep the names distinct.
    """
    if len(names) == 1:
        return list(names)
    parts = [name.split("-") for name in names]
    shared = set(parts[0]).intersection(*parts[1:])
    rest = [[part for part in name if part not in shared] for name in parts]
    for count in range(1, max(map(len, rest), default=0) + 1):
        short = ["-".join(name[:count]) for name in rest]
        if len(set(short)) == len(set(names)):
            return [word or name for word, name in zip(short, names, strict=True)]
    return list(names)


def error_text(rmse, stderr, upper, significant, converged):
    """An RMSE with its standard error, or its upper limit; a star where sub-cells are too coarse.

    Parameters
    ----------
    rmse, stderr, upper : float
        In sr^(-1/2).
    significant, converged : bool

    Returns
    -------
    str
    """
    if not significant:
        return f"below noise (< {upper:.1e})"
    return text.with_error(rmse, stderr) + ("" if converged else " *")


def stacked(entry, room):
    """The name of an entry, each option of a second reading on a line of its own, and long ones on several.

    Parameters
    ----------
    entry : goniosim.report.comparison.entries.Entry
    room : float
        In inches.

    Returns
    -------
    str
    """
    names = entry.label.rstrip("]").replace("[", "\n").replace(",", "\n").split("\n")
    return "\n".join(letters.broken(name, NAME_SIZE, room) for name in names)


def lines(entries, room):
    """Most lines that the names of entries take, see `stacked`."""
    return max(stacked(entry, room).count("\n") + 1 for entry in entries)


def above(disk, entry, room):
    """Write the name of an entry above its view."""
    words = stacked(entry, room)
    disk.above(words, fontsize=letters.fitting(words, NAME_SIZE, room), linespacing=1.1)


def below(disk, entry, room):
    """Write the error of an entry below its view."""
    disk.below(entry.error, fontsize=letters.fitting(entry.error, ERROR_SIZE, room))


def with_twin(entry, twin):
    """The name of an entry, and of the entry whose curve covers its own: ``bati19_belcour = belcour18_forward``."""
    if twin is None:
        return entry.label
    same = twin.options_text == entry.options_text != ""
    return f"{entry.label} = {twin.model}[same]" if same else f"{entry.label} = {twin.label}"


def explanation(directions):
    """What the numbers below the views are."""
    errors = [entry for direction in directions for entry in direction.entries if entry.error]
    if not errors:
        return ""
    words = "; below: RMSE of the direction [sr^-1/2] ± standard error"
    return words + ("" if all(entry.converged for entry in errors) else "; *: sub-cells too coarse, see errors.csv")
