"""The check of a history: friction, contact and strength, beside sums over a block that are written out here."""

from dataclasses import replace
from math import atan2, cos, hypot, sin

import numpy as np
import pytest
from matplotlib.text import Text

from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.symmetric_frame import SymmetricFrame
from mechanisms.wall import Wall
from rocking_cli import errors
from rocking_cli import respond as respond_verb
from rocking_cli.ask.read import read_record
from rocking_cli.core.reactions import impulses
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.studies import contact
from rocking_cli.studies.contact import Contacts, _stretches
from rocking_cli.views.verdict import contact_columns, contact_words, joints_in_words
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import respond

G = 9.80665
BLOCK = Block(width=1.0, height=5.0)


def shaking(size=0.35, vertical=0.0, dt=0.005):
    """Three seconds of two sines, and quiet before and after."""
    t = np.arange(0, 8, dt)
    on = (t > 0.5) & (t < 6.5)
    u = np.where(on, np.sin(9 * (t - 0.5)) + 0.6 * np.sin(23.7 * (t - 0.5)), 0.0)
    up = (
        GroundMotion("up", dt, vertical * G * np.where(on, np.sin(17 * (t - 0.5)), 0.0), unit="m/s2")
        if vertical
        else None
    )
    return GroundMotion("sines", dt, size * G * u, vertical=up, unit="m/s2")


def checked(structure, motion, opening=1.0, **options):
    """A history, also of joints that open, which would end some before the first impact, and what is checked of it."""
    history = respond(structure, motion, opening, models=("nonlinear",), **options)["nonlinear"]
    return history, Contacts(structure).check(history, motion)


def of_a_block(phi, rate, u, v, *, width=1.0, height=5.0):
    """|H|/N and N over the mass in one state of a block: signed rotation and rate, all written out."""
    s = np.sign(phi) if phi else np.sign(rate)
    half, alpha = hypot(width, height) / 2, atan2(width, height)
    phi, rate = abs(phi), s * rate
    turning = -(3 / (4 * half)) * ((G + v) * sin(alpha - phi) + s * u * cos(alpha - phi))
    x = s * half * (cos(alpha - phi) * turning + sin(alpha - phi) * rate**2)
    y = half * (sin(alpha - phi) * turning - cos(alpha - phi) * rate**2)
    return abs(x + u) / (y + G + v), y + G + v


@pytest.mark.parametrize("vertical", [0.0, 0.4])
def test_a_block_state_by_state(vertical):
    motion = shaking(vertical=vertical)
    history, found = checked(BLOCK, motion)
    assert history.impact_count > 3 and not history.overturned
    u = np.interp(history.time, motion.time, motion.acceleration, right=0)
    v = np.interp(history.time, motion.time, motion.vertical.acceleration, right=0) if vertical else 0 * u
    states = [
        (t, *of_a_block(*each))
        for t, *each in zip(history.time, history.phi, history.rate, u, v, strict=True)
        if each[0] or each[1]
    ]
    at_foot = 1e-15  # says of which direction a state is
    for t, s, rate in history.impacts:
        here = np.interp(t, history.time, u), np.interp(t, history.time, v)
        eta = 1 - 1.5 * sin(atan2(1, 5)) ** 2
        states += [(t, *of_a_block(s * at_foot, -s * rate, *here))]
        states += [(t, *of_a_block(-s * at_foot, -s * eta * rate, *here))]
    start = history.uplift_time
    here = np.interp(start, history.time, u), np.interp(start, history.time, v)
    states.append((start, *of_a_block(-np.sign(here[0]) * at_foot, 0.0, *here)))
    time, needed, _ = max(states, key=lambda each: each[1])
    assert found.friction_needed == pytest.approx(needed, rel=1e-9)
    assert found.time == pytest.approx(time)
    assert found.least_normal == pytest.approx(min(each[2] for each in states), rel=1e-9)
    assert found.joint in ("O", "O'") and not found.whole and found.holds


def test_after_the_last_sample_nothing_shakes_it_any_longer():
    """A record that ends with a push: from then on each state is that of a free motion."""
    motion = GroundMotion("push", 0.01, np.full(31, -0.35 * G), unit="m/s2")
    history, found = checked(BLOCK, motion)
    k = int(np.flatnonzero(history.time > 0.31)[0])
    assert history.phi[k] > 0 and history.first_impact > history.time[k]
    free, _ = of_a_block(history.phi[k], history.rate[k], 0.0, 0.0)
    assert found.demand[found.times == history.time[k]] == pytest.approx([free], rel=1e-9)


