"""A fragility study with everything that its file names: structures, their samples, and the records' files."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import nan
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from pydantic import ValidationError

from rocking_cli.ask.ground_motions import pulse_in, type_in_words
from rocking_cli.core import Mechanism
from rocking_cli.core.structure_file import load_structure
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse, parse_pulse
from rocking_cli.excitation.records.opening import matching_files
from rocking_cli.io.field_problems import by_meaning, say
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import Document, Place, parse, read_text
from rocking_cli.processing.entry import Entry, as_written
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.listed import is_list
from rocking_cli.processing.record_list import read_list
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
    usable_entries,
    usable_part,
)
from rocking_cli.questions.fragility.distributions import draw
from rocking_cli.questions.fragility.hazard_curve import HazardCurve, read_hazard
from rocking_cli.questions.fragility.sources import Source
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
        definition = self.definition
        return {
            "structures": {
                structure.name: {
                    "mechanism": structure.mechanism,
                    **structure.model_dump(exclude_none=True, exclude={"name"}),
                    "vary": entry.model_dump(exclude_none=True)["vary"],
                }
                for structure, entry in zip(self.structures, definition.structures, strict=True)
            },
            "order of structures": [structure.name for structure in self.structures],
            "records": [_described(source) for source in self.sources],
            **({"processing": definition.processing} if definition.processing else {}),
            **({"floor": str(Floor.parse(definition.floor))} if definition.floor is not None else {}),
            "levels": {
                "measure": definition.levels.measure,
                "values": definition.levels.levels(),
                **({} if definition.levels.scaled else {"scaled": False}),
            },
            "polarity": definition.polarity,
            "restitution": definition.restitution,
            "model": definition.model,
            **({"engine": definition.engine} if definition.engine != "exact" else {}),
            "opening": definition.opening,
            "samples": definition.samples,
            "sampling": definition.sampling,
            "seed": definition.seed,
            **({SLIDING: "checked in every run"} if SLIDING in definition.limit_states else {}),
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
    made = InMemory()
    if isinstance(given, Mapping):
        path = Path("study")
        document = Document("study", "study", [], _plain(given, made))
    else:
        path = Path(given)
        name = path.stem
        document = parse(read_text(path, "study"), str(path), "study", HINT)

    def load(file: str) -> Mechanism:
        return made.structures[file] if file in made.structures else load_structure(path.parent / file)

    definition = definition_of(document, load)
    entries = usable_entries(document, "structures", StructureEntry)
    structures = [_structure(document, ("structures", k), path.parent, entry, load) for k, entry in entries]
    common = usable_part(Common, {key: document.data[key] for key in Common.model_fields if key in document.data})
    motions = made.named_motions()
    sources = [
        source
        for k, entry in usable_entries(document, "records", RecordEntry)
        for source in (
            _made_source(document, ("records", k), entry, common or Common(), motions[entry.file])
            if entry.file in motions
            else _sources(document, ("records", k), path.parent, entry, common or Common())
        )
    ]
    sources = _apart(sources)
    read = [source for source in sources if source.motion is None]
    places = [source.path.resolve().as_posix() if source.path else source.file for source in read]
    unlike = [_in_words(place, source.entry) for place, source in zip(places, read, strict=True)]
    _refuse_repeated(document, "records", unlike)
    in_memory = {source.name for source in sources if source.motion is not None}  # as a file may be called, too
    _refuse_repeated(document, "records", [source.name for source in sources if source.name in in_memory])
    _refuse_repeated(document, "structures", [each.name or "" for each in structures if each is not None])
    if checks_sliding(document.data):
        for (_, entry), structure in zip(entries, structures, strict=True):
            if structure is not None and structure.friction is None and "friction" not in entry.vary:
                what = "is missing: the limit state sliding is whether joints need more friction than there is"
                hint = "give that of its joints, such as `friction: 0.6`"
                document.problems.append(Problem(what, str(path.parent / entry.file), field="friction", hint=hint))
    if document.data.get("engine") in ("blocks", "auto"):
        files = [path.parent / entry.file for _, entry in entries]
        document.problems += _wrong_as_free_blocks(document, files, structures)
    hazard = _hazard(document, path.parent)
    sampling = usable_part(Sampling, {key: document.data[key] for key in Sampling.model_fields if key in document.data})
    samples: list[Sample] = []
    for (k, entry), structure in zip(entries, structures, strict=True):
        if sampling is not None and structure is not None:
            samples += _samples(document, sampling, k, entry, structure)
    document.check()
    assert definition is not None
    known = tuple(each for each in structures if each is not None)
    return Study(definition.name or one_line(name), definition, known, tuple(samples), tuple(sources), hazard)


@dataclass(frozen=True)
class InMemory:
    """Mechanisms and ground motions of a study made in Python, by the names that stand for their files."""

    structures: dict[str, Mechanism] = field(default_factory=dict)
    motions: dict[str, GroundMotion] = field(default_factory=dict)

    def named_motions(self) -> dict[str, GroundMotion]:
        """Return the motions, with a number in the names of those that are called as others before them."""
        named: dict[str, GroundMotion] = {}
        for motion in self.motions.values():
            name = one_line(motion.name)
            name = name if name not in named else numbered(name, "", named)
            named[name] = replace(motion, name=name)
        return dict(zip(self.motions, named.values(), strict=True))


def _plain(given: Mapping[str, Any], made: InMemory) -> dict[str, Any]:
    """Return a study made in Python as plain data, and put aside its mechanisms and motions."""

    def plain(each: Any) -> Any:
        if isinstance(each, Mechanism):
            return _stand_in(made.structures, "structure", each)
        if isinstance(each, GroundMotion):
            return _stand_in(made.motions, "motion", each)
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

    def named(each: Any) -> Any:
        entry = {"file": each} if isinstance(each, Mechanism) else each
        of = entry.get("file") if isinstance(entry, Mapping) else None
        return {"name": of.name or of.mechanism, **entry} if isinstance(of, Mechanism) else entry

    def shaking(each: Any) -> Any:
        is_pulse = isinstance(each, Pulse) or (isinstance(each, str) and pulse_in(each) is not None)
        return {"pulse": each} if is_pulse else each

    for field_, entry in (("structures", named), ("records", shaking)):
        if isinstance(entries := given.get(field_), list | tuple):
            given = {**given, field_: [entry(each) for each in entries]}
    data: dict[str, Any] = json.loads(json_text(plain(given)))
    return data


T = TypeVar("T")


def _stand_in(made: dict[str, T], kind: str, each: T) -> str:
    """Return the name that stands for the file of an object, the same for the same object."""
    name = next((name for name, known in made.items() if known is each), f"<{kind} {len(made) + 1}>")
    made[name] = each
    return name


def _made_source(
    document: Document, place: Place, entry: RecordEntry, common: Common, motion: GroundMotion
) -> list[Source]:  # fmt: skip
    """Return a ground motion of Python, whose entry can have everything but what describes a file."""
    if set(as_written(entry)) - OF_MOTIONS:
        what = "units, dt, channel, vertical and the like describe a file, and this is a ground motion"
        document.problems.append(document.at(place, what))
        return []
    reading = entry.reading(Path(), common.reading)
    return [Source(_at_level(motion.name, entry), entry, reading, motion.name, motion=motion)]


def _structure(
    document: Document, place: Place, folder: Path, entry: StructureEntry, load: Callable[[str], Mechanism]
) -> Mechanism | None:  # fmt: skip
    file = folder / entry.file
    try:
        structure = load(entry.file)
    except InputError as error:
        document.problems += _of_file(document, _within(document, place, "file"), entry.file, file, error)
        return None
    except MechanismError as error:
        raise of_structure(error, entry.file) from error
    infos = type(structure).model_fields.items()
    fields = {name: info for name, info in infos if info.annotation in (float, float | None)}
    known = [*fields, RESTITUTION]
    written = document.data["structures"][place[1]]  # as written, with invalid distributions too
    varied = written.get("vary") if isinstance(written, dict) else None
    for name in varied if isinstance(varied, dict) else []:
        if name not in known:
            what = f"is not a number among the fields of {structure.mechanism}"
            hint = by_meaning(name, fields) or did_you_mean(name, known)
            document.problems.append(document.at((*place, "vary", name), what, hint, key=True))
    return structure.model_copy(update={"name": entry.name}) if entry.name is not None else structure


def _of_file(document: Document, place: Place, name: str, file: Path, error: InputError) -> list[Problem]:
    """Return the problems of a file that the study names; those without a line get the line in the study file."""
    return [
        each
        if each.line is not None or each.file != str(file)
        else document.at(place, f"{name}: {each.field + ' ' if each.field else ''}{each.message}", each.hint)
        for each in error.problems
    ]


def _sources(document: Document, place: Place, folder: Path, entry: RecordEntry, common: Common) -> list[Source]:
    if entry.pulse is not None:
        try:
            parse_pulse(entry.pulse)
        except (InputError, MechanismError) as error:
            document.problems.append(document.at(_within(document, place, "pulse"), str(error)))
            return []
        return [Source(_at_level(entry.pulse, entry), entry, entry.reading(folder, common.reading), entry.pulse)]
    assert entry.file is not None
    files = _select(document, _within(document, place, "file"), entry.file, folder)
    other = _select(document, (*place, "with"), entry.other, folder) if entry.other is not None else []
    vertical = None
    if entry.vertical is not None:
        verticals = _select(document, (*place, "vertical"), entry.vertical, folder)
        if max(len(files), len(verticals)) > 1:
            what = "a vertical component belongs to a single record: give each record its own entry"
            document.problems.append(document.at((*place, "vertical"), what))
            return []
        vertical = verticals[0] if verticals else None
    if other and max(len(files), len(other)) > 1:
        what = "a second component belongs to one record: give each record an entry of its own"
        document.problems.append(document.at((*place, "with"), what))
        return []
    if other:  # a pattern is replaced by the only file that it matches
        entry = entry.model_copy(update={"other": _shown(other[0], folder)})
    return [one for file in files for one in _of_file_or_list(document, place, folder, entry, common, file, vertical)]


def _of_file_or_list(
    document: Document,
    place: Place,
    folder: Path,
    entry: RecordEntry,
    common: Common,
    file: Path,
    vertical: Path | None,
) -> list[Source]:
    """Return the records of a file, or of a list of records; the options of a list's entry take precedence."""
    reading = entry.reading(folder, common.reading)
    if not is_list(file):
        shown = _shown(file, folder)
        return [Source(_at_level(shown, entry), entry, reading, shown, file, vertical)]
    if vertical is not None:
        what = "a vertical component belongs to one record, and this is a list of them: give each an entry of its own"
        document.problems.append(document.at((*place, "vertical"), what))
        return []
    try:
        listed = read_list(file)
    except InputError as error:
        document.problems += _of_file(document, _within(document, place, "file"), str(entry.file), file, error)
        return []
    sources = []
    for item in listed:
        assert item.entry is not None
        record = RecordEntry.model_validate(_together(entry, item.entry))
        shown = _shown(item.path, folder)
        sources.append(Source(_at_level(shown, record), record, item.reading(reading), shown, item.path))
    return sources


