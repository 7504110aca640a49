"""The least horizontal acceleration that sets an assembly in motion, and the mechanism of this motion.

The multiplier lambda is the greatest for which forces in the joints balance every block (static theorem); the dual
variables (prices) of that linear programme are the velocities of a mechanism of the same multiplier (kinematic
theorem). Joints carry no
tension. Friction is associated: a joint that slides also opens, which overestimates lambda. Even a small friction can
thus lock a joint between parts that cannot move apart: `confined` searches those for mechanisms without dilation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, DoesNotStand, NoAnswer, NothingMoves, listed
from mechanisms._assembly.confined import Undilated, undilated
from mechanisms._assembly.problem import MAX_MULTIPLIER, ZERO_LOAD, AssemblyProblem, moving
from mechanisms._assembly.unique import kept_rays, mechanisms_of, smallest, velocity_space
from rocking_cli.core import Direction, Guide, Reals

ZERO_RATE = 1e-11  # opening and sliding velocities that count as zero, over the fastest velocity


@dataclass(frozen=True, eq=False)
class Shared:
    """One of several mechanisms of the same multiplier.

    Parameters
    ----------
    multiplier : float
        Multiplier of this mechanism alone; NaN if the live forces do no work on it.
    velocity : ndarray, shape (blocks, 3)
        Velocities of the blocks, as in `Collapse`.
    moves : tuple of str
        Names of the blocks that move.
    """

    multiplier: float
    velocity: Reals
    moves: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Collapse:
    """Weakest mechanism of an assembly.

    Parameters
    ----------
    multiplier : float
        The greatest multiplier that forces in the joints carry, or the least one that starts a mechanism without
        dilation.
    kinematic : float
        The same multiplier, from the work of the forces on the velocities.
    velocity : ndarray, shape (blocks, 3)
        vx, vy of the centroid [m/s] and omega, anticlockwise [rad/s]; the fastest block turns by 1 rad/s, and if none
        turns, the fastest moves by 1 m/s.
    opening : ndarray, shape (contacts, 2)
        Opening velocity of each joint at its start and its end [m/s].
    sliding : ndarray, shape (contacts,)
        Sliding velocity of `b`, from start to end [m/s].
    normal : ndarray, shape (contacts, 2)
        Normal forces at both ends [N] in one of the states that carry the multiplier.
    shear : ndarray, shape (contacts,)
        Force on `b` from start to end [N] in that state.
    guide : ndarray, shape (guides,)
        Force of the ground on each guide, along i times its direction [N].
    unique : bool
        Whether no other mechanism has this multiplier, but for idle blocks.
    several : tuple of Shared
        If not unique, mechanisms with this multiplier, whose combinations are all others.
    idle : tuple of str
        Blocks at rest that may also move at the same multiplier, see `smallest`.
    problem : AssemblyProblem
        The linear programme that was solved.
    associated : float or None
        Multiplier by associated flow, if the mechanism is one without dilation; infinite if nothing moves. Else None.
    confined, complete : bool
        Whether blocks are confined, so that mechanisms without dilation were searched; whether this search was
        complete.
    """

    multiplier: float
    kinematic: float
    velocity: Reals
    opening: Reals
    sliding: Reals
    normal: Reals
    shear: Reals
    guide: Reals
    unique: bool
    several: tuple[Shared, ...]
    idle: tuple[str, ...]
    problem: AssemblyProblem
    associated: float | None = None
    confined: bool = False
    complete: bool = True


def collapse(
    blocks: Sequence[AssemblyBlock],
    contacts: Sequence[AssemblyContact],
    guides: Sequence[Guide] = (),
    direction: Direction = Direction.POSITIVE,
    *,
    dead: Reals | None = None,
    live: Reals | None = None,
    gravity: float = 9.80665,
) -> Collapse:
    """Return the weakest mechanism of an assembly, and the multiplier at which it starts.

    Parameters
    ----------
    blocks : sequence of AssemblyBlock
        Blocks that can move.
    contacts : sequence of AssemblyContact
        Joints of the assembly.
    guides : sequence of Guide
        Supports that restrain a point in both senses.
    direction : Direction
        Direction of the live forces: positive towards +x.
    dead, live : ndarray, shape (blocks, 3), optional
        Permanent forces [N] and moments about the centroid [N m] on each block, and those per unit of the multiplier;
        by default, the weights, and the weights acting horizontally.
    gravity : float
        Gravitational acceleration [m/s2].

    Returns
    -------
    Collapse
        The mechanism, with scaled velocities and one state of forces.

    Raises
    ------
    DoesNotStand
        If the joints cannot balance the dead forces alone, or cannot balance any multiplier above zero, or if confined
        blocks may fall because only compression between their sides holds them.
    NothingMoves
        If the joints can balance any multiplier.
    NoAnswer
        If the solver fails, or if associated flow locks confined blocks that are too many to search.
    """
    problem = AssemblyProblem.of(blocks, contacts, guides, direction, dead=dead, live=live, gravity=gravity)
    rays = problem.bearings.rays()
    falls = problem.why_not(rays)
    if falls:
        raise DoesNotStand(f"it does not stand by itself: nothing holds {listed(falls)}", falls)
    multiplier, forces, raw = problem.greatest(rays, exact=True)
    locked = multiplier >= MAX_MULTIPLIER * (1 - ZERO_LOAD)
    confined = undilated(problem, multiplier)
    if confined is not None:
        if confined.falls:
            raise DoesNotStand(
                f"{listed(confined.falls)} would slide down under weight alone: friction at the sides holds only if "
                "something presses them together, and the file gives no such force. Draw a support from below",
                confined.falls,
            )
        if confined.multiplier is not None:
            return _without_dilation(problem, confined, np.inf if locked else multiplier / problem.strength)
        if locked and not confined.complete:
            raise NoAnswer(
                "friction by associated flow locks its confined blocks, and they are too many to search for all "
                "mechanisms without dilation. Analyse fewer blocks, or leave out what confines them"
            )
    if locked:
        raise NothingMoves("no acceleration sets it in motion", problem.frame.names)
    if multiplier <= ZERO_LOAD:
        # If the joints cannot carry the weight, `moving` returns nothing, and the blocks that lack support are named.
        falls = moving(problem.frame.names, raw, 1e-6) or problem.unheld(rays)[1]
        raise DoesNotStand(f"it barely stands: the least acceleration sets {listed(falls)} in motion", falls)
    kept = kept_rays(rays, problem.dead, problem.live, raw)
    space = velocity_space(rays.rates[kept], problem.frame)
    least = smallest(problem, rays, kept, space)
    fields, idle = ([least[0]], least[1]) if least else (mechanisms_of(rays, kept, space, raw), ())
    # Sort by work of the live forces, then by moving blocks: the search returns mechanisms in any order.
    fields.sort(
        key=lambda field: (
            not _worked_on(problem, field),
            [problem.frame.index[name] for name in moving(problem.frame.names, field, ZERO_LOAD)],
        )
    )
    several = tuple(_shared(problem, field) for field in fields) if len(fields) > 1 else ()
    velocity = _sized(problem, fields[0])
    rates = _rates(problem, velocity)
    state = problem.weight * (rays.mix.T @ forces)
    return Collapse(
        multiplier / problem.strength,
        _kinematic(problem, fields[0]) / problem.strength,
        velocity,
        *problem.by_contact(rates)[:2],
        *problem.by_contact(state),
        len(fields) == 1,
        several,
        idle,
        problem,
        None,
        confined is not None,
        confined is None or confined.complete,
    )


def _without_dilation(problem: AssemblyProblem, mechanism: Undilated, associated: float) -> Collapse:
    """Return the mechanism without dilation of confined blocks."""
    assert mechanism.multiplier is not None
    velocity = _sized(problem, mechanism.field)
    # Sliding without dilation dissipates work; by associated flow no joint does.
    resisted = float((problem.dead + problem.bearings.rates.T @ mechanism.state) @ mechanism.field)
    return Collapse(
        mechanism.multiplier / problem.strength,
        -resisted / float(problem.live @ mechanism.field) / problem.strength,
        velocity,
        *problem.by_contact(_rates(problem, velocity))[:2],
        *problem.by_contact(problem.weight * mechanism.state),
        True,
        (),
        (),
        problem,
        associated,
        True,
        mechanism.complete,
    )


def _kinematic(problem: AssemblyProblem, field: Reals) -> float:
    return -float(problem.dead @ field) / float(problem.live @ field)


def _worked_on(problem: AssemblyProblem, field: Reals) -> bool:
    """Return whether the live forces do work on a mechanism."""
    return abs(float(problem.live @ field)) > ZERO_LOAD * float(np.abs(field).max())


def _sized(problem: AssemblyProblem, field: Reals) -> Reals:
    """Return velocities with units from dimensionless ones, scaled so that the fastest rotation is 1 rad/s.

    If nothing rotates, the fastest block moves by 1 m/s.
    """
    velocity = field.reshape(-1, 3) * np.array([problem.frame.size, problem.frame.size, 1.0])
    turns = np.abs(velocity[:, 2]).max()
    fastest = turns if turns > ZERO_LOAD * np.abs(field).max() else np.abs(velocity).max()
    return np.asarray(velocity / fastest)


def _rates(problem: AssemblyProblem, velocity: Reals) -> Reals:
    """Return the opening and sliding velocities of each joint, with rounding errors set to zero."""
    field = (velocity * np.array([1.0, 1.0, problem.frame.size])).ravel()
    rates: Reals = problem.bearings.rates @ field
    return np.asarray(np.where(np.abs(rates) > ZERO_RATE * np.abs(field).max(), rates, 0.0))


def _shared(problem: AssemblyProblem, field: Reals) -> Shared:
    multiplier = _kinematic(problem, field) / problem.strength if _worked_on(problem, field) else np.nan
    return Shared(multiplier, _sized(problem, field), moving(problem.frame.names, field, ZERO_LOAD))
