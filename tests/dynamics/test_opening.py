"""Joints released alone beside a history: how far they open, and until when its result stands."""

import json
from dataclasses import replace
from functools import cache
from itertools import pairwise, product
from math import isnan, nan
from types import SimpleNamespace

import numpy as np
import pytest

from rocking_cli import GroundMotion, Registry, load_structure, read_record
from rocking_cli.core import Direction
from rocking_cli.core.released import Undetermined, released, tabulated_impulses
from rocking_cli.dynamics import openings
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.joints import _calm, _within
from rocking_cli.dynamics.modes import modes
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS
from rocking_cli.errors import InputError
from rocking_cli.names import OPENING
from rocking_cli.views.verdict import joints_in_words
from tests.conftest import EXAMPLES, SHARED
from tests.following import build_model, respond
from tests.oracle.openings import openings as other_openings

BLOCKS = SHARED / "blocks" / "assemblies.json"
ACCEL = EXAMPLES / "accel.csv"
NEVER = nan


@cache
def structure(name, **fields):
    return structure(name).model_copy(update=fields) if fields else load_structure(EXAMPLES / name)


def nonlinear(made, opening=OPENING):
    return build_model(made, "nonlinear", opening)


def history(made, factor=1.0, file=ACCEL, **how):
    return respond(made, read_record(file).scaled(factor), models=("nonlinear",), **how)["nonlinear"]


# Of each: first warning, when an opening of 0.5 % is passed [s], and the largest opening over D_cr. By two programs.
PUBLISHED = [
    ("masonry/buttressed_arch.yaml", {}, 0.48972, [
        (0.4, 3.586, NEVER, 0.00337), (0.5, 3.195, 3.772, 0.1148), (0.6, 3.248, 3.320, 0.3865),
        (0.7, 3.249, 3.319, 0.4661), (1.0, 1.865, 3.314, 0.8992)]),
    ("masonry/portal.yaml", {"friction": 0.6}, 0.89495, [
        (1.0, NEVER, NEVER, 0.0), (1.5, 3.364, NEVER, 0.00056), (1.75, 3.300, 3.498, 0.00544),
        (2.0, 3.298, 3.498, 0.0350)]),
    ("assembly.yaml", {"friction": 0.6}, 0.97931, [
        (1.0, 3.091, NEVER, 0.00101), (1.5, 3.044, 3.331, 0.3448)]),
]  # fmt: skip


@pytest.mark.parametrize(("name", "fields", "reach", "rows"), PUBLISHED, ids=lambda value: str(value)[:24])
def test_values_that_two_other_programs_agree_on(name, fields, reach, rows):
    made = structure(name, **fields)
    for factor, warned, passed, opening in rows:
        found = history(made, factor)
        assert found.check.reach == pytest.approx(reach, rel=1e-4)
        assert found.opening == pytest.approx(opening, rel=0.02, abs=1e-4)
        for ours, theirs in ((found.warned, warned), (found.known_to, passed)):
            assert ours == pytest.approx(theirs, abs=0.01, nan_ok=True)
        assert found.unknown == (not isnan(passed))
        assert found.words == ("unknown" if found.unknown else "rocks")


@pytest.mark.every(2)
@pytest.mark.parametrize(("name", "factor"), [("masonry/buttressed_arch.yaml", 0.5), ("masonry/portal.yaml", 1.75)])
def test_motion_and_openings_are_those_of_a_program_that_shares_nothing(tmp_path, name, factor):
    """Over seven seconds, in which both reach their peaks."""
    strong = tmp_path / "strong.csv"
    strong.write_text("".join(ACCEL.read_text(encoding="utf-8").splitlines(keepends=True)[:703]), encoding="utf-8")
    theirs, found = other_openings(EXAMPLES / name, strong, factor), history(structure(name), factor, file=strong)
    assert found.check.reach == pytest.approx(theirs.reach, rel=1e-9)
    assert found.opening == pytest.approx(theirs.largest, rel=0.001)
    assert found.known_to == pytest.approx(theirs.passed, abs=0.0015)  # each says it at its next node
    made = structure(name)
    whole = history(made, factor, file=strong, opening=1.0)
    assert whole.uplift_time == pytest.approx(theirs.motion.uplifts[0], abs=1e-9)
    for impact in theirs.motion.impacts:
        if impact.before > 1e-3:  # not those of before rest, which comes a little sooner or later
            times = whole.impacts[whole.impacts[:, 1] == impact.side, 0]
            assert abs(times - impact.time).min() < 1e-9
    for direction, peak in zip(Direction, (whole.peak_positive, whole.peak_negative), strict=True):
        assert peak == pytest.approx(theirs.turned(made.collapse(direction).lead, int(direction)), rel=1e-8)


