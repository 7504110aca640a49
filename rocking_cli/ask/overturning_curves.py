"""`rk.overturning_curves`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.dynamics.model import ModelName

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.overturning import Comparison


def overturning_curves(
    structures: Sequence[StructureLike],
    *,
    shape: str = "sine",
    model: ModelName = "nonlinear",
    period: tuple[float, float] | None = None,
    top: float | None = None,
    polarities: Sequence[int] = (1,),
    points: int = 60,
) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        Structures to compare.
    shape, model, polarities
        As for `overturning_map`.
    period : (float, float), optional
        Smallest and largest period [s].
    top : float, optional
        Largest amplitude to try [standard gravity].
    points : int
        Number of periods between them, at equal ratios.

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
    """
    from rocking_cli.studies import overturning as study
    from rocking_cli.studies.under_pulses import parse_shape, pulsed_model
    from rocking_cli.views import overturning as views

    form, ready = parse_shape(shape), [structure_of(each) for each in structures]
    subjects = [pulsed_model(each, model, form, polarities) for each in ready]
    periods = np.geomspace(*(period or study.usual_periods(subjects)), points)
    found = study.compare(subjects, form, periods, top or study.usual_amplitudes(subjects)[1], polarities=polarities)

    def figure() -> Figure:
        from rocking_cli.plotting.overturning import draw_comparison

        return draw_comparison(found, views.comparison_title(found))

    view = views.comparison_view(found, [each.mechanism for each in ready])
    return Answer("overturning curves", found, view, lambda: views.comparison_table(found), figure)
