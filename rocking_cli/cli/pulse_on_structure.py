"""`rocking pulse FILE`: a pulse on a structure, by its equivalent blocks and by its nonlinear history."""

from __future__ import annotations

import click

from rocking_cli.cli import structures, terminal
from rocking_cli.cli.work import say_if_compiling
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.studies.pulse_on_structure import Answer, answers, closed_forms, sampled_histories
from rocking_cli.views.pulse_on_structure import view


def run(file: str | None, shape: str, ag: str, period: float, polarity: str, as_json: bool) -> None:
    """Do all that is asked for and print it."""
    pulse = _pulse(shape, ag, period)
    structure = structures.prepared([file] if file else [])
    signs = (1, -1) if polarity == "both" else (int(polarity),)
    found = {sign: _answers(structure, pulse, sign) for sign in signs}
    terminal.show(view(structure, pulse, found, closed_forms(structure, pulse)), as_json=as_json)


def _pulse(shape: str, ag: str, period: float) -> Pulse:
    """The pulse of `--shape`, `--ag` and `--period`."""
    name, *further = shape.split(":")
    shapes = PulseShapes()
    if name not in shapes:
        raise click.BadParameter(f"{name!r} is not one of {', '.join(shapes)}.", param_hint="'--shape'")
    try:
        parse_pulse(f"sine:{ag}:1s")
    except InputError:
        raise click.BadParameter(
            f"{ag!r} is not a positive amplitude with its unit: give it as 0.6g, 5.9m/s2, 590cm/s2 or 590gal "
            "(--polarity -1 reverses the pulse).",
            param_hint="'--ag'",
        ) from None
    return parse_pulse(":".join((name, ag, f"{period!r}s", *further)))


def _answers(structure: Prepared, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """What the models say, with a warning of those that no sampling settles."""
    say_if_compiling()
    sampled = sampled_histories(structure, pulse, polarity)
    for name, found in sampled.items():
        if not found.converged:
            terminal.warning(
                f"{name}: {found.per_period} samples to a period do not settle it: it is close to another motion"
            )
    return answers(structure, pulse, polarity, sampled)
