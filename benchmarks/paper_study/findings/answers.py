"""Comparisons of two models on many materials, answered from a table of errors.

A table is a dict of (material name, model) to `Value`.
"""

from ..study import name_of
from ..verdicts import less, within


def ordered(table, materials, lower, higher):
    """Whether one model has a smaller error than another: answers by the name of the material."""
    return {name_of(m): less(table[m.name, lower], table[m.name, higher]) for m in materials}


def agree(table, materials, model, other, decades):
    """Whether the errors of two models agree within so many decades: answers by material and second model."""
    return {f"{name_of(m)}, {other}": within(table[m.name, model], table[m.name, other], decades) for m in materials}
