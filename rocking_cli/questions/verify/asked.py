"""What `rocking verify` and `rk.verify` are asked."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import model_validator

from rocking_cli.ask.asked import Idle, Kind, option
from rocking_cli.ask.groups import (
    IDENTITY,
    AtSite,
    ForRecords,
    Identity,
    InLanguage,
    MaybeUnderMotions,
    OfJoints,
    OfStructure,
    plot_file,
)
from rocking_cli.ask.kinds import FILE, number, output
from rocking_cli.errors import InputError, named

if TYPE_CHECKING:
    from typing import Self

    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.ask.inputs import StructureLike
else:  # heavy to import, and not checked by the model
    StructureLike = Any


def _point(value: Any) -> Any:
    """Return a point x, y or x, y, body of a text x,y or x,y,BODY."""
    if not isinstance(value, str):
        return value
    x, _, rest = value.partition(",")
    y, _, body = rest.partition(",")
    try:
        return number(x), number(y), body.strip() or None
    except ValueError:
        raise ValueError(f"{value!r} is not a valid point: give x,y in m, or x,y,BODY, such as 0.3,8.0") from None


def _sets(value: Any) -> dict[str, Any]:
    """Return the set of records of each state, of a mapping or of texts STATE=PLACE."""
    if isinstance(value, Mapping):
        return dict(value)
    sets: dict[str, Any] = {}
    for text in value:
        state, _, place = text.partition("=")
        if not place:
            raise ValueError(f"{text!r} is not a set of a limit state: give STATE=PLACE, such as SLV=slv/set.yaml")
        if state in sets:
            raise ValueError(f"has {state} twice: give all its records as one set")
        sets[state] = Path(place)
    return sets


class UnderSets(MaybeUnderMotions, ForRecords):
    """A question about the records of limit states."""

    heading: ClassVar[str] = "Options"
    sets: Mapping[str, Any] | None = option(
        "Motions of a limit state of its own: a folder or list that `rocking select` wrote, a file, or a pattern.  "
        "Repeatable. In Python a mapping with the motions of each state.",
        Kind(_sets, "STATE=PLACE"), typed="set", repeat=True,
    )  # fmt: skip

    @cached_property
    def ground_motions(self) -> Motions:
        """All ground motions, together with how they are read and scaled."""
        from rocking_cli.ask.ground_motions import each_of

        return self.as_read([one for each in (self.sets or {}).values() for one in each_of(each)] or self.motions)

    @property
    def requested(self) -> dict[str | None, Motions]:
        """The set of motions of each limit state, None for the default one; empty without motions."""
        if self.sets:
            return {state: self.as_read(each) for state, each in self.sets.items()}
        return {self.state: self.ground_motions} if self.ground_motions else {}

    @model_validator(mode="after")
    def _one_set_each(self) -> Self:
        """Refuse sets that are empty, or beside other motions."""
        from rocking_cli.ask.ground_motions import each_of

        if self.sets is None:
            return self
        for name in ("motions", "state"):
            if self.has(name):
                raise InputError(f"{named(name)} cannot be combined with {named('sets')}: give sets alone")
        if empty := [key for key, each in self.sets.items() if not each_of(each)] or ["any state"] * (not self.sets):
            raise InputError(f"{named('sets')} has no ground motion for {empty[0]}")
        return self


class VerifyAsked(OfStructure, AtSite, UnderSets, OfJoints, InLanguage, Identity):
    """Verify a rocking mechanism by the code that the site file names: the Italian, NTC 2018 and Circolare 7/2019.

    The command compares the damage, linear and nonlinear methods for each direction, on the exact capacity curve and on
    its straight-line approximation: the capacity by each method, which one governs, and why they differ. The terminal
    shows what is needed to judge the verdict; --all shows all, every number with its clause. The exit code is 0 whether
    the structure passes or fails.

    With --record (repeatable), the dynamic method is added: time histories on the capacity curve, with and without the
    confidence factor; with --polarity both, the worse of the two polarities governs. A record whose outcome is unknown,
    because a joint opens or slides that the model keeps closed or a tie yields, does not pass. A set of records belongs
    to one limit state, given by --state, and is checked against it alone. For several limit states, give each its own
    set, as --set SLV=PLACE --set SLC=PLACE. If the site has a floor, ground motions are carried to it, unless
    --on-floor states that they are motions of the floor. If the mean spectrum of the records is below that of the site
    at the period that decides, this is a condition; the sheet draws both. With --strengthened, a second structure is
    verified too, and both are compared side by side. --sheet writes the calculation sheet for submission: every formula
    with its numbers, in English or Italian.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking new block > block.yaml
      rocking new site > site.yaml
      rocking verify block.yaml --site site.yaml
      rocking verify block.yaml --site site.yaml --sheet block.html --language it
      rocking verify block.yaml --site site.yaml --control 0.35,2.8
      rocking verify block.yaml --strengthened tied.yaml --site site.yaml
      rocking verify block.yaml --site site.yaml --record "records/*.AT2" --target-pga 0.24
      rocking verify block.yaml --site site.yaml --set SLV=slv --set SLC=slc
    """

    idle = (
        Idle("without ground motions", lambda asked: not asked.ground_motions,
             ("polarity", "state", "on_floor", "opening")),
        Idle("without a calculation sheet: give {sheet}", lambda asked: asked.sheet is None, IDENTITY),
    )  # fmt: skip
    strengthened: StructureLike | None = option(
        "The strengthened structure, to be verified too and compared with FILE.", FILE
    )
    control: tuple[float, float] | tuple[float, float, str | None] | None = option(
        "Control point, in m, and the body it is on.", Kind(_point, "X,Y[,BODY]"),
        usual="centroid of the moving weights",
    )  # fmt: skip
    in_full: bool = option(
        "Show also the ground, both curves, every clause and the remarks in full.",
        default=True, where="Python", on_terminal=False,
    )  # fmt: skip
    sheet: Path | None = option(
        "Write the calculation sheet (.html; .docx and .pdf need an extra package; a browser does for .pdf).",
        output(".html", ".docx", ".pdf"),
    )
    plot: Path | None = plot_file("Plot the capacity curves")
