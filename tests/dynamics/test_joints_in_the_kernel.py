"""What the kernel looks at to say until when a history is known, function by function, as plain Python.

A block is written out here: its slip under a ramp, and what an impact leaves at its foot. Forces of made-up joints are
polynomials.
"""

from math import isnan

import numpy as np
import pytest

from mechanisms.block import Block
from rocking_cli.dynamics import kernels, openings, stepping
from rocking_cli.dynamics.deck import lay_out
from rocking_cli.dynamics.stepping import Ground, Law, State
from rocking_cli.excitation.base import GroundMotion
from tests.following import build_model

G, MU = 9.80665, 0.1
HALF_WIDTH, HALF_HEIGHT, DENSITY = 0.5, 1.0, 2000.0
MASS = DENSITY * 4 * HALF_WIDTH * HALF_HEIGHT
NEVER = float("nan")
LAW = Law(**{**dict.fromkeys(Law._fields, 1.0), "d": 0, "q_end": 2.0, "gravity": G})


def marks():
    """Marks of a history that has just begun."""
    found = np.full(stepping.MARKS, NEVER)
    found[[stepping.PEAK, stepping.PEAK + 1, stepping.IMPACTS, openings.LARGEST, openings.LONGEST]] = 0.0
    return found


def begun(watch):
    """A watch of which nothing has moved."""
    watch.kept[:], watch.notes[:] = 0.0, 0.0
    watch.notes[[openings.SINCE, openings.SEEN]] = NEVER
    return watch


def of_block(mu=MU, opening=0.005):
    """The watch of a block of usual size on a foot with friction."""
    block = Block(width=2 * HALF_WIDTH, height=2 * HALF_HEIGHT, density=DENSITY, depth=1.0, friction=mu)
    model = build_model(block, "nonlinear", opening)
    deck = lay_out([model], [GroundMotion("still", 0.01, np.zeros(2), unit="m/s2")])
    room = kernels.Room(
        np.empty((2, stepping.COLUMNS)), np.empty((1, openings.KEPT)), np.empty(openings.NOTES), np.empty(4, np.int64)
    )
    nothing = np.empty(0)
    motion = kernels.Motion(nothing, 1.0, 0.01, nothing, 1.0, 0.01, nothing, nothing, nothing, nothing)
    return begun(openings.watch_of(deck.joints, 0, 1.0, 1.0, motion, room))


def of_rows(*forces, step=0.1, limit=1.0, strength=np.inf, friction=np.nan, other=-1):
    """The watch of one joint: polynomials over a cell of width 2 of N at its end and of T, with a compliance of 1."""
    rows = np.zeros((2, len(forces), openings.OF_ROW))
    for k, force in enumerate(forces):
        for column, factors in force.items():
            rows[:, k, column : column + len(factors)] = factors
        rows[:, k, 16] = 1.0
    made = {
        "size": 1, "cells": 1, "lines": len(forces), "gravity": G, "limit": limit, "step": step, "slender": 1.0,
        "contacts": np.array([[[0, other, len(forces) - 1, 0]] * 2]), "bearing": np.array([[friction, strength]]),
        "rows": rows.reshape(-1, openings.OF_ROW), "stopped": np.zeros((2 * len(forces), 2)),
        "kept": np.empty((1, openings.KEPT)),
        "notes": np.empty(openings.NOTES), "active": np.empty(4, np.int64),
    }  # fmt: skip
    return begun(openings.Watch(**{**dict.fromkeys(openings.Watch._fields, 0), **made}))


ONE, PUSH, RATE, LIFT = 0, 4, 8, 12  # first columns of a row


