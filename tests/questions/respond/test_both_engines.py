"""Free blocks beside one degree of freedom: who simulates what, when both part, what is said, and the film of both."""

import json
import re
from dataclasses import replace
from math import cos, isnan, nan, sin

import numpy as np
import pytest
from PIL import Image

import rocking_cli as rk
from rocking_cli.ask.inputs import structure_of
from rocking_cli.core import Direction
from rocking_cli.questions.respond.film import scene_of
from rocking_cli.questions.respond.picture import draw_history
from rocking_cli.studies import response as study
from rocking_cli.studies.both_engines import joints_of
from rocking_cli.studies.engines import free as engine
from rocking_cli.studies.engines import scene
from rocking_cli.studies.engines.blocks import BlockMotion
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.studies.picture import picture
from rocking_cli.views.engines import agreement
from rocking_cli.views.verdict import verdict
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

pytest.importorskip("mujoco", reason="free blocks need mujoco")

SHORT = rk.Block(width=1.0, height=2.0, name="short")  # it soon comes to rest
BRIEF = rk.GroundMotion("brief", 0.01, 8.0 * np.sin(np.pi * np.arange(41) / 40), unit="m/s2")
SMOOTH = rk.Block(width=0.4, height=2.2, density=1000, depth=1, friction=0.19)  # it slides before it rocks
STRONG = "sine:0.6g:1.6s"  # soon overturns it as a free block
ACCEL = EXAMPLES / "accel.csv"
PORTAL = EXAMPLES / "masonry" / "portal.yaml"

LOADS = {
    "symmetric_frame": {"body": "columns", "at": [0.2, 3.0], "each": True},
    "arch": {"body": "segment 1", "at": [-7.0, 6.4]},  # on the second voussoir of this link
}


@pytest.fixture(scope="module")
def answer():
    return rk.respond(SHORT, BRIEF, engine="blocks")


@pytest.fixture(scope="module")
def found(answer):
    return answer.engines[1]


@pytest.fixture
def simulated(answer, found, monkeypatch):
    """Nothing is simulated again."""
    monkeypatch.setattr(study, "histories", lambda *given: (answer.runs[1], found, ""))


@pytest.fixture(scope="module")
def unasked():
    return rk.respond(SMOOTH, STRONG)


def changed(found, *, until=None, unknown=False, fell=False, by=1.0):
    """The comparison with other free blocks: other rotations from a time on, or an outcome of their own."""
    ratio = np.where(found.of_blocks.time >= (until or 0.0), by, 1.0) * found.of_blocks.ratio
    blocks = replace(
        found.of_blocks, ratio=ratio, peak_ratio=float(np.abs(ratio).max()), fell_to=int(fell), overturning_time=1.0
    )
    exact = found.exact
    if unknown:
        known = exact.time <= 0.5
        exact = replace(
            exact, unknown=True, known_to=0.5, phi=np.where(known, exact.phi, nan),
            ratio=np.where(known, exact.ratio, nan), check=replace(exact.check, reason="opens", joint="a and b"),
        )  # fmt: skip
    return replace(found, of_blocks=blocks, exact=exact)


def runs_of(both):
    return {"nonlinear": both.exact, "blocks": both.of_blocks}


def lines_of(runs, motion):
    return {line.get_label(): line for line in draw_history(runs, motion, "").axes[1].get_lines()}


