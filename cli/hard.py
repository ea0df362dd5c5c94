"""`goniosim hard`: the hard cases, checked on this machine."""

import click

from .options import PATH
from .policy import debug_option, say
from .signals import tidied_up


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option("--list", "listed", is_flag=True, help="List the cases and check nothing.")
@click.option("-o", "--output", type=PATH, metavar="FILE.md", help="Write the table as Markdown as well.")
@click.option("--json", "as_json", is_flag=True, help="For programs: print JSON.")
@click.option("--overwrite", is_flag=True, help="Replace any file by the page, also one of more cases.")
@debug_option
@click.pass_context
def hard(ctx, names, listed, output, as_json, overwrite):
    """Check the hard cases on this machine.

    Scenes at the edges of what can be described are simulated, and held against what is exactly known of them. A table
    tells for each case what is checked, the expected and the found number, and how far apart they are. Give NAMEs for
    some of them. The exit code is 1 if a check fails.

    FILE.md is replaced if it is a page of the same cases, or of fewer.

    \b
    Examples: goniosim hard dark_stack smooth_stacks
              goniosim hard --list
              goniosim hard -o hard_cases.md
    """  # noqa: D301
    import json
    from contextlib import nullcontext
    from pathlib import Path

    from goniosim.hard import run, table
    from goniosim.hard.names import chosen
    from goniosim.hard.page import refuse_loss
    from goniosim.report.text import duration
    from goniosim.writing import make_folder, replacing

    if output == "-":
        raise click.UsageError("the page is a file, not a stream: name it with -o")
    try:
        cases = chosen(names)
    except ValueError as error:
        raise click.UsageError(str(error)) from None
    if listed:
        if as_json:
            click.echo(json.dumps(table.names(cases), indent=1))
        else:
            say(table.listing(cases))
        return
    if output:
        if not overwrite:
            refuse_loss(output, cases)
        make_folder(Path(output).parent)
    outcomes = []
    # That the file can be written is known before the work.
    with replacing(output) if output else nullcontext() as page, tidied_up():
        for outcome in run(cases):
            outcomes.append(outcome)
            if not as_json:
                say(table.case_text(outcome))
        if page:
            page.write_text(table.markdown(outcomes), encoding="utf-8")
    if as_json:
        click.echo(json.dumps(table.rows(outcomes), indent=1, allow_nan=False))
    else:
        say(f"{table.verdict(outcomes)}, in {duration(sum(outcome.seconds for outcome in outcomes))}")
    if not all(outcome.holds for outcome in outcomes):
        ctx.exit(1)
