"""`rocking equiv`: compute the equivalent rocking block."""

from __future__ import annotations

import io

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Compute the equivalent rocking block of each structure.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.as_json
@click.option("--csv", "as_csv", is_flag=True, help="Print comma-separated values, one line per direction.")
@click.pass_context
def command(ctx: click.Context, files: tuple[str, ...], as_json: bool, as_csv: bool) -> None:
    """Compute the parameters of the equivalent single rocking block of each structure.

    The table has one column if both directions agree and two if they differ; positive is clockwise. With --json, each
    file gives one object on a line of its own. A file that cannot be used is reported and skipped, and the exit code
    is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking equiv frame.yaml
      rocking equiv wall.yaml arch.yaml --csv > parameters.csv

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 9-20.
    """
    if as_json and as_csv:
        raise click.UsageError("--json and --csv cannot be combined: choose one.")
    from rocking_cli.cli import structures
    from rocking_cli.errors import INCOMPLETE, MechanismError
    from rocking_cli.io.tables import write_csv
    from rocking_cli.structure import Structure
    from rocking_cli.views import equivalent_block

    mechanisms, _, bad = structures.load_each(files)
    found = []
    for mechanism in mechanisms:
        try:
            structure = Structure(mechanism)
            structure.statics, structure.why_no_block  # noqa: B018 - derived here, and kept
            found.append(structure)
        except MechanismError as error:
            if len(mechanisms) == 1:
                raise
            terminal.error(str(error))
            refused = error
            bad += 1
    if not found:
        ctx.exit(refused.exit_code)
    if as_csv:
        lines = io.BytesIO()
        write_csv(lines, [equivalent_block.table(found)], digits=None)
        terminal.result(lines.getvalue().decode().rstrip("\n"))
    for structure in found:
        if not as_csv:
            terminal.show(equivalent_block.view(structure), as_json=as_json)
        for each in equivalent_block.warnings(structure):
            terminal.warning(each)
        for each in equivalent_block.notes(structure.mechanism):
            terminal.note(each)
    if bad:
        ctx.exit(INCOMPLETE)
