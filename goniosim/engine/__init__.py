"""The Monte Carlo engine: `simulate`, whole or in portions, `probe` for a short trial, and what it needs of memory."""

from .estimators.choose import estimators_of
from .extended import prior_of
from .memory import memory_needed, require_memory, shortage, threads_of
from .pieces import piece_rays
from .portions import Traced, join_portions, trace_portion
from .prior import seeds_of
from .probe import Probe, probe, warm_up
from .simulate import checked_state, simulate
from .uniting import unite

__all__ = [
    "Probe",
    "Traced",
    "checked_state",
    "estimators_of",
    "join_portions",
    "memory_needed",
    "piece_rays",
    "prior_of",
    "probe",
    "require_memory",
    "seeds_of",
    "shortage",
    "simulate",
    "threads_of",
    "trace_portion",
    "unite",
    "warm_up",
]
