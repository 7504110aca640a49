"""Response of the linear rocking block to a pulse: by Eqs. 41-42 for a full sine, and exactly for any pulse shape.

Everything is dimensionless [paper, Eq. 40]: rotations x = phi/phi_cr, times tau = p t counted from uplift, pulse
amplitude a = a_g/(g lambda) and frequency omega = omega_g/p. A full sine lifts the block where a sin = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, exp, log, pi, sqrt

from rocking_cli.dynamics.exact import ExactResponse, solve
from rocking_cli.dynamics.pulse_motion import Side
from rocking_cli.errors import InputError

# How many cycles they last, and their phase at the start: those of `rocking_cli.excitation.pulses`, without its numpy.
SHAPES = {"sine": (1.0, 0.0), "cosine": (1.0, pi / 2), "half_sine": (0.5, 0.0), "rectangular": (1.0, pi / 2)}
LARGEST = 1e6  # a or omega, and 1/omega
LONG = 690.0  # exp of more, with a factor of omega^2, overflows


@dataclass(frozen=True)
class ClosedForm:
    """Results of Eqs. 41-42 if their conditions hold, and otherwise the reason why they do not.

    Parameters
    ----------
    D0 : float or None
        Eq. 42: the energy of the free motion after the pulse, if the conditions hold; None if it does not exist or
        overflows.
    max_ratio : float or None
        phi_max/phi_cr of Eq. 41, the peak of the first rebound; None if the block overturns or a condition does not
        hold.
    overturns : bool or None
        Whether eta^2 (1 - D0) >= 1: overturning after one impact. None if a condition other than uplift does not hold;
        without uplift the block does not overturn.
    conditions : dict of str to bool or None
        `uplift` (a > 1), `first_impact_after_pulse`, `no_overturning_without_impact`; None if there is no motion.
    printed_ratio : float or None
        Value of Eq. 41 as printed, whether or not its conditions hold, to show its error; None if it is not a number
        from 0 to 1.
    """

    D0: float | None
    max_ratio: float | None
    overturns: bool | None
    conditions: dict[str, bool | None]
    printed_ratio: float | None = None

    @property
    def valid(self) -> bool:
        """Whether every condition of the closed form holds."""
        return all(self.conditions.values())

    def off(self, exact: float) -> float | None:
        """Return Eq. 41 as printed minus an exact peak phi/phi_cr; None if Eq. 41 gives no value."""
        return None if self.printed_ratio is None else self.printed_ratio - exact


def check_pulse(a: float, omega: float, eta: float) -> None:
    """Raise `InputError`, with the name of the parameter, if a parameter of the pulse or the block is not valid."""
    if not 0 < a <= LARGEST:
        raise InputError(f"a must be a positive number up to {LARGEST:g} (a_g over the uplift acceleration), got {a:g}")
    if not 1 / LARGEST <= omega <= LARGEST:
        raise InputError(f"omega must be a number from {1 / LARGEST:g} to {LARGEST:g} (omega_g/p), got {omega:g}")
    if not 0 < eta <= 1:
        raise InputError(f"eta must be in (0, 1], got {eta:g}")


def closed_form(a: float, omega: float, eta: float) -> ClosedForm:
    """Return the peak response to a full sine pulse by Eqs. 41-42, with the conditions under which they hold.

    Parameters
    ----------
    a, omega, eta : float
        Dimensionless amplitude and frequency, and coefficient of restitution.

    Returns
    -------
    ClosedForm

    Raises
    ------
    InputError
        If a or omega is not positive or eta is outside (0, 1].

    Notes
    -----
    The paper states none of the conditions: (i) the block lifts, (ii) its first impact comes after the pulse,
    (iii) it does not overturn before.
    """
    check_pulse(a, omega, eta)
    if a <= 1:
        return ClosedForm(None, None, False, _conditions(False, None, None))
    root = sqrt(a * a - 1)
    end = (2 * pi - asin(1 / a)) / omega  # tau from uplift to the end of the pulse
    if end + log(a) > LONG:
        # The growing term decides all: D0 is beyond numbers, with the sign of root - omega.
        conditions = _conditions(True, root >= omega, root <= omega)
        return ClosedForm(None, None, False if all(conditions.values()) else None, conditions)
    grow, decay = exp(end), exp(-end)
    D0 = (omega / (omega**2 + 1)) ** 2 * (
        omega**2 - 2 * a**2 + 1 + (root + omega) * a * decay + (root - omega) * a * grow
    )  # Eq. 42
    lifted = (root - omega) * grow - (root + omega) * decay + 2 * (1 + omega**2) / omega >= 0
    left = eta**2 * (1 - D0)
    conditions = _conditions(True, lifted, (root - omega) * grow < a)
    valid = all(conditions.values())
    ratio = 1 - sqrt(1 - left) if left < 1 else None  # Eq. 41
    return ClosedForm(
        D0=D0,
        max_ratio=ratio if valid else None,
        overturns=left >= 1 if valid else None,
        conditions=conditions,
        printed_ratio=ratio if ratio is not None and ratio >= 0 else None,
    )


def _conditions(uplift: bool, impact_after: bool | None, stays: bool | None) -> dict[str, bool | None]:
    return {"uplift": uplift, "first_impact_after_pulse": impact_after, "no_overturning_without_impact": stays}


def exact_pulse(a: float, omega: float, eta: float, shape: str = "sine") -> ExactResponse:
    """Return the exact response of the linear block to a pulse, with any number of impacts.

    Parameters
    ----------
    a, omega, eta : float
        Dimensionless amplitude and frequency, and coefficient of restitution.
    shape : {"sine", "cosine", "half_sine", "rectangular"}
        Shape of the pulse; omega is 2 pi over its period, see `rocking_cli.excitation.pulses`.

    Returns
    -------
    ExactResponse
        Rotations over phi_cr, and times tau = p t from the start of the pulse.

    Raises
    ------
    InputError
        If a or omega is not positive, eta is outside (0, 1] or the shape is none of these.
    SolverError
        If the block has too many impacts during a slow pulse, with a restitution near 1.

    Notes
    -----
    The motion of `rocking_cli.dynamics.pulse_motion`, with p, phi_cr and the uplift acceleration equal to 1.
    """
    check_pulse(a, omega, eta)
    if shape not in SHAPES:
        raise InputError(f"shape must be one of {', '.join(SHAPES)}, got {shape!r}")
    cycles, phase = SHAPES[shape]
    side = Side(1.0, 1.0, 1.0, eta)
    duration = 2 * pi / omega * cycles
    # To the left, so that the positive direction is the first.
    return solve((side, side), [(0.0, duration, -a, 0.0 if shape == "rectangular" else omega, phase)])
