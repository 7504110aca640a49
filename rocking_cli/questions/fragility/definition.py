"""The definition of a fragility study in its YAML file: fields, rules between them, and distributions of numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import islice, pairwise
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, ValidationError
from pydantic_core import PydanticCustomError

from rocking_cli.arrays import Reals
from rocking_cli.ask.asked import as_in
from rocking_cli.core import Mechanism
from rocking_cli.core.fields import Name, Restitution
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.io.yaml_file import Document, Place
from rocking_cli.processing.reading import Reading, reading_of
from rocking_cli.processing.record_list import Entry, FloorItem, Steps
from rocking_cli.processing.steps import parse_steps
from rocking_cli.questions.fragility.asked import MAX_LEVELS, OfStudy
from rocking_cli.questions.fragility.asked import OVERTURNING as OVERTURNING
from rocking_cli.questions.fragility.asked import SLIDING as SLIDING
from rocking_cli.questions.fragility.asked import UPLIFT as UPLIFT
from rocking_cli.questions.fragility.hazard_curve import wrong_points
from rocking_cli.questions.fragility.observed import INTENSITY_TOLERANCE
from rocking_cli.studies.engines import EngineName
from rocking_cli.studies.file_part import Part, Sound, problems_of
from rocking_cli.studies.fragility.quantities import (
    PGA,
    displacement_in_mm,
    is_quantity,
    metres,
    no_levels,
    standard_measure,
)
from rocking_cli.studies.fragility.quantities import SCALE as SCALE
from rocking_cli.units import UnitError, read

RESTITUTION = "restitution"
UPLIFT_MEASURE = "lambda"  # the measure that a motion must exceed to uplift a structure; not a limit state of a study
as_asked = partial(as_in, OfStudy)


def _measure(text: str) -> str:
    """Return the standard spelling of a measure given in any case and spacing."""
    try:
        return standard_measure(text)
    except InputError as error:
        (problem,) = error.problems
        values = {"reason": problem.message, "hint": problem.hint}
        raise PydanticCustomError("unit", "{reason}", values) from None


def _level_measure(text: str) -> str:
    """Return the measure of levels: the factor on the records, or a measure proportional to a power of this factor."""
    if text.strip().lower() == SCALE:
        return SCALE
    if why := no_levels(measure := _measure(text)):
        raise ValueError(why)
    return measure


def _limit(value: object) -> object:
    """Read a limit state: a word, a ratio of rotations, or a displacement of the top, converted to mm."""
    if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf"):
        return float(value)
    if value in (UPLIFT, OVERTURNING, SLIDING):
        return value
    if isinstance(value, str) and is_quantity(value):
        return displacement_in_mm(value)
    known = "uplift, overturning, sliding, a positive number or a displacement such as 25 mm"
    raise ValueError(f"must be {known}, got {value!r}")


def _listed(given: dict[str, Any], name: str) -> list[Any]:
    """Return the entries of a list in the data of a file; none if there is none, or if it is no list."""
    entries = given.get(name)
    return entries if isinstance(entries, list) else []


def _right(given: dict[str, Any], name: str, sound: Sound) -> list[Any]:
    """Return the valid entries of a list."""
    return [each for k, each in enumerate(_listed(given, name)) if sound(name, k)]


def _different(values: list[str]) -> list[str]:
    """Refuse a measure paired with itself: a surface over the two is a curve."""
    if values[0] == values[1]:
        raise ValueError(f"{values[0]} is paired with itself")
    return values


def _as_text(value: object) -> object:
    """Return a whole number as text: YAML reads the polarity 1 as a number."""
    return str(value) if type(value) is int else value


def _file(value: object) -> object:
    """Expand an entry that is plain text to a mapping with the text as its `file`."""
    return {"file": value} if isinstance(value, str) else value


Intensity = Annotated[float, Field(ge=1e-6, le=1e6)]
Measure = Annotated[str, AfterValidator(_measure)]
LevelMeasure = Annotated[str, AfterValidator(_level_measure)]
Limit = Annotated[str | float, BeforeValidator(_limit)]
Item = TypeVar("Item")
Pair = Annotated[list[Item], Field(min_length=2, max_length=2)]


def implies(limit: Limit, other: Limit, *, slides: bool = False) -> bool:
    """Return whether every run that exceeds a limit state exceeds another one, if a body may also only slide."""
    if limit == other or other in (OVERTURNING, SLIDING):
        return False
    if other == UPLIFT or limit == OVERTURNING:
        return not slides or limit == OVERTURNING or isinstance(limit, float)
    if isinstance(limit, float) and isinstance(other, float):
        return limit > other
    moved, less = metres(limit), metres(other)
    return moved is not None and less is not None and moved > less


class StructureEntry(Part):
    """A structure of the study."""

    file: str = Field(description="its YAML file")
    name: Name | None = Field(None, description="what to call it here")
    vary: dict[str, Distribution] = Field({}, description="distributions of some of its fields")


class RecordEntry(Entry, Part):
    """Ground motions of the study: files that a pattern stands for, a list of records, or a pulse."""

    pulse: str | None = Field(None, description="a pulse, such as sine:0.6g:0.8s")
    vertical: str | None = Field(None, description="the file of the vertical component")
    level: Intensity | None = Field(None, description="the one level whose set of records it belongs to")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that an entry has exactly one source, and only the fields that suit it."""
        there = {name for name in given if given.get(name) is not None}
        if len(there & {"file", "pulse"}) != 1:
            yield (), "give a file or a pulse"
        elif "pulse" in there and there - {"pulse", "floor", "weight", "level"}:
            yield (), "units, dt, channel, vertical and the like describe a file"
        pair = bool(there & {"with", "other"})
        if "azimuth" in there and not pair:
            yield ("azimuth",), f"is between two components: give the file of the second with {named('with')}"
        if there & {"with_channel", "other_channel"} and not pair:
            yield ("with_channel",), f"is of a second component: give its file with {named('with')}"
        if pair and "azimuth" not in there:
            yield (), f"azimuth is missing: 0 for the record, 90 for that of {named('with')}, or what is between them"


