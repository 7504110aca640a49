"""Results of a verification by any code, and the lines of its calculation.

A line has a formula, its numbers, its clause, and how far the formula was checked.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isclose, isfinite, isnan, nan
from typing import Any, Literal, NamedTuple, Self

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.oscillator import Floor
from rocking_cli.processing.reading import Scaled
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.conclusion import Concluded, Conclusion, Effect, LeftOut, Limit, worst
from rocking_cli.studies.remark import Remark, in_plain

Standing = Literal["print", "transcription", "code", "ours", "plain"]
"""How far a formula of a code was checked: `print`, `transcription` or `code`, or that it is not of the code.

`print`: checked against the printed code; `transcription`: against a transcription of its text; `code`: not yet
checked; `ours`: an interpretation where the code leaves a choice; `plain`: mechanics or arithmetic.
"""
SLOT = re.compile(r"{(\w+)(?::(\d+))?}")
"""A slot for a number in a formula, with its number of digits if others than `DIGITS` are printed: `{T:9}`."""
AND_SO_ON = re.compile(r"([^();]+?)( \+ |; )…")
"""Part of a formula that is repeated for each of several numbers: `({P} · {x} + …)`."""
DIGITS = 6
"""Significant digits of numbers in formulas and of results, where a formula does not ask for more."""


class Clause(str):
    """A clause of a code; `transcribed` if it was checked against a transcription of the text."""

    __slots__ = ("transcribed",)
    transcribed: bool

    def __new__(cls, place: str, *, transcribed: bool = False) -> Self:
        """Create a clause from its place in the code."""
        clause = super().__new__(cls, place)
        clause.transcribed = transcribed
        return clause


@dataclass(frozen=True)
class Working:
    """A line of a calculation.

    Parameters
    ----------
    symbol : str
        Symbol of the result, as in the code.
    meaning : str
        Meaning of the result, in a few words.
    formula : str
        The formula.
    numbers : str
        The formula with numbers in place of symbols; empty if they are too many.
    value : float
        The result.
    unit : str
        Unit of the result; empty if it is dimensionless.
    clause : str
        The clause of the code.
    standing : {"print", "transcription", "code", "ours", "plain"}
        How far the formula was checked, see `Standing`; for a formula of the code, its clause decides.
    state : str
        The limit state to which it belongs; empty if it belongs to none alone.
    section : str
        The part of the calculation in which it stands.
    digits : int
        Significant digits of the result, more where later lines subtract near numbers.
    """

    symbol: str
    meaning: str
    formula: str
    numbers: str
    value: float
    unit: str
    clause: str
    standing: Standing = "code"
    state: str = ""
    section: str = ""
    digits: int = DIGITS

    def __post_init__(self) -> None:
        if self.standing == "code" and isinstance(self.clause, Clause) and self.clause.transcribed:
            object.__setattr__(self, "standing", "transcription")

    def in_plain(self, section: str | None = None) -> Working:
        """Return the line in plain characters; `section` names its part of the calculation, if not known yet."""
        texts: dict[str, Any] = {
            key: in_plain(getattr(self, key)) for key in ("symbol", "meaning", "formula", "numbers", "unit")
        }
        return replace(self, **texts, section=in_plain(self.section if section is None else section))


class Evaluated(NamedTuple):
    """A line of a calculation that is not written in a language yet: a formula with its result, names and numbers.

    Parameters
    ----------
    formula : Formula
        The formula.
    value : float
        The result.
    names : mapping of str to object
        Names for the slots of symbol, text, unit and meaning, see `Formula.working`.
    numbers : mapping of str to object
        Values for the slots of the numbers.
    """

    formula: Formula
    value: float
    names: Mapping[str, Any]
    numbers: Mapping[str, Any]


def as_written(value: float, digits: int = DIGITS) -> str:
    """Return a number as it is written in a formula."""
    return f"{value + 0.0:.{digits}g}"


@dataclass(frozen=True)
class Formula:
    """A formula of a code, from which all outputs of a calculation are made.

    Parameters
    ----------
    symbol : str
        Symbol of the result; subscripts and superscripts as in `d_[0]^[*]`, names that differ between uses in slots, as
        in `T_[{state}]`.
    text : str
        The right-hand side in symbols, with the same marks and slots.
    numbers : str
        The right-hand side with a slot for each number; `{P} · {x} + …` is a sum over several, and `{T:9}` is printed
        with nine digits.
    unit : str
        Unit of the result.
    clause : str
        The clause of the code.
    meaning : str
        Meaning of the result, in a few words; for a code with a calculation sheet, the key of its texts.
    standing : {"print", "transcription", "code", "ours", "plain"}
        How far the formula was checked, see `Standing`.
    digits : int
        Significant digits of the result.
    """

    symbol: str
    text: str = ""
    numbers: str = ""
    unit: str = ""
    clause: str = ""
    meaning: str = field(default="", kw_only=True)
    standing: Standing = field(default="code", kw_only=True)
    digits: int = field(default=DIGITS, kw_only=True)

    def working(
        self,
        value: float,
        names: Mapping[str, Any] | None = None,
        /,
        write: Callable[..., str] = as_written,
        marks: Callable[[str], str] = str,
        **numbers: Any,
    ) -> Working:
        """Return a line of a calculation by this formula.

        Parameters
        ----------
        value : float
            The result.
        names : mapping of str to str, optional
            Names for the slots of symbol, text, unit and meaning; `state` is the limit state of the line.
        write : callable
            Function that writes a number, with the number of its digits as second argument where a slot has one.
        marks : callable
            Function that writes a formula with the decimal marks of a language.
        **numbers
            Values for the slots of the numbers: a number, several for a sum, or a text.

        Raises
        ------
        KeyError
            If a slot has no name or number.
        ValueError
            If the sequences of a sum differ in length.

        Examples
        --------
        >>> ratio = Formula("r_[{state}]", "C/D", "{C}/{D}", "", "4.2", meaning="capacity over demand")
        >>> line = ratio.working(1.5, {"state": "ULS"}, C=0.3, D=0.2).in_plain()
        >>> line.symbol, line.formula, line.numbers
        ('r_ULS', 'C/D', '0.3/0.2')
        """
        names = names or {}
        return Working(
            self.symbol.format(**names),
            self.meaning.format(**names),
            marks(self.text.format(**names)),
            put(marks(self.numbers), numbers, write),
            value,
            self.unit.format(**names),
            self.clause,
            self.standing,
            names.get("state", ""),
            digits=self.digits,
        )

    def line(self, value: float, names: Mapping[str, Any] | None = None, /, **numbers: Any) -> Evaluated:
        """Return a line of a calculation by this formula, to be written in a language later; see `working`."""
        return Evaluated(self, value, names or {}, numbers)


def put(numbers: str, values: Mapping[str, Any], write: Callable[..., str]) -> str:
    """Fill the slots of a formula with numbers; negative ones and those with a power of ten in parentheses."""

    def held(value: Any, digits: str | None) -> str:
        if isinstance(value, str):
            return value
        text = write(value, int(digits)) if digits else write(value)
        return f"({text})" if re.search(r"[-−^]", text) else text

    def filled(piece: str, row: Mapping[str, Any]) -> str:
        return SLOT.sub(lambda slot: held(row[slot[1]], slot[2]), piece)

    def repeated(match: re.Match[str]) -> str:
        piece, between = match[1].strip(), match[2]
        names = list(dict.fromkeys(name for name, _ in SLOT.findall(piece)))
        rows = zip(*(values[name] for name in names), strict=True)
        each = [filled(piece, dict(zip(names, row, strict=True))) for row in rows]
        return match[1][: len(match[1]) - len(match[1].lstrip())] + between.join(each)

    return filled(AND_SO_ON.sub(repeated, numbers), values)


class Later(Sequence[Working]):
    """Lines of a calculation that are made when they are first accessed."""

    def __init__(self, write: Callable[[], Sequence[Working]]) -> None:
        self._write = write

    @cached_property
    def _written(self) -> Sequence[Working]:
        return self._write()

    def __getitem__(self, place: Any) -> Any:
        return self._written[place]

    def __len__(self) -> int:
        return len(self._written)


CAPACITY_TOLERANCE = 1e-12  # relative shortfall of a capacity that passes, as rounding may reduce an equal one
SAME_RATIO = 1e-9  # relative difference below which neither direction governs


@dataclass(frozen=True)
class Method:
    """Capacity and demand of a structure by one method of verification.

    Parameters
    ----------
    title : str
        Name of the method.
    capacity, demand : float or None
        Capacity and demand in the same unit; None if the site lacks values on which they depend.
    clause : str
        The clause of the code.
    unit : str
        Unit of capacity and demand.
    """

    title: str
    capacity: float | None
    demand: float | None
    clause: str = ""
    unit: str = field(default="", kw_only=True)

    @property
    def ratio(self) -> float | None:
        """Capacity over demand; infinity if the demand is zero, None if either is not known."""
        if self.capacity is None or self.demand is None:
            return None
        return self.capacity / self.demand if self.demand else inf

    @property
    def passed(self) -> bool | None:
        """Whether the capacity meets the demand; None if either is not known."""
        return None if self.ratio is None else self.ratio >= 1 - CAPACITY_TOLERANCE


def governing(methods: Mapping[str, Method]) -> str:
    """Return the key of the method with the smallest ratio; the first if no ratio is known."""
    return min(methods, key=lambda key: inf if (ratio := methods[key].ratio) is None or isnan(ratio) else ratio)


@short_repr
class Requirement(NamedTuple):
    """What a code requires of a direction at one limit state.

    Parameters
    ----------
    state : str
        Name of the limit state; empty if the code has only one.
    method : str
        Key of the method that governs there.
    ratio : float or None
        Capacity over demand; None if it is not known.
    concluded : Concluded
        Whether it is satisfied.
    motions : sequence of str
        Names of the ground motions by which it was verified, if any.
    motion : str
        The ground motion that takes the structure past its capacity, or whose outcome is unknown; empty if none does.
    required : float or None
        The ratio that is required; None if it is not known.
    """

    state: str
    method: str
    ratio: float | None
    concluded: Concluded
    motions: Sequence[str] = ()
    motion: str = ""
    required: float | None = 1.0

    @classmethod
    def of(cls, state: str, method: str, ratio: float | None, passed: bool | None) -> Requirement:
        """Return the check of a method that passes, fails, or lacks values of the site (None)."""
        known = {True: Concluded.SATISFIED, False: Concluded.NOT_SATISFIED, None: Concluded.NOT_CHECKED}
        return cls(state, method, ratio, known[passed])


@short_repr
@dataclass(frozen=True, eq=False)
class Verified:
    """Result of a verification in one direction of rocking.

    A code whose acceptance differs from that of the method that governs overrides `ratio` and `passed`. Both must
    agree: surveys and designs compare the ratio with 1.

    Parameters
    ----------
    direction : Direction
    methods : mapping of str to Method
        Result of each method of the code, by its key.
    governs : str
        The key of the method that decides, such as `governing(methods)`.
    workings : sequence of Working
        The lines of the calculation.
    remarks : sequence of str or Remark
        Remarks on the results: sentences, or keys of the texts of the code.
    """

    direction: Direction
    methods: Mapping[str, Method]
    governs: str
    workings: Sequence[Working] = field(default=(), kw_only=True)
    remarks: Sequence[str | Remark] = field(default=(), kw_only=True)

    @property
    def counts(self) -> Method:
        """The method that governs."""
        return self.methods[self.governs]

    @property
    def ratio(self) -> float | None:
        """Capacity over demand of the method that governs; None if the site lacks values for it."""
        return self.counts.ratio

    @property
    def passed(self) -> bool | None:
        """Whether the code is satisfied; None if the site lacks values for it."""
        return self.counts.passed

    @property
    def checks(self) -> Sequence[Requirement]:
        """All that the code requires; by default the verdict `passed` on the method that governs."""
        return (Requirement.of("", self.governs, self.ratio, self.passed),)

    @property
    def conclusions(self) -> list[Conclusion]:
        """The conclusion on each of `checks`."""
        return [
            Conclusion(
                concluded=check.concluded, limit_state=check.state, method=check.method,
                direction=self.direction.label, ratio=check.ratio, motions=check.motions, motion=check.motion,
                required=check.required,
            )
            for check in self.checks
        ]  # fmt: skip

    def is_like(self, other: Verified) -> bool:
        """Return whether another direction has the same numbers, so that only one needs to be shown."""
        if self.methods.keys() != other.methods.keys() or self.governs != other.governs:
            return False
        pairs = [(each, other.methods[key]) for key, each in self.methods.items()]
        return all(_are_close(a.capacity, b.capacity) and _are_close(a.demand, b.demand) for a, b in pairs)


def _are_close(one: float | None, other: float | None) -> bool:
    return one == other if one is None or other is None else isclose(one, other, rel_tol=SAME_RATIO)


def _say_the_same(one: object, other: object) -> bool:
    """Return whether two values of remarks, or remarks, differ by rounding alone, as those of alike directions do."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_say_the_same(one[key], other[key]) for key in one)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_say_the_same, one, other))
    return _are_close(one, other) if isinstance(one, float) and isinstance(other, float) else one == other


