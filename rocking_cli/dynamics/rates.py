"""The kernel's peaks of the angular velocity: the largest |phi.| of a motion, at the ends of its steps and inside."""

from __future__ import annotations

from math import isfinite

from rocking_cli.dynamics.openings import PASSED
from rocking_cli.dynamics.stepping import BOUNDED, BOW, FASTEST, PER_CELL, RATE_PEAK, advance, called, inlined

RATE_TOLERANCE = (
    1e-4  # distance to a turning point of phi. at which its search ends, over a step; phi. then misses 1e-8 of its rise
)


@called
def angle(structure, d, q):
    """phi and dphi/dq at q."""
    if structure.linear:
        return q, 1.0
    angles = structure.angles
    place = q * structure.numbers[d, PER_CELL]
    k = min(max(int(place), 0), angles.shape[0] - 1)
    x = place - k
    phi = angles[k, d, 0] + x * (angles[k, d, 1] + x * (angles[k, d, 2] + x * angles[k, d, 3]))
    slope = angles[k, d, 4] + x * (angles[k, d, 5] + x * (angles[k, d, 6] + x * angles[k, d, 7]))
    return phi, slope


@inlined
def turning(linear, angles, law, state):
    """phi. and phi.. = q.. dphi/dq + q.^2 d2phi/dq2 of a state."""
    q, w, f = state
    if linear:
        return w, f
    d, place = law.d, q * law.per_cell
    k = min(max(int(place), 0), angles.shape[0] - 1)
    x = place - k
    slope = angles[k, d, 4] + x * (angles[k, d, 5] + x * (angles[k, d, 6] + x * angles[k, d, 7]))
    bend = (angles[k, d, 5] + x * (2 * angles[k, d, 6] + x * 3 * angles[k, d, 7])) * law.per_cell
    return w * slope, f * slope + w * w * bend


@called
def look_for_peak(linear, forces, angles, law, ground, t, tau, state, size, ended, marks):
    """Note in `marks` the largest |phi.| of a step, up to where the outcome is unknown.

    Inside, phi.. vanishes once at most. False position on the step itself finds where, to the full order of the pair.
    """
    end = size
    if isfinite(marks[PASSED]):
        end = min(size, marks[PASSED] - t - tau)
        if end <= 0:
            return
        if end < size:
            ended, _, _ = advance(forces, law, ground, tau, state, end)
    rate, growth = turning(linear, angles, law, state)
    last_rate, last_growth = turning(linear, angles, law, ended)
    peak = max(abs(rate), abs(last_rate))
    # Where it moves one way all along, and first slower, the turning point is the slowest moment.
    if growth * last_growth < 0 and (rate * last_rate < 0 or (rate + last_rate) * growth > 0):
        low, high, x = 0.0, end, end
        for _ in range(100):
            before, x = x, low + (high - low) * growth / (growth - last_growth)
            there, _, _ = advance(forces, law, ground, tau, state, x)
            rate, inside = turning(linear, angles, law, there)
            peak = max(peak, abs(rate))
            if abs(x - before) <= RATE_TOLERANCE * size:
                break
            if (inside > 0) == (growth > 0):
                low, growth, last_growth = x, inside, last_growth / 2  # so that neither end of the bracket stays
            else:
                high, last_growth, growth = x, inside, growth / 2
    marks[RATE_PEAK + law.d] = max(marks[RATE_PEAK + law.d], peak)


@inlined
def may_peak(fastest, bow, bounded, peak, state, size, ended, last):
    """Whether a step may have the largest |phi.| so far, of a flight that ends with it or in which it grows no longer.

    `fastest`, `bow` and `bounded` are of the numbers of its direction, and `peak` is the largest |phi.| before. q.. is
    almost straight in a step: where it changes sign, |q.| exceeds that of both ends by a quarter at most of the smaller
    |q..| times the step.
    """
    w = abs(ended.w)
    grows = not last and ended.w * ended.f > bow * (w * w * w)
    most = max(abs(state.w), w) + size * min(abs(state.f), abs(ended.f))
    return not (ended.q <= bounded) or (not grows and fastest * most > peak)


@inlined
def may_have_peak(numbers, d, state, size, ended, last, marks):
    """The same by the numbers of a history and what it has noted."""
    return may_peak(
        numbers[d, FASTEST], numbers[d, BOW], numbers[d, BOUNDED], marks[RATE_PEAK + d], state, size, ended, last
    )  # fmt: skip


@inlined
def keep_rate(structure, law, ground, t, tau, state, size, ended, last, marks):
    """Note in `marks` the largest |phi.| of an accepted step where it may be larger than all before.

    `last` tells whether a flight ends with this step, or the outcome becomes unknown.
    """
    if may_have_peak(structure.numbers, law.d, state, size, ended, last, marks):
        linear, angles = structure.linear, structure.angles
        look_for_peak(linear, structure.forces, angles, law, ground, t, tau, state, size, ended, marks)
