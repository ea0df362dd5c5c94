"""A run that goes on from a finished result: to what both have yielded together, on random numbers of its own."""

import copy
import dataclasses
import threading

import numpy as np
import pytest

from goniosim.engine import prior_of, simulate
from goniosim.engine.drive import Drive
from goniosim.engine.packing import pack, unpack
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session
from goniosim.errors import StoppedError, UnusableResultError
from goniosim.scene import with_arguments
from reference.scenes import conductor, dielectric, lambert, make_scene, medium
from sameness import content

METAL = [dielectric(1.5, 0.3), medium([0.05, 0.1, 0.8]), conductor(1.45, [1.0, 0.5, 0.5], 0.3)]
SLAB = [dielectric(1.5, 0.001), medium(0.2), dielectric(1.0, 0.3)]
NARROW = [dielectric(1.5, 0.01), conductor(1.45, 1.0, 0.01)]
PLASTIC = [dielectric(1.5, 0.1), lambert(0.5)]
CASES = {
    "analog": (METAL, {"orders": 2}, {"rays": 4000, "estimator": "analog"}),
    "connection": (PLASTIC, {}, {"rays": 131_072}),
    "split": (NARROW, {}, {"rays": 9000, "estimator": "split"}),
    "operator": (METAL, {}, {"rays": 262_144}),
    "two estimators": (SLAB, {"orders": 2}, {"rays": 262_144}),
}
QUICK = [case if case in ("analog", "split") else pytest.param(case, marks=pytest.mark.slow) for case in CASES]


def scene_of(case, seed=1):
    layers, orders, asked = CASES[case]
    return with_arguments(make_scene(layers, [10.0, 70.0], rows=9, columns=36, seed=seed, **orders), asked)


@pytest.fixture(scope="module")
def first():
    """A finished run of a case; the function remembers it."""
    found = {}

    def of(case, seed=1):
        if (case, seed) not in found:
            found[case, seed] = simulate(scene_of(case, seed), threads=1)
        return found[case, seed]

    return of


def extended(case, result, factor=3, seed=1, **given):
    scene = scene_of(case, seed)
    return simulate(scene, rays=factor * scene.simulation.rays, prior=prior_of(scene, result), **given)


def alone(scene, key, rays):
    """What is missing, traced by itself."""
    simulation = scene.simulation.model_copy(update={"seed": int(key), "rays": rays})
    session = Session(make_plan(scene), simulation, Drive(2, threading.Event(), lambda done, total: None))
    session.run()
    return session


def parts_of(result):
    """Components and their orders, by way out and number of the order."""
    for side, name in enumerate(("reflection/internal", "transmission")):
        if name in result.components:
            component = result.components[name]
            yield from (((side, None), component), *(((side, n), o) for n, o in enumerate(component.orders.values())))


@pytest.mark.parametrize("case", QUICK)
def test_it_is_the_run_before_and_an_independent_one(first, case):
    """Means by light paths. Of independent paths, scatter is that of all of them; else variances add up."""
    before, scene = first(case), scene_of(case)
    both = extended(case, before)
    missing = 3 * scene.simulation.rays - int(before.rays.min())
    other = alone(scene, prior_of(scene, before).key(scene.simulation.seed), missing)
    run_of = {side: run for run in other.runs for side in run.sides}
    held = dict(parts_of(before))
    for place, found in parts_of(both):
        old, run = held[place], run_of[place[0]]
        for m in range(2):
            new = run.estimate(place[0], m, place[1])
            n, k = int(old.paths[m]), new.paths
            position = make_plan(scene).position
            energy = (n * old.energy[m] + k * new.energy[position]) / (n + k)
            if old.hits is not None:
                # Sums of squares, from the errors of the means.
                squares = n * (n - 1.0) * old.stderr[m] ** 2 + n * old.energy[m] ** 2
                squares += k * (k - 1.0) * new.stderr[position] ** 2 + k * new.energy[position] ** 2
                variance = (squares / (n + k) - energy**2) / (n + k - 1.0)
                np.testing.assert_array_equal(found.hits[m], old.hits[m] + new.hits)
            else:
                variance = ((n * old.stderr[m]) ** 2 + (k * new.stderr[position]) ** 2) / (n + k) ** 2
                assert found.replicates[m] == old.replicates[m] + new.count
            assert found.paths[m] == n + k
            np.testing.assert_allclose(found.energy[m], energy, rtol=1e-12, atol=0.0)
            np.testing.assert_allclose(found.stderr[m] ** 2, variance, rtol=1e-10, atol=0.0)
    assert both.status == "complete" and both.rays.min() >= 3 * scene.simulation.rays
    assert (both.cost.rays[:, : before.cost.checkpoints] == before.cost.rays).all()
    assert (both.cost.rays[:, -1] == both.rays).all() and (np.diff(both.cost.cpu_seconds) >= 0.0).all()


