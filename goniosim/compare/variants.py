"""Which models are compared with a material, and with which options."""

import dataclasses
from collections.abc import Iterable, Mapping

from ..errors import ConfigError
from ..models import MODELS, describe_options, find_model
from ..models.options import parse_options
from ..scene import optical_stack


@dataclasses.dataclass(frozen=True)
class Variant:
    """A model with its options.

    Attributes
    ----------
    model : str
    options : tuple of (str, object)
        Those that are not left at their default.
    """

    model: str
    options: tuple = ()

    @property
    def options_text(self):
        """The options as they are written on the command line: ``name=value``, with commas between."""
        return ",".join(f"{name}={_shown(value)}" for name, value in self.options)

    @property
    def label(self):
        """Name that tells the variants of a model apart: ``belcour18_forward[jacobian=snell]``."""
        return f"{self.model}[{self.options_text}]" if self.options else self.model


def _shown(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def check_request(models=None, options=None):
    """Check the models and options that somebody asks for.

    Parameters
    ----------
    models : sequence of str, optional
        All models by default.
    options : mapping of str to mapping, optional
        Options of each model by its name.

    Returns
    -------
    dict of str to dict
        Options given for each model to be compared, in the order of `goniosim.models.MODELS`.

    Raises
    ------
    ConfigError
        An unknown model, option or value; all mistakes at once.
    """
    options = {} if options is None else options
    if not isinstance(options, Mapping):
        raise ConfigError(f"options must be a mapping of models to their options [got {options!r}]")
    if not isinstance(models, Iterable | None):
        raise ConfigError(f"models must be names of models [got {models!r}]")
    models = None if models is None else list(models)
    if models == []:
        raise ConfigError("there are no models to compare; leave models out to compare all")
    problems = []
    for name in [*(models or ()), *options]:
        try:
            parse_options(name, find_model(name).options, options.get(name))
        except ConfigError as error:
            problems += [problem for problem in error.problems if problem not in problems]
    for name in options:
        if models and name not in models:
            problems.append(f"model {name}: has options set but is not compared; add it to the models")
    if problems:
        raise ConfigError(problems)
    return {name: dict(options.get(name) or {}) for name in MODELS if not models or name in models}


def variants_for(scene, request):
    """Variants to compare with a material: each model, and the second readings reported beside it.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    request : dict of str to dict
        From `check_request`.

    Returns
    -------
    variants : list of Variant
    not_applicable : dict of str to str
        For each model that does not apply, the sentence why.
    """
    # Two readings of the papers that matter: see docs/models.md.
    beside = {"jacobian": "snell"} if scene.material.transmits else {"refraction_scale": "paper"}
    component = components_for(scene)[0]
    variants, not_applicable = [], {}
    for name, given in request.items():
        reason = MODELS[name].supports(scene, component)
        if reason is not None:
            not_applicable[name] = reason
            continue
        known = {info.name for info in describe_options(name)}
        variants.append(_variant(name, given))
        for option, value in beside.items():
            if option in known and option not in given:
                variants.append(_variant(name, {**given, option: value}))
    return variants, not_applicable


def components_for(scene):
    """The two components whose errors are reported, the main one first.

    The direct reflection is exact in some models and would hide all the rest under its highlight; so
    Bati et al. 2019 look at internal paths, and for slabs at the transmission.
    """
    if scene.material.transmits:
        return ("transmission", "reflection")
    if len(optical_stack(scene.material).material.interfaces) == 1:
        return ("reflection",)
    return ("reflection/internal", "reflection")


def _variant(name, given):
    default = find_model(name).options()
    chosen = parse_options(name, find_model(name).options, given)
    pairs = zip(dataclasses.asdict(chosen).items(), dataclasses.asdict(default).values(), strict=True)
    return Variant(name, tuple(pair for pair, usual in pairs if pair[1] != usual))
