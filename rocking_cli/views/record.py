"""View of records and their intensity, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking_cli.views import processing
from rocking_cli.views import response_spectrum as spectra
from rocking_cli.views.view import ABSENT, Table, number

if TYPE_CHECKING:
    from rocking_cli.excitation.base import Doubt, GroundMotion
    from rocking_cli.excitation.measures import Measures
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.processing.intensity import Measure
    from rocking_cli.processing.oscillator import ResponseSpectrum

HEADING = 14  # characters of a line of a record's name above its column, where blanks in it allow
LEFT = 26  # characters that labels and units take of a table
BESIDE = 3  # blanks between columns


class Examined(NamedTuple):
    """A record as read, its scale factor, and measures, doubts, p dt and pulses of the scaled record.

    `label` is its name, with "reversed" for the second of both polarities. `p_dt` is the frequency parameter of a
    structure times the sampling interval. `asked` are measures requested by name, `spectrum` is its response spectrum.
    """

    file: str
    label: str
    motion: GroundMotion
    factor: float
    measures: Measures
    doubts: list[Doubt]
    p_dt: float | None
    pulses: list[PulseFit]
    asked: Mapping[Measure, float] = {}
    spectrum: ResponseSpectrum | None = None


def data(record: Examined) -> dict[str, Any]:
    """Return a record as plain data."""
    motion, measures = record.motion, record.measures
    found: dict[str, Any] = {
        "file": record.file,
        "name": motion.name,
        "format": motion.format,
        "channel": _channel(record),
        "unit": motion.unit,
        "origin": motion.origin._asdict(),
        "npts": motion.npts,
        "dt": motion.dt,
        "duration": motion.duration,
        "factor": record.factor,
        **processing.data(motion),
        "pga": measures.pga,
        "pgv": measures.pgv,
        "pgd": measures.pgd,
        "arias_intensity": measures.arias,
        "significant_duration": measures.significant_duration,
        "t_5": measures.t_5,
        "t_95": measures.t_95,
        "mean_acceleration": measures.mean,
        "final_velocity": measures.final_velocity,
        "final_displacement": measures.final_displacement,
        "p_dt": record.p_dt,
        "warnings": [doubt._asdict() for doubt in record.doubts],
    }
    if record.pulses:
        from rocking_cli.views.pulse_fits import fits_data

        found["pulses"] = fits_data(record.pulses)
    if record.asked:
        found["measures"] = {str(measure): value for measure, value in record.asked.items()}
    if record.spectrum is not None:
        found["spectrum"] = spectra.data(record.spectrum)
    return found


def parts(records: Sequence[Examined], width: int | None) -> Iterator[Table | str]:
    """Yield tables with a column for each record, as many as the width requires, then the pulses of each record.

    Without a width there is one table. If a table has room for one record only, the name is its title.
    """
    names = [_folded(record.label) for record in records]
    rows = _rows(records)
    fitting = len(records)
    if width is not None:
        widest = max(HEADING, *(len(line) for name in names for line in name.split("\n")))
        fitting = max((width - LEFT) // (widest + BESIDE), 1)
    for start in range(0, len(records), fitting):
        part = slice(start, start + fitting)
        cells = [[row[0], *row[1:-1][part], row[-1]] for row in rows]
        title, headings = ("", names[part])
        if len(headings) == 1:
            title, headings = records[start].label, ["value"]
        yield Table(title, ["", *headings, "unit"], cells, numbers=range(1, len(headings) + 1))
    for record in records:
        if record.pulses:
            from rocking_cli.views import pulse_fits

            yield from pulse_fits.parts(record.label, record.pulses)
    yield from (spectra.peaks(each.label, each.spectrum) for each in records if each.spectrum is not None)


def _rows(records: Sequence[Examined]) -> list[list[str]]:
    """Return the rows of the table: a label, a cell for each record, a unit."""
    rows = [
        ("format", [_folded(r.motion.format) for r in records], ""),
        ("channel", [_channel(r) or ABSENT for r in records], ""),
        ("unit in the file", [r.motion.unit for r in records], ""),
        ("earthquake", [_folded(r.motion.origin.event or ABSENT) for r in records], ""),
        ("station", [_folded(r.motion.origin.station or ABSENT) for r in records], ""),
        ("magnitude", [number(r.motion.origin.magnitude) for r in records], ""),
        ("distance", [number(r.motion.origin.distance, 4) for r in records], "km"),
        ("points", [str(r.motion.npts) for r in records], ""),
        ("dt", [number(r.motion.dt) for r in records], "s"),
        ("duration", [number(r.motion.duration) for r in records], "s"),
        ("processed", ["\n".join(r.motion.processing) or ABSENT for r in records], ""),
        ("scaled by", [number(r.factor) for r in records], ""),
        ("PGA", [number(r.measures.pga, 4) for r in records], "g"),
        ("PGV", [number(r.measures.pgv, 4) for r in records], "m/s"),
        ("PGD", [number(r.measures.pgd, 4) for r in records], "m"),
        ("Arias intensity", [number(r.measures.arias, 4) for r in records], "m/s"),
        ("5-95 % duration", [number(r.measures.significant_duration, 4) for r in records], "s"),
        ("from", [number(r.measures.t_5, 4) for r in records], "s"),
        ("to", [number(r.measures.t_95, 4) for r in records], "s"),
        ("mean acceleration", [number(r.measures.mean, 2) for r in records], "g"),
        ("p dt", [number(r.p_dt, 2) for r in records], ""),
        *((str(each), [number(r.asked[each], 4) for r in records], each.unit) for each in records[0].asked),
    ]
    silent = {"channel": ABSENT, "processed": ABSENT, "scaled by": "1", "p dt": ABSENT}  # says nothing if all are this
    silent |= dict.fromkeys(("earthquake", "station", "magnitude", "distance"), ABSENT)
    return [
        [label, *cells, unit]
        for label, cells, unit in rows
        if label not in silent or any(cell != silent[label] for cell in cells)
    ]


def _channel(record: Examined) -> str | None:
    """Return the channel of a record from a file with several; readers put it into the name of the motion."""
    return record.motion.name.partition(f"{Path(record.file).name} channel ")[2] or None


def _folded(name: str) -> str:
    """Break a name at blanks into lines of a column's width."""
    return "\n".join(wrap(name, HEADING, break_long_words=False, break_on_hyphens=False))
