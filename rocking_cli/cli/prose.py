"""Break sentences into lines of the terminal's width: at blanks, never inside a word, a quantity or a command."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.patterns import regex

HANG = 2  # blanks before the lines that go on with a sentence
DOTS = "..."
_LABEL = regex(r"\w+:? +")
_UNITS = (
    r"%|°|deg|m?rad(?:/s)?|(?:k|c|d|m)?m(?:/s2?|2|3)?|in(?:/s)?|ft(?:/s2)?|m?s|min|gal|m?g|kg(?: m2?|/m3)?"
    r"|t(?:/m3)?|Mg|lb|[kM]?N(?:/m[23])?|[kMG]?Pa|bar|psi|ksi|MB|phi_cr|times"
)
# Blanks at which no line ends: in what backticks or quotes hold, between a number and its unit, beside a sign.
_HELD = regex(
    r"`[^`\n]+`|'[^'\s][^'\n]*'(?!\w)|\"[^\"\n]+\""
    rf"|[-+]?\d[\d.,]*(?:e[-+]?\d+)? (?:{_UNITS})(?![\w/])"
    rf"|[^\s,]+ (?:=|<=|>=|<|>) [^\s,]+(?: (?:{_UNITS})(?![\w/]))?|(?:<=|>=|<|>) [-+]?\d\S*|\bEqs?\. \d\S*"
)
_TRACEBACK = "Traceback (most recent call last)"  # is for who writes programs, and stays as it is to its end
_BLANK = "\0"  # stands for a blank at which no line ends: printable text has none


def cells(text: str) -> int:
    """Return the width of a line, in columns of a terminal."""
    if text.isascii():
        return len(text)
    from rich.cells import cell_len

    return cell_len(text)


def words(text: str, most: int) -> list[str]:
    """Return the pieces of a line between which it may be broken, each at most `most` wide if possible."""
    held = _HELD.sub(lambda found: found[0].replace(" ", _BLANK), text).split()
    return [
        piece
        for each in held
        for piece in ([each.replace(_BLANK, " ")] if cells(each) <= most else each.replace(_BLANK, " ").split())
    ]


def wrapped(text: str, width: int | None, *, start: int = 0, hang: int = HANG) -> str:
    """Return a text in lines of a width.

    Parameters
    ----------
    text : str
        Text; its own line breaks are kept.
    width : int or None
        Columns of the terminal; None for no terminal, and lines of any length.
    start : int
        Columns of the first line that are already in use.
    hang : int
        Blanks before the continuation lines, in addition to those before the first; below a label, such as
        `source:   ...`, the width of the label.

    Returns
    -------
    str
        Lines; only a single word, such as a path, makes a line longer. A quoted line of a file above a mark is cut.
    """
    if width is None:
        return text
    lines = text.split("\n")
    labels = _labels(lines)
    made: list[str] = []
    for k, line in enumerate(lines):
        taken = 0 if k else start
        if line.startswith(_TRACEBACK):
            return "\n".join([*made, *lines[k:]])
        if k and line.strip() == "^":  # comes with the line that it marks
            continue
        if k + 1 < len(lines) and lines[k + 1].strip() == "^":
            made += _around(line, lines[k + 1], width)
        elif cells(line) + taken <= width:
            made.append(line)
        else:
            made += _filled(line, width, taken, labels[k], hang)
    return "\n".join(made)


def _labels(lines: list[str]) -> list[int]:
    """Return the columns of the label before each text, as in `source:   ...`; 0 if a line has no label.

    Two blanks distinguish a label from a word; among consecutive lines, the longest label has only one.
    """
    wide = [len(found[0]) if (found := _LABEL.match(line)) else 0 for line in lines]
    sure = {each for each, line in zip(wide, lines, strict=True) if line[:each].endswith("  ")}
    return [each if each in sure else 0 for each in wide]


def _filled(line: str, width: int, taken: int, label: int, deeper: int) -> Iterator[str]:
    """Yield one line as several; continuation lines are indented below the text after its label, or `deeper`."""
    blanks = label or len(line) - len(line.lstrip())
    hang = min(label or blanks + deeper, width // 2)
    shown = line[:blanks]
    begun = False
    for word in words(line[blanks:], width - hang):
        if begun and taken + cells(shown) + 1 + cells(word) > width:
            yield shown
            shown, taken, begun = " " * hang, 0, False
        shown += f" {word}" if begun else word
        begun = True
    yield shown


def _around(line: str, mark: str, width: int) -> list[str]:
    """Return a quoted line and the mark below it, cut if they are wider than the terminal."""
    if cells(line) <= width and len(mark) <= width:
        return [line, mark]
    place, blanks = len(mark) - 1, len(line) - len(line.lstrip())
    quoted, place, room = line[blanks:], place - blanks, width - blanks
    first = max(0, min(place - 2 * room // 3, len(quoted) - room))
    shown = quoted[first : first + room]
    if first:
        shown = DOTS + shown[len(DOTS) :]
    if first + room < len(quoted):
        shown = shown[: -len(DOTS)] + DOTS
    return [" " * blanks + shown, " " * (blanks + place - first) + "^"]
