"""`rocking survey`: rank the structures of a table by vulnerability."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.groups import GroundMotions, Output, read_table
from rocking_cli.cli.help import Command
from rocking_cli.errors import InputError, MechanismError

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer
    from rocking_cli.io.tables import Columns

MAX_NAMED_ROWS = 20  # rows that cannot be used, in a message


@dataclass(frozen=True)
class SurveyOutput(Output):
    """The files to write, among them a page, and whether the result is one JSON object."""

    page: Path | None = None

    def blocks(self, answer: Answer[Any]) -> Iterable[Columns]:
        """Return all rows: in a CSV file, which spreadsheets open, texts that look like formulas are marked."""
        from rocking_cli.io.tables import PARQUET
        from rocking_cli.questions.survey.view import blocks

        assert self.out is not None
        return blocks(answer.result, for_spreadsheets=self.out.suffix.lower() != PARQUET)


@click.command(cls=Command, short_help="Rank the structures of a table, the most vulnerable first.")
@click.argument("file", metavar="TABLE.csv", type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.opening
@options.site
@click.option(
    "--top", type=click.IntRange(1), default=20, show_default=True, metavar="N", help="Number of structures to show."
)  # fmt: skip
@options.out(".csv", ".parquet", what="Write all rows in ranked order (.csv or .parquet).")
@click.option(
    "--page", callback=options.output_path(".html"), metavar="FILE.html", shell_complete=complete.files,
    help="Write an HTML page with a plot and all rows in a sortable table.",
)  # fmt: skip
@options.plot("Plot the uplift acceleration against the frequency parameter")
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, results=SurveyOutput)
def command(
    ctx: click.Context, file: str, asked: GroundMotions, results: SurveyOutput, **question: Any
) -> None:  # fmt: skip
    """Rank many structures, one per table row, by vulnerability.

    The columns of the table are `mechanism`, `name` and fields of mechanisms, with dots for nested fields
    (loads.0.mass, ties.bar.stiffness); each row may have any mechanism. A column `file` names YAML files, whose fields
    the other columns replace. An empty cell means that the field is not given; give units in cells (800 mm) or in
    headings (width [mm]). TABLE.csv may be - for standard input.

    Without ground motions, structures are ranked by their uplift acceleration. With ground motions, they are ranked by
    the share of motions that overturn them and then by their largest peak rotation, both from the nonlinear model; a
    motion whose outcome is unknown, because a joint opens or slides that the model keeps closed, counts as overturning.
    With --polarity both, the worse of the two polarities governs. With --site, each is verified by the code of the site
    and ranked by its ratio of capacity to demand.

    A row that cannot be used is reported with its line number and skipped, and the exit code is 5.

    \b
    Example:
      rocking survey parapets.csv --page parapets.html
      rocking survey parapets.csv --record "records/*.AT2" --polarity both --out ranked.csv
    """
    asked.check()
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import check_table
    from rocking_cli.questions.survey.structure_table import StructureTable
    from rocking_cli.questions.survey.verb import survey
    from rocking_cli.questions.survey.view import bad_lines

    check_table(results.out)
    motions, watch = asked.motions, results.watch
    written = [("--out", results.out), ("--page", results.page), ("--plot", results.plot)]
    keep_apart(written, [file, *(str(each.path) for each in motions.records)])
    table = read_table(file, lambda sheet: StructureTable(sheet, Path()))
    answer = survey(table, motions, polarity=asked.polarity, processes=True, page=results.page, watch=watch, **question)
    for line in bad_lines(answer.bad, name_of(file), MAX_NAMED_ROWS):
        terminal.error(line)
    if not answer.rows:
        first = answer.bad[0].error
        ctx.exit(first.exit_code if isinstance(first, MechanismError) else InputError.exit_code)
    watch.left_out += len(answer.bad)
    results.show(answer)
