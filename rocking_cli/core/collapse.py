"""The weakest mechanism that a structure of blocks was found to have, as a mechanism tells it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class CollapseHinge:
    """A point about which two groups of blocks turn: what they are called, where it is at rest [m], and its joint.

    The joint is named by the two blocks that touch there.
    """

    letter: str
    between: tuple[str, str]
    at: complex
    joint: str = ""


@dataclass(frozen=True)
class CollapseMechanism:
    """The weakest mechanism of one direction.

    Parameters
    ----------
    lambda_ : float
        Ground acceleration over g that starts it.
    lead : str
        The block whose rotation phi is; empty where it slides.
    hinges : sequence of CollapseHinge
        In order from the left.
    groups : sequence of sequence of str
        Blocks that move as one.
    rest, lifted, slides, glued : sequence of str
        What does not move; joints that open at both ends, that slide, and that carry shear without a normal force in
        the state shown, each by the two that it is of.
    with_usual : float or None
        Lambda with the friction of masonry in joints that have none; None if all have some.
    no_model : str
        Why it cannot be followed further than its start, as a sentence without a full stop; empty if it can.
    friction_needed : float or None
        The least coefficient of friction in every joint that leaves lambda as it is; None: no such.
    valid_to : float or None
        The rotation at which, held displaced, another joint opens [rad]; None: none does before the critical rotation.
    opens : str
        Which joint that is.
    held_by : float or None
        G/B there, the acceleration over g that holds it.
    thrust : sequence of (str, complex, complex)
        Joint, point [m] and force [N] of one state of the forces as it starts.
    velocities : sequence of (complex, float)
        Of each group as it starts: of the point (0, 0) [m/s], and its rotation, anticlockwise [rad/s], at any speed.
        Without them a mechanism that has no rocking model is not drawn.
    idle : sequence of str
        Blocks at rest that may move along at no cost: other mechanisms of this multiplier are this one with them.
    """

    lambda_: float
    lead: str
    hinges: Sequence[CollapseHinge]
    groups: Sequence[Sequence[str]]
    rest: Sequence[str]
    lifted: Sequence[str]
    slides: Sequence[str]
    glued: Sequence[str]
    with_usual: float | None
    no_model: str
    friction_needed: float | None
    valid_to: float | None
    opens: str
    held_by: float | None
    thrust: Sequence[tuple[str, complex, complex]]
    velocities: Sequence[tuple[complex, float]] = ()
    idle: Sequence[str] = ()
