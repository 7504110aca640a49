"""Count the words of the pages that are committed, by topic, and say which topic has more than its number.

python docs/count_words.py            # part of make docs-check
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
TOTAL = 60_000
TOPICS = {
    "index, set-up, readers": (950, "docs/index.md docs/for_*.md"),
    "README": (970, "README.md"),
    "tutorial": (3_000, "docs/tutorial.md"),
    "how to read a result": (2_000, "docs/how_to_read_it.md"),
    "structures": (7_000, "docs/structures.md docs/mechanisms/*.md docs/loads.md"),
    "ground motions": (3_500, "docs/motions.md"),
    "histories, margins, maps, spectra": (4_500, "docs/histories.md"),
    "pages that answer": (700, "docs/explore.md"),
    "verification and sheet": (4_000, "docs/verification.md"),
    "a building": (1_950, "docs/building.md"),
    "fragility": (3_500, "docs/fragility.md"),
    "a collection": (2_100, "docs/collection.md"),
    "survey and design": (2_100, "docs/survey.md"),
    "drawings and meshes": (3_000, "docs/import.md"),
    "calibration": (1_200, "docs/calibration.md"),
    "Python": (2_000, "docs/python.md docs/api.md docs/api/*.md"),
    "worked structures": (2_000, "docs/examples.md"),
    "theory with free blocks": (4_700, "docs/theory.md docs/free_blocks.md"),
    "how far to trust it": (3_500, "docs/how_far_to_trust_it.md docs/validation.md docs/scor*.md"),
    "performance": (800, "docs/performance.md"),
    "plugins": (4_000, "docs/plugins.md"),
    "contributing": (2_500, "CONTRIBUTING.md docs/contributing.md docs/[acw][rho][cnar]*.md"),
    "questions and messages": (1_500, "docs/faq.md"),
}
"""Of each topic the largest number of words, outputs of commands among them, and its files."""


def counted() -> dict[str, int]:
    """Return the number of words of each topic, and of pages that belong to none."""
    every = {*PROJECT.glob("docs/*.md"), *PROJECT.glob("docs/[!_]*/*.md"), PROJECT / "README.md"}
    every -= {*PROJECT.glob("docs/reference/*.md")}  # made, and not committed
    words: dict[str, int] = {}
    for topic, (_, patterns) in TOPICS.items():
        files = {file for pattern in patterns.split() for file in PROJECT.glob(pattern)}
        words[topic] = sum(map(words_of, files))
        every -= files
    return words | {file.relative_to(PROJECT).as_posix(): words_of(file) for file in every}


def words_of(file: Path) -> int:
    """Return the number of words of a page, without what its markers name."""
    return len(re.sub("<!--.*?-->", "", file.read_text(encoding="utf-8"), flags=re.DOTALL).split())


def main() -> None:
    """Print the numbers; the exit code tells whether they are kept."""
    words = counted()
    over = []
    for topic, number in words.items():
        most = TOPICS[topic][0] if topic in TOPICS else 0
        print(f"{topic:40}{number:8,}{most:8,}{'  more than its number' * (number > most)}")
        over += [topic] if number > most else []
    print(f"{'all':40}{sum(words.values()):8,}{TOTAL:8,}")
    sys.exit(bool(over) or sum(words.values()) > TOTAL)


if __name__ == "__main__":
    main()
