"""`rk.overturning_map`: map the outcomes of pulses of all periods and amplitudes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.ground_motions import signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.overturning import OverturningMap

ETA = 0.9  # of the linear block


@takes_numbers
def overturning_map(
    structure: StructureLike | None = None,
    *,
    shape: str = "sine",
    model: ModelName = "linear2",
    eta: float | None = None,
    period: tuple[float, float] | None = None,
    ag: tuple[float, float] | None = None,
    omega: tuple[float, float] | None = None,
    a: tuple[float, float] | None = None,
    dimensionless: bool = False,
    polarity: str | int = "1",
    points: int = 128,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> Answer[OverturningMap]:
    """Map the effect of pulses of all periods and amplitudes on a structure, or on the dimensionless linear block.

    Parameters
    ----------
    structure : Mechanism, str or Path, optional
        Structure; without it, the linear block, with the axes omega = omega_g/p and a = a_g/(g lambda).
    shape : str
        Shape of the pulses.
    model : {"linear2", "linear1", "nonlinear"}
        Model of the structure.
    eta : float, optional
        Coefficient of restitution; by default that of the structure, or 0.9.
    period, ag : (float, float), optional
        Smallest and largest period [s] and amplitude [standard gravity], for a structure.
    omega, a : (float, float), optional
        Smallest and largest dimensionless frequency and amplitude, for the linear block.
    dimensionless : bool
        Whether a structure has the axes omega and a as well.
    polarity : {"1", "-1", "both"}
        Polarity of the pulses; with both, the worse governs.
    points : int
        Number of points along each side.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Shown the progress.

    Returns
    -------
    Answer of OverturningMap
        Outcome under every pulse; `regions` has the class of each, unknown outcomes among them.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    Dimensionless amplitude and frequency: DeJong and Dimitrakopoulos (2014), Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> found = rk.overturning_map(points=24)
    >>> found.outcome.overturned.shape
    (24, 24)
    """
    from rocking_cli.studies import overturning as study
    from rocking_cli.studies.under_pulses import linear_block, parse_shape, pulsed_model
    from rocking_cli.views import overturning as views

    form, signs = parse_shape(shape), signs_of(polarity)
    axes = {"period": period, "ag": ag, "omega": omega, "a": a}
    if structure is None:
        mechanism, subject = None, linear_block(ETA if eta is None else eta)
    else:
        ready = structure_of(structure, watch, opening)
        mechanism, subject = ready.mechanism, pulsed_model(ready, model, form, signs, eta)
    bare = dimensionless or mechanism is None
    if model != "nonlinear" or mechanism is None:
        refuse_idle("on a linear block, which has no joints", opening=opening != OPENING)
    right = dict(zip(*(("period", "ag"), ("omega", "a"))[:: 1 if bare else -1], strict=True))
    for name in [name for name, ends in axes.items() if ends is not None and name in right]:
        why = "without a structure" if mechanism is None else "with `dimensionless`" if bare else "with a structure"
        more = "" if bare else ", or add `dimensionless`"
        raise InputError(f"`{name}` has no effect {why}: give `{right[name]}`{more}")
    if bare:
        columns, rows = np.linspace(*(omega or study.OMEGAS), points), np.linspace(*(a or study.AMPLITUDES), points)
    else:
        columns = subject.period(np.linspace(*(period or study.usual_periods([subject])), points))
        rows = np.linspace(*(ag or study.usual_amplitudes([subject])), points) * STANDARD_GRAVITY / subject.unit
    count = study.count_histories([subject], columns.size * rows.size, signs)
    with watch.progress(count, "histories") as progress:
        found = study.overturning_map(subject, form, columns, rows, polarities=signs, progress=progress)
    shown = views.map_view(found, mechanism, dimensionless=bare)
    table, figure = partial(views.map_table, found, mechanism), partial(_figure, found, dimensionless=bare)
    return Answer("overturning map", found, shown, table, figure)


def _figure(found: OverturningMap, *, dimensionless: bool) -> Figure:
    from rocking_cli.plotting.overturning import draw_map
    from rocking_cli.views.overturning import map_title

    return draw_map(found, map_title(found), dimensionless=dimensionless)
