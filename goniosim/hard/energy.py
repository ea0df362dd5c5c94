"""Checks of where the light of a result goes."""

from collections.abc import Iterator, Sequence

import numpy as np

from ..result import Result
from .check import Check, absolute, in_sigmas, statement
from .oracles.adding import Energies
from .oracles.rough import Shares

# What the entries of an audit may miss of 1 by rounding.
CLOSED = 1e-12
# What no path of N has met has a share below 20 / N, but for 2e-9 of all seeds: as a limit of 6 standard errors.
RARE = 20.0 / 6.0


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


def as_added(result: Result, exact: Energies, rare: bool = False) -> Iterator[Check]:
    """Check shares of the light of a stack of smooth interfaces against adding.

    ``rare``: few paths enter, and error bars are widened by what they may be missing.
    """
    yield from leaving(result, exact, rare)
    if exact.absorbed.max() > CLOSED:
        yield _sampled(result, "absorbed", ("absorbed_media", "absorbed_base"), exact.absorbed, rare)
    if "reflection/direct" in result.components:
        yield absolute("reflected directly", result.audit.direct_integrated, exact.direct, CLOSED)
    yield closes(result)
    yield sane(result)


def leaving(result: Result, exact: Energies, rare: bool = False) -> Iterator[Check]:
    """Check what leaves a stack after having entered it; arguments as of `as_added`."""
    for entry, share in {"reflected_internal": exact.internal, "transmitted": exact.transmitted}.items():
        if share.any() or result.audit.energy[entry].any():
            yield _sampled(result, entry.replace("_", " "), (entry,), share, rare)


def _sampled(result: Result, checked: str, entries: tuple[str, ...], share: np.ndarray, rare: bool) -> Check:
    energy, stderr = (sum(book[each] for each in entries) for book in (result.audit.energy, result.audit.stderr))
    rays = float(result.rays.min())
    if rare:
        return in_sigmas(checked, energy, with_rare(stderr, rays), share)
    return in_sigmas(checked, energy, stderr, share, unseen=1.0 / rays)


def with_rare(stderr: np.ndarray, rays: float) -> np.ndarray:
    """Widen standard errors by what rare paths of full weight may be missing."""
    return np.hypot(stderr, RARE / rays)


def as_scattered(results: Sequence[Result], exact: Sequence[Sequence[Shares]]) -> Iterator[Check]:
    """Check shares of the light of single rough interfaces, one for each result and each of its directions."""
    for name, entry in {
        "reflected": "reflected_direct",
        "transmitted": "transmitted",
        "absorbed": "absorbed_base",
        "lost_reflection": "lost_masked_reflection",
        "lost_transmission": "lost_masked_transmission",
    }.items():
        share = np.array([[getattr(each, name) for each in row] for row in exact])[..., None]
        got = np.array([result.audit.energy[entry] for result in results])
        if share.any() or got.any():
            error = [with_rare(result.audit.stderr[entry], result.rays.min()) for result in results]
            yield in_sigmas(f"{name.replace('_', ' by ')}, sampled", got, np.array(error), share)
    missing = np.array([result.audit.residual for result in results])
    yield absolute("all light is accounted for: sum of the audit", 1.0 - missing, 1.0, CLOSED)
    sanity = [sane(result) for result in results]
    yield next((each for each in sanity if not each.holds), sanity[0])


def directly(results: Sequence[Result]) -> np.ndarray:
    """Return what the top interface reflects, integrated over cells, [result, direction]; channels are alike."""
    return np.array([result.audit.direct_integrated[:, 0] for result in results])
