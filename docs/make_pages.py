"""Write the generated parts of the pages, pictures and calculation sheets, so that they show what the program does.

    python docs/make_pages.py             # part of make docs

`tests/house/test_docs.py` fails as long as a part or a picture is stale.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import make_chooser
import make_reference
import make_sheets
from make_runs import Content, Run, keep, run, shown
from parts import asked, renewed

import rocking_cli
from rocking_cli import Registry, verification

DOCS = Path(__file__).resolve().parent
PROJECT = DOCS.parent
RUN = DOCS / "_generated" / "run"  # not in git; the site has the report from there
LANGUAGES = {".yaml": "yaml", ".py": "python", ".toml": "toml"}
RUNS = ("run", "draw")  # the kinds of parts that are made by a command, with and without its output


def pages() -> list[Path]:
    """Return the README and all pages, the tutorial first: it writes the file that others use."""
    folders = ("", "api/", "mechanisms/", "walls/", "masonry/")
    found = [*(page for folder in folders for page in DOCS.glob(f"{folder}*.md")), PROJECT / "README.md"]
    return sorted(found, key=lambda page: (page.name != "tutorial.md", page))


def commands() -> list[str]:
    """Return every command that is shown, without repetitions."""
    parts = (part for page in pages() for part in asked(page.read_text(encoding="utf-8")))
    return list(dict.fromkeys(what for kind, what in parts if kind in RUNS))


def made(kind: str, what: str, runs: dict[str, Run]) -> str:
    """Return the text of a part."""
    if kind in RUNS:
        output = f"\n\n```{'yaml' if ' > ' in what else 'text'}\n{runs[what].output}```" if kind == "run" else ""
        return f"    {what}{output}"
    if kind == "file":
        text = (PROJECT / what).read_text(encoding="utf-8")
        return f"```{LANGUAGES[Path(what).suffix]}\n{text.strip()}\n```"
    if kind == "readme":
        return of_the_readme(what)
    if kind == "mechanism":
        return make_reference.mechanism(Registry()[what])
    if kind == "blocks":
        return make_reference.equivalent_blocks(what)
    if kind == "core":
        return make_reference.helpers(what)
    if kind == "verification":
        return make_reference.helpers(what, verification)
    if kind == "names":
        return make_reference.helpers(what, rocking_cli)
    if kind == "chooser":
        return make_chooser.listed(what)
    if kind == "study":
        return make_reference.study_fields()
    if kind == "index":
        return make_reference.index(what)
    return {"options": make_reference.command_line, "formulas": make_reference.standing_of_formulas}[kind]()


def of_the_readme(name: str) -> str:
    """Return the text of the README between `<!-- NAME -->`, or its beginning, and `<!-- /NAME -->`."""
    before, _, _ = (PROJECT / "README.md").read_text(encoding="utf-8").partition(f"<!-- /{name} -->")
    return before.rpartition(f"<!-- {name} -->")[2]


def drawn(runs: dict[str, Run]) -> dict[str, Content]:
    """Return the content of every picture that is shown."""
    all_drawn = {name: content for each in runs.values() for name, content in each.pictures.items()}
    all_drawn |= make_sheets.contents()
    wanted = {name for page in pages() for name in shown(page.read_text(encoding="utf-8"))}
    return {name: all_drawn[name] for name in sorted(wanted)}


def main() -> None:
    """Run all commands, and renew stale parts, pictures and sheets."""
    shutil.rmtree(RUN, ignore_errors=True)
    RUN.mkdir(parents=True)
    runs = run(commands(), RUN)
    make_sheets.main()
    make_sheets.draw(RUN)
    keep(drawn(runs), runs, RUN)
    make_chooser.keep()
    for page in pages():
        text = page.read_text(encoding="utf-8")
        anew = renewed(text, lambda kind, what: made(kind, what, runs))
        if anew != text:
            page.write_text(anew, encoding="utf-8", newline="\n")
            print(f"renewed {page.relative_to(PROJECT)}")


if __name__ == "__main__":
    main()