def _together(entry: RecordEntry, listed: Entry) -> dict[str, Any]:
    """Merge the entry of a study that names a list of records with the entry of one record in that list.

    Values of the list entry take precedence. Processing steps of both apply: first those of the list, then those of the
    study. Factors of both apply too; the factor of the list comes before any step of the study.
    """
    fields = {**as_written(entry), **as_written(listed), "file": str(entry.file)}
    steps = [*(listed.processing or []), *(entry.processing or [])]
    if listed.factor is not None and (entry.processing or entry.factor is not None):
        steps.insert(len(listed.processing or []), {"factor": listed.factor})
        fields["factor"] = entry.factor
    return {**fields, "processing": steps or None}


def _at_level(name: str, entry: RecordEntry) -> str:
    """Return the name of a record; with its level if it is in a set, as it may be in several."""
    return name if entry.level is None else f"{name} at {entry.level:g}"


def _in_words(name: str, entry: RecordEntry) -> str:
    """Return the name of a record with its channel, azimuth and level, if given."""
    channel = "" if entry.channel is None else f" channel {entry.channel}"
    towards = "" if entry.azimuth is None or entry.other is None else f" azimuth {entry.azimuth:g}"
    return _at_level(f"{name}{channel}{towards}", entry)


def _apart(sources: Sequence[Source]) -> list[Source]:
    """Return the records with different names: channel and azimuth are added to names that several records share."""
    names = [source.name for source in sources]
    return [
        replace(each, name=_in_words(each.file, each.entry)) if names.count(each.name) > 1 else each for each in sources
    ]


