"""Small results with the look of real ones, for tests that need a result but no simulation."""

import numpy as np

from goniosim.effective import uncertain
from goniosim.result import AUDIT_ENTRIES, INTEGRATED, Audit, Cells, Component, Cost, Result
from goniosim.sums import BATCHES, block_sums, noise_of, sum_and_error

CONFIG = """\
material:
  name: {name}
  layers:
{layers}\
incident: {{theta_deg: {theta_deg}}}
slice: {{parametrization: {parametrization}, rows: {rows}, columns: {columns}}}
simulation: {{{measure}, seed: {seed}{orders}}}
"""
COATED = """\
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: [0.05, 0.1, 0.8]}
    - interface: {type: lambert, rho: 0.5}
"""
BARE = """\
    - interface: {type: conductor, eta: 1.5, kappa: 1.0, alpha: 0.2}
"""


def make_result(
    theta_deg=(0.0, 60.0),
    channels=("red", "green", "blue"),
    rows=6,
    columns=8,
    *,
    parametrization="classic",
    components=("reflection/direct", "reflection/internal", "transmission"),
    orders=0,
    rays=100_000,
    status="complete",
    name="synthetic",
    config_yaml=None,
    seed=1,
    estimator="analog",
    target=None,
    target_reached=None,
):
    """Make up a result: hits are Poisson counts, energies carry continuous weights as absorption gives.

    Parameters
    ----------
    theta_deg : sequence of float
        Incident directions.
    channels : sequence of str
    rows, columns : int
    parametrization : str
        For ``half`` the last row is invalid; the solid angles stay those of ``classic``.
    components : sequence of str
    orders : int
        Last order told apart in the components that are sampled; 0 for none.
    rays : int
        Rays per incident direction.
    status, name : str
    config_yaml : str, optional
        A scene to which all this belongs by default.
    seed : int
        Of the made-up numbers, and the seed that the result claims.
    estimator : str or dict of str to str
        Of the sampled components, or of each of them; others than ``analog`` keep batches and have nodes.
    target : str, optional
        What stands in the scene under ``target`` instead of the rays.
    target_reached : bool, optional

    Returns
    -------
    Result
    """
    rng = np.random.default_rng(seed)
    cells = _cells(parametrization, len(theta_deg), rows, columns)
    made = {}
    for path in components:
        own = estimator if isinstance(estimator, str) else estimator.get(path, "analog")
        made[path] = _component(path, rng, cells, len(channels), rays, orders, own)
    totals = {path: component.energy.sum(axis=(2, 3)) for path, component in made.items()}
    scene = CONFIG.format(
        name=name,
        layers=COATED if "reflection/internal" in components else BARE,
        theta_deg=[float(theta) for theta in theta_deg],
        parametrization=parametrization,
        rows=rows,
        columns=columns,
        measure=f"target: {target}" if target else f"rays: {rays}",
        seed=seed,
        orders=f", orders: {orders}" if orders else "",
    )
    return Result(
        config_yaml=scene if config_yaml is None else config_yaml,
        config_hash="5" * 64,
        name=name,
        status=status,
        seed=seed,
        theta_deg=np.array(theta_deg, float),
        phi_deg=np.zeros(len(theta_deg)),
        rays=np.full(len(theta_deg), rays),
        channels=list(channels),
        cells=cells,
        components=made,
        audit=_audit(rng, totals, (len(theta_deg), len(channels)), rays),
        cost=_cost(components, len(theta_deg), rays),
        effects={"absorption": True, "colour": True, "orders": orders > 0, "transmission": False},
        provenance={
            "created_utc": "2024-05-01T12:00:00Z",
            "goniosim_version": "0.1.0",
            "processor": "imaginary",
            "threads": "2",
        },
        target_reached=target_reached,
    )


def make_summary(name="M1-a", alpha0=0.2, category="metals"):
    """Make up the errors of three models: the first are far below the noise and significant, the last is not."""
    # Only here: the slow reference tracer and others do without the models.
    from goniosim.compare.rows import COLUMNS
    from goniosim.compare.summary import Summary
    from goniosim.compare.variants import Variant

    variants = [Variant("ww09"), Variant("belcour18_forward", (("jacobian", "snell"),)), Variant("elek10")]
    rows = []
    for number, variant in enumerate(variants):
        row = dict.fromkeys(COLUMNS) | {"model": variant.model, "options": variant.options_text, "material": name}
        row |= {"component": "reflection/internal", "channel": "mean", "theta_deg": "all", "rays": 1e6}
        error = 0.001 * (number + 1)
        row |= {"rmse": error, "rmse_stderr": 0.0003, "rmse_upper": 2 * error, "below_noise": int(number == 2)}
        row |= {"rmse_converged": error * (1 + number), "converged": int(number != 1), "noise_floor": 0.02}
        row |= {"rmse_relative": 10 * error, "reference_norm": 0.1, "model_seconds": 0.01, "integration": "adaptive"}
        row |= {"albedo_error": 0.1, "albedo_reference_stderr": 0.01, "simulation_seconds": 1.0}
        rows.append(row)
    times = np.array([0.01, 0.02]), np.array([0.04, 0.02])
    return Summary(name, category, alpha0, 0.2, "reflection/internal", variants, rows, *times, {})


