"""What a hint works out and suggests is valid, and what was worked out is not shown as if it had been written."""

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import parse_scene

SCENE = """\
material:
  name: coat
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: 0.5}
    - interface: {type: lambert, rho: 0.5}
incident: {theta_deg: [0, 30]}
"""
TAU = "unknown key; tau is the optical depth of one crossing, tau = sigma_a * thickness (did you mean tau?)"
MEDIUM = "f.yaml:5: material.layers[1].medium"
COAT = "f.yaml:4: material.layers[0].interface"
THETA = "unknown key; theta_deg lists the angles of incidence from the normal, in degrees"


@pytest.mark.parametrize(
    "old, new, lines",
    [
        (
            "tau: 0.5",
            "sigma_a: [0.1, 0.2], thickness: 2",
            [
                f"{MEDIUM}.sigma_a: {TAU}",
                f"{MEDIUM}.thickness: {TAU}",
                f"{MEDIUM}.sigma_a: must be one number for all channels or a list of three, for R, G and B: "
                "this list has 2 [got tau: [0.2, 0.4]]",
            ],
        ),
        (
            "tau: 0.5",
            "sigma_a: [0.1, -0.2, 0.3], thickness: 2",
            [
                f"{MEDIUM}.sigma_a: {TAU}",
                f"{MEDIUM}.thickness: {TAU}",
                f"{MEDIUM}.sigma_a[1]: must be 0 or more (1e9 at most): it is the optical depth, and 0 absorbs nothing "
                "[got tau: -0.4]",
            ],
        ),
        (
            "alpha: 0.2",
            "roughness: 1.5",
            [
                f"{COAT}.roughness: unknown key; alpha is the GGX width, alpha = roughness^2 (did you mean alpha?)",
                f"{COAT}.roughness: must be 0 or lie between 1e-6 and 1: it is the GGX width; use 0 for a smooth "
                "interface [got alpha: 2.25]",
            ],
        ),
        (
            "theta_deg: [0, 30]",
            "theta: 95",
            [
                f"f.yaml:7: incident.theta: {THETA} (did you mean theta_deg?)",
                "f.yaml:7: incident.theta[0]: must be 0 or more and below 90: it is the angle from the normal in "
                "degrees [got theta_deg: 95]",
            ],
        ),
    ],
)
def test_nothing_is_suggested_that_would_be_refused(old, new, lines):
    assert old in SCENE
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE.replace(old, new, 1), "f.yaml")
    assert caught.value.problems == lines
