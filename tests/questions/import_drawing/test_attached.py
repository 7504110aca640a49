"""What the texts beside loads and ties say, and what is said of those that cannot be used."""

import pytest
import yaml

from rocking_cli.errors import InputError
from rocking_cli.io.drawings.contract import DrawingError
from tests.questions.import_drawing.sheets import box, imported, line, spot, text, words

PORTAL = [box(0, 0, 0.4, 3), box(3.6, 0, 0.4, 3), box(0, 3, 4, 0.6)]
WEIGHTS = {"density": {"": 2000.0}, "depth": 1.0}


def tied(label, start=(0.4, 2.5), end=(3.6, 0.5)):
    return imported(*PORTAL, line(start, end, "CATENE"), labels=[text(label, 2, 1.6, "CATENE")], **WEIGHTS)


@pytest.mark.parametrize(
    ("label", "said"),
    [
        ("bar: steel S235", "the tie bar lacks data (diameter is missing: give `diameter` with `bars` or `spacing`"),
        ("bar: area 452 mm2", "the tie bar lacks data (stiffness: give stiffness, or area and modulus"),
        ("bar: area 452 kg, modulus 210 GPa", "the tie bar lacks data (area: 452 kg is a mass, not an area)"),
        ("bar: area 4,52 cm2, yield 235 MPa", "the tie bar lacks data (diameter is missing"),
        ("tie rod", "the tie tie rod has no text with data, such as"),
    ],
)
def test_a_tie_whose_text_lacks_data_is_a_comment_with_its_place(label, said):
    found = tied(label)
    (note,) = [each for each in found.notes if "it is a comment in the file" in each.words]
    assert said in note.words and list(note.at) == [0.4 + 2.5j]
    (tie,) = yaml.safe_load(found.comments[0])["ties"]
    assert tie["to"] == {"body": "b2", "at": [3.6, 0.5]} and "ties" not in found.fields


def test_what_a_text_of_a_tie_says_besides_is_told():
    found = tied("bar: bars 2, diameter 6 mm; steel S235, only tension, see sheet 3")
    (tie,) = found.structure.ties
    assert (tie.name, tie.bars, tie.diameter, tie.steel, tie.only) == ("bar", 2, 0.006, "S235", "tension")
    assert "of the tie bar, see sheet 3 was not understood" in words(found)
    assert "was not understood" in words(tied("bar: area 4,52 cm2, yield 235 MPa"))
    assert "not understood" not in words(tied("bar: area 452 mm2, modulus 210 GPa"))


@pytest.mark.parametrize("label", ["2\u00d86 S235", "catena 2 \u00f8 6 mm, steel S235", "2\u23006, S235 only tension"])
def test_bars_and_steel_as_drawings_write_them(label):
    (tie,) = tied(label).structure.ties
    assert (tie.bars, tie.diameter, tie.steel) == (2, 0.006, "S235")


def test_texts_outside_bodies_are_counted():
    labels = [text("SEZIONE A-A", 9, 9), text("8.00", 9, 8, "QUOTE"), text("9.00", 9, 7, "QUOTE"), text("low", 0.2, 1)]
    said = words(imported(*PORTAL, labels=labels, **WEIGHTS))
    assert "left out: 1 TEXT on TESTI" in said and "left out: 2 TEXT on QUOTE" in said


def test_a_tie_on_one_body_is_a_comment_and_one_that_nothing_stretches_has_a_hint():
    found = tied("bar: stiffness 1 kN/m", (0.1, 2.5), (0.3, 0.5))
    assert "the tie bar has all its points on b1, so that nothing stretches it: it is a comment" in words(found)
    with pytest.raises(InputError, match="no motion of the structure changes its length: move an end, or leave it out"):
        imported(
            box(0, 0, 2, 1), box(0.8, 1, 0.4, 3), line((-1, 0), (3, 0), "GROUND"), line((-1, 0), (0.0, 0.5), "CATENE"),
            labels=[text("area 1 cm2, modulus 210 GPa", -0.5, 0.3, "CATENE")], **WEIGHTS,
        )  # fmt: skip


def test_a_mass_drawn_as_an_arrow_is_refused():
    arrow, words_beside = line((2, 4.5), (2, 3.6), "CARICHI"), text("roof 3 t", 2, 4.5, "CARICHI")
    with pytest.raises(DrawingError, match="3 t is a mass: draw it as a point, not as an arrow"):
        imported(*PORTAL, arrow, labels=[words_beside], **WEIGHTS)


def test_a_support_on_no_body_is_told_by_the_end_next_to_one():
    with pytest.raises(DrawingError, match=r"its nearer end is at \(5, 2.5\)") as caught:
        imported(*PORTAL, line((6, 2.5), (5, 2.5), "SOLAI"))
    assert caught.value.at == [[5.0, 2.5]]


def test_texts_of_loads_give_floor_shares_and_body():
    labels = [
        text("roof 3 t, floor sliding, seat 20 cm, body b1", 0.4, 3.0, "CARICHI"),
        text("snow 1 t, horizontal 0.5", 2, 3.6, "CARICHI"), text("weight 12 kN", 2, 4.5, "CARICHI"),
        text("see sheet 3", 2.02, 4.6, "CARICHI"),
    ]  # fmt: skip
    spots = [spot(0.4, 3.0, "CARICHI"), spot(2, 3.6, "CARICHI")]
    found = imported(*PORTAL, line((2, 4.5), (2, 3.6), "CARICHI"), spots=spots, labels=labels, **WEIGHTS)
    roof, snow, weight = found.structure.loads
    assert (roof.name, roof.mass, roof.floor, roof.seat, roof.body) == ("roof", 3000, "sliding", 0.2, "b1")
    assert (snow.horizontal, snow.vertical, snow.body) == (0.5, None, "b3")
    assert (weight.name, weight.force) == ("weight", [0, -12000])
    assert "the text 'see sheet 3' on CARICHI has no symbol of its own: it is left out" in words(found)
    labels[0] = text("roof 3 t, body left pier", 0.4, 3.0, "CARICHI")
    with pytest.raises(DrawingError, match="no body has the name 'left pier' that a load states"):
        imported(*PORTAL, line((2, 4.5), (2, 3.6), "CARICHI"), spots=spots, labels=labels, **WEIGHTS)
