"""`rocking design`: find the values of one field for which a structure meets a requirement."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import options
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import NEIGHBOUR_OPTIONS, GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Parsed


def _span(text: str) -> Any:
    from rocking_cli.questions.design.study import Span

    return Span.parse(text)


def _aim(text: str) -> Any:
    from rocking_cli.questions.design.study import Aim

    return Aim.parse(text)


@click.command(cls=Command, short_help="Find the values of a field that meet a requirement.")
@options.structure
@click.option(
    "--vary", required=True, type=Parsed("field", _span), metavar="FIELD=LOW:HIGH",
    help="Field to vary and its range: width=0.2m:0.8m, ties.bar.prestress=0:50kN, loads.0.mass=1t:9t.",
)  # fmt: skip
@click.option(
    "--until", required=True, type=Parsed("requirement", _aim), metavar="'METRIC OP NUMBER'",
    help="Requirement: one of lambda, phi_cr, p, peak_ratio, peak_displacement, drift, tie_force, overturned, ratio, "
    "or a number of a code (alpha0, zeta_SLD, zeta_SLV, zeta_SLC, zeta_damage, zeta_linear or zeta_nonlinear); one of "
    "<, <=, > or >=; and a number, or the word required for what the code of the site requires.",
)  # fmt: skip
@click.option(
    "--points", type=click.IntRange(2, 10_000), default=41, show_default=True, metavar="N",
    help=options.HELP["points"],
)  # fmt: skip
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.around()
@options.opening
@options.site
@options.out(".csv", ".parquet", what="Write the scanned values and the metric at each (.csv or .parquet).")
@options.plot("Plot the metric against the field")
@options.as_json
@options.grouped(asked=GroundMotions, output=Output)
def command(file: str | Path, asked: GroundMotions, output: Output, **question: Any) -> None:
    """Find the least thickness, width or tie force, or the largest load, for which a requirement holds.

    The metrics are lambda, phi_cr and p of `rocking equiv`: of the two directions, the smaller phi_cr and lambda and
    the larger p. With a ground motion, the metric may also be the share of its neighbours that overturn (overturned),
    or the median over them of the peak rotation over the critical rotation (peak_ratio), of the peak displacement of
    the control point (peak_displacement), of that of the top over its height (drift), or of the largest force of a tie
    (tie_force); an unknown outcome, because a joint opens or slides that the model keeps closed, counts as overturning.
    With several motions, or with --polarity both, the worst case governs. With --site, ratio is the ratio of capacity
    to demand by the code of the site (zeta_E by the Italian code). alpha0 and, with --site, the zeta_E of a limit
    state or of a method are those of `rocking verify` by the Italian code. Of each, the smaller of both directions
    governs.

    If the field varies the force of a tie, the answer names bars of steel that give it.

    First, the range is scanned at --points values. If the metric is monotonic over it, the single threshold value is
    computed accurately; otherwise every interval in which the requirement is met is listed. "Met nowhere" and "met
    everywhere" are valid results.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking design wall.yaml --vary width=200mm:800mm --until "lambda >= 0.15"
      rocking design facade.yaml --vary ties.bar.prestress=0:100kN --until "lambda > 0.2" --plot tie.png
      rocking design block.yaml --vary width=0.3m:1m --until "overturned < 5%" --record accel.csv
    """
    asked.check()
    from rocking_cli.questions.design.verb import design

    if not asked:
        as_declared(question, *NEIGHBOUR_OPTIONS)
    output.keep_apart(file, *asked.motions.records)
    output.show(design(file, motions=asked.motions, polarity=asked.polarity, watch=output.watch, **question))
