"""What a simulation needs of memory, what is free, and what is said when that does not meet."""

from importlib import import_module

import numpy as np
import pytest

from goniosim import free_memory as free_module
from goniosim.engine import memory, memory_needed, require_memory, shortage, simulate
from goniosim.errors import ResourceError
from goniosim.free_memory import free_memory, resident_memory
from goniosim.report.simulation.forecast import file_size
from goniosim.scene import with_arguments
from reference.scenes import dielectric, lambert, make_scene, medium

# The module, which the function of the same name hides.
driver = import_module("goniosim.engine.simulate")

PLASTIC = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.8]), lambert([0.1, 0.6, 0.1])]
SLAB = [dielectric(1.5, 0.2), dielectric(1.0, 0.2)]

MEMINFO = "MemTotal:       100 kB\nMemAvailable:   {} kB\n"
STATUS = "Name:\tpython\nVmSize:\t    3000 kB\nVmRSS:\t    2000 kB\n"


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """Files of a machine as in ``/proc`` and ``/sys``; no limit on address space."""
    monkeypatch.setattr(free_module.resource, "getrlimit", lambda _: (free_module.resource.RLIM_INFINITY,) * 2)

    def write(files):
        for name, content in files.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(content)
        return tmp_path

    return write


def test_nothing_is_known_where_the_system_tells_nothing(machine):
    assert free_memory(machine({})) is None
    assert resident_memory(machine({})) == 0


def test_what_is_available_counts(machine):
    root = machine({"proc/meminfo": MEMINFO.format(50), "proc/self/status": STATUS})
    assert free_memory(root) == (50 * 1024, "available on this machine")
    assert resident_memory(root) == 2000 * 1024


def test_the_limit_on_address_space_counts(machine, monkeypatch):
    root = machine({"proc/meminfo": MEMINFO.format(10**6), "proc/self/status": STATUS})
    monkeypatch.setattr(free_module.resource, "getrlimit", lambda _: (5000 * 1024, 0))
    n_bytes, what = free_memory(root)
    assert n_bytes == 2000 * 1024 and "ulimit -v" in what


GROUPS = {
    # Version 2; the limit of the outer group is the tighter one, and cache makes room.
    "nested": (
        "0::/batch/job\n",
        {
            "batch/job/memory.max": "max",
            "batch/job/memory.current": "100",
            "batch/memory.max": "1000",
            "batch/memory.current": "900",
            "batch/memory.stat": "anon 500\ninactive_file 150\nactive_file 50\n",
        },
        300,
    ),
    # Within a container, the path is that of the outside.
    "container": ("0::/docker/abc\n", {"memory.max": "5000", "memory.current": "1000"}, 4000),
    "version 1": (
        "5:cpu:/\n4:memory:/job\n0::/\n",
        {
            "memory/job/memory.limit_in_bytes": "1000",
            "memory/job/memory.usage_in_bytes": "700",
            "memory/job/memory.stat": "total_inactive_file 100\ninactive_file 7\n",
            "memory/memory.limit_in_bytes": str(2**63 - 4096),
            "memory/memory.usage_in_bytes": "9000",
        },
        400,
    ),
}


@pytest.mark.parametrize("case", GROUPS)
def test_the_limits_of_containers_count(machine, case):
    group, files, left = GROUPS[case]
    files = {f"sys/fs/cgroup/{name}": content for name, content in files.items()}
    root = machine({"proc/meminfo": MEMINFO.format(10**9), "proc/self/cgroup": group, **files})
    assert free_memory(root) == (left, "left of the container's limit")


def test_what_no_kernel_says_is_passed_over(machine):
    odd = {
        "proc/self/cgroup": "garbage\n\n1:2\n0::/job\n",
        "sys/fs/cgroup/job/memory.max": "500\n",
        "sys/fs/cgroup/job/memory.current": "100\n",
        "sys/fs/cgroup/job/memory.stat": "odd\nactive_file many\ninactive_file 50\n",
    }
    root = machine({"proc/meminfo": MEMINFO.format(10**9), **odd})
    assert free_memory(root) == (450, "left of the container's limit")


@pytest.fixture
def room(monkeypatch):
    """Pretend that so many bytes can be had."""

    def pretend(n_bytes):
        monkeypatch.setattr(memory, "free_memory", lambda: n_bytes if n_bytes is None else (n_bytes, "in a test"))
        monkeypatch.setattr(memory, "resident_memory", lambda: 0)

    return pretend


def test_nothing_is_refused_where_nothing_is_known(room):
    room(None)
    assert shortage(make_scene(SLAB, [0.0, 1.0], rows=2000, columns=2000, orders=16, threads=4096)) is None


def test_just_enough_is_enough(room):
    scene = make_scene(PLASTIC, [30.0])
    room(memory_needed(scene).peak)
    assert shortage(scene) is None
    assert "GB are needed" in shortage(scene, besides=1)
    room(memory_needed(scene).peak - 1)
    assert "GB are needed" in shortage(scene)


