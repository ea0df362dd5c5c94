"""Commands and options of other tools: what was perhaps meant by one that does not exist."""

import contextlib
import difflib

import click

# By command or option: other words for it, without hyphens.
COMMANDS = {
    "simulate": "run render sim trace measure start go",
    "check": "validate lint verify test predict estimate dryrun",
    "cost": "price prices pricelist accuracy budget",
    "plan": "schedule array shards",
    "submit": "sbatch qsub slurm batch launch",
    "status": "stat progress queue squeue jobs",
    "merge": "join reduce combine concatenate gather",
    "warmup": "compile precompile warm cache",
    "info": "ls list inspect describe summary print cat",
    "plot": "view show display draw figure figures picture image open",
    "compare": "evaluate eval diff benchmark rank error errors report",
    "models": "model",
    "hard": "selftest selfcheck edge cases catalogue catalog stress",
    "init": "new create template example examples quickstart",
    "--version": "version",
    "--help": "help man usage",
}
OPTIONS = {
    "--rays": "samples spp n nrays numrays nsamples photons r count",
    "--target": "tolerance tol rtol error maxerror relativeerror targeterror accuracy noise epsilon eps",
    "--of": "metric norm quantity",
    "--max-rays": "maxsamples maxspp raylimit",
    "--max-time": "timeout timelimit time budget timebudget maxseconds",
    "--walltime": "timeout timelimit time",
    "--shards": "tasks jobs array chunks",
    "--cpus": "cpuspertask cores threads ncpus",
    "--estimator": "method integrator algorithm e",
    "--threads": "nthreads numthreads workers cores jobs j t cpus processes",
    "--output": "out outfile outputfile outdir outputdir dir folder output",
    "--seed": "randomseed rng s",
    "--set": "define d override param parameter option",
    "--quiet": "silent noprogress",
    "--verbose": "loglevel log",
    "--overwrite": "force f clobber replace",
    "--theta": "angle angles thetadeg thetai direction",
    "--figures": "plots plot nofigures images",
    "--models": "model m",
    "--model": "models",
    "--format": "ext suffix filetype",
    "--subcells": "subsamples supersampling",
    "--json": "asjson machine",
}
# Commands and options for which there is no other word.
EXPLAINED = {
    **dict.fromkeys(("gpu", "cuda", "device"), "not available: rays are traced by the processor"),
    **dict.fromkeys(("resume", "continue"), "a study goes on where it stopped: run the same command again"),
    **dict.fromkeys(
        ("partition", "account", "qos", "mem", "constraint"), "options of sbatch stand behind --: -- --partition=long"
    ),
    **dict.fromkeys(("export", "convert"), "not available: results are HDF5 files, described in data_schema.md"),
    **dict.fromkeys(("config", "scene", "file", "input", "i"), "name the file behind the command, without an option"),
    "phi": "not available: layers look the same from every azimuth, and the light stands at phi = 0",
}


class HintingGroup(click.Group):
    """A group of commands that says what was perhaps meant by a word that it does not know."""

    def parse_args(self, ctx, args):
        """Parse what stands before the command."""
        with self._hinting():
            return super().parse_args(ctx, args)

    def invoke(self, ctx):
        """Run the command."""
        with self._hinting():
            return super().invoke(ctx)

    def resolve_command(self, ctx, args):
        """Find the command."""
        word = str(args[0])
        if self.get_command(ctx, word) is None and (hint := self._command_hint(word)):
            raise click.UsageError(f"No such command {word!r}: {hint}", ctx=ctx)
        return super().resolve_command(ctx, args)

    @contextlib.contextmanager
    def _hinting(self):
        try:
            yield
        except click.NoSuchOption as error:
            if hint := self._option_hint(error):
                raise click.UsageError(f"No such option {error.option_name!r}: {hint}", ctx=error.ctx) from None
            raise

    def _command_hint(self, word):
        lower = _normal(word)
        if word.lower().endswith((".yaml", ".yml")) or word == "-":
            return f"did you mean goniosim simulate {word}?"
        if word.lower().endswith((".h5", ".hdf5")):
            return f"did you mean goniosim info {word}?"
        if lower in EXPLAINED:
            return EXPLAINED[lower]
        known = [name for name in _meant(lower, COMMANDS) if name in (*self.commands, "--help", "--version")]
        known += difflib.get_close_matches(word.lower(), self.commands, n=1)
        return f"did you mean goniosim {known[0]}?" if known else None

    def _option_hint(self, error):
        word = _normal(error.option_name)
        if word in EXPLAINED:
            return EXPLAINED[word]
        if error.option_name in _options(self):
            return f"{error.option_name} stands before the command"
        meant = [*(option for option in OPTIONS if _normal(option) == word), *_meant(word, OPTIONS)]
        here = _options(error.ctx.command)
        # An option of this command goes before the same word elsewhere.
        if known := [option for option in meant if option in here]:
            return f"did you mean {known[0]}?"
        for option in (*meant, *difflib.get_close_matches(error.option_name, here, n=1)):
            if option in here:
                return f"did you mean {option}?"
            homes = [name for name, command in self.commands.items() if option in _options(command)]
            if homes:
                place = "stands behind" if error.ctx.command is self else "belongs to"
                return f"{option} {place} goniosim {' and '.join(filter(None, [', '.join(homes[:-1]), homes[-1]]))}"
        return None


def _meant(word, table):
    return [name for name, words in table.items() if word in words.split()]


def _normal(word):
    return word.replace("-", "").replace("_", "").lower()


def _options(command):
    return [name for parameter in command.params for name in parameter.opts]
