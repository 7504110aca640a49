"""The parts of the pages that are made: `<!-- KIND: COMMAND -->` to `<!-- end -->`, and `<!-- here: KIND WHAT -->`.

Commands with their outputs are part of a page, as it is read as a file too. They are rewritten only if the output
changes: it holds numbers, which differ in their last digits from processor to processor, so two outputs are the same if
their words are equal and their numbers are close. What `here` stands for, such as a table of fields, is on the site
alone.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isclose

PART = re.compile(r"^<!-- (?P<kind>run|draw): (?P<what>.+?) -->\n(?P<made>.*?)^<!-- end -->$", re.M | re.S)
HERE = re.compile(r"^<!-- here: (?P<kind>\w+)(?P<what>.*?) -->$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.#-])[-+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?")
CLOSE = 0.02  # of a number: far more than rounding, far less than what another option changes
RAN = "run"  # the kind of part that holds the output of a command


def commands(text: str) -> list[str]:
    """Return the commands of a page."""
    return [part["what"] for part in PART.finditer(text)]


def renewed(text: str, make: Callable[[str, str], str]) -> str:
    """Return a page with its changed commands and outputs rewritten; `make` gives the text of a kind and a command."""

    def anew(part: re.Match[str]) -> str:
        made = "\n" + make(part["kind"], part["what"]).strip("\n") + "\n\n"
        if part["kind"] == RAN and same(part["made"], made):
            return part[0]
        return f"<!-- {part['kind']}: {part['what']} -->\n{made}<!-- end -->"

    return PART.sub(anew, text)


def same(one: str, other: str) -> bool:
    """Return whether two texts have the same words, whatever the widths of their columns, and close numbers."""
    words = [" ".join(re.sub("─+", "─", NUMBER.sub(" 0 ", text)).split()) for text in (one, other)]
    return words[0] == words[1] and all(map(close, NUMBER.findall(one), NUMBER.findall(other)))


def close(one: str, other: str) -> bool:
    """Return whether two printed numbers are close: relatively, or within one in the last decimal place."""
    last = max(10.0 ** -len(number.partition(".")[2]) for number in (one, other)) if "." in one + other else 0.0
    a, b = (float(number.replace(",", "")) for number in (one, other))
    return isclose(a, b, rel_tol=CLOSE, abs_tol=0.0 if "e" in one + other else 1.001 * last)
