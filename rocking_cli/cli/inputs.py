"""Structure and ground motions of a command: read or made, checked and scaled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.cli import motion_files, terminal
from rocking_cli.excitation.scaled import Scaled

if TYPE_CHECKING:
    from rocking_cli.cli.groups import GroundMotions
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.processing.listed import Listed
    from rocking_cli.processing.reading import Reading
    from rocking_cli.structure import Structure


def structure(files: Sequence[str], records: Sequence[str]) -> Structure:
    """Return the single structure of a command, prepared."""
    import click

    from rocking_cli.cli import structures
    from rocking_cli.errors import InputError

    if len(files) > 1:
        motion_files.check_strays(files, records)
        raise click.UsageError(f"This command takes one structure, but {len(files)} are given: {', '.join(files)}.")
    try:
        return structures.prepared(files)
    except InputError:
        motion_files.check_strays(files, records)
        raise


def read(what: str, record: Listed, reading: Reading) -> GroundMotion:
    """Read a motion and report it under the name `what`."""
    motion = motion_files.read(record, reading)
    introduce(what, motion)
    return motion


def introduce(what: str, motion: GroundMotion) -> None:
    """Report a motion under the name `what`."""
    ground = motion.of_ground
    terminal.note(
        f"{what}: {motion.name} ({motion.format}), {ground.npts} points, dt = {ground.dt:g} s, "
        f"in {motion.unit}, PGA = {ground.pga_g:.4g} g{motion_files.done(motion)}"
    )


def make(specification: str) -> tuple[Pulse, GroundMotion]:
    """Make a pulse from its specification, and report it."""
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.excitation.pulses import parse_pulse

    pulse = parse_pulse(specification)
    amplitude = pulse.amplitude / STANDARD_GRAVITY
    terminal.note(f"pulse: {pulse.title}, {amplitude:.4g} g, period {pulse.period:.4g} s, lasts {pulse.duration:.4g} s")
    return pulse, pulse.sampled()


def judge(
    motion: GroundMotion,
    p: float,
    scale: float | None,
    target_pga: float | None,
    target_pgv: float | None,
) -> float:
    """Return the factor on the motion, after warnings about the record, also for this structure."""
    from rocking_cli.excitation.doubts import doubts
    from rocking_cli.excitation.measures import measure

    measured = measure(motion.of_ground)
    if motion.format != "pulse":  # what a formula leaves the ground with is meant
        warn(motion, p)
    if motion.vertical is not None:
        motion_files.warn(motion.vertical, doubts(motion.vertical, measure(motion.vertical)))
    factor = motion_files.factor(motion, measured, scale, target_pga, target_pgv)
    if factor != 1:
        pga, pgv = abs(factor) * measured.pga, abs(factor) * measured.pgv
        terminal.note(f"scaled by {factor:.6g}: PGA = {pga:.4g} g, PGV = {pgv:.4g} m/s")
    return factor


def warn(motion: GroundMotion, p: float) -> None:
    """Warn of doubts about a record, also for a structure of a frequency parameter `p`."""
    from rocking_cli.excitation.doubts import coarse_for, doubts
    from rocking_cli.excitation.measures import measure

    ground = motion.of_ground
    motion_files.warn(motion, doubts(ground, measure(ground)) + coarse_for(motion, p))


def gather(records: Sequence[Listed], asked: GroundMotions, p: float, *, several: bool) -> tuple[list[Scaled], int]:
    """Return the motions for a structure of a frequency parameter `p`, and the number of unusable ones.

    A single motion is reported in full, and an error in it ends the command. Of `several`, each is reported by itself.
    """
    if several:
        return motion_files.gather(records, asked.pulses, asked.reading, asked.scaling, p, "this structure")
    pulse, file, reading = None, None, asked.reading
    if asked.pulses:
        pulse, motion = make(asked.pulses[0])
        motion = reading.on_floor(motion)
    else:
        file = records[0].path
        motion = read("record", records[0], reading)
        reading = records[0].reading(reading)
    return [Scaled(motion, judge(motion, p, *asked.scaling), pulse, file)], 0
