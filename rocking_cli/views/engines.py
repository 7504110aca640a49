"""Who simulated a result, in words: one degree of freedom, free blocks, or both, and when their motions part."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan, nan
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking_cli import names
from rocking_cli.core import Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import percent
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.engines import Engine, EngineName
from rocking_cli.views.column import Column, data_of, of, of_part, only_shown, rounded, table_of
from rocking_cli.views.verdict import ends, unknown_after
from rocking_cli.views.view import Aside, Table, number

if TYPE_CHECKING:
    from rocking_cli.studies.both_engines import BlockJoint, BothEngines

MAX_LISTED_JOINTS = 8
BLOCKS_FAILED = "free blocks failed: a step diverged, or a body sank too deep into another"
ALL_EXACT = "Engine: one degree of freedom for all histories, as it tells every outcome."


def engines_in_words(engine: EngineName, by_blocks: int, mechanism: Mechanism, off_edge: int = 0) -> list[str]:
    """Return sentences on the histories that were simulated with free blocks; none if there are none.

    Parameters
    ----------
    engine : {"exact", "blocks", "auto"}
        The engine that was requested.
    by_blocks : int
        Number of histories with free blocks.
    mechanism : Mechanism
        The structure.
    off_edge : int
        Number of those of them in which a block falls off an edge.
    """
    if engine == "exact":
        return []
    if not by_blocks:
        return [Aside(ALL_EXACT)]
    histories = "1 history" if by_blocks == 1 else f"{by_blocks} histories"
    given = mechanism.friction is not None
    friction = (
        f"{mechanism.friction:g}, as given" if given else f"{MASONRY_FRICTION:g}, as usual for masonry: none is given"
    )
    return [*blocks_in_words(engine, histories, friction, off_edge)]


def blocks_in_words(engine: EngineName, histories: str, friction: str, off_edge: int) -> Iterator[str]:
    """Yield which histories free blocks give, and how: their friction and falls, collapse and impacts, in words."""
    off = f" In {off_edge:,} of them, a block falls off an edge that the file draws: they count as overturned."
    others = "; one degree of freedom for all others" if engine == "auto" else ""
    yield (
        f"Engine: free blocks (MuJoCo) for {histories}{others}. Their friction is {friction}.{off * (off_edge > 0)} "
        "Impacts lose the energy that contact takes, whatever restitution is given."
    )
    from rocking_cli.studies.engines.free_blocks import COLLAPSE

    yield Aside(f"Overturning of free blocks is collapse: {COLLAPSE}.")


def cost_in_words(
    engine: Engine, structure: Structure, motion: GroundMotion, count: int, processes: int | None = None
) -> str:
    """Return how long many histories will take, measured, as a sentence; empty for one degree of freedom.

    Parameters
    ----------
    engine : Engine
        Who simulates them.
    structure : Structure
        The structure.
    motion : GroundMotion
        One of the motions.
    count : int
        Number of histories.
    processes : int, optional
        Number of histories at a time; by default, one for each processor.

    Raises
    ------
    InputError
        If the structure has something that free blocks cannot have.
    """
    if engine.name == "exact":
        return ""
    from rocking_cli.studies.engines.free import cost

    each, usual = cost(structure, motion)
    processes = processes or usual
    histories = "history" if count == 1 else "histories"
    most = "up to " if engine.name == "auto" else ""
    return (
        f"Free blocks: {most}{count} {histories} of some {each:.2g} s each, {processes} at a time: {most}"
        f"{_duration(count * each / processes)}. Histories that are done are kept: an interrupted run goes on."
    )


def _duration(seconds: float) -> str:
    for unit, long in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * long:
            return f"{seconds / long:.0f} {unit}"
    return f"{max(seconds, 1.0):.0f} s"


class JointsOfEngine(NamedTuple):
    """What an engine finds at the joints: the largest friction required, and the largest opening or slip [m]."""

    friction: float
    friction_joint: str
    widest: float
    joint: str
    reach: float
    least: float


OF_ENGINE: tuple[Column[JointsOfEngine], ...] = (
    Column("friction_needed", of("friction"), "", "largest friction", rounded(3)),
    Column("friction_joint", lambda side: side.friction_joint or None, head="at joint", text=True),
    Column("largest_opening", of("widest"), "m"),
    Column("opening_joint", lambda side: side.joint or None),
    only_shown("largest opening or slip", lambda side: _length(side.widest, side.reach, side.least), unit="mm"),
    only_shown("of joint", lambda side: side.joint or None, text=True),
)
JOINTS: tuple[Column[BlockJoint], ...] = (
    Column("joint", of("name"), "", "joint, by free blocks", text=True),
    Column("opening", of("opening"), "m"),
    Column("slip", of("slip"), "m"),
    Column("passed", of("passed"), "s"),
    Column("friction", of("friction"), "", "friction", rounded(3)),
)


def _joints_of(both: BothEngines, demand: ContactDemand) -> dict[EngineName, JointsOfEngine]:
    check, (pair, friction) = both.exact.check, both.friction
    reach = nan if check is None else check.reach
    opened = (nan, "") if check is None else (check.largest, check.largest_joint)
    widest = (max(both.joints[0].opening, both.joints[0].slip), both.joints[0].name) if both.joints else (nan, "")
    between = "" if isnan(friction) else " and ".join(name or "the ground" for name in pair)
    return {
        "exact": JointsOfEngine(demand.friction_needed, demand.joint, *opened, reach, 0.0),
        "blocks": JointsOfEngine(friction, between, *widest, reach, both.moved.least),
    }


def joints_across(both: BothEngines, demand: ContactDemand) -> list[Column[History]]:
    """Return the columns of what each engine finds at the joints, in a table of histories."""
    sides = _joints_of(both, demand)
    return of_part(OF_ENGINE, lambda run: sides["blocks" if run.by_blocks else "exact"])


def _length(value: float, reach: float, least: float) -> str:
    """Return an opening in mm, without its size if it is not resolved, or beyond D_cr, where it is no joint's."""
    if 0 < value <= least:
        return f"< {number(1000 * least, 2)}"
    return f"more than {1000 * reach:.3g}" if value > reach else number(1000 * value, 3)


