"""Refractive indices: equal, less than 1, very dense, at the critical angle, and those of conductors."""

import math
from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...result import Result
from ...scene import Scene
from ..check import Check, absolute, in_sigmas, relative
from ..energy import as_added, as_scattered, closes, directly, leaving, sane, with_rare
from ..oracles import adding, digits, fresnel, rough
from ..variants import labelled, varied

ALPHAS = (0.01, 0.1, 0.5, 1.0)
# Degrees from the critical angle.
AWAY = (1e-12, 1e-9, 1e-6, 1e-3)
# Real parts and extinctions of conductors, each real part with all three.
REAL = (0.05, 1.0, 1.5, 10.0, 1000.0)
EXTINCTIONS = ((1e6, 0.0, 1e-12), (0.05, 1.0, 100.0))


def matched_index(scene: Scene) -> Iterator[Check]:
    """A rough interface between equal indices neither reflects, nor bends, nor loses anything, to the last bit."""
    result = simulate(scene)
    rho = np.array(scene.material.interfaces[-1].rho_rgb)
    yield absolute("reflected by the base", result.audit.energy["reflected_internal"], rho, 1e-15)
    yield absolute("reflected by the interface", result.audit.direct_integrated, 0.0, 0.0)
    top = {"interface": {"type": "dielectric", "eta": 1.0, "alpha": 0.5}}
    alone = simulate(varied(scene, {"material.layers": [top]}))
    yield absolute("alone: transmitted", alone.audit.energy["transmitted"], 1.0, 0.0)
    lit = np.count_nonzero(alone.components["transmission"].energy[:, 0], axis=(1, 2))
    yield absolute("alone: cells that see the light", lit, 1, 0.0)
    yield closes(result)


def nearly_matched_index(scene: Scene) -> Iterator[Check]:
    """An index 1e-9 above or below 1 reflects as Fresnel says; a rough one masks like any, but bends nothing."""
    thetas = scene.incident.theta_deg
    cosines = np.array([rough.cosine_of(theta) for theta in thetas])
    for eta in (1.0 + 1e-9, 1.0 - 1e-9):
        name = "1 + 1e-9" if eta > 1.0 else "1 - 1e-9"
        smooth = _of_index(scene, eta)
        exact, _ = fresnel.dielectric(cosines, eta)
        yield relative(f"{name}, smooth: reflected directly", directly([simulate(smooth)])[0], exact, 1e-10)
        wide = varied(smooth, {"material.layers.0.interface.alpha": 0.3})
        result, shares = simulate(wide), [[rough.shares(theta, 0.3, eta) for theta in thetas]]
        reflected = [each.reflected for each in shares[0]]
        yield relative(f"{name}, alpha 0.3: reflected directly", directly([result])[0], reflected, 1e-5)
        yield from labelled(f"{name}, alpha 0.3", as_scattered([result], shares))


def rarer_below(scene: Scene) -> Iterator[Check]:
    """Indices of 0.8, 0.5 and 0.1 below air reflect all light beyond the critical angle, rough ones facet by facet."""
    thetas = scene.incident.theta_deg
    for eta in (0.8, 0.5, 0.1):
        smooth = simulate(varied(_of_index(scene, eta), {"material.layers.0.interface.alpha": 0.0}))
        exact, _ = fresnel.dielectric(np.array([rough.cosine_of(theta) for theta in thetas]), eta)
        yield absolute(f"{eta}, smooth: reflected directly", directly([smooth])[0], exact, 1e-13)
        beyond = exact == 1.0
        yield absolute(f"{eta}, smooth: transmitted beyond", smooth.audit.energy["transmitted"][beyond], 0.0, 0.0)
        results, shares = _scattered(scene, eta, thetas)
        # Total reflection begins as a root on an arc through the cells; sums over azimuths of facets feel it most.
        reflected = np.array([[each.reflected for each in row] for row in shares])
        yield relative(f"{eta}: reflected directly, by cells", directly(results), reflected, 1e-5)
        yield from labelled(f"{eta}", as_scattered(results, shares))


