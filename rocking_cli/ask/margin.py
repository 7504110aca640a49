"""`rk.margin`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.given import Motion, StructureLike, each_of, motion_of, structure_of
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.studies.margin import Margin


def margin(
    structure: StructureLike, motions: Motion | Sequence[Motion], *, polarities: Sequence[int] = (1, -1)
) -> MappingAnswer[str, Margin]:
    """Compute the scale factors on motions that uplift a structure, and that overturn it.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions
        One or several, as for `respond`.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.

    Returns
    -------
    MappingAnswer of str to Margin
        Margins, by name of the motion.

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
    The model is the nonlinear one, Eq. 8 of DeJong and Dimitrakopoulos (2014), under the neighbours of the motion at
    each of many scale factors.
    """
    from rocking_cli.studies import margin as study
    from rocking_cli.studies.neighbours import Neighbourhood
    from rocking_cli.views import margin as views

    ready, around = structure_of(structure), Neighbourhood()
    shaking = [motion_of(each) for each in each_of(motions)]
    found = {each.name: study.margin(ready.model("nonlinear"), each, polarities, around=around) for each in shaking}
    rows = [views.MarginRow(each.name, 1.0, each.of_ground.pga_g, found[each.name]) for each in shaking]
    polarity = "both" if len(polarities) > 1 else str(polarities[0])

    def columns() -> Columns:
        return {
            "motion": [name for name, each in found.items() for _ in each.factors],
            "factor": np.concatenate([each.factors for each in found.values()]),
            "overturned": np.concatenate([each.overturned for each in found.values()]),
            "unknown": np.concatenate(
                [each.unknown if each.checked else each.unknown + np.nan for each in found.values()]
            ),
        }

    def figure() -> Figure:
        from rocking_cli.plotting.margin import draw_margins

        return draw_margins(found, heading(ready.mechanism))

    return MappingAnswer("margin", found, views.view(ready.mechanism, rows, polarity, around), columns, figure)
