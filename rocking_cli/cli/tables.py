"""Lay out a table of results in the width of a terminal: as a grid, or as a block of lines for each row."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from rocking_cli.cli.prose import HANG, cells, words, wrapped

NARROW = 60  # columns below which no cell is wrapped: there a column has room for a word or two
READABLE = 18  # columns that a cell keeps when it is wrapped, or all that it needs if that is less
EDGES = 2  # blanks around a grid
GAPS = (3, 2)  # blanks between its columns: as people like them, and close


def grid(
    columns: Sequence[str], rows: Sequence[Sequence[str]], numbers: Collection[int], width: int | None
) -> tuple[int, list[list[str]]] | None:
    """Return the gap between columns, and the lines of cells, headings first, that fit a width; None if none do.

    Parameters
    ----------
    columns, rows : sequence
        Headings, and cells; their line breaks are kept.
    numbers : collection of int
        Indices of columns that never wrap, like the first.
    width : int or None
        Columns of the terminal; None for no terminal, and rows of any length.
    """
    lines = [list(columns), *(list(row) for row in rows)]
    needs = [max(_widest(line[k]) for line in lines) for k in range(len(columns))]
    for gap in GAPS:
        if width is None or _whole(needs, gap) <= width:
            return gap, lines
    assert width is not None
    if width < NARROW:
        return None
    floors = [
        need if k == 0 or k in numbers else min(need, max(READABLE, *(_longest(line[k], need) for line in lines)))
        for k, need in enumerate(needs)
    ]
    if _whole(floors, GAPS[-1]) > width:
        return None
    while _whole(needs, GAPS[-1]) > width:
        slack = [need - floor for need, floor in zip(needs, floors, strict=True)]
        widest = max((k for k in range(len(needs)) if slack[k]), key=lambda k: needs[k])
        needs[widest] -= 1
    return GAPS[-1], [
        ["\n".join(_folded(cell, need)) for cell, need in zip(line, needs, strict=True)] for line in lines
    ]


def drawn(gap: int, lines: Sequence[Sequence[str]], numbers: Collection[int], rule: str) -> tuple[list[str], list[str]]:
    """Return the headings and the rows of a grid as lines of one width.

    Parameters
    ----------
    gap : int
        Blanks between columns.
    lines : sequence
        As of `grid`: cells, headings first.
    numbers : collection of int
        Indices of columns to align to the right.
    rule : str
        Character of the line under the headings.
    """
    widths = [max(_widest(line[k]) for line in lines) for k in range(len(lines[0]))]

    def fitted(line: Sequence[str], *, low: bool = False) -> list[str]:
        parts = [cell.split("\n") for cell in line]
        height = max(map(len, parts))
        columns = []
        for k, (part, width) in enumerate(zip(parts, widths, strict=True)):
            rest = [""] * (height - len(part))
            columns.append([_aligned(each, width, k in numbers) for each in (rest + part if low else part + rest)])
        return [f" {(' ' * gap).join(row)} " for row in zip(*columns, strict=True)]

    whole = _whole(widths, gap)
    heads = [" " * whole, *fitted(lines[0], low=True)]
    return heads, [f" {rule * (whole - EDGES)} ", *(each for line in lines[1:] for each in fitted(line)), " " * whole]


def _aligned(text: str, width: int, right: bool) -> str:
    if right:
        text = text.rstrip()
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
            f"{deeper}{' ' * HANG}{head}: {cell.strip()}" if head else f"{deeper}{' ' * HANG}{cell.strip()}"
            for head, cell in zip(heads[1:], others, strict=True)
            if cell
        ]
        made += [wrapped(line, width) for line in lines]
    return made


def _whole(needs: Sequence[int], gap: int) -> int:
    return sum(needs) + gap * (len(needs) - 1) + EDGES


def _widest(cell: str) -> int:
    return max(cells(line) for line in cell.split("\n"))


def _longest(cell: str, most: int) -> int:
    """Return the width of the widest word of a cell."""
    return max((cells(word) for line in cell.split("\n") for word in words(line, most)), default=0)


def _folded(cell: str, width: int) -> list[str]:
    """Return the lines of a cell in a width, without indentation."""
    lines: list[str] = []
    for line in cell.split("\n"):
        if cells(line) <= width:
            lines.append(line)
            continue
        shown = ""
        for word in words(line, width):
            if shown and cells(shown) + 1 + cells(word) > width:
                lines.append(shown)
                shown = ""
            shown += f" {word}" if shown else word
        lines.append(shown)
    return lines