@pytest.mark.parametrize("case", QUICK)
def test_any_number_of_threads_gives_the_same_bits(first, case):
    found = {content(extended(case, first(case), threads=threads)) for threads in (1, 2, 3)}
    assert len(found) == 1


@pytest.mark.parametrize("case", QUICK)
def test_an_interrupted_one_goes_on_to_the_same_bits(first, case):
    """From a state alone, which holds what was there before."""
    scene = with_arguments(scene_of(case), {"rays": 3 * scene_of(case).simulation.rays})
    states, prior = [], prior_of(scene, first(case))

    def run(**given):
        drive = Drive(2, threading.Event(), lambda done, total: None)
        session = Session(make_plan(scene), scene.simulation, drive, **given)
        session.run()
        return session

    def numbers(session):
        runs = [run for run in session.known for _ in range(2)]
        found = [run.estimate(side, n % 2) for n, run in enumerate(runs) for side in run.sides]
        return pack([session.rays, session.drive.done, *(list(vars(one).values()) for one in found)])

    whole = run(prior=prior, checkpoint=lambda session: states.append(pack(session.state())))
    for state in (states[0], states[len(states) // 2], states[-1]):
        assert numbers(run(resumed=unpack(state))) == numbers(whole)


@pytest.mark.parametrize("case", ["analog", "split"])
def test_stopped_before_it_gained_anything_it_is_no_result(first, case):
    """So that nothing takes the place of a finished one."""
    stop = threading.Event()
    stop.set()
    with pytest.raises(StoppedError):
        extended(case, first(case), stop=stop)


def test_where_nothing_but_the_direct_reflection_leaves():
    scene = make_scene([conductor(1.45, 1.0, 0.3)], [10.0, 70.0], rows=5, columns=12, rays=2000)
    more = with_arguments(scene, {"rays": 5000})
    found = simulate(more, prior=prior_of(more, simulate(scene)))
    assert found.rays.tolist() == found.audit.rays.tolist() == [5000, 5000]
    aimed = with_arguments(scene, {"target": 0.01})
    again = simulate(aimed, prior=prior_of(aimed, found))
    assert again.target_reached and again.rays.tolist() == [5000, 5000] and simulate(aimed).target_reached


@pytest.mark.false_alarm(2e-5, seeds=(1, 101))
@pytest.mark.parametrize("case", ["analog", "split"])
def test_a_direction_without_rays_has_what_the_run_adds(first, case, seed):
    """5 sigma on 3 numbers, with errors from 32 replicates or 64 parts: a false alarm in 2e-5 of the cases."""
    before = copy.deepcopy(first(case, seed))
    before.status, before.rays[1], before.audit.rays[1] = "partial", 0, 0
    for _, part in parts_of(before):
        part.paths[1] = 0
    found, plain = extended(case, before, seed=seed), first(case, seed)
    missing = 3 * scene_of(case).simulation.rays
    assert found.rays[0] == plain.rays[0] + found.rays[1] and missing <= found.rays[1] < 1.1 * missing
    (value, error), (other, others_error) = ((v[1], e[1]) for v, e in (found.albedo(), plain.albedo()))
    assert (np.abs(value - other) < 5.0 * np.hypot(error, others_error)).all()


def test_replicates_that_only_go_on_are_no_smaller_than_others(first):
    before, scene = first("connection"), with_arguments(scene_of("connection"), {"rays": 132_000})
    found = simulate(scene, prior=prior_of(scene, before))
    assert found.rays.tolist() == [2 * 131_072] * 2


def test_every_extension_has_random_numbers_of_its_own(first):
    scene, once = scene_of("analog"), first("analog")
    twice = extended("analog", once, 2)
    priors = [prior_of(scene, result) for result in (once, twice, extended("analog", twice, 3))]
    keys = [prior.key(seed) for prior in priors for seed in (1, 2)]
    assert len(set(keys)) == len(keys)
    assert twice.provenance["extended_from"].startswith("4000 rays per direction, of 20")


def test_what_cannot_be_relied_on_is_refused(first):
    scene, result = scene_of("analog"), first("analog")
    other = dataclasses.replace(result, provenance={**result.provenance, "goniosim_version": "0.0"})
    with pytest.raises(UnusableResultError, match="it is of goniosim 0.0, and this is"):
        prior_of(scene, other)
    component = result.components["reflection/internal"]
    parts = {**result.components, "reflection/internal": dataclasses.replace(component, paths=None)}
    with pytest.raises(UnusableResultError, match="does not say how many light paths"):
        prior_of(scene, dataclasses.replace(result, components=parts))
    auto = with_arguments(scene, {"rays": 1e6, "estimator": "auto"})
    with pytest.raises(UnusableResultError, match="was made by analog, and operator serves what is asked for"):
        prior_of(auto, result)


def test_a_tighter_target_goes_on(first):
    scene = with_arguments(scene_of("split"), {"target": 0.05})
    loose = simulate(scene)
    said, tight = [], with_arguments(scene, {"target": 0.003})
    found = simulate(tight, prior=prior_of(tight, loose), note=said.append)
    # The direction at the normal is through.
    assert found.target_reached and found.rays[0] > loose.rays[0] and found.rays[1] == loose.rays[1]
    assert said == [] and (found.cost.error["reflection/internal"][:, -1] > 0.0).all()
    # What is met already takes no ray; nor does what no ray is left for.
    again = simulate(scene, prior=prior_of(scene, found))
    assert again.target_reached and (again.rays == found.rays).all()
    limited = with_arguments(scene, {"target": 0.0001, "max_rays": int(found.rays.min())})
    missed = simulate(limited, prior=prior_of(limited, found))
    assert missed.target_reached is False and missed.status == "complete" and (missed.rays == found.rays).all()


def test_a_target_that_takes_another_estimator_begins_anew():
    """Independent paths were enough for the loose target; the pilot says that they are not for the tight one."""
    scene = with_arguments(scene_of("connection"), {"target": 0.3})
    loose, said = simulate(scene), []
    assert loose.estimator == "analog"
    tight = with_arguments(scene, {"target": 0.01})
    found = simulate(tight, prior=prior_of(tight, loose), note=said.append)
    assert found.estimator == "connection" and "extended_from" not in found.provenance
    assert said == ["begins anew: what is there was made by analog, and connection serves what is asked for"]


@pytest.mark.slow
@pytest.mark.false_alarm(2e-5, seeds=(0, 1000))
@pytest.mark.parametrize("estimator", ["analog", "split"])
def test_error_bars_hold(estimator, seed):
    """Scatter over 200 runs, extended once, against the errors that they state.

    The mean of 200 squares scatters by a tenth, where they are normal; in sums over cells, and in the cells that hold
    the most, 5 sigma are a false alarm in 1e-5 of the cases.
    """
    scene = with_arguments(make_scene(METAL, [30.0], rows=3, columns=8), {"estimator": estimator, "rays": 1500})
    albedos, cells = [], []
    for number in range(200):
        own = with_arguments(scene, {"seed": seed + number})
        both = simulate(own, rays=4000, threads=1, prior=prior_of(own, simulate(own, threads=1)))
        component = both.components["reflection/internal"]
        brightest = np.unravel_index(component.energy[0, 0].argmax(), component.energy[0, 0].shape)
        albedos.append((component.albedo[0, 0], component.albedo_stderr[0, 0]))
        cells.append((component.energy[0, 0], component.stderr[0, 0]))
    for values, errors in (np.array(albedos).T, np.array([(e[brightest], s[brightest]) for e, s in cells]).T):
        ratio = values.var(ddof=1) / (errors**2).mean()
        assert 0.5 < ratio < 1.5
