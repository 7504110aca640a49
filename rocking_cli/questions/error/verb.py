"""`rk.error`: compute the errors of the equivalent block of a structure."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.error.asked import ErrorAsked
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.questions.error.study import Linearisation


@verb(ErrorAsked)
def error(asked: ErrorAsked, watch: Watcher) -> Answer[list[Linearisation]]:
    """Compute the errors of the equivalent block of a structure, in each direction.

    Returns
    -------
    Answer of list of Linearisation
        One for each distinct direction. `to_frame()` has a row for each direction, kappa and `quantity`: its `value` of
        the structure, and the `ratio` of the equivalent block's value to it, against `amplitude` (phi/phi_cr) or
        `acceleration` (a/lambda). The free period is the same with either kappa.

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
    from rocking_cli.questions.error.view import QUANTITIES, of_quantity, ratios, view

    for name, why_not in (("at", why_no_amplitude), ("a", why_no_acceleration)):
        for value in getattr(asked, name):
            if why := why_not(value):
                raise InputError(Problem(why, field=named(name)))
    ready = structure_of(asked.structure, watch)
    with ready.named():
        curves, marks = compare(ready, asked.at, asked.a)
    shown = view(ready.mechanism, ready.equivalence, curves, marks)
    figure = drawn("questions.error.view.draw_linearisation", curves, marks, heading(ready.mechanism))
    columns = partial(ratios, ready.name, marks, ready.mechanism.gravity)
    dims = [
        Dimensions(("direction", *kappa, *along), (name,), partial(of_quantity, columns, quantity))
        for quantity, (along, _) in QUANTITIES.items()
        for kappa, name in (((), quantity), (("kappa",), f"{quantity}_ratio"))
    ]
    return Answer("linearisation", marks, shown, columns, figure, dims=dims)
