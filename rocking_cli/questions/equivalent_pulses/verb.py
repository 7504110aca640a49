"""`rk.equivalent_pulses`: find the pulses to which several structures are equally vulnerable."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Literal

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, sized_pulse, structure_of, structures_of, warn_misleading
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.pulses import Pulse, parse_pulse
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from rocking_cli.questions.equivalent_pulses.study import EquivalentResponses


@takes_numbers
def equivalent_pulses(
    structures: Sequence[StructureLike],
    pulse: Pulse | str | None = None,
    *,
    ag: float | None = None,
    period: float | None = None,
    shape: str = "sine",
    polarity: str | int = "1",
    kappa: str | int = "2",
    eta: float | Literal["first", "own"] = "first",
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        At least two structures.
    pulse : Pulse or str, optional
        Pulse such as `sine:0.6g:0.8s`, or else `ag`, `period` and `shape`.
    ag, period : float, optional
        Amplitude [standard gravity] and period [s] of the pulse.
    shape : str
        Shape of the pulse.
    polarity : {"1", "-1"}
        Polarity of the pulse; "-1" reverses it.
    kappa : {"1", "2"}
        Equivalent block by which the pulses are scaled: "1" for kappa1, "2" for kappa2.
    eta : float, "first" or "own"
        Coefficient of restitution of all structures: a number, that of the first structure, or that of each.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told which structures cannot be used, and for which the linear models mislead.

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

    if len(structures) < 2:
        raise InputError("give at least two structures: the pulse is for the first, the others get equivalent pulses")
    if str(polarity) not in ("1", "-1") or str(kappa) not in ("1", "2"):
        raise InputError(f"`polarity` must be 1 or -1, and `kappa` 1 or 2, got {polarity!r} and {kappa!r}")
    if eta not in ("first", "own") and not (isinstance(eta, float | int) and 0 < eta <= 1):
        what = f"{eta!r} is not valid: give a number above 0 and at most 1, 'first' or 'own'"
        raise InputError(Problem(what, field="`eta`"))
    if pulse is not None:
        refuse_idle("beside `pulse`", ag=ag is not None, period=period is not None, shape=shape != "sine")
    if pulse is None:
        pulse = sized_pulse(shape, ag, period)
    elif isinstance(pulse, str):
        pulse = parse_pulse(pulse)
    first = structure_of(structures[0], watch, opening)
    ready = structures_of([first, *structures[1:]], watch, opening, least=2)
    scaling: Literal[1, 2] = 1 if str(kappa) == "1" else 2
    result = study.equivalent_pulses(ready, pulse, polarity=int(polarity), kappa=scaling, eta=eta)
    warn_misleading(ready, watch)
    figure = drawn("questions.equivalent_pulses.picture.draw_equivalent", result, views.title(result))
    return Answer("equivalent pulses", result, views.view(result), partial(views.table, result), figure)
