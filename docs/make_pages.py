"""Write commands and outputs in the pages, pictures and calculation sheets, so that they show what the program does.

    python docs/make_pages.py             # part of make docs

`tests/house/test_docs.py` fails as long as an output or a picture is stale.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import make_chooser
import make_sheets
import parts
from make_runs import Content, Run, keep, run, shown

DOCS = Path(__file__).resolve().parent
PROJECT = DOCS.parent
RUN = DOCS / "_generated" / "run"  # not in git; the site has the report from there


def pages() -> list[Path]:
    """Return the README and all pages, the tutorial first: it writes the file that others use."""
    found = [*DOCS.glob("*.md"), *DOCS.glob("mechanisms/*.md"), PROJECT / "README.md"]
    return sorted(found, key=lambda page: (page.name != "tutorial.md", page))


def commands() -> list[str]:
    """Return every command that is shown, without repetitions."""
    return list(dict.fromkeys(what for page in pages() for what in parts.commands(page.read_text(encoding="utf-8"))))


def made(kind: str, command: str, runs: dict[str, Run]) -> str:
    """Return a command, of kind `run` with its output."""
    language = "yaml" if " > " in command else "text"
    return f"    {command}" + (f"\n\n```{language}\n{runs[command].output}```" if kind == parts.RAN else "")


def drawn(runs: dict[str, Run]) -> dict[str, Content]:
    """Return the content of every picture that is shown."""
    all_drawn = {name: content for each in runs.values() for name, content in each.pictures.items()}
    all_drawn |= make_sheets.contents()
    wanted = {name for page in pages() for name in shown(page.read_text(encoding="utf-8"))}
    return {name: all_drawn[name] for name in sorted(wanted)}


def main() -> None:
    """Run all commands, and renew stale outputs, pictures and sheets."""
    shutil.rmtree(RUN, ignore_errors=True)
    RUN.mkdir(parents=True)
    runs = run(commands(), RUN)
    make_sheets.main()
    make_sheets.draw(RUN)
    keep(drawn(runs), runs, RUN)
    make_chooser.keep()
    for page in pages():
        text = page.read_text(encoding="utf-8")
        anew = parts.renewed(text, lambda kind, command: made(kind, command, runs))
        if anew != text:
            page.write_text(anew, encoding="utf-8", newline="\n")
            print(f"renewed {page.relative_to(PROJECT)}")


if __name__ == "__main__":
    main()
