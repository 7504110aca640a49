"""A structure and the ground motion that shakes it: read or made, judged, scaled, and responded to."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rocking_cli.cli import motions, terminal

if TYPE_CHECKING:
    from rocking_cli.core import Equivalence, Mechanism
    from rocking_cli.dynamics.history import History
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.measures import Measures
    from rocking_cli.excitation.pulses import Pulse


def equivalence(mechanism: Mechanism) -> Equivalence:
    """The equivalent blocks of a structure; an error names it."""
    from rocking_cli.core import equivalent_block
    from rocking_cli.errors import MechanismError

    try:
        return equivalent_block(mechanism)
    except MechanismError as error:
        raise MechanismError(f"{mechanism.name}: {error}") from error


def read(what: str, file: str, dt: float | None, units: str | None, channel: str | None) -> GroundMotion:
    """Read a motion and say what was read; `what` it is to be called."""
    from rocking_cli.excitation.records import read_record

    motion = read_record(file, dt=dt, units=units, channel=channel)
    terminal.note(
        f"{what}: {motion.name} ({motion.format}), {motion.npts} points, dt = {motion.dt:g} s, "
        f"in {motion.unit}, PGA = {motion.pga:.4g} g"
    )
    return motion


def read_vertical(
    file: str, dt: float | None, own_dt: float | None, units: str | None, channel: str | None
) -> GroundMotion:
    """Read a vertical component as `read` does; `own_dt` is its interval, else that of the horizontal one."""
    from rocking_cli.errors import InputError, Problem, renamed

    options = {"--channel": "--vertical-channel"}
    if own_dt is not None or dt is None:
        options["--dt"] = "--vertical-dt"
    try:
        return read("vertical", file, dt if own_dt is None else own_dt, units, channel)
    except InputError as error:
        found: list[Problem] = []
        for each in renamed(error, options).problems:
            if each.hint and "--dt" in each.hint.split():  # it was meant for the other component
                each = replace(each, hint="give the interval of the vertical component with --vertical-dt")
            found.append(each)
        raise InputError(*found) from None


def make(specification: str) -> tuple[Pulse, GroundMotion]:
    """Make a pulse from its specification, and say what it is."""
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.excitation.pulses import parse_pulse

    pulse = parse_pulse(specification)
    amplitude = pulse.amplitude / STANDARD_GRAVITY
    terminal.note(f"pulse: {pulse.title}, {amplitude:.4g} g, period {pulse.period:.4g} s, lasts {pulse.duration:.4g} s")
    return pulse, pulse.sampled()


def judge(
    motion: GroundMotion,
    blocks: Equivalence,
    scale: float | None,
    target_pga: float | None,
    target_pgv: float | None,
) -> float:
    """The factor on the motion, after saying what is doubtful about a record, for this structure too."""
    from rocking_cli.excitation.doubts import doubts
    from rocking_cli.excitation.measures import measure

    measured = measure(motion)
    if motion.format != "pulse":  # what a formula leaves the ground with is meant
        _warn(motion, measured, blocks)
    if motion.vertical is not None:
        motions.warn(motion.vertical, doubts(motion.vertical, measure(motion.vertical)))
    factor = motions.factor(motion, measured, scale, target_pga, target_pgv)
    if factor != 1:
        pga, pgv = abs(factor) * measured.pga, abs(factor) * measured.pgv
        terminal.note(f"scaled by {factor:.6g}: PGA = {pga:.4g} g, PGV = {pgv:.4g} m/s")
    return factor


def _warn(motion: GroundMotion, measured: Measures, blocks: Equivalence) -> None:
    from rocking_cli.excitation.doubts import coarse_for, doubts

    p = max(blocks.positive.p, blocks.negative.p)
    motions.warn(motion, doubts(motion, measured) + coarse_for(motion, p))


def respond(
    mechanism: Mechanism,
    motion: GroundMotion | None,
    models: tuple[ModelName, ...],
    release: float | None,
    tail: float,
    rtol: float,
) -> dict[ModelName, History]:
    """The histories of a structure; an error names it."""
    from rocking_cli.cli.work import say_if_compiling
    from rocking_cli.dynamics import history
    from rocking_cli.errors import MechanismError

    say_if_compiling()
    try:
        return history.respond(mechanism, motion, models=models, release=release, tail=tail, rtol=rtol)
    except MechanismError as error:
        raise MechanismError(f"{mechanism.name}: {error}") from error
