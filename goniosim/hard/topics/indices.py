"""Refractive indices: equal, less than 1, very dense, at the critical angle, and those of conductors."""

import math
from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...result import Result
from ...scene import Scene
from ..check import Check, absolute, in_sigmas, relative
from ..energy import as_added, as_scattered, closes, directly, sane, with_rare
from ..oracles import adding, digits, fresnel, rough
from ..variants import labelled, varied

ALPHAS = (0.01, 0.1, 0.5, 1.0)
# Real parts and extinctions, each real part with all three.
REAL = (0.05, 1.0, 1.5, 10.0, 1000.0)
EXTINCTIONS = ((1e6, 0.0, 1e-12), (0.05, 1.0, 100.0))


def matched_index(scene: Scene) -> Iterator[Check]:
    """A rough interface between equal indices neither reflects, nor bends, nor loses anything, to the last bit."""
    result = simulate(scene)
    rho = np.array(scene.material.interfaces[-1].rho_rgb)
    yield absolute("reflected by the base", result.audit.energy["reflected_internal"], rho, 1e-15)
    yield absolute("reflected by the interface", result.audit.direct_integrated, 0.0, 0.0)
    (top, _) = scene.model_dump(mode="json")["material"]["layers"]
    alone = simulate(varied(scene, {"material.layers": [top]}))
    yield absolute("alone: transmitted", alone.audit.energy["transmitted"], 1.0, 0.0)
    lit = np.count_nonzero(alone.components["transmission"].energy[:, 0], axis=(1, 2))
    yield absolute("alone: cells that see the light", lit, 1, 0.0)
    yield closes(result)


def nearly_matched_index(scene: Scene) -> Iterator[Check]:
    """An index 1e-9 above or below 1 reflects what Fresnel's equations say, and a rough one masks and bends nothing."""
    thetas = scene.incident.theta_deg
    cosines = np.array([rough.cosine_of(theta) for theta in thetas])
    for eta in (1.0 + 1e-9, 1.0 - 1e-9):
        name = "1 + 1e-9" if eta > 1.0 else "1 - 1e-9"
        smooth = _of_index(scene, eta)
        exact, _ = fresnel.dielectric(cosines, eta)
        yield relative(f"{name}, smooth: reflected directly", directly([simulate(smooth)])[0], exact, 1e-10)
        wide = varied(smooth, {"material.layers.0.interface.alpha": 0.3})
        result, shares = simulate(wide), [[rough.shares(theta, 0.3, eta) for theta in thetas]]
        # What is reflected totally begins on an arc that cells do not see: a few 1e-6 of the rest.
        reflected = [each.reflected for each in shares[0]]
        limit = 1e-7 if eta > 1.0 else 1e-4
        yield relative(f"{name}, alpha 0.3: reflected directly", directly([result])[0], reflected, limit)
        yield from labelled(f"{name}, alpha 0.3", as_scattered([result], shares))


def rarer_below(scene: Scene) -> Iterator[Check]:
    """Indices of 0.8, 0.5 and 0.1 below air reflect all light beyond the critical angle, and rough ones as facets do."""
    thetas = scene.incident.theta_deg
    for eta in (0.8, 0.5, 0.1):
        smooth = simulate(varied(_of_index(scene, eta), {"material.layers.0.interface.alpha": 0.0}))
        exact, _ = fresnel.dielectric(np.array([rough.cosine_of(theta) for theta in thetas]), eta)
        yield absolute(f"{eta}, smooth: reflected directly", directly([smooth])[0], exact, 1e-14)
        beyond = exact == 1.0
        yield absolute(f"{eta}, smooth: transmitted beyond", smooth.audit.energy["transmitted"][beyond], 0.0, 0.0)
        results, shares = _scattered(scene, eta, thetas)
        # Total reflection begins as a root on an arc through the cells, which the cell integrals feel.
        reflected = np.array([[each.reflected for each in row] for row in shares])
        yield relative(f"{eta}: reflected directly, by cells", directly(results), reflected, 1e-4)
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
    """From 1e-12 to 0.001 degrees beside the critical angle what goes through agrees with 40 digits, and is 0 beyond."""
    for eta in (0.8, 0.5, 0.999):
        critical = math.degrees(math.asin(eta))
        for away in (1e-12, 1e-9, 1e-6, 1e-3):
            thetas = [critical - away, critical + away]
            result = simulate(varied(_of_index(scene, eta), {"incident.theta_deg": thetas}))
            before = digits.transmitted(thetas[0], eta)
            through = 1.0 - directly([result])[0]
            # A cosine is good to 1e-16, and so is the square of what is left; its root halves the relative error.
            spacing = math.radians(away)
            limit = (
                4e-16 / spacing / math.sin(math.radians(critical)) / math.cos(math.radians(critical)) + 1e-15 / before
            )
            yield relative(f"{eta}: {away:g} degrees before", through[0], before, limit)
            yield absolute(f"{eta}: {away:g} degrees beyond", through[1], 0.0, 0.0)
            energy, stderr = result.audit.energy["transmitted"], result.audit.stderr["transmitted"]
            yield in_sigmas(
                f"{eta}: {away:g} degrees before, sampled",
                energy[0, 0],
                with_rare(stderr[0, 0], scene.simulation.rays),
                before,
            )
            yield absolute(f"{eta}: {away:g} degrees beyond, sampled", energy[1], 0.0, 0.0)


