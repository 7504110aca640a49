"""Every class of refusal of `rocking import`, reached by the command line with a file of its own."""

import io
import json
import re

import ezdxf
import pytest
from click.testing import CliRunner
from ezdxf.xclip import XClip

from rocking_cli.cli.main import main
from tests import meshes
from tests.conftest import PROJECT

BOX = [[0, 0], [0.6, 0], [0.6, 2.4], [0, 2.4]]
MESH = meshes.box((0.0, 0.0, 0.0), (0.6, 0.8, 2.4))
CRUMBS = meshes.several(*(meshes.box((2.0 * k, 0.0, 0.0), (2.0 * k + 1, 1.0, 1.0)) for k in range(101)))
LEANING = meshes.extruded([(0.0, 0.0), (0.3, 0.0), (3.0, 3.0), (0.0, 3.0)], 0.5)
INSERT = (
    "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nK\n70\n{}\n1\nother.dwg\n0\nLINE\n11\n1\n0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\n"
)
INSERT += "ENTITIES\n0\nINSERT\n2\nK\n70\n32000\n71\n32000\n44\n1\n45\n1\n0\nENDSEC\n0\nEOF\n"
PLY = "ply\nformat ascii 1.0\nelement vertex 8\nelement face 5000000\nend_header\n"


def shape(kind, coordinates, layer="PIETRA", name=""):
    properties = {"layer": layer, "name": name}
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def body(*corners, layer="PIETRA"):
    return shape("Polygon", [[*corners, corners[0]]], layer)


def box(x, y, width, height, layer="PIETRA"):
    return body([x, y], [x + width, y], [x + width, y + height], [x, y + height], layer=layer)


def line(*corners, layer="PIETRA"):
    return shape("LineString", corners, layer)


def drawing(*shapes):
    return json.dumps({"type": "FeatureCollection", "features": shapes}).encode()


def clipped():
    """A DXF file with an insert of which a part is hidden."""
    document = ezdxf.new()
    document.blocks.new("WALL").add_lwpolyline([(0, 0), (2, 0), (2, 3), (0, 3)], close=True)
    XClip(document.modelspace().add_blockref("WALL", (0, 0), {"layer": "MURO"})).set_wcs_clipping_path([(0, 0), (1, 3)])
    document.write(stream := io.StringIO())
    return stream.getvalue().encode()


