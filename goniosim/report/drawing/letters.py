"""How much room words take, measured before they are drawn; how to make long ones fit."""

import math
import re
from functools import lru_cache

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

POINTS = 72.0
# Letters are set on whole pixels, which makes small ones a little wider than they are drawn.
PIXELS = 1.05
# Letters that would have to shrink to less than this share of their size go on two lines.
SMALLER = 0.75


@lru_cache(maxsize=4096)
def width(words, size, bold=False):
    """Width in inches of the widest line of some words at a size in points, at most."""
    font = FontProperties(size=size, weight="bold" if bold else "normal")
    lines = words.split("\n")
    return PIXELS * max(text_to_path.get_text_width_height_descent(line, font, False)[0] for line in lines) / POINTS


def fitting(words, size, room, bold=False):
    """The size in points, at most ``size``, at which words are no wider than ``room`` inches."""
    taken = width(words, size, bold)
    return size if taken <= room else 0.99 * size * room / taken


def broken(words, size, room, bold=False):
    """Break words into lines no wider than ``room`` inches, if they have places to break.

    Parameters
    ----------
    words : str
        May be broken after any of ``- _ , [ =`` and spaces, as names of materials and models have.
    size : float
        In points.
    room : float
        In inches.
    bold : bool

    Returns
    -------
    str
        With line breaks, in the middle of a piece that is wider.
    """
    lines = [""]
    pieces = re.findall(r"[^-_,\[= ]*(?:[-_,\[= ]+|$)", words)
    for part in (part for piece in pieces for part in _cut(piece, size, room, bold)):
        if lines[-1] and width((lines[-1] + part).rstrip(), size, bold) > room:
            lines.append("")
        lines[-1] += part
    return "\n".join(line.rstrip() for line in lines)


def snug(words, size, room, bold=False):
    """Make words fit on one line, or, where their letters became much smaller, on two.

    Parameters
    ----------
    words : str
    size : float
        In points, at most.
    room : float
        Width in inches.
    bold : bool

    Returns
    -------
    words : str
        Perhaps with a line break.
    size : float
    """
    alone = fitting(words, size, room, bold)
    if alone >= SMALLER * size:
        return words, alone
    size *= SMALLER
    while (lines := broken(words, size, room, bold)).count("\n") > 1:
        size *= 0.95
    return lines, fitting(lines, size, room, bold)


def _cut(piece, size, room, bold):
    if width(piece, size, bold) <= room:
        return [piece]
    count = math.ceil(1.1 * width(piece, size, bold) / room)
    length = math.ceil(len(piece) / count)
    return [piece[start : start + length] for start in range(0, len(piece), length)]
