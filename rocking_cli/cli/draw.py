"""`rocking draw`: draw a structure at rest and displaced."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.pictures import write_picture
from rocking_cli.cli.quantities import Finite
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.studies.picture import Picture


def _ratio(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    if value is not None and not value > 0:
        raise click.BadParameter(f"{value:g} is not a valid multiple of phi_cr: give a number above 0.", ctx, param)
    return value


@click.command(short_help="Draw a structure at rest and displaced, with dimensions.")
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--at", "ratio", type=Finite(), metavar="RATIO", callback=_ratio,
    help="Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr.  "
    "[default: 1, 0.1]",
)  # fmt: skip
@options.plot("Output file", "[default: FILE with .png, in this folder; none with --json]")
@options.as_json
def command(file: str | None, ratio: float | None, plot: Path | None, as_json: bool) -> None:
    """Draw a structure at rest with its dimensions, and displaced in both directions, to scale.

    Check the drawing before you trust a number: is this the intended mechanism, and were the dimensions read correctly?
    It shows the bodies, the hinges with the letters of the paper, the centroids, and R and alpha or the angles of the
    linkage; for an arch, the voussoirs and the line of thrust at uplift; the loads, the ties (dashed if slack), and the
    walls behind a structure that rocks in one direction only.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking draw frame.yaml
      rocking draw arch.yaml --at 0.5 --plot arch.svg
    """
    from rocking_cli.cli import structures
    from rocking_cli.errors import InputError, Problem
    from rocking_cli.io.files import check_writable, keep_apart
    from rocking_cli.views.draw import view

    if plot is None and not as_json:
        plot = Path(f"{structures.stem(file)}.png")
        check_writable(plot)
    keep_apart([("--plot", plot)], [file])
    mechanism = structures.load([file] if file else [])[0]
    shown = _picture(mechanism)
    if ratio is not None and ratio > shown.furthest:
        of = "the limit" if None in shown.phi_cr.values() else "phi_cr"
        hint = f"at most {shown.furthest:.4g} times {of}"
        raise InputError(
            Problem(f"{ratio:g} times {of} is beyond the kinematic limit of the mechanism", field="--at", hint=hint)
        )
    if plot is not None:
        from rocking_cli.plotting.structure import draw_structure

        write_picture(plot, draw_structure(shown, heading(mechanism), ratio))
    terminal.show(view(shown), as_json=as_json)


def _picture(mechanism: Mechanism) -> Picture:
    from rocking_cli.errors import MechanismError, of_structure
    from rocking_cli.studies.picture import picture

    try:
        return picture(mechanism)
    except MechanismError as error:
        raise of_structure(error, mechanism.name or mechanism.mechanism) from error
