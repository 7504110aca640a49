"""Loads and ties of a structure, and what keeps it to one side, as pictures, pages, tables and reports show them."""

import html
import re
from math import pi

import numpy as np
import pytest
import yaml
from matplotlib.collections import PolyCollection
from PIL import Image

from mechanisms.block import Block
from mechanisms.symmetric_frame import SymmetricFrame
from rocking_cli.core import Direction
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting import dimensions, hung, style
from rocking_cli.plotting.moving import moving, ratio_chart
from rocking_cli.plotting.structure import NO_CRITICAL_TEXT, draw_structure
from rocking_cli.questions.respond.picture import draw_history
from rocking_cli.studies.film import Film
from rocking_cli.studies.movements import Watched
from rocking_cli.studies.picture import NODES_PER_SIDE, picture
from rocking_cli.views.verdict import verdict
from tests.cli.test_cli import run, run_json
from tests.conftest import rows_of
from tests.following import respond, structure_of

OF_STONE = {"density": 2400.0, "depth": 1.0}
BAR = {"name": "bar", "from": {"ground": [-6, 7.5]}, "to": {"at": [-0.3, 7.5]}, "stiffness": 1e5, "only": "tension"}
FLOOR = {"name": "floor", "mass": 2000.0, "at": [0.2, 5], "floor": "borne"}
THRUST = {"name": "thrust", "force": [3000.0, -4000.0], "at": [0.3, 4]}
TENDON = {"name": "tendon", "path": [{"ground": [0, 0]}, {"at": [0, 0]}], "stiffness": 2e8, "prestress": 2e4}
FACADE = {"width": 0.6, "height": 8.0, **OF_STONE}
TIED = {"name": "tied", "width": 1.0, "height": 5.0, **OF_STONE, "ties": [TENDON]}
TIED_FILE = yaml.safe_dump({"mechanism": "block", **TIED})
ONE_SIDED = {"one_sided": "positive", "rebound": 0.48}
LEANING = {"name": "facade", **FACADE, **ONE_SIDED, "loads": [FLOOR, THRUST], "ties": [BAR]}


def write(folder, fields):
    (folder / "s.yaml").write_text(yaml.safe_dump({"mechanism": "block", **fields}), encoding="utf-8")
    return folder / "s.yaml"


@pytest.fixture
def tied(tmp_path):
    """A column that a tendon leaves no critical rotation."""
    return write(tmp_path, TIED)


@pytest.fixture
def leaning(tmp_path):
    """A loaded and tied facade that leans on side walls."""
    return write(tmp_path, LEANING)


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


