"""Draw what docs/import.md starts from: a DXF drawing as a CAD program shows it.

python docs/make_import.py drawing FILE.dxf --plot PICTURE
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import click
import ezdxf
import ezdxf.path
import numpy as np

from rocking_cli.plotting import style
from rocking_cli.questions.import_drawing.legend import Role, role_of

LOOKS: dict[Role, dict[str, Any]] = {
    Role.BODIES: {"color": style.INK, "linewidth": style.MEDIUM},
    Role.GROUND: {"color": style.EARTH, "linewidth": style.BOLD},
    Role.SUPPORTS: {"color": style.MEASURE, "linewidth": style.BOLD},
    Role.LOADS: {"color": style.CURSOR, "linewidth": style.MEDIUM},
    Role.TIES: style.TIE,
    Role.NOTHING: {"color": style.FAINT, "linewidth": style.THIN},
}
"""The look of what is drawn on the layers of each role."""
SAGITTA = 1.0  # largest distance of the sides of a curve from it [units of the drawing]


@click.group()
def main() -> None:
    """Make what docs/import.md starts from."""


@main.command()
@click.argument("file")
@click.option("--plot", required=True)
def drawing(file: str, plot: str) -> None:
    """Draw a DXF file."""
    figure, axes = style.one_panel(style.page_width() * 0.72, Path(file).name)
    shown: dict[Role, set[str]] = {}
    for entity, layer in parts(ezdxf.readfile(file).modelspace()):
        role = role_of(layer) or Role.NOTHING
        look = LOOKS[role]
        shown.setdefault(role, set()).add(layer)
        if entity.dxftype() in ("TEXT", "ATTRIB", "MTEXT"):
            if style.is_narrow():
                continue  # there is no room for them
            x, y, _ = entity.dxf.insert
            text = entity.plain_text() if entity.dxftype() == "MTEXT" else entity.dxf.text
            middle = {"ha": "center", "va": "center"} if entity.dxftype() == "MTEXT" else {}
            colour = look["color"] if role is not Role.NOTHING else style.INK
            axes.text(x, y, text, fontsize=style.TINY, color=colour, **middle)
        elif entity.dxftype() == "POINT":
            x, y, _ = entity.dxf.location
            axes.plot([x], [y], marker="o", markersize=4, **look)
        elif entity.dxftype() == "HATCH":
            for path in ezdxf.path.from_hatch(entity):
                corners = [(each.x, each.y) for each in path.flattening(SAGITTA)]
                axes.fill(*np.transpose(corners), facecolor="none", edgecolor=look["color"], hatch="///", linewidth=0)
        else:
            corners = [(each.x, each.y) for each in ezdxf.path.make_path(entity).flattening(SAGITTA)]
            axes.plot(*np.transpose(corners), **look)
    for role, look in LOOKS.items():
        axes.plot([], [], label=f"{role}: {', '.join(sorted(shown[role]))}", **look)
    axes.set(aspect="equal")
    axes.set_axis_off()
    style.legend_below(figure, ncols=1 if style.is_narrow() else 2, grows=True)
    with Path(plot).open("wb") as stream:
        style.save(figure, stream, format=Path(plot).suffix[1:])


def parts(entities: Iterable[Any], around: str = "0") -> Iterator[tuple[Any, str]]:
    """Yield the entities of a drawing and their layers, those of blocks and dimensions one by one."""
    for entity in entities:
        layer = around if entity.dxf.layer == "0" else entity.dxf.layer
        if entity.dxftype() in ("INSERT", "DIMENSION"):
            yield from parts([*getattr(entity, "attribs", ()), *entity.virtual_entities()], layer)
        elif entity.dxftype() not in ("ATTDEF", "SOLID") and layer != "Defpoints":
            yield entity, layer


if __name__ == "__main__":
    main()
