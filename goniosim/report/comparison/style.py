"""How models look in all figures: the colours of Bati et al. 2019, and a pattern for a second reading."""

import numpy as np

from ...models import MODELS

COLOURS = {
    "ww09": "#d1242f",
    "elek10": "#f08c00",
    "bati19_ww": "#2a9d3a",
    "belcour18_forward": "#12b5cb",
    "belcour18_symmetric": "#2563c9",
    "bati19_belcour": "#8e3bb0",
}
MARKERS = {
    "ww09": "o",
    "elek10": "s",
    "bati19_ww": "D",
    "belcour18_forward": "^",
    "belcour18_symmetric": "v",
    "bati19_belcour": "P",
}
# For models without a look of their own, in the order in which they are listed.
SPARE_COLOURS = ("#8c564b", "#5f6b76", "#c2459b", "#8a8a00", "#00796b", "#b35c00")
SPARE_MARKERS = ("X", "p", "h", "*", "<", ">")
# There are many figures with many disks: half the size and the time of what one result gets.
DISKS_DPI = 110

# A model that is not known here, of a file that comes from elsewhere.
UNKNOWN_COLOUR, UNKNOWN_MARKER = "0.45", "X"
DASHED = (0, (2.2, 1.2))
THICKEST, THINNEST = 2.4, 0.8
BAND = "0.75"
SIMULATION = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.3}


def colour(variant):
    """Colour of a model, whatever its options."""
    return COLOURS.get(variant.model) or _spare(SPARE_COLOURS, variant.model, UNKNOWN_COLOUR)


def marker(variant):
    """Marker of a model, whatever its options."""
    return MARKERS.get(variant.model) or _spare(SPARE_MARKERS, variant.model, UNKNOWN_MARKER)


def line_style(variant):
    """Solid for a model with its usual options, dashed otherwise."""
    return DASHED if variant.options else "-"


def lines(entries):
    """How entries are drawn as lines.

    Parameters
    ----------
    entries : list of goniosim.report.comparison.entries.Entry

    Returns
    -------
    list of dict
        Arguments of a `matplotlib.lines.Line2D`. Later models are thinner, so that those that nearly
        agree are all seen.
    """
    widths = np.linspace(THICKEST, THINNEST, len(entries))
    return [
        SIMULATION
        if entry.model is None
        else {"color": colour(entry), "linestyle": line_style(entry), "linewidth": width}
        for entry, width in zip(entries, widths, strict=True)
    ]


def spread_out(variants):
    """All variants that occur, without repetition, in the order in which models are listed."""
    order = {name: place for place, name in enumerate(MODELS)}
    found = dict.fromkeys(variants)
    return sorted(found, key=lambda variant: (order.get(variant.model, len(order)), variant.options_text))


def _spare(looks, model, unknown):
    others = [name for name in MODELS if name not in COLOURS]
    return looks[others.index(model) % len(looks)] if model in others else unknown
