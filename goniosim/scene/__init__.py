"""What the user describes: typed, checked, and read from YAML with the line of every mistake."""

from goniosim.scene.arguments import with_arguments
from goniosim.scene.effects import Effect, absent_interfaces, distinct_channels, effects
from goniosim.scene.load import Source, as_scene, as_scenes, is_study, load_scene, load_scenes, parse_scene, study_name
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice
from goniosim.scene.optical import OpticalStack, optical_stack
from goniosim.scene.overrides import Override
from goniosim.scene.quantity import CHANNELS
from goniosim.scene.schema import json_schema

__all__ = [
    "CHANNELS",
    "Effect",
    "Incident",
    "Material",
    "OpticalStack",
    "Override",
    "Scene",
    "Simulation",
    "Slice",
    "Source",
    "absent_interfaces",
    "as_scene",
    "as_scenes",
    "distinct_channels",
    "effects",
    "is_study",
    "json_schema",
    "load_scene",
    "load_scenes",
    "optical_stack",
    "parse_scene",
    "study_name",
    "with_arguments",
]
