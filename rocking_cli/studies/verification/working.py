"""How a number of a verification came about: its formula, what was put in, its clause, and how far that was checked."""

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
    """A place in a code; transcribed if what it says was checked against a transcription of the text."""

    __slots__ = ("transcribed",)
    transcribed: bool

    def __new__(cls, place: str, *, transcribed: bool = False) -> Self:
        """Make a clause of a place."""
        clause = super().__new__(cls, place)
        clause.transcribed = transcribed
        return clause


@dataclass(frozen=True)
class Working:
    """A line of a calculation.

    Parameters
    ----------
    symbol : str
        What is computed, as the code calls it.
    meaning : str
        What it is, in a few words.
    formula : str
        By which formula.
    numbers : str
        The same with numbers put in; empty where they are many.
    value : float
        The result.
    unit : str
        Its unit; empty for a pure number.
    clause : str
        Where in the code.
    standing : {"print", "transcription", "code", "ours", "plain"}
        How far the formula was checked, see `Standing`; of a formula of the code its clause decides.
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
        """The same in plain characters; `section` says in which part of the calculation, if that is not known yet."""
        texts: dict[str, Any] = {
            key: in_plain(getattr(self, key)) for key in ("symbol", "meaning", "formula", "numbers", "unit")
        }
        return replace(self, **texts, section=in_plain(self.section if section is None else section))


def as_written(value: float) -> str:
    """A number in a formula."""
    return f"{value + 0.0:.6g}"


@dataclass(frozen=True)
class Formula:
    """A formula of a code, written once for every printout.

    Parameters
    ----------
    symbol : str
        What it gives; subscripts and superscripts as in `d_[0]^[*]`, names that differ from use to use in slots, as in
        `T_[{state}]`.
    text : str
        Its right-hand side, in symbols, with the same marks and slots.
    numbers : str
        The same with a slot for each number; `{P} · {x} + …` is a sum over several.
    unit : str
        Of the result.
    clause : str
        Where in the code.
    meaning : str
        What it is, in a few words; of a code with a sheet, the key of its texts.
    standing : {"code", "print", "ours", "plain"}
        How far it was checked, see `Standing`.
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
        """A line of a calculation by this formula.

        Parameters
        ----------
        value : float
            The result.
        names : mapping of str to str, optional
            What is in the slots of symbol, text, unit and meaning; `state` is the limit state of the line.
        write : callable
            How a number is written.
        marks : callable
            How a formula is written with the decimal marks of a language.
        **numbers
            What is in the slots of the numbers: a number, several for a sum, or a text as it is.

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
    """A formula with numbers in its slots, those below zero and with a power of ten in parentheses."""

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
    """A formula, or a text with symbols, in plain characters: `alpha0 g/(e* FC)`, `T_SLV`."""

    def mark(found: re.Match[str]) -> str:
        below, what = found[1] == "_", found[2]
        return what if what == "*" or (below and what.isdigit()) else f"{found[1]}{what}"

    return "".join(PLAIN.get(sign) or _spelled(sign) for sign in MARK.sub(mark, text))


def _spelled(sign: str) -> str:
    """A Greek letter by its name; another sign as it is."""
    if sign.isascii() or not (named := name(sign, "")).startswith("GREEK"):
        return sign
    letter = named.rpartition(" ")[2]
    return letter.capitalize() if "CAPITAL" in named else letter.lower()


class Later(Sequence[Working]):
    """Workings that are written when they are first looked at."""

    def __init__(self, write: Callable[[], Sequence[Working]]) -> None:
        self._write = write

    @cached_property
    def _written(self) -> Sequence[Working]:
        return self._write()

    def __getitem__(self, place: Any) -> Any:
        return self._written[place]

    def __len__(self) -> int:
        return len(self._written)