@pytest.mark.rest
@pytest.mark.skipif(not BLOCKS.is_file(), reason=f"no assemblies in {BLOCKS}")
def test_seventy_assemblies_followed_by_two_engines_of_free_blocks():
    stated, wrong = 0, []
    for name, case in json.loads(BLOCKS.read_text(encoding="utf-8")).items():
        made = Registry()["assembly"](**{k: v for k, v in case["structure"].items() if k != "mechanism"})
        motion = GroundMotion(name, case["record"]["dt"], 9.80665 * np.array(case["record"]["a_g"]), unit="m/s2")
        found = respond(made, motion, models=("nonlinear",))["nonlinear"]
        theirs = case["opening"]
        assert found.check.reach == pytest.approx(theirs["D_cr"], rel=1e-3), name
        assert found.opening == pytest.approx(theirs["share"], rel=0.02, abs=2e-4), name
        assert found.check.passed == pytest.approx(theirs["first"]["0.005"] or nan, abs=0.01, nan_ok=True), name
        if found.unknown:
            continue
        stated += 1
        engines = case["moreau"]["fell"] is not None, case["mujoco"]["fell"] is not None
        if engines[0] == engines[1] != found.overturned and not 0.05 < case["neighbours"]["share"] < 0.95:
            wrong.append(name)
    assert (stated, wrong) == (33, [])


def test_an_arch_and_its_voussoirs_say_the_same():
    for factor in (1.0, 1.5):
        one, other = history(structure("arch.yaml"), factor), history(structure("assembly.yaml"), factor)
        assert one.unknown == other.unknown
        assert one.opening == pytest.approx(other.opening, rel=0.02)
        for field in ("warned", "known_to"):
            assert getattr(one, field) == pytest.approx(getattr(other, field), abs=0.002, nan_ok=True)


def test_an_arch_without_voussoirs_may_open_at_forty_cuts():
    made = structure("arch.yaml", voussoirs=None)
    pieces = made.pieces(Direction.POSITIVE)
    assert len(pieces) >= 40
    assert sum(each.body.mass for each in pieces) == pytest.approx(
        sum(body.mass for body in made.weighed()) * made._beta / (made._cuts[-1] - made._cuts[0])
    )
    assert history(made, 1.5).unknown


CHECKED = [
    file for folder in ("", "masonry", "linkages", "walls") for file in sorted((EXAMPLES / folder).glob("*.yaml"))
]


@pytest.mark.every(2)
@pytest.mark.parametrize("file", CHECKED, ids=lambda file: file.stem)
def test_forces_balance_every_piece_and_uplift_opens_nothing(file):
    made = load_structure(file)
    for direction in made.directions:
        rotations = np.linspace(0.0, 0.5 * made.limit(direction), 5)
        if file.stem in ("portico", "symmetric_frame", "wall_with_openings"):  # columns, bricks: joints too many
            with pytest.raises(Undetermined):
                released(made, direction, rotations)
            continue
        found = released(made, direction, rotations)
        if found is None:
            assert file.stem == "curve"
            continue
        push = -int(direction) * made.uplift(direction) * made.gravity
        at_rest = found.force[0] @ np.array([1.0, push, 0.0, 0.0])
        weight = made.gravity * sum(body.mass for body in made.weighed())
        normals = [row for normal, _ in found.rows for row in normal]
        assert at_rest[normals].min() > -1e-9 * weight
        # All of the weight, and what ties pull, comes down to the ground at rest.
        if not made.attached:
            up = sum(
                (at_rest[row] * contact.normal).imag
                for contact, (normal, _) in zip(found.contacts, found.rows, strict=True)
                for row in normal
                if None in contact.pieces
            ) + sum(
                (at_rest[shear] * -1j * contact.normal).imag
                for contact, (_, shear) in zip(found.contacts, found.rows, strict=True)
                if shear is not None and None in contact.pieces
            )
            moving = sum(each.body.mass for each in made.pieces(direction))
            signs = [1 if contact.pieces[0] is None else -1 for contact in found.contacts if None in contact.pieces]
            if all(sign > 0 for sign in signs):
                assert up == pytest.approx(made.gravity * moving, rel=1e-6)


