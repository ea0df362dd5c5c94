"""The tables of the experiments: how the claims fare when a choice is made otherwise."""

from goniosim.report.text import count

from .experiments import conventions, metal_options, metal_tau, plastic_tau, slab_options
from .experiments.scenes import RAYS
from .experiments.table import settings_of, value_of
from .findings import eq5, plastics_ranking, rho_and_tau, rough_base, slabs, smooth_base
from .markdown import number, table
from .materials import parse
from .verdicts import YES, overall

METALS = {"4": rough_base.claims, "5": smooth_base.claims, "6": eq5.claims}
# The slab whose lobe is measured, that of Fig. 9 but for the colour.
WIDE = (0.001, 0.2)
SLABS = {"9 (growth)": slabs.claims}


def _slabs_snell(errors, materials):
    return slabs.claims(errors, materials, slabs.SNELL)


CONVENTIONS = {"1": plastics_ranking.claims, "3 (as declared)": rho_and_tau.claims} | METALS
CONVENTIONS |= SLABS | {"9 (growth), jacobian=snell": _slabs_snell}


def text(study):
    """Everything that was varied, in Markdown."""
    found = study.experiments
    return "\n\n".join(
        [
            "# What was varied",
            "Each cell: the verdict on the claims of that finding, and for each claim how many comparisons are *yes*. "
            f"Stacks other than the 60 are simulated with {count(RAYS)} rays per direction.",
            "### Plastics: other τ and ρ",
            "Declared: τ C = (0.05, 0.1, 0.8), τ A = 0.2, ρ C = (0.1, 0.6, 0.1), ρ A = 0.5. Each row changes one of "
            "them (α₀ = 0.05).",
            _fare(found[plastic_tau.NAME], {"1": plastics_ranking.claims, "3 (as declared)": rho_and_tau.claims}),
            "### Metals: other τ",
            f"η₁ = {metal_tau.ETA1:g}, all six pairs of roughnesses.",
            _fare(found[metal_tau.NAME], METALS),
            "### Metals: other readings of the models",
            f"{' and '.join(metal_options.LABELS)}. Each row gives the options to all models that have them.",
            _fare(found[metal_options.NAME], METALS, base=next(iter(metal_options.SETTINGS))),
            "M2 is the metal on which finding 5 is weakest. Its RMSE [sr^-1/2] with a smooth base, of the models that "
            "have the option:",
            _frosted(found[metal_options.NAME]),
            "### Slabs: other readings of Belcour's model",
            f"{' and '.join(slab_options.LABELS)}, RMSE [sr^-1/2] by α₀/α₁, and the width of the lobe of "
            f"{WIDE[0]:g}/{WIDE[1]:g} at {slab_options.LIGHT}° as in finding 9.",
            _slab_errors(found[slab_options.NAME]),
            "### The convention of the error",
            "All 60 materials. Where slices are reduced anew, models have 5 × 5 sub-cells.",
            _fare(found[conventions.NAME], CONVENTIONS),
            "### Colours at grazing angles: where they come from",
            "Patina with grey τ, internal paths, light at 75°, viewer beyond 75°: green over red by the number of "
            "events on the top interface, and the share of each in the green light.",
            _orders(found["colours"]),
            "Green over red of Belcour's models under their options:",
            _colour_options(found["colours"]),
        ]
    )


def _fare(rows, findings, base=None):
    """One row for each setting, one column for each finding; what a setting leaves out is that of ``base``."""
    tables = settings_of(rows)
    lines = []
    for setting, own in tables.items():
        errors = tables.get(base, {}) | own
        materials = [parse(name) for name in dict.fromkeys(name for name, _ in errors)]
        lines.append([setting, *(_cell(claims(errors, materials)) for claims in findings.values())])
    return table(["setting", *findings], lines)


def _cell(claims):
    counts = ", ".join(f"{claim.count(YES)}/{len(claim.answers)}" for claim in claims)
    return f"{overall(claims)}: {counts}"


def _frosted(rows):
    models = metal_options.FAMILY[1:] + metal_options.BELCOUR
    tables = settings_of(rows)
    base = next(iter(tables.values()))
    lines = []
    for setting, own in tables.items():
        for name in sorted({name for name, _ in base}):
            material = parse(name)
            if material.label == metal_options.LABELS[0] and material.alpha1 == 0.001:
                cells = [number(own[name, model]) if (name, model) in own else "" for model in models]
                lines.append([setting, f"{material.alpha0:g}", *cells])
    return table(["setting", "α₀", *models], lines)


def _slab_errors(rows):
    tables = settings_of([row for row in rows if row["quantity"] == "rmse"])
    widths = settings_of([row for row in rows if row["quantity"] == "width"])
    names = sorted({name for name, _ in next(iter(tables.values()))}, key=lambda n: (parse(n).alpha1, parse(n).alpha0))
    (wide,) = (name for name in names if (parse(name).alpha0, parse(name).alpha1) == WIDE)
    head = [f"{parse(name).alpha0:g}/{parse(name).alpha1:g}" for name in names]
    lines = []
    for setting, own in tables.items():
        materials = [parse(name) for name, _ in own]
        cells = [number(own[name, slab_options.MODEL]) for name in names]
        width = number(widths[setting][wide, slab_options.MODEL])
        lines.append([setting, *cells, _cell(slabs.claims(own, materials)), width])
    truth = number(widths[slab_options.SIMULATION][wide, slab_options.SIMULATION])
    lines.append(["simulation", *[""] * (len(names) + 1), truth])
    return table(["options", *head, "9 (growth)", "width"], lines)


def _orders(rows):
    chosen = [row for row in rows if row["model"] == "simulation"]
    numbers = {(row["material"], row["setting"], row["quantity"]): number(value_of(row)) for row in chosen}
    bases = list(dict.fromkeys(row["setting"] for row in chosen))
    orders = list(dict.fromkeys(row["material"] for row in chosen))
    quantities = ("G/R", "share of green")
    lines = [[order, *(numbers[order, base, q] for base in bases for q in quantities)] for order in orders]
    return table(["paths", *(f"{base}: {q}" for base in bases for q in quantities)], lines)


def _colour_options(rows):
    chosen = [row for row in rows if row["model"] != "simulation"]
    bases = list(dict.fromkeys(row["setting"] for row in chosen))
    numbers = {(row["model"], row["material"], row["setting"]): number(value_of(row)) for row in chosen}
    keys = list(dict.fromkeys((row["model"], row["material"]) for row in chosen))
    return table(["model", "options", *bases], [[*key, *(numbers[*key, base] for base in bases)] for key in keys])
