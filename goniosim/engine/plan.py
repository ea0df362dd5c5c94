"""A scene lowered to the flat tables that the compiled engine reads: only what the scene calls for."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..scene import distinct_channels, optical_stack
from ..slices import PARAMETRIZATIONS, slice_geometry
from .layout import DOWN, UP
from .stages import LAMBERT, OPAQUE, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC, lower
from .stages.smooth_conductor import ETA, KAPPA

# The order (events on the top interface) with which a path can first leave upwards after having
# entered the stack, and downwards.
FIRST_ORDER = (2, 1)


@dataclass(frozen=True)
class Plan:
    """What to trace, and nothing that no layer or option asks for.

    K interfaces, D distinct channels, M directions.

    Attributes
    ----------
    kinds : ndarray of int64, shape (K,)
        Interface types, see `stages`.
    alphas, etas : ndarray, shape (K,)
        GGX width, and index below relative to above (1 for opaque interfaces).
    spectral : ndarray, shape (K, 2, D)
        Relative eta and kappa of conductors, rho of Lambertian bases.
    forgets : ndarray of bool, shape (K,)
        Interfaces to which the azimuth of an arriving ray does not matter.
    taus : ndarray, shape (max(K - 1, 1), D)
        Optical depths between interfaces.
    absorbs : ndarray of bool, shape (max(K - 1, 1),)
    distinct : list of int
        A representative channel for every distinct one.
    position : list of int
        Of every channel of the scene, its place among the distinct ones.
    theta_deg : ndarray, shape (M,)
    light : ndarray, shape (M, 3)
        Unit vectors to the light.
    orders : int
        Orders to tell apart, 0 for none.
    slots : ndarray of int64, shape (2, 3)
        For exits upwards and downwards: first histogram, number of histograms, first order.
    """

    kinds: np.ndarray
    alphas: np.ndarray
    etas: np.ndarray
    spectral: np.ndarray
    forgets: np.ndarray
    taus: np.ndarray
    absorbs: np.ndarray
    distinct: list
    position: list
    theta_deg: np.ndarray
    light: np.ndarray
    orders: int
    slots: np.ndarray
    parametrization_name: str
    rows: int
    columns: int

    @cached_property
    def geometry(self):
        """The cells, a `goniosim.slices.Geometry` for each direction; computed when first asked for."""
        name, rows, columns = self.parametrization_name, self.rows, self.columns
        return [slice_geometry(name, rows, columns, theta) for theta in self.theta_deg]

    @property
    def n_distinct(self):
        """Channels that are traced."""
        return len(self.distinct)

    @property
    def n_slots(self):
        """Histograms, over both ways out."""
        return int(self.slots[:, 1].sum())

    @cached_property
    def width(self):
        """Columns that tell all: light at phi = 0 on isotropic layers makes column K - 1 - j equal to column j.

        But light that stays in the plane of incidence lies on an edge, and belongs to the column behind it alone.
        """
        folds = self.columns % 2 == 0 and not any(self.has_specular_chain(side) for side in (UP, DOWN))
        return self.columns // 2 if folds else self.columns

    def in_one_cell(self):
        """The same rays, all of whose exits share one cell: for what does not look at slices."""
        return replace(self, rows=1, columns=1, orders=0, slots=_slots(len(self.kinds), self.slots[DOWN, 1] > 0, 0))

    @property
    def parametrization(self):
        """Number of the parametrization in compiled code."""
        return PARAMETRIZATIONS[self.parametrization_name][0]

    @property
    def tables(self):
        """The tuple of tables that `walk.walk` takes."""
        return (
            self.kinds,
            self.alphas,
            self.etas,
            self.spectral,
            self.forgets,
            self.taus,
            self.absorbs,
            self.orders > 0,
        )

    @property
    def blacks(self):
        """Where the index of an interface is that of the medium above, so that a conductor is black; (K, D) of bool."""
        return (self.spectral[:, ETA] == 1.0) & (self.spectral[:, KAPPA] == 0.0)

    @property
    def mirrors(self):
        """Whether each interface is smooth and reflects anything; ndarray of bool, shape (K,)."""
        reflects = np.where(self.kinds == SMOOTH_CONDUCTOR, ~self.blacks.all(axis=1), self.etas != 1.0)
        return np.isin(self.kinds, (SMOOTH_DIELECTRIC, SMOOTH_CONDUCTOR)) & reflects

    def has_specular_chain(self, side):
        """Whether light can leave upwards (inside the stack) or downwards by smooth interfaces alone."""
        # No light enters a medium whose index is below the sine of its angle outside.
        enters = np.cumprod(self.etas) > self.light[:, 0].min()
        passed = np.logical_and.accumulate((self.kinds == SMOOTH_DIELECTRIC) & enters)
        if side == DOWN:
            return bool(passed[-1])
        return bool((passed[:-1] & self.mirrors[1:]).any())


def make_plan(scene):
    """Lower a scene.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    Plan
    """
    distinct, position = distinct_channels(scene)
    material = optical_stack(scene.material).material
    interfaces = material.interfaces
    k = len(interfaces)
    kinds = np.zeros(k, np.int64)
    alphas = np.zeros(k)
    etas = np.ones(k)
    spectral = np.zeros((k, 2, len(distinct)))
    above = 1.0
    for i, interface in enumerate(interfaces):
        kinds[i], alphas[i], etas[i], rows = lower(interface, above)
        for row, values in enumerate(rows):
            spectral[i, row] = [values[c] for c in distinct]
        # The index itself: a product of ratios would not come back to it exactly.
        above = above if interface.opaque else interface.eta
    taus = np.zeros((max(k - 1, 1), len(distinct)))
    for i, tau in enumerate(material.tau):
        taus[i] = [tau[c] for c in distinct]

    orders = scene.simulation.orders or 0
    rows, columns = scene.slice.rows, scene.slice.columns
    theta_deg = np.array(scene.incident.theta_deg, dtype=float)
    return Plan(
        kinds=kinds,
        alphas=alphas,
        etas=etas,
        spectral=spectral,
        forgets=kinds == LAMBERT,
        taus=taus,
        absorbs=(taus > 0.0).any(axis=1),
        distinct=distinct,
        position=position,
        theta_deg=theta_deg,
        light=np.array([[math.sin(t), 0.0, math.cos(t)] for t in np.radians(theta_deg)]),
        orders=orders,
        slots=_slots(k, kinds[-1] not in OPAQUE, orders),
        parametrization_name=scene.slice.parametrization,
        rows=rows,
        columns=columns,
    )


def _slots(n_interfaces, transmits, orders):
    """Histograms upwards: orders 2 to N, then all above; downwards: orders 1 to N, then all above."""
    counts = [0, 0]
    if n_interfaces > 1:
        counts[UP] = max(orders, 1)
    if transmits:
        counts[DOWN] = orders + 1 if orders else 1
    return np.array([[0, counts[UP], FIRST_ORDER[UP]], [counts[UP], counts[DOWN], FIRST_ORDER[DOWN]]], dtype=np.int64)
