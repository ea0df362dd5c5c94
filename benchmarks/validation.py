"""Print the tables of docs/validation.md: how well the engine agrees with its oracles.

Usage: python benchmarks/validation.py [--quick]
"""

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from goniosim.engine import simulate  # noqa: E402
from goniosim.optics import fresnel  # noqa: E402
from reference import checks, closed_forms, exact_fresnel  # noqa: E402
from reference.cell_integrals import integrate_cells  # noqa: E402
from reference.scenes import conductor, dielectric, lambert, make_scene, medium  # noqa: E402

THETAS = [0, 30, 60, 85, 89]
ALPHAS = [0.001, 0.05, 0.2, 1.0]
SLICES = ["classic", "half"]


def table(title, head, rows):
    """Print a table in Markdown."""
    print(f"\n### {title}\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for row in rows:
        print(f"| {' | '.join(str(cell) for cell in row)} |", flush=True)


def fresnel_rows():
    """Largest errors against decimal arithmetic, of goniosim and of the textbook formula in doubles."""
    near_one = [1.0 + sign * 10.0**-e for e in range(1, 13) for sign in (1.0, -1.0)]
    thetas = np.append(np.arange(90.0), 90.0 - 10.0 ** -np.arange(1.0, 7.0))
    cosines = np.cos(np.radians(thetas)).tolist()

    def worst(rows, relative):
        errors = [[abs(float((v - float(exact)) / (float(exact) if relative else 1.0))) for v in values]
                  for exact, *values in rows]  # fmt: skip
        return [f"{error:.0e}" for error in np.max(errors, axis=0)]

    etas = [*near_one, 0.1, 0.2, 0.5, 1.0 / 1.5, 1.33, 1.5, 4.0, 10.0]
    reflected, through = [], []
    for eta in etas:
        for c in cosines:
            exact, rest, _ = exact_fresnel.dielectric(c, eta)
            textbook = float(closed_forms.fresnel_dielectric(c, eta))
            reflected.append((exact, fresnel.fresnel_dielectric(c, eta)[0], textbook))
            if rest > 0:
                through.append((rest, fresnel.dielectric_transmittance(c, eta), 1.0 - textbook))
    yield "dielectric R", "0.1 to 10, 1 ± 1e-12", "absolute", *worst(reflected, False)
    yield "dielectric 1 - R", "0.1 to 10, 1 ± 1e-12", "relative", *worst(through, True)
    reflected, absorbed = [], []
    for eta in (*near_one, 0.05, 1.45, 3.0):
        for kappa in 10.0 ** np.arange(-9.0, 7.0):
            for c in np.logspace(-6.0, 0.0, 13):
                exact, rest = exact_fresnel.conductor(c, eta, kappa)
                textbook = float(closed_forms.fresnel_conductor(c, complex(eta, kappa)))
                reflected.append((exact, fresnel.fresnel_conductor(c, eta, kappa), textbook))
                absorbed.append((rest, fresnel.conductor_absorptance(c, eta, kappa), 1.0 - textbook))
    yield "conductor R", "eta 0.05 to 3, 1 ± 1e-12; kappa 1e-9 to 1e6", "relative", *worst(reflected, True)
    yield "conductor 1 - R", "eta 0.05 to 3, 1 ± 1e-12; kappa 1e-9 to 1e6", "relative", *worst(absorbed, True)


def closed_form_rows(rays, seeds):
    """Energies of smooth stacks: mean over the seeds, with deviations in units of their own error."""
    stacks = {
        "plastic, rho 0.5, tau 0.5": (
            [dielectric(1.5), medium(0.5), lambert(0.5)],
            lambda c: {"reflected_internal": closed_forms.plastic_albedo(c, 1.5, 0.5, 0.5)},
        ),
        "metal, 1.45 + 1i, tau 0.2": (
            [dielectric(1.5), medium(0.2), conductor(1.45, 1.0)],
            lambda c: {"reflected_internal": closed_forms.smooth_metal(c, 1.5, 1.45, 1.0, 0.2)[1]},
        ),
        "slab, tau 0.5": (
            [dielectric(1.5), medium(0.5), dielectric(1.0)],
            lambda c: dict(
                zip(
                    ("reflected_direct", "reflected_internal", "transmitted"),
                    closed_forms.smooth_slab(c, 1.5, 0.5),
                    strict=True,
                )
            ),
        ),
        "white furnace": (
            [dielectric(1.5), lambert(1.0)],
            lambda c: {"reflected_internal": 1.0 - float(closed_forms.fresnel_dielectric(c, 1.5))},
        ),
    }
    for name, (layers, exact) in stacks.items():
        scene = make_scene(layers, [0, 60, 85], rows=1, columns=1)
        audits = [simulate(scene, rays=rays, seed=seed, estimator="analog").audit.energy for seed in range(seeds)]
        for m, theta in enumerate((0, 60, 85)):
            for entry, value in exact(math.cos(math.radians(theta))).items():
                found = np.array([audit[entry][m, 0] for audit in audits])
                error = found.std(ddof=1) / math.sqrt(seeds)
                sigma = f"{(found.mean() - value) / error:+.1f}"
                yield name, theta, entry, f"{value:.6f}", f"{found.mean():.6f} ± {error:.6f}", sigma


def chi_square_rows(rays):
    """Chi-square per degree of freedom, with its distance from 1 in sigma."""

    def rows(scene, alpha, slices, found):
        for parts, chi_squares in zip(("cells", "blocks"), found, strict=True):
            values = [f"{c.per_dof:.3f} ({c.sigmas:+.1f})" for c in chi_squares]
            yield scene, alpha, slices, parts, *values, *[""] * (len(THETAS) - len(values))

    for slices in SLICES:
        yield from rows("plastic, smooth coat", "", slices, checks.plastic_cells(THETAS, slices, rays, 1))
        for alpha in ALPHAS:
            found = checks.conductor_cells(alpha, THETAS, slices, rays, 2)
            yield from rows("rough conductor", alpha, slices, found)
    for eta in (1.5, 1.0 / 1.5):
        for alpha in ALPHAS:
            found = checks.transmission_cells(alpha, eta, THETAS[:-1], rays, 3)
            yield from rows(f"transmission, 1 to {eta:.3g}", alpha, "classic", found)


def integration_rows():
    """Yield rows on the direct reflection: as integrated by the engine and by an independent quadrature."""
    for slices in SLICES:
        for alpha in ALPHAS:
            density = closed_forms.reflection_density(alpha, 1.45 + 1.0j)
            top = conductor(1.45, 1.0, alpha)
            energy, stderr, exact = checks.direct_cells(top, density, THETAS, slices)
            error = np.abs(energy - exact)
            total = np.abs(error.sum(axis=(1, 2)) / exact.sum(axis=(1, 2))).max()
            yield alpha, slices, f"{error.max():.1e}", f"{stderr.max():.1e}", f"{total:.1e}"


def error_bar_rows(rays, seeds):
    """Yield rows on error bars: scatter over seeds against what is stated."""
    cases = {
        "plastic, classic, 60 deg": (
            [dielectric(1.5), medium(0.2), lambert(0.5)], 60, "classic",
            closed_forms.plastic_density(1.5, 0.5, 0.2),
        ),
        "conductor, half, 45 deg": (
            [dielectric(1.0), conductor(1.45, 1.0, 0.3)], 45, "half",
            closed_forms.reflection_density(0.3, 1.45 + 1.0j),
        ),
    }  # fmt: skip
    for name, (layers, theta, slices, density) in cases.items():
        energy, stderr, hits = checks.many_seeds(layers, theta, "reflection/internal", slices, rays, seeds)
        exact = integrate_cells(density, theta, *hits.shape[1:], slices)
        counted = hits.mean(axis=0) >= checks.ENOUGH_HITS
        bar = np.sqrt((stderr[:, 0] ** 2).mean(axis=0))
        z = (energy[:, 0] - exact)[:, counted] / bar[counted]
        own = (energy[:, 0] - exact)[:, counted] / stderr[:, 0][:, counted]
        error = z.mean(axis=1).std(ddof=1) / math.sqrt(seeds)
        yield name, z.size, f"{z.std():.4f}", f"{z.mean():+.4f} ± {error:.4f}", f"{own.std():.4f}"


def energy_rows(rays):
    """Audit of rough coats, with the energy that single-scattering facets lose."""
    stacks = {
        "rough coat 0.2 over white": [dielectric(1.5, 0.2), lambert(1.0)],
        "rough coat 1.0 over white": [dielectric(1.5, 1.0), lambert(1.0)],
        "metal 0.2 / 0.2": [dielectric(1.5, 0.2), medium(0.2), conductor(1.45, 1.0, 0.2)],
        "slab 0.2 / 0.2": [dielectric(1.5, 0.2), medium(0.2), dielectric(1.0, 0.2)],
    }
    for name, layers in stacks.items():
        audit = simulate(
            make_scene(layers, [0, 60, 85], rows=30, columns=60), rays=rays, seed=4, estimator="analog"
        ).audit
        for m, theta in enumerate((0, 60, 85)):
            e = {entry: float(value[m, 0]) for entry, value in audit.energy.items()}
            lost = e["lost_masked_reflection"] + e["lost_masked_transmission"]
            difference = e["reflected_direct"] - audit.direct_integrated[m, 0]
            sigma = difference / math.sqrt(e["reflected_direct"] * (1.0 - e["reflected_direct"]) / rays)
            energies = (e["reflected_direct"] + e["reflected_internal"], e["transmitted"])
            absorbed = e["absorbed_media"] + e["absorbed_base"]
            residual = np.abs(audit.residual[m]).max()
            yield (
                name, theta, *(f"{x:.5f}" for x in energies), f"{absorbed:.5f}", f"{lost:.5f}",
                f"{e['lost_roulette']:+.0e}", f"{residual:.0e}", f"{sigma:+.1f}",
            )  # fmt: skip


def reciprocity_rows(rays):
    """Yield rows on f(l, v) = f(v, l)."""
    thetas = [0.5, 15.5, 30.5, 45.5, 60.5, 75.5]
    metal = [dielectric(1.5, 0.2), medium(0.2), conductor(1.45, 1.0, 0.2)]
    slab = [dielectric(1.5, 0.2), medium(0.2), dielectric(1.0, 0.2)]
    for name, layers, part in (
        ("metal", metal, "reflection/internal"),
        ("slab", slab, "reflection/internal"),
        ("slab", slab, "transmission"),
    ):
        z = checks.exchange_deviations(layers, part, thetas, rays, 5)
        mean_square = f"{(z**2).mean():.3f} ± {math.sqrt(2 / z.size):.3f}"
        yield name, part, z.size, mean_square, f"{np.abs(z).max():.1f}"


def tracer_rows(rays, tracer_rays):
    """Yield rows on the agreement with the reference tracer."""
    deep = [
        dielectric(1.5, 0.2), medium([0.05, 0.1, 0.4]), dielectric(1.3), medium([0.2, 0.0, 0.1]),
        dielectric(1.7, 0.05),
    ]  # fmt: skip
    for name, base in (
        ("over a conductor", conductor([1.2, 1.45, 1.9], [1.0, 0.5, 2.0], 0.3)),
        ("in air", dielectric(1.0, 0.3)),
    ):
        for slices in SLICES:
            deviations, _ = checks.tracer_deviations([*deep, base], 40, slices, rays, tracer_rays)
            for part, z in deviations.items():
                if z.size >= 10:
                    yield name, slices, part, z.size, f"{(z**2).mean():.2f}", f"{np.abs(z).max():.1f}"


def main():
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a tenth of the rays")
    scale = 0.1 if parser.parse_args().quick else 1.0
    start = time.perf_counter()

    def rays(count):
        return int(scale * count)

    table(
        "Fresnel's equations where they lose digits",
        ("quantity", "indices", "largest error", "goniosim", "textbook formula in doubles"),
        fresnel_rows(),
    )
    table(
        "Closed forms of smooth stacks",
        ("stack", "theta", "energy", "exact", f"found, 30 seeds of {rays(1e6):.0e} rays", "sigma"),
        closed_form_rows(rays(1e6), 30),
    )
    table(
        "Every cell against its integrated density: chi-square per degree of freedom (sigma)",
        ("scene", "alpha", "slice", "over", *(f"{theta} deg" for theta in THETAS)),
        chi_square_rows(rays(1e7)),
    )
    table(
        "Integrated direct reflection of a rough conductor against the oracle's quadrature",
        ("alpha", "slice", "largest error of a cell", "largest error bar", "relative error of the sum"),
        integration_rows(),
    )
    table(
        f"Standardised deviations over {round(200 * scale)} seeds",
        ("scene", "deviations", "std", "mean", "std with each run's own error bar"),
        error_bar_rows(300_000, round(200 * scale)),
    )
    table(
        "Energy",
        ("stack", "theta", "reflected", "transmitted", "absorbed", "lost to masking", "roulette",
         "residual", "direct, sampled - integrated (sigma)"),
        energy_rows(rays(1e7)),
    )  # fmt: skip
    table(
        "Reciprocity, alpha 0.2 / 0.2: light and viewer exchanged",
        ("stack", "component", "pairs of cells", "mean square deviation", "largest"),
        reciprocity_rows(rays(3e7)),
    )
    table(
        "Four-layer stack against the reference tracer",
        ("stack", "slice", "part", "deviations", "mean square", "largest"),
        tracer_rows(rays(4e7), rays(4e6)),
    )
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
