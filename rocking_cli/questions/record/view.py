"""View of records and their intensity, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulse_fit import CRITERIA, PulseFit
from rocking_cli.short_repr import short_repr
from rocking_cli.text import in_short
from rocking_cli.views.column import Column, data_of, of, only_shown, rounded, table_across, table_of
from rocking_cli.views.response import fit_data, pulse_data
from rocking_cli.views.view import ABSENT, ASIDE, Aside, Table, View, number, processing_data

if TYPE_CHECKING:
    from rocking_cli.excitation.base import Doubt, GroundMotion
    from rocking_cli.excitation.measures import Measures
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.intensity import Measure
    from rocking_cli.processing.oscillator import ResponseSpectrum

MAX_HEADING_LINE = 9  # characters of a line of a heading above a quantity
IN_WORDS = {"dt", "duration", "PGA", "PGV"}
"""Headings of the quantities of a single record that a sentence has."""


@short_repr
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


def _channel(record: Examined) -> str | None:
    """Return the channel of a record from a file with several; readers put it into the name of the motion."""
    return record.motion.name.partition(f"{Path(record.file).name} channel ")[2] or None


AS_READ: tuple[Column[Examined], ...] = (
    Column("file", of("file")),
    Column("name", of("motion.name")),
    Column("format", of("motion.format"), head="format", rank=ASIDE),
    Column("channel", _channel, head="channel"),
    Column("unit", of("motion.source_unit"), head="unit in the file", rank=ASIDE),
    Column("origin", lambda record: record.motion.origin._asdict()),
    only_shown("earthquake", lambda record: record.motion.origin.event or None, rank=4),
    only_shown("station", lambda record: record.motion.origin.station or None, rank=4),
    only_shown("magnitude", of("motion.origin.magnitude"), number, rank=3),
    only_shown("distance", of("motion.origin.distance"), unit="km", rank=3),
    Column("npts", of("motion.npts"), head="points", rank=ASIDE),
    Column("dt", of("motion.dt"), "s", "dt", number, rank=3),
    Column("duration", of("motion.duration"), "s", "duration", number, rank=3),
    only_shown("processed", lambda record: ", ".join(record.motion.processing) or None, rank=4),
    only_shown("prepared from", lambda record: record.motion.prepared_from or None, rank=4),
    Column("factor", of("factor"), head="scaled by", form=number),
)
MEASURED: tuple[Column[Examined], ...] = (
    Column("pga_g", of("measures.pga_g"), "g", "PGA"),
    Column("pgv", of("measures.pgv"), "m/s", "PGV", rank=1),
    Column("pgd", of("measures.pgd"), "m", "PGD", rank=2),
    Column("arias_intensity", of("measures.arias"), "m/s", "Arias intensity", rank=2),
    Column("significant_duration", of("measures.significant_duration"), "s", "5-95 % duration", rank=2),
    Column("t_5", of("measures.t_5"), "s", "5 % of Arias at", rank=ASIDE),
    Column("t_95", of("measures.t_95"), "s", "95 % of Arias at", rank=ASIDE),
    Column("mean_acceleration", of("measures.mean"), "g", "mean acceleration", rounded(2), rank=ASIDE),
    Column("final_velocity", of("measures.final_velocity"), "m/s"),
    Column("final_displacement", of("measures.final_displacement"), "m"),
    Column("p_dt", of("p_dt"), head="p dt", form=rounded(2)),
)


def data(record: Examined) -> dict[str, Any]:
    """Return a record as plain data."""
    entry = data_of(AS_READ, record) | processing_data(record.motion) | data_of(MEASURED, record)
    entry["warnings"] = [doubt._asdict() for doubt in record.doubts]
    if record.pulses:
        entry["pulses"] = fits_data(record.pulses)
    if record.asked:
        entry["measures"] = {str(measure): value for measure, value in record.asked.items()}
    if record.spectrum is not None:
        entry["spectrum"] = spectrum_data(record.spectrum)
    return entry


def parts(records: Sequence[Examined]) -> Iterator[Table | str]:
    """Yield how strong the records are, and whether they have defects, a table, and the pulses of each record.

    A record alone is a column of its table; of several, each is a row, without line breaks.
    """
    yield in_words(records)
    columns = _columns(records)
    if len(records) == 1:
        yield table_across(records[0].label, columns, ["value"], records)
    else:
        yield _long(records, columns)
    for record in records:
        if record.pulses:
            yield from _pulses(record.label, record.pulses)
    yield from (peaks(each.label, each.spectrum) for each in records if each.spectrum is not None)


def in_words(records: Sequence[Examined]) -> str:
    """Return in words how strong a record is, or how many records there are, and which have possible defects."""
    first, doubtful = records[0], [each.label for each in records if each.doubts]
    least, most = (f"{end(each.measures.pga_g for each in records):.3g}" for end in (min, max))
    words = f"{len(records)} records, PGA {f'{least} to ' * (least != most)}{most} g"
    if len(records) == 1:
        strong = f"PGA {first.measures.pga_g:.3g} g, PGV {first.measures.pgv:.3g} m/s"
        words = f"{first.label}: {strong}; {first.motion.duration:.4g} s at dt = {first.motion.dt:.4g} s"
    whose = f" of {in_short(doubtful)}" if len(records) > 1 else ""
    return f"{words}. " + (f"Possible defects{whose}: see the warnings." if doubtful else "No defects found.")


def _long(records: Sequence[Examined], columns: Sequence[Column[Examined]]) -> Table:
    """Return a table with a row for each record, with units in its headings."""
    narrow = []
    for each in columns:
        lines = wrap(each.head or "", MAX_HEADING_LINE, break_long_words=False, break_on_hyphens=False)
        narrow.append(replace(each, head="\n".join([*lines, *[f"[{each.unit}]"] * bool(each.unit)])))
    return table_of("", [only_shown("record", of("label"), text=True), *narrow], records)


def _columns(records: Sequence[Examined]) -> list[Column[Examined]]:
    """Return the columns that tables show: those with information on any record, and the requested measures."""
    # Rows in which all records have these values are left out.
    silent = {"channel": ABSENT, "processed": ABSENT, "scaled by": "1", "p dt": ABSENT}
    silent |= dict.fromkeys(("prepared from", "earthquake", "station", "magnitude", "distance"), ABSENT)
    columns = [
        column
        for column in (*AS_READ, *MEASURED)
        if column.head is not None
        and (column.head not in silent or any(column.cell(each) != silent[column.head] for each in records))
    ]
    if len(records) == 1:  # the first sentence has their values
        columns = [replace(each, rank=ASIDE) if each.head in IN_WORDS else each for each in columns]
    return columns + [only_shown(str(each), partial(_asked, each), unit=each.unit) for each in records[0].asked]


def _asked(measure: Measure, record: Examined) -> float:
    return record.asked[measure]


PULSES: tuple[Column[PulseFit], ...] = (
    only_shown("energy captured", lambda fit: 100 * fit.captured, "{:.1f}".format, "%"),
    only_shown("a_p", lambda fit: fit.pulse.amplitude / STANDARD_GRAVITY, rounded(4), "g"),
    only_shown("T_p", of("pulse.period"), rounded(4), "s"),
    only_shown("start", of("start"), rounded(4), "s"),
    only_shown("centre", of("centre"), rounded(4), "s"),
    only_shown("sign", of("sign"), "{:+d}".format),
    only_shown("phase", lambda fit: pulse_data(fit.pulse).get("phase"), rounded(4), "deg"),
    only_shown("cycles", lambda fit: pulse_data(fit.pulse).get("cycles"), rounded(4)),
)


def fits_data(fits: Sequence[PulseFit]) -> dict[str, Any]:
    """Return fitted pulses as plain data, by criterion and shape."""
    return {
        criterion: {fit.pulse.name: fit_data(fit) for fit in fits if fit.criterion == criterion}
        for criterion in CRITERIA
    }


def _pulses(name: str, fits: Sequence[PulseFit]) -> Iterator[Table | str]:
    """Yield a table for each criterion, with a column for each shape, and a sentence on what is maximised."""
    for criterion in CRITERIA:
        one = [fit for fit in fits if fit.criterion == criterion]
        yield table_across(f"{name}: pulses fitted in {criterion}", PULSES, [fit.pulse.name for fit in one], one)
    yield Aside("Energy captured: 1 - sum (r - s)^2 / sum r^2, r of the record and s of the pulse.")


ORDINATES: tuple[Column[ResponseSpectrum], ...] = (
    Column("period", of("periods"), "s"),
    Column("sa", of("sa"), "g", name="pseudo Sa"),
    Column("sv", of("sv"), "m/s", name="pseudo Sv"),
    Column("sd", of("sd"), "m", name="Sd"),
)
"""Columns whose values are arrays, over all periods."""


def spectrum_data(spectrum: ResponseSpectrum) -> dict[str, Any]:
    """Return a spectrum as plain data, in s, standard gravity, m/s and m."""
    return {"damping": spectrum.damping} | {
        key: values.tolist() for key, values in data_of(ORDINATES, spectrum).items()
    }


def spectra_table(spectra: Mapping[str, ResponseSpectrum]) -> Columns:
    """Return spectra as columns, one motion below the other."""
    all_spectra = list(spectra.values())
    return {
        "motion": [name for name, each in spectra.items() for _ in each.periods],
        "damping": [each.damping for each in all_spectra for _ in each.periods],
        **{column.heading: np.concatenate([column.of(each) for each in all_spectra]).tolist() for column in ORDINATES},
    }


def peaks(name: str, spectrum: ResponseSpectrum) -> str:
    """Return a sentence on the largest ordinates of a spectrum and their periods."""
    k, j = int(spectrum.sa.argmax()), int(spectrum.sv.argmax())
    return (
        f"{name}: with {100 * spectrum.damping:g} % damping Sa is largest at {spectrum.periods[k]:.3g} s, "
        f"{spectrum.sa[k]:.3g} g, and Sv at {spectrum.periods[j]:.3g} s, {spectrum.sv[j]:.3g} m/s."
    )


def spectrum_view(name: str, spectrum: ResponseSpectrum) -> View:
    """Show the spectrum of one motion."""
    return View(lambda: {"name": name, **spectrum_data(spectrum)}, [peaks(name, spectrum)])
