"""A fragility study with everything that its file names: structures, their samples, and its ground motions."""

from __future__ import annotations

import hashlib
import json
from collections import Counter, OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from rocking_cli.ask.ground_motions import pulse_in, type_in_words
from rocking_cli.core import Mechanism
from rocking_cli.core.structure_file import load_structure
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD, SAMPLING, Pulse, parse_pulse
from rocking_cli.excitation.records.opening import matching_files
from rocking_cli.io.field_problems import by_meaning, say
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import Document, Place, parse, read_text
from rocking_cli.processing.oscillator import Floor
from rocking_cli.processing.reading import Reading, is_list
from rocking_cli.processing.record_list import Entry, as_written, read_list
from rocking_cli.processing.steps import process
from rocking_cli.questions.fragility.definition import (
    HINT,
    RESTITUTION,
    SLIDING,
    Common,
    Definition,
    HazardEntry,
    RecordEntry,
    Sampling,
    StructureEntry,
    checks_sliding,
    definition_of,
    draw,
    usable_entries,
    usable_part,
    varied,
)
from rocking_cli.questions.fragility.hazard_curve import HazardCurve, read_hazard
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.studies.engines.scene import engine_version
from rocking_cli.text import did_you_mean, numbered, one_line

OF_MOTIONS = frozenset({"processing", "factor", "floor", "weight", "level", "event", "station"})
"""Items of a record's entry that do not describe a file."""


@dataclass(frozen=True)
class Sample:
    """One sample of a structure, as it is simulated.

    Parameters
    ----------
    structure : int
        Index of the structure in the study.
    number : int
        Number of the sample, from 0.
    drawn : dict of str to float
        The sampled fields, by name.
    mechanism : Mechanism
        The structure with these values.
    """

    structure: int
    number: int
    drawn: dict[str, float]
    mechanism: Mechanism

    @property
    def geometry(self) -> tuple[tuple[str, float], ...]:
        """The sampled fields except restitution, which needs no new tables of coefficients."""
        return tuple(each for each in self.drawn.items() if each[0] != RESTITUTION)

    @property
    def eta(self) -> float:
        """The sampled coefficient of restitution; NaN if it is not sampled."""
        return self.drawn.get(RESTITUTION, nan)


@short_repr
@dataclass(frozen=True, eq=False)
class Study:
    """A study ready to run.

    Parameters
    ----------
    name : str
        Name of the study.
    definition : Definition
        The definition in its file.
    structures : tuple of Mechanism
        The structures, named.
    samples : tuple of Sample
        The samples to simulate, structure by structure: one of each, or as many as are drawn.
    sources : tuple of Source
        The ground motions.
    hazard : HazardCurve, optional
        Annual rates at which intensities are exceeded.
    """

    name: str
    definition: Definition
    structures: tuple[Mechanism, ...]
    samples: tuple[Sample, ...]
    sources: tuple[Source, ...]
    hazard: HazardCurve | None

    @property
    def weights(self) -> list[float]:
        """The weight of each record."""
        return [source.entry.weight for source in self.sources]

    def description(self) -> dict[str, Any]:
        """Return everything that decides the runs, except the content of the records, as plain data."""
        asked = self.definition
        return {
            "structures": {
                structure.name: {
                    "mechanism": structure.mechanism,
                    **structure.model_dump(exclude_none=True, exclude={"name"}),
                    "vary": entry.model_dump(exclude_none=True)["vary"],
                }
                for structure, entry in zip(self.structures, asked.structures, strict=True)
            },
            "order of structures": [structure.name for structure in self.structures],
            "records": [_described(source) for source in self.sources],
            **({"processing": asked.processing} if asked.processing else {}),
            **({} if asked.floor is None else {"floor": str(Floor.parse(asked.floor))}),
            "levels": {
                "measure": asked.levels.measure,
                "values": asked.levels.levels(),
                **({} if asked.levels.scaled else {"scaled": False}),
            },
            **{name: getattr(asked, name) for name in ("polarity", "restitution", "model")},
            **({"engine": asked.engine} if asked.engine != "exact" else {}),
            **{name: getattr(asked, name) for name in ("opening", "samples", "sampling", "seed")},
            **({SLIDING: "checked in every run"} if SLIDING in asked.limit_states else {}),
        }


