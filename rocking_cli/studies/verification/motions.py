"""What moves a structure in the time histories of a verification: motions of the ground, or of a floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.floor import Floor

Moves = Literal["as_given", "carried_to_floor", "carried_by_option", "of_floor"]
"""What the motions of histories are: those given, where the site has no floor; ground motions carried to the floor of
the site, or to that given with the records; or motions of the floor, as the user states."""


@dataclass(frozen=True)
class Motions:
    """What moves the structure in histories.

    Parameters
    ----------
    kind : str
        One of `Moves`.
    floor : str or None
        The floor to which ground motions are carried: period [s], damping ratio, height over that of the building and
        participation factor.
    """

    kind: Moves = "as_given"
    floor: str | None = None


def where_it_stands(
    motions: Sequence[GroundMotion], floor: Floor | None, *, on_floor: bool
) -> tuple[Motions, Sequence[GroundMotion]]:
    """Return what the motions of histories are, and ground motions carried to the floor of a site.

    Parameters
    ----------
    motions : sequence of GroundMotion
        As scaled.
    floor : Floor or None
        The floor of the site on which the structure stands; None if it stands on the ground.
    on_floor : bool
        Whether the motions are those of the floor.

    Raises
    ------
    InputError
        If the motions cannot be of the floor, or are mixed.
    """
    carried = [motion.ground is not None for motion in motions]
    if on_floor and floor is None:
        hint = "give `floor` in the site file, or leave the option out"
        raise InputError(Problem("requires a site with a floor", field="`on_floor`", hint=hint))
    if any(carried) and on_floor:
        hint = "leave out one of the two: `floor` carries ground motions to a floor"
        raise InputError(Problem("cannot be combined with `floor`", field="`on_floor`", hint=hint))
    if any(carried) and not all(carried):
        raise InputError(Problem("some of the motions are of a floor, others of the ground: give motions of one kind"))
    if on_floor:
        return Motions("of_floor"), motions
    if carried and all(carried):
        return Motions("carried_by_option", motions[0].processing[-1].removeprefix("floor ")), motions
    if floor is None:
        return Motions(), motions
    return Motions("carried_to_floor", str(floor)), [floor.of(motion) for motion in motions]
