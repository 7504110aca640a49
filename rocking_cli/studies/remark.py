"""A remark that a view says in a language, and texts with the signs of formulas in plain characters."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from unicodedata import name

from rocking_cli.short_repr import short_repr

MINUS = "−"
MARK = re.compile(r"([_^])\[([^\[\]]*)\]")
"""A subscript or superscript: `d_[0]^[*]` has both."""
PLAIN_CHARACTERS = {
    "λ": "lambda", "Σ": "sum", "√": "sqrt", "·": "*", "×": "*", "≥": ">=", "≤": "<=", "′": "'", "²": "2", "³": "3",
    "–": "-", MINUS: "-", "⟦": "", "⟧": "",
}  # fmt: skip
"""Replacements of the signs of a formula in plain characters; Greek letters are spelled."""


@short_repr
class Remark(NamedTuple):
    """A remark on a result, which a view says in a language.

    Parameters
    ----------
    key : str
        Key of the sentence among the texts of the code.
    values : mapping of str to object
        Numbers, names and further remarks in the sentence.
    states : sequence of str, optional
        The limit states whose conclusion it limits, see `Verification.effects`; by default all.
    """

    key: str
    values: Mapping[str, Any]
    states: Sequence[str] | None = None

    @classmethod
    def of(cls, key: str, /, **values: Any) -> Remark:
        """Return the remark of a key with its values."""
        return cls(key, values)


def in_plain(text: str) -> str:
    """Return a formula, or a text with symbols, in plain characters: `alpha0 g/(e* FC)`, `T_SLV`."""

    def mark(match: re.Match[str]) -> str:
        below, what = match[1] == "_", match[2]
        return what if what == "*" or (below and what.isdigit()) else f"{match[1]}{what}"

    return MARK.sub(mark, text).translate(PLAIN)


class _Plain(dict[int, str]):
    """Replacements of signs by their code points: a Greek letter by its name, any other sign by itself."""

    def __missing__(self, code: int) -> str:
        sign = chr(code)
        script, _, letter = name(sign, "").rpartition(" ")
        if script.startswith("GREEK"):
            sign = letter.capitalize() if "CAPITAL" in script else letter.lower()
        self[code] = sign
        return sign


PLAIN = _Plain(str.maketrans(PLAIN_CHARACTERS))
