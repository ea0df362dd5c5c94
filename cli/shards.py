"""One shard of a study, with signals and progress; and a study cut down to some of its materials."""

import contextlib
from dataclasses import replace
from pathlib import Path

from .jobs import prepare_kernels
from .options import overrides_of
from .policy import say
from .signals import StopSignals


def load(config, overrides, asked):
    """What a scene or study file describes with the changes of the command line, or the plan of a folder.

    Parameters
    ----------
    config : str
    overrides : list of goniosim.scene.Override
    asked : dict
        For `options.overrides_of`.

    Returns
    -------
    goniosim.scene.Config

    Raises
    ------
    ConfigError
        Also for changes of what is planned.
    """
    from goniosim.cluster import ShardPlan
    from goniosim.errors import ConfigError
    from goniosim.scene import Config, load_config, with_arguments

    if not Path(config).is_dir():
        return load_config(config, [*overrides, *overrides_of(asked)])
    plan = ShardPlan.read(config)
    if changes := [*overrides, *overrides_of({**asked, "threads": None})]:
        raise ConfigError(f"{config}: {changes[0].shown}: what is planned cannot be changed; make another plan")
    scenes = [with_arguments(scene, {"threads": asked.get("threads")}) for scene in plan.scenes]
    return Config(scenes, plan.study)


def only(described, names):
    """A study with some of its materials; all without names.

    Parameters
    ----------
    described : goniosim.scene.Config
    names : tuple of str

    Raises
    ------
    ConfigError
        If there is no such material.
    """
    from goniosim.errors import ConfigError
    from goniosim.scene.problems import closest

    known = [scene.material.name for scene in described.scenes]
    problems = []
    for name in names:
        if name not in known:
            meant = closest(name, known)
            problems.append(f"--only {name}: there is no such material" + (f"; did you mean {meant}?" if meant else ""))
    if problems:
        raise ConfigError(problems)
    chosen = [scene for scene in described.scenes if not names or scene.material.name in names]
    return replace(described, scenes=chosen)


def trace(described, text, output, time_limit, every, quiet, verbose):
    """Trace a shard; returns the exit code.

    Parameters
    ----------
    described : goniosim.scene.Config
    text : str
        Which, see `goniosim.cluster.parse_shard`.
    output : str or None
        Folder of the shards.
    time_limit : float or None
        Seconds.
    every : float
        Seconds between two checkpoints.
    quiet, verbose : bool
    """
    from goniosim.cluster import Division, ShardPlan, parse_shard, plan_of, run_shard
    from goniosim.errors import StoppedError
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation.forecast import effects_text

    folder = Path(output or f"{described.study or described.scenes[0].material.name}.shards")
    there = ShardPlan.find(folder)
    number, count = parse_shard(text, there and there.shards)
    plan = plan_of(folder, ShardPlan.make(described.scenes, described.study, count))
    progress = make_progress(Division(plan).rays(number), quiet)
    with StopSignals(time_limit) as signals, contextlib.closing(progress):

        def begin(task, claim):
            signals.gathering, signals.claim = False, claim
            label = f"{number}/{count} {task.scene.material.name}"
            if verbose:
                progress.note(effects_text(task.scene))
            prepare_kernels(task.scene, progress)

            def report(done, total):
                if not signals.gathering:
                    progress.begin(label, inherited=done)
                    signals.gathering = True
                progress.update(done, total)

            return report

        threads = described.scenes[0].simulation.threads
        try:
            given = {"threads": threads, "stop": signals.event, "every": every, "begin": begin, "note": progress.note}
            found = run_shard(folder, number, **given)
        except StoppedError:
            progress.note(f"stopped by {signals.reason} before the first rays")
            return signals.exit_code
        if signals.reason is not None:
            progress.note(f"stopped by {signals.reason}; the same command goes on")
    if not quiet:
        say(_summary(number, count, found))
    return signals.exit_code if signals.reason is not None else 0


def _summary(number, count, found):
    from goniosim.report.text import counted, duration

    lines = [f"shard {number} of {count}: {counted(len(found), 'file') if found else 'no work'}"]
    for task, standing in found:
        share = f"{100.0 * standing.done_rays / standing.total_rays:.3g} %" if standing.total_rays else "some"
        lines.append(f"  {task.name}: {share} of its light paths, {duration(standing.seconds)}")
    return "\n".join(lines)
