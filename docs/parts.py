"""The parts of the pages that are made: what stands between `<!-- KIND: WHAT -->` and `<!-- end -->`.

A page is read as it is, on a code forge or in an editor, and the site is built from the same file: what is made stands
in it. It is written anew only where it says something else. The outputs of commands hold numbers, which differ in their
last digits from processor to processor: they are the same if their words are and their numbers are close.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isclose

PART = re.compile(r"^<!-- (?P<kind>\w+): (?P<what>.+?) -->\n(?P<made>.*?)^<!-- end -->$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.#-])[-+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?")
CLOSE = 0.02  # of a number: far more than rounding, far less than what another option changes
RAN = "run"  # the kind of part that holds the output of a command


def asked(text: str) -> list[tuple[str, str]]:
    """Kind and subject of each part of a page."""
    return [(part["kind"], part["what"]) for part in PART.finditer(text)]


def renewed(text: str, make: Callable[[str, str], str]) -> str:
    """A page with the parts made anew that say something else; `make` gives the text of a kind and a subject."""

    def anew(part: re.Match[str]) -> str:
        made = "\n" + make(part["kind"], part["what"]).strip("\n") + "\n\n"
        if part["kind"] == RAN and same(part["made"], made):
            return part[0]
        return f"<!-- {part['kind']}: {part['what']} -->\n{made}<!-- end -->"

    return PART.sub(anew, text)


def same(one: str, other: str) -> bool:
    """Whether two texts have the same words, however wide their columns are, and close numbers."""
    words = [" ".join(re.sub("─+", "─", NUMBER.sub(" 0 ", text)).split()) for text in (one, other)]
    return words[0] == words[1] and all(map(close, NUMBER.findall(one), NUMBER.findall(other)))


def close(one: str, other: str) -> bool:
    """Whether two printed numbers are: by a part of themselves, or by one in the last decimal place of both."""
    last = max(10.0 ** -len(number.partition(".")[2]) for number in (one, other)) if "." in one + other else 0.0
    a, b = (float(number.replace(",", "")) for number in (one, other))
    return isclose(a, b, rel_tol=CLOSE, abs_tol=0.0 if "e" in one + other else 1.001 * last)
