"""`rk.equivalent_pulses`: pulses to which different structures are equally vulnerable [paper, Fig. 15]."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import isnan, nan, pi
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.ask.answer import Answer, Dimensions
from rocking_cli.ask.inputs import sized_pulse, structure_of, structures_of, warn_misleading
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core import Direction, Equivalence, EquivalentBlock
from rocking_cli.dynamics.exact import exact_response
from rocking_cli.dynamics.history import History, follow
from rocking_cli.dynamics.model import ModelName, linear_model
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.dynamics.verdict import NEAR_OVERTURNING
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.questions.equivalent_pulses.asked import EquivalentPulsesAsked
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies import engines
from rocking_cli.studies.under_pulses import check_eta, uplift, weakest_direction
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.response import known_data
from rocking_cli.views.verdict import unchecked, why_unknown
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIMULATED_AFTER_PULSE = 12.0  # p times the duration that is simulated
MAX_PULSE_PERIODS = 1000  # periods simulated after the pulse, which may be far shorter than the motion
# Largest spread, over the linear peak, of equivalent and of approximately equivalent structures.
MAX_SPREAD, MAX_APPROXIMATE_SPREAD = 0.05, 0.2
CUT_RATIO, SHOWN_AFTER_PULSE = 1.5, 8.0  # phi/phi_cr, and p times the duration after the pulse, that are drawn


@short_repr
@dataclass(frozen=True, eq=False)
class PulsedStructure:
    """One structure under its own pulse, among structures that are compared.

    Parameters
    ----------
    structure : Structure
        The structure.
    block : EquivalentBlock
        Equivalent block of the direction in which the pulse first uplifts the structure.
    pulse : Pulse
        The pulse of this structure.
    eta : float
        Restitution of the impact that ends the first motion, as used; that of the structure itself is `block.eta`.
    history : History
        Nonlinear time history under this pulse.
    """

    structure: Structure
    block: EquivalentBlock
    pulse: Pulse
    eta: float
    history: History

    @property
    def name(self) -> str:
        """Name of the structure."""
        return self.structure.name


@short_repr
@dataclass(frozen=True, eq=False)
class EquivalentResponses:
    """Responses of structures to pulses of the same dimensionless amplitude a and frequency omega.

    Parameters
    ----------
    members : tuple of PulsedStructure
        The structures; the pulse was given for the first.
    a, omega : float
        Dimensionless amplitude and frequency of every pulse [paper, Eq. 40].
    kappa : {1, 2}
        The scaling: the uplift acceleration by which a is divided, 1: lambda_lin, 2: lambda.
    polarity : int
        1, or -1 for reversed pulses.
    direction : Direction
        The direction in which the pulse first uplifts the structures.
    alone : Outcome
        Outcome of the linear block that all structures share; exact if the pulse has an exact solution.
    linear : History
        Time history of the linear block under the first structure's pulse.
    tau : ndarray
        Dimensionless time p t of the samples, the same for all structures.
    """

    members: tuple[PulsedStructure, ...]
    a: float
    omega: float
    kappa: Literal[1, 2]
    polarity: int
    direction: Direction
    alone: OneOutcome
    linear: History
    tau: Reals

    @property
    def spread(self) -> float:
        """Largest minus smallest peak phi/phi_cr; NaN if any structure overturns or has an unknown outcome."""
        return float(np.ptp([nan if each.history.unknown else each.history.peak_ratio for each in self.members]))

    @property
    def relative_spread(self) -> float:
        """The spread over the peak of the linear block; NaN without a spread, or if this peak is not positive."""
        return self.spread / self.alone.peak_ratio if self.alone.peak_ratio > 0 else nan

    @property
    def title(self) -> str:
        """Shape of the pulses and their common a and omega."""
        return f"{self.members[0].pulse.title}, a = {self.a:.4g}, omega = {self.omega:.4g}"

    def turned(self, history: History) -> Reals:
        """Return phi/phi_cr of a history, positive in the direction in which the pulse uplifts first."""
        return int(self.direction) * history.ratio


@verb(EquivalentPulsesAsked)
def equivalent_pulses(asked: EquivalentPulsesAsked, watch: Watcher) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

    Returns
    -------
    Answer of EquivalentResponses
        A pulse and a response for each structure, and for the linear block that they share.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014): equal a and omega of Eq. 40, as in Fig. 15.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.0, height=4.0, restitution=0.9)]
    >>> round(rk.equivalent_pulses(blocks, ag=0.6, period=0.5).a, 3)
    2.4
    """
    pulse: Any = asked.pulse or sized_pulse(asked.shape, asked.ag, asked.period)
    first = structure_of(asked.structures[0], watch, asked.opening)
    structures = structures_of([first, *asked.structures[1:]], watch, asked.opening, least=2)
    kappa: Literal[1, 2] = 1 if asked.kappa == "1" else 2
    responses = under_equivalent_pulses(structures, pulse, int(asked.polarity), kappa, asked.restitution)
    warn_misleading(structures, watch)
    dims = [Dimensions(("structure", "p_t"))]
    table, figure = partial(_table, responses), partial(draw, responses)
    return Answer("equivalent pulses", responses, view(responses), table, figure, dims=dims)


