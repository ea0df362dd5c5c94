"""Words in figures: short names of materials, names and errors of models."""

from .. import text


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


def above(disk, entry):
    """Write the name of an entry above its view, the options of a second reading on a line of their own."""
    name = entry.label.rstrip("]").replace("[", "\n").replace(",", "\n")
    disk.above(name, fontsize=7.5)


def below(disk, entry):
    """Write the error of an entry below its view."""
    disk.below(entry.error, fontsize=7)


def explanation(directions):
    """What the numbers below the views are."""
    errors = [entry for direction in directions for entry in direction.entries if entry.error]
    if not errors:
        return ""
    words = "; below: RMSE of the direction [1/√sr] ± standard error"
    return words + ("" if all(entry.converged for entry in errors) else "; *: sub-cells too coarse, see errors.csv")
