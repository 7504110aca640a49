"""What `rocking survey` and `rk.survey` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import (
    DEVIATIONS,
    IDENTITY,
    NEIGHBOURS,
    Around,
    Identity,
    InLanguage,
    MaybeUnderMotions,
    Motion,
    OfJoints,
    WithTable,
    plot_file,
    table_file,
)
from rocking_cli.ask.kinds import FILE, FOLDER, SITE, WHOLE, output
from rocking_cli.names import MAX_NEIGHBOURS

if TYPE_CHECKING:
    from rocking_cli.ask.inputs import SiteLike, StructureLike
    from rocking_cli.questions.survey.structure_table import StructureTable
else:  # heavy to import, and not checked by the model
    SiteLike = StructureLike = StructureTable = Any


class SurveyAsked(MaybeUnderMotions, OfJoints, Around, InLanguage, Identity, WithTable):
    """Rank many structures, one per table row, by vulnerability.

    A list of objects as their owners write it, with heights, widths, depths, weights, rooms and supports, is read by
    its words, in English or Italian. Under ground motions, each object then has the peaks at which 5 and 50 % of its
    neighbours overturn, and what to do.

    Otherwise the columns of the table are `mechanism`, `name` and fields of mechanisms, with dots for nested fields
    (loads.0.mass, ties.bar.stiffness); each row may have any mechanism. A column `file` names YAML files, whose fields
    the other columns replace. An empty cell means that the field is not given; give units in cells (800 mm) or in
    headings (width [mm]). Italian headings are read too. TABLE.csv may be - for standard input.

    Without ground motions, structures are ranked by their uplift acceleration. With ground motions, they are ranked by
    the share of neighbouring motions that overturn them and then by their largest peak rotation, both from the
    nonlinear model; a motion whose outcome is unknown, because a joint opens or slides that the model keeps closed,
    counts as overturning. Motions act as given, unless both polarities are requested, of which the worse governs. At a
    site, each is verified by its code and ranked by its ratio of capacity to demand; columns site, z and floor give a
    row another site file, and the height or the fields of its floor.

    A block that is alone, and less deep than wide, is ranked as it rocks about its depth, unless its column plane says
    width. Without a depth, only its width is examined.

    A row that cannot be used is reported with its line number and skipped, and the exit code is 5.

    \b
    Example:
      rocking survey inventory.csv --record "records/*.AT2" --out ranked.csv
      rocking survey parapets.csv --page parapets.html
      rocking survey parapets.csv --record "records/*.AT2" --polarity both --out ranked.csv
    """

    writes_each: ClassVar[bool] = True  # the table before the sheets, which take longer and may fail
    structures: str | Path | Mapping[str, Sequence[Any]] | StructureTable | Sequence[StructureLike] = option(
        "A table of structures, or a list of objects, as CSV, .xlsx, .xls or .ods, or its columns by their headings (a "
        "frame of pandas is one); or structures, or their YAML files.",
        where="input", default=..., typed="TABLE.csv",
    )  # fmt: skip
    site: SiteLike | None = option(
        "Site file, or its fields in Python: each structure is verified by its code and ranked by the ratio of "
        "capacity to demand. A column site replaces it for a row. `rocking new site` prints a template.",
        SITE,
    )
    neighbours: int | None = option(
        "Number of neighbouring motions to simulate as well, 0 for none.", WHOLE, ge=0, le=MAX_NEIGHBOURS,
        usual="200, or as many as take about a minute",
    )  # fmt: skip
    remedies: Literal["first", "all"] = option(
        "Remedies of objects of a list that may fall: the first that suffices, or all.", default="first"
    )
    in_space: bool = option(
        "Simulate objects of a list in three dimensions too (experimental), with motions along the weaker side.",
        default=False, typed="3d",
    )  # fmt: skip
    transverse: Motion | Sequence[Motion] | None = option(
        "Component of each motion across it, in three dimensions: a file or a pulse for each, in their order. "
        "Repeatable.",
        FILE, repeat=True,
    )  # fmt: skip
    top: int = option("Number of structures to show.", WHOLE, default=20, ge=1)
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    in_processes: bool = option(
        "Share the work of thousands of structures among processes; a script then needs "
        '`if __name__ == "__main__"`.',
        default=False, where="Python", on_terminal=True,  # a command is always such a script
    )  # fmt: skip
    out: Path | None = table_file("Write all rows in ranked order", ".parquet")
    page: Path | None = option(
        "Write a page with a plot, a map and all rows in a sortable table (.html), or of a list of objects a document "
        "by rooms, with pictures and remedies (.pdf and .docx need an extra package; a browser does for .pdf).",
        output(".html", ".pdf", ".docx"),
    )
    labels: Path | None = option("Write a card for each object of a list, to be cut out (.pdf).", output(".pdf"))
    map: Path | None = option(
        "Draw a map of the structures, by the columns longitude and latitude (.png, .svg or .pdf).",
        output(".png", ".svg", ".pdf"),
    )
    sheets: Path | None = option(
        "Write the calculation sheet of each structure into this folder; it needs a site.", FOLDER
    )
    sheet_format: Literal["html", "docx", "pdf"] = option(
        "Format of the sheets (docx and pdf need an extra package; a browser does for pdf).", default="html"
    )
    plot: Path | None = plot_file(
        "Plot the uplift acceleration against the frequency parameter, or draw the first objects of a list to scale"
    )
    idle = (
        Idle("without calculation sheets: give {sheets}", lambda asked: asked.sheets is None, ("sheet_format",)),
        Idle("without a page or calculation sheets: give {page} or {sheets}",
             lambda asked: asked.sheets is None and asked.page is None, IDENTITY),
        Idle("without ground motions", lambda asked: not asked.ground_motions,
             ("polarity", "opening", "remedies", "in_space", *NEIGHBOURS)),
        Idle("without {in_space}", lambda asked: not asked.in_space, ("transverse",)),
        Idle("without neighbours", lambda asked: asked.neighbours == 0, ("remedies", *DEVIATIONS)),
    )  # fmt: skip

    @property
    def has_document(self) -> bool:
        """Whether the page is the document on a list of objects."""
        return self.page is not None and self.page.suffix.lower() != ".html"

    @property
    def hands_over(self) -> bool:
        """Whether the document on a list of objects, or their cards, are requested."""
        return self.has_document or self.labels is not None
