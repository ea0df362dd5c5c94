"""The analytic models where their formulas divide by next to nothing, and where the published ones are wrong."""

from collections.abc import Iterator

import numpy as np

from ...compare import compare
from ...engine import simulate
from ...models import COMPONENTS, MODELS, evaluate_model, prepare
from ...scene import Scene
from ..check import Check, absolute, relative, statement, whether
from ..oracles import adding
from ..variants import varied

RECIPROCAL = ("ww09", "elek10", "bati19_ww", "belcour18_symmetric")
# Their energies are exact where all interfaces are smooth.
EXACT_IF_SMOOTH = ("belcour18_forward", "belcour18_symmetric", "bati19_belcour")
# From the normal to the horizon, and close to the mirror directions of whole and half degrees.
VIEWS = np.array([0.0, 1e-9, 1e-3, 0.5, 1.0, 10.0, 30.0, 45.0, 60.0, 80.0, 89.0, 89.9, 89.999, 89.9999999, 90.0])
AZIMUTHS = np.array([0.0, 1e-9, 1e-3, 45.0, 90.0, 135.0, 179.0, 179.999, 180.0, 180.001, 270.0, 359.999999])


def _values(scene: Scene) -> Iterator[tuple[str, str, float, np.ndarray, np.ndarray]]:
    """Values and energies of Dirac lobes of all models that apply, in all directions of light and view."""
    polar, azimuth = np.meshgrid(VIEWS, AZIMUTHS)
    for name, model in MODELS.items():
        for component in COMPONENTS:
            if model.supports(scene, component) is None:
                for theta in scene.incident.theta_deg:
                    values = evaluate_model(name, scene, theta, polar, azimuth, component)
                    yield name, component, theta, values, prepare(name, scene, theta, component).mirror_energy


def _sane(scene: Scene) -> Iterator[Check]:
    wrong: dict[str, list[str]] = {}
    for name, component, theta, values, mirror in _values(scene):
        found = wrong.setdefault(name, [])
        if not (np.isfinite(values).all() and (values >= 0.0).all()):
            found.append(f"{component} at {theta:g}")
        if not (np.isfinite(mirror).all() and (mirror >= 0.0).all()):
            found.append(f"Dirac lobe of {component} at {theta:g}")
    for name, places in wrong.items():
        yield statement(f"{name}: finite and not negative", not places, "everywhere", ", ".join(places) or "everywhere")


def _reciprocal(scene: Scene) -> Iterator[Check]:
    """Light and view exchanged; the symmetric sweep is a table, of 2e-4."""
    angles = np.array([0.0, 1.0, 20.0, 45.0, 70.0, 85.0, 89.9, 89.999])
    azimuths = np.array([0.0, 30.0, 90.0, 170.0, 180.0])
    light, view, azimuth = np.meshgrid(angles, angles, azimuths, indexing="ij")
    for name in RECIPROCAL:
        if MODELS[name].supports(scene, "reflection") is None:
            there = evaluate_model(name, scene, light, view, azimuth)
            back = evaluate_model(name, scene, view, light, azimuth)
            # In units of the largest value of the pair's slice: near zero a difference means nothing.
            scale = np.maximum(np.maximum(there, back), 1e-12)
            yield absolute(f"{name}: light and view exchanged, relative", (there - back) / scale, 0.0, 1e-6)


def models_at_the_horizon(scene: Scene) -> Iterator[Check]:
    """Light at 89.999 degrees, viewers in the horizon: models are finite, not negative, reciprocal where promised."""
    yield from _sane(scene)
    yield from _reciprocal(scene)


def models_of_needles(scene: Scene) -> Iterator[Check]:
    """Lobes of alpha 1e-6 under a coat of alpha 1e-6: models are finite, not negative, reciprocal where promised."""
    yield from _sane(scene)
    yield from _reciprocal(scene)


def models_of_extreme_indices(scene: Scene) -> Iterator[Check]:
    """Coats of 10 and of 0.1 over a mirror of kappa 1e6: models are finite, not negative, reciprocal where promised."""
    yield from _sane(scene)
    yield from _reciprocal(scene)