def test_free_blocks_go_on_by_themselves_where_a_history_ends(unasked):
    """What is known until when stays that of one degree of freedom; both are in the first sentence."""
    told, (exact, blocks) = unasked.to_dict(), runs_of(unasked.engines[1]).values()
    assert exact.unknown and blocks.fell and next(iter(unasked)) == "nonlinear" and "blocks" in unasked
    assert told["responses"]["nonlinear"]["outcome"] == told["conclusion"]["concluded"] == "unknown"
    assert told["responses"]["nonlinear"]["overturned"] is None
    assert told["conclusion"]["known_until"] == exact.known_to < blocks.overturning_time
    assert told["responses"]["blocks"]["outcome"] == "overturned" and told["conclusion"]["blocks"] == {
        "concluded": "overturns", "peak_ratio": None, "slip": None, "time": blocks.overturning_time
    }  # fmt: skip
    assert told["conclusion"]["next"] == ["hold_joint", "strengthen", "margin"]
    assert told["engines"]["finding"] == "exact_unknown" and told["no_blocks"] is None
    text = unasked.sentences[0]
    assert text.index(f"unknown after {exact.known_to:.4g} s") < text.index(f"{blocks.overturning_time:.4g} s")
    asked = rk.respond(SMOOTH, STRONG, engine="auto")
    assert np.array_equal(asked["blocks"].phi, blocks.phi, equal_nan=True)  # to the last bit, and again


def test_the_exact_engine_leaves_it_out_and_names_who_goes_on(unasked):
    answer = rk.respond(SMOOTH, STRONG, engine="exact")
    told = answer.to_dict()
    assert (
        "blocks" not in answer and "blocks" not in told["conclusion"] and told["engines"] is told["no_blocks"] is None
    )
    assert "free_blocks" in told["conclusion"]["next"]
    assert "`rocking respond` with the engine `auto`" in answer.sentences[0]
    assert answer["nonlinear"].known_to == unasked["nonlinear"].known_to


def test_without_mujoco_all_is_as_by_the_exact_engine(monkeypatch):
    monkeypatch.setattr(scene, "find_spec", lambda name: None)
    answer, exact = rk.respond(SMOOTH, STRONG), rk.respond(SMOOTH, STRONG, engine="exact")
    assert answer.sentences == exact.sentences
    assert answer.to_dict() | {"given": 0} == exact.to_dict() | {"given": 0}
    said = run("respond", "--pulse", "sine:0.3g:0.8s", "--engine", "blocks", code=2).stderr
    assert "pip install 'rocking-cli[blocks]'" in said


def test_beyond_the_bound_it_is_told_who_goes_on(unasked, monkeypatch):
    """Steps times bodies of the whole motion count: one fewer, and free blocks do not go on unless they are asked."""
    free, moved = free_blocks(SMOOTH), unasked.engines[1].moved
    lasts = max(unasked.first.duration, moved.time[-1]) + engine.SETTLING * free.unit_of_time
    steps = lasts / engine.BlockModel(free).step
    monkeypatch.setattr(study, "MOST_UNASKED_STEPS", 1.01 * steps)
    assert "blocks" in rk.respond(SMOOTH, STRONG)
    assert set(rk.respond(SMOOTH, STRONG, polarity="both").engines) == {1, -1}  # each has the bound
    monkeypatch.setattr(study, "MOST_UNASKED_STEPS", 0.99 * steps)
    left = rk.respond(SMOOTH, STRONG)
    told = left.to_dict()
    assert "blocks" not in left and f"{0.99 * steps:,.0f} steps" in told["no_blocks"]
    assert told["conclusion"]["concluded"] == "unknown" and "free_blocks" in told["conclusion"]["next"]
    said = " ".join(left.sentences)
    assert told["no_blocks"][1:] in said and "`rocking respond` with the engine `auto`" in said
    assert "blocks" in rk.respond(SMOOTH, STRONG, engine="auto")


def test_beside_free_blocks_the_equivalent_blocks_end_where_one_degree_of_freedom_does(unasked):
    runs = unasked.runs[1]
    lines = lines_of(runs, unasked.first)
    (linear,) = (line for label, line in lines.items() if "kappa_2" in label)
    assert linear.get_label().endswith("$") and linear.get_xdata()[-1] <= runs["nonlinear"].known_to
    assert lines["free blocks"].get_xdata()[-1] > runs["nonlinear"].known_to


