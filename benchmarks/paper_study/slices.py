"""Slices of the simulation and of the models, and what is summed over parts of them."""

from dataclasses import dataclass

import h5py
import numpy as np

import goniosim
from goniosim.slices import PARAMETRIZATIONS
from goniosim.sums import noise_of

from .errors import StudyError
from .verdicts import Value


@dataclass(frozen=True)
class Slice:
    """One component in all directions.

    Attributes
    ----------
    energy, stderr : ndarray, shape (M, C, R, K)
    noise : list
        How the noise of the cells hangs together in each direction (`goniosim.sums`); None where there is none.
    """

    energy: np.ndarray
    stderr: np.ndarray
    noise: list


class Slices:
    """Simulated and integrated slices of one material.

    Parameters
    ----------
    results : Path
        The folder of results, with ``comparison/models.h5``.
    material : Material
    """

    def __init__(self, results, material):
        self._results = results
        self.material = material
        self.result = goniosim.open_result(results / f"{material.name}.h5")

    def reference(self, component):
        """The simulated `Slice` of a component."""
        return slice_of(self.result, self.result.components[component])

    def model(self, label, component):
        """The `Slice` of a model, integrated with 5 x 5 sub-cells."""
        energy = model_energy(self._results, self.material.name, label, component)
        return Slice(energy, np.zeros_like(energy), [None] * len(energy))

    def direction(self, theta_deg):
        """Number of an incident direction."""
        return int(np.argmin(np.abs(self.result.theta_deg - theta_deg)))

    def bsdf(self, found, direction):
        """BSDF and standard error of a `Slice` in one direction, each (C, R, K); 0 where it has no value."""
        cells = self.result.cells
        size, valid = cells.projected_solid_angle[direction], cells.valid[direction]
        scale = np.where(valid & (size > 0.0), 1.0 / np.maximum(size, 1e-300), 0.0)
        return found.energy[direction] * scale, found.stderr[direction] * scale

    def polar(self, direction):
        """Polar angle of the viewer at the centre of every cell, in degrees, shape (R, K)."""
        z = view_directions(self.result.cells, self.result.theta_deg[direction])[2]
        return np.degrees(np.arccos(np.clip(z, -1.0, 1.0)))

    def along_plane(self, direction):
        """Sine of the viewer's polar angle along the plane of incidence, positive on the mirror side, (R, K)."""
        return view_directions(self.result.cells, self.result.theta_deg[direction])[0]

    def region(self, found, direction, chosen):
        """Energy of each channel in a part of the valid cells.

        Parameters
        ----------
        found : Slice
        direction : int
        chosen : ndarray of bool, shape (R, K)

        Returns
        -------
        list of Value
        """
        return energy_in(found, direction, chosen & self.result.cells.valid[direction])


def slice_of(result, component):
    """The `Slice` of a component of a result, or of one of its orders."""
    noise = [noise_of(component, m, rays) for m, rays in enumerate(result.rays)]
    return Slice(component.energy, component.stderr, noise)


def energy_in(found, direction, where):
    """Energy of each channel in some cells, a list of `Value`.

    Parameters
    ----------
    found : Slice
    direction : int
    where : ndarray of bool, shape (R, K)
    """
    weights = where.astype(float)
    variance = (found.stderr[direction] ** 2 * weights).sum(axis=(1, 2))
    if found.noise[direction] is not None:
        variance = variance + found.noise[direction].of_sum(weights)
    energy, stderr = (found.energy[direction] * weights).sum(axis=(1, 2)), np.sqrt(np.maximum(variance, 0.0))
    return [Value(float(e), float(s)) for e, s in zip(energy, stderr, strict=True)]


def ratio(a, b):
    """Ratio of two values as a `Value`; what they share of their noise makes its error smaller than stated."""
    if b.value <= 0.0:
        return Value(float("nan"), float("inf"))
    value = a.value / b.value
    return Value(value, value * np.hypot(a.stderr / max(a.value, 1e-300), b.stderr / b.value))


def view_directions(cells, theta_deg):
    """Directions to the viewer at the centres of the cells of a slice.

    Parameters
    ----------
    cells : goniosim.result.Cells
    theta_deg : float
        Of the light.

    Returns
    -------
    ndarray, shape (3, R, K)
        Unit vectors; x counts from the light to the mirror direction, z is negative below the horizon.
    """
    u, phi = (np.radians(0.5 * (e[1:] + e[:-1])) for e in (cells.row_edges, cells.column_edges))
    theta = np.radians(theta_deg)
    light = np.array([np.sin(theta), 0.0, np.cos(theta)])
    x, y, z = np.moveaxis(PARAMETRIZATIONS[cells.parametrization][1].directions(u[:, None], phi, light), -1, 0)
    return np.stack([-x, y, z])


def model_energy(results, name, label, component):
    """Energies of a model in all cells, from models.h5, shape (M, C, R, K).

    Parameters
    ----------
    results : Path
        The folder of results.
    name : str
        Of the material.
    label : str
        Of the model, with its options in brackets.
    component : str

    Raises
    ------
    StudyError
        There is no such file, or it does not hold them.
    """
    path = results / "comparison" / "models.h5"
    place = f"{name}/{label}/{component}/energy"
    try:
        with h5py.File(path, "r") as file:
            return file[place][:]
    except (OSError, KeyError) as error:
        raise StudyError(f"{path}: {place} cannot be read: {error}; run `goniosim compare` anew") from error
