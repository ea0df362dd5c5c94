"""The folder that a comparison writes: tables, integrated slices, figures; one material at a time."""

from ...compare.comparison import check_usable
from ...compare.material import compare_material
from ...compare.summary import summarise
from ...errors import OutputError, UnusableResultError
from ...integration import Pool
from ...store import open_result, read_header
from ...store.model_slices import ModelSlicesFile
from . import files
from .figures import draw_joint, draw_material
from .ranking import ranking

FIGURES = "figures"


def check_headers(paths, allow_partial):
    """Make sure, before anything is computed, that all files can be compared.

    Parameters
    ----------
    paths : list of Path
    allow_partial : bool

    Raises
    ------
    UnusableResultError
        A partial result, or two of the same name.
    ForeignFileError, DamagedFileError, NewerSchemaError
        A file is not a result that can be read.
    """
    names = {}
    for path in paths:
        header = read_header(path)
        if header["status"] == "partial" and not allow_partial:
            raise UnusableResultError(
                f"{path}: the simulation was interrupted (partial); finish it, or use --allow-partial"
            )
        name = header["name"]
        if name in names:
            raise UnusableResultError(
                f"{path}: its material has the name {name}, as that of {names[name]}; rename one of them"
            )
        names[name] = path


class Report:
    """Writes the report of a comparison; to be closed.

    Parameters
    ----------
    folder : Path
        Created if it does not exist.
    request : dict of str to dict
        From `goniosim.compare.variants.check_request`.
    subcells : int

    Raises
    ------
    OutputError
        The folder cannot be written.
    """

    def __init__(self, folder, request, subcells):
        self._folder = folder
        self._request = request
        self._subcells = subcells
        self._summaries = []
        self._origin = files.origin_of(subcells)
        try:
            (folder / FIGURES).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(
                f"{folder}: the folder cannot be created: {error.strerror}; choose another place"
            ) from error
        self._models = ModelSlicesFile(folder / "models.h5", self._origin)
        self._pool = Pool()

    def close(self):
        """Release what is open; an unfinished file of slices is removed."""
        self._pool.shutdown()
        self._models.discard()

    def add(self, path, say):
        """Compare one result, write its slices and draw its figures.

        Parameters
        ----------
        path : Path
        say : callable
            Called with a line on what is being done.
        """
        result = open_result(path)
        check_usable(result, allow_partial=True)
        say(f"{result.name}: integrating the models")
        comparison = compare_material(result, self._request, self._subcells, self._pool)
        self._models.add_material(result)
        for variant in comparison.variants:
            slices = {part: one for (label, part), one in comparison.slices.items() if label == variant.label}
            attributes = {"model": variant.model, "options": variant.options_text}
            self._models.add_model(result, variant.label, attributes, slices)
        say(f"{result.name}: drawing")
        draw_material(comparison, self._folder / FIGURES)
        self._summaries.append(summarise(comparison))

    def finish(self):
        """Write the tables and the joint figures.

        Returns
        -------
        str
            The ranking of the models.
        """
        self._models.commit()
        rows = [row for summary in self._summaries for row in summary.rows]
        sources = [summary.source for summary in self._summaries]
        files.write_csv(self._folder / "errors.csv", rows, self._origin)
        files.write_json(self._folder / "errors.json", rows, self._origin, sources)
        draw_joint(self._summaries, self._folder / FIGURES)
        return ranking(self._summaries)
