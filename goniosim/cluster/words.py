"""What a plan of shards, and the state that they are in, look like as text."""

from goniosim.cluster.shard import array_list
from goniosim.cluster.status import Stage
from goniosim.report import text
from goniosim.report.simulation import study
from goniosim.report.simulation.forecast import effects_text

# Errors of shards that are shown: the others are in their files.
MOST_SHOWN = 10


def outlook_text(outlook):
    """Tell what a study takes as a job array.

    Parameters
    ----------
    outlook : goniosim.cluster.outlook.Outlook

    Returns
    -------
    str
    """
    expected, plan = outlook.expected, outlook.plan
    header = ["material", "rays or target", "speed", "time", "file at most", "memory"]
    rows = [
        [
            one.scene.material.name,
            _asked(one.scene),
            text.rate(one.rays_per_second),
            "as it takes" if one.seconds is None else text.duration(one.seconds),
            text.size(one.file_bytes),
            text.size(one.n_bytes),
        ]
        for one in expected
    ]
    left, results = outlook.disk
    lines = [
        *([effects_text(expected[0].scene), ""] if plan.study is None else []),
        f"Predicted for tasks with {text.counted(outlook.cpus, 'processor')}, from short probes on this machine",
        *text.table(header, rows),
        f"  time     {text.duration(outlook.seconds)} in all, one task after the other{_unknown(expected)}",
        f"  memory   at most {text.size(outlook.n_bytes)} for each task",
        f"  disk     at most {text.size(left)} for shards and {text.size(results)} for results",
        f"  shards   {plan.shards}, each about {text.duration(outlook.each)}; "
        f"a task may take {text.duration(outlook.walltime)}",
    ]
    if plan.has_targets and plan.shards > len(plan.scenes):
        lines.append(
            f"  Warning: a material with a target is never cut: {len(plan.scenes)} shards are all that have work"
        )
    if outlook.each > outlook.walltime:
        lines.append(
            "  Warning: a shard takes longer than a task may: tasks will stop and queue again until all is done"
        )
    lines += [
        f"  Warning: memory: {one.scene.material.name} does not fit here: {one.shortage}"
        for one in expected
        if one.shortage
    ]
    return "\n".join(lines)


def _asked(scene):
    simulation = scene.simulation
    if simulation.target is not None:
        return str(simulation.target)
    return f"{len(scene.incident.theta_deg)} x {text.count(simulation.rays)}"


def _unknown(expected):
    number = sum(one.seconds is None for one in expected)
    return f" (of {number} that stop at a target nobody knows: taken for the mean of the others)" if number else ""


def status_text(status, results):
    """Tell how far shards are.

    Parameters
    ----------
    status : goniosim.cluster.status.Status
    results : dict of Path to goniosim.result.Result
        What is merged.

    Returns
    -------
    str
    """
    plan = status.plan
    name = plan.study or plan.scenes[0].material.name
    done, total = (sum(getattr(shard, rays) for shard in status.shards) for rays in ("done_rays", "total_rays"))
    lines = [f"{name}: {text.counted(plan.shards, 'shard')}"]
    for stage in Stage:
        shards = status.of(stage)
        if shards:
            lines.append(f"  {stage.value:<8} {len(shards):>5}   {array_list([shard.number for shard in shards])}")
        lines += [f"    {shard.number}: {shard.why}" for shard in shards if shard.why][:MOST_SHOWN]
    if total:
        lines.append(f"  rays     {text.count(done)} of {text.count(total)} ({100.0 * done / total:.3g} %)")
    if status.noise is not None:
        lines.append(f"  noise    at most {status.noise:.2g} sr^-1/2 in the slices that were begun")
    lines.append(f"  left     {_left(status, results)}")
    if results:
        rows = [study.row(result, path) for path, result in results.items()]
        lines += ["", f"Merged, in {next(iter(results)).parent}", study.study_text(rows)]
    return "\n".join(lines)


def status_as_data(status, results):
    """What `status_text` tells, for programs.

    Parameters
    ----------
    status : goniosim.cluster.status.Status
    results : dict of Path to goniosim.result.Result

    Returns
    -------
    dict
    """
    plan = status.plan
    return {
        "name": plan.study or plan.scenes[0].material.name,
        "shards": plan.shards,
        **{stage.value: [shard.number for shard in status.of(stage)] for stage in Stage},
        "errors": {str(shard.number): shard.why for shard in status.shards if shard.why},
        "rays_done": sum(shard.done_rays for shard in status.shards),
        "rays_planned": sum(shard.total_rays for shard in status.shards),
        "noise": status.noise,
        "seconds_left": status.seconds_left(status.shards),
        "results": {
            result.name: {"file": str(path), "status": result.status, "noise": study.noise(result)}
            for path, result in results.items()
        },
    }


def _left(status, results):
    """The time that is left, of all and of the shards that run."""
    unfinished = [shard for shard in status.shards if shard.stage is not Stage.DONE]
    if not unfinished:
        return "nothing" if results else "nothing: merge them"
    work, longest = status.seconds_left(unfinished), max(status.seconds_left([shard]) or 0.0 for shard in unfinished)
    if work is None:
        return "nobody can tell yet"
    return f"{text.duration(work)} in all, {text.duration(longest)} for the shard that takes longest"
