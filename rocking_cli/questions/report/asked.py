"""What `rocking report` and `rk.report` are asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import (
    NEIGHBOURS,
    Around,
    ForRecords,
    Identity,
    InLanguage,
    MaybeUnderMotions,
    OfJoints,
    OfRestitution,
    OfStructure,
    Polarity,
    polarity,
)
from rocking_cli.ask.kinds import SITE, STANDARD_OUTPUT, WHOLE, output
from rocking_cli.names import MAX_NEIGHBOURS

if TYPE_CHECKING:
    from rocking_cli.ask.inputs import SiteLike
else:  # heavy to import, and not checked by the model
    SiteLike = Any


def _named_after(given: dict[str, Any], *, as_json: bool) -> Path | None:
    """Return the file of the command that names none: a report is read as a document, or as JSON."""
    file = str(given.get("structure", STANDARD_OUTPUT))
    return None if as_json else Path("rocking" if file == STANDARD_OUTPUT else Path(file).stem).with_suffix(".html")


OF_MOTIONS = ("explore", "polarity", "opening", "state", "on_floor", *NEIGHBOURS)


class ReportAsked(OfStructure, MaybeUnderMotions, ForRecords, OfRestitution, Around, OfJoints, InLanguage, Identity):
    """Write a report on a structure: one HTML file that opens in any browser and can be printed, a PDF, or .docx.

    The HTML file needs no network. A PDF (`-o report.pdf`) is printed by the browser of this computer, or made with the
    extra package `pdf`. The first page is for the owner: what was asked, the conclusion, the drawing, and what to do
    next. Then follow what the results rest on, the parameters, the response to each ground motion (with --polarity
    both, that of the worse polarity), the joints, the margin, the pulses and the overturning map, the error of the
    equivalent block, and the files and versions needed to reproduce the results. Without a ground motion, the report
    contains only the parts that need none.

    With --verify SITE.yaml, the report also contains the verification by the code of the site, step by step as in
    `rocking verify --sheet`; --state and --on-floor are those of `rocking verify`.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A record that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking report frame.yaml --record accel.csv -o report.html
      rocking report frame.yaml --record accel.csv --explore
      rocking report frame.yaml --record accel.csv -o report.pdf
      rocking report arch.yaml --record one.AT2 --record two.AT2 --target-pga 0.3
    """

    idle = (
        Idle("without ground motions", lambda asked: not asked.ground_motions, OF_MOTIONS),
        Idle(
            "but in a page of HTML",
            lambda asked: asked.out is None or asked.out.suffix.lower() != ".html",
            ("explore",),
        ),
        Idle("without a verification: give {verify}", lambda asked: asked.verify is None, ("state", "on_floor")),
    )
    out: Path | None = option(
        "Output file; .pdf needs a browser or an extra package, .docx an extra package.",
        output(".html", ".pdf", ".docx"), on_terminal=_named_after,
        usual="the name of FILE with the ending .html, in this folder; none with JSON, or in Python",
    )  # fmt: skip
    verify: SiteLike | None = option("Site file of a verification by code that becomes part of the report.", SITE)
    explore: bool = option("Put the page of `rocking explore` in the place of the animation, in HTML.", default=False)
    polarity: Polarity = polarity("both")
    neighbours: int = option(
        "Number of neighbours of each motion to simulate, which show how close the result is.", WHOLE, default=200,
        ge=1, le=MAX_NEIGHBOURS,
    )  # fmt: skip
