"""Errors of the equivalent block against its mechanism: the paper's three measures, for any structure.

Free rocking period (Eq. 24), uplift acceleration, and overturning time under a constant acceleration (Eq. 25), each as
the ratio of the equivalent block's value to the mechanism's. The mechanism's times are integrals of its energy
equation, in the variable in which the equivalent block's own integrand is constant. The remaining integrand is smooth
up to phi_cr and down to the uplift acceleration, so that Gauss's rule converges fast.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Equivalence, EquivalentBlock, Mechanism, equivalent_block
from rocking_cli.core.equivalence import Grade, grade, preferred_kappa
from rocking_cli.errors import SolverError
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure

NODES_TOLERANCE = 1e-10  # relative change at which doubling the nodes stops
MIN_NODES, MAX_NODES = 16, 512  # nodes of the integration along the motion
ENERGY_NODES = 20  # nodes of the integration of energy between two rotations
# Tolerance, most nodes and energy nodes, if derivatives of the restoring moment have corners.
ROUGH_INTEGRATION = (1e-5, 128, 100)
CURVE_POINTS = 60
MAX_CURVE_STRENGTH = 10.0  # acceleration over uplift acceleration at which the curves end
MIN_RATIO_DISTANCE = 1e-6  # distance of phi/phi_cr from 0 and from 1 that energies still resolve
MAX_STRENGTH = 1e6  # largest acceleration over the uplift acceleration


@short_repr
@dataclass(frozen=True, eq=False)
class Linearisation:
    """Ratios of the equivalent block's values to the mechanism's in one direction; a ratio of 1 is no error.

    Parameters
    ----------
    direction : Direction
        Direction of rocking.
    block : EquivalentBlock
        The equivalent block of this direction.
    amplitude : ndarray, shape (n,)
        Amplitude phi/phi_cr of the free motion.
    period : ndarray, shape (n,)
        Period of the mechanism [s], four times its quarter in this direction.
    period_ratio : ndarray, shape (n,)
        Ratio of the block's period to that of the mechanism [Eq. 24].
    uplift_ratio1, uplift_ratio2 : float
        Uplift acceleration of the block with kappa1 and kappa2 over the mechanism's; the second ratio is 1.
    acceleration : ndarray, shape (m,)
        Constant acceleration over the uplift acceleration of the mechanism, a/lambda.
    overturning : ndarray, shape (m,)
        Time from rest to phi_cr [s].
    overturning_ratio1, overturning_ratio2 : ndarray, shape (m,)
        Overturning time of the block with kappa1 and kappa2 over `overturning` [Eq. 25]; infinite if it does not
        uplift.
    """

    direction: Direction
    block: EquivalentBlock
    amplitude: Reals
    period: Reals
    period_ratio: Reals
    uplift_ratio1: float
    uplift_ratio2: float
    acceleration: Reals
    overturning: Reals
    overturning_ratio1: Reals
    overturning_ratio2: Reals


def why_no_amplitude(ratio: float) -> str:
    """Return why a number cannot be an amplitude phi/phi_cr of a free motion; empty if it can."""
    if 0 < ratio < 1 and not MIN_RATIO_DISTANCE <= ratio <= 1 - MIN_RATIO_DISTANCE:
        return (
            f"an amplitude must stay {MIN_RATIO_DISTANCE:g} of phi_cr away from 0 and 1, where rounding hides it; "
            f"got {ratio:g}"
        )
    return "" if 0 < ratio < 1 else f"an amplitude must be a fraction of phi_cr between 0 and 1, got {ratio:g}"


def why_no_acceleration(times: float) -> str:
    """Return why a number cannot be a constant acceleration over the uplift acceleration; empty if it can."""
    if not (times > 1 and np.isfinite(times)):
        return f"an acceleration must be above 1 times that of uplift to move anything, got {times:g}"
    if not 1 + MIN_RATIO_DISTANCE <= times <= MAX_STRENGTH:
        return (
            f"an acceleration must be {1 + MIN_RATIO_DISTANCE:.7g} to {MAX_STRENGTH:g} times that of uplift, "
            f"got {times:.17g}"
        )
    return ""


def linearisation(
    mechanism: Mechanism,
    direction: Direction,
    amplitude: ArrayLike = (),
    acceleration: ArrayLike = (),
    *,
    equivalence: Equivalence | None = None,
) -> Linearisation:
    """Compare a mechanism with its equivalent block in one direction.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    direction : Direction
        Direction of rocking.
    amplitude : array of float
        phi/phi_cr of free motions, in (0, 1).
    acceleration : array of float
        Constant accelerations over the uplift acceleration, above 1.
    equivalence : Equivalence, optional
        The equivalent blocks of the structure, if they are known already.

    Returns
    -------
    Linearisation

    Raises
    ------
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If an integral does not converge, or the mechanism does not overturn under an acceleration.
    """
    r, rho = np.atleast_1d(np.asarray(amplitude, float)), np.atleast_1d(np.asarray(acceleration, float))
    block = (equivalence or equivalent_block(mechanism))[direction]
    period = free_period(mechanism, direction, r)
    time = overturning_time(mechanism, direction, rho, block.lambda_)
    lin = block.lambda_lin / block.lambda_
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.where(rho > lin, rho / lin - 1, np.nan)
        with_kappa1 = np.where(rho > lin, np.arccosh(1 + 1 / excess) / block.p, np.inf)  # Eq. 25
    return Linearisation(
        direction=direction,
        block=block,
        amplitude=r,
        period=period,
        period_ratio=4 / block.p * np.arccosh(1 / (1 - r)) / period,  # Eq. 24
        uplift_ratio1=lin,
        uplift_ratio2=block.theta_cr2 / block.lambda_,
        acceleration=rho,
        overturning=time,
        overturning_ratio1=with_kappa1 / time,
        overturning_ratio2=np.arccosh(1 + 1 / (rho - 1)) / block.p / time,  # Eq. 25 with lambda
    )


def compare(
    structure: Structure, amplitudes: Sequence[float], accelerations: Sequence[float]
) -> tuple[list[Linearisation], list[Linearisation]]:
    """Return the errors of the blocks over whole ranges and at the requested values; of one direction if both agree."""
    structure.ask("linear models")
    mechanism, equivalence = structure.mechanism, structure.equivalence
    directions = [mechanism.directions[0]] if equivalence.symmetric else list(Direction)

    def of(ratios: ArrayLike, times: ArrayLike) -> list[Linearisation]:
        return [linearisation(mechanism, each, ratios, times, equivalence=equivalence) for each in directions]

    marks = of(amplitudes, accelerations)
    strongest = max(MAX_CURVE_STRENGTH, *accelerations)
    return of(np.linspace(0.01, 0.99, CURVE_POINTS), np.geomspace(1.02, strongest, CURVE_POINTS)), marks


class Errors(NamedTuple):
    """Largest errors of an equivalent block at the requested amplitudes, in the worse of the two directions.

    Parameters
    ----------
    uplift : float
        Relative error of the uplift acceleration, with its sign.
    period, overturning : float
        Absolute relative errors of the free period and of the overturning time; infinite if the block never uplifts.
    """

    uplift: float
    period: float
    overturning: float

    @property
    def grade(self) -> Grade:
        """Grade the block by its largest error."""
        return max(grade(self.uplift), grade(self.period), grade(self.overturning))


def errors(asked: Sequence[Linearisation], kappa: int) -> Errors:
    """Return the largest errors of the block with kappa1 or kappa2."""
    uplifts = [getattr(each, f"uplift_ratio{kappa}") - 1 for each in asked]
    return Errors(
        max(uplifts, key=abs),
        max(float(np.abs(each.period_ratio - 1).max()) for each in asked),
        max(float(np.abs(getattr(each, f"overturning_ratio{kappa}") - 1).max()) for each in asked),
    )


def preferred(asked: Sequence[Linearisation]) -> int | None:
    """Return which kappa to prefer at the requested amplitudes: 1, 2, 0 if either will do, None if neither does.

    The kappa with the better grade is preferred; if both have the same grade, `preferred_kappa` decides by the uplift
    acceleration.
    """
    one, two = (errors(asked, kappa).grade for kappa in (1, 2))
    if one is two is Grade.DISREGARD:
        return None
    if one is not two:
        return 1 if one < two else 2
    return 2 if any(preferred_kappa(each.block) == "kappa2" for each in asked) else 0


def velocity_ratios(block: EquivalentBlock, gravity: float) -> tuple[float, float]:
    """Return the velocity step that just overturns the block with kappa1 and kappa2, over that of the structure.

    In q.. = p^2 (q - phi_cr), a velocity step v of the ground gives the rate p^2 kappa v/g, and a rate p phi_cr just
    overturns: v = g lambda/p.
    """
    # The ratio is NaN for a structure that overturns by itself, or nearly does.
    unit = gravity / (block.p * block.v_imp) if block.v_imp else np.nan
    return unit * block.lambda_lin, unit * block.lambda_


def free_period(mechanism: Mechanism, direction: Direction, amplitude: Reals) -> Reals:
    """Return the period of free rocking without losses [s]: four times the quarter from an amplitude to phi = 0.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    direction : Direction
        The direction of the quarter.
    amplitude : ndarray, shape (n,)
        phi/phi_cr, in (0, 1).

    Returns
    -------
    ndarray, shape (n,)
    """
    critical = mechanism.critical_rotation(direction)
    short = critical * (1 - amplitude[:, None])

    def slowness(u: Reals) -> Reals:
        # phi_cr - phi = (phi_cr - phi_0) cosh u: the equivalent block has u = p t.
        fallen = np.minimum(2 * short * np.sinh(u / 2) ** 2, critical * amplitude[:, None])
        top = critical - short
        fall = fallen * _mean(mechanism, direction, top - fallen, top, 0.0)
        inertia = _inertia(mechanism, direction, top - fallen)
        slow: Reals = np.sqrt(inertia / (2 * mechanism.gravity * fall)) * short * np.sinh(u)
        return slow

    return 4 * _integral(slowness, np.arccosh(1 / (1 - amplitude)), smooth=mechanism.smooth)


def overturning_time(
    mechanism: Mechanism, direction: Direction, acceleration: Reals, lambda_: float | None = None
) -> Reals:  # fmt: skip
    """Return the time from rest to phi_cr under a constant acceleration [s].

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    direction : Direction
        Direction of rocking.
    acceleration : ndarray, shape (m,)
        Constant accelerations over the uplift acceleration, above 1.
    lambda_ : float, optional
        The uplift acceleration over g, if it is known already.

    Returns
    -------
    ndarray, shape (m,)

    Raises
    ------
    SolverError
        If the mechanism does not reach phi_cr under an acceleration.
    """
    critical = mechanism.critical_rotation(direction)
    excess = acceleration[:, None] - 1
    push = acceleration[:, None] * (equivalent_block(mechanism)[direction].lambda_ if lambda_ is None else lambda_)

    def slowness(u: Reals) -> Reals:
        # phi = phi_cr (a/lambda - 1)(cosh u - 1): the equivalent block has u = p t.
        phi = np.minimum(2 * critical * excess * np.sinh(u / 2) ** 2, critical)
        gain = -phi * _mean(mechanism, direction, np.zeros_like(phi), phi, push)
        if not (gain > 0).all():
            stuck = acceleration[~(gain > 0).all(axis=1)]
            raise SolverError(
                f"under {stuck[0]:.4g} times its uplift acceleration the mechanism does not overturn from rest"
            )
        inertia = _inertia(mechanism, direction, phi)
        slow: Reals = np.sqrt(inertia / (2 * mechanism.gravity * gain)) * critical * excess * np.sinh(u)
        return slow

    return _integral(slowness, np.arccosh(1 + 1 / (acceleration - 1)), smooth=mechanism.smooth)


def _mean(mechanism: Mechanism, direction: Direction, low: Reals, high: Reals, push: Reals | float) -> Reals:
    """Return the mean of V'/g - push B between two rotations, without cancellation between potentials."""
    x, weight = np.polynomial.legendre.leggauss(ENERGY_NODES if mechanism.smooth else ROUGH_INTEGRATION[2])
    phi = low[..., None] + (high - low)[..., None] * (1 + x) / 2
    at = mechanism.coefficients(phi.ravel(), direction)
    restoring, B = (values.reshape(phi.shape) for values in (at.restoring(mechanism.gravity), at.B))
    mean: Reals = (restoring - np.asarray(push)[..., None] * B) @ (weight / 2)
    return mean


