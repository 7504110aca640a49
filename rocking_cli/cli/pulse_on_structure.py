"""`rocking pulse FILE`: a pulse on a structure, by its equivalent blocks and by its nonlinear history."""

from __future__ import annotations

from rocking_cli.cli import structures, terminal
from rocking_cli.cli.groups import SizedPulse
from rocking_cli.cli.waiting import compile_first
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.studies.pulse_on_structure import Answer, answers, closed_forms, sampled_histories
from rocking_cli.views.pulse_on_structure import view


def run(file: str | None, given: SizedPulse, *, as_json: bool) -> None:
    """Do all that is asked for and print it."""
    pulse = given.pulse
    structure = structures.prepared([file] if file else [])
    found = {sign: _answers(structure, pulse, sign) for sign in given.signs}
    terminal.show(view(structure, pulse, found, closed_forms(structure, pulse)), as_json=as_json)


def _answers(structure: Prepared, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """What the models say, with a warning of those that no sampling settles."""
    compile_first()
    sampled = sampled_histories(structure, pulse, polarity)
    for name, found in sampled.items():
        if not found.converged:
            terminal.warning(
                f"{name}: {found.per_period} samples to a period do not settle it: it is close to another motion"
            )
    return answers(structure, pulse, polarity, sampled)
