"""Writes the chooser of mechanisms: a thumbnail of each, static/mechanisms/NAME.svg, and the list that shows them.

The templates of common structures have thumbnails in the same folder; a table of docs/structures.md shows them.
"""

from __future__ import annotations

from pathlib import Path

from make_runs import themed
from matplotlib.figure import Figure
from parts import same

from rocking_cli import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.io.starters import STARTERS, starter
from rocking_cli.questions.mechanisms.command import drawing
from rocking_cli.questions.mechanisms.picture import THUMBNAIL, draw_thumbnail
from rocking_cli.studies.picture import picture

PLACE = Path(__file__).resolve().parent / "static" / "mechanisms"


def listed(names: str) -> str:
    """Return the list of mechanisms with their thumbnails, in the order of some names."""
    every = Registry()
    return "\n".join(
        f"- [![{every[name].title}](static/mechanisms/{name}.svg) `{name}`](mechanisms/{name}.md): {every[name].suits}"
        for name in names.split()
    )


def thumbnail(name: str) -> str:
    """Return the file of the thumbnail of a mechanism or of a template."""
    shown = picture(parse_structure(starter(name), name, name)) if name in STARTERS else drawing(name, Registry())
    figure = Figure(figsize=(THUMBNAIL.real, THUMBNAIL.imag), frameon=False)  # the page shows through
    draw_thumbnail(figure.add_axes((0, 0, 1, 1)), shown)
    return themed(figure, name)


def stale() -> dict[str, str]:
    """Return the thumbnails that are missing or differ from what is drawn, by their names."""
    every = Registry()
    own = [name for name in every if every.package_of(name).startswith("rocking-cli ")]
    there = {file.stem: file.read_text(encoding="utf-8") for file in PLACE.glob("*.svg")}
    return {name: text for name in [*own, *STARTERS] if not same(text := thumbnail(name), there.get(name, ""))}


def keep() -> None:
    """Write the thumbnails that are stale."""
    for name, text in stale().items():
        (PLACE / f"{name}.svg").write_text(text, encoding="utf-8", newline="\n")
        print(f"renewed docs/static/mechanisms/{name}.svg")