class Levels(Part):
    """Intensities to which every record is scaled."""

    measure: LevelMeasure = Field(description="what the levels are of")
    values: list[Intensity] | None = Field(None, min_length=1, max_length=MAX_LEVELS, description="the levels")
    least: Intensity | None = Field(None, description="the smallest")
    most: Intensity | None = Field(None, description="the largest")
    count: int | None = Field(None, ge=2, le=MAX_LEVELS, description="how many")
    spacing: Literal["even", "log"] = Field("even", description="steps of equal size, or of equal ratio")
    scaled: bool = Field(True, description="false: sets of records are used as they are, and a level names its set")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that levels are either listed or given as a range, and differ by more than rounding."""
        least, most, count = ranged = [given.get(name) for name in ("least", "most", "count")]
        if any((each is None) == (given.get("values") is None) for each in ranged):
            yield (), "give values, or least, most and count"
        for one, other in _alike(sorted(_right(given, "values", sound))):
            same = f"{one} is given twice" if one == other else f"{one} and {other} differ by rounding alone"
            yield ("values",), same
        if least is None or most is None or not (sound("least") and sound("most")):
            return
        complete = count is not None and sound("count") and sound("spacing")
        if least >= most:
            yield ("most",), f"must be more than least ({least:g}), got {most:g}"
        elif complete and _alike(cls.model_construct(**{**given, "values": None}).levels()):
            yield ("most",), f"is too close to least for {count} distinct levels"

    def levels(self) -> list[float]:
        """Return the levels, increasing."""
        if self.values is not None:
            return sorted(self.values)
        assert self.least is not None and self.most is not None and self.count is not None
        between = np.geomspace if self.spacing == "log" else np.linspace
        return [float(each) for each in between(self.least, self.most, self.count)]


def _alike(levels: list[float]) -> list[tuple[float, float]]:
    """Return the neighbours among increasing levels that differ by no more than rounding."""
    return [(one, other) for one, other in pairwise(levels) if other <= one * (1 + INTENSITY_TOLERANCE)]


class HazardEntry(Part):
    """Annual rates at which intensities are exceeded at the site."""

    measure: Measure = Field("PGA", description="of the intensities")
    file: str | None = Field(
        None, description="CSV of intensity and annual rate of exceedance, or OpenQuake's hazard curve"
    )
    points: list[Pair[Positive]] | None = Field(
        None, min_length=2, description="[intensity, annual rate] of each point"
    )

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the hazard has exactly one source, and that its points are in order."""
        points: Any = given.get("points")
        if (given.get("file") is None) == (points is None):
            yield (), "give a file or points"
        right = [k for k in range(len(_listed(given, "points"))) if sound("points", k)]
        if len(right) > 1:
            for k, message in wrong_points(*np.array([points[k] for k in right], dtype=np.float64).T):
                yield ("points", right[k]), message


