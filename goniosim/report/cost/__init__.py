"""The price list of a scene: what accuracy costs in time, what its effects add, and where something else limits."""