def dense_coats(scene: Scene) -> Iterator[Check]:
    """Smooth coats of index 2.4, 4 and 10 over a Lambertian base agree with exact adding."""
    for eta in (2.4, 4.0, 10.0):
        coat = _of_index(scene, eta)
        yield from labelled(f"{eta:g}", as_added(simulate(coat), adding.energies(coat)))


def dense_rough_interfaces(scene: Scene) -> Iterator[Check]:
    """Rough interfaces to an index of 2.4, 4 and 10 agree with sums over their slopes."""
    thetas = scene.incident.theta_deg
    for eta in (2.4, 4.0, 10.0):
        results, shares = _scattered(scene, eta, thetas)
        reflected = np.array([[each.reflected for each in row] for row in shares])
        yield relative(f"{eta:g}: reflected directly, by cells", directly(results), reflected, 1e-7)
        yield from labelled(f"{eta:g}", as_scattered(results, shares))


def critical_angle(scene: Scene) -> Iterator[Check]:
    """1e-12 to 0.001 degrees before the critical angle what goes through agrees with 40 digits, and is 0 beyond."""
    for eta in (0.8, 0.5):
        critical = math.degrees(math.asin(eta))
        thetas = [critical + side * away for side in (-1, 1) for away in AWAY]
        result = simulate(varied(_of_index(scene, eta), {"incident.theta_deg": thetas}))
        before, beyond = slice(0, len(AWAY)), slice(len(AWAY), None)
        exact = np.array([digits.transmitted(theta, eta) for theta in thetas[before]])
        through = 1.0 - directly([result])[0]
        for away, got, wanted in zip(AWAY, through, exact, strict=False):
            # Sine and cosine are good to 1e-16; the square of what goes through is in proportion to their distance
            # from the critical ones. 1 - R is good to 1e-16 too.
            distance = math.radians(away) * math.cos(math.radians(critical)) * eta
            yield relative(f"{eta}: {away:g} degrees before", got, wanted, 1e-16 / distance + 1e-15 / wanted)
        yield absolute(f"{eta}: beyond", through[beyond], 0.0, 0.0)
        energy, stderr = result.audit.energy["transmitted"][:, 0], result.audit.stderr["transmitted"][:, 0]
        error = with_rare(stderr[before], scene.simulation.rays)
        yield in_sigmas(f"{eta}: before, sampled", energy[before], error, exact)
        yield absolute(f"{eta}: beyond, sampled", energy[beyond], 0.0, 0.0)


def guided_modes(scene: Scene) -> Iterator[Check]:
    """Light caught between two smooth interfaces over a Lambertian base agrees with adding, by every estimator."""
    exact = adding.energies(scene)
    for estimator in ("analog", "split"):
        result = simulate(varied(scene, {"simulation.estimator": estimator}))
        value, stderr = result.albedo("reflection/internal")
        yield in_sigmas(f"{estimator}: reflected internal", value, stderr, exact.internal)
    energy = result.audit.energy
    white = (energy["reflected_direct"] + energy["reflected_internal"])[:, 0]
    yield absolute("without absorption all comes back", white, 1.0, 1e-12)
    yield closes(result)
    yield sane(result)


