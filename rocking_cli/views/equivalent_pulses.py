"""View of pulses to which structures are equivalently vulnerable, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rocking_cli.dynamics.holding import unchecked
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.names import UNKNOWN
from rocking_cli.studies.equivalent_pulses import EquivalentResponses, PulsedStructure
from rocking_cli.views.column import Column, data_of, of, table_of
from rocking_cli.views.response import known_data
from rocking_cli.views.view import View


def _peak(outcome: OneOutcome) -> str:
    if outcome.unknown:
        return f"{UNKNOWN}, >= {outcome.lower_bound:.4g}"
    return f"{outcome.peak_ratio:.4g}" if outcome.peak_ratio > 0 else outcome.words


COLUMNS: tuple[Column[PulsedStructure], ...] = (
    Column("mechanism", of("mechanism")),
    Column("name", of("name"), head="", text=True),
    Column("p", of("block.p"), "rad/s"),
    Column("lambda", of("block.lambda_")),
    Column("lambda_lin", of("block.lambda_lin")),
    Column("ag", of("amplitude"), "g", "a_g [g]"),
    Column("period", of("pulse.period"), "s", "T [s]"),
    Column("eta", of("eta"), head="eta"),
    Column("own_eta", of("own_eta")),
    Column("peak_ratio", of("history.peak_ratio")),
    Column("", of("history"), head="peak / phi_cr", form=_peak),
    Column("overturned", of("history.overturned")),
)


def view(found: EquivalentResponses, verdict: str) -> View:
    """Show each structure under its own pulse, the linear block that they share, and a verdict."""
    data = {
        "pulse": found.members[0].pulse.name,
        "polarity": found.polarity,
        "kappa": found.kappa,
        "a": found.a,
        "omega": found.omega,
        "direction": found.direction.label,
        "structures": [{**data_of(COLUMNS, each), **known_data(each.history)} for each in found.members],
        "linear_peak_ratio": found.alone.peak_ratio,
        "spread": found.spread,
        "relative_spread": found.relative_spread,
        "verdict": verdict,
    }
    table = table_of(title(found), COLUMNS, found.members)
    alone = ["linear block", "", "", f"{found.members[0].eta:.4g}", _peak(found.alone)]
    cautions = [unchecked(each.name) for each in found.members if each.history.check is None]
    cautions += [f"Caution: {each.name}: {each.caution}" for each in found.members if each.caution]
    return View(data, [replace(table, rows=[*table.rows, alone]), verdict, *cautions])


def title(found: EquivalentResponses) -> str:
    """Return the shape of the pulses and their common a and omega, as a heading."""
    return f"{found.members[0].pulse.title}, a = {found.a:.4g}, omega = {found.omega:.4g}"


def table(found: EquivalentResponses) -> dict[str, Sequence[object]]:
    """Return the columns of a table: p t, and time and rotation of each structure; empty after their end."""

    def padded(values: list[float]) -> list[float]:
        return values + [float("nan")] * (found.tau.size - len(values))

    columns: dict[str, Sequence[object]] = {"p t": found.tau.tolist()}
    for each in found.members:
        columns[f"{each.name} t [s]"] = padded(each.history.time.tolist())
        columns[f"{each.name} phi/phi_cr"] = padded(each.history.ratio.tolist())
    columns["linear block phi/phi_cr"] = padded(found.linear.ratio.tolist())
    return columns