def test_impulses_are_those_of_the_kinematic_restitution_of_a_block():
    made = Registry()["block"](width=0.7, height=2.8, friction=0.6)
    alpha, eta = np.arctan2(0.7, 2.8), made.eta(Direction.POSITIVE)
    constant, factor = tabulated_impulses(made, Direction.POSITIVE).T
    normal, shear = constant + eta * factor
    assert abs(shear) / normal == pytest.approx((1 - eta) / ((1 + eta) * np.tan(alpha)), rel=1e-9)


@pytest.mark.parametrize("laden", [False, True])
def test_compliance_of_a_block_let_go_at_its_foot(laden):
    """Released in the vertical alone, held along its face: c = 1/(A^-1)_11 of A = J M^-1 J^T, by hand.

    A load at [x, y] about the centroid adds its mass by its shares along x and y, of the velocity of its point.
    """
    b, h, x, y, shares = 0.35, 1.4, 0.2, 1.1, (0.9, 0.4)
    load = {"name": "bust", "mass": 0.3, "at": [x, h + y], "horizontal": 0.9, "vertical": 0.4, "weight": 0.7}
    made = Registry()["block"](width=2 * b, height=2 * h, mass=1.0, loads=[load] if laden else [])
    mass = np.diag([1.0, 1.0, (b * b + h * h) / 3])
    for share, row in zip(shares, ([1.0, 0.0, -y], [0.0, 1.0, x]), strict=True):
        mass += 0.3 * laden * share * np.outer(row, row)
    foot = np.array([[0.0, 1.0, -b], [1.0, 0.0, h]])  # up and sideways
    compliance = foot @ np.linalg.inv(mass) @ foot.T
    found = released(made, Direction.NEGATIVE, np.zeros(1)).compliance[0]
    assert found == pytest.approx(1 / np.diag(np.linalg.inv(compliance)), rel=1e-12)


def test_a_force_of_any_size_has_its_direction():
    """Of the smallest that there is the quotient by its size is no number."""
    bar = {"name": "bar", "from": {"ground": [-1.0, 0.0]}, "to": {"at": [-0.35, 1.0]}, "stiffness": 0.0}
    bare, faint, tied, pulled = (
        released(
            Registry()["block"](width=0.7, height=2.8, mass=1.0, **more), Direction.POSITIVE, np.array([0.0, 0.1])
        ).force
        for more in ({}, *({"ties": [bar | {"prestress": size}]} for size in (5e-323, 1e-3, 1.0)))
    )
    assert faint == pytest.approx(bare, rel=1e-12)
    assert 1e3 * (tied - bare) == pytest.approx(pulled - bare, rel=1e-6, abs=1e-9)
    assert abs(pulled - bare).max() > 0.1