@pytest.mark.parametrize(
    ("fields", "valid"),
    [({}, True), ({"slides": 1.0}, False), ({"slides": 1.0, "followed": True}, True), ({"lost": 1.0}, False),
     ({"opens": 1.0}, False), ({"opens": np.nan}, True), ({"followed": True, "known_to": 2.0}, False),
     ({"known_to": 2.0}, False)],
)  # fmt: skip
def test_a_whole_history_is_valid_if_followed_and_known_or_if_all_joints_hold(fields, valid):
    assert contact.ContactDemand(times=np.zeros(0), demand=np.zeros(0), **fields).stands == valid


def test_how_long_a_demand_lasts():
    """Along a polygon: above 1 from 1 to 1.5 and from 3.25 to 5, at one moment from 4 down to 2."""
    time = np.array([0.0, 2.0, 2.0, 3.0, 4.0, 4.0, 6.0])
    value = np.array([0.0, 2.0, 0.0, 0.5, 4.0, 2.0, 0.0])
    starts, ends = _stretches(time, value, 1.0)
    assert starts == pytest.approx([1.0, 3 + 0.5 / 3.5]) and ends == pytest.approx([2.0, 5.0])
    assert all(each.size == 0 for each in _stretches(time, value, 4.0))
    assert [each.tolist() for each in _stretches(time[1:2], value[1:2], 1.0)] == [[2.0], [2.0]]


def test_the_time_near_the_peak_is_that_of_the_demand():
    _, found = checked(BLOCK, shaking())
    peak = found.friction_needed
    assert found.demand.max() == peak and found.times[found.demand.argmax()] == found.time
    k = int(found.demand.argmax())
    first, last = k, k
    while found.demand[first - 1] > 0.9 * peak:
        first -= 1
    while found.demand[last + 1] > 0.9 * peak:
        last += 1
    inside, outside = found.times[last] - found.times[first], found.times[last + 1] - found.times[first - 1]
    assert inside <= found.duration <= outside and found.duration > 0


def test_less_friction_than_lambda_slides_before_it_rocks():
    """A block beside a wall does, as its slip is not known in closed form."""
    weak, motion = BLOCK.model_copy(update={"friction": 0.15, "one_sided": "negative"}), shaking()
    history, found = checked(weak, motion, opening=0.005)
    assert found.slides == pytest.approx(history.uplift_time) and not found.holds
    above = _stretches(found.times, found.demand, 0.15)
    assert found.duration == pytest.approx((above[1] - above[0]).max())
    assert contact_words(found, weak).startswith(
        f"Sliding would start at joint O' at {found.slides:.4g} s. "
        f"It would last at most {found.duration:.2g} s at a time. Joint O' requires"
    )
    # How far it slides decides until when the history is a result, which is said beside.
    at_rest = motion.time[np.argmax(abs(motion.acceleration) > 0.15 * G)]
    assert history.unknown and history.check.reason == "slides"
    assert history.warned == pytest.approx(at_rest, abs=1.01 * motion.dt) and history.warned < found.slides
    assert history.known_to > history.warned and history.time[np.isfinite(history.phi)][-1] <= history.known_to
    slid = 0.005 * abs(np.exp(-1j * atan2(1, 5)) * (0.5 + 2.5j) - (0.5 + 2.5j))  # of its way until it is upright
    assert f"the joint between the ground and {weak.bodies()[0].name} has slid by {1000 * slid:.3g} mm" in (
        joints_in_words(history)
    )
    # Of joints that are not checked that far, each that does not hold ends it.
    loose = NoJoints(thickness=0.3, height=3.0, restitution=0.7, friction=0.05)
    _, unchecked = checked(loose, shaking(0.5))
    assert contact_words(unchecked, loose).startswith(
        f"Sliding would start at {unchecked.slides:.4g} s: the result is not valid beyond that time. It would last"
    )
    _, enough = checked(BLOCK.model_copy(update={"friction": 0.9}), shaking())
    assert np.isnan(enough.slides) and enough.duration == 0 and enough.holds
    assert "; 0.9 is available" in contact_words(enough, BLOCK)


