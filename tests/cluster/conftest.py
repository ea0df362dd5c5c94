"""A Slurm of two processors, for all tests of this folder."""

import pytest

from cluster.slurm import Slurm, missing


@pytest.fixture(scope="session")
def daemons():
    """The one that all tests share."""
    if lacking := missing():
        pytest.fail(f"there is no {' and no '.join(lacking)} here: `make test-cluster` installs Slurm")
    slurm = Slurm(cpus=2)
    yield slurm
    slurm.stop()


@pytest.fixture
def slurm(daemons, monkeypatch):
    """That Slurm, known to what the test calls; its tasks find the kernels that are compiled here."""
    from goniosim._jit.folder import CACHE_FOLDER

    for name, value in daemons.environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(CACHE_FOLDER.parents[1]))
    return daemons
