"""Random scenes over all that is legal, as what a scene file holds; the ends of every range come often."""

import math

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from goniosim.engine.estimators.choose import choose
from goniosim.engine.layout import N_LEDGER, STAGES
from goniosim.engine.plan import make_plan
from goniosim.engine.tally import record_length
from goniosim.engine.unit import Workspace, pilot_key
from goniosim.errors import ConfigError
from goniosim.scene import parse_scene
from laws.alike import in_order
from reference.scenes import conductor, dielectric, lambert, medium

# Deviations of an index from that of the medium above, on both sides of what counts as equal.
NEAR = [0.0, 1e-15, 1e-12, 1.1e-12, 1e-9, 1e-6, 1e-3]
NAMES = ["x", "0.5", "A" * 120, "_+=-.", "1e7", "null"]
SPECIAL_ANGLES = [0.0, 1e-9, 1e-3, 30.0, 45.0, 60.0, 89.0, 89.9, 89.999]
GRIDS = [(1, 1), (7, 11), (1, 8), (5, 1), (6, 12), (2, 3), (18, 36), (90, 7)]
# Which of three numbers the channels take: in the same ones everywhere, so that some channels are alike.
ALIKE = [(0, 1, 2), (0, 1, 2), (0, 0, 1), (0, 1, 0), (0, 1, 1)]

# Rays of a trial that tells whether a stack takes long, and events and stages that are enough for others.
TRIED = 128
MOST_EVENTS = 200_000
MOST_STAGES = 2000


def spread(low, high):
    """Positive numbers, as many in each decade."""
    return st.floats(math.log(low), math.log(high)).map(lambda x: min(max(math.exp(x), low), high))


def often(special, others):
    """One of a few special values, or any other."""
    return st.one_of(st.sampled_from(special), others)


def unequal(numbers):
    """Three numbers for the channels."""
    return st.lists(numbers, min_size=3, max_size=3)


def per_channel(numbers):
    """One number for all channels, or one for each."""
    return st.one_of(numbers, unequal(numbers))


alphas = often([0.0, 0.0, 1e-6, 1e-3, 1.0], spread(1e-6, 1.0))
taus = often([0.0, 1e-300, 1e-12, 50.0, 700.0, 1e4, 1e9], spread(1e-6, 1e4))
# Of media whose sum is to be legal.
parts = st.lists(taus.map(lambda tau: min(tau, 1e8)), min_size=2, max_size=4)
thin = often([0.0, 1e-12], spread(1e-6, 1.0))
rhos = often([0.0, 1.0, 1e-12, 1.0 - 1e-9], st.floats(0.0, 1.0))
metal_etas = often([1e-3, 0.05, 1.0, 1.5, 1e3], spread(1e-3, 1e3))
kappas = often([0.0, 1e-12, 1.0, 1e6], spread(1e-9, 1e6))
seeds = often([0, 1, 2**63 - 1], st.integers(0, 2**63 - 1))


def dielectric_eta(index):
    """Indices below that of a medium: any, those that are common, and those next to its own."""
    near = st.tuples(st.sampled_from(NEAR), st.sampled_from([-1.0, 1.0])).map(lambda x: index * (1.0 + x[0] * x[1]))
    return st.one_of(
        st.sampled_from([1.0, 1.5, 1.33, 2.4, 0.1, 10.0]), spread(0.1, 10.0), near.map(lambda x: min(max(x, 0.1), 10.0))
    )


