"""How models look in all figures: the colours of Bati et al. 2019, and a pattern for a second reading."""

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
DASHED = (0, (2.2, 1.2))


def colour(variant):
    """Colour of a model, whatever its options."""
    return COLOURS.get(variant.model) or _spare(SPARE_COLOURS, variant.model)


def marker(variant):
    """Marker of a model, whatever its options."""
    return MARKERS.get(variant.model) or _spare(SPARE_MARKERS, variant.model)


def line_style(variant):
    """Solid for a model with its usual options, dashed otherwise."""
    return DASHED if variant.options else "-"


def spread_out(variants):
    """All variants that occur, without repetition, in the order in which models are listed."""
    order = list(MODELS)
    found = dict.fromkeys(variants)
    return sorted(found, key=lambda variant: (order.index(variant.model), variant.options_text))


def _spare(looks, model):
    others = [name for name in MODELS if name not in COLOURS]
    return looks[others.index(model) % len(looks)]
