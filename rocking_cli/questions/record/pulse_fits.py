"""View of the pulses fitted to a record, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulse_fit import CRITERIA, PulseFit
from rocking_cli.views.column import Column, of, only_shown, rounded, table_across
from rocking_cli.views.response import fit_data, pulse_data
from rocking_cli.views.view import Table

COLUMNS: tuple[Column[PulseFit], ...] = (
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


def parts(name: str, fits: Sequence[PulseFit]) -> Iterator[Table | str]:
    """Yield a table for each criterion, with a column for each shape, and a sentence on what is maximised."""
    for criterion in CRITERIA:
        one = [fit for fit in fits if fit.criterion == criterion]
        yield table_across(f"{name}: pulses fitted in {criterion}", COLUMNS, [fit.pulse.name for fit in one], one)
    yield "Energy captured: 1 - sum (r - s)^2 / sum r^2, r of the record and s of the pulse."
