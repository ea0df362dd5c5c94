"""The driver: schedule, stopping, resuming, overrides, and what a scene does not call for."""

import sys
import threading
from types import SimpleNamespace

import numpy as np
import pytest

from goniosim.compare.measures import measure, rmse
from goniosim.engine import blas, probe, simulate, warm_up
from goniosim.engine import unit as unit_module
from goniosim.engine.estimate import channel_weights
from goniosim.engine.estimators import ESTIMATORS
from goniosim.engine.plan import make_plan
from goniosim.engine.schedule import LARGEST_UNIT, Schedule
from goniosim.errors import ConfigError, StoppedError
from plain import Plain
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

PLASTIC = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.8]), lambert([0.1, 0.6, 0.1])]


@pytest.mark.parametrize("rays", [100, 101, 12_345, 10**7, 160 * 10**6 + 1])
def test_schedule_shares_all_rays_evenly(rays):
    schedule = Schedule(directions=3, rays=rays)
    shares = {m: [] for m in range(3)}
    for number in range(len(schedule)):
        direction, unit, share = schedule[number]
        assert unit == len(shares[direction])
        shares[direction].append(share)
    for sizes in shares.values():
        assert sum(sizes) == rays
        assert max(sizes) - min(sizes) <= 1
        assert max(sizes) <= LARGEST_UNIT
        assert len(sizes) >= 16
    assert schedule.checkpoints[-1] == schedule.rounds


@pytest.mark.parametrize("rays", [100, 12_345])
def test_a_work_unit_has_parts_with_ledgers_of_their_own(rays):
    plan = make_plan(make_scene(PLASTIC, [30.0]))
    tally = unit_module.Tally(plan)
    report = unit_module.Workspace(plan).run(0, rays, unit_module.unit_key(1, 0, 0), tally, threading.Event())
    assert len(report.part_rays) == len(tally.ledgers) == unit_module.PARTS
    assert max(report.part_rays) - min(report.part_rays) <= 1 and report.rays == rays
    np.testing.assert_allclose(tally.ledgers.sum(axis=1), np.array(report.part_rays)[:, None] * np.ones(3), rtol=1e-12)
    assert len({part.tobytes() for part in tally.ledgers}) == unit_module.PARTS


def test_the_noise_floor_is_that_of_the_table_of_errors():
    """The mean over channels of the root, not the root of the mean: 20 % apart where channels are so unlike."""
    layers = [dielectric(1.5, 0.2), medium([0.05, 0.5, 3.0]), dielectric(1.0, 0.2)]
    result = simulate(make_scene(layers, [0.0, 60.0], rows=18, columns=36), rays=20_000)
    for name in ("reflection/internal", "transmission"):
        part = result.components[name]
        found = measure(part.bsdf, part.bsdf, part.bsdf_stderr, result.cells)
        for m in range(2):
            floor = rmse(found, m).noise_floor
            assert result.cost.error[name][m, -1] == pytest.approx(floor, rel=1e-12)
        joint = (part.bsdf_stderr**2 * result.cells.projected_solid_angle[:, None]).sum(axis=(2, 3)).mean() ** 0.5
        assert joint > 1.1 * rmse(found).noise_floor


def test_channels_that_are_alike_count_as_often_as_there_are_of_them():
    layers = [dielectric(1.5), medium([0.1, 2.0, 0.1]), dielectric(1.0)]
    np.testing.assert_allclose(channel_weights(make_plan(make_scene(layers, 0.0))), [2.0 / 3.0, 1.0 / 3.0], rtol=1e-15)


def test_a_stop_leaves_a_prefix_of_the_complete_result():
    """Every direction keeps its first work units; the same seed traces the same rays."""
    scene = make_scene(PLASTIC, [0.0, 60.0], rays=400_000, seed=3)
    stop = threading.Event()

    def progress(done, total):
        if done > 0.3 * total:
            stop.set()

    result = simulate(scene, progress=progress, stop=stop, threads=2)
    assert result.status == "partial"
    assert (result.rays > 0).all() and (result.rays < 400_000).all()
    assert np.abs(result.audit.residual).max() < 1e-12
    for component in result.components.values():
        assert np.isfinite(component.bsdf).all() and np.isfinite(component.bsdf_stderr).all()
    np.testing.assert_array_equal(result.cost.rays[:, -1], result.rays)
    assert (np.diff(result.cost.seconds, axis=1) >= 0.0).all() and (result.cost.cpu_seconds[:, -1] > 0.0).all()


def test_a_stop_before_the_first_ray_leaves_nothing():
    stop = threading.Event()
    stop.set()
    with pytest.raises(StoppedError, match="nothing to keep"):
        simulate(make_scene(PLASTIC, [0.0], rays=1000), stop=stop)


def test_interrupted_and_resumed_kernel_calls_change_nothing(monkeypatch):
    scene = make_scene(PLASTIC, [40.0], rays=30_000)
    whole = simulate(scene)
    monkeypatch.setattr(unit_module, "BUDGET", 700)
    pieces = simulate(scene)
    for name, component in whole.components.items():
        assert (component.energy == pieces.components[name].energy).all()


def test_overrides_are_recorded_and_checked():
    scene = make_scene(PLASTIC, [0.0], rays=1e6)
    result = simulate(scene, rays=5000, seed=11, threads=1)
    assert result.rays.tolist() == [5000]
    assert result.seed == 11
    assert "rays: 5000" in result.config_yaml and "seed: 11" in result.config_yaml
    with pytest.raises(ConfigError, match="rays"):
        simulate(scene, rays=3)


