"""`rocking survey`: rank the structures of a table by vulnerability."""

from __future__ import annotations

import os
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import complete, motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions
from rocking_cli.cli.help import Command
from rocking_cli.errors import INCOMPLETE, InputError, MechanismError

if TYPE_CHECKING:
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.studies.structure_table import StructureTable
    from rocking_cli.studies.survey import Survey

NAMED = 20  # rows that cannot be used, named one by one
LONG, LONG_SHAKEN = 10_000, 1_000  # rows from which on processes are worth their beginning
FEW = 3  # doubts about sizes, likewise


@dataclass(frozen=True)
class SurveyOutput:
    """Outputs of a survey."""

    top: int
    out: Path | None
    page: Path | None
    plot: Path | None
    as_json: bool

    def write(self, found: Survey, file: str) -> None:
        """Write the requested files, and report them."""
        from rocking_cli.views.survey import blocks, title

        if self.out is not None:
            from rocking_cli.cli import table_files
            from rocking_cli.io.tables import PARQUET

            table_files.write(self.out, blocks(found, for_spreadsheets=self.out.suffix.lower() != PARQUET))
        if self.plot is not None:
            from rocking_cli.cli.pictures import write_picture
            from rocking_cli.plotting.survey import draw_survey

            write_picture(self.plot, draw_survey(found, title(found)))
        if self.page is not None:
            self._write_page(self.page, found, file)

    def _write_page(self, place: Path, found: Survey, file: str) -> None:
        from rocking_cli import __version__
        from rocking_cli.io.files import write_whole
        from rocking_cli.report.survey import render

        today = datetime.now(UTC).strftime("%d %B %Y").lstrip("0")
        page = render(found, Path(file).name, [f"Written on {today} with rocking-cli {__version__}."]).encode()
        write_whole(place, lambda stream: stream.write(page))
        terminal.note(f"wrote {place} ({len(page) / 1e6:.2g} MB)")


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
def command(ctx: click.Context, file: str, asked: GroundMotions, site: str | None, results: SurveyOutput) -> None:
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
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import check_table

    check_table(results.out)
    paths, missing = motion_files.find(asked.records)
    written = [("--out", results.out), ("--page", results.page), ("--plot", results.plot)]
    keep_apart(written, [file, *(str(each.path) for each in paths)])
    table = _table(file)
    chosen: list[Scaled] = []
    refused = 0
    if asked:
        chosen, refused = motion_files.gather(paths, asked.pulses, asked.reading, asked.scaling, 0.0)
        if not chosen:
            ctx.exit(InputError.exit_code)
    found = _survey(table, chosen, asked, site)
    _report(found, table.sheet.file)
    if not found.rows:
        first = found.bad[0].error
        ctx.exit(first.exit_code if isinstance(first, MechanismError) else InputError.exit_code)
    results.write(found, table.sheet.file)
    from rocking_cli.views.survey import view

    terminal.show(view(found, results.top), as_json=results.as_json)
    if found.bad or missing or refused:
        ctx.exit(INCOMPLETE)


def _table(file: str) -> StructureTable:
    """Return the table of a file or of standard input."""
    from rocking_cli.errors import Problem
    from rocking_cli.excitation.records.opening import name_of, original
    from rocking_cli.io.spreadsheet import parse_sheet, read_sheet
    from rocking_cli.studies.structure_table import StructureTable

    if file == options.STANDARD_OUTPUT:
        table = StructureTable(parse_sheet(original(file), name_of(file)), Path())
    else:
        table = StructureTable(read_sheet(Path(file)), Path(file).parent)
    if not len(table):
        raise InputError(Problem("the table has no rows below its headings", table.sheet.file))
    if short := table.short:
        lines = f"line {short[0]}" if len(short) == 1 else f"{len(short):,} lines, first in line {short[0]}"
        terminal.warning(f"{table.sheet.file}: fewer cells than headings in {lines}: missing cells are read as empty")
    return table


def _survey(table: StructureTable, chosen: list[Scaled], asked: GroundMotions, site: str | None) -> Survey:
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.studies.survey import survey
    from rocking_cli.studies.verification.check import read_site

    where = read_site(Path(site)) if site is not None else None
    motions: list[Any] = [each.motion.scaled(each.factor) for each in chosen]
    if motions:
        compile_first()
    count = _processes(len(table), bool(motions) or where is not None)
    opening = click.get_current_context().meta.get(options.OPENING)
    with terminal.progress(len(table), "structures") as advance:
        return survey(table, motions, asked.signs, site=where, opening=opening, processes=count, progress=advance)


def _processes(rows: int, shaken: bool) -> int | None:
    """Return the number of processes that share the work; None if threads are as fast."""
    from rocking_cli.dynamics.compiled import unwritable
    from rocking_cli.dynamics.processes import MOST

    count = min(os.cpu_count() or 1, MOST)
    if count < 2 or rows < (LONG_SHAKEN if shaken else LONG) or (shaken and unwritable() is not None):
        return None
    return count


def _report(found: Survey, file: str) -> None:
    """Report the unusable rows, and warn of doubtful sizes."""
    from rocking_cli.text import one_line
    from rocking_cli.views.survey import bad_lines

    for line in bad_lines(found.bad, file, NAMED):
        terminal.error(line)
    doubtful = [each for each in found.rows if each.doubt is not None]
    for each in doubtful[:FEW]:
        terminal.warning(f"{one_line(each.name)}: {each.doubt}")
    if len(doubtful) > FEW:
        terminal.warning(f"{len(doubtful) - FEW:,} more structures have doubtful sizes: --json lists them")
