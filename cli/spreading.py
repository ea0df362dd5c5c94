"""The materials of one command in shards, on workers of dask: traced, merged, and the shards removed."""

_INSTALL = 'pip install "goniosim[dask]"'


def run(address, described, planned, todo, output, progress, signals, overwrite, every):
    """Simulate on workers of dask and merge, yielding each (job, result) once its file stands; end early when stopped.

    Parameters
    ----------
    address : str
        See `goniosim.cluster.on_dask.dask_executor`.
    described : goniosim.scene.Config
    planned, todo : list of goniosim_cli.jobs.Job
        All, and those whose files do not hold what is asked for.
    output : Path
        Result file, or the folder of a study's files.
    progress : goniosim.report.progress
    signals : goniosim_cli.signals.StopSignals
    overwrite : bool
    every : float
        Seconds between two checkpoints of a shard.
    """
    from goniosim.cluster import merge, plan_of, remove_shards, shards_folder, spread
    from goniosim.scene import total_rays

    dask_executor = _dask_executor()
    if not todo:
        return
    folder, given = shards_folder(output), described.scenes[0].simulation.threads
    threads, whole = given or 1, total_rays(job.scene for job in todo)
    with dask_executor(address, threads) as (executor, slots):
        plan = plan_of(folder, _asked(described, todo, folder, slots, address))

        def report(done, total):
            if not signals.gathering:
                progress.note(f"{plan.shards} shards, which lie in {folder} until they are merged")
                progress.begin(f"{plan.shards} shards", inherited=done)
                signals.gathering = True
            # Of shards, with the work on further components, told in rays of the scenes.
            progress.update(done if total is None or whole is None else whole * done // max(total, 1), whole)

        asked = {"threads": threads, "stop": signals.event, "every": every}
        spread(folder, executor, progress=report, note=progress.note, **asked)
    jobs = {job.path: job for job in planned}
    if signals.reason is None:
        for result, path in merge(folder, output, overwrite=overwrite, threads=given, note=progress.note):
            yield jobs[path], result
            if signals.reason is not None:
                break
        else:
            remove_shards(folder)
    if signals.reason is not None:
        progress.note(f"stopped by {signals.reason}: what is done stays in {folder}; the same command goes on")


def _asked(described, todo, folder, slots, address):
    """What is to be in shards: what is missing, with what was missing when a run began that was interrupted."""
    from goniosim.cluster import ShardPlan
    from goniosim.cluster.spreading import SHARDS_PER_THREAD
    from goniosim.errors import RefusalError

    there = ShardPlan.find(folder)
    if there is None and not slots:
        raise RefusalError(
            f"--dask {address}: it has no workers; start some, which tells how many shards are worthwhile"
        )
    names = {job.name for job in todo} | {scene.material.name for scene in (there.scenes if there else ())}
    count = there.shards if there else SHARDS_PER_THREAD * slots
    return ShardPlan.make([s for s in described.scenes if s.material.name in names], described.study, count)


def _dask_executor():
    from goniosim.errors import RefusalError

    try:
        from goniosim.cluster.on_dask import dask_executor
    except ModuleNotFoundError as error:
        raise RefusalError(f"--dask needs distributed, an optional part: {_INSTALL} ({error})") from error
    return dask_executor
