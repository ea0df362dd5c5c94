"""Estimators of what leaves a stack: one file each.

An estimator makes *replicates*: independent, unbiased estimates of the slices, each from a key of its own. Whatever
it does within one (lattices, shared paths, many deposits of one path), the scatter of the replicates is an honest error.
"""
