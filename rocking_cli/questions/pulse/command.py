"""`rocking pulse`: compute the response to a pulse, of the dimensionless block or of a structure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.quantities import POSITIVE


@click.command(short_help="Compute the response to a pulse.")
@click.argument("file", required=False, type=click.Path())
@options.sized_pulse("1", "-1", "both")
@click.option("--a", type=POSITIVE, help=options.HELP["a"])
@click.option("--omega", type=POSITIVE, help=options.HELP["omega"])
@click.option("--eta", type=click.FloatRange(0, 1, min_open=True), help=f"{options.HELP['eta']}  [default: 0.9]")
@options.opening
@options.as_json
def command(file: str | None, as_json: bool, **question: Any) -> None:
    """Compute the response of a structure, or of the dimensionless linear block, to a pulse.

    With --a and --omega, the command computes the response of the linear block. The closed form (Eqs. 41-42) is for one
    full sine and is valid only under three conditions. Each condition is checked, and the exact solution of the same
    equation is given for comparison. Rotations are divided by the critical rotation; times are tau = p t from uplift.

    With --ag and --period, the command computes the response of the structure in FILE, by its equivalent blocks with
    kappa1 and kappa2 and by its nonlinear time history; --polarity both gives one polarity after the other.
    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking pulse --a 4 --omega 6 --eta 0.9
      rocking pulse frame.yaml --ag 0.4g --period 0.8 --polarity both

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 40-42.
    """
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.questions.pulse.verb import pulse

    structure: str | Path | None = file
    if file is None and (question["ag"] is not None or question["period"] is not None or question["polarity"] != "1"):
        from rocking_cli.ask.given import LOCAL_FILE

        structure = LOCAL_FILE
    terminal.show(pulse(structure, watch=OnTerminal(), **question).view, as_json=as_json)