def guided_modes(scene: Scene) -> Iterator[Check]:
    """Light caught between two smooth interfaces above a Lambertian base agrees with exact adding, by every estimator."""
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
    """Light that a rough interface throws between two smooth ones leaves in the end, the same by every estimator."""
    results = {
        name: simulate(varied(scene, {"simulation.estimator": name})) for name in ("analog", "split", "operator")
    }
    audit = results["analog"].audit
    entries = ("reflected_direct", "reflected_internal", "transmitted", "lost_masked_reflection")
    ends = sum(audit.energy[entry] for entry in (*entries, "lost_masked_transmission"))
    yield absolute("analog: left, or lost by masking", ends, 1.0, 1e-12)
    for component in ("reflection/internal", "transmission"):
        wanted, noise = results["analog"].albedo(component)
        for name in ("split", "operator"):
            got, stderr = results[name].albedo(component)
            yield in_sigmas(f"{name} less analog: {component}", got - wanted, np.hypot(stderr, noise), 0.0)
    flat = varied(scene, {"material.layers.1.interface.alpha": 1e-6})
    smooth = varied(scene, {"material.layers.1.interface.alpha": 0.0})
    yield from labelled("alpha 1e-6, as if smooth", _by_audit(simulate(flat), smooth))


def conductors_at_the_edges(scene: Scene) -> Iterator[Check]:
    """Conductors of extinction 0 to 1e6 and real part 0.05 to 1000 reflect and absorb what they should, to 1e-11."""
    cosines = np.array([rough.cosine_of(theta) for theta in scene.incident.theta_deg])
    for kappas in EXTINCTIONS:
        for eta in REAL:
            changes = {"material.layers.0.interface.eta": eta, "material.layers.0.interface.kappa": list(kappas)}
            result = simulate(varied(scene, changes))
            exact = np.array([fresnel.conductor(cosines, complex(eta, kappa)) for kappa in kappas])
            label = f"{eta:g} + ({', '.join(f'{kappa:g}' for kappa in kappas)})i"
            yield absolute(f"{label}: reflected", result.audit.direct_integrated, exact[:, 0].T, 1e-14)
            yield relative(f"{label}: absorbed", result.audit.energy["absorbed_base"], exact[:, 1].T, 1e-11)


def rough_conductors_at_the_edges(scene: Scene) -> Iterator[Check]:
    """Rough conductors of these indices absorb what sums over their slopes say."""
    for kappas in EXTINCTIONS:
        for eta in REAL:
            changes = {"material.layers.0.interface.eta": eta, "material.layers.0.interface.kappa": list(kappas)}
            result = simulate(varied(scene, changes))
            shares = [[rough.shares(t, 0.3, complex(eta, kappa)) for kappa in kappas] for t in result.theta_deg]
            absorbed, reflected = (
                np.array([[getattr(each, name) for each in row] for row in shares])
                for name in ("absorbed", "reflected")
            )
            label = f"{eta:g} + ({', '.join(f'{kappa:g}' for kappa in kappas)})i"
            # Without extinction total reflection begins on an arc through the cells, as in a dielectric.
            yield relative(f"{label}: reflected directly", result.audit.direct_integrated, reflected, 1e-4)
            energy, stderr = result.audit.energy["absorbed_base"], result.audit.stderr["absorbed_base"]
            # No ray brings more than the most absorbing facet takes.
            rare = np.hypot(stderr, 4.0 * absorbed * 20.0 / 6.0 / scene.simulation.rays)
            yield in_sigmas(f"{label}: absorbed, sampled", energy, rare, absorbed)


def _of_index(scene: Scene, eta: float) -> Scene:
    return varied(scene, {"material.layers.0.interface.eta": eta})


def _scattered(scene: Scene, eta: float, thetas: tuple[float, ...]) -> tuple[list[Result], list[list[rough.Shares]]]:
    """Results and exact shares of one interface, for each of a few alphas."""
    changes = [{"material.layers.0.interface.alpha": alpha} for alpha in ALPHAS]
    results = [simulate(varied(_of_index(scene, eta), change)) for change in changes]
    return results, [[rough.shares(theta, alpha, eta) for theta in thetas] for alpha in ALPHAS]


def _by_audit(result: Result, smooth: Scene) -> Iterator[Check]:
    exact = adding.energies(smooth)
    for entry, share in {"reflected_internal": exact.internal, "transmitted": exact.transmitted}.items():
        energy, stderr = result.audit.energy[entry], with_rare(result.audit.stderr[entry], float(result.rays.min()))
        yield in_sigmas(entry.replace("_", " "), energy, stderr, share)


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
