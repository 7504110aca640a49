"""The style guide, as far as it can be counted: phrases that are not English an engineer would write."""

import re
from pathlib import Path

from rocking_cli.errors import Problem
from tests.conftest import PROJECT

PHRASES = (
    "asked for", "held against", "can take", "on the safe side", "goes not with", "goes with", "it is said",
    "that is said", "hangs on", "as often as you like", "takes for granted", "do alike", "is no unit",
    "are warned of", "what there is none of", "next to the one",
)  # fmt: skip
MOST = 14  # that may stay, where they are English
FOLDERS = ("rocking_cli", "mechanisms", "docs", "examples", "tests", "scripts", "benchmarks")
KINDS = {".py", ".pyi", ".md", ".yaml", ".html", ".j2", ".js", ".css", ".toml"}
GLOSSARY = PROJECT / "docs" / "words.md"  # its column of words not to use names some
NOT_COUNTED = {GLOSSARY, PROJECT / "CHANGELOG.md", Path(__file__)}


def files():
    """Return every text of the project that its authors wrote."""
    of_folders = (file for folder in FOLDERS for file in (PROJECT / folder).rglob("*") if file.suffix in KINDS)
    own = [PROJECT / name for name in ("README.md", "CONTRIBUTING.md", "Makefile", "pyproject.toml")]
    return sorted({*of_folders, *own} - NOT_COUNTED)


BROKEN = r"(?:\s|#|\"\s*\n\s*f?\")+"  # what may be between two words


def places(text, phrase):
    """Return the lines on which a phrase begins, whether or not it is broken between two lines."""
    broken = BROKEN.join(map(re.escape, phrase.split()))
    return [text.count("\n", 0, found.start()) + 1 for found in re.finditer(rf"\b{broken}\b", text, re.IGNORECASE)]


def test_phrases_that_are_not_english_are_gone():
    found = [
        f"{file.relative_to(PROJECT)}:{line}: {phrase}"
        for file in files()
        if "_generated" not in file.parts
        for text in [file.read_text(encoding="utf-8")]
        for flat in [re.sub(BROKEN, " ", text).lower()]
        for phrase in PHRASES
        if phrase in flat  # most are in no file, and seen soonest so
        for line in places(text, phrase)
    ]
    assert len(found) <= MOST, "\n".join(found)


def test_a_phrase_is_found_across_lines_and_in_any_case():
    assert places("a\nHeld\n    # against", "held against") == [2]
    assert places('"what is held "\n    "against"', "held against") == [1]
    assert places("upheld against, shelf held against", "held against") == [1]


def test_a_predicate_follows_its_field_without_a_colon():
    assert str(Problem("is missing", field="FC", file="a.yaml", line=3)) == "a.yaml:3: FC is missing"
    assert str(Problem("cannot be combined with ag", field="spectrum")) == "spectrum cannot be combined with ag"
    assert str(Problem("give a number", field="FC")) == "FC: give a number"
    assert str(Problem("is missing")) == "is missing"
