"""Both engines side by side: when they part, what joints do as free blocks move, what is said, and the film of both."""

import json
from dataclasses import replace
from math import cos, isnan, nan, sin

import numpy as np
import pytest
from PIL import Image
from rocking_cli.questions.crosscheck.film import scene_of
from rocking_cli.questions.crosscheck.study import joints_of

import rocking_cli as rk
from rocking_cli.ask.inputs import structure_of
from rocking_cli.core import Direction
from rocking_cli.questions.crosscheck import study
from rocking_cli.questions.crosscheck.picture import draw_crosscheck
from rocking_cli.questions.crosscheck.view import verdict
from rocking_cli.studies.engines import scene as engine
from rocking_cli.studies.engines.blocks import BlockMotion
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.studies.picture import picture
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

pytest.importorskip("mujoco", reason="free blocks need mujoco")

SHORT = rk.Block(width=1.0, height=2.0, name="short")  # it soon comes to rest
BRIEF = rk.GroundMotion("brief", 0.01, 8.0 * np.sin(np.pi * np.arange(41) / 40), unit="m/s2")
ACCEL = EXAMPLES / "accel.csv"
PORTAL = EXAMPLES / "masonry" / "portal.yaml"

LOADS = {
    "symmetric_frame": {"body": "columns", "at": [0.2, 3.0], "each": True},
    "arch": {"body": "segment 1", "at": [-7.0, 6.4]},  # on the second voussoir of this link
}


@pytest.fixture(scope="module")
def answer():
    return rk.crosscheck(SHORT, BRIEF)


@pytest.fixture(scope="module")
def found(answer):
    return answer.result


@pytest.fixture
def simulated(found, monkeypatch):
    """Nothing is simulated again."""
    monkeypatch.setattr(study, "crosscheck", lambda *given, **named: found)


def changed(found, *, until=None, unknown=False, fell=False, by=1.0):
    """The comparison with other free blocks: other rotations from a time on, or an outcome of their own."""
    ratio = np.where(found.of_blocks.time >= (until or 0.0), by, 1.0) * found.of_blocks.ratio
    blocks = replace(found.of_blocks, ratio=ratio, peak_ratio=float(np.abs(ratio).max()), fell_to=int(fell))
    exact = found.exact
    if unknown:
        known = exact.time <= 0.5
        exact = replace(
            exact, unknown=True, known_to=0.5, phi=np.where(known, exact.phi, nan),
            ratio=np.where(known, exact.ratio, nan), check=replace(exact.check, reason="opens", joint="a and b"),
        )  # fmt: skip
    return replace(found, of_blocks=blocks, exact=exact)