def test_a_lone_block_that_jumps_is_known_no_further():
    """Its foot's force by hand, N/m = g + R [sin(a - phi) phi.. - cos(a - phi) phi.^2], and its opening by sums."""
    r, g, dt = np.sqrt(2), 9.80665, 1e-4
    u = 2.25 * g * np.sin(6 * np.pi * np.arange(4000) * dt)
    motion, made = GroundMotion("sine", dt, u, unit="m/s2"), Registry()["block"](width=2.0, height=2.0)
    found = respond(made, motion, models=("nonlinear",))["nonlinear"]
    whole = respond(made, motion, opening=1e3, models=("nonlinear",))["nonlinear"]
    part = slice(0, u.size)
    lever = np.pi / 4 - abs(whole.phi[part])
    bend = -3 / (4 * r) * (g * np.sin(lever) + np.sign(whole.phi[part]) * u * np.cos(lever))  # Eq. 1
    force = g + r * (np.sin(lever) * bend - np.cos(lever) * whole.rate[part] ** 2)
    first = int(np.argmax((force < 0) & (whole.phi[part] != 0)))
    assert found.warned == pytest.approx(first * dt, abs=2 * dt)
    let_go = np.maximum(-force, 0) / (1 - 0.75 * np.sin(lever) ** 2)  # m - G^2/I of what hangs on its foot
    opening = np.cumsum(np.cumsum(let_go[first:])) * dt**2
    assert found.unknown
    assert found.known_to == pytest.approx((first + np.argmax(opening > 0.005 * found.check.reach)) * dt, abs=5 * dt)
    runs = respond_many([nonlinear(made)], [motion], Runs.of(0, 0, scale=[0.5, 1.0]))
    assert runs.unknown.tolist() == [False, True]
    assert runs.known_to[1] == pytest.approx(found.known_to, abs=dt)


@pytest.mark.parametrize(
    ("name", "fields"),
    [
        ("masonry/buttressed_arch.yaml", {}),
        ("frame.yaml", {}),
        ("wall.yaml", {}),
        ("masonry/portal.yaml", {"friction": 0.6}),
    ],
)
def test_where_the_quick_bounds_hold_every_joint_bears_and_none_slides(name, fields):
    """At the corners of the bounds, somewhere in every third cell: forces are linear in u and q.^2."""
    made = structure(name, **fields)
    joints, random, held = nonlinear(made).joints, np.random.default_rng(3), 0
    for d, place in product(range(2), range(0, len(joints.within), 3)):
        low, low_more, high, high_more, most = joints.within[place, d]
        at = (place + random.random()) / len(joints.within) * len(joints.rows)
        t = at % 1
        force = joints.rows[int(at), d].reshape(-1, 5, 4) @ np.array([1, t, t * t, t**3])
        for y in (0.0, most):
            least, largest = max(low + low_more * y, -50.0), min(high + high_more * y, 50.0)
            for u in (least, largest) if least <= largest else ():
                held += 1
                now = force[:, :4] @ np.array([1.0, u, y, 0.0])
                for one, other, shear, _ in joints.contacts[:, d]:
                    normals = [now[row] for row in (one, other) if row >= 0]
                    assert min(normals, default=0.0) >= 0
                    assert shear < 0 or made.friction is None or abs(now[shear]) <= made.friction * sum(normals)
    assert held > 100


@pytest.mark.parametrize("name", ["masonry/portal.yaml", "wall.yaml", "block.yaml", "frame.yaml"])
def test_below_the_line_of_the_calm_every_joint_bears(name):
    model = nonlinear(structure(name))
    joints, random = model.joints, np.random.default_rng(3)
    most, fastest = joints.calm
    assert most > 0 and fastest > 0
    least = np.inf
    for d, table in enumerate(model.tables):
        cells = len(joints.rows) * table.q(model.phi_cr[d]) / table.end
        normals = [row for row in joints.contacts[:, d, :2].ravel() if row >= 0]
        for at in np.append(cells * random.random(300), [0.0, cells]):
            factors = joints.rows[int(at), d].reshape(-1, 5, 4) @ (at - int(at)) ** np.arange(4.0)
            share = random.choice([0.0, 1.0, random.random()])
            for u in (-share * most, share * most):
                least = min(least, (factors[normals, :4] @ [1.0, u, (1 - share) * fastest, 0.0]).min())
    weight = model.gravity * sum(body.mass for body in structure(name).weighed())
    assert 0 <= least < 0.3 * weight  # and much more would be too much


@pytest.mark.parametrize("rises", [True, False])
def test_the_quick_bounds_of_a_cell_are_those_of_its_weaker_end(rises):
    """A normal force of n - q.^2, n from 1 to 9 or back over one cell, bears up to n."""
    row = np.zeros((1, 1, 5, 4))
    row[0, 0, 0, :2] = (1.0, 8.0) if rises else (9.0, -8.0)
    row[0, 0, 2, 0] = -1.0
    within = _within(row, np.array([[0, -1, -1, 0]]), np.array([[np.nan, np.inf]]))
    ends = np.linspace(*((1.0, 9.0) if rises else (9.0, 1.0)), len(within) + 1)
    least = np.minimum(ends[:-1], ends[1:])
    assert (within[:, 4] <= least).all() and (within[:, 4] > least / 2).all()