def test_what_to_do_about_the_friction_of_impacts_is_said():
    block = BLOCK.model_copy(update={"restitution": 0.5, "friction": 0.3})
    history, found = checked(block, shaking())
    assert found.impact_friction > 1.6 and history.opening == 0  # the check leaves out a restitution that is given
    left_out = "joints with less slide at impacts, which is not simulated; prevent this, for instance by dowels."
    assert f"and much more with a lower restitution: {left_out}" in contact_words(found, block)
    arch = load_structure(EXAMPLES / "arch.yaml")
    _, found = checked(arch, read_record(EXAMPLES / "accel.csv"))
    assert found.impact_friction > found.friction_needed > 0
    counts = "the check of the joints counts how far they slide at impacts."
    assert f": give `friction` in the file, and {counts}" in contact_words(found, arch)
    assert f"lower restitution: {counts}" in contact_words(replace(found, friction=0.6), arch)
    assert left_out in contact_words(replace(found, followed=False), arch)
    assert "with a lower restitution. " in contact_words(
        replace(found, friction_needed=0.5, impact_friction=0.59), arch
    )


def test_of_a_structure_that_stays_at_rest_there_is_nothing_to_say():
    history, found = checked(BLOCK.model_copy(update={"friction": 0.1}), shaking(0.1))
    assert not history.lifted and np.isnan(found.friction_needed) and np.isnan(found.slides)
    assert contact_words(found, BLOCK) == "" and (found.demand == 0).all()


def test_with_little_weight_contact_is_lost():
    motion = shaking(0.5, vertical=0.97)
    history, found = checked(BLOCK, motion)
    u, v = (np.interp(history.time, motion.time, each, right=0) for each in
            (motion.acceleration, motion.vertical.acceleration))  # fmt: skip
    states = [
        (t, *of_a_block(*each))
        for t, *each in zip(history.time, history.phi, history.rate, u, v, strict=True)
        if (each[0] or each[1]) and t <= (history.overturning_time if history.overturned else np.inf)
    ]
    pulls = [t for t, _, normal in states if normal <= 0]
    until = [state for state in states if state[0] <= found.lost]
    bears = max(needed for _, needed, normal in until if normal > 0.01 * G)
    assert np.isclose(found.demand, bears, rtol=1e-9).any() and bears <= found.friction_needed * (1 + 1e-9)
    assert found.friction_needed < max(needed for _, needed, normal in states if normal > 0)  # for N tends to zero
    assert pulls and found.lost <= pulls[0] and pulls[0] - found.lost <= motion.dt
    assert found.least_normal <= 0 and not found.holds and "Contact is lost at joint O" in contact_words(found, BLOCK)


def test_a_history_ends_where_nothing_holds_the_structure_down():
    motion = shaking(vertical=1.3)
    history, _ = checked(BLOCK, motion)
    up = motion.vertical.acceleration
    k = int((up <= -G).argmax())
    gone = motion.dt * (k - 1 + (up[k - 1] + G) / (up[k - 1] - up[k]))  # on the ramp
    assert history.unknown and history.check.reason == "weightless"
    assert history.known_to == pytest.approx(gone, abs=1e-12)
    assert history.contact_lost == pytest.approx(gone, abs=1e-12)
    assert "nothing holds the structure down" in joints_in_words(history)


def test_a_release_is_checked_from_its_first_moment():
    history, found = checked(BLOCK, None, release=0.6)
    phi = history.phi[0]
    needed, normal = of_a_block(phi, 0.0, 0.0, 0.0)
    assert found.demand[0] == pytest.approx(needed) and found.times[0] == 0
    eta, alpha = 1 - 1.5 * sin(atan2(1, 5)) ** 2, atan2(1, 5)
    assert found.impact_friction == pytest.approx((1 - eta) / ((1 + eta) * np.tan(alpha)))
    assert found.least_normal <= normal


