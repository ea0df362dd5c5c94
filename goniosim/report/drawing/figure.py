"""Figures that keep their look wherever they are drawn, and that notebooks show."""

import io

from matplotlib import figure

from .files import own_style


class Figure(figure.Figure):
    """A figure in the style of the files; parameters as of `matplotlib.figure.Figure`."""

    def draw(self, renderer):
        """Draw with the style that it was made with: ticks are made only now."""
        with own_style():
            super().draw(renderer)

    def _repr_png_(self):
        # Notebooks know figures by themselves only once pyplot was imported, which nobody needs here.
        stream = io.BytesIO()
        self.savefig(stream, format="png")
        return stream.getvalue()


def styled(make, *arguments):
    """Draw ``make(*arguments)``, a `Figure`, in the style of the files."""
    with own_style():
        return make(*arguments)
