"""One free body in three dimensions: against closed forms, quadrature and the plane, and what is asked of it."""

import json
import sys
from functools import cache
from math import atan, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import quad

import rocking_cli as rk
from rocking_cli.ask.ground_motions import motion_of
from rocking_cli.cli.main import main
from rocking_cli.names import NO_UPLIFT, OVERTURNS, ROCKS, SLIDES, STILL_ROCKING, UNKNOWN
from rocking_cli.studies.engines import scene, space
from rocking_cli.studies.engines.solid_body import SolidBody, solid_of
from rocking_cli.studies.engines.space import follow_in_space, follow_twice
from rocking_cli.studies.engines.space_history import CheckedHistory, SpaceHistory
from rocking_cli.testing.mechanism import contract
from tests.conftest import EXAMPLES
from tests.following import respond

pytest.importorskip("mujoco", reason="free blocks need mujoco")

G = 9.80665
COLUMN = SolidBody.cylinder(0.5, 2.0)
STRONG, ACROSS = "sine:0.3g:1s", f"sine:0.2g:{1 / 1.3}s"


def pulse(text):
    return text if text is None else motion_of(text)


@cache
def twice(solid, x, y=None, z=None):
    return follow_twice(solid, pulse(x), pulse(y), pulse(z), only_outcome=True)


def energy(history):
    """Energy over the weight [m], from rest, of a history."""
    solid = history.solid
    _, x, y, _ = history.turned.T
    level = history.moved[:, 2] - solid.level * (2 * (x**2 + y**2))
    velocity, omega = np.split(history.rates, 2, axis=1)
    moving = (velocity**2).sum(axis=1) + np.einsum("ni,ij,nj->n", omega, solid.inertia, omega)
    return level + moving / (2 * G)


@pytest.mark.parametrize(
    ("width", "depth", "height", "along"), [(0.7, 0.9, 2.8, 0), (0.7, 0.9, 2.8, 1), (0.7, 1.2, 1.4, 0)]
)
def test_a_box_that_moves_along_a_side_rocks_as_in_the_plane(width, depth, height, along):
    side = (width, depth)[along]
    text = f"sine:{1.3 * side / height:.4f}g:0.8s"
    solid = SolidBody.box(width, depth, height)
    history = follow_in_space(solid, *[None] * along, pulse(text), only_outcome=True)
    plane = respond(rk.Block(width=side, height=height), pulse(text), models=["nonlinear"])["nonlinear"]
    assert (history.outcome, plane.words) == (ROCKS, ROCKS)
    assert history.tilt.max() == pytest.approx(plane.peak_ratio * atan(side / height), rel=0.005)
    assert np.abs(history.twist).max() < 1e-6 and np.abs(history.moved[:, 1 - along]).max() < 1e-6


def test_a_box_overturns_as_in_the_plane():
    for text in ("sine:0.5g:0.9s", "sine:0.6g:0.9s"):
        plane = respond(rk.Block(width=0.7, height=2.8), pulse(text), models=["nonlinear"])["nonlinear"]
        assert twice(SolidBody.box(0.7, 0.9, 2.8), text).outcome == plane.words
    assert plane.fell


def test_a_column_under_one_component_and_under_two(monkeypatch):
    alone, both = twice(COLUMN, STRONG), twice(COLUMN, STRONG, ACROSS)
    assert alone.outcome == ROCKS and both.outcome == OVERTURNS
    assert alone.history.peak_ratio == pytest.approx(0.2805, rel=0.005)  # as another model of MuJoCo had it
    assert alone.halved.peak_ratio == pytest.approx(0.281, rel=0.005)
    assert both.history.overturning_time == pytest.approx(both.halved.overturning_time, abs=0.005)
    monkeypatch.setattr(SolidBody, "fallen", 1.25)
    falls = follow_in_space(SolidBody.cylinder(0.5, 2.0), pulse(STRONG), pulse(ACROSS))
    assert np.interp(1.2, falls.tilt, falls.time) == pytest.approx(1.964, abs=0.004)
    plane = respond(rk.Block(width=0.5, height=2.0, section="round"), pulse(STRONG), models=["nonlinear"])
    assert alone.history.peak_ratio == pytest.approx(plane["nonlinear"].peak_ratio, rel=0.005)
    assert alone.history.rolled < 1e-6 < 0.5 < both.history.rolled


