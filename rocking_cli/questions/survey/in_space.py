"""Objects of a list in three dimensions: what each does there beside what it does in the plane; experimental."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

from rocking_cli.errors import RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import OVERTURNS, UNKNOWN
from rocking_cli.questions.survey.inventory import ListedObject
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import follow
from rocking_cli.studies.engines.space import follow_in_space, follow_twice


class SpaceOutcome(NamedTuple):
    """What an object does under a motion in three dimensions, and in the plane.

    Parameters
    ----------
    motion : str
        Name of the motion.
    outcome, in_plane : str
        What it does, in the words of histories: in three dimensions, and in the plane under the motion alone.
    peak_ratio : float
        Largest tilt over that at which its centroid is above the weaker side of its foot.
    overturning_time : float or None
        When it overturns [s].
    """

    motion: str
    outcome: str
    in_plane: str
    peak_ratio: float
    overturning_time: float | None

    @property
    def differs(self) -> bool:
        """Whether it overturns in one of both and is known not to in the other."""
        return UNKNOWN not in (self.outcome, self.in_plane) and self.topples_in_space != (self.in_plane == OVERTURNS)

    @property
    def topples_in_space(self) -> bool:
        """Whether it overturns in three dimensions."""
        return self.outcome == OVERTURNS


def outcomes_in_space(
    item: ListedObject, structure: Structure, motions: Sequence[GroundMotion], transverse: Sequence[GroundMotion]
) -> list[SpaceOutcome]:
    """Return what an object does in three dimensions under motions of what it stands on.

    An outcome that differs from that in the plane is checked by half of step and softness, and unknown if that differs.

    Parameters
    ----------
    item : ListedObject
        The object.
    structure : Structure
        Its structure in the weaker plane.
    motions, transverse : sequence of GroundMotion
        Components along the weaker side of its foot, with vertical ones if they have any, and across it, or none.

    Raises
    ------
    InputError
        If it is not simulated in three dimensions, or MuJoCo is not installed.
    """
    solid, outcomes = item.solid(), list[SpaceOutcome]()
    for k, motion in enumerate(motions):
        components = motion, transverse[k] if transverse else None, motion.vertical
        try:
            in_plane = follow(structure, motion).words
        except RockingError:  # as of a stocky body, whose restitution is not known
            in_plane = UNKNOWN
        history = follow_in_space(solid, *components)
        outcome = history.outcome
        if (outcome == OVERTURNS) != (in_plane == OVERTURNS):
            outcome = follow_twice(solid, *components).outcome
        time = history.overturning_time
        outcomes.append(
            SpaceOutcome(motion.name, outcome, in_plane, history.peak_ratio, time if isfinite(time) else None)
        )
    return outcomes
