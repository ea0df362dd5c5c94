"""What a simulation will do and cost, before it is run."""

from dataclasses import asdict, dataclass

from ...scene.quantity import percent
from ...sums import BATCHES, BLOCKS
from .. import text
from . import target
from .losses import NOTEWORTHY_CAP, cap_remedy

# Seconds spent on probing one material, and on probing a whole study.
PROBE = 1.0
PROBE_STUDY = 12.0


@dataclass(frozen=True)
class Forecast:
    """Predicted cost of one material.

    Attributes
    ----------
    name : str
    directions : int
    simulation : goniosim.scene.Simulation
        What is asked for.
    rays_per_second, events_per_ray : float
        As measured.
    compile_seconds : float
        Time that compilation, or loading from the cache, took.
    n_bytes : int
        Upper estimate of the size of the result file.
    threads : int
    memory : goniosim.engine.memory.Memory
        Upper estimate of what is held in memory.
    shortage : str or None
        What is missing if that is more than is free here.
    estimators : list of str
        Which estimator serves which component, and why.
    gains : dict of str to float
        By component, how many times the processor time the analog estimator would take for the same noise.
    memory_to_plot, memory_to_compare : int
        Upper estimates of what the reports on the result take, `compare` with all models.
    probe_rays : int
        Rays of the probe, all directions together.
    lost_event_cap : float
        Largest share of the flux that it lost at the event cap.
    """

    name: str
    directions: int
    simulation: object
    rays_per_second: float
    events_per_ray: float
    compile_seconds: float
    n_bytes: int
    threads: int
    memory: object
    shortage: str | None
    estimators: list
    gains: dict
    memory_to_plot: int
    memory_to_compare: int
    probe_rays: int
    lost_event_cap: float

    @property
    def seconds(self):
        """Predicted time of tracing, without compilation; with a target the most that its limits allow, or None."""
        asked = self.simulation
        rays = asked.rays or asked.max_rays
        traced = None if rays is None else self.directions * rays / self.rays_per_second
        return min(filter(None, (traced, asked.max_time)), default=None)


def file_size(scene):
    """Upper estimate of the size of the result file of a scene, in bytes."""
    from goniosim.scene import components
    from goniosim.store import predicted_size

    names = components(scene)
    orders = (scene.simulation.orders or 0) * (len(names) - 1)
    arrays = predicted_size(
        len(scene.incident.theta_deg),
        3,
        scene.slice.rows,
        scene.slice.columns,
        len(names),
        orders,
        scene.slice.parametrization,
    )
    return arrays + size_of_batches(scene) + len(scene.to_yaml().encode())


def size_of_batches(scene):
    """Bytes of the batches of replicates that estimators other than analog keep, see `goniosim.sums`."""
    from goniosim.engine.rounds import FEWEST_PATHS
    from goniosim.scene import components

    asked = scene.simulation
    if asked.estimator == "analog" or (asked.estimator == "auto" and (asked.rays or FEWEST_PATHS) < FEWEST_PATHS):
        return 0
    blocks = min(scene.slice.rows, BLOCKS[0]) * min(scene.slice.columns, BLOCKS[1])
    sampled = len(components(scene)) - 1
    return 8 * BATCHES * 3 * blocks * len(scene.incident.theta_deg) * sampled * (1 + (asked.orders or 0))


