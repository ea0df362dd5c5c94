"""What remains of a comparison once its slices are written: little enough to keep a whole study in memory."""

from dataclasses import dataclass

import numpy as np

from ..scene import optical_stack
from .rows import label, material_rows

PLASTICS, METALS, SLABS = CATEGORIES = ("plastics", "metals", "slabs")


@dataclass(frozen=True)
class Summary:
    """One material of a comparison.

    Attributes
    ----------
    name : str
    category : str
        One of `CATEGORIES`, by the last interface of the material.
    alpha0, alpha_base : float
        GGX widths of the top and of the last interface; 0 for a Lambertian one.
    component : str
        The main component.
    variants : list of goniosim.compare.variants.Variant
    rows : list of dict
        Of the table of errors.
    seconds, noise : ndarray, shape (P,)
        At the checkpoints of the simulation: time per slice, and noise floor of the main component.
    source : dict
        Where the reference came from: hash of its scene, seed, rays, time, version.
    """

    name: str
    category: str
    alpha0: float
    alpha_base: float
    component: str
    variants: list
    rows: list
    seconds: np.ndarray
    noise: np.ndarray
    source: dict

    def overall(self):
        """Rows of Eq. 4 for the main component, in the order of the variants."""
        return [
            row
            for row in self.rows
            if row["component"] == self.component
            and row["channel"] == "mean"
            and row["theta_deg"] == "all"
            and row["note"] is None
        ]

    def label_of(self, row):
        """Label of the variant of a row."""
        return label(row)


def summarise(comparison):
    """Keep the small parts of a comparison.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison

    Returns
    -------
    Summary
    """
    result = comparison.result
    interfaces = optical_stack(comparison.scene.material).material.interfaces
    main = comparison.components[0]
    base = {"lambert": PLASTICS, "conductor": METALS, "dielectric": SLABS}[interfaces[-1].type]
    noise = result.cost.noise(main) if main in result.cost.error else np.zeros(0)
    return Summary(
        name=result.name,
        category=base,
        alpha0=getattr(interfaces[0], "alpha", 0.0),
        alpha_base=getattr(interfaces[-1], "alpha", 0.0),
        component=main,
        variants=comparison.variants,
        rows=material_rows(comparison),
        seconds=result.cost.elapsed[: len(noise)] / len(result.theta_deg),
        noise=noise,
        source={
            "material": result.name,
            "config_hash": result.config_hash,
            "status": result.status,
            "seed": int(result.seed),
            "rays": result.rays.tolist(),
            "theta_deg": result.theta_deg.tolist(),
            "created_utc": result.provenance["created_utc"],
            "goniosim_version": result.provenance["goniosim_version"],
        },
    )
