"""What every engine does: simulate one motion of a structure, or many."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Literal, TypedDict, Unpack

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.excitation.base import GroundMotion

if TYPE_CHECKING:
    from rocking_cli.studies.conditions import Conditions

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
    def respond(self, conditions: Conditions, motion: GroundMotion | None = None) -> Mapping[ModelName, History]:
        """Simulate models of a structure under a motion; errors are those of `exact.follow`.

        Parameters
        ----------
        conditions : Conditions
            The structure and the conditions of the run.
        motion : GroundMotion, optional
            The motion, scaled and reversed; None for a release alone.

        Returns
        -------
        mapping of str to History
            History of each model, in their order; that of free blocks has the model "blocks".
        """

    @abstractmethod
    def outcomes(
        self,
        models: Sequence[Model],
        motions: Sequence[GroundMotion | None],
        runs: Runs,
        **options: Unpack[RunOptions],
    ) -> Outcomes:
        """Simulate many motions; parameters and errors are those of `respond_many`."""
