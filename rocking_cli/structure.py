"""A structure: what is derived from its mechanism, its equivalent blocks and its models, each once and kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property

from pydantic import ValidationError

from rocking_cli.core import Equivalence, Mechanism, NoEquivalentBlock, Statics, both_statics, equivalent_block
from rocking_cli.core.advice import uplift_error
from rocking_cli.core.statics import STRAIGHT
from rocking_cli.dynamics.model import MODELS, Model, ModelName, build
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY


def with_restitution(mechanism: Mechanism, eta: float) -> Mechanism:
    """A structure with another restitution of every impact: the rebound of one that rocks to one side only.

    Raises `InputError` if it cannot have it.
    """
    field = "restitution" if mechanism.rocks_both_ways else "rebound"
    try:
        return mechanism.model_copy(update={field: eta})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        reason = first["ctx"]["reason"] if first["type"] == "geometry" else f"{first['msg']}, got {eta:g}"
        name = mechanism.name or mechanism.mechanism
        raise InputError(Problem(f"{name}: {reason[0].lower()}{reason[1:]}", field=field)) from None


@dataclass(frozen=True, eq=False)
class Structure:
    """A structure, and all that is derived from its mechanism, computed when first requested.

    Parameters
    ----------
    mechanism : Mechanism
        What it is, with what hangs on it.
    file : str, optional
        Where it stands, for errors of its fields that show only when they are used.
    """

    mechanism: Mechanism
    file: str | None = None
    _models: dict[ModelName, Model] = field(default_factory=dict, repr=False)

    @property
    def name(self) -> str:
        """What to call it."""
        return self.mechanism.name or self.mechanism.mechanism

    @cached_property
    def equivalence(self) -> Equivalence:
        """Its equivalent blocks. Raises `MechanismError`, naming it, if it has none."""
        with self._named():
            return equivalent_block(self.mechanism, self.statics)

    @cached_property
    def statics(self) -> tuple[Statics, Statics]:
        """Its moments in both directions, also where no block is equivalent. Raises `MechanismError`, naming it."""
        with self._named():
            return both_statics(self.mechanism)

    @cached_property
    def why_no_block(self) -> str | None:
        """Why no single block is equivalent to it, as a sentence; None if there is one in each direction."""
        try:
            self.equivalence  # noqa: B018 - it is kept
        except NoEquivalentBlock as error:
            return f"{error}"
        return None

    @cached_property
    def misleading(self) -> str | None:
        """Why its linear models mislead though there is a block, as a sentence; None if they do not, or there is none.

        Only for structures that something is attached to: for a bare one, the error is given with each kappa.
        """
        if self.why_no_block is not None or not self.mechanism.bends:
            return None
        far = max(each.departure for each in self.statics)
        off = uplift_error(self.equivalence)
        if far > STRAIGHT:
            return (
                f"the linear models mislead: the restoring moment leaves the straight line to phi_cr by {far:.2g} of "
                "its value at rest"
            )
        if abs(off) > STRAIGHT:
            return (
                "the linear models mislead: the uplift acceleration of the linearised mechanism is "
                f"{1 + off:.3g} times its own"
            )
        return None

    @property
    def default_models(self) -> tuple[ModelName, ...]:
        """The models to follow where nobody asks for some: the linear ones only where they do not mislead."""
        return MODELS if self.why_no_block is None and self.misleading is None else ("nonlinear",)

    @cached_property
    def etas(self) -> tuple[float, float]:
        """Restitution of an impact that ends positive and negative motion; the rebound where it rocks to one side."""
        with self._named():
            return self.mechanism.eta(self.mechanism.sides[0]), self.mechanism.eta(self.mechanism.sides[1])

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s], of two different directions the larger; without a block, how fast it moves."""
        if self.why_no_block is None:
            return max(self.equivalence.positive.p, self.equivalence.negative.p)
        return self.model("nonlinear").p

    @property
    def growth(self) -> float:
        """How fast a tilt near the critical one grows [1/s]; 0 where none is critical."""
        return self.p if self.why_no_block is None else 0.0

    @property
    def uplift(self) -> tuple[float, float]:
        """The ground acceleration that lifts it to the positive and the negative direction [standard gravity]."""
        unit = self.mechanism.gravity / STANDARD_GRAVITY
        return self.statics[0].lambda_ * unit, self.statics[1].lambda_ * unit

    def model(self, name: ModelName) -> Model:
        """One of its models. Raises `InputError` or `MechanismError` if it cannot be built."""
        if name not in self._models:
            statics, equivalence = self.statics, self.equivalence if name != "nonlinear" else None
            with self._named():
                self._models[name] = build(self.mechanism, statics, equivalence, name)
        return self._models[name]

    def models(self, names: Sequence[ModelName] = MODELS) -> list[Model]:
        """Some of its models."""
        return [self.model(name) for name in names]

    def with_eta(self, eta: float) -> Structure:
        """The same structure with another restitution of every impact. Raises `InputError` if it cannot have it."""
        return Structure(with_restitution(self.mechanism, eta), self.file)

    @contextmanager
    def _named(self) -> Iterator[None]:
        """Have errors of the mechanics begin with the name of the structure, and those of its fields with its file."""
        try:
            yield
        except MechanismError as error:
            raise of_structure(error, self.name) from error
        except InputError as error:
            if self.file is None:
                raise
            raise InputError(*(replace(each, file=each.file or self.file) for each in error.problems)) from None
