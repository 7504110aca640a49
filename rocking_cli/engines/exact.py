"""The exact engine: tables of the mechanism, and a compiled kernel that integrates from impact to impact."""

from __future__ import annotations

from typing import ClassVar

from rocking_cli.dynamics.history import History, follow
from rocking_cli.dynamics.model import ModelName
from rocking_cli.engines.base import Engine, Knowledge
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure


class Exact(Engine):
    """Engine for one degree of freedom: the joints of the mechanism open and close, and all others are only checked.

    Nonlinear: Eq. 8 by an error-controlled Runge-Kutta-Nystrom pair. Linear: Eq. 16, exact on every ramp of the
    record; with a vertical component, whose g changes along the ramp, by the same pair.
    """

    name = "exact"
    knows: ClassVar[frozenset[Knowledge]] = frozenset({"linear models", "releases", "vertical components", "joints"})

    def refuses(self, structure: Structure) -> None:
        """Return None: the exact engine refuses no structure; building the model raises an error if impossible."""

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
        """Return the history of a model of the structure; arguments are those of `Engine.history`."""
        return follow(structure.model(model), motion, release=release, tail=tail, rtol=rtol)
