"""Claims on output paths, ``.NAME.HASH.claim``: who is at work on what. They die with their owner."""

from .claim import Claim, owner_of, remove_dead
from .life import SILENCE
from .owner import Owner

__all__ = ["SILENCE", "Claim", "Owner", "owner_of", "remove_dead"]