@short_repr
@dataclass(frozen=True, eq=False)
class Verification:
    """Verification of a structure by a code.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    code, name, edition : str
        The code: its key in site files, its name, and its edition.
    directions : mapping of Direction to Verified
        Result in each direction in which the structure can rock.
    workings : sequence of Working
        Lines of the calculation that are common to both directions, such as the ground.
    remarks : sequence of str or Remark
        Remarks on the verification: sentences, or keys of the texts of the code.
    left_out : sequence of LeftOut
        What was given and does not count.
    rules : sequence of Remark
        The rules of the code by which its limit states and the required ratio were chosen, if it has several.
    effects : mapping of str to Effect
        What remarks do to the conclusion, by their keys; remarks with other keys do nothing.
    strengthened : Verification, optional
        The same verification of the strengthened structure, with which this one is compared.
    """

    mechanism: Mechanism
    code: str
    name: str
    edition: str
    directions: Mapping[Direction, Verified]
    workings: Sequence[Working] = field(default=(), kw_only=True)
    remarks: Sequence[str | Remark] = field(default=(), kw_only=True)
    left_out: Sequence[LeftOut] = field(default=(), kw_only=True)
    rules: Sequence[Remark] = field(default=(), kw_only=True)
    effects: Mapping[str, Effect] = field(default_factory=dict, kw_only=True)
    strengthened: Verification | None = field(default=None, kw_only=True)

    @property
    def unprinted(self) -> bool:
        """Whether any formula was not checked against the printed code."""
        every = [*self.workings, *(line for each in self.directions.values() for line in each.workings)]
        return any(line.standing in ("code", "transcription") for line in every)

    @property
    def conclusion(self) -> Conclusion:
        """The worst check of all directions and limit states: "satisfied" needs all of them, and no remark on them."""
        conclusions = [each for verified in self.directions.values() for each in self._limited(verified)]
        governs = worst(conclusions)
        alike = [
            each for each in conclusions if each.ratio is not None and governs.ratio is not None
            and (each.concluded, each.limit_state, each.method)
            == (governs.concluded, governs.limit_state, governs.method) and _are_close(each.ratio, governs.ratio)
        ]  # fmt: skip
        preceded = any(each.what == "mechanism" for each in self.left_out)
        uncovered = preceded and governs.concluded in (Concluded.SATISFIED, Concluded.SATISFIED_IF)
        return replace(
            governs,
            concluded=Concluded.NOT_CHECKED if uncovered else governs.concluded,
            direction="" if len(alike) == len(self.directions) else governs.direction,
            limit_states=list(dict.fromkeys(each.limit_state for each in conclusions if each.limit_state)),
            directions=[direction.label for direction in self.directions],
            motions=list(dict.fromkeys(name for each in conclusions for name in each.motions)),
            left_out=self.left_out,
            rules=[each.key for each in self.rules],
            limits=[each for each in self.limits if each.stands_with(governs.concluded) and not uncovered],
        )

    def concluded(self, verified: Verified, state: str) -> Concluded:
        """Return the conclusion on a direction at a limit state: by its methods, or by histories in their place."""
        at = [each for each in self._limited(verified) if each.limit_state == state]
        return worst([each for each in at if each.method in verified.methods] or at).concluded

    def _limited(self, verified: Verified) -> list[Conclusion]:
        return [each.limited(self._limits(verified, each.limit_state)) for each in verified.conclusions]

    @property
    def limits(self) -> list[Limit]:
        """What limits a conclusion on the structure, whatever it is, each once."""
        every = [
            limit for verified in self.directions.values() for check in verified.checks
            for limit in self._limits(verified, check.state)
        ]  # fmt: skip
        return [each for k, each in enumerate(every) if not any(_say_the_same(each, one) for one in every[:k])]

    def _limits(self, verified: Verified, state: str) -> list[Limit]:
        """Return what limits the conclusion on a direction at a limit state."""
        return [
            Limit(each.key, each.values, self.effects[each.key])
            for each in (*verified.remarks, *self.remarks)
            if isinstance(each, Remark) and each.key in self.effects and (each.states is None or state in each.states)
        ]

    @property
    def deciding(self) -> Any:
        """Result of the direction that governs the conclusion; of the first if both do."""
        label = self.conclusion.direction
        return next(each for direction, each in self.directions.items() if label in ("", direction.label))

    @property
    def governs(self) -> Direction:
        """The direction with the smaller ratio; the first if both are equal."""
        return next(direction for direction, ratio in self._ratios.items() if ratio <= self._least)

    @property
    def alike(self) -> bool:
        """Whether both directions have the same ratio."""
        return max(self._ratios.values()) <= self._least

    @property
    def distinct(self) -> Sequence[Any]:
        """Results of the directions; only the first if both have the same numbers."""
        each = list(self.directions.values())
        return each[:1] if len(each) == 2 and each[0].is_like(each[1]) else each

    @property
    def ratio(self) -> float:
        """Capacity over demand in the direction that governs; NaN if it is not known."""
        worst = self.directions[self.governs].ratio
        return nan if worst is None else worst

    def compared(self, direction: Direction) -> float | None:
        """Return the ratio of capacity to demand of a direction, by which the directions are compared; None if unknown.

        The direction with the smaller ratio governs. A code may override this method to compare by another ratio.
        """
        return self.directions[direction].ratio

    @property
    def _least(self) -> float:
        """The smallest ratio, plus a tolerance for rounding."""
        least = min(self._ratios.values())
        return least + SAME_RATIO * abs(least)

    @property
    def _ratios(self) -> dict[Direction, float]:
        ratios = {direction: self.compared(direction) for direction in self.directions}
        return {key: ratio if ratio is not None and isfinite(ratio) else inf for key, ratio in ratios.items()}


