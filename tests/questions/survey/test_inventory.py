"""Lists of objects: how they are read, what each object does, by hand on paper and beside `margin`, and what to do."""

from math import exp, isclose
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.processing.oscillator import Floor
from rocking_cli.questions.survey.inventory import Inventory, catalogue, plain
from rocking_cli.questions.survey.remedies import remedies
from rocking_cli.questions.survey.structure_table import table_of
from rocking_cli.studies.neighbours import Neighbourhood
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
G = 9.80665
SPREAD = exp(1.6448536269514722 * np.hypot(0.04, 0.10))
"""Amplitude over slenderness that one in twenty neighbours exceeds: 5 % of a lognormal of 4 % and 10 %."""
HEAD = "No.,Object,Height (cm),Width (cm),Depth (cm),Weight (kg),Material,Support,Room\n"


def items(text, floor=None, name="list.csv"):
    Path(name).write_text(text, encoding="utf-8")
    made = table_of(name, floor)
    assert isinstance(made, Inventory)
    return {each.code: each for each in made}


def item(cells, floor=None):
    """Return the one object of a row: sides in cm, kg, material, support, room."""
    (made,) = items(f"{HEAD}1,thing,{cells}\n", floor).values()
    return made


def lambda_of(mechanism):
    weaker = mechanism.weaker_side() or mechanism
    return min(weaker.uplift(side) for side in (1, -1))


class TestHeadings:
    @pytest.mark.parametrize(
        ("headings", "keys"),
        [
            ("Inv. no.,Object,Height (cm),Width [cm],Depth cm,Weight (kg)", "code name height width depth mass"),
            ("N. inv.,Oggetto,Altezza [cm],Larghezza (cm),Profondità (cm),Peso (kg)",
             "code name height width depth mass"),
            ("Accession number,Title,Overall height in cm,Diameter (cm),Medium", "code name height diameter material"),
            ("ID,Item,H (mm),W (mm),D (mm),Location", "code name height width depth room"),
            ("Codice,Opera,Altezza massima (cm),Diametro (cm),Diametro base (cm),Ubicazione,Materia",
             "code name height diameter foot room material"),
        ],
    )  # fmt: skip
    def test_words_of_two_languages_and_units_in_any_brackets(self, headings, keys):
        values = ",".join("7" for _ in headings.split(","))
        (made,) = items(f"{headings}\n{values}\n").values()
        assert list(made.inventory.places) == keys.split()
        assert made.wrong is None

    def test_no_word_means_two_fields(self):
        words = [each for some in catalogue()["headings"].values() for each in some]
        assert len(words) == len(set(words))
        assert all(plain(each) == each for each in words)

    def test_other_columns_are_kept_and_named_once_with_the_nearest_field(self):
        made = items("No,Name,Height (cm),Width (cm),Widht (cm),Donor\n1,a,200,50,40,x\n")["1"]
        (note,) = [each for each in made.inventory.notes if "not read" in each]
        assert "Widht (cm) (did you mean width?); Donor" in note
        answer = rk.survey("list.csv")
        assert answer.columns()["Donor"] == ["x"]

    def test_a_side_without_a_unit_is_refused(self):
        with pytest.raises(
            InputError, match=r"(?s)Height gives no unit, and 200 in line 2 has none.*write Height \(cm\)"
        ):
            items("No,Name,Height,Width (cm)\n1,a,200,50\n")

    def test_without_a_height_the_nearest_heading_is_named(self):
        Path("l.csv").write_text("No,Name,Heigth (cm),Width (cm)\n1,a,200,50\n", encoding="utf-8")
        result = run("survey", "l.csv", code=2)
        assert "Heigth" in result.stderr and "Traceback" not in result.stderr

    def test_a_table_with_mechanisms_is_no_list(self):
        Path("t.csv").write_text("mechanism,name,width,height\nblock,a,0.5,2\n", encoding="utf-8")
        assert not isinstance(table_of("t.csv", None), Inventory)

    def test_a_frame_is_read_as_its_file(self):
        columns = {"No": ["1"], "Name": ["a"], "Height (cm)": [200], "Width (cm)": [50.0], "Depth (cm)": [20]}
        assert isclose(rk.survey(columns).rows[0].lambda_, 0.1)


