"""Every error a user can meet, each with its exit code.

The command line prints the message of a `GoniosimError` as one line (a
`ConfigError` may carry one line per mistake) and leaves with ``exit_code``;
a traceback appears only with ``--debug``.

====  =========================================================
code  meaning
====  =========================================================
0     success
1     an unexpected fault: a bug in goniosim; or a hard case failed
2     the command line itself is wrong (unknown option, ...)
3     the scene file or an override is wrong
4     the output cannot be written (permission, disk full, ...),
      something stands there that is not to be overwritten, another
      process is at work on it, or there is not enough memory
5     the file is not a goniosim result
6     the file is a goniosim result, but damaged
7     the file was written by a newer, incompatible goniosim
8     the result cannot be used for what was asked
9     a target was not reached within its limits; the result is in the
      output file
10    the operating system or an environment variable stands in the way
75    a simulation was stopped by a signal or its time limit: run it
      again, it goes on
129   another command was stopped: the terminal was closed (SIGHUP)
130   stopped by Ctrl-C; what was gathered is in the output file
143   another command was stopped by SIGTERM
====  =========================================================
"""

from collections.abc import Iterable

# No error: the result is complete, and kept.
TARGET_NOT_REACHED = 9


class GoniosimError(Exception):
    """Base of all errors that are explained to the user in one line."""

    exit_code = 1


class ConfigError(GoniosimError):
    """The scene file, or an override of it, is wrong.

    Parameters
    ----------
    problems : str or list of str
        One line for each mistake, all mistakes at once.
    """

    exit_code = 3

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = [problems] if isinstance(problems, str) else list(problems)
        super().__init__("\n".join(self.problems))


class OutputError(GoniosimError):
    """The output cannot be written.

    Parameters
    ----------
    message : str
    details : sequence of str
        Lines that stand before the message, where there is more than one thing to say.
    """

    exit_code = 4

    def __init__(self, message: str, details: Iterable[str] = ()) -> None:
        self.details = list(details)
        super().__init__(message)


class InUseError(OutputError):
    """Another process is at work on the output."""


class FewerRaysError(OutputError):
    """What stands at the output is worth more, of the same scene, than what should replace it.

    Parameters
    ----------
    path : path-like
    held, offered : str
        Rays per direction of either, in the mean.
    more : str
        What else there is to say of the two.

    Attributes
    ----------
    fact : str
        The message without its remedy.
    """

    def __init__(self, path: object, held: str, offered: str, more: str = "") -> None:
        facts = f"it holds {held} rays per direction of this scene, the new result {offered}{more}"
        self.fact = f"{path} stays as it is: {facts}"
        super().__init__(f"{self.fact}; choose another name, or allow overwriting")


class ResourceError(GoniosimError):
    """The machine has not enough memory for what was asked."""

    exit_code = 4


class ForeignFileError(GoniosimError):
    """The file is not a goniosim result."""

    exit_code = 5


class UnreadableFileError(ForeignFileError):
    """The file is there, but the operating system does not let it be read: nobody knows what is in it."""


class DamagedFileError(GoniosimError):
    """The file is a goniosim result whose content is truncated or altered."""

    exit_code = 6


class AnnotatedFileWarning(UserWarning):
    """Something was added to a file after it was written; all that goniosim wrote is unchanged."""


class NewerSchemaError(GoniosimError):
    """The file follows a schema version that this goniosim cannot read."""

    exit_code = 7


class StoppedError(GoniosimError):
    """The simulation was stopped before there was anything to keep."""

    exit_code = 130


class UnusableResultError(GoniosimError):
    """The file is sound, but it lacks what the command needs.

    Parameters
    ----------
    message : str
    details : sequence of str
        Lines that stand before the message, where there is more than one thing to say.
    """

    exit_code = 8

    def __init__(self, message: str, details: Iterable[str] = ()) -> None:
        self.details = list(details)
        super().__init__(message)


class RefusalError(GoniosimError):
    """The operating system refuses something, or an environment variable makes it impossible."""

    exit_code = 10
