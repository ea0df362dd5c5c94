"""Light and view from the normal to the horizon, and cells that reach below it."""

from collections.abc import Iterator, Sequence

import numpy as np

from ...engine import simulate
from ...result import Component
from ...scene import Scene
from ..check import ROUNDING, Check, absolute, chi_square, in_sigmas, relative, statement, t_in_sigmas
from ..energy import as_added, closes, sane, with_rare
from ..oracles import adding, half_cells, plastic, rough
from ..variants import varied

# A cell with fewer paths is not nearly normal.
ENOUGH = 50


def normal_to_grazing(scene: Scene) -> Iterator[Check]:
    """From 0 to 89.999 degrees the light that a coated white base brings back agrees with exact adding."""
    yield from as_added(simulate(scene), adding.energies(scene))


def mirror_from_normal_to_grazing(scene: Scene) -> Iterator[Check]:
    """From 0 to 89.999 degrees the light that a coated mirror brings back agrees with exact adding."""
    # At 89.999 degrees, six rays in 100000 enter, and as few of those leave at each try.
    yield from as_added(simulate(scene), adding.energies(scene), rare=True)


def symmetric_metal(scene: Scene) -> Iterator[Check]:
    """At theta = 0 a rough coat over a rough conductor shines alike in all azimuths, by every estimator."""
    yield from _symmetric(scene, ("analog", "split", "operator"))


def symmetric_plastic(scene: Scene) -> Iterator[Check]:
    """At theta = 0 a rough coat over a Lambertian base shines alike in all azimuths, by every estimator."""
    yield from _symmetric(scene, ("analog", "split", "connection"))


def just_beside_normal(scene: Scene) -> Iterator[Check]:
    """A ten-millionth of a degree beside the normal rough metal shines as at 0."""
    result = simulate(varied(scene, {"simulation.estimator": "analog"}))
    part = result.components["reflection/internal"]
    # Rows, since azimuths turn by any angle where there are none.
    energy, variance = part.energy[:, 0].sum(axis=-1), (part.stderr[:, 0] ** 2).sum(axis=-1)
    for beside, theta in enumerate(scene.incident.theta_deg[1:], 1):
        stderr = with_rare(np.sqrt(variance[0] + variance[beside]), scene.simulation.rays)
        yield in_sigmas(f"{theta:g} degrees less 0: rows", energy[beside] - energy[0], stderr, 0.0)
    direct = result.components["reflection/direct"].energy[:, 0]
    # 1e-4 degrees are 1e-5 of the lobe.
    yield absolute("reflected directly into cells", direct[1:], np.stack([direct[0]] * (len(direct) - 1)), 1e-6)
    yield closes(result)
    yield sane(result)


