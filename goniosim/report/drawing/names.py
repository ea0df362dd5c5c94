"""Names of figures: no two of them may share a file, not even where file systems take ``A`` for ``a``."""

import re

LONGEST = 200
_UNSAFE = re.compile(r"[^A-Za-z0-9._+=,-]+")


def distinct(names):
    """Turn names of materials or models into parts of file names that differ from each other.

    Parameters
    ----------
    names : iterable of str

    Returns
    -------
    list of str
        Each name itself, without what means something to a shell or a file system: ``ww09-masking=correlated`` for
        ``ww09[masking=correlated]``. Where this makes it another one's, a number follows: ``Gold``, ``gold~2``.
    """
    found, taken = [], set()
    for name in names:
        part = plain = _UNSAFE.sub("-", name).rstrip("-").lstrip(".")[:LONGEST] or "-"
        number = 1
        while part.casefold() in taken:
            number += 1
            part = f"{plain}~{number}"
        taken.add(part.casefold())
        found.append(part)
    return found
