"""View of pulses to which structures are equivalently vulnerable, as text and as data."""

from __future__ import annotations

from dataclasses import replace
from math import isnan, nan

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.dynamics.verdict import NEAR_OVERTURNING
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.questions.equivalent_pulses.study import EquivalentResponses, PulsedStructure
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.response import known_data
from rocking_cli.views.verdict import unchecked, why_unknown
from rocking_cli.views.view import View

# Largest spread, over the linear peak, of equivalent and of approximately equivalent structures.
MAX_SPREAD, MAX_APPROXIMATE_SPREAD = 0.05, 0.2


def _peak(outcome: OneOutcome) -> str:
    if outcome.unknown:
        return f"{names.UNKNOWN}, >= {outcome.lower_bound:.4g}"
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
    only_shown("peak / phi_cr", of("history"), _peak),
    Column("overturned", of("history.overturned")),
    Column("caution", lambda each: each.caution or None),
)


def view(found: EquivalentResponses) -> View:
    """Show each structure under its own pulse, the linear block that they share, and a verdict."""
    verdict = " ".join(judge(found))
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


def table(found: EquivalentResponses) -> Columns:
    """Return the columns of a table, with a row for each structure, the linear block last, and each sample."""
    histories = {each.name: each.history for each in found.members}

    def row(name: str, run: History, time: Reals | float) -> dict[str, object]:
        return {"structure": name, "p_t": found.tau[: run.ratio.size], "t [s]": time, "phi_ratio": run.ratio}

    members = (row(name, run, run.time) for name, run in histories.items())
    return stacked([*members, row("linear block", found.linear, nan)])


def judge(found: EquivalentResponses) -> list[str]:
    """Return sentences on whether the structures are equivalently vulnerable.

    Parameters
    ----------
    found : EquivalentResponses
        The responses.
    """
    unknown = [each for each in found.members if each.history.unknown]
    if unknown:
        sentences = [
            f"The outcome of {each.name} is {names.UNKNOWN} after {each.history.known_to:.4g} s, as "
            f"{why_unknown(each.history)}."
            for each in unknown
        ]
        known = tuple(each for each in found.members if not each.history.unknown)
        if len(known) < 2:
            return [*sentences, "Whether the structures are equivalently vulnerable to these pulses is not known."]
        return [*sentences, f"What follows is about the other {len(known)}.", *judge(replace(found, members=known))]
    sentences = []
    fallen = [each for each in found.members if each.history.fell]
    peaks = {each.name: each.history.peak_ratio for each in found.members if not each.history.fell}
    linear = (
        names.OVERTURNS
        if found.alone.fell
        else f"{names.ROCKS} to {found.alone.peak_ratio:.4g} of phi_cr"
        if found.alone.peak_ratio
        else names.NO_UPLIFT
    )
    if not fallen and not any(peaks.values()) and found.alone.peak_ratio == 0:
        return [f"The linear block {names.NO_UPLIFT} (a = {found.a:.4g}, uplift needs a > 1), nor does any structure."]
    if not peaks:
        sentences.append(f"All overturn; the linear block {linear}.")
    elif fallen:
        who = ", ".join(each.name for each in fallen)
        sentences.append(
            f"Here the equivalence breaks: {who} overturn{'s' if len(fallen) == 1 else ''}, the rest do not; "
            f"the linear block {linear}."
        )
    else:
        part = "" if isnan(found.relative_spread) else f", {100 * found.relative_spread:.2g} % of that"
        sentences.append(
            f"The linear block {linear}; the peaks of the structures lie within {found.spread:.3g} of one another"
            f"{part}."
        )
        if isnan(found.relative_spread):
            what = f"{names.OVERTURNS} and none of the structures does" if found.alone.fell else (
                f"{names.NO_UPLIFT} and a structure does"
            )  # fmt: skip
            sentences.append(f"The linear block {what}: here the equivalence breaks.")
        elif found.relative_spread > MAX_APPROXIMATE_SPREAD:
            far = max(peaks, key=lambda name: abs(peaks[name] - found.alone.peak_ratio))
            sentences.append(f"Here the equivalence breaks: {far} is the farthest from the linear block.")
        else:
            how = "" if found.relative_spread <= MAX_SPREAD else "approximately "
            sentences.append(f"They are {how}equivalently vulnerable to these pulses.")
    if peaks and max(peaks.values()) > NEAR_OVERTURNING:
        sentences.append(
            f"Above {NEAR_OVERTURNING:g} of the critical rotation, small differences decide the outcome: do not rely "
            "on the equivalence there."
        )
    if not found.one_eta:
        sentences.append(
            "The coefficients of restitution differ, but equivalence requires the same value for all: set it with "
            "`eta`."
        )
    return sentences
