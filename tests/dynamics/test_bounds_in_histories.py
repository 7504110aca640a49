"""Histories that end at a bound, or are thrown back from a stop, against an integration of a block of its own."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import rocking_cli as rk
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import follow
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import build_models

B, H, G = 0.2, 1.1, 9.80665  # half the width and the height [m]
ALPHA, RADIUS = math.atan(B / H), math.hypot(B, H)
P2, ETA = 0.75 * G / RADIUS, 1 - 1.5 * math.sin(ALPHA) ** 2
PUSH = GroundMotion("push", 0.05, np.array([0, -3.5, -5, -5, -4, 1, 4, 5, 5, 4, 2, 0, -2, -3, 0.0]), unit="m/s2")


def block(gap, restitution=None):
    stop = {"point": [B, 2 * H], "gap": gap, "restitution": restitution}
    return rk.Block(width=2 * B, height=2 * H, density=1000, depth=1, stops=[stop])


def ground(motion, t):
    return float(np.interp(t, np.arange(motion.npts) * motion.dt, motion.acceleration, right=0.0))


def turning(side, phi, u):
    """phi.. in a direction (1 clockwise), phi >= 0."""
    return -P2 * (math.sin(ALPHA - phi) + side * u / G * math.cos(ALPHA - phi))


def by_hand(motion, stop, restitution, until):
    """Return samples (t, signed phi), and the times at which a clockwise block meets its stop, from rest."""
    t, side, y, moving, samples, met = 0.0, 1, np.zeros(2), False, [(0.0, 0.0)], []
    while t < until:
        if not moving:  # on the ramp at which it uplifts
            lift = [
                brentq(lambda x, s=s: -s * ground(motion, x) / G - math.tan(ALPHA), a, a + motion.dt)
                for a in motion.dt * np.arange(motion.npts - 1) if a + motion.dt > t
                for s in (1, -1)
                if -s * ground(motion, a) / G < math.tan(ALPHA) < -s * ground(motion, a + motion.dt) / G
            ]  # fmt: skip
            t = lift[0]
            side, moving = (1 if ground(motion, t) < 0 else -1), True
        end = (math.floor(t / motion.dt + 1e-9) + 1) * motion.dt

        def rate(x, y, side=side):
            return [y[1], turning(side, y[0], ground(motion, x))]

        def impact(x, y, start=t):
            return y[0] if x > start + 1e-9 else 1.0

        def stops(x, y, side=side):
            return y[0] - stop if side > 0 and y[1] > -1e-9 else -1.0

        impact.terminal = stops.terminal = True
        impact.direction, stops.direction = -1, 1
        found = solve_ivp(rate, (t, end), y, "DOP853", events=[impact, stops], rtol=1e-11, atol=1e-13, max_step=0.005)
        t, y = float(found.t[-1]), found.y[:, -1].copy()
        if found.t_events[0].size:
            side, y = -side, np.array([0.0, -ETA * y[1]])
        elif found.t_events[1].size:
            met.append(t)
            if restitution is None:
                return samples, met
            y = np.array([stop, -restitution * y[1]])
            if -y[1] < 1e-7:  # pressed against it until the ground lets go
                while turning(side, stop, ground(motion, t)) > 0:
                    t += 1e-6
                y = np.array([stop - 1e-15, 0.0])
        samples.append((t, side * y[0]))
    return samples, met


@pytest.mark.parametrize("gap", [0.01, 0.05])
def test_a_history_ends_at_the_moment_at_which_its_bound_is_met(gap):
    bound = math.asin(gap / 2.2)
    _, (met, *_) = by_hand(PUSH, bound, None, 3.0)
    history = rk.respond(block(gap), PUSH, neighbours=0, engine="exact")["nonlinear"]
    assert history.unknown and history.overturned is None
    assert history.known_to == pytest.approx(met, abs=1e-7)
    assert history.peak_positive == pytest.approx(bound, rel=1e-9)
    assert np.isnan(history.phi[history.time > met]).all()
    assert history.bound.name == "the stop"


@pytest.mark.parametrize("side", [1, -1])
def test_the_bound_that_ends_a_history_is_plain_data(side):
    stop = {"point": [side * B, 2 * H], "gap": side * 0.05, "name": "wall"}
    stopped = rk.Block(width=2 * B, height=2 * H, density=1000, depth=1, stops=[stop])
    told = rk.respond(stopped, PUSH, polarity=side, neighbours=0).to_dict()["responses"]["nonlinear"]
    assert told["outcome"] == "unknown" and told["bound"] == {
        "phi": pytest.approx(math.asin(0.05 / 2.2), rel=1e-9), "kind": "meets", "name": "wall", "body": "block",
        "at": [side * B, 2 * H], "restitution": None, "direction": "positive" if side > 0 else "negative",
    }  # fmt: skip
    still = rk.respond(stopped, PUSH.scaled(0.4), neighbours=0).to_dict()["responses"]
    assert [each["bound"] for each in still.values()] == [None] * len(still)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.9])
def test_a_stop_throws_a_block_back(restitution):
    gap = 0.03
    (model,) = build_models(block(gap, restitution), ("nonlinear",))
    history = follow(replace(model, joints=None), PUSH)  # of the joints below
    samples, met = by_hand(PUSH, math.asin(gap / 2.2), restitution, 1.4)
    assert len(met) >= 1
    assert history.peak_positive == pytest.approx(math.asin(gap / 2.2), rel=1e-9)
    times, phi = np.array(samples).T
    at = [
        k
        for k in range(1, len(times))
        if round(times[k] / 0.05) < history.time.size and abs(times[k] / 0.05 - round(times[k] / 0.05)) < 1e-9
    ]
    sampled = history.phi[np.round(times[at] / 0.05).astype(int)]
    before = np.isfinite(sampled)  # it overturns to the other side
    assert before[:12].all()
    assert sampled[before] == pytest.approx(phi[at][before], abs=2e-5)


def test_neighbours_meet_what_does_not_scale_with_their_slenderness():
    gap, factor = 0.03, 1.2
    (model,) = build_models(block(gap), ("nonlinear",))
    runs = Runs.of([0, 0], 0, scale=[1.0, 1.0], slender=[1.0, factor])
    outcome = respond_many([model], [PUSH], runs)
    weaker = GroundMotion("weaker", PUSH.dt, PUSH.acceleration / factor, unit="m/s2")
    for k, (motion, bound) in enumerate([(PUSH, math.asin(gap / 2.2)), (weaker, math.asin(gap / 2.2) / factor)]):
        _, (met, *_) = by_hand(motion, bound, None, 3.0)
        assert outcome.known_to[k] == pytest.approx(met, abs=1e-7)
    assert outcome.peak_positive == pytest.approx(math.asin(gap / 2.2), rel=1e-9)


def test_a_stop_that_pulls_at_the_pivot_opens_it_by_as_much_as_the_rule_says():
    gap = 0.02
    (model,) = build_models(block(gap, 0.0), ("nonlinear",))
    history = follow(replace(model, joints=replace(model.joints, limit=1e3)), PUSH)
    bound = math.asin(gap / 2.2)
    # Until it is pressed back, by small steps: the pivot is thrown up by c m w x, and falls by c N.
    _, (met, *_) = by_hand(PUSH, bound, None, 3.0)
    mass, about = 880.0, 880.0 * RADIUS**2 / 3
    x, y = RADIUS * math.sin(ALPHA - bound), RADIUS * math.cos(ALPHA - bound)
    rows = np.array([[0.0, 1.0, -x], [1.0, 0.0, y]])  # velocity of the pivot, up and to the right, anticlockwise turn
    compliance = rows / [mass, mass, about] @ rows.T
    up = 1 / np.linalg.inv(compliance)[0, 0]
    start = brentq(lambda t: -ground(PUSH, t) / G - math.tan(ALPHA), 0, PUSH.dt)
    rise = solve_ivp(
        lambda t, y: [y[1], turning(1, y[0], ground(PUSH, t))], (start, met), [0.0, 0.0], rtol=1e-10, max_step=1e-3
    )
    speed = float(rise.y[1, -1])
    rate, opened, t = up * mass * speed * x, 0.0, met
    while rate > 0 or opened > 0:
        opened += 1e-6 * rate
        rate -= 1e-6 * up * mass * G  # pressed against the stop, N is the weight
        t += 1e-6
        if rate < 0:
            break
    assert turning(1, bound, ground(PUSH, t)) > 0  # it is still pressed
    assert history.check.largest == pytest.approx(opened, rel=0.02)
