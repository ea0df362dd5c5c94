"""Checks of where the light of a result goes."""

from collections.abc import Iterator

import numpy as np

from ..result import Result
from .check import Check, absolute, in_sigmas, statement
from .oracles.adding import Energies

# What the entries of an audit may miss of 1 by rounding.
CLOSED = 1e-12


def closes(result: Result) -> Check:
    """Check that the audit sums to 1."""
    return absolute("all light is accounted for: sum of the audit", 1.0 - result.audit.residual, 1.0, CLOSED)


def sane(result: Result) -> Check:
    """Check that all numbers are finite, and no energy or error is negative."""
    wrong = [
        f"{path}/{name}"
        for path, component in result.components.items()
        for name in ("energy", "stderr", "bsdf", "bsdf_stderr")
        if not (np.isfinite(values := getattr(component, name)).all() and (values >= 0.0).all())
    ]
    return statement("numbers of cells are finite and not negative", not wrong, "all", ", ".join(wrong) or "all")


def as_added(result: Result, exact: Energies) -> Iterator[Check]:
    """Check shares of the light of a stack of smooth interfaces against adding."""
    energy, stderr = result.audit.energy, result.audit.stderr
    unseen = float(1.0 / result.rays.min())
    for entry, share in {
        "reflected_internal": exact.internal,
        "transmitted": exact.transmitted,
    }.items():
        if share.any() or energy[entry].any():
            yield in_sigmas(entry.replace("_", " "), energy[entry], stderr[entry], share, unseen)
    absorbed = energy["absorbed_media"] + energy["absorbed_base"]
    if exact.absorbed.max() > CLOSED:
        error = stderr["absorbed_media"] + stderr["absorbed_base"]
        yield in_sigmas("absorbed", absorbed, error, exact.absorbed, unseen)
    if "reflection/direct" in result.components:
        yield absolute("reflected directly", result.audit.direct_integrated, exact.direct, CLOSED)
    yield closes(result)
    yield sane(result)