def first_impact(arm, inertia, alpha, tilt):
    """Time from rest at a tilt to upright about a fixed edge, by its energy [s]; inertia about it over the mass."""

    def rate(phi):
        return sqrt(2 * G * arm * (cos(alpha - tilt) - cos(alpha - phi)) / inertia)

    # phi = tilt (1 - u^2) takes away the singularity at the start
    return quad(lambda u: 2 * u * tilt / rate(tilt * (1 - u * u)), 1e-12, 1)[0]


@pytest.mark.parametrize("solid", [SolidBody.box(0.6, 0.8, 2.4), SolidBody.cylinder(0.6, 2.4)], ids=["box", "round"])
def test_a_release_over_an_edge_meets_the_ground_when_quadrature_says(solid):
    arm = hypot(0.3, 1.2)
    history = follow_in_space(solid, None, start_tilt=0.6 * solid.alpha, only_outcome=True, tail=2.0)
    down = int((history.lean[:, 0] <= 0).argmax())
    time = np.interp(0, -history.lean[[down - 1, down], 0], history.time[[down - 1, down]])
    expected = first_impact(arm, solid.inertia[1, 1] + arm**2, solid.alpha, 0.6 * solid.alpha)
    assert time == pytest.approx(expected, rel=0.001)


def test_a_square_box_released_on_its_corner_meets_the_ground_when_quadrature_says():
    """In the plane of its diagonal, in which it stays by symmetry, it turns about the corner alone."""
    solid, arm, alpha = SolidBody.box(0.6, 0.6, 2.4), hypot(0.3 * sqrt(2), 1.2), atan2(0.3 * sqrt(2), 1.2)
    tilt = 0.6 * alpha
    history = follow_in_space(solid, None, start_tilt=tilt, azimuth=pi / 4, only_outcome=True, tail=2.0)
    along = history.lean @ [cos(pi / 4), sin(pi / 4)]
    assert np.abs(history.lean @ [-sin(pi / 4), cos(pi / 4)])[: int((along <= 0.1 * along[0]).argmax())].max() < 1e-3
    down = int((along <= 0).argmax())
    time = np.interp(0, -along[[down - 1, down]], history.time[[down - 1, down]])
    inertia = (0.6**2 + 2.4**2) / 12 + arm**2  # of a square box the same about every horizontal axis
    assert time == pytest.approx(first_impact(arm, inertia, alpha, tilt), rel=0.003)


@pytest.mark.parametrize("azimuth", [0.0, 0.3, pi / 4])
@pytest.mark.parametrize("solid", [SolidBody.box(0.6, 0.8, 2.4), SolidBody.cylinder(0.6, 2.4)], ids=["box", "round"])
def test_energy_does_not_grow_after_a_release(solid, azimuth, monkeypatch):
    spin = (0.0, 0.0, 0.0) if azimuth else (-0.2, 0.0, 0.5)  # of a round foot: it rolls
    monkeypatch.setattr(space, "LONGEST_TAIL", 3.0)
    history = follow_in_space(solid, None, start_tilt=0.5 * solid.alpha, azimuth=azimuth, spin=spin, tail=3.0)
    values = energy(history)[:600].reshape(-1, 20)  # contacts give back what they store in an impact
    assert values[0, 0] > 0.01 and np.diff(values.max(axis=1)).max() < 3e-4 * values[0, 0] > 3e-4 * values[-1, -1]


