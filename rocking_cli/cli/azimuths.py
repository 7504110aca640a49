"""`rocking respond --azimuth all`: rotate a pair of components into every direction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from rocking_cli.cli.groups import GroundMotions, Output

if TYPE_CHECKING:
    from rocking_cli.ask.watcher import Watcher
    from rocking_cli.structure import Structure

COMMANDLINE = ParameterSource.COMMANDLINE


def show(
    structure: Structure, asked: GroundMotions, output: Output, question: Mapping[str, Any], watch: Watcher
) -> None:  # fmt: skip
    """Simulate a structure in all directions under a pair of components, and show the outcomes."""
    from rocking_cli.ask.ground_motions import Motions, introduce, warn_about
    from rocking_cli.ask.motions import respond_around
    from rocking_cli.excitation.measures import measure
    from rocking_cli.excitation.scaled import Scaled

    reading = asked.towards(0.0)
    motions = Motions(tuple(asked.records), reading, None, *asked.scaling)
    _check(asked, question, motions.count)
    output.keep_apart(structure.file, *motions.records, question["vertical"])
    (record,) = motions.records
    one, other = record.reading(reading).pair(record.path)
    for component in (one, other):
        introduce("component", Scaled(component, 1.0), watch)
        warn_about([component], watch, structure.growth)
    if question["vertical"] is not None:
        scaled = Scaled(one, 1.0, file=record.path)
        one = replace(
            one,
            vertical=motions.vertical(
                scaled, question["vertical"], question["vertical_dt"], question["vertical_channel"], watch
            ),
        )
    factor = motions.factor(one, measure(one.of_ground))
    if factor != 1:
        watch.note(f"scaled by {factor:.6g}: PGA = {abs(factor) * one.of_ground.pga_g:.4g} g at 0 degrees")
    given = {name: question[name] for name in ("models", "release", "rtol")}
    output.show(respond_around(structure, one, other, scale=factor, **given))


def _check(asked: GroundMotions, question: Mapping[str, Any], count: int) -> None:
    """Raise if options are given that apply to a single direction."""
    if count != 1 or asked.pulses:
        raise click.UsageError("--azimuth all takes a single pair of components: give one --record FILE.")
    if asked.polarity != "1":
        raise click.UsageError("--azimuth all already covers both polarities: leave out --polarity.")
    context = click.get_current_context()
    typed = [name for name in ("tail", "neighbours") if context.get_parameter_source(name) is COMMANDLINE]
    if question["with_pulse"] is not None or question["impacts"] or question["contact"] or typed:
        raise click.UsageError(
            "--with-pulse, --impacts, --contact, --tail and --neighbours apply to one direction: "
            "give a single --azimuth."
        )
