"""Numbers and tables as plain text."""

import math
from collections import Counter

import numpy as np

from ..scene.quantity import count
from ..writing import printable

# Characters of a value from a file.
LONGEST_VALUE = 200
# Decimals of a number with its error.
MOST_DECIMALS = 9
# Seconds of a year, and years from which on days are no words.
YEAR, MANY_YEARS = 365.25 * 86400.0, 3


def with_error(value, stderr, decimals=5):
    """Format a value with its standard error, as in ``0.04321 ± 0.00002``.

    Parameters
    ----------
    value, stderr : float
    decimals : int
        Decimals of a value whose standard error is zero (known without noise), or more than
        three places further down and less than a millionth of the value; a small one gets
        four digits instead.

    Returns
    -------
    str
        The error has one significant digit, two when the first of them is a 1 (one digit
        alone would there be wrong by up to a half). A plain number when there is no error; of
        tiny ones the power of ten is written apart.
    """
    if stderr == 0.0 or (stderr < 10.0 ** -(decimals + 3) and stderr < 1e-6 * abs(value)):
        small = 0.0 < abs(value) < 10.0 ** (3 - decimals)
        return f"{value:.4g}" if small else f"{value:.{decimals}f}"
    exponent = math.floor(math.log10(stderr))
    if stderr / 10.0**exponent < 1.95:
        exponent -= 1
    shown = max(-exponent, 0)
    if shown > MOST_DECIMALS:
        power = math.floor(math.log10(max(abs(value), stderr)))
        scale, shown = 10.0**-power, power - exponent
        return f"({value * scale:.{shown}f} ± {stderr * scale:.{shown}f})e{power}"
    return f"{value:.{shown}f} ± {stderr:.{shown}f}"


def counts(rays):
    """Format the numbers of rays of all directions: one number if they are equal."""
    if rays.min() == rays.max():
        return count(rays[0])
    return f"between {count(rays.min())} and {count(rays.max())}"


def rate(rays, per="s"):
    """Format a rate of rays: ``11.8 M rays/s``."""
    for unit, scale in (("G ", 1e9), ("M ", 1e6), ("k ", 1e3)):
        if rays >= scale:
            return f"{rays / scale:.3g} {unit}rays/{per}"
    return f"{rays:.3g} rays/{per}"


def duration(seconds):
    """Format a time span with its two largest units: ``0.4 s``, ``3 min 20 s``, ``2 h 5 min``; or as ``40 years``."""
    if seconds < 10.0:
        return f"{seconds:.2g} s"
    if seconds >= MANY_YEARS * YEAR:
        return f"{seconds / YEAR:.2g} years".replace("e+0", "e").replace("e+", "e")
    parts, rest = [], round(seconds)
    for unit, length in (("d", 86400), ("h", 3600), ("min", 60), ("s", 1)):
        amount, rest = divmod(rest, length)
        if amount or parts:
            parts.append((amount, unit))
    return " ".join(f"{amount} {unit}" for amount, unit in parts[:2] if amount)


def size(n_bytes):
    """Format a file size: ``12.3 MB`` (decimal units)."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if n_bytes >= scale:
            return f"{n_bytes / scale:.3g} {unit}"
    return f"{n_bytes} bytes"


def counted(number, thing):
    """Format a number of things: ``1 thread``, ``8 threads``."""
    return f"{number} {thing}{'' if number == 1 else 's'}"


def degrees(angle):
    """Format an angle in degrees without useless decimals: ``45``, ``89.99``."""
    return f"{angle:.10g}"


def angles(theta_deg):
    """Format angles in degrees so that no two of them look alike: ``30`` and ``30.0000000000001``.

    Parameters
    ----------
    theta_deg : ndarray, shape (M,)
        Distinct.

    Returns
    -------
    list of str
        As from `degrees`, with more digits only where it takes them.
    """
    values = [float(angle) for angle in theta_deg]
    shown = [degrees(angle) for angle in values]
    for digits in range(11, 18):
        uses = Counter(shown)
        for place, value in enumerate(values):
            if uses[shown[place]] > 1:
                # The shortest text that reads back as the number tells any two apart.
                shown[place] = f"{value:.{digits}g}" if digits < 17 else repr(value).removesuffix(".0")
    return shown


def table(header, rows, indent="  ", gap="   "):
    """Lay out rows of strings in columns.

    Parameters
    ----------
    header : sequence of str
        A line break in it makes a header of two lines.
    rows : sequence of sequences of str
    indent, gap : str
        What stands before the first column and between two columns.

    Returns
    -------
    list of str
        The header, then one line for each row; columns are aligned to the right, a first column
        of words to the left.
    """
    height = max(name.count("\n") for name in header)
    tops = [("\n" * (height - name.count("\n")) + name).split("\n") for name in header]
    cells = [*map(list, zip(*tops, strict=True)), *(list(row) for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    words_first = any(row[0] and not row[0][0].isdigit() for row in rows)
    lines = []
    for row in cells:
        aligned = [
            text.ljust(width) if words_first and column == 0 else text.rjust(width)
            for column, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append((indent + gap.join(aligned)).rstrip())
    return lines


def pairs(mapping):
    """Lay out names and values in two columns, sorted by name; each value in one line that is not too long."""
    width = max(map(len, mapping), default=0)
    return [f"  {name.ljust(width)}   {printable(value, LONGEST_VALUE)}" for name, value in sorted(mapping.items())]


def channel_groups(names, arrays):
    """Group the channels that agree in all the numbers to be shown.

    Parameters
    ----------
    names : list of str
        Names of the C channels.
    arrays : iterable of ndarray, shape (M, C)

    Returns
    -------
    list of (str, int)
        The joined name of each group, ``RGB`` or ``red+green``, and its first channel.
    """
    arrays = list(arrays)
    groups = []
    for c in range(len(names)):
        for members in groups:
            if all(np.array_equal(a[:, c], a[:, members[0]]) for a in arrays):
                members.append(c)
                break
        else:
            groups.append([c])
    separator = "" if all(len(name) == 1 for name in names) else "+"
    return [(separator.join(names[c] for c in members), members[0]) for members in groups]