def under_equivalent_pulses(
    structures: list[Structure],
    pulse: Pulse,
    polarity: int = 1,
    kappa: Literal[1, 2] = 2,
    eta: float | Literal["first", "own"] = "first",
) -> EquivalentResponses:
    """Simulate structures under pulses of the same a and omega, each scaled by the structure's own equivalent block.

    Raises `InputError` if a restitution cannot be used, or a structure rocks to one side only, unlike the linear block.
    """
    for each in structures:
        each.ask("linear models")
        if not (sided := each.mechanism).rocks_both_ways:
            what = f"{each.name}: it rocks in the {sided.one_sided} direction only, but the linear block rocks in both"
            raise InputError(Problem(what, field="one_sided"))
    first, gravity = structures[0].equivalence, structures[0].mechanism.gravity
    ground = pulse.sampled().scaled(polarity)
    # The direction in which the pulse uplifts first; without uplift, that of a stronger pulse.
    lifts = {d: -d * ground.acceleration > first[d].lambda_ * gravity for d in Direction}
    lifted = [d for d in Direction if lifts[d].any()] or [weakest_direction(first, pulse, (polarity,))]
    direction = min(lifted, key=lambda d: int(lifts[d].argmax()))
    block = first[direction]
    scaling: ModelName = "linear1" if kappa == 1 else "linear2"
    a = pulse.amplitude / (gravity * uplift(block, scaling))  # Eq. 40
    omega = 2 * pi / (pulse.period * block.p)  # Eq. 40
    if eta == "first" and not 0 < block.eta <= 1:
        what = (
            f"{structures[0].name}: the kinematics give a restitution of {block.eta:.4g}, which cannot be that of all"
        )
        hint = f"give one in (0, 1] for all with {named('restitution')}, or a measured one in its file"
        raise InputError(Problem(what, hint=hint))
    if not isinstance(eta, str):
        check_eta(eta, "eta")
    members = []
    for each in structures:
        itself, g = each.equivalence[direction], each.mechanism.gravity
        scaled = replace(pulse, amplitude=a * g * uplift(itself, scaling), period=2 * pi / (omega * itself.p))
        used = itself.eta if eta == "own" else block.eta if eta == "first" else float(eta)
        shaken = each if eta == "own" else each.under(restitution=used)
        history = engines.follow(shaken, scaled.sampled().scaled(polarity), tail=_tail(scaled, itself.p))
        members.append(PulsedStructure(each, itself, scaled, used, history))
    both = replace(block, eta=members[0].eta)
    linear = follow(linear_model("linear block", scaling, (both, both), gravity), ground, tail=_tail(pulse, block.p))
    alone: OneOutcome = linear
    if pulse.segments():  # an exact outcome, whereas the history is of the sampled pulse
        alone = exact_response(Equivalence(both, both), pulse, kappa=kappa, gravity=gravity, polarity=polarity)
    longest = max(run.time.size for run in (linear, *(each.history for each in members)))
    tau = ground.kept.dt * block.p * np.arange(longest, dtype=np.float64)
    return EquivalentResponses(tuple(members), a, omega, kappa, polarity, direction, alone, linear, tau)