@pytest.mark.parametrize("case", ["portal", "lifted", "sliding"])
def test_the_quick_bounds_change_nothing(case):
    """The same histories with every step looked at; a force that lifts does not fall with the weight."""
    motion, g = read_record(ACCEL), 9.80665
    if case == "portal":
        made, factors = structure("masonry/portal.yaml"), [1.5, 1.75]
    elif case == "sliding":
        made, factors = Registry()["block"](width=1.0, height=5.0, friction=0.22), [0.6, 1.0]
    else:
        lift = {"name": "lift", "force": [0.0, 0.8 * 1000 * g], "at": [0.0, 2.5]}
        made, factors = Registry()["block"](width=1.0, height=5.0, mass=1000.0, loads=[lift]), [1.0, 0.5]
        up = GroundMotion("up", 0.01, 0.3 * g * np.sin(4 * np.pi * motion.time), unit="m/s2")
        motion = replace(motion.scaled(0.1), vertical=up)
    model = nonlinear(made)
    within = model.joints.within.copy()
    within[..., 4] = -1.0  # no q.^2 is as small
    other = replace(model, joints=replace(model.joints, within=within, calm=(np.inf, -1.0)))
    found = respond_many([model, other], [motion], Runs.of(np.repeat([0, 1], 2), 0, scale=factors * 2))
    assert np.isfinite(found.warned).any() and found.opening.max() > 0
    for field in OUTCOME_FIELDS:
        one, all_looked_at = np.asarray(getattr(found, field)).reshape(2, -1)
        np.testing.assert_allclose(one, all_looked_at, rtol=1e-9, err_msg=field)


def test_the_reach_is_that_of_the_direction_in_which_it_moves_less():
    """A body goes from rest to over its pivot along a chord, 2 R sin(alpha/2)."""
    made = Registry()["rigid_body"](polygon=[[0, 0], [0.7, 0], [0.3, 2.8], [0, 2.8]])
    (body,) = made.bodies()
    chords = [2 * abs(arm) * np.sin(np.arctan2(abs(arm.real), arm.imag) / 2)
              for arm in (body.centroid - 0.7, body.centroid)]  # fmt: skip
    model = nonlinear(made)
    assert max(chords) > 1.2 * min(chords)
    assert model.joints.reach == pytest.approx(min(chords), rel=1e-9)


def test_columns_alike_bear_together():
    """Of three columns that slide before they rock each joint is one of all: three times 2 MPa x .3 m x 1 m."""
    fields = {"column_width": 1.0, "column_height": 6.0, "mass_ratio": 1.0, "density": 2000.0, "depth": 1.0}
    fields |= {"columns": 3, "friction": 0.1, "strength": {"stress": 2e6, "width": 0.3}}
    joints = nonlinear(Registry()["symmetric_frame"](**fields)).joints
    assert len(joints.labels) == 3 and joints.bearing[:2, 1] == pytest.approx(3 * 2e6 * 0.3)


def test_which_joints_bear_elsewhere_in_the_other_direction():
    """Of a portal the hinges of each direction: those joints start anew at an impact, the others do not."""
    made = structure("masonry/portal.yaml")
    joints = nonlinear(made).joints
    points = {label: [set(), set()] for label in joints.labels}
    for k, direction in enumerate(Direction):
        for contact in made.contacts(direction):
            points[contact.label][k] |= set(contact.points)
    expected = {label: one != other for label, (one, other) in points.items()}
    assert set(expected.values()) == {True, False}
    for label, changes in zip(joints.labels, joints.contacts[:, :, 3], strict=True):
        assert changes.tolist() == [expected[label]] * 2, label


