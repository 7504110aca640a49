"""The answer of a design in steel: bars that give the force that a tie needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from rocking_cli.core import Mechanism
from rocking_cli.core.hung.element import Spring
from rocking_cli.core.hung.ties import BAR_DIAMETERS, STEELS, SteelName, Tie, TieStrength, circle, tie_strength
from rocking_cli.io.dotted import words
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure

MAX_BARS = 4  # largest number of bars proposed for a tie that does not give it
MAX_PROPOSALS = 2  # the fewest bars that suffice, and more bars of a smaller diameter
DEFAULT_STEEL: SteelName = "S235"


class Bars(NamedTuple):
    """Bars of one tie: number (not whole if it follows from a spacing), diameter [m] and strength."""

    number: float
    diameter: float
    strength: TieStrength


@short_repr
@dataclass(frozen=True)
class SteelAnswer:
    """The force that a tie needs, and bars that give it.

    Parameters
    ----------
    tie : str
        Name of the tie.
    force : float
        The force that it needs [N].
    steel : str or None
        Name of the steel; None if the tie gives its yield stress.
    stress : float
        Yield stress of the steel [Pa].
    spacing : float or None
        Distance between the bars, if the tie gives it [m].
    anchored : bool
        Whether the plates of the tie, one for each bar, are counted.
    proposals : sequence of Bars
        Bars whose strength is at least the force, the fewest first; empty if no bars of the list suffice.
    """

    tie: str
    force: float
    steel: str | None
    stress: float
    spacing: float | None
    anchored: bool
    proposals: Sequence[Bars]


def steel_answer(
    structure: Structure, field: str, value: float, other: float, *, of_code: bool = False
) -> SteelAnswer | None:
    """Return the bars that give the least force of a tie that meets a requirement.

    Parameters
    ----------
    structure : Structure
        The structure.
    field : str
        The field that varies.
    value, other : float
        The value that is the answer, and the other end of the range in which the requirement is met.
    of_code : bool
        Whether the requirement is on a number of a code, for which ties of steel act with their strength.

    Returns
    -------
    SteelAnswer or None
        None unless the field varies the constant force of a tie, and the answer is the least.
    """
    path = words(field)
    if path[0] != "ties" or len(path) < 3 or path[2] in ("plate", "wall"):
        return None
    chosen, largest = (structure.varied(field, each).mechanism for each in (value, other))
    if of_code:
        chosen, largest = chosen.at_strength(), largest.at_strength()
    tie = _named(chosen, path[1])
    force, more = (_constant_force(each, tie.name) for each in (chosen, largest))
    if force is None or more is None or not 0 < force < more:
        return None
    stress = tie.yield_of_steel if tie.is_steel else STEELS[DEFAULT_STEEL]
    steel = tie.steel if tie.is_steel else DEFAULT_STEEL
    spacing = tie.spacing if path[2] != "spacing" else None
    known = tie.bars is not None or spacing is not None
    counts = [tie.number_of_bars(chosen.depth)] if known else [float(count) for count in range(1, MAX_BARS + 1)]
    proposals: list[Bars] = []
    for count in counts:
        bars = _thinnest(tie, stress, count, force)
        if bars is not None and (not proposals or bars.diameter < proposals[-1].diameter):
            proposals.append(bars)
    return SteelAnswer(tie.name, force, steel, stress, spacing, tie.plate is not None, proposals[:MAX_PROPOSALS])


def _named(mechanism: Mechanism, word: str) -> Tie:
    ties = {tie.name: tie for tie in mechanism.ties or []}
    return ties[word] if word in ties else list(ties.values())[int(word)]


def _constant_force(mechanism: Mechanism, name: str) -> float | None:
    """Return the force of a tie that does not depend on its elongation [N]; None if it does."""
    element = next(each for each in mechanism.hung.ties if each.name == name)
    return element.prestress if isinstance(element, Spring) and element.stiffness == 0 else None


def _thinnest(tie: Tie, stress: float, count: float, force: float) -> Bars | None:
    """Return the bars of the smallest diameter with at least this strength; None if none has it."""
    stress /= tie.gamma or 1
    every = (Bars(count, d, tie_strength(circle(d), stress, count, tie.plate, tie.wall)) for d in BAR_DIAMETERS)
    return next((bars for bars in every if bars.strength.force >= force), None)
