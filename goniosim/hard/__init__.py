"""The catalogue of hard cases: a scene for each difficulty, what is exactly known of it, and what goniosim finds."""

from goniosim.hard.catalogue import CASES, TOPICS, Case
from goniosim.hard.check import Check
from goniosim.hard.running import Outcome, run

__all__ = ["CASES", "TOPICS", "Case", "Check", "Outcome", "run"]
