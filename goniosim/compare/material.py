"""The comparison of all models with one material."""

import time
from dataclasses import dataclass

import numpy as np

from ..integration import integrate_fixed
from ..models import MODELS, prepare
from ..result import Component, Result
from ..scene import Scene, parse_scene
from .cells import grid_of, to_bsdf, to_slice
from .convergence import converge
from .counts import count
from .measures import Measures, measure, rmse
from .variants import Variant, components_for, variants_for

# An RMSE that differs by more than this share from that of the converged integration is marked.
CONVERGED = 0.02
# What a converged integration took, the least first.
INTEGRATIONS = ("fixed", "adaptive", "exhausted")


@dataclass(frozen=True, eq=False)
class Slices:
    """Integrated slices of one variant and component.

    Attributes
    ----------
    energy : ndarray, shape (M, C, R, K)
        Fraction of the incident flux; 0 in cells that are not valid.
    finer, converged : ndarray, shape (M, C, R, K)
        The same from finer sub-cells, and integrated adaptively.
    integration : list of str
        What ``converged`` took in each direction, see `convergence.Levels`.
    seconds : float
        Time of ``energy`` per slice: preparation, evaluation and integration.
    contains_delta : bool
        Whether some energy leaves in exactly the mirror direction.
    """

    energy: np.ndarray
    finer: np.ndarray
    converged: np.ndarray
    integration: list
    seconds: float
    contains_delta: bool

    def __repr__(self):
        directions, channels, rows, columns = self.energy.shape
        return f"<Slices: {directions} directions, {channels} channels, {rows} x {columns} cells>"


@dataclass(frozen=True, eq=False)
class Compared:
    """One variant against the reference, in one component.

    Attributes
    ----------
    variant : Variant
    component : str
    measures, finer, converged : Measures
        With the sub-cells asked for, with finer ones, and integrated adaptively.
    integration : list of str
        What ``converged`` took in each direction: one of `INTEGRATIONS`.
    seconds : float
        Time of the model per slice.
    """

    variant: Variant
    component: str
    measures: Measures
    finer: Measures
    converged: Measures
    integration: list
    seconds: float

    def __repr__(self):
        found = rmse(self.measures)
        return f"<Compared {self.variant.label}, {self.component}: RMSE {found.rmse:.3g} ± {found.stderr:.1g} sr^-1/2>"

    def is_converged(self, direction=None, channel=None):
        """Whether the sub-cells asked for give the RMSE to 2 %; arguments as in `measures.rmse`."""
        if self.integrated(direction) == "exhausted":
            return False
        found, limit = (rmse(each, direction, channel) for each in (self.measures, self.converged))
        if not (found.significant or limit.significant):
            return True
        return abs(found.rmse - limit.rmse) <= CONVERGED * limit.rmse

    def integrated(self, direction=None):
        """What the converged integration took in a direction, or at most in any of them."""
        return _most(self.integration if direction is None else [self.integration[direction]])


@dataclass(frozen=True, eq=False)
class MaterialComparison:
    """All models against one result.

    Attributes
    ----------
    result : goniosim.result.Result
    scene : goniosim.scene.Scene
    subcells : int
    variants : list of Variant
    not_applicable : dict of str to str
        Models that do not apply, each with the sentence why.
    components : tuple of str
        Main component first.
    compared : list of Compared
    slices : dict of (str, str) to goniosim.result.Component
        By label of the variant and component, ``reflection`` only where a model does not split it.
    """

    result: Result
    scene: Scene
    subcells: int
    variants: list
    not_applicable: dict
    components: tuple
    compared: list
    slices: dict

    def __repr__(self):
        labels = ", ".join(variant.label for variant in self.variants)
        return f"<MaterialComparison {self.result.name}, {', '.join(self.components)}: {labels or 'no model applies'}>"

    @property
    def simulation_seconds(self):
        """Time of the simulation per slice."""
        seconds = self.result.cost.elapsed
        return float(seconds[-1]) / len(self.result.theta_deg) if len(seconds) else 0.0

    def bsdf(self, label, component):
        """Slices of a variant in 1/sr, shape (M, C, R, K); direct and internal paths are added up."""
        parts = (part for part in self.slices if part[0] == label and part[1].startswith(component))
        return sum(self.slices[part].bsdf for part in parts)

    def reference(self, component):
        """Slices of the simulation and their standard errors in 1/sr, each of shape (M, C, R, K)."""
        return reference(self.result, component)


