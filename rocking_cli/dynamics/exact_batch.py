"""The exact response to many pulses of one shape: the motion of `pulse_motion`, compiled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.core import Equivalence
from rocking_cli.dynamics import pulse_motion
from rocking_cli.dynamics.compiled import PULSES, compile_source, has_run
from rocking_cli.dynamics.exact import polarity_of, segments_of, sides_of
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import Pulse

UNIT = 1024  # pulses a thread takes at a time: some milliseconds


@dataclass(frozen=True, eq=False)
class ExactResponses:
    """What becomes of a structure under many pulses, one a place, each an ndarray of shape (n,).

    Parameters
    ----------
    overturned, failed : ndarray of bool
        Whether it overturns; failed ones bounce all through the pulse, and their other values mean nothing.
    peak_ratio : ndarray
        Largest rotation over the critical rotation; NaN if it overturns, 0 if it does not lift.
    impacts_before_overturning : ndarray of int
        -1 if it does not overturn.
    uplift_time : ndarray
        The first uplift [s]; NaN if there is none.
    """

    overturned: NDArray[np.bool_]
    failed: NDArray[np.bool_]
    peak_ratio: NDArray[np.float64]
    impacts_before_overturning: NDArray[np.int64]
    uplift_time: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.overturned)

    @property
    def uplifted(self) -> NDArray[np.bool_]:
        """Whether it lifts at all."""
        return np.isfinite(self.uplift_time)


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
) -> ExactResponses:
    """Exact response of a structure's equivalent blocks to many pulses of one shape.

    Parameters
    ----------
    equivalence : Equivalence
        Of the structure.
    pulse : Pulse
        The shape; its own amplitude and period are replaced.
    amplitudes, periods : array_like, shape (n,)
        Of each pulse [m/s2], [s], > 0; a number holds for all.
    kappa, gravity, polarity
        See `exact_response`.
    threads : int, optional
        How many at a time; without it, one for each processor.
    progress : callable, optional
        Called with the number of pulses finished since the last call.

    Returns
    -------
    ExactResponses
        In the order given, the same for any number of threads.

    Raises
    ------
    InputError
        If the pulse has no segments, an amplitude or a period is not positive, or their lengths differ.
    """
    sides = sides_of(equivalence, kappa=kappa, gravity=gravity)
    sizes = _sizes(amplitudes, periods)
    if threads is not None and threads < 1:
        raise InputError(f"threads must be 1 or more, got {threads}")
    segments = np.array(segments_of(pulse), dtype=np.float64)
    factors, stretches = polarity_of(polarity) * sizes[0] / pulse.amplitude, sizes[1] / pulse.period
    n = factors.size
    results = np.empty((n, 4))
    if n:
        many = _compiled()

        def follow(first: int, stop: int) -> None:
            many(sides, segments, factors, stretches, first, stop, results)

        in_parts(follow, n, UNIT, threads, progress)
        has_run(PULSES)
    status, peaks, impacts, uplift_time = results.T
    overturned = status == pulse_motion.OVERTURNED
    return ExactResponses(
        overturned=overturned,
        failed=status == pulse_motion.SPENT,
        peak_ratio=np.where(overturned, np.nan, peaks),
        impacts_before_overturning=np.where(overturned, impacts, -1).astype(np.int64),
        uplift_time=uplift_time.copy(),
    )


def _sizes(amplitudes: ArrayLike, periods: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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


@cache
def _compiled() -> Any:
    return compile_source(pulse_motion.SOURCE, inline=(pulse_motion.at,))["many"]
