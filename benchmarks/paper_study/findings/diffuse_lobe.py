"""Finding 2: the diffuse lobe of a plastic is over-estimated."""

from ..markdown import number, table
from ..materials import PLASTICS, one, select
from ..study import Finding, name_of
from ..verdicts import Claim, Value, less

TITLE = "ww09 and elek10 over-estimate the diffuse lobe"
PAPER = (
    "Both models show too bright a diffuse lobe although they leave out inter-reflections, Elek's even more so "
    "(Section 4.2, Fig. 5); Eq. 5 is slightly too dark, as it should be without them (Section 5.1)."
)
# The material of Fig. 5, its brightest channel, the light and the region in which the lobe is read.
SHOWN, CHANNEL, THETAS, NORMAL = ("P1", 0.05), 1, (0, 30, 60, 75), 20.0


def measure(study):
    """The `Finding`."""
    plastics = select(study.materials, category=PLASTICS)
    reference = {m: _albedo(study, m, "ww09", "reference") for m in plastics}
    model = {(m, name): _albedo(study, m, name, "model") for m in plastics for name in _MODELS}

    def answers(test):
        return {name_of(m): test(m) for m in plastics}

    claims = [
        Claim("albedo of ww09 > simulation", answers(lambda m: less(reference[m], model[m, "ww09"]))),
        Claim("albedo of elek10 > simulation", answers(lambda m: less(reference[m], model[m, "elek10"]))),
        Claim("albedo of elek10 > ww09", answers(lambda m: less(model[m, "ww09"], model[m, "elek10"]))),
        Claim("albedo of bati19_ww < simulation", answers(lambda m: less(model[m, "bati19_ww"], reference[m]))),
    ]
    rows = [
        [m.label, f"{m.alpha0:g}", number(reference[m]), *(f"{model[m, name].value:.4f}" for name in _MODELS)]
        for m in plastics
    ]
    albedos = table(["material", "α₀", "simulation", *_MODELS], rows)
    return Finding(
        claims,
        [
            "Albedo of internal paths, which are the diffuse lobe and nothing else: mean over directions and channels.",
            albedos,
            f"{SHOWN[0]} with α₀ = {SHOWN[1]:g} (the material of Fig. 5), BSDF of internal paths within {NORMAL:g}° of "
            "the normal, green channel, in 1/sr:",
            _normal_table(study),
        ],
    )


_MODELS = ("ww09", "elek10", "bati19_ww")


def _albedo(study, material, model, kind):
    row = study.errors.row(material, model)
    stderr = float(row["albedo_reference_stderr"]) if kind == "reference" else 0.0
    return Value(float(row[f"albedo_{kind}"]), stderr)


def _normal_table(study):
    slices = study.slices(one(study.materials, *SHOWN))
    component = slices.material.component
    parts = {"simulation": slices.reference(component)}
    parts |= {name: slices.model(name, component) for name in _MODELS}
    rows = []
    for theta in THETAS:
        m = slices.direction(theta)
        chosen = slices.polar(m) < NORMAL
        size = (slices.result.cells.projected_solid_angle[m] * (chosen & slices.result.cells.valid[m])).sum()
        found = [slices.region(part, m, chosen)[CHANNEL] for part in parts.values()]
        rows.append([f"{theta}°", *(number(Value(v.value / size, v.stderr / size)) for v in found)])
    return table(["light", *parts], rows)
