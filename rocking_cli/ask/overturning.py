"""`rk.overturning`: map the pulses that overturn a structure, or compare several structures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structures_of, warn_misleading
from rocking_cli.ask.ground_motions import each_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.overturning_curves import overturning_curves
from rocking_cli.ask.overturning_map import overturning_map
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from rocking_cli.structure import Structure
    from rocking_cli.studies.overturning import Comparison, OverturningMap

PLANE, CURVE = 256, 60  # points, of each side of a map and of a curve
Range = tuple[float, float]


@takes_numbers
def overturning(
    structures: StructureLike | Sequence[StructureLike] = (),
    *,
    compare: bool = False,
    shape: str = "sine",
    model: ModelName | None = None,
    eta: float | None = None,
    polarity: str | int = "1",
    dimensionless: bool = False,
    period: Range | None = None,
    ag: Range | None = None,
    omega: Range | None = None,
    a: Range | None = None,
    points: int | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> Answer[OverturningMap] | Answer[Comparison]:
    """Map the pulses that overturn a structure, or compare several structures.

    This is `overturning_map` of one structure or of the linear block, or `overturning_curves` with `compare`.

    Parameters
    ----------
    structures : Mechanism, str or Path, or a sequence of these
        One structure for a map, several to compare; without any, the dimensionless linear block.
    compare : bool
        Whether to compute the smallest overturning amplitudes of several structures instead of a map.
    shape : str
        Shape of the pulses.
    model : {"linear2", "linear1", "nonlinear"}, optional
        Model of the structure; by default "linear2", or "nonlinear" to compare.
    eta : float, optional
        Coefficient of restitution; by default that of the structure, or 0.9 without one.
    polarity : {"1", "-1", "both"}
        Polarity of the pulses; with both, the worse governs.
    dimensionless : bool
        Whether the map of a structure has the axes omega and a.
    period, ag : (float, float), optional
        Smallest and largest period [s] and amplitude [standard gravity].
    omega, a : (float, float), optional
        Smallest and largest dimensionless frequency and amplitude, on dimensionless axes.
    points : int, optional
        Number of points along each side of a map, 256 by default, or of periods, 60 by default.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Shown the progress, and told which structures cannot be used, and for which the linear models mislead.

    Returns
    -------
    Answer of OverturningMap or Comparison
        As for `overturning_map` and `overturning_curves`.

    Raises
    ------
    InputError
        If a value is out of range, arguments cannot be combined, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 6, with the dimensionless numbers of Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.overturning(points=24).outcome.overturned.shape
    (24, 24)
    """
    ready = structures_of(each_of(structures), watch, opening)
    axes = {"period": period, "ag": ag, "omega": omega, "a": a}
    given = [name for name, ends in axes.items() if ends is not None]
    _check(ready, given, compare=compare, dimensionless=dimensionless, model=model)
    model = model or ("nonlinear" if compare else "linear2")
    if model != "nonlinear":
        warn_misleading(ready, watch)
    if compare:
        return overturning_curves(
            ready, shape=shape, model=model, eta=eta, period=period, top=ag[1] if ag is not None else None,
            polarity=polarity, points=points or CURVE, opening=opening, watch=watch,
        )  # fmt: skip
    return overturning_map(
        ready[0] if ready else None, shape=shape, model=model, eta=eta, period=period, ag=ag, omega=omega, a=a,
        dimensionless=dimensionless, polarity=polarity, points=points or PLANE, opening=opening, watch=watch,
    )  # fmt: skip


def _check(
    structures: Sequence[Structure], given: Sequence[str], *, compare: bool, dimensionless: bool, model: str | None
) -> None:
    """Raise `InputError` if arguments cannot be combined."""
    if compare and len(structures) < 2:
        raise InputError("`compare` needs at least two structures that can be used")
    if not compare and len(structures) > 1:
        raise InputError("a map shows one structure: give one, or `compare` for the curves of several")
    if not structures and model not in (None, "linear2"):
        raise InputError(f"`model` {model} requires a structure: without one, the map is that of the linear block")
    if compare and dimensionless:
        raise InputError("`compare` uses the period in s as its axis: leave out `dimensionless`")
    for name, right in (("omega", "period"), ("a", "ag")):
        if compare and name in given:
            raise InputError(f"`{name}` has no effect with `compare`: give `{right}`")
