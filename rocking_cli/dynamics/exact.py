"""Response of linear rocking blocks to a pulse: exactly, and by Eqs. 41-42 for a full sine.

The response of equivalent blocks is in SI units. Otherwise everything is dimensionless [paper, Eq. 40]: rotations
x = phi/phi_cr, times tau = p t counted from uplift, pulse amplitude a = a_g/(g lambda) and frequency omega = omega_g/p.
A full sine lifts the block where a sin = 1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import asin, exp, inf, isfinite, log, nan, pi, sqrt
from typing import TYPE_CHECKING, Literal

from rocking_cli.dynamics import pulse_motion
from rocking_cli.dynamics.outcome import UNCHECKED_FIELDS, Outcome
from rocking_cli.dynamics.pulse_motion import COLUMNS, Side
from rocking_cli.errors import InputError, SolverError
from rocking_cli.short_repr import short_repr

if TYPE_CHECKING:  # avoid importing numpy, which only structures and pulses need
    from rocking_cli.core import Equivalence
    from rocking_cli.excitation.pulses import Pulse, Segment

MAX_IMPACTS = 5_000  # largest number of impacts; with eta = 0.995 a block rests after 2800
# Number of cycles and initial phase, as in `rocking_cli.excitation.pulses`, which imports numpy.
SHAPE_CYCLES = {"sine": (1.0, 0.0), "cosine": (1.0, pi / 2), "half_sine": (0.5, 0.0), "rectangular": (1.0, pi / 2)}
MAX_INPUT = 1e6  # largest a, omega and 1/omega
MAX_EXPONENT = 690.0  # a larger exponential, times omega^2, overflows


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class ExactResponse(Outcome[bool, int, float]):
    """Response of an equivalent block to a pulse by its linear equation of motion, to rounding error; see `Outcome`.

    Parameters
    ----------
    first_excursion, first_rebound : float
        Largest phi/phi_cr before and after the first impact; NaN if the block overturns in it, or it does not take
        place.
    impacts : tuple of (float, int, float)
        Time [s], sign of the direction that ends, and rotation rate before [rad/s], of each impact until rest or
        overturning, of at most the first 5000.
    pulse_end : float
        Duration of the pulse [s].
    """

    first_excursion: float
    first_rebound: float
    impacts: tuple[tuple[float, int, float], ...]
    pulse_end: float

    @property
    def first_impact(self) -> float:
        """Time of the first impact [s]; NaN if there is none."""
        return self.impacts[0][0] if self.impacts else nan


def exact_response(
    equivalence: Equivalence, pulse: Pulse, *, kappa: Literal[1, 2], gravity: float, polarity: int = 1
) -> ExactResponse:
    """Return the exact response of a structure's equivalent blocks to a pulse.

    Parameters
    ----------
    equivalence : Equivalence
        Equivalent blocks of the structure.
    pulse : Pulse
        A pulse made of sines and constants.
    kappa : {1, 2}
        Scaling of the equivalent block.
    gravity : float
        Gravitational acceleration of the structure [m/s2].
    polarity : {1, -1}
        1 for the pulse as given, whose first or largest acceleration is to the right; -1 reverses it.

    Returns
    -------
    ExactResponse

    Raises
    ------
    InputError
        If the pulse has no segments, kappa or polarity is not valid, or an eta is not positive.
    SolverError
        If the block has too many impacts during a slow pulse, with a restitution near 1.

    Notes
    -----
    Eqs. 12, 16 and 6: closed form between impacts; each impact by a root search that misses no turning point.

    Examples
    --------
    >>> from rocking_cli import Registry
    >>> from rocking_cli.core import equivalent_block
    >>> from rocking_cli.dynamics.exact import exact_response
    >>> from rocking_cli.excitation.pulses import parse_pulse
    >>> block = Registry()["block"](width=0.7, height=2.8)
    >>> answer = exact_response(equivalent_block(block), parse_pulse("sine:0.4g:0.5s"), kappa=2, gravity=block.gravity)
    >>> answer.overturned, round(answer.peak_ratio, 6), round(answer.first_impact, 6)
    (False, 0.245494, 0.362202)
    """
    sides = sides_of(equivalence, kappa=kappa, gravity=gravity)
    blocks = (equivalence.positive, equivalence.negative)
    answer = solve(sides, segments_of(pulse), polarity_of(polarity))
    rotations, rates = {}, {}
    for name, block in zip(("positive", "negative"), blocks, strict=True):
        rotations[f"peak_{name}"] = getattr(answer, f"peak_{name}") * block.phi_cr
        rates[f"peak_rate_{name}"] = getattr(answer, f"peak_rate_{name}") * block.p * block.phi_cr
    return replace(answer, **rotations, **rates)


def sides_of(equivalence: Equivalence, *, kappa: int, gravity: float) -> tuple[Side, Side]:
    """Return the equivalent blocks of both directions as arguments of the motion. Raises as `exact_response`."""
    if kappa not in (1, 2):
        raise InputError(f"kappa must be 1 or 2, got {kappa!r}")
    if not 0 < gravity < inf:
        raise InputError(f"gravity must be positive, got {gravity:g}")
    for block in (equivalence.positive, equivalence.negative):
        if not block.eta > 0:
            raise InputError(f"eta must be positive to know what follows an impact, got {block.eta:g}")
    positive, negative = (
        Side(
            block.p,
            gravity * (block.lambda_lin if kappa == 1 else block.lambda_),  # Eqs. 18-20: g phi_cr/kappa
            block.p * block.phi_cr,
            block.eta,
        )
        for block in (equivalence.positive, equivalence.negative)
    )
    return positive, negative


def segments_of(pulse: Pulse) -> tuple[Segment, ...]:
    """Return the segments of a pulse. Raises `InputError` if it has none."""
    segments = pulse.segments()
    if not segments:
        raise InputError(f"{pulse.name} is not a chain of sines and constants: respond to pulse.sampled() instead")
    return segments


def polarity_of(polarity: int) -> int:
    """Return the polarity. Raises `InputError` if it is neither 1 nor -1."""
    if polarity not in (1, -1):
        raise InputError(f"polarity must be 1 or -1, got {polarity!r}")
    return polarity


def solve(sides: tuple[Side, Side], segments: pulse_motion.Rows, polarity: int = 1) -> ExactResponse:
    """Return the response, with peaks over the phi_cr, and peak rates over the p phi_cr, of their direction."""
    log = [0.0] * (COLUMNS * MAX_IMPACTS)
    motion = pulse_motion.follow(sides, segments, float(polarity), 1.0, True, log)
    if motion.status == pulse_motion.SPENT:
        raise SolverError(
            f"more than {pulse_motion.EXCURSIONS} impacts within the pulse: so slow a pulse needs a smaller restitution"
        )
    overturned = motion.status == pulse_motion.OVERTURNED
    fell_to = (1, -1)[motion.side] if overturned else 0
    kept = [log[k : k + COLUMNS] for k in range(0, COLUMNS * min(motion.impacts, MAX_IMPACTS), COLUMNS)]
    return ExactResponse(
        still_rocking=False,
        failed=False,
        fell_to=fell_to,
        peak_positive=nan if fell_to == 1 else motion.peaks[0],
        peak_negative=nan if fell_to == -1 else motion.peaks[1],
        peak_ratio=nan if overturned else max(motion.peaks),
        peak_rate_positive=nan if fell_to == 1 else motion.rates[0],
        peak_rate_negative=nan if fell_to == -1 else motion.rates[1],
        overturning_time=motion.crossed if overturned and isfinite(motion.crossed) else nan,
        uplift_time=motion.uplift,
        impact_count=motion.impacts,
        end_time=nan,
        **UNCHECKED_FIELDS,
        first_excursion=kept[0][3] if kept else nan,
        first_rebound=kept[1][3] if len(kept) > 1 else nan,
        impacts=tuple((time, int(sign), rate) for time, sign, rate, _ in kept),
        pulse_end=segments[-1][1],
    )


@short_repr
@dataclass(frozen=True)
class ClosedForm:
    """Results of Eqs. 41-42 if their conditions hold, and otherwise the reason why they do not.

    Parameters
    ----------
    D0 : float or None
        Eq. 42: (phi/phi_cr - 1)^2 - (dphi/dtau/phi_cr)^2, which is constant in the free motion after the pulse, of the
        motion that Eq. 42 assumes: without impact until then. None without uplift, or if it overflows.
    max_ratio : float or None
        phi_max/phi_cr of Eq. 41, the peak of the first rebound; None if the block overturns or a condition does not
        hold.
    overturns : bool or None
        Whether eta^2 (1 - D0) >= 1: overturning after one impact. None if a condition other than uplift does not hold;
        without uplift the block does not overturn.
    conditions : dict of str to bool or None
        `uplift` (a > 1), `first_impact_after_pulse`, `no_overturning_without_impact`; None if there is no motion.
    printed_ratio : float or None
        Value of Eq. 41 as printed, whether or not its conditions hold, to show its error; None where it has no real
        value from 0 to 1, as with eta^2 (1 - D0) >= 1.
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
    if not 0 < a <= MAX_INPUT:
        raise InputError(
            f"a must be a positive number up to {MAX_INPUT:g} (a_g over the uplift acceleration), got {a:g}"
        )
    if not 1 / MAX_INPUT <= omega <= MAX_INPUT:
        raise InputError(f"omega must be a number from {1 / MAX_INPUT:g} to {MAX_INPUT:g} (omega_g/p), got {omega:g}")
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
    if end + log(a) > MAX_EXPONENT:
        # The growing term governs: D0 overflows, with the sign of root - omega.
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
        Rotations over phi_cr, times tau = p t from the start of the pulse, and angular velocities over p phi_cr.

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
    if shape not in SHAPE_CYCLES:
        raise InputError(f"shape must be one of {', '.join(SHAPE_CYCLES)}, got {shape!r}")
    cycles, phase = SHAPE_CYCLES[shape]
    side = Side(1.0, 1.0, 1.0, eta)
    duration = 2 * pi / omega * cycles
    # The pulse starts to the left, so that the structure first rocks in the positive direction.
    return solve((side, side), [(0.0, duration, -a, 0.0 if shape == "rectangular" else omega, phase)])