def steady(diameter, height, tilt):
    """Rate of the azimuth of a cylinder that rolls on its rim with its centroid at rest [rad/s], and its spin.

    The axis e leans by theta, the rim touches at r = X u - Z z from the centroid, u to where it leans, v = z x u. With
    omega = W z + n e, W of the azimuth, the point that touches is at rest: W X + n R = 0. The momentum is
    C (W cos + n) e - A W sin e', e' = cos u - sin z; the force of the ground, g z, has the moment -g X v, and
    dL/dt = W (C (W cos + n) sin - A W sin cos) v.
    """
    r, h = diameter / 2, height / 2
    across, axial = (3 * r**2 + height**2) / 12, r**2 / 2
    away = r * cos(tilt) - h * sin(tilt)
    rate = sqrt(G * away / (sin(tilt) * (across * cos(tilt) - axial * (cos(tilt) - away / r))))
    spin = -rate * away / r
    return rate, (-rate * sin(tilt), 0.0, rate * cos(tilt) + spin)


@pytest.mark.parametrize(("diameter", "height", "tilt"), [(1.0, 0.1, 0.3), (0.5, 2.0, 0.1)], ids=["disc", "column"])
def test_a_cylinder_that_wobbles_steadily_turns_at_the_rate_of_the_closed_form(diameter, height, tilt, monkeypatch):
    rate, spin = steady(diameter, height, tilt)
    solid = SolidBody.cylinder(diameter, height, friction=2.0)
    monkeypatch.setattr(space, "LONGEST_TAIL", 2.0)

    def rounds():
        history = follow_in_space(solid, None, start_tilt=tilt, spin=spin, only_outcome=True)
        ends = int(2 * 2 * pi / rate / history.time[1])  # after two rounds
        levels = energy(history)
        turned = np.unwrap(history.azimuth[: ends + 1])[-1] / rate / history.time[ends]
        return turned, history.tilt[ends] / tilt, levels[ends] / levels[ends // 8]

    turned, leans, left = rounds()
    assert turned == pytest.approx(1, abs=0.004) and leans == pytest.approx(1, abs=0.006)
    assert left == pytest.approx(1, abs=0.002)
    monkeypatch.setattr(space, "ROLLING", 1e9)  # without what a rim that rolls needs
    turned, leans, left = rounds()
    assert turned < 0.99 and leans > 1.01


def test_a_box_that_slides_goes_as_far_as_the_closed_form():
    solid = SolidBody.box(1.0, 1.0, 0.5, friction=0.4)
    push, lasts = 0.7 * G, 0.5
    motion = rk.GroundMotion("step", 0.001, np.full(501, push), unit="m/s2")
    brake = 0.4 * G
    speed = (push - brake) * lasts
    distance = speed * lasts / 2 + speed**2 / (2 * brake)
    for components, axis in (((motion,), 0), ((None, motion), 1)):
        history = follow_in_space(solid, *components)
        assert history.outcome == SLIDES
        assert history.moved[-1, axis] == pytest.approx(-distance, rel=0.001)
        assert history.path[-1] == pytest.approx(distance, rel=0.001)


def test_vertical_motion_lifts_the_weight():
    flat = rk.GroundMotion("up", 0.01, np.full(200, -0.5 * G), unit="m/s2")
    text, solid = "sine:0.2g:1s", SolidBody.box(0.7, 0.9, 2.8)
    assert follow_in_space(solid, pulse(text)).outcome == NO_UPLIFT
    assert follow_in_space(solid, pulse(text), None, flat, only_outcome=True).outcome != NO_UPLIFT


def test_x_and_y_may_be_exchanged():
    solid = SolidBody.box(0.7, 0.7, 2.8)
    one = follow_in_space(solid, pulse("sine:0.35g:0.8s"), pulse("cosine:0.2g:0.8s"), only_outcome=True)
    other = follow_in_space(solid, pulse("cosine:0.2g:0.8s"), pulse("sine:0.35g:0.8s"), only_outcome=True)
    assert one.peak_ratio > 0.1 and one.peak_ratio == pytest.approx(other.peak_ratio, rel=0.01)
    n = int(0.5 / one.time[1])  # later, rounding makes a difference
    assert np.abs(one.moved[:n, :2] - other.moved[:n, 1::-1]).max() < 1e-3 * one.path.max()
    assert one.twist[n] == pytest.approx(-other.twist[n], abs=1e-4)


def test_no_uplift_below_lambda_in_any_direction(monkeypatch):
    monkeypatch.setattr(space, "LONGEST_TAIL", 0.5)
    time = np.arange(401) * 0.01
    for solid in (COLUMN, SolidBody.box(0.5, 0.5, 2.0)):
        for share, words in ((0.98, [NO_UPLIFT]), (1.15, [ROCKS, STILL_ROCKING])):
            ramp = share * 0.25 * G * np.minimum(time / 2, 1)
            x, y = (
                rk.GroundMotion("turning", 0.01, ramp * wave(2 * pi * time / 0.7), unit="m/s2")
                for wave in (np.cos, np.sin)
            )
            assert follow_in_space(solid, x, y, only_outcome=True).outcome in words


def test_a_tilt_that_oscillates_in_a_plane_is_no_rolling_and_one_that_goes_round_is():
    solid = SolidBody.cylinder(1.0, 2.0)
    angle = np.linspace(0, 2 * pi, 400)

    def history(leans_x, leans_y):
        turned = np.stack([np.ones(400), -0.005 * leans_y, 0.005 * leans_x, np.zeros(400)], axis=1)
        turned /= np.linalg.norm(turned, axis=1)[:, None]
        return SpaceHistory(solid=solid, time=angle, moved=np.zeros((400, 3)), turned=turned, rates=np.zeros((400, 6)))

    assert history(np.cos(3 * angle), 1e-9 * np.sin(angle)).rolled < 1e-6
    assert history(np.cos(angle), np.sin(angle)).rolled == pytest.approx(2 * pi * 0.5, rel=1e-3)


def test_a_history_that_ends_early_has_the_same_outcome_and_peak():
    solid = SolidBody.box(0.7, 0.9, 2.8)
    kick = np.concatenate([0.3 * np.sin(np.linspace(0, 2 * pi, 81)), np.zeros(400), 0.5 * np.ones(20), [0.0]])
    motion = rk.GroundMotion("late", 0.01, kick, unit="g")  # it has tilted least when the motion ends
    whole, early = (follow_in_space(solid, motion, only_outcome=each) for each in (False, True))
    n = len(early.time)
    assert (early.outcome, early.peak_ratio) == (whole.outcome, whole.peak_ratio) and n < len(whole.time)
    assert whole.tilt[: len(kick)].max() < 0.9 * whole.tilt.max()


def test_the_second_history_decides_whether_the_outcome_is_known():
    rocks, falls = twice(COLUMN, STRONG).history, twice(COLUMN, STRONG, ACROSS).history
    weaker = follow_in_space(COLUMN, pulse("sine:0.29g:1s"), only_outcome=True)
    assert CheckedHistory(rocks, rocks).outcome == ROCKS and not CheckedHistory(rocks, rocks).doubt
    for other, word in ((falls, "overturns"), (weaker, "the peak is")):
        checked = CheckedHistory(rocks, other)
        assert checked.outcome == UNKNOWN and word in checked.doubt
    assert CheckedHistory(rocks, falls).unsettled == "its turn and its displacement"


@pytest.mark.parametrize(
    ("mechanism", "alpha", "inertia"),
    [
        (rk.Block(width=0.6, height=2.4, depth=0.4), atan(1 / 6), (0.16 + 5.76, 0.36 + 5.76, 0.36 + 0.16)),
        (rk.Block(width=0.6, height=2.4, section="round"), atan(0.25), (0.27 + 5.76, 0.27 + 5.76, 0.54)),
        (
            rk.RigidBody(polygon=[[1, 0], [1.6, 0], [1.6, 2.4], [1, 2.4]], depth=0.4),
            atan(1 / 6),
            (0.16 + 5.76, 0.36 + 5.76, 0.36 + 0.16),
        ),
        (
            rk.Cone(base_radius=0.5, height=2.0, kind="solid"),
            atan(1.0),
            (1.8 * 0.25 + 0.45 * 4, 1.8 * 0.25 + 0.45 * 4, 3.6 * 0.25),
        ),
    ],
    ids=["block", "round", "polygon", "cone"],
)
def test_inertia_and_alpha_of_structures(mechanism, alpha, inertia):
    solid = solid_of(mechanism)
    assert solid.alpha == pytest.approx(alpha)
    np.testing.assert_allclose(12 * solid.inertia, np.diag(inertia), atol=1e-12)


def test_a_prism_has_the_moments_of_its_triangles():
    outline = np.array([0, 1, 1.2 + 2j, 0.1 + 1.5j])
    solid = SolidBody.prism(outline, 0.5)
    rng = np.random.default_rng(0)
    points = rng.uniform((0, -0.25, 0), (1.2, 0.25, 2), (400_000, 3))
    z = points[:, 0] + 1j * points[:, 2]
    inside = np.all(
        [((z - a).conj() * (b - a)).imag < 0 for a, b in zip(outline, np.roll(outline, -1), strict=True)], axis=0
    )
    points = points[inside] - points[inside].mean(axis=0)
    squares = points.T @ points / len(points)
    np.testing.assert_allclose(solid.inertia, np.trace(squares) * np.eye(3) - squares, atol=3e-3)


def asked(tmp_path, *more, fields="depth: 0.9", code=0):
    """What `respond --3d` prints of a block, and its errors."""
    file = tmp_path / "box.yaml"
    file.write_text(f"mechanism: block\nwidth: 0.7\nheight: 2.8\n{fields}\n", encoding="utf-8")
    done = CliRunner().invoke(main, ["respond", str(file), "--pulse", "sine:0.32g:0.8s", *map(str, more)])
    assert done.exit_code == code, done.output
    return done


IN_SPACE = ("--engine", "blocks", "--3d")


def test_it_is_asked_in_english(tmp_path):
    text = asked(tmp_path, *IN_SPACE, "--transverse", "sine:0.2g:0.6s", "--all").stdout
    assert "In three dimensions (experimental) the body rocks to 0.2" in text
    assert "In the plane, under the component along x alone, by one degree of freedom: rocks to 0.2" in text
    assert "Its friction is assumed to be 0.6" in text and "largest tilt over alpha" in text


def test_it_answers_in_json_and_writes_files(tmp_path):
    table, plot = tmp_path / "t.csv", tmp_path / "p.svg"
    done = asked(tmp_path, *IN_SPACE, "--json", "--out", table, "--plot", plot, fields="section: round\nfriction: 0.5")
    data = json.loads(done.stdout)
    assert data["experimental"] and data["outcome"] == data["plane"]["outcome"] == ROCKS and data["doubt"] is None
    assert data["history"]["peak_ratio"] == pytest.approx(data["plane"]["peak_ratio"], rel=0.01)
    assert data["halved"]["peak_ratio"] == pytest.approx(data["history"]["peak_ratio"], rel=0.01)
    assert (data["friction"], data["components"]) == (0.5, ["sine:0.32g:0.8s", None, None])
    assert table.read_text("utf-8").startswith("t [s],tilt [rad],azimuth [rad],twist [rad],x [m],y [m]\n")
    assert "three dimensions" in plot.read_text("utf-8")


def test_components_are_scaled_and_reversed_together(tmp_path):
    record = rk.read_record(EXAMPLES / "accel.csv")
    block = rk.Block(width=0.7, height=2.8, depth=0.9)
    how = {"engine": "blocks", "in_space": True, "scale": 0.4, "polarity": -1}
    answer = rk.respond(block, record, transverse=EXAMPLES / "accel_transverse.csv", vertical=record, **how)
    x, y, z = answer.motions
    across = rk.read_record(EXAMPLES / "accel_transverse.csv").acceleration
    for given, expected in ((x, -record.acceleration), (y, -across), (z, record.acceleration)):
        np.testing.assert_allclose(given.acceleration, 0.4 * expected)


def test_a_mesh_of_a_box_is_the_box(tmp_path):
    from tests.meshes import box, obj

    mesh = tmp_path / "box.obj"
    mesh.write_bytes(obj(box((0.0, 0.0, 0.0), (700.0, 900.0, 2800.0))))
    of_file = json.loads(asked(tmp_path, *IN_SPACE, "--json").stdout)
    of_mesh = json.loads(asked(tmp_path, *IN_SPACE, "--json", "--mesh", mesh, "--mesh-units", "mm", fields="").stdout)
    assert of_mesh["alpha"] == pytest.approx(of_file["alpha"])
    assert of_mesh["history"]["peak_ratio"] == pytest.approx(of_file["history"]["peak_ratio"], rel=1e-3)
    assert "give --mesh-units" in asked(tmp_path, *IN_SPACE, "--mesh", mesh, code=2).stderr


@pytest.mark.parametrize(
    ("more", "fields", "words"),
    [
        (IN_SPACE, "", "depth is missing for three dimensions"),
        (("--3d",), "depth: 0.9", "--3d has no effect without --engine blocks"),
        (("--transverse", "sine:0.2g:1s"), "depth: 0.9", "--transverse has no effect without --3d"),
        ((*IN_SPACE, "--restitution", "0.9"), "depth: 0.9", "--restitution has no effect in three dimensions"),
        ((*IN_SPACE, "--polarity", "both"), "depth: 0.9", "give one polarity"),
        ((*IN_SPACE, "--pulse", "sine:0.4g:1s"), "depth: 0.9", "--3d has no effect with several motions"),
        ((*IN_SPACE, "--transverse", "gone.csv"), "depth: 0.9", "gone.csv"),
        (IN_SPACE, "depth: 0.9\none_sided: positive\nrebound: 0.5", "one_sided cannot be simulated"),
        (IN_SPACE, "depth: 0.9\nmass: 100.0\nloads: [{name: a, mass: 9.0, at: [0, 2.8]}]", "loads cannot be simulated"),
    ],
)
def test_what_cannot_be_simulated_is_refused_by_name(more, fields, words, tmp_path):
    assert words in asked(tmp_path, *more, fields=fields, code=2).stderr


def test_other_structures_are_refused():
    for file, words in (("frame.yaml", "has 3"), ("point_mass.yaml", "its shape in three dimensions is not known")):
        with pytest.raises(rk.InputError, match=words):
            rk.respond(EXAMPLES / file, STRONG, engine="blocks", in_space=True)


def test_without_mujoco_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    monkeypatch.setattr(scene, "find_spec", lambda name: None)
    with pytest.raises(rk.InputError, match=r"pip install 'rocking-cli\[blocks\]'"):
        rk.respond(rk.Block(width=0.5, height=2.0, section="round"), STRONG, engine="blocks", in_space=True)


def test_a_round_block_is_a_cylinder():
    r, h = 0.25, 2.0
    block = rk.Block(width=2 * r, height=h, section="round", density=2000.0)
    body = block.bodies()[0]
    assert body.inertia == pytest.approx((3 * r**2 + h**2) / 12)
    about_foot = block.kinetic_inertia(np.zeros(1), block.directions[0])[0] / block.total_mass()
    assert about_foot == pytest.approx(5 * r**2 / 4 + h**2 / 3)
    assert block.total_mass() == pytest.approx(2000 * pi * r**2 * h)
    (solid,) = block.solids()["block"]
    assert solid.mass == pytest.approx(block.total_mass())
    assert block.round_foot() == pytest.approx((r, r**2 / 2))
    assert block.weaker_side() is None and block.rebound_from_impacts() is None and not block.may_rock_about_depth()
    assert "may roll on its rim" in block.cautions()[0]
    for field, value in (("depth", 0.5), ("plane", "width")):
        with pytest.raises(rk.InputError, match=f"{field} cannot be combined with section: round"):
            rk.Block(width=0.5, height=2.0, section="round", **{field: value})
    assert all(each.passed for each in contract(block))