def _select(document: Document, place: Place, pattern: str, folder: Path) -> list[Path]:
    try:
        return matching_files(pattern, folder)
    except InputError as error:
        document.problems += [document.at(place, f"{each.file}: {each.message}", each.hint) for each in error.problems]
        return []


def _within(document: Document, place: Place, key: str) -> Place:
    """Return the place of a key of an entry; the place of the entry itself if this is plain text."""
    return (*place, key) if (*place, key) in document.values else place


def _shown(path: Path, folder: Path) -> str:
    """Return the name of a file relative to the study's folder, the same on every system."""
    return one_line((path.relative_to(folder) if path.is_relative_to(folder) else path).as_posix())


def _refuse_repeated(document: Document, field: str, names: Sequence[str]) -> None:
    for name in dict.fromkeys(name for name in names if names.count(name) > 1):
        hint = "give one of them a `name`" if field == "structures" else None
        document.problems.append(document.at((field,), f"two of them are called {name}", hint, key=True))


def _wrong_as_free_blocks(
    document: Document, files: Sequence[Path], structures: Sequence[Mechanism | None]
) -> Iterator[Problem]:
    """Yield why free blocks cannot be simulated at all, or what of a structure they cannot have."""
    try:
        engine_version()
    except InputError as error:
        yield from (document.at(("engine",), each.message, each.hint) for each in error.problems)
    for file, structure in zip(files, structures, strict=True):
        try:
            if structure is not None:
                free_blocks(structure)
        except InputError as error:
            yield from (replace(each, file=str(file)) for each in error.problems)


