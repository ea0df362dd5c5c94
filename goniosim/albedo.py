"""Albedos of a result: the share of the incident energy that a component holds, with its standard error."""

import numpy as np

from .errors import UnusableResultError
from .result import Component, Result

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
    parts = list(chosen.values())
    if DIRECT in chosen:
        energy, stderr = _sum_of(chosen[DIRECT])
        value += energy
        variance += stderr**2
        parts.remove(chosen[DIRECT])
    if parts:
        energy, stderr = _sampled(parts, result.rays)
        value += energy
        variance += stderr**2
    return value, np.sqrt(variance)


def arrived(component: Component) -> np.ndarray:
    """Whether anything of a sampled component was seen, shape (M, C); a path may have nothing left in a channel."""
    if component.hits is None:
        return np.asarray(component.energy.any(axis=(2, 3)))
    return np.broadcast_to(np.asarray(component.hits.any(axis=(1, 2)))[:, None], component.energy.shape[:2])


def _sum_of(component: Component) -> tuple[np.ndarray, np.ndarray]:
    """Sum over the cells, and its standard error."""
    if component.albedo is None or component.albedo_stderr is None:
        raise TypeError("the component of a model, which has no noise, has no albedo with an error")
    return component.albedo, component.albedo_stderr


def _sampled(parts: list[Component], rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sum of sampled components, none in another, and its standard error; NaN where no ray was traced."""
    energy = np.sum([_sum_of(part)[0] for part in parts], axis=0)
    variance = np.sum([_sum_of(part)[1] ** 2 for part in parts], axis=0)
    if len(parts) == 2:
        for direction, n in enumerate(rays):
            variance[direction] += _covariance(parts[0], parts[1], direction, int(n))
    n = rays[:, None]
    seen = np.any([arrived(part) for part in parts], axis=0)
    stderr = np.where(seen, np.sqrt(np.maximum(variance, 0.0)), UNSEEN / np.maximum(n, 1))
    return np.where(n > 0, energy, np.nan), np.where(n > 0, stderr, np.nan)


def _covariance(one: Component, other: Component, direction: int, rays: int) -> np.ndarray:
    """Twice the covariance of the sums of two components that may share their paths, shape (C,)."""
    (value, stderr), (other_value, other_stderr) = _sum_of(one), _sum_of(other)
    analog = [part.estimator[direction] == "analog" for part in (one, other)]
    if all(analog):
        return np.asarray(-2.0 * value[direction] * other_value[direction] / max(rays - 1, 1))
    if any(analog):
        # Each has a run of its own.
        return np.zeros(one.energy.shape[1])
    if one.batches is None or other.batches is None:
        return np.asarray(2.0 * stderr[direction] * other_stderr[direction])
    a, b = (batches[direction].sum(axis=(-2, -1)) for batches in (one.batches, other.batches))
    return np.asarray(2.0 * ((a - a.mean(axis=0)) * (b - b.mean(axis=0))).sum(axis=0) / (len(a) * (len(a) - 1.0)))


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
