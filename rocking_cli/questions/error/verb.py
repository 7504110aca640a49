"""`rk.error`: compute the errors of the equivalent block of a structure."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.error.study import Linearisation


@takes_numbers
def error(
    structure: StructureLike,
    *,
    at: Sequence[float] = (0.5,),
    a: Sequence[float] = (2.0,),
    watch: Watcher = SILENT,
) -> Answer[list[Linearisation]]:
    """Compute the errors of the equivalent block of a structure, in each direction.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    at : sequence of float
        Amplitudes phi/phi_cr for the free period.
    a : sequence of float
        Constant accelerations for the overturning time, as multiples of the uplift acceleration.
    watch : Watcher
        Told what is doubtful about the structure.

    Returns
    -------
    Answer of list of Linearisation
        One for each distinct direction.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If an integral does not converge, or the structure does not overturn under an acceleration.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 4: Eq. 24 for the free period, Eq. 25 for the overturning time.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.error(rk.Wall(thickness=0.3, height=3.0), at=[0.3])
    >>> answer.result[0].period_ratio.round(3).tolist()
    [0.963]
    """
    from rocking_cli.questions.error.study import compare, why_no_acceleration, why_no_amplitude
    from rocking_cli.questions.error.view import view

    for field, values, why_not in (("`at`", at, why_no_amplitude), ("`a`", a, why_no_acceleration)):
        for value in values:
            if why := why_not(value):
                raise InputError(Problem(why, field=field))
    ready = structure_of(structure, watch)
    with ready.named():
        curves, marks = compare(ready, at, a)
    shown = view(ready.mechanism, ready.equivalence, curves, marks)
    figure = drawn("questions.error.picture.draw_linearisation", curves, marks, heading(ready.mechanism))
    return Answer("linearisation", marks, shown, partial(_columns, marks), figure)


def _columns(found: Sequence[Linearisation]) -> Columns:
    return {
        "direction": [each.direction.label for each in found for _ in each.amplitude],
        "phi/phi_cr": [value for each in found for value in each.amplitude.tolist()],
        "period [s]": np.concatenate([each.period for each in found]),
        "period_ratio": np.concatenate([each.period_ratio for each in found]),
    }