@pytest.mark.parametrize(("most", "fast"), [(5.0, 5.0), (7.0, 6.0)])
def test_the_calm_is_no_faster_than_any_cell_may_be(most, fast):
    """Bounds -2 + y/10 and 3 - y/2 meet zero at y = 20 and 6; cells past phi_cr, half way, do not count."""
    cells = np.tile([-2.0, 0.1, 3.0, -0.5, most], (8, 2, 1))
    cells[4:] = -0.1, 0.1, 0.1, -0.1, 0.01
    table, side = SimpleNamespace(q=lambda phi: phi, end=1.0), SimpleNamespace(reference=0.5)
    assert _calm(cells, [table, table], [side, side]) == pytest.approx((2.0, fast))


def test_samples_end_with_the_record_where_nothing_later_is_a_result():
    motion = read_record(ACCEL)
    short = replace(motion, acceleration=2 * motion.acceleration[:361])
    found = respond(structure("masonry/portal.yaml"), short, models=("nonlinear",))["nonlinear"]
    whole = respond(structure("masonry/portal.yaml"), short, opening=1e3, models=("nonlinear",))["nonlinear"]
    assert found.unknown and found.known_to < short.duration < whole.impacts[-1, 0]  # it rocks on after the record
    assert found.time[-1] == pytest.approx(short.duration) and whole.time[-1] > short.duration
    for each in (found.phi, found.rate, found.ratio):
        assert (np.isfinite(each) == (found.time <= found.known_to)).all()


def test_what_to_do_next_depends_on_what_the_joint_does():
    slides = history(structure("masonry/portal.yaml"), 2.0)
    assert slides.check.reason == "slides"
    assert "anchor the joint that slides or justify a higher friction" in joints_in_words(slides)
    opens = history(structure("masonry/buttressed_arch.yaml"), 0.6)
    assert opens.check.reason == "opens"
    assert "describe the structure as a linkage that hinges at the joint that opens" in joints_in_words(opens)
    alone = replace(opens, check=replace(opens.check, alone=True))
    assert joints_in_words(alone).endswith("Under this motion, assume that it overturns.")


@pytest.mark.parametrize(("name", "factor", "tilted"), [("block", 1.2, 0.05), ("portal", 1.5, 0.92)])
def test_the_lower_bound_is_the_largest_rotation_until_the_first_warning(name, factor, tilted):
    """The block slides at an impact, the portal on its way back: both have rocked further by then."""
    if name == "block":
        made = Registry()["block"](width=1.0, height=5.0, friction=0.3)
    else:
        made = structure("masonry/portal.yaml")
    found = history(made, factor, opening=1e3)
    ratio = abs(found.ratio)
    now = np.interp(found.warned, found.time, ratio) / found.lower_bound
    assert now == pytest.approx(tilted, abs=0.01)
    assert found.lower_bound == pytest.approx(ratio[found.time <= found.warned].max(), rel=1e-3)
    assert found.lower_bound < 0.2 * found.peak_ratio


def test_what_slides_in_one_motion_adds_to_what_slid_before():
    """At rest the rate ends and the slip stays: of two pulses with quiet between the slip is that of either alone."""
    hair = {"name": "hair", "from": {"ground": [-9.0, 2.5]}, "to": {"at": [0.0, 2.5]}, "stiffness": 1e-6}
    made = Registry()["block"](width=1.0, height=5.0, friction=0.1, restitution=0.01, mass=1000.0, ties=[hair])
    time = 0.005 * np.arange(1600)
    one, other = (
        np.where((time > at) & (time < at + 0.4), size * 9.80665 * np.sin(2 * np.pi * (time - at) / 0.4), 0.0)
        for at, size in ((0.5, 0.5), (5.0, 0.3))
    )
    slips = [
        respond(made, GroundMotion("pulses", 0.005, a, unit="m/s2"), opening=1e3, models=("nonlinear",))[
            "nonlinear"
        ].check.largest
        for a in (one, other, one + other)
    ]
    assert min(slips) > 0.1 and slips[2] == pytest.approx(slips[0] + slips[1], rel=1e-9)