def _described(source: Source) -> dict[str, Any]:
    """Return what decides the runs under a record: its entry without the weight, and for a set also its file."""
    entry = {key: value for key, value in as_written(source.entry).items() if key != "weight"}
    return {"name": source.name, **entry, **({"file": source.file} if source.entry.level is not None else {})}


def digest(description: dict[str, Any]) -> str:
    """Return the SHA-256 of a description; the order of its keys does not matter."""
    return hashlib.sha256(json_text(description, sort_keys=True).encode()).hexdigest()


def load_study(given: str | Path | Mapping[str, Any], name: str = "study") -> Study:
    """Read a study and the structures it names; of the records, only the names are read.

    Parameters
    ----------
    given : str, Path or mapping
        The study file, or its fields, in which structures may be mechanisms and records ground motions or pulses; the
        files that it names are relative to its folder, or to the present one.
    name : str
        Name of a study given by its fields, if these have none; one in a file is named after it.

    Raises
    ------
    InputError
        With every problem of the study and of the structure files.
    MechanismError
        If a mechanism's plugin cannot be used.
    """
    structures: dict[str, Mechanism] = {}
    motions: dict[str, GroundMotion] = {}
    if isinstance(given, Mapping):
        folder, document = Path(), Document("study", "study", [], _plain(given, structures, motions))
    else:
        path = Path(given)
        folder, name = path.parent, path.stem
        document = parse(read_text(path, "study"), str(path), "study", HINT)
    return _Files(document, folder, structures, motions).study(name)


def _plain(given: Mapping[str, Any], structures: dict[str, Mechanism], motions: dict[str, GroundMotion]) -> Any:
    """Return a study made in Python as plain data, with names that stand for its mechanisms and motions."""

    def plain(each: Any) -> Any:
        if isinstance(each, Mechanism):
            return stand_in(structures, "structure", each)
        if isinstance(each, GroundMotion):
            return stand_in(motions, "motion", each)
        if isinstance(each, Pulse):
            return each.specification
        if isinstance(each, Mapping):
            return {key: plain(value) for key, value in each.items()}
        if isinstance(each, list | tuple):
            return [plain(value) for value in each]
        if isinstance(each, Path):
            return str(each)
        if each is None or isinstance(each, str | int | float) or hasattr(each, "tolist"):
            return each
        raise InputError(Problem(f"cannot hold {type_in_words(each)}", "study", hint=HINT))

    def stand_in(made: dict[str, Any], kind: str, each: Any) -> str:
        name = next((name for name, known in made.items() if known is each), f"<{kind} {len(made) + 1}>")
        made[name] = each
        return name

    def named(each: Any) -> Any:
        entry = {"file": each} if isinstance(each, Mechanism) else each
        of = entry.get("file") if isinstance(entry, Mapping) else None
        return {"name": of.name or of.mechanism, **entry} if isinstance(of, Mechanism) else entry

    def shaking(each: Any) -> Any:
        is_pulse = isinstance(each, Pulse) or (isinstance(each, str) and pulse_in(each) is not None)
        return {"pulse": each} if is_pulse else each

    for field, entry in (("structures", named), ("records", shaking)):
        if isinstance(entries := given.get(field), list | tuple):
            given = {**given, field: [entry(each) for each in entries]}
    data = json.loads(json_text(plain(given)))
    names: list[str] = []
    for key, motion in motions.items():
        name = one_line(motion.name)
        names.append(name if name not in names else numbered(name, "", names))
        motions[key] = replace(motion, name=names[-1])
    return data


