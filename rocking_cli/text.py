"""Text from files and plugins (names, keys, lines): safe to show in a terminal, a plot or a page."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from contextvars import ContextVar
from itertools import count
from typing import Any, AnyStr, cast

# Control characters, marks that turn the direction of writing, line ends of other kinds, and code points that are no
# characters. Tabs and line feeds are allowed, as they do no harm.
_UNSEEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ufffe\uffff\ud800-\udfff]"
)
keeps_formulas = ContextVar("keeps_formulas", default=False)
"""Whether texts that a spreadsheet would compute go unchanged into a CSV table."""
MAX_LISTED = 8  # names in a row before the rest is counted
MAX_QUOTED_CHARACTERS = 60
QUOTED_BEFORE, QUOTED_AFTER = 30, 40  # quoted characters of a line on either side of an error


def printable(text: str) -> str:
    r"""Spell out the characters of a text that control a terminal or cannot be on a page: ESC is `\x1b`.

    A byte of a file name that is not UTF-8 is spelled as this byte, `\xff`.

    Examples
    --------
    >>> printable("a\x1b[31mb")
    'a\\x1b[31mb'
    """
    return _UNSEEN.sub(_spelled, text)


def _spelled(match: re.Match[str]) -> str:
    code = ord(match[0])
    if 0xDC80 <= code <= 0xDCFF:  # Python's stand-in for a byte that is not UTF-8
        code -= 0xDC00
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"


def seen(text: str) -> str:
    """Return a text in one line with single spaces, without the characters that `printable` spells out."""
    return " ".join(_UNSEEN.sub("", " ".join(text.split())).split())


def one_line(text: str) -> str:
    """Spell out a text as `printable` does, including tabs and line feeds, which file names may contain."""
    return printable(text).replace("\t", r"\t").replace("\n", r"\n")


def is_one_line(text: str) -> bool:
    """Return whether a text can be shown unchanged, in one line."""
    return not _UNSEEN.search(text) and not {"\t", "\n"} & set(text)


def cut(text: str, most: int = MAX_QUOTED_CHARACTERS) -> str:
    """Shorten a text to at most `most` characters, with dots at the end if it was longer."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def numbered(name: str, suffix: str, taken: Collection[str]) -> str:
    """Return the first of `name.csv`, `name-2.csv`, ... that is not taken, also where case does not count.

    Examples
    --------
    >>> numbered("a", ".csv", ["A.csv", "b.csv"])
    'a-2.csv'
    """
    known = {each.casefold() for each in taken}
    names = (f"{name}{f'-{k}' if k > 1 else ''}{suffix}" for k in count(1))
    return next(each for each in names if each.casefold() not in known)


def in_short(names: Sequence[str], between: str = ", ", most: int = MAX_LISTED) -> str:
    """Return names joined in one text: at most `most` of them, and how many more there are.

    Examples
    --------
    >>> in_short(["a", "b"]), in_short(["a", "b", "c", "d"], most=2)
    ('a, b', 'a, b and 2 more')
    """
    more = f" and {len(names) - most:,} more" if len(names) > most else ""
    return between.join(names[:most]) + more


def quoted_line(line: str, column: int | None) -> list[str]:
    """Return two lines of output: a line of a file, cut around a column (from 1), and a mark below this column."""
    start = (column or 1) - 1
    before, after = printable(line[:start]), printable(line[start:])
    if len(before) > QUOTED_BEFORE:
        before = f"...{before[3 - QUOTED_BEFORE :]}"
    lines = [before + cut(after, QUOTED_AFTER)]
    return lines if column is None else [*lines, " " * len(before) + "^"]


def did_you_mean(word: str, known: list[str]) -> str | None:
    """Return a hint with the known word nearest to a mistyped one, or the list of all."""
    from difflib import get_close_matches

    lowered = {each.lower(): each for each in known}
    close = [lowered[each] for each in get_close_matches(word.lower(), lowered, n=1, cutoff=0.6)]
    return f"did you mean {close[0]}?" if close else f"known: {', '.join(sorted(known))}" if known else None


def exact(number: float) -> str:
    """Return a number with the fewest digits that read back to the same number.

    Examples
    --------
    >>> exact(25.0), exact(0.1), exact(9 / 7)
    ('25', '0.1', '1.2857142857142858')
    """
    short = f"{number:g}"
    return short if float(short) == number else repr(float(number))


def regex(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """Return an object that acts as `re.compile(text, flags)` and compiles the expression when first used.

    A command uses few of the expressions that it imports.
    """
    return cast("re.Pattern[AnyStr]", _Pattern(text, flags))


class _Pattern:
    def __init__(self, text: str | bytes, flags: int) -> None:
        self._given: Any = text, flags

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(re.compile(*self._given), name)
        setattr(self, name, attribute)  # later accesses bypass this function
        return attribute
