"""A simulated goniometer measurement in memory: plain data, no behaviour of the engine or of HDF5.

Axes are always ``[direction, channel, row, column]``; M directions, C channels,
R rows, K columns.

Two of them are equal only if they are the same object: arrays have no single answer to that.

What people do with a result is a method of it, so that they find it, and a line long: it hands on to the
room that knows how, which is imported when the method is called. The ground itself needs no other room.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from xarray import DataTree


# What stands for an estimator where nothing is sampled.
INTEGRATED = "integrated"


@dataclass(eq=False)
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
        component that is integrated instead of sampled, and where an estimator other than ``analog`` was at work.
    uncertain : ndarray of bool, shape (M, C, R, K), or None
        Cells whose value and standard error rest on too few paths or replicates, see `goniosim.effective`. None for
        a component that is not sampled.
    albedo, albedo_stderr : ndarray, shape (M, C), or None
        Sum of ``energy`` over the cells, and its standard error with the covariance of the cells, see `goniosim.sums`;
        0 where nothing arrived, for which `Result.albedo` has a limit. None for a model.
    estimator : list of str
        For each direction what made the numbers: ``analog`` and other estimators, or `INTEGRATED`. Empty for a model.
    node_bias : ndarray, shape (M,), or None
        What the nodes of an operator may be off by, as a norm like that of `Cost.error`. None unless some estimator
        has nodes.
    batches : ndarray, shape (M, B, C, Rb, Kb), or None
        Energy in blocks of cells (`goniosim.sums.block_sums`) by each of B independent batches of replicates: each is
        an unbiased estimate, and their mean is the sum of ``energy`` over the block. Tells the errors of sums over
        cells where paths are not independent; 0 in directions of ``analog``, whose covariance is known, and None if
        there are no others.
    paths, replicates : ndarray of int64, shape (M,), or None
        Light paths, `Result.rays` or more, and replicates where there are `batches`. None before schema 1.4.
    contains_delta : bool
        Whether some of the energy leaves in exactly one direction (a chain of smooth interfaces); the BSDF of the cell
        that holds that direction is then a cell average of a Dirac delta.
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
    orders: dict[str, Component] = field(default_factory=dict)
    uncertain: np.ndarray | None = None
    albedo: np.ndarray | None = None
    albedo_stderr: np.ndarray | None = None
    estimator: list[str] = field(default_factory=list)
    node_bias: np.ndarray | None = None
    batches: np.ndarray | None = None
    paths: np.ndarray | None = None
    replicates: np.ndarray | None = None

    @property
    def sampled(self) -> bool:
        """Whether paths made it, and not an integration or a model."""
        return any(name != INTEGRATED for name in self.estimator)

    def __repr__(self) -> str:
        from goniosim.report import brief

        return brief.component(self)


@dataclass(eq=False)
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

    def __repr__(self) -> str:
        from goniosim.report import brief

        return brief.cells(self)


@dataclass(eq=False)
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
    rays : ndarray of int64, shape (M,), or None
        Independent paths that the sampled entries rest on. None before schema 1.4.
    """

    energy: dict[str, np.ndarray]
    stderr: dict[str, np.ndarray]
    direct_integrated: np.ndarray
    direct_integrated_stderr: np.ndarray
    rays: np.ndarray | None = None

    @property
    def residual(self) -> np.ndarray:
        """1 minus the sum of all entries, shape (M, C): rounding only."""
        return 1.0 - np.sum(list(self.energy.values()), axis=0)

    def __repr__(self) -> str:
        from goniosim.report import brief

        return brief.audit(self)


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


@dataclass(eq=False)
class Cost:
    """What accuracy cost in time, per direction, at P checkpoints.

    Attributes
    ----------
    rays : ndarray, shape (M, P)
        Rays traced so far. A direction that ended before others repeats its last numbers.
    seconds, cpu_seconds : ndarray, shape (M, P)
        Wall-clock and processor time spent on the direction so far, without compilation. Directions share the
        threads, so that wall-clock time is shared out as the processor time is: the sum over directions has elapsed.
    error : dict of str to ndarray, shape (M, P)
        Per sampled component, in 1/sr^(1/2): the mean over the channels of the root of the integral of
        bsdf_stderr^2 cos(theta) over the valid cells. This is the noise floor of
        the RMSE of Eq. 4, Bati et al. 2019, of the direction, as in the table of errors.
    """

    rays: np.ndarray
    seconds: np.ndarray
    cpu_seconds: np.ndarray
    error: dict[str, np.ndarray]

    @property
    def checkpoints(self) -> int:
        """Number of checkpoints."""
        return self.rays.shape[1]

    @property
    def elapsed(self) -> np.ndarray:
        """Wall-clock time of all directions, shape (P,)."""
        return self.seconds.sum(axis=0)

    def noise(self, component: str) -> np.ndarray:
        """Error of a component over all directions, shape (P,): the root of the mean of the squares."""
        return np.sqrt((self.error[component] ** 2).mean(axis=0))

    def __repr__(self) -> str:
        from goniosim.report import brief

        return brief.cost(self)


