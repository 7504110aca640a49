"""The reader of meshes: every format, what is cut short, too large, or no mesh at all."""

import struct
import sys

import numpy as np
import pytest

from rocking_cli.errors import InputError
from rocking_cli.io.drawings import mesh
from rocking_cli.io.drawings.contract import DrawingError
from tests.meshes import ascii_stl, box, obj, ply, stl

BOX = box((0.0, 0.0, 0.0), (0.5, 1.0, 2.0))
FILES = {
    "a.obj": obj(BOX),
    "b.ply": ply(BOX),
    "c.ply": ply(BOX, "binary_little_endian"),
    "d.ply": ply(BOX, "binary_big_endian"),
    "e.stl": stl(BOX),
    "f.stl": ascii_stl(BOX),
}


@pytest.mark.parametrize("name", FILES)
def test_every_format_has_the_triangles_of_the_box(name):
    found = mesh.read(FILES[name], name)
    assert found.format == name[2:].upper()
    assert np.array_equal(found.points[found.triangles], BOX[0][BOX[1]])
    assert mesh.sniff(FILES[name], "")  # by its content alone
    if name != "a.obj":  # which has no end
        with pytest.raises(DrawingError, match="cut short"):
            mesh.read(FILES[name][: len(FILES[name]) * 2 // 3], name)


def test_faces_of_four_corners_seams_of_texture_and_objects_are_read():
    corners = b"o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n"
    found = mesh.read(corners + b"f 1/1 2/1 3/1 4/1\no b\nv 0 0 1\nf -1/2 1/2 2/2\n", "q.obj")
    assert len(found.triangles) == 3
    area = np.linalg.norm(np.cross(*(found.points[found.triangles[:, k]] - found.points[found.triangles[:, 0]]
                                     for k in (1, 2))), axis=1)  # fmt: skip
    assert sorted(area) == [1.0, 1.0, 1.0]
    ascii_quads = ply(BOX).replace(b"element face 12", b"element face 1").split(b"\n3 ")[0] + b"\n4 0 1 3 2\n"
    assert len(mesh.read(ascii_quads, "q.ply").triangles) == 2


def test_points_of_no_face_are_read():
    for content, name in ((FILES["a.obj"] + b"v 9 9 9\n", "a.obj"), (b"vn 0 0 1\nv 9 9 9\n" + FILES["a.obj"], "a.obj")):
        assert len(mesh.read(content, name).points) == 9


def test_indices_of_obj_may_count_back_from_the_face():
    points = FILES["a.obj"].split(b"f ")[0]
    faces = "".join(f"f {a - 8} {b - 8}/7 {c - 8}//1 # back\n" for a, b, c in BOX[1]).encode()
    found = mesh.read(points + faces + b"o two\n" + points + faces, "a.obj")
    assert np.array_equal(found.triangles, np.concatenate([BOX[1], BOX[1] + 8]))


@pytest.mark.parametrize("name", ["a.obj", "b.ply"])
def test_points_without_faces_are_a_cloud(name):
    content = obj((BOX[0], BOX[1][:0])) if name == "a.obj" else ply((BOX[0], BOX[1][:0]))
    found = mesh.read(content, name)
    assert (found.points.shape, found.triangles.shape) == ((8, 3), (0, 3))


@pytest.mark.parametrize(
    ("name", "content", "refused", "words"),
    [
        ("a.obj", b"hello\n", "empty", "has no points"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n", "damaged", "is damaged or cut short"),
        ("a.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "damaged", "coordinates that are not numbers"),
        ("a.ply", ply(BOX).replace(b"face 12", b"face 999999999999"), "cut", "and 999,999,999,999 faces"),
        ("a.ply", ply(BOX).rsplit(b"\n", 3)[0], "cut", "announces 8 points and 12 faces, and has 8 and 10"),
        ("a.stl", b"x" * 80 + struct.pack("<I", 4 * 10**9) + b"x" * 999, "cut", "announces 4,000,000,000"),
        ("a.stl", ascii_stl(BOX).rsplit(b"\n", 9)[0], "cut", "does not end the solid"),
        ("a.stl", ascii_stl(BOX).replace(b"vertex", b"", 1), "damaged", "is damaged"),
        ("a.stl", stl(BOX) + b"x" * 50, "damaged", "has more data than the 12 faces"),
        ("a.stl", stl((BOX[0], BOX[1][:0])), "empty", "has no triangles"),
        ("a.ply", ply(BOX) + b"3 0 1 2\n", "damaged", "has more data than the 8 points and 12 faces"),
        ("a.obj", b"v 0 0 0\n" * 3 + b"f 0 1 2\n", "damaged", "a point that does not exist"),
        ("a.obj", b"v 0 0 0\n" * 3 + b"f 1 2\n", "damaged", "fewer than three"),
        ("a.obj", b"v 0 0 x\n" * 3 + b"f 1 2 3\n", "damaged", "is damaged"),
        ("a.obj", b"v 0 0 0\n" * 3 + b"f 1 2 x\n", "damaged", "not whole numbers"),
        ("a.obj", b"v 0 0 0\n".ljust(mesh.MAX_TEXT_BYTES + 1), "too_large", "has 64 MB"),
    ],
)
def test_what_is_no_mesh_is_refused(name, content, refused, words):
    with pytest.raises(DrawingError, match=words) as caught:
        mesh.read(content, name)
    assert (caught.value.refused, str(caught.value).startswith(f"{name}: ")) == (refused, True)


def test_points_and_triangles_are_bounded(monkeypatch):
    monkeypatch.setattr(mesh, "MAX_COUNT", 7)
    for name in ("a.obj", "c.ply", "e.stl", "f.stl"):
        with pytest.raises(DrawingError, match="has 12 triangles") as caught:
            mesh.read(FILES[name], name)
        assert caught.value.refused == "too_large"
    for content, of in ((b"f" + b" 1" * 10, "8 triangles"), (b"v 0 0 0\n" * 7, "8 points")):
        with pytest.raises(DrawingError, match=f"has {of}"):
            mesh.read(b"v 0 0 0\n" + content, "a.obj")


def test_other_drawings_are_not_taken_for_meshes():
    for content in (b"  0\nSECTION\n  2\nHEADER\n", b"<svg/>", b'{"type": "Feature"}', b"x,y\n0,0\n", b""):
        assert not mesh.sniff(content, ".dxf")


@pytest.mark.parametrize("package", ["trimesh", "shapely"])
def test_without_a_package_the_extra_is_told(monkeypatch, package):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=r"rocking-cli\[mesh\]"):
        mesh.read(FILES["b.ply"], "b.ply")
