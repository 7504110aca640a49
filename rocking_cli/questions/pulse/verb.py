"""`rk.pulse`: compute the response to a pulse. The dimensionless block needs no numpy."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import MappingAnswer, no_plot
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rocking_cli.ask.given import StructureLike
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.pulse.study_on_structure import Answer
    from rocking_cli.structure import Structure

ETA = 0.9


@takes_numbers
def pulse(
    structure: StructureLike | None = None,
    *,
    ag: float | None = None,
    period: float | None = None,
    shape: str = "sine",
    polarity: str | int = "1",
    a: float | None = None,
    omega: float | None = None,
    eta: float | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> MappingAnswer[Any, Any]:
    """Compute the response to a pulse, of a structure or of the dimensionless linear block.

    Parameters
    ----------
    structure : Mechanism, str or Path, optional
        The structure, or its YAML file; without it, the dimensionless linear block.
    ag, period : float, optional
        Amplitude [standard gravity] and period [s] of the pulse on a structure.
    shape : str
        Shape of the pulse: "sine", "cosine", "half_sine", "rectangular", and for a structure any other.
    polarity : {"1", "-1", "both"}
        Polarity of the pulse on a structure: as given, reversed, or one after the other.
    a, omega : float, optional
        Dimensionless amplitude a_g/(g lambda) and frequency omega_g/p of the pulse on the linear block.
    eta : float, optional
        Coefficient of restitution of the linear block; 0.9 by default. That of a structure is in its file.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told of histories that do not converge with the sampling of the pulse.

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
    for_block = [name for name, value in (("a", a), ("omega", omega), ("eta", eta)) if value is not None]
    options = {"ag": ag, "period": period, "polarity": None if str(polarity) == "1" else polarity}
    for_structure = [f"`{name}` for a structure" for name, value in options.items() if value is not None]
    if structure is not None:
        for_structure.append("a structure is given")
    if for_block and for_structure:
        more = "." if eta is None else " (eta is `restitution` in its file)."
        raise InputError(
            f"`{for_block[0]}` is for the dimensionless block, {for_structure[0]}: give `a` and `omega`, or a "
            f"structure with `ag` and `period`{more}"
        )
    if not for_structure:
        refuse_idle("on the dimensionless block, which has no joints", opening=opening != OPENING)
        return _on_block(a, omega, ETA if eta is None else eta, shape)
    if structure is None:
        raise InputError(Problem("is missing", field="structure", hint="give one, or `a` and `omega` without `ag`"))
    from rocking_cli.ask.given import sized_pulse, structure_figure, structure_of
    from rocking_cli.ask.ground_motions import signs_of
    from rocking_cli.questions.pulse.study_on_structure import closed_forms, with_conclusion
    from rocking_cli.questions.pulse.view_on_structure import view

    signs, sized, ready = signs_of(polarity), sized_pulse(shape, ag, period), structure_of(structure, watch, opening)
    by_polarity = with_conclusion(sized, {sign: _answers(ready, sized, sign, watch) for sign in signs})
    shown = view(ready, sized, by_polarity, closed_forms(ready, sized))
    return MappingAnswer(
        "pulse", by_polarity, shown, partial(_columns, by_polarity), partial(structure_figure, ready.mechanism)
    )


def _on_block(a: float | None, omega: float | None, eta: float, shape: str) -> MappingAnswer[Any, Any]:
    from rocking_cli.dynamics.exact import SHAPE_CYCLES, closed_form, exact_pulse
    from rocking_cli.questions.pulse.view import view

    if a is None or omega is None:
        missing = [f"`{name}`" for name, value in (("a", a), ("omega", omega)) if value is None]
        raise InputError(
            f"{' and '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing: give `a` and `omega` for the "
            "dimensionless block, or a structure with `ag` and `period`"
        )
    if shape not in SHAPE_CYCLES:
        raise InputError(
            f"the dimensionless block accepts the shapes {', '.join(SHAPE_CYCLES)}, not {shape!r}: for other shapes, "
            "give a structure, `ag` and `period`"
        )
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
    from rocking_cli.questions.pulse.study_on_structure import SampledHistory, answers

    responses = answers(structure, given, polarity)
    for name, run in responses.items():
        if isinstance(run, SampledHistory) and not run.converged:
            watch.warn(f"{name}: not converged with {run.per_period} samples per period: another motion is close")
    return responses


def _columns(found: Mapping[int, Mapping[str, Answer]]) -> Columns:
    from rocking_cli.questions.pulse.study_on_structure import outcome

    runs = [(sign, name, outcome(one)) for sign, models in found.items() for name, one in models.items()]
    return {
        "polarity": [sign for sign, _, _ in runs],
        "model": [name for _, name, _ in runs],
        "peak_ratio": [run.peak_ratio for _, _, run in runs],
        "outcome": [run.words for _, _, run in runs],
    }