def _inertia(mechanism: Mechanism, direction: Direction, phi: Reals) -> Reals:
    """Return the inertia coefficient I at rotations of any shape."""
    return mechanism.coefficients(phi.ravel(), direction).I.reshape(phi.shape)


def _integral(integrand: Callable[[Reals], Reals], until: Reals, *, smooth: bool) -> Reals:
    """Integrate f(u) from 0 to each `until`, by Gauss's rule with an increasing number of nodes."""
    before = np.full_like(until, np.nan)
    precision, most_nodes, _ = (NODES_TOLERANCE, MAX_NODES, ENERGY_NODES) if smooth else ROUGH_INTEGRATION
    nodes = MIN_NODES
    while nodes <= most_nodes:
        x, weight = np.polynomial.legendre.leggauss(nodes)
        with np.errstate(over="ignore", invalid="ignore"):  # overflow means that the integral does not converge
            integral: Reals = until / 2 * (integrand(until[:, None] * (1 + x) / 2) @ weight)
        if (np.abs(integral - before) <= precision * np.abs(integral)).all():
            return integral
        before, nodes = integral, 2 * nodes
    raise SolverError(
        "the integral of the energy equation does not converge: the mechanism is not smooth up to phi_cr, or so stocky "
        "that rounding hides how it moves"
    )