@dataclass(frozen=True)
class _Files:
    """What the document of a study names; what is wrong with it is added to the problems of the document.

    Parameters
    ----------
    document : Document
        The document.
    folder : Path
        The folder to which file names are relative.
    made_structures, made_motions : dict
        Mechanisms and motions of a study made in Python, by the names that stand for their files.
    """

    document: Document
    folder: Path
    made_structures: dict[str, Mechanism]
    made_motions: dict[str, GroundMotion]

    def study(self, name: str) -> Study:
        """Return the study. Raises `InputError` with every problem of its document and files."""
        document = self.document
        definition = definition_of(document, self.load)
        entries = [*usable_entries(document, "structures", StructureEntry)]
        structures = [self.structure(k, entry) for k, entry in entries]
        common = (usable_part(Common, document.data) or Common()).reading
        records = usable_entries(document, "records", RecordEntry)
        sources = _named_apart([source for k, entry in records for source in self.sources(k, entry, common)])
        files = [source for source in sources if source.motion is None]
        places = [source.path.resolve().as_posix() if source.path else source.file for source in files]
        self.refuse_repeated("records", map(_in_words, places, (source.entry for source in files)))
        in_memory = {source.name for source in sources if source.motion is not None}  # as a file may be called, too
        self.refuse_repeated("records", (source.name for source in sources if source.name in in_memory))
        self.refuse_repeated("structures", (each.name or "" for each in structures if each is not None))
        known = [(k, entry, each) for (k, entry), each in zip(entries, structures, strict=True) if each is not None]
        if checks_sliding(document.data):
            for _, entry, structure in known:
                if structure.friction is None and "friction" not in entry.vary:
                    what = "is missing: the limit state sliding is whether joints need more friction than there is"
                    hint = "give that of its joints, such as `friction: 0.6`"
                    file = str(self.folder / entry.file)
                    document.problems.append(Problem(what, file, field="friction", hint=hint))
        if document.data.get("engine") in ("blocks", "auto"):
            self.refuse_without_free_blocks([(entry.file, structure) for _, entry, structure in known])
        hazard = self.hazard()
        sampling = usable_part(Sampling, document.data)
        samples = [each for one in known for each in self.samples(*one, sampling)] if sampling is not None else []
        document.check()
        assert definition is not None
        mechanisms = tuple(structure for *_, structure in known)
        return Study(definition.name or one_line(name), definition, mechanisms, tuple(samples), tuple(sources), hazard)

    def wrong(self, place: Place, what: str, hint: str | None = None, *, key: bool = False) -> None:
        """Add a problem with the value at a place, or with its key."""
        self.document.problems.append(self.document.at(place, what, hint, key=key))

    def wrong_file(self, place: Place, name: str, error: InputError) -> None:
        """Add the problems of a file that the study names; those without a line get the line in the study."""
        for each in error.problems:
            if each.line is not None or each.file != str(self.folder / name):
                self.document.problems.append(each)
            else:
                self.wrong(place, f"{name}: {each.field + ' ' if each.field else ''}{each.message}", each.hint)

    def within(self, *place: str | int) -> Place:
        """Return the place of a key of an entry; the place of the entry itself if this is plain text."""
        return place if place in self.document.values else place[:-1]

    def refuse_repeated(self, field: str, names: Iterable[str]) -> None:
        """Add a problem for each name that is there twice."""
        for name, count in Counter(names).items():
            if count > 1:
                hint = "give one of them a `name`" if field == "structures" else None
                self.wrong((field,), f"two of them are called {name}", hint, key=True)

    def load(self, file: str) -> Mechanism:
        """Return the structure of a file that the study names."""
        return self.made_structures[file] if file in self.made_structures else load_structure(self.folder / file)

    def structure(self, k: int, entry: StructureEntry) -> Mechanism | None:
        """Return a structure by its name in the study; None if its file is wrong."""
        try:
            structure = self.load(entry.file)
        except InputError as error:
            self.wrong_file(self.within("structures", k, "file"), entry.file, error)
            return None
        except MechanismError as error:
            raise of_structure(error, entry.file) from error
        infos = type(structure).model_fields.items()
        fields = {name: info for name, info in infos if info.annotation in (float, float | None)}
        known = [*fields, RESTITUTION]
        for at, name in varied(self.document.data):  # as written, with invalid distributions too
            if at == k and name not in known:
                what = f"is not a number among the fields of {structure.mechanism}"
                hint = by_meaning(name, fields) or did_you_mean(name, known)
                self.wrong(("structures", k, "vary", name), what, hint, key=True)
        return structure.model_copy(update={"name": entry.name}) if entry.name is not None else structure

    def refuse_without_free_blocks(self, structures: Iterable[tuple[str, Mechanism]]) -> None:
        """Add why free blocks cannot be simulated at all, or what of a structure they cannot have."""
        try:
            engine_version()
        except InputError as error:
            for each in error.problems:
                self.wrong(("engine",), each.message, each.hint)
        for file, structure in structures:
            try:
                free_blocks(structure)
            except InputError as error:
                self.document.problems += [replace(each, file=str(self.folder / file)) for each in error.problems]

    def samples(self, k: int, entry: StructureEntry, structure: Mechanism, sampling: Sampling) -> list[Sample]:
        """Return the samples of a structure; samples that cannot be built are reported as problems of its `vary`."""
        if not entry.vary or any(name not in type(structure).model_fields for name in entry.vary):
            return [Sample(k, 0, {}, structure)]
        seed, method = sampling.seed, sampling.sampling
        columns = [
            draw(each, sampling.samples, seed=seed, stream=f"{structure.name}.{name}", method=method).tolist()
            for name, each in entry.vary.items()
        ]
        samples, wrong = [], []
        for number, values in enumerate(zip(*columns, strict=True)):
            drawn = dict(zip(entry.vary, values, strict=True))
            try:
                samples.append(Sample(k, number, drawn, structure.model_copy(update=drawn)))
            except ValidationError as error:
                first = error.errors(include_url=False)[0]
                message, _ = say(type(structure), first["loc"], first, structure.mechanism, "")
                wrong.append(f"{first['loc'][0]} {message}" if first["loc"] else message)
        if wrong:
            what = f"{len(wrong)} of {sampling.samples} samples cannot be built; the first: {wrong[0]}"
            self.wrong(("structures", k, "vary"), what, "bound the distributions with `low` and `high`")
        return samples

    def hazard(self) -> HazardCurve | None:
        """Return the hazard of the study; None if there is none, or if it is wrong."""
        hazard = usable_part(HazardEntry, self.document.data.get("hazard"))
        if hazard is None:
            return None
        if hazard.points is not None:
            return HazardCurve(*np.array(hazard.points).T)
        assert hazard.file is not None
        try:
            return read_hazard(self.folder / hazard.file, hazard.measure)
        except InputError as error:
            self.wrong_file(("hazard", "file"), hazard.file, error)
            return None

    def sources(self, k: int, entry: RecordEntry, common: Reading) -> list[Source]:
        """Return the ground motions of an entry, of which none has a name yet."""
        place = ("records", k)
        if entry.pulse is not None:
            try:
                parse_pulse(entry.pulse)
            except (InputError, MechanismError) as error:
                self.wrong(self.within(*place, "pulse"), str(error))
                return []
            return [Source("", entry, entry.reading(self.folder, common), entry.pulse)]
        assert entry.file is not None
        if (motion := self.made_motions.get(entry.file)) is not None:
            if as_written(entry).keys() - OF_MOTIONS:
                what = "units, dt, channel, vertical and the like describe a file, and this is a ground motion"
                self.wrong(place, what)
                return []
            return [Source("", entry, entry.reading(self.folder, common), motion.name, motion=motion)]
        files = self.select(self.within(*place, "file"), entry.file)
        others = self.select((*place, "with"), entry.other)
        verticals = self.select((*place, "vertical"), entry.vertical)
        if entry.vertical is not None and max(len(files), len(verticals)) > 1:
            what = "a vertical component belongs to a single record: give each record its own entry"
            self.wrong((*place, "vertical"), what)
            return []
        if others and max(len(files), len(others)) > 1:
            what = "a second component belongs to one record: give each record an entry of its own"
            self.wrong((*place, "with"), what)
            return []
        if others:  # a pattern is replaced by the only file that it matches
            entry = entry.model_copy(update={"other": self.shown(others[0])})
        reading, vertical = entry.reading(self.folder, common), next(iter(verticals), None)
        sources = []
        for file in files:
            if not is_list(file):
                sources.append(Source("", entry, reading, self.shown(file), file, vertical))
            elif vertical is not None:
                what = "a vertical component belongs to one record, and this is a list of them"
                self.wrong((*place, "vertical"), f"{what}: give each an entry of its own")
            else:
                sources += self.listed(k, entry, file, reading)
        return sources

    def listed(self, k: int, entry: RecordEntry, file: Path, reading: Reading) -> list[Source]:
        """Return the records of a list of records, whose options take precedence over those of the study's entry."""
        try:
            items = read_list(file)
        except InputError as error:
            self.wrong_file(self.within("records", k, "file"), str(entry.file), error)
            return []
        return [
            Source("", _together(entry, item.entry), item.reading(reading), self.shown(item.path), item.path)
            for item in items
            if item.entry is not None
        ]

    def select(self, place: Place, pattern: str | None) -> list[Path]:
        """Return the files that match a pattern."""
        try:
            return [] if pattern is None else matching_files(pattern, self.folder)
        except InputError as error:
            for each in error.problems:
                self.wrong(place, f"{each.file}: {each.message}", each.hint)
            return []

    def shown(self, path: Path) -> str:
        """Return the name of a file relative to the study's folder, the same on every system."""
        return one_line((path.relative_to(self.folder) if path.is_relative_to(self.folder) else path).as_posix())


