"""The folder of a report: built aside and put in place at the end, over an earlier report but over nothing else."""

import contextlib
import errno
import json
import os
import re
from pathlib import Path

from ...errors import ForeignFileError, GoniosimError, OutputError, UnusableResultError
from ...parts import Part, remove_dead, turn
from ...store import read_header
from ...writing import explained, make_folder
from ..drawing.files import is_figure
from . import files

FIGURES, MODELS = "figures", "models.h5"
TABLES = (MODELS, files.CSV, files.JSON)
_FIGURE = re.compile(rf"{FIGURES}/[^./][^/]*\.(?:png|svg)")
_OTHER_PLACE = "write the report into another folder with -o"


class ReportFolder:
    """A report in the making.

    Parameters
    ----------
    folder : Path
        Where it will stand: a folder that does not exist, is empty, holds results, or an earlier report and whatever
        somebody put beside that. Only files that the earlier report lists are replaced or removed.
    materials : list of str
        As their figures are named.

    Attributes
    ----------
    building : Path
        Where to write meanwhile.

    Raises
    ------
    OutputError
        The folder holds something else, or takes no new file.
    """

    def __init__(self, folder, materials):
        self._shown = folder
        self._folder = Path(os.path.realpath(folder))
        # Asking may fail too: the name may be too long.
        with explained(folder):
            exists = self._folder.exists()
        if exists and not self._folder.is_dir():
            raise OutputError(f"{folder}: is not a folder; choose another place: {_OTHER_PLACE}")
        remove_dead([self._folder])
        if self._folder.is_dir():
            remove_dead([self._folder], inside=True)
            self._refuse_foreign(_possible(self._folder, materials))
        else:
            make_folder(self._folder.parent)
        with explained(folder):
            # Beside a folder that does not exist, so that all of it can appear at once; else on the same file system.
            self._part = Part(self._folder, folder=True, inside=self._folder.is_dir())
        self.building = self._part.path

    def names(self):
        """Files written so far, relative to the folder, as a list of str."""
        found = (path for path in self.building.rglob("*") if path.is_file())
        names = (path.relative_to(self.building).as_posix() for path in found)
        return sorted(name for name in names if not name.startswith("."))

    def commit(self):
        """Put the report in place, and remove what only the earlier one had.

        Raises
        ------
        OutputError
            The folder was made or filled with something else meanwhile; it is then as it was.
        """
        names = self.names()
        with explained(self._shown):
            if self._appear():
                return
            with turn(self._folder):
                earlier = self._refuse_foreign(names)
                (self._folder / FIGURES).mkdir(exist_ok=True)
                # With the list of files comes what makes it a report: first where there was none, else last.
                first = [] if earlier else [files.JSON]
                for name in [*first, *(name for name in names if name != files.JSON)]:
                    os.replace(self.building / name, self._folder / name)
                for name in earlier.difference(names):
                    with contextlib.suppress(OSError):
                        os.unlink(self._folder / name)
                if earlier:
                    os.replace(self.building / files.JSON, self._folder / files.JSON)
        self.discard()

    def discard(self):
        """Remove what was written, unless it was put in place."""
        self._part.remove()

    def _appear(self):
        """Make the report appear all at once, which works where no folder stands."""
        if self._folder.exists():
            return False
        try:
            self._part.move(self._folder)
        except OSError as error:
            if error.errno in (errno.ENOTEMPTY, errno.EEXIST, errno.ENOTDIR):
                return False
            raise
        return True

    def _refuse_foreign(self, names):
        """Make sure that nothing but an earlier report is in the way; return the files that it lists."""
        earlier = listed_files(self._folder)
        for name in names:
            path = self._folder / name
            if name not in earlier and path.exists() and not (earlier and is_figure(path)):
                raise OutputError(f"{self._shown / name}: exists and is not overwritten; {_OTHER_PLACE}")
        if not earlier:
            self._refuse_anything_else()
        return earlier

    def _refuse_anything_else(self):
        with explained(self._shown):
            for path in sorted(self._folder.iterdir()):
                emptied = path.name == FIGURES and path.is_dir() and not any(path.iterdir())
                if not (path.name.startswith(".") or _is_result(path) or emptied):
                    raise OutputError(
                        f"{self._shown}: holds {path.name}, and no earlier report, so nothing in it is overwritten; "
                        f"{_OTHER_PLACE}"
                    )


def _is_result(path):
    try:
        read_header(path)
    except (ForeignFileError, UnusableResultError):
        return False
    except GoniosimError:
        # Damaged or newer: a result all the same.
        pass
    return True


def listed_files(folder):
    """What belongs to the report in a folder.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    set of str
        Names relative to the folder; empty if there is no report.
    """
    try:
        report = json.loads((folder / files.JSON).read_bytes())
        if report["filetype"] != files.FILETYPE:
            return set()
        # The first reports had no list.
        found = report.get("files") or _possible(folder, [source["material"] for source in report["results"]])
        # Whatever the list says, it names nothing elsewhere.
        return {files.JSON, *(name for name in found if name in TABLES or _FIGURE.fullmatch(name))}
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return set()


def _possible(folder, materials):
    """Tables, and the files among the figures whose names a report on these materials may use."""
    ours = "|".join(map(re.escape, materials))
    name = re.compile(rf"(?:errors|cost|(?:{ours})-(?:views|lobes(?:-theta_[0-9.e+-]+)?))\.(?:png|svg)")
    figures = folder / FIGURES
    found = figures.iterdir() if figures.is_dir() else ()
    return [*TABLES, *(f"{FIGURES}/{path.name}" for path in found if name.fullmatch(path.name))]