def test_strength_is_that_of_each_contact():
    motion = shaking(vertical=0.3)
    strength = {"stress": 4e6, "width": 0.04}
    block = Block(width=1.0, height=5.0, density=2000.0, depth=0.8, strength=strength)
    history, found = checked(block, motion)
    twice = block.model_copy(update={"strength": {"stress": 8e6, "width": 0.04}})
    assert found.crushing.used == pytest.approx(2 * checked(twice, motion)[1].crushing.used)
    assert not history.unknown and "use at most" in contact_words(found, block)
    u, v = (np.interp(history.time, motion.time, each, right=0) for each in
            (motion.acceleration, motion.vertical.acceleration))  # fmt: skip
    presses = {
        t: of_a_block(*each)[1]
        for t, *each in zip(history.time, history.phi, history.rate, u, v, strict=True)
        if each[0] or each[1]
    }
    most = max(presses.values())
    assert found.crushing.used >= most * 2000 * 5 * 0.8 / (4e6 * 0.04 * 0.8) * (1 - 1e-9)
    assert found.crushing.used == pytest.approx(most * 2000 * 5 / (4e6 * 0.04), rel=0.02)
    # Half as strong, a contact crushes, and the history ends there at once.
    weak = block.model_copy(update={"strength": {"stress": 2e6, "width": 0.04}})
    until, crushed = checked(weak, motion)
    first = next(t for t, normal in presses.items() if normal * 2000 * 5 > 2e6 * 0.04)
    assert until.unknown and until.check.reason == "crushes"
    assert until.known_to == pytest.approx(first, abs=motion.dt) and until.peak_ratio < history.peak_ratio
    assert 1 < crushed.crushing.used < 2 * found.crushing.used and "would crush" in contact_words(crushed, weak)
    assert block.enlarged(2.0).strength.width == 0.08
    frame = {"column_width": 1.0, "column_height": 6.0, "mass_ratio": 1.0, "density": 2000.0, "depth": 1.0}
    few, many = (
        checked(SymmetricFrame(**frame, columns=n, strength=strength), motion)[1].crushing.used for n in (2, 5)
    )
    assert few == pytest.approx(many)  # a column each of all that bear the sum


@pytest.mark.parametrize(("given", "field"), [({}, "strength"), ({"mass": 500.0}, "depth")])
def test_strength_needs_masses_and_a_depth(given, field):
    with pytest.raises(errors.FieldError, match=field):
        Block(width=1.0, height=5.0, strength={"stress": 1e6, "width": 0.1}, **given)


class NoJoints(Wall):
    """A plugin that does not say where its joints are."""

    def joints(self, direction):
        return ()


ARCH = Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7)
STRUCTURES = [
    Wall(thickness=0.3, height=3.0),
    NoJoints(thickness=0.3, height=3.0, restitution=0.7),
    ARCH,
    ARCH.model_copy(update={"restitution": 0.6}),
    AsymmetricFrame(
        column_width=1, left_height=6, right_height=7.5, spacing=8, beam_depth=1, density=2000.0, depth=1.0
    ),
    SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=1.0),
    Block(width=0.6, height=8.0, one_sided="positive"),
]


@pytest.mark.parametrize("structure", STRUCTURES, ids=lambda each: type(each).__name__)
def test_every_mechanism_is_checked(structure, monkeypatch):
    motion = shaking(0.5 if isinstance(structure, Wall | Arch) else 0.3)
    history, found = checked(structure, motion)
    assert 0.05 < found.friction_needed < 5 and found.least_normal > 0 and history.impact_count
    assert found.whole is isinstance(structure, NoJoints)
    assert found.joint in {joint.letter for d in structure.directions for joint in structure.joints(d)} | {""}
    given = structure.restitution is not None
    assert np.isnan(found.impact_friction) == (structure.one_sided is not None or (given and not found.whole))
    said = contact_words(found, structure)
    assert ("sums over the whole" in said) is found.whole
    assert ("sums over all columns" in said) is isinstance(structure, SymmetricFrame)
    monkeypatch.setattr(contact, "STATES_PER_BLOCK", 100)  # piece by piece it is the same
    again = Contacts(structure).check(history, motion)
    assert replace(again, times=found.times, demand=found.demand).friction_needed == found.friction_needed
    assert (again.demand == found.demand).all()


def test_a_beam_without_mass_asks_nothing_of_its_joint():
    frame = SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=0.0)
    _, bare = checked(frame, shaking(0.3))
    _, column = checked(Block(width=1.0, height=6.0), shaking(0.3))
    assert bare.friction_needed == pytest.approx(column.friction_needed) and bare.joint[0] == "A" and bare.holds
    assert bare.least_normal == pytest.approx(column.least_normal)
    assert bare.impact_friction == pytest.approx(column.impact_friction)