class TestSizes:
    @pytest.mark.parametrize(
        ("cell", "sizes"),
        [
            ("182 x 48 x 36", (1.82, 0.48, 0.36)),
            ("h. 182 x 48 x 36", (1.82, 0.48, 0.36)),
            ("182 × 48 × 36 cm", (1.82, 0.48, 0.36)),
            ("H. 182 W. 48 D. 36", (1.82, 0.48, 0.36)),
            ("1820 x 480 x 360 mm", (1.82, 0.48, 0.36)),
            ("48 (w) x 36 (d) x 182 (h) cm", (1.82, 0.48, 0.36)),
            ("H 1.82 m, W 48 cm, D 36 cm", (1.82, 0.48, 0.36)),
            ("l 48 x p 36 x h 182 cm", (1.82, 0.48, 0.36)),
            ("182 x 48 x 36 cm (71 5/8 x 18 7/8 x 14 in)", (1.82, 0.48, 0.36)),
        ],
    )
    def test_all_sides_in_a_cell(self, cell, sizes):
        made = items(f'No,Name,Dimensions (cm)\n1,a,"{cell}"\n')["1"]
        assert tuple(made.sizes[key] for key in ("height", "width", "depth")) == pytest.approx(sizes)

    @pytest.mark.parametrize(
        "cell",
        [
            "182-184 x 48 x 36",
            "1,820 x 480 x 360 mm",
            "71 5/8 x 18 7/8 x 14 in",
            "182 x 48 x 36 x 20",
            "2 parts: 182 x 48",
        ],
    )
    def test_sizes_in_a_cell_that_are_not_understood_are_refused(self, cell):
        assert items(f'No,Name,Dimensions (cm)\n1,a,"{cell}"\n')["1"].wrong is not None

    def test_a_diameter_in_a_cell_is_round(self):
        for cell in ("h. 68, diam. 16", "68 x Ø 16"):
            made = items(f'No,Name,Misure (cm)\n1,a,"{cell}"\n')["1"]
            assert made.is_round and made.sizes == {"diameter": 0.16, "height": 0.68}

    def test_cells_have_the_last_word_on_units_and_commas(self):
        made = items("No;Name;Altezza (cm);Larghezza (cm);Peso (kg)\n1;a;1,82 m;48,5;5,2\n")["1"]
        assert made.sizes == {"height": 1.82, "width": 0.485, "mass": 5.2}

    def test_a_weight_in_newtons_or_pounds(self):
        assert items("No,Name,Height (cm),Width (cm),Weight (lb)\n1,a,200,50,100\n")["1"].mass == pytest.approx(
            45.359237
        )
        assert items("No,Name,Height (cm),Width (cm),Weight (kN)\n1,a,200,50,1\n")["1"].mass == pytest.approx(1e3 / G)


class TestByHand:
    """Ten objects on paper."""

    def test_a_stele_rocks_about_its_depth(self):
        assert isclose(lambda_of(item("240,60,18,620,limestone,floor,G2").make()), 0.18 / 2.40)

    def test_a_bookcase_too_however_its_sides_are_called(self):
        assert isclose(lambda_of(item("220,90,35,140,oak,floor,L1").make()), 0.35 / 2.20)
        assert isclose(lambda_of(item("220,35,90,140,oak,floor,L1").make()), 0.35 / 2.20)

    def test_a_vase_on_its_foot(self):
        made = items("No,Name,Height (cm),Diameter (cm),Foot (cm),Weight (kg)\n1,vase,60,30,12,4\n")["1"].make()
        assert isclose(lambda_of(made), 0.12 / 0.60)
        # Half of m b^2 is that of a cylinder of radius 0.15 m: m (3 r^2 + h^2)/12 about the centroid, and m R^2 more.
        inertia = (3 * 0.15**2 + 0.60**2) / 12 + 0.06**2 + 0.30**2
        (body,) = made.bodies()
        assert isclose(body.inertia / body.mass + 0.06**2 + 0.30**2, inertia)

    def test_a_high_centre_of_gravity(self):
        made = items("No,Name,Height (cm),Width (cm),Depth (cm),Centre of gravity (cm)\n1,bust,100,40,40,70\n")[
            "1"
        ].make()
        assert isclose(lambda_of(made), 0.20 / 0.70)

    def test_a_narrow_foot_of_the_other_plane_governs(self):
        text = "No,Name,Height (cm),Width (cm),Depth (cm),Foot (cm),Foot depth (cm)\n1,a,100,40,40,40,10\n"
        assert isclose(lambda_of(items(text)["1"].make()), 0.10 / 1.00)

    def test_a_pedestal_under_a_vase(self):
        text = f"{HEAD}1,vase,60,20,20,5,clay,on 2,A\n2,pedestal,100,30,30,35,MDF,floor,A\n"
        made = items(text)
        height = (35 * 0.50 + 5 * 1.30) / 40
        assert isclose(lambda_of(made["2"].make()), 0.15 / height)
        # Of both, the weaker: here the pedestal, with the vase on it.
        assert isclose(lambda_of(made["1"].make()), min(0.20 / 0.60, 0.15 / height), rel_tol=1e-6)

    def test_three_on_each_other(self):
        text = f"{HEAD}1,vase,60,20,20,5,clay,on 2,A\n2,box,40,30,30,10,oak,on 3,A\n3,plinth,100,32,32,40,MDF,floor,A\n"
        made = items(text)
        whole = (40 * 0.50 + 10 * 1.20 + 5 * 1.70) / 55
        upper = (10 * 0.20 + 5 * 0.70) / 15
        assert isclose(lambda_of(made["3"].make()), 0.16 / whole)
        every = min(0.10 / 0.30, 0.15 / upper, 0.16 / whole)
        assert isclose(lambda_of(made["1"].make()), every, rel_tol=1e-6)
        assert isclose(lambda_of(made["2"].make()), min(0.15 / upper, 0.16 / whole), rel_tol=1e-6)

    def test_wires(self):
        # (m g b/2 + F z)/(m g h/2) = (100 9.80665 0.15 + 300 1.2)/(100 9.80665 0.75)
        held = item('150,30,40,100,bronze,"floor, wires 300 N at 1.2 m",G').holds_to()
        assert isclose(held, (100 * G * 0.15 + 300 * 1.2) / (100 * G * 0.75))

    def test_wax(self):
        # Pull of 20 cm2 at 40 kPa: 80 N, in the middle of a foot of 10 cm; shear of 20 cm2 at 30 kPa: 60 N.
        held = item('40,10,12,3,ceramic,"shelf, wax 20 cm2 40 kPa 30 kPa",G').holds_to()
        turning = (3 * G + 80) * 0.05 / (3 * G * 0.20)
        assert isclose(held, min(turning, 60 / (3 * G)))

    def test_slip_under_a_pulse(self):
        # A constant 0.4 g for 0.2 s over friction of 0.15: slip while it gains speed, and while it loses it.
        dt, pushed, mu = 1e-3, 0.2, 0.15
        samples = np.zeros(3001)
        samples[100 : 100 + int(pushed / dt)] = 0.4
        motion = rk.GroundMotion("step", dt, samples, unit="g")
        (row,) = rk.survey(items(f"{HEAD}1,case,120,95,95,180,glass,felt 0.15,G\n") and "list.csv", motion).rows
        faster = 0.25 * G * pushed
        slip = faster * pushed / 2 + faster**2 / (2 * mu * G)
        assert row.under.slip == pytest.approx(slip, rel=0.01)
        assert row.under.concluded.value == "slides"

    def test_an_isolator_ends_where_small_steps_say(self):
        # x.. = -2 xi w x. - w^2 x - a, by central differences of a tenth of a sample.
        made = item('140,40,40,95,bronze,"isolator 2 s, 10 %, 25 cm",G')
        motion, w, h, (x, v, largest) = rk.read_record(ACCEL), np.pi, 1e-3, (0.0, 0.0, 0.0)
        for push in np.interp(np.arange(0, motion.duration + 4, h), motion.time, motion.acceleration, right=0.0):
            v += h * (-2 * 0.10 * w * v - w**2 * x - push)
            x += h * v
            largest = max(largest, abs(x))
        (on_base,) = made.under([motion])
        assert made.limits(on_base).ends_from == pytest.approx(0.25 / largest, rel=0.01)


