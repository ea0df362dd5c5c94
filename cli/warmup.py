"""`goniosim warmup`: compiled code in its cache before a run needs it."""

import click

from .options import PATH
from .policy import debug_option, say, say_error
from .signals import tidied_up


@click.command()
@click.argument("config", type=PATH, required=False)
@debug_option
def warmup(config):
    """Compile for this machine and keep the result in the cache.

    CONFIG is a scene or study file, the folder of a plan, or - for the standard input: what its simulation
    takes is compiled; without it, the kernels of all estimators. Several at once, as in the jobs of one node, compile
    nothing twice: the others wait, and load what the first has made. The cache is below NUMBA_CACHE_DIR,
    if that is set, or in the home folder.

    \b
    Examples: goniosim warmup study.yaml
              NUMBA_CACHE_DIR=/tmp/mine goniosim warmup
    """  # noqa: D301
    from goniosim._jit.folder import notices
    from goniosim.cluster.warmup import keep_warm, of_all_estimators
    from goniosim.report.text import counted, duration

    from . import shards

    scenes = of_all_estimators() if config is None else shards.load(config, [], {}).scenes
    with tidied_up():
        made = keep_warm(scenes)
    for notice in notices:
        say_error(f"note: {notice}")
    if made.compiled:
        what = f"{counted(made.compiled, 'kernel')} compiled in {duration(made.seconds)}"
    else:
        what = f"all kernels were compiled before: loaded in {duration(made.seconds)}"
    waited = f", after waiting {duration(made.waited)} for another process" if made.waited > 1.0 else ""
    say(f"{what}{waited}\n  cache   {made.folder} ({counted(made.kernels, 'kernel')})")