class TestParting:
    def test_a_block_moves_as_by_the_exact_engine(self, answer, found):
        assert found.finding == "agree" and isnan(found.parted)
        assert found.peak_quotient == pytest.approx(1.0, abs=0.02)
        assert found.peak_quotient == found.of_blocks.peak_ratio / np.abs(found.exact.ratio).max()
        assert answer.sentences[0].startswith("The engines agree: the structure rocks, with a peak of 0.")

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
        assert other.finding == finding and words in verdict(other)

    def test_what_is_unknown_is_not_compared(self, found):
        other = changed(found, until=0.51, by=3.0, unknown=True)
        assert other.compared_to == 0.5 and isnan(other.parted)
        assert other.peaks[1] == np.abs(found.of_blocks.ratio[:51]).max()
        assert "witness" in verdict(other)

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
    def test_blocks_loads_and_ties_are_where_the_mechanism_has_them(self, found, file, sign):
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
        ours = scene_of(structure, replace(found, free=free, moved=motion)).films[1].picture
        for at, time in ((0.0, 0.0), (phi, 1.0), (phi, 7.0)):
            theirs, mine = (
                {complex(np.round(z, 6)) for part in parts for polygon in part for z in polygon}
                for parts in (drawn.placed(at)[0], ours.placed(time)[0])
            )
            assert theirs <= mine
            np.testing.assert_allclose(ours.held(time), drawn.held(at), atol=1e-9)
            assert ours.hung(time, 0.0)[2] == drawn.hung(at, 0.0)[2]

    def test_both_share_a_clock_and_the_exact_one_stops_where_it_is_unknown(self, found):
        other = changed(found, unknown=True)
        exact, blocks = scene_of(structure_of(SHORT), other).films
        assert exact.stops == 0.5 and exact.name == "exact engine"
        assert blocks.stops > 1e9 and blocks.enlargement == 1.0
        time = np.array([0.2, 0.25])
        assert np.array_equal(blocks.place(time), time)
        np.testing.assert_allclose(blocks.rotation(time), np.interp(time, other.of_blocks.time, other.of_blocks.phi))

    def test_the_page_shows_both(self, tmp_path, simulated):
        rk.crosscheck(SHORT, BRIEF, animate=tmp_path / "both.html")
        text = (tmp_path / "both.html").read_text("utf-8")
        data = json.loads(text.split('type="application/json">')[1].split("</script>")[0])
        exact, blocks = data["stages"]
        assert (exact["name"], blocks["name"]) == ("exact engine", "free blocks")
        assert "place" not in exact and blocks["place"][-1] == pytest.approx(data["end"], abs=data["step"])
        assert data["enlargement"] == 1

    @pytest.mark.rest
    def test_a_gif_shows_both_in_every_frame(self, tmp_path, simulated):
        rk.crosscheck(SHORT, BRIEF, animate=tmp_path / "both.gif")
        with Image.open(tmp_path / "both.gif") as film:
            assert film.n_frames > 20
            film.seek(film.n_frames // 2)
            moving = np.asarray(film.convert("RGB"))[:400]
        half = moving.shape[1] // 2
        assert all((part != 255).any(axis=2).mean() > 0.02 for part in (moving[:, :half], moving[:, half:]))


def test_the_plot_ends_the_exact_curve_where_it_is_unknown(found):
    axes = draw_crosscheck(changed(found, unknown=True), "title").axes[-1]
    exact, blocks = (next(each for each in axes.lines if each.get_label() == name)
                     for name in ("exact engine", "free blocks"))  # fmt: skip
    assert max(exact.get_xdata()) <= 0.5 < max(blocks.get_xdata())


def test_the_command_prints_what_the_verb_returns(answer, tmp_path, simulated):
    file = tmp_path / "short.yaml"
    file.write_text("mechanism: block\nname: short\nwidth: 1\nheight: 2\n", encoding="utf-8")
    rows = "".join(f"{0.01 * k:.2f},{a / 9.80665:.9f}\n" for k, a in enumerate(BRIEF.acceleration))
    (tmp_path / "brief.csv").write_text("time [s],a [g]\n" + rows, encoding="utf-8")
    command = ("crosscheck", file, "--record", tmp_path / "brief.csv")
    data = run_json(*command, "--out", tmp_path / "both.csv", "--plot", tmp_path / "both.svg")
    assert [side["engine"] for side in data["histories"].values()] == ["exact", "blocks"]
    for name, mine in answer.to_dict()["histories"].items():
        assert data["histories"][name]["peak_ratio"] == pytest.approx(mine["peak_ratio"], rel=1e-6)
    table = np.genfromtxt(tmp_path / "both.csv", delimiter=",", names=True)
    assert len(table) == 2 * len(answer.result.of_blocks.time) and (tmp_path / "both.svg").exists()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"motions": [BRIEF, BRIEF.scaled(2)]}, "2 motions are given where one is expected"),
        ({"motions": BRIEF, "polarity": "both"}, "`polarity` must be one of 1, -1, got 'both'"),
        ({}, "no excitation is given"),
        ({"release": 0.3, "polarity": -1}, "`polarity` has no effect without a ground motion"),
        ({"release": 0.3, "animate": "a.html"}, "`animate` has no effect without a ground motion"),
        ({"motions": BRIEF, "animate": "a.txt"}, "does not end in .html or .gif or .mp4"),
        ({"motions": BRIEF, "structure": EXAMPLES / "curve.yaml"}, "free blocks cannot have a body of unknown shape"),
    ],
)  # fmt: skip
def test_what_cannot_be_compared_is_refused(given, words):
    with pytest.raises(rk.InputError, match=words):
        rk.crosscheck(**{"structure": SHORT} | given)


