"""A simulated goniometer measurement in memory: plain data, no behaviour of the engine or of HDF5.

Axes are always ``[direction, channel, row, column]``; M directions, C channels,
R rows, K columns.
"""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Component:
    """One component of the scattered light, as cell averages.

    Attributes
    ----------
    energy, stderr : ndarray, shape (M, C, R, K)
        Fraction of the incident flux that leaves into the cell, and the
        standard error of that fraction.
    bsdf, bsdf_stderr : ndarray, shape (M, C, R, K)
        ``energy`` and ``stderr`` divided by the projected solid angle of the
        cell, in 1/sr; zero where the cell is not valid.
    hits : ndarray of int64, shape (M, R, K), or None
        Number of paths that deposited energy in the cell. None for a
        component that is integrated instead of sampled.
    contains_delta : bool
        Whether some of the energy leaves in exactly one direction (a chain of
        smooth interfaces); the BSDF of the cell that holds that direction is
        then a cell average of a Dirac delta.
    orders : dict of str to Component
        Decomposition by the number of events on the top interface:
        ``order_2``, ``order_3``, ..., ``order_N_and_more``. Empty unless asked for.
    """

    energy: np.ndarray
    stderr: np.ndarray
    bsdf: np.ndarray
    bsdf_stderr: np.ndarray
    hits: np.ndarray | None = None
    contains_delta: bool = False
    orders: dict[str, "Component"] = field(default_factory=dict)


@dataclass
class Cells:
    """The cells of the slices.

    Attributes
    ----------
    parametrization : str
        ``classic`` (rows theta_v, columns phi_v) or ``half`` (rows
        u = sqrt(theta_h pi/2), columns phi_h).
    row_edges : ndarray, shape (R + 1,)
        Edges of the rows in degrees of the row coordinate, 0 to 90.
    column_edges : ndarray, shape (K + 1,)
        Edges of the columns in degrees, 0 to 360.
    valid : ndarray of bool, shape (M, R, K)
        Cells that lie wholly above the horizon.
    solid_angle, projected_solid_angle : ndarray, shape (M, R, K)
        Of the part of the cell above the horizon, in sr; the second is
        weighted by cos(theta_v) and sums to pi.
    """

    parametrization: str
    row_edges: np.ndarray
    column_edges: np.ndarray
    valid: np.ndarray
    solid_angle: np.ndarray
    projected_solid_angle: np.ndarray


@dataclass
class Audit:
    """Where the incident energy went, per direction and channel, as fractions of it.

    The entries sum to 1 to rounding: each is tallied by itself during the walk.

    Attributes
    ----------
    energy, stderr : dict of str to ndarray, shape (M, C)
        Keys are the names in `AUDIT_ENTRIES`, in that order. The standard
        errors come from the scatter between 64 or more independent parts of
        the rays (four or more in a partial result).
    direct_integrated, direct_integrated_stderr : ndarray, shape (M, C)
        Energy of the direct reflection by integration over the cells, to be
        compared with the sampled ``reflected_direct``.
    """

    energy: dict[str, np.ndarray]
    stderr: dict[str, np.ndarray]
    direct_integrated: np.ndarray
    direct_integrated_stderr: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """1 minus the sum of all entries, shape (M, C): rounding only."""
        return 1.0 - np.sum(list(self.energy.values()), axis=0)


AUDIT_ENTRIES = {
    "reflected_direct": "left upwards after a single event on the top interface (sampled)",
    "reflected_internal": "left upwards after having entered the stack",
    "transmitted": "left downwards",
    "absorbed_media": "absorbed by media (Beer-Lambert)",
    "absorbed_base": "absorbed by an opaque interface (conductor or Lambertian)",
    "lost_masked_reflection": "reflected by a facet, then masked or sent to the wrong side",
    "lost_masked_transmission": "refracted by a facet, then masked or sent to the wrong side",
    "lost_roulette": "killed minus boosted by Russian roulette; zero on average",
    "lost_event_cap": "still on its way when the limit on the number of events was reached",
}


@dataclass
class Cost:
    """What accuracy cost in time: one row per checkpoint.

    Attributes
    ----------
    rays : ndarray, shape (P,)
        Rays per incident direction (mean over directions) traced so far.
    seconds, cpu_seconds : ndarray, shape (P,)
        Wall-clock and processor time of tracing so far, without compilation.
    error : dict of str to ndarray, shape (P,)
        Per sampled component, in 1/sr^(1/2): the mean over the channels of the
        root of the mean over the directions of the integral of
        bsdf_stderr^2 cos(theta) over the valid cells. This is the noise floor of
        the RMSE of Eq. 4, Bati et al. 2019, as in the table of errors.
    """

    rays: np.ndarray
    seconds: np.ndarray
    cpu_seconds: np.ndarray
    error: dict[str, np.ndarray]


@dataclass
class Result:
    """Everything one simulation of one material yields; what a result file holds.

    Attributes
    ----------
    config_yaml : str
        The scene that was simulated, complete with defaults and overrides, as YAML.
    config_hash : str
        Identity of the scene, see `goniosim.scene.Scene.config_hash`: not the name, not the rays, not the threads.
    name : str
        Name of the material.
    status : str
        ``complete`` or ``partial``.
    seed : int
    theta_deg, phi_deg : ndarray, shape (M,)
        Incident directions in degrees.
    rays : ndarray of int64, shape (M,)
        Rays traced from each direction.
    channels : list of str
    cells : Cells
    components : dict of str to Component
        ``reflection/direct``, ``reflection/internal``, ``transmission``; only
        those the scene can have.
    audit : Audit
    cost : Cost
    effects : dict of str to bool
        Which effects the scene called for.
    provenance : dict of str to str
        Versions, processor, threads, creation time (``created_utc``,
        ``goniosim_version``, ...).
    """

    config_yaml: str
    config_hash: str
    name: str
    status: str
    seed: int
    theta_deg: np.ndarray
    phi_deg: np.ndarray
    rays: np.ndarray
    channels: list[str]
    cells: Cells
    components: dict[str, Component]
    audit: Audit
    cost: Cost
    effects: dict[str, bool]
    provenance: dict[str, str]
