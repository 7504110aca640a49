"""`rk.shares`: compute how many neighbours of a motion overturn a structure."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple, Unpack

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError
from rocking_cli.names import OPENING, percent
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.neighbours import neighbours as neighbours_of
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class OutcomeShares(NamedTuple):
    """Shares of the neighbours of a motion by outcome, each from 0 to 1; their sum is 1.

    Parameters
    ----------
    overturned, stands, unknown : float
        Share that overturns, share that is known not to overturn, and share of unknown outcome.
    checked : bool
        Whether the joints of the structure are known; if not, no outcome is unknown.
    """

    overturned: float
    stands: float
    unknown: float
    checked: bool


@takes_numbers
def shares(
    structure: StructureLike,
    motion: Motion,
    *,
    neighbours: int = Neighbourhood.count,
    polarity: str | int = "1",
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[OutcomeShares]:
    """Compute the shares of the neighbours of a motion that overturn, that do not, and whose outcome is unknown.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path
        The ground motion, its file, or a pulse as text.
    neighbours : int
        Number of neighbouring motions to simulate under each polarity, at least 1.
    polarity : {"1", "-1", "both"}
        Polarity of the motion: as given, reversed, or the mean of both.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told what was read, and what is doubtful about it.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of OutcomeShares
        `overturned`, `stands` and `unknown`.

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
    The shares are those that `score` compares with tests. The model is the nonlinear one, Eq. 8 of DeJong and
    Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.shares(rk.Block(width=0.7, height=2.8), "sine:0.39g:0.8s")
    >>> 0.3 < answer.overturned < 0.7
    True
    """
    ready = structure_of(structure, watch, opening)
    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    given = Motions.of(motion, options).one(ready.growth, watch)
    model = ready.model("nonlinear")
    found = [neighbours_of(model, given.motion.scaled(sign * given.factor), around) for sign in signs_of(polarity)]
    overturned = sum(each.overturned for each in found) / len(found)
    unknown = sum(each.unknown or 0.0 for each in found) / len(found)
    result = OutcomeShares(overturned, 1 - overturned - unknown, unknown, model.joints is not None)
    said = f"Of {around.count} neighbours of {given.motion.name}, {percent(overturned)} overturn {ready.name}"
    said += f", and the outcome of {percent(unknown)} is unknown." if unknown else "."
    return Answer("shares", result, View(result._asdict(), [said]), partial(_columns, result), _no_figure)


def _columns(found: OutcomeShares) -> dict[str, list[float]]:
    return {name: [value] for name, value in found._asdict().items()}


def _no_figure() -> Figure:
    raise InputError("shares have no plot of their own: plot the margin")
