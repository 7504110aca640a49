"""Lay out sentences and tables in the width of a terminal: sentences in lines, a table as a grid or as blocks."""

from __future__ import annotations

from collections.abc import Collection, Sequence

HANGING_INDENT = 2  # blanks before the continuation lines of a sentence
MIN_WIDTH_TO_WRAP = 60  # columns: in less, a table column has room for only a word or two
MIN_CELL_WIDTH, NARROW_CELL_WIDTH = 18, 12  # columns of a wrapped cell, and of one in a table of few columns
_TRACEBACK = "Traceback (most recent call last)"  # printed unwrapped, as it is meant for programmers


def cells(text: str) -> int:
    """Return the width of a line, in columns of a terminal."""
    if text.isascii():
        return len(text)
    from rich.cells import cell_len

    return cell_len(text)


def wrapped(text: str, width: int | None, *, start: int = 0) -> str:
    """Return a text in lines of a width.

    Parameters
    ----------
    text : str
        Text; its own line breaks are kept, and a quoted line of a file with the mark below it.
    width : int or None
        Columns of the terminal; None for no terminal, and lines of any length.
    start : int
        Columns of the first line that are already in use.

    Returns
    -------
    str
        Lines; only a single word, such as a path, makes a line longer.
    """
    if width is None:
        return text
    lines = text.split("\n")
    made: list[str] = []
    for k, line in enumerate(lines):
        if line.startswith(_TRACEBACK):
            return "\n".join([*made, *lines[k:]])
        quoted = any(each.strip() == "^" for each in lines[k : k + 2])
        blanks = " " * (len(line) - len(line.lstrip()))
        taken = "" if k else " " * start
        folded = "\n".join(_folded(taken + line, width, blanks + " " * HANGING_INDENT))
        made.append(line if quoted else folded[len(taken) :])
    return "\n".join(made)


def _folded(line: str, width: int, hang: str = "") -> list[str]:
    """Return a line as lines of a width; all but the first begin with `hang`."""
    if cells(line) <= width:
        return [line]
    from textwrap import wrap

    return wrap(line, width, subsequent_indent=hang, break_long_words=False, break_on_hyphens=False)


def grid(
    columns: Sequence[str], rows: Sequence[Sequence[str]], numbers: Collection[int], width: int | None, rule: str,
    *, narrow: bool = False,
) -> tuple[list[str], list[str]] | None:  # fmt: skip
    """Return the lines of the headings of a grid, and those of its rows; None if it does not fit the width.

    Parameters
    ----------
    columns, rows : sequence
        Headings, and cells; their line breaks are kept.
    numbers : collection of int
        Indices of columns to align to the right.
    width : int or None
        Columns of the terminal; None for no terminal, and rows of any length.
    rule : str
        Character of the line under the headings.
    narrow : bool
        Whether cells wrap in any width, and in fewer columns.
    """
    lines = [[cell.split("\n") for cell in line] for line in (columns, *rows)]
    needs = _needs(lines)
    gap = 3 if width is None or _whole(needs, 3) <= width else 2
    if width is not None and _whole(needs, gap) > width:
        may_wrap, least = narrow or width >= MIN_WIDTH_TO_WRAP, NARROW_CELL_WIDTH if narrow else MIN_CELL_WIDTH
        free = range(1, len(needs) if may_wrap else 1)
        while _whole(needs, gap) > width:
            widest = max(free, key=lambda k: needs[k], default=0)
            if not widest or needs[widest] <= least:
                return None
            needs[widest] -= 1
        lines = [
            [[each for part in cell for each in _folded(part, need)] for cell, need in zip(line, needs, strict=True)]
            for line in lines
        ]
        needs = _needs(lines)
        if _whole(needs, gap) > width:  # a word is wider than its column
            return None

    def drawn(line: list[list[str]]) -> list[str]:
        height = max(map(len, line))
        parts = []
        for k, (cell, need) in enumerate(zip(line, needs, strict=True)):
            rest = [""] * (height - len(cell))
            shown = rest + cell if line is lines[0] else cell + rest  # headings are aligned at the bottom
            parts.append([_aligned(each, need, right=k in numbers) for each in shown])
        return [f" {(' ' * gap).join(row)} " for row in zip(*parts, strict=True)]

    blank = " " * _whole(needs, gap)
    body = [each for line in lines[1:] for each in drawn(line)]
    return [blank, *drawn(lines[0])], [f" {rule * (len(blank) - 2)} ", *body, blank]


def _needs(lines: Sequence[Sequence[Sequence[str]]]) -> list[int]:
    """Return the width of each column."""
    return [max(cells(each) for cell in column for each in cell) for column in zip(*lines, strict=True)]


def _whole(needs: Sequence[int], gap: int) -> int:
    return sum(needs) + gap * (len(needs) - 1) + 2


def _aligned(text: str, width: int, *, right: bool) -> str:
    text = text.rstrip() if right else text
    blanks = " " * (width - cells(text))
    return blanks + text if right else text + blanks


def stacked(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> list[str]:
    """Return a block for each row: its first cell, then a line `heading: value` for each other non-empty cell."""
    heads = [each.replace("\n", " ").strip() for each in columns]
    made = []
    for row in rows:
        first, *others = (cell.replace("\n", " ").rstrip() for cell in row)
        deeper = " " * (len(first) - len(first.lstrip()))
        lines = [f"{deeper}{heads[0]}: {first.lstrip()}" if heads[0] and first.strip() else first]
        lines += [
            f"{deeper}{' ' * HANGING_INDENT}{head}{': ' * bool(head)}{cell.strip()}"
            for head, cell in zip(heads[1:], others, strict=True)
            if cell
        ]
        made += [wrapped(line, width) for line in lines]
    return made
