"""Random numbers: the same from the same seed, others from any other."""

from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...result import Result
from ...scene import Scene
from ..check import Check, absolute, in_sigmas, statement
from ..ways import by_estimator

# Next to each other, and where integers of 32 bits, of 53 in a float64, and signed ones end.
SEEDS = (0, 1, 2, 3, 4, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53, 2**53 + 1, 2**62, 2**63 - 2, 2**63 - 1)


def neighbouring_seeds(scene: Scene) -> Iterator[Check]:
    """Seeds next to each other, and at the ends of integers, give independent slices."""
    for name in dict(by_estimator(scene, rays=1000)):
        found = [simulate(scene, estimator=name, seed=seed).components["reflection/internal"] for seed in SEEDS]
        energy = np.array([component.energy[0, 0].ravel() for component in found])
        pairs = np.triu_indices(len(SEEDS), 1)
        alike = [(one == other)[one > 0.0].mean() for one, other in zip(*(energy[each] for each in pairs), strict=True)]
        yield absolute(f"{name}: share of cells that agree by chance", alike, 0.0, 0.01)
        if name == "analog":
            # Only here the noise of cells is independent, so that a correlation has a known error.
            stderr = np.array([component.stderr[0, 0].ravel() for component in found])
            deviations = (energy - energy.mean(axis=0)) / stderr.mean(axis=0)
            correlation = (deviations @ deviations.T / deviations.shape[1])[pairs]
            # The common mean makes the expected product of two -1 / N of a variance.
            error = deviations.shape[1] ** -0.5
            yield in_sigmas(f"{name}: correlation of two seeds", correlation, error, -1.0 / len(SEEDS))


def any_number_of_threads(scene: Scene) -> Iterator[Check]:
    """One thread, two, three and seven: the same bits, by every estimator."""
    for name, one in by_estimator(scene, threads=1):
        for threads in (2, 3, 7):
            other = simulate(scene, estimator=name, threads=threads)
            got = _first_difference(one, other) or "same bits"
            yield statement(f"{name}: {threads} threads against one", got == "same bits", "same bits", got)


def _first_difference(one: Result, other: Result) -> str:
    """What differs first between two results of one scene, and by how much at the most; empty if nothing does."""
    arrays = {
        f"{path} {part}": (getattr(component, part), getattr(other.components[path], part))
        for path, component in one.components.items()
        for part in ("energy", "stderr", "bsdf", "bsdf_stderr")
    }
    arrays |= {f"audit {entry}": (value, other.audit.energy[entry]) for entry, value in one.audit.energy.items()}
    for name, (first, second) in arrays.items():
        if not np.array_equal(first, second):
            apart = first != second
            size = np.maximum(np.abs(first[apart]), np.abs(second[apart]))
            return (
                f"{name} differs, relatively by {np.max(np.abs(first[apart] - second[apart]) / size):.2g} at the most"
            )
    return ""


CASES = (neighbouring_seeds, any_number_of_threads)