class TestPicture:
    def test_loads_and_ends_of_ties_move_with_the_body(self):
        """By hand: a block turns by -phi about its right foot; the ground stays."""
        shown = picture(Block(**FACADE, loads=[FLOOR, THRUST], ties=[BAR]))
        loads, ((piece,),), slack = shown.hung(0.05, symbol=1.0)
        turned = [0.3 + np.exp(-0.05j) * (z - 0.3) for z in (0.2 + 5j, 0.3 + 4j, -0.3 + 7.5j)]
        np.testing.assert_allclose([*loads, piece[1]], turned)
        assert piece[0] == -6 + 7.5j and slack == [False]

    @pytest.mark.parametrize(
        ("of", "kind"),
        [
            ({"stiffness": 1e5}, "spring"),
            ({"area": 4e-4, "modulus": 2e11}, "line"),
            ({"area": 4e-6, "steel": "S235"}, "line"),
            ({"stiffness": 0, "prestress": 1e2}, "line"),
        ],
    )
    def test_a_bar_is_a_line_and_a_stiffness_alone_a_spring(self, of, kind):
        long, short = (
            {key: value for key, value in each.items() if key not in ("stiffness", "prestress")} | of
            for each in (BAR, TENDON | {"length": 5.0} if "area" in of else TENDON)
        )
        shown = picture(Block(**FACADE, ties=[long, short]))
        assert [tie.pieces[0].kind for tie in shown.ties] == [kind, {"spring": "symbol"}.get(kind, kind)]
        lines = [line.size for line, _, _ in hung.symbols(shown, 0.0, 1.0).lines]
        assert (min(lines) > 2) is (kind == "spring") and (max(lines) > 2) is (kind == "spring")

    def test_heights_that_a_length_shows_already_are_not_measured_again(self):
        roof = FLOOR | {"name": "roof", "at": [0, 8]}
        shown = picture(Block(**FACADE, loads=[FLOOR, THRUST, roof], ties=[BAR, TENDON]))
        assert [each.text for each in dimensions.heights(shown, shown.sketch.lengths)] == ["4 m", "5 m", "7.5 m"]

    def test_a_tie_that_pulls_only_is_slack_the_other_way(self):
        shown = picture(Block(**FACADE, ties=[BAR]))
        assert shown.hung(-0.05, symbol=1.0)[2] == [True]
        assert shown.hung(0.0, symbol=1.0)[2] == [False]
        held = picture(Block(**FACADE, ties=[BAR | {"prestress": 2e3}]))  # slack once it is shorter by 20 mm
        assert [held.hung(turn, symbol=1.0)[2] for turn in (-0.002, -0.004)] == [[False], [True]]

    def test_ends_that_are_together_are_drawn_apart(self):
        """What holds it below, what moves above; where it opens by 2 b sin(phi/2), so does its symbol."""
        shown = picture(Block(**TIED))
        ((below, above),) = shown.hung(0.0, symbol=0.1)[1][0]
        assert (below, above) == (-0.1j, pytest.approx(0.1j))
        ((below, above),) = shown.hung(0.02, symbol=0.0)[1][0]
        assert abs(above - below) == pytest.approx(2 * 0.5 * np.sin(0.01))

    def test_without_a_critical_rotation_the_limit_is_what_rotations_are_compared_with(self):
        shown = picture(Block(**TIED))
        assert set(shown.phi_cr.values()) == {None}
        assert shown.reference[Direction.POSITIVE] == pytest.approx(pi / 2)
        assert shown.as_dict()["phi_cr"] == {"positive": None, "negative": None}

    @pytest.mark.parametrize(("side", "face"), [("positive", -0.3), ("negative", 0.3)])
    def test_it_leans_on_the_side_that_it_cannot_rock_to(self, side, face):
        shown = picture(Block(**FACADE, one_sided=side))
        (wall,) = shown.walls
        assert set(wall.real) == {face} and wall.imag.max() == 8.0
        to_the_right = (wall[1] - wall[0]) * -1j  # where the hatches are
        assert np.sign(to_the_right.real) == np.sign(face)
        data = shown.as_dict()
        assert data["one_sided"] == side and list(data["limit"]) == [side]
        assert len(data["rotation"]) == NODES_PER_SIDE + 1 and {pin["direction"] for pin in data["pins"]} == {side}

    def test_what_each_of_several_columns_has_is_drawn_on_each(self):
        tendon = TENDON | {"path": [{"ground": [0, 0]}, {"body": "columns", "at": [0, 0]}], "each": True}
        pot = {"name": "pot", "mass": 20.0, "at": [0, 3], "body": "columns", "each": True}
        sizes = {"column_width": 1.0, "column_height": 6.0, "columns": 3}
        frame = SymmetricFrame(**sizes, mass_ratio=1.0, mass=6e4, loads=[pot], ties=[tendon])
        shown = picture(frame)
        feet = [pin.point - 0.5 for pin in shown.pins if pin.direction > 0 and pin.point.imag == 0]
        assert [tie.pieces[0].end.point for tie in shown.ties] == feet
        assert [tie.name for tie in shown.ties] == ["tendon", "", ""]
        assert [(load.point, load.text) for load in shown.loads] == [(foot + 3j, "20 kg") for foot in feet]

    def test_friction_turns_with_the_motion_and_a_thrust_does_not(self):
        """The crossing walls hold it back: to the left while it rocks to the right, and the other way."""
        courses = {"courses": 40, "overlap": 0.2, "thickness": 0.5, "walls": 1, "height": 8.0}
        shown = picture(Block(**FACADE, interlock=courses, loads=[THRUST]))
        pushes = {}
        for turn in (0.01, -0.01):
            forces = dict(zip([load.name for load in shown.loads], hung.symbols(shown, turn, 1.0).forces, strict=True))
            pushes[turn] = {name: np.sign((tip - tail).real) for name, (tail, tip) in forces.items()}
        assert pushes == {0.01: {"thrust": 1, "interlock": -1}, -0.01: {"thrust": 1, "interlock": 1}}

    def test_a_page_has_every_end_where_the_picture_has_it(self):
        shown = picture(Block(**FACADE, loads=[FLOOR], ties=[BAR]))
        data = shown.as_dict()
        k = NODES_PER_SIDE + 7
        turn, part = data["rotation"][k], data["parts"][0]
        loads, ((piece,),), _ = shown.hung(turn, symbol=0.0)
        ends = [data["loads"][0], *data["ties"][0]["pieces"][0]["ends"]]
        here = complex(part["x"][k], part["y"][k])
        for each, place in zip(ends, [loads[0], *piece], strict=True):
            z = complex(*each["point"])
            found = z if each["part"] is None else here + np.exp(1j * part["psi"][k]) * z
            assert found == pytest.approx(place, abs=1e-5)
        slack = data["ties"][0]["slack"]
        assert slack[NODES_PER_SIDE - 5] and not slack[NODES_PER_SIDE] and not slack[-1]


