"""Which ground motions a command works on, how they are scaled, and what to say of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.doubts import Doubt
    from rocking_cli.excitation.measures import Measures


def check_scaling(scale: float | None, target_pga: float | None, target_pgv: float | None) -> None:
    """Refuse more than one way of scaling, before anything is read."""
    if sum(value is not None for value in (scale, target_pga, target_pgv)) > 1:
        raise click.UsageError("--scale, --target-pga and --target-pgv exclude each other.")


def factor(
    motion: GroundMotion, measured: Measures, scale: float | None, target_pga: float | None, target_pgv: float | None
) -> float:
    """The factor on a motion as read that the options ask for, polarity apart.

    Parameters
    ----------
    motion, measured : GroundMotion, Measures
        The motion and its measures.
    scale : float, optional
        The factor itself.
    target_pga : float, optional
        PGA to reach [g].
    target_pgv : float, optional
        PGV to reach [m/s].

    Returns
    -------
    float
        1 if nothing is asked for.
    """
    if target_pga is None and target_pgv is None:
        return 1.0 if scale is None else scale
    wanted, own = (target_pga, measured.pga) if target_pga is not None else (target_pgv, measured.pgv)
    assert wanted is not None
    if own == 0:
        raise InputError(Problem("the record is zero throughout, and cannot be scaled to a peak", motion.name))
    return wanted / own


def warn(motion: GroundMotion, found: Iterable[Doubt]) -> None:
    """Say on standard error what makes a motion doubtful."""
    for doubt in found:
        terminal.warning(f"{motion.name}: {doubt.text}")
