"""Block models of compas_dem: a portal of prisms beside the same one typed by hand, and what is no prism."""

import json

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.io.drawings import compas
from rocking_cli.io.drawings.contract import DrawingError

SIDES = [[0, 1, 2, 3], [7, 6, 5, 4], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
PORTAL = {
    "left": [[0.0, 0.0], [0.8, 0.0], [0.8, 3.0], [0.0, 3.0]],
    "right": [[3.2, 0.0], [4.0, 0.0], [4.0, 3.0], [3.2, 3.0]],
    "lintel": [[0.0, 3.0], [4.0, 3.0], [4.0, 3.6], [0.0, 3.6]],
}
GROUND = [[-1.0, -0.5], [5.0, -0.5], [5.0, 0.0], [-1.0, 0.0]]


def moved(x, y, z):
    return {"data": {"matrix": [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]}}


def block(section, ends=(0.0, 0.5), *, name=None, support=False, at=None, faces=SIDES, axes=(0, 2, 1)):
    """A prism as compas writes it; `axes` are those of the section, then that of the prism."""
    corners = np.array([(*corner, end) for end in ends for corner in section])[:, np.argsort(axes)].tolist()
    mesh = {"vertex": {str(k): dict(zip("xyz", each, strict=True)) for k, each in enumerate(corners)},
            "face": {str(k): face for k, face in enumerate(faces)}}  # fmt: skip
    data = {"name": "Block", "transformation": at, "material": "stone", "is_support": support,
            "geometry": {"dtype": "compas.datastructures/Mesh", "data": mesh}}  # fmt: skip
    return {"dtype": "compas_dem.elements/Block", "data": data} | ({"name": name} if name else {})


def model(blocks, at=None, children=()):
    nodes = [{"name": "ElementNode", "element": key} for key in blocks]
    for one, other in children:
        nodes[one]["children"] = [nodes[other]]
    within = {other for _, other in children}
    root = {"name": "root", "children": [node for k, node in enumerate(nodes) if k not in within]}
    stone = {"dtype": "compas_dem.material/Stone", "data": {"density": 2200}}
    data = {"transformation": at, "elements": blocks, "tree": {"root": root}, "materials": {"stone": stone}}
    return json.dumps({"dtype": "compas_dem.models/BlockModel", "data": data}).encode()


def portal(**more):
    blocks = {name: block(z, name=name, **more) for name, z in PORTAL.items()}
    return {"g": block(GROUND, support=True, **more)} | blocks


@pytest.mark.parametrize(("plane", "axes"), [("xz", (0, 2, 1)), ("yz", (1, 2, 0))])
def test_a_portal_is_the_one_typed_by_hand(tmp_path, plane, axes):
    (tmp_path / "model.json").write_bytes(model(portal(axes=axes)))
    made = rk.import_drawing(tmp_path / "model.json", units="m", plane=plane)
    typed = rk.Assembly(
        blocks={name: {"polygon": z} for name, z in PORTAL.items()}, ground={"g": {"polygon": GROUND}}, density=2200,
        depth=0.5,
    )  # fmt: skip
    for direction in rk.Direction:
        assert made.structure.uplift(direction) == pytest.approx(typed.uplift(direction), rel=1e-12)
    assert [body.mass for body in made.structure.bodies()] == pytest.approx([2640, 2640, 2640])


def test_blocks_are_moved_by_what_they_are_part_of():
    tall = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]
    blocks = {"a": block(GROUND, support=True, at=moved(5, 0, 0)), "b": block(tall, at=moved(0, 0, 1))}
    drawing = compas.read(model(blocks, moved(0, 7, 10), [(0, 1)]), "m.json")
    assert [each.layer for each in drawing.chains] == ["ground", "blocks"] and drawing.depth == 0.5
    assert set(drawing.chains[1].points.tolist()) == {5 + 11j, 5 + 13j, 6 + 11j, 6 + 13j}


def test_triangles_make_the_same_section():
    cut = [half for a, b, c, d in SIDES for half in ([a, b, c], [a, c, d])]
    (chain,) = compas.read(model({"a": block(GROUND, faces=cut)}), "m.json").chains
    assert len(chain.points) == 4 and set(chain.points.tolist()) == {complex(*corner) for corner in GROUND}


def test_what_is_no_prism_is_named():
    skew = block(GROUND, name="keystone")
    skew["data"]["geometry"]["data"]["vertex"]["5"]["x"] += 0.01
    for odd, said in (
        (skew, "the block keystone is not a prism along the axis across xz"),
        (block(GROUND, (0.1, 0.6), name="behind"), "the block behind reaches from 0.1 to 0.6, and not from 0 to 0.5"),
        (block(GROUND, axes=(1, 2, 0)), "the block Block odd reaches from -1 to 5"),
    ):
        with pytest.raises(DrawingError, match=said):
            compas.read(model({"a": block(GROUND), "odd": odd}), "m.json")
    far = (model(portal()).replace(b"5.0", number) for number in (b"NaN", b"1e999", b"9" * 400))
    for cut in (b'{"dtype": "compas_dem.models/BlockModel"}', model({"a": {}}), model(portal())[:-9], *far):
        assert compas.sniff(cut, ".json")
        with pytest.raises(DrawingError, match="cannot be read as JSON of compas_dem"):
            compas.read(cut, "m.json")
    old = b'{"dtype": "compas_model.models/Model", "data": {"elements": []}}'
    with pytest.raises(DrawingError, match=r"older compas_model: save it by compas_dem 0\.6"):
        compas.read(old, "m.json")
