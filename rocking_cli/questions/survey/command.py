"""`rocking survey`: rank the structures of a table by vulnerability."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import NEIGHBOUR_OPTIONS, GroundMotions, Output, read_table
from rocking_cli.cli.help import Command
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.questions.verify import heads

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer
    from rocking_cli.io.tables import Columns

MAX_NAMED_ROWS = 20  # rows that cannot be used, in a message
SHEET_FORMATS = ("html", "docx", "pdf")


@dataclass(frozen=True)
class SurveyOutput(Output):
    """The files to write, among them a page and a map, and whether the result is one JSON object."""

    page: Path | None = None
    map: Path | None = None

    def blocks(self, answer: Answer[Any]) -> Iterable[Columns]:
        """Return all rows; in a CSV file, which spreadsheets open, with their decimal sign."""
        from rocking_cli.io.tables import PARQUET
        from rocking_cli.questions.survey.view import blocks

        assert self.out is not None
        return blocks(answer.result, None if self.out.suffix.lower() == PARQUET else self.decimal or ".")


@click.command(cls=Command, short_help="Rank the structures of a table, the most vulnerable first.")
@click.argument("file", metavar="TABLE.csv", type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.around(None, "200, or as many as take about a minute")
@options.opening
@options.site
@click.option(
    "--top", type=click.IntRange(1), default=20, show_default=True, metavar="N", help="Number of structures to show."
)  # fmt: skip
@options.out(".csv", ".parquet", what="Write all rows in ranked order (.csv or .parquet).")
@options.table_signs
@click.option(
    "--page", callback=options.output_path(".html"), metavar="FILE.html", shell_complete=complete.files,
    help="Write an HTML page with a plot, a map and all rows in a sortable table.",
)  # fmt: skip
@click.option(
    "--map", callback=options.output_path(".png", ".svg", ".pdf"), metavar="FILE.png", shell_complete=complete.files,
    help="Draw a map of the structures, by the columns longitude and latitude (.png, .svg or .pdf).",
)  # fmt: skip
@click.option(
    "--sheets", metavar="FOLDER", help="Write the calculation sheet of each structure into this folder; needs --site."
)
@click.option(
    "--sheet-format", type=click.Choice(SHEET_FORMATS), default="html", show_default=True,
    help="Format of the sheets (docx and pdf need an extra package; a browser does for pdf).",
)  # fmt: skip
@heads.language
@heads.head
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
    the share of neighbouring motions that overturn them and then by their largest peak rotation, both from the
    nonlinear model; a motion whose outcome is unknown, because a joint opens or slides that the model keeps closed,
    counts as overturning. There are 200 neighbours of each motion unless the table would then take more than a minute;
    --neighbours N fixes their number. With --polarity both, the worse of the two polarities governs. With --site, each
    is verified by the code of the site and ranked by its ratio of capacity to demand.

    A block that is alone, and less deep than wide, is ranked as it rocks about its depth, unless its column plane says
    width.

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
    results.check_signs()
    motions, watch = asked.motions, results.watch
    files = {"--out": results.out, "--page": results.page, "--plot": results.plot, "--map": results.map}
    keep_apart([*files.items()], [file, question["site"], *(str(each.path) for each in motions.records)])
    if not asked:
        as_declared(question, *NEIGHBOUR_OPTIONS)
    if question["sheets"] is None:
        as_declared(question, *heads.HEAD_OPTIONS)
    table = read_table(file, lambda sheet: StructureTable(sheet, Path()))
    answer = survey(
        table, motions, polarity=asked.polarity, processes=True, page=results.page, map=results.map,
        origin=None if question["sheets"] is None else heads.command_line(ctx), watch=watch, **question,
    )  # fmt: skip
    for line in bad_lines(answer.bad, name_of(file), MAX_NAMED_ROWS):
        terminal.error(line)
    if not answer.rows:
        first = answer.bad[0].error
        ctx.exit(first.exit_code if isinstance(first, MechanismError) else InputError.exit_code)
    watch.left_out += len(answer.bad)
    results.show(answer)
