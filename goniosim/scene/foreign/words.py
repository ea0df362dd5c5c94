"""The table of foreign words: what each means here, by the place in a scene where it stands.

Case, underscores and hyphens do not matter. A word that goniosim itself uses at a place needs no entry.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from goniosim.scene.foreign import values


@dataclass(frozen=True)
class Meaning:
    """What some words stand for.

    Attributes
    ----------
    words : str
        With blanks between.
    message : str
        What to tell whoever uses one of them.
    key : str or None
        The key to use instead; None where there is none.
    value : callable
        ``value(value, siblings)``: the value under that key, from the foreign one and those beside
        it, or None if it cannot be told.
    """

    words: str
    message: str
    key: str | None = None
    value: Callable[[Any, Mapping[str, Any]], Any] = values.unchanged


def _called(key: str, why: str, words: str, value: Callable[..., Any] = values.unchanged) -> Meaning:
    """Words for what goniosim calls ``key``."""
    return Meaning(words, f"unknown key; {why}", key, value)


def _needless(why: str, words: str) -> Meaning:
    """Words for what is given otherwise, or not at all."""
    return Meaning(words, f"unknown key; {why}")


def _lacking(why: str, words: str) -> Meaning:
    """Words for what goniosim cannot do yet."""
    return Meaning(words, f"not available: {why}")


_ETA = "eta is the absolute refractive index below the interface"
_TAU = "tau is the optical depth of one crossing, tau = sigma_a * thickness"
_THETA = "theta_deg lists the angles of incidence from the normal, in degrees"
_MEDIUM = "absorption belongs to a medium: write `- medium: {tau: ...}`"
_TITLE = "title id label"
_AIM = "{target: {relative_error: 1%}, max_time: 10m}"
_SPECTRA = _lacking(
    "there are three channels, R, G and B; give a number for each",
    "wavelength wavelengths wavelength_nm lambda spectrum spectra spectral dispersion abbe cauchy",
)
_UNIFORM = _lacking("layers are the same at every point", "normal_map bump_map texture displacement opacity")

KEYS: dict[str, tuple[Meaning, ...]] = {
    "scene": (
        _called("incident", "the light is called incident", "light lights source emitter illumination incidence"),
        _called("simulation", "rays and seed belong to simulation", "sampling settings integrator options sampler"),
        _called("slice", "the cells are those of a slice", "grid sensor detector film output resolution cells bins"),
        _called("material", "the stack of layers is called a material", "bsdf sample stack"),
        _needless("several materials make a study: write study: {name: ..., materials: [...]}", "materials"),
        _needless("layers and a name belong to material", "layers name"),
        _needless("angles belong to incident: {theta_deg: [...]}", "theta_deg theta angles"),
        _needless("this belongs to simulation: {rays: ..., seed: ...}", "rays samples spp seed threads estimator"),
        _needless(f"this belongs to simulation: {_AIM}", "target tolerance accuracy max_rays max_time time_limit"),
        _SPECTRA,
    ),
    "study": (
        _called("cross", "the axes of a study are crossed", "axes sweep product vary parameters grid"),
        _called("material", "the template of a crossed study is called material", "template base"),
        _called("name", "the name of a study is that of its folder", _TITLE),
    ),
    "material": (
        _called("layers", "layers are listed from top to bottom", "stack interfaces coatings structure"),
        _called("name", "the name of a material is that of its result file", _TITLE),
        _needless("a material has no type: its interfaces have", "type bsdf"),
        _UNIFORM,
        _SPECTRA,
    ),
    "layer": (
        _called("interface", "a boundary is called an interface", "boundary coating coat base substrate surface bsdf"),
        _called("medium", "what lies between two interfaces is called a medium", "volume absorber interior filling"),
        _needless(_MEDIUM, "sigma_a sigma_t absorption thickness depth"),
        _needless("write `- interface: {type: ..., ...}`", "dielectric conductor lambert metal diffuse glass"),
    ),
    "type": (_called("type", "what an interface is, its type says", "kind model bsdf material class"),),
    "interface": (
        _called("eta", _ETA, "ior n index refractive_index index_of_refraction int_ior ri eta_i eta_t eta_int n_real"),
        _called(
            "alpha",
            "alpha is the GGX width, alpha = roughness^2",
            "roughness linear_roughness perceptual_roughness rough",
            values.squared,
        ),
        _called(
            "alpha",
            "alpha is the GGX width, alpha = (1 - glossiness)^2",
            "glossiness gloss smoothness",
            values.one_minus_squared,
        ),
        _called("alpha", "alpha is the GGX width", "alpha_g alpha_ggx ggx_alpha ggx roughness_alpha width m"),
        _needless("above lies what the interface above says, and air on top", "ext_ior eta_ext n_ext"),
        _needless(_MEDIUM, "tau thickness depth sigma_a sigma_t absorption interior medium"),
        _needless("the reflection follows from eta and kappa", "specular specular_reflectance f0 fresnel"),
        _lacking(
            "roughness is the same in all directions; give one alpha",
            "alpha_x alpha_y alpha_u alpha_v roughness_x roughness_y roughness_u roughness_v anisotropy anisotropic",
        ),
        _lacking("a choice of distribution; every rough interface is GGX: remove this key", "distribution ndf"),
        _lacking("a choice of masking; it is that of Smith, separable", "masking shadowing geometry"),
        _lacking("media absorb and do not scatter; nor do interfaces know a phase function", "g phase_function hg"),
        _lacking("layers do not interfere", "thin_film thin_film_thickness film_thickness iridescence"),
        _lacking("interfaces are dielectric, conductor or lambert", "sheen clearcoat subsurface transmission metallic"),
        _UNIFORM,
        _SPECTRA,
    ),
    "dielectric": (
        _needless(
            "a dielectric does not absorb; put a medium with tau below it, or use a conductor",
            "k kappa eta_k",
        ),
    ),
    "conductor": (
        _called(
            "kappa",
            "kappa is the imaginary part of the absolute refractive index",
            "k extinction extinction_coefficient eta_k eta_imag n_imag",
        ),
        _needless("the colour of a conductor follows from eta and kappa", "reflectance albedo rho color base_color"),
    ),
    "lambert": (
        _called(
            "rho",
            "rho is the fraction of the light that a lambert base sends back",
            "reflectance albedo diffuse_reflectance diffuse_albedo diffuse color colour base_color kd r reflectivity",
        ),
    ),
    "medium": (
        _called(
            "tau",
            _TAU,
            "sigma_a sigma_t mu_a absorption absorption_coefficient extinction attenuation",
            values.absorption_times_thickness,
        ),
        _called("tau", _TAU, "thickness depth d distance height length", values.absorption_times_thickness),
        _called("tau", "tau is the optical depth of one crossing", "optical_depth optical_thickness od"),
        _called(
            "tau",
            "tau is the optical depth of one crossing, tau = -ln(transmittance)",
            "transmittance transmission",
            values.minus_log,
        ),
        _needless("the index of a medium is eta of the interface above it", "eta ior n index refractive_index int_ior"),
        _needless("tau is the optical depth, tau = 4 pi k * thickness / wavelength", "k kappa"),
        _lacking(
            "media absorb and do not scatter; give tau",
            "g sigma_s mu_s albedo single_scattering_albedo scattering phase phase_function anisotropy hg",
        ),
        _SPECTRA,
    ),
    "incident": (
        _called("theta_deg", _THETA, "theta thetas theta_i theta_in angle angles angles_deg zenith", values.as_list),
        _called("theta_deg", f"{_THETA}, 180/pi of a radian", "theta_rad angles_rad", values.degrees_as_list),
        _needless(f"{_THETA}: 90 minus the elevation", "elevation"),
        _lacking(
            "layers look the same from every azimuth, and the light stands at phi = 0",
            "phi phi_deg phi_i phi_in phi_l azimuth azimuths",
        ),
        _lacking("light is unpolarised at every event", "polarization polarisation stokes"),
        _needless("results are relative to the incident flux", "power intensity radiance irradiance flux"),
        _SPECTRA,
    ),
    "slice": (
        _called("rows", "rows divide the elevation", "n_theta theta_bins theta_res theta_v n_rows num_theta height"),
        _called("columns", "columns divide the azimuth", "n_phi phi_bins phi_res phi_v n_columns num_phi cols width"),
        _called("parametrization", "the choice of cells is called parametrization", "type kind mode mapping"),
        _needless("give rows, for the elevation, and columns, for the azimuth", "resolution size bins shape"),
    ),
    "simulation": (
        _called(
            "rays",
            "rays is the number of rays for each incident direction",
            "samples spp n n_rays num_rays rays_per_direction n_samples num_samples sample_count samples_per_pixel "
            "photons paths",
        ),
        _called(
            "threads",
            "each thread uses a core",
            "n_threads num_threads workers num_workers cores n_cores n_jobs",
        ),
        _called("seed", "seed is that of the random numbers", "random_seed rng_seed rng"),
        _called("estimator", "the method is called estimator", "method integrator algorithm type technique"),
        _called(
            "target",
            "to stop at an accuracy, write target: {relative_error: 1%} instead of rays",
            "target_error target_accuracy relative_error rel_error max_error tolerance rtol accuracy error noise "
            "noise_level noise_threshold adaptive_threshold stop_at goal",
            values.as_target,
        ),
        _called(
            "max_rays",
            "max_rays limits a target",
            "max_samples max_spp max_n_rays max_paths ray_limit",
        ),
        _called(
            "max_time",
            "max_time limits a target",
            "time time_limit timeout time_budget budget max_seconds seconds duration walltime",
        ),
        _called("orders", "orders splits the result by events on the top interface", "n_orders max_order"),
        _needless("rays walk until they leave or are absorbed", "depth max_depth bounces max_bounces rr_depth"),
        _needless("the file is chosen on the command line, by -o", "output out output_file file"),
        _lacking("rays are traced by the processor, in double precision", "gpu device backend dtype float32 precision"),
        _SPECTRA,
    ),
    "target": (
        _called(
            "relative_error",
            "relative_error is a standard error over what it is the error of: 1% or 0.01",
            "error rel_error rel tolerance rtol value level noise accuracy stderr threshold",
        ),
        _called("of", "what the error is of", "what quantity metric measure kind type norm"),
        _needless("limits stand beside target: {max_rays: ..., max_time: ...}", "max_rays max_time time timeout"),
    ),
}

# The choices of `simulation.estimator` and of `target.of`.
ESTIMATORS = {
    "auto": "automatic default best adaptive optimal",
    "analog": "analogue plain naive brute_force random_walk path path_tracing unidirectional independent reference",
    "split": "splitting split_walk branching roulette",
    "operator": "operators adding_doubling adding matrix",
    "connection": "connect connections next_event next_event_estimation nee bidirectional bdpt",
}
OF = {
    "slice": "slices image brdf btdf bsdf norm rms rmse",
    "albedo": "energy flux total reflectance transmittance",
    "cells": "cell pixel pixels bin bins",
}

# Names of types: the type as which the rest of the interface is read, or None for what no single one can be.
TYPES: tuple[tuple[str | None, str, str], ...] = (
    (
        "conductor",
        "a metal is a conductor, of absolute index eta + i kappa",
        "metal metallic mirror roughconductor smoothconductor gold silver copper aluminium aluminum",
    ),
    ("lambert", "a diffuse base is called lambert", "diffuse lambertian matte"),
    (
        "dielectric",
        "what lets light in is a dielectric, rough by its alpha",
        "glass roughdielectric smoothdielectric thindielectric coat coating clearcoat varnish water",
    ),
    (None, "a plastic is two layers, a dielectric coat over a lambert base", "plastic roughplastic smoothplastic"),
    (None, "a dielectric or conductor is GGX-rough by its alpha", "ggx microfacet rough"),
    (
        None,
        "others are not available",
        "principled disney openpbr standard_surface oren_nayar roughdiffuse hair sheen velvet translucent subsurface "
        "beckmann phong ward normalmap",
    ),
)

# The two choices of `slice.parametrization`.
PARAMETRIZATIONS = {
    "half": "rusinkiewicz half_angle half_vector halfway theta_h",
    "classic": "standard spherical regular uniform theta_phi polar",
}

# Refractive indices in yellow light, rounded: only to say what a number looks like.
INDICES = {
    "air": 1.0,
    "vacuum": 1.0,
    "water": 1.33,
    "acrylic": 1.49,
    "glass": 1.5,
    "polycarbonate": 1.58,
    "diamond": 2.42,
}


def normal(word: str) -> str:
    """A word without what differs between tools: case, underscores, hyphens."""
    return re.sub(r"[\W_]", "", word).lower()


_MEANINGS = {
    place: {normal(word): meaning for meaning in meanings for word in meaning.words.split()}
    for place, meanings in KEYS.items()
}


def meaning(word: str, places: tuple[str, ...]) -> Meaning | None:
    """What a word stands for at the first of some places that knows it, or None.

    Parameters
    ----------
    word : str
    places : tuple of str
        Keys of `KEYS`; others hold no foreign words.
    """
    found = (_MEANINGS.get(place, {}).get(normal(word)) for place in places)
    return next(filter(None, found), None)
