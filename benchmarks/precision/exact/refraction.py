"""Snell's law for directions that point away from the interface."""

from mpmath import mpf, sqrt


def cosine_below(cosine, ratio):
    """Cosine on the other side; ``ratio`` is the index above over that below. 0 under total internal reflection."""
    square = 1 - ratio**2 * (1 - cosine**2)
    return sqrt(square) if square > 0 else mpf(0)


def shift(cosine, ratio):
    """The k of the direction ``ratio w + k m`` below that belongs to w; 0 under total internal reflection."""
    below = cosine_below(cosine, ratio)
    return below - ratio * cosine if below > 0 else below