class TestReading:
    @pytest.mark.parametrize(
        ("support", "sizes"),
        [
            ("floor", {}),
            ('"floor, felt 0.15"', {"friction": 0.15}),
            ("PTFE 0.1", {"friction": 0.1}),
            ("pavimento con feltro 0.15", {"friction": 0.15}),
            ("floor on castors 0.02", {"friction": 0.02}),
            ('"floor, chain 800 N at 1.0 m"', {"wire": 800.0, "wire_height": 1.0}),
            ('"shelf, 1.6 m up, edge 8 cm"', {"edge": 0.08}),
            ('"feltro 0,2; bordo 5 cm"', {"friction": 0.2, "edge": 0.05}),
            ('"wires 0.6 kN at 0.9 m"', {"wire": 600.0, "wire_height": 0.9}),
            ('"cera 6 cm2 40 kPa 30 kPa"', {"wax_area": 6e-4, "wax_tension": 4e4, "wax_shear": 3e4}),
            ('"su isolatore 2.5 s 15 % 25 cm"', {"period": 2.5, "damping": 0.15, "stroke": 0.25}),
        ],
    )
    def test_supports(self, support, sizes):
        made = item(f"100,30,30,40,oak,{support},A")
        others = {key: value for key, value in made.sizes.items() if key not in ("height", "width", "depth", "mass")}
        assert others == pytest.approx(sizes)
        assert made.wrong is None

    def test_two_blocks_are_taken_as_rigid(self):
        made = item('65,210,70,900,marble,"two blocks, 0.4 m",C1')
        assert made.raised
        assert any("0.4 m above the floor is taken as rigid" in each for each in made.remarks)

    @pytest.mark.parametrize(
        ("room", "storey"),
        [("L1 (2nd floor)", 2), ("Sala 3, primo piano", 1), ("piano 4", 4), ("G1", None), ("Sala 2", None)],
    )
    def test_the_storey_of_a_room(self, room, storey):
        assert items(f'{HEAD}1,a,100,30,30,40,oak,floor,"{room}"\n')["1"].storey == storey

    def test_a_support_that_is_not_understood_is_said(self):
        for support, words in {
            "teleporter": "'teleporter' is not understood",
            '"floor, teleporter 800 N"': "'teleporter 800 N' is not understood",
            "bolted to the floor": "'bolted to the floor' (bolted, to) is not understood",
            "floor on castors": "no coefficient of friction",
        }.items():
            questions = item(f"100,30,30,40,oak,{support},A").questions
            assert any(words in each for each in questions), (support, questions)

    @pytest.mark.parametrize(
        ("cells", "question"),
        [
            ("100,30,30,400,oak,floor,A", "it weighs 400 kg, but solid oak of its sides 117 kg at most"),
            ("100,30,30,1,marble,floor,A", "0.4% of a solid of marble"),
            ('100,30,30,40,oak,"shelf, edge 8 cm",A', "closer than half of the foot"),
        ],
    )
    def test_questions(self, cells, question):
        made = item(cells)
        assert any(question in each for each in made.questions), made.questions
        assert made.wrong is None

    def test_a_foot_larger_than_the_body_and_sides_exchanged(self):
        made = items("No,Name,Height (cm),Width (cm),Depth (cm),Foot (cm)\n1,amphora,20,50,50,60\n")["1"]
        assert any("larger than the body" in each for each in made.questions)
        assert any("exchanged" in each and "high" in each for each in made.questions)

    @pytest.mark.parametrize(
        ("cells", "why"),
        [
            (",30,30,40,oak,floor,A", "Height .cm. is missing"),
            ("100,,,40,oak,floor,A", "Width .cm. is missing"),
            ("100,30,30,40,oak,on 7,A", "stands on 7, which is not in the list"),
            ("100,30,30,40,oak,isolator 2 s,A", "the isolator has no stroke"),
            ("100,30,30,40,oak,wax 10 cm2,A", "no strength in tension and in shear"),
            ("-100,30,30,40,oak,floor,A", "must be above 0"),
            ("tall,30,30,40,oak,floor,A", "tall"),
            ("100 kg,30,30,40,oak,floor,A", "is a mass, not a length"),
        ],
    )
    def test_rows_that_cannot_be_used(self, cells, why):
        with pytest.raises(InputError, match=why) as error:
            item(cells).make()
        assert "list.csv:2" in str(error.value)

    def test_a_circle_of_supports(self):
        made = items(f"{HEAD}1,a,60,20,20,5,clay,on 2,A\n2,b,100,30,30,35,MDF,on 1,A\n")
        for each in made.values():
            with pytest.raises(InputError, match="stands on itself"):
                each.make()

    @pytest.mark.parametrize("support", ["isolator 2 s 300 % 20 cm", "isolator 900000000 s 10 % 20 cm"])
    def test_an_isolator_that_cannot_be_loses_its_row_alone(self, support):
        text = f"{HEAD}1,good,100,30,30,40,oak,floor,A\n2,bad,100,30,30,40,oak,{support},A\n"
        answer = quick(text)
        assert [row.name for row in answer.rows] == ["1 good"]
        assert "the isolator:" in answer.bad[0].reason

    def test_rows_are_skipped_by_name(self):
        Path("l.csv").write_text(
            f"{HEAD}1,good,100,30,30,40,oak,floor,A\n2,bad,,30,30,40,oak,floor,A\n", encoding="utf-8"
        )
        result = run("survey", "l.csv", code=5)
        assert "1 good" in result.stdout
        assert "l.csv:3: Height (cm) is missing" in result.stderr


