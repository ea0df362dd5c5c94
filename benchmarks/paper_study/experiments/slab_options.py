"""Other readings of Belcour's slab on two of the four: for finding 9."""

from itertools import product

import goniosim

from .table import rmse_rows

NAME = "slab_options"
# Grey tau, both base roughnesses.
LABELS = ("S2", "S4")
MODEL = "belcour18_forward"
CHOICES = {
    "jacobian": ("published", "snell"),
    "refraction_scale": ("paper", "normal"),
    "fgd": ("fresnel", "exact"),
}


def run(results):
    """Yield rows for every combination of options, under the plain name of the model."""
    files = sorted(path for path in results.glob("*.h5") if path.name.split("-")[0] in LABELS)
    for path in files:
        result = goniosim.open_result(path)
        for values in product(*CHOICES.values()):
            options = dict(zip(CHOICES, values, strict=True))
            setting = ", ".join(f"{name}={value}" for name, value in options.items())
            comparison = goniosim.compare(result, [MODEL], {MODEL: options})
            yield from rmse_rows(comparison, setting, lambda row: row["model"])
