"""`rocking respond --azimuth all`: rotate a pair of components into every direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from rocking_cli.cli import inputs, motion_files, terminal
from rocking_cli.cli.groups import GroundMotions, HistoryOptions, Output, Vertical

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.processing.listed import Listed
    from rocking_cli.structure import Structure

COMMANDLINE = ParameterSource.COMMANDLINE


def check(asked: GroundMotions, history: HistoryOptions, count: int, *, impacts: bool, contact: bool) -> None:
    """Raise if options are given that apply to a single direction."""
    if count != 1 or asked.pulses:
        raise click.UsageError("--azimuth all takes a single pair of components: give one --record FILE.")
    if asked.polarity != "1":
        raise click.UsageError("--azimuth all already covers both polarities: leave out --polarity.")
    context = click.get_current_context()
    typed = [name for name in ("tail", "neighbours") if context.get_parameter_source(name) is COMMANDLINE]
    if history.with_pulse is not None or impacts or contact or typed:
        raise click.UsageError(
            "--with-pulse, --impacts, --contact, --tail and --neighbours apply to one direction: "
            "give a single --azimuth."
        )


def respond(
    structure: Structure,
    models: Sequence[ModelName],
    record: Listed,
    asked: GroundMotions,
    vertical: Vertical,
    history: HistoryOptions,
    output: Output,
) -> None:
    """Simulate a structure in all directions under a pair of components, and show the outcomes."""
    from rocking_cli.cli import structures
    from rocking_cli.excitation.measures import measure
    from rocking_cli.plotting import style
    from rocking_cli.plotting.azimuths import draw_azimuths
    from rocking_cli.studies.azimuths import all_around
    from rocking_cli.views.azimuths import columns, view
    from rocking_cli.views.view import heading

    reading = record.reading(asked.towards(0.0))
    one, other = reading.pair(record.path)
    for each in (one, other):
        inputs.introduce("component", each)
        inputs.warn(each, structure.growth)
    if vertical.vertical is not None:
        one = replace(one, vertical=inputs.read_vertical(vertical, reading))
    factor = motion_files.factor(one, measure(one.of_ground), *asked.scaling)
    if factor != 1:
        terminal.note(f"scaled by {factor:.6g}: PGA = {abs(factor) * one.of_ground.pga_g:.4g} g at 0 degrees")
    release = history.release.ratio(structure) if history.release is not None else None
    found = all_around(structure, models, (one, other), factor, release=release, rtol=history.rtol)

    def draw() -> Figure:
        one, other = (side.phi_cr is None for side in structure.statics)
        return draw_azimuths(found, heading(structure.mechanism), style.over((one, other), math=True))

    output.write(lambda: [columns(found)], draw)
    terminal.show(view(structure, found, structures.doubts(structure.mechanism)), as_json=output.as_json)
