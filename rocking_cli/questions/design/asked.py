"""What `rocking design` and `rk.design` are asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import (
    NEIGHBOURS,
    Around,
    MaybeUnderMotions,
    OfJoints,
    OfStructure,
    SiteLike,
    WithTable,
    plot_file,
    table_file,
)
from rocking_cli.ask.kinds import SITE, WHOLE
from rocking_cli.names import MAX_NEIGHBOURS
from rocking_cli.text import cut

if TYPE_CHECKING:
    from rocking_cli.questions.design.study import Aim, Span
else:  # heavy to import, and not checked by the model
    Aim = Span = Any


def _span(value: Any) -> Any:
    from rocking_cli.questions.design.study import Span

    match value:
        case Span():
            return value
        case str():
            return Span.parse(value)
        case (str() as field, low, high):
            return Span(field, str(low), str(high))
    what = f"must be FIELD=LOW:HIGH or (field, low, high), got {cut(repr(value))}"
    raise ValueError(f"{what}: give a range such as width=0.2m:0.8m")


def _aim(value: Any) -> Any:
    from rocking_cli.questions.design.study import Aim

    return value if isinstance(value, Aim) else Aim.parse(str(value))


SPAN = Kind(_span, "FIELD=LOW:HIGH")
VARY = (
    "Field to vary and its range, without a unit in that of the field: width=0.2m:0.8m, ties.bar.prestress=0:50kN, "
    "loads.0.mass=1t:9t."
)


class Sought(AskedModel):
    """What is sought: the field that varies, and the requirement."""

    vary: Span | str | tuple[str, float | str, float | str] = option(
        VARY, SPAN, where="input option", default=...,
    )  # fmt: skip
    until: Aim | str = option(
        "Requirement: one of lambda, phi_cr, p, peak_ratio, peak_displacement, drift, tie_force, overturned, ratio, "
        "or a number of a code (alpha0, zeta_SLD, zeta_SLV, zeta_SLC, zeta_damage, zeta_linear or zeta_nonlinear); one "
        "of <, <=, > or >=; and a number, or the word required for what the code of the site requires of the structure "
        "after the change.",
        Kind(_aim, "'METRIC OP NUMBER'"), where="input option", default=...,
    )  # fmt: skip


class DesignAsked(OfStructure, Sought, MaybeUnderMotions, Around, OfJoints, WithTable):
    """Find the least thickness, width or tie force, or the largest load, for which a requirement holds.

    The metrics are lambda, phi_cr and p of `rocking equiv`: of the two directions, the smaller phi_cr and lambda and
    the larger p. With a ground motion, the metric may also be the share of its neighbours that overturn (overturned),
    or the median over them of the peak rotation over the critical rotation (peak_ratio), of the peak displacement of
    the control point (peak_displacement), of that of the top over its height (drift), or of the largest force of a tie
    (tie_force); an unknown outcome, because a joint opens or slides that the model keeps closed, counts as overturning.
    With several motions, or with both polarities, the worst case governs. With a site, ratio is the ratio of capacity
    to demand by the code of the site (zeta_E by the Italian code). alpha0 and, with a site, the zeta_E of a limit
    state or of a method are those of `rocking verify` by the Italian code. Of each, the smaller of both directions
    governs.

    A block that is alone, and less deep than wide, is judged as it rocks about its depth, unless it has plane: width.

    If the field varies the force of a tie, the answer names bars of steel that give it.

    First, the range is scanned at some points. If the metric is monotonic over it, the single threshold value is
    computed accurately; otherwise every interval in which the requirement is met is listed. "Met nowhere" and "met
    everywhere" are valid results.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking design wall.yaml --vary width=200mm:800mm --until "lambda >= 0.15"
      rocking design facade.yaml --vary ties.bar.prestress=0:100kN --until "lambda > 0.2" --plot tie.png
      rocking design block.yaml --vary width=0.3m:1m --until "overturned < 5%" --record accel.csv
    """

    points: int = option("Number of values in the first scan.", WHOLE, default=41, ge=2, le=10_000)
    neighbours: int = option(
        "Number of neighbours of each motion to simulate.", WHOLE, default=200, ge=1, le=MAX_NEIGHBOURS
    )
    site: SiteLike | None = option(
        "Site file, or its fields in Python: ground motion, confidence factor, floor. `rocking new site` prints a "
        "template.",
        SITE,
    )  # fmt: skip
    out: Path | None = table_file("Write the scanned values and the metric at each", ".parquet")
    plot: Path | None = plot_file("Plot the metric against the field")
    idle = (
        Idle(
            "on a metric that does not depend on a ground motion",
            lambda asked: not asked.until.metric.shaken,
            ("polarity", "opening", *NEIGHBOURS),
        ),
    )