def test_what_crushes_is_unknown_to_free_blocks_too():
    weak = rk.Block(width=0.7, height=2.8, density=2000, depth=1, strength={"stress": "0.3 MPa", "width": "5 cm"})
    for engine_name in (None, "auto"):
        answer = rk.respond(weak, ACCEL, engine=engine_name)
        told = answer.to_dict()
        assert (
            answer["nonlinear"].crushes and "blocks" not in answer and told["no_blocks"] == "free blocks cannot crush"
        )
        assert "free_blocks" not in told["conclusion"]["next"]


def test_a_rebound_that_is_not_known_is_not_assumed(tmp_path):
    text = (EXAMPLES / "linkages" / "leaning_slab.yaml").read_text("utf-8")
    (tmp_path / "slab.yaml").write_text(re.sub(r"(?m)^rebound:.*$", "", text), "utf-8")
    answer = rk.respond(tmp_path / "slab.yaml", release=0.5)
    assert answer["nonlinear"].unmeasured and "blocks" not in answer


def test_the_rotation_is_that_of_the_body_that_leads():
    """The slab that leans on the pier turns as fast at rest, and less beyond."""
    structure = structure_of(EXAMPLES / "linkages" / "leaning_slab.yaml")
    free, phi = free_blocks(structure.mechanism), 0.9 * structure.model("nonlinear").phi_cr[0]
    assert [lead.block for lead in free.leads] == ["pier"]
    assert free.rotation(free.tilted(structure.mechanism, phi)[None]) == pytest.approx([phi], abs=1e-9)


@pytest.mark.parametrize("side", [1, -1])
def test_a_block_that_falls_by_itself_gives_its_direction(found, side):
    free = replace(found.free)
    moved = replace(found.moved, moved=np.zeros((3, 1, 3)), rates=np.zeros((3, 1, 3)), time=np.arange(3.0))
    moved.moved[-1, 0, 0] = 0.8 * side
    moved = replace(moved, collapsed=2.0, block=free.bodies[0].name)
    assert engine.outcome_of(moved, free, (0.3, 0.3))["fell_to"] == side


def test_the_bound_ends_a_free_motion_too(monkeypatch):
    monkeypatch.setattr(study, "MOST_UNASKED_STEPS", 2000)  # a second or so of a motion that lasts longer
    flat = rk.Block(width=1.6, height=1.0, friction=3.0)  # kinematics give no restitution
    answer = rk.respond(flat, release=0.5)
    assert "blocks" not in answer and "more than 2,000 steps" in answer.to_dict()["no_blocks"]


def test_free_blocks_that_fail_are_no_result(monkeypatch):
    monkeypatch.setattr("rocking_cli.studies.engines.blocks.BlockModel._fault", lambda *state: "a step diverged")
    answer = rk.respond(SMOOTH, STRONG)
    told = answer.to_dict()
    assert "blocks" not in answer and "blocks" not in told["conclusion"] and "a step diverged" in told["no_blocks"]
    assert any("a step diverged" in sentence for sentence in answer.sentences)
    assert "free blocks failed" in run("respond", "--release", "0.3", "--engine", "blocks", code=4).stderr


def test_nothing_else_is_simulated_as_free_blocks_unasked(monkeypatch):
    """A known history, several motions, neighbours, margins and reports."""
    monkeypatch.setattr(engine.Blocks, "__init__", lambda *given: pytest.fail("free blocks are simulated"))
    rk.respond(SHORT, BRIEF)
    answers = rk.respond(SMOOTH, [STRONG, "sine:0.5g:1.6s"], neighbours=2)
    assert all(each["nonlinear"].unknown and "blocks" not in each for each in answers.values())
    rk.margin(SMOOTH, STRONG, neighbours=2)
    with pytest.raises(pytest.fail.Exception):
        rk.respond(SMOOTH, STRONG)


def test_neighbours_of_a_history_that_goes_on_are_those_of_one_degree_of_freedom():
    near = {engine: rk.respond(SMOOTH, STRONG, neighbours=2, engine=engine).neighbours[1] for engine in (None, "exact")}
    assert near[None].unknown == near["exact"].unknown > 0


