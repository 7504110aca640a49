"""View of the pulses fitted to a record, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulse_fit import CRITERIA, PulseFit
from rocking_cli.views.response import fit_data, pulse_data
from rocking_cli.views.view import Table, number


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
        columns = ["", *(fit.pulse.name for fit in one), "unit"]
        yield Table(f"{name}: pulses fitted in {criterion}", columns, _rows(one), numbers=range(1, len(one) + 1))
    yield "Energy captured: 1 - sum (r - s)^2 / sum r^2, r of the record and s of the pulse."


def _rows(fits: Sequence[PulseFit]) -> list[list[str]]:
    def each(values: list[float | None]) -> list[str]:
        return [number(value, 4) for value in values]

    further = [pulse_data(fit.pulse) for fit in fits]
    return [
        ["energy captured", *(f"{100 * fit.captured:.1f}" for fit in fits), "%"],
        ["a_p", *each([fit.pulse.amplitude / STANDARD_GRAVITY for fit in fits]), "g"],
        ["T_p", *each([fit.pulse.period for fit in fits]), "s"],
        ["start", *each([fit.start for fit in fits]), "s"],
        ["centre", *each([fit.centre for fit in fits]), "s"],
        ["sign", *(f"{fit.sign:+d}" for fit in fits), ""],
        ["phase", *each([pulse.get("phase") for pulse in further]), "deg"],
        ["cycles", *each([pulse.get("cycles") for pulse in further]), ""],
    ]
