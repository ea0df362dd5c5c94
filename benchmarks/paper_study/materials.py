"""The 60 materials of the paper, told apart by the names that configs/paper gives them."""

from dataclasses import dataclass

PLASTICS, METALS, SLABS = "plastics", "metals", "slabs"
CATEGORIES = {"P": PLASTICS, "M": METALS, "S": SLABS}
# What Fig. 4 shows: internal paths of opaque materials, transmission of slabs.
COMPONENTS = {PLASTICS: "reflection/internal", METALS: "reflection/internal", SLABS: "transmission"}


@dataclass(frozen=True)
class Material:
    """One of the 60.

    Attributes
    ----------
    name : str
        As in result files.
    label : str
        As in Tables 3 to 5 of the paper: ``P1`` to ``S4``.
    alpha0 : float
    alpha1 : float or None
        None for a Lambertian base.
    tau, base : str
        As written in the name; ``base`` is rho of a plastic, eta1 of a metal, empty for a slab.
    """

    name: str
    label: str
    alpha0: float
    alpha1: float | None
    tau: str
    base: str

    @property
    def category(self):
        """`PLASTICS`, `METALS` or `SLABS`."""
        return CATEGORIES[self.label[0]]

    @property
    def component(self):
        """The component whose error Fig. 4 shows."""
        return COMPONENTS[self.category]

    @property
    def is_yellow(self):
        """Whether tau is chromatic: C in the paper's tables."""
        return "_" in self.tau


def parse(name):
    """The material of that name, or None if the name is of another kind.

    Parameters
    ----------
    name : str
        Such as ``M1-alpha0_0.2-alpha1_0.001-tau_0.2-eta1_1.9``.

    Returns
    -------
    Material or None
    """
    label, *parts = name.split("-")
    values = dict(part.split("_", 1) for part in parts if "_" in part)
    if len(label) != 2 or label[0] not in CATEGORIES or not {"alpha0", "tau"} <= values.keys():
        return None
    return Material(
        name=name,
        label=label,
        alpha0=float(values["alpha0"]),
        alpha1=float(values["alpha1"]) if "alpha1" in values else None,
        tau=values["tau"],
        base=values.get("rho", values.get("eta1", "")),
    )


def mean_of(text):
    """Mean over the channels of what a name says of tau or rho."""
    values = [float(value) for value in text.split("_")]
    return sum(values) / len(values)


def select(materials, label=None, alpha0=None, alpha1=None, category=None):
    """Materials with all the given properties, in order of label and roughness."""
    asked = {"label": label, "alpha0": alpha0, "alpha1": alpha1, "category": category}
    found = [m for m in materials if all(v is None or getattr(m, k) == v for k, v in asked.items())]
    return sorted(found, key=lambda m: (m.category, m.label, m.alpha0, m.alpha1 or 0.0))


def one(materials, label, alpha0, alpha1=None):
    """The single material with these properties."""
    (found,) = select(materials, label, alpha0, alpha1)
    return found