def quick(text, *motions, **how):
    Path("list.csv").write_text(text, encoding="utf-8")
    return rk.survey("list.csv", motions or ACCEL, neighbours=how.pop("neighbours", 60), **how)


class TestShares:
    def test_are_those_of_margin(self):
        found = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n2,case,200,120,50,90,oak,floor,A\n")
        for row, (width, height) in zip(
            sorted(found.rows, key=lambda each: each.row), [(0.16, 0.68), (0.5, 2.0)], strict=True
        ):
            answer = rk.margin(rk.Block(width=width, height=height), ACCEL, polarity="1", neighbours=60)
            (margin,) = answer.values()
            (one,) = row.topples
            assert one.share == margin.share
            assert one.factors == {0.05: margin.first(0.05, unknown=True), 0.5: margin.first(0.5, unknown=True)}
            assert row.toppled_from(0.5)[0] == pytest.approx(margin.first(0.5) * margin.pga_g)

    def test_pgv_is_that_of_the_ground(self):
        (row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n").rows
        motion = rk.read_record(ACCEL)
        assert row.topples[0].pgv == pytest.approx(np.abs(motion.velocity).max())

    def test_danger_is_of_the_worst_motion(self):
        strong, weak = rk.read_record(ACCEL), rk.read_record(ACCEL).scaled(0.05)
        (row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n", strong, weak).rows
        assert row.danger == "falls" and row.topples[1].share.highest == 0
        (row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n", weak).rows
        assert row.danger == "stands"

    def test_without_neighbours_nothing_is_said_of_how_strong(self):
        (row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n", neighbours=0).rows
        assert row.danger is None and not row.topples and row.under.overturned == 1

    def test_a_floor_for_each_row(self):
        building = Floor.parse("T1=0.3,xi=0.05,z/H=1,n=3")
        text = "No,Name,Height (cm),Width (cm),Depth (cm),Floor\n1,a,200,40,40,0\n2,b,200,40,40,2\n3,c,200,40,40,\n"
        Path("list.csv").write_text(text, encoding="utf-8")
        ground = rk.read_record(ACCEL)
        answer = rk.survey("list.csv", ACCEL, floor=str(building), neighbours=60)
        peaks = {row.name[0]: row.topples[0].base_pga for row in answer.rows}
        of = lambda z: Floor(0.3, 0.05, z, building.participation).of(ground).pga_g  # noqa: E731
        assert peaks["1"] == pytest.approx(ground.pga_g)
        assert peaks["2"] == pytest.approx(of(2 / 3))
        assert peaks["3"] == pytest.approx(of(1.0))
        assert all(row.topples[0].pga == pytest.approx(ground.pga_g) for row in answer.rows)

    def test_wires_hold_up_to_their_force_and_no_farther(self):
        pga = rk.read_record(ACCEL).pga_g
        (bare,) = quick(f"{HEAD}1,stele,200,20,60,100,marble,floor,A\n").rows
        free = bare.topples[0].share.highest
        assert free > 0.5
        for factor, share in ((1 / SPREAD**2, free), (SPREAD**2, 0.0)):
            # b/h = 0.1: the rest of the moment m a h/2 is that of the wire.
            force = 100 * G * (factor * pga - 0.1) * 1.0 / 2.0
            (row,) = quick(f'{HEAD}1,stele,200,20,60,100,marble,"wires {force:.3f} N at 2 m",A\n').rows
            assert row.topples[0].share.highest == pytest.approx(share, abs=0.06)

    def test_a_stroke_that_is_too_short_is_unknown(self):
        (row,) = quick(f'{HEAD}1,a,140,40,40,95,bronze,"isolator 2 s, 10 %, 1 cm",A\n').rows
        assert row.topples[0].share.lowest == 0 and row.topples[0].share.highest == 1
        assert row.under.unknown == 1
        (row,) = quick(f'{HEAD}1,a,140,40,40,95,bronze,"isolator 2 s, 10 %, 3 m",A\n').rows
        assert row.topples[0].share.highest == 0

    def test_an_edge_that_a_slip_passes(self):
        (row,) = quick(f'{HEAD}1,case,60,50,50,40,oak,"felt 0.1, edge 1 mm",A\n').rows
        assert row.topples[0].share.lowest == 1 and row.under.overturned == 1
        (row,) = quick(f'{HEAD}1,case,60,50,50,40,oak,"felt 0.1, edge 5 m",A\n').rows
        assert row.topples[0].share.highest == 0 and row.under.slip > 0.01

    def test_wax_holds_no_longer_than_the_pedestal_stands(self):
        text = (
            f'{HEAD}1,vase,60,20,20,5,clay,"on 2, wax 100 cm2 400 kPa 300 kPa",A\n2,pedestal,100,14,14,35,MDF,floor,A\n'
        )
        made = items(text)["1"]
        motion = rk.read_record(ACCEL)
        height = (35 * 0.50 + 5 * 1.30) / 40
        assert made.holds_to() > 1
        assert made.limits(motion).held_to * motion.pga_g == pytest.approx(0.07 / height)

    def test_a_weak_motion_that_topples_is_named_below_a_fifth(self):
        strong = rk.read_record(ACCEL).scaled(8)
        (row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n", strong).rows
        (plain_row,) = quick(f"{HEAD}1,amphora,68,16,16,5.2,clay,floor,A\n").rows
        assert row.topples[0].factors[0.05] < 0.2
        assert row.toppled_from(0.05)[0] == pytest.approx(plain_row.toppled_from(0.05)[0], rel=0.06)


class TestSentences:
    """What the terminal says of a list is what its rows hold."""

    LIST = (
        "No,Object,Height (cm),Width (cm),Depth (cm),Weight (kg),Support,Floor\n"
        "1,urn,100,20,20,50,floor,\n2,slab,20,80,80,200,floor,2\n3,case,60,50,50,40,felt 0.1,\n"
    )

    def said_of(self, **how):
        answer = quick(self.LIST, **how)
        return answer, " ".join(str(part) for part in answer.view.parts if isinstance(part, str))

    def test_counts_and_clearance(self):
        answer, text = self.said_of()
        count = {word: sum(row.danger == word for row in answer.rows) for word in ("falls", "may fall", "stands")}
        assert count["falls"] == 1 and count["stands"] == 2
        assert "Objects that fall: 1, that may fall: 0, and that stand: 2." in text
        case = next(row for row in answer.rows if row.name == "3 case")
        assert case.clearance > case.under.slip > 0.01
        assert f"3 case: slides by up to {case.clearance:.2g} m" in text

    def test_floors(self):
        _, text = self.said_of()
        assert "2 slab: on an upper floor, which moves more than the ground, whose motion was used." in text
        answer, text = self.said_of(floor="T1=0.3,xi=0.05,z/H=0,n=3")
        peak = next(row for row in answer.rows if row.name == "2 slab").topples[0].base_pga
        assert f"2 slab: on floors or isolators of their own, with a PGA {peak:.3g} g." in text
        assert "whose motion was used" not in text

    def test_space_in_italian_too(self):
        pytest.importorskip("mujoco", reason="free blocks need MuJoCo")
        _, text = self.said_of(in_space=True, language="it", neighbours=0)
        assert "In tre dimensioni (sperimentale)" in text and "In three dimensions" not in text


class TestUnsafe:
    """What a list says at its edges, and would be safe if it were left out."""

    def test_a_foot_of_one_plane_is_not_that_of_the_other(self):
        made = items("No,Name,Height (cm),Width (cm),Depth (cm),Foot (cm)\n1,a,120,62,20,60\n")["1"]
        assert isclose(lambda_of(made.make()), 0.20 / 1.20)

    def test_wax_does_not_hold_beyond_a_stroke(self):
        support = '"isolator 2.5 s 15 % 1 cm, wax 20 cm2 40 kPa 300 kPa"'
        (row,) = quick(f"{HEAD}1,a,100,20,20,50,oak,{support},A\n", remedies="all").rows
        assert row.danger == "falls" and row.topples[0].share.highest == 1
        assert not {"wires", "wax", "slide"} & {each.kind for each in row.remedies}

    def test_wires_hold_what_stands_on_the_object_too(self):
        text = f'{HEAD}1,bust,100,60,60,500,oak,on 2,A\n2,pedestal,100,60,60,50,oak,"wires 300 N at 1 m",A\n'
        held = items(text)["2"].holds_to()
        assert isclose(held, (550 * G * 0.30 + 300) / (550 * G * (50 * 0.5 + 500 * 1.5) / 550))

    def test_a_failed_row_fails_what_bears_it(self):
        text = f"{HEAD}1,bust,100,,,500,oak,on 2,A\n2,pedestal,100,60,60,50,oak,floor,A\n"
        with pytest.raises(InputError, match="carries 1 bust, whose row cannot be used"):
            items(text)["2"].make()

    def test_a_code_alone_in_a_column_of_supports(self):
        head = "No,Object,Height (cm),Width (cm),Weight (kg),Stands on\n"
        made = items(f"{head}1,bust,100,60,500,2\n2,pedestal,100,60,50,floor\n3,box,10,60,5,on 2 trestles\n")
        assert made["1"].on == "2" and made["3"].on == "" and made["3"].raised

    @pytest.mark.parametrize("heading", ["Edge", "Wire height", "Isolator stroke", "Wax", "Gap"])
    def test_numbers_without_units_are_refused(self, heading):
        made = items(f"No,Object,Height (cm),Width (cm),Weight (kg),{heading}\n1,a,100,60,500,4\n")["1"]
        assert "without a unit" in str(made.wrong)

    @pytest.mark.parametrize(
        "support",
        ["wires 30 N at 15 m", "wax 4000 cm2 5 kPa 30 kPa", "edge 3-40 cm", "edge 1", "felt 4", "isolator 15 % 1 cm"],
    )
    def test_what_cannot_be_is_refused(self, support):
        assert item(f"100,20,20,50,oak,{support},A").wrong is not None

    def test_separators_of_thousands_are_refused(self):
        assert item('180,40,40,"1,050 kg",oak,floor,A').wrong is not None
        made = items("No;Name;Height;Width\n1;a;1.820 mm;40 cm\n2;b;100 cm;0,5 m\n")
        assert made["1"].wrong is not None and made["2"].wrong is None

    def test_a_floor_that_is_not_understood_is_left_out_where_floors_move(self):
        building = Floor.parse("T1=0.3,xi=0.05,z/H=0,n=3")
        for room, storey in {"First room, third floor": 3, "Livello 2": 2, "Top floor": None}.items():
            made = items(f'{HEAD}1,a,100,30,30,40,oak,floor,"{room}"\n', building)["1"]
            assert made.storey == storey and (made.wrong is not None) == (storey is None)

    def test_an_isolator_moves_no_farther_than_its_neighbour(self):
        (row,) = quick(f'{HEAD}1,a,100,40,40,50,oak,"isolator 2.5 s 15 % 30 cm, gap 2 cm",A\n').rows
        assert row.topples[0].share.highest == 1

    def test_nothing_is_safer_than_what_it_stands_on(self):
        text = f'{HEAD}1,lamp,30,20,20,1,oak,on 2,A\n2,stand,100,20,20,10,oak,"floor, gap 1 mm",A\n'
        rows = {row.name: row for row in quick(text).rows}
        assert rows["1 lamp"].topples[0].share.highest >= rows["2 stand"].topples[0].share.highest

    def test_few_neighbours_have_no_class(self):
        (row,) = quick(f"{HEAD}1,slab,20,80,80,200,stone,floor,A\n", neighbours=20).rows
        assert row.topples and row.danger is None

    def test_a_base_is_no_wider_than_its_room(self):
        made = items(f'{HEAD}1,a,100,20,20,50,oak,"floor, edge 1 cm",A\n')["1"]
        kinds = [each.kind for each in remedies(made, [rk.read_record(ACCEL)], (1,), Neighbourhood(60))]
        assert "base" not in kinds and "isolate" not in kinds

    def test_a_load_stays_on_what_is_changed(self):
        text = f"{HEAD}1,bust,100,30,30,500,stone,on 2,A\n2,pedestal,100,60,60,50,oak,floor,A\n"
        assert len(items(text)["2"].alone().carried) == 1


class TestRemedies:
    """Each number by a formula of its own, and each remedy tried again as a list that says it."""

    TEXT = f"{HEAD}1,urn,100,20,20,50,clay,floor,A\n"

    def every(self, text=TEXT, scale=1.0):
        (made,) = items(text).values()
        motion = rk.read_record(ACCEL).scaled(scale)
        return made, motion, {each.kind: each for each in remedies(made, [motion], (1,), Neighbourhood(60))}

    def share(self, text, **more):
        (row,) = quick(text, **more).rows
        return row.topples[0].share.highest

    def test_the_bare_one_falls(self):
        assert self.share(self.TEXT) > 0.5

    def test_wires(self):
        _made, motion, every = self.every()
        numbers = every["wires"].numbers
        force = 50 * G * (SPREAD * motion.pga_g * 0.5 - 0.1) / (2 / 3)
        assert numbers == pytest.approx({"force": force, "height": 2 / 3})
        assert self.share(f'{HEAD}1,urn,100,20,20,50,clay,"wires {1.01 * force:.2f} N at 0.66667 m",A\n') <= 0.05
        assert self.share(f'{HEAD}1,urn,100,20,20,50,clay,"wires {0.8 * force:.2f} N at 0.66667 m",A\n') > 0.05

    def test_wax(self):
        _made, motion, every = self.every()
        numbers, strong = every["wax"].numbers, SPREAD * motion.pga_g
        # About the edge of the foot: m a h/2 = (m g + T) b/2.
        assert numbers == pytest.approx({"pull": 50 * G * (strong * 0.5 / 0.1 - 1), "shear": 50 * G * strong})
        assert every["wax"].suffices is None
        text = self.TEXT.replace("floor", '"wax 1 cm2 50 kPa 40 kPa"')
        _, _, every = self.every(text)
        area = max(numbers["pull"] / 5e4, numbers["shear"] / 4e4)
        assert every["wax"].numbers["area"] == pytest.approx(area)
        assert every["wax"].suffices == (area <= 0.2**2)

    def test_a_wider_base(self):
        _made, _motion, every = self.every()
        wider = every["base"].numbers["wider"]
        head = "No,Name,Height (cm),Width (cm),Depth (cm),Weight (kg),Foot (cm),Foot depth (cm)\n"
        wide = 100 * (0.2 + wider)
        assert self.share(f"{head}1,urn,100,20,20,50,{wide},{wide}\n") <= 0.05
        narrow = 100 * (0.2 + 0.6 * wider)
        assert self.share(f"{head}1,urn,100,20,20,50,{narrow},{narrow}\n") > 0.05

    def test_sand_in_the_foot(self):
        _made, motion, every = self.every(scale=0.7)
        mass = every["ballast"].numbers["mass"]
        block = rk.Block(
            width=0.2, height=1.0, depth=0.2, mass=50.0, loads=[{"name": "sand", "mass": mass, "at": [0.0, 0.05]}]
        )
        (margin,) = rk.margin(block, motion, polarity="1", neighbours=60).values()
        assert 0 < mass <= 50 and margin.share.highest <= 0.05

    def test_on_a_pedestal_it_is_tried_on_the_floor_of_that(self):
        building = Floor.parse("T1=0.3,xi=0.05,z/H=0,n=3")
        head = "No,Name,Height (cm),Width (cm),Depth (cm),Weight (kg),Support,Floor\n"
        made = items(f"{head}1,vase,60,20,20,5,on 02,\n2,plinth,50,60,60,90,floor,3\n", building)
        motion = rk.read_record(ACCEL)
        (on_plinth,), (alone,) = (each.under([motion]) for each in (made["1"], made["1"].alone()))
        assert on_plinth.pga_g == alone.pga_g > motion.pga_g

    def test_no_sand_in_marble(self):
        _, _, every = self.every(f"{HEAD}1,stele,100,20,20,50,marble,floor,A\n")
        assert "ballast" not in every

    def test_let_it_slide(self):
        _made, _motion, every = self.every()
        numbers = every["slide"].numbers
        assert numbers["friction"] == pytest.approx(0.8 * 0.2)
        assert (
            self.share(
                self.TEXT.replace("floor", f'"felt {numbers["friction"]}, edge {1.02 * numbers["clearance"]:.5f} m"')
            )
            <= 0.05
        )
        assert (
            self.share(
                self.TEXT.replace("floor", f'"felt {numbers["friction"]}, edge {0.5 * numbers["clearance"]:.5f} m"')
            )
            > 0.05
        )

    def test_an_isolator(self):
        _made, _motion, every = self.every()
        numbers = every["isolate"].numbers
        support = f'"isolator {numbers["period"]} s, 15 %, {1.02 * numbers["stroke"]:.4f} m"'
        assert self.share(self.TEXT.replace("floor", support)) <= 0.05
        support = f'"isolator {numbers["period"]} s, 15 %, {0.8 * numbers["stroke"]:.4f} m"'
        assert self.share(self.TEXT.replace("floor", support)) > 0.05

    def test_slender_marble_is_not_held_at_its_top(self):
        _, _, every = self.every(f"{HEAD}1,stele,240,60,18,620,marble,floor,A\n")
        assert every["wires"].against and every["wax"].against
        _, _, every = self.every(f"{HEAD}1,bookcase,240,60,18,100,oak,floor,A\n")
        assert not every["wires"].against

    def test_what_stands_needs_none(self):
        (row,) = quick(f"{HEAD}1,slab,20,80,80,200,stone,floor,A\n").rows
        assert row.danger == "stands" and not row.remedies

    def test_the_first_that_suffices_and_all_on_demand(self):
        (row,) = quick(self.TEXT).rows
        assert [each.kind for each in row.remedies] == ["base"]
        (row,) = quick(self.TEXT, remedies="all").rows
        assert [each.kind for each in row.remedies] == ["base", "wires", "wax", "slide", "isolate"]


class TestInSpace:
    """Objects in three dimensions beside the plane; histories themselves are tested with their engine."""

    PUSH, ACROSS = "sine:0.3g:1s", "sine:0.2g:0.76923s"

    @pytest.fixture(autouse=True)
    def _engine(self):
        pytest.importorskip("mujoco", reason="free blocks need MuJoCo")

    def test_a_second_component_topples_what_the_plane_calls_safe(self):
        text = "No,Name,Height (cm),Diameter (cm),Support\n1,drum,200,50,friction 0.6\n"
        (row,) = quick(text, self.PUSH, in_space=True, neighbours=0).rows
        assert [each.outcome for each in row.space] == ["rocks"] and not row.space[0].differs
        answer = quick(text, self.PUSH, in_space=True, transverse=self.ACROSS, neighbours=0)
        (row,) = answer.rows
        assert row.space[0].differs and row.space[0].overturning_time == pytest.approx(1.8275, abs=0.01)
        assert any("Overturn in space, and not in the plane: 1 drum." in str(part) for part in answer.view.parts)

    def test_a_box_lies_with_its_weaker_side_along_x(self):
        made = item("240,60,18,620,limestone,floor,G2").solid()
        assert np.ptp(made.points, axis=0) == pytest.approx([0.18, 0.60, 2.40])
        assert np.diag(made.inertia) == pytest.approx(
            [(0.6**2 + 2.4**2) / 12, (0.18**2 + 2.4**2) / 12, (0.18**2 + 0.6**2) / 12]
        )

    @pytest.mark.parametrize("support", ["on 2", '"wires 300 N at 1 m"', "isolator 2 s 10 % 20 cm", "gap 3 cm"])
    def test_what_is_not_simulated_is_said_by_name(self, support):
        text = f"{HEAD}1,a,100,30,30,40,oak,{support},A\n2,b,50,60,60,90,oak,floor,A\n"
        rows = {row.name: row for row in quick(text, self.PUSH, in_space=True, neighbours=0).rows}
        assert "not simulated in three dimensions, as it" in rows["1 a"].not_in_space
        assert not rows["1 a"].space

    def test_a_component_for_each_motion(self):
        with pytest.raises(InputError, match="2 given for 1 motions"):
            quick(TestRemedies.TEXT, self.PUSH, in_space=True, transverse=[self.ACROSS, self.PUSH])


def test_kinds_of_a_list_can_be_named():
    head = "No,Name,Type,Height (cm),Width (cm),Depth (cm)"
    text = f"{head}\n1,x,cylinder,100,30,30\n2,y,vase,60,20,20\n3,z,bookcase,200,90,30\n"
    made = items(text)
    assert [each.kind for each in made.values()] == ["cylinder", "vase", "bookcase"]
    assert made["1"].is_round and made["2"].is_round and not made["3"].is_round


def test_starters_stand_in_a_table():
    Path("t.csv").write_text("mechanism,name,height\nparapet,A,1.5\nparapetto,B,\n", encoding="utf-8")
    a, b = (row.make() for row in table_of("t.csv", None))
    assert a.name == "A" and a.height == 1.5 and b.height != 1.5 and a.width == b.width