class Sampling(Part, extra="ignore"):
    """Method by which samples of the structures are drawn."""

    samples: int = as_asked("samples")
    sampling: Literal["random", "latin hypercube"] = as_asked("sampling")
    seed: int = as_asked("seed")


class Common(Part, extra="ignore"):
    """Processing and floor of all records."""

    processing: Steps = as_asked("processing")
    floor: FloorItem = as_asked("floor")

    @property
    def reading(self) -> Reading:
        """Reading and processing of all records, unless the entry of a record states otherwise."""
        return Reading(reading_of({"floor": self.floor}).options, parse_steps(self.processing))


class Definition(Sampling, Common, extra="forbid"):
    """The content of a study file: the fields of `OfStudy`, and what each may hold in a file."""

    name: Name | None = as_asked("name")
    structures: list[Annotated[StructureEntry, BeforeValidator(_file)]] = as_asked("structures", min_length=1)
    records: list[Annotated[RecordEntry, BeforeValidator(_file)]] = as_asked("motions", default=..., min_length=1)
    method: Literal["cloud", "stripes", "ida"] = as_asked("method", default=...)
    levels: Levels = as_asked("levels", default=Levels(measure="scale", values=[1.0]))
    polarity: Annotated[Literal["1", "-1", "both"], BeforeValidator(_as_text)] = as_asked("polarity")
    restitution: list[Restitution] | None = as_asked("restitution")
    model: ModelName = as_asked("model")
    engine: EngineName = as_asked("engine")
    opening: float = as_asked("opening")
    limit_states: list[Limit] = as_asked("limit_states")
    measures: list[Measure] | None = as_asked("measures")
    bivariate: list[Annotated[Pair[Measure], AfterValidator(_different)]] = as_asked("bivariate")
    confidence: float = as_asked("confidence")
    hazard: HazardEntry | None = as_asked("hazard")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the levels suit the method, the samples what varies, and the model the requested measures."""
        method, levels, vary = given.get("method"), given.get("levels"), {name for _, name in varied(given)}
        scaled = isinstance(levels, dict) and sound("levels", "measure") and levels["measure"].strip().lower() != SCALE
        if method == "cloud" and scaled:
            yield ("levels",), f"a cloud scales records by factors: `measure: {SCALE}`"
        yield from _wrong_sets(given, sound)
        if method in ("stripes", "ida") and "levels" not in given:
            yield ("levels",), "is missing: every record is scaled to levels of intensity"
        if vary and "samples" not in given:
            yield ("samples",), "is missing: how many structures are drawn from the distributions"
        if not vary and sound("structures") and sound("samples") and given.get("samples", 1) > 1:
            yield ("samples",), f"nothing varies: add {named('vary')} to at least one structure"
        if given.get(RESTITUTION) is not None and RESTITUTION in vary:
            yield (RESTITUTION,), "cannot be combined with a structure that varies its restitution: give one of the two"
        if checks_sliding(given) and sound("model") and given.get("model", "nonlinear") != "nonlinear":
            yield ("limit_states",), "sliding requires `model: nonlinear`: linear models do not give the joint forces"
        if sound("engine") and (engine := given.get("engine", "exact")) != "exact":
            yield from _wrong_with_free_blocks(given, sound, engine)
        for name, values in (
            (RESTITUTION, _right(given, RESTITUTION, sound)),
            ("limit_states", [_limit(each) for each in _right(given, "limit_states", sound)]),
            ("measures", [_measure(each) for each in _right(given, "measures", sound)]),
            ("bivariate", [" and ".join(map(_measure, pair)) for pair in _right(given, "bivariate", sound)]),
        ):
            for k, value in enumerate(values):
                if value in values[:k] and value not in values[k + 1 :]:
                    yield (name,), f"{value} is given twice"

    @property
    def polarities(self) -> list[int]:
        """The polarities that are run: 1 as given, -1 reversed."""
        return [1, -1] if self.polarity == "both" else [int(self.polarity)]

    @property
    def fitted_measures(self) -> list[str]:
        """Measures of the curves: those requested, otherwise that of the levels; and that of the hazard."""
        usual = PGA if self.levels.measure == SCALE else self.levels.measure
        of_hazard = [] if self.hazard is None else [self.hazard.measure]
        return list(dict.fromkeys([*(self.measures or [usual]), *of_hazard]))

    @property
    def asked_measures(self) -> list[str]:
        """All measures that the study names, each once: those of levels, curves, surfaces and hazard."""
        asked = [self.levels.measure, *self.fitted_measures, *(one for pair in self.bivariate for one in pair)]
        return [name for name in dict.fromkeys(asked) if name != SCALE]


def varied(given: dict[str, Any]) -> list[tuple[int, str]]:
    """Return the index of the structure and the name of each field that varies, in the data of a study file."""
    vary = [each.get("vary") if isinstance(each, dict) else None for each in _listed(given, "structures")]
    return [(k, name) for k, each in enumerate(vary) if isinstance(each, dict) for name in each]


def _wrong_sets(given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
    """Yield an error for each record whose set or level does not suit the levels and the method of the study."""
    entries, levels = _listed(given, "records"), given.get("levels")
    of_sets = [k for k, each in enumerate(entries) if isinstance(each, dict) and each.get("level") is not None]
    if isinstance(levels, dict) and levels.get("scaled") is False:
        place = ("levels", "scaled")
        if levels.get("measure") == SCALE:
            yield place, f"levels of the measure {SCALE} are factors: leave scaled out"
        if sound("records") and len(of_sets) < len(entries):
            yield place, f"records are used as they are, so each needs the {named('level')} whose set it is of"
    if of_sets and given.get("method") != "stripes" and sound("method"):
        yield ("records", of_sets[0], "level"), "sets of records for levels are of `method: stripes`"
    if not of_sets or (right := usable_part(Levels, levels)) is None:
        return
    known = right.levels()
    for k in of_sets:
        if sound("records", k) and not np.isclose(level := entries[k]["level"], known, INTENSITY_TOLERANCE, 0).any():
            shown = ", ".join(f"{each:g}" for each in known[:10]) + (", ..." if len(known) > 10 else "")
            yield ("records", k, "level"), f"{level:g} is not one of the levels {shown}"


def _wrong_with_free_blocks(given: dict[str, Any], sound: Sound, engine: str) -> Iterator[tuple[Place, str]]:
    """Yield an error for each field that has no meaning, or no effect, if free blocks are simulated."""
    if sound("model") and (model := given.get("model", "nonlinear")) != "nonlinear":
        yield ("model",), f"{model} cannot be combined with `engine: {engine}`: leave it out"
    if checks_sliding(given):
        what = f"sliding cannot be combined with `engine: {engine}`, as free blocks slide by themselves: leave it out"
        yield ("limit_states",), what
    if engine == "auto":  # runs of one degree of freedom use these
        return
    restitution = "has no effect with `engine: blocks`, as contact decides the restitution: leave it out"
    if given.get(RESTITUTION) is not None:
        yield (RESTITUTION,), restitution
    if given.get("opening") is not None:
        yield ("opening",), "has no effect with `engine: blocks`, which simulates every joint: leave it out"
    for k, name in varied(given):
        if name in (RESTITUTION, "rebound"):
            yield ("structures", k, "vary", name), restitution


def checks_sliding(given: dict[str, Any]) -> bool:
    """Return whether the data of a study file names sliding as a limit state, so that every run is checked."""
    return SLIDING in _listed(given, "limit_states")


HINT = "see the example in docs/fragility.md"
# Keys of an entry for which hints are looked up in turn.
ENTRY_PARTS = (("file", "name"), ("file", "vertical"), ("file",), ("pulse",))
Piece = TypeVar("Piece", bound=BaseModel)


def definition_of(document: Document, load: Callable[[str], Mechanism]) -> Definition | None:
    """Return the definition of a study; errors in it are added to the problems of the document, and make it None.

    Parameters
    ----------
    document : Document
        The content of the study.
    load : callable
        Returns the structure of a file that the study names.
    """
    of_units = in_units_of_fields(document, load)
    document.problems += of_units
    try:
        return Definition.model_validate(document.data)
    except ValidationError as error:
        document.problems += problems_of(document, Definition, error, owner="the study", lister=HINT, known=of_units)
    return None


def usable_entries(document: Document, field: str, model: type[Piece]) -> Iterator[tuple[int, Piece]]:
    """Yield the entries of a list with their places; of an invalid entry one part that is valid by itself, if any."""
    for k, entry in enumerate(_listed(document.data, field)):
        if isinstance(given := _file(entry), dict):
            parts = (given, *({name: given.get(name) for name in names} for names in ENTRY_PARTS))
            usable = (each for each in (usable_part(model, part) for part in parts) if each is not None)
            yield from ((k, each) for each in islice(usable, 1))


def usable_part(model: type[Piece], data: Any) -> Piece | None:
    """Return a part of the file that is valid by itself, whatever is wrong elsewhere; None if it is invalid."""
    try:
        return model.model_validate(data)
    except ValidationError:
        return None


Positive = Annotated[float, Field(gt=0)]
MIN_RANDOM = 2.0**-54  # a random number may be zero, where a normal distribution has no quantile


class _Ordered(Part):
    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ends are in order."""
        low, high = given.get("low"), given.get("high")
        if low is not None and high is not None and sound("low") and sound("high") and low >= high:
            yield ("high",), f"must be more than low ({low:g}), got {high:g}"


