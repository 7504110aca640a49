"""A second program for rocking bodies in the plane, which shares no code and no derivation with the project.

A structure says where its bodies are; T, V and the loads' and springs' parts in them follow, their derivatives by
Cauchy's integral on a small circle, the equation of motion by Lagrange's equation, reactions by virtual work with a
joint let go. A motion is integrated by DOP853 at 1e-12 from event to event. It is slow.

    from tests.oracle import GROUND, Block, Frame, Ground, Wall, reactions, simulate

    tied = Block(1.0, 5.0, mass=1000.0).with_tie((GROUND, 0j), ("block", 0j), k=4e4, n0=2e3)
    floor = tied.with_load("block", 0.2 + 3j, 500.0, weight=0.5, vertical=1 / 3).with_force("block", 4j, 300.0)
    floor.critical(1), floor.eta(1), floor.terms(1, 0.1).dV
    motion = simulate(Wall(0.3, 3.0), Ground([0.0, 0.3, 0.6], [0.0, -15.0, 0.0]), until=5.0)
    motion.impacts[0].time, motion.peaks, motion.ended
    reactions(floor, 1, phi=0.05, rate=0.2, u=-3.0)["foot"].x
    openings(Path("portal.yaml"), Path("accel.csv"), factor=1.75).largest  # of `tests.oracle.openings`; an assembly

Points are x + iy of the structure at rest; forces Fx + i Fy; x to the right, y up, u and v accelerations of the ground.
s = 1 is clockwise, and phi >= 0 in either direction. The foot's middle, of a frame the left one's, is the origin.
"""

from .history import Ground, History, simulate
from .reactions import Force, reactions
from .shapes import Block, Frame, Wall, box
from .structures import GROUND, Piece, Rigid, Structure

__all__ = [
    "GROUND",
    "Block",
    "Force",
    "Frame",
    "Ground",
    "History",
    "Piece",
    "Rigid",
    "Structure",
    "Wall",
    "box",
    "reactions",
    "simulate",
]
