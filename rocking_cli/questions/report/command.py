"""`rocking report`: write a report on a structure as a page of HTML, as PDF, or for a word processor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import NEIGHBOUR_OPTIONS, GroundMotions
from rocking_cli.cli.help import Command
from rocking_cli.questions.verify import heads


@click.command(cls=Command, short_help="Write a report on a structure, as HTML, PDF or .docx.")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both", default="both")
@options.out(
    ".html", ".pdf", ".docx",
    what="Output file; .pdf needs a browser or an extra package, .docx an extra package.  [default: FILE with the "
    "ending .html, in this folder; none with --json]",
)  # fmt: skip
@heads.language
@heads.head
@click.option(
    "--verify", type=click.Path(), metavar="SITE.yaml", shell_complete=complete.files,
    help="Site file of a verification by code that becomes part of the report.",
)  # fmt: skip
@click.option(
    "--state", metavar="STATE",
    help="Limit state to which the records belong, such as SLC, if the site gives it.  [default: that of the verdict]",
)  # fmt: skip
@options.on_floor
@options.around()
@options.opening
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions)
def command(
    ctx: click.Context, files: tuple[str, ...], asked: GroundMotions, out: Path | None, as_json: bool, **question: Any
) -> None:  # fmt: skip
    """Write a report on a structure: one HTML file that opens in any browser and can be printed, a PDF, or .docx.

    The HTML file needs no network. A PDF (`-o report.pdf`) is printed by the browser of this computer, or made with the
    extra package `pdf`. The first page is for the owner: what was asked, the conclusion, the drawing, and what to do
    next. Then follow what the results rest on, the parameters, the response to each ground motion (with --polarity
    both, that of the worse polarity), the joints, the margin, the pulses and the overturning map, the error of the
    equivalent block, and the files and versions needed to reproduce the results. Without a ground motion, the report
    contains only the parts that need none.

    With --verify SITE.yaml, the report also contains the verification by the code of the site, step by step as in
    `rocking verify --sheet`; --state and --on-floor are those of `rocking verify`.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A record that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking report frame.yaml --record accel.csv -o report.html
      rocking report frame.yaml --record accel.csv -o report.pdf
      rocking report arch.yaml --record one.AT2 --record two.AT2 --target-pga 0.3
    """
    asked.check()
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.report.verb import report

    question["polarity"] = asked.polarity
    if not asked:
        as_declared(question, "polarity", *NEIGHBOUR_OPTIONS)
    file = asked.structure(files)
    if out is None and not as_json:
        out = Path(f"{options.stem(file)}.html")
    motions, watch = asked.motions, OnTerminal()
    read = [*files, *(str(each.path) for each in motions.records), question["logo"], question["verify"]]
    keep_apart([("--out", out)], read)
    origin = heads.command_line(ctx)
    answer = report(file, motions, out, origin=origin, watch=watch, **question)
    terminal.show(answer.view, as_json=as_json)
    watch.end()
