"""Results of the schemas 1.0 and 1.1, as those of today: what they leave out follows from the rest, or stays open.

All of them are of independent paths (`analog`). Of each component the albedo was an entry of the audit, and which
cells are uncertain follows from energies, errors and rays. The cost was one of all directions together: each gets the
rays, an equal share of the time, and the noise floor of all, so that sums of times and root mean squares of noise are
what they were.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from goniosim.effective import uncertain
from goniosim.result import INTEGRATED, Component, Result
from goniosim.store.layout import Dataset, describe
from goniosim.sums import noise_of, sum_and_error

_VERSIONS = ("1.0", "1.1")
_ENTRIES = {"reflection/internal": "reflected_internal", "transmission": "transmitted"}


class Earlier:
    """What is different in the file with a header, if it is of an earlier schema.

    Parameters
    ----------
    header : dict of str to str or int
        Attributes of the root.
    """

    def __init__(self, header: Mapping[str, str | int]) -> None:
        self._applies = header["schema_version"] in _VERSIONS

    @property
    def checkpoints(self) -> str:
        """Path of a dataset with one number for each checkpoint."""
        return "cost/rays" if self._applies else "cost/checkpoint"

    def describe(self, path: str) -> Dataset:
        """As `layout.describe`, for the file."""
        entry = describe(path)
        return replace(entry, dims=("checkpoint",)) if self._applies and path.startswith("cost/") else entry

    def complete(self, result: Result) -> None:
        """Fill in what the file does not hold."""
        if not self._applies:
            return
        cost, directions = result.cost, len(result.theta_deg)
        cost.rays = _repeated(cost.rays, directions)
        cost.seconds = _repeated(cost.seconds / directions, directions)
        cost.cpu_seconds = _repeated(cost.cpu_seconds / directions, directions)
        cost.error = {name: _repeated(error, directions) for name, error in cost.error.items()}
        for name, component in result.components.items():
            for part in (component, *component.orders.values()):
                _complete(part, result.rays)
            if component.sampled:
                entry = _ENTRIES[name]
                component.albedo, component.albedo_stderr = result.audit.energy[entry], result.audit.stderr[entry]
            else:
                component.albedo = result.audit.direct_integrated
                component.albedo_stderr = result.audit.direct_integrated_stderr


def _repeated(values: np.ndarray, directions: int) -> np.ndarray:
    return np.tile(values, (directions, 1))


def _complete(part: Component, rays: np.ndarray) -> None:
    part.estimator = [INTEGRATED if part.hits is None else "analog"] * len(rays)
    if part.hits is None:
        return
    part.uncertain = uncertain(part.energy, part.stderr, rays[:, None, None, None])
    sums = [sum_and_error(part.energy[m], part.stderr[m], noise_of(part, m, int(n))) for m, n in enumerate(rays)]
    part.albedo, part.albedo_stderr = (np.stack(values) for values in zip(*sums, strict=True))