def models_of_extreme_media(scene: Scene) -> Iterator[Check]:
    """Depths of 0, 700 and 1e9: models are finite, and what an opaque medium hides is not there."""
    yield from _sane(scene)
    for name, component, theta, values, mirror in _values(scene):
        if component == "reflection/internal":
            hidden = max(float(values[1:].max()), float(mirror[1:].max()))
            yield absolute(f"{name}, {theta:g} degrees: through depths of 700 and 1e9", hidden, 0.0, 1e-200)


def models_of_a_smooth_metal(scene: Scene) -> Iterator[Check]:
    """Smooth interfaces alone: Dirac lobes of Belcour's sweep have the exact energies, and no values beside them."""
    exact = adding.energies(scene)
    for m, theta in enumerate(scene.incident.theta_deg):
        for name in EXACT_IF_SMOOTH:
            prepared = prepare(name, scene, theta, "reflection/internal")
            energy = prepared.mirror_energy[prepared.position]
            yield relative(f"{name}, {theta:g} degrees: internal", energy, exact.internal[m], 1e-11)
            prepared = prepare(name, scene, theta, "reflection/direct")
            energy = prepared.mirror_energy[prepared.position]
            yield relative(f"{name}, {theta:g} degrees: direct", energy, exact.direct[m], 1e-11)
            beside = evaluate_model(name, scene, theta, VIEWS, 90.0)
            yield absolute(f"{name}, {theta:g} degrees: values beside the Dirac lobe", beside, 0.0, 0.0)


def models_of_matched_interfaces(scene: Scene) -> Iterator[Check]:
    """A rough interface between equal indices: models have the bits of the stack without it."""
    layers = [layer.model_dump(exclude_none=True) for layer in scene.material.layers]
    without = varied(scene, {"material.layers": [*layers[:2], *layers[3:]]})
    pairs = zip(_values(scene), _values(without), strict=True)
    wrong = [f"{one[0]} {one[1]}" for one, other in pairs if not all(map(np.array_equal, one[3:], other[3:]))]
    yield statement("bits with and without the interface", not wrong, "equal", ", ".join(wrong) or "equal")


def elek10_makes_light(scene: Scene) -> Iterator[Check]:
    """A published formula, kept: without (N_0/N_1)^2 `elek10` sends back twice what arrives, and says so."""
    exact = adding.energies(scene)
    energy = prepare("elek10", scene, 0.0).mirror_energy[0]
    # What enters, is reflected by the base once and leaves; the internal reflectance tells that of the base.
    r, inner = exact.direct[0, 0], exact.internal[0, 0]
    entered = inner * (1.0 - r) ** 2 / ((1.0 - r) ** 2 + r * inner)
    yield relative("elek10, smooth coat of 1.5 on a mirror: share of the light", energy, r + 1.5**2 * entered, 1e-11)
    corrected = prepare("bati19_ww", scene, 0.0).mirror_energy[0]
    yield relative("bati19_ww, which has the factor", corrected, r + entered, 1e-11)
    yield relative("exact", exact.direct[0, 0] + exact.internal[0, 0], 1.0, 1e-9)


def ww09_under_total_reflection(scene: Scene) -> Iterator[Check]:
    """Coats of falling index: directions that cannot leave contribute nothing, and no square root is negative."""
    yield from _sane(scene)
    yield from _reciprocal(scene)


def comparison_of_a_needle(scene: Scene) -> Iterator[Check]:
    """An exact model with a lobe no sub-cell meets: sub-cells are called unconverged, adaptive integration finds it."""
    compared = compare(simulate(scene), models=["ww09"])
    for theta in scene.incident.theta_deg:
        (row,) = compared.rows("reflection", theta_deg=theta)
        where = f"{theta:g} degrees"
        yield whether(f"{where}: sub-cells are called converged", False, row["converged"])
        share = row["rmse_converged"] / row["reference_norm"]
        yield absolute(f"{where}: error by adaptive integration, share of the slice", share, 0.0, 1e-4)


CASES = (
    models_at_the_horizon,
    models_of_needles,
    models_of_extreme_indices,
    models_of_extreme_media,
    models_of_a_smooth_metal,
    models_of_matched_interfaces,
    elek10_makes_light,
    ww09_under_total_reflection,
    comparison_of_a_needle,
)
