"""How models look in all figures: a colour and a marker for each model, a dash and a fill for its options.

A look depends on the model and its options alone, so that it is the same in all figures of all reports.
"""

import zlib
from dataclasses import dataclass

import numpy as np

from ...models import MODELS, describe_options

# The hues of Bati et al. 2019, in the palette of Okabe and Ito that colour-blind readers can tell apart.
COLOURS = {
    "ww09": "#d55e00",
    "elek10": "#e69f00",
    "bati19_ww": "#009e73",
    "belcour18_forward": "#56b4e9",
    "belcour18_symmetric": "#0055a4",
    "bati19_belcour": "#b0479a",
}
MARKERS = {
    "ww09": "o",
    "elek10": "s",
    "bati19_ww": "D",
    "belcour18_forward": "^",
    "belcour18_symmetric": "v",
    "bati19_belcour": "P",
}
# For models without a look of their own, in the order in which they are listed; for unknown ones by their names.
SPARE_COLOURS = ("#8c564b", "#5f6b76", "#7a1f4d", "#8a8a00", "#332288", "#44aa99")
SPARE_MARKERS = ("X", "p", "h", "*", "<", ">")
# There are many figures with many disks: half the size and the time of what one result gets.
DISKS_DPI = 110

# Strokes and gaps, in widths of the line, for an option that is not at its default; several follow each other, and
# then a longer gap.
STROKES = (
    (1.0, 1.3),
    (6.0, 1.5, 6.0, 1.5, 1.0, 1.5),
    (4.0, 1.3, 1.0, 1.3, 1.0, 1.3),
    (3.2, 1.6),
    (9.0, 1.5, 3.0, 1.5),
    (4.5, 1.3, 1.0, 1.3),
    (8.0, 2.5),
    (9.0, 1.5, 1.0, 1.3, 1.0, 1.3),
)
BETWEEN_WORDS = 3.5
FILLS = ("none", "left", "top", "right", "bottom")
THICKEST, THINNEST = 2.2, 1.1
BAND = "0.75"
SIMULATION = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.3}


@dataclass(frozen=True)
class Look:
    """What tells a variant from all others.

    Attributes
    ----------
    colour, marker : str
        Of the model.
    dash : str or (int, tuple of float)
        Of its options: a line style of matplotlib, solid for the defaults.
    fill : str
        Of its options: a fill style of matplotlib, full for the defaults.
    """

    colour: str
    marker: str
    dash: str | tuple
    fill: str

    def line(self, width):
        """Arguments of a `matplotlib.lines.Line2D` without marks."""
        return {"color": self.colour, "linestyle": self.dash, "linewidth": width}

    def mark(self, size):
        """Arguments of a `matplotlib.lines.Line2D` for its marks."""
        look = {"color": self.colour, "marker": self.marker, "markersize": size, "fillstyle": self.fill}
        return look | {"markerfacecoloralt": "white", "markeredgewidth": 0.9} | self._hollow()

    def _hollow(self):
        # A hollow mark hides what lies below, as the others do.
        return {"fillstyle": "full", "markerfacecolor": "white"} if self.fill == "none" else {}


def look(model, options=""):
    """Look of a model with some options.

    Parameters
    ----------
    model : str
    options : str
        Those that are not at their default, as in labels: ``masking=correlated,jacobian=snell``.

    Returns
    -------
    Look
    """
    number = zlib.crc32(model.encode())
    colour, marker = COLOURS.get(model), MARKERS.get(model)
    others = [name for name in MODELS if name not in COLOURS]
    if model in others:
        place = others.index(model)
        colour, marker = _cyclic(SPARE_COLOURS, place), _cyclic(SPARE_MARKERS, place)
    elif colour is None:
        # Of a file that comes from elsewhere.
        colour, marker = _cyclic(SPARE_COLOURS, number), _cyclic(SPARE_MARKERS, number // len(SPARE_COLOURS))
    if not options:
        return Look(colour, marker, "-", "full")
    words = sorted(_word(model, option) for option in options.split(","))
    strokes = [stroke for word in words for stroke in _cyclic(STROKES, word)]
    if len(words) > 1:
        strokes[-1] = BETWEEN_WORDS
    return Look(colour, marker, (0, tuple(strokes)), _cyclic(FILLS, sum(words) + 3 * (len(words) - 1) - 3))


def of(variant):
    """Look of anything with a ``model`` and an ``options_text``."""
    return look(variant.model, variant.options_text)


def lines(entries):
    """How entries are drawn as lines.

    Parameters
    ----------
    entries : list of goniosim.report.comparison.entries.Entry

    Returns
    -------
    list of dict
        Arguments of a `matplotlib.lines.Line2D`. Later models are thinner, and their marks sit elsewhere, so that
        those that agree are all seen.
    """
    widths = np.linspace(THICKEST, THINNEST, len(entries))
    return [
        SIMULATION if entry.model is None else of(entry).mark(4.6) | of(entry).line(width)
        for entry, width in zip(entries, widths, strict=True)
    ]


def spread_out(variants):
    """All variants that occur, without repetition, in the order in which models are listed."""
    order = {name: place for place, name in enumerate(MODELS)}
    found = dict.fromkeys(variants)
    return sorted(found, key=lambda variant: (order.get(variant.model, len(order)), variant.options_text))


def _word(model, option):
    """Number of a value of an option among all that are not defaults, whatever other options there are."""
    known = describe_options(model) if model in MODELS else []
    words = [f"{info.name}={str(value).lower()}" for info in known for value in info.values if value != info.default]
    return words.index(option) if option in words else zlib.crc32(option.encode()) % len(STROKES)


def _cyclic(looks, number):
    return looks[number % len(looks)]
