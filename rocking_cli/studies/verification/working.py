"""Lines of a calculation in a verification: formula, numbers, clause, and how far the formula was checked."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, Self
from unicodedata import name

Standing = Literal["print", "transcription", "code", "ours", "plain"]
"""Of a formula: of the code, and checked against its print; checked against a transcription of its text only; or not
yet checked; ours, where the code leaves it open; or plain mechanics and arithmetic."""
MINUS = "−"
MARK = re.compile(r"([_^])\[([^\[\]]*)\]")
"""A subscript or superscript: `d_[0]^[*]` has both."""
AND_SO_ON = re.compile(r"([^();]+?)( \+ |; )…")
"""A piece that is there once for each of several numbers: `({P} · {x} + …)`."""
PLAIN = {
    "λ": "lambda", "Σ": "sum", "√": "sqrt", "·": "*", "×": "*", "≥": ">=", "≤": "<=", "′": "'", "²": "2", "³": "3",
    "–": "-", MINUS: "-",
}  # fmt: skip
"""What stands for the signs of a formula where there are plain characters only; Greek letters are spelled."""


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

    def __post_init__(self) -> None:
        if self.standing == "code" and isinstance(self.clause, Clause) and self.clause.transcribed:
            object.__setattr__(self, "standing", "transcription")

    def in_plain(self, section: str | None = None) -> Working:
        """Return the line in plain characters; `section` names its part of the calculation, if not known yet."""
        texts: dict[str, Any] = {
            key: in_plain(getattr(self, key)) for key in ("symbol", "meaning", "formula", "numbers", "unit")
        }
        return replace(self, **texts, section=in_plain(self.section if section is None else section))


def as_written(value: float) -> str:
    """Return a number as it is written in a formula."""
    return f"{value + 0.0:.6g}"


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
        The right-hand side with a slot for each number; `{P} · {x} + …` is a sum over several.
    unit : str
        Unit of the result.
    clause : str
        The clause of the code.
    meaning : str
        Meaning of the result, in a few words; for a code with a calculation sheet, the key of its texts.
    standing : {"code", "print", "ours", "plain"}
        How far the formula was checked, see `Standing`.
    """

    symbol: str
    text: str = ""
    numbers: str = ""
    unit: str = ""
    clause: str = ""
    meaning: str = field(default="", kw_only=True)
    standing: Standing = field(default="code", kw_only=True)

    def working(
        self,
        value: float,
        names: Mapping[str, Any] | None = None,
        /,
        write: Callable[[float], str] = as_written,
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
            Function that writes a number.
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
        )


def put(numbers: str, given: Mapping[str, Any], write: Callable[[float], str]) -> str:
    """Fill the slots of a formula with numbers; negative ones and those with a power of ten in parentheses."""

    def held(value: Any) -> str:
        text = value if isinstance(value, str) else write(value)
        return f"({text})" if not isinstance(value, str) and re.search(r"[-−^]", text) else text

    def repeated(found: re.Match[str]) -> str:
        piece, between = found[1].strip(), found[2]
        lists = {name: given[name] for name in re.findall(r"{(\w+)}", piece)}
        each = [piece.format(**{name: held(value) for name, value in zip(lists, row, strict=True)})
                for row in zip(*lists.values(), strict=True)]  # fmt: skip
        return found[1][: len(found[1]) - len(found[1].lstrip())] + between.join(each)

    single = {name: held(value) for name, value in given.items() if not isinstance(value, list | tuple)}
    return AND_SO_ON.sub(repeated, numbers).format(**single)


def in_plain(text: str) -> str:
    """Return a formula, or a text with symbols, in plain characters: `alpha0 g/(e* FC)`, `T_SLV`."""

    def mark(found: re.Match[str]) -> str:
        below, what = found[1] == "_", found[2]
        return what if what == "*" or (below and what.isdigit()) else f"{found[1]}{what}"

    return "".join(PLAIN.get(sign) or _spelled(sign) for sign in MARK.sub(mark, text))


def _spelled(sign: str) -> str:
    """Return the name of a Greek letter; any other sign unchanged."""
    if sign.isascii() or not (named := name(sign, "")).startswith("GREEK"):
        return sign
    letter = named.rpartition(" ")[2]
    return letter.capitalize() if "CAPITAL" in named else letter.lower()


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
