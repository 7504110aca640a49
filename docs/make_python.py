"""Runs what some pages of docs show of Python, line by line, in a folder of its own with the examples in it.

python docs/make_python.py            # part of make docs
"""

from __future__ import annotations

import doctest
import shutil
import sys
import warnings
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking_cli import DoubtWarning

DOCS = Path(__file__).resolve().parent
PAGES = ("tutorial.md", "python.md", "import.md")


def run(folder: Path, page: str) -> int:
    """Count the lines of a page whose output differs from the page; pictures and files are left in the folder."""
    shutil.copytree(DOCS.parent / "examples", folder / "examples")
    with chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore", DoubtWarning)  # the mechanism that a page makes is unverified
        return doctest.testfile(
            str(DOCS / page), module_relative=False, optionflags=doctest.NORMALIZE_WHITESPACE
        ).failed


def script() -> str:
    """Return the lines of the pages without their output, for a type checker."""
    return "\n".join(doctest.script_from_examples((DOCS / page).read_text(encoding="utf-8")) for page in PAGES)


def main() -> None:
    """Run them; the exit code tells whether all is as shown."""
    with TemporaryDirectory() as folder:
        sys.exit(sum(run(Path(folder) / page, page) for page in PAGES) > 0)


if __name__ == "__main__":
    main()
