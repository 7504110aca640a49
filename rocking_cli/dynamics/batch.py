"""Many time histories in one call: any selection of structures, records, scale factors, restitutions and sizes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.dynamics import kernels, stepping
from rocking_cli.dynamics.deck import (
    MAX_IMPACTS,
    NEVER_LIFTED,
    check_rtol,
    fit_lanes,
    lay_out,
    never_lifts,
    read_marks,
    run_deck,
    run_lanes,
)
from rocking_cli.dynamics.history import out_of_step
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import ROTATIONS, Outcomes
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.dynamics.sliding import settle
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import RTOL
from rocking_cli.short_repr import short_repr

# Impacts after the record: one ends the current motion, two end an excursion to either side; later motion decays.
DECISIVE_IMPACTS = 3
RESTITUTION_ROUNDING = 1e-9  # relative excess over the bound that is allowed, as equal sides reach the bound
HISTORIES_PER_TASK = 512  # some 50 ms of work; handing it to a thread takes 20 us, and lanes are idle at its end


@short_repr
@dataclass(frozen=True, eq=False)
class Runs:
    """Time histories to run, one for each entry of the arrays; `of` and `every` make them.

    Parameters
    ----------
    model, record : ndarray of int, shape (n,)
        Indices in the lists of models and ground motions.
    scale : ndarray, shape (n,)
        Factor on both components of the ground acceleration.
    polarity : ndarray of int, shape (n,)
        1, or -1 to reverse the horizontal component.
    eta : ndarray, shape (n,)
        Ratio of the rotation rates after and before an impact, in both directions; NaN for that of the structure.
    size : ndarray, shape (n,)
        Factor on every length of the structure.
    slender : ndarray, shape (n,)
        Factor on the slenderness of the structure: the horizontal acceleration is divided by it, and rotations in rad
        are multiplied.

    Raises
    ------
    InputError
        If a number is out of range.
    """

    model: Integers
    record: Integers
    scale: Reals
    polarity: Integers
    eta: Reals
    size: Reals
    slender: Reals

    def __post_init__(self) -> None:
        with np.errstate(invalid="ignore"):
            rules = {
                "model": (self.model >= 0, "a place in the list of models, counted from 0"),
                "record": (self.record >= 0, "a place in the list of ground motions, counted from 0"),
                "scale": (np.isfinite(self.scale), "finite"),
                "polarity": (np.abs(self.polarity) == 1, "1 or -1"),
                "eta": (np.isnan(self.eta) | ((self.eta > 0) & np.isfinite(self.eta)), "positive"),
                "size": (np.isfinite(self.size) & (self.size > 0), "positive"),
                "slender": (np.isfinite(self.slender) & (self.slender > 0), "positive"),
            }
        for name, (right, must) in rules.items():
            if not right.all():
                k = int(np.unravel_index(np.argmin(right), right.shape)[0])
                raise InputError(f"run {k}: {name} must be {must}, got {getattr(self, name)[~right][0]:g}")

    def __len__(self) -> int:
        return len(self.model)

    @classmethod
    def of(
        cls,
        model: ArrayLike,
        record: ArrayLike,
        *,
        scale: ArrayLike = 1.0,
        polarity: ArrayLike = 1,
        eta: ArrayLike = np.nan,
        size: ArrayLike = 1.0,
        slender: ArrayLike = 1.0,
    ) -> Runs:
        """Make runs from arrays of one length, or from numbers that apply to all runs.

        Raises
        ------
        InputError
            If lengths differ, or a number is out of range.
        """
        etas = np.asarray(eta, dtype=np.float64)
        both = etas.ndim == 2 and etas.shape[1] == 2
        try:
            columns = np.broadcast_arrays(
                *np.atleast_1d(model, record, scale, polarity, size, slender),
                *(etas.T if both else np.atleast_1d(etas)[None]),
            )
        except ValueError:
            raise InputError(
                "the runs' models, records, scales, polarities, etas, sizes and slendernesses differ in length"
            ) from None
        m, r, a, s, k, w, *e = (column.astype(np.float64) for column in columns)
        return cls(
            _whole("model", m),
            _whole("record", r),
            a,
            _whole("polarity", s),
            np.stack(e, axis=-1) if both else e[0],
            k,
            w,
        )

    @classmethod
    def every(
        cls,
        models: int,
        records: int,
        *,
        scales: Sequence[float] = (1.0,),
        polarities: Sequence[int] = (1,),
        etas: Sequence[float] = (np.nan,),
        sizes: Sequence[float] = (1.0,),
    ) -> Runs:
        """Make runs of every combination, in the order of the arguments, the last one changing fastest."""
        grid = np.meshgrid(range(models), range(records), scales, polarities, etas, sizes, indexing="ij")
        model, record, scale, polarity, eta, size = (axis.ravel() for axis in grid)
        return cls.of(model, record, scale=scale, polarity=polarity, eta=eta, size=size)


def _whole(name: str, values: Reals) -> Integers:
    if not ((values == np.floor(values)) & (np.abs(values) < 2**53)).all():
        raise InputError(f"every {name} of a run must be a whole number")
    return values.astype(np.int64)


def respond_many(
    models: Sequence[Model],
    motions: Sequence[GroundMotion | None],
    runs: Runs,
    *,
    release: float | Reals | None = None,
    threads: int | None = None,
    rtol: float = RTOL,
    only_peaks: bool = False,
    progress: Callable[[int], None] | None = None,
) -> Outcomes:
    """Run many time histories, each equal to that of `respond` to the last bit.

    Parameters
    ----------
    models : sequence of Model
        Models of structures, as `Structure.model` gives them.
    motions : sequence of GroundMotion or None
        The ground motions, before scaling; None for no ground motion.
    runs : Runs
        The time histories to run.
    release : float or ndarray, shape (n,), optional
        Start all, or each, of the histories at rest, tilted by this fraction of the critical rotation; negative:
        anticlockwise.
    threads : int, optional
        Number of threads; by default, one for each processor.
    rtol : float
        Relative local error of a step of the nonlinear motions.
    only_peaks : bool
        Whether to end a motion, as still rocking, some impacts after its record, when its peaks are final and it can no
        longer overturn; `impact_count` is then that at its end.
    progress : callable, optional
        Called with the number of histories finished since the last call.

    Returns
    -------
    Outcomes
        Outcomes in the order of `runs`, for any number of threads. A motion whose outcome becomes unknown ends there,
        and its `opening` is the largest until then. Samples are not kept: each history takes some 700 bytes of memory.

    Raises
    ------
    InputError
        If a run has the index of a model or a ground motion that does not exist, or a value is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from rocking_cli import GroundMotion, Registry
    >>> from rocking_cli.dynamics.batch import Runs, respond_many
    >>> from rocking_cli.structure import build_models
    >>> wave = GroundMotion("sine", 0.01, 6 * np.sin(2 * np.pi * np.arange(101) / 100), unit="m/s2")
    >>> models = build_models(Registry()["block"](width=0.7, height=2.8), ("nonlinear",))
    >>> [float(x) for x in respond_many(models, [wave], Runs.every(1, 1, scales=(0.3, 0.5))).peak_ratio.round(4)]
    [0.0, 0.2522]
    """
    if threads is not None and threads < 1:
        raise InputError(f"threads must be 1 or more, got {threads}")
    check_rtol(rtol)
    for name, places, there in (("model", runs.model, len(models)), ("record", runs.record, len(motions))):
        if len(runs) and places.max() >= there:
            raise InputError(f"run {int(places.argmax())}: there is no {name} {places.max()}, only {there}")
    etas = _etas(models, runs)
    rows = np.zeros((len(runs), kernels.RUN_COLUMNS))
    rows[:, kernels.RECORD] = runs.record
    rows[:, kernels.FACTOR] = runs.scale * runs.polarity / runs.slender
    rows[:, kernels.V_FACTOR] = abs(runs.scale)
    rows[:, kernels.SIZE] = runs.size
    rows[:, kernels.SLENDER] = runs.slender
    tilts = np.broadcast_to(np.asarray(0.0 if release is None else release, dtype=np.float64), len(runs))
    if release is not None:
        different, which = np.unique(tilts, return_inverse=True)
        starts = np.array([[model.q(float(tilt)) for tilt in different] for model in models])
        rows[:, kernels.START] = starts[runs.model, which]
    rows[:, [kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE]] = etas
    marks = np.full((len(runs), stepping.MARKS), np.nan)  # a run that is never computed has failed
    most_impacts = DECISIVE_IMPACTS - 1 if only_peaks else MAX_IMPACTS  # a history ends after this number of impacts
    rows[:, kernels.STRUCTURE] = runs.model
    rows[:, kernels.LOOSE] = np.array([model.to_first_impact for model in models])[runs.model]
    if len(runs):
        deck = lay_out(models, motions)
        in_lanes = fit_lanes(deck, rows)

        def simulate(which: Bools, progress: Callable[[int], None] | None = None) -> None:
            for run, part in ((run_lanes, which & in_lanes), (run_deck, which & ~in_lanes)):
                chosen, their_marks = rows[part], marks[part]
                work = partial(run, deck, chosen, their_marks, rtol=rtol, most_impacts=most_impacts)
                in_parts(work, len(chosen), HISTORIES_PER_TASK, threads, progress)
                marks[part] = their_marks

        still = never_lifts(deck, rows)
        marks[still] = NEVER_LIFTED
        if progress is not None and still.any():
            progress(int(still.sum()))
        simulate(~still, progress)
        loose = out_of_step(models, motions, rows, marks, tilts, rtol=rtol, most_impacts=most_impacts, threads=threads)
        rows[loose, kernels.LOOSE] = 1.0
        simulate(loose)
    reach = np.array([model.reach for model in models])
    phi_cr = np.array([model.phi_cr for model in models]).reshape(-1, 2)[runs.model]
    slip, _ = settle(marks, [model.sliding for model in models], motions, rows)
    outcomes = replace(read_marks(marks, phi_cr, reach[runs.model]), slip=slip)
    if (runs.slender == 1).all():
        return outcomes
    peaks = {name: getattr(outcomes, name) * runs.slender for name in ROTATIONS}
    return replace(outcomes, **peaks)


def _etas(models: Sequence[Model], runs: Runs) -> Reals:
    """Return the restitution of both directions for each run, shape (n, 2).

    A restitution above 1 is refused if an impact would gain energy by it. If the inertias at rest differ, even one
    below 1 may do so, which is left to the user.
    """
    etas = np.broadcast_to(runs.eta[:, None], (len(runs), 2)) if runs.eta.ndim == 1 else runs.eta
    bounds = np.maximum(1.0, np.array([model.most_eta for model in models]).reshape(-1, 2))[runs.model]
    with np.errstate(invalid="ignore"):
        beyond = etas > bounds * (1 + RESTITUTION_ROUNDING)
    if beyond.any():
        k, side = (int(place) for place in np.argwhere(beyond)[0])
        raise InputError(f"run {k}: eta must be in (0, {bounds[k, side]:.6g}], got {etas[k, side]:g}")
    return etas
