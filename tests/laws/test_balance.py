"""Of every legal scene: numbers that are finite and not negative, and sums that agree."""

import math

import numpy as np

from goniosim.engine import simulate
from goniosim.engine.plan import make_plan
from goniosim.engine.stages import OPAQUE, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC
from goniosim.scene import parse_scene
from goniosim.sums import block_sums
from laws.law import law
from laws.strategies import scenes
from sameness import FIELDS

LEDGER = {"reflection/internal": "reflected_internal", "transmission": "transmitted"}
# Of the probability that a mean of numbers between 0 and 1 strays so far: see `strays`.
RARE = 1e-12


@law(fast=44, slow=800, scene=scenes())
def test_everything_is_finite_and_adds_up(scene):
    """Sums to 1e-12; the sampled direct reflection to what happens once in 1e12 (Bernstein's inequality)."""
    parsed = parse_scene(scene)
    result = simulate(parsed)
    assert result.status == "complete"
    for name, array in arrays_of(result):
        assert np.isfinite(array).all(), name
        assert "audit" in name or "batches" in name or (array >= 0.0).all(), name
    audit = result.audit
    assert np.abs(audit.residual).max() < 1e-12
    for entry, energy in audit.energy.items():
        # An entry may be the difference of two sums: zero to rounding.
        assert entry == "lost_roulette" or (energy >= -1e-15).all(), entry
        assert (audit.stderr[entry] >= 0.0).all(), entry
    for name, component in result.components.items():
        totals_agree(name, component, audit)
    close(audit.direct_integrated, result.components["reflection/direct"].albedo)
    close(result.cells.projected_solid_angle.sum(axis=(1, 2)), math.pi)
    strays = np.abs(audit.energy["reflected_direct"] - audit.direct_integrated)
    assert (strays <= rarely(audit.direct_integrated, audit.rays[:, None])).all()
    only_what_can_happen(make_plan(parsed), audit)


def arrays_of(result):
    """Names and values of all numbers of a result."""
    for name, component in result.components.items():
        for label, part in {"": component, **component.orders}.items():
            for field in (*FIELDS, "hits", "batches", "node_bias"):
                if getattr(part, field) is not None:
                    yield f"{name}/{label} {field}", getattr(part, field)
    for field in ("energy", "stderr"):
        for entry, values in getattr(result.audit, field).items():
            yield f"audit {field} {entry}", values
    yield "audit direct", result.audit.direct_integrated
    yield "audit direct stderr", result.audit.direct_integrated_stderr
    yield "solid angle", result.cells.solid_angle
    yield "projected solid angle", result.cells.projected_solid_angle
    for name, error in result.cost.error.items():
        yield f"cost {name}", error


def totals_agree(name, component, audit):
    """Cells, albedo, ledger, orders and batches of one component."""
    total = component.energy.sum(axis=(2, 3))
    close(component.albedo, total)
    for m, estimator in enumerate(component.estimator):
        if estimator == "analog":
            close(total[m], audit.energy[LEDGER[name]][m])
    if component.orders:
        close(sum(part.energy for part in component.orders.values()), component.energy)
    if component.batches is not None:
        for m, batches in enumerate(component.batches):
            close(batches.mean(axis=0), block_sums(component.energy[m]))


def close(found, expected):
    """To 1e-12 of the flux or of the number."""
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)


def rarely(mean, count):
    """What a mean of so many independent numbers in [0, 1] strays by once in 1e12, at the most (Bernstein)."""
    unlikely = math.log(2.0 / RARE) / count
    return unlikely / 3.0 + np.sqrt((unlikely / 3.0) ** 2 + 2.0 * unlikely * mean * (1.0 - mean)) + 1e-12


def only_what_can_happen(plan, audit):
    """Nothing is booked under what no layer of the stack does."""
    energy = audit.energy
    assert plan.absorbs.any() or not energy["absorbed_media"].any()
    assert plan.kinds[-1] in OPAQUE or not energy["absorbed_base"].any()
    assert plan.kinds[-1] not in OPAQUE or not energy["transmitted"].any()
    assert len(plan.kinds) > 1 or not energy["reflected_internal"].any()
    if np.isin(plan.kinds, (SMOOTH_DIELECTRIC, SMOOTH_CONDUCTOR)).all():
        assert not energy["lost_masked_reflection"].any() and not energy["lost_masked_transmission"].any()
