"""Scalar physics, one idea per file: pure functions of numbers, for the simulator and the models alike."""