class _Bounded(_Ordered):
    low: float | None = Field(None, description="smallest value: what lies below is not drawn")
    high: float | None = Field(None, description="largest value: what lies above is not drawn")

    @property
    def ends(self) -> Reals:
        """The two bounds; infinite where there is none."""
        return np.array([-np.inf if self.low is None else self.low, np.inf if self.high is None else self.high])


class Normal(_Bounded):
    """A normal distribution, truncated where `low` or `high` is given."""

    mean: float = Field(description="mean, before truncation")
    deviation: Positive = Field(description="standard deviation, before truncation")


class Lognormal(_Bounded):
    """A lognormal distribution, truncated where `low` or `high` is given."""

    median: Positive = Field(description="median, before truncation")
    dispersion: Positive = Field(description="standard deviation of the logarithm, before truncation")


class Uniform(_Ordered):
    """A uniform distribution."""

    low: float = Field(description="smallest value")
    high: float = Field(description="largest value")


class Triangular(Part):
    """A triangular distribution."""

    low: float = Field(description="smallest value")
    mode: float = Field(description="most likely value")
    high: float = Field(description="largest value")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the mode lies between the ends."""
        if all(sound(name) for name in ("low", "mode", "high")):
            low, mode, high = given["low"], given["mode"], given["high"]
            if not low <= mode <= high or low == high:
                yield ("mode",), f"must lie between low ({low:g}) and high ({high:g})"


class Distribution(Part):
    """One of several distributions: a mapping with its name as the only key."""

    normal: Normal | None = None
    lognormal: Lognormal | None = None
    uniform: Uniform | None = None
    triangular: Triangular | None = None
    values: list[float] | None = Field(None, min_length=1, description="values that are equally likely")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that there is exactly one distribution."""
        if sum(each is not None for each in given.values()) != 1:
            yield (), f"give one distribution, of {', '.join(cls.model_fields)}"

    def quantile(self, probability: Reals) -> Reals:
        """Return the values that are not exceeded with some probabilities, each in (0, 1)."""
        if self.normal is not None:
            return _truncated_normal(probability, self.normal.mean, self.normal.deviation, self.normal.ends)
        if self.lognormal is not None:
            with np.errstate(divide="ignore"):
                ends = np.log(np.maximum(self.lognormal.ends, 0.0))
            mean = float(np.log(self.lognormal.median))
            return np.exp(_truncated_normal(probability, mean, self.lognormal.dispersion, ends))
        if self.uniform is not None:
            width = self.uniform.high - self.uniform.low
            return np.asarray(self.uniform.low + width * probability)
        if self.triangular is not None:
            low, mode, high = self.triangular.low, self.triangular.mode, self.triangular.high
            rising = low + np.sqrt(probability * (high - low) * (mode - low))
            falling = high - np.sqrt((1 - probability) * (high - low) * (high - mode))
            return np.asarray(np.where(probability < (mode - low) / (high - low), rising, falling))
        assert self.values is not None
        place = np.minimum(probability * len(self.values), len(self.values) - 1).astype(int)
        return np.asarray(np.array(self.values)[place])


