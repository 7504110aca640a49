"""Lines of a text, split a page at a time, and checks whether printed numbers keep to their columns and digits.

A long record has too many lines to hold all as objects. Programs print all numbers of a file in the same way: if a row
or a number has another form than nearly all the others, the file is damaged, and the number is most likely not the
original one.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import overload

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import Doubt
from rocking_cli.text import regex

PAGE_CHARACTERS = 1 << 16
"""Characters of a page, at least: a page ends where a line does."""
MAX_LINE_CHARACTERS = 1_000_000
"""Characters of a line of numbers, at most: a thousand columns of a thousand characters."""


class Lines(Sequence[str]):
    r"""The sequence `text.split("\n")`, with at most one page of it in memory.

    Parameters
    ----------
    text : str
        Content of a file, lines ending in a plain newline.
    tabs : bool, optional
        Whether tabs are replaced by blanks, as required in a file with columns.
    """

    def __init__(self, text: str, *, tabs: bool = False) -> None:
        self._had_tabs = "\t" in text
        self._text = text = text.expandtabs() if tabs and self._had_tabs else text
        self._starts = [0]  # offsets of the pages in the text
        self._firsts = [0]  # index of the first line of each page
        while (end := text.find("\n", self._starts[-1] + PAGE_CHARACTERS)) >= 0:
            self._firsts.append(self._firsts[-1] + text.count("\n", self._starts[-1], end + 1))
            self._starts.append(end + 1)
        self._length = self._firsts[-1] + text.count("\n", self._starts[-1]) + 1
        self._starts.append(len(text) + 1)
        self._number, self._page = 0, self._cut(0)  # the page read last

    def __len__(self) -> int:
        return self._length

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        if isinstance(index, slice):
            return [self[place] for place in range(*index.indices(self._length))]
        index = range(self._length)[index]  # negative and invalid indices behave as in a list
        number = bisect_right(self._firsts, index) - 1
        if number != self._number:
            self._number, self._page = number, self._cut(number)
        return self._page[index - self._firsts[number]]

    def __iter__(self) -> Iterator[str]:
        return self.since(0)

    @cached_property
    def edited(self) -> bool:
        """Whether an editor has changed the blanks of a file with columns: it has tabs, or no leading blanks."""
        return self._had_tabs or not (self._text.startswith(" ") or "\n " in self._text)

    def since(self, start: int) -> Iterator[str]:
        """Yield all lines from index `start` on, faster than by single indices."""
        for _, page in self.pages(start):
            yield from page

    def pages(self, start: int) -> Iterator[tuple[int, list[str]]]:
        """Yield all lines from index `start` on in pages, each with the index of its first line."""
        for number in range(bisect_right(self._firsts, start) - 1, len(self._firsts)):
            skipped = max(start - self._firsts[number], 0)
            yield self._firsts[number] + skipped, self._cut(number)[skipped:]

    def check_lengths(self, file: str) -> None:
        """Raise `InputError` if a line is so long that its numbers would fill the memory."""
        ends = [*self._firsts[1:], self._length]
        for (start, end), number in zip(pairwise(self._starts), ends, strict=True):
            if end - start > PAGE_CHARACTERS + MAX_LINE_CHARACTERS:  # only the last line of a page extends beyond it
                raise InputError(
                    Problem(f"a line of numbers has at most {MAX_LINE_CHARACTERS} characters", file, number)
                )

    def _cut(self, number: int) -> list[str]:
        return self._text[self._starts[number] : self._starts[number + 1] - 1].split("\n")


MAX_LEAVING_ROWS = 0.1  # share of rows that may leave the columns of the others; with more there are no columns
MAX_ODD_NUMBERS = 0.03  # share of numbers that may be printed in another form; with more the form means nothing
_GLUED = regex(r"(?<=[\d.])(?=[+-])")  # the sign follows a digit if columns of Fortran run together
_DIGITS = str.maketrans("123456789", "000000000")
_ONES = str.maketrans("0", "1")
_PRINTED = regex(r"[+-]?(\d*)(?:(\.)(\d*))?(?:[EeDd]([+-]?)(\d+))?")

Form = tuple[int | None, int | None, int | None]
"""Digits of a number: after the point; and if it has an exponent, before the point and in the exponent."""


@dataclass(frozen=True)
class PrintedRows:
    """Rows of printed numbers, for checks of their form.

    Parameters
    ----------
    lines : Lines
        All lines of the file.
    start : int
        Index of the first row.
    split : callable
        Function that returns the numbers of a row as printed; none for a comment.
    end : int, optional
        Index of the line after the last row, if it is not the end of the file.
    """

    lines: Lines
    start: int
    split: Callable[[str], list[str]]
    end: int | None = None

    def __iter__(self) -> Iterator[tuple[int, str]]:
        """Yield line number and text of each row."""
        for first, page in self.pages():
            yield from enumerate(page, start=first + 1)

    @cached_property
    def tally(self) -> tuple[Counter[tuple[int, int, int, int]], Counter[str]]:
        """Counts of rows by length, number of values, indent and length of the last value; and of numbers by form."""
        sizes: Counter[tuple[int, int, int, int]] = Counter()
        numbers: Counter[str] = Counter()
        for _, page in self.pages():
            for row, times in Counter(_blank_out("\n".join(page)).split("\n")).items():  # few rows differ in their form
                if values := self.split(row):
                    row = row.rstrip()
                    sizes[len(row), len(values), len(row) - len(row.lstrip()), len(values[-1])] += times
                    for number in values:
                        numbers[number] += times
        return sizes, numbers

    def pages(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the rows in pages, each with the index of its first line."""
        for first, page in self.lines.pages(self.start):
            if self.end is not None and first + len(page) >= self.end:
                yield first, page[: self.end - first]
                return
            yield first, page


