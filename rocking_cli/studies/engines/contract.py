"""What every engine does: simulate one motion of a structure, or many."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, ClassVar, Literal, TypedDict, Unpack

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.excitation.base import GroundMotion

if TYPE_CHECKING:
    pass

EngineName = Literal["exact", "blocks", "auto"]


class RunOptions(TypedDict, total=False):
    """Options of many motions, see `respond_many`."""

    release: float | Reals | None
    threads: int | None
    rtol: float
    only_peaks: bool
    progress: Callable[[int], None] | None


class Engine(ABC):
    """An engine: who simulates the motion of a structure."""

    name: ClassVar[EngineName]

    @abstractmethod
    def outcomes(
        self,
        models: Sequence[Model],
        motions: Sequence[GroundMotion | None],
        runs: Runs,
        **options: Unpack[RunOptions],
    ) -> Outcomes:
        """Simulate many motions; parameters and errors are those of `respond_many`."""