DEEP = [dielectric(1.5 if i % 2 else 1.3) for i in range(800)] + [lambert(0.9)]
HELP = {
    "threads": (SLAB, [0.0, 30.0], {"rows": 400, "threads": 64}, 7e8, "threads would fit (simulation.threads: "),
    "directions": (
        PLASTIC,
        [float(i) for i in range(80)],
        {"threads": 1},
        1e9,
        "incident directions per file would fit",
    ),
    "cells": (
        SLAB,
        [30.0],
        {"rows": 2000, "columns": 2000, "threads": 2},
        2e9,
        "slices of 1000 x 1000 cells would fit",
    ),
    "orders": (SLAB, [30.0], {"rows": 500, "threads": 1, "orders": 16}, 1e9, "or fewer orders (simulation.orders)"),
    "queues": (DEEP, [30.0], {"rows": 2, "columns": 2, "threads": 1}, 4e8, "give the stack fewer interfaces"),
    "nothing": (PLASTIC, [30.0], {"threads": 1}, 1e8, "use a machine with more memory"),
}


@pytest.mark.parametrize("case", HELP)
def test_the_refusal_names_numbers_and_what_would_help(room, case):
    layers, theta, options, free, words = HELP[case]
    scene = make_scene(layers, theta, **options)
    room(free)
    with pytest.raises(ResourceError) as caught:
        require_memory(scene)
    message = str(caught.value)
    assert caught.value.exit_code == 4 and "\n" not in message
    assert "memory" in message and words in message
    assert f"{memory_needed(scene).peak / 1e9:.3g} GB" in message and f"{free / 1e9:.3g} GB can be had" in message


def test_the_threads_that_are_named_fit_and_one_more_does_not(room):
    layers, theta, options, free, _ = HELP["threads"]
    room(free)
    named = int(shortage(make_scene(layers, theta, **options)).split("simulation.threads: ")[1].rstrip(")"))
    assert shortage(make_scene(layers, theta, **{**options, "threads": named})) is None
    assert shortage(make_scene(layers, theta, **{**options, "threads": named + 1})) is not None


def test_a_simulation_is_refused_before_anything_is_made(room, monkeypatch):
    monkeypatch.setattr("goniosim.slices.half.geometry", lambda *_: pytest.fail("cells were computed"))
    room(4e8)
    with pytest.raises(ResourceError, match="not enough memory"):
        simulate(make_scene(SLAB, [31.0], "half", rows=2000, columns=2000))


def test_memory_that_runs_out_all_the_same_is_explained(monkeypatch):
    def greedy(*_):
        raise MemoryError("Unable to allocate 3 GiB")

    monkeypatch.setattr(driver, "integrate_direct", greedy)
    with pytest.raises(ResourceError, match="memory ran out"):
        simulate(make_scene(PLASTIC, [30.0], rows=2, columns=2))


def test_the_need_does_not_grow_with_the_rays_of_a_long_run():
    needs = [memory_needed(make_scene(PLASTIC, [30.0], rays=rays)).peak for rays in (10**10, 10**15)]
    assert needs[0] == needs[1]


def test_a_target_needs_what_its_limit_or_a_long_run_needs():
    def needed(**given):
        return memory_needed(with_arguments(make_scene(SLAB, [30.0], threads=2), given))

    assert needed(target=0.01, estimator="analog") == needed(rays=10**15, estimator="analog")
    limited = needed(target=0.01, max_rays=10**6, estimator="analog")
    assert limited == needed(rays=10**6, estimator="analog") != needed(rays=10**15, estimator="analog")
    # Replicates are summed up as they come: a long run needs no more than a short one.
    assert needed(target=0.01) == needed(rays=10**15) == needed(rays=10**6)


@pytest.mark.false_alarm(3e-5, seeds=(1, 101))
def test_ledgers_that_are_added_up_keep_the_balance(monkeypatch, seed):
    """Standard errors of 16 parts, of up to ten entries, exceed those of 64 by 90 % with a probability of 3e-5."""
    scene = make_scene(PLASTIC, [30.0], rows=2, columns=2, rays=40_000, threads=1, seed=seed)
    before = simulate(scene)
    with monkeypatch.context() as patched:
        patched.setattr("goniosim.engine.analog.MOST_LEDGERS", 16)
        after = simulate(scene)
    assert after.rays.tolist() == before.rays.tolist()
    for name, energy in before.audit.energy.items():
        np.testing.assert_allclose(after.audit.energy[name], energy, rtol=1e-12)
        # A standard error of 64 parts is known to 9 %, of 16 to 18 %: five standard deviations.
        np.testing.assert_allclose(after.audit.stderr[name], before.audit.stderr[name], rtol=0.9, atol=1e-15)
    np.testing.assert_array_equal(
        after.components["reflection/internal"].energy, before.components["reflection/internal"].energy
    )


def test_threads_without_work_take_nothing():
    few, many = (memory_needed(make_scene(SLAB, [30.0], threads=threads)) for threads in (16, 4096))
    assert few == many


def test_the_peak_is_that_of_a_phase():
    need = memory_needed(make_scene(PLASTIC, [30.0, 40.0], threads=3))
    assert need.peak >= need.program + need.result + need.file
    assert need.peak < sum(getattr(need, name) for name in need.__dataclass_fields__)
    assert need.largest == "file"


def test_the_text_of_the_scene_counts_in_the_size_of_the_file():
    deep, flat = (make_scene(layers, 30.0) for layers in (DEEP, [DEEP[0], DEEP[-1]]))
    assert file_size(deep) - file_size(flat) == len(deep.to_yaml()) - len(flat.to_yaml()) > 10_000
