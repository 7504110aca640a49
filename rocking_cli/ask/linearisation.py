"""`rk.linearisation`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.studies.linearisation import Linearisation


def linearisation(
    structure: StructureLike, *, at: Sequence[float] = (0.5,), a: Sequence[float] = (2.0,)
) -> Answer[list[Linearisation]]:
    """Compute the errors of the equivalent block of a structure; see `rocking error`.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    at : sequence of float
        Amplitudes phi/phi_cr for the free period.
    a : sequence of float
        Constant accelerations for the overturning time, as multiples of the uplift acceleration.

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
    """
    from rocking_cli.studies.linearisation import compare
    from rocking_cli.views import error as views

    ready = structure_of(structure)
    curves, found = compare(ready, at, a)

    def columns() -> Columns:
        return {
            "direction": [each.direction.label for each in found for _ in at],
            "phi/phi_cr": [value for _ in found for value in at],
            "period [s]": np.concatenate([each.period for each in found]),
            "period_ratio": np.concatenate([each.period_ratio for each in found]),
        }

    def figure() -> Figure:
        from rocking_cli.plotting.linearisation import draw_linearisation

        return draw_linearisation(curves, found, heading(ready.mechanism))

    view = views.view(ready.mechanism, ready.equivalence, curves, found)
    return Answer("linearisation", list(found), view, columns, figure)
