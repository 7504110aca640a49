"""The exact engine: tables of the mechanism, and a compiled kernel from impact to impact."""

from __future__ import annotations

from typing import ClassVar

from rocking_cli.dynamics.history import History, follow
from rocking_cli.dynamics.model import ModelName
from rocking_cli.engines.base import Engine, Knowledge
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure


class Exact(Engine):
    """One degree of freedom between impacts: the joints of the mechanism open, all others are checked.

    Nonlinear: Eq. 8 by an error-controlled Runge-Kutta-Nystrom pair. Linear: Eq. 16, exact on every ramp of the
    record; with a vertical component, whose g changes along the ramp, by the same pair.
    """

    name = "exact"
    knows: ClassVar[frozenset[Knowledge]] = frozenset({"linear models", "releases", "vertical components", "joints"})

    def refuses(self, structure: Structure) -> None:
        """Refuse no structure: each has one degree of freedom. One without a model is an error of its own."""

    def history(
        self,
        structure: Structure,
        motion: GroundMotion | None,
        *,
        model: ModelName,
        release: float,
        tail: float,
        rtol: float,
    ) -> History:
        """Return the history of a model of the structure."""
        return follow(structure.model(model), motion, release=release, tail=tail, rtol=rtol)