def split_numbers(row: str) -> list[str]:
    """Return the numbers of a row as printed, separated by blanks, or only by a sign."""
    return _GLUED.sub(" ", row).split()


def odd_row(rows: PrintedRows) -> tuple[int, str] | None:
    """Return line number and text of the first of a few rows not aligned to the columns of the others; None if none.

    Columns are assumed only if first and last numbers of rows have different lengths and yet end at the same places:
    otherwise, rows of equal length only mean numbers of equal length.
    """
    if rows.lines.edited:
        return None
    tally, _ = rows.tally
    sizes: Counter[tuple[int, int]] = Counter()
    for (length, count, _, _), times in tally.items():
        sizes[length, count] += times
    if not sizes:
        return None
    (length, count), _ = sizes.most_common(1)[0]
    kept = [key for key in tally if key[:2] == (length, count)]
    if len({indent for _, _, indent, _ in kept}) < 2 or len({last for *_, last in kept}) < 2:
        return None

    def leaves(size: int, numbers: int) -> bool:
        return size * count != length * numbers  # the last row may be short, and two rows may have been merged

    leaving = sum(times for size, times in sizes.items() if leaves(*size))
    if not 0 < leaving <= MAX_LEAVING_ROWS * sizes.total():
        return None
    return next(
        (number, line)
        for number, line in rows
        if (numbers := rows.split(line)) and leaves(len(line.rstrip()), len(numbers))
    )


def unlike_the_others(rows: PrintedRows) -> tuple[Doubt, ...]:
    """Return doubts about the form of numbers in free text, at most one for each row."""
    doubts = odd_digits(rows)
    if not doubts and (odd := odd_row(rows)) is not None:
        text = f"line {odd[0]} does not end where the others do, which keep to columns: was a character lost?"
        doubts = [Doubt("columns", float(odd[0]), text)]
    return tuple(doubts)


def odd_digits(rows: PrintedRows) -> list[Doubt]:
    """Return doubts if a few numbers have fewer or more digits than the others, printed by a program that pads.

    If a program omits trailing zeros, or prints as many digits as each number requires, there are no doubts.
    """
    tally: Counter[Form | None] = Counter()
    for number, times in rows.tally[1].items():
        tally[_form(number)] += times
    if len(tally) < 2:
        return []
    usual, _ = tally.most_common(1)[0]
    if usual is None or tally.total() - tally[usual] > MAX_ODD_NUMBERS * tally.total():
        return []
    # Zeros may be printed in any form. A number with no more digits than the longest is only of another size.
    longest = max(
        len(_mantissa(number.replace("o", "").translate(_ONES))) for number in rows.tally[1] if _form(number) == usual
    )
    wrong = [
        (line, number)
        for line, number in _unlike(rows, usual)
        if (mantissa := _mantissa(number)) and (usual[2] is not None or len(mantissa) < longest)
    ]
    printed = (number for _, line in rows for number in rows.split(line))
    if not wrong or not any(_mantissa(each).endswith("0") and _form(_blank_out(each)) == usual for each in printed):
        return []  # no program that pads with zeros
    first, token = wrong[0]
    others = f", and {len(wrong) - 1} more," if len(wrong) > 1 else ""
    text = (
        f"'{token[:40]}' in line {first}{others} is printed with other digits than all the other numbers: "
        "was a character lost?"
    )
    return [Doubt("digits", float(first), text)]


def _unlike(rows: PrintedRows, usual: Form) -> Iterator[tuple[int, str]]:
    """Yield line number and text of each number that has another form than the usual one."""
    for first, page in rows.pages():
        blanked = _blank_out("\n".join(page)).split("\n")
        odd = {row for row in set(blanked) if any(_form(number) != usual for number in rows.split(row))}
        for line_number, (row, line) in enumerate(zip(blanked, page, strict=True), start=first + 1):
            if row in odd:
                yield from ((line_number, each) for each in rows.split(line) if _form(_blank_out(each)) != usual)


def _blank_out(text: str) -> str:
    """Return the text with zeros for all digits, except an optional zero before a decimal point."""
    return text.replace("0.", "o.").translate(_DIGITS)


def _form(blanked: str) -> Form | None:
    """Return the form of a blanked-out number; None if it is not a number."""
    match = _PRINTED.fullmatch(blanked.replace("o", ""))
    if match is None:
        return None
    whole, point, decimals, sign, exponent = match.groups()
    after = len(decimals) if point else None
    return (after, None, None) if exponent is None else (after, len(whole), len(exponent) + 10 * bool(sign))


def _mantissa(token: str) -> str:
    """Return the digits of a number from the first non-zero one on; empty for zero."""
    match = _PRINTED.fullmatch(token)
    return ((match[1] or "") + (match[3] or "")).lstrip("0") if match else token