@dataclass(eq=False)
class Result:
    """Everything one simulation of one material yields; what a result file holds.

    Attributes
    ----------
    config_yaml : str
        The scene that was simulated, complete with defaults and overrides, as YAML.
    config_hash : str
        Identity of the scene, see `goniosim.scene.Scene.config_hash`: not the name, rays or target, threads.
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
    target_reached : bool or None
        Whether the accuracy that the scene asks for was reached; None if it asks for rays.
    state : bytes or None
        Of a partial one, what `goniosim.engine.simulate` goes on from.
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
    target_reached: bool | None = None
    state: bytes | memoryview | None = None

    @property
    def estimator(self) -> str:
        """What made the sampled components: one name if all directions agree, else ``mixed``."""
        found = {name for part in self.components.values() if part.sampled for name in part.estimator}
        return "mixed" if len(found) > 1 else next(iter(found), INTEGRATED)

    def __repr__(self) -> str:
        from goniosim.report import brief

        return brief.result(self)

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the result into a file, whole or not at all; `goniosim.open_result` reads it.

        Parameters
        ----------
        path : str or Path
        overwrite : bool
            Replace whatever result stands there. Without it one of another scene, or of more rays, stays.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        goniosim.errors.OutputError
            It cannot be written, or would replace what is to stay.

        Examples
        --------
        >>> file = result.save("coated.h5")
        >>> goniosim.open_result(file).name
        'coated'
        """
        from goniosim.store import write_result

        # Whoever called it has it still.
        write_result(self, path, overwrite=overwrite, rescued=False)
        return Path(path)

    def albedo(self, component: str | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Share of the incident energy that leaves in a component, with its standard error.

        Parameters
        ----------
        component : str, optional
            One of `components`; one of its orders, such as ``reflection/internal/order_2``; or ``reflection``
            for all that leaves upwards. Without it, all that leaves.

        Returns
        -------
        value, stderr : ndarray, shape (M, C)
            The standard error of a sampled component counts that cells share their paths, see `goniosim.sums`;
            that of ``reflection/direct`` is the integration's. Internal reflection and transmission share their
            paths as well: a path of ``analog`` leaves in one of them only, other estimators have their batches, and
            without those the two errors are added, which is a limit. Where no path arrived
            it is 1.5 / `rays`, since that much may have gone unseen; both are NaN where no ray was traced. Channels
            share their paths, and so their errors; directions are independent of each other.

        Raises
        ------
        goniosim.errors.UnusableResultError
            There is no such component; the message names those that there are.

        Examples
        --------
        >>> value, stderr = result.albedo("reflection/internal")
        >>> value.shape
        (2, 3)
        """
        from goniosim.albedo import albedo

        return albedo(self, component)

    def to_xarray(self) -> DataTree:
        """Turn the result into labelled arrays: what ``xarray.open_datatree`` makes of its file, but for checksums.

        Returns
        -------
        xarray.DataTree
            Sharing its arrays with the result.

        Raises
        ------
        ImportError
            xarray is not installed: ``pip install goniosim[xarray]``.

        Examples
        --------
        >>> tree = result.to_xarray()
        >>> tree["reflection/internal/bsdf"].dims
        ('direction', 'channel', 'row', 'column')
        """
        from goniosim.store import to_datatree

        return to_datatree(self)

    def plot(self, theta_deg: float | None = None) -> Figure:
        """Draw the result; notebooks show the figure.

        Parameters
        ----------
        theta_deg : float, optional
            An incident direction, to see each component of it. Without it, an overview of all directions.

        Returns
        -------
        matplotlib.figure.Figure
            Drawn off screen, without pyplot: ``savefig`` writes it.

        Raises
        ------
        goniosim.errors.UnusableResultError
            The direction was not simulated; the message names those that were.

        Examples
        --------
        >>> figure = result.plot(theta_deg=60)
        """
        from goniosim.report.simulation.figures import figure

        return figure(self, theta_deg)
