"""Albedos of a result: the share of the incident energy that a component holds, with its standard error."""

from collections.abc import Iterable

import numpy as np

from .errors import UnusableResultError
from .result import Component, Result

# The audit entry in which a sampled component is booked as a whole.
SAMPLED_ENTRY = {"reflection/internal": "reflected_internal", "transmission": "transmitted"}
DIRECT = "reflection/direct"
REFLECTION = "reflection"
# As a limit of two standard errors, what may go unseen at 95 % confidence: 3 / rays.
UNSEEN = 1.5


def albedo(result: Result, name: str | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Albedo of a component with its standard error: what `goniosim.result.Result.albedo` describes.

    Parameters
    ----------
    result : Result
    name : str, optional

    Returns
    -------
    value, stderr : ndarray, shape (M, C)

    Raises
    ------
    UnusableResultError
        There is no such component.
    """
    chosen = _chosen(result, name)
    shape = (len(result.theta_deg), len(result.channels))
    value, variance = np.zeros(shape), np.zeros(shape)
    if DIRECT in chosen:
        value += result.audit.direct_integrated
        variance += result.audit.direct_integrated_stderr**2
    sampled = [part for part in chosen if part != DIRECT]
    if sampled:
        energy, stderr = _sampled(result, sampled, [chosen[part] for part in sampled])
        value += energy
        variance += stderr**2
    return value, np.sqrt(variance)


def _sampled(result: Result, names: list[str], parts: list[Component]) -> tuple[np.ndarray, np.ndarray]:
    """Sum of sampled components and its standard error; NaN where no ray was traced."""
    entry = SAMPLED_ENTRY.get(names[0]) if len(names) == 1 else None
    if entry is not None:
        energy, stderr = result.audit.energy[entry], result.audit.stderr[entry]
    else:
        energy, stderr = _of_paths(parts, result.rays)
    arrived = np.any([part.hits.any(axis=(1, 2)) for part in parts if part.hits is not None], axis=0)[:, None]
    rays = result.rays[:, None]
    stderr = np.where(arrived, stderr, UNSEEN / np.maximum(rays, 1))
    return np.where(rays > 0, energy, np.nan), np.where(rays > 0, stderr, np.nan)


def _of_paths(parts: Iterable[Component], rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sum over cells, and its standard error by the scatter of the paths.

    A path leaves once, so that the covariance of two cells is - E_i E_j / (rays - 1), and the variance of
    the sum is that of single cells less (sum E)^2 - sum E^2 over (rays - 1).
    """
    energy, squares, variance = (
        sum(np.sum(values**power, axis=(2, 3)) for values in arrays)
        for arrays, power in (
            ([part.energy for part in parts], 1),
            ([part.energy for part in parts], 2),
            ([part.stderr for part in parts], 2),
        )
    )
    less = (energy**2 - squares) / np.maximum(rays - 1, 1)[:, None]
    return np.asarray(energy), np.sqrt(np.maximum(variance - less, 0.0))


def _chosen(result: Result, name: str | None) -> dict[str, Component]:
    """The components, none in another, that a name stands for."""
    found = result.components
    if name is None:
        return dict(found)
    named = {**found, **{f"{of}/{order}": part for of in found for order, part in found[of].orders.items()}}
    if name in named:
        return {name: named[name]}
    if name == REFLECTION:
        return {of: part for of, part in found.items() if of.startswith(f"{REFLECTION}/")}
    raise UnusableResultError(f"{result.name}: has no component {name!r}; there is {', '.join([*named, REFLECTION])}")