@pytest.mark.parametrize(
    ("end", "before", "accelerations", "time", "after"),
    [
        (0, (0.0, 0.0), (-1.0, 3.0), 2.0, (1.125, 2.25)),  # opens 1.5 s before the end
        (0, (0.5, 1.0), (1.0, 2.0), 1.0, (0.5 + 1 + 4 / 6, 2.5)),
        (0, (0.1, -1.0), (0.0, 0.0), 1.0, (0.0, 0.0)),  # closes, without rebound
        (0, (0.0, 0.0), (-2.0, -1.0), 1.0, (0.0, 0.0)),
        (2, (0.5, 1.0), (-4.0, -4.0), 1.0, (0.5 + 1 / 8, 0.0)),  # stops after v^2/2a, and stays there
        (2, (0.5, 0.0), (-4.0, -4.0), 1.0, (0.5, 0.0)),
        (3, (0.5, 2.0), (0.0, -1.0), 1.0, (0.5 + 2 - 1 / 6, 1.5)),
    ],
)
def test_an_opening_and_a_slip_step_by_step(end, before, accelerations, time, after):
    """Rows 0 and 1 of a joint are its ends, 2 and 3 its slip in either sense; the acceleration is straight."""
    kept = np.zeros((1, openings.KEPT))
    at, rate = [(openings.GAP, openings.GAP_RATE), (openings.SLIP, openings.SLIP_RATE)][end // 2]
    columns = [at + end % 2, rate + end % 2]
    kept[0, columns] = before
    moves = openings.advance_opening(kept, 0, end, *accelerations, time)
    assert kept[0, columns] == pytest.approx(after)
    assert moves == (after[1] > 0 or (end < 2 and after[0] > 0))


def test_a_wider_limit_keeps_the_result():
    assert not history(structure("masonry/portal.yaml"), 1.75, opening=0.01).unknown
    assert history(structure("masonry/portal.yaml"), 1.5, opening=0.0).unknown


def test_the_limit_is_one_of_the_analysis_and_a_file_that_has_it_says_so(tmp_path):
    file = tmp_path / "portal.yaml"
    file.write_text(f"{(EXAMPLES / 'masonry' / 'portal.yaml').read_text(encoding='utf-8')}opening: 0.01\n", "utf-8")
    with pytest.raises(InputError, match=r"portal.yaml:\d+:\d+: opening .*give `opening` to the analysis"):
        load_structure(file)
    with pytest.raises(InputError, match="`opening` must be from 0 to 1000, got 1001"):
        history(structure("masonry/portal.yaml"), opening=1001)


def test_joints_of_more_slender_neighbours_bear_the_whole_acceleration():
    model = nonlinear(structure("masonry/portal.yaml"), 1.0)
    runs = Runs.of(0, 0, scale=[1.5, 1.8], slender=[1.0, 1.2])
    plain, slender = respond_many([model], [read_record(ACCEL)], runs).peak_ratio
    assert plain == pytest.approx(slender, rel=1e-9)  # the motion over phi_cr is that of a weaker ground motion
    plain, slender = respond_many([model], [read_record(ACCEL)], runs).opening
    assert slender > 2 * plain > 0
    one, other = respond_many([model], [read_record(ACCEL)], runs).peak_positive
    assert other == pytest.approx(1.2 * one, rel=1e-9)


def test_crushing_ends_a_history_at_once():
    made = structure("masonry/portal.yaml").model_copy(update={"strength": {"stress": 5e4, "width": 0.05}})
    found = history(made, 1.0)
    assert found.unknown and found.check.reason == "crushes"
    assert found.known_to == pytest.approx(found.uplift_time, abs=0.01)  # its hinges crush as soon as it rocks


def test_nothing_is_known_where_the_ground_falls_away():
    motion = GroundMotion("x", 0.01, np.zeros(200), unit="m/s2")
    down = GroundMotion("y", 0.01, np.where(np.arange(200) == 100, -12.0, 0.0), unit="m/s2")
    found = respond(structure("block.yaml"), replace(motion, vertical=down), models=("nonlinear",))["nonlinear"]
    assert found.unknown
    assert found.known_to == pytest.approx(0.99 + 0.01 * 9.80665 / 12, rel=1e-9)  # on the ramp to -12 m/s2


def test_a_plugin_of_several_bodies_that_names_no_contacts_is_not_checked():
    found = history(structure("curve.yaml"))
    assert found.check is None and isnan(found.opening) and not found.unknown


@pytest.mark.every(4)
@pytest.mark.parametrize(
    ("name", "factor"), [("masonry/portal.yaml", 1.5), ("masonry/portal.yaml", 2.0), ("assembly.yaml", 1.5)]
)
def test_joints_cut_in_two_say_the_same(name, factor):
    made = structure(name)
    model = nonlinear(made)
    contacts = {direction: made.contacts(direction) for direction in Direction}

    class Cut(type(made)):
        def contacts(self, direction):
            found = []
            for each in contacts[direction]:
                if len(each.points) == 1:
                    found.append(each)
                    continue
                middle = sum(each.points) / 2
                halves = ((each.points[0], middle), (middle, each.points[1]))
                found += [replace(each, points=ends, name=f"{each.label} {k}") for k, ends in enumerate(halves)]
            return found

    other = nonlinear(Cut.from_fields({key: getattr(made, key) for key in made.model_fields_set}))
    assert other.joints.rows.shape != model.joints.rows.shape
    one, two = (respond_many([each], [read_record(ACCEL)], Runs.of(0, 0, scale=factor)) for each in (model, other))
    assert one.unknown[0] == two.unknown[0]
    assert one.warned[0] == pytest.approx(two.warned[0], abs=0.005, nan_ok=True)
    assert one.known_to[0] == pytest.approx(two.known_to[0], abs=0.02, nan_ok=True)


def test_where_statics_determines_the_forces_the_modes_are_single_joints():
    """An end that opens, or a contact that slides once mu N - T or mu N + T is used up: force, compliance, impulse."""
    made, direction = structure("masonry/portal.yaml"), Direction.NEGATIVE
    critical = made.critical_rotation(direction)
    rotations = np.linspace(0.0, 0.8 * critical, 5)
    rows, struck = released(made, direction, rotations), tabulated_impulses(made, direction.opposite)
    single = {}
    for contact, (normals, shear) in zip(rows.contacts, rows.rows, strict=True):
        ends = list(normals)
        for k in ends:
            single[contact.label, k] = rows.force[:, k], rows.compliance[:, k], struck[k]
        for sense in (1, -1) if contact.friction is not None else ():
            force, impulse = (
                contact.friction * each[..., ends, :].sum(axis=-2) - sense * each[..., shear, :]
                for each in (rows.force, struck)
            )
            single[contact.label, f"slides {sense}"] = force, rows.compliance[:, shear], impulse
    found = modes(made, direction, rotations, critical)
    assert len(found.released.contacts) >= 5
    for j, contact in enumerate(found.released.contacts):
        force, compliance = found.released.force[:, j], found.released.compliance[:, j]
        size = np.abs(force).max()
        alike = [each for each in single.values() if np.allclose(each[0], force, rtol=0, atol=1e-9 * size)]
        assert len(alike) == 1, contact.label
        assert compliance == pytest.approx(alike[0][1], rel=1e-9)
        assert found.struck[j] == pytest.approx(alike[0][2], rel=1e-9, abs=1e-9 * np.abs(struck).max())


def test_a_wall_in_running_bond_is_checked():
    """A pier of four courses, of one brick and of two halves in turn: most of its joints are redundant."""
    bricks = {}
    for course in range(4):
        edges = (0.0, 0.25, 0.5) if course % 2 else (0.0, 0.5)
        for k, (left, right) in enumerate(pairwise(edges)):
            low = 0.25 * course
            corners = [[left, low], [right, low], [right, low + 0.25], [left, low + 0.25]]
            bricks[f"c{course} {k}"] = {"polygon": corners}
    ground = {"floor": {"polygon": [[-1.0, -0.3], [2.5, -0.3], [2.5, 0.0], [-1.0, 0.0]]}}
    made = Registry()["assembly"](blocks=bricks, ground=ground, friction=0.7, density=1800.0, depth=0.5)
    model = nonlinear(made)
    assert model.joints is not None and model.joints.labels
    found = respond_many([model], [read_record(ACCEL)], Runs.of(0, 0, scale=[1.0, 4.0]))
    assert np.isfinite(found.opening).all()
