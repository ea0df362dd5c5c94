"""The Monte Carlo engine: `simulate`, and `probe` for a short trial."""

from .simulate import Probe, available_cores, probe, simulate, warm_up

__all__ = ["Probe", "available_cores", "probe", "simulate", "warm_up"]
