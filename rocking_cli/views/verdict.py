"""The time histories of a structure in words: outcomes, how well its equivalent blocks agree, and its joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from math import isfinite, isnan
from typing import Any

from rocking_cli import names
from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.equivalence import Grade, grade
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.joints import JointCheck
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.sliding import Slid
from rocking_cli.dynamics.verdict import NEAR_OVERTURNING, SAME_PEAK_DELAY, Agreement, disagree, remedy
from rocking_cli.names import percent
from rocking_cli.studies.contact import NEAR_PEAK, ContactDemand, SupportDemand
from rocking_cli.views.column import Column, data_of, of, rounded
from rocking_cli.views.view import ABSENT, Aside, force_unit, number

SENSE = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}
TIME_TOLERANCE = 1e-2  # s within which two events are at the same time
ASSUMED = (
    "The friction required, {:.3g}, is more than the {:g} usual for masonry: the result assumes that nothing slides."
)
INVALID_REASON = "the model no longer holds: a joint opens or slides too far, a tie yields, or something is met"
NO_JOINTS = "The equivalent blocks have no joints, so their results are not those of the structure."
MIN_OPENING = 1e-6  # share of D_cr: a smaller opening is reported as none
# From a comparison with free blocks: a peak below SMALL_PEAK has an error of some 20 % if a joint opens by more than
# SMALL_PEAK_OPENING of D_cr.
SMALL_PEAK, SMALL_PEAK_OPENING, SMALL_PEAK_ERROR = 0.02, 0.001, 0.2
NEXT_STEP = "Next: {}`rocking margin` shows up to which scale factor the outcome is known. Under this motion, {}."
GO_ON = "`rocking respond` with the engine `auto` simulates what happens from then on, as free blocks; "
ONE_SAMPLE = (
    "`rocking margin` with the engine `{}` gives shares of neighbouring motions, as one history is one sample of a "
    "chaotic motion."
)
OVERTURNS = "assume that it overturns"
REMEDIES = {
    "hinge_at_joint": f"describe the structure as a linkage that hinges at the joint that opens, or {OVERTURNS}",
    "hold_joint": f"anchor the joint that slides or justify a higher friction, or {OVERTURNS}",
    "stronger_bar": f"give the tie a section or a steel with which it does not yield, or {OVERTURNS}",
    "assume_overturning": OVERTURNS,
    "give_restitution": "give a measured `restitution` (or `rebound`)",
}
NOT_VALID_BEYOND = ": the result is not valid beyond that time"


SUPPORTS: tuple[Column[SupportDemand], ...] = (
    Column("support", of("support")),
    Column("way", lambda each: [each.way.real, each.way.imag]),
    Column("most", of("most")),
    Column("least", of("least")),
)


def unchecked(name: str = "", why: str = "it does not say which of them stay closed") -> str:
    """Return the caution that the joints of a structure are not checked.

    Parameters
    ----------
    name : str
        The name of the structure, if it is one of several.
    why : str
        The reason, or what to give, see `Mechanism.unchecked`.
    """
    of = f"{name}: " if name else ""
    return f"Caution: {of}the joints of this mechanism are not checked: {why}."


def joints_in_words(
    history: History, assumed_friction: float | None = None, blocks: History | None = None
) -> str:  # fmt: skip
    """Return whether the joints hold in a nonlinear history, in words; empty if none could open, or none is checked.

    Parameters
    ----------
    history : History
        History of the nonlinear model.
    assumed_friction : float, optional
        Friction that the joints require, if the structure gives none and it is more than masonry usually has. The
        result is then not called valid.
    blocks : History, optional
        History of free blocks, which go on where the outcome is unknown.

    Returns
    -------
    str
        A few sentences: all joints hold; or one opens by so little that the result is valid; or until when the result
        is valid, why, and what to do next.
    """
    check = history.check
    slides = [] if assumed_friction is None else [ASSUMED.format(assumed_friction, MASONRY_FRICTION)]
    if history.unmeasured:
        return f"{_until(history, blocks)} Next: {REMEDIES[remedy(history)]}."
    if history.unknown and blocks is not None:
        following = f"Next: {ONE_SAMPLE.format('auto')} By one degree of freedom alone, {REMEDIES[remedy(history)]}."
        return " ".join([_until(history, blocks), *slides, following])
    if history.unknown:
        following = NEXT_STEP.format(GO_ON * history.witness, REMEDIES[remedy(history)])
        return " ".join([_until(history), *slides, following])
    if check is None or history.slip:
        return " ".join(slides)
    if isnan(check.warned) and check.alone:
        return " ".join(slides)
    assumed = [f"Not checked, but assumed to hold: {', '.join(check.asserted)}."] if check.asserted else []
    if check.largest >= MIN_OPENING * check.reach and not isnan(check.warned):
        return " ".join([*_opens(history, check, valid=not slides), *slides, *assumed])
    which = f" ({'; '.join(check.checked)})" if check.checked else ""
    but = f", except the joint between {check.warned_joint} for an instant at {check.warned:.4g} s"
    when = "throughout the motion" if check.at_rest else "while the structure rocks"
    bear = f"All checked joints bear {when}{which}{'' if isnan(check.warned) else but}."
    return " ".join([bear, *slides, *assumed])


def _opens(history: History, check: JointCheck, *, valid: bool) -> Iterator[str]:
    """Yield by how much a joint opens, less than the limit, and what this means for outcome and peak."""
    uncertain = 0 < history.peak_ratio < SMALL_PEAK and check.largest > SMALL_PEAK_OPENING * check.reach
    kept = "outcome remains" if uncertain else "outcome and the peak remain"
    yield (
        f"The joint between {check.largest_joint} opens or slides by up to {_small(check.largest, 'm')} "
        f"({percent(check.largest / check.reach)} of D_cr; the limit is {percent(check.limit)}), for at most "
        f"{_small(check.longest, 's')} at a time: less than the limit{f', so the {kept} valid' if valid else ''}."
    )
    if uncertain:
        yield (
            f"The peak is uncertain by some {percent(SMALL_PEAK_ERROR)}, as it is below {SMALL_PEAK:g} of the "
            f"{history.reference} and the opening is above {percent(SMALL_PEAK_OPENING)} of D_cr."
        )


def why_unknown(history: History) -> str | None:
    """Return why a history is not valid beyond its `known_to`, in words; None if all of it is valid."""
    check = history.check
    if not history.unknown:
        return None
    if history.unmeasured:
        return "it has an impact, and its restitution is not known"
    if history.apart:
        return (
            "three or more columns may fall out of step at an impact, and one that carries nothing, rocking alone, "
            "ends otherwise"
        )
    if history.bound is not None:
        return history.bound.words
    if history.slid is not None and (there := history.slid.arrives) is not None:
        return f"it slides to {there.words}, {there.distance:.3g} m away"
    if check is None or check.reason in (None, "weightless"):
        return "nothing holds the structure down, as v_g'' comes down to -g"
    if check.reason == "crushes":
        return f"the joint between {check.joint} crushes: its normal force exceeds its strength"
    does = "has slid by" if check.reason == "slides" else "has opened by"
    limit = f"{percent(check.limit)} of D_cr = {check.reach:.3g} m, by which the farthest block moves up to phi_cr"
    return f"the joint between {check.joint} {does} {_small(check.limit * check.reach, 'm')} ({limit})"


def unknown_after(history: History, blocks: History | None = None) -> str:
    """Return the sentence that an outcome is unknown: until when it is known, why not beyond, and what blocks do."""
    sentence = f"The outcome is unknown after {history.known_to:.4g} s: then {why_unknown(history)}"
    return f"{sentence}." if blocks is None else f"{sentence}; as free blocks, it {blocks_do(blocks)}."


def _until(history: History, blocks: History | None = None) -> str:
    """Return until when a history is valid and why not beyond, in words, with the lower bound of the peak."""
    sentence = (
        unknown_after(history, blocks)
        if blocks is not None
        else f"{unknown_after(history)} The structure may overturn."
    )
    over = "its kinematic limit" if any(history.ends_at_limit) else "its critical rotation"
    if not history.peak_ratio:
        return f"{sentence} Until then it does not uplift."
    less = _less_by_blocks(history, blocks) if blocks is not None else ""
    if isfinite(history.warned) and history.lower_bound < history.peak_ratio:
        return (
            f"{sentence} Until then the model, which keeps the joints closed, has a peak of {history.peak_ratio:.4g} "
            f"of {over}. A lower bound of the peak is {history.lower_bound:.4g}, that before any joint opens or slides."
            f"{less}"
        )
    return f"{sentence} A lower bound of the peak is {history.lower_bound:.4g} of {over}, that until then.{less}"


def _less_by_blocks(history: History, blocks: History) -> str:
    """Return by how much the peak of free blocks is below the lower bound, as a sentence; empty if it is not."""
    from rocking_cli.studies.engines.free import MOVED

    if not blocks.peak_ratio < history.lower_bound or (not blocks.lifted and history.lower_bound <= MOVED):
        return ""
    less = percent(1 - blocks.peak_ratio / history.lower_bound)
    return f" The peak of free blocks is {less} less than this bound: the engines differ by this while all joints hold."


def _small(value: float, unit: str) -> str:
    return f"{value:.3g} {unit}" if value >= 0.5 else f"{1000 * value:.3g} m{unit}"


def verdict(
    histories: Mapping[ModelName, History], agreed: Mapping[ModelName, Agreement], assumed_friction: float | None = None
) -> str:
    """Return whether a structure uplifts, how far it rocks, whether it overturns, and which model to trust, in words.

    Arguments are those of `verdicts`.
    """
    return " ".join(sentence for part in verdicts(histories, agreed, assumed_friction) for sentence in part)


def verdicts(
    histories: Mapping[ModelName, History], agreed: Mapping[ModelName, Agreement], assumed_friction: float | None = None
) -> tuple[list[str], list[str], list[str]]:
    """Return sentences on the structure, on its equivalent blocks, and on what to do before relying on either.

    Parameters
    ----------
    histories : mapping of str to History
        Histories of one or more models of the same structure and motion.
    agreed : mapping of str to Agreement
        The agreement of the equivalent blocks, see `rocking_cli.dynamics.verdict.agreements`.
    assumed_friction : float, optional
        Friction that the result assumes, see `joints_in_words`.

    """
    blocks = histories.get("blocks")
    histories = {name: run for name, run in histories.items() if name != "blocks"}
    if not histories:
        assert blocks is not None
        return [f"As free blocks, the structure {blocks_do(blocks)}."], [], []
    best: ModelName = "nonlinear" if "nonlinear" in histories else next(iter(histories))
    run = histories[best]
    by = "" if best == "nonlinear" or len(histories) == 1 else f"By {best} the"
    sentences = [] if run.unknown else [f"{by or 'The'} structure {ends(run)}."]
    if run.unknown or (best == "nonlinear" and run.check is not None):
        sentences += filter(None, [joints_in_words(run, assumed_friction, blocks)])
    if blocks is not None and not run.unknown:
        sentences.append(f"As free blocks, it {blocks_do(blocks)}.")
    if (run.unknown or run.slip) and len(histories) > 1:
        linear = [NO_JOINTS] if run.bound is None else []
    else:
        linear = blocks_in_words(histories, agreed, {name: name for name in histories})
    cautions = []
    if not run.unknown and disagree(histories):
        cautions.append("Do not trust any of them alone: run weaker and stronger motions as well.")
    elif not run.fell and not run.unknown and run.peak_ratio > NEAR_OVERTURNING and not any(run.ends_at_limit):
        cautions.append("This is close to overturning: run weaker and stronger motions before relying on it.")
    if still := [name for name, each in histories.items() if each.still_rocking]:
        cautions.append(
            f"{', '.join(still)}: {names.STILL_ROCKING} long after the end of the record, and certain not to overturn."
        )
    return sentences, linear, cautions


def ends(run: History) -> str:
    """Return the outcome of the structure in words, which follow "it" or its name."""
    if run.unknown:
        return f"has an {names.UNKNOWN} outcome"
    if run.fell:
        return f"{names.OVERTURNS} {SENSE[Direction(run.fell_to)]}"
    if run.slid is not None and run.slip:
        return f"does not overturn, but slides {_slip(run.slid, run.blocks.least if run.blocks is not None else 0.0)}"
    if not run.peak_ratio:
        return names.NO_UPLIFT
    if run.peak_ratio > 1:
        return (
            f"{names.ROCKS}: it exceeds its critical rotation, reaching {run.peak_ratio:.4g} times it, and is brought "
            "back"
        )
    if any(run.ends_at_limit):
        return f"{names.ROCKS} to {run.furthest:.4g} rad, {run.peak_ratio:.4g} of its {run.reference}"
    return f"{names.ROCKS} to {run.peak_ratio:.4g} of its critical rotation phi_cr"


def _slip(slid: Slid, least: float) -> str:
    """Return how far and where a body slides, in words, which follow the outcome; `least` is what is resolved [m]."""
    most, end = (
        f"{_small(abs(slip), 'm')} to the {'right' if slip > 0 else 'left'}" for slip in (slid.largest, slid.residual)
    )
    at = f"{end} of" if abs(slid.residual) > least else "back in"
    return f"by up to {most}; at the end it is {at} its place, after a path of {_small(slid.path, 'm')}"


def blocks_do(run: History) -> str:
    """Return the outcome of a history of free blocks in words, which follow "the structure"."""
    assert run.blocks is not None
    falls, off, (turned, _), (moved, mover), (left, stays), least_turn, least = run.blocks
    if run.fell:
        where = f", where {falls} {names.FALLS_OFF} {off}" if off else f": {falls} falls first"
        return f"collapses at {run.overturning_time:.4g} s{where}"
    does = ends(run) if run.rotates else names.COMES_TO_REST
    if run.still_rocking:
        until = f". Until then it {ends(run)}" if run.rotates else ""
        does = f"still moves at {run.end_time:.4g} s, where the simulation ends{until}"
    if moved <= least and turned <= least_turn:
        return f"{does}. No block moves by more than its soft contacts let it"
    where = (
        f"{mover} moves by up to {_small(moved, 'm')}"
        if moved > least
        else f"No block moves by more than {_small(least, 'm')}"
    )
    if left > least:
        where += f", and {stays} stays {_small(left, 'm')} from its place"
    elif not run.still_rocking:
        where += ", and all blocks return to their places"
    most = f"{turned:.3g}" if turned > least_turn else f"{least_turn:.2g}"
    return f"{does}. {where}; no block turns by more than {most} rad"


def blocks_in_words(
    histories: Mapping[ModelName, History], agreed: Mapping[ModelName, Agreement], called: Mapping[ModelName, str]
) -> list[str]:
    """Return a sentence on each equivalent block: its grade under this motion, and the numbers behind this.

    Parameters
    ----------
    histories, agreed
        See `verdict`.
    called : mapping of str to str
        Names of the models in the sentences.
    """
    if not agreed:  # without a nonlinear history, state the other outcomes, and the blocks that are unfit
        sentences = [f"By {called[name]} it {ends(run)}." for name, run in list(histories.items())[1:]]
        return sentences + [
            f"Disregard {called[name]}: its uplift acceleration is {uplift_in_words(run.uplift_error)}."
            for name, run in histories.items()
            if grade(run.uplift_error) is Grade.DISREGARD
        ]
    sentences = [
        _agrees(called[name], agreement, histories[name], histories["nonlinear"]) for name, agreement in agreed.items()
    ]
    if any(
        agreement.peak_error is not None and agreement.grade is not Grade.DISREGARD for agreement in agreed.values()
    ):
        sentences.append(
            "This holds for this ground motion only; under another one the equivalent block may be more or less "
            "accurate."
        )
    return sentences


def _agrees(name: str, found: Agreement, run: History, best: History) -> str:
    beside = _beside(found, run, best)
    if found.unfit:
        return f"Disregard {name}: its uplift acceleration is {uplift_in_words(found.uplift_error)}; here {beside}."
    if not found.same_fate:
        return f"{name} disagrees: {beside}."
    if found.grade is Grade.DISREGARD:
        return f"Disregard {name} here: {beside}."
    return f"{name} {'agrees' if found.grade is Grade.AGREES else 'is good for a first estimate'}: {beside}."


def _beside(found: Agreement, run: History, best: History) -> str:
    """Return in words how the motion of a block differs from that of the nonlinear model."""
    if not found.same_fate:
        return f"it {ends(run)}"
    delay = found.peak_delay or 0.0
    later = (
        "at the same time"
        if abs(delay) < TIME_TOLERANCE
        else f"{abs(delay):.3g} s {'later' if delay > 0 else 'earlier'}"
    )
    if best.fell:
        return f"it {names.OVERTURNS}{' too' if run.fell_to == best.fell_to else ' the other way'}, {later}"
    if found.peak_error is None:
        return f"it {names.NO_UPLIFT} either"
    size = percent(abs(found.peak_error))
    size = "the same" if size == percent(0) else f"{size} {'higher' if found.peak_error > 0 else 'lower'}"
    if found.difference is None:
        return f"its peak is {size}"
    late = f" and {later}" if abs(delay) * best.p > SAME_PEAK_DELAY else ""
    return f"its peak is {size}{late}, and its rotation history differs by {percent(found.difference)} (rms)"


def uplift_in_words(error: float) -> str:
    """Return the error of an uplift acceleration in words, which follow "its uplift acceleration is"."""
    return f"{percent(abs(error))} too {'low' if error < 0 else 'high'}"


def contact_data(found: ContactDemand, mechanism: Mechanism) -> dict[str, Any]:
    """Return the demands as plain data; missing values are null."""
    return {
        **data_of(contact_columns(mechanism), found),
        **({} if found.opens is None else {"opens": found.opens, "opens_joint": found.opens_joint or None}),
        "sums": _sums(found, mechanism),
        "per_unit_mass": not mechanism.has_mass,
    }


def contact_columns(mechanism: Mechanism) -> list[Column[ContactDemand]]:
    """Return the columns of the demands on a structure; forces are per unit mass if it has no masses."""
    per, unit = force_unit(mechanism)

    def force(value: float) -> str:
        return ABSENT if isnan(value) else f"{number(value / per, 4)} {unit}"

    return [
        Column("friction_needed", of("friction_needed"), head="friction required", form=rounded(3)),
        Column("joint", lambda found: found.joint or None, head="at joint", text=True),
        Column("time", of("time"), head="at [s]", form=rounded(3)),
        Column("duration", of("duration"), head="for [s]", form=rounded(3)),
        Column("impact_friction", of("impact_friction"), head="at impacts", form=rounded(3)),
        Column("base_shear", of("base_shear"), head="base shear, without impacts", form=force),
        Column("least_normal", of("least_normal"), head="least normal force", form=force, text=True),
        Column("lost", of("lost"), head="contact lost", form=_lost, text=True),
        Column("lost_joint", lambda found: found.lost_joint or None),
        Column("friction", of("friction")),
        Column("slides", of("slides")),
        Column("slides_joint", lambda found: found.slides_joint or None),
        Column("strength", lambda found: None if found.crushing is None else asdict(found.crushing)),
        Column("supports", lambda found: [data_of(SUPPORTS, each) for each in found.supports]),
    ]


def _lost(time: float) -> str:
    return "never" if isnan(time) else f"at {number(time, 4)} s"


def contact_words(found: ContactDemand, mechanism: Mechanism) -> str:
    """Return the demands as one text; empty for a structure that does not rock."""
    return " ".join(contact_parts(found, mechanism))


def contact_parts(found: ContactDemand, mechanism: Mechanism) -> list[str]:
    """Return the demands as sentences: those that a terminal always shows as one text, then the others.

    If the joints are checked, the outcome states whether a joint opens or slides so far that the result ends.
    """
    if isnan(found.friction_needed):
        return []
    beyond = "" if found.followed else NOT_VALID_BEYOND
    sentences = _friction(found, beyond, alone=len(mechanism.bodies()) == 1)
    if found.impact_friction > max(found.friction_needed, found.friction or 0.0):
        sentences.append(
            f"Impacts require a coefficient of friction of {number(found.impact_friction, 3)}, and much more with a "
            f"lower restitution{_at_impacts(found, mechanism)}."
        )
    if not isnan(found.lost):
        sentences.append(f"Contact is lost at {_where(found.lost_joint)} at {number(found.lost, 4)} s{beyond}.")
    if found.opens is not None and not isnan(found.opens):
        sentences.append(
            f"At {number(found.opens, 4)} s another joint would open, that between {found.opens_joint}{beyond}."
        )
    if found.crushing is not None:
        at = f"{_where(found.crushing.joint)} at {number(found.crushing.time, 4)} s"
        if found.crushing.used > 1:
            sentences.append(
                f"The contacts would crush: they carry up to {number(found.crushing.used, 3)} times their strength, "
                f"at {at}. The result is not valid once the strength is exceeded."
            )
        else:
            sentences.append(
                f"The contacts use at most {number(100 * found.crushing.used, 3)} % of their strength, at {at}."
            )
    sentences += [_support(each, mechanism) for each in found.supports]
    sums = _sums(found, mechanism)
    if sums == "whole" and all(mechanism.contacts(direction) for direction in mechanism.directions):
        sentences.append(
            "Statics alone does not determine the force at each joint: the forces are sums over the whole structure, "
            "on level ground, and a single joint may require more friction."
        )
    elif sums == "whole":
        sentences.append(
            "The positions of its joints are not known: the forces are sums over the whole structure, on level ground."
        )
    elif sums == "shared":
        sentences.append(
            "Statics alone does not determine the force at each joint, as there are more joints than needed: the "
            "friction required is a least-squares estimate, and the normal force is the sum over the whole structure."
        )
    elif sums is not None:
        sentences.append(Aside(f"Forces are sums over all {sums}."))
    always = " ".join(each for each in sentences if not isinstance(each, Aside))
    return [always, *(each for each in sentences if isinstance(each, Aside))]


def _at_impacts(found: ContactDemand, mechanism: Mechanism) -> str:
    """Return what to do about the friction that impacts require, as a clause with its colon."""
    if found.friction is None and found.impact_friction <= MASONRY_FRICTION:
        return ""
    # The check uses impulses of the kinematic restitution; impulses of another restitution are not known by joint.
    if not found.followed or not mechanism.restitution_is_kinematic:
        return ": joints with less slide at impacts, which is not simulated; prevent this, for instance by dowels"
    if found.friction is None:
        return ": give `friction` in the file, and the check of the joints counts how far they slide at impacts"
    return ": the check of the joints counts how far they slide at impacts"


def _friction(found: ContactDemand, beyond: str, *, alone: bool) -> list[str]:
    needed, at = number(found.friction_needed, 3), f"at {number(found.time, 4)} s"
    where = _where(found.joint) if found.joint else "the structure"
    if found.friction is None:
        usual = f"{'more' if found.beyond_masonry else 'no more'} than the {MASONRY_FRICTION:g} usual for masonry"
        usual += " (measure it for marble, metal or wood)" * (alone and not found.beyond_masonry)
        lasts = f"more than {100 * NEAR_PEAK:.0f} % of this value for {number(found.duration, 2)} s."
        return [
            f"Contact: {where} requires a coefficient of friction of up to {needed}, {at}, {usual}.",
            Aside(f"Around this time it requires {lasts}"),
        ]
    there = number(found.friction, 3)
    if isnan(found.slides):
        return [f"Contact: {where} requires a coefficient of friction of up to {needed}, {at}; {there} is available."]
    there_first = f" at {_where(found.slides_joint)}" if found.slides_joint else ""
    return [
        f"Sliding would start{there_first} at {number(found.slides, 4)} s{beyond}. It would last at most "
        f"{number(found.duration, 2)} s at a time. {where[0].upper()}{where[1:]} requires a coefficient of friction "
        f"of up to {needed}, {at}; {there} is available."
    ]


def _support(found: SupportDemand, mechanism: Mechanism) -> str:
    per, unit = force_unit(mechanism)
    level = abs(found.way.real) > abs(found.way.imag)
    senses = ("to the right", "to the left") if level else ("upwards", "downwards")
    parts = [
        f"{number(force / per, 3)} {unit} {sense}"
        for force, sense in zip((found.most, -found.least), senses, strict=True) if force > 0
    ]  # fmt: skip
    return f"{found.support[0].upper()}{found.support[1:]} must provide up to {' and '.join(parts)}."


def _where(letter: str) -> str:
    return f"joint {letter}" if letter else "the ground"


def _sums(found: ContactDemand, mechanism: Mechanism) -> str | None:
    """Return the extent over which forces are summed: the whole structure, identical bodies, or none (None).

    `shared` is a least-squares estimate where statics alone does not determine the force at each joint.
    """
    if found.whole:
        return "whole"
    if found.shared:
        return "shared"
    joints = mechanism.joints(mechanism.directions[0])
    of_several = {name for joint in joints if joint.level for name in joint.bodies}
    return next((name for name in mechanism.alike() if name in of_several), None)