def _together(entry: RecordEntry, listed: Entry) -> RecordEntry:
    """Merge the entry of a study that names a list of records with the entry of one record in that list.

    Values of the list entry take precedence. Processing steps of both apply: first those of the list, then those of the
    study. Factors of both apply too; the factor of the list comes before any step of the study.
    """
    fields = {**as_written(entry), **as_written(listed), "file": str(entry.file)}
    steps = [*(listed.processing or []), *(entry.processing or [])]
    if listed.factor is not None and (entry.processing or entry.factor is not None):
        steps.insert(len(listed.processing or []), {"factor": listed.factor})
        fields["factor"] = entry.factor
    return RecordEntry.model_validate({**fields, "processing": steps or None})


def _in_words(name: str, entry: RecordEntry, *, fully: bool = True) -> str:
    """Return the name of a record with the level whose set it is in, and fully with its channel and azimuth."""
    if fully and entry.channel is not None:
        name += f" channel {entry.channel}"
    if fully and entry.azimuth is not None and entry.other is not None:
        name += f" azimuth {entry.azimuth}".removesuffix(".0")
    return name if entry.level is None else f"{name} at {entry.level:g}"


def _named_apart(sources: Sequence[Source]) -> list[Source]:
    """Return the records with names: channel and azimuth are in those that several records would share."""
    names = [_in_words(source.file, source.entry, fully=False) for source in sources]
    count = Counter(names)
    return [
        replace(each, name=_in_words(each.file, each.entry) if count[name] > 1 else name)
        for each, name in zip(sources, names, strict=True)
    ]


