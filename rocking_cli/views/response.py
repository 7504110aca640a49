"""View of the response of a structure to one ground motion, in one polarity or both, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from math import degrees, inf, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.dynamics.history import MIN_IMPACT_RATE, BlockPeaks, History, contact_lost
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.dynamics.sliding import Slid
from rocking_cli.dynamics.verdict import Agreement, disagree
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.structure import Structure
from rocking_cli.studies.movements import Movements, PointPeak, TiePeak, Watched
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.studies.response import ByPolarity, Histories, Response
from rocking_cli.views.cautions import bound_data, cautions_of
from rocking_cli.views.column import Column, data_of, of, of_part, only_shown, rounded, table_across, table_of
from rocking_cli.views.conclusion import conclusion_data, governing_polarity, next_in_words
from rocking_cli.views.engines import agreement, engines_data, engines_in_words, joints_across, joints_shown
from rocking_cli.views.neighbours import neighbours_data, neighbours_in_words
from rocking_cli.views.restitution import restitution_data, restitution_sentences
from rocking_cli.views.verdict import (
    ONE_SAMPLE,
    SENSE,
    contact_data,
    contact_parts,
    unchecked,
    verdict,
    verdicts,
    why_unknown,
)
from rocking_cli.views.view import ASIDE, Aside, Table, View, force_unit, in_degrees, number, processing_data

if TYPE_CHECKING:
    from rocking_cli.excitation.pulse_fit import PulseFit

LINEAR = frozenset(MODELS[1:])  # the models that are equivalent blocks
MAX_LISTED_IMPACTS = 12  # number of impacts of a model in its table; the data have all


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
        "unit": motion.source_unit,
        "pga_g": motion.of_ground.pga_g,
        "format": motion.format,
        **processing_data(motion),
    }


AGREEMENT: tuple[Column[Agreement], ...] = (
    Column("grade", of("grade.key")),
    Column("uplift_error", of("uplift_error")),
    Column("peak_error", of("peak_error")),
    Column("delay", of("peak_delay")),
    Column("rms_difference", of("difference")),
)


def runs_data(
    found: Response, watched: Watched, etas: tuple[float, float] | None = None, structure: Structure | None = None
) -> dict[str, Any]:
    """Return responses, neighbours and the conclusion as plain data, by polarity if there are two.

    Parameters
    ----------
    found : Response
        The response of the structure.
    watched : Watched
        Points and ties of the structure, whose movement is listed.
    etas : tuple of float, optional
        Restitution of impacts that end positive and negative motion; with it the impacts are listed.
    structure : Structure, optional
        The structure: with it, both engines are compared.
    """
    each: dict[str, dict[str, Any]] = {
        str(sign): {
            "responses": histories_data(found, sign, watched, etas),
            # An equivalent block has no joints, and is not compared with unknown outcomes.
            "agreement": {
                name: data_of(AGREEMENT, found.agreement[sign][name]) if name in found.agreement[sign] else None
                for name in histories
                if name in LINEAR and "nonlinear" in histories
            },
            "neighbours": neighbours_data(found.neighbours[sign]) if sign in found.neighbours else None,
            "verdict": verdict(histories, found.agreement[sign], found.assumed_friction(sign)),
        }
        for sign, histories in found.runs.items()
    }
    if structure is not None:
        for sign, data in each.items():
            both_engines = found.engines.get(int(sign))
            data["engines"] = both_engines and engines_data(both_engines, found.contacts[int(sign)], structure)
            data["no_blocks"] = found.no_blocks.get(int(sign))
    both = {"polarities": each, "governs": found.conclusion.polarity}
    return {"conclusion": conclusion_data(found.conclusion)} | (each.popitem()[1] if len(each) == 1 else both)


def histories_data(
    found: Response, sign: int, watched: Watched, etas: tuple[float, float] | None = None
) -> dict[str, Any]:
    """Return the response of each model under one polarity as plain data; arguments are those of `runs_data`."""
    data: dict[str, Any] = {}
    for name, run in found.runs[sign].items():
        moved = watched.peaks(run) if name != "blocks" else None  # free blocks do not move as the mechanism does
        data[name] = {
            **data_of(_columns(), run),
            **known_data(run),
            "impact_velocity": moved.impact_velocity if moved is not None else None,
            "points": {each.name: data_of(POINTS, each) for each in moved.points} if moved is not None else {},
            "slip": data_of(SLIP, run.slid) if run.slid is not None else None,
            "bound": bound_data(run.bound) if run.bound is not None else None,
            "ties": {each.name: data_of(TIES, each) for each in moved.ties} if moved is not None else {},
            "blocks": data_of(BLOCKS, run.blocks) if run.blocks is not None else None,
        }
        if etas is not None and not run.by_blocks:
            data[name]["impact_list"] = [data_of(IMPACTS, each) for each in _impacts(run.impacts, etas)]
        # Linear models have no joints.
        checked = found.contacts[sign] if name == "nonlinear" and sign in found.contacts else None
        data[name]["contact"] = contact_data(checked, watched.mechanism) if checked is not None else None
    return data


def models_used(models: Iterable[ModelName]) -> Iterator[str]:
    """Yield a sentence on what the models are; none for the nonlinear model alone."""
    names = list(models)
    linear = [name for name in names if name in LINEAR]
    if linear:
        itself = "nonlinear is the structure itself, " if "nonlinear" in names else ""
        scaled = " and ".join(name.replace("linear", "kappa") for name in linear)
        what = (
            f"{' and '.join(linear)} {'are' if len(linear) > 1 else 'is'} its linearised equivalent block with {scaled}"
        )
        yield Aside(f"Models: {itself}{what} (see `rocking equiv`).")


def ending(outcome: OneOutcome) -> str:
    """Return the keyword for how a motion ended, for JSON."""
    if outcome.unknown:
        return names.UNKNOWN
    if outcome.off_edge:
        return "falls_off"
    return "overturned" if outcome.fell else "still_rocking" if outcome.still_rocking else "at_rest"


def _is_unknown(outcome: OneOutcome) -> bool | None:
    """Return whether an outcome is unknown; None if the joints of the structure were not checked."""
    checked = not isinstance(outcome, History) or outcome.model != "nonlinear" or outcome.check is not None
    return outcome.unknown if outcome.unknown or checked else None


KNOWN: tuple[Column[OneOutcome], ...] = (
    Column("unknown", _is_unknown, words="Whether the outcome is unknown; null if the joints are not checked"),
    Column("known_to", lambda outcome: outcome.known_to if outcome.unknown else None, "s",
           words="Time from which it is unknown: peaks and impacts are those until then"),
    Column("known_to_reason", lambda outcome: why_unknown(outcome) if isinstance(outcome, History) else None,
           words="The joint, or what else ends the result at `known_to`, in words"),
    Column("peak_lower_bound", lambda outcome: outcome.lower_bound if outcome.unknown else None,
           words="Peak over phi_cr until the first joint ceased to bear: the structure rocks at least so far"),
    Column("opening", of("opening"),
           words="Largest opening or slip of a joint over D_cr, of the whole history, beyond `known_to` too"),
)  # fmt: skip
ENDING: Column[Any] = Column(
    "outcome", ending,
    words="How the motion ended: at_rest (it rocked or not, see `peak_ratio`), still_rocking, overturned, falls_off "
    "(an edge, as free blocks) or unknown",
)  # fmt: skip


def known_data(outcome: OneOutcome) -> dict[str, Any]:
    """Return, as plain data, until when a motion is known and why; linear models are always known."""
    return data_of(KNOWN, outcome)


def not_checked(mechanism: Mechanism, histories: Iterable[History]) -> list[str]:
    """Return a caution if the joints of a nonlinear history are not checked; otherwise an empty list."""
    if all(each.model != "nonlinear" or each.check is not None for each in histories):
        return []
    return [unchecked(why=mechanism.unchecked)]


def _columns(*, unknown: bool = False, slides: bool = False, over: str = "phi_cr") -> list[Column[History]]:
    """Return the columns of the table of histories, except those in `KNOWN`.

    Parameters
    ----------
    unknown : bool
        Whether the outcome of the structure is unknown: the table then leaves out those of its blocks.
    slides : bool
        Whether the structure slides, which its blocks do not: the table then leaves out their outcomes.
    over : str
        What peaks are divided by.
    """

    def of_structure(value: Callable[[History], Any]) -> Callable[[History], Any]:
        hidden = unknown or slides
        return lambda run: None if hidden and not (run.unknown or run.slip or run.by_blocks) else value(run)

    until, bound = ("known until", f"lower bound of peak / {over}") if unknown else (None, None)
    return [
        Column("engine", lambda run: "blocks" if run.by_blocks else "exact"),
        ENDING,
        only_shown("outcome", of_structure(of("words"))),
        only_shown(until, of("known_to"), rounded(5), "s"),
        Column("peak_ratio", of("peak_ratio"), "", f"peak rotation / {over}", rounded(5)),
        only_shown(bound, lambda run: run.lower_bound if run.unknown else None, rounded(5)),
        Column("peak_positive", of("peak_positive"), "deg", "peak rotation, clockwise", in_degrees),
        Column("peak_negative", of("peak_negative"), "deg", "peak rotation, anticlockwise", in_degrees),
        Column("peak_rate", of("peak_rate"), "rad/s", "peak angular velocity", rounded(4)),
        Column("peak_rate_over_p", lambda run: run.peak_rate / run.p, "rad"),
        Column("peak_rate_positive", of("peak_rate_positive"), "rad/s"),
        Column("peak_rate_negative", of("peak_rate_negative"), "rad/s"),
        Column("uplift_time", of("uplift_time"), "s", "first uplift", rounded(5)),
        Column("overturned", of("overturned")),
        Column("overturning_time", of("overturning_time")),
        only_shown("overturning time", of_structure(of("overturning_time")), rounded(5), "s"),
        Column("overturning_direction", lambda run: Direction(run.fell_to).label if run.fell else None),
        Column("impacts", lambda run: len(run.felt) if run.rotates else None, head="impacts"),
        Column("impacts_all", lambda run: run.impact_count if run.rotates else None),
        Column("contact_lost", of("contact_lost")),
        Column("ratio_of", lambda run: "limit" if any(run.ends_at_limit) else "phi_cr"),
    ]


def _resolved(factor: float, value: float, least: float) -> str:
    return f"< {number(factor * least, 2)}" if value <= least else number(factor * value, 4)


BLOCKS: tuple[Column[BlockPeaks], ...] = (
    Column("falls", lambda blocks: blocks.fell or None),
    Column("falls_off", lambda blocks: blocks.off or None),
    Column("rotation", lambda blocks: blocks.turned[0]),
    Column("rotation_of", lambda blocks: blocks.turned[1]),
    Column("displacement", lambda blocks: blocks.moved[0]),
    Column("displacement_of", lambda blocks: blocks.moved[1]),
    Column("residual", lambda blocks: blocks.left[0]),
    Column("residual_of", lambda blocks: blocks.left[1] or None),
    only_shown("peak rotation of a block", lambda each: _resolved(degrees(1), each.turned[0], each.least_turn),
               unit="deg"),
    only_shown("displacement of a block", lambda each: _resolved(1e3, each.moved[0], each.least), unit="mm"),
    only_shown("its displacement at rest", lambda each: _resolved(1e3, each.left[0], each.least), unit="mm"),
)  # fmt: skip
POINTS: tuple[Column[PointPeak], ...] = (
    Column("at", lambda point: [point.at.real, point.at.imag]),
    Column("horizontal", of("horizontal")),
    Column("vertical", of("vertical")),
)
SLIP: tuple[Column[Slid], ...] = (
    Column("largest", of("largest"), "m", "largest slip, positive to the right", rounded(4)),
    Column("residual", of("residual"), "m", "slip at the end", rounded(4)),
    Column("path", of("path"), "m", "length of the path of the slip", rounded(4)),
)
TIES: tuple[Column[TiePeak], ...] = (Column("peak_force", of("force")), Column("peak_elongation", of("elongation")))


class Impact(NamedTuple):
    """An impact: its time [s], the direction that ends, and the rates before and after [rad/s]."""

    time: float
    direction: Direction
    before: float
    after: float


IMPACTS: tuple[Column[Impact], ...] = (
    Column("time", of("time"), "s", "time [s]", "{:.4f}".format),
    Column("direction", of("direction.label")),
    only_shown("ends motion", of("direction"), SENSE.__getitem__, text=True),
    Column("rate_before", of("before"), "rad/s", "before [rad/s]", rounded(4)),
    Column("rate_after", of("after"), "rad/s", "after [rad/s]", rounded(4)),
)


def _impacts(impacts: Reals, etas: tuple[float, float]) -> Iterator[Impact]:
    """Yield impacts of a history; after each, the rate is eta of that before."""
    for time, sign, rate in impacts.tolist():
        yield Impact(time, Direction(int(sign)), rate, etas[0 if sign > 0 else 1] * rate)


def view(
    found: Response, conditions: Conditions, title: str, doubts: Sequence[str] = (), *, impacts: bool, linear: bool
) -> View:  # fmt: skip
    """Show the responses to one motion.

    Parameters
    ----------
    found : Response
        The response of the structure.
    conditions : Conditions
        The structure and the conditions of the run.
    title : str
        Title of the tables.
    doubts : sequence of str
        Doubts about the structure, as sentences.
    impacts : bool
        Whether to list the impacts: the first in a table, without chatter, all in the data.
    linear : bool
        Whether equivalent blocks are shown on terminals in short too.
    """
    structure, given = conditions.structure, found.given
    mechanism = structure.mechanism
    watched, etas = Watched(mechanism), structure.etas if impacts else None
    runs = [run for histories in found.runs.values() for run in histories.values()]
    until = max(run.overturning_time if run.fell else inf for run in runs)
    notes = vertical_notes(found.first, mechanism.gravity, until)
    data: dict[str, Any] = {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "record": record_data(given.motion, given.factor, conditions.polarity, given.pulse) if given else None,
        "release": conditions.release,
        "restitution": restitution_data(structure) if structure.no_model is None else None,
        **runs_data(found, watched, etas, structure),
    }
    if found.fit is None or found.to_pulse is None:
        parts = _tables(title, found, conditions, watched, etas, linear=linear)
    else:
        pulse = found.fit.pulse.title
        data |= {"pulse": fit_data(found.fit), "pulse_responses": histories_data(found.to_pulse, 1, watched, etas)}
        parts = [
            *_tables(f"{title}, under the record", found, conditions, watched, etas, linear=linear),
            "",
            *_tables(f"{title}, under the {pulse} alone", found.to_pulse, conditions, watched, etas, linear=linear),
            share_of_pulse(found, found.to_pulse, pulse),
        ]
    first = next(iter(found.runs.values()))
    rocks = structure.no_model is None
    remarks = cautions_of(mechanism) if rocks else [f"{structure.no_model}. Free blocks alone have no rotation phi."]
    caution = [f"Caution: {text}" for text in remarks]
    if rocks and structure.misleading and not LINEAR.isdisjoint(first):
        caution.append(f"Caution: {structure.misleading}.")
    caution += [f"Caution: {text}" for text in apart(watched, found.runs)]
    caution += not_checked(mechanism, first.values())
    named = any(each.joint for each in found.contacts.values())
    joints = [Aside("Joints are named as in `rocking draw`.")] if named else []
    restitution = [*restitution_sentences(structure)] if "nonlinear" in first else []
    by_blocks = sum("blocks" in runs for runs in found.runs.values())
    engine = "auto" if by_blocks and conditions.goes_on else conditions.engine
    restitution += engines_in_words(engine, by_blocks, mechanism)
    sentences = [*parts, *joints, *models_used(first), *restitution, *notes, *caution]
    return View({**data, "notes": [*doubts, *notes, *caution]}, sentences)


def apart(watched: Watched, runs: ByPolarity) -> Iterator[str]:
    """Warn if blocks of crossing walls have slid out of one another."""
    interlock = watched.mechanism.interlock
    every = [run for histories in runs.values() for run in histories.values()]
    if interlock is not None and any(map(watched.is_torn_apart, every)):
        yield (
            f"at the crossing walls the structure moves by more than their overlap of {1000 * interlock.overlap:.0f} "
            "mm: the blocks have then separated and the friction assumed here is lost. The result is not valid."
        )


def vertical_notes(motion: GroundMotion | None, gravity: float, until: float = inf) -> list[str]:
    """Return sentences on what a vertical component means for results: the range of g, and where contact is lost.

    Parameters
    ----------
    motion : GroundMotion or None
        The ground motion, as scaled.
    gravity : float
        Acceleration of gravity [m/s2].
    until : float
        Time at which the structure overturns [s]: contact that is lost later does not matter.
    """
    if motion is None or motion.vertical is None:
        return []
    v = motion.vertical.acceleration / gravity
    low, high = 1 + min(float(v.min()), 0.0), 1 + max(float(v.max()), 0.0)
    swing = f"{sqrt(low):.2f} to {sqrt(high):.2f} times" if low > 0 else f"nothing to {sqrt(high):.2f} times"
    sentence = (
        f"Vertical ground motion: gravity as the structure feels it, g + v_g'', goes from {low:.3g} g to {high:.3g} g. "
        "All histories take it into account, at uplift and in the restoring force. The parameters of the equivalent "
        f"block are those of constant g: its frequency parameter p would go from {swing} the value given, which closed "
        "forms and spectra over p leave out."
    )
    sentences: list[str] = [Aside(sentence)]
    lost = contact_lost(motion, gravity)
    if lost is not None and lost <= until:
        sentences.append(
            f"Contact is lost: at {lost:.4g} s v_g'' comes down to -g and nothing holds the structure to the ground. "
            "It may fly, which no model here follows: do not trust the response from then on."
        )
    return sentences


def _tables(
    title: str, found: Response, conditions: Conditions, watched: Watched, etas: tuple[float, float] | None = None,
    *, linear: bool,
) -> list[Table | str]:  # fmt: skip
    """Return sentences and a table for each polarity, and which of two governs; joints of free blocks if requested."""
    parts: list[Table | str] = []
    free = next(iter(found.values())).ends_at_limit
    for sign, histories in found.runs.items():
        under = f"{title}, polarity {sign}" if len(found.runs) > 1 else title
        end = found.conclusions[sign]
        both = found.engines.get(sign)
        compared = joints_across(both, found.contacts[sign]) if both is not None and not conditions.goes_on else ()
        itself, of_blocks, doubts = verdicts(histories, found.agreement[sign], found.assumed_friction(sign))
        known = not any(run.unknown for run in histories.values())
        shown = linear or (known and disagree(histories)) or LINEAR.isdisjoint(histories)
        parts.append(f"{under}. {' '.join([*itself, *of_blocks * shown, *doubts])}")
        if sign in found.neighbours:
            following = "" if end.remedy else next_in_words(end)
            parts.append(f"{neighbours_in_words(found.neighbours[sign])} {following}".rstrip())
        parts.append(outcome_table(found, sign, watched, compared, linear=shown))
        parts += [Aside(" ".join(of_blocks))] * bool(of_blocks and not shown)
        if both is not None:
            parts.append(agreement(both))
            if not both.exact.unknown:
                parts.append(f"Next: {ONE_SAMPLE.format('blocks')}")
            parts += [] if conditions.goes_on else joints_shown(both, conditions.structure.opening)
        if sign in found.no_blocks:
            parts.append(f"{found.no_blocks[sign][:1].upper()}{found.no_blocks[sign][1:]}.")
        if sign in found.contacts:
            parts += contact_parts(found.contacts[sign], watched.mechanism)
        if etas is not None:
            for name, run in ((name, run) for name, run in histories.items() if not run.by_blocks):
                parts += ["", *_impact_table(f"{under}: impacts, {name}", run, etas)]
        parts += [""] if len(found.runs) > 1 else []
    if len(found.runs) > 1:
        parts.insert(0, governing_polarity(found.conclusions, found.conclusion.polarity, names.peaks_over(free)))
    return parts


def outcome_table(
    found: Response, sign: int, watched: Watched, more: Iterable[Column[History]] = (), *, linear: bool
) -> Table:  # fmt: skip
    """Return a table of outcomes, peaks and times under one polarity, with a column for each model, and more rows.

    Terminals show what the sentences above it state in full only, and so equivalent blocks if not `linear`.
    """
    runs = list(found.runs[sign].values())
    unknown = any(run.unknown for run in runs)
    free = runs[0].ends_at_limit
    over = "limit" if all(free) else "phi_cr or limit" if any(free) else "phi_cr"
    slides = any(run.slip for run in runs)
    columns = [
        *_columns(unknown=unknown, slides=slides, over=over),
        *(of_part(SLIP, of("slid")) if slides else ()),
        *_movements({run.model: watched.peaks(run) for run in runs if run.model != "blocks"}),
        *(of_part(BLOCKS, of("blocks")) if any(run.blocks is not None for run in runs) else ()),
    ]
    if sign in found.contacts:
        per, unit = force_unit(watched.mechanism)
        shear = found.contacts[sign].base_shear / per
        columns.append(
            only_shown(
                "base shear, without impacts", lambda run: shear if run.model == "nonlinear" else None, rounded(4), unit
            )
        )
    columns += more
    heads = [
        f"{head},\nuntil {number(run.known_to, 4)} s" if run.unknown else head
        for head, run in zip(model_heads(found.runs[sign], unknown=unknown), runs, strict=True)
    ]
    aside = [run.model in LINEAR and not linear for run in runs]
    if aside.count(False) == 1:
        stated = "outcome", "known until", f"peak rotation / {over}", f"lower bound of peak / {over}"
        columns = [replace(each, rank=ASIDE) if each.head in stated else each for each in columns]
    return table_across("", columns, heads, runs, aside=aside)


def model_heads(models: Iterable[str], *, unknown: bool) -> list[str]:
    """Return headings of models; if the outcome of the structure is unknown, those of its block state that."""
    heads = {"nonlinear": "nonlinear", "blocks": "free blocks"}
    return [heads.get(model, f"block,\n{model}" if unknown else model) for model in models]


def _movements(moved: Mapping[str, Movements]) -> Iterator[Column[History]]:
    """Yield the columns of the movements of a structure, given by model."""
    if not moved:
        return

    def peak(kind: str, k: int, name: str, factor: float) -> Callable[[History], float | None]:
        return lambda run: factor * getattr(getattr(moved[run.model], kind)[k], name) if run.model in moved else None

    yield only_shown(
        "peak impact velocity", lambda run: moved[run.model].impact_velocity if run.model in moved else None,
        rounded(4), "m/s",
    )  # fmt: skip
    any_model = next(iter(moved.values()))
    for k, point in enumerate(any_model.points):
        yield only_shown(
            f"{point.name}, horizontal displacement", peak("points", k, "horizontal", 1e3), rounded(4), "mm"
        )
    for k, tie in enumerate(any_model.ties):
        yield only_shown(f"{tie.name}, force", peak("ties", k, "force", 1e-3), rounded(4), "kN")
        yield only_shown(f"{tie.name}, elongation", peak("ties", k, "elongation", 1e3), rounded(4), "mm")


def _impact_table(title: str, history: History, etas: tuple[float, float]) -> list[Table | str]:
    table = table_of(title, IMPACTS, _impacts(history.felt[:MAX_LISTED_IMPACTS], etas))
    felt, chatter = len(history.felt), history.impact_count - len(history.felt)
    sentences = [f"{felt - MAX_LISTED_IMPACTS} more impacts follow"] if felt > MAX_LISTED_IMPACTS else []
    sentences += [f"{chatter} weaker than {100 * MIN_IMPACT_RATE:g} % of the strongest are left out"] if chatter else []
    return [table, f"{' and '.join(sentences)}: the JSON output lists them."] if sentences else [table]


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
