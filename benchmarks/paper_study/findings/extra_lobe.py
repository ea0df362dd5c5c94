"""Finding 8: ww09 has a lobe at grazing angles that nothing else has."""

from ..curves import plane_figure
from ..markdown import number, table
from ..materials import one
from ..study import Finding, name_of
from ..verdicts import CLOSE, Claim, Value, over_twice, within
from .grazing import LIGHTS, RED, VIEWER, beyond, green_over_red

TITLE = "ww09 has an extra achromatic lobe at grazing angles"
PAPER = (
    "On metals with a rough base Weidlich and Wilkie's model shows an additional lobe without colour towards grazing "
    "angles, since it evaluates the base in directions that are not refracted; Elek's model has none (Section 4.2, "
    "Figs. 6 and 8)."
)
# The base of Figs. 6 and 8, eta1 = 1.45, with both tau; the picture shows the material of Fig. 6.
LABELS, COATS, ROUGH = ("M2", "M4"), (0.001, 0.05, 0.2), 0.2
PICTURE = "paper-extra_lobe.png"


def measure(study):
    """The `Finding`."""
    answers = {name: {} for name in ("more", "grey", "red", "elek")}
    rows = []
    for material in [one(study.materials, label, alpha0, ROUGH) for label in LABELS for alpha0 in COATS]:
        slices = study.slices(material)
        component = material.component
        parts = {"simulation": slices.reference(component)}
        parts |= {name: slices.model(name, component) for name in ("ww09", "elek10")}
        for theta in LIGHTS:
            energy = {name: beyond(slices, part, theta) for name, part in parts.items()}
            colour = {name: green_over_red(each) for name, each in energy.items()}
            what = f"{name_of(material)} at {theta}°"
            answers["more"][what] = over_twice(energy["ww09"][RED], energy["simulation"][RED])
            answers["grey"][what] = within(colour["ww09"], Value(1.0), CLOSE)
            answers["red"][what] = over_twice(Value(1.0), colour["simulation"])
            answers["elek"][what] = over_twice(Value(1.0), colour["elek10"])
            rows.append(
                [name_of(material), f"{theta}°"]
                + [number(energy[name][RED]) for name in parts]
                + [number(colour[name]) for name in parts]
            )
    plane_figure(
        study.slices(one(study.materials, "M4", 0.001, ROUGH)),
        LIGHTS[0],
        {"red": RED, "green": 1},
        ("ww09", "elek10"),
        study.pictures / PICTURE,
    )
    return Finding(
        [
            Claim(f"ww09 sends over twice the red light beyond {VIEWER:g}°", answers["more"]),
            Claim("achromatic in ww09: green within a factor 2 of red", answers["grey"]),
            Claim("red in the simulation: green under half of red", answers["red"]),
            Claim("red in elek10: green under half of red", answers["elek"]),
        ],
        [
            "M2 and M4, the base of the paper's Figs. 6 and 8, with every coat. Energy of internal paths that leaves "
            f"beyond {VIEWER:g}°, red channel, and green over red there.",
            table(
                ["material", "light", "simulation", "ww09", "elek10", "G/R simulation", "G/R ww09", "G/R elek10"], rows
            ),
            f"![In the plane of incidence at {LIGHTS[0]} degrees: ww09 far above the simulation, without colour]"
            f"({PICTURE})",
        ],
    )