def _hazard(document: Document, folder: Path) -> HazardCurve | None:
    hazard = usable_part(HazardEntry, document.data.get("hazard"))
    if hazard is None:
        return None
    if hazard.points is not None:
        return HazardCurve(*np.array(hazard.points).T)
    assert hazard.file is not None
    file = folder / hazard.file
    try:
        return read_hazard(file, hazard.measure)
    except InputError as error:
        document.problems += _of_file(document, ("hazard", "file"), hazard.file, file, error)
        return None


def _samples(
    document: Document, sampling: Sampling, k: int, entry: StructureEntry, structure: Mechanism
) -> list[Sample]:  # fmt: skip
    """Return the samples of a structure; samples that cannot be built are reported as problems of its `vary`."""
    if not entry.vary or any(name not in type(structure).model_fields for name in entry.vary):
        return [Sample(k, 0, {}, structure)]
    columns: dict[str, list[float]] = {}
    for name, distribution in entry.vary.items():
        stream = f"{structure.name}.{name}"
        columns[name] = draw(
            distribution, sampling.samples, seed=sampling.seed, stream=stream, method=sampling.sampling
        ).tolist()
    samples, wrong = [], []
    for number in range(sampling.samples):
        drawn = {name: values[number] for name, values in columns.items()}
        try:
            samples.append(Sample(k, number, drawn, structure.model_copy(update=drawn)))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            message, _ = say(type(structure), first["loc"], first, structure.mechanism, "")
            wrong.append(f"{first['loc'][0]} {message}" if first["loc"] else message)
    if wrong:
        what = f"{len(wrong)} of {sampling.samples} samples cannot be built; the first: {wrong[0]}"
        hint = "bound the distributions with `low` and `high`"
        document.problems.append(document.at(("structures", k, "vary"), what, hint))
    return samples