class TestInsideAStep:
    """A motion of order 5 in time is between the ends of a step what it is anywhere."""

    SIZE = 0.3
    MOTION = np.polynomial.Polynomial([0.2, 0.9, -2.0, 3.0, 7.0, -11.0])

    def step(self):
        """State, size and end of a step, as `look` takes them."""
        of = self.MOTION, self.MOTION.deriv(), self.MOTION.deriv(2)
        start, end = (State(*(float(each(t)) for each in of)) for t in (0.0, self.SIZE))
        return start, self.SIZE, end

    @pytest.mark.parametrize("x", [0.0, 0.1, 0.3, 0.5, 0.8, 1.0])
    def test_place_and_speed_are_those_of_the_motion(self, x):
        start, size, end = self.step()
        expected = self.MOTION(x * size), self.MOTION.deriv()(x * size)
        assert openings.between(start, end, size, x) == pytest.approx(expected, rel=1e-12)

    @pytest.mark.parametrize("share", [0.2, 0.45, 0.7])
    def test_a_joint_opens_from_where_it_pulls(self, share):
        """N = 1 - q/q_0 is inside a step on the parabola through its start, middle and end: it pulls from a root on."""
        level, start = float(self.MOTION(share * self.SIZE)), 5.0
        watch, found = of_rows({ONE: (1.0, -2 / level)}, {ONE: (1.0,)}, step=self.SIZE / 1000), marks()
        openings.look(watch, LAW, Ground(0.0, 0.0, G, 0.0), start, 0.0, *self.step(), 0.0, 0.0, 0.0, found)
        pull = np.polyfit([0.0, 0.5, 1.0], self.MOTION(np.array([0.0, 0.5, 1.0]) * self.SIZE) / level - 1, 2)
        first = min(root for root in np.roots(pull) if 0 < root < 1)
        assert 0 <= (found[openings.WARNED] - start) / self.SIZE - first <= 1.001e-3
        reached = self.MOTION(found[openings.WARNED] - start)
        assert found[openings.WARNED_PEAK] == pytest.approx(reached, rel=1e-12)

    @pytest.mark.parametrize(("share", "moment"), [(0.3, 0.5), (0.7, 1.0), (1.1, NEVER)])
    def test_a_contact_crushes_at_the_first_moment_of_three_at_which_it_bears_too_much(self, share, moment):
        """N = q, and the contact slides meanwhile, or nothing would be noted before the end of the step."""
        strength = float(self.MOTION(share * self.SIZE))
        how = {"step": self.SIZE / 4, "strength": strength, "friction": 0.0}
        watch, found = of_rows({ONE: (0.0, 2.0)}, {ONE: (1.0,)}, **how), marks()
        openings.look(watch, LAW, Ground(0.0, 0.0, G, 0.0), 0.0, 0.0, *self.step(), 0.0, 0.0, 0.0, found)
        reason = openings.CRUSHES if moment <= 1 else NEVER
        expected = [moment * self.SIZE, reason]
        assert found[[openings.PASSED, openings.REASON]].tolist() == pytest.approx(expected, nan_ok=True)


class TestAnImpact:
    """A block returns to rest with a rate w and leaves on its other foot with eta w; P_x = m w h (1 - eta)."""

    @pytest.mark.parametrize("mu", [0.1, 0.35, 0.36])
    @pytest.mark.parametrize("d", [0, 1])
    def test_it_slides_by_what_friction_lacks(self, d, mu):
        """P_y = m w b (1 + eta); of a foot let go along the ground c = I/(m I - m^2 h^2), I about the foot."""
        watch, found, rate = of_block(mu), marks(), 1.7
        b, h, inertia = HALF_WIDTH, HALF_HEIGHT, 4 / 3 * MASS * (HALF_WIDTH**2 + HALF_HEIGHT**2)
        eta = 1 - 1.5 * b**2 / (b**2 + h**2)
        openings.strike(watch, d, 3.0, 0.0, watch.struck, rate, eta, found)
        lacks = max(MASS * rate * (h * (1 - eta) - mu * b * (1 + eta)), 0.0)
        slips = inertia / (MASS * inertia - (MASS * h) ** 2) * lacks
        rates = watch.kept[0, openings.SLIP_RATE : openings.SLIP_RATE + 2].tolist()
        assert sorted(rates) == pytest.approx([0.0, slips], rel=1e-9)
        assert (lacks > 0) == (watch.notes[openings.MOVING] > 0) == (mu < 0.353)
        assert found[openings.WARNED] == pytest.approx(3.0 if lacks else NEVER, nan_ok=True)
        assert not watch.kept[0, openings.GAP : openings.GAP + 4].any()  # the foot is pressed

    @pytest.mark.parametrize("eta", [0.0, 0.4, 0.9])
    def test_an_impulse_is_what_stops_the_motion_and_what_begins_the_next(self, eta):
        """P = w (P_0 + eta P_1): -(1 + 3 eta) opens the end, and what presses it gives its friction."""
        watch = of_rows({}, {})._replace(struck=np.array([[9.0, 9.0], [9.0, 9.0], [-1.0, -3.0], [0.0, 0.0]]))
        openings.strike(watch, 1, 0.0, 0.0, watch.struck, 2.0, eta, marks())
        assert watch.kept[0, openings.GAP_RATE] == pytest.approx(2.0 * (1 + 3 * eta))
        watch = of_rows({}, {}, friction=0.5)._replace(
            struck=np.array([[1.0, 3.0], [-2.0, -5.0], [9.0, 9.0], [9.0, 9.0]])
        )
        openings.strike(watch, 0, 0.0, 0.0, watch.struck, 2.0, eta, marks())
        slips = 2.0 * (2 + 5 * eta - 0.5 * (1 + 3 * eta))
        assert watch.kept[0, openings.SLIP_RATE : openings.SLIP_RATE + 2].tolist() == pytest.approx([0.0, slips])

    def test_what_opens_elsewhere_in_the_other_direction_starts_anew_and_slips_go_on(self):
        for changes, stays in ((0, 0.1), (1, 0.0)):
            watch = of_rows({}, {}, friction=0.5)._replace(struck=np.zeros((4, 2)))
            watch.contacts[:, :, openings.CHANGES] = changes
            watch.kept[0, [openings.GAP, openings.SLIP, openings.SLIP_RATE]] = 0.1, 0.2, 0.3
            openings.strike(watch, 0, 0.0, 0.0, watch.struck, 1.0, 0.5, marks())
            kept = watch.kept[0, [openings.GAP, openings.SLIP, openings.SLIP_RATE]]
            assert kept.tolist() == [stays, 0.2, 0.3]
            openings.settle(watch, 0.0, marks())  # at rest all joints are closed, and what has slid stays
            assert watch.kept[0].any() and watch.kept[0, openings.SLIP] == 0.2 == watch.kept[0].sum()


