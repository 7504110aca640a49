"""The parts of pages that scripts make: the text between `<!-- made: NAME -->` and `<!-- end -->`.

The rest of a page is written by people, in the page. Other kinds of parts are those of docs/parts.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from textwrap import fill

DOCS = Path(__file__).resolve().parents[1] / "docs"
MADE = re.compile(r"^<!-- made: (?P<name>\w+) -->\n(?P<text>.*?)^<!-- end -->$", re.M | re.S)


def renewed(text: str, parts: Mapping[str, str]) -> str:
    """Return a page with all its made parts; raise ValueError if a part lacks its text, or a text its part."""
    names = [part["name"] for part in MADE.finditer(text)]
    if sorted(names) != sorted(parts):
        raise ValueError(f"the page has the parts {', '.join(names)}, and the script makes {', '.join(parts)}")
    return MADE.sub(lambda part: f"<!-- made: {part['name']} -->\n\n{parts[part['name']]}\n\n<!-- end -->", text)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table."""
    first, *others = (f"| {' | '.join(row)} |" for row in (heads, *rows))
    return "\n".join([first, "|---" * len(heads) + "|", *others])


def prose(*sentences: str) -> str:
    """Return a paragraph."""
    return fill(" ".join(sentences), 120, break_long_words=False, break_on_hyphens=False)