class TestDraw:
    def test_json_lists_what_hangs_on_it(self, leaning):
        found = run_json("draw", leaning)
        assert [(each["name"], each["mass"], each["force"]) for each in found["loads"]] == [
            ("floor", 2000.0, None), ("thrust", None, [3000.0, -4000.0]),
        ]  # fmt: skip
        assert [(each["name"], each["only"]) for each in found["ties"]] == [("bar", "tension")]
        assert found["one_sided"] == "positive"

    def test_names_are_written_and_one_direction_is_shown(self):
        figure = draw_structure(picture(Block(**FACADE, one_sided="positive", rebound=0.5, loads=[FLOOR, THRUST],
                                              ties=[BAR])), "facade")  # fmt: skip
        assert {"floor, 2 t", "thrust, 5 kN", "bar", "4 m", "5 m", "7.5 m"} <= set(texts(figure))
        for axes in figure.axes:  # a centroid is in front of a weight at the same place
            (weights,) = (each for each in axes.collections if isinstance(each, PolyCollection))
            (centroids,) = (line for line in axes.lines if line.get_fillstyle() == "top")
            assert centroids.get_zorder() > weights.get_zorder() and len(weights.get_paths()) == 1
        assert [axes.get_title().split()[0] for axes in figure.axes] == ["at", "positive"]
        lines = [line for axes in figure.axes for line in axes.lines if line.get_color() == style.TIE["color"]]
        assert [line.get_linestyle() for line in lines] == ["-", "-"]

    def test_a_slack_tie_is_dashed(self):
        figure = draw_structure(picture(Block(**FACADE, ties=[BAR])), "facade")
        looks = {
            axes.get_title().split()[0]: line.get_linestyle()
            for axes in figure.axes
            for line in axes.lines
            if line.get_color() == style.TIE["color"]
        }
        assert looks == {"negative": "--", "at": "-", "positive": "-"}

    def test_without_a_critical_rotation_it_is_shown_at_an_angle_that_is_seen(self, tied, tmp_path):
        figure = draw_structure(picture(Block(**TIED)), "tied")
        assert any(NO_CRITICAL_TEXT in text.get_text() for text in figure.texts)
        assert any("9°" in axes.get_title() for axes in figure.axes)
        out = tmp_path / "tied.png"
        assert run("draw", tied, "--plot", out, "--at", 0.5).exit_code == 0 and out.stat().st_size > 10_000
        assert "at most 0.999 times the limit" in run("draw", tied, "--at", 2, code=2).stderr

    def test_everything_that_is_drawn_is_in_its_panel(self):
        for made in (
            Block(**FACADE, loads=[FLOOR, THRUST], ties=[BAR]),
            Block(**TIED | {"loads": [FLOOR | {"at": [0.5, 5]}, THRUST | {"force": [-9.0, 0.0], "at": [0.5, 4]}]}),
        ):
            shown = picture(made)
            figure = draw_structure(shown, "x")
            for axes in figure.axes:
                (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
                scale = axes.get_position().width * style.PAGE_WIDTH / (right - left)
                way = {"n": -1, "a": 0, "p": 1}[axes.get_title()[0]]
                turn = way * shown.usual[Direction.POSITIVE] * shown.reference[Direction(way or 1)]
                found = hung.symbols(shown, turn, scale)
                z = np.concatenate([*(line[0] for line in found.lines), *found.weights, *map(np.array, found.forces)])
                assert left <= z.real.min() and z.real.max() <= right
                assert low <= z.imag.min() and z.imag.max() <= high


class TestAnimate:
    def test_a_gif_shows_what_hangs_on_it_in_its_own_colour(self, leaning, tmp_path):
        out = tmp_path / "a.gif"
        run("animate", leaning, "--pulse", "sine:0.5g:0.5s", "--fps", 1, "--out", out,
            "--neighbours", 0)  # fmt: skip
        green = tuple(int(style.TIE["color"][k : k + 2], 16) for k in (1, 3, 5))
        with Image.open(out) as frames:
            frames.seek(frames.n_frames // 2)
            colours = {each for _, each in frames.convert("RGB").getcolors(1 << 16)}
            assert any(np.abs(np.subtract(each, green)).max() <= 8 for each in colours)

    def test_rotations_are_over_the_limit_where_there_is_no_critical_one(self):
        mechanism = Block(**TIED)
        motion = parse_pulse("sine:0.5g:0.5s").sampled()
        history = respond(mechanism, motion, models=("nonlinear",))["nonlinear"]
        film = Film(picture(mechanism), history, motion)
        np.testing.assert_allclose(film.ratio(history.phi), history.ratio)
        shown = moving(film, [ratio_chart({"nonlinear": history})], label="", speed=1.0, moment=0.0)
        (chart,) = shown["charts"]
        assert shown["stages"][0]["ratio"] == "φ/limit" and "φ/limit" in chart["label"]
        assert {level["text"] for level in chart["levels"]} == {"kinematic limit"}

    def test_the_view_holds_all_that_hangs_on_it(self):
        mechanism = Block(**FACADE, ties=[BAR])
        motion = parse_pulse("sine:0.1g:0.5s").sampled()
        film = Film(picture(mechanism), respond(mechanism, motion, models=("nonlinear",))["nonlinear"], motion)
        assert film.box()[0].real == pytest.approx(-6)


class TestRespond:
    def test_a_table_has_points_and_ties_after_all_else(self, leaning, tmp_path):
        out = tmp_path / "h.csv"
        found = run_json("respond", leaning, "--pulse", "sine:0.4g:0.8s", "--out", out)["responses"]["nonlinear"]
        rows = rows_of(out)
        assert list(rows[0]) == [
            "t [s]", "a_g [g]", "nonlinear phi [rad]", "nonlinear phi_dot [rad/s]", "nonlinear phi_ratio",
            *(f"nonlinear {name} u_{way} [m]" for name in ("top", "floor", "thrust", "bar") for way in "xy"),
            "nonlinear bar elongation [m]", "nonlinear bar force [N]", "nonlinear base shear [N]",
        ]  # fmt: skip
        phi, u, e, n = (
            np.array([float(row[f"nonlinear {name}"]) for row in rows])
            for name in ("phi [rad]", "floor u_x [m]", "bar elongation [m]", "bar force [N]")
        )
        np.testing.assert_allclose(u, (0.3 + np.exp(-1j * phi) * (-0.1 + 5j)).real - 0.2, atol=1e-9)  # by hand
        np.testing.assert_allclose(n, 1e5 * e, rtol=1e-6, atol=1e-6)
        assert n.max() == pytest.approx(found["ties"]["bar"]["peak_force"], rel=2e-3)

    def test_a_history_that_overturns_has_no_places_after_it(self, tmp_path):
        out = tmp_path / "h.csv"
        run("respond", "--pulse", "sine:2g:1s", "--out", out)
        last = rows_of(out)[-1]
        assert last["nonlinear phi [rad]"] == last["nonlinear top u_x [m]"] == last["linear2 top u_x [m]"] == ""

    @pytest.mark.parametrize(("stiffness", "unit", "factor"), [(1e7, "°", np.degrees(1)), (2e8, "mrad", 1000.0)])
    def test_forces_of_ties_are_drawn_below_the_rotation_in_degrees_or_mrad(self, stiffness, unit, factor):
        mechanism = Block(**TIED | {"ties": [TENDON | {"stiffness": stiffness}]})
        motion = parse_pulse("sine:0.6g:1s").sampled()
        run = respond(mechanism, motion, models=("nonlinear",))["nonlinear"]
        assert all(run.ends_at_limit)
        figure = draw_history({"nonlinear": run}, motion, "x", structure=structure_of(mechanism))
        _, rotation, forces = figure.axes
        assert rotation.get_ylabel() == f"rotation [{unit}], clockwise up"
        np.testing.assert_allclose(rotation.lines[1].get_ydata(), factor * run.phi)
        keys = [*figure.legends, *filter(None, [axes.get_legend() for axes in figure.axes])]
        words = [text.get_text() for key in keys for text in key.get_texts()]
        assert any(each.startswith(f"peak {factor * run.furthest:.3g}") and unit in each for each in words)
        (line,) = (line for line in forces.lines if line.get_label() == "tendon")
        largest = Watched(mechanism).peaks(run).ties[0].force / 1000
        assert largest * 0.99 < line.get_ydata().max() <= largest
        assert "tendon" in words

    @pytest.mark.parametrize("side", ["positive", "negative"])
    def test_the_side_that_it_leans_on_is_hatched(self, side):
        mechanism = Block(**FACADE, one_sided=side, rebound=0.4)
        motion = parse_pulse("sine:0.15g:0.8s").sampled()
        histories = respond(mechanism, motion, models=("nonlinear",))
        axes = draw_history(histories, motion, "x", structure=structure_of(mechanism)).axes[1]
        assert [text.get_text() for text in axes.texts if "support" in text.get_text()] == ["supports"]
        low, high = axes.get_ylim()
        sign = Direction[side.upper()]
        assert max(sign * low, sign * high) > 2 * -min(sign * low, sign * high) > 0

    def test_a_sentence_compares_with_what_that_direction_has(self):
        """The tie holds it in the positive direction only; the other has its critical rotation still."""
        held = Block(**FACADE, ties=[BAR | {"stiffness": 1e6}])
        one = respond(held, parse_pulse("sine:0.3g:0.4s").sampled(), models=("nonlinear",))["nonlinear"]
        assert one.ends_at_limit == (True, False)
        assert one.peak_negative > one.peak_positive > 0
        assert one.reference == "critical rotation" and one.furthest == one.peak_negative
        assert f"{one.peak_negative:.4g} rad, {one.peak_ratio:.4g} of its critical" in verdict({"nonlinear": one}, {})


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """The reports of a structure without a block and of a loaded facade: page as text, and data."""
    found = {}
    for name, fields in (("tied", TIED), ("leaning", LEANING)):
        folder = tmp_path_factory.mktemp(name)
        write(folder, fields)
        options = ("--pulse", "sine:0.5g:0.7s", "--neighbours", 5)
        data = run_json("report", folder / "s.yaml", *options, "-o", folder / "r.html")
        page = re.sub(r"<script.*?</script>|<svg.*?</svg>", "", (folder / "r.html").read_text("utf-8"), flags=re.S)
        found[name] = re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", " ", page))), data
    return found


@pytest.mark.usefixtures("small_maps")
class TestReport:
    def test_each_part_that_needs_a_block_says_why_there_is_none(self, told):
        text, data = told["tied"]
        why = "its restoring moment does not vanish before the kinematic limit of 1.571 rad"
        assert why in data["no_block"]
        for said in (
            "The nonlinear model; no other is available. No single block is equivalent",
            "the only model available here. No single block is equivalent",
            "No map is given: its axes need the frequency parameter p of an equivalent block",
            "No equivalent block exists here, so there is no error to report: no single block",
            "Check the largest tie forces in this report against the capacity of the ties and their anchorages.",
        ):
            assert said in text
        assert "φcr and does not come back" not in text and "κ" not in text
        assert all(list(each["responses"]) == ["nonlinear"] for each in data["motions"][0]["polarities"].values())
        assert data["parameters"]["positive"]["p"] is None and data["parameters"]["positive"]["lambda"] > 0.2

    @pytest.mark.parametrize(("which", "tie"), [("tied", "tendon"), ("leaning", "bar")])
    def test_ties_are_told_with_their_largest_force_of_either_way_round(self, told, which, tie):
        text, data = told[which]
        (motion,) = data["motions"]
        runs = [each["responses"]["nonlinear"] for each in motion["polarities"].values()]
        force = max(abs(run["ties"][tie]["peak_force"]) for run in runs) / 1000
        assert f"{tie} has the largest force: {force:.3g} kN in tension, under {motion['name']}." in text

    def test_loads_are_told_with_their_shares(self, told):
        text, _ = told["leaning"]
        assert "floor block 0.2; 5 2000 1 0.333 0.5" in text
        assert "The supports that it leans on are assumed not to move." in text
        assert "It rocks in the positive direction only" in text
        assert "Constant forces" in text

    @pytest.mark.rest
    def test_a_fall_has_no_largest_movement(self, tmp_path):
        leaning = write(tmp_path, LEANING | {"ties": [BAR | {"stiffness": 1.0}]})
        out = tmp_path / "r.html"
        run("report", leaning, "--pulse", "sine:1g:1.5s", "--neighbours", 5, "-o", out)
        page = out.read_text("utf-8")
        assert "the structure overturns in at least one polarity: it has no largest displacement" in page
        assert re.search(r"bar has the largest force: \S+ kN in tension, under sine:1g:1\.5s\.", page)  # borne before


class TestStudies:
    STUDY = """\
name: tied
structures: [s.yaml]
records: [{pulse: "sine:1g:0.6s"}, {pulse: "ricker:1g:0.5s"}]
method: stripes
levels: {measure: PGA, values: [0.1, 0.3, 0.6]}
limit_states: [uplift, 0.0005, overturning]
"""

    def test_a_study_follows_what_has_no_block_by_itself(self, tied, tmp_path):
        (tmp_path / "study.yaml").write_text(self.STUDY)
        found = run_json("fragility", tmp_path / "study.yaml", "--store", "s.runs")
        assert found["runs"] == found["finished"] == 6 and found["failed"] == 0 and found["left_out"] == []
        (said,) = found["without_block"]
        assert said.startswith("tied: no equivalent single block exists") and "kinematic limit" in said
        run("results", "s.runs", "--out", "runs.csv")
        rows = rows_of("runs.csv")
        assert {row["p PGV/(g lambda)"] for row in rows} == {""} and rows[0]["PGA/(g lambda)"] != ""
        one = next(row for row in rows if row["motion"] == "sine:1g:0.6s" and float(row["level"]) == 0.6)
        alone = run_json("respond", tied, "--pulse", "sine:1g:0.6s", "--scale", 0.6, "--neighbours", 0)
        assert float(one["peak_ratio"]) == pytest.approx(alone["responses"]["nonlinear"]["peak_ratio"], rel=1e-6)

    @pytest.mark.parametrize(
        ("change", "what"),
        [(("measure: PGA", "measure: p PGV/(g lambda)"), "p PGV/(g lambda) cannot be had of it"),
         (("method: stripes", "method: stripes\nmodel: linear2"), "the model linear2 cannot be had of it"),
         (("method: stripes", "method: stripes\nbivariate: [[PGA, p PGV/(g lambda)]]"), "p PGV/(g lambda) cannot be")],
    )  # fmt: skip
    def test_a_study_that_asks_for_a_block_is_refused_with_the_reason(self, change, what, tied, tmp_path):
        (tmp_path / "study.yaml").write_text(self.STUDY.replace(*change))
        said = run("fragility", tmp_path / "study.yaml", "--store", "s.runs", code=2).stderr
        assert what in said and "does not vanish before the kinematic limit" in said

    def test_a_spectrum_refuses_what_has_no_block(self, tied):
        said = run("spectrum", tied, "--pulse", "sine:0.4g:0.8s", "--sizes", "2:6", "--count", "3", code=2).stderr
        assert "no single block is equivalent to it" in said

    @pytest.mark.parametrize(("loads", "says"), [({"loads": [FLOOR]}, True), ({}, False)])
    def test_a_spectrum_says_what_is_scaled(self, loads, says, tmp_path):
        path = write(tmp_path, {"width": 1, "height": 4, "density": 2000, "depth": 1, **loads})
        text = run("spectrum", path, "--pulse", "sine:0.4g:0.8s", "--sizes", "4:6", "--count", "3").stdout
        assert ("their masses, stiffness and forces are not" in " ".join(text.split())) is says

    def test_margin_finds_the_factors_of_what_has_no_block(self, tied):
        (found,) = run_json("margin", tied, "--pulse", "sine:0.4g:0.8s", "--neighbours", 3)["motions"]
        uplift = run_json("equiv", tied)["directions"]["positive"]["lambda"]
        assert found["uplift"] == pytest.approx(uplift / 0.4, rel=1e-3)
        assert found["overturned"] == 0