def _tail(pulse: Pulse, p: float) -> float:
    return min(SIMULATED_AFTER_PULSE / p, MAX_PULSE_PERIODS * pulse.period)


def _peak(outcome: OneOutcome) -> str:
    if outcome.unknown:
        return f"{names.UNKNOWN}, >= {outcome.lower_bound:.4g}"
    return f"{outcome.peak_ratio:.4g}" if outcome.peak_ratio > 0 else outcome.words


COLUMNS: tuple[Column[PulsedStructure], ...] = (
    Column("mechanism", of("structure.mechanism.mechanism")),
    Column("name", of("name"), head="", text=True),
    Column("p", of("block.p"), "rad/s"),
    Column("lambda", of("block.lambda_")),
    Column("lambda_lin", of("block.lambda_lin")),
    Column("ag", lambda each: each.pulse.amplitude / STANDARD_GRAVITY, "g", "a_g [g]"),
    Column("period", of("pulse.period"), "s", "T [s]"),
    Column("eta", of("eta"), head="eta"),
    Column("own_eta", of("block.eta")),
    Column("peak_ratio", of("history.peak_ratio")),
    only_shown("peak / phi_cr", of("history"), _peak),
    Column("overturned", of("history.overturned")),
    Column("caution", lambda each: each.structure.mechanism.own_caution() or None),
)


def view(found: EquivalentResponses) -> View:
    """Show each structure under its own pulse, the linear block that they share, and a verdict."""
    members, verdict = found.members, " ".join(judge(found))
    data: dict[str, Any] = {"pulse": members[0].pulse.name}
    data |= {name: getattr(found, name) for name in ("polarity", "kappa", "a", "omega", "spread", "relative_spread")}
    data |= {"direction": found.direction.label, "linear_peak_ratio": found.alone.peak_ratio, "verdict": verdict}
    data["structures"] = [{**data_of(COLUMNS, each), **known_data(each.history)} for each in members]
    table = table_of(found.title, COLUMNS, members)
    alone = ["linear block", "", "", f"{members[0].eta:.4g}", _peak(found.alone)]
    cautions = [unchecked(each.name) for each in members if each.history.check is None]
    told = [(each.name, each.structure.mechanism.own_caution()) for each in members]
    cautions += [f"Caution: {name}: {caution}" for name, caution in told if caution]
    return View(data, [replace(table, rows=[*table.rows, alone]), verdict, *cautions])


def _table(found: EquivalentResponses) -> Columns:
    """Return the columns of a table, with a row for each structure, the linear block last, and each sample."""
    runs = [(each.name, each.history, each.history.time) for each in found.members]
    return stacked(
        {"structure": name, "p_t": found.tau[: run.ratio.size], "t [s]": time, "phi_ratio": run.ratio}
        for name, run, time in [*runs, ("linear block", found.linear, nan)]
    )


