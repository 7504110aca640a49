"""`rocking import`: make a structure file of a drawing or a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from rocking_cli.ask.asked import no_effect
from rocking_cli.ask.watcher import Watcher
from rocking_cli.cli import terminal
from rocking_cli.cli.made import Made, command_line
from rocking_cli.errors import InputError
from rocking_cli.plugins.rooms import short_help
from rocking_cli.questions.import_drawing.options import ImportDrawing
from rocking_cli.questions.import_mesh.options import ImportMesh


class _Imported(ImportDrawing, ImportMesh):
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


class _Import(Made):
    def ask(self, given: Mapping[str, Any], usual: Mapping[str, Any], watch: Watcher) -> Any:
        """Make a structure of the file by the verb for what it has."""
        from rocking_cli.ask.read import is_mesh
        from rocking_cli.io.drawings.contract import DrawingError
        from rocking_cli.questions.import_drawing.verb import import_drawing
        from rocking_cli.questions.import_mesh.verb import import_mesh

        context = click.get_current_context()
        try:
            read_as, verb = ("mesh", import_mesh) if is_mesh(given["file"]) else ("drawing", import_drawing)
            if of_others := [name for name in given if name not in verb.model.model_fields]:
                raise InputError(no_effect(of_others, f"on a {read_as}"))
            origin = command_line(context, without=("out", "plot", "page", "as_json"))
            return verb.ask(given, {"origin": origin}, watch)
        except DrawingError as error:
            if not context.params["as_json"]:
                raise
            (problem,) = error.problems
            told = {"message": problem.message, "hint": problem.hint, "line": problem.line, "at": error.at}
            terminal.print_json({"refused": error.refused, **told})
            raise click.exceptions.Exit(error.exit_code) from None

    def show(self, answer: Any, *, as_json: bool) -> None:
        """Show the answer; without a file to write, the structure file of a drawing alone."""
        if as_json or click.get_current_context().params["out"] is not None or not hasattr(answer, "text"):
            super().show(answer, as_json=as_json)
        else:
            terminal.result(answer.text.rstrip("\n"))


command = _Import("import", _Imported, short_help("import"))
