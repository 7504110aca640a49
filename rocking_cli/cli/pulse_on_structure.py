"""`rocking pulse FILE`: compute the response of a structure to a pulse, by all models."""

from __future__ import annotations

from rocking_cli.cli import structures, terminal
from rocking_cli.cli.groups import SizedPulse
from rocking_cli.cli.waiting import compile_first
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.structure import Structure
from rocking_cli.studies.pulse_on_structure import Answer, answers, closed_forms, sampled_histories
from rocking_cli.views.pulse_on_structure import view


def run(file: str | None, given: SizedPulse, *, as_json: bool) -> None:
    """Compute the responses and print them."""
    pulse = given.pulse
    structure = structures.prepared([file] if file else [])
    found = {sign: _answers(structure, pulse, sign) for sign in given.signs}
    terminal.show(view(structure, pulse, found, closed_forms(structure, pulse)), as_json=as_json)


def _answers(structure: Structure, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """Return the responses of the models; warn of those that do not converge with the sampling."""
    compile_first()
    sampled = sampled_histories(structure, pulse, polarity)
    for name, found in sampled.items():
        if not found.converged:
            terminal.warning(
                f"{name}: not converged with {found.per_period} samples per period: another motion is close"
            )
    return answers(structure, pulse, polarity, sampled)