@st.composite
def stacks(draw, *, most=12, fewest=1, alphas=alphas, taus=taus, rhos=rhos, colours=per_channel, of_metals=per_channel):
    """Layers from top to bottom: up to 12 interfaces, with a medium, two media or none between them."""
    base = draw(st.sampled_from(["glass", "metal", "lambert"]))
    count = draw(st.one_of(st.integers(fewest, min(3, most)), st.integers(fewest, most)))
    layers, index = [], 1.0
    for number in range(count):
        if number == count - 1 and base == "metal":
            eta, kappa = draw(of_metals(metal_etas)), draw(of_metals(kappas))
            # What the walk takes for black: the medium's own index.
            layers.append(conductor(*draw(st.sampled_from([(eta, kappa), (eta, kappa), (index, 0.0)])), draw(alphas)))
        elif number == count - 1 and base == "lambert":
            layers.append(lambert(draw(colours(rhos))))
        else:
            index = draw(dielectric_eta(index))
            layers.append(dielectric(index, draw(alphas)))
            if number < count - 1:
                layers += [medium(draw(colours(taus))) for _ in range(draw(st.sampled_from([0, 1, 1, 2])))]
    return in_order(layers, draw(st.sampled_from(ALIKE)))


def many_faced(**given):
    """Layers of two interfaces or more: there is something between them."""
    return stacks(fewest=2, **{"most": 12, **given})


def with_layers(scene, layers):
    """The same scene of another stack."""
    return {**scene, "material": {**scene["material"], "layers": layers}}


def angles(layers):
    """Distinct angles of incidence; those at which a medium is no longer entered are among them."""
    indices = [layer["interface"]["eta"] for layer in layers if layer.get("interface", {}).get("type") == "dielectric"]
    critical = [math.degrees(math.asin(index)) for index in indices if index < 1.0]
    beside = [angle * (1.0 + shift) for angle in critical for shift in (0.0, 1e-12, -1e-12)]
    special = SPECIAL_ANGLES + [angle for angle in beside if angle < 89.999]
    return st.lists(often(special, st.floats(0.0, 89.999)), min_size=1, max_size=3, unique=True)


def applies(scene, estimator):
    """Whether an estimator serves a scene."""
    parsed = parse_scene(scene)
    try:
        choose(make_plan(parsed), estimator, parsed.simulation.rays)
    except ConfigError:
        return False
    return True


def lingers(scene):
    """Whether light is caught in the stack for so long that few rays take seconds."""
    plan = make_plan(parse_scene(scene)).in_one_cell()
    workspace, ledger = Workspace(plan), np.zeros((N_LEDGER, plan.n_distinct))
    for direction in range(len(plan.theta_deg)):
        cells = workspace.cells(direction, 1, 1, np.zeros((plan.n_slots, record_length(plan.n_distinct))))
        workspace.begin(TRIED)
        if not workspace.advance(direction, pilot_key(direction), MOST_EVENTS, ledger, cells):
            return True
        if workspace.state[STAGES] > MOST_STAGES:
            return True
    return False


@st.composite
def scenes(draw, layers=None, *, estimators=("analog", "auto", "split", "connection", "operator")):
    """Complete scenes of few rays and few cells."""
    layers = draw(stacks() if layers is None else layers)
    rows, columns = draw(often(GRIDS, st.tuples(st.integers(1, 12), st.integers(1, 24))))
    scene = {
        "material": {"name": draw(st.sampled_from(NAMES)), "layers": layers},
        "incident": {"theta_deg": draw(angles(layers))},
        "slice": {
            "parametrization": draw(st.sampled_from(["classic", "half"])),
            "rows": rows,
            "columns": columns,
        },
        "simulation": {
            "rays": draw(often([100, 101, 500], st.integers(100, 2000))),
            "seed": draw(seeds),
            "threads": 1,
        },
    }
    orders = draw(st.one_of(st.none(), st.integers(1, 16)))
    if orders is not None:
        scene["simulation"]["orders"] = orders
    # Operators take a second where the others take a moment.
    wanted = draw(st.sampled_from([name for name in estimators for _ in range(1 if name == "operator" else 3)]))
    scene["simulation"]["estimator"] = wanted if applies(scene, wanted) else "analog"
    if scene["simulation"]["estimator"] == "operator":
        del scene["incident"]["theta_deg"][1:]
    assume(not lingers(scene))
    return scene
