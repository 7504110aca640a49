"""The conditions of a run, in one object: whatever simulates, draws neighbours or shows results reads them here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

from rocking_cli.dynamics.model import MODELS, Model, ModelName
from rocking_cli.names import RTOL, TAIL_SECONDS
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import Engine, EngineName, engine_of
from rocking_cli.studies.neighbours import Neighbourhood


@short_repr
@dataclass(frozen=True, eq=False)
class Conditions:
    """All on which a run depends, besides its ground motion.

    Parameters
    ----------
    structure : Structure
        The structure as the run has it: restitution and opening of its joints are those given for the run.
    models : sequence of {"nonlinear", "linear1", "linear2"}
        The models that are simulated.
    signs : sequence of int
        The polarities: 1, -1 or both.
    release : float or None
        Fraction of phi_cr at which the structure starts at rest; None: phi = 0.
    release_is_angle : bool
        Whether the release was given as an angle, which stays the same if the slenderness of neighbours varies.
    tail : float
        Duration of the history after the end of the record [s].
    rtol : float
        Relative local error of a step.
    with_pulse : str or None
        Shape of the pulse under which the response is computed as well, or "best"; None for no pulse.
    around : Neighbourhood
        The neighbours of every motion; a count of 0 for none.
    engine : {"exact", "blocks", "auto"}
        Who simulates the motions: one degree of freedom, free blocks, or these where the former tells no outcome. Under
        a single motion the former is simulated beside free blocks, as far as it can be.
    goes_on : bool
        Whether free blocks go on unasked where the outcome of a single motion is unknown, within `MOST_UNASKED_STEPS`.
    """

    structure: Structure
    models: Sequence[ModelName] = MODELS
    signs: Sequence[int] = (1,)
    release: float | None = None
    release_is_angle: bool = False
    tail: float = TAIL_SECONDS
    rtol: float = RTOL
    with_pulse: str | None = None
    around: Neighbourhood = field(default_factory=Neighbourhood)
    engine: EngineName = "exact"
    goes_on: bool = False

    @cached_property
    def by(self) -> Engine:
        """Who simulates the motions. Raises `InputError` as `engine_of`."""
        return engine_of(self.engine, [self.structure.mechanism])

    @property
    def model(self) -> Model:
        """The model whose neighbours are simulated: the structure itself, or else the first of its blocks."""
        return self.structure.model("nonlinear" if "nonlinear" in self.models else self.models[0])

    @property
    def polarity(self) -> str:
        """The polarities as users give them: "1", "-1" or "both"."""
        return "both" if len(self.signs) > 1 else f"{self.signs[0]}"
