"""What the user describes: typed, checked, and read from YAML with the line of every mistake."""

from goniosim.scene.arguments import with_arguments
from goniosim.scene.components import components
from goniosim.scene.differences import differences
from goniosim.scene.effects import Effect, absent_interfaces, distinct_channels, effects
from goniosim.scene.example import example
from goniosim.scene.load import Config, Source, as_scene, as_scenes, load_config, load_scene, load_scenes, parse_scene
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice, total_rays
from goniosim.scene.optical import OpticalStack, optical_stack
from goniosim.scene.overrides import Override
from goniosim.scene.quantity import CHANNELS
from goniosim.scene.schema import json_schema
from goniosim.scene.target import Target

__all__ = [
    "CHANNELS",
    "Config",
    "Effect",
    "Incident",
    "Material",
    "OpticalStack",
    "Override",
    "Scene",
    "Simulation",
    "Slice",
    "Source",
    "Target",
    "absent_interfaces",
    "as_scene",
    "as_scenes",
    "components",
    "differences",
    "distinct_channels",
    "effects",
    "example",
    "json_schema",
    "load_config",
    "load_scene",
    "load_scenes",
    "optical_stack",
    "parse_scene",
    "total_rays",
    "with_arguments",
]
