"""Statics of a mechanism, and its equivalent single rocking block if it has one [paper, Section 3]."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from enum import IntEnum
from math import isclose, isnan, sqrt, tan
from typing import Literal

import numpy as np

from rocking_cli.core.coefficients import NoCriticalRotation, check_continuous
from rocking_cli.core.kinematics import Direction
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.errors import PluginError, RockingError, StructureError
from rocking_cli.plugins.errors import plugin_error
from rocking_cli.short_repr import short_repr

EQUAL_DIRECTIONS = 1e-9  # relative difference of parameters that count as equal in both directions


class NoEquivalentBlock(StructureError):
    """Error: the structure stands and rocks, but no single block is equivalent to it."""


@short_repr
@dataclass(frozen=True)
class EquivalentBlock:
    """Parameters of the equivalent block in one direction of rocking.

    Parameters
    ----------
    p : float
        Frequency parameter [rad/s].
    phi_cr : float
        Critical rotation of the mechanism [rad].
    lambda_ : float
        Uplift acceleration over g of the mechanism; the block scaled by kappa2 has the same.
    lambda_lin : float
        Uplift acceleration over g of the linearised mechanism; the block scaled by kappa1 has the same.
    kappa1, kappa2 : float
        Ratio of phi to the rotation theta of the equivalent block.
    theta_cr1, theta_cr2 : float
        Critical rotation of the equivalent block [rad], with either kappa.
    eta : float
        Ratio of the rotation rates after and before an impact that ends motion in this direction.
    I_eq, G_eq, B_eq : float
        Linearised inertia [kg m2], restoring moment over g and per rad [kg m], and drive [kg m].
    v_imp : float
        Velocity step of the ground that just overturns the mechanism from rest, without linearisation [m/s].
    """

    p: float
    phi_cr: float
    lambda_: float
    lambda_lin: float
    kappa1: float
    kappa2: float
    theta_cr1: float
    theta_cr2: float
    eta: float
    I_eq: float
    G_eq: float
    B_eq: float
    v_imp: float

    def as_dict(self) -> dict[str, float]:
        """Return the parameters by their public names (`lambda` for `lambda_`)."""
        return {key.rstrip("_"): value for key, value in asdict(self).items()}


@short_repr
@dataclass(frozen=True)
class Equivalence:
    """Equivalent blocks of both directions; of a structure that rocks to one side only, the same block twice."""

    positive: EquivalentBlock
    negative: EquivalentBlock

    def __getitem__(self, direction: Direction) -> EquivalentBlock:
        return self.positive if direction > 0 else self.negative

    @property
    def symmetric(self) -> bool:
        """Whether the blocks of the two directions are equal, to rounding error."""
        return alike(self.positive, self.negative)


def alike(one: EquivalentBlock | Statics, other: EquivalentBlock | Statics) -> bool:
    """Return whether the parameters of two directions are equal, to rounding error."""
    pairs = zip(asdict(one).values(), asdict(other).values(), strict=True)
    return all(_agree(a, b) for a, b in pairs)


def _agree(one: float | str | None, other: float | str | None) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return isclose(one, other, rel_tol=EQUAL_DIRECTIONS, abs_tol=1e-12) or (isnan(one) and isnan(other))
    return (one is None) == (other is None)  # texts count as equal: their numbers may differ by rounding


def equivalent_block(mechanism: Mechanism, known: Sequence[Statics] = ()) -> Equivalence:
    """Return the equivalent single rocking blocks of a mechanism, in both directions.

    Parameters
    ----------
    mechanism : Mechanism
        Any plugin.
    known : sequence of Statics, optional
        Statics of both directions, if they are already computed: see `both_statics`.

    Returns
    -------
    Equivalence

    Raises
    ------
    MechanismError
        If the structure does not stand or is beyond the range of numbers, or the plugin fails.
    NoEquivalentBlock
        If, because of a tie, there is no critical rotation, or the restoring moment does not decrease all the way to
        it.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Eqs. 9-20: local equivalence at the unstable equilibrium.
    """
    with _held_to_numbers(mechanism):
        moments = known or both_statics(mechanism)
        blocks = [_one_direction(mechanism, *each) for each in zip(mechanism.sides, moments, strict=True)]
        return Equivalence(blocks[0], blocks[1])


def one_block(mechanism: Mechanism, direction: Direction, known: Statics) -> EquivalentBlock:
    """Return the equivalent block of one direction from its statics. Raises as `equivalent_block`."""
    with _held_to_numbers(mechanism):
        return _one_direction(mechanism, direction, known)


def both_statics(mechanism: Mechanism) -> tuple[Statics, Statics]:
    """Return the statics of both directions, positive first; needs no equivalent block. Raises `MechanismError`."""
    with _held_to_numbers(mechanism):
        both = [statics(mechanism, direction) for direction in mechanism.directions]
        return both[0], both[-1]


@contextmanager
def _held_to_numbers(mechanism: Mechanism) -> Iterator[None]:
    """Turn arithmetic errors into an error of the structure's sizes (overflow), or else of the plugin."""
    try:
        with np.errstate(all="raise", under="ignore"):
            yield
    except ArithmeticError as error:
        raise _beyond_range(error) from error
    except PluginError as error:
        cause = error.__cause__  # an overflow is caused by sizes that are too large, not by the plugin
        if isinstance(cause, OverflowError) or (isinstance(cause, FloatingPointError) and "overflow" in str(cause)):
            raise _beyond_range(cause) from error
        raise
    except RockingError:
        raise
    except Exception as error:  # the mechanism returned unusable values
        what = f"the mechanism {mechanism.mechanism} does not give what it must"
        raise plugin_error(what, type(mechanism).__module__, error) from error