def test_without_mujoco_it_says_what_to_install(monkeypatch):
    monkeypatch.setattr(engine, "find_spec", lambda name: None)
    done = run("crosscheck", "--pulse", "sine:0.3g:0.8s", code=2)
    assert "pip install 'rocking-cli[blocks]'" in done.stderr


def test_free_blocks_that_fail_end_with_an_error(monkeypatch):
    monkeypatch.setattr("rocking_cli.studies.engines.blocks.BlockModel._fault", lambda *state: "a step diverged")
    assert "free blocks failed" in run("crosscheck", "--release", "0.3", code=4).stderr


@pytest.mark.rest
def test_the_portal_agrees_and_the_arch_collapses(tmp_path):
    portal = rk.crosscheck(PORTAL, ACCEL)
    assert portal.finding == "agree" and not portal.parted < 7.5  # impacts drift apart by 20 ms in eight
    for run_ in (portal.exact, portal.of_blocks):
        assert max(run_.peak_positive, run_.peak_negative) == pytest.approx(0.0742, rel=0.01)
    arch = rk.crosscheck(EXAMPLES / "masonry" / "buttressed_arch.yaml", ACCEL, scale=0.7)
    assert arch.finding == "exact_unknown" and arch.of_blocks.fell
    assert 3.2 < arch.parted < arch.exact.known_to < arch.joints[0].passed < arch.of_blocks.overturning_time


@pytest.mark.every(3)
@pytest.mark.parametrize(
    ("fields", "refused"),
    [
        ({}, None),
        ({"stops": [{"point": [0.4, 2.0], "gap": 0.05, "name": "wall", "restitution": 0.5}]}, "stops"),
        ({"crushing": {"strength": 2e6}}, "pivots that crush"),
    ],
)
@pytest.mark.parametrize("several", [False, True])
def test_it_is_advised_where_it_is_not_refused(fields, refused, several):
    block = rk.Block(width=0.4, height=2.2, density=1000, depth=1, friction=0.19, **fields)
    motions = ["sine:0.3g:0.8s", "sine:0.32g:0.8s"][: 1 + several]
    answers = rk.respond(block, motions if several else motions[0], model="nonlinear", neighbours=0)
    ends = [each.conclusion for each in answers.values()] if several else [answers.conclusion]
    assert all(end.concluded == "unknown" and ("crosscheck" in end.next) == (refused is None) for end in ends)
    said = " ".join(str(part) for part in answers.view.parts)
    assert ("`rocking crosscheck`" in said) == (refused is None) and "`rocking margin` shows up to which" in said
    if refused is None:
        assert rk.crosscheck(block, motions[0]).finding == "exact_unknown"
    else:
        with pytest.raises(rk.InputError, match=refused):
            rk.crosscheck(block, motions[0])


def test_a_release_is_compared_until_an_impact_whose_restitution_is_unknown(tmp_path):
    flat = rk.Block(width=1.6, height=1.0, friction=3.0)  # kinematics give no restitution
    answer = rk.crosscheck(flat, release=0.5)
    alpha, radius = np.arctan2(1.6, 1.0), np.hypot(0.8, 0.5)
    start = 0.5 * alpha
    # The energy of a fall from rest gives the rate; s with phi = start - s^2 takes away its zero at the start.
    s = (np.arange(200_000) + 0.5) / 200_000 * np.sqrt(start)
    rate = np.sqrt(1.5 * 9.80665 / radius * (np.cos(alpha - start) - np.cos(alpha - start + s**2)))
    first_impact = np.sum(2 * s / rate) * np.sqrt(start) / 200_000
    assert answer.exact.unmeasured and answer.exact.known_to == pytest.approx(first_impact, rel=1e-6)
    assert answer.finding == "exact_unknown" and answer.peaks == pytest.approx([0.5, 0.5], rel=1e-2)
    assert "it has an impact, and its restitution is not known" in answer.to_dict()["verdict"]
    with pytest.raises(rk.InputError, match="restitution"):
        rk.crosscheck(flat, "sine:2g:0.5s")
