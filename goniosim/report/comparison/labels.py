"""Short names of materials for the axis of a figure."""


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
    parts = [name.split("-") for name in names]
    shared = set(parts[0]).intersection(*parts[1:]) if len(parts) > 1 else set()
    rest = [[part for part in name if part not in shared] for name in parts]
    for count in range(1, max(map(len, rest), default=0) + 1):
        short = ["-".join(name[:count]) for name in rest]
        if len(set(short)) == len(set(names)):
            return [word or name for word, name in zip(short, names, strict=True)]
    return list(names)
