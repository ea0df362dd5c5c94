"""Results of different seeds, made one: with the rays of all of them, and as if one run had traced these."""

import dataclasses
import functools
import itertools

import numpy as np
import pytest

from goniosim.engine import prior_of, simulate, unite
from goniosim.errors import UnusableResultError
from goniosim.scene import parse_scene, with_arguments
from goniosim.store import open_result, write_result
from reference.scenes import conductor, dielectric, make_scene, medium
from sameness import content

METAL = [dielectric(1.5, 0.3), medium([0.05, 0.1, 0.8]), conductor(1.45, [1.0, 0.5, 0.5], 0.3)]
NUMBERS = ("energy", "stderr", "bsdf", "albedo", "albedo_stderr", "batches")


@functools.cache
def made(estimator, seed, rays=3000):
    scene = make_scene(METAL, [10.0, 70.0], rows=5, columns=12, orders=2)
    return simulate(with_arguments(scene, {"estimator": estimator, "seed": seed, "rays": rays}), threads=1)


@pytest.mark.parametrize("estimator", ["analog", "split"])
def test_three_in_any_order(estimator):
    results = [made(estimator, 1), made(estimator, 2, 6000), made(estimator, 3)]
    found = [functools.reduce(unite, order) for order in itertools.permutations(results)]
    for one in found:
        assert one.seed == 1 and one.provenance["merged_seeds"] == "1, 2, 3" and one.status == "complete"
        assert (one.rays >= 12_000).all() and (one.audit.rays >= 9000).all()
        for name, component in one.components.items():
            for field in NUMBERS:
                value, same = getattr(component, field), getattr(found[0].components[name], field)
                if value is not None:
                    np.testing.assert_allclose(value, same, rtol=1e-12, atol=0.0)
        for entry, value in one.audit.energy.items():
            np.testing.assert_allclose(value, found[0].audit.energy[entry], rtol=1e-12, atol=1e-16)


def test_it_counts_by_light_paths(tmp_path):
    one, other = made("split", 1), made("split", 2, 6000)
    both = unite(other, one)
    n, k = int(one.rays[0]), int(other.rays[0])
    for name in ("reflection/internal", "reflection/internal/order_2"):
        a, b, c = (r.components["reflection/internal"] for r in (one, other, both))
        if name.endswith("order_2"):
            a, b, c = (part.orders["order_2"] for part in (a, b, c))
        np.testing.assert_allclose(c.energy, (n * a.energy + k * b.energy) / (n + k), rtol=1e-12)
        np.testing.assert_allclose(c.stderr, np.hypot(n * a.stderr, k * b.stderr) / (n + k), rtol=1e-12)
    assert both.cost.rays[:, -1].tolist() == both.rays.tolist() and both.cost.checkpoints == one.cost.checkpoints + 1
    scene = parse_scene(both.config_yaml)
    assert scene.simulation.rays == n + k and both.config_hash == one.config_hash
    write_result(both, tmp_path / "both.h5")
    assert content(open_result(tmp_path / "both.h5")) == content(both)


def test_a_better_one_goes_on_with_random_numbers_of_its_own():
    both = unite(made("analog", 1), made("analog", 2))
    scene = with_arguments(parse_scene(both.config_yaml), {"rays": 9000})
    plain = made("analog", 1, 6000)
    assert prior_of(scene, both).key(1) != prior_of(scene, plain).key(1)
    more = simulate(scene, prior=prior_of(scene, both))
    assert more.rays.tolist() == [9000, 9000] and more.provenance["merged_seeds"] == "1, 2"


@pytest.mark.false_alarm(1e-12)
def test_the_errors_are_those_of_as_many_rays():
    """Four runs of 3000 rays and one of 12000; over many seeds the norms of their errors differ by 0.4 %."""
    merged = functools.reduce(unite, [made("analog", seed) for seed in (1, 2, 3, 4)])
    errors = [np.linalg.norm(r.components["reflection/internal"].stderr) for r in (merged, made("analog", 5, 12_000))]
    assert errors[0] == pytest.approx(errors[1], rel=0.05)


def test_a_partial_one_counts_as_far_as_it_goes():
    partial = dataclasses.replace(made("analog", 2), status="partial")
    both = unite(made("analog", 1), partial)
    assert both.status == "partial" and both.rays.tolist() == [6000, 6000]


def test_other_estimators_are_refused():
    one, other = made("analog", 1), made("split", 2)
    with pytest.raises(UnusableResultError, match="reflection/internal was made by split, and with seed 1 by analog"):
        unite(one, other)
