"""Placeholder until the split walk brings it."""


def mended(mean, variance):
    return variance
