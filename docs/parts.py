"""The generated parts of the pages: the text between `<!-- KIND: WHAT -->` and `<!-- end -->`.

Pages are read as files, on a code forge or in an editor, and the site is built from the same files, so generated text
is part of them. A part is rewritten only if its content changes. The outputs of commands hold numbers, which differ in
their last digits from processor to processor: two outputs are the same if their words are equal and their numbers are
close.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isclose

PART = re.compile(r"^<!-- (?!made:)(?P<kind>\w+): (?P<what>.+?) -->\n(?P<made>.*?)^<!-- end -->$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.#-])[-+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?")
CLOSE = 0.02  # of a number: far more than rounding, far less than what another option changes
RAN = "run"  # the kind of part that holds the output of a command


def asked(text: str) -> list[tuple[str, str]]:
    """Return kind and subject of each part of a page."""
    return [(part["kind"], part["what"]) for part in PART.finditer(text)]


def renewed(text: str, make: Callable[[str, str], str]) -> str:
    """Return a page with its changed parts rewritten; `make` gives the text of a kind and a subject."""

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
