"""The common structures that `rocking new` prints, and the Italian names and comments of its templates."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

STARTERS = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
"""Common structures, each a file in the data of the package. A mechanism of the same name has priority."""
ENDINGS = (r" \([^()]*\)", r" \[[^\[\]]*\]", r", [^,]+")
"""Bounds, unit and symbol, which in a comment follow the description of a field, from the last on."""
NAME = re.compile(r"(?<=\bname: )[a-z ]+\b")
NO_PROSE = r"\[.*\]|- .*|[\w ]+:( .*)?|.*\(\d{4}\).*"
"""Comments that need no translation: a unit, a field that is commented out, and a source with its year."""


@cache
def italian() -> Mapping[str, Mapping[str, str]]:
    """Return `templates` and `fields` by Italian names, and Italian `names` and `comments` by English ones."""
    import tomllib

    return tomllib.loads((files("rocking_cli") / "data" / "italian.toml").read_text(encoding="utf-8"))


def starter(name: str) -> str:
    """Return the text of a file in the data of the package, such as that of `facade`."""
    return (files("rocking_cli") / "data" / "starters" / f"{name}.yaml").read_text(encoding="utf-8")


def template_of(word: str) -> str:
    """Return the name of the template that an Italian word means; another word as it is.

    Examples
    --------
    >>> template_of("Cella campanaria"), template_of("facade")
    ('bell_cell', 'facade')
    """
    return italian()["templates"].get(re.sub(r"[\s-]+", "_", word.strip().lower()), word)


def instead_of_mechanism(word: str) -> str | None:
    """Return what a word means that is the name of no mechanism: a starter, or an Italian name; None if neither."""
    name = template_of(word)
    if name in STARTERS:
        return f"{name} is a starter: `rocking new {name} > {name}.yaml`"
    return f"did you mean {name}?" if name != word else None


def in_italian(text: str) -> tuple[str, list[str]]:
    """Return a template with its names and comments in Italian, and the comments that have no Italian text."""
    lines, missing = [], []
    for line in text.splitlines():
        before, sign, comment = line.rpartition("# ")
        translated = _translated(comment) if sign else None
        if sign and translated is None and not re.fullmatch(NO_PROSE, comment.strip()):
            missing.append(comment)
        lines.append(line if translated is None else f"{before}# {translated}")
    named = NAME.sub(lambda match: italian()["names"].get(match[0], match[0]), "\n".join(lines))
    return named + "\n", missing


def _translated(comment: str) -> str | None:
    """Return a comment in Italian, with the symbol, the unit and the bounds that end it; None if there is no text."""
    comments, kept = italian()["comments"], ""
    for ending in ENDINGS:
        match = None if comment in comments else re.fullmatch(f"(.+)({ending})", comment)
        if match is not None:
            comment, kept = match[1], match[2] + kept
    return comments[comment] + kept if comment in comments else None