class TestParting:
    def test_a_block_moves_as_by_the_exact_engine(self, answer, found):
        assert found.finding == "agree" and isnan(found.parted)
        assert found.peak_quotient == pytest.approx(1.0, abs=0.02)
        assert found.peak_quotient == found.of_blocks.peak_ratio / np.abs(found.exact.ratio).max()
        assert re.search(r"block\. The structure rocks to 0\..* As free blocks, it", answer.sentences[0])
        assert answer.sentences[1].startswith("The engines agree: the structure rocks, with a peak of 0.")

    @pytest.mark.parametrize("until", [0.2, 0.4])
    def test_they_part_at_the_first_sample_that_differs_by_a_twentieth_of_the_larger_peak(self, found, until):
        growing = 1 + 3 * np.clip(found.of_blocks.time - until, 0.0, None)
        other = changed(found, by=growing)
        most = max(max(map(abs, other.exact.ratio)), max(map(abs, other.of_blocks.ratio)))
        pairs = zip(other.of_blocks.time, other.of_blocks.ratio, other.exact.ratio, strict=False)
        first = next(time for time, one, two in pairs if abs(one - two) > 0.05 * most)
        assert other.parted == first > until

    def test_what_soft_contacts_turn_by_is_no_difference(self, found):
        still = replace(found.exact, ratio=0 * found.exact.ratio)
        assert isnan(replace(changed(found, by=1e-3), exact=still).parted)
        assert replace(changed(found, by=1.0), exact=still).parted > 0

    @pytest.mark.parametrize(
        ("how", "finding", "words"),
        [
            ({"by": 1.04}, "agree", "The engines agree"),
            ({"by": 1.2}, "peaks_differ", "their peaks differ by more than 5 %"),
            ({"fell": True}, "outcomes_differ", "by free blocks it overturns clockwise at"),
            ({"unknown": True}, "exact_unknown", "the joint between a and b has opened"),
        ],
    )
    def test_the_finding_follows_from_outcomes_and_peaks(self, found, how, finding, words):
        other = changed(found, **how)
        said = f"{verdict(runs_of(other), {})} {agreement(other)}"
        assert other.finding == finding and words in said

    def test_a_peak_below_what_is_known_is_said_to_be(self, found):
        """Both bounds: that before the first warning, and that until all ends."""
        other = changed(found, unknown=True)
        peak = other.of_blocks.peak_ratio
        for warned, bound, less in ((nan, peak / 0.98, "2 %"), (0.3, peak / 0.9, "10 %")):
            exact = replace(other.exact, warned=warned, lower_bound=bound, peak_ratio=2 * peak)
            said = verdict(runs_of(replace(other, exact=exact)), {})
            assert f"The peak of free blocks is {less} less than this bound: the engines differ by this" in said
        assert "less than this bound" not in verdict(runs_of(other), {})

    def test_nothing_that_contacts_give_way_by_is_a_number(self, found):
        def said(**peaks):
            run = replace(found.of_blocks, blocks=found.of_blocks.blocks._replace(**peaks))
            return verdict(runs_of(replace(found, of_blocks=run)), {})

        least, least_turn = found.moved.least, found.moved.least_turn
        assert 1e-5 < least < 1e-3 and 1e-5 < least_turn < 1e-3
        nothing = {"moved": (0.9 * least, "a"), "left": (2e-6, "a"), "turned": (0.9 * least_turn, "a")}
        assert said(**nothing).endswith("No block moves by more than its soft contacts let it.")
        assert "and all blocks return to their places; no block turns by more" in said(left=(2e-6, "short"))
        assert "and short stays 30 mm from its place" in said(left=(0.03, "short"))
        assert f"no block turns by more than {least_turn:.2g} rad." in said(turned=nothing["turned"])
        assert f"No block moves by more than {1000 * least:.3g} mm, and all blocks" in said(
            moved=(1e-6, "a"), left=(2e-6, "a")
        )

    def test_what_is_unknown_is_not_compared(self, found):
        other = changed(found, until=0.51, by=3.0, unknown=True)
        assert other.compared_to == 0.5 and isnan(other.parted)
        assert other.peaks[1] == np.abs(found.of_blocks.ratio[:51]).max()
        assert "never differ" in agreement(other) and "as free blocks, it rocks" in verdict(runs_of(other), {})

    def test_a_history_at_rest_stays_at_rest(self, found):
        later = replace(found.of_blocks, time=np.arange(900) * 0.01, ratio=np.zeros(900), phi=np.zeros(900))
        longer = replace(found, of_blocks=later)
        assert longer.compared == 900 and longer.extended(longer.exact.phi)[-1] == 0.0


