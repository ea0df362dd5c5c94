"""What the user describes: typed, checked, and read from YAML with the line of every mistake."""

from goniosim.scene.differences import differences
from goniosim.scene.effects import Effect, absent_interfaces, distinct_channels, effects
from goniosim.scene.load import is_study, load_scene, load_scenes, parse_scene, study_name
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice
from goniosim.scene.optical import OpticalStack, optical_stack
from goniosim.scene.quantity import CHANNELS
from goniosim.scene.schema import json_schema

__all__ = [
    "CHANNELS",
    "Effect",
    "Incident",
    "Material",
    "OpticalStack",
    "Scene",
    "Simulation",
    "Slice",
    "absent_interfaces",
    "differences",
    "distinct_channels",
    "effects",
    "is_study",
    "json_schema",
    "load_scene",
    "load_scenes",
    "optical_stack",
    "parse_scene",
    "study_name",
]
