"""The folder that a comparison writes: tables, integrated slices, figures; one material at a time."""

from ...compare.comparison import check_usable
from ...compare.material import compare_material
from ...compare.summary import summarise
from ...cores import available_cores
from ...errors import UnusableResultError
from ...integration import Pool
from ...store import ModelsWriter, open_result, read_header, read_scene
from .. import memory
from ..drawing.files import write_figure
from ..drawing.names import distinct
from ..drawing.studio import Studio
from . import files
from .figures import joint_figures, material_figures
from .folder import FIGURES, MODELS, ReportFolder
from .ranking import ranking


def check_headers(paths, allow_partial, request, figures="all"):
    """Make sure, before anything is computed, that all files can be compared, and that there is memory for it.

    Parameters
    ----------
    paths : list of Path
    allow_partial : bool
    request, figures
        As for `Report`.

    Returns
    -------
    list of str
        Names of the materials.

    Raises
    ------
    UnusableResultError
        A partial result, or two of the same name.
    ForeignFileError, DamagedFileError, NewerSchemaError
        A file is not a result that can be read.
    ResourceError
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
                f"{path}: its material has the name {name}, as that of {names[name]}; "
                "rename one of them and simulate it anew"
            )
        names[name] = path
        scene = read_scene(path)
        memory.require_memory(path, memory.memory_to_compare(scene, request, figures), _remedy(request, figures))
    return list(names)


def _remedy(request, figures):
    fewer = ["name fewer models (--models)"] if len(request) > 1 else []
    fewer += ["draw fewer figures (--figures none)"] if figures != "none" else []
    return ", ".join([*fewer, "or simulate fewer incident directions per file"]).removeprefix("or ")


class Report:
    """Writes the report of a comparison; to be closed.

    Parameters
    ----------
    folder : Path
        Where it appears with `commit`, see `goniosim.report.comparison.folder.ReportFolder`.
    materials : list of str
        Names of all that will be compared.
    request : dict of str to dict
        From `goniosim.compare.variants.check_request`.
    subcells : int
    figures : str
        Which figures of each material, see `goniosim.report.comparison.figures.EXTENTS`.

    Raises
    ------
    OutputError
        The folder cannot be written, or holds something else.
    """

    def __init__(self, folder, materials, request, subcells, figures="all"):
        self._origin = files.origin_of(subcells)
        self._stems = dict(zip(materials, distinct(materials), strict=True))
        self._place = ReportFolder(folder, list(self._stems.values()))
        self._folder = self._place.building
        try:
            (self._folder / FIGURES).mkdir()
            self._models = ModelsWriter(self._folder / MODELS, self._origin)
        except BaseException:
            self._place.discard()
            raise
        self._request = request
        self._subcells = subcells
        self._figures = figures
        self._summaries = []
        self._pool = Pool()
        self._studio = Studio(available_cores())

    def close(self):
        """Release what is open; a report that is not in place is removed."""
        self._studio.close()
        self._pool.shutdown()
        self._models.discard()
        self._place.discard()

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
        self._models.add_material(result, comparison.components[0])
        for variant in comparison.variants:
            slices = {part: one for (label, part), one in comparison.slices.items() if label == variant.label}
            attributes = {"model": variant.model, "options": variant.options_text}
            self._models.add_model(result, variant.label, attributes, slices)
        figures = material_figures(comparison, self._folder / FIGURES / self._stems[result.name], self._figures)
        if figures:
            say(f"{result.name}: drawing")
            # Not while models are timed: both want all processors.
            self._studio.draw(figures)
        self._summaries.append(summarise(comparison))

    def finish(self):
        """Write the tables and the joint figures, so that all is there but not in place.

        Returns
        -------
        str
            The ranking of the models.
        """
        self._models.commit()
        rows = [row for summary in self._summaries for row in summary.rows]
        sources = [summary.source for summary in self._summaries]
        files.write_csv(self._folder / files.CSV, rows, self._origin)
        if self._figures != "none":
            for figure in joint_figures(self._summaries, self._folder / FIGURES):
                write_figure(*figure)
        written = [*self._place.names(), files.JSON]
        files.write_json(self._folder / files.JSON, rows, self._origin, sources, written)
        return ranking(self._summaries)

    def commit(self):
        """Put the report in place of an earlier one.

        Raises
        ------
        OutputError
        """
        self._place.commit()