class TestJoints:
    """The portal: its lower left block turns about its foot, and the one on it is pushed and lifted off it."""

    TURN, PUSH, LIFT = 0.02, 0.004, 0.007

    @pytest.fixture
    def joints(self):
        mechanism = structure_of(PORTAL).mechanism
        free = free_blocks(mechanism)
        names = [body.name for body in free.bodies]
        moved = np.zeros((4, len(names), 3))
        for k, share in ((1, 0.5), (2, 1.0), (3, -1.0)):
            for name, push, lift in (("left low", 0.0, 0.0), ("left high", self.PUSH, self.LIFT)):
                # Clockwise about the foot (0.9, 0), and the upper block along and off the turned face.
                turn, at = -share * self.TURN, free.bodies[names.index(name)].centroid - 0.9
                x = cos(turn) * at.real - sin(turn) * at.imag - at.real
                y = sin(turn) * at.real + cos(turn) * at.imag - at.imag
                push, lift = share * push, share * lift
                x += cos(turn) * push - sin(turn) * lift
                y += sin(turn) * push + cos(turn) * lift
                moved[k, names.index(name)] = x, y, turn
        motion = BlockMotion(
            time=0.1 * np.arange(4), moved=moved, rates=moved, friction={("left high", "left low"): 0.3}
        )
        return {each.name: each for each in joints_of(mechanism, free, motion, 0.005)}

    def test_opening_and_slip_are_along_the_face_that_turns(self, joints):
        first = joints["left low and left high"]
        assert first.opening == pytest.approx(self.LIFT, rel=1e-9)
        assert first.slip == pytest.approx(self.PUSH, rel=1e-9)
        assert first.passed == pytest.approx(0.2) and first.friction == 0.3

    @pytest.mark.parametrize("sign", [1, -1])
    def test_joints_that_hinge_in_one_direction_count_in_the_other(self, sign):
        mechanism = structure_of(EXAMPLES / "arch.yaml").mechanism
        free = free_blocks(mechanism)
        moved = np.stack([np.zeros((len(free.bodies), 3)), free.tilted(mechanism, sign * 0.1)])
        motion = BlockMotion(time=np.array([0.0, 1.0]), moved=moved, rates=moved)
        joints = joints_of(mechanism, free, motion, 0.005)
        assert len(joints) > 4 and max(max(each.opening, each.slip) for each in joints) < 1e-9

    def test_only_joints_that_stay_closed_are_listed_the_widest_first(self, joints):
        assert list(joints) == ["left low and left high", "right low and right high"]
        other = joints["right low and right high"]
        assert other.opening == other.slip == 0.0 and isnan(other.passed) and isnan(other.friction)


