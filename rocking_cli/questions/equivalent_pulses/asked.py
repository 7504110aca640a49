"""What `rocking equivalent_pulses` and `rk.equivalent_pulses` are asked."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from rocking_cli.ask.asked import Idle, Kind, option
from rocking_cli.ask.groups import OfJoints, SizedPulse, StructureLike, WithTable, plot_file, polarity, table_file
from rocking_cli.ask.kinds import each, number

if TYPE_CHECKING:
    from rocking_cli.excitation.pulses import Pulse
else:
    Pulse = Any


def _pulse(value: Any) -> Any:
    from rocking_cli.excitation.pulses import Pulse, parse_pulse

    if not isinstance(value, str | Pulse):
        raise ValueError(f"{value!r} is not a pulse: give one such as sine:0.6g:0.8s")
    return parse_pulse(value) if isinstance(value, str) else value


def _restitution(value: Any) -> Any:
    with suppress(ValueError):
        if 0 < number(value) <= 1:
            return number(value)
    if value not in ("first", "own"):
        raise ValueError(f"{value!r} is not valid: give a number above 0 and at most 1, first or own")
    return value


class EquivalentPulsesAsked(SizedPulse, OfJoints, WithTable):
    """Find the pulses to which several structures are equally vulnerable.

    The given pulse is for the first FILE. Every other structure gets the pulse with the same a = a_g/(g lambda) and
    omega = omega_g/p, and the nonlinear responses are compared as phi/phi_cr against p t: the output shows how closely
    they agree.

    The comparison requires the same coefficient of restitution. If the directions of a structure differ, p and lambda
    are those of the direction that the pulse uplifts first. A FILE that cannot be used is reported and skipped, and the
    exit code is 5.

    \b
    Example:
      rocking equivalent_pulses block.yaml frame.yaml wall.yaml --ag 0.6g --period 0.8 --plot equivalent.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6.2 and Fig. 15.
    """

    structures: Sequence[StructureLike] = option(
        "At least two structures, or their YAML files; the pulse is for the first.",
        Kind(each), where="input", default=..., min_length=2,
    )  # fmt: skip
    pulse: Pulse | str | None = option(
        "The pulse in one word, such as sine:0.6g:0.8s, instead of its amplitude, period and shape.",
        Kind(_pulse, "PULSE", words="rocking.pulses"),
    )
    polarity: Literal["1", "-1", 1, -1] = polarity(allowed="1 -1")
    kappa: Literal["1", "2"] = option(
        "Equivalent block by which the pulses are scaled: 1 for kappa1, 2 for kappa2.", Kind(str, words="1 2"),
        default="2",
    )  # fmt: skip
    restitution: float | Literal["first", "own"] = option(
        "Coefficient of restitution: a number for all structures, that of the first, or each structure's own.",
        Kind(_restitution, "NUMBER|first|own", words="first own"), default="first",
    )  # fmt: skip
    out: Path | None = table_file("Write the responses against p t")
    plot: Path | None = plot_file("Plot the responses")
    idle = (Idle("beside {pulse}", lambda asked: asked.pulse is not None, ("ag", "period", "shape")),)