class TestAtRest:
    """A block on a foot of little friction slides under ramps of u_g'' and v_g'': s.. = |u_g''| - mu (g + v_g'')."""

    @pytest.mark.every(6)
    @pytest.mark.parametrize("steps", [1, 3, 40])
    @pytest.mark.parametrize("way", [1, -1])
    @pytest.mark.parametrize(
        ("ground", "lift"),
        [((0.02, 0.14), (0.0, 0.0)), ((0.02, 0.14), (0.0, -0.6)), ((0.02, 0.14), (-0.6, 0.0)),
         ((0.02, 0.14), (0.5, -0.5)), ((0.14, 0.18), (0.0, 0.5)), ((0.14, 0.18), (-0.5, 0.0)),
         ((0.02, 0.08), (0.0, 0.0))],
    )  # fmt: skip
    def test_the_slip_is_that_of_the_forces_at_each_moment(self, ground, lift, way, steps):
        watch, found, size = of_block(opening=1e3), marks(), 0.5
        (u0, u1), (v0, v1) = ground, lift
        openings.stand(watch, 2.0, size, steps, way * u0 * G, way * u1 * G, 1.0, v0 * G, v1 * G, found)
        first, last = (G * (u - MU * (1 + v)) for u, v in ((u0, v0), (u1, v1)))
        left = 0.0 if last <= 0 else size if first >= 0 else size * last / (last - first)  # it slides
        first = max(first, 0.0)
        kept = watch.kept[0]
        slips = kept[openings.SLIP : openings.SLIP + 2].sum(), kept[openings.SLIP_RATE : openings.SLIP_RATE + 2].sum()
        assert slips == pytest.approx((left**2 * (2 * first + last) / 6, left * (first + last) / 2), rel=1e-6)
        assert not kept[openings.GAP : openings.GAP + 4].any()
        if left:  # the first moment at which it slides
            assert 0 <= found[openings.WARNED] - (2.0 + size - left) <= size / steps * (1 + 1e-9)

    def test_when_it_warns_passes_the_limit_and_stops(self):
        """u_g'' grows to 0.2 g in 0.5 s, falls to nothing in 0.5 s, and is nothing: times by integration by hand."""
        watch, found, steps = of_block(opening=0.01), marks(), 5000
        for k, (u0, u1) in enumerate([(0.0, 0.2), (0.2, 0.0), (0.0, 0.0), (0.0, 0.0)]):
            openings.stand(watch, 0.5 * k, 0.5, steps, u0 * G, u1 * G, 1.0, 0.0, 0.0, found)
        # Beyond mu g from 0.25 to 0.75 s: a triangle of 0.1 g; then it decelerates by a ramp to mu g, and by mu g.
        rate_then = 0.5 * 0.5 * 0.1 * G - 0.5 * 0.25 * 0.1 * G
        stops = 1.0 + rate_then / (0.1 * G)
        ramp = 0.4 * G
        slip = lambda t: ramp * (t - 0.25) ** 3 / 6  # noqa: E731
        limit = watch.limit
        assert limit < slip(0.5)
        assert found[openings.WARNED] == pytest.approx(0.25, abs=2e-4)
        assert found[openings.PASSED] == pytest.approx(0.25 + (6 * limit / ramp) ** (1 / 3), abs=2e-4)
        assert found[openings.REASON] == openings.SLIDES and found[openings.WHERE] == 0
        assert found[openings.LONGEST] == pytest.approx(stops - 0.25, abs=4e-4)
        assert found[openings.LARGEST_AT] == pytest.approx(stops, abs=4e-4)
        assert watch.notes[openings.MOVING] == 0 and isnan(found[openings.PARTED])

    @pytest.mark.parametrize(("u", "calm"), [(0.0999, True), (0.1001, False), (-0.0999, True), (-0.1001, False)])
    def test_it_is_steady_up_to_its_friction(self, u, calm):
        assert bool(openings.steady(of_block(), u * G)) == calm
        moving = of_block()
        moving.notes[openings.MOVING] = 1.0
        assert not openings.steady(moving, u * G)
        assert bool(openings.steady(of_block()._replace(slender=1.01), u * G / 1.01)) == calm


