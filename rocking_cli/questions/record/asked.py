"""What `rocking record`, `rk.record` and `rk.response_spectrum` are asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import (
    ANY_MOTIONS,
    Correcting,
    Motion,
    Motions,
    StructureLike,
    UnderMotions,
    plot_file,
)
from rocking_cli.ask.kinds import BELOW_ONE, FILE, NUMBER, PERIOD, as_given, output, span

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
else:  # heavy to import, and not checked by the model
    ArrayLike = Any

DAMPING = 0.05
TABLE = output(".csv")


def _out(value: Any) -> Any:
    return Path(value) if isinstance(value, str) else value


def _spectrum(value: Any) -> Any:
    return value if isinstance(value, bool) else TABLE.read(value)


class RecordAsked(UnderMotions, Correcting):
    r"""Inspect records: what was read, and how strong it is (peaks, Arias intensity, durations).

    The measures are those of the scaled record, exact for straight lines between its samples. Drifts, offsets, clipped
    peaks, coarse sampling and implausible units are reported as warnings, with the number that reveals them. With
    several files, or both polarities, each record is a row of a table; as JSON, each is one object on a line of its
    own. A file that cannot be used is reported and skipped, and the exit code is 5.

    FILE may be delimited text or in the format of a data centre, also in a gzip file or zip archive; - is standard
    input. If there are several columns, channels or files in an archive, choose a channel; without it they are listed.
    Corrections are made in the order in which they are given.

    \b
    Example:
      rocking record accel.csv --plot record.png
      rocking record north.AT2 east.AT2 --target-pga 0.4
      rocking record station.V2 --channel 2 --highpass .1 --baseline linear --out prepared.csv
      rocking record table.csv --channel "acc x" --units g
      rocking record accel.csv --fit-pulse --plot pulse.png
      rocking record "north.AT2" "east.AT2" --spectrum spectra.csv --plot spectra.png
      rocking record accel.csv --measures "Sa(1.0), CAV, PGV/v_imp" --structure frame.yaml
    """

    writes_each: ClassVar[bool] = True
    motions: Motion | Sequence[Motion] | Motions = option(ANY_MOTIONS, where="input", default=..., typed="FILE...")
    structure: StructureLike | None = option(
        "Structure, or its file, to check the sampling interval and for relative measures.", FILE
    )
    fit_pulse: bool = option(
        "Fit a sine, a Ricker and a near-fault pulse to each record; the plot shows the best.", default=False
    )
    measures: str | Sequence[str] | None = option(
        "Intensity measures to compute as well, or all; `rocking measures` lists them.", Kind(as_given, "M,M,...")
    )
    spectrum: Path | bool = option(
        "Write the response spectrum of each record; the plot draws it and JSON includes it. In Python also True, for "
        "the frame of spectra alone.  - is standard output.",
        Kind(_spectrum, "FILE.csv", words="output"), default=False,
    )  # fmt: skip
    period: tuple[float, float] | None = option(
        "Shortest and longest period of the spectrum.", span(PERIOD, "0.1s:4s", "LOW:HIGH"), usual="0.02:10"
    )
    damping: float = option("Damping ratio of the spectrum.", BELOW_ONE, default=DAMPING)
    out: Any = option(
        "Write each record as it is corrected and scaled, and what was done to it: FILE.csv, or a folder (created if "
        "missing) that receives NAME.csv.  - is standard output.",
        Kind(_out, "PLACE", words="output"),
    )  # fmt: skip
    plot: Path | None = plot_file("Plot one record, or the spectra")
    idle = (Idle("without {spectrum}", lambda asked: asked.spectrum is False, ("period", "damping")),)


class ResponseSpectrumAsked(AskedModel):
    """Compute the response spectrum of a ground motion."""

    motions: Motion = option("The ground motion, its file, or a pulse as text.", where="input", default=...)
    periods: ArrayLike | None = option(
        "Undamped periods of the oscillators [s].", where="input", usual="200 from 0.02 to 10 s at equal ratios"
    )
    damping: float = option("Damping ratio of the oscillators.", BELOW_ONE, default=DAMPING)
    scale: float = option("Scale factor on the motion.", NUMBER, default=1.0)
