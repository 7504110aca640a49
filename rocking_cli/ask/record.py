"""`rk.record`: how strong a ground motion is, and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, done, signs_of, unprocessed
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import Measures
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.processing.intensity import Measure
from rocking_cli.views.record import Examined
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.given import StructureLike
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.oscillator import ResponseSpectrum
    from rocking_cli.processing.scaled import Scaled
    from rocking_cli.structure import Structure

PATIENCE = 1.0  # s without a word


@dataclass(frozen=True, eq=False, repr=False)
class RecordAnswer(Answer[Measures]):
    """Measures of a ground motion, of the first polarity if there are two.

    Parameters
    ----------
    examined : tuple of Examined
        The record, its measures, doubts and fitted pulses, in each polarity.
    motions : tuple of GroundMotion
        The corrected and scaled motion in each polarity.
    """

    examined: tuple[Examined, ...] = field(kw_only=True)
    motions: tuple[GroundMotion, ...] = field(kw_only=True)


@takes_numbers
def record(
    motion: Motion | Motions,
    *,
    polarity: str | int = "1",
    structure: StructureLike | None = None,
    fit_pulse: bool = False,
    measures: str | None = None,
    spectrum: object = None,
    period: tuple[float, float] | None = None,
    damping: float | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> RecordAnswer:
    """Measure the strength of a ground motion, and check it for defects.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    polarity : {"1", "-1", "both"}
        Polarity of the motion: as given, reversed, or one after the other.
    structure : Mechanism, str or Path, optional
        Structure, to check the sampling interval and for relative measures.
    fit_pulse : bool
        Whether to fit a sine, a Ricker and a near-fault pulse; the plot shows the best.
    measures : str, optional
        Names of intensity measures to compute as well, such as "Sa(1.0), CAV", or "all".
    spectrum : bool
        Whether to compute the response spectrum.
    period : (float, float), optional
        Shortest and longest period of the spectrum [s]; by default 0.02 and 10.
    damping : float, optional
        Damping ratio of the spectrum; by default 0.05.
    watch : Watcher
        Told what is doubtful about the record, and how far the fits are.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    RecordAnswer
        Peaks, Arias intensity, durations and mean period; `examined` has all else.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The measures are exact for straight lines between the samples; the intensity is that of Arias (1970), pi/(2 g) times
    the integral of the squared acceleration.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> round(rk.record("ricker:0.6g:0.5s").pga, 6)
    0.6
    """
    from rocking_cli.excitation.doubts import coarse_for, doubts
    from rocking_cli.excitation.measures import measure
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.views.record import data, parts

    if not spectrum and (period is not None or damping is not None):
        raise InputError("`period` and `damping` require a response spectrum: give `spectrum`")
    ready = None
    if structure is not None:
        from rocking_cli.ask.given import structure_of

        ready = structure_of(structure, watch)
    p = ready.p if ready is not None else None
    read, signs = Motions.of(motion, options).one(0.0), signs_of(polarity)
    if any(each.startswith("from ") for each in read.motion.processing):
        watch.note(f"{read.motion.name}{done(read.motion)}")
    found = doubts(read.motion.of_ground, measure(read.motion.of_ground))
    found += coarse_for(read.motion, p) if p is not None else []
    examined: list[Examined] = []
    scaled = [read.motion.scaled(sign * read.factor) for sign in signs]
    for sign, one in zip(signs, scaled, strict=True):
        seen = Examined(
            name_of(read.file) if read.file is not None else read.motion.name,
            f"{read.motion.name}, reversed" if len(signs) > 1 and sign < 0 else read.motion.name,
            read.motion,
            sign * read.factor,
            measure(one),
            found,
            p * read.motion.dt if p is not None else None,
            _fit(one, watch) if fit_pulse else [],
            _measured(one, measures, ready),
            _spectrum(one, period, damping) if spectrum else None,
        )
        examined.append(seen)
    for doubt in found:
        watch.warn(f"{read.motion.name}: {doubt.text}")
    first, own = examined[0], examined[0].measures
    said = f"{first.label}: PGA {own.pga:.3g} g, PGV {own.pgv:.3g} m/s."
    return RecordAnswer(
        "record",
        own,
        View(lambda: data(first), [*parts(examined, 100), said]),
        partial(_columns, scaled[0]),
        partial(_figure, scaled[0], first, read),
        examined=tuple(examined),
        motions=tuple(scaled),
    )


def _fit(motion: GroundMotion, watch: Watcher) -> list[PulseFit]:
    """Fit the best pulse of each shape by each criterion; report progress if that takes long."""
    from rocking_cli.excitation.pulse_fit import CRITERIA, FITTED, fit_pulses

    fits: list[PulseFit] = []
    since = perf_counter()
    for fit in fit_pulses(motion):
        fits.append(fit)
        if perf_counter() - since > PATIENCE:
            watch.note(f"{motion.name}: {len(fits)} of {len(CRITERIA) * len(FITTED)} pulses fitted")
            since = perf_counter()
    return fits


def _measured(motion: GroundMotion, names: str | None, structure: Structure | None) -> dict[Measure, float]:
    """Compute the measures given by name; `all` without a structure means those that need none."""
    if names is None:
        return {}
    from rocking_cli.processing.intensity import ALL, parse_measures
    from rocking_cli.studies.motion_intensities import intensities, reference_of

    asked = parse_measures(names)
    if structure is None and names.strip().lower() == ALL:
        asked = [each for each in asked if not each.is_relative]
    return intensities(motion, asked, reference_of(structure) if structure is not None else None)


def _spectrum(motion: GroundMotion, period: tuple[float, float] | None, damping: float | None) -> ResponseSpectrum:
    from rocking_cli.processing import oscillator

    periods = oscillator.periods_between(*(period or (oscillator.SHORTEST, oscillator.LONGEST)))
    return oscillator.response_spectrum(motion, periods, oscillator.DAMPING if damping is None else damping)


def _columns(motion: GroundMotion) -> Columns:
    return {"t [s]": np.arange(motion.npts) * motion.dt, "a_g [g]": motion.acceleration / STANDARD_GRAVITY}


def _figure(motion: GroundMotion, examined: Examined, read: Scaled) -> Figure:
    """Draw the fitted pulses, or the record before and after its corrections, or the record alone."""
    from rocking_cli.plotting.processing import draw_before_and_after
    from rocking_cli.plotting.pulse_fit import draw_pulses
    from rocking_cli.plotting.record import draw_record
    from rocking_cli.processing.steps import Trim

    if examined.pulses:
        return draw_pulses(motion, _best(examined.pulses), examined.measures.t_95 or motion.duration)
    if read.reading is not None and (before := unprocessed(read)) is not None:
        start = sum(step.start for step in read.reading.steps if isinstance(step, Trim))
        return draw_before_and_after(before.scaled(examined.factor), motion, start)
    return draw_record(motion, examined.measures)


def _best(fits: Sequence[PulseFit]) -> list[PulseFit]:
    """Return the fitted pulse that captures most, by each criterion, velocity first."""
    by_criterion = {fit.criterion: fit for fit in sorted(fits, key=lambda fit: fit.captured)}
    return [by_criterion["velocity"], by_criterion["acceleration"]]
