"""Ground motions as they are given to a verb, with how to read, correct and scale them."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from textwrap import shorten
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem, named, renamed
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.excitation.records.opening import allow_again, matching_files
from rocking_cli.processing.reading import LIST_FILE, Listed, Reading, Scaled, is_list, reading_of
from rocking_cli.processing.reading_options import READING, SCALING
from rocking_cli.processing.steps import Resample, process
from rocking_cli.views.view import MAX_DETAILED_MOTIONS, processing_in_words

Motion = GroundMotion | Pulse | Scaled | str | Path | NDArray[Any]
"""Ground motion or pulse, file of a record, pulse as text such as `sine:0.6g:0.8s`, or samples in an array."""
MAX_PGA, MAX_PGV = 1e3, 1e4  # g and m/s: larger than in any ground motion, and too long to simulate
Source = GroundMotion | Scaled | Pulse | Listed | InputError
"""Source of a motion: an object, a single file of a pattern or list, or the reason why there is no file."""


@dataclass(frozen=True, eq=False)
class Motions:
    """Ground motions as they are given, and how to read and scale them.

    Parameters
    ----------
    sources : tuple of Source
        The motions, the files of patterns and lists one by one.
    reading : Reading
        How the files are read and corrected, and the floor.
    scale, target_pga, target_pgv : float, optional
        Scale factor, or what to scale to, as in `SCALING`.
    repeated : int
        Number of motions that were given before, and are not among the sources again.
    """

    sources: tuple[Source, ...]
    reading: Reading = field(default_factory=Reading)
    scale: float | None = None
    target_pga: float | None = None
    target_pgv: float | None = None
    repeated: int = 0

    @classmethod
    def of(cls, given: Motions | Motion | Sequence[Motion], options: Mapping[str, Any]) -> Motions:
        """Return the motions of a verb, from its motion arguments and its keyword arguments. Raises `InputError`."""
        if isinstance(given, Motions):
            return given
        for name, value in options.items():
            if value is not None and not each_of(given):
                what = "has no effect, as no ground motion is given"
                raise InputError(Problem(what, field=named(name), hint=f"give {named('motions')}"))
        scaling = {
            name: SCALING[name].parse(each) for name, each in options.items() if name in SCALING and each is not None
        }
        if len(scaling) > 1:
            raise InputError(
                f"{named('scale')}, {named('target_pga')} and {named('target_pgv')} cannot be combined: "
                "give one of them"
            )
        every: list[tuple[object, Source]] = []
        for one in each_of(given):
            if isinstance(one, np.ndarray):
                every += [(id(each), each) for each in _of_array(one, options)]
            elif isinstance(one, GroundMotion | Scaled):
                every.append((id(one), one))
            elif (pulse := pulse_in(one)) is not None:
                every.append((pulse, pulse))
            else:
                try:
                    every += [((each.path, each.folder, repr(each.entry)), each) for each in files_of(str(one))]
                except InputError as error:
                    every.append((id(error), error))
        sources = dict(every)
        if any(isinstance(one, np.ndarray) for one in each_of(given)) and not _have_files(sources.values()):
            options = {name: each for name, each in options.items() if name not in ("dt", "units")}  # of the array
        repeated = len(every) - len(sources)
        return cls(tuple(sources.values()), reading_of(options).check(), **scaling, repeated=repeated)

    def __bool__(self) -> bool:
        """Return whether any motion is given."""
        return bool(self.sources)

    @property
    def count(self) -> int:
        """Number of motions, including those that cannot be found."""
        return len(self.sources)

    @property
    def records(self) -> list[Listed]:
        """Files of records, in the order in which they are given."""
        return [each for each in self.sources if isinstance(each, Listed)]

    @property
    def has_records(self) -> bool:
        """Whether anything but pulses is given."""
        return not all(
            isinstance(each, Pulse) or (isinstance(each, Scaled) and each.pulse is not None) for each in self.sources
        )

    def gather(
        self, p: float, watch: Watcher = SILENT, whom: str = "this structure", *, with_vertical: bool = False
    ) -> list[Scaled]:
        """Read all motions and find their scale factors.

        Parameters
        ----------
        p : float
            Frequency parameter of the smallest structure under these motions [rad/s], to which sampling is compared.
        watch : Watcher
            Told which motions were read, what is doubtful about them, and which of several cannot be used.
        whom : str
            Name of that structure in warnings.
        with_vertical : bool
            Whether a vertical component is read by the same arguments.

        Returns
        -------
        list of Scaled
            The motions that can be used, at least one, each with a unique name.

        Raises
        ------
        InputError
            If none can be used, a pulse is malformed, or an argument describes records and none is given.
        """
        self.check(with_vertical=with_vertical)
        self.remark(watch)
        if self.sources and all(isinstance(each, Scaled) for each in self.sources):
            return [each for each in self.sources if isinstance(each, Scaled)]  # these motions were read before
        chosen: list[Scaled] = []
        for place, source in enumerate(self.sources):
            try:
                one = self.read(source)
            except InputError as error:
                if self.count == 1:
                    raise
                watch.leave_out(error)
                continue
            name, used = one.motion.name, {other.motion.name for other in chosen}
            if name in used and isinstance(source, Listed):
                name = f"{name} ({source.path.parent})"
            if name in used:
                name = f"{name} ({place + 1})"
            chosen.append(one._replace(motion=replace(one.motion, name=name)))
        if not chosen:
            raise InputError("no ground motion can be used")
        _introduce(chosen, watch)
        warn_about([one.motion for one in chosen if one.pulse is None], watch, p, whom)
        return chosen

    def remark(self, watch: Watcher) -> None:
        """Tell that a motion is given twice, and that a negative scale reverses it."""
        if self.repeated:
            watch.warn(f"a motion that is given twice is used once: {self.repeated} left out")
        if self.scale is not None and self.scale < 0:
            watch.note(
                f"{named('scale')} {self.scale:g} is negative: it reverses the motion, as {named('polarity')} -1 does"
            )

    def refused(self, chosen: Sequence[Scaled]) -> list[str]:
        """Return the names of the files that are not among the motions that can be used, in their order."""
        used = [id(each.record) for each in chosen]
        return [each.path.name for each in self.records if id(each) not in used]

    def vertical(
        self, motion: Scaled, file: str | Path, dt: float | None, channel: str | None, watch: Watcher = SILENT
    ) -> GroundMotion:
        """Read the vertical component of a motion: interval and channel of its own, all else as for the horizontal one.

        Raises
        ------
        InputError
            If the file cannot be read; the message names `vertical_dt` and `vertical_channel`.
        """
        reading = motion.record.reading(self.reading) if motion.record is not None else self.reading
        arguments = {"channel": "vertical_channel"}
        if dt is not None or reading.dt is None:
            arguments["dt"] = "vertical_dt"
        try:
            with renamed(arguments):
                component = reading.vertical(file, dt, channel)
        except InputError as error:  # a hint on `dt` is of the interval that was given for the other component
            hint = f"give the interval of the vertical component with {named('vertical_dt')}"
            of_other = [each.hint is not None and named("dt") in each.hint for each in error.problems]
            problems = zip(error.problems, of_other, strict=True)
            raise InputError(*(replace(each, hint=hint) if other else each for each, other in problems)) from None
        introduce("vertical", Scaled(component, 1.0), watch)
        warn_about([component], watch)
        return component

    def read(self, source: Source) -> Scaled:
        """Read one of the motions, and find its scale factor. Raises `InputError`."""
        if isinstance(source, InputError):
            raise source
        if isinstance(source, Scaled):
            return source
        if isinstance(source, Listed):
            motion, reading = source.settled(self.reading)
            one = Scaled(motion, 1.0, record=source, reading=reading)
        elif isinstance(source, Pulse):
            one = Scaled(self.reading.on_floor(source.sampled()), 1.0, pulse=source)
        else:
            one = Scaled(self.reading.on_floor(process(source, self.reading.steps)), 1.0)
        return one._replace(factor=self.factor(one.motion, measure(one.motion.of_ground)))

    def factor(self, motion: GroundMotion, measured: Measures) -> float:
        """Return the factor on a motion as read; the polarity is not included.

        Raises
        ------
        InputError
            If the motion is zero, or the scaled motion is beyond any ground motion.
        """
        by = 1.0 if self.scale is None else self.scale
        for target_peak, unscaled_peak in ((self.target_pga, measured.pga_g), (self.target_pgv, measured.pgv)):
            if target_peak is not None:
                if unscaled_peak == 0:
                    what = "the record is zero throughout and cannot be scaled to a peak"
                    raise InputError(Problem(what, motion.name))
                by = target_peak / unscaled_peak
        pga, pgv = abs(by) * measured.pga_g, abs(by) * measured.pgv
        if not (pga <= MAX_PGA and pgv <= MAX_PGV):
            scaled = f" scaled by {by:.4g}" if by != 1 else ""
            problem = f"PGA = {pga:.4g} g and PGV = {pgv:.4g} m/s{scaled} are not plausible for a ground motion"
            hint = f"at most {MAX_PGA:g} g and {MAX_PGV:g} m/s: check unit, interval and factor"
            raise InputError(Problem(problem, motion.name, hint=hint))
        return by

    def check(self, *, with_vertical: bool = False) -> None:
        """Raise `InputError` if an argument has no effect; unit and interval also apply to a vertical component."""
        of_both = ("units", "dt") if with_vertical else ()
        extra = [name for name in self.reading.options if name not in (*of_both, "floor")]
        what = "record" if not self.has_records else "" if _have_files(self.sources) else "file"
        if what == "record":
            extra += [step.name for step in self.reading.steps]
        if extra and what:
            verb = "describes" if len(extra) == 1 else "describe"
            raise InputError(f"{' and '.join(map(named, extra))} {verb} a {what}, and no {what} is given")


def _have_files(sources: Iterable[Source]) -> bool:
    """Return whether a source is a file, or was read before."""
    return any(isinstance(each, Listed | Scaled | InputError) for each in sources)


def unprocessed(motion: Scaled) -> GroundMotion | None:
    """Return the record of a motion before its corrections; None if it has none."""
    reading = motion.reading
    if reading is None or motion.file is None or not reading.steps:
        return None
    allow_again(motion.file)
    grid = tuple(step for step in reading.steps if isinstance(step, Resample))  # needed if times are uneven
    return replace(reading.without("floor"), steps=grid).read(motion.file)


def pulse_in(given: Motion) -> Pulse | None:
    """Return a pulse, made from its text if that is given; None for a record. A file of the same name has priority."""
    if isinstance(given, Pulse):
        return given
    if isinstance(given, str) and given.partition(":")[0] in PulseShapes() and not Path(given).exists():
        return parse_pulse(given)
    if not isinstance(given, str | Path):
        hint = 'make one of samples: rk.GroundMotion("mine", 0.01, samples, unit="g")'
        what = f"must be a ground motion, a pulse or a file, got {type_in_words(given)}"
        raise InputError(Problem(what, field="motion", hint=hint))
    return None


def _of_array(samples: NDArray[Any], options: Mapping[str, Any]) -> list[GroundMotion]:
    """Return the motions in the rows of an array, with the interval and the unit of the options."""
    for name, what in (("dt", "interval"), ("units", "unit")):
        if options.get(name) is None:
            hint = "give both, such as dt=0.01, units='g' or units='m/s2'"
            raise InputError(
                Problem(f"is missing: samples in an array need their {what}", field=named(name), hint=hint)
            )
    if samples.ndim > 1 and len(samples) > samples.shape[1]:
        what = f"would be {len(samples):,} motions of {samples.shape[1]} samples"
        raise InputError(
            Problem(what, field="motions", hint="a row of an array is a motion: transpose it, `samples.T`")
        )
    dt, unit = READING["dt"].parse(options["dt"]), options["units"]
    return [GroundMotion(f"motion {k}", dt, row, unit=unit) for k, row in enumerate(np.atleast_2d(samples), 1)]


def motion_of(given: Motion) -> GroundMotion:
    """Read a ground motion from its file, or sample a pulse. Raises `InputError`."""
    if isinstance(given, GroundMotion):
        return given
    if isinstance(given, Scaled):
        return given.motion.scaled(given.factor)
    pulse = pulse_in(given)
    return pulse.sampled() if pulse is not None else Reading().read(str(given))


def files_of(place: str) -> list[Listed]:
    """Return the records of a file, a pattern, a list or its folder. Raises `InputError` if there are none."""
    listed, of_folder = [], Path(place) / LIST_FILE
    # pathlib raises where a folder may not be entered.
    for path in [of_folder] if os.path.isfile(of_folder) else matching_files(place):  # noqa: PTH113
        if is_list(path):
            from rocking_cli.processing.record_list import read_list

            listed += read_list(path)
        else:
            listed.append(Listed(path))
    return listed


def type_in_words(given: object) -> str:
    """Return the type of a value, for messages: `a dict`."""
    name = type(given).__name__
    return f"{'an' if name[0].lower() in 'aeiou' else 'a'} {name}"


def each_of(given: Any) -> list[Any]:
    """Return a list or tuple as a list, and one thing as a list of one."""
    return list(given) if isinstance(given, list | tuple) and not isinstance(given, Scaled) else [given]


def done(motion: GroundMotion) -> str:
    """Return what was done to a motion, as the continuation of a sentence."""
    return f"; {steps}" if (steps := processing_in_words(motion)) else ""


def introduce(what: str, one: Scaled, watch: Watcher) -> None:
    """Tell which motion was read, under the name `what`, and how it is scaled."""
    motion, by, pulse = one.motion, one.factor, one.pulse
    ground = motion.of_ground
    scaled = ""
    if by != 1:
        measured = measure(ground)
        scaled = f", scaled by {by:.6g}: PGA = {abs(by) * measured.pga_g:.4g} g, PGV = {abs(by) * measured.pgv:.4g} m/s"
    if pulse is not None:
        read = f"{pulse.title}, {pulse.amplitude / STANDARD_GRAVITY:.4g} g, period {pulse.period:.4g} s, lasts"
        watch.note(f"pulse: {read} {pulse.duration:.4g} s{scaled}{done(motion)}")
        return
    watch.note(
        f"{what}: {motion.name} ({motion.format}), {ground.npts} points, dt = {ground.dt:.6g} s, "
        f"in {motion.source_unit}, PGA = {ground.pga_g:.4g} g{scaled}{done(motion)}"
    )


def _introduce(chosen: Sequence[Scaled], watch: Watcher) -> None:
    if len(chosen) <= MAX_DETAILED_MOTIONS:
        for one in chosen:
            introduce("motion", one, watch)
        return
    peaks = [abs(one.factor) * one.motion.of_ground.pga_g for one in chosen]
    scaled = " as scaled" if any(one.factor != 1 for one in chosen) else ""
    watch.note(f"motions: {len(chosen)}, PGA from {min(peaks):.3g} to {max(peaks):.3g} g{scaled}")


def warn_about(motions: Sequence[GroundMotion], watch: Watcher, p: float = 0.0, whom: str = "this structure") -> None:
    """Warn of doubts about motions, also for a structure of a frequency parameter `p`; briefly if there are many."""
    doubtful = []
    for motion in motions:
        ground = motion.of_ground
        if warnings := doubts(ground, measure(ground)) + coarse_for(motion, p, whom):
            doubtful.append((motion, warnings))
    if len(doubtful) <= MAX_DETAILED_MOTIONS:
        for motion, warnings in doubtful:
            for doubt in warnings:
                watch.warn(f"{motion.name}: {doubt.text}")
        return
    kinds = Counter(doubt.kind for _, warnings in doubtful for doubt in warnings)
    counts = ", ".join(f"{kind} ({count})" for kind, count in kinds.most_common())
    names = shorten(", ".join(motion.name for motion, _ in doubtful), 200, placeholder=" ...")
    watch.warn(f"{len(doubtful)} records are doubtful: {counts}; run `rocking record` to see why: {names}")
