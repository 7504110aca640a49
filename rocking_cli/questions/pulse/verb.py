"""`rk.pulse`: compute the response to a pulse. The dimensionless block needs no numpy."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import MappingAnswer, no_plot
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.pulse.asked import PulseAsked

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.pulse.on_structure import Answer
    from rocking_cli.structure import Structure


@verb(PulseAsked)
def pulse(asked: PulseAsked, watch: Watcher) -> MappingAnswer[Any, Any]:
    """Compute the response to a pulse, of a structure or of the dimensionless linear block.

    Returns
    -------
    MappingAnswer of SampledHistory, ExactResponse or ClosedForm
        For a structure, by polarity, 1 or -1, the responses of the models "linear1", "linear2" and "nonlinear". For the
        linear block, the "exact" solution, and the "closed_form" if the shape is a sine.

    Raises
    ------
    InputError
        If a value is out of range, arguments for a structure and for the linear block are given, or a file cannot be
        used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The closed form is Eqs. 41-42 of DeJong and Dimitrakopoulos (2014), with the dimensionless numbers of Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.pulse(a=4, omega=6)["exact"].overturned
    False
    """
    if asked.on_block:
        return _on_block(asked)
    if asked.structure is None:
        hint = f"give one, or {named('a')} and {named('omega')} for the dimensionless block"
        raise InputError(Problem("is missing", field=named("structure"), hint=hint))
    from rocking_cli.ask.inputs import sized_pulse, structure_figure, structure_of
    from rocking_cli.questions.pulse.on_structure import closed_forms, view, with_conclusion

    sized = sized_pulse(asked.shape, asked.ag, asked.period)
    ready = structure_of(asked.structure, watch, asked.opening)
    by_polarity = with_conclusion(sized, {sign: _answers(ready, sized, sign, watch) for sign in asked.signs})
    shown = view(ready, sized, by_polarity, closed_forms(ready, sized))
    return MappingAnswer(
        "pulse", by_polarity, shown, partial(_columns, by_polarity), partial(structure_figure, ready.mechanism)
    )


def _on_block(asked: PulseAsked) -> MappingAnswer[Any, Any]:
    from rocking_cli.dynamics.exact import SHAPE_CYCLES, closed_form, exact_pulse
    from rocking_cli.questions.pulse.view import view

    a, omega, eta, shape = asked.a, asked.omega, asked.restitution, asked.shape
    if a is None or omega is None:
        missing = named("a" if a is None else "omega")
        raise InputError(Problem("is missing for the dimensionless block", field=missing))
    if shape not in SHAPE_CYCLES:
        hint = f"for other shapes, give a structure, {named('ag')} and {named('period')}"
        what = f"must be one of {', '.join(SHAPE_CYCLES)} on the dimensionless block, got {shape!r}"
        raise InputError(Problem(what, field=named("shape"), hint=hint))
    closed, exact = closed_form(a, omega, eta) if shape == "sine" else None, exact_pulse(a, omega, eta, shape)
    responses = {"exact": exact} if closed is None else {"exact": exact, "closed_form": closed}
    columns: Any = {
        "a": [a],
        "omega": [omega],
        "eta": [eta],
        "peak_ratio": [exact.peak_ratio],
        "outcome": [exact.words],
    }
    figure = no_plot("a pulse on the dimensionless block has no plot", "map many with `overturning`")
    return MappingAnswer("pulse", responses, view(shape, a, omega, eta, closed, exact), lambda: columns, figure)


def _answers(structure: Structure, given: Any, polarity: int, watch: Watcher) -> dict[str, Answer]:
    """Return the responses of the models; warn of those that do not converge with the sampling."""
    from rocking_cli.questions.pulse.on_structure import SampledHistory, answers

    responses = answers(structure, given, polarity)
    for name, run in responses.items():
        if isinstance(run, SampledHistory) and not run.converged:
            watch.warn(f"{name}: not converged with {run.per_period} samples per period: another motion is close")
    return responses


def _columns(found: Mapping[int, Mapping[str, Answer]]) -> Columns:
    from rocking_cli.questions.pulse.on_structure import outcome

    runs = [(sign, name, outcome(one)) for sign, models in found.items() for name, one in models.items()]
    return {
        "polarity": [sign for sign, _, _ in runs],
        "model": [name for _, name, _ in runs],
        "peak_ratio": [run.peak_ratio for _, _, run in runs],
        "outcome": [run.words for _, _, run in runs],
    }
