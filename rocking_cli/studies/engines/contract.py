"""What every engine does: simulate one motion of a structure, or many."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar, Literal

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import RTOL, TAIL_SECONDS, History
from rocking_cli.dynamics.model import MODELS, Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure

EngineName = Literal["exact", "blocks", "auto"]


class Engine(ABC):
    """An engine: who simulates the motion of a structure."""

    name: ClassVar[EngineName]

    @abstractmethod
    def respond(
        self,
        structure: Structure,
        motion: GroundMotion | None = None,
        *,
        models: Sequence[ModelName] = MODELS,
        release: float | None = None,
        tail: float = TAIL_SECONDS,
        rtol: float = RTOL,
    ) -> Mapping[ModelName, History]:
        """Simulate one motion of a structure; parameters and errors are those of `Exact.respond`.

        The history of free blocks has the model "blocks".
        """

    @abstractmethod
    def outcomes(
        self,
        models: Sequence[Model],
        motions: Sequence[GroundMotion | None],
        runs: Runs,
        *,
        release: float | Reals | None = None,
        threads: int | None = None,
        rtol: float = RTOL,
        only_peaks: bool = False,
        progress: Callable[[int], None] | None = None,
    ) -> Outcomes:
        """Simulate many motions; parameters and errors are those of `respond_many`."""
