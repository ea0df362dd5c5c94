"""Deliberate bugs, and the tests that have to catch them: one file of TOML for each room, see `catalogue`."""
