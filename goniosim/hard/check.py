"""What is checked of a case: the expected and the found, and how far apart they may be."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

# A single right number is further off in 2e-9 of all runs, with an error from 32 replicates in 1e-6.
SIGMAS = 6.0
# Of the numbers that a standard error says nothing about: what rounding may add to them.
ROUNDING = 1e-12


@dataclass(frozen=True)
class Check:
    """One line of the table.

    Attributes
    ----------
    checked : str
        What is compared, in a few words.
    expected, got : str
        As people read them.
    deviation : float or None
        How far apart they are, in ``unit``; None of a statement, which holds or does not.
    unit : str
        ``sigma``, ``relative`` or ``absolute``.
    limit : float or None
        Largest deviation that is accepted.
    holds : bool
    """

    checked: str
    expected: str
    got: str
    deviation: float | None
    unit: str
    limit: float | None
    holds: bool


def in_sigmas(
    checked: str, got: ArrayLike, stderr: ArrayLike, expected: ArrayLike, unseen: float = 0.0, limit: float = SIGMAS
) -> Check:
    """Compare what was sampled with what is exactly known; of several numbers the worst is told.

    Parameters
    ----------
    checked : str
    got, stderr, expected : array_like
        Numbers with their standard errors, and the exact ones.
    unseen : float
        What may be there where nothing was seen: 1 / rays, for what paths carry of one unit at most.
    limit : float
        Standard errors.

    Returns
    -------
    Check
    """
    got, stderr, expected = np.broadcast_arrays(*(np.asarray(each, float) for each in (got, stderr, expected)))
    rounding = ROUNDING * np.maximum(np.abs(expected), 1e-300)
    error = np.hypot(np.hypot(stderr, rounding), np.where(got == 0.0, unseen, 0.0))
    deviations = np.abs(got - expected) / error
    worst = _worst(deviations)
    shown = f"{got[worst]:.6g} ± {error[worst]:.1g}"
    return _judged(_of_many(checked, got), f"{expected[worst]:.6g}", shown, deviations[worst], "sigma", limit)


def chi_square(checked: str, deviations: ArrayLike, freedom: int, limit: float = SIGMAS) -> Check:
    """Compare a sum of squares of standardised deviations with its mean, and tell it in sigmas of a normal one.

    Parameters
    ----------
    checked : str
    deviations : array_like
        In standard errors.
    freedom : int
        How many of them are independent.
    limit : float
        Standard errors.

    Returns
    -------
    Check
    """
    statistic = float(np.sum(np.square(deviations)))
    # Wilson and Hilferty: the cube root of a chi-square is nearly normal.
    width = 2.0 / (9.0 * freedom)
    sigmas = abs((statistic / freedom) ** (1.0 / 3.0) - (1.0 - width)) / math.sqrt(width)
    return _judged(f"{checked}: chi-square", f"{freedom}", f"{statistic:.4g}", sigmas, "sigma", limit)


def t_in_sigmas(checked: str, t: ArrayLike, freedom: int, limit: float = SIGMAS) -> Check:
    """Compare deviations from 0 over errors that were estimated from a few numbers; the worst is told, in sigmas."""
    t = np.atleast_1d(np.asarray(t, float))
    # Wallace: Student's t as a normal number of the same probability.
    sigmas = (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t**2 / freedom))
    worst = _worst(sigmas)
    found = f"{t[worst]:.3g} standard errors"
    return _judged(_of_many(checked, t), "0", found, sigmas[worst], "sigma", limit)


def relative(checked: str, got: ArrayLike, expected: ArrayLike, limit: float) -> Check:
    """Compare numbers that have no noise, by their relative difference; of several numbers the worst is told."""
    got, expected = np.broadcast_arrays(np.asarray(got, float), np.asarray(expected, float))
    deviations = np.abs(got - expected) / np.maximum(np.abs(expected), 1e-300)
    worst = _worst(deviations)
    wanted, found = f"{expected[worst]:.12g}", f"{got[worst]:.12g}"
    return _judged(_of_many(checked, got), wanted, found, deviations[worst], "relative", limit)


def absolute(checked: str, got: ArrayLike, expected: ArrayLike, limit: float) -> Check:
    """Compare numbers that have no noise, by their difference; of several numbers the worst is told."""
    got, expected = np.broadcast_arrays(np.asarray(got, float), np.asarray(expected, float))
    deviations = np.abs(got - expected)
    worst = _worst(deviations)
    wanted, found = f"{expected[worst]:.12g}", f"{got[worst]:.12g}"
    return _judged(_of_many(checked, got), wanted, found, deviations[worst], "absolute", limit)


def statement(checked: str, holds: Any, expected: object, got: object) -> Check:
    """State what is either so or not."""
    return Check(checked, str(expected), str(got), None, "", None, bool(holds))


def whether(checked: str, expected: bool, found: Any) -> Check:
    """State what is to be so, or not to be so; what is neither true nor false fails, and is shown as it is."""
    return statement(checked, found == expected, _in_words(expected), _in_words(found))


def _in_words(answer: Any) -> str:
    return {True: "yes", False: "no"}.get(answer, str(answer))


def _worst(deviations: np.ndarray) -> tuple[np.intp, ...]:
    # What is not a number is the worst there is.
    return np.unravel_index(np.argmax(np.where(np.isnan(deviations), math.inf, deviations)), deviations.shape)


def _judged(checked: str, expected: str, got: str, deviation: float, unit: str, limit: float) -> Check:
    return Check(checked, expected, got, float(deviation), unit, limit, bool(deviation <= limit))


def _of_many(checked: str, values: np.ndarray) -> str:
    return checked if values.size == 1 else f"{checked} (worst of {values.size})"