class TestFilm:
    """The picture of free blocks is that of the mechanism, if they move as the mechanism does."""

    @pytest.mark.every(4)
    @pytest.mark.parametrize(
        "file", ["block", "arch", "symmetric_frame", "walls/facade", "walls/floor_wall", "masonry/portal"]
    )
    @pytest.mark.parametrize("sign", [1, -1])
    def test_blocks_loads_and_ties_are_where_the_mechanism_has_them(self, answer, found, file, sign):
        structure = structure_of(EXAMPLES / f"{file}.yaml")
        if file in LOADS:
            load = {"name": "statue", "mass": 500.0, **LOADS[file]}
            structure = structure_of(structure.mechanism.replace(density=2500.0, depth=1.0, loads=[load]))
        if Direction(sign) not in structure.mechanism.directions:
            return
        free, drawn = free_blocks(structure.mechanism), picture(structure.mechanism)
        phi = sign * 0.3 * drawn.reference[Direction(sign)]
        moved = np.stack([np.zeros((len(free.bodies), 3)), free.tilted(structure.mechanism, phi)])
        motion = replace(found.moved, time=np.array([0.0, 1.0]), moved=moved)
        both = replace(found, free=free, moved=motion)
        ours = scene_of(structure, replace(answer.result, engines={1: both})).films[1].picture
        for at, time in ((0.0, 0.0), (phi, 1.0), (phi, 7.0)):
            theirs, mine = (
                {complex(np.round(z, 6)) for part in parts for polygon in part for z in polygon}
                for parts in (drawn.placed(at)[0], ours.placed(time)[0])
            )
            assert theirs <= mine
            np.testing.assert_allclose(ours.held(time), drawn.held(at), atol=1e-9)
            assert ours.hung(time, 0.0)[2] == drawn.hung(at, 0.0)[2]

    def test_both_share_a_clock_and_the_exact_one_stops_where_it_is_unknown(self, answer, found):
        other = changed(found, unknown=True)
        both = replace(answer.result, runs={1: runs_of(other)}, engines={1: other})
        exact, blocks = scene_of(structure_of(SHORT), both).films
        assert exact.stops == 0.5 and exact.name == "exact engine"
        assert blocks.stops > 1e9 and blocks.enlargement == 1.0
        time = np.array([0.2, 0.25])
        assert np.array_equal(blocks.place(time), time)
        np.testing.assert_allclose(blocks.rotation(time), np.interp(time, other.of_blocks.time, other.of_blocks.phi))

    def test_the_page_shows_both(self, tmp_path, simulated):
        rk.respond(SHORT, BRIEF, engine="blocks", animate=tmp_path / "both.html")
        text = (tmp_path / "both.html").read_text("utf-8")
        data = json.loads(text.split('type="application/json">')[1].split("</script>")[0])
        exact, blocks = data["stages"]
        assert (exact["name"], blocks["name"]) == ("exact engine", "free blocks")
        assert "place" not in exact and blocks["place"][-1] == pytest.approx(data["end"], abs=data["step"])
        assert data["enlargement"] == 1

    def test_blocks_that_go_on_by_themselves_are_in_the_film(self, tmp_path, unasked, monkeypatch):
        monkeypatch.setattr(study, "histories", lambda *given: (unasked.runs[1], unasked.engines[1], ""))
        rk.respond(SMOOTH, STRONG, animate=tmp_path / "both.html")
        assert '"free blocks"' in (tmp_path / "both.html").read_text("utf-8")

    @pytest.mark.parametrize(
        ("runs", "why", "said"),
        [
            ("known", "", "alone, as it tells the outcome, and free blocks were not requested (--engine blocks)"),
            ("unknown", "free blocks take more", "alone, as free blocks take more: --engine auto simulates them"),
            ("unknown", "", "alone, as free blocks do not go on: --engine auto simulates them, or says why not"),
        ],
    )
    def test_a_film_without_them_says_why(self, tmp_path, found, monkeypatch, runs, why, said):
        exact = changed(found, unknown=runs == "unknown").exact
        monkeypatch.setattr(study, "histories", lambda *given: ({"nonlinear": exact}, None, why))
        file = tmp_path / "alone.html"
        command = ("respond", "--pulse", "sine:0.3g:0.8s", "--neighbours", 0, "--animate", file)
        assert said in " ".join(run(*command).stderr.split())
        assert '"free blocks"' not in file.read_text("utf-8")

    def test_what_is_known_has_a_film_of_its_own(self, answer, found):
        alone = replace(answer.result, engines={})
        assert [each.name for each in scene_of(structure_of(SHORT), alone).films] == ["exact engine"]

    @pytest.mark.rest
    def test_a_gif_shows_both_in_every_frame(self, tmp_path, simulated):
        rk.respond(SHORT, BRIEF, engine="blocks", animate=tmp_path / "both.gif")
        with Image.open(tmp_path / "both.gif") as film:
            assert film.n_frames > 20
            film.seek(film.n_frames // 2)
            moving = np.asarray(film.convert("RGB"))[:400]
        half = moving.shape[1] // 2
        assert all((part != 255).any(axis=2).mean() > 0.02 for part in (moving[:, :half], moving[:, half:]))


def test_marks_of_free_blocks_are_named_as_theirs_and_are_on_their_curve(unasked, answer, found):
    runs = unasked.runs[1]
    named = lines_of(runs, unasked.first)
    fall = runs["blocks"].overturning_time
    collapse = named[f"free blocks: collapse at {fall:.4g} s, outside the panel"]
    assert f"free blocks: uplift at {runs['blocks'].uplift_time:.4g} s" in named
    assert np.array_equal(collapse.get_xydata()[0], named["free blocks"].get_xydata()[-1])
    early = replace(runs["blocks"], ratio=0.1 * runs["blocks"].ratio)  # in the panel as it collapses
    named = lines_of(runs | {"blocks": early}, unasked.first)
    assert named[f"free blocks: collapse at {fall:.4g} s"].get_xydata()[0] == pytest.approx([fall, early.ratio[-1]])
    assert sum(name.startswith("free blocks: peak 0.") for name in lines_of(runs_of(found), BRIEF)) == 1


def test_the_plot_shows_until_when_each_goes_and_when_they_part(found):
    other = changed(found, unknown=True)
    axes = draw_history(runs_of(other), BRIEF, "title", parted=[0.3]).axes[1]
    named = {each.get_label(): each for each in axes.lines}
    (exact,), (blocks,) = (
        [line for name, line in named.items() if name.startswith(of) and ":" not in name] for of in ("nonl", "free")
    )
    assert max(exact.get_xdata()) <= 0.5 < max(blocks.get_xdata())
    assert [*named["both engines part at 0.3 s"].get_xdata()] == [0.3, 0.3]


def test_the_command_prints_what_the_verb_returns(answer, tmp_path, simulated):
    file = tmp_path / "short.yaml"
    file.write_text("mechanism: block\nname: short\nwidth: 1\nheight: 2\n", encoding="utf-8")
    command = ("respond", file, "--pulse", "sine:0.3g:0.8s", "--engine", "blocks")
    data = run_json(*command, "--out", tmp_path / "both.csv", "--plot", tmp_path / "both.svg")
    assert data["engines"]["verdict"] == answer.to_dict()["engines"]["verdict"] and data["engines"]["joints"] == []
    table = np.genfromtxt(tmp_path / "both.csv", delimiter=",", names=True)
    assert len(table) == len(answer["blocks"].time) and (tmp_path / "both.svg").exists()
    assert table["blocks_phi_rad"] == pytest.approx(answer["blocks"].phi, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"motions": BRIEF, "engine": "exact", "animate": "a.html"}, "without free blocks: leave out `engine`"),
        ({"motions": BRIEF, "model": "linear1", "animate": "a.html"}, "`animate` has no effect without the nonlinear"),
        ({"motions": ACCEL, "with_pulse": "best", "engine": "auto"}, "leave out `engine`, so that they go on"),
        ({"motions": [BRIEF, BRIEF.scaled(2)], "engine": "auto", "animate": "a.html"}, "has no effect with several"),
        ({"motions": BRIEF, "polarity": "both", "engine": "auto", "animate": "a.html"}, "effect with `polarity` both"),
        ({"release": 0.3, "animate": "a.html", "engine": "blocks"}, "`animate` has no effect without a ground motion"),
        ({"motions": BRIEF, "animate": "a.txt", "engine": "blocks"}, "does not end in .html or .gif or .mp4"),
        ({"motions": BRIEF, "model": "linear1", "engine": "blocks"}, "`model` has no effect with free blocks"),
        ({"motions": BRIEF, "structure": EXAMPLES / "curve.yaml", "engine": "blocks"}, "a body of unknown shape"),
    ],
)  # fmt: skip
def test_what_cannot_be_compared_is_refused(given, words):
    with pytest.raises(rk.InputError, match=words):
        rk.respond(**{"structure": SHORT} | given)