class TestQuiet:
    """Joints bear for certain between two straight lines over q.^2, up to some q.^2; push is towards the direction."""

    LINE = -1.0, 0.1, 2.0, -0.2, 3.0

    def quiet(self, push, square, d=0, weight=G, slender=1.0, scales=True, slow=-1.0, q=0.5):
        within = np.zeros((2, 5))
        within[d] = self.LINE
        watch = of_rows({}, {})._replace(within=within, slender=slender, scales=scales, slow=slow)
        law = LAW._replace(d=d)
        return openings.quiet(watch, law, Ground((1 - 2 * d) * push, 0.0, weight, 0.0), 0.0, q, square**0.5)

    @pytest.mark.parametrize("d", [0, 1])
    @pytest.mark.parametrize("factor", [1.0, 0.5])
    def test_between_the_lines_and_no_further(self, d, factor):
        """With half the weight they bear half as much of each; where a tie holds, nothing is certain then."""
        for square in (0.0, 2.0):
            for push, bears in (
                (-1 + 0.1 * square + 1e-6, True), (-1 + 0.1 * square - 1e-6, False),
                (2 - 0.2 * square - 1e-6, True), (2 - 0.2 * square + 1e-6, False),
            ):  # fmt: skip
                assert self.quiet(factor * push, factor * square, d, factor * G) == bears
                assert self.quiet(factor * push / 1.1, factor * square, d, factor * G, slender=1.1) == bears
                assert self.quiet(factor * push, factor * square, d, factor * G, scales=False) == (
                    bears and factor == 1
                )
        assert self.quiet(factor * 0.5, factor * 2.999, d, factor * G)
        assert not self.quiet(factor * 0.5, factor * 3.001, d, factor * G)
        assert not self.quiet(0.0, 0.0, d, 0.0)

    def test_what_is_slow_is_quiet_up_to_the_critical_rotation(self):
        assert self.quiet(9.0, 0.49, slow=0.5) and not self.quiet(9.0, 0.51, slow=0.5)
        assert not self.quiet(9.0, 0.49, slow=0.5, q=1.001)


