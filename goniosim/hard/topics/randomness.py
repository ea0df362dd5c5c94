"""Random numbers: the same from the same seed, others from any other."""

from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...scene import Scene
from ..check import Check, in_sigmas, statement
from ..ways import by_estimator

# Next to each other, and where integers of 32 bits, of 53 in a float64, and signed ones end.
SEEDS = (0, 1, 2, 3, 4, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53, 2**53 + 1, 2**62, 2**63 - 2, 2**63 - 1)


def neighbouring_seeds(scene: Scene) -> Iterator[Check]:
    """Seeds next to each other, and at the ends of integers, give independent slices."""
    for name in dict(by_estimator(scene)):
        found = [simulate(scene, estimator=name, seed=seed).components["reflection/internal"] for seed in SEEDS]
        energy = np.array([component.energy[0, 0].ravel() for component in found])
        stderr = np.array([component.stderr[0, 0].ravel() for component in found])
        deviations = (energy - energy.mean(axis=0)) / stderr.mean(axis=0)
        # Slices of some estimators are their own mirror images, which hold each number twice.
        deviations = deviations.reshape(len(SEEDS), *found[0].energy.shape[2:])[:, :, : found[0].energy.shape[3] // 2]
        deviations = deviations.reshape(len(SEEDS), -1)
        products = deviations @ deviations.T / deviations.shape[1]
        pairs = products[np.triu_indices(len(SEEDS), 1)]
        # The common mean makes the expected product -1 / N of a variance.
        yield in_sigmas(f"{name}: correlation of two seeds", pairs, deviations.shape[1] ** -0.5, -1.0 / len(SEEDS))


def any_number_of_threads(scene: Scene) -> Iterator[Check]:
    """One thread, two, three and seven: the same bits, by every estimator."""
    for name, one in by_estimator(scene, threads=1):
        for threads in (2, 3, 7):
            other = simulate(scene, estimator=name, threads=threads)
            same = all(
                np.array_equal(getattr(component, part), getattr(other.components[path], part))
                for path, component in one.components.items()
                for part in ("energy", "stderr", "bsdf", "bsdf_stderr")
            )
            audits = all(np.array_equal(value, other.audit.energy[entry]) for entry, value in one.audit.energy.items())
            yield statement(
                f"{name}: {threads} threads against one",
                same and audits,
                "same bits",
                "same bits" if same and audits else "others",
            )


CASES = (neighbouring_seeds, any_number_of_threads)
