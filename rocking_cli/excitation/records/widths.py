"""Checks whether printed numbers keep to their columns and digits: a short row or number has lost a character.

Programs print all numbers of a file in the same way. If a row or a number has another form than nearly all the others,
the file is damaged, and the number is most likely not the original one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

from rocking_cli.excitation.base import Doubt
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.text import regex

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
    if not wrong or not any(_is_padded(number, usual) for _, line in rows for number in rows.split(line)):
        return []
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


def _is_padded(number: str, usual: Form) -> bool:
    """Return whether a number, other than zero, has the usual form and ends with a zero."""
    return _mantissa(number).endswith("0") and _form(_blank_out(number)) == usual


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