def forecasts(scenes, gains=False):
    """Probe the speed of every scene for a moment.

    Parameters
    ----------
    scenes : list of Scene
    gains : bool
        Whether to try independent paths too, and tell what estimators gain over them.

    Returns
    -------
    list of Forecast
    """
    from goniosim.engine import estimators_of, memory_needed, probe, shortage, threads_of
    from goniosim.report.memory import memory_to_compare, memory_to_plot

    made = []
    for scene in scenes:
        short = shortage(scene)
        # What does not fit here may run elsewhere: its speed is that on slices of the usual size.
        tried = _usual_slices(scene) if short else scene
        measured = probe(tried, min(PROBE, PROBE_STUDY / len(scenes)), gains)
        made.append(
            Forecast(
                name=scene.material.name,
                directions=len(scene.incident.theta_deg),
                simulation=scene.simulation,
                rays_per_second=measured.rays_per_second,
                events_per_ray=measured.events_per_ray,
                compile_seconds=measured.compile_seconds,
                n_bytes=file_size(scene),
                threads=threads_of(scene),
                memory=memory_needed(scene),
                shortage=short,
                estimators=estimators_of(scene),
                gains=measured.gains,
                memory_to_plot=memory_to_plot(scene),
                memory_to_compare=memory_to_compare(scene),
                probe_rays=measured.rays,
                lost_event_cap=measured.lost_event_cap,
            )
        )
    return made


def _usual_slices(scene):
    simulation = scene.simulation.model_copy(update={"orders": None})
    usual = type(scene.slice)(parametrization=scene.slice.parametrization)
    return scene.model_copy(update={"slice": usual, "simulation": simulation})


def effects_text(scene):
    """List the effects that a scene calls for, and those it does without, each with the reason."""
    from goniosim.scene import absent_interfaces, effects

    found = effects(scene)
    width = max(len(effect.name) for effect in found)
    blocks = []
    for heading, wanted in (("Called for", True), ("Absent, and so without cost", False)):
        lines = [f"  {e.name.ljust(width)}   {e.why}" for e in found if e.active == wanted]
        if lines:
            blocks.append("\n".join([heading, *lines]))
    idle = [f"Note: {sentence}." for sentence in absent_interfaces(scene)]
    if idle:
        blocks.append("\n".join(idle))
    return "\n".join([_heading(scene), "\n\n".join(blocks)])


def cost_text(made):
    """Tell the predicted time and file size: in words for one material, as a table for a study."""
    compilation = sum(forecast.compile_seconds for forecast in made)
    if len(made) == 1:
        (one,) = made
        lines = [
            f"Predicted, from a probe of about {text.duration(PROBE)}",
            *(f"  estimator   {line}" for line in one.estimators),
            *(
                f"  gain        {name}: analog takes {gain:.2g} times the CPU time for the same noise"
                for name, gain in one.gains.items()
            ),
            f"  speed       {text.rate(one.rays_per_second)}, {one.events_per_ray:.1f} events per ray",
            f"  time        {_time(one)}",
            f"  file size   at most {text.size(one.n_bytes)}",
            f"  memory      at most {text.size(one.memory.peak)} on {text.counted(one.threads, 'thread')}: "
            + ", ".join(f"{name} {text.size(n_bytes)}" for name, n_bytes in _largest(one.memory)),
            f"  report      at most {text.size(one.memory_to_plot)} of memory for plot, "
            f"{text.size(one.memory_to_compare)} for compare with all models",
        ]
    else:
        header = ["material", "rays or target", "speed", "time", "file at most", "memory"]
        rows = [
            [
                one.name,
                _asked(one),
                text.rate(one.rays_per_second),
                _duration(one.seconds),
                text.size(one.n_bytes),
                text.size(one.memory.peak),
            ]
            for one in made
        ]
        seconds, n_bytes = _total(one.seconds for one in made), sum(one.n_bytes for one in made)
        peak, compared = (max(one.memory.peak for one in made), max(one.memory_to_compare for one in made))
        lines = [
            f"{len(made)} materials, all valid; speeds from short probes",
            *text.table(header, rows),
            f"  Together: {_duration(seconds)}, at most {text.size(n_bytes)} on disk and, at a time, "
            f"{text.size(peak)} of memory;",
            f"  compare with all models takes at most {text.size(compared)} of memory.",
        ]
    lines += [_event_cap(one) for one in made if one.lost_event_cap >= NOTEWORTHY_CAP]
    lines += [f"  Warning: memory: {one.name} does not fit here: {one.shortage}" for one in made if one.shortage]
    if compilation > 1.0:
        lines.append(f"  Compilation took {text.duration(compilation)}; it is kept for the next run.")
    return "\n".join(lines)


