"""A structure with the statics, equivalent blocks and models derived from its mechanism, each computed once."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, TypeVar
from weakref import ref

from pydantic import ValidationError

from rocking_cli.core import Equivalence, Mechanism, NoEquivalentBlock, Statics, both_statics, equivalent_block
from rocking_cli.core.equivalence import MAX_CURVATURE, uplift_error
from rocking_cli.core.hung.element import Question
from rocking_cli.dynamics.model import MODELS, Model, ModelName, build, no_restitution
from rocking_cli.dynamics.parallel import matrices_by_one_thread
from rocking_cli.errors import InputError, MechanismError, Problem, named, of_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.field_problems import (
    by_meaning,
    fields_at,
    is_plural,
    lists_models,
    names_at,
    of_arguments,
    spellings,
    types_at,
    unit_at,
)
from rocking_cli.io.yaml_file import Place, placed, put, words
from rocking_cli.names import OPENING
from rocking_cli.short_repr import short_repr
from rocking_cli.text import cut, did_you_mean

T = TypeVar("T")
MOST_KEPT = 16  # results that are kept of structures that are asked again; the tables of one take some megabytes
MAX_OPENING = 1000.0  # bound on the largest opening over D_cr; with wider openings every outcome is known


_KEPT: dict[tuple[int, Hashable], tuple[ref[Mechanism], Any]] = {}


def kept(mechanism: Mechanism, what: Hashable, make: Callable[[], T]) -> T:
    """Return a result of a mechanism, made once while the mechanism lives and is among those that were last asked."""
    key = id(mechanism), what
    if (entry := _KEPT.pop(key, None)) is None:
        forget = _KEPT.pop  # bound, as Python empties modules before it forgets the last structures
        entry = ref(mechanism, lambda _: forget(key, None)), make()
    _KEPT[key] = entry
    for oldest in list(_KEPT)[:-MOST_KEPT]:
        _KEPT.pop(oldest, None)
    result: T = entry[1]
    return result


def with_name(mechanism: Mechanism) -> Mechanism:
    """Return a mechanism with a name: its own, or that of its kind."""
    if mechanism.name:
        return mechanism
    return kept(mechanism, "named", lambda: mechanism.model_copy(update={"name": mechanism.mechanism}))


def with_restitution(mechanism: Mechanism, eta: float) -> Mechanism:
    """Return a mechanism with another restitution of all impacts (the rebound, if it rocks to one side only).

    Raises `InputError` if the mechanism does not accept this restitution.
    """
    field = "restitution" if mechanism.rocks_both_ways else "rebound"
    try:
        return mechanism.model_copy(update={field: eta})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        reason = first["ctx"]["reason"] if first["type"] == "geometry" else f"{first['msg']}, got {eta:g}"
        name = f"{mechanism.name or mechanism.mechanism}: {'rebound: ' if field == 'rebound' else ''}"
        raise InputError(Problem(f"{name}{reason[0].lower()}{reason[1:]}", field=named("restitution"))) from None


def build_models(
    mechanism: Mechanism, names: Sequence[ModelName] = MODELS, *, opening: float = OPENING
) -> list[Model]:  # fmt: skip
    """Build the models of a mechanism: its equations of motion as arrays, for `respond_many`.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    names : sequence of {"nonlinear", "linear1", "linear2"}
        Which models.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.

    Returns
    -------
    list of Model
        One for each name.

    Raises
    ------
    InputError
        If `opening` is out of range.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Examples
    --------
    >>> from rocking_cli import Registry
    >>> [each.name for each in build_models(Registry()["block"](width=0.7, height=2.8), ("nonlinear", "linear2"))]
    ['nonlinear', 'linear2']
    """
    return Structure(mechanism, opening=opening).models(names)


def check_opening(opening: float) -> None:
    """Raise `InputError` if a largest opening of joints, over D_cr, is out of range."""
    if not 0 <= opening <= MAX_OPENING:
        raise InputError(Problem(f"must be from 0 to {MAX_OPENING:g}, got {opening:g}", field=named("opening")))


@short_repr
@dataclass(frozen=True, eq=False)
class Structure:
    """A structure as a run has it, with all that is derived from its mechanism, computed when first requested.

    Parameters
    ----------
    mechanism : Mechanism
        Mechanism, with its loads and ties, and with the restitution of the run if one is given.
    file : str, optional
        File of the structure, for messages on fields whose errors show only when they are used.
    opening : float
        Largest opening of a joint up to which its time histories are valid, over D_cr: the displacement of its farthest
        block at the critical rotation.
    to_first_impact : bool
        Whether time histories of a structure without a known restitution are simulated up to their first impact, and
        not refused.
    restitution : float, optional
        Restitution of all impacts that is given for the run, in place of that of the mechanism; for one-sided rocking,
        the rebound.

    Raises
    ------
    InputError
        If the opening is out of range, or the mechanism does not accept the restitution.
    """

    mechanism: Mechanism
    file: str | None = None
    opening: float = OPENING
    to_first_impact: bool = False
    restitution: float | None = None
    _derived: dict[str, Any] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_opening(self.opening)
        if self.restitution is not None:
            given, eta = self.mechanism, self.restitution
            restored = kept(given, ("restitution", eta), lambda: with_restitution(given, eta))
            object.__setattr__(self, "mechanism", restored)
        derived = kept(self.mechanism, (self.opening, self.to_first_impact), dict[str, Any])
        object.__setattr__(self, "_derived", derived)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle and copy what it is made of: what is derived, such as tables of megabytes, is computed anew."""
        return Structure, (self.mechanism, self.file, self.opening, self.to_first_impact, self.restitution)

    def under(self, *, opening: float | None = None, restitution: float | None = None) -> Structure:
        """Return the structure as a run has it; what is None stays. Raises `InputError` if a value is not valid."""
        opening = self.opening if opening is None else opening
        restitution = self.restitution if restitution is None else restitution
        if (opening, restitution) == (self.opening, self.restitution):
            return self
        return replace(self, opening=opening, restitution=restitution)

    def of(self, mechanism: Mechanism) -> Structure:
        """Return the structure with another mechanism, such as its own with another field."""
        return replace(self, mechanism=mechanism)

    def released(self) -> Structure:
        """Return the structure for a free release: without a known restitution, simulated up to its first impact."""
        return self if no_restitution(self.mechanism) is None else replace(self, to_first_impact=True)

    @property
    def name(self) -> str:
        """Name of the structure, or of its mechanism if it has none."""
        return self.mechanism.name or self.mechanism.mechanism

    def _once(self, what: str, make: Callable[[], T]) -> T:
        """Return a result of the structure, made once, whose errors have the structure's name."""
        if what not in self._derived:
            with self.named():
                self._derived[what] = make()
        result: T = self._derived[what]
        return result

    @property
    def equivalence(self) -> Equivalence:
        """Equivalent blocks of both directions. Raises `MechanismError`, with the structure's name, if none exist."""
        return self._once("equivalence", lambda: equivalent_block(self.mechanism, self.statics))

    @property
    def statics(self) -> tuple[Statics, Statics]:
        """Statics of both directions; needs no equivalent block. Raises `MechanismError` with the structure's name."""
        return self._once("statics", lambda: both_statics(self.mechanism))

    @cached_property
    def why_no_block(self) -> str | None:
        """Reason why the structure has no equivalent block, a sentence; None if it has one in each direction."""
        try:
            self.equivalence  # noqa: B018 - computes and caches it
        except NoEquivalentBlock as error:
            return f"{error}"
        return None

    @cached_property
    def misleading(self) -> str | None:
        """Reason why the linear models mislead, a sentence; None if they do not, or if there is no equivalent block.

        Only for structures with loads or ties: for a bare mechanism, the error is given with each kappa.
        """
        if self.why_no_block is not None or not self.mechanism.bends:
            return None
        if why := self.refuses("linear models"):
            return why
        far = max(each.departure for each in self.statics)
        off = uplift_error(self.equivalence)
        if far > MAX_CURVATURE:
            return (
                f"the linear models mislead: the restoring moment leaves the straight line to phi_cr by {far:.2g} of "
                "its value at rest"
            )
        if abs(off) > MAX_CURVATURE:
            return (
                "the linear models mislead: the uplift acceleration of the linearised mechanism is "
                f"{1 + off:.3g} times its own"
            )
        return None

    def refuses(self, question: Question) -> str | None:
        """Return why the structure's elements prevent an answer to a question, a sentence; None if they do not."""
        return self.mechanism.hung.refuses(question)

    def ask(self, question: Question) -> None:
        """Raise `InputError`, with the structure's file, if its elements prevent an answer to a question."""
        with self.named():
            self.mechanism.hung.ask(question)

    @cached_property
    def no_model(self) -> str | None:
        """Reason why the structure has no rocking model, as one that slides; None if it has one in each direction."""
        try:
            self.model("nonlinear")
        except MechanismError as error:
            return f"{error}"
        return None

    @property
    def default_models(self) -> tuple[ModelName, ...]:
        """Models to simulate by default: all, or the nonlinear one alone if the linear ones mislead or do not exist."""
        all_fit = no_restitution(self.mechanism) is None and self.why_no_block is None and self.misleading is None
        return MODELS if all_fit else ("nonlinear",)

    @cached_property
    def etas(self) -> tuple[float, float]:
        """Restitution of the impacts that end positive and negative motion; for one-sided rocking, the rebound."""
        with self.named():
            return self.mechanism.eta(self.mechanism.sides[0]), self.mechanism.eta(self.mechanism.sides[1])

    @property
    def restitution_source(self) -> str:
        """Where the restitution comes from: "run", "given" (by the file), "kinematics", "impacts", or "missing"."""
        if self.restitution is not None:
            return "run"
        if not self.mechanism.restitution_is_kinematic:
            return "given"
        if self.mechanism.rocks_both_ways:
            return "kinematics"
        return "missing" if self.mechanism.rebound_from_impacts() is None else "impacts"

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s]: the larger of both directions; without a block, of the nonlinear model."""
        if self.why_no_block is None:
            return max(self.equivalence.positive.p, self.equivalence.negative.p)
        return self.model("nonlinear").p

    @property
    def growth(self) -> float:
        """Rate at which a rotation near the critical one diverges [1/s]; 0 without an equivalent block."""
        return self.p if self.why_no_block is None else 0.0

    @property
    def uplift(self) -> tuple[float, float]:
        """Uplift acceleration of the ground in the positive and in the negative direction [standard gravity]."""
        unit = self.mechanism.gravity / STANDARD_GRAVITY
        return self.statics[0].lambda_ * unit, self.statics[1].lambda_ * unit

    def model(self, name: ModelName) -> Model:
        """Return a model of the structure. Raises `InputError` or `MechanismError` if it cannot be built."""
        return self._once(name, lambda: self._built(name))

    def _built(self, name: ModelName) -> Model:
        statics, equivalence = self.statics, self.equivalence if name != "nonlinear" else None
        with matrices_by_one_thread():
            model = build(
                self.mechanism, statics, equivalence, name, self.opening, to_first_impact=self.to_first_impact
            )
        model.protect()
        return model

    def models(self, names: Sequence[ModelName] = MODELS) -> list[Model]:
        """Return several models of the structure, in the order of `names`."""
        return [self.model(name) for name in names]

    def unit_of(self, field: str) -> str:
        """Return the unit of a numeric field, empty if dimensionless. Raises `InputError` if the field does not exist.

        A field is named by its path, with dots, and entries of lists by name or number: `ties.bar.prestress`.
        """
        return unit_at(type(self.mechanism), self._place_of(field))

    def is_whole(self, field: str) -> bool:
        """Return whether a numeric field takes whole numbers only. Raises as `unit_of`."""
        return float not in types_at(type(self.mechanism), self._place_of(field))

    def value_of(self, field: str) -> float | None:
        """Return the value of a numeric field; None if it is not given. Raises as `unit_of`."""
        here: Any = self._data
        for part in self._place_of(field):
            here = here.get(part) if isinstance(here, dict) else here[part]
            if here is None:
                return None
        return float(here) if isinstance(here, int | float) else None

    def varied(self, field: str, value: float) -> Structure:
        """Return the structure with another value of a field. Raises `InputError` if it cannot be built."""
        data, cls = deepcopy(self._data), type(self.mechanism)
        value = int(value) if self.is_whole(field) and float(value).is_integer() else value
        put(data, self._words(field), value, is_list=partial(lists_models, cls), grow=False)
        folder = Path(self.file).parent if self.file is not None else None
        try:
            return self.of(cls.from_fields(data, folder))
        except ValidationError as error:
            raise InputError(*of_arguments(cls, error.errors(include_url=False), cls.mechanism)) from None

    def _words(self, field: str) -> tuple[str, ...]:
        """Return the path of a field, whose first word is its usual name even if the field is given by another."""
        first, *rest = words(field)
        names = [spellings(name, info) for name, info in type(self.mechanism).model_fields.items()]
        return next((each[0] for each in names if first in each), first), *rest

    @cached_property
    def _data(self) -> dict[str, Any]:
        return self.mechanism.model_dump(by_alias=True, exclude_unset=True)

    def _place_of(self, field: str) -> Place:
        """Return the path of a numeric field in the structure's data.

        Raises `InputError` if the field does not exist or is not numeric.
        """
        cls, path = type(self.mechanism), self._words(field)
        place = put(deepcopy(self._data), path, 1.0, is_list=partial(lists_models, cls), grow=False)
        known_path: Place = ()
        for k, part in enumerate(place):
            if isinstance(part, str):
                named = names_at(cls, known_path)
                known = list(self._entries(known_path) if named else fields_at(cls, known_path))
                if part not in known:
                    within = ".".join(path[:k]) or cls.mechanism
                    message = f"{within} has no {cut(part)}" if named else f"{cut(part)} is not a field of {within}"
                    hint = by_meaning(part, fields_at(cls, known_path)) or did_you_mean(part, known)
                    raise InputError(Problem(message if k else f"is not a field of {within}", field=field, hint=hint))
            known_path = (*known_path, part)
        kinds = types_at(cls, place)
        if not kinds & {float, int} or (isinstance(place[-1], str) and is_plural(cls, place)):
            given = [name for name in fields_at(cls, ()) if name in self._data and not is_plural(cls, (name,))]
            numeric = [name for name in given if types_at(cls, (name,)) & {float, int}]
            hint = f"a number of this file can be varied, such as {', '.join(numeric)}" if numeric else None
            raise InputError(Problem("is not a numeric field, so it cannot be varied", field=field, hint=hint))
        return place

    def _entries(self, place: Place) -> list[str]:
        """Return the names that the user gave to the entries at a place of the data, such as ties."""
        here: Any = self._data
        for part in place:
            here = (here or {}).get(part) if isinstance(part, str) else here[part]
        return list(here or {})

    @contextmanager
    def named(self) -> Iterator[None]:
        """Prefix mechanics errors with the structure's name, and add its file to errors of its fields."""
        try:
            yield
        except MechanismError as error:
            raise of_structure(error, self.name) from error
        except InputError as error:
            if self.file is None:
                raise
            raise InputError(*(placed(replace(each, file=each.file or self.file)) for each in error.problems)) from None