Moves = Literal["as_given", "carried_to_floor", "carried_by_option", "of_floor"]
"""Kind of the motions of histories, on a site with a floor or without.

`as_given`: as given, on a site without a floor; `carried_to_floor`: ground motions carried to the floor of the site;
`carried_by_option`: to the floor given with the records; `of_floor`: motions of the floor, as the user states.
"""


@dataclass(frozen=True)
class MotionPlace:
    """The kind of motions in the time histories of a verification.

    Parameters
    ----------
    kind : str
        The kind, one of `Moves`.
    floor : str or None
        The floor to which ground motions are carried: period [s], damping ratio, height over that of the building and
        participation factor.
    """

    kind: Moves = "as_given"
    floor: str | None = None


@short_repr
@dataclass(frozen=True)
class Histories:
    """The time histories that are requested for a verification.

    Parameters
    ----------
    records : sequence of Scaled
        The records of one set. If the site has a floor, ground motions are converted to motions of this floor.
    signs : sequence of int
        The polarities: 1, -1 or both.
    state : str, optional
        The limit state to which the records belong; by default the first one.
    on_floor : bool
        Whether the motions are those of the floor of the site, and not of the ground.
    progress : callable
        Called with 1 after each record.
    refused : sequence of str
        Names of records of the set that could not be used.
    """

    records: Sequence[Scaled]
    signs: Sequence[int] = (1,)
    state: str | None = None
    on_floor: bool = False
    progress: Callable[[int], object] = int
    refused: Sequence[str] = ()

    @cached_property
    def motions(self) -> Sequence[GroundMotion]:
        """The scaled records."""
        return [each.motion.scaled(each.factor) for each in self.records]


