"""The pulses in a record, as people and programs read them."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter
from typing import Any

from rocking_cli.cli import terminal
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import CRITERIA, FITTED, PulseFit, fit_pulses
from rocking_cli.views.response import pulse_data
from rocking_cli.views.view import number

PATIENCE = 1.0  # s without a word


def find(motion: GroundMotion) -> list[PulseFit]:
    """The best pulse of each shape by each criterion; says how far it is if that takes its time."""
    fits: list[PulseFit] = []
    since = perf_counter()
    for fit in fit_pulses(motion):
        fits.append(fit)
        if perf_counter() - since > PATIENCE:
            terminal.note(f"{motion.name}: {len(fits)} of {len(CRITERIA) * len(FITTED)} pulses fitted")
            since = perf_counter()
    return fits


def fit_json(fit: PulseFit) -> dict[str, Any]:
    """A fitted pulse, and where it is in its record."""
    return {
        "criterion": fit.criterion,
        "captured": fit.captured,
        "start": fit.start,
        "centre": fit.centre,
        "sign": fit.sign,
        **pulse_data(fit.pulse),
    }


def fits_json(fits: Sequence[PulseFit]) -> dict[str, Any]:
    """Fitted pulses by criterion and shape."""
    return {
        criterion: {fit.pulse.name: fit_json(fit) for fit in fits if fit.criterion == criterion}
        for criterion in CRITERIA
    }


def print_tables(name: str, fits: Sequence[PulseFit]) -> None:
    """A table for each criterion with a column for each shape, and what is maximised."""
    for criterion in CRITERIA:
        one = [fit for fit in fits if fit.criterion == criterion]
        terminal.table(
            f"{name}: pulses fitted in {criterion}",
            ["", *(fit.pulse.name for fit in one), "unit"],
            _rows(one),
            numbers=range(1, len(one) + 1),
        )
    terminal.result("Energy captured: 1 - sum (r - s)^2 / sum r^2, r of the record and s of the pulse.")


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
