"""What a survey of a list hands over: a document by rooms and cards, whose words and colours agree with the numbers."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Text

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.names import percent
from rocking_cli.processing.oscillator import Floor
from rocking_cli.questions.survey import director, portraits
from rocking_cli.questions.survey.inventory import Inventory
from rocking_cli.questions.survey.remedies import Remedy
from rocking_cli.questions.survey.structure_table import table_of
from rocking_cli.questions.survey.study import Topples
from rocking_cli.questions.survey.study import survey as study
from rocking_cli.questions.survey.wording import (
    DANGERS,
    SurveyedObject,
    advice,
    in_words,
    objects,
    printed,
    topples_from,
    topples_share,
)
from rocking_cli.studies.conclusion import NeighbourShare
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.provenance import File, TitleBlock
from rocking_cli.views.sheet.document import Drawing, Sentence
from rocking_cli.views.sheet.language import plain
from rocking_cli.views.view import Table
from tests.cli.test_cli import ACCEL, run, some
from tests.conftest import EXAMPLES
from tests.questions.verify.test_sheet_italian import english_words

EXAMPLE = EXAMPLES / "survey" / "collection.csv"
MISTAKES = {
    "11,Bust of a poet,62,34,28,40,": "11,Bust of a poet,62,34,28,400,",
    "12,Lid of a chest,35,": "12,Lid of a chest,,",
}
ITALIAN = EXAMPLES / "survey" / "collezione.csv"
SYMBOLS = re.compile(r"[λφηκζ]|\b(lambda|eta|phi|kappa)\b|\bp\b")
STRANGE = "=SUM(A1)", "a|b||c", '"quoted" \U0001f600', "_[x]^[2] `code` $x$ <b>&amp;", "# Heading <x>", "@0 !! {{ 1 }}"


def surveyed(file, motions=None, neighbours=60):
    motion = read_record(ACCEL) if motions is None else motions
    return study(table_of(file, None), [motion], around=Neighbourhood(neighbours))


def with_mistakes(folder):
    """Write the example with a weight that is ten times too large, and without a height."""
    text, file = EXAMPLE.read_text(encoding="utf-8"), folder / "collection.csv"
    for right, wrong in MISTAKES.items():
        assert right in text
        text = text.replace(right, wrong)
    file.write_text(text, encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def collection(tmp_path_factory):
    return surveyed(with_mistakes(tmp_path_factory.mktemp("list")))


def document(collection, key="en"):
    return director.document(
        collection, TitleBlock("rocking survey", "1 May 2026"), [File("list.csv", b"")], printed(key)
    )


def parts_of(sheet):
    return {part.key: part for part in sheet.parts}


def tables(part):
    return [item for item in part.items if isinstance(item, Table)]


def texts(part):
    """All that a section prints, its pictures too."""
    for item in part.items:
        if isinstance(item, Table):
            yield from (item.title, *item.columns, *(cell for row in item.rows for cell in row))
        elif isinstance(item, Drawing):
            yield item.label
            yield from (each.get_text() for each in item.figure().findobj(Text))
        else:
            yield item.text
    yield part.heading


def sentences(part):
    return [item.text for item in part.items if isinstance(item, Sentence)]


class TestDocument:
    def test_the_counts_are_those_of_the_rows(self, collection):
        sheet = document(collection)
        parts = parts_of(sheet)
        counts = [sum(row.danger == danger for row in collection.rows) for danger in DANGERS]
        assert all(counts) and sum(counts) == 12
        first = parts["answer"].items[0]
        assert first.answers and first.fails
        assert first.text == (
            f"Of 12 objects, {counts[0]} are likely to fall, {counts[1]} may fall, and {counts[2]} stand."
        )
        urgent, by_room = tables(parts["answer"])
        assert [sum(map(int, column)) for column in [*zip(*by_room.rows, strict=True)][1:]] == counts
        assert len(urgent.rows) == counts[0] + counts[1]
        assert [row[0] for row in by_room.rows] == ["Hall", "Gallery", "Library", "without a room"]
        rows = [row for key, part in parts.items() if key.startswith("room-") for row in tables(part)[0].rows]
        assert {row[0]: row[2] for row in rows} == {
            collection.items[each.row - 1].code: each.danger for each in collection.rows
        }

    def test_a_table_of_a_room_says_what_was_computed(self, collection):
        (table,) = tables(parts_of(document(collection))["room-1"])
        cells = {row[0]: row[3:] for row in table.rows}
        for each in collection.rows:
            item = collection.items[each.row - 1]
            if item.room != "Hall":
                continue
            for level, cell in zip((0.05, 0.5), cells[item.code], strict=False):
                pga, _ = each.toppled_from(level)
                assert ("> " in cell) == (pga is None)
                assert pga is None or float(cell.removesuffix(" g")) == pytest.approx(
                    pga, abs=0.051 if pga >= 1 else 0.0051
                )
            share = each.topples[0].share
            assert cells[item.code][3] == percent(share.highest) or share.lowest != share.highest

    def test_rows_that_were_not_used_and_questions_are_named(self, collection):
        parts = parts_of(document(collection))
        assert tables(parts["unused"])[0].rows == [["13", "12 Lid of a chest", "Height (cm) is missing"]]
        ((number, name, question),) = tables(parts["questions"])[0].rows
        assert (number, name) == ("11", "Bust of a poet") and question.startswith("it weighs 400 kg, but solid plaster")
        said = " ".join(sentences(parts["answer"]))
        assert "could not be used: 1" in said and "Questions on the list: 1" in said
        assert "One record is one sample" in said and "0.55 g" in said and "60 cases" in said

    def test_doubts_about_sizes_are_questions_too(self, collection):
        doubtful = replace(collection, rows=[replace(collection.rows[0], doubt="height is 0.005 m: did you mean 5 m?")])
        rows, italian = (tables(parts_of(document(doubtful, key))["questions"])[0].rows for key in ("en", "it"))
        assert rows[0][2] == "height is 0.005 m: did you mean 5 m?" and len(rows) == 2
        assert italian[0][2] == "Insolito o mancante: height."

    @pytest.mark.parametrize("key", ["en", "it"])
    def test_symbols_are_in_the_appendix_alone(self, collection, key):
        sheet = document(collection, key)
        for part in sheet.parts[:-1]:
            assert not SYMBOLS.search(" ".join(texts(part))), part.key
        assert sheet.parts[-1].key == "appendix" and "λ" in " ".join(texts(sheet.parts[-1]))

    def test_the_italian_document_has_no_english_word_and_decimal_commas(self):
        sheet = document(surveyed(ITALIAN, neighbours=60), "it")
        english = english_words(("rocking_cli.questions.survey",))
        italian = " ".join(ITALIAN.read_text(encoding="utf-8").split()).lower()
        for part in sheet.parts[:-1]:
            for text in texts(part):
                strange = {each for each in re.findall(r"[^\W\d_]{2,}", text.lower()) if each in english}
                assert not {each for each in strange if each not in italian}, text
                assert not re.search(r"\d\.\d", text), text
        assert [part.heading for part in sheet.parts] == ["La risposta", "Sala 1", "Sala 2", "Biblioteca", "Appendice"]

    def test_what_the_list_leaves_open_is_translated(self, tmp_path):
        sides = "Height (cm),Width (cm),Depth (cm),Foot width (cm),Weight (kg)"
        head = f"Inv. no.,Object,{sides},Material,Support,Storey,Dimensions\n"
        rows = [
            '1,Vase,40,50,60,,,,"floor, edge 0 cm",second,', "1,Block,80,30,30,40,,,balcony,attic,",
            '2,Slab,80,30,30,,0.3,marble,"shelf 1 m up, edge 5 cm, felt",,', "3,Slab,80,30,30,,9999,,table,,",
            "4,Slab,,,,,500,marble,floor,,180 x 60 x 20 cm", "5,Slab,many,30,30,,,,floor,,",
            "6,Slab,-3,30,30,,,,floor,,",
            "7,Slab,80,,,,,,floor,,", "8,Slab,80,30,30,,,,on 99,,", '9,Slab,80,30,30,,,,"wax 20 cm2",,',
            '10,Slab,80,30,30,,9,,"wax 20 cm2",,', '11,Slab,80,30,30,,9,,"isolator 2 s",,',
            "12,Slab,80,30,30,,,,on 13,,",
            "13,Slab,80,30,30,,5,,floor,,", "14,Lid,30,90,90,,,,floor,,", '15,Slab,80,30,30,,5,,"on 13, gap 5 cm",,',
            '16,Slab,80,30,30,,,,"floor, edge 5 cm",,',
        ]  # fmt: skip
        file = tmp_path / "list.csv"
        file.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
        inventory, say = table_of(file, None), printed("it")
        assert isinstance(inventory, Inventory)
        texts_ = {text for each in inventory.items for text in (*each.remarks, *each.questions)}
        assert len(texts_) >= 14
        bad = study(inventory).bad
        assert len(bad) == 9
        english = english_words(("rocking_cli.questions.survey",)) - {"slab", "many", "marble", "height", "width"}
        for text in [*texts_, *(each.reason for each in bad)]:
            italian = say.recognised("shown", text)
            told = re.sub(r"'[^']*'|^\w+: |[A-Z]\w+ \(\w+\)|balcony|attic|Weight|\bSupport\b|felt", "", italian)
            assert italian != text and not {*re.findall(r"[^\W\d_]{3,}", told)} & english, (text, italian)

    def test_a_hundred_objects_and_strange_names_are_all_there(self, collection, tmp_path):
        lines = ["Number;Object;Height (cm);Width (cm);Room"]
        for k in range(100):
            name = STRANGE[k % len(STRANGE)].replace('"', '""')
            lines.append(f'N{k};"{name}";{60 + k};{30 + k % 5};"{STRANGE[k % 2] if k % 4 else ""}"')
        file = tmp_path / "list.csv"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        weak = read_record(ACCEL).scaled(0.01)
        many = surveyed(file, weak)
        sheet = document(many)
        rooms = [part for part in sheet.parts if part.key.startswith("room-")]
        rows = [row for part in rooms for row in tables(part)[0].rows]
        assert sorted(row[0] for row in rows) == sorted(f"N{k}" for k in range(100))
        assert {row[1] for row in rows} == {plain(each.title) for each in many.items} and len(rooms) == 3
        for part in rooms:
            drawn = [item for item in part.items if isinstance(item, Drawing)]
            assert len(drawn) == -(-len(tables(part)[0].rows) // director.DRAWN_TOGETHER)
            codes = [each.get_text() for item in drawn for each in item.figure().findobj(Text)]
            assert {row[0] for row in tables(part)[0].rows} <= {*codes}
        from rocking_cli.documents.sheet_typst import page_pictures

        pytest.importorskip("typst")
        assert len(page_pictures(sheet, 10)) < 25


class TestWords:
    @pytest.mark.parametrize(
        ("remedy", "words"),
        [
            (Remedy("base", True, {"wider": 0.108}), "a base that is 11 cm wider, 5.5 cm on each side"),
            (Remedy("ballast", True, {"mass": 11.62}), "12 kg of sand or weights in its foot"),
            (Remedy("wires", True, {"force": 395.0, "height": 1.2}), "wires that hold 400 N at a height of 1.2 m"),
            (Remedy("wires", True, {"force": 1400.1, "height": 1.2}), "wires that hold 1.5 kN at a height of 1.2 m"),
            (Remedy("wires", True, {"force": 1.0, "height": 1.2}, against=True),
             "do not tie it or stick it down: slender and brittle, it may crack"),
            (Remedy("wax", None, {"pull": 2750.0, "shear": 1290.0}),
             "wax under its foot that holds 2.8 kN of pull and 1.3 kN of shear, by its maker"),
            (Remedy("wax", True, {"pull": 0.0, "shear": 90.0, "area": 0.00399}),
             "wax under its foot that holds 90 N of shear on 40 cm2"),
            (Remedy("wax", False, {"pull": 1.0, "shear": 90.0, "area": 0.4}),
             "wax would need 4000 cm2, more than its foot has"),
            (Remedy("slide", True, {"friction": 0.169, "clearance": 0.0121}),
             "let it slide: friction of at most 0.16, and 1.5 cm of free space all around"),
            (Remedy("slide", False, {"friction": 0.169, "clearance": 0.131}),
             "sliding needs 14 cm of free space, more than it has"),
            (Remedy("isolate", True, {"period": 2.5, "stroke": 0.1431}),
             "an isolator with a period of 2.5 s and a stroke of 15 cm"),
            (Remedy("none", False), "none of the remedies that were tried suffices"),
        ],
    )  # fmt: skip
    def test_a_remedy_in_words_has_conservative_numbers(self, remedy, words):
        assert in_words(remedy, printed("en")) == words
        italian = in_words(remedy, printed("it"))
        assert italian != words and not re.search(r"\d\.\d", italian)
        assert [*map(float, re.findall(r"[\d.]+\d|\d", words.replace("cm2", "")))] == [
            float(each.replace(",", ".")) for each in re.findall(r"[\d,]+\d|\d", italian.replace("cm2", ""))
        ]

    def test_advice_names_what_suffices_and_what_harms(self, collection):
        one, say = objects(collection)[0], printed("en")
        base, slide = Remedy("base", True, {"wider": 0.1}), Remedy("slide", True, {"friction": 0.1, "clearance": 0.1})
        wires = Remedy("wires", True, {"force": 1.0, "height": 1.0}, against=True)
        wax, nothing = Remedy("wax", None, {"pull": 1.0, "shear": 1.0}), Remedy("none", False)

        def of(*remedies, on="", most=None, slip=0.0):
            return advice(
                SurveyedObject(
                    replace(one.item, on=on),
                    replace(one.found, remedies=remedies, clearance=slip),
                ),
                say,
                most,
            )

        assert of(slip=0.0) == "nothing to do" and of(slip=0.111) == "it slides: keep 12 cm free all around"
        assert of(base, slide, most=1) == "a base that is 10 cm wider, 5 cm on each side"
        assert "; or let it slide" in of(base, slide)
        assert of(wires, base).endswith("each side; do not tie it or stick it down: slender and brittle, it may crack")
        assert of(base, on="7").endswith("each side, with 7 fixed")
        assert of(wax, nothing).startswith("wax under") and of(wax, nothing).endswith("tried suffices")
        assert "wax" not in of(wax, base)

    def test_bounds_of_what_topples_are_marked(self, collection):
        def of(*factors, pga=1.0):
            topples = [Topples(str(k), pga, 1.0, {0.05: each}, (0.2, 5.0), NeighbourShare(0.1, 0.1 * k, 9), pga)
                       for k, each in enumerate(factors, 1)]  # fmt: skip
            return replace(collection.rows[0], topples=topples)

        english, italian = printed("en"), printed("it")
        for factors, words in (((0.21,), "0.21 g"), ((None,), "> 5.0 g"), ((0.2,), "below 0.20 g"),
                               ((0.5, 0.3), "0.30 to 0.50 g"), ((0.3, None), "0.30 to > 5.0 g"),
                               ((0.2, 1.25), "below 0.20 to 1.2 g"), ((None, None), "> 5.0 g")):  # fmt: skip
            assert topples_from(of(*factors), 0.05, english) == words
        assert topples_from(of(0.5, 0.3), 0.05, italian) == "da 0,30 a 0,50 g"
        assert topples_share(of(1.0, 1.0, 1.0), english) == "10 to 30 %"
        assert topples_share(of(1.0), italian) == "10 %"


class TestPictures:
    def test_colours_hatches_and_words_are_those_of_the_classes(self, collection):
        say, every = printed("en"), objects(collection)
        assert [*portraits.LOOKS] == [*DANGERS]
        assert len({look["facecolor"] for look in portraits.LOOKS.values()}) == 3
        assert len({look["hatch"] for look in portraits.LOOKS.values()}) == 3
        for each in every:
            figure = portraits.draw_room([each], say, portraits.scale_of([each]))
            (axes,) = figure.axes
            looks = [(to_hex(patch.get_facecolor()), patch.get_hatch() or "") for patch in axes.patches]
            wanted = portraits.LOOKS[each.danger]
            assert (wanted["facecolor"], wanted["hatch"]) in looks
            others = [look["facecolor"] for danger, look in portraits.LOOKS.items() if danger != each.danger]
            assert not {colour for colour, _ in looks} & {*others}
            words = [text.get_text() for text in axes.texts]
            assert each.item.code in words and each.danger in words

    def test_objects_of_a_room_have_one_scale_and_stay_in_the_picture(self, collection):
        every = objects(collection)
        scale = portraits.scale_of(every[:8])
        figure = portraits.draw_room(every[:8], printed("en"), scale)
        (axes,) = figure.axes
        coloured = {to_hex(look["facecolor"]) for look in portraits.LOOKS.values()}
        drawn = [each for each in axes.patches if to_hex(each.get_facecolor()) in coloured]
        heights = [each.get_path().get_extents().height for each in drawn]
        assert heights == pytest.approx([scale * each.item.height for each in every[:8]])
        assert all(patch.get_path().get_extents().x1 <= axes.get_xlim()[1] + 1e-9 for patch in axes.patches[2:])

    def test_a_card_for_each_object(self, collection):
        every = sorted(objects(collection), key=lambda each: each.item.line)
        for start in (0, 10):
            drawn = portraits.draw_cards(every[start : start + 10], printed("it"))
            words = [each.get_text() for each in drawn.findobj(Text)]
            for each in every[start : start + 10]:
                assert each.item.code in words and each.item.title in words
        assert words.count("resta in piedi") + words.count("cade") + words.count("può cadere") == 2


class TestFiles:
    @pytest.fixture(autouse=True)
    def here(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("list.csv").write_text("Object,Height (cm),Width (cm),Room\nTall,200,30,A\nLow,50,50,\n", "utf-8")
        Path("blocks.csv").write_text("mechanism,name,width,height\nblock,a,0.5,2\n", "utf-8")

    def test_document_and_cards_are_written(self):
        pytest.importorskip("typst")
        words = ("survey", "list.csv", "--record", ACCEL, "--neighbours", 60, "--language", "it")
        shown = run(*words, "--page", "c.pdf", "--labels", "l.pdf")
        assert "scritto c.pdf" in shown.stderr and "scritto l.pdf" in shown.stderr
        assert Path("c.pdf").read_bytes()[:5] == Path("l.pdf").read_bytes()[:5] == b"%PDF-"
        assert len(re.findall(rb"/Type /Page\b", Path("l.pdf").read_bytes())) == 1
        before = Path("l.pdf").read_bytes()
        run(*words, "--labels", "l.pdf")
        assert Path("l.pdf").read_bytes() == before

    def test_twelve_cards_are_two_pages_and_a_word_processor_has_the_document(self):
        docx = pytest.importorskip("docx")
        motion = "--record", ACCEL, "--scale", 0.05, "--neighbours", 60
        some("survey", with_mistakes(Path()), *motion, "--page", "c.docx", "--labels", "l.pdf")
        assert len(re.findall(rb"/Type /Page\b", Path("l.pdf").read_bytes())) == 2
        written = docx.Document("c.docx")
        assert any("likely to fall" in each.text for each in written.paragraphs) and len(written.inline_shapes) == 4

    @pytest.mark.parametrize(
        ("words", "said"),
        [
            (("blocks.csv", "--record", ACCEL, "--page", "c.pdf"), "--page c.pdf is for a list of objects, with"),
            (("blocks.csv", "--record", ACCEL, "--labels", "c.pdf"), "--labels c.pdf is for a list of objects"),
            (("list.csv", "--page", "c.pdf"), "59 neighbours or more: give ground motions"),
            (("list.csv", "--labels", "c.pdf"), "requires ground motions"),
            (("list.csv", "--record", ACCEL, "--neighbours", "0", "--labels", "c.pdf"), "leave out --neighbours"),
            (("list.csv", "--record", ACCEL, "--labels", "c.png"), "does not end in .pdf"),
            (("list.csv", "--record", ACCEL, "--page", "c.png"), "does not end in .html or .pdf or .docx"),
            (("list.csv", "--record", ACCEL, "--page", "c.pdf", "--labels", "c.pdf"), "c.pdf"),
        ],
    )  # fmt: skip
    def test_what_cannot_be_handed_over_is_refused_before_any_work(self, words, said, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.survey.study.survey", lambda *_, **__: pytest.fail("worked"))
        assert said in " ".join(run("survey", *words, code=2).stderr.split())
        assert not Path("c.pdf").exists()

    def test_without_what_makes_a_pdf_nothing_is_computed(self, monkeypatch):
        def none():
            raise InputError("no browser")

        monkeypatch.setattr("rocking_cli.questions.verify.sheets.find_spec", lambda _: None)
        monkeypatch.setattr("rocking_cli.questions.verify.sheets.browser", none)
        monkeypatch.setattr("rocking_cli.questions.survey.study.survey", lambda *_, **__: pytest.fail("worked"))
        assert "no browser" in run("survey", "list.csv", "--record", ACCEL, "--page", "c.pdf", code=2).stderr

    def test_cards_that_are_interrupted_leave_the_former_ones(self, monkeypatch):
        Path("l.pdf").write_bytes(b"before")

        def stop(*_):
            raise KeyboardInterrupt

        monkeypatch.setattr(portraits, "draw_cards", stop)
        with pytest.raises(KeyboardInterrupt):
            rk.survey("list.csv", motions=ACCEL, neighbours=60, labels="l.pdf")
        assert Path("l.pdf").read_bytes() == b"before" and sorted(each.name for each in Path().iterdir()) == [
            "blocks.csv", "l.pdf", "list.csv"
        ]  # fmt: skip

    def test_the_html_page_is_as_before(self):
        run("survey", "list.csv", "--record", ACCEL, "--neighbours", 2, "--page", "c.html")
        assert "<table" in Path("c.html").read_text(encoding="utf-8")


def test_objects_on_upper_floors_are_told_unless_a_floor_carries_the_motions(tmp_path):
    file = tmp_path / "list.csv"
    file.write_text("No,Object,Height (cm),Width (cm),Room\n1,Tall,200,60,second floor\n2,Low,90,50,A\n", "utf-8")
    on_ground = " ".join(sentences(parts_of(document(surveyed(file, neighbours=60)))["answer"]))
    assert "upper floors, but are shaken here as on the ground, which is less: 1." in on_ground
    floor = Floor(0.4, 0.05, 1.0, 9 / 7)  # of three storeys
    carried = study(table_of(file, floor), [read_record(ACCEL)], around=Neighbourhood(60))
    assert "upper floors" not in " ".join(sentences(parts_of(document(carried))["answer"]))


def test_what_falls_in_space_alone_is_named_on_the_first_page(tmp_path):
    pytest.importorskip("mujoco", reason="free blocks need MuJoCo")
    file = tmp_path / "list.csv"
    file.write_text("No,Object,Height (cm),Diameter (cm),Support\n1,Drum,200,50,friction 0.6\n", "utf-8")
    along, across = (parse_pulse(text).sampled() for text in ("sine:0.3g:1s", "sine:0.2g:0.76923s"))
    table, around = table_of(file, None), Neighbourhood(60)
    both = study(table, [along], around=around, in_space=True, transverse=[across])
    assert both.rows[0].danger != "falls"
    assert "fall in a simulation in three dimensions" in " ".join(sentences(parts_of(document(both))["answer"]))
    alone = study(table, [along], around=around, in_space=True)
    assert "three dimensions" not in " ".join(sentences(parts_of(document(alone))["answer"]))
