"""View of both engines side by side, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan, nan
from typing import Any, NamedTuple

from rocking_cli import names
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.dynamics.history import History
from rocking_cli.names import percent
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.crosscheck.study import PARTED, SAME_PEAKS, BlockJoint, Crosscheck
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import EngineName
from rocking_cli.studies.engines.free import MOVED
from rocking_cli.views.column import Column, data_of, of, only_shown, rounded, table_across, table_of
from rocking_cli.views.engines import engines_in_words
from rocking_cli.views.response import ending, known_data, not_checked, record_data
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.verdict import ASSUMED, ends, unknown_after
from rocking_cli.views.view import View, heading, number

MAX_LISTED_JOINTS = 8
MORE = (
    "One history is one sample, as rocking is chaotic: `rocking margin` with the engine `blocks` gives shares of "
    "neighbouring motions."
)


class _Side(NamedTuple):
    """One of the engines: its history, and what it finds at the joints."""

    engine: EngineName
    run: History
    friction: float
    friction_joint: str
    widest: float
    joint: str
    reach: float


COLUMNS: tuple[Column[_Side], ...] = (
    Column("engine", of("engine")),
    Column("outcome", lambda side: ending(side.run)),
    only_shown("outcome", of("run.words"), text=True),
    only_shown("known until", of("run.known_to"), rounded(5), "s"),
    Column("peak_ratio", of("run.peak_ratio")),
    Column("peak_positive", of("run.peak_positive"), "rad", "peak rotation, clockwise", rounded(4)),
    Column("peak_negative", of("run.peak_negative"), "rad", "peak rotation, anticlockwise", rounded(4)),
    Column("uplift_time", of("run.uplift_time"), "s", "first uplift", rounded(4)),
    Column("overturning_time", of("run.overturning_time"), "s", "overturning time", rounded(4)),
    Column("friction_needed", of("friction"), "", "largest friction", rounded(3)),
    Column("friction_joint", lambda side: side.friction_joint or None, head="at joint", text=True),
    Column("largest_opening", of("widest"), "m"),
    Column("opening_joint", lambda side: side.joint or None),
    only_shown("largest opening or slip", lambda side: _length(side.widest, side.reach), unit="mm"),
    only_shown("of joint", lambda side: side.joint or None, text=True),
)

JOINTS: tuple[Column[BlockJoint], ...] = (
    Column("joint", of("name"), "", "joint, by free blocks", text=True),
    Column("opening", of("opening"), "m"),
    Column("slip", of("slip"), "m"),
    Column("passed", of("passed"), "s"),
    Column("friction", of("friction"), "", "friction", rounded(3)),
)


def view(structure: Structure, given: Scaled | None, polarity: int, release: float | None, found: Crosscheck) -> View:
    """Show both engines side by side, and what follows.

    Parameters
    ----------
    structure : Structure
        The structure.
    given : Scaled or None
        The motion as read; None for a free release.
    polarity : int
        Polarity of the motion.
    release : float or None
        Fraction of phi_cr from which it is released.
    found : Crosscheck
        The motion by both engines.
    """
    mechanism, sides, assumed = structure.mechanism, _sides(found), found.demand.assumed_friction
    reach = sides[0].reach
    peak = only_shown(f"peak rotation / {divisor(found.exact)}", of("run.peak_ratio"), rounded(4))
    columns = [*COLUMNS[:4], peak, *COLUMNS[4:]]
    table = table_across(heading(mechanism), columns, ["exact engine", "free blocks"], sides)
    millimetres: list[Column[BlockJoint]] = [
        only_shown("opening\n[mm]", lambda joint: _length(joint.opening, reach)),
        only_shown("slip\n[mm]", lambda joint: _length(joint.slip, reach)),
        only_shown(f"more than {1000 * structure.opening * reach:.3g} mm\nat [s]", of("passed"), rounded(4)),
    ]
    listed = table_of("", [JOINTS[0], *millimetres, *JOINTS[1:]], found.joints[:MAX_LISTED_JOINTS])
    more = len(found.joints) - MAX_LISTED_JOINTS
    sentences = [
        verdict(found),
        *([f"{more} more joints open and slide by less: the JSON output lists them."] if more > 0 else []),
        f"Exact engine: one degree of freedom. {restitution_used(structure)}",
        *engines_in_words("blocks", 1, mechanism),
        *not_checked(mechanism, [found.exact]),
        *([] if assumed is None else [ASSUMED.format(assumed, MASONRY_FRICTION)]),
        MORE,
    ]
    data: dict[str, Any] = {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "record": record_data(given.motion, given.factor, str(polarity), given.pulse) if given else None,
        "release": release,
        "restitution": restitution_data(structure),
        "histories": {side.engine: {**data_of(COLUMNS, side), **known_data(side.run)} for side in sides},
        "compared_to": found.compared_to,
        "peaks": dict(zip(("exact", "blocks"), found.peaks, strict=True)),
        "peak_quotient": found.peak_quotient,
        "parted": found.parted,
        "friction": {"given": mechanism.friction, "blocks": found.free.friction},
        "block": found.moved.block or None,
        "falls_off": found.moved.off or None,
        "limit": None if isnan(reach) else structure.opening * reach,
        "joints": [data_of(JOINTS, each) for each in found.joints],
        "finding": found.finding,
        "verdict": verdict(found),
    }
    return View(data, [table, sentences[0], *([listed] if found.joints else []), *sentences[1:]])


def divisor(run: History) -> str:
    """Return by what rotations are divided: the critical rotation, or the limit of a direction that has none."""
    return names.peaks_over(run.ends_at_limit).replace("of ", "").replace("the ", "")


def _sides(found: Crosscheck) -> list[_Side]:
    check, (pair, friction) = found.exact.check, found.friction
    reach = nan if check is None else check.reach
    widest = found.joints[0] if found.joints else None
    return [
        _Side(
            "exact", found.exact, found.demand.friction_needed, found.demand.joint,
            nan if check is None else check.largest, "" if check is None else check.largest_joint, reach,
        ),
        _Side(
            "blocks", found.of_blocks, friction, "" if isnan(friction) else _between(pair),
            nan if widest is None else max(widest.opening, widest.slip), "" if widest is None else widest.name, reach,
        ),
    ]  # fmt: skip


def _between(pair: Sequence[str]) -> str:
    return " and ".join(name or "the ground" for name in pair)


def _length(value: float, reach: float) -> str:
    """Return an opening in mm; one beyond D_cr is no longer that of a joint, so that its size is not given."""
    return f"more than {1000 * reach:.3g}" if value > reach else number(1000 * value, 3)


def verdict(found: Crosscheck) -> str:
    """Return whether both engines agree, and when they part, in a few sentences."""
    parts = [_finding(found)]
    if found.moved.block:
        off = f", off the edge of {found.moved.off}" if found.moved.off else ""
        parts.append(f"Of the free blocks, {found.moved.block} falls first{off}.")
    share = f"more than {percent(PARTED)} of the larger peak"
    if isnan(found.parted):
        parts.append(f"Up to {found.compared_to:.4g} s, their rotations never differ by {share}.")
    else:
        parts.append(f"Their rotations first differ by {share} at {found.parted:.4g} s.")
    return " ".join(parts)


def _finding(found: Crosscheck) -> str:
    exact, blocks = found.exact, found.of_blocks
    peaks = _both(f"{exact.peak_ratio:.4g} of its {exact.reference}", f"{blocks.peak_ratio:.4g}")
    match found.finding:
        case "exact_unknown":
            witness = f"Free blocks are the witness from then on: by them, it {_ends(blocks)}."
            return f"{unknown_after(exact)} {witness}"
        case "outcomes_differ":
            return (
                f"The engines disagree: by the exact engine the structure {_ends(exact)}; by free blocks it "
                f"{_ends(blocks)}."
            )
        case "peaks_differ":
            differ = f"their peaks differ by more than {percent(SAME_PEAKS)}"
            return f"The engines agree that the structure does not overturn, but {differ}: {peaks}."
    if exact.fell:
        times = _both(f"{exact.overturning_time:.4g} s", f"{blocks.overturning_time:.4g} s")
        return f"The engines agree: the structure {names.OVERTURNS}, at {times}."
    does = f"{names.ROCKS}, with a peak of {peaks}" if blocks.peak_ratio else ends(exact)
    small = f", less than the {percent(MOVED)} from which free blocks count as uplifted"
    return f"The engines agree: the structure {does}{small if exact.lifted and not blocks.lifted else ''}."


def _both(exact: str, blocks: str) -> str:
    return f"{exact} by the exact engine and {blocks} by free blocks"


def _ends(run: History) -> str:
    return f"{ends(run)} at {run.overturning_time:.4g} s" if run.fell else ends(run)
