"""From smooth to rough: interfaces of every alpha, and where it meets another small number."""

from collections.abc import Iterator, Sequence

import numpy as np

from ...engine import simulate
from ...scene import Scene
from ..check import Check, absolute, in_sigmas, relative, statement
from ..energy import as_scattered, closes, directly, sane, with_rare
from ..oracles import adding, fresnel, rough
from ..variants import varied

ALPHAS = (1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 1.0)
NARROW = (1e-6, 1e-4, 1e-3)
# The direct reflection is integrated to 1e-10 of a cell where cosines have their digits.
INTEGRATED = 1e-9
# Next to grazing, half vectors of narrow lobes have some digits less.
GRAZING = 1e-7


def coat_of_any_alpha(scene: Scene) -> Iterator[Check]:
    """One rough interface of alpha 1e-6 to 1, seen from 0 to 89.999 degrees, agrees with sums over its slopes."""
    thetas = scene.incident.theta_deg
    results = [simulate(_wide(scene, alpha)) for alpha in ALPHAS]
    exact = [[rough.shares(theta, alpha, 1.5) for theta in thetas] for alpha in ALPHAS]
    yield relative("reflected directly, by cells", directly(results), _reflected(exact), GRAZING)
    yield from as_scattered(results, exact)


def base_of_any_alpha(scene: Scene) -> Iterator[Check]:
    """One rough conductor of alpha 1e-6 to 1, seen from 0 to 89.999 degrees, agrees with sums over its slopes."""
    thetas = scene.incident.theta_deg
    results = [simulate(_wide(scene, alpha)) for alpha in ALPHAS]
    (face,) = scene.material.interfaces
    for channel, (eta, kappa) in enumerate(zip(face.eta_rgb, face.kappa_rgb, strict=True)):
        exact = [[rough.shares(theta, alpha, complex(eta, kappa)) for theta in thetas] for alpha in ALPHAS]
        got = [result.audit.direct_integrated[:, channel] for result in results]
        index = f"{eta:g} + {kappa:g}i"
        yield relative(f"{index}: reflected directly, by cells", got, _reflected(exact), GRAZING)
        share = np.array([[each.absorbed for each in row] for row in exact])
        absorbed = np.array([result.audit.energy["absorbed_base"][:, channel] for result in results])
        stderr = np.array([result.audit.stderr["absorbed_base"][:, channel] for result in results])
        yield in_sigmas(f"{index}: absorbed, sampled", absorbed, with_rare(stderr, scene.simulation.rays), share)
    yield closes(results[-1])


def law_of_small_alpha(scene: Scene) -> Iterator[Check]:
    """The reflectance leaves that of a smooth interface as alpha^2 ln(1 / alpha), until it is 4e-8 away from it.

    So the deviation over alpha^2 grows by the same amount from decade to decade; the next term is alpha smaller.
    """
    alphas = (1e-2, 1e-3, 1e-4)
    cosines = np.array([rough.cosine_of(theta) for theta in scene.incident.theta_deg])
    smooth, _ = fresnel.dielectric(cosines, 1.5)
    yield absolute("alpha 0 reflects as Fresnel says", directly([simulate(_wide(scene, 0.0))])[0], smooth, 1e-15)
    away = directly([simulate(_wide(scene, alpha)) for alpha in alphas]) - smooth
    yield absolute("alpha 1e-4: reflected, as if smooth", smooth + away[-1], smooth, 1e-6)
    exact = [[rough.shares(theta, alpha, 1.5) for theta in scene.incident.theta_deg] for alpha in alphas]
    # 1e-10 of the reflectance is 1e-3 of the smallest of these.
    yield relative("deviation from smooth", away, _reflected(exact) - smooth, 1e-2)
    growth = np.diff(away / np.square(alphas)[:, None], axis=0)
    yield relative("growth of deviation / alpha^2, from decade to decade", growth[1], growth[0], 0.02)


