"""A structure: what is derived from its mechanism, its equivalent blocks and its models, each once and kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rocking_cli.core import Equivalence, Mechanism, NoEquivalentBlock, Statics, both_statics, equivalent_block
from rocking_cli.core.advice import uplift_error
from rocking_cli.core.hung.element import Question
from rocking_cli.core.statics import STRAIGHT
from rocking_cli.dynamics.dispatch import build
from rocking_cli.dynamics.model import MODELS, Model, ModelName
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.dotted import copied, put, words
from rocking_cli.io.field_problems import fields_at, is_plural, lists_models, names_at, of_arguments, types_at, unit_at
from rocking_cli.io.yaml_file import Place
from rocking_cli.text import cut, did_you_mean


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


def build_models(mechanism: Mechanism, names: Sequence[ModelName] = MODELS) -> list[Model]:
    """Prepare models of a structure: `Structure(mechanism).models(names)`. Raises `InputError` or `MechanismError`."""
    return Structure(mechanism).models(names)


@dataclass(frozen=True, eq=False)
class Structure:
    """A structure, and all that is derived from its mechanism, computed when first requested.

    Parameters
    ----------
    mechanism : Mechanism
        What it is, with what is attached to it.
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
        if why := self.refuses("linear models"):
            return why
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

    def refuses(self, question: Question) -> str | None:
        """Return why its elements leave a question without an answer, as a sentence; None if they do not."""
        return self.mechanism.hung.refuses(question)

    def ask(self, question: Question) -> None:
        """Raise `InputError`, with its file, if its elements leave a question without an answer."""
        with self._named():
            self.mechanism.hung.ask(question)

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

    def unit_of(self, field: str) -> str:
        """Unit of a numeric field, empty if it is dimensionless. Raises `InputError` if it has no such field.

        A field is named by its path, with dots, and entries of lists by name or number: `ties.bar.prestress`.
        """
        return unit_at(type(self.mechanism), self._place_of(field))

    def value_of(self, field: str) -> float | None:
        """Value of a numeric field; None if it is not given. Raises as `unit_of`."""
        here: Any = self._data
        for part in self._place_of(field):
            here = here.get(part) if isinstance(here, dict) else here[part]
            if here is None:
                return None
        return float(here) if isinstance(here, int | float) else None

    def varied(self, field: str, value: float) -> Structure:
        """The same structure with another value of a field. Raises `InputError` if it cannot be built."""
        data, cls = copied(self._data), type(self.mechanism)
        put(data, words(field), value, is_list=partial(lists_models, cls), grow=False)
        folder = Path(self.file).parent if self.file is not None else None
        try:
            return Structure(cls.from_fields(data, folder))
        except ValidationError as error:
            raise InputError(*of_arguments(cls, error.errors(include_url=False), cls.mechanism)) from None

    @cached_property
    def _data(self) -> dict[str, Any]:
        return self.mechanism.model_dump(by_alias=True, exclude_unset=True)

    def _place_of(self, field: str) -> Place:
        """Where a numeric field is in the data. Raises `InputError` if it is not there, or not numeric."""
        cls, path = type(self.mechanism), words(field)
        place = put(copied(self._data), path, 1.0, is_list=partial(lists_models, cls), grow=False)
        found: Place = ()
        for k, part in enumerate(place):
            if isinstance(part, str):
                named = names_at(cls, found)
                known = list(self._entries(found) if named else fields_at(cls, found))
                if part not in known:
                    within = ".".join(path[:k]) or cls.mechanism
                    message = f"{within} has no {cut(part)}" if named else f"{cut(part)} is not a field of {within}"
                    message, hint = message if k else f"is not a field of {within}", did_you_mean(part, known)
                    raise InputError(Problem(message, field=field, hint=hint))
            found = (*found, part)
        if float not in types_at(cls, place) or (isinstance(place[-1], str) and is_plural(cls, place)):
            raise InputError(Problem("is not a numeric field, so it cannot be varied", field=field))
        return place

    def _entries(self, place: Place) -> list[str]:
        """Return the names that the user chose at a place."""
        here: Any = self._data
        for part in place:
            here = (here or {}).get(part) if isinstance(part, str) else here[part]
        return list(here or {})

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
