"""Simulation as Python users call it: Ctrl-C, progress and whole studies around the engine."""

from .simulation import simulate
from .study import simulate_study

__all__ = ["simulate", "simulate_study"]