def judge(found: EquivalentResponses) -> list[str]:
    """Return sentences on whether the structures are equivalently vulnerable."""
    alone, members = found.alone, [each for each in found.members if not each.history.unknown]
    sentences = [
        f"The outcome of {each.name} is {names.UNKNOWN} after {each.history.known_to:.4g} s, as "
        f"{why_unknown(each.history)}."
        for each in found.members
        if each.history.unknown
    ]
    if sentences and len(members) < 2:
        return [*sentences, "Whether the structures are equivalently vulnerable to these pulses is not known."]
    if sentences:
        sentences.append(f"What follows is about the other {len(members)}.")
    relative = replace(found, members=tuple(members)).relative_spread
    fallen = [each.name for each in members if each.history.fell]
    peaks = {each.name: each.history.peak_ratio for each in members if not each.history.fell}
    reached = f"{names.ROCKS} to {alone.peak_ratio:.4g} of phi_cr" if alone.peak_ratio else names.NO_UPLIFT
    verdict = f"The linear block {names.OVERTURNS if alone.fell else reached}"
    if alone.peak_ratio == 0 and not fallen and not any(peaks.values()):
        return [*sentences, f"{verdict} (a = {found.a:.4g}, uplift needs a > 1), nor does any structure."]
    if not peaks:
        verdict += ", and so do all structures"
    elif fallen:
        verdict += f"; the equivalence breaks: {', '.join(fallen)} overturn{'s' * (len(fallen) == 1)}, others do not"
    elif not relative <= MAX_APPROXIMATE_SPREAD:
        far = max(peaks, key=lambda name: abs(peaks[name] - alone.peak_ratio))
        verdict += f"; the equivalence breaks: {'no structure does' if isnan(relative) else f'{far} is the farthest'}"
    else:
        how = "" if relative <= MAX_SPREAD else "approximately "
        verdict += f"; the peaks of the structures lie within {100 * relative:.2g} % of that: they are {how}equivalent"
    sentences.append(f"{verdict}.")
    if peaks and max(peaks.values()) > NEAR_OVERTURNING:
        sentences.append(f"Above {NEAR_OVERTURNING:g} of the critical rotation, small differences decide the outcome.")
    if np.ptp([each.eta for each in members]) > 1e-9:
        sentences.append("The restitutions differ, but equivalence requires the same value for all: set it with `eta`.")
    return sentences


def draw(found: EquivalentResponses) -> Figure:
    """Plot the pulses in their units above, and the responses together below."""
    from rocking_cli.plotting import style

    figure, ((above,), (below,)) = style.panels(5.8 + 0.2 * len(found.members), 2, height_ratios=[1, 1.8])
    style.heading(above, found.title)
    shared = {"color": style.FAINT, "linewidth": 3.5, "alpha": 0.6, "zorder": 1}
    curves = [(each.name, each.history, each.history, style.distinct(k)) for k, each in enumerate(found.members)]
    for k, (name, history, outcome, look) in enumerate(
        [*curves, ("linear block of all", found.linear, found.alone, shared)]
    ):
        ratio = found.turned(history)
        beyond = np.flatnonzero(~(np.abs(ratio) <= CUT_RATIO))  # where it overturned, or is not known
        ratio = ratio[: beyond[0]] if beyond.size else ratio
        tau = found.tau[: ratio.size]
        ends = f", unknown after {history.known_to:.3g} s (open circle)" if history.unknown else ""
        label = f"{name}{', overturns' if outcome.fell else ends}"
        spacing = max(1, round(2 / float(found.tau[1] - found.tau[0])))  # marks of different curves do not overlap
        below.plot(tau, ratio, label=style.plain(label), markevery=(1 + k * spacing // 6, spacing), **look)
        if look is shared:
            continue
        pulse = found.members[k].pulse
        time = np.linspace(0.0, pulse.duration, 400)
        ground = found.polarity * pulse.acceleration(time) / STANDARD_GRAVITY
        above.plot([0.0, *time, time[-1]], [0.0, *ground, 0.0], markevery=(20 + 7 * k, 80), **look)
        if ratio.size and (history.fell or history.unknown):
            mark = {"marker": "x"} if history.fell else {"marker": "o", "markerfacecolor": style.PAPER}
            below.plot(tau[-1], ratio[-1], markersize=8, color=look["color"], zorder=3, **mark)
    pulse_end = found.members[0].block.p * found.members[0].pulse.duration
    below.set_xlim(0.0, min(pulse_end + SHOWN_AFTER_PULSE, float(found.tau[-1])))
    above.set_xlim(left=0.0)
    below.axvline(pulse_end, color=style.FAINT, linewidth=style.CURVE, linestyle=":", label="end of the pulses")
    low, high = below.get_ylim()
    below.set_ylim(low, high + 0.1 * (high - low))  # so that the peaks are free of the frame
    below.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    style.tidy(above, "time [s]", "pulse of each [g]")
    style.tidy(below, r"dimensionless time $p\,t$", r"$\phi/\phi_{cr}$, first lifted side up")
    style.legend_below(figure, below.get_legend_handles_labels()[0], handlelength=4)
    return figure
