"""The Monte Carlo engine: `simulate`, `probe` for a short trial, and what a simulation needs of memory."""

from .estimators.choose import estimators_of
from .memory import memory_needed, require_memory, shortage, threads_of
from .probe import Probe, probe, warm_up
from .simulate import checked_state, simulate

__all__ = [
    "Probe",
    "checked_state",
    "estimators_of",
    "memory_needed",
    "probe",
    "require_memory",
    "shortage",
    "simulate",
    "threads_of",
    "warm_up",
]
