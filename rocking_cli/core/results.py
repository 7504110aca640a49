"""Results of a mechanism: a search for its weakest mechanism, and further ones beside the equivalent block."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class CollapseHinge:
    """A hinge between two groups of blocks: its name, its point at rest [m] and its joint.

    The joint is the pair of blocks that touch at the hinge.
    """

    letter: str
    between: tuple[str, str]
    at: complex
    joint: str = ""


@dataclass(frozen=True)
class CollapseMechanism:
    """Weakest mechanism of one direction.

    Parameters
    ----------
    lambda_ : float
        Ground acceleration over g that starts it.
    lead : str
        The block whose rotation is phi; empty if it slides.
    hinges : sequence of CollapseHinge
        In order from the left.
    groups : sequence of sequence of str
        Blocks that move as one.
    rest, lifted, slides, glued : sequence of str
        Blocks that do not move; joints that open at both ends; joints that slide; joints that carry shear without a
        normal force in the state shown. A joint is named by its two blocks.
    with_usual : float or None
        Lambda if the joints without a coefficient of friction have that usual of masonry; None if all have one.
    no_model : str
        Why its motion cannot be simulated beyond its start, a sentence without a full stop; empty if it can.
    friction_needed : float or None
        The least coefficient of friction of all joints at which lambda stays the same; None if there is none.
    valid_to : float or None
        Rotation at which another joint opens in displaced equilibrium [rad]; None if none opens before the critical
        rotation.
    opens : str
        The joint that opens at `valid_to`.
    held_by : float or None
        G/B at `valid_to`, the acceleration over g of displaced equilibrium.
    thrust : sequence of (str, complex, complex)
        Joint, point [m] and force [N] of one possible state of forces at the start of motion.
    velocities : sequence of (complex, float)
        Velocity of each group at the start of motion, up to a common factor: of its point at (0, 0) [m/s], and its
        rotation rate, anticlockwise [rad/s]. Without them a mechanism that has no rocking model is not drawn.
    idle : sequence of str
        Blocks at rest that may also move at the same lambda: then the mechanism is not the only one with this lambda.
    confined : bool
        Whether blocks are confined between fixed sides, so that mechanisms in which joints slide without opening were
        searched too.
    associated : float or None
        Lambda by associated flow, if a mechanism without dilation has a lower one and is shown; infinite if nothing
        moves by associated flow.
    complete : bool
        Whether the search for mechanisms without dilation was complete; if not, lambda may be even lower.
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
    confined: bool = False
    associated: float | None = None
    complete: bool = True


@dataclass(frozen=True)
class Extra:
    """A result of one direction of rocking, such as the height of the hinge of a wall.

    Parameters
    ----------
    key : str
        Name of the result in JSON, other than those of the parameters of the equivalent block.
    value : float
        Value, in `unit`.
    unit : str
        Unit; empty if dimensionless.
    meaning : str
        Description, in a few words.
    """

    key: str
    value: float
    unit: str
    meaning: str
