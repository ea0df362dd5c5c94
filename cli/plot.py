"""`goniosim plot`: pictures of a result file."""

import click

from .policy import debug_option


@click.command()
@click.argument("file")
@click.option("-o", "--output", metavar="DIR", default=".", help="Folder for the pictures [default: here].")
@click.option(
    "--format",
    "suffix",
    type=click.Choice(["png", "svg", "pdf"]),
    default="png",
    show_default=True,
    help="File format.",
)
@click.option("--theta", type=float, multiple=True, help="Only this incident direction, in degrees; may be repeated.")
@debug_option
def plot(file, output, suffix, theta):
    """Draw the slices in the result FILE.

    An overview, and one figure per incident direction: each component is seen from above in colour and
    as bands of equal luminance, and along the plane of incidence with its noise.
    """
    from pathlib import Path

    from goniosim.report.simulation.figures import draw
    from goniosim.store import open_result

    result = open_result(file)
    written = draw(result, Path(output), Path(file).stem, suffix=suffix, theta_deg=theta or None)
    for path in written:
        click.echo(path)
