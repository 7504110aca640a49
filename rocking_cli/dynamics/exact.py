"""The exact response of the equivalent blocks to a pulse, in SI units."""

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
    """What the linear equation of motion says of a structure under a pulse, to rounding error; see `Outcome`.

    Parameters
    ----------
    first_excursion, first_rebound : float
        Largest phi/phi_cr before and after the first impact; NaN for one that overturns or never comes.
    impacts : tuple of (float, int, float)
        Time [s], sign of the direction that ends, and rotation rate before [rad/s], of each impact until it rests or
        overturns, of the first 5000 at most.
    pulse_end : float
        How long the pulse lasts [s].
    """

    first_excursion: float
    first_rebound: float
    impacts: tuple[tuple[float, int, float], ...]
    pulse_end: float

    @property
    def first_impact(self) -> float:
        """When the first impact comes [s]; NaN if there is none."""
        return self.impacts[0][0] if self.impacts else nan


def exact_response(
    equivalence: Equivalence, pulse: Pulse, *, kappa: Literal[1, 2], gravity: float, polarity: int = 1
) -> ExactResponse:
    """Exact response of a structure's equivalent blocks to a pulse.

    Parameters
    ----------
    equivalence : Equivalence
        Of the structure.
    pulse : Pulse
        One that is made of sines and constants.
    kappa : {1, 2}
        Which scaling of the equivalent block.
    gravity : float
        That of the structure [m/s2].
    polarity : {1, -1}
        -1 reverses the pulse, which is to the right at first or at its peak.

    Returns
    -------
    ExactResponse

    Raises
    ------
    InputError
        If the pulse has no segments, kappa or polarity is none, or an eta is not positive.
    SolverError
        If it bounces all through a slow pulse, with a restitution near 1.

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
    """The equivalent blocks of both directions as the motion needs them; errors as `exact_response`."""
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
    """The segments of a pulse; `InputError` if there are none."""
    segments = pulse.segments()
    if not segments:
        raise InputError(f"{pulse.name} is not a chain of sines and constants: respond to pulse.sampled() instead")
    return segments


def polarity_of(polarity: int) -> int:
    """1 or -1; `InputError` if it is neither."""
    if polarity not in (1, -1):
        raise InputError(f"polarity must be 1 or -1, got {polarity!r}")
    return polarity


def solve(sides: tuple[Side, Side], segments: pulse_motion.Rows, polarity: int = 1) -> ExactResponse:
    """The response with both peaks over their phi_cr, whatever the units."""
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
        overturned=overturned,
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
