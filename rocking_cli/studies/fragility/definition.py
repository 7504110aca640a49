"""A fragility study from its YAML file: the fields, and what must hold between them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

import numpy as np
from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, ValidationError, model_validator

from rocking_cli.core.mechanism import Name, Restitution, geometry_error
from rocking_cli.dynamics.model import ModelName
from rocking_cli.field_problems import problems
from rocking_cli.studies.fragility.distributions import STRICT, Distribution, Positive
from rocking_cli.studies.fragility.intensity import MEASURES, PGA
from rocking_cli.studies.fragility.varied import in_units_of_fields
from rocking_cli.yaml_file import Document, parse, read_text

T = TypeVar("T")
UPLIFT, OVERTURNING = "uplift", "overturning"
SCALE = "scale"
MOST = 100_000  # levels or samples: more is a slip of the keyboard


def _measure(value: object) -> object:
    """A measure as it is spelt here, from any case and spacing."""
    plain = {name.replace(" ", "").lower(): name for name in (*MEASURES, SCALE)}
    return plain.get(value.replace(" ", "").lower(), value) if isinstance(value, str) else value


def _limit(value: object) -> object:
    """A limit state: a word, or a ratio of rotations."""
    if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf"):
        return float(value)
    if value in (UPLIFT, OVERTURNING):
        return value
    raise ValueError(f"must be uplift, overturning or a positive number, got {value!r}")


def _unlike(values: list[T]) -> list[T]:
    """Refuse a list that repeats itself."""
    for value in values:
        if values.count(value) > 1:
            raise ValueError(f"{value} is given twice")
    return values


def _file(value: object) -> object:
    """A plain text stands for an entry that is only a file."""
    return {"file": value} if isinstance(value, str) else value


Measure = Annotated[
    Literal["PGA", "PGV", "PGA/(g lambda)", "p PGV/(g lambda)"],  # MEASURES, as types must be written out
    BeforeValidator(_measure),
]
LevelMeasure = Annotated[
    Literal["PGA", "PGV", "PGA/(g lambda)", "p PGV/(g lambda)", "scale"], BeforeValidator(_measure)
]
Limit = Annotated[str | float, BeforeValidator(_limit)]
Unlike = AfterValidator(_unlike)


class StructureEntry(BaseModel):
    """A structure of the study."""

    model_config = STRICT

    file: str = Field(description="its YAML file")
    name: Name | None = Field(None, description="what to call it here")
    vary: dict[str, Distribution] = Field({}, description="distributions of some of its fields")


class RecordEntry(BaseModel):
    """Ground motions of the study: files that a pattern stands for, or a pulse."""

    model_config = STRICT

    file: str | None = Field(None, description="a file, or a pattern of file names")
    pulse: str | None = Field(None, description="a pulse, such as sine:0.6g:0.8s")
    units: Literal["g", "m/s2", "cm/s2", "mm/s2", "gal", "mg", "%g"] | None = Field(
        None, description="unit, where no file says"
    )
    dt: Positive | None = Field(None, description="sample interval, where no file says")
    channel: str | None = Field(None, description="which of several channels")
    vertical: str | None = Field(None, description="the file of the vertical component")

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.file is None) == (self.pulse is None):
            raise ValueError("give a file or a pulse")
        if self.pulse is not None and self.model_fields_set != {"pulse"}:
            raise ValueError("units, dt, channel and vertical describe a file")
        return self


Intensity = Annotated[float, Field(ge=1e-6, le=1e6)]


class Levels(BaseModel):
    """Intensities to which every record is scaled."""

    model_config = STRICT

    measure: LevelMeasure = Field(description="what the levels are of")
    values: Annotated[list[Intensity], Unlike] | None = Field(
        None, min_length=1, max_length=MOST, description="the levels"
    )
    least: Intensity | None = Field(None, description="the smallest")
    most: Intensity | None = Field(None, description="the largest")
    count: int | None = Field(None, ge=2, le=MOST, description="how many")
    spacing: Literal["even", "log"] = Field("even", description="steps of equal size, or of equal ratio")

    @model_validator(mode="after")
    def _listed_or_ranged(self) -> Self:
        ranged = [self.least, self.most, self.count]
        if self.values is not None:
            if any(each is not None for each in ranged):
                raise ValueError("give values, or least, most and count")
        elif self.least is None or self.most is None or self.count is None:
            raise ValueError("give values, or least, most and count")
        elif self.least >= self.most:
            raise geometry_error("most", f"must be more than least ({self.least:g}), got {self.most:g}")
        elif len(set(self.levels())) < self.count:
            raise geometry_error("most", f"is so close to least that {self.count} levels between them repeat")
        return self

    def levels(self) -> list[float]:
        """The levels, growing."""
        if self.values is not None:
            return sorted(self.values)
        assert self.least is not None and self.most is not None and self.count is not None
        spaced = np.geomspace if self.spacing == "log" else np.linspace
        return [float(each) for each in spaced(self.least, self.most, self.count)]


class Hazard(BaseModel):
    """How often intensities are exceeded at the site."""

    model_config = STRICT

    measure: Measure = Field("PGA", description="of the intensities")
    file: str | None = Field(None, description="CSV of two columns: intensity, annual rate of exceedance")
    points: list[Annotated[list[Positive], Field(min_length=2, max_length=2)]] | None = Field(
        None, min_length=2, description="[intensity, annual rate] of each point"
    )

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.file is None) == (self.points is None):
            raise ValueError("give a file or points")
        return self


class Definition(BaseModel):
    """What a study file says."""

    model_config = STRICT

    name: Name | None = Field(None, description="what to call the study")
    structures: list[Annotated[StructureEntry, BeforeValidator(_file)]] = Field(
        min_length=1, description="what is shaken"
    )
    records: list[Annotated[RecordEntry, BeforeValidator(_file)]] = Field(min_length=1, description="what shakes it")
    method: Literal["cloud", "stripes", "ida"] = Field(description="how records and intensities are combined")
    levels: Levels = Field(
        Levels(measure=SCALE, values=[1.0]), description="intensities to which every record is scaled"
    )
    polarities: Annotated[list[Literal[1, -1]], Unlike] = Field(
        [1], min_length=1, max_length=2, description="-1 reverses the records"
    )
    eta: Annotated[list[Restitution], Unlike] | None = Field(
        None, min_length=1, description="restitutions, instead of the structures' own"
    )
    model: ModelName = Field("nonlinear", description="equation of motion")
    samples: int = Field(1, ge=1, le=MOST, description="how many structures are drawn from the distributions")
    sampling: Literal["random", "latin hypercube"] = Field("latin hypercube", description="how they are drawn")
    seed: int = Field(0, ge=0, lt=2**63, description="of the random numbers")
    limit_states: Annotated[list[Limit], Unlike] = Field(
        [UPLIFT, OVERTURNING], min_length=1, description="what is asked of the motions"
    )
    measures: Annotated[list[Measure], Unlike] | None = Field(
        None, min_length=1, description="intensities that curves are fitted over"
    )
    bivariate: list[Annotated[list[Measure], Field(min_length=2, max_length=2)]] = Field(
        [], description="pairs of intensities that surfaces are fitted over"
    )
    confidence: float = Field(0.95, gt=0.5, lt=1, description="of intervals and bands")
    hazard: Hazard | None = Field(None, description="how often intensities are exceeded at the site")

    @model_validator(mode="after")
    def _together(self) -> Self:
        if self.method == "cloud" and self.levels.measure != SCALE:
            raise geometry_error("levels", f"a cloud scales records by factors: `measure: {SCALE}`")
        if self.method != "cloud" and "levels" not in self.model_fields_set:
            raise geometry_error("levels", "is missing: every record is scaled to levels of intensity")
        varied = any(each.vary for each in self.structures)
        if varied and "samples" not in self.model_fields_set:
            raise geometry_error("samples", "is missing: how many structures are drawn from the distributions")
        if not varied and self.samples > 1:
            raise geometry_error("samples", "nothing varies: give a structure a `vary`")
        if self.eta is not None and any("restitution" in each.vary for each in self.structures):
            raise geometry_error("eta", "a structure varies its restitution: give one of the two")
        return self

    @property
    def fitted_measures(self) -> list[str]:
        """The measures of curves: those asked for, else that of the levels; and that of the hazard."""
        found: list[str] = list(self.measures or [])
        if not found:
            found = [PGA if self.levels.measure == SCALE else self.levels.measure]
        return list(dict.fromkeys([*found, *([self.hazard.measure] if self.hazard is not None else [])]))

    @property
    def hazard_measure(self) -> str | None:
        """What the hazard curve is of."""
        return self.hazard.measure if self.hazard is not None else None


HINT = "docs/fragility.md shows one to start from"
WORDS = {"owner": "the study", "lister": HINT}
Entry = TypeVar("Entry", bound=BaseModel)


def read_definition(path: Path) -> tuple[Document, Definition | None]:
    """The content of a study file, with what is wrong in it among the document's problems.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    document : Document
        Where everything stands.
    definition : Definition or None
        None if there are problems.

    Raises
    ------
    InputError
        If it cannot be read at all.
    """
    document = parse(read_text(path, "study"), str(path), "study", HINT)
    of_units = in_units_of_fields(document, path.parent)
    document.problems += of_units
    try:
        return document, Definition.model_validate(document.data)
    except ValidationError as error:
        found: Any = error.errors(include_url=False)
    known = {(each.field, each.line) for each in of_units}
    wrong = problems(document, Definition, [*found, *_together(document.data, found)], **WORDS)
    document.problems += [each for each in wrong if (each.field, each.line) not in known]
    return document, None


def _together(data: dict[str, Any], found: list[Any]) -> list[Any]:
    """What is wrong between the fields that are right one by one: pydantic looks there only if all are."""
    wrong = {error["loc"][0] for error in found if error["loc"]}
    absent = {"structures": ["-"], "records": ["-"], "method": "cloud"}
    if not wrong or "method" in wrong:
        return []
    if "structures" in wrong:
        wrong |= {"samples", "eta"}  # right or wrong by what the structures vary
    try:
        Definition.model_validate({**absent, **{key: value for key, value in data.items() if key not in wrong}})
    except ValidationError as error:
        return [each for each in error.errors(include_url=False) if each["ctx"]["field"] not in wrong]
    return []


def sound_entries(document: Document, field: str, model: type[Entry]) -> list[tuple[int, Entry]]:
    """The entries of a list that are right by themselves, with their places, whatever is wrong elsewhere."""
    found = []
    entries = document.data.get(field)
    for k, entry in enumerate(entries if isinstance(entries, list) else []):
        try:
            found.append((k, model.model_validate(_file(entry))))
        except ValidationError:
            continue  # it is among the problems
    return found