def _beyond_range(error: BaseException | None) -> StructureError:
    return StructureError(
        f"its equivalent block is beyond the range of numbers ({error}): check the sizes and their units"
    )


def _one_direction(mechanism: Mechanism, direction: Direction, at_rest: Statics) -> EquivalentBlock:
    if at_rest.phi_cr is None or at_rest.why_no_block is not None:
        raise NoEquivalentBlock(
            f"no single block is equivalent to it in the {direction.label} direction: {at_rest.why_no_block}"
        )
    lam, phi_cr = at_rest.lambda_, at_rest.phi_cr
    critical = mechanism.coefficients(np.array([phi_cr]), direction)
    I_eq, B_eq = float(critical.I[0]), float(critical.B[0])  # Eq. 13
    G_eq = -float(critical.stiffness(mechanism.gravity)[0])  # Eq. 13, with -V''(phi_cr)/g in place of -G'
    kappa1 = B_eq / G_eq  # Eq. 15
    lambda_lin = phi_cr / kappa1  # Eqs. 18-19
    kappa2 = phi_cr / lam  # Eq. 20
    return EquivalentBlock(
        p=sqrt(mechanism.gravity * G_eq / I_eq),  # Eq. 17
        phi_cr=phi_cr,
        lambda_=lam,
        lambda_lin=lambda_lin,
        kappa1=kappa1,
        kappa2=kappa2,
        theta_cr1=lambda_lin,  # Eq. 17: phi_cr/kappa1
        theta_cr2=lam,  # Eq. 17: phi_cr/kappa2
        eta=mechanism.eta(direction),
        I_eq=I_eq,
        G_eq=G_eq,
        B_eq=B_eq,
        v_imp=impulse_velocity(mechanism, direction, phi_cr),
    )


def impulse_velocity(mechanism: Mechanism, direction: Direction, phi_cr: float) -> float:
    """Return the velocity step of the ground that just overturns a structure from rest [m/s].

    The step v gives the structure the rotation rate B(0) v/I(0), with which its kinetic energy just suffices to reach
    phi_cr.
    """
    at = mechanism.coefficients(np.array([0.0, phi_cr]), direction)
    stored = mechanism.gravity * at.V[1] + at.U[1]
    # By rounding, the energy may be negative if the structure is about to overturn by itself.
    return sqrt(2 * float(at.I[0]) * max(float(stored), 0.0)) / float(at.B[0])


JUMP_SEARCH_STEPS = 128  # steps to the critical rotation, between which jumps of the motion are searched
MAX_CURVATURE = 0.25  # departure from the straight line 1 - phi/phi_cr, over V'(0), beyond which linear models mislead


@dataclass(frozen=True)
class Statics:
    """Statics of a structure in one direction of rocking.

    Parameters
    ----------
    lambda_ : float
        Uplift acceleration over g.
    phi_cr : float or None
        Critical rotation [rad]; None if there is none before the kinematic limit.
    limit : float
        Kinematic limit of the motion [rad].
    stiffening : float
        V''(0)/V'(0), relative slope of the restoring moment at rest [1/rad]; negative if the moment decreases, as that
        of a free block does.
    departure : float
        Largest difference of V'/V'(0) from the straight line 1 - phi/phi_cr; NaN without a critical rotation.
    why_no_block : str or None
        Why no single block is equivalent to the structure, a sentence without a full stop; None if one is.
    yields : float or None
        Rotation at which a tie of steel yields before the critical one, or the limit [rad]; None if none does.
    """

    lambda_: float
    phi_cr: float | None
    limit: float
    stiffening: float
    departure: float
    why_no_block: str | None
    yields: float | None = None

    @property
    def reference(self) -> float:
        """Rotation by which rotations are divided [rad]: the critical one, or else the kinematic limit."""
        return self.limit if self.phi_cr is None else self.phi_cr