@pytest.mark.parametrize(("name", "instead"), [("crosscheck", "respond"), ("score", "validation.score")])
def test_what_is_gone_names_what_does_its_work(name, instead):
    assert instead in run(name, "a.yaml", code=2).stderr
    with pytest.raises(ImportError, match=instead):
        exec(f"from rocking_cli import {name}")
    assert not hasattr(rk, name)


@pytest.mark.rest
def test_the_portal_agrees_and_the_arch_collapses():
    portal = rk.respond(PORTAL, ACCEL, engine="blocks").engines[1]
    assert portal.finding == "agree" and not portal.parted < 7.5  # impacts drift apart by 20 ms in eight
    for history in (portal.exact, portal.of_blocks):
        assert max(history.peak_positive, history.peak_negative) == pytest.approx(0.0742, rel=0.01)
    arch = rk.respond(EXAMPLES / "masonry" / "buttressed_arch.yaml", ACCEL, scale=0.7).engines[1]
    assert arch.finding == "exact_unknown" and arch.of_blocks.fell
    assert 3.2 < arch.parted < arch.exact.known_to < arch.joints[0].passed < arch.of_blocks.overturning_time


@pytest.mark.parametrize(
    ("fields", "refused"),
    [
        ({}, None),
        ({"stops": [{"point": [0.4, 2.0], "gap": 0.05, "name": "wall", "restitution": 0.5}]}, "stops"),
        ({"crushing": {"strength": 2e6}}, "pivots that crush"),
    ],
)
def test_they_are_advised_where_they_are_not_refused(fields, refused):
    block = SMOOTH.replace(**fields)
    for motions in (["sine:0.3g:0.8s", "sine:0.32g:0.8s"], "sine:0.3g:0.8s"):
        answer = rk.respond(block, motions, model="nonlinear", engine="exact")
        ends = [each.conclusion for each in answer.values()] if isinstance(motions, list) else [answer.conclusion]
        assert all(end.concluded == "unknown" and ("free_blocks" in end.next) == (refused is None) for end in ends)
        said = " ".join(str(part) for part in answer.view.parts)
        assert ("the engine `auto`" in said) == (refused is None) and "`rocking margin` shows up to which" in said
    if refused is not None:
        assert rk.respond(block, motions, model="nonlinear").sentences == answer.sentences
        with pytest.raises(rk.InputError, match=refused):
            rk.respond(block, motions, engine="blocks")