def _truncated_normal(probability: Reals, mean: float, deviation: float, ends: Reals) -> Reals:
    low, high = ((ends - mean) / deviation).tolist()
    return np.asarray(mean + deviation * _standard_normal(probability, low, high))


def _standard_normal(probability: Reals, low: float, high: float) -> Reals:
    """Return quantiles of the standard normal distribution between two bounds, without underflow in its tails."""
    from scipy.special import log_ndtr, ndtri_exp

    if low > 0:  # by symmetry, as the lower tail has more digits
        upper: Reals = -_standard_normal(1 - probability, -high, -low)
        return upper
    below, above = log_ndtr(low), log_ndtr(high)
    between = above + np.log(-np.expm1(below - above))
    return np.asarray(np.clip(ndtri_exp(np.logaddexp(below, np.log(probability) + between)), low, high))


def draw(
    distribution: Distribution,
    count: int,
    *,
    seed: int,
    stream: str,
    method: Literal["random", "latin hypercube"],
) -> Reals:
    """Draw samples of a distribution.

    Parameters
    ----------
    distribution : Distribution
        The distribution.
    count : int
        Number of samples.
    seed : int
        Seed of the study.
    stream : str
        Name of the quantity that is drawn. Each name has its own stream of random numbers, so that adding another
        quantity does not change the samples of this one.
    method : {"random", "latin hypercube"}
        Independent draws, or one in each of `count` equally likely ranges, in random order.
    """
    rng = np.random.default_rng([seed, *stream.encode()])
    uniform = rng.random(count)
    if method == "latin hypercube":
        uniform = (rng.permutation(count) + uniform) / count
    with np.errstate(over="ignore"):  # overflow gives infinity, from which no structure can be built
        return distribution.quantile(np.clip(uniform, MIN_RANDOM, 1 - 2 * MIN_RANDOM))


