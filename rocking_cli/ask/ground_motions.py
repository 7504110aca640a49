"""Ground motions as they are given to a verb, with how to read, correct and scale them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from textwrap import shorten
from typing import Any, TypedDict, get_type_hints

from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem, renamed
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.excitation.records import read_record
from rocking_cli.excitation.records.opening import STANDARD_INPUT, allow_again
from rocking_cli.excitation.records.sensor import Gain, Quantity, size_of
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.excitation.selection import select
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.listed import Listed, is_list
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.steps import STEPS, Resample, Step, parse_step, process
from rocking_cli.text import did_you_mean
from rocking_cli.views.processing import in_words
from rocking_cli.views.view import FEW

Motion = GroundMotion | Pulse | Scaled | str | Path
"""Ground motion or pulse, file of a record, or pulse as text such as `sine:0.6g:0.8s`."""
MOST_PGA, MOST_PGV = 1e3, 1e4  # g and m/s: beyond any ground motion, and too long to simulate
SCALING = ("scale", "target_pga", "target_pgv")
OF_FILES = ("dt", "units", "channel", "quantity", "gain", "other")
"""Arguments that describe the file of a record."""


class ReadingArguments(TypedDict, total=False):
    """Keyword arguments of verbs that read records.

    Parameters
    ----------
    units, dt, channel : str, float, str, optional
        Unit, sampling interval [s] and channel of the record, if its file does not state them.
    quantity : {"acceleration", "velocity", "displacement"}, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain or str, optional
        Sensitivity of the instrument: the value of one unit of the record, such as "0.05m/V".
    other, other_channel, azimuth : path, str, float, optional
        File and channel of the horizontal component at right angles, and the angle of the structure's plane from the
        record towards it [deg].
    baseline, highpass, lowpass, taper, trim, resample : str or float, optional
        Corrections, made in the order in which they are given: as for `correct`.
    floor : Floor, str or mapping, optional
        Floor of a building on which the structure stands, as for `on_floor`.
    """

    units: str | None
    dt: float | None
    channel: str | None
    quantity: Quantity | None
    gain: Gain | str | None
    other: str | Path | None
    other_channel: str | None
    azimuth: float | None
    baseline: str | None
    highpass: str | float | None
    lowpass: str | float | None
    taper: str | float | None
    trim: str | None
    resample: str | float | None
    floor: Floor | str | Mapping[str, Any] | None


class MotionArguments(ReadingArguments, total=False):
    """Keyword arguments of verbs that read and scale ground motions: those of `ReadingArguments`, and one scale.

    Parameters
    ----------
    scale : float, optional
        Scale factor on the motions; a negative one reverses them.
    target_pga, target_pgv : float, optional
        Peak ground acceleration [standard gravity] or velocity [m/s] to scale the motions to.
    """

    scale: float | None
    target_pga: float | None
    target_pgv: float | None


def check_known(options: Mapping[str, Any], accepted: type = ReadingArguments) -> None:
    """Refuse keyword arguments of a verb that are not among those it accepts. Raises `InputError`."""
    known = list(get_type_hints(accepted))
    for name in options:
        if name not in known:
            hint = "the motions of this question are not scaled" if name in SCALING else did_you_mean(name, known)
            raise InputError(Problem("is not an argument", field=f"`{name}`", hint=hint))


def reading_of(options: MotionArguments | ReadingArguments) -> Reading:
    """Return how to read a record, from the keyword arguments of a verb.

    Raises
    ------
    InputError
        If a correction, a gain or a floor is not valid, or if two arguments do not go together.
    """
    plain: dict[str, Any] = {
        name: value for name, value in options.items() if value is not None and name not in SCALING
    }
    steps = [
        plain.pop(name) if isinstance(value, Step) else parse_step(name, plain.pop(name))
        for name, value in list(plain.items())
        if name in STEPS
    ]
    if isinstance(gain := plain.get("gain"), str):
        plain["gain"] = Gain.parse(gain)
    if (floor := plain.get("floor")) is not None and not isinstance(floor, Floor):
        plain["floor"] = Floor.parse(floor)
    if "other" in plain and "azimuth" not in plain:
        hint = "0 is the direction of the record, 90 that of the second component"
        raise InputError(Problem("is missing for two components", field="`azimuth`", hint=hint))
    return Reading(**plain, steps=tuple(steps))


@dataclass(frozen=True, eq=False)
class Motions:
    """Ground motions as they are given, and how to read and scale them.

    Parameters
    ----------
    given : tuple of GroundMotion, Pulse, str or Path
        Motions, pulses, pulses as text, files of records, patterns such as "records/*.AT2", and lists of records.
    reading : Reading
        How the files are read and corrected, and the floor.
    usual : Reading, optional
        How files are read that do not state their unit, interval or channel themselves; by default as `reading`.
    scale, target_pga, target_pgv : float, optional
        Scale factor, or what to scale to: as for `MotionArguments`.
    """

    given: tuple[Motion, ...]
    reading: Reading = field(default_factory=Reading)
    usual: Reading | None = None
    scale: float | None = None
    target_pga: float | None = None
    target_pgv: float | None = None

    def __post_init__(self) -> None:
        if sum(value is not None for value in (self.scale, self.target_pga, self.target_pgv)) > 1:
            raise InputError("`scale`, `target_pga` and `target_pgv` cannot be combined: give one of them")

    @classmethod
    def of(
        cls,
        given: Motions | Motion | Sequence[Motion],
        options: MotionArguments | ReadingArguments,
        accepted: type = MotionArguments,
    ) -> Motions:
        """Return the motions of a verb, from what it is given and its keyword arguments. Raises `InputError`."""
        check_known(options, accepted)
        if isinstance(given, Motions):
            return given
        given = each_of(given)
        for name, value in options.items():
            if value is not None and not given:
                raise InputError(Problem("has no effect, as no ground motion is given", field=f"`{name}`"))
        scaling: dict[str, Any] = {name: options.get(name) for name in SCALING}
        return cls(tuple(given), reading_of(options), **scaling)

    def __bool__(self) -> bool:
        """Return whether any motion is given."""
        return bool(self.given)

    @cached_property
    def _found(self) -> tuple[list[GroundMotion | Scaled | Pulse | Listed], list[InputError]]:
        """Motions, pulses and files, those of patterns and lists one by one, and the errors of places with no file."""
        sources: dict[object, GroundMotion | Scaled | Pulse | Listed] = {}
        errors: list[InputError] = []
        for one in self.given:
            if isinstance(one, GroundMotion | Scaled):
                sources[id(one)] = one
            elif (pulse := pulse_in(one)) is not None:
                sources[pulse] = pulse
            else:
                try:
                    for listed in files_of(str(one)):
                        sources.setdefault((listed.path, listed.folder, repr(listed.entry)), listed)
                except InputError as error:
                    errors.append(error)
        return list(sources.values()), errors

    @property
    def count(self) -> int:
        """Number of motions, those that cannot be found among them."""
        return len(self._found[0]) + len(self._found[1])

    @property
    def records(self) -> list[Listed]:
        """Files of records, in the order in which they are given."""
        return [each for each in self._found[0] if isinstance(each, Listed)]

    @property
    def has_records(self) -> bool:
        """Whether anything but pulses is given."""
        return bool(self._found[1]) or not all(
            isinstance(each, Pulse) or (isinstance(each, Scaled) and each.pulse is not None) for each in self._found[0]
        )

    @property
    def are_read(self) -> bool:
        """Whether all motions were read and scaled before."""
        return bool(self.given) and all(isinstance(each, Scaled) for each in self.given)

    def one(self, p: float, watch: Watcher = SILENT, *, with_vertical: bool = False) -> Scaled:
        """Return the single motion, as `gather`. Raises `InputError` if there are several."""
        if self.count > 1:
            raise InputError(f"{self.count} motions are given where one is expected: ask for one after the other")
        return self.gather(p, watch, with_vertical=with_vertical)[0]

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
        self._check(with_vertical=with_vertical)
        if self.are_read:
            return [each for each in self.given if isinstance(each, Scaled)]
        sources, errors = self._found[0], [*self._found[1]]
        several = self.count > 1
        chosen: list[Scaled] = []
        for place, source in enumerate(sources):
            try:
                one = self._scaled(source, place)
            except InputError as error:
                errors.append(error)
                continue
            name, taken = one.motion.name, {other.motion.name for other in chosen}
            if name in taken and isinstance(source, Listed):
                name = f"{name} ({source.path.parent})"
            if name in taken:
                name = f"{name} ({place + 1})"
            one = one._replace(motion=replace(one.motion, name=name))
            chosen.append(one)
        for refused in errors:
            if not several:
                raise refused
            watch.leave_out(refused)
        if not chosen:
            raise InputError("no ground motion can be used")
        _introduce(chosen, watch)
        warn_about([one.motion for one in chosen if one.pulse is None], watch, p, whom)
        return chosen

    def read(self, record: Listed) -> GroundMotion:
        """Read a record. Raises `InputError` if that is not possible."""
        given, typed = self._readings(record)
        if typed != given:
            with suppress(InputError):
                return record.as_said(typed.read(record.path))
            allow_again(record.path)
        return record.as_said(given.read(record.path))

    def reading_for(self, motion: Scaled) -> Reading:
        """Return how the record of one of these motions is read, also for its other components."""
        usual, source = self.usual or self.reading, self._found[0][motion.place]
        return source.reading(usual) if isinstance(source, Listed) else usual

    def unusable(self, chosen: Sequence[Scaled]) -> list[str]:
        """Return the files of records that are not among the chosen motions."""
        places = {each.place for each in chosen}
        return [str(each.path) for k, each in enumerate(self._found[0]) if isinstance(each, Listed) and k not in places]

    def vertical(
        self, motion: Scaled, file: str | Path, dt: float | None, channel: str | None, watch: Watcher = SILENT
    ) -> GroundMotion:
        """Read the vertical component of a motion: interval and channel of its own, all else as for the horizontal one.

        Raises
        ------
        InputError
            If the file cannot be read; the message names `vertical_dt` and `vertical_channel`.
        """
        reading = self.reading_for(motion)
        arguments = {"channel": "vertical_channel"}
        if dt is not None or reading.dt is None:
            arguments["dt"] = "vertical_dt"
        try:
            component = reading.vertical(file, dt, channel)
        except InputError as error:
            problems: list[Problem] = []
            for problem in renamed(error, arguments).problems:
                if problem.hint and "`dt`" in problem.hint:  # it was meant for the other component
                    problem = replace(problem, hint="give the interval of the vertical component with `vertical_dt`")
                problems.append(problem)
            raise InputError(*problems) from None
        introduce("vertical", Scaled(component, 1.0), watch)
        warn_about([component], watch)
        return component

    def settled(self, motion: Scaled) -> Reading | None:
        """Return how the file of one of these motions was read: as it states itself, or else as `usual`.

        None for what is not a file, and for standard input, which cannot be read again.
        """
        record = self._found[0][motion.place]
        if not isinstance(record, Listed) or str(record.path) == STANDARD_INPUT:
            return None
        given, typed = self._readings(record)
        if typed != given:
            with suppress(InputError):
                typed.read(record.path)
                return typed
        return given

    def unprocessed(self, motion: Scaled) -> GroundMotion | None:
        """Return the record of one of these motions before its corrections; None if it has none."""
        record = self._found[0][motion.place]
        if not isinstance(record, Listed) or not (reading := record.reading(self.usual or self.reading)).steps:
            return None
        allow_again(record.path)
        grid = tuple(step for step in reading.steps if isinstance(step, Resample))  # uneven times cannot do without
        bare = replace(reading, steps=grid, floor=None)
        typed = replace(self.reading, steps=grid, floor=None) if self.usual is not None else bare
        return Motions((), typed, bare if self.usual is not None else None).read(Listed(record.path))

    def apart(self) -> list[Motions]:
        """Return these motions one by one, those that cannot be found among them."""
        alone = [([source], list[InputError]()) for source in self._found[0]]
        alone += [(list[GroundMotion | Scaled | Pulse | Listed](), [error]) for error in self._found[1]]
        single = []
        for found in alone:
            one = replace(self)
            one.__dict__["_found"] = found
            single.append(one)
        return single

    def without(self, path: Path) -> Motions:
        """Return these motions without those of one file."""
        found = [
            each
            for each in self._found[0]
            if not (isinstance(each, Listed) and each.path.exists() and each.path.samefile(path))
        ]
        kept = replace(self, given=self.given if found else ())
        kept.__dict__["_found"] = found, self._found[1]
        return kept

    def _readings(self, record: Listed) -> tuple[Reading, Reading]:
        """Return how to read a record that does not state its unit, interval or channel, and one that does."""
        typed = record.reading(self.reading)
        if self.usual is None:
            return typed, typed
        usual, given = self.usual, record.reading(self.usual)
        if usual.units != self.reading.units and usual.units is not None:
            of = given.quantity or "acceleration"
            if given.gain is not None or (given.units == usual.units and size_of(usual.units, of) is None):
                given = record.reading(replace(usual, units=None))  # it says nothing of such a record
        return given, typed

    def _scaled(self, source: GroundMotion | Scaled | Pulse | Listed, place: int) -> Scaled:
        if isinstance(source, Scaled):
            return source
        if isinstance(source, Listed):
            one = Scaled(self.read(source), 1.0, file=source.path, place=place)
        elif isinstance(source, Pulse):
            one = Scaled(self.reading.on_floor(source.sampled()), 1.0, pulse=source, place=place)
        else:
            one = Scaled(self.reading.on_floor(process(source, self.reading.steps)), 1.0, place=place)
        return one._replace(factor=self.factor(one.motion, measure(one.motion.of_ground)))

    def factor(self, motion: GroundMotion, measured: Measures) -> float:
        """Return the factor on a motion as read; the polarity is not included.

        Raises
        ------
        InputError
            If the motion is zero, or the scaled motion is beyond any ground motion.
        """
        by = 1.0 if self.scale is None else self.scale
        for wanted, own in ((self.target_pga, measured.pga), (self.target_pgv, measured.pgv)):
            if wanted is not None:
                if own == 0:
                    raise InputError(
                        Problem("the record is zero throughout and cannot be scaled to a peak", motion.name)
                    )
                by = wanted / own
        pga, pgv = abs(by) * measured.pga, abs(by) * measured.pgv
        if not (pga <= MOST_PGA and pgv <= MOST_PGV):
            scaled = f" scaled by {by:.4g}" if by != 1 else ""
            problem = f"PGA = {pga:.4g} g and PGV = {pgv:.4g} m/s{scaled} are not plausible for a ground motion"
            hint = f"at most {MOST_PGA:g} g and {MOST_PGV:g} m/s: check unit, interval and factor"
            raise InputError(Problem(problem, motion.name, hint=hint))
        return by

    def _check(self, *, with_vertical: bool) -> None:
        """Raise `InputError` if an argument describes records and none is given."""
        if self.has_records:
            return
        of_records = [f"`{name}`" for name in OF_FILES[2 * with_vertical :] if getattr(self.reading, name) is not None]
        of_records += [f"`{step.name}`" for step in self.reading.steps]
        if of_records:
            verb = "describes" if len(of_records) == 1 else "describe"
            raise InputError(f"{' and '.join(of_records)} {verb} a record, and no record is given")


def pulse_in(given: Motion) -> Pulse | None:
    """Return a pulse, made from its text if that is given; None for a record. A file of the same name has priority."""
    if isinstance(given, Pulse):
        return given
    if isinstance(given, str) and given.partition(":")[0] in PulseShapes() and not Path(given).exists():
        return parse_pulse(given)
    if not isinstance(given, str | Path):
        hint = "make one with rk.GroundMotion(name, dt, acceleration), the acceleration in m/s2"
        what = f"must be a ground motion, a pulse or a file, got {kind_of(given)}"
        raise InputError(Problem(what, field="motion", hint=hint))
    return None


def motion_of(given: Motion) -> GroundMotion:
    """Read a ground motion from its file, or sample a pulse. Raises `InputError`."""
    if isinstance(given, GroundMotion):
        return given
    if isinstance(given, Scaled):
        return given.motion.scaled(given.factor)
    pulse = pulse_in(given)
    return pulse.sampled() if pulse is not None else read_record(str(given))


def files_of(place: str) -> list[Listed]:
    """Return the records of a file, a pattern or a list of records. Raises `InputError` if there are none."""
    return [listed for path in select(place) for listed in (_listed(path) if is_list(path) else [Listed(path)])]


def _listed(path: Path) -> list[Listed]:
    from rocking_cli.processing.record_list import read_list

    return read_list(path)


def kind_of(given: object) -> str:
    """Return the type of a value, for messages: `a dict`."""
    name = type(given).__name__
    return f"{'an' if name[0].lower() in 'aeiou' else 'a'} {name}"


def each_of(given: Any) -> list[Any]:
    """Return a list or tuple as a list, and one thing as a list of one."""
    return list(given) if isinstance(given, list | tuple) and not isinstance(given, Scaled) else [given]


def signs_of(polarity: str | int) -> tuple[int, ...]:
    """Return the polarities of an argument: 1 as given, -1 reversed, or "both". Raises `InputError`."""
    if str(polarity) not in ("1", "-1", "both"):
        raise InputError(Problem(f"must be 1, -1 or 'both', got {polarity!r}", field="`polarity`"))
    return (1, -1) if polarity == "both" else (int(polarity),)


def done(motion: GroundMotion) -> str:
    """Return what was done to a motion, as the continuation of a sentence."""
    return f"; {said}" if (said := in_words(motion)) else ""


def introduce(what: str, one: Scaled, watch: Watcher) -> None:
    """Tell which motion was read, under the name `what`, and how it is scaled."""
    motion, by, pulse = one.motion, one.factor, one.pulse
    ground = motion.of_ground
    scaled = ""
    if by != 1:
        measured = measure(ground)
        scaled = f", scaled by {by:.6g}: PGA = {abs(by) * measured.pga:.4g} g, PGV = {abs(by) * measured.pgv:.4g} m/s"
    if pulse is not None:
        read = f"{pulse.title}, {pulse.amplitude / STANDARD_GRAVITY:.4g} g, period {pulse.period:.4g} s, lasts"
        watch.note(f"pulse: {read} {pulse.duration:.4g} s{scaled}{done(motion)}")
        return
    watch.note(
        f"{what}: {motion.name} ({motion.format}), {ground.npts} points, dt = {ground.dt:.6g} s, in {motion.unit}, "
        f"PGA = {ground.pga_g:.4g} g{scaled}{done(motion)}"
    )


def _introduce(chosen: Sequence[Scaled], watch: Watcher) -> None:
    if len(chosen) <= FEW:
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
        if found := doubts(ground, measure(ground)) + coarse_for(motion, p, whom):
            doubtful.append((motion, found))
    if len(doubtful) <= FEW:
        for motion, found in doubtful:
            for doubt in found:
                watch.warn(f"{motion.name}: {doubt.text}")
        return
    kinds = Counter(doubt.kind for _, found in doubtful for doubt in found)
    said = ", ".join(f"{kind} ({count})" for kind, count in kinds.most_common())
    names = shorten(", ".join(motion.name for motion, _ in doubtful), 200, placeholder=" ...")
    watch.warn(f"{len(doubtful)} records are doubtful: {said}; run `rocking record` to see why: {names}")
