"""`rocking design`: find the values of one field for which a structure meets a requirement."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Near, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Parsed
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.structure import Structure
    from rocking_cli.studies.design import Aim, Design, Span
    from rocking_cli.studies.metrics import Excitation


def _span() -> Callable[[str], Any]:
    from rocking_cli.studies.design import Span

    return Span.parse


def _aim() -> Callable[[str], Any]:
    from rocking_cli.studies.design import Aim

    return Aim.parse


@click.command(cls=Command, short_help="Find the values of a field that meet a requirement.")
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--vary", required=True, type=Parsed("field", _span), metavar="FIELD=LOW:HIGH",
    help="Field to vary and its range: width=0.2m:0.8m, ties.bar.prestress=0:50kN, loads.0.mass=1t:9t.",
)  # fmt: skip
@click.option(
    "--until", required=True, type=Parsed("requirement", _aim), metavar="'METRIC OP NUMBER'",
    help="Requirement: one of lambda, phi_cr, p, peak_ratio, overturned, ratio, or a number of a code (alpha0, "
    "zeta_damage, zeta_linear or zeta_nonlinear); one of <, <=, > or >=; and a number.",
)  # fmt: skip
@click.option(
    "--points", type=click.IntRange(2, 10_000), default=41, show_default=True, metavar="N",
    help=options.HELP["points"],
)  # fmt: skip
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.around
@options.opening
@options.site
@options.out(".csv", ".parquet", what="Write the scanned values and the metric at each (.csv or .parquet).")
@options.plot("Plot the metric against the field")
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, near=Near, output=Output)
def command(
    ctx: click.Context,
    file: str | None,
    vary: Span,
    until: Aim,
    points: int,
    asked: GroundMotions,
    near: Near,
    site: str | None,
    output: Output,
) -> None:
    """Find the least thickness, width or tie force, or the largest load, for which a requirement holds.

    The metrics are lambda, phi_cr and p of `rocking equiv`: of the two directions, the smaller phi_cr and lambda and
    the larger p. With a ground motion, the metric may also be the share of its neighbours that overturn (overturned),
    or the median of their peak rotation over the critical rotation (peak_ratio); an unknown outcome, because a joint
    opens or slides that the model keeps closed, counts as overturning. With several motions, or with
    --polarity both, the worst case governs. With --site, ratio is the ratio of capacity to demand by the code of the
    site. alpha0 and, with --site, the zeta_E of a method are those of `rocking verify` by the Italian code. Of each,
    the smaller of both directions governs.

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
    if until.metric.shaken and not asked:
        raise click.UsageError(f"{until.metric.name} needs a ground motion: give --record PLACE or --pulse PULSE.")
    if not until.metric.shaken and asked:
        raise click.UsageError(
            f"{until.metric.name} does not depend on a ground motion: leave out --record and --pulse."
        )
    if until.metric.shaken and not near.neighbours:
        raise click.UsageError(
            f"{until.metric.name} is computed from neighbouring motions: --neighbours must be at least 1."
        )
    if until.metric.sited and site is None:
        raise click.UsageError(
            f"{until.metric.name} depends on the site: give --site FILE. `rocking new site` prints a template."
        )
    if site is not None and not until.metric.sited:
        raise click.UsageError(f"{until.metric.name} does not depend on the site: leave out --site.")
    from rocking_cli.cli import structures
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import check_table
    from rocking_cli.views.design import columns, view

    check_table(output.out)
    paths, bad = motion_files.find(asked.records)
    keep_apart([("--out", output.out), ("--plot", output.plot)], [file, *(str(each.path) for each in paths)])
    structure = structures.prepared([file] if file else [])
    span = vary.in_unit(structure.unit_of(vary.field))
    _warn_of_sizes(structure, vary.field, span)
    excitation = None
    if asked:
        chosen, refused = motion_files.gather(paths, asked.pulses, asked.reading, asked.scaling, structure.growth)
        bad += refused
        if not chosen:
            ctx.exit(InputError.exit_code)
        excitation = _shaking(chosen, asked, near)
    elif site is not None:
        from rocking_cli.studies.metrics import Excitation
        from rocking_cli.studies.verification.check import read_site

        excitation = Excitation([], site=read_site(Path(site)))
    found = _design(structure, vary.field, span, until, excitation, points)
    output.write_made(lambda: [columns(found)], lambda: _draw(found))
    terminal.show(view(found, excitation), as_json=output.as_json)
    if bad:
        ctx.exit(INCOMPLETE)


def _warn_of_sizes(structure: Structure, field: str, span: tuple[float, float]) -> None:
    """Warn if a range looks as if it were given in another unit."""
    from rocking_cli.core.size import doubtful_size
    from rocking_cli.errors import RockingError

    for value in span:
        try:
            doubt = doubtful_size(structure.varied(field, value).mechanism)
        except RockingError:  # the scan says which values cannot be built
            continue
        if doubt is not None and doubt != doubtful_size(structure.mechanism):
            at = f"{field} = {value:g} {structure.unit_of(field)}".strip()
            terminal.warning(f"at {at}: {doubt}")


def _shaking(chosen: Any, asked: GroundMotions, near: Near) -> Excitation:
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.studies.metrics import Excitation

    compile_first()
    return Excitation([each.motion.scaled(each.factor) for each in chosen], asked.signs, near.around)


def _design(
    structure: Structure, field: str, span: tuple[float, float], until: Aim, excitation: Excitation | None, points: int
) -> Design:
    from rocking_cli.studies.design import design

    with terminal.progress(points, "values") as advance:
        return design(structure, field, span, until, excitation, points=points, progress=advance)


def _draw(found: Design) -> Any:
    from rocking_cli.plotting.design import draw_design

    return draw_design(found)