MAX_SAMPLES_IN_MEMORY = 32_000_000  # samples of all records: a quarter of a gigabyte


@dataclass(frozen=True)
class Source:
    """One ground motion of a study.

    Parameters
    ----------
    name : str
        Name of the motion: the file as the study names it, or the pulse's specification; with the set if it is in one.
    entry : RecordEntry
        The entry of the study file.
    reading : Reading
        How to read and process the record.
    file : str
        The name without the set.
    path, vertical : Path, optional
        The files of the record and of its vertical component.
    motion : GroundMotion, optional
        The motion itself, if it was given in Python.
    """

    name: str
    entry: RecordEntry
    reading: Reading
    file: str
    path: Path | None = None
    vertical: Path | None = None
    motion: GroundMotion | None = None

    @property
    def is_simple(self) -> bool:
        """Whether it is a horizontal motion of the ground, without a vertical component and not on a floor."""
        made = self.motion is not None and (self.motion.vertical is not None or self.motion.ground is not None)
        return self.vertical is None and self.reading.floor is None and not made

    def checksum(self) -> str:
        """Return the SHA-256 of its files, or of its samples, or of the pulse and its sampling.

        Raises `InputError` without a file.
        """
        digest = hashlib.sha256()
        for path in (Path(each) for each in (self.path, self.vertical, self.reading.other) if each is not None):
            try:
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            except OSError as error:
                raise InputError(Problem(f"cannot be read: {error.strerror or error}", str(path))) from None
        if self.motion is not None:
            for each in _parts(self.motion):
                digest.update(f"{each.dt!r} {each.npts} ".encode())
                digest.update(each.acceleration.astype("<f8").tobytes())
        elif self.entry.pulse is not None:
            pulse = parse_pulse(self.entry.pulse).specification
            digest.update(f"{pulse}, {COARSE_POINTS_PER_PERIOD} a period: {SAMPLING}".encode())
        return digest.hexdigest()

    def read(self) -> GroundMotion:
        """Read the motion, unscaled. Raises `InputError` if it cannot be read."""
        if self.motion is not None:
            return self.reading.on_floor(process(self.motion, self.reading.steps))
        if self.entry.pulse is not None:
            return self.reading.on_floor(parse_pulse(self.entry.pulse).sampled(COARSE_POINTS_PER_PERIOD))
        assert self.path is not None
        motion = self.reading.read(self.path)
        if self.vertical is not None:
            motion = replace(motion, vertical=self.reading.vertical(self.vertical))
        return motion


