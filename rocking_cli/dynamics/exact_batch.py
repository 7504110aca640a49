"""Exact response to many pulses of one shape, by the compiled motion of `pulse_motion`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Equivalence
from rocking_cli.dynamics import pulse_motion, ways
from rocking_cli.dynamics.calling import PULSES
from rocking_cli.dynamics.exact import polarity_of, segments_of, sides_of
from rocking_cli.dynamics.outcome import UNCHECKED_FIELDS, Outcome, Outcomes
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import Pulse

PULSES_PER_TASK = 1024  # some milliseconds of work for a thread


def exact_many(
    equivalence: Equivalence,
    pulse: Pulse,
    amplitudes: ArrayLike,
    periods: ArrayLike,
    *,
    kappa: Literal[1, 2],
    gravity: float,
    polarity: int = 1,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Outcomes:
    """Return the exact response of a structure's equivalent blocks to many pulses of one shape.

    Parameters
    ----------
    equivalence : Equivalence
        Equivalent blocks of the structure.
    pulse : Pulse
        The shape; its own amplitude and period are replaced.
    amplitudes, periods : array_like, shape (n,)
        Amplitude [m/s2] and period [s] of each pulse, > 0; a single number applies to all pulses.
    kappa, gravity, polarity
        As in `exact_response`.
    threads : int, optional
        Number of threads; by default, one for each processor.
    progress : callable, optional
        Called with the number of pulses finished since the last call.

    Returns
    -------
    Outcomes
        Outcomes in the order of the pulses, for any number of threads. `failed` is True for pulses with too
        many impacts. Times of overturning and of coming to rest are not computed.

    Raises
    ------
    InputError
        If the pulse has no segments, an amplitude or a period is not positive, or amplitudes and periods differ in
        length.
    """
    sides = sides_of(equivalence, kappa=kappa, gravity=gravity)
    sizes = _sizes(amplitudes, periods)
    if threads is not None and threads < 1:
        raise InputError(f"threads must be 1 or more, got {threads}")
    segments = np.array(segments_of(pulse), dtype=np.float64)
    factors, stretches = polarity_of(polarity) * sizes[0] / pulse.amplitude, sizes[1] / pulse.period
    n = factors.size
    results = np.full((n, pulse_motion.RESULTS), np.nan)  # a pulse that is never computed has failed
    if n:
        many = ways.kernel(PULSES)

        def follow(first: int, stop: int) -> None:
            many(sides, segments, factors, stretches, first, stop, results)

        in_parts(follow, n, PULSES_PER_TASK, threads, progress)
    status, side, impacts, uplift_time, *peaks = results.T
    overturned = status == pulse_motion.OVERTURNED
    fell_to = np.where(overturned, 1 - 2 * side, 0).astype(np.int64)
    blocks = [equivalence[direction] for direction in Direction]
    units = [*(block.phi_cr for block in blocks), *(each.rate for each in sides)]
    positive, negative, positive_rate, negative_rate = (
        np.where(fell_to == int(direction), np.nan, peak * unit)
        for direction, peak, unit in zip([*Direction] * 2, peaks, units, strict=True)
    )
    return Outcome(
        still_rocking=np.zeros(n, dtype=bool),
        failed=(status == pulse_motion.SPENT) | np.isnan(status),
        fell_to=fell_to,
        peak_positive=positive,
        peak_negative=negative,
        peak_ratio=np.where(overturned, np.nan, np.maximum(*peaks[:2])),
        peak_rate_positive=positive_rate,
        peak_rate_negative=negative_rate,
        overturning_time=np.full(n, np.nan),
        uplift_time=uplift_time.copy(),
        impact_count=np.nan_to_num(impacts).astype(np.int64),
        end_time=np.full(n, np.nan),
        **{name: np.full(n, value) for name, value in UNCHECKED_FIELDS.items()},
    )


def _sizes(amplitudes: ArrayLike, periods: ArrayLike) -> tuple[Reals, Reals]:
    try:
        a, t = np.broadcast_arrays(*(np.atleast_1d(np.asarray(x, dtype=np.float64)) for x in (amplitudes, periods)))
    except ValueError:
        raise InputError("amplitudes and periods differ in length") from None
    for name, values in (("amplitude", a), ("period", t)):
        if values.ndim != 1:
            raise InputError(f"the {name}s must be a row of numbers, not of shape {values.shape}")
        wrong = ~(np.isfinite(values) & (values > 0))
        if wrong.any():
            k = int(wrong.argmax())
            raise InputError(f"pulse {k}: the {name} must be positive, got {values[k]:g}")
    return a, t
