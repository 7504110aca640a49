"""Ground or floor motions in the time histories of a verification."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.floor import Floor

Moves = Literal["as_given", "carried_to_floor", "carried_by_option", "of_floor"]
"""What the motions of histories are: those given, where the site has no floor; ground motions carried to the floor of
the site, or to that given with the records; or motions of the floor, as the user states."""


@dataclass(frozen=True)
class MotionPlace:
    """The kind of motions in the time histories of a verification.

    Parameters
    ----------
    kind : str
        The kind, one of `Moves`.
    floor : str or None
        The floor to which ground motions are carried: period [s], damping ratio, height over that of the building and
        participation factor.
    """

    kind: Moves = "as_given"
    floor: str | None = None


@dataclass(frozen=True)
class Histories:
    """The time histories that are requested for a verification.

    Parameters
    ----------
    motions : sequence of GroundMotion
        The scaled records. If the site has a floor, ground motions are converted to motions of this floor.
    signs : sequence of int
        The polarities: 1, -1 or both.
    state : str, optional
        The limit state to which the records belong; by default the first one.
    on_floor : bool
        Whether the motions are those of the floor of the site, and not of the ground.
    progress : callable
        Called with 1 after each record.
    """

    motions: Sequence[GroundMotion]
    signs: Sequence[int] = (1,)
    state: str | None = None
    on_floor: bool = False
    progress: Callable[[int], object] = int


def where_it_stands(asked: Histories, floor: Floor | None) -> tuple[MotionPlace, Sequence[GroundMotion]]:
    """Return the kind of the motions of histories, and the motions, converted to the floor of a site if there is one.

    Parameters
    ----------
    asked : Histories
        The histories.
    floor : Floor or None
        The floor of the site on which the structure stands; None if it stands on the ground.

    Raises
    ------
    InputError
        If the motions cannot be of the floor, or are mixed.
    """
    motions, carried = asked.motions, [motion.ground is not None for motion in asked.motions]
    if asked.on_floor and floor is None:
        hint = "give `floor` in the site file, or leave the option out"
        raise InputError(Problem("requires a site with a floor", field="`on_floor`", hint=hint))
    if any(carried) and asked.on_floor:
        hint = "leave out one of the two: `floor` carries ground motions to a floor"
        raise InputError(Problem("cannot be combined with `floor`", field="`on_floor`", hint=hint))
    if any(carried) and not all(carried):
        raise InputError(Problem("some of the motions are of a floor, others of the ground: give motions of one kind"))
    if asked.on_floor:
        return MotionPlace("of_floor"), motions
    if carried and all(carried):
        return MotionPlace("carried_by_option", motions[0].processing[-1].removeprefix("floor ")), motions
    if floor is None:
        return MotionPlace(), motions
    return MotionPlace("carried_to_floor", str(floor)), [floor.of(motion) for motion in motions]