def statics(mechanism: Mechanism, direction: Direction) -> Statics:
    """Return the statics of a structure in one direction of rocking.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with its loads and ties.
    direction : Direction
        Direction of rocking.

    Raises
    ------
    MechanismError
        If the structure does not stand, no ground motion starts it, or a body jumps.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Eqs. 9-10, with V' = g G + Q in place of g G. A block is equivalent only if
    there is a critical rotation and V'' < 0 at all smaller rotations.
    """
    lam = mechanism.uplift(direction)  # Eq. 10
    limit = mechanism.limit(direction)
    try:
        phi_cr: float | None = mechanism.critical_rotation(direction)  # Eq. 9
    except NoCriticalRotation:
        if not mechanism.attached:
            raise
        phi_cr, why = None, f"its restoring moment does not vanish before the kinematic limit of {limit:.4g} rad"
    rotations = np.linspace(0.0, limit if phi_cr is None else phi_cr, JUMP_SEARCH_STEPS + 1)
    here = mechanism.coefficients(rotations if phi_cr is not None else rotations[:-1], direction)
    check_continuous(mechanism.mechanism, direction, here, mechanism.jumps)
    moment, slope = here.restoring(mechanism.gravity), here.stiffness(mechanism.gravity)
    departure = float("nan")
    if phi_cr is not None:
        departure = float(np.abs(moment / moment[0] - (1 - rotations / phi_cr)).max())
        rises = mechanism.bends and (slope >= 0).any()
        cause = ": what ties it stiffens it" if mechanism.attached else ""
        why = f"its restoring moment does not fall all the way from rest{cause}" if rises else ""
    bound = mechanism.yields(direction, float(rotations[-1 if phi_cr is not None else -2]))
    if bound is not None:
        why = f"the tie {bound.name} yields at {bound.phi:.4g} rad, before its restoring moment vanishes"
    why = mechanism.hung.fault("equivalent block") or why
    at_yield = None if bound is None else bound.phi
    return Statics(lam, phi_cr, limit, float(slope[0] / moment[0]), departure, why or None, at_yield)


# The paper finds small errors with either kappa for walls of alpha < 0.2: lambda_lin/lambda = 0.2/tan(0.2) there.
SLENDER_LAMBDA_RATIO = 0.2 / tan(0.2)
# Errors up to which a block agrees with its structure, and up to which it is good for a first estimate.
SMALL_ERROR, LARGE_ERROR = (0.05, 0.15)


class Grade(IntEnum):
    """Grade of an equivalent block, from good to bad."""

    AGREES = 0
    ESTIMATE = 1
    DISREGARD = 2

    @property
    def key(self) -> str:
        """Name of the grade in JSON."""
        return ("agrees", "first_estimate", "disregard")[self]


def grade(error: float, small: float = SMALL_ERROR, large: float = LARGE_ERROR) -> Grade:
    """Return the grade of an equivalent block with this error; NaN counts as too large.

    Parameters
    ----------
    error : float
        Relative error of either sign.
    small, large : float
        Largest errors at which the block agrees, and is good for a first estimate.

    Examples
    --------
    >>> grade(-0.04).key, grade(0.1).key, grade(0.2).key
    ('agrees', 'first_estimate', 'disregard')
    """
    size = abs(error)
    return Grade.AGREES if size <= small else Grade.ESTIMATE if size <= large else Grade.DISREGARD


def uplift_error(equivalence: Equivalence) -> float:
    """Return the relative error of the uplift acceleration with kappa1, in the direction where it is larger.

    With kappa2 this error is zero.
    """
    errors = [equivalence[each].lambda_lin / equivalence[each].lambda_ - 1 for each in Direction]
    return max(errors, key=abs)


def preferred_kappa(block: EquivalentBlock) -> Literal["kappa2", "either"]:
    """Return which kappa to use for an equivalent block, judged by the uplift of the linearised mechanism alone.

    lambda_lin/lambda is the paper's measure of effective slenderness: 1 for a slender structure, for which either will
    do.
    """
    return (
        "either" if SLENDER_LAMBDA_RATIO <= block.lambda_lin / block.lambda_ <= 1 / SLENDER_LAMBDA_RATIO else "kappa2"
    )