WALL = box(100, 0, 1, 2)
M, D = ["--units", "m"], ["--units", "m", "--density", "2000"]
REFUSED = [  # class, ending, content, options, words, and place
    ("units", "geojson", drawing(box(0, 0, 600, 2400)), [], "give --units .it is 2400 units large: 2.4 m if mm", []),
    ("units", "csv", b"0,0\n6,0\n6,24\n", ["--units", "km"], "would be 2.4e.04 m large: give other --units", []),
    ("units", "obj", meshes.obj(MESH), [], "a mesh does not say its units: give --units", []),
    ("layers", "geojson", drawing(*(box(9 * k, 0, 1, 1, name) for k, name in enumerate(("FOGLIO", "0", "FOGLIO")))), M,
     "FOGLIO has 2 outlines, 0 has 1; 2 of them .* --layers bodies=FOGLIO,0 ", []),
    ("layers", "geojson", drawing(WALL, box(9, 0, 1, 1, "MATTE")), M,
     "MATTE has no known role: by what is drawn there, --layers bodies=MATTE .other roles: nothing", []),
    ("empty", "geojson", drawing(shape("Point", [500, 0])), M, "no outline in it, only 1 Point", []),
    ("empty", "obj", b"# nothing\n", D, "has no points", []),
    ("unclosed", "csv", b"0,0\n1,0\n\n1,0\n1,2\n\n1,2\n0,2\n\n0,2\n0,0.03\n", M,
     "4 lines close nothing: .* 30 mm apart", [[0, 0], [0, 0.03]]),
    ("crosses", "geojson", drawing(body([300, 0], [301, 2.4], [301, 0], [300, 2.4])), M, "itself at .300.5, 1.2",
     [[300.5, 1.2]]),
    ("thin", "geojson", drawing(body([300, 0], [301, 0], [302, 0])), M, "encloses nothing, at .300, 0", [[300, 0]]),
    ("overlap", "geojson", drawing(WALL, box(100.96, 0, 1, 1)), M, "b2 overlap by 0.04 m2 at .* 40 mm deep",
     [[100.98, 0.5]]),
    ("nested", "geojson", drawing(WALL, box(100.2, 1, 0.5, 0.5)), M, "lies within outline 1 .*--nested openings",
     [[100.45, 1.25]]),
    ("opening", "geojson", drawing(WALL, box(104, 1, 0.2, 0.2, "FORI")), M, "in no body", [[104.1, 1.1]]),
    ("below", "geojson", drawing(WALL, line([99, 0.5], [102, 0.5], layer="TERRENO")), M,
     "reaches 500 mm into the ground", [[100.5, 0.25]]),
    ("not_plane", "geojson", drawing(body([300, 0, 0], [301, 0, 0], [301, 2, 0.4])), M, "differ by 400 mm in z",
     [[300, 0]]),
    ("density", "geojson", drawing(WALL, box(101, 0, 1, 1, "MATTONE")), [*M, "--density", "PIETRA=1800"],
     "some have none: give --density for all", [[101.5, 0.5]]),
    ("density", "obj", meshes.obj(MESH), [*M, "--page", "out.html"],
     "mass of the body is not known: give --density", []),
    ("hinge", "geojson", drawing(WALL, shape("Point", [105, 0], "CERNIERE")), M, "on no edge of a body", [[105, 0]]),
    ("support", "geojson", drawing(WALL, line([105, 1], [106, 1], layer="SOLAIO")), M, "ends on no body", [[105, 1]]),
    ("load", "geojson", drawing(WALL, shape("Point", [100.5, 2], "CARICHI", "12 kN")), M,
     "12 kN at a point: is it the weight of a mass", [[100.5, 2]]),
    ("tie", "geojson", drawing(WALL, line([100.5, 1], [106, 1], layer="CATENE")), M,
     "a tie ends on no body", [[106, 1]]),
    ("mechanism", "geojson", drawing(WALL, box(105, 3, 1, 1)), M, "'b2' touches nothing", [[105.5, 3.5]]),
    ("xref", "dxf", INSERT.format(4).encode(), M, "refers to another file, other.dwg", []),
    ("clipped", "dxf", clipped(), M, r"INSERT \w+ on layer MURO shows only a part of its block WALL \(XCLIP\)", []),
    ("xref", "svg", b'<svg><use href="b.svg#a"/></svg>', M, "another file, b.svg#a", []),
    ("degrees", "geojson", drawing(body([12.49, 41.89], [12.4901, 41.89], [12.49, 41.8902])), M, "look like degrees",
     [[12.49, 41.89]]),
    ("number", "csv", b"0,0\n1e13,0\n1,1\n", M, "x is beyond 1e.12", []),
    ("number", "obj", meshes.obj(MESH).replace(b"2.4", b"1e300", 1), D, "a coordinate of 1e.300, beyond 1e.12", []),
    ("too_large", "dxf", INSERT.format(0).encode(), M, "inserts of the drawing make more than 100000 entities", []),
    ("not_dxf", "dwg", b"AC1032" + bytes(99), M, "save it as DXF", []),
    ("not_svg", "svg", b"<svg><g>", M, "the file is cut short", []),
    ("not_geojson", "geojson", drawing(WALL)[:-9], M, "the file is cut short", []),
    ("not_csv", "csv", b"0,0\n1,x\n1,1\n", M, "y is `x`, which is not a number", []),
    ("unknown", "txt", b"hello\n", M, "known formats: CSV of vertices, DXF, GeoJSON", []),
    ("open", "obj", meshes.obj((MESH[0], MESH[1][:-1])), D,
     "3 loose sides, the largest hole 0.8 x 0.6 m", [[0, 0, 2.4]]),
    ("point", "obj", meshes.obj(meshes.turned(MESH, (1, 0, 0), 3)), D, "stands on a line within 1 mm .* 3.00 degrees",
     [[-0.3, -0.3366486], [0.3, -0.3366486]]),
    ("falls", "obj", meshes.obj(LEANING), D, "not above its foot within 1 mm .* 0.709 m beside it", [[0, 0]]),
    ("shells", "obj", meshes.obj(CRUMBS), D, "has 101 closed surfaces", []),
    ("thin", "obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", D, "its surface has no inside", []),
    ("cut", "stl", meshes.stl(MESH)[:-20], D, "announces 12 faces, and has 11", []),
    ("damaged", "obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n", D, "cannot be read as OBJ", []),
    ("cut", "ply", PLY.encode(), D, "announces 8 points and 5,000,000 faces, and has 0 and 0", []),
]  # fmt: skip
HINTS = {
    "xref": "bind it", "clipped": "explode it", "xref svg": "put its content into",
    "degrees": "save it in a projection", "cut": "save it again",
    "too_large": "save what is needed", "not_svg": "save the drawing as SVG", "open": "close its holes, or give --hull",
    "point": "--settle", "falls": "--settle", "shells": "keep those of one body",
}  # fmt: skip
LINES = {"xref svg": 1, "number csv": 2, "not_svg": 1, "not_geojson": 1, "not_csv": 2}


@pytest.mark.parametrize(
    ("refused", "ending", "content", "options", "words", "at"),
    REFUSED,
    ids=[f"{case[0]} {case[1]}" for case in REFUSED],
)
def test_a_file_is_refused_with_class_words_and_place_and_nothing_is_written(
    refused, ending, content, options, words, at, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / f"drawn.{ending}").write_bytes(content)
    typed = ["import", f"drawn.{ending}", *options, "-o", "out.yaml", "--plot", "out.png", "--json"]
    done = CliRunner().invoke(main, typed)
    assert done.exit_code == 2, done.output
    told = json.loads(done.stdout)
    assert (told["refused"], bool(re.search(words, told["message"]))) == (refused, True), told
    assert [pytest.approx(place) for place in at] == told["at"]
    hint, row = (texts.get(f"{refused} {ending}", texts.get(refused)) for texts in (HINTS, LINES))
    assert (told["hint"] or "").startswith(hint or "") and bool(told["hint"]) == bool(hint)
    assert told["line"] == row
    assert [each.name for each in tmp_path.iterdir()] == [f"drawn.{ending}"]


def test_every_class_that_the_code_raises_is_tried():
    package = PROJECT / "rocking_cli"
    folders = [package / each for each in ("io/drawings", "questions/import_drawing", "questions/import_mesh")]
    files = [package / "ask" / "read.py", *(file for folder in folders for file in folder.glob("*.py"))]
    code = "".join(file.read_text(encoding="utf-8") for file in files)
    raised = set(re.findall(r'(?:DrawingError\(|places\.require\([^"]*, |refusal\()\s*"(\w+)"', code))
    assert raised == {refused for refused, *_ in REFUSED}
