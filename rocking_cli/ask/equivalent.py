"""`rk.equivalent`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.excitation.pulses import Pulse, parse_pulse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.equivalent_pulses import EquivalentResponses


def equivalent(
    structures: Sequence[StructureLike], pulse: Pulse | str, *, polarity: int = 1
) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        At least two structures.
    pulse : Pulse or str
        Pulse such as `sine:0.6g:0.8s`.
    polarity : {1, -1}
        Polarity of the pulse; -1 reverses it.

    Returns
    -------
    Answer of EquivalentResponses
        A pulse and a response for each structure, and for the linear block that they share.

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
    DeJong and Dimitrakopoulos (2014): equal a and omega of Eq. 40, as in Fig. 15.
    """
    from rocking_cli.studies import equivalent_pulses as study
    from rocking_cli.views import equivalent_pulses as views

    given = parse_pulse(pulse) if isinstance(pulse, str) else pulse
    found = study.equivalent([structure_of(each).mechanism for each in structures], given, polarity=polarity)

    def figure() -> Figure:
        from rocking_cli.plotting.equivalent_pulses import draw_equivalent

        return draw_equivalent(found, views.title(found))

    view = views.view(found, " ".join(study.judge(found)))
    return Answer("equivalent pulses", found, view, lambda: views.table(found), figure)