def test_progress_ends_at_the_total():
    seen = []
    simulate(make_scene(PLASTIC, [0.0, 30.0], rays=10_000), progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (20_000, 20_000)
    assert seen == sorted(seen)


def test_probe_measures():
    scene = make_scene(PLASTIC, [0.0])
    assert warm_up(scene) >= 0.0
    found = probe(scene, seconds=0.2)
    assert found.rays_per_second > 1e4
    assert 1.0 < found.events_per_ray < 20.0


def test_a_probe_expects_more_work_where_a_direction_takes_more():
    """Light that enters two slabs at 89.9 degrees is in there for long; the middle direction says nothing of it."""
    slabs = [dielectric(1.5), dielectric(1.0), dielectric(1.5), dielectric(1.0)]
    usual, grazing = (
        probe(make_scene(slabs, angles, rows=3, columns=4, rays=1 << 17, estimator="split"), seconds=0.0)
        for angles in ([0.0, 10.0, 20.0], [0.0, 10.0, 89.9])
    )
    assert grazing.events_per_ray > 3.0 * usual.events_per_ray


@pytest.mark.parametrize(("coats", "walks"), [([1.5], False), ([1.5, 1.3], True)])
def test_a_probe_traces_independent_paths_only_where_they_tell_something(monkeypatch, coats, walks):
    """Where replicates make all slices and nothing catches light, the analog walk is not even compiled."""
    module, inside, asked = sys.modules["goniosim.engine.probe"], [], []

    class Watched(Plain):
        tiny = classmethod(lambda cls, plan, sides: cls(plan, sides))

        def prepare(self):
            inside.append(blas._users)

        def workspace(self):
            asked.append(self)
            return super().workspace()

    monkeypatch.setitem(ESTIMATORS, "operator", Watched)
    monkeypatch.setattr(module, "_warm", set())
    monkeypatch.setattr(module, "_walk", lambda *given: asked.append("walk") or (10, 20, 0.5, 1.0, None))
    monkeypatch.setattr(module, "Tally", lambda plan: asked.append("compiled"))
    monkeypatch.setattr(module, "Workspace", lambda plan: SimpleNamespace(run=lambda *given: None))
    metal = [*(dielectric(eta, 0.2) for eta in coats), conductor(1.45, 1.0, 0.2)]
    found = probe(make_scene(metal, [0.0], rows=3, columns=4, rays=1 << 17, estimator="operator"), seconds=0.0)
    assert [each for each in asked if isinstance(each, str)] == (["compiled", "walk"] if walks else [])
    assert (found.rays, found.lost_event_cap) == ((10, 0.5) if walks else (0, 0.0))
    assert found.rays_per_second > 0.0 and found.events_per_ray > 1.0
    # Products of matrices have no threads of their own here.
    assert len(inside) == 2 and min(inside) == 1 and blas._users == 0


def test_only_distinct_channels_are_traced():
    metal = [dielectric(1.5, 0.2), medium(0.1), conductor(1.45, [1.0, 0.01, 0.01], 0.2)]
    assert make_plan(make_scene(metal, [0.0])).n_distinct == 2
    assert make_plan(make_scene(PLASTIC, [0.0])).n_distinct == 3
    assert make_plan(make_scene([dielectric(1.5), lambert(0.5)], [0.0])).n_distinct == 1


def test_only_possible_components_are_kept():
    def names(layers):
        return list(simulate(make_scene(layers, [0.0], rays=100)).components)

    assert names([conductor(1.5, 1.0, 0.2)]) == ["reflection/direct"]
    assert names([dielectric(1.5, 0.2)]) == ["reflection/direct", "transmission"]
    assert names(PLASTIC) == ["reflection/direct", "reflection/internal"]
    slab = [dielectric(1.5, 0.2), dielectric(1.0, 0.2)]
    assert names(slab) == ["reflection/direct", "reflection/internal", "transmission"]


def test_orders_sum_to_their_component():
    slab = [dielectric(3.0, 0.2), dielectric(1.0, 0.2)]
    scene = make_scene(slab, [30.0], rays=20_000, orders=3)
    result = simulate(scene)
    plain = simulate(make_scene(slab, [30.0], rays=20_000))
    expected = {
        "reflection/internal": ["order_2", "order_3", "order_4_and_more"],
        "transmission": ["order_1", "order_2", "order_3", "order_4_and_more"],
    }
    for name, orders in expected.items():
        component = result.components[name]
        assert list(component.orders) == orders
        total = sum(order.energy for order in component.orders.values())
        assert np.allclose(total, component.energy, rtol=1e-12, atol=1e-18)
        # The same paths, summed in another order.
        assert np.allclose(component.energy, plain.components[name].energy, rtol=1e-12, atol=1e-18)
        assert (component.hits == plain.components[name].hits).all()
        assert all(order.energy.sum() > 0 for order in component.orders.values())


def test_a_probe_of_a_deep_stack_looks_at_the_clock_soon():
    layers = [dielectric(1.1 if i % 2 else 1.5, 0.0) for i in range(400)]
    scene = make_scene(layers, [30.0], threads=1)
    assert probe(scene, seconds=0.0).rays <= (1 << 18) // 400