def test_an_impact_that_throws_a_joint_apart_loses_contact():
    """The joints that open next would have to pull at the impact of a thin half circle."""
    arch = Arch(radius=10.0, thickness=1.1, inclusion_angle_deg=180)
    history, found = checked(arch, None, release=0.3)
    assert impulses(arch, arch.directions[0]).normal.min() < 0
    assert found.lost == history.impacts[0, 0] and found.lost_joint == "A'" and not found.holds
    assert found.times[found.demand > 0].max() == found.lost  # that moment itself still counts
    assert f"Contact is lost at joint A' at {found.lost:.4g} s" in contact_words(found, arch)


def test_respond_says_it(tmp_path):
    file = tmp_path / "frame.yaml"
    file.write_text((EXAMPLES / "frame.yaml").read_text(encoding="utf-8") + "friction: 0.25\n", encoding="utf-8")
    asked = (file, "--record", EXAMPLES / "accel.csv", "--neighbours", 0, "--opening", "100%")
    responses = run_json("respond", *asked)["responses"]
    assert responses["linear1"]["contact"] is None and responses["linear2"]["contact"] is None
    found = responses["nonlinear"]["contact"]
    assert set(found) >= {"friction_needed", "joint", "time", "duration", "least_normal", "impact_friction", "lost"}
    assert found["friction"] == 0.25 < found["friction_needed"] and found["joint"] == "B" and found["lost"] is None
    assert found["slides"] < found["time"] and found["duration"] > 0 and found["per_unit_mass"] is False
    said = " ".join(run("respond", *asked).stdout.split())
    assert f"Sliding would start at joint {found['slides_joint']} at {found['slides']:.4g} s" in said
    assert f"Joint B requires a coefficient of friction of up to {found['friction_needed']:.3g}, at" in said
    both = run_json("respond", *asked, "--polarity", "both")["polarities"]
    assert both["1"]["responses"]["nonlinear"]["contact"] == found != both["-1"]["responses"]["nonlinear"]["contact"]
    pulse = run_json("respond", *asked, "--with-pulse", "sine")["pulse_responses"]["nonlinear"]["contact"]
    assert pulse["friction_needed"] > 0 and pulse != found


def test_without_friction_in_the_file_what_is_required_is_compared_with_masonry():
    block = Block(width=0.7, height=2.8)
    _, found = checked(block, shaking(0.5))
    assert found.friction_needed < 0.6
    assert "no more than the 0.6 usual for masonry" in contact_words(found, block)
    said = contact_words(replace(found, friction_needed=0.61), block)
    assert "more than the 0.6 usual for masonry" in said and "no more than" not in said


def test_thrown_back_it_is_checked_on_both_sides_of_an_impact():
    history, found = checked(Block(width=0.6, height=8.0, one_sided="positive"), None, release=0.5)
    first, *_ = history.impacts[:, 0]
    at_impact = found.demand[found.times == first]
    assert at_impact.size == 2 and (at_impact > 0).all() and at_impact[0] != at_impact[1]


def test_impulses_of_one_direction_alone_do_not_say_what_impacts_need():
    eta = ARCH.eta(ARCH.directions[0])
    for given, known in ((eta, True), (0.5, False)):
        one = ARCH.model_copy(update={"restitution": {"positive_to_negative": eta, "negative_to_positive": given}})
        history, found = checked(one, shaking(0.5))
        assert len(set(history.impacts[:, 1])) == 2
        assert np.isfinite(found.impact_friction) == known


def test_the_picture_shows_it_where_it_is_requested():
    block, record = EXAMPLES / "block.yaml", EXAMPLES / "accel.csv"
    for requested in (False, True):
        figure = respond_verb(block, record, neighbours=0, contact=requested).figure()
        assert ("required" in [text.get_text() for text in figure.findobj(Text)]) == requested
    asked = ("respond", block, "--record", record, "--neighbours", 0, "--contact")
    assert "--contact has no effect without --plot" in run(*asked, code=2).stderr


def test_forces_in_a_row_are_in_kN_as_they_are_in_sentences():
    heavy, none = Block(width=0.7, height=2.8, mass=20e3), Block(width=0.7, height=2.8)
    for structure, unit, per in ((heavy, "kN", 1000), (none, "N/kg", 1)):
        _, found = checked(structure, shaking(0.4))
        row = [column.cell(found) for column in contact_columns(structure)]
        assert row[5] == f"{found.base_shear / per:.4g} {unit}" and row[6] == f"{found.least_normal / per:.4g} {unit}"
