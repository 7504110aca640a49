"""`rocking equiv`: compute the equivalent rocking block."""

from __future__ import annotations

import io

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Compute the equivalent rocking block of each structure.")
@options.structures
@options.as_json
@click.option("--csv", "as_csv", is_flag=True, help="Print comma-separated values, one line per direction.")
def command(files: tuple[str, ...], as_json: bool, as_csv: bool) -> None:
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
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.io.tables import write_csv
    from rocking_cli.questions.equiv.verb import equiv

    watch = OnTerminal(as_json=as_json)
    answers = equiv(files, watch=watch)
    if as_csv:
        lines = io.BytesIO()
        write_csv(lines, [answer.columns() for answer in answers.values()], digits=None)
        terminal.result(lines.getvalue().decode().rstrip("\n"))
    elif not as_json:
        terminal.show(answers.view, as_json=False)
    watch.end()