def _parts(motion: GroundMotion) -> list[GroundMotion]:
    """Return a motion with its vertical component and the motion of the ground below, as far as it has them."""
    below = [each for each in (motion.vertical, motion.ground) if each is not None]
    return [motion, *(part for each in below for part in _parts(each))]


@short_repr
@dataclass(frozen=True)
class Record:
    """A ground motion of a study as its store keeps it: checksum, peaks and sampling.

    Parameters
    ----------
    name, checksum : str
        See `Source`; the checksum of a file that cannot be read is empty.
    reason : str or None
        Why the motion cannot be used; None if it can.
    dt : float
        Sampling interval [s]; this and all further fields are 0 if the motion cannot be used.
    npts : int
        Number of samples.
    pga, pgv : float
        Peak acceleration [standard gravity] and peak velocity [m/s].
    doubts : int
        Number of doubts about the motion; `rocking record` lists them.
    """

    name: str
    checksum: str
    reason: str | None = None
    dt: float = 0.0
    npts: int = 0
    pga: float = 0.0
    pgv: float = 0.0
    doubts: int = 0


class KeptMotions:
    """The ground motions of a study, of which the ones used last are kept in memory.

    Parameters
    ----------
    sources : iterable of Source
        The motions.
    """

    def __init__(self, sources: Iterable[Source]) -> None:
        self._sources = list(sources)
        self._checksums: dict[int, str] = {}
        self._kept: OrderedDict[int, GroundMotion] = OrderedDict()
        self._size = 0

    def examine(self, k: int, known: Record | None) -> Record:
        """Return the record of a motion; if it is known and usable, only its checksum is computed again."""
        source = self._sources[k]
        record = replace(known, checksum="") if known is not None and known.reason is None else Record(source.name, "")
        is_measured = record.npts > 0
        try:
            record = replace(record, checksum=source.checksum())
            if not is_measured:
                motion = source.read()
                measured = measure(motion.of_ground)
                if measured.pga_g == 0:
                    raise InputError(f"{source.name}: zero throughout: there is nothing to scale")
                # Only records are checked: a pulse is exactly what its formula gives.
                doubtful = len(doubts(motion.of_ground, measured)) if source.entry.pulse is None else 0
                numbers = (motion.dt, motion.npts, measured.pga_g, measured.pgv, doubtful)
                record = Record(source.name, record.checksum, None, *numbers)
                self._keep(k, motion)
        except InputError as error:
            if not is_measured:
                record = replace(record, reason=str(error).splitlines()[0])
        self._checksums[k] = record.checksum
        return record

    def __getitem__(self, k: int) -> GroundMotion:
        """Return a motion by its index. Raises `InputError` if its file has changed."""
        if k in self._kept:
            self._kept.move_to_end(k)
            return self._kept[k]
        source = self._sources[k]
        if source.checksum() != self._checksums[k]:
            raise InputError(Problem("has changed while the study ran", source.name, hint="start the study again"))
        return self._keep(k, source.read())

    def _keep(self, k: int, motion: GroundMotion) -> GroundMotion:
        self._kept[k] = motion
        self._size += motion.npts
        while self._size > MAX_SAMPLES_IN_MEMORY and len(self._kept) > 1:
            _, dropped = self._kept.popitem(last=False)
            self._size -= dropped.npts
        return motion
