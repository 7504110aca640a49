"""`rk.overturning_curves`: compute the smallest pulses that overturn each of several structures."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structures_of
from rocking_cli.ask.ground_motions import signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import ModelName
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.overturning import Comparison


@takes_numbers
def overturning_curves(
    structures: Sequence[StructureLike],
    *,
    shape: str = "sine",
    model: ModelName = "nonlinear",
    eta: float | None = None,
    period: tuple[float, float] | None = None,
    top: float | None = None,
    polarity: str | int = "1",
    points: int = 60,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        Structures to compare.
    shape, model, eta, polarity, opening
        As for `overturning_map`.
    period : (float, float), optional
        Smallest and largest period [s].
    top : float, optional
        Largest amplitude to try [standard gravity].
    points : int
        Number of periods between them, at equal ratios.
    watch : Watcher
        Shown the progress, and told which structures cannot be used.

    Returns
    -------
    Answer of Comparison
        Smallest amplitudes `least` known to overturn, and the structure that overturns first; overturning starts
        between `possible` and `least` if outcomes below are unknown.

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
    The models are those of `respond`: DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.4, height=5.6)]
    >>> rk.overturning_curves(blocks, model="linear2", points=3).least.shape
    (2, 3)
    """
    from rocking_cli.studies import overturning as study
    from rocking_cli.studies.under_pulses import parse_shape, pulsed_model
    from rocking_cli.views import overturning as views

    form, signs = parse_shape(shape), signs_of(polarity)
    if model != "nonlinear":
        refuse_idle("on linear blocks, which have no joints", opening=opening != OPENING)
    ready = structures_of(structures, watch, opening)
    subjects = [pulsed_model(each, model, form, signs, eta) for each in ready]
    periods = np.geomspace(*(period or study.usual_periods(subjects)), points)
    highest = study.usual_amplitudes(subjects)[1] if top is None else top
    count = study.count_scans(subjects, periods.size, signs)
    with watch.progress(count, "histories") as progress:
        found = study.compare(subjects, form, periods, highest, polarities=signs, progress=progress)
    shown = views.comparison_view(found, [each.mechanism for each in ready])
    return Answer("overturning curves", found, shown, partial(views.comparison_table, found), partial(_figure, found))


def _figure(found: Comparison) -> Figure:
    from rocking_cli.plotting.overturning import draw_comparison
    from rocking_cli.views.overturning import comparison_title

    return draw_comparison(found, comparison_title(found))