def test_a_release_is_compared_until_an_impact_whose_restitution_is_unknown():
    flat = rk.Block(width=1.6, height=1.0, friction=3.0)  # kinematics give no restitution
    answer = rk.respond(flat, release=0.5)
    both, alpha, radius = answer.engines[1], np.arctan2(1.6, 1.0), np.hypot(0.8, 0.5)
    start = 0.5 * alpha
    # The energy of a fall from rest gives the rate; s with phi = start - s^2 takes away its zero at the start.
    s = (np.arange(200_000) + 0.5) / 200_000 * np.sqrt(start)
    rate = np.sqrt(1.5 * 9.80665 / radius * (np.cos(alpha - start) - np.cos(alpha - start + s**2)))
    first_impact = np.sum(2 * s / rate) * np.sqrt(start) / 200_000
    assert both.exact.unmeasured and both.exact.known_to == pytest.approx(first_impact, rel=1e-6)
    assert both.finding == "exact_unknown" and both.peaks == pytest.approx([0.5, 0.5], rel=1e-2)
    assert "it has an impact, and its restitution is not known" in answer.to_dict()["engines"]["verdict"]
    for asked in (None, "auto", "blocks"):
        with pytest.raises(rk.InputError, match="restitution"):
            rk.respond(flat, "sine:2g:0.5s", engine=asked)
