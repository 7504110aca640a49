"""Lines of a text, split a page at a time, as a long record has too many lines to hold all as objects."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from typing import overload

from rocking_cli.errors import InputError, Problem

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
