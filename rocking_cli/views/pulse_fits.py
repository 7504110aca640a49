"""View of the pulses fitted to a record, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulse_fit import CRITERIA, PulseFit
from rocking_cli.views.column import Column, lines_of, of, rounded
from rocking_cli.views.response import fit_data, pulse_data
from rocking_cli.views.view import Table

COLUMNS: tuple[Column[PulseFit], ...] = (
    Column("", lambda fit: 100 * fit.captured, "%", "energy captured", form="{:.1f}".format),
    Column("", lambda fit: fit.pulse.amplitude / STANDARD_GRAVITY, "g", "a_p", rounded(4)),
    Column("", of("pulse.period"), "s", "T_p", rounded(4)),
    Column("", of("start"), "s", "start", rounded(4)),
    Column("", of("centre"), "s", "centre", rounded(4)),
    Column("", of("sign"), "", "sign", "{:+d}".format),
    Column("", lambda fit: pulse_data(fit.pulse).get("phase"), "deg", "phase", rounded(4)),
    Column("", lambda fit: pulse_data(fit.pulse).get("cycles"), "", "cycles", rounded(4)),
)


def fits_data(fits: Sequence[PulseFit]) -> dict[str, Any]:
    """Return fitted pulses as plain data, by criterion and shape."""
    return {
        criterion: {fit.pulse.name: fit_data(fit) for fit in fits if fit.criterion == criterion}
        for criterion in CRITERIA
    }


def parts(name: str, fits: Sequence[PulseFit]) -> Iterator[Table | str]:
    """Yield a table for each criterion, with a column for each shape, and a sentence on what is maximised."""
    for criterion in CRITERIA:
        one = [fit for fit in fits if fit.criterion == criterion]
        heads = ["", *(fit.pulse.name for fit in one), "unit"]
        numbers = range(1, len(one) + 1)
        yield Table(f"{name}: pulses fitted in {criterion}", heads, lines_of(COLUMNS, one), numbers)
    yield "Energy captured: 1 - sum (r - s)^2 / sum r^2, r of the record and s of the pulse."
