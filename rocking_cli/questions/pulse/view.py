"""View of a pulse on the dimensionless linear block, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from math import isnan
from typing import Any, TypeVar

from rocking_cli import names
from rocking_cli.dynamics.exact import ClosedForm, ExactResponse
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.names import percent
from rocking_cli.views.column import Column, data_of, of, only_shown, table_across
from rocking_cli.views.view import ABSENT, ASIDE, Aside, Table, View, number

R = TypeVar("R")
CONDITIONS = {
    "uplift": "the pulse lifts the block (a > 1)",
    "first_impact_after_pulse": "the first impact comes after the pulse",
    "no_overturning_without_impact": "the block does not overturn before its first impact",
}
LINEAR_BLOCK = Aside(
    "The linear block is the equivalent block of any structure: a = a_g/(g lambda), omega = omega_g/p, tau = p t."
)
IN_WORDS = {"  overturns", "  impacts"}
"""Headings of what the first sentence has."""
YES_NO = {True: "yes", False: "no", None: ABSENT}


def _condition(name: str) -> Column[ClosedForm]:
    holds = YES_NO.__getitem__
    return only_shown("  condition", lambda closed: closed.conditions[name], holds, words=CONDITIONS[name])


CLOSED: tuple[Column[ClosedForm], ...] = (
    only_shown("closed form D0*", of("D0"), number, words="(phi/phi_cr - 1)^2 - (phi'/phi_cr)^2 at its end (Eq. 42)"),
    only_shown("  max ratio", of("max_ratio"), number, words="peak of the first rebound over phi_cr (Eq. 41)"),
    only_shown("  overturns", of("overturns"), YES_NO.__getitem__, words="eta^2 (1 - D0*) >= 1"),
    *map(_condition, CONDITIONS),
)


def _exact(
    key: str, value: Callable[[ExactResponse], Any], head: str, words: str = "", form: Callable[[Any], str] = number
) -> Column[ExactResponse]:
    return Column(key, value, "", head, form, words=words, rank=ASIDE * (head in IN_WORDS))


EXACT: tuple[Column[ExactResponse], ...] = (
    _exact("max_ratio", of("peak_ratio"), "exact max ratio", "largest rotation over phi_cr"),
    _exact("first_excursion", of("first_excursion"), "exact first excursion", "peak before the first impact"),
    _exact("first_rebound", of("first_rebound"), "exact first rebound", "peak after the first impact"),
    _exact("overturns", of("fell"), "  overturns", form=YES_NO.__getitem__),
    _exact("impacts_before_overturning", lambda exact: impacts_before(exact), "  impacts", "before it overturns", str),
    _exact("uplift", of("uplift_time"), "exact uplift", "tau = p t from the start of the pulse"),
    _exact("pulse_end", lambda exact: exact.pulse_end - exact.uplift_time, "  end of pulse", "tau from uplift"),
    _exact("first_impact", lambda exact: exact.first_impact - exact.uplift_time, "  first impact", "tau from uplift"),
    Column("impact_during_pulse", lambda exact: exact.first_impact < exact.pulse_end),
)
"""Columns of the exact solution; times count from uplift, except that of uplift itself."""


def view(shape: str, a: float, omega: float, eta: float, closed: ClosedForm | None, exact: ExactResponse) -> View:
    """Show the exact solution, and the closed form if the shape has one."""
    data = {
        "shape": shape,
        "a": a,
        "omega": omega,
        "eta": eta,
        "closed_form": None if closed is None else closed_data(closed, exact),
        "exact": data_of(EXACT, exact),
    }
    title = "Full sine" if shape == "sine" else shape.replace("_", " ").capitalize()
    table = _table(f"{title} pulse: a = {a:g}, omega = {omega:g}, eta = {eta:g}", EXACT, exact)
    if closed is not None:
        rows = [*_table("", CLOSED, closed).rows, *table.rows]
        more = len(rows) - len(table.rows)  # of the closed form
        hidden = range(more) if closed.D0 is None else ()
        table = replace(table, rows=rows, asides=[*hidden, *(more + k for k in table.asides)])
    return View(data, [_verdict(a, closed, exact), table, LINEAR_BLOCK])


def _table(title: str, columns: Sequence[Column[R]], found: R) -> Table:
    return table_across(title, columns, ["value"], [found], {"meaning": of("words")})


def closed_data(closed: ClosedForm, exact: ExactResponse) -> dict[str, Any]:
    """Return the closed form as plain data: whether it is valid, why not, and its errors in two exact peaks."""
    return {
        **asdict(closed),
        "valid": closed.valid,
        "reason": why_not_valid(closed),
        "off_first_rebound": closed.off(exact.first_rebound),
        "off_peak_ratio": closed.off(exact.peak_ratio),
    }


def why_not_valid(closed: ClosedForm) -> str | None:
    """Return the reason why a closed form cannot be used, in words; None if it can."""
    failed = [CONDITIONS[name] for name, holds in closed.conditions.items() if holds is False]
    return None if closed.valid else f"it holds only where {' and '.join(failed)}"


def how_far_off(closed: ClosedForm, exact: ExactResponse) -> str:
    """Compare Eq. 41 with the exact solution, as the end of a sentence; empty if they agree."""
    printed, overturns, peak = closed.printed_ratio, exact.fell, exact.peak_ratio
    if closed.valid and closed.overturns != overturns:
        return f"; by Eq. 41 it {_fate(closed.overturns)}, but by the exact solution it {_fate(overturns)}"
    if overturns:
        return (
            ""
            if printed is None
            else f"; Eq. 41 would give {printed:.4g}, but by the exact solution it {_fate(overturns)}"
        )
    if printed is None:
        return "" if closed.valid else f"; Eq. 41 gives no rotation here, the exact largest rotation is {peak:.4g}"
    if abs(printed - peak) < 1e-9:
        return ""
    off = percent(abs(printed - peak) / peak) if peak > 0 else f"{printed:.4g}"
    first = "; it gives the first rebound only, and" if closed.valid else ";"
    what = f"{off} too {'high' if printed > peak else 'low'}"
    return f"{first} the largest rotation is {peak:.4g}, Eq. 41 gives {printed:.4g}, {what}"


def _fate(overturns: bool | None) -> str:
    return names.outcome(uplifts=True, overturned=bool(overturns))


def impacts_before(outcome: OneOutcome) -> int | None:
    """Return the number of impacts before the block overturns; None if it does not."""
    return outcome.impact_count if outcome.fell else None


def after_impacts(outcome: OneOutcome) -> str:
    """Return in words after how many impacts the block overturns; empty if it does not."""
    count = impacts_before(outcome)
    if count is None:
        return ""
    return "without impact" if count == 0 else f"after {count} impact{'s' if count > 1 else ''}"


def _verdict(a: float, closed: ClosedForm | None, exact: ExactResponse) -> str:
    if a <= 1:
        return f"The linear block {names.NO_UPLIFT}: a <= 1."
    fate = (
        f"{names.OVERTURNS} {after_impacts(exact)}"
        if exact.fell
        else f"{names.ROCKS} to {exact.peak_ratio:.4g} of its critical rotation"
    )
    if closed is None:
        trust = "No closed form exists for this shape: Eqs. 41-42 apply to a full sine"
    else:
        use = "All conditions are met: the closed form can be used"
        trust = use if closed.valid else f"Do not use the closed form here: {why_not_valid(closed)}"
        if closed.valid and exact.first_excursion > 1 and isnan(exact.first_rebound):
            trust += "; the block passes its critical rotation before its first impact"
        else:
            trust += how_far_off(closed, exact)
    return f"The linear block {fate}. {trust}."