def compare_material(result, request, subcells, pool, progress=None):
    """Compare the models with one result.

    Parameters
    ----------
    result : goniosim.result.Result
    request : dict of str to dict
        From `variants.check_request`.
    subcells : int
        Sub-cells along each side of a cell.
    pool : goniosim.integration.Pool
    progress : callable, optional
        Called as ``progress(done, total)`` after every integrated variant.

    Returns
    -------
    MaterialComparison
    """
    scene = parse_scene(result.config_yaml, f"the scene of {result.name}")
    variants, not_applicable = variants_for(scene, request)
    components = components_for(scene)
    grids = [grid_of(result, m) for m in range(len(result.theta_deg))]
    compared, slices = [], {}
    for done, variant in enumerate(variants):
        parts = {}
        for component in components:
            for part in _parts(scene, variant.model, component):
                if part not in parts:
                    parts[part] = _integrated(scene, variant, part, grids, subcells, pool)
            own = [parts[part] for part in _parts(scene, variant.model, component)]
            compared.append(_compared(result, variant, component, own))
        for part, found in parts.items():
            slices[variant.label, part] = _component(found, result.cells)
        if progress is not None:
            progress(done + 1, len(variants))
    return MaterialComparison(result, scene, subcells, variants, not_applicable, components, compared, slices)


def reference(result, component):
    """BSDF and standard error of a component of a result, ``reflection`` being all that is reflected."""
    parts = [part for name, part in result.components.items() if name.startswith(component)]
    bsdf = sum(part.bsdf for part in parts)
    return bsdf, np.sqrt(sum(part.bsdf_stderr**2 for part in parts))


def _parts(scene, model, component):
    """What is integrated for a component: the direct and internal paths apart where the model tells them."""
    split = ("reflection/direct", "reflection/internal")
    if component == "reflection" and all(MODELS[model].supports(scene, part) is None for part in split):
        return split
    return (component,)


def _integrated(scene, variant, component, grids, subcells, pool):
    """Integrate a variant in all directions."""
    options = dict(variant.options)
    levels = {"energy": [], "finer": [], "converged": []}
    integration = []
    # Compiled code is loaded before the clock starts.
    first = prepare(variant.model, scene, grids[0].theta_deg, component, options)
    integrate_fixed(first, grids[0], 1, pool, grids[0].numbers[:1])
    seconds, contains_delta = 0.0, False
    for grid in grids:
        started = time.perf_counter()
        prepared = prepare(variant.model, scene, grid.theta_deg, component, options)
        coarse, spread = integrate_fixed(prepared, grid, subcells, pool)
        seconds += time.perf_counter() - started
        contains_delta |= bool(np.any(prepared.mirror_energy))
        found = converge(prepared, grid, subcells, pool, coarse, spread)
        for kept, energy in zip(levels.values(), (found.coarse, found.finer, found.converged), strict=True):
            kept.append(to_slice(prepared, grid, energy))
        integration.append(found.integration)
    return Slices(
        **{name: np.stack(kept) for name, kept in levels.items()},
        integration=integration,
        seconds=seconds / len(grids),
        contains_delta=contains_delta,
    )


def _component(found, cells):
    # A model has no noise; how far its integration is from converged stands in the table.
    none = np.broadcast_to(0.0, found.energy.shape)
    bsdf = to_bsdf(found.energy, cells)
    return Component(found.energy, none, bsdf, none, contains_delta=found.contains_delta)


def _compared(result, variant, component, parts):
    bsdf, stderr = reference(result, component)
    counts = count(result, component)
    measures = [
        measure(to_bsdf(sum(energies), result.cells), bsdf, stderr, result.cells, counts)
        for energies in zip(*((part.energy, part.finer, part.converged) for part in parts), strict=True)
    ]
    return Compared(
        variant,
        component,
        *measures,
        integration=[_most(taken) for taken in zip(*(part.integration for part in parts), strict=True)],
        seconds=sum(part.seconds for part in parts),
    )


def _most(integrations):
    return max(integrations, key=INTEGRATIONS.index)
