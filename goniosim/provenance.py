"""With what a number was computed: versions, processor, threads and time."""

import platform
from datetime import UTC, datetime
from importlib.metadata import version


def provenance(threads: int) -> dict[str, str]:
    """Provenance of a result or a report.

    Parameters
    ----------
    threads : int

    Returns
    -------
    dict of str to str
    """
    return {
        "created_utc": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "goniosim_version": version("goniosim"),
        "numba_version": version("numba"),
        "numpy_version": version("numpy"),
        "python_version": platform.python_version(),
        "processor": platform.processor() or platform.machine(),
        "threads": str(threads),
    }
