"""CSV of vertices: spellings of one table, outlines, and files that are refused."""

from math import pi

import pytest

from rocking_cli.io.drawings import csv_vertices
from tests.io.drawings.areas import area

BLOCK = [0, 0.6, 0.6 + 2.4j, 2.4j]


def drawn(text):
    return csv_vertices.read(text.encode(), "x.csv")


@pytest.mark.parametrize("text", [
    "0,0\n.6,0\n.6,2.4\n0,2.4\n0,0",
    "\ufeffx;y\r\n0;0\r\n0,6;0\r\n0,6;2,4\r\n0;2,4\r\n0;0\r\n",
    "# a block\n\nX [m]\tY [m]\n0\t0\n0,6\t0\n# its top\n0,6\t2,4\n0\t2.4\n\n\n",
    "0 0\n0.6 0\n 0.6   2.4\n0 2.4",
    '"y_m","x_m","bulge"\n0,0,\n0,6e-1,0\n2.4,+.6,\n"2.4","0",""',
    "y;note;x\n0;a;0\n0;;0,6\n2,4;b,c;0,6;;\n2,4\t;d;0",
])  # fmt: skip
def test_a_table_is_the_same_in_every_spelling(text):
    drawing = drawn(text)
    (chain,) = drawing.chains
    assert chain.points.tolist() == BLOCK and chain.closed and not chain.bulges.any()
    assert (chain.kind, chain.layer, chain.handle, drawing.unit) == ("outline", "", "", None)
    assert len(drawing.left_out) == ("note" in text)
    assert csv_vertices.sniff(text.encode(), ".csv")


def test_blank_lines_end_an_outline_and_two_corners_are_a_line():
    chains = drawn("0,0\n1,0\n1,1\n\n \n5,5\n6,5\n").chains
    assert [(len(each.points), each.closed) for each in chains] == [(3, True), (2, False)]


@pytest.mark.parametrize("heading", ["outline", "Body", "NAME"])
def test_rows_of_an_outline_have_its_name_and_layer(heading):
    drawing = drawn(f"{heading};layer;x;y\nb1;M,<u>;0;0\n\nb1;M,<u>;2;0\nb1;M,<u>;0;1\nb2;;5;5\nb2;;7;5\nb2;;7;8\n")
    assert [(each.handle, each.layer, len(each.points)) for each in drawing.chains] == [
        ("b1", "M,<u>", 3),
        ("b2", "", 3),
    ]
    one, two = drawing.labels
    assert (one.text, two.text, one.layer) == ("b1", "b2", "M,<u>")
    assert one.at.real + 2 * one.at.imag < 2 and one.at.real > 0 and one.at.imag > 0


def test_bulges_make_arcs():
    (circle,) = drawn("x,y,bulge\n0,0,1\n2,0,1\n").chains
    (top,) = drawn("bulge,x,y\n0,0,0\n0,1,0\n1,1,3\n0,0,3\n7,0,0\n").chains
    assert circle.closed and area(circle) == pytest.approx(pi)
    assert area(top) == pytest.approx(3.392699082, rel=1e-9)


@pytest.mark.every(3)
@pytest.mark.parametrize(("text", "refused", "words"), [
    ("", "empty", "the file is empty"), ("\n \n# 1,2\n", "empty", "no rows"), ("x,y\n", "empty", "no rows of numbers"),
    ("a,b\n1,2\n", "not_csv", "x.csv:1: the headings have no x and y: `a, b`"),
    ("x,y,name,body\n1,2\n", "not_csv", "two columns, `body` is the second"),
    ("x,y\n1,2\n3,z\n", "not_csv", "x.csv:3: y is `z`, which is not a number"),
    ("x,y\n1,5,2,5\n", "not_csv", "x.csv:2: the row has 4 cells instead of 2\n.*semicolons"),
    ("1,2,3\n1,2,3\n", "not_csv", "more columns need headings"),
    ("x,y\n٣,2\n", "not_csv", "not a number"), ("x,y\n1e999,2\n", "number", "x.csv:2: x is beyond 1e\\+12"),
    ("1,2\n", "not_csv", "x.csv:1: the outline that starts here has one corner"),
    ("x,y,body\n1,2,a\n2,3,a\n4,4,b\n4,5,b\n3,3,a\n", "not_csv", "x.csv:6: the outline `a` begins a second time"),
    ("x,y,layer\n1,2,a\n2,3,b\n", "not_csv", "x.csv:3: the outline is on two layers, `a` and `b`"),
    ('x,y\n"1,2\n', "not_csv", "x.csv:2: the row is not valid CSV"), ("x,y\n\0", "not_csv", "binary"),
])  # fmt: skip
def test_bad_tables_are_refused_with_class_and_place(text, refused, words):
    with pytest.raises(csv_vertices.DrawingError, match=words) as caught:
        drawn(text)
    assert caught.value.refused == refused


def test_encodings():
    text = "x;y;name\n0;0;è\x1b<b>\n1;0;è\x1b<b>\n"
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        assert csv_vertices.read(text.encode(encoding), "x").labels[0].text == "è\x1b<b>"
    assert csv_vertices.read(text.replace("\x1b", "").encode("cp1252"), "x").labels[0].text == "è<b>"
    with pytest.raises(csv_vertices.DrawingError, match="x:2: not UTF-8 text"):
        csv_vertices.read(text.encode("latin-1"), "x")


@pytest.mark.parametrize(("data", "ending", "claimed"), [
    (b"", ".csv", True), (b"name,x,y\nb1,0,1.5", ".txt", True), (b"1 2", ".dat", False), (b"1 2", ".tsv", True),
    (b"  0\nSECTION\n  2\nHEADER\n", ".txt", False), (b"Dear all,\nsee you at 5.", ".txt", False),
    ("x;y\n0,5;1".encode("utf-16"), ".csv", True), (b"\0" * 50 + b"\xff", ".txt", False),
])  # fmt: skip
def test_sniff_takes_rows_of_numbers_alone(data, ending, claimed):
    assert csv_vertices.sniff(data, ending) == claimed