def where_it_stands(histories: Histories, floor: Floor | None) -> tuple[MotionPlace, Sequence[GroundMotion]]:
    """Return the kind of the motions (of ground or floor), and the motions, converted to the floor of the site.

    Parameters
    ----------
    histories : Histories
        The histories.
    floor : Floor or None
        The floor of the site on which the structure stands; None if it stands on the ground.

    Raises
    ------
    InputError
        If the motions cannot be of the floor, or are mixed.
    """
    motions, carried = histories.motions, [motion.ground is not None for motion in histories.motions]
    if histories.on_floor and floor is None:
        hint = f"give {named('floor')} in the site file, or leave the option out"
        raise InputError(Problem("requires a site with a floor", field=named("on_floor"), hint=hint))
    if any(carried) and histories.on_floor:
        hint = f"leave out one of the two: {named('floor')} carries ground motions to a floor"
        raise InputError(Problem(f"cannot be combined with {named('floor')}", field=named("on_floor"), hint=hint))
    if any(carried) and not all(carried):
        raise InputError(Problem("some of the motions are of a floor, others of the ground: give motions of one kind"))
    if histories.on_floor:
        return MotionPlace("of_floor"), motions
    if carried and all(carried):
        return MotionPlace("carried_by_option", motions[0].processing[-1].removeprefix("floor ")), motions
    if floor is None:
        return MotionPlace(), motions
    if any(step.startswith("floor ") for motion in motions for step in motion.processing):
        hint = f"give {named('on_floor')}, or prepare them without a floor"
        raise InputError(Problem("the records are prepared as the motions of a floor already", hint=hint))
    return MotionPlace("carried_to_floor", str(floor)), [floor.of(motion) for motion in motions]


@dataclass(frozen=True)
class Control:
    """Position of a control point [m], and its body; without a body the code chooses the point."""

    at: complex
    body: str | None = None


def control_at(mechanism: Mechanism, x: float, y: float, body: str | None = None) -> Control:
    """Return a control point of a body; one body may be left out. Raises `InputError` if the point is not on it."""
    try:
        spot = mechanism.carrier.spot(body, complex(x, y), (), "control")
    except RefusedFields as error:
        raise InputError(Problem(f"{named('control')}: {error.reason}")) from None
    return Control(spot.at, spot.body)
