"""Every scalar function of goniosim as cases: a kernel, a grid and an oracle for each number it returns."""

from . import elementary, fresnel, ggx, horizon, medium, microfacet, refraction, sampling

GROUPS = {
    "elementary": elementary.CASES,
    "fresnel": fresnel.CASES,
    "refraction": refraction.CASES,
    "ggx": ggx.CASES,
    "sampling": sampling.CASES,
    "microfacet": microfacet.CASES,
    "medium": medium.CASES,
    "horizon": horizon.CASES,
}
