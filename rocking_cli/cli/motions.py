"""Which ground motions a command works on, how they are scaled, and what to say of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, NamedTuple

import click

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.doubts import Doubt
    from rocking_cli.excitation.measures import Measures

FEW = 3  # motions of which each gets its own lines; of more there is a summary


def check_scaling(scale: float | None, target_pga: float | None, target_pgv: float | None) -> None:
    """Refuse more than one way of scaling, before anything is read."""
    if sum(value is not None for value in (scale, target_pga, target_pgv)) > 1:
        raise click.UsageError("--scale, --target-pga and --target-pgv exclude each other.")


def factor(
    motion: GroundMotion, measured: Measures, scale: float | None, target_pga: float | None, target_pgv: float | None
) -> float:
    """The factor on a motion as read that the options ask for, polarity apart.

    Parameters
    ----------
    motion, measured : GroundMotion, Measures
        The motion and its measures.
    scale : float, optional
        The factor itself.
    target_pga : float, optional
        PGA to reach [g].
    target_pgv : float, optional
        PGV to reach [m/s].

    Returns
    -------
    float
        1 if nothing is asked for.
    """
    if target_pga is None and target_pgv is None:
        return 1.0 if scale is None else scale
    wanted, own = (target_pga, measured.pga) if target_pga is not None else (target_pgv, measured.pgv)
    assert wanted is not None
    if own == 0:
        raise InputError(Problem("the record is zero throughout, and cannot be scaled to a peak", motion.name))
    return wanted / own


def warn(motion: GroundMotion, found: Iterable[Doubt]) -> None:
    """Say on standard error what makes a motion doubtful."""
    for doubt in found:
        terminal.warning(f"{motion.name}: {doubt.text}")


class Scaled(NamedTuple):
    """A ground motion as read, and the factor on it."""

    motion: GroundMotion
    factor: float


def find(places: Sequence[str]) -> tuple[list[Path], int]:
    """The files of several names and patterns, each once, and how many of these stand for none, which is reported."""
    from rocking_cli.excitation.selection import select

    found: dict[Path, None] = {}
    bad = 0
    for place in places:
        try:
            found |= dict.fromkeys(select(place))
        except InputError as error:
            terminal.error(str(error))
            bad += 1
    return list(found), bad


def gather(
    paths: Sequence[Path],
    pulses: Sequence[str],
    reading: tuple[float | None, str | None, str | None],
    asked: tuple[float | None, float | None, float | None],
    p: float,
) -> tuple[list[Scaled], int]:
    """Read records and make pulses; say what is doubtful about them, and report those that cannot be used.

    Parameters
    ----------
    paths : sequence of Path
        The records.
    pulses : sequence of str
        Specifications such as `sine:0.6g:0.8s`.
    reading : tuple
        `dt`, `units` and `channel` of `read_record`.
    asked : tuple
        `scale`, `target_pga` and `target_pgv` of `factor`.
    p : float
        Frequency parameter of the smallest structure that they shake [rad/s].

    Returns
    -------
    list of Scaled
        Those that can be used, each with a name of its own.
    int
        How many cannot.

    Raises
    ------
    InputError
        If a pulse is malformed.
    """
    from rocking_cli.excitation.doubts import coarse_for, doubts
    from rocking_cli.excitation.measures import measure
    from rocking_cli.excitation.pulses import parse_pulse
    from rocking_cli.excitation.records import read_record

    made = [pulse.sampled() for pulse in dict.fromkeys(parse_pulse(text) for text in pulses)]
    sources: list[Path | GroundMotion] = [*paths, *made]
    dt, units, channel = reading
    found: list[Scaled] = []
    doubtful: list[tuple[GroundMotion, list[Doubt]]] = []
    for source in sources:
        try:
            motion = read_record(source, dt=dt, units=units, channel=channel) if isinstance(source, Path) else source
            measured = measure(motion)
            each = Scaled(motion, factor(motion, measured, *asked))
        except InputError as error:
            terminal.error(str(error))
            terminal.plugin_traceback(error)
            continue
        if isinstance(source, Path):
            if any(motion.name == other.motion.name for other in found):
                each = Scaled(replace(motion, name=f"{motion.name} ({source.parent})"), each.factor)
            doubtful.append((each.motion, doubts(motion, measured) + coarse_for(motion, p, "the smallest size")))
        found.append(each)
    _introduce(found)
    _warn_of([each for each in doubtful if each[1]])
    return found, len(sources) - len(found)


def _introduce(found: Sequence[Scaled]) -> None:
    """Say which ground motions these are."""
    if len(found) <= FEW:
        for motion, by in found:
            scaled = f", scaled by {by:.6g}: PGA = {abs(by) * motion.pga:.4g} g" if by != 1 else ""
            terminal.note(
                f"motion: {motion.name} ({motion.format}), {motion.npts} points, dt = {motion.dt:.6g} s, "
                f"PGA = {motion.pga:.4g} g{scaled}"
            )
        return
    pga = [abs(by) * motion.pga for motion, by in found]
    scaled = " as scaled" if any(by != 1 for _, by in found) else ""
    terminal.note(f"motions: {len(found)}, PGA from {min(pga):.3g} to {max(pga):.3g} g{scaled}")


def _warn_of(doubtful: Sequence[tuple[GroundMotion, list[Doubt]]]) -> None:
    """Say what makes motions doubtful; in a few words if there are many."""
    if len(doubtful) <= FEW:
        for motion, found in doubtful:
            warn(motion, found)
        return
    kinds = Counter(doubt.kind for _, found in doubtful for doubt in found)
    said = ", ".join(f"{kind} ({count})" for kind, count in kinds.most_common())
    names = shorten(", ".join(motion.name for motion, _ in doubtful), 200, placeholder=" ...")
    terminal.warning(f"{len(doubtful)} records are doubtful: {said}; `rocking record` says why: {names}")
