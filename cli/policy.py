"""What the user sees of an error: a line on standard error and an exit code; with --debug, the traceback."""

import sys
import traceback
import warnings

import click

from goniosim.errors import AnnotatedFileWarning, ConfigError, GoniosimError, RefusalError, ResourceError
from goniosim.provenance import commanded
from goniosim.writing import printable

from . import streams
from .hints import HintingGroup

_DEBUG = "goniosim_cli.debug"


def _remember(ctx, param, value):
    if value:
        ctx.meta[_DEBUG] = True


# Accepted before and after the name of the command, so it belongs to both.
debug_option = click.option(
    "--debug",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_remember,
    help="Show the traceback of an error.",
)


class PolicyGroup(HintingGroup):
    """A group of commands that explains the errors of all of them in the same way."""

    def main(self, args=None, *arguments, **options):
        """Run the command line, whatever state the standard streams are in."""
        args = sys.argv[1:] if args is None else list(args)
        with streams.guarded(), commanded(args):
            return super().main(args, *arguments, **options)

    def invoke(self, ctx):
        """Run a command and leave with the exit code of whatever goes wrong."""
        try:
            with warnings.catch_warnings():
                _say_what_was_annotated()
                return super().invoke(ctx)
        except (click.exceptions.Exit, click.ClickException, click.Abort):
            raise
        except KeyboardInterrupt:
            say_error("interrupted")
            ctx.exit(130)
        except Exception as error:
            if ctx.meta.get(_DEBUG):
                say("".join(traceback.format_exception(error)).rstrip("\n"), err=True)
            error = _understood(error)
            for line in _lines(error):
                click.echo(printable(line), err=True)
            ctx.exit(getattr(error, "exit_code", 1))


def say_error(message):
    """Print one line on standard error."""
    click.echo(f"goniosim: {printable(message)}", err=True)


def say(text, err=False):
    """Print text that may hold names from files: whatever a terminal would obey is written out."""
    click.echo("\n".join(map(printable, str(text).split("\n"))), err=err)


def _say_what_was_annotated():
    usual = warnings.showwarning

    def show(message, category, *place):
        if issubclass(category, AnnotatedFileWarning):
            say_error(f"note: {message}")
        else:
            usual(message, category, *place)

    warnings.simplefilter("always", AnnotatedFileWarning)
    warnings.showwarning = show


def _understood(error):
    """What the operating system refuses is no bug, wherever it comes up."""
    if isinstance(error, OSError):
        from goniosim.writing import reason, remedy

        if isinstance(error, FileNotFoundError) and error.filename is None:
            # What `os.getcwd` says.
            return RefusalError("the current folder is gone: change to another (cd)")
        where = f"{error.filename}: " if error.filename is not None else ""
        return RefusalError(f"{where}{reason(error)}; {remedy(error)}")
    if isinstance(error, MemoryError):
        return ResourceError("memory ran out; close other programs, or give fewer or smaller files at a time")
    return error


def _lines(error):
    if isinstance(error, ConfigError):
        n = len(error.problems)
        return [*error.problems, f"goniosim: error: {n} mistake{'s' if n > 1 else ''}"]
    if isinstance(error, GoniosimError):
        return [*getattr(error, "details", ()), f"goniosim: error: {error}"]
    what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    what = " ".join(what.split())
    return [f"goniosim: error: {what} - this is a bug in goniosim; rerun with --debug to see where"]
