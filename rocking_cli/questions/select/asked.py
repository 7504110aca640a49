"""What `rocking select` and `rk.select` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import Motion, Motions, OfRecords, SiteLike, plot_file
from rocking_cli.ask.kinds import BELOW_ONE, FOLDER, PERIOD, WHOLE, as_given, quantity, span

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from rocking_cli.questions.select.target_spectrum import TargetSpectrum
else:  # heavy to import, and not checked by the model
    ArrayLike = TargetSpectrum = Any

MEAN_LIMITS = (0.9, 1.3)  # NTC 2018, 3.2.3.6; EN 1998-1:2004, 3.2.3.1.2(4)c, has only the lower one
FACTOR_LIMITS = (0.2, 5.0)
SITE_SUFFIXES = (".yaml", ".yml")
RATIO = quantity("ratio", "", "NUMBER", "0.9", 1e-3, 1e3)
FACTOR = quantity("factor", "", "NUMBER", "0.5", 1e-6, 1e6)


class OfTarget(AskedModel):
    """A question about a target spectrum."""

    target: TargetSpectrum | SiteLike | tuple[ArrayLike, ArrayLike] = option(
        "Target spectrum, of the damping ratio given: one column of periods in s, and one of ordinates in g or in the "
        "unit of its heading; or a site file (.yaml), of which the code gives the spectrum of the ground.",
        Kind(as_given, "SPECTRUM.csv", words="file"), where="input option", default=...,
    )  # fmt: skip


class SelectAsked(OfRecords, OfTarget):
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Among the sets of records whose mean stays within the limits over the whole band, the one is selected whose mean is
    closest to the target. Each record is first scaled to match the target on average over the band; then one common
    factor is applied to all. The default limits are those of NTC 2018; EN 1998-1 requires the lower limit of 0.9 only,
    from 0.2 to 2 times the period of the structure.

    RECORD is a file or a quoted pattern. A record that cannot be used is reported and skipped, and the exit code is 5.
    If no set stays within the limits, the closest one is shown, with the periods at which it exceeds them.

    \b
    Example:
      rocking select "records/*.AT2" --target ec8.csv --band 0.2:4 --count 7
      rocking select "records/*.AT2" --target ec8.csv --band 0.2:2 --count 7 --factors 0.5:3 -o set --plot set.png
      rocking select "records/*.AT2" --target site.yaml --state SLC --band 0.2:2 --count 7
      rocking respond block.yaml --record "set/*.csv"
    """

    motions: Motion | Sequence[Motion] | Motions = option(
        "Records to select from, their files, or patterns such as `records/*.AT2`.",
        where="input", typed="RECORD...", default=...,
    )  # fmt: skip
    state: str | None = option(
        "Limit state of the site file whose spectrum is the target.", Kind(str, "STATE"), usual="SLV"
    )
    band: tuple[float, float] = option(
        "Period range over which the mean must match.", span(PERIOD, "0.2s:4s"), default=...
    )
    count: int = option("Number of records to select.", WHOLE, default=..., ge=1, le=1000)
    within: tuple[float, float] = option(
        "Lower and upper limit on the ratio of mean to target.", span(RATIO, "0.9:1.3", "LOW:HIGH"),
        default=MEAN_LIMITS, usual="0.9:1.3",
    )  # fmt: skip
    damping: float = option("Damping ratio of the spectrum.", BELOW_ONE, default=0.05)
    factors: tuple[float, float] = option(
        "Lower and upper limit on the scale factor of each record.", span(FACTOR, "0.5:3", "LOW:HIGH"),
        default=FACTOR_LIMITS, usual="0.2:5",
    )  # fmt: skip
    one_per: Literal["event", "station", "none"] = option(
        "Source from which at most one record is taken, if the files name it.", default="event"
    )
    same_factor: bool = option("Scale all records by the same factor.", default=False)
    seed: int = option("Seed of the random searches, if there are too many sets to try all.", WHOLE, default=0, ge=0)
    out: Path | None = option("Write the scaled records and a list of them, set.yaml, into this folder.", FOLDER)
    plot: Path | None = plot_file("Plot the spectra, their mean and the target")
    idle = (
        Idle("for a target without limit states: give a site file as {target}", lambda asked: not asked.of_site,
             ("state",)),
    )  # fmt: skip

    @property
    def of_site(self) -> bool:
        """Whether the target is that of a site."""
        given = self.target
        is_file = isinstance(given, str | Path) and Path(given).suffix.lower() in SITE_SUFFIXES
        return is_file or isinstance(given, Mapping)
