"""Scenes in the words of other tools: what was meant, and a hint for every word."""

from goniosim.scene.foreign.translation import choice_meant, translate, unknown_key, value_hint

__all__ = ["choice_meant", "translate", "unknown_key", "value_hint"]
