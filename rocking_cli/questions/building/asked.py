"""What `rocking building` and `rk.building` are asked."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from pydantic import model_validator

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import IDENTITY, Identity, InLanguage, WithTable, plot_file, table_file
from rocking_cli.ask.kinds import FILE, FOLDER, SITE, WHOLE, output
from rocking_cli.errors import InputError, named
from rocking_cli.questions.verify.asked import UnderSets

if TYPE_CHECKING:
    from rocking_cli.ask.inputs import SiteLike
else:  # heavy to import, and not checked by the model
    SiteLike = Any

MAX_SHAKEN = 100


class BuildingAsked(UnderSets, InLanguage, Identity, WithTable):
    """Verify all out-of-plane mechanisms of a building that one file describes, and name the one that governs.

    The file lists levels, walls, floors, roof, ties, gables, parapets, bell gables and corners (`rocking new building`
    prints one). Each wall overturns about each level, and about the weakest height between; it bends between the levels
    that hold it, and as a horizontal arch if its thrust is resisted. What stands on it turns about its foot, and a
    corner along its diagonal. The weakest heights and cracks are searched. Each mechanism is verified by the code of
    the site, as `rocking verify` does, at the height of its hinge.

    With ground motions, the worst mechanisms are verified by time histories too, as by `rocking verify`. With
    --strengthened, both buildings are compared. With --design, the least bars of the ties of a level are found with
    which every mechanism satisfies the code. --structures writes each mechanism as a structure file that every command
    takes, with the site at its height.

    A table of walls (.csv, .xlsx) with columns name, storey, thickness, height, length and, where a wall bears a floor,
    bears and span, is read as a building; `rocking new building --walls` makes a file of it.

    \b
    Example:
      rocking new building > house.yaml
      rocking building house.yaml --site site.yaml
      rocking building house.yaml --site site.yaml --sheet house.pdf --structures mechanisms
      rocking building house.yaml --strengthened tied.yaml --site site.yaml
      rocking building house.yaml --site site.yaml --design 2
      rocking building house.yaml --site site.yaml --record "records/*.AT2"
      rocking new building --walls walls.csv > house.yaml
    """

    writes_each: ClassVar[bool] = True  # the folder of structures last, which the next run refuses if it is there
    building: str | Path | Mapping[str, Any] = option(
        "The file of a building, or of a table of its walls; in Python its fields too.", FILE, where="input",
        default=..., typed="BUILDING.yaml",
    )  # fmt: skip
    site: SiteLike | None = option(
        "Site file, or its fields in Python; by default the `site` of the building. `rocking new site` prints a "
        "template.",
        SITE,
    )
    strengthened: str | Path | Mapping[str, Any] | None = option(
        "The strengthened structure, to be verified too and compared with FILE.", FILE
    )
    worst: int = option("Number of mechanisms to verify by time histories.", WHOLE, default=3, ge=1, le=MAX_SHAKEN)
    design: int | None = option("Level whose ties are designed: the least bars that satisfy the code.", WHOLE, ge=1)
    structures: Path | None = option(
        "Write each mechanism into this folder as a structure file, with its site, and a table of all.", FOLDER
    )
    sheet: Path | None = option(
        "Write the calculation sheet (.html; .docx and .pdf need an extra package; a browser does for .pdf).",
        output(".html", ".docx", ".pdf"),
    )
    appendix: bool = option("Add the workings of each mechanism that counts to the sheet.", default=False)
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    in_processes: bool = option(
        'Share the walls among processes; a script then needs `if __name__ == "__main__"`.',
        default=False, where="Python", on_terminal=True,  # a command is always such a script
    )  # fmt: skip
    out: Path | None = table_file("Write all mechanisms, the worst first.")
    plot: Path | None = plot_file("Draw the building with its mechanisms")
    idle = (
        Idle("without ground motions", lambda asked: not asked.ground_motions, ("polarity", "state", "on_floor",
                                                                                "worst")),
        Idle("without a sheet: give {sheet}", lambda asked: asked.sheet is None, ("appendix", *IDENTITY)),
    )  # fmt: skip

    @model_validator(mode="after")
    def _one_at_a_time(self) -> Self:
        """Refuse ties that are designed in two buildings."""
        if self.strengthened is not None and self.design is not None:
            raise InputError(f"{named('design')} changes one building: leave out {named('strengthened')}")
        return self
