"""`rk.record`: how strong ground motions are, and what is doubtful about them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import nan
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from rocking_cli.ask.answer import Answer, Answers, Dimensions, drawn
from rocking_cli.ask.ground_motions import Motions, done, motion_of, unprocessed
from rocking_cli.ask.kinds import STANDARD_OUTPUT
from rocking_cli.ask.verbs import answers, are_several, verb, write_rows
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.excitation.pulse_fit import CRITERIA, FITTED, PulseFit, fit_pulses
from rocking_cli.excitation.records.opening import name_of
from rocking_cli.excitation.records.prepared import is_record_csv, write_record_csv
from rocking_cli.processing import oscillator
from rocking_cli.processing.intensity import ALL_MEASURES, Measure, Reference, RunMeasure, parse_measures
from rocking_cli.processing.reading import Listed
from rocking_cli.processing.steps import Trim, multiplied
from rocking_cli.questions.record.asked import RecordAsked, ResponseSpectrumAsked
from rocking_cli.questions.record.view import Examined, data, parts, spectra_table, spectrum_view
from rocking_cli.structure import Structure
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.oscillator import ResponseSpectrum
    from rocking_cli.processing.reading import Scaled

SPECTRA = "questions.record.picture.draw_response_spectra"
PROGRESS_DELAY = 1.0  # s of work before progress is shown


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

    @property
    def measures(self) -> dict[str, float]:
        """Values of the measures that were requested, by their standard names; NaN if one is undefined."""
        return {str(measure): value for measure, value in self.examined[0].asked.items()}


@verb(RecordAsked)
def record(asked: RecordAsked, watch: Watcher) -> RecordAnswer | Answers[RecordAnswer]:
    """Measure the strength of ground motions, and check them for defects.

    Returns
    -------
    RecordAnswer
        Peaks, Arias intensity, durations and mean period; `examined` has all else. For several motions, `Answers` with
        one for each, by its name.

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
    >>> round(rk.record("ricker:0.6g:0.5s").pga_g, 6)
    0.6
    >>> block = rk.Block(width=0.7, height=2.8)
    >>> round(rk.record("ricker:0.6g:0.5s", structure=block, measures="PGA/(g lambda)").measures["PGA/(g lambda)"], 6)
    2.4
    """
    motions, signs, spectrum = asked.ground_motions, asked.signs, asked.spectrum is not False
    motions.check()
    motions.remark(watch)
    places = _places(asked.out, motions, signs) if asked.out is not None else {}
    ready = None
    if asked.structure is not None:
        from rocking_cli.ask.inputs import structure_of

        ready = structure_of(asked.structure, watch)
    several = are_several(asked.motions, motions)
    if asked.plot is not None and not spectrum and motions.count * len(signs) > 1:
        raise InputError(f"{named('plot')} draws a single record: give one FILE and one polarity")

    by_name = dict[str, RecordAnswer]()
    for k, source in enumerate(motions.sources):
        try:
            read = motions.read(source)
            seen, scaled = _examine(read, signs, ready, watch, asked.measures, fit_pulse=asked.fit_pulse)
        except InputError as error:
            if not by_name and k == motions.count - 1:
                raise
            watch.leave_out(error)
            continue
        if spectrum:
            seen = [each._replace(spectrum=_spectrum(one, asked)) for each, one in zip(seen, scaled, strict=True)]
        for sign, each, one in zip(signs, seen, scaled, strict=True):
            if (k, sign) in places:
                _write(places[k, sign], each, watch)
            watch.take(_answer([each], [one], read))
        by_name[_unique(seen[0], by_name)] = _answer(seen, scaled, read)
    examined = [seen for each in by_name.values() for seen in each.examined]
    answer: RecordAnswer | Answers[RecordAnswer] = by_name[next(iter(by_name))]
    if several:
        kept = {"spectrum": partial(spectra_table, _spectra(examined))} if spectrum else {}
        figure = drawn(SPECTRA, _spectra(examined)) if spectrum else None
        answer = answers("records", "motion", by_name, list(parts(examined)), figure, kept)
    if isinstance(asked.spectrum, Path):
        write_rows(asked.spectrum, [answer.tables["spectrum"]()], watch)
    if asked.plot is not None:
        answer.plot(asked.plot)
        watch.note(f"wrote {asked.plot}")
    return answer


def _examine(
    read: Scaled,
    signs: Sequence[int],
    ready: Structure | None,
    watch: Watcher,
    measures: str | Sequence[str] | None,
    *,
    fit_pulse: bool,
) -> tuple[list[Examined], list[GroundMotion]]:
    """Return the results for a motion in each polarity, and the motions; warn of what is doubtful."""
    p = ready.p if ready is not None else None
    if any(each.startswith("from ") for each in read.motion.processing):
        watch.note(f"{read.motion.name}{done(read.motion)}")
    warnings = doubts(read.motion.of_ground, measure(read.motion.of_ground))
    warnings += coarse_for(read.motion, p) if p is not None else []
    scaled = [read.motion.scaled(sign * read.factor) for sign in signs]
    examined = [
        Examined(
            name_of(read.file) if read.file is not None else read.motion.name,
            f"{read.motion.name}, reversed" if len(signs) > 1 and sign < 0 else read.motion.name,
            read.motion,
            sign * read.factor,
            measure(one),
            warnings,
            p * read.motion.dt if p is not None else None,
            _fit(one, watch) if fit_pulse else [],
            _measured(one, measures, ready),
        )
        for sign, one in zip(signs, scaled, strict=True)
    ]
    for doubt in warnings:
        watch.warn(f"{read.motion.name}: {doubt.text}")
    return examined, scaled


def _answer(examined: Sequence[Examined], scaled: Sequence[GroundMotion], read: Scaled) -> RecordAnswer:
    first = examined[0]
    with_spectra = first.spectrum is not None
    return RecordAnswer(
        "record",
        first.measures,
        View(lambda: data(first), [*parts(examined)]),
        partial(_columns, scaled[0]),
        drawn(SPECTRA, _spectra(examined)) if with_spectra else partial(_figure, scaled[0], first, read),
        tables={"spectrum": partial(spectra_table, _spectra(examined))} if with_spectra else {},
        examined=tuple(examined),
        motions=tuple(scaled),
    )


def _places(
    out: Path | BinaryIO, motions: Motions, signs: Sequence[int]
) -> dict[tuple[int, int], Path | BinaryIO]:  # fmt: skip
    """Return the file for each record, by its index and polarity; in a folder, named after record and channel.

    All are checked: they can be written, no file that is read is among them, and files that are not prepared records
    are kept.
    """
    from rocking_cli.io.files import check_writable, folder, keep_apart
    from rocking_cli.io.tables import PARQUET

    paths: dict[tuple[int, int], Path] = {}
    streamed = not isinstance(out, Path) or str(out) == STANDARD_OUTPUT
    alone = not isinstance(out, Path) or streamed or (out.suffix.lower() == ".csv" and not out.is_dir())
    if alone and (motions.count > 1 or len(signs) > 1):
        raise InputError(f"{named('out')} FILE.csv takes one record: give one motion and one polarity, or a folder")
    if not isinstance(out, Path) or streamed:
        return {(0, signs[0]): out}
    if out.suffix.lower() == PARQUET:
        check_writable(out, ".csv")
    if alone:
        paths[0, signs[0]] = out
    else:
        folder(str(out))
    for k, record in enumerate(motions.sources if not alone else ()):
        if not isinstance(record, Listed):
            continue
        channel = record.reading(motions.reading).channel
        suffix = "-" + re.sub(r"\W+", "-", channel.strip()) if channel is not None else ""
        for sign in signs:
            turned = "-reversed" if len(signs) > 1 and sign < 0 else ""
            path = out / f"{Path(name_of(record.path)).stem}{suffix}{turned}.csv"
            if path in paths.values():
                what = "two records would be written to the same file"
                raise InputError(Problem(what, str(path), hint="write them one by one"))
            paths[k, sign] = path
    for path in paths.values():
        keep_apart([(named("out"), path)], [str(each.path) for each in motions.records])
        if not alone and path.exists() and not is_record_csv(path):
            what = f"{named('out')} would overwrite a file that rocking did not write"
            raise InputError(Problem(what, str(path), hint="move it, or name another folder"))
        check_writable(path)
    return {**paths}


def _write(place: Path | BinaryIO, seen: Examined, watch: Watcher) -> None:
    """Write a record, as it is scaled."""
    from rocking_cli.io.files import write_whole

    motion = multiplied(seen.motion, seen.factor)
    if not isinstance(place, Path):
        write_record_csv(place, motion)
        return
    if str(place) == STANDARD_OUTPUT:
        with watch.standard_output() as stream:
            write_record_csv(stream, motion)
        return
    write_whole(place, partial(write_record_csv, motion=motion))
    watch.note(f"wrote {place.resolve()}")


def _unique(record: Examined, taken: Iterable[str]) -> str:
    """Return the name of a record, with its file or a number if it is taken."""
    known = set(taken)
    more = (f"{record.label} ({k})" for k in range(2, len(known) + 3))
    names = (record.label, f"{record.label} ({record.file})", *more)
    return next(name for name in names if name not in known)


def _spectra(examined: Sequence[Examined]) -> dict[str, ResponseSpectrum]:
    spectra: dict[str, ResponseSpectrum] = {}
    for each in examined:
        if each.spectrum is not None:
            spectra[_unique(each, spectra)] = each.spectrum
    return spectra


def _fit(motion: GroundMotion, watch: Watcher) -> list[PulseFit]:
    """Fit the best pulse of each shape by each criterion; report progress if that takes long."""
    fits: list[PulseFit] = []
    since = perf_counter()
    for fit in fit_pulses(motion):
        fits.append(fit)
        if perf_counter() - since > PROGRESS_DELAY:
            watch.note(f"{motion.name}: {len(fits)} of {len(CRITERIA) * len(FITTED)} pulses fitted")
            since = perf_counter()
    return fits


def _measured(
    motion: GroundMotion, names: str | Sequence[str] | None, structure: Structure | None
) -> dict[Measure, float]:
    """Compute the measures given by name; `all` without a structure means those that need none."""
    if names is None:
        return {}
    names = names if isinstance(names, str) else ", ".join(names)

    parsed = parse_measures(names)
    if structure is None and names.strip().lower() == ALL_MEASURES:
        parsed = [each for each in parsed if not each.is_relative]
    return intensities(motion, parsed, reference_of(structure) if structure is not None else None)


def _spectrum(motion: GroundMotion, asked: RecordAsked) -> ResponseSpectrum:

    periods = oscillator.periods_between(*(asked.period or (oscillator.SHORTEST_PERIOD, oscillator.LONGEST_PERIOD)))
    return oscillator.response_spectrum(motion, periods, asked.damping)


def _columns(motion: GroundMotion) -> Columns:
    return {"t [s]": np.arange(motion.npts) * motion.dt, "a_g [g]": motion.acceleration / STANDARD_GRAVITY}


def _figure(motion: GroundMotion, examined: Examined, read: Scaled) -> Figure:
    """Draw the fitted pulses, or the record before and after its corrections, or the record alone."""
    from rocking_cli.questions.record.picture import draw_before_and_after, draw_pulses, draw_record

    if examined.pulses:
        # Of each criterion the pulse that captures most, velocity first.
        best = {fit.criterion: fit for fit in sorted(examined.pulses, key=lambda fit: fit.captured)}
        end = examined.measures.t_95 or motion.duration
        return draw_pulses(motion, [best["velocity"], best["acceleration"]], end)
    if read.reading is not None and (before := unprocessed(read)) is not None:
        start = sum(step.start for step in read.reading.steps if isinstance(step, Trim))
        return draw_before_and_after(before.scaled(examined.factor), motion, start)
    return draw_record(motion, examined.measures)


@verb(ResponseSpectrumAsked)
def response_spectrum(asked: ResponseSpectrumAsked, watch: Watcher) -> Answer[ResponseSpectrum]:
    """Compute the response spectrum of a ground motion: the peak responses of linear oscillators.

    Returns
    -------
    Answer of ResponseSpectrum
        `periods`, and at each of them the displacement `sd` [m], the pseudo-velocity `sv` [m/s] and the
        pseudo-acceleration `sa` [standard gravity].

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The spectrum is exact for straight lines between the samples, during the motion and after it.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.response_spectrum("sine:0.2g:0.8s", [0.8]).sa.round(2).tolist()
    [0.54]
    """
    scaled = motion_of(asked.motions).scaled(asked.scale)
    spectrum = oscillator.response_spectrum(scaled, asked.periods, asked.damping)
    named = {scaled.name: spectrum}
    figure = drawn(SPECTRA, named)
    dims = [Dimensions(("motion", "period"))]
    return Answer(
        "response spectrum",
        spectrum,
        spectrum_view(scaled.name, spectrum),
        partial(spectra_table, named),
        figure,
        dims=dims,
    )


def reference_of(structure: Structure) -> Reference:
    """Return the reference values of measures relative to a structure, in the direction that uplifts first."""
    gravity = structure.mechanism.gravity
    if structure.why_no_block is not None:
        return Reference(nan, min(side.lambda_ for side in structure.statics), gravity)
    block = min((structure.equivalence.positive, structure.equivalence.negative), key=lambda each: each.lambda_)
    return Reference(block.p, block.lambda_, gravity, block.v_imp)


def intensities(
    motion: GroundMotion, measures: Sequence[Measure], structure: Reference | None = None
) -> dict[Measure, float]:  # fmt: skip
    """Compute intensity measures of a ground motion.

    Parameters
    ----------
    motion : GroundMotion
        The scaled motion.
    measures : sequence of Measure
        The measures to compute.
    structure : Reference, optional
        Reference values of relative measures.

    Returns
    -------
    dict of Measure to float
        Value of each measure; NaN if the motion or the structure has none.

    Raises
    ------
    InputError
        If a measure is relative, and there is no structure.
    PluginError
        If the plugin of a measure fails.
    """
    bare = [str(measure) for measure in measures if measure.is_relative]
    if bare and structure is None:
        raise InputError(Problem(f"{', '.join(bare)}: relative to what is shaken", hint=f"give a {named('structure')}"))
    values: dict[Measure, float] = {}
    for requested in measures:
        if isinstance(requested, RunMeasure):
            assert structure is not None
            values[requested] = requested.value(motion, structure)
        else:
            assert requested.base is not None
            value = requested.base.value(motion)
            values[requested] = float(value if structure is None else requested.relative(value, structure))
    return values
