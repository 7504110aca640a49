"""`rk.equivalent_pulses`: find the pulses to which several structures are equally vulnerable."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.inputs import sized_pulse, structure_of, structures_of, warn_misleading
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.questions.equivalent_pulses.asked import EquivalentPulsesAsked

if TYPE_CHECKING:
    from rocking_cli.questions.equivalent_pulses.study import EquivalentResponses


@verb(EquivalentPulsesAsked)
def equivalent_pulses(asked: EquivalentPulsesAsked, watch: Watcher) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

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

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.0, height=4.0, restitution=0.9)]
    >>> round(rk.equivalent_pulses(blocks, ag=0.6, period=0.5).a, 3)
    2.4
    """
    from rocking_cli.questions.equivalent_pulses import study
    from rocking_cli.questions.equivalent_pulses import view as views

    pulse: Any = asked.pulse or sized_pulse(asked.shape, asked.ag, asked.period)
    first = structure_of(asked.structures[0], watch, asked.opening)
    ready = structures_of([first, *asked.structures[1:]], watch, asked.opening, least=2)
    result = study.equivalent_pulses(
        ready, pulse, polarity=int(asked.polarity), kappa=1 if asked.kappa == "1" else 2, eta=asked.restitution
    )
    warn_misleading(ready, watch)
    figure = drawn("questions.equivalent_pulses.picture.draw_equivalent", result, views.title(result))
    dims = [Dimensions(("structure", "p_t"))]
    return Answer("equivalent pulses", result, views.view(result), partial(views.table, result), figure, dims=dims)
