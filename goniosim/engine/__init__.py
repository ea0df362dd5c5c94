"""The Monte Carlo engine: `simulate`, and `probe` for a short trial."""

from .probe import Probe, probe, warm_up
from .simulate import simulate

__all__ = ["Probe", "probe", "simulate", "warm_up"]
