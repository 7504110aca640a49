"""The control point of a verification, whose displacement is compared with the demand."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.core import Mechanism
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.errors import InputError, Problem


@dataclass(frozen=True)
class Control:
    """Position of a control point [m], and its body; without a body the code chooses the point."""

    at: complex
    body: str | None = None


def control_at(mechanism: Mechanism, x: float, y: float, body: str | None = None) -> Control:
    """Return a control point of a body; one body may be left out. Raises `InputError` if the point is not on it."""
    try:
        spot = mechanism.carrier.spot(body, complex(x, y), (), "control")
    except RefusedFields as error:
        raise InputError(Problem(f"`control`: {error.reason}")) from None
    return Control(spot.at, spot.body)
