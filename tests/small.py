"""A scene and a study that take no time."""

SCENE = """\
material:
  name: small
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: 0.2}
    - interface: {type: conductor, eta: 1.45, kappa: [1.0, 0.01, 0.01], alpha: 0.2}
incident: {theta_deg: [30]}
slice: {rows: 6, columns: 12}
simulation: {rays: 1e4, seed: 1}
"""

STUDY = """\
study:
  name: three-coats
  cross:
    alpha: [0.1, 0.2, 0.3]
  material:
    name: coat-${alpha}
    layers:
      - interface: {type: dielectric, eta: 1.5, alpha: "${alpha}"}
      - interface: {type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.2}
incident: {theta_deg: [30]}
slice: {rows: 6, columns: 12}
simulation: {rays: 1e4, seed: 1}
"""
