"""What the figures of a material show: in each direction the simulation and the models, seen alike."""

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ...result import Cells
from .. import text
from ..drawing import inplane, panels, tone, view, zoom
from . import labels


@dataclass(frozen=True, eq=False)
class Entry:
    """The simulation or a model in one direction.

    Attributes
    ----------
    label : str
    model : str or None
        None for the simulation.
    options_text : str
        Options of the model that are not at their default.
    slices : ndarray, shape (C, R, K)
        BSDF in 1/sr.
    angle, f, sigma : ndarray, shape (P,)
        Luminance along the plane of incidence and its standard error, see `inplane`; NaN where nothing was seen.
    highest : float
        Where the curve is not mere noise, in 1/sr; 1 in the dark. A Dirac part does not count.
    dirac : int or None
        The cell that holds light leaving in exactly one direction.
    unseen : ndarray of bool, shape (R, K), or None
        Cells that no path hit, see `panels.unseen_cells`.
    narrow : (float, float) or None
        Range of angles in degrees to be enlarged, see `zoom.window`.
    error : str
        RMSE of the model in this direction, if it was compared, in words.
    converged : bool
        Whether the sub-cells give the error.
    """

    label: str
    model: str | None
    options_text: str
    slices: np.ndarray
    angle: np.ndarray
    f: np.ndarray
    sigma: np.ndarray
    highest: float
    dirac: int | None
    unseen: np.ndarray | None = None
    narrow: tuple | None = None
    error: str = ""
    converged: bool = True


@dataclass(frozen=True, eq=False)
class Direction:
    """One incident direction of a material.

    Attributes
    ----------
    number : int
    theta_deg : float
    angle : str
        The same in words that no other direction of the material shares.
    cells : goniosim.result.Cells
    entries : list of Entry
        The simulation first, if it is there.
    """

    number: int
    theta_deg: float
    angle: str
    cells: Cells
    entries: list

    @cached_property
    def scaling(self):
        """The entry that sets all scales: the simulation, or else the model of median brightness."""
        if self.entries[0].model is None:
            return self.entries[0]
        return sorted(self.entries, key=lambda entry: entry.highest)[len(self.entries) // 2]

    def coinciding(self, tolerance):
        """For each entry the numbers of earlier ones whose curves it nowhere leaves.

        Parameters
        ----------
        tolerance : float
            Of the remapped luminance, as in `panels.coinciding`.

        Returns
        -------
        list of set of int
            The simulation has its noise, and coincides with nothing.
        """
        found = panels.coinciding([(entry.angle, tone.remap(entry.f)) for entry in self.entries], tolerance)
        noisy = {number for number, entry in enumerate(self.entries) if entry.model is None}
        return [set() if number in noisy else each - noisy for number, each in enumerate(found)]

    def disk(self, pixels):
        """Cells seen from above, see `view.disk`."""
        return view.disk(self.cells, self.number, self.theta_deg, pixels)

    def spot(self, entry):
        """Direction of the Dirac part of an entry, or None."""
        return None if entry.dirac is None else view.centre(self.cells, self.theta_deg, entry.dirac)


def of_comparison(comparison, number):
    """What is seen of the main component of a comparison in one direction.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison
    number : int
        Which of the incident directions.

    Returns
    -------
    Direction
    """
    # Only here: whoever draws does without the compiler that comes with it.
    from ...compare.measures import rmse

    result, component = comparison.result, comparison.components[0]
    theta_deg = float(result.theta_deg[number])
    see = partial(_entry, result.cells, number, theta_deg, component)
    entries = [see("simulation", None, "", result.components)]
    for found in comparison.compared:
        if found.component == component:
            variant = found.variant
            slices = {part: each for (label, part), each in comparison.slices.items() if label == variant.label}
            converged = found.is_converged(number)
            error = rmse(found.measures, number)
            words = labels.error_text(error.rmse, error.stderr, error.upper, error.significant, converged)
            seen = see(variant.label, variant.model, variant.options_text, slices, error=words, converged=converged)
            entries.append(seen)
    return Direction(number, theta_deg, text.angles(result.theta_deg)[number], result.cells, entries)


def of_models(material, models, number):
    """What is seen of the main component of integrated models in one direction.

    Parameters
    ----------
    material : goniosim.store.models.contents.MaterialEntry
    models : list of (goniosim.store.models.contents.ModelEntry, dict of str to goniosim.result.Component)
    number : int
        Which of the incident directions.

    Returns
    -------
    Direction
    """
    theta_deg = float(material.theta_deg[number])
    see = partial(_entry, material.cells, number, theta_deg, material.main_component)
    entries = [see(model.label, model.model, model.options, slices) for model, slices in models]
    return Direction(number, theta_deg, text.angles(material.theta_deg)[number], material.cells, entries)


def twins(directions, tolerances):
    """The entry, if any, whose curve covers that of each entry in all of some directions.

    Parameters
    ----------
    directions : list of Direction
    tolerances : list of float
        For each of them, see `Direction.coinciding`.

    Returns
    -------
    list of (Entry or None)
        With the same options if there is such a one.
    """
    entries = directions[0].entries
    found = [each.coinciding(tolerance) for each, tolerance in zip(directions, tolerances, strict=True)]
    chosen = []
    for entry, earlier in zip(entries, zip(*found, strict=True), strict=True):
        common = [entries[number] for number in sorted(set.intersection(*earlier))]
        common.sort(key=lambda other: other.options_text != entry.options_text)
        chosen.append(common[0] if common else None)
    return chosen


def _entry(cells, number, theta_deg, component, label, model, options, slices, **error):
    """See a component, which may be stored in parts."""
    if component in slices:
        parts = [slices[component]]
    else:
        parts = [part for name, part in slices.items() if name.startswith(component)]
    bsdf = sum(part.bsdf[number] for part in parts)
    stderr = np.sqrt(sum(part.bsdf_stderr[number] ** 2 for part in parts))
    dirac = next((panels.dirac_cell(part, number) for part in parts if part.contains_delta), None)
    curve = partial(inplane.plane_of_incidence, cells, number, theta_deg)
    angle, f, sigma = curve(_luminance(bsdf), _luminance(stderr))
    clear = panels.without_cell(bsdf, dirac)
    scaling = curve(_luminance(clear), _luminance(stderr))
    highest = inplane.highest(*scaling[1:], panels.BAND_SIGMAS) or 1.0
    # What leaves in one exact direction and nothing else has no shape to be seen.
    narrow = None if dirac is not None and clear is bsdf else zoom.of_channels(*scaling)
    unseen = panels.unseen_cells(parts, cells, number)
    f, sigma = f[:, 0], sigma[:, 0]
    if unseen is not None:
        f = np.where(f > 0.0, f, np.nan)
    return Entry(label, model, options, bsdf, angle, f, sigma, highest, dirac, unseen, narrow, **error)


def _luminance(slices):
    """Shape (1, R, K); of standard errors too, for those of the channels, which share their paths, add up."""
    weights = tone.LUMINANCE if len(slices) == 3 else np.full(len(slices), 1.0 / len(slices))
    return np.tensordot(weights, slices, axes=1)[None]