def rows_at_the_horizon(scene: Scene) -> Iterator[Check]:
    """Rows next to the horizon hold the light that Fresnel's equations let out there, by every estimator."""
    exact = adding.energies(scene).internal
    rows = scene.slice.rows
    edges = np.radians(np.linspace(0.0, 90.0, rows + 1))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    width = np.diff(edges)[:, None]
    theta = edges[:-1, None] + 0.5 * width * (nodes + 1.0)
    # cos(theta) by the complement.
    height = np.sin(0.5 * np.pi - edges[1:, None] + 0.5 * width * (1.0 - nodes))
    shares = np.sum(plastic.exitance(scene)(height) * np.sin(theta) * np.pi * width * weights, axis=-1)
    share = exact[..., None] * shares[None]
    for estimator in ("analog", "split", "connection"):
        part = simulate(varied(scene, {"simulation.estimator": estimator})).components["reflection/internal"]
        energy, stderr = part.energy[..., 0], part.stderr[..., 0]
        if estimator == "connection":
            # Each path brings light to every row.
            yield in_sigmas("connection: each row", energy, stderr, share)
            continue
        in_degrees = (*energy.shape[:2], 90, rows // 90)
        error = with_rare(np.sqrt((stderr**2).reshape(in_degrees).sum(axis=-1)), scene.simulation.rays)
        wanted = share.reshape(in_degrees).sum(axis=-1)
        yield in_sigmas(f"{estimator}: rows of each degree", energy.reshape(in_degrees).sum(axis=-1), error, wanted)


def reflection_at_the_horizon(scene: Scene) -> Iterator[Check]:
    """The direct reflection of alpha 0.3 into the last ten degrees above the horizon agrees with plain quadrature."""
    result = simulate(scene)
    got = result.components["reflection/direct"].energy[:, 0, -10:]
    exact = [_reflection(theta, scene.slice.rows, scene.slice.columns, 10) for theta in scene.incident.theta_deg]
    yield relative("reflected into cells", got, np.array(exact), 1e-9)


def half_cells_cut_by_the_horizon(scene: Scene) -> Iterator[Check]:
    """Solid angles of half cells agree with another quadrature, with cells that the horizon cuts, at six angles."""
    result = simulate(scene)
    cells = result.cells
    shape = (scene.slice.rows, scene.slice.columns)
    exact = np.array(
        [half_cells.integrals(*shape, theta, lambda z: np.array([z**0, z]), 2) for theta in scene.incident.theta_deg]
    )
    solid, projected = exact[:, 0], exact[:, 1]
    cut = ~cells.valid & (projected > 0.0)
    yield statement("cells are cut at every angle", cut.any(axis=(1, 2)).all(), "all", cut.sum(axis=(1, 2)).tolist())
    for name, ours, theirs, total in (
        ("solid angles", cells.solid_angle, solid, 2.0 * np.pi),
        ("projected solid angles", cells.projected_solid_angle, projected, np.pi),
    ):
        yield relative(f"{name} of whole cells", ours[cells.valid], theirs[cells.valid], 1e-12)
        # In steradians, as some of these cells have next to nothing above the horizon.
        yield absolute(f"{name} of cut cells", ours[~cells.valid], theirs[~cells.valid], 1e-12)
        yield absolute(f"{name}: sum", ours.sum(axis=(1, 2)), total, 1e-11)
    white = result.components["reflection/direct"].energy[:, 0]
    yield absolute("light of a white sheet in each cell", white, projected / np.pi, 1e-12)
    yield closes(result)


def light_in_cut_cells(scene: Scene) -> Iterator[Check]:
    """Half cells that the horizon cuts hold the light that leaves above it, by every estimator, and sums close."""
    density = plastic.exitance(scene)
    shape = (scene.slice.rows, scene.slice.columns)
    shares = np.array([half_cells.integrals(*shape, theta, density, 3) for theta in scene.incident.theta_deg])
    exact = shares * adding.energies(scene).internal[..., None, None]
    for estimator in ("analog", "split", "connection"):
        result = simulate(varied(scene, {"simulation.estimator": estimator}))
        part = result.components["reflection/internal"]
        cut = np.broadcast_to(~result.cells.valid[:, None], exact.shape)
        stderr = with_rare(part.stderr, scene.simulation.rays)
        enough = exact * scene.simulation.rays > ENOUGH
        for name, some in {"whole": ~cut & enough, "cut": cut & enough}.items():
            yield in_sigmas(f"{estimator}: light in {name} cells", part.energy[some], stderr[some], exact[some])
        yield absolute(f"{estimator}: BSDF of cut cells", part.bsdf[cut], 0.0, 0.0)
        if estimator == "analog":
            counted = part.energy.sum(axis=(2, 3))
            yield absolute("all cells, and the audit", counted, result.audit.energy["reflected_internal"], 1e-12)


def _symmetric(scene: Scene, estimators: Sequence[str]) -> Iterator[Check]:
    for estimator in estimators:
        part = simulate(varied(scene, {"simulation.estimator": estimator})).components["reflection/internal"]
        if estimator == "analog":
            yield _columns_alike(part)
        else:
            yield _waves(part, estimator)


def _columns_alike(part: Component) -> Check:
    """Independent paths: each cell against the mean of its row."""
    energy, stderr = part.energy[0, 0], part.stderr[0, 0]
    mean = energy.mean(axis=1, keepdims=True)
    # By the mean error of the row: cells that happen to have little light claim little error too.
    deviations = (energy - mean) / np.sqrt((stderr**2).mean(axis=1, keepdims=True))
    rows, columns = energy.shape
    return chi_square("analog: cells and the mean of their row", deviations, rows * (columns - 1))


def _waves(part: Component, estimator: str) -> Check:
    """Cells share their noise: waves around the normal, by the scatter of independent batches."""
    assert part.batches is not None
    # Slices are their own mirror images: cosines are all.
    columns = part.batches.shape[-1]
    phi = (np.arange(columns) + 0.5) * 2.0 * np.pi / columns
    waves = np.cos(np.outer(phi, np.arange(1, 7)))
    found = part.batches[0, :, 0].sum(axis=-2) @ waves
    count = len(found)
    # Where light is spread over whole rings, rounding is all there is.
    rounding = ROUNDING * part.batches[0, :, 0].sum() / count
    t = found.mean(axis=0) / np.hypot(found.std(axis=0, ddof=1) / np.sqrt(count), rounding)
    return t_in_sigmas(f"{estimator}: waves of 1 to 6 periods around the normal", t, count - 1)


def _reflection(theta_deg: float, rows: int, columns: int, last: int) -> np.ndarray:
    """Direct reflection of alpha 0.3 into the last rows of classic cells, shape (last, columns)."""
    x, w = np.polynomial.legendre.leggauss(40)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    d_theta, d_phi = 0.5 * np.pi / rows, 2.0 * np.pi / columns
    # Angles from the horizon, to keep the digits of cosines.
    low = (d_theta * (np.arange(last)[::-1, None] + 1.0 - x)).reshape(last, 1, -1, 1)
    phi = (d_phi * (np.arange(columns)[:, None] + x)).reshape(1, columns, 1, -1)
    low, phi = np.broadcast_arrays(low, phi)
    view = np.stack([np.cos(low) * np.cos(phi), np.cos(low) * np.sin(phi), np.sin(low)], axis=-1)
    light = np.array([np.sin(np.radians(theta_deg)), 0.0, rough.cosine_of(theta_deg)])
    values = rough.reflected_towards(light, view, 0.3, 1.5) * np.cos(low)
    return d_theta * d_phi * np.einsum("rcij,i,j->rc", values, w, w)


CASES = (
    normal_to_grazing,
    mirror_from_normal_to_grazing,
    symmetric_metal,
    symmetric_plastic,
    just_beside_normal,
    rows_at_the_horizon,
    reflection_at_the_horizon,
    half_cells_cut_by_the_horizon,
    light_in_cut_cells,
)
