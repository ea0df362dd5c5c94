"""The Monte Carlo engine: `simulate`, and `probe` for a short trial."""

from .probe import Probe, available_cores, probe, warm_up
from .simulate import simulate

__all__ = ["Probe", "available_cores", "probe", "simulate", "warm_up"]
