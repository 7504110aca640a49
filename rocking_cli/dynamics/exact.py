"""Exact response of the equivalent blocks to a pulse, in SI units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isfinite, nan
from typing import TYPE_CHECKING, Literal

from rocking_cli.dynamics import pulse_motion
from rocking_cli.dynamics.outcome import UNCHECKED, Outcome
from rocking_cli.dynamics.pulse_motion import COLUMNS, Side
from rocking_cli.errors import InputError, SolverError

if TYPE_CHECKING:  # numpy: only who has a structure and a pulse has paid for it
    from rocking_cli.core import Equivalence
    from rocking_cli.excitation.pulses import Pulse, Segment

KEPT = 5_000  # impacts; eta = 0.995 rests after 2800


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
    >>> from rocking_cli import Registry, equivalent_block, exact_response
    >>> from rocking_cli.excitation.pulses import parse_pulse
    >>> block = Registry()["block"](width=0.7, height=2.8)
    >>> answer = exact_response(equivalent_block(block), parse_pulse("sine:0.4g:0.5s"), kappa=2, gravity=block.gravity)
    >>> answer.overturned, round(answer.peak_ratio, 6), round(answer.first_impact, 6)
    (False, 0.245494, 0.362202)
    """
    sides = sides_of(equivalence, kappa=kappa, gravity=gravity)
    blocks = (equivalence.positive, equivalence.negative)
    answer = solve(sides, segments_of(pulse), polarity_of(polarity))
    ratios = (answer.peak_positive, answer.peak_negative)
    positive, negative = (x * block.phi_cr for x, block in zip(ratios, blocks, strict=True))
    return replace(answer, peak_positive=positive, peak_negative=negative)


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
    """Return the response, with both peaks over the phi_cr of their direction, in any consistent units."""
    log = [0.0] * (COLUMNS * KEPT)
    motion = pulse_motion.follow(sides, segments, float(polarity), 1.0, True, log)
    if motion.status == pulse_motion.SPENT:
        raise SolverError(
            f"more than {pulse_motion.EXCURSIONS} impacts within the pulse: so slow a pulse needs a smaller restitution"
        )
    overturned = motion.status == pulse_motion.OVERTURNED
    fell_to = (1, -1)[motion.side] if overturned else 0
    kept = [log[k : k + COLUMNS] for k in range(0, COLUMNS * min(motion.impacts, KEPT), COLUMNS)]
    return ExactResponse(
        still_rocking=False,
        failed=False,
        fell_to=fell_to,
        peak_positive=nan if fell_to == 1 else motion.peaks[0],
        peak_negative=nan if fell_to == -1 else motion.peaks[1],
        peak_ratio=nan if overturned else max(motion.peaks),
        overturning_time=motion.crossed if overturned and isfinite(motion.crossed) else nan,
        uplift_time=motion.uplift,
        impact_count=motion.impacts,
        end_time=nan,
        **UNCHECKED,
        first_excursion=kept[0][3] if kept else nan,
        first_rebound=kept[1][3] if len(kept) > 1 else nan,
        impacts=tuple((time, int(sign), rate) for time, sign, rate, _ in kept),
        pulse_end=segments[-1][1],
    )