class TestNotes:
    """What `note` keeps of the moments it is told of: the first, the largest and the longest."""

    def moment(self, watch, found, t, *, q=0.1, gap=0.0, slip=0.0, missing=0.0, moving=False, crushes=-1, parted=-1):
        watch.kept[0, [openings.GAP, openings.SLIP]] = gap, slip
        demand = openings.Demand(missing, 0 if missing else -1, crushes, parted)
        openings.note(watch, 0, 1.0, t, q, demand, moving, found)

    def test_the_first_that_passes_the_limit_with_its_reason_and_the_peaks_until_then(self):
        for how, reason in (({"gap": 0.0101}, openings.OPENS), ({"slip": 0.0101}, openings.SLIDES),
                            ({"crushes": 0}, openings.CRUSHES)):  # fmt: skip
            watch, found = of_rows({}, {}, limit=0.01), marks()
            found[stepping.IMPACTS], watch.notes[openings.SO_FAR], watch.notes[openings.SO_FAR + 1] = 3, 0.5, 0.7
            self.moment(watch, found, 1.0, gap=0.01, q=0.2)  # as much as is permitted
            assert isnan(found[openings.PASSED])
            self.moment(watch, found, 2.0, q=0.3, **how)
            found[stepping.IMPACTS] = 4
            self.moment(watch, found, 3.0, q=0.6, **how)
            places = ("PASSED", "REASON", "WHERE", "PASSED_IMPACTS", "PASSED_PEAK")
            got = found[[*(getattr(openings, place) for place in places), openings.PASSED_PEAK + 1]]
            assert got.tolist() == [2.0, reason, 0.0, 3.0, 0.5, 0.7]

    def test_the_first_warning_and_the_largest_opening_up_to_the_critical_rotation(self):
        watch, found = of_rows({}, {}), marks()
        self.moment(watch, found, 1.0)
        assert isnan(found[openings.WARNED]) and isnan(found[openings.PARTED])
        self.moment(watch, found, 2.0, missing=5.0, parted=0, gap=0.1, q=0.4)
        self.moment(watch, found, 3.0, missing=9.0, parted=0, gap=0.3, q=1.0)
        self.moment(watch, found, 4.0, gap=0.5, q=1.001)  # beyond phi_cr
        self.moment(watch, found, 5.0, gap=0.2, q=0.9)
        got = found[[openings.WARNED, openings.WARNED_PEAK, openings.PARTED, openings.LARGEST, openings.LARGEST_AT]]
        assert got.tolist() == [2.0, 0.4, 2.0, 0.3, 3.0]

    def test_the_longest_time_for_which_any_moves(self):
        watch, found = of_rows({}, {}), marks()
        for t, moving in ((0.0, False), (1.0, True), (1.5, True), (3.0, False), (4.0, True), (5.0, False)):
            self.moment(watch, found, t, moving=moving)
        assert found[openings.LONGEST] == 2.0


class TestUplift:
    """-u_g'' > lambda (g + v_g'') lifts the positive direction, u_g'' the negative one: on ramps, at a root."""

    NUMBERS = np.zeros((2, stepping.COLUMNS))
    NUMBERS[:, stepping.LAMBDA], NUMBERS[:, stepping.GRAVITY] = (0.2, 0.3), G

    def at(self, u, ramp, end=2.0, g=G, grade=0.0, tau=0.0):
        return kernels.lifts_at(self.NUMBERS, tau, end, u, ramp, g, grade)

    @pytest.mark.parametrize(("d", "level"), [(0, -0.2 * G), (1, 0.3 * G)])
    def test_it_lifts_where_a_ramp_crosses_its_level(self, d, level):
        assert self.at(0.0, level) == (pytest.approx(1.0), d)
        assert self.at(0.0, level / 2.001) == (2.0, -1) and self.at(level * 1.001, 0.0, tau=0.5) == (0.5, d)
        assert self.at(level * 0.999, 0.0)[1] == -1
        # Weight that ebbs by half in 2 s halves the level on the way.
        assert self.at(0.75 * level, 0.0, grade=-G / 4) == (pytest.approx(1.0), d)

    def test_of_both_it_takes_the_first_or_the_one_with_more_behind_it(self):
        """Without weight both directions are open; here one is after the other, as weight ebbs within 1 s."""
        for u, d in ((-0.15 * G, 0), (0.25 * G, 1)):
            first = 1 - abs(u) / (self.NUMBERS[d, stepping.LAMBDA] * G)
            time, lifted = self.at(u, 0.0, end=3.0, grade=-G)
            assert (time, lifted) == (pytest.approx(first), d)
        other = self.at(0.1 * G, -0.4 * G, end=1.0, grade=-1.2 * G)
        crossings = [(0.2 - -0.1) / (0.4 + 0.2 * 1.2), (0.3 - 0.1) / (-0.4 + 0.3 * 1.2)]
        expected = min((t, d) for d, t in enumerate(crossings) if t > 0)
        assert other == (pytest.approx(expected[0]), expected[1])
        assert self.at(0.05 * G, 0.0, g=-0.5 * G) == (0.0, 1)  # 0.05 + 0.15 against -0.05 + 0.1