def _time(one):
    if one.simulation.target is None:
        return f"{text.duration(one.seconds)} for {one.directions} x {text.count(one.simulation.rays)} rays"
    until = f"until {one.simulation.target} is reached"
    return until if one.seconds is None else f"{until}, at most {text.duration(one.seconds)}"


def _asked(one):
    simulation = one.simulation
    return text.count(one.directions * simulation.rays) if simulation.target is None else str(simulation.target)


def _duration(seconds):
    return "as it takes" if seconds is None else text.duration(seconds)


def _total(seconds):
    """Sum of times, None if one of them is."""
    seconds = list(seconds)
    return None if None in seconds else sum(seconds)


def _largest(memory):
    """The two parts of the peak that take most, besides the program."""
    phase = max(memory.phases, key=lambda names: sum(getattr(memory, name) for name in names))
    parts = sorted(((getattr(memory, name), name) for name in phase[1:]), reverse=True)
    return [(name, n_bytes) for n_bytes, name in parts[:2]]


def _event_cap(one):
    # Each work unit of the probe has less rays than one of a long run, which loses a smaller share.
    return (
        f"  Warning: event cap: {one.name} traps light between interfaces; of the {text.count(one.probe_rays)} rays of "
        f"the probe up to {percent(one.lost_event_cap)} were cut and lost; {cap_remedy(one.simulation.rays or 0)}"
    )


def as_dict(scene, one):
    """What `check` says of a material, for programs: plain numbers in base units.

    Parameters
    ----------
    scene : Scene
    one : Forecast

    Returns
    -------
    dict
    """
    from goniosim.scene import absent_interfaces, effects

    return {
        "name": one.name,
        "directions": one.directions,
        **one.simulation.model_dump(include={"rays", "target", "max_rays", "max_time", "estimator"}),
        "threads": one.threads,
        "seconds": one.seconds,
        "rays_per_second": one.rays_per_second,
        "events_per_ray": one.events_per_ray,
        "compile_seconds": one.compile_seconds,
        "file_bytes": one.n_bytes,
        "memory_bytes": one.memory.peak,
        "memory": asdict(one.memory),
        "memory_shortage": one.shortage,
        "estimators": one.estimators,
        "estimator_gains": one.gains,
        "report_memory_bytes": {"plot": one.memory_to_plot, "compare": one.memory_to_compare},
        "effects": {effect.name: {"active": effect.active, "why": effect.why} for effect in effects(scene)},
        "absent_interfaces": absent_interfaces(scene),
        "probe_rays": one.probe_rays,
        "lost_event_cap": one.lost_event_cap,
    }


def study_as_dict(name, scenes, made):
    """What `check` says of a study, for programs: totals, and the peak of memory, which is not a sum."""
    materials = [as_dict(scene, one) for scene, one in zip(scenes, made, strict=True)]
    totals = {key: _total(each[key] for each in materials) for key in ("seconds", "compile_seconds", "file_bytes")}
    return {
        "name": name,
        **totals,
        "memory_bytes": max(each["memory_bytes"] for each in materials),
        "report_memory_bytes": {
            report: max(each["report_memory_bytes"][report] for each in materials) for report in ("plot", "compare")
        },
        "materials": materials,
    }


def _heading(scene):
    chosen = scene.slice
    angles = ", ".join(text.angles(scene.incident.theta_deg))
    return "\n".join(
        [
            f"{scene.material.name}: valid",
            f"  incident theta [deg]: {angles}",
            f"  {chosen.parametrization} slices, {chosen.rows} x {chosen.columns} cells",
            f"  {target.asked(scene.simulation)}, seed {scene.simulation.seed}",
            "",
        ]
    )
