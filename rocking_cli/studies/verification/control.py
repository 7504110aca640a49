"""The control point of a verification, whose displacement counts."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.core import Mechanism
from rocking_cli.core.hung.attachments import Carrier, RefusedFields
from rocking_cli.errors import InputError, Problem


@dataclass(frozen=True)
class Control:
    """A point of a body [m]; without a body a point that the code chooses."""

    at: complex
    body: str | None = None


def control_at(mechanism: Mechanism, x: float, y: float, body: str | None) -> Control:
    """A control point of a body, which may be left out where there is one. Raises `InputError` if it is not on it."""
    carrier = Carrier.of(mechanism.bodies(), mechanism.sketch(), mechanism.alike(), mechanism.piece)
    try:
        spot = carrier.spot(body, complex(x, y), (), "control")
    except RefusedFields as error:
        raise InputError(Problem(f"`control`: {error.reason}")) from None
    return Control(spot.at, spot.body)
