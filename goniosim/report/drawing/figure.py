"""Figures that keep their look wherever they are drawn, and that notebooks show."""

import io

from matplotlib import figure, rc_context

from .files import STYLE


class Figure(figure.Figure):
    """A figure in the style of the files; parameters as of `matplotlib.figure.Figure`."""

    def draw(self, renderer):
        """Draw with the style that it was made with: ticks are made only now."""
        with rc_context(STYLE):
            super().draw(renderer)

    def _repr_png_(self):
        # Notebooks know figures by themselves only once pyplot was imported, which nobody needs here.
        stream = io.BytesIO()
        self.savefig(stream, format="png")
        return stream.getvalue()


def styled(make, *arguments):
    """Draw ``make(*arguments)``, a `Figure`, in the style of the files."""
    with rc_context(STYLE):
        return make(*arguments)
