"""How many threads there are by default: by whoever allots processors."""

import os

import pytest

from goniosim.cores import available_cores

MACHINE = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


@pytest.fixture
def many(monkeypatch):
    """A machine with 16 processors."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(16)), raising=False)


def container(root, lines, files):
    for name, content in ({"proc/self/cgroup": lines} | files).items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(content)
    return root


@pytest.mark.parametrize(
    ("environment", "cores"),
    [
        ({}, 16),
        ({"SLURM_CPUS_PER_TASK": "2", "OMP_NUM_THREADS": "3", "NUMBA_NUM_THREADS": "4"}, 2),
        ({"OMP_NUM_THREADS": "3,2", "NUMBA_NUM_THREADS": "4"}, 3),
        ({"NUMBA_NUM_THREADS": " 4 "}, 4),
        ({"SLURM_CPUS_PER_TASK": "64"}, 16),
        ({"SLURM_CPUS_PER_TASK": "", "OMP_NUM_THREADS": "0", "NUMBA_NUM_THREADS": "-1"}, 16),
        ({"SLURM_CPUS_PER_TASK": "many", "OMP_NUM_THREADS": "3"}, 3),
    ],
)
def test_the_most_particular_allotment_counts(many, tmp_path, environment, cores):
    assert available_cores(environment, tmp_path) == cores


@pytest.mark.parametrize(
    ("lines", "files", "cores"),
    [
        ("0::/job/task\n", {"sys/fs/cgroup/job/cpu.max": "250000 100000\n"}, 3),
        ("0::/job\n", {"sys/fs/cgroup/job/cpu.max": "50000 100000\n"}, 1),
        ("0::/job\n", {"sys/fs/cgroup/job/cpu.max": "max 100000\n", "sys/fs/cgroup/cpu.max": "400000 100000\n"}, 4),
        (
            "4:cpu,cpuacct:/job\n2:memory:/job\n",
            {
                "sys/fs/cgroup/cpu/job/cpu.cfs_quota_us": "200000\n",
                "sys/fs/cgroup/cpu/job/cpu.cfs_period_us": "100000\n",
            },
            2,
        ),
        (
            "4:cpu:/\n",
            {"sys/fs/cgroup/cpu/cpu.cfs_quota_us": "-1\n", "sys/fs/cgroup/cpu/cpu.cfs_period_us": "100000\n"},
            16,
        ),
        ("nonsense", {"sys/fs/cgroup/cpu.max": "1 1"}, 16),
    ],
)
def test_the_quota_of_a_container_counts(many, tmp_path, lines, files, cores):
    root = container(tmp_path, lines, files)
    assert available_cores({}, root) == cores
    # Who allots knows better.
    assert available_cores({"OMP_NUM_THREADS": "5"}, root) == 5


def test_never_more_than_there_are(tmp_path):
    assert available_cores({}, tmp_path) == MACHINE
    assert available_cores({"OMP_NUM_THREADS": "10000"}, tmp_path) == MACHINE
