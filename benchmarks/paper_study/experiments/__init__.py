"""What changes when a choice is made otherwise: every experiment is one file, its results are rows of one table.

An experiment offers ``NAME`` and ``run(results)``, which yields rows as `table.cell` makes them.
"""

from . import absorption, colours, conventions, metal_options, metal_tau, plastic_tau, slab_options

EXPERIMENTS = (absorption, plastic_tau, metal_tau, metal_options, slab_options, colours, conventions)
