"""`rocking margin`: compute how close ground motions are to overturning a structure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Near
from rocking_cli.cli.help import Command
from rocking_cli.errors import INCOMPLETE, InputError
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.dynamics.model import Model
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.studies.neighbours import Neighbourhood


@click.command(cls=Command, short_help="Compute how close ground motions are to overturning.")
@click.argument("file", required=False, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both", default="both")
@options.around
@options.opening
@options.plot("Plot the shares against the scale factor")
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, near=Near)
def command(
    ctx: click.Context, file: str | None, asked: GroundMotions, near: Near, plot: Path | None, as_json: bool
) -> None:  # fmt: skip
    """Compute how close ground motions are to overturning a structure.

    A structure may overturn at one scale factor and survive a larger one, so there is no single critical factor. At
    each of 60 factors from 0.2 to 5, neighbouring motions with slightly different amplitude, slenderness and
    restitution are simulated, and the share of them that overturn is computed. The output gives the factors at which
    this share first reaches 10, 50 and 90 %, and the last factors at which it is below them. If the outcome of some is
    unknown, because a joint opens or slides that the model keeps closed, a second row counts them as overturning. With
    --polarity both, the worse of the two polarities governs.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A motion that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking margin block.yaml --record accel.csv --plot margin.png
      rocking margin frame.yaml --record "records/*.AT2" --polarity 1
      rocking margin --pulse sine:0.5g:0.8s --neighbours 1000
    """
    if not asked:
        raise click.UsageError("No ground motion given: add --record PLACE or --pulse PULSE, each repeatable.")
    asked.check()
    if not near.neighbours:
        raise click.UsageError("rocking margin needs neighbouring motions: --neighbours must be at least 1.")
    from rocking_cli.cli import structures
    from rocking_cli.io.files import keep_apart
    from rocking_cli.views.margin import view

    paths, missing = motion_files.find(asked.records)
    keep_apart([("--plot", plot)], [file, *(str(each.path) for each in paths)])
    structure = structures.prepared([file] if file else [])
    mechanism, model = structure.mechanism, structure.model("nonlinear")
    chosen, refused = motion_files.gather(paths, asked.pulses, asked.reading, asked.scaling, structure.p)
    if not chosen:
        ctx.exit(InputError.exit_code)
    rows = _rows(model, chosen, asked.signs, near.around)
    if plot is not None:
        from rocking_cli.cli.pictures import write_picture
        from rocking_cli.plotting.margin import draw_margins

        write_picture(plot, draw_margins({row.name: row.margin for row in rows}, heading(mechanism)))
    terminal.show(view(mechanism, rows, asked.polarity, near.around), as_json=as_json)
    if missing or refused:
        ctx.exit(INCOMPLETE)


def _rows(model: Model, chosen: list[Scaled], polarities: tuple[int, ...], around: Neighbourhood) -> list[Any]:
    """Return the margin of each motion, with the share of its own neighbours that overturn."""
    from rocking_cli.cli import waiting
    from rocking_cli.studies.margin import FACTORS, margin
    from rocking_cli.views.margin import MarginRow

    rows = []
    each_has = (FACTORS.size + 1) * around.count * len(polarities)
    with waiting.histories(each_has * len(chosen)) as progress:
        for motion, factor, *_ in chosen:
            scaled = motion.scaled(factor)
            found = margin(model, scaled, polarities, around=around, progress=progress)
            rows.append(MarginRow(motion.name, factor, scaled.of_ground.pga_g, found))
    return rows
