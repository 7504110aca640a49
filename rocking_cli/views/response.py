"""View of the response of a structure to one ground motion, in one polarity or both, as text and as data."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from math import nan, sqrt
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.core import Direction, Mechanism
from rocking_cli.dynamics.history import FELT, History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.dynamics.verdict import agreements
from rocking_cli.dynamics.vertical import contact_lost
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.movements import Movements, Watched
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.studies.response import Histories, Question, Response, Runs, concluded
from rocking_cli.views import processing
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.conclusion import conclusion_data, governing_polarity, headline, next_in_words
from rocking_cli.views.contact import contact_data, contact_words
from rocking_cli.views.neighbours import neighbours_data, neighbours_in_words
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.verdict import SENSE, unchecked, verdict, why_unknown
from rocking_cli.views.view import ABSENT, Table, View, force_unit, in_degrees, number

Reals = NDArray[np.float64]
FIRST = 12  # impacts of a model in its table; the data have all


class HistoryDetails(NamedTuple):
    """What is shown of each history beside its outcome.

    Parameters
    ----------
    watched : Watched or None
        Points and ties, whose movement is shown.
    contacts : mapping of int to ContactDemand
        Contact demands of the nonlinear history, by polarity.
    mechanism : Mechanism or None
        The structure that they are of.
    etas : tuple of float, or None
        Restitution of impacts that end positive and negative motion; with it the impacts are listed.
    """

    watched: Watched | None = None
    etas: tuple[float, float] | None = None
    contacts: Mapping[int, ContactDemand] = MappingProxyType({})
    mechanism: Mechanism | None = None

    def contact(self, polarity: int, name: ModelName) -> dict[str, Any] | None:
        """Return the contact demands of a history; None for a linear model, which has no joints."""
        if name != "nonlinear" or polarity not in self.contacts or self.mechanism is None:
            return None
        return contact_data(self.contacts[polarity], self.mechanism)

    def assumed_friction(self, polarity: int) -> float | None:
        """Return the friction that the result assumes in a polarity, see `ContactDemand`."""
        return self.contacts[polarity].assumed_friction if polarity in self.contacts else None

    def contact_words(self, polarity: int) -> list[str]:
        """Return the contact demands as sentences, if there are any."""
        if polarity not in self.contacts or self.mechanism is None:
            return []
        said = contact_words(self.contacts[polarity], self.mechanism)
        return [said] if said else []


NOTHING_MORE = HistoryDetails()


def record_data(motion: GroundMotion, factor: float, polarity: str, pulse: Pulse | None) -> dict[str, Any]:
    """Return the record as read, or the pulse as given, and its scaling and processing, as plain data."""
    return {
        **_motion_data(motion),
        **({"pulse": pulse_data(pulse)} if pulse is not None else {}),
        "vertical": _motion_data(motion.vertical) if motion.vertical is not None else None,
        "scale": factor,
        "polarity": polarity if polarity == "both" else int(polarity),
    }


def pulse_data(pulse: Pulse) -> dict[str, Any]:
    """Return a pulse as plain data: shape, amplitude [g], period and duration [s], and further parameters."""
    return {
        "shape": pulse.name,
        "specification": pulse.specification,
        "amplitude": pulse.amplitude / STANDARD_GRAVITY,
        "period": pulse.period,
        "duration": pulse.duration,
        **{field.name: getattr(pulse, field.name) for field in fields(pulse)[2:]},
    }


def fit_data(fit: PulseFit) -> dict[str, Any]:
    """Return a fitted pulse as plain data, with its position in the record."""
    return {
        "criterion": fit.criterion,
        "captured": fit.captured,
        "start": fit.start,
        "centre": fit.centre,
        "sign": fit.sign,
        **pulse_data(fit.pulse),
    }


def _motion_data(motion: GroundMotion) -> dict[str, Any]:
    return {
        "name": motion.name,
        "npts": motion.npts,
        "dt": motion.dt,
        "unit": motion.unit,
        "pga": motion.of_ground.pga_g,
        "format": motion.format,
        **processing.data(motion),
    }


def runs_data(
    runs: Runs, near: Mapping[int, Neighbours], shown: HistoryDetails = NOTHING_MORE, motion: str = ""
) -> dict[str, Any]:
    """Return responses, neighbours and the conclusion as plain data, by polarity if there are two."""
    each = {
        str(polarity): {
            "responses": histories_data(histories, shown, polarity),
            "agreement": agreement_data(histories),
            "neighbours": neighbours_data(near[polarity]) if polarity in near else None,
            "verdict": verdict(histories, agreements(histories), shown.assumed_friction(polarity)),
        }
        for polarity, histories in runs.items()
    }
    found = concluded(runs, near, motion)
    both = {"polarities": each, "governs": found.polarity}
    return {"conclusion": conclusion_data(found)} | (each.popitem()[1] if len(each) == 1 else both)


def histories_data(histories: Histories, shown: HistoryDetails = NOTHING_MORE, polarity: int = 1) -> dict[str, Any]:
    """Return the response of each model as plain data."""
    return {
        name: {**_history_data(run, shown), "contact": shown.contact(polarity, name)} for name, run in histories.items()
    }


def agreement_data(histories: Histories) -> dict[str, Any]:
    """Return, as plain data, how the models compare with the nonlinear one; empty without it.

    If the outcome of the nonlinear model is unknown, each value is null.
    """
    if "nonlinear" in histories and histories["nonlinear"].unknown:
        return {name: None for name in histories if name != "nonlinear"}
    return {
        name: {
            "grade": found.grade.key,
            "uplift_error": found.uplift_error,
            "peak_error": found.peak_error,
            "delay": found.peak_delay,
            "rms_difference": found.difference,
        }
        for name, found in agreements(histories).items()
    }


def models_used(models: Iterable[ModelName]) -> Iterator[str]:
    """Yield a sentence on what the models are; none for the nonlinear model alone."""
    names = list(models)
    linear = [name for name in names if name != "nonlinear"]
    if linear:
        itself = "nonlinear is the structure itself, " if "nonlinear" in names else ""
        scaled = " and ".join(name.replace("linear", "kappa") for name in linear)
        what = (
            f"{' and '.join(linear)} {'are' if len(linear) > 1 else 'is'} its linearised equivalent block with {scaled}"
        )
        yield f"Models: {itself}{what} (see `rocking equiv`)."


def ending(outcome: OneOutcome) -> str:
    """Return the keyword for how a motion ended, for JSON."""
    if outcome.unknown:
        return names.UNKNOWN
    return "overturned" if outcome.fell else "still_rocking" if outcome.still_rocking else "at_rest"


def known_data(outcome: OneOutcome) -> dict[str, Any]:
    """Return, as plain data, until when a motion is known and why; linear models are always known."""
    history = outcome if isinstance(outcome, History) else None
    checked = history is None or history.model != "nonlinear" or history.check is not None
    return {
        "unknown": outcome.unknown if outcome.unknown or checked else None,
        "known_to": outcome.known_to if outcome.unknown else None,
        "known_to_reason": None if history is None else why_unknown(history),
        "peak_lower_bound": outcome.lower_bound if outcome.unknown else None,
        "opening": outcome.opening,
    }


def not_checked(mechanism: Mechanism, histories: Iterable[History]) -> list[str]:
    """A caution if the joints of a nonlinear history are not checked; else nothing."""
    if all(each.model != "nonlinear" or each.check is not None for each in histories):
        return []
    return [unchecked(why=mechanism.unchecked)]


def _history_data(history: History, shown: HistoryDetails) -> dict[str, Any]:
    found: dict[str, Any] = {
        "peak_positive": history.peak_positive,
        "peak_negative": history.peak_negative,
        "peak_ratio": history.peak_ratio,
        "overturned": history.overturned,
        "overturning_time": history.overturning_time,
        "overturning_direction": Direction(history.fell_to).label if history.fell else None,
        "uplift_time": history.uplift_time,
        "impacts": len(history.felt),
        "impacts_all": history.impact_count,
        "outcome": ending(history),
        "contact_lost": history.contact_lost,
        "ratio_of": "limit" if any(history.ends_at_limit) else "phi_cr",
        **known_data(history),
    }
    if shown.watched is not None:
        found |= _movements_data(shown.watched.peaks(history))
    if shown.etas is not None:
        found["impact_list"] = [
            {"time": time, "direction": direction.label, "rate_before": before, "rate_after": after}
            for time, direction, before, after in _impacts(history.impacts, shown.etas)
        ]
    return found


def _movements_data(moved: Movements) -> dict[str, Any]:
    """Return peak displacements of points, peak forces of ties and the impact velocity as plain data."""
    return {
        "impact_velocity": moved.impact_velocity,
        "points": {
            each.name: {"at": [each.at.real, each.at.imag], "horizontal": each.horizontal, "vertical": each.vertical}
            for each in moved.points
        },
        "ties": {each.name: {"peak_force": each.force, "peak_elongation": each.elongation} for each in moved.ties},
    }


def _impacts(impacts: Reals, etas: tuple[float, float]) -> list[tuple[float, Direction, float, float]]:
    """Return time [s], direction that ends, and rates before and after [rad/s] of impacts of a history."""
    rows = ((time, Direction(int(sign)), rate) for time, sign, rate in impacts.tolist())
    return [(time, direction, rate, etas[0 if direction > 0 else 1] * rate) for time, direction, rate in rows]


def view(
    found: Response,
    structure: Structure,
    asked: Question,
    polarity: str,
    title: str,
    doubts: Sequence[str] = (),
    *,
    impacts: bool,
) -> View:
    """Show the responses to one motion.

    Parameters
    ----------
    found : Response
        The response of the structure.
    structure : Structure
        The structure.
    asked : Question
        The options of the response.
    polarity : str
        `1`, `-1` or `both`.
    title : str
        Title of the tables.
    doubts : sequence of str
        Doubts about the structure, as sentences.
    impacts : bool
        Whether to list the impacts: the first in a table, without chatter, all in the data.
    """
    mechanism, given = structure.mechanism, found.given
    shown = HistoryDetails(Watched(mechanism), structure.etas if impacts else None, found.contacts, mechanism)
    notes = vertical_notes(found.first, mechanism.gravity)
    data: dict[str, Any] = {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "record": record_data(given.motion, given.factor, polarity, given.pulse) if given else None,
        "release": asked.release,
        "restitution": restitution_data(structure),
        **runs_data(found.runs, found.neighbours, shown, found.conclusion.motion),
    }
    if found.fit is None or found.to_pulse is None:
        parts = _tables(title, found.runs, found.neighbours, shown)
    else:
        checked = {1: found.to_pulse_contact} if found.to_pulse_contact is not None else {}
        of_pulse = shown._replace(contacts=checked)
        data |= {"pulse": fit_data(found.fit), "pulse_responses": histories_data(found.to_pulse, of_pulse)}
        parts = _tables(f"{title}, under the record", found.runs, found.neighbours, shown)
        alone = f"{title}, under the {found.fit.pulse.title} alone"
        parts += ["", *_tables(alone, {1: found.to_pulse}, {}, of_pulse)]
        parts.append(share_of_pulse(next(iter(found.runs.values())), found.to_pulse, found.fit.pulse.title))
    first = next(iter(found.runs.values()))
    caution = [f"Caution: {text}" for text in cautions_of(mechanism)]
    if structure.misleading and any(name != "nonlinear" for name in first):
        caution.append(f"Caution: {structure.misleading}.")
    caution += [f"Caution: {text}" for text in apart(shown.watched, found.runs)]
    caution += not_checked(mechanism, first.values())
    joints = ["Joints are named as in `rocking draw`."] if any(each.joint for each in found.contacts.values()) else []
    said = [*parts, *joints, *models_used(first), restitution_used(structure), *notes, *caution]
    return View({**data, "notes": [*doubts, *notes, *caution]}, said)


def apart(watched: Watched | None, runs: Runs) -> Iterator[str]:
    """Warn if blocks of crossing walls have slid out of one another."""
    interlock = watched.mechanism.interlock if watched is not None else None
    every = [run for histories in runs.values() for run in histories.values()]
    if watched is not None and interlock is not None and any(map(watched.is_torn_apart, every)):
        yield (
            f"at the crossing walls the structure moves by more than their overlap of {1000 * interlock.overlap:.0f} "
            "mm: the blocks have then separated and the friction assumed here is lost. The result is not valid."
        )


def vertical_notes(motion: GroundMotion | None, gravity: float) -> list[str]:
    """Return sentences on what a vertical component means for results: the range of g, and where contact is lost.

    Parameters
    ----------
    motion : GroundMotion or None
        The ground motion, as scaled.
    gravity : float
        Acceleration of gravity [m/s2].
    """
    if motion is None or motion.vertical is None:
        return []
    v = motion.vertical.acceleration / gravity
    low, high = 1 + min(float(v.min()), 0.0), 1 + max(float(v.max()), 0.0)
    swing = f"{sqrt(low):.2f} to {sqrt(high):.2f} times" if low > 0 else f"nothing to {sqrt(high):.2f} times"
    said = [
        f"Vertical ground motion: gravity as the structure feels it, g + v_g'', goes from {low:.3g} g to {high:.3g} g. "
        "All histories take it into account, at uplift and in the restoring force. The parameters of the equivalent "
        f"block are those of constant g: its frequency parameter p would go from {swing} the value given, which closed "
        "forms and spectra over p leave out."
    ]
    lost = contact_lost(motion, gravity)
    if lost is not None:
        said.append(
            f"Contact is lost: at {lost:.4g} s v_g'' comes down to -g and nothing holds the structure to the ground. "
            "It may fly, which no model here follows: do not trust the response from then on."
        )
    return said


def runs_view(title: str, runs: Runs, mechanism: Mechanism, contacts: Mapping[int, ContactDemand]) -> View:
    """Show responses without neighbours, in one polarity or both."""
    shown = HistoryDetails(Watched(mechanism), contacts=contacts, mechanism=mechanism)
    caution = [f"Caution: {text}" for text in apart(shown.watched, runs)]
    return View(lambda: runs_data(runs, {}, shown), [*_tables(title, runs, {}, shown), *caution])


def _tables(
    title: str, runs: Runs, near: Mapping[int, Neighbours], shown: HistoryDetails = NOTHING_MORE
) -> list[Table | str]:  # fmt: skip
    """Return a table and sentences for each polarity, and which of two governs."""
    parts: list[Table | str] = []
    for polarity, histories in runs.items():
        of = f"{title}, polarity {polarity}" if len(runs) > 1 else title
        end = concluded({polarity: histories}, near)
        heading = f"{of} ({headline(end)})"
        parts += [
            _table(heading, histories, shown, polarity),
            verdict(histories, agreements(histories), shown.assumed_friction(polarity)),
        ]
        parts += (
            [f"{neighbours_in_words(near[polarity])} {'' if end.remedy else next_in_words(end)}".rstrip()]
            if polarity in near
            else []
        )
        parts += shown.contact_words(polarity)
        if shown.etas is not None:
            for name, run in histories.items():
                parts += ["", *_impact_table(f"{of}: impacts, {name}", run, shown.etas)]
        parts += [""] if len(runs) > 1 else []
    if len(runs) > 1:
        ends = {sign: concluded({sign: histories}, near) for sign, histories in runs.items()}
        free = next(iter(next(iter(runs.values())).values())).ends_at_limit
        parts.append(governing_polarity(ends, concluded(runs, near).polarity, names.peaks_over(list(free))))
    return parts


def _table(title: str, histories: Histories, shown: HistoryDetails, polarity: int) -> Table:
    runs = list(histories.values())
    unknown = any(run.unknown for run in runs)
    free = runs[0].ends_at_limit
    over = "limit" if all(free) else "phi_cr or limit" if any(free) else "phi_cr"
    rows = [
        ["outcome", *(ABSENT if unknown and not run.unknown else run.words for run in runs), ""],
        [f"peak rotation / {over}", *(number(run.peak_ratio, 5) for run in runs), ""],
        ["peak rotation, clockwise", *(in_degrees(run.peak_positive) for run in runs), "deg"],
        ["peak rotation, anticlockwise", *(in_degrees(run.peak_negative) for run in runs), "deg"],
        ["first uplift", *(number(run.uplift_time, 5) for run in runs), "s"],
        [
            "overturning time",
            *(ABSENT if unknown and not run.unknown else number(run.overturning_time, 5) for run in runs),
            "s",
        ],
        ["impacts", *(str(len(run.felt)) for run in runs), ""],
    ]
    if unknown:
        rows.insert(1, ["known until", *(number(run.known_to, 5) for run in runs), "s"])
        rows.insert(3, [f"lower bound of peak / {over}", *(number(_bound(run), 5) for run in runs), ""])
    if shown.watched is not None:
        rows += _movement_rows([shown.watched.peaks(run) for run in runs])
    if polarity in shown.contacts and shown.mechanism is not None:
        per, unit = force_unit(shown.mechanism)
        shear = number(shown.contacts[polarity].base_shear / per, 4)
        rows.append(
            ["base shear, without impacts", *(shear if run.model == "nonlinear" else ABSENT for run in runs), unit]
        )
    heads = [
        f"{head},\nuntil {number(run.known_to, 4)} s" if run.unknown else head
        for head, run in zip(model_heads(histories, unknown=unknown), runs, strict=True)
    ]
    return Table(title, ["", *heads, "unit"], rows, numbers=range(1, len(runs) + 1))


def model_heads(models: Iterable[str], *, unknown: bool) -> list[str]:
    """Return headings of models; if the outcome of the structure is unknown, those of its block state that."""
    return [f"block,\n{model}" if unknown and model != "nonlinear" else model for model in models]


def _bound(run: History) -> float:
    return run.lower_bound if run.unknown else nan


def _movement_rows(moved: Sequence[Movements]) -> list[list[str]]:
    rows = [["peak impact velocity", *(number(each.impact_velocity, 4) for each in moved), "m/s"]]
    for k, point in enumerate(moved[0].points):
        rows.append(
            [
                f"{point.name}, horizontal displacement",
                *(number(1000 * each.points[k].horizontal, 4) for each in moved),
                "mm",
            ]
        )
    for k, tie in enumerate(moved[0].ties):
        rows.append([f"{tie.name}, force", *(number(each.ties[k].force / 1000, 4) for each in moved), "kN"])
        rows.append([f"{tie.name}, elongation", *(number(1000 * each.ties[k].elongation, 4) for each in moved), "mm"])
    return rows


def _impact_table(title: str, history: History, etas: tuple[float, float]) -> list[Table | str]:
    rows = [
        [f"{time:.4f}", SENSE[direction], number(before, 4), number(after, 4)]
        for time, direction, before, after in _impacts(history.felt[:FIRST], etas)
    ]
    table = Table(title, ["time [s]", "ends motion", "before [rad/s]", "after [rad/s]"], rows, numbers=(0, 2, 3))
    felt, chatter = len(history.felt), history.impact_count - len(history.felt)
    said = [f"{felt - FIRST} more impacts follow"] if felt > FIRST else []
    said += [f"{chatter} weaker than {100 * FELT:g} % of the strongest are left out"] if chatter else []
    return [table, f"{' and '.join(said)}: the JSON output lists them."] if said else [table]


def share_of_pulse(histories: Histories, to_pulse: Histories, called: str) -> str:
    """Return a sentence that compares the response to a record with that to its pulse (named `called`) alone."""
    model: ModelName = "nonlinear" if "nonlinear" in histories else next(iter(histories))
    whole, alone = histories[model], to_pulse[model]
    if whole.unknown or alone.unknown:
        what = "record" if whole.unknown else called
        return (
            f"By the {model} model, how much the {called} causes is not known: the outcome under the {what} is unknown."
        )
    if whole.fell or alone.fell or (whole.peak_ratio and not alone.peak_ratio):
        return f"By the {model} model, it {whole.words} under the record; under the {called} alone it {alone.words}."
    if not whole.peak_ratio:
        return f"By the {model} model, it {whole.words} under the record."
    share = 100 * alone.peak_ratio / whole.peak_ratio
    return (
        f"By the {model} model, the peak rotation under the {called} alone is {share:.3g} % of that under the record."
    )