def joints_shown(both: BothEngines, opening: float) -> Iterator[Table | str]:
    """Yield the joints that open or slide most as free blocks; `opening` is the largest one without effect."""
    reach = both.exact.check.reach if both.exact.check is not None else nan
    millimetres: list[Column[BlockJoint]] = [
        only_shown("opening\n[mm]", lambda joint: _length(joint.opening, reach, both.moved.least)),
        only_shown("slip\n[mm]", lambda joint: _length(joint.slip, reach, both.moved.least)),
        only_shown(f"more than {1000 * opening * reach:.3g} mm\nat [s]", of("passed"), rounded(4)),
    ]
    if both.joints:
        yield table_of("", [JOINTS[0], *millimetres, *JOINTS[1:]], both.joints[:MAX_LISTED_JOINTS])
    if (more := len(both.joints) - MAX_LISTED_JOINTS) > 0:
        yield f"{more} more joints open and slide by less: the JSON output lists them."


def engines_data(both: BothEngines, demand: ContactDemand, structure: Structure) -> dict[str, Any]:
    """Return how both engines compare, as plain data."""
    check = both.exact.check
    return {
        "finding": both.finding,
        "compared_to": both.compared_to,
        "peaks": dict(zip(("exact", "blocks"), both.peaks, strict=True)),
        "peak_quotient": both.peak_quotient,
        "parted": both.parted,
        "friction": {"given": structure.mechanism.friction, "blocks": both.free.friction},
        "limit": None if check is None else structure.opening * check.reach,
        **{name: data_of(OF_ENGINE, side) for name, side in _joints_of(both, demand).items()},
        "joints": [data_of(JOINTS, each) for each in both.joints],
        "verdict": f"{_finding(both)} {parting(both)}",
    }


def agreement(both: BothEngines) -> str:
    """Return whether both engines agree, and when they part, in a sentence or two."""
    return parting(both) if both.finding == "exact_unknown" else f"{_finding(both)} {parting(both)}"


def parting(both: BothEngines) -> str:
    """Return when the motions by both engines part, in a sentence."""
    from rocking_cli.studies.both_engines import PARTED

    share = f"more than {percent(PARTED)} of the larger peak"
    if isnan(both.parted):
        return f"Up to {both.compared_to:.4g} s, the rotations by both engines never differ by {share}."
    return f"The rotations by both engines first differ by {share} at {both.parted:.4g} s."


def _finding(both: BothEngines) -> str:
    from rocking_cli.studies.both_engines import SAME_PEAKS
    from rocking_cli.studies.engines.free import MOVED

    exact, blocks = both.exact, both.of_blocks
    agree = f"Up to {blocks.end_time:.4g} s, the" if blocks.still_rocking else "The"
    peaks = _by_both(f"{exact.peak_ratio:.4g} of its {exact.reference}", f"{blocks.peak_ratio:.4g}")
    match both.finding:
        case "exact_unknown":
            return unknown_after(exact, blocks)
        case "outcomes_differ":
            sides = f"by the exact engine the structure {_ends(exact)}; by free blocks it {_ends(blocks)}."
            return f"The engines {'do not agree yet' if blocks.still_rocking else 'disagree'}: {sides}"
        case "peaks_differ":
            differ = f"their peaks differ by more than {percent(SAME_PEAKS)}"
            return f"{agree} engines agree that the structure does not overturn, but {differ}: {peaks}."
    if exact.fell:
        times = _by_both(f"{exact.overturning_time:.4g} s", f"{blocks.overturning_time:.4g} s")
        return f"The engines agree: the structure {names.OVERTURNS}, at {times}."
    does = f"{names.ROCKS}, with a peak of {peaks}" if blocks.peak_ratio else ends(exact)
    small = f", less than the {percent(MOVED)} from which free blocks count as uplifted"
    return f"{agree} engines agree: the structure {does}{small if exact.lifted and not blocks.lifted else ''}."


def _by_both(exact: str, blocks: str) -> str:
    return f"{exact} by the exact engine and {blocks} by free blocks"


def _ends(run: History) -> str:
    if run.by_blocks and run.still_rocking:
        return f"still moves at {run.end_time:.4g} s, where the simulation ends"
    return f"{ends(run)} at {run.overturning_time:.4g} s" if run.fell else ends(run)
