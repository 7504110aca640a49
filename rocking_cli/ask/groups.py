"""Fields that several questions share, in groups that are base classes of their models."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import create_model, model_validator

from rocking_cli.ask.asked import AskedModel, Kind, option
from rocking_cli.ask.kinds import (
    BELOW_ONE,
    FILE,
    LOCAL_FILE,
    NUMBER,
    PERIOD,
    PULSE_AMPLITUDE,
    SHAPE,
    SHARE,
    SITE,
    STANDARD_OUTPUT,
    TILT,
    WHOLE,
    output,
    word,
)
from rocking_cli.errors import InputError, named
from rocking_cli.names import MAX_NEIGHBOURS, OPENING, Language
from rocking_cli.processing.reading_options import CORRECTIONS, PREPARING, READING, SCALING, Option

if TYPE_CHECKING:  # the stub of verbs finds their types here
    from typing import Self

    from rocking_cli.ask.ground_motions import Motion as Motion
    from rocking_cli.ask.ground_motions import Motions as Motions
    from rocking_cli.ask.inputs import SiteLike as SiteLike
    from rocking_cli.ask.inputs import StructureLike as StructureLike
    from rocking_cli.excitation.records.record_units import Gain as Gain
    from rocking_cli.processing.oscillator import Floor as Floor
    from rocking_cli.processing.reading import Reading as RecordReading
    from rocking_cli.processing.steps import Step as Step
    from rocking_cli.structure import Structure
    from rocking_cli.studies.neighbours import Neighbourhood
    from rocking_cli.studies.neighbours import Release as Release
    from rocking_cli.studies.provenance import TitleBlock
else:  # heavy to import, and not checked by the model
    SiteLike = StructureLike = Motion = Motions = Release = Any

ModelName = Literal["nonlinear", "linear1", "linear2"]
EngineName = Literal["exact", "blocks", "auto"]
Polarity = Literal["1", "-1", "both", 1, -1]
OnePolarity = Literal["1", "-1", 1, -1]


def fields_of(options: dict[str, Option], *, once: bool = False) -> dict[str, Any]:
    """Return the fields of the options of records, which may be typed only `once`."""
    fields = {}
    for name, each in options.items():
        choices = each.metavar[1:-1].replace("|", " ") if "|" in each.metavar else ""
        kind = Kind(each.parse, each.metavar, words="file" if each.metavar == "FILE" else choices)
        field = option(each.help, only_once(kind) if once else kind, typed=each.key, repeat=once, type=each.type)
        fields[name] = (Any if each.metavar else bool | None, field)
    return fields


def only_once(kind: Kind) -> Kind:
    """Return the kind of a value that is refused if it is typed twice."""

    def read(value: Any) -> Any:
        if isinstance(value, tuple):
            if len(value) > 1:
                raise ValueError("is given twice: give it once; a `processing:` list of a study may repeat a step")
            (value,) = value
        return kind.read(value)

    return kind._replace(read=read)


class OfStructure(AskedModel):
    """A question about one structure."""

    structure: StructureLike = option(
        "The structure, or its YAML file.", where="input", default=..., on_terminal=LOCAL_FILE
    )


class OfStructures(AskedModel):
    """A question about one structure or several."""

    structures: StructureLike | Sequence[StructureLike] = option(
        "One structure or several, or their YAML files.", where="input", default=..., on_terminal=(LOCAL_FILE,)
    )


class OfJoints(AskedModel):
    """How far the joints of a structure may open."""

    opening: float = option(
        "Largest opening of a joint up to which a history holds, over D_cr.", SHARE, default=OPENING
    )


class OfRestitution(AskedModel):
    """A restitution in place of that of the structure."""

    restitution: float | None = option(
        "Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound.",
        NUMBER, gt=0, le=1, usual="that of the structure",
    )  # fmt: skip


def polarity(default: Polarity = "1", allowed: str = "1 -1 both") -> Any:
    """Declare the polarity of motions; the text of a question says what `both` means."""
    kind = word(*allowed.split())._replace(metavar="")
    return option("Polarity of the motion: 1 as given, -1 reversed.", kind, default=default)


Reading: type[AskedModel] = create_model("Reading", __base__=AskedModel, **fields_of(READING))
"""How records are read."""
Scaling: type[AskedModel] = create_model("Scaling", __base__=AskedModel, **fields_of(SCALING))
"""How motions are scaled."""
Correcting: type[AskedModel] = create_model("Correcting", __base__=AskedModel, **fields_of(CORRECTIONS, once=True))
"""How a record is corrected, in the order given."""
Reading.heading, Scaling.heading, Correcting.heading = "Reading of records", "Ground motions", "Correction of records"


class ReadRecordAsked(Reading, Correcting):
    """Read a recorded ground motion, and correct it."""

    path: Any = option(
        "A file in the format of a data centre, of any reader of the entry points `rocking.records`, or delimited "
        "text: a column of accelerations, or several, with or without the time. It may be compressed (gzip), or a file "
        "in a zip archive. `-` is standard input, which can be read once.",
        where="input in Python", default=..., type="str | Path",
    )  # fmt: skip


class ReadsRecords(Reading):
    """A question that reads records which are named elsewhere, as in a table."""

    @property
    def reading(self) -> RecordReading:
        """How they are read."""
        from rocking_cli.processing.reading import reading_of

        return reading_of(self.part(Reading))


class BothWays(AskedModel):
    """A question about motions that may be reversed."""

    heading: ClassVar[str] = "Ground motions"
    polarity: Polarity = polarity()

    @property
    def signs(self) -> tuple[int, ...]:
        """The polarities: 1 as given, -1 reversed."""
        return (1, -1) if self.polarity == "both" else (int(self.polarity),)


ANY_MOTIONS = "One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several."


class OfRecords(Reading):
    """A question about ground motions, which are read."""

    motions: Motion | Sequence[Motion] | Motions = option(ANY_MOTIONS, where="input", default=...)

    @cached_property
    def ground_motions(self) -> Motions:
        """The ground motions, together with how they are read, and scaled if they are."""
        return self.as_read(() if self.motions is None else self.motions)

    def as_read(self, motions: Motion | Sequence[Motion] | Motions) -> Motions:
        """Return motions together with how they are read and scaled."""
        from rocking_cli.ask.ground_motions import Motions

        return Motions.of(motions, self.in_order_given(PREPARING, SCALING))


class UnderMotions(OfRecords, Scaling, BothWays):
    """A question about ground motions, which are read, scaled and reversed."""


class MaybeUnderMotions(UnderMotions):
    """A question about ground motions, if any are given."""

    motions: Motion | Sequence[Motion] | Motions = option(
        "One motion or several, their files, or pulses as text; without any, no histories are followed.",
        where="input", default=(),
    )  # fmt: skip


class AtSite(AskedModel):
    """A question about a site."""

    site: SiteLike = option(
        "Site file, or its fields in Python: ground motion, confidence factor, floor. `rocking new site` prints a "
        "template.",
        SITE, where="input option", default=...,
    )  # fmt: skip


class ForRecords(AskedModel):
    """A question about records that belong to a limit state, or are motions of a floor."""

    state: str | None = option(
        "Limit state to which the records belong, such as SLC, if the site gives it.", Kind(str, "STATE"),
        usual="that of the verdict",
    )  # fmt: skip
    on_floor: bool = option("The motions are those of the floor of the site, and not of the ground.", default=False)


class SizedPulse(AskedModel):
    """A question about one pulse, by its amplitude, period and shape."""

    ag: float | None = option("Amplitude of the pulse; a text needs its unit: 0.6g, 5.9m/s2.", PULSE_AMPLITUDE)
    period: float | None = option("Period of the pulse, such as 0.8s.", PERIOD)
    shape: str = option(
        "Shape of the pulse: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any.",
        SHAPE, default="sine",
    )  # fmt: skip


class FromTilt(AskedModel):
    """A question about motions that may start from a tilt."""

    release: Release | float | str | None = option(
        "Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as 0.05rad; negative is "
        "anticlockwise.",
        TILT,
    )

    def ratio(self, structure: Structure) -> float | None:
        """Return the tilt as a fraction of that at which a structure overturns, see `Release.ratio`; None if none."""
        tilt: Any = self.release
        return tilt and float(tilt.ratio(structure))


class Excited(UnderMotions, FromTilt):
    """A question about a ground motion, a release, or both."""

    @model_validator(mode="after")
    def _moves(self) -> Self:
        """Refuse a question without an excitation."""
        if not self.ground_motions and self.release is None:
            raise InputError(f"no excitation is given: give {named('motions')}, or {named('release')}")
        return self


def neighbours(**more: Any) -> Any:
    """Declare the number of neighbours of a motion; `more` are further arguments of `option`."""
    text = "Number of neighbouring motions to simulate as well; 0 for none."
    return option(text, WHOLE, ge=0, le=MAX_NEIGHBOURS, **more)


class Around(AskedModel):
    """Neighbours of a motion: how many, and how far they are from it."""

    heading: ClassVar[str] = "Neighbouring motions"
    neighbours: int | None = neighbours(usual="200, or 20 with free blocks")
    amplitude_deviation: float = option(
        "Standard deviation of ln amplitude of the neighbours.", BELOW_ONE, default=0.04
    )
    slenderness_deviation: float | None = option(
        "Standard deviation of ln slenderness.", BELOW_ONE, usual="that of the file, or 10 %"
    )
    restitution_deviation: float | None = option(
        "Standard deviation of restitution.", BELOW_ONE, usual="that of the file, 0.03 of a given value, or 0.05"
    )

    def neighbourhood(self, usual: int) -> Neighbourhood:
        """Return how neighbours are drawn; `usual` is their number if none is given."""
        from rocking_cli.studies.neighbours import Neighbourhood

        count = usual if self.neighbours is None else self.neighbours
        return Neighbourhood(count, self.amplitude_deviation, self.restitution_deviation, self.slenderness_deviation)


DEVIATIONS = ("amplitude_deviation", "slenderness_deviation", "restitution_deviation")
"""Fields that have no effect without neighbours."""
NEIGHBOURS = ("neighbours", *DEVIATIONS)
"""Fields that have no effect without ground motions."""


class ByEngine(AskedModel):
    """Who simulates the motions."""

    engine: EngineName = option(
        "Engine: exact (one degree of freedom), blocks (free blocks), or auto (blocks if exact tells no outcome).",
        default="exact",
    )


class InLanguage(AskedModel):
    """A question that is answered in a language."""

    heading: ClassVar[str] = "Documents"
    language: Language | None = option("Language of the answer and of documents.", usual="that of the site, or en")


class Identity(AskedModel):
    """What the heading of a document names, and how the document was made."""

    heading: ClassVar[str] = "Documents"
    project: str | None = option("Project name, for the heading of the document.", Kind(str, "TEXT"))
    place: str | None = option("Location of the structure, for the heading.", Kind(str, "TEXT"))
    client: str | None = option("Client who ordered the document, for the heading.", Kind(str, "TEXT"))
    author: str | None = option("Author of the document, for the heading.", Kind(str, "TEXT"))
    logo: Path | None = option("Author's logo (.png, .jpg or .svg), for the heading.", FILE)
    origin: str | None = option(
        "What the document says of how it was made.", where="Python", usual="the command, or the call of Python"
    )

    def title(self, origin: str, language: str) -> TitleBlock:
        """Return the title block, with the date of today. Raises `InputError` if the logo cannot be used."""
        from rocking_cli.documents.figures import embedded
        from rocking_cli.studies.provenance import TitleBlock
        from rocking_cli.views.sheet.language import Language

        logo = None if self.logo is None else embedded(self.logo)
        today = Language(language).today()
        return TitleBlock(origin, today, self.project, self.place, self.client, self.author, logo)


IDENTITY = (*Identity.model_fields,)
"""Fields that have no effect where no document is written."""


class WithTable(AskedModel):
    """A table that is written; a question redeclares `out` with what it holds."""

    heading: ClassVar[str] = "Output"
    out: Path | None = option("Write the table.", output(".csv"))
    separator: Literal[",", ";", "tab"] | None = option("Separator of the CSV table.", usual="a comma")
    decimal: Literal[".", ","] | None = option("Decimal sign of the CSV table.", usual="a point")

    @model_validator(mode="after")
    def _signs_fit(self) -> Self:
        """Refuse signs of a table in text that have no effect, or are the same."""
        names = [named(name) for name in ("separator", "decimal") if getattr(self, name) is not None]
        writes = f"{' and '.join(names)} {'write' if names[1:] else 'writes'} a CSV table"
        if names and self.out is None:
            raise InputError(f"{writes}, and none is requested: give {named('out')}, a file that ends in .csv")
        if names and self.out is not None and self.out.suffix.lower() != ".csv" and str(self.out) != STANDARD_OUTPUT:
            raise InputError(f"{writes}, and {self.out.name} is not one: give a name that ends in .csv")
        if (self.separator or ",") == self.decimal:
            raise InputError(f"{named('decimal')} cannot be the separator too: give {named('separator')} ';'")
        return self


def table_file(text: str, *suffixes: str) -> Any:
    """Declare the table that a question writes, `out`, as text or .xlsx, or as a file of other `suffixes`."""
    suffixes = (".csv", *suffixes)
    return option(f"{text} ({', '.join(suffixes)} or .xlsx).  - is standard output.", output(*suffixes, ".xlsx"))


def plot_file(text: str, **more: Any) -> Any:
    """Declare the plot that a question writes, `plot`; `more` are further arguments of `option`."""
    return option(f"{text} (.png, .svg or .pdf).", output(".png", ".svg", ".pdf"), **more)
