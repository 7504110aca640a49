"""Runs what docs/python.md shows, line by line, in a folder of its own with the examples in it.

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

PAGE = Path(__file__).resolve().parent / "python.md"


def run(folder: Path) -> int:
    """Count the lines of the page whose output differs from the page; pictures and files are left in the folder."""
    shutil.copytree(PAGE.parents[1] / "examples", folder / "examples")
    with chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore", DoubtWarning)  # the mechanism that the page makes is unverified
        return doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.NORMALIZE_WHITESPACE).failed


def script() -> str:
    """Return the lines of the page without their output, for a type checker."""
    return doctest.script_from_examples(PAGE.read_text(encoding="utf-8"))


def main() -> None:
    """Run it; the exit code tells whether all is as shown."""
    with TemporaryDirectory() as folder:
        sys.exit(bool(run(Path(folder))))


if __name__ == "__main__":
    main()