def guided_by_a_rough_interface(scene: Scene) -> Iterator[Check]:
    """Light that a rough interface throws between two smooth ones leaves in the end, whether paths split or not."""
    analog, split = (simulate(varied(scene, {"simulation.estimator": name})) for name in ("analog", "split"))
    entries = ("reflected_direct", "reflected_internal", "transmitted")
    losses = ("lost_masked_reflection", "lost_masked_transmission")
    ends = sum(analog.audit.energy[entry] for entry in (*entries, *losses))
    # Paths that masking has left little weight are played roulette with.
    roulette, error = analog.audit.energy["lost_roulette"], analog.audit.stderr["lost_roulette"]
    yield absolute("left, lost by masking, or lost and won by roulette", ends + roulette, 1.0, 1e-12)
    yield in_sigmas("balance of roulette", roulette, error, 0.0)
    for component in ("reflection/internal", "transmission"):
        (got, stderr), (wanted, noise) = split.albedo(component), analog.albedo(component)
        yield in_sigmas(f"{component}: split less analog", got - wanted, np.hypot(stderr, noise), 0.0)
    flat = varied(scene, {"material.layers.1.interface.alpha": 1e-6})
    smooth = varied(scene, {"material.layers.1.interface.alpha": 0.0})
    yield from labelled("alpha 1e-6, as if smooth", leaving(simulate(flat), adding.energies(smooth), rare=True))


def conductors_at_the_edges(scene: Scene) -> Iterator[Check]:
    """Conductors of extinction 0 to 1e6 and real part 0.05 to 1000 reflect and absorb what they should, to 1e-11."""
    cosines = np.array([rough.cosine_of(theta) for theta in scene.incident.theta_deg])
    for kappas in EXTINCTIONS:
        for eta in REAL:
            changes = {"material.layers.0.interface.eta": eta, "material.layers.0.interface.kappa": list(kappas)}
            result = simulate(varied(scene, changes))
            exact = np.array([fresnel.conductor(cosines, complex(eta, kappa)) for kappa in kappas])
            label = f"{eta:g} + ({', '.join(f'{kappa:g}' for kappa in kappas)})i"
            # Angles in radians are good to 1e-16, cosines of 1.7e-5 to 1e-11 of themselves.
            yield absolute(f"{label}: reflected", result.audit.direct_integrated, exact[:, 0].T, 1e-12)
            yield relative(f"{label}: absorbed", result.audit.energy["absorbed_base"], exact[:, 1].T, 1e-11)


def rough_conductors_at_the_edges(scene: Scene) -> Iterator[Check]:
    """Rough conductors of these indices absorb what sums over their slopes say."""
    for kappas in EXTINCTIONS:
        for eta in REAL:
            changes = {"material.layers.0.interface.eta": eta, "material.layers.0.interface.kappa": list(kappas)}
            result = simulate(varied(scene, changes))
            shares = [[rough.shares(t, 0.3, complex(eta, kappa)) for kappa in kappas] for t in result.theta_deg]
            absorbed = np.array([[each.absorbed for each in row] for row in shares])
            reflected = np.array([[each.reflected for each in row] for row in shares])
            label = f"{eta:g} + ({', '.join(f'{kappa:g}' for kappa in kappas)})i"
            # Without extinction total reflection begins on an arc through the cells, as in a dielectric.
            yield relative(f"{label}: reflected directly", result.audit.direct_integrated, reflected, 1e-4)
            energy, stderr = result.audit.energy["absorbed_base"], result.audit.stderr["absorbed_base"]
            yield in_sigmas(f"{label}: absorbed, sampled", energy, stderr, absorbed)


def _of_index(scene: Scene, eta: float) -> Scene:
    return varied(scene, {"material.layers.0.interface.eta": eta})


def _scattered(scene: Scene, eta: float, thetas: tuple[float, ...]) -> tuple[list[Result], list[list[rough.Shares]]]:
    """Results and exact shares of one interface, for each of a few alphas."""
    changes = [{"material.layers.0.interface.alpha": alpha} for alpha in ALPHAS]
    results = [simulate(varied(_of_index(scene, eta), change)) for change in changes]
    return results, [[rough.shares(theta, alpha, eta) for theta in thetas] for alpha in ALPHAS]


CASES = (
    matched_index,
    nearly_matched_index,
    rarer_below,
    dense_coats,
    dense_rough_interfaces,
    critical_angle,
    guided_modes,
    guided_by_a_rough_interface,
    conductors_at_the_edges,
    rough_conductors_at_the_edges,
)
