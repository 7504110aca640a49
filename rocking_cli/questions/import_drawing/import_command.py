"""`rocking import`: make a structure file of a drawing or a mesh."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.groups import Output
from rocking_cli.cli.quantities import NUMBER

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer

KINDS = ("rigid_body", "assembly", "linkage")
OF_MESHES = {
    "azimuth": None, "level": None, "settle": False, "hull": False, "up": None, "north": None, "page": None,
}  # fmt: skip
OF_DRAWINGS = {
    "scale": None, "layers": (), "depth": None, "merge_gap": None, "close": "1mm", "nested": None, "kind": None,
    "tolerance": "0.1mm", "plane": None,
}  # fmt: skip
"""Options that only meshes, or drawings, have, with their defaults."""


@click.command(short_help="Make a structure file of a drawing or a mesh.")
@click.argument("file", type=click.Path(), shell_complete=complete.files)
@options.out(".yaml", ".yml", what="Structure file to write.  [default: printed]", metavar="FILE.yaml")
@click.option(
    "--units", metavar="UNIT", help="Unit of the drawing: mm, cm, dm, m, in or ft.  [default: as the file says]"
)
@click.option("--scale", metavar="1:N", help="Scale of the drawing, such as 1:50.")
@click.option(
    "--layers",
    multiple=True,
    metavar="ROLE=NAMES",
    help="Layers of a role, such as bodies=CONCI,PILE. Roles: bodies, ground, openings, hinges, supports, loads, ties, "
    "nothing. Repeatable.  [default: by their names]",
)
@click.option(
    "--density",
    multiple=True,
    metavar="[LAYER=]DENSITY",
    help="Density, in kg/m3 without a unit; of one layer with its name: PIETRA=2600. Repeatable.",
)
@click.option("--depth", metavar="LENGTH", help="Depth of the structure, such as 1m.")
@click.option("--merge-gap", metavar="LENGTH", help="Close mortar joints up to this width: 12mm.  [default: none]")
@click.option(
    "--close",
    default="1mm",
    show_default=True,
    metavar="LENGTH",
    help="Distance up to which ends of lines are one point, and depth up to which overlaps are mended.",
)
@click.option("--nested", type=click.Choice(["openings"]), help="Take outlines inside others as openings.")
@click.option(
    "--as",
    "kind",
    type=click.Choice(KINDS),
    help="Mechanism of the structure.  [default: rigid_body for one body, linkage with hinges, or else assembly]",
)
@click.option(
    "--tolerance",
    default="0.1mm",
    show_default=True,
    metavar="LENGTH",
    help="Largest distance of the straight sides of curved blocks from their arcs.",
)
@click.option("--plane", type=click.Choice(["xz", "yz"]), help="Of a model of blocks: its plane.  [default: xz]")
@click.option("--azimuth", metavar="DEG", help="Of a mesh: direction of the motion, from its x axis: 30, or 0:350:10.")
@click.option("--level", metavar="LENGTH", help="Of a mesh: height up to which points bear.  [default: 1mm]")
@click.option("--settle", is_flag=True, help="Of a mesh: lay it on the facet of its hull below its centre of mass.")
@click.option("--hull", is_flag=True, help="Of a mesh: take its convex hull; it need not be closed.")
@click.option("--up", type=click.Choice(["z", "y"]), help="Of a mesh: axis that points upwards.  [default: z]")
@click.option("--north", type=NUMBER, metavar="DEG", help="Of a mesh: azimuth of the north, for the plot and the page.")
@click.option(
    "--page",
    callback=options.output_path(".html"),
    metavar="FILE.html",
    shell_complete=complete.files,
    help="Of a mesh: page on which the body can be turned.",
)
@options.plot("Plot the bodies with their names, what was mended, and what was left out")
@options.as_json
@options.grouped(output=Output)
def command(file: str, output: Output, **asked: Any) -> None:
    """Make a structure file of a drawing (DXF, SVG, GeoJSON, CSV of vertices).

    The names of layers say what is drawn on them: bodies (PIETRA, STONE, MURATURA), ground, openings, hinges, supports,
    loads and ties, in English or Italian; other layers with outlines need --layers. Closed lines are bodies; arcs stay
    exact. The output lists the bodies, and everything that was mended, assumed or left out; the same sentences are
    comments in the structure file. Without -o the file is printed.

    A block model of compas_dem (JSON) is an assembly of prisms seen in --plane; its supports are ground.

    A mesh (OBJ, PLY, STL) of a closed surface becomes a rigid body: the output lists the edges of its foot, and lambda
    in each direction. --level is decisive for a scan, so a table shows what it does.

    If the drawing cannot be used, the exit code is 2, one sentence says why and where, and nothing is written.

    \b
    Example:
      rocking import section.dxf -o section.yaml --plot section.png
      rocking import elevation.svg -o wall.yaml --scale 1:50 --density 1800 --depth 1m
      rocking import arch.dxf -o arch.yaml --merge-gap 12mm --density 2400 --depth 1m
      rocking import statue.obj -o statue.yaml --units m --density 2700 --level 2mm --settle --page statue.html
    """
    from rocking_cli.ask.drawings import is_mesh
    from rocking_cli.io.drawings.contract import DrawingError

    output.keep_apart(file)
    try:
        answer = (_of_mesh if is_mesh(file) else _of_drawing)(file, output, asked)
    except DrawingError as error:
        if not output.as_json:
            raise
        (problem,) = error.problems
        hint = problem.hint and terminal.as_typed(problem.hint)
        told = {"message": terminal.as_typed(problem.message), "hint": hint, "line": problem.line, "at": error.at}
        terminal.print_json({"refused": error.refused, **told})
        raise click.exceptions.Exit(error.exit_code) from None
    replace(output, out=None).show(answer)
    output.watch.end()


def _of_drawing(file: str, output: Output, asked: dict[str, Any]) -> Answer[Any]:
    """Import a drawing; without a file to write, the answer shows the structure file alone."""
    from rocking_cli.questions.import_drawing.roles import parse_layers
    from rocking_cli.questions.import_drawing.verb import import_drawing

    _refuse(asked, OF_MESHES, "is for meshes, but the file is a drawing")
    given = {name: value for name, value in asked.items() if name not in OF_MESHES and value is not None}
    given |= {"layers": parse_layers(asked["layers"]), "density": _densities(asked["density"])}
    answer = import_drawing(file, out=output.out, command=_typed(file, asked), watch=output.watch, **given)
    if output.out is None and not output.as_json:
        terminal.result(answer.text.rstrip("\n"))
        return replace(answer, view=replace(answer.view, parts=[]))
    return answer


def _of_mesh(file: str, output: Output, asked: dict[str, Any]) -> Answer[Any]:
    """Import a mesh."""
    from rocking_cli.questions.import_mesh.verb import import_mesh

    _refuse(asked, OF_DRAWINGS, "is for drawings, but the file is a mesh")
    if len(asked["density"]) > 1 or "=" in "".join(asked["density"]):
        raise click.UsageError("A mesh has one density: give --density once, without a layer.")
    given = {name: value for name, value in asked.items() if name in OF_MESHES and value is not None}
    density = asked["density"][0] if asked["density"] else None
    return import_mesh(
        file, units=asked["units"], density=density, out=output.out, command=_typed(file, asked), watch=output.watch,
        **given,
    )  # fmt: skip


def _refuse(asked: dict[str, Any], names: Mapping[str, Any], why: str) -> None:
    """Raise if an option is given that has no effect on the file."""
    for name, usual in names.items():
        if asked[name] != usual:
            raise click.UsageError(f"{'--as' if name == 'kind' else '--' + name.replace('_', '-')} {why}.")


def _densities(given: tuple[str, ...]) -> dict[str, str] | None:
    """Return the density of each layer, that of all others under ""."""
    densities: dict[str, str] = {}
    for text in given:
        layer, _, value = text.rpartition("=")
        if layer in densities:
            raise click.UsageError(f"--density is given twice for {layer or 'all layers'}.")
        densities[layer] = value
    return densities or None


def _typed(file: str, asked: dict[str, Any]) -> str:
    """Return the command as it may be typed again."""
    defaults = {"close": "1mm", "tolerance": "0.1mm"}
    words = ["rocking", "import", Path(file).name]
    for name, value in asked.items():
        option = "--as" if name == "kind" else f"--{name.replace('_', '-')}"
        for each in value if isinstance(value, tuple) else (value,):
            if each is not None and each is not False and defaults.get(name) != each:
                words += [option] if each is True else [option, str(each)]
    return shlex.join(words)
