"""Structures and ground motions laid out for the kernel, which runs any selection of them in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics.model import Model
from rocking_cli.excitation.base import GroundMotion

Reals = NDArray[np.float64]

RELEASE_DT = 0.005  # s between samples of a free motion without a record
MOST_IMPACTS = 20_000  # after the record and its tail, to call it still rocking; eta = 0.999 rests in 14 000


@dataclass(frozen=True, eq=False)
class Deck:
    """The arrays that all runs of a call share; see `rocking_cli.dynamics.kernels.run`.

    Parameters
    ----------
    structures, numbers, forces, angles, certain : ndarray
        The models.
    records, u, v, ahead, v_ahead : ndarray
        The ground motions.
    """

    structures: NDArray[np.int64]
    numbers: Reals
    forces: Reals
    angles: Reals
    certain: Reals
    records: Reals
    u: Reals
    v: Reals
    ahead: Reals
    v_ahead: Reals

    def run(
        self,
        runs: Reals,
        marks: Reals,
        *,
        first: int = 0,
        stop: int | None = None,
        rtol: float,
        phi: Reals | None = None,
        rate: Reals | None = None,
        impacts: Reals | None = None,
    ) -> None:
        """Run the kernel, which fills `marks` and, if given, the samples and the impacts of the last history."""
        from rocking_cli.dynamics import kernels  # numba, only when a history is asked for

        nothing = np.empty(0)
        kernels.run(
            first,
            len(runs) if stop is None else stop,
            runs,
            self.structures,
            self.numbers,
            self.forces,
            self.angles,
            self.certain,
            self.records,
            self.u,
            self.v,
            self.ahead,
            self.v_ahead,
            rtol,
            MOST_IMPACTS,
            nothing if phi is None else phi,
            nothing if rate is None else rate,
            np.empty((0, 3)) if impacts is None else impacts,
            marks,
        )


def lay_out(models: Sequence[Model], motions: Sequence[GroundMotion | None]) -> Deck:
    """Lay out models and ground motions (None: no shaking) for the kernel; a single one is not copied."""
    sizes = [len(model.forces) for model in models]
    structures = np.column_stack([_starts(sizes), sizes, [model.is_linear for model in models]]).astype(np.int64)
    u = [motion.acceleration if motion is not None else np.empty(0) for motion in motions]
    dt = [motion.dt if motion is not None else RELEASE_DT for motion in motions]
    vertical = [motion.vertical if motion is not None else None for motion in motions]
    v = [up.acceleration if up is not None else np.empty(0) for up in vertical]
    v_dt = [up.dt if up is not None else 1.0 for up in vertical]
    ahead, v_ahead = [], []
    for horizontal, up, step, v_step in zip(u, v, dt, v_dt, strict=True):
        length = max(horizontal.size, ceil((up.size - 1) * v_step / step) + 1 if up.size else 0)
        ahead.append(_strongest_to_come(np.abs(horizontal), 1.0, length))
        v_ahead.append(_strongest_to_come(np.maximum(-up, 0.0), step / v_step, length if up.size else 0))
    # Where no record has a vertical component, the second array is empty, and the kernel leaves it alone.
    if not any(len(each) for each in v_ahead):
        v_ahead = []
    else:
        v_ahead = [each if each.size else np.zeros(one.size) for each, one in zip(v_ahead, ahead, strict=True)]
    records = np.column_stack(
        [
            _starts([each.size for each in u]),
            [each.size for each in u],
            _starts([each.size for each in v]),
            [each.size for each in v],
            _starts([each.size for each in ahead]),
            [each.size for each in ahead],
            dt,
            v_dt,
        ]
    ).astype(np.float64)
    return Deck(
        structures,
        np.stack([model.numbers for model in models]),
        _joined([model.forces for model in models]),
        _joined([model.angles for model in models]),
        _joined([model.certain for model in models]),
        records,
        _joined(u),
        _joined(v),
        _joined(ahead),
        _joined(v_ahead or [np.empty(0)]),
    )


def _strongest_to_come(strength: Reals, stride: float, length: int) -> Reals:
    """At samples `stride` apart (in those of `strength`), the largest from there on; nothing after the last."""
    result = np.zeros(length)
    if strength.size:
        ahead = np.maximum.accumulate(strength[::-1])[::-1]
        places = np.arange(length) if stride == 1 else np.floor(np.arange(length) * stride).astype(np.int64)
        inside = places < strength.size - 1
        result[inside] = ahead[places[inside]]
    return result


def _starts(sizes: Sequence[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)


def _joined(arrays: Sequence[Reals]) -> Reals:
    return np.ascontiguousarray(arrays[0] if len(arrays) == 1 else np.concatenate(arrays))