DIMENSIONLESS = ("dispersion",)  # parameters of a distribution without a unit


def in_units_of_fields(document: Document, load: Callable[[str], Mechanism]) -> list[Problem]:
    """Convert texts with units in the distributions of a study to numbers; return the problems with them.

    Parameters
    ----------
    document : Document
        The study; its data are changed. Values that are not texts with a unit stay as they are.
    load : callable
        Returns the structure of a file that the study names.
    """
    entries = document.data.get("structures")
    problems: list[Problem] = []
    of_file = cache(load)
    for k, entry in enumerate(entries if isinstance(entries, list) else []):
        varied = entry.get("vary") if isinstance(entry, dict) else None
        if not isinstance(varied, dict) or not isinstance(entry.get("file"), str):
            continue
        for name, distribution in varied.items():
            unit = partial(_unit, name, of_file, entry["file"])
            try:
                varied[name] = _numbers(document, distribution, unit, ("structures", k, "vary", name), problems)
            except RockingError:  # the problem is reported when the study itself is read
                break
    return problems


def _unit(name: str, load: Callable[[str], Mechanism], file: str) -> str:
    """Return the unit of a field of the structure of a file; empty if it has none."""
    info = type(load(file)).model_fields.get(name)
    extra = info.json_schema_extra if info is not None else None
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


def _numbers(document: Document, value: Any, unit: Callable[[], str], place: Place, problems: list[Problem]) -> Any:
    if isinstance(value, dict):
        return {key: _numbers(document, each, unit, (*place, key), problems) for key, each in value.items()}
    if isinstance(value, list):
        return [_numbers(document, each, unit, (*place, k), problems) for k, each in enumerate(value)]
    if not is_quantity(value):
        return value
    wanted = unit()
    try:
        return read(value, "" if place[-1] in DIMENSIONLESS else wanted)
    except UnitError as error:
        problems.append(document.at(place, error.message, error.hint))
        return value