def _cells(parametrization, directions, rows, columns):
    edges = np.linspace(0, np.pi / 2, rows + 1)
    shape = (directions, rows, columns)
    width = 2 * np.pi / columns
    valid = np.ones(shape, bool)
    if parametrization == "half":
        valid[:, -1] = False
    return Cells(
        parametrization=parametrization,
        row_edges=np.degrees(edges),
        column_edges=np.linspace(0, 360, columns + 1),
        valid=valid,
        solid_angle=np.broadcast_to(-np.diff(np.cos(edges))[:, None] * width, shape).copy(),
        projected_solid_angle=np.broadcast_to(np.diff(np.sin(edges) ** 2)[:, None] * width / 2, shape).copy(),
    )


def _component(path, rng, cells, channels, rays, orders, estimator):
    # Each component gets about a quarter of the rays, spread as a Lambertian spreads them.
    expected = rays / 4 * cells.projected_solid_angle / np.pi
    hits = rng.poisson(expected)
    shape = (len(hits), channels, *hits.shape[1:])
    weight = rng.uniform(0.2, 0.8, (1, channels, 1, 1))
    scatter = rng.normal(0, 0.3, shape) / np.sqrt(np.maximum(hits, 1))[:, None]
    energy = hits[:, None] / rays * weight * np.exp(scatter)
    stderr = np.sqrt(hits)[:, None] / rays * weight * np.exp(rng.normal(0, 0.01, shape))

    sampled = path != "reflection/direct"
    parts = {}
    if sampled and orders:
        lowest = 1 if path == "transmission" else 2
        names = [*(f"order_{number}" for number in range(lowest, orders + 1)), f"order_{orders + 1}_and_more"]
        parts = {name: _component(path, rng, cells, channels, rays, 0, estimator) for name in names}
    to_bsdf = np.where(cells.valid, 1 / cells.projected_solid_angle, 0.0)[:, None]
    made = Component(
        energy=energy,
        stderr=stderr,
        bsdf=energy * to_bsdf,
        bsdf_stderr=stderr * to_bsdf,
        hits=hits.astype(np.int64) if sampled and estimator == "analog" else None,
        contains_delta=path == "transmission",
        orders=parts,
        estimator=[estimator if sampled else INTEGRATED] * len(hits),
    )
    if sampled:
        made.paths = np.full(len(hits), rays)
    if sampled and estimator != "analog":
        made.node_bias, made.replicates = np.full(len(hits), 1e-6), np.full(len(hits), BATCHES)
        made.batches = _batches(energy)
    fill(made, rays)
    return made


def fill(component, rays):
    """Set what follows from energies, errors, hits and batches: albedo, its error, and which cells are uncertain."""
    component.albedo = component.energy.sum(axis=(2, 3))
    component.albedo_stderr = np.full(component.albedo.shape, 1e-9)
    if component.sampled:
        component.uncertain = uncertain(component.energy, component.stderr, rays)
        for m, (energy, stderr) in enumerate(zip(component.energy, component.stderr, strict=True)):
            component.albedo_stderr[m] = sum_and_error(energy, stderr, noise_of(component, m, rays))[1]


def _batches(energy):
    """Batches of replicates that scatter by a tenth, up and down in turn."""
    sign = np.where(np.arange(BATCHES) % 2, 0.1, -0.1)
    return (1.0 + sign)[None, :, None, None, None] * block_sums(energy)[:, None]


def _audit(rng, totals, shape, rays):
    names = {
        "reflected_direct": "reflection/direct",
        "reflected_internal": "reflection/internal",
        "transmitted": "transmission",
    }
    energy = {entry: totals.get(names.get(entry), np.zeros(shape)) for entry in AUDIT_ENTRIES}
    # As sampled: nearly what the integration says.
    energy["reflected_direct"] = energy["reflected_direct"] / 1.0001
    energy["lost_masked_reflection"] = rng.uniform(0, 0.01, shape)
    energy["absorbed_base"] = 1 - sum(energy.values())
    stderr = {entry: np.sqrt(np.abs(value) / rays) for entry, value in energy.items()}
    return Audit(
        energy, stderr, totals.get("reflection/direct", np.zeros(shape)), np.full(shape, 1e-9), np.full(shape[0], rays)
    )


def _cost(components, directions, rays):
    traced = np.tile(rays * np.array([0.25, 0.5, 1.0]), (directions, 1))
    sampled = [path for path in components if path != "reflection/direct"]
    return Cost(
        rays=traced,
        seconds=traced / 1e7,
        cpu_seconds=traced / 5e6,
        error={path: 3 / np.sqrt(traced) for path in sampled},
    )


MODELS = {
    "ww09": {"model": "ww09", "options": ""},
    "belcour18_forward[jacobian=snell]": {"model": "belcour18_forward", "options": "jacobian=snell"},
}


def write_models(path, materials=("synthetic",), **options):
    """Write a file of integrated models whose slices are those of made-up results.

    Parameters
    ----------
    path : path-like
    materials : sequence of str
    **options
        Of `make_result`.

    Returns
    -------
    dict of (str, str) to Result
        By material and model: the result whose components were written.
    """
    from goniosim.store import ModelsWriter

    made = {}
    writer = ModelsWriter(path, {"created_utc": "2024-05-01T12:00:00Z", "goniosim_version": "0.1.0", "subcells": "5"})
    try:
        for number, name in enumerate(materials):
            reference = make_result(name=name, **options)
            main = next(each for each in ("transmission", "reflection/internal") if each in reference.components)
            writer.add_material(reference, main)
            for offset, (label, attributes) in enumerate(MODELS.items(), 1):
                made[name, label] = make_result(name=name, seed=10 * number + 1 + offset, **options)
                writer.add_model(reference, label, attributes, made[name, label].components)
        writer.commit()
    finally:
        writer.discard()
    return made
