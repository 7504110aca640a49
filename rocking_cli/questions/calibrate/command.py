"""`rocking calibrate`: find the restitution of a structure from a trace of free rocking, or from tests."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.groups import Output, ReadingOptions, read_table
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import QuantityKind, range_of

FACTOR = QuantityKind("factor", "", "0.8", "0.8:1.2", 1e-3, 1e3)
ETA = QuantityKind("restitution", "", "0.8", "0.8:0.99", 1e-3, 1.0)


@click.command(cls=Command, short_help="Find the restitution from a trace of free rocking.")
@click.argument("file", type=click.Path())
@click.option(
    "--free",
    metavar="TRACE.csv",
    type=click.Path(),
    shell_complete=complete.files,
    help="Trace of a free-rocking test: columns time [s] and angle [deg] or [rad]; - is standard input.",
)
@click.option(
    "--tests",
    metavar="TESTS.csv",
    type=click.Path(),
    shell_complete=complete.files,
    help="Table of shake-table tests, as for `rocking score`; those of FILE are used.",
)
@click.option(
    "--free-geometry",
    is_flag=True,
    help="With --free: fit p and alpha too, of a free-standing block with alpha of 0.07 rad or more.",
)
@click.option(
    "--slenderness",
    type=range_of(FACTOR),
    metavar="LOW:HIGH",
    help="With --tests: range of the factor on the slenderness.  [default: 0.7:1.3]",
)
@click.option(
    "--restitution",
    type=range_of(ETA),
    metavar="LOW:HIGH",
    help="With --tests: range of the restitution.  [default: 0.7:0.99]",
)
@click.option(
    "--points",
    type=click.IntRange(3, 101),
    metavar="N",
    help="With --tests: number of values along each axis of the grid.  [default: 9]",
)
@click.option(
    "--neighbours",
    type=click.IntRange(1, 100_000),
    metavar="N",
    help="With --tests: number of neighbours of each test at each point of the grid.  [default: 40]",
)
@options.reading
@options.out(
    ".yaml",
    ".yml",
    what="Write a copy of FILE with the fitted restitution and its scatter (uncertainty).",
    metavar="FILE.yaml",
)
@options.plot("Plot the trace with its fit and residuals, or the likelihood over the grid")
@options.as_json
@options.grouped(reading=ReadingOptions, output=Output)
def command(file: str, reading: ReadingOptions, output: Output, **question: Any) -> None:
    """Find the coefficient of restitution of a structure from what was measured on it.

    With --free, the trace of a free-rocking test is fitted at once: time and angle of the release, the restitution, and
    offset and drift of the instrument; the geometry is that of FILE. A restitution for each impact tells how much it
    scatters, which is what neighbours should draw. The trace may have lifting, holding and rest in it, any sampling,
    gaps and either sense. -o writes restitution and scatter, and with --free-geometry width and height, into a copy of
    FILE.

    With --tests, the outcomes of shake-table tests give the likelihood over slenderness and restitution. Outcomes alone
    leave a ridge of pairs that explain them about as well: the region is shown, and nothing is written.

    What does not determine the restitution is refused with the reason: fewer than three impacts above the noise, a
    trace that is no free rocking of this structure, a best point on the edge of the grid.

    \b
    Example:
      rocking calibrate block.yaml --free trace.csv --plot fit.png
      rocking calibrate block.yaml --free trace.csv -o measured.yaml
      rocking calibrate block.yaml --tests tests.csv --points 13
    """
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.questions.calibrate.trace import parse_trace
    from rocking_cli.questions.calibrate.verb import calibrate

    output.keep_apart(file, question["free"], question["tests"])
    watch = OnTerminal()
    if question["free"] is not None:
        # Defaults from the settings of a user do not apply to a trace, and are not an error.
        question |= {name: None for name in ("points", "neighbours") if from_default(name)}
        question["free"] = read_table(question["free"], parse_trace)
    answer = calibrate(file, out=output.out, watch=watch, usual=reading.usual, **question, **reading.options)
    if output.out is not None:
        watch.note(f"wrote {output.out}")
    replace(output, out=None).show(answer)
    watch.end()