def alpha_meets_grazing(scene: Scene) -> Iterator[Check]:
    """Where alpha meets cos(theta), their ratio decides, from a mirror at a tenth to full masking at 30."""
    thetas = scene.incident.theta_deg
    cosines = [rough.cosine_of(theta) for theta in thetas]
    ratios = (0.06, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
    alphas = [[float(ratio * cosine) for cosine in cosines] for ratio in ratios]
    results = [[simulate(_at(scene, theta, a)) for theta, a in zip(thetas, row, strict=True)] for row in alphas]
    exact = [[rough.shares(theta, a, 1.5) for theta, a in zip(thetas, row, strict=True)] for row in alphas]
    got = np.array([[result.audit.direct_integrated[0, 0] for result in row] for row in results])
    yield relative("reflected directly, by cells", got, _reflected(exact), GRAZING)
    # What depends on cos(theta) beside the ratio falls as cos(theta) ln(cos(theta)), for ratios up to 1.
    apart = -np.diff(got[:4], axis=1)
    fall = apart[:, 0] / apart[:, 1]
    yield statement("less is left to cos(theta), the smaller it is", fall.min() > 5.0, "5 to 10", f"{fall.min():.3g}")
    yield from as_scattered(sum(results, []), [[each] for row in exact for each in row])


def alpha_meets_the_critical_angle(scene: Scene) -> Iterator[Check]:
    """At the critical angle of an index of 0.8 what goes through falls as the root of alpha, to 1 % at 1e-6."""
    (theta,) = scene.incident.theta_deg
    alphas = (1e-6, 1e-5, 1e-4, 1e-3)
    results = [simulate(_wide(scene, alpha)) for alpha in alphas]
    exact = [[rough.shares(theta, alpha, 0.8)] for alpha in alphas]
    through = 1.0 - directly(results)[:, 0]
    # The root with which total reflection begins runs through cells.
    yield relative("reflected directly, by cells", directly(results), _reflected(exact), 1e-6)
    # The next term is five times the root of alpha smaller.
    yield relative("growth of what goes through, from decade to decade", through[1:3] / through[:2], 10.0**0.5, 0.05)
    yield from as_scattered(results, exact)


def narrow_coat_over_a_base(scene: Scene) -> Iterator[Check]:
    """A coat of alpha 1e-6 to 1e-3 over a Lambertian base lets out what a smooth one does, by every estimator."""
    yield from _as_if_smooth(scene, 0, ("analog", "split", "connection"))


def coat_over_a_narrow_base(scene: Scene) -> Iterator[Check]:
    """A smooth coat over a conductor of alpha 1e-6 to 1e-3 reflects as over a smooth one, by every estimator."""
    yield from _as_if_smooth(scene, 2, ("analog", "split"))


def narrow_lobes_in_half_cells(scene: Scene) -> Iterator[Check]:
    """Lobes of alpha 1e-3 and 1e-4 have GGX's tail in half cells: t^2 / (alpha^2 + t^2) within tan(theta_h) < t."""
    for alpha in (1e-3, 1e-4):
        yield from _lobe(_wide(scene, alpha), ("analog", "split"))


def cells_of_a_ninetieth_degree(scene: Scene) -> Iterator[Check]:
    """A lobe of alpha 1e-6 is resolved by rows of 1/90 degree, each with its exact share, by every estimator."""
    yield from _lobe(scene, ("analog", "split"))


def narrow_reflection_in_cells(scene: Scene) -> Iterator[Check]:
    """The direct reflection of alpha 1e-6, summed over cells, is Fresnel's within the error that it states."""
    cosines = np.array([rough.cosine_of(theta) for theta in scene.incident.theta_deg])
    smooth, _ = fresnel.dielectric(cosines, 1.5)
    for name in ("classic", "half"):
        result = simulate(varied(scene, {"slice.parametrization": name}))
        got = result.components["reflection/direct"].energy[:, 0].sum(axis=(1, 2))
        yield relative(f"{name}: sum over the cells", got, smooth, INTEGRATED)
        claimed = result.audit.direct_integrated_stderr[:, 0] + 1e-15
        yield in_sigmas(f"{name}: by the error that it states", got, claimed, smooth)
        yield sane(result)


def _lobe(scene: Scene, estimators: Sequence[str]) -> Iterator[Check]:
    """Check rows of a half slice at normal incidence, where D cos(theta_h) has a closed form."""
    alpha = scene.material.interfaces[0].alpha
    edges = np.radians(np.linspace(0.0, 90.0, scene.slice.rows + 1)) ** 2 / (0.5 * np.pi)
    # Far out, reflectance and masking change; both as theta_h^4 and alpha^2 theta_h^2 or less.
    near = np.searchsorted(edges, 0.01)
    edges = edges[: near + 1]
    shares = np.diff(_within(np.tan(edges), alpha))
    for estimator in estimators:
        result = simulate(varied(scene, {"simulation.estimator": estimator}))
        if estimator == estimators[0]:
            direct = result.components["reflection/direct"].energy[0, 0, :near].sum(axis=1)
            lit = shares > 1e-4
            yield relative(f"alpha {alpha:g}: reflected into rows", direct[lit], 0.04 * shares[lit], 1e-6)
        # A facet tilted by theta_m turns light by theta_d = 2 theta_h, with sin(theta_m) = 1.5 sin(theta_m - theta_d).
        tilts = 1.5 * np.sin(2.0 * edges) / (1.5 * np.cos(2.0 * edges) - 1.0)
        through = result.components["transmission"]
        energy, stderr = through.energy[0, 0, :near].sum(axis=1), through.stderr[0, 0, :near, 0]
        expected = 0.96 * np.diff(_within(tilts, alpha))
        some = expected > 1e-3
        label = f"alpha {alpha:g}, {estimator}: transmitted into rows"
        yield in_sigmas(label, energy[some], with_rare(stderr[some], scene.simulation.rays), expected[some])


def _within(tangents: np.ndarray, alpha: float) -> np.ndarray:
    return tangents**2 / (alpha**2 + tangents**2)


def _as_if_smooth(scene: Scene, layer: int, estimators: Sequence[str]) -> Iterator[Check]:
    exact = adding.energies(_wide(scene, 0.0, layer)).internal
    for estimator in estimators:
        results = [simulate(varied(_wide(scene, a, layer), {"simulation.estimator": estimator})) for a in NARROW]
        values, errors = zip(*(result.albedo("reflection/internal") for result in results), strict=True)
        # Roughness adds some alpha^2 ln(1 / alpha): 1e-5 at most.
        rough_as = 10.0 * np.square(NARROW)[:, None, None]
        error = np.hypot(with_rare(np.array(errors), scene.simulation.rays), rough_as)
        yield in_sigmas(f"{estimator}: reflected internal", np.array(values), error, exact)
        yield closes(results[-1])


def _wide(scene: Scene, alpha: float, layer: int = 0) -> Scene:
    return varied(scene, {f"material.layers.{layer}.interface.alpha": alpha})


def _at(scene: Scene, theta: float, alpha: float) -> Scene:
    return varied(_wide(scene, alpha), {"incident.theta_deg": [theta]})


def _reflected(exact: Sequence[Sequence[rough.Shares]]) -> np.ndarray:
    return np.array([[each.reflected for each in row] for row in exact])


CASES = (
    coat_of_any_alpha,
    base_of_any_alpha,
    law_of_small_alpha,
    alpha_meets_grazing,
    alpha_meets_the_critical_angle,
    narrow_coat_over_a_base,
    coat_over_a_narrow_base,
    narrow_lobes_in_half_cells,
    cells_of_a_ninetieth_degree,
    narrow_reflection_in_cells,
)
