"""Published analytic models of layered materials: one file each, the same two verbs.

``supports(scene, component)`` says whether a model applies, ``prepare(scene, theta_i_deg, component,
options)`` lowers the scene to what its compiled kernel reads. See docs/models.md for the formulas.
"""

from .evaluation import describe_options, evaluate_model, find_model, prepare
from .model import COMPONENTS, Model, Prepared
from .options import OptionInfo
from .registry import MODELS

__all__ = [
    "COMPONENTS",
    "MODELS",
    "Model",
    "OptionInfo",
    "Prepared",
    "describe_options",
    "evaluate_model",
    "find_model",
    "prepare",
]
