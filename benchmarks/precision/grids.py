"""Grids of arguments: logarithmic, dense towards the values at which digits get lost."""

import numpy as np


def logarithmic(low, high, n):
    """``n`` numbers from ``low`` to ``high``."""
    return np.geomspace(low, high, n)


def cosines(dense):
    """From 1e-16 to 1, and 1 - 10^-k up to the last digit."""
    n, step = (65, 1) if dense else (9, 5)
    return np.unique(np.concatenate([logarithmic(1e-16, 1.0, n), 1.0 - 10.0 ** -np.arange(1.0, 16.0, step)]))


def indices(dense):
    """From .05 to 10, and 1 + 10^-k on both sides."""
    n, step = (31, 1) if dense else (6, 5)
    near = 10.0 ** -np.arange(1.0, 16.0, step)
    return np.unique(np.concatenate([logarithmic(0.05, 10.0, n), 1.0 + near, 1.0 - near, [1.0, 1.5, 1.0 / 1.5]]))


def absorptions(dense):
    """0, and from 1e-12 to 1e6."""
    return np.append(0.0, logarithmic(1e-12, 1e6, 37 if dense else 7))


def widths(dense):
    """Alpha from 1e-6 to 1."""
    return logarithmic(1e-6, 1.0, 25 if dense else 4)


def product(*axes):
    """All combinations, shape (axes, points)."""
    return np.stack([grid.ravel() for grid in np.meshgrid(*axes, indexing="ij")])


def critical(dense):
    """Cosines and relative indices below 1, at the critical angle and up to 1e-15 rad to both sides of it."""
    eta = indices(dense)
    eta = eta[eta < 1.0]
    offsets = 10.0 ** -np.arange(2.0, 16.0, 1.0 if dense else 4.0)
    angles = np.arcsin(eta)[:, None] + np.concatenate([offsets, -offsets, [0.0]])
    cosine = np.cos(angles)
    # Next to grazing incidence the cosine is the more exact one.
    exact = np.sqrt((1.0 - eta) * (1.0 + eta))
    cosine = np.concatenate([cosine, np.stack([exact, np.nextafter(exact, 1.0), np.nextafter(exact, 0.0)], -1)], -1)
    pairs = np.stack([cosine, np.broadcast_to(eta[:, None], cosine.shape)]).reshape(2, -1)
    return pairs[:, (pairs[0] > 0.0) & (pairs[0] <= 1.0)]


def fresnel(dense):
    """Cosines and indices, with the neighbourhood of critical angles."""
    return np.concatenate([product(cosines(dense), indices(dense)), critical(dense)], axis=1)
