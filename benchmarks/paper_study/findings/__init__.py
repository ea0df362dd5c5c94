"""The findings of the paper, one file each: what it says, our numbers, the claims that decide.

Every file offers ``TITLE``, ``PAPER`` (its statement in our words) and ``measure(study)``; those on errors
alone also ``claims(table, materials)``, so that they can be asked about other tables.
"""

from . import (
    diffuse_lobe,
    eq5,
    eq6,
    extra_lobe,
    grazing_colours,
    plastics_ranking,
    rho_and_tau,
    rough_base,
    same_roughness,
    slabs,
    smooth_base,
)

FINDINGS = (
    plastics_ranking,
    diffuse_lobe,
    rho_and_tau,
    rough_base,
    smooth_base,
    eq5,
    same_roughness,
    extra_lobe,
    slabs,
    eq6,
    grazing_colours,
)
