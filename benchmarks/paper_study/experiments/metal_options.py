"""Other readings of the models on two of the metals: for findings 4 to 6."""

import goniosim

from .table import rmse_rows

NAME = "metal_options"
# eta1 = 1.45 with yellow tau, eta1 = 1.2 with grey tau.
LABELS = ("M2", "M6")
FAMILY = ("ww09", "elek10", "bati19_ww")
BELCOUR = ("belcour18_forward", "belcour18_symmetric")
# Options by setting; each is given to the models that have it, the others stay as they are.
SETTINGS = {
    "as in this study": {},
    "refraction_scale=paper": dict.fromkeys(BELCOUR, {"refraction_scale": "paper"}),
    "fgd=fresnel": dict.fromkeys(BELCOUR, {"fgd": "fresnel"}),
    "refraction_scale=paper,fgd=fresnel": dict.fromkeys(BELCOUR, {"refraction_scale": "paper", "fgd": "fresnel"}),
    "normalise_lobes=true": dict.fromkeys(BELCOUR, {"normalise_lobes": True}),
    "masking=correlated": dict.fromkeys(FAMILY + BELCOUR, {"masking": "correlated"}),
    "conductor_index=absolute": dict.fromkeys(FAMILY, {"conductor_index": "absolute"}),
    "t_roughness=inner": dict.fromkeys(FAMILY[:2], {"t_roughness": "inner"}),
    "t_masking=vgroove": dict.fromkeys(FAMILY[:2], {"t_masking": "vgroove"}),
}


def run(results):
    """Yield rows for every setting, under the plain names of the models."""
    for path in _files(results):
        result = goniosim.open_result(path)
        for setting, options in SETTINGS.items():
            models = list(options) or [*FAMILY, *BELCOUR]
            given = {
                model: {"refraction_scale": "auto"} | options.get(model, {}) for model in models if model in BELCOUR
            }
            given |= {model: options[model] for model in models if model not in BELCOUR and model in options}
            yield from rmse_rows(goniosim.compare(result, models, given), setting, lambda row: row["model"])


def _files(results):
    """Result files of the metals that are looked at."""
    return sorted(path for path in results.glob("*.h5") if path.name.split("-")[0] in LABELS)
