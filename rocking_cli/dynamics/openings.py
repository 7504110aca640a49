"""The kernel's watch of joints: the forces at each, and how far it opens or slips if it alone could."""

from __future__ import annotations

from math import ceil, isfinite, nan, sqrt
from typing import NamedTuple

import numpy as np

from rocking_cli.dynamics.stepping import IMPACTS, PEAK, called, inlined, quintic

# What `marks` gathers of the joints: when their opening passes its limit, why and where, with peaks and impacts until
# then; the first moment at which one does not bear, where, with the peaks until then; the largest opening [m], where
# and when, the longest time for which a joint is open, and when and where first a joint that stays closed would open.
PASSED, REASON, WHERE, PASSED_PEAK, PASSED_IMPACTS, WARNED, WARNED_WHERE, WARNED_PEAK = 8, 9, 10, 11, 13, 14, 15, 16
LARGEST, LARGEST_WHERE, LARGEST_AT, LONGEST, PARTED, PARTED_WHERE = 18, 19, 20, 21, 22, 23
# Why a history is not known any longer.
OPENS, SLIDES, CRUSHES, WEIGHTLESS, APART, BOUND = range(6)
# Columns of `contacts`: rows of the two normal forces and of the shear force, and whether the joint bears at other ends
# in the other direction; of `bearing`: coefficient of friction, strength [N].
NORMAL, OTHER, SHEAR, CHANGES = range(4)
FRICTION, STRENGTH = range(2)
# What is kept of each joint, a row a joint: openings of its ends and their rates, lengths of slip in either sense and
# their rates, and the four accelerations at the end of a step, at its start and half way; and of all of them together.
GAP, GAP_RATE, SLIP, SLIP_RATE, GAP_ACC, SLIP_ACC, START_ACC, HALF_ACC = 0, 2, 4, 6, 8, 10, 12, 16
KEPT = 20
MOVING, FRESH, SO_FAR, SINCE, SEEN = 0, 1, 2, 4, 5
NOTES = 6
OF_ROW = 20  # of `rows`: powers 0 to 3 of the factors of 1, u_g'', q.^2 and v_g'' in a force, and of its compliance
LOOK = 1.25e-3  # s: longest step in which openings of joints are advanced, eight in 0.01 s
COINCIDE = 1e-9  # distance of moments that coincide, over a sample interval


class Joints(NamedTuple):
    """Joints of all structures, against which histories are checked; see `rocking_cli.dynamics.joints`."""

    # int (m, 8): first joint, numbers of joints, rows and cells; places of the first of `rows`, `struck` and `within`,
    # and the number of cells of the last
    sizes: np.ndarray
    contacts: np.ndarray  # int (joints, 2, 4): see the columns above, for either direction; -1 where there is none
    bearing: np.ndarray  # (joints, 2): see the columns above
    # (n, OF_ROW): forces [N] and compliance [1/kg] over q, of all cells, directions and rows of each structure
    rows: np.ndarray
    # (n, 2): of its directions and rows, impulses over the rate before, a constant and the factor of eta
    struck: np.ndarray
    stopped: np.ndarray  # (n, 2): the same of a stop, in the direction that it ends for a moment
    within: np.ndarray  # (n, 5): of its cells and directions, where all joints bear for certain, see `quiet`
    # (joints, 3, 4): of both normal forces and the shear force at rest, factors of 1, u_g'' and v_g'', and compliance
    rest: np.ndarray
    # (m, 8): gravity [m/s2], limit of the opening [m], longest step in the structure's own size [s], whether all forces
    # scale with g, the u_g'' and the q.^2 that joints bear up to phi_cr, each without the other, and the least and the
    # largest u_g'' that they bear at rest
    numbers: np.ndarray


class Watch(NamedTuple):
    """The joints of one structure, and the numbers of one history."""

    size: int
    cells: int  # of `rows`
    lines: int  # rows of a direction in a cell
    contacts: np.ndarray
    bearing: np.ndarray
    rows: np.ndarray
    struck: np.ndarray
    stopped: np.ndarray
    within: np.ndarray
    rest: np.ndarray
    steady_from: float  # u_g'' at which no joint fails at rest
    steady_to: float
    gravity: float
    limit: float
    step: float
    scales: bool  # whether all forces scale with g, which those of ties do not
    slender: float  # factor on the slenderness: u_g'' is divided by it, except for the joints
    slow: float  # q.^2 up to which no joint opens before phi_cr under any u_g'' of the motion
    kept: np.ndarray  # (joints, KEPT)
    notes: np.ndarray  # (NOTES,)
    active: np.ndarray  # int (4 joints,): rows that move in a step


class Demand(NamedTuple):
    """Forces that are missing at the joints at one moment; joints by their numbers, -1 for none."""

    missing: float  # largest force missing at any joint [N]
    where: int  # joint of that force
    crushes: int  # joint that crushes
    parted: int  # closed joint at which the largest force is missing


@inlined
def cubic(at, first, x):
    """A cubic of a row at a place of its cell."""
    return at[first] + x * (at[first + 1] + x * (at[first + 2] + x * at[first + 3]))


@inlined
def between(state, ended, size, x):
    """q and w inside a step, by the polynomial of order 5 through both of its ends."""
    c1, c2, c3, c4, c5 = quintic(state, ended, size)
    height = state.q + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))))
    speed = c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))
    return max(height, 0.0), speed / size


@inlined
def quiet(watch, law, ground, tau, q, w):
    """Whether no joint moves and all certainly bear: u_g'' is between two straight lines over q.^2, up to some q.^2.

    Forces are affine in g, u_g'' and q.^2: with g times a factor they bear under u_g'' and q.^2 times that. That of a
    tie does not grow with g, and nothing is certain under vertical motion.
    """
    if watch.notes[MOVING] != 0:
        return False
    if w * w <= watch.slow and q <= law.q_cr:
        return True
    weight = ground.g + ground.grade * tau
    if weight <= 0 or not (watch.scales or weight == law.gravity):
        return False
    per_weight = watch.gravity / weight
    cells = watch.within.shape[0] // 2
    k = min(max(int(q * cells / law.q_end), 0), cells - 1)
    y, push = w * w * per_weight, (1.0 - 2.0 * law.d) * (ground.push + ground.ramp * tau) * watch.slender * per_weight
    line = watch.within[2 * k + law.d]
    return y <= line[4] and line[0] + line[1] * y <= push and push <= line[2] + line[3] * y


@called
def weigh(watch, d, per_end, q, w, u, weight, lift, held):
    """Fill in how fast each joint would open and slip at this moment, and return the `Demand`.

    `held` is the acceleration of phi that a stop holds back.
    """
    rows, kept = watch.rows, watch.kept
    place = q * per_end * watch.cells
    k = min(max(int(place), 0), watch.cells - 1)
    x = place - k
    row = (2 * k + d) * watch.lines
    one, push, rate, up = weight, u, w * w, lift
    missing, where, crushes, tension, parted = 0.0, -1, -1, 0.0, -1
    for j in range(watch.size):
        for end in range(4):
            kept[j, GAP_ACC + end] = -1.0
        total, shear = 0.0, watch.contacts[j, d, SHEAR]
        if shear < 0:
            continue
        for end in range(2):
            r = watch.contacts[j, d, NORMAL + end]
            if r < 0:
                continue
            at = rows[row + r]
            n = one * cubic(at, 0, x) + push * cubic(at, 4, x) + rate * cubic(at, 8, x) + up * cubic(at, 12, x)
            n += held * watch.stopped[d * watch.lines + r, 0]
            total += n
            kept[j, GAP_ACC + end] = -n * cubic(at, 16, x)
            if -n > missing:
                missing, where = -n, j
            if -n > tension and watch.contacts[j, d, OTHER] >= 0:
                tension, parted = -n, j
            if n > watch.bearing[j, STRENGTH]:
                crushes = j
        friction = watch.bearing[j, FRICTION]
        if isfinite(friction):
            at = rows[row + shear]
            t = one * cubic(at, 0, x) + push * cubic(at, 4, x) + rate * cubic(at, 8, x) + up * cubic(at, 12, x)
            t += held * watch.stopped[d * watch.lines + shear, 0]
            c = cubic(at, 16, x)
            for sense in range(2):
                left = friction * max(total, 0.0) - (1.0 - 2.0 * sense) * t
                kept[j, SLIP_ACC + sense] = -left * c
                if -left > missing:
                    missing, where = -left, j
    return Demand(missing, where, crushes, parted)


@inlined
def advance_opening(kept, j, end, a0, a1, h):
    """Advance one opening or slip by h under an acceleration straight between its two ends; True if it moves."""
    slips = end >= 2
    at, rate = (SLIP + end - 2, SLIP_RATE + end - 2) if slips else (GAP + end, GAP_RATE + end)
    x, v = kept[j, at], kept[j, rate]
    if v > 0 or (not slips and x > 0):
        v1 = v + h * (a0 + a1) / 2
        x1 = x + h * v + h * h * (2 * a0 + a1) / 6
        if slips and v1 <= 0:  # it stops on the way, and stays where it is
            x1, v1 = x + h * v * v / (v - v1) / 2, 0.0
        elif not slips and x1 <= 0:
            x1, v1 = 0.0, 0.0
        kept[j, at], kept[j, rate] = x1, v1
    elif a1 > 0:  # it begins on the way
        left = h if a0 >= 0 else h * a1 / (a1 - a0)
        begun = max(a0, 0.0)
        kept[j, at] = x + left * left * (2 * begun + a1) / 6
        kept[j, rate] = left * (begun + a1) / 2
    return kept[j, rate] > 0 or (not slips and kept[j, at] > 0)


@inlined
def through(kept, j, end, x):
    """The acceleration of a row inside a step, by the parabola through its start, middle and end."""
    a0, am, a1 = kept[j, START_ACC + end], kept[j, HALF_ACC + end], kept[j, GAP_ACC + end]
    return a0 + x * (4 * am - 3 * a0 - a1 + x * (2 * a0 - 4 * am + 2 * a1))


@called
def passed(watch, d, t, q, reason, where, marks):
    """Note in `marks` that the outcome is unknown from here on, with the reason and the joint."""
    marks[PASSED], marks[REASON], marks[WHERE], marks[PASSED_IMPACTS] = t, reason, where, marks[IMPACTS]
    for side in range(2):
        marks[PASSED_PEAK + side] = watch.notes[SO_FAR + side]
    marks[PASSED_PEAK + d] = max(watch.notes[SO_FAR + d], q)


@called
def note(watch, d, q_cr, t, q, demand, moving, marks):
    """Note in `marks` which joints open, slide or crush at this moment."""
    notes, kept = watch.notes, watch.kept
    missing, where, crushes, parted = demand
    if parted >= 0 and not isfinite(marks[PARTED]):
        marks[PARTED], marks[PARTED_WHERE] = t, parted
    if missing > 0 and not isfinite(marks[WARNED]):
        marks[WARNED], marks[WARNED_WHERE] = t, where
        for side in range(2):
            marks[WARNED_PEAK + side] = notes[SO_FAR + side]
        marks[WARNED_PEAK + d] = max(notes[SO_FAR + d], q)
    largest, at, slides = 0.0, -1, False
    for j in range(watch.size):
        gap, slip = max(kept[j, GAP], kept[j, GAP + 1]), kept[j, SLIP] + kept[j, SLIP + 1]
        if max(gap, slip) > largest:
            largest, at, slides = max(gap, slip), j, slip > gap
    if largest > marks[LARGEST] and q <= q_cr:  # beyond, it may be overturning
        marks[LARGEST], marks[LARGEST_WHERE], marks[LARGEST_AT] = largest, at, t
    if not isfinite(marks[PASSED]) and (largest > watch.limit or crushes >= 0):
        passed(
            watch,
            d,
            t,
            q,
            CRUSHES if crushes >= 0 else SLIDES if slides else OPENS,
            at if crushes < 0 else crushes,
            marks,
        )
    if moving and not isfinite(notes[SINCE]):
        notes[SINCE] = t
    elif not moving and isfinite(notes[SINCE]):
        marks[LONGEST] = max(marks[LONGEST], t - notes[SINCE])
        notes[SINCE] = nan


@inlined
def copy_accelerations(watch, column):
    """Keep the present accelerations in another column; slices of one array would be copied through memory."""
    for j in range(watch.size):
        for end in range(4):
            watch.kept[j, column + end] = watch.kept[j, GAP_ACC + end]


@called
def look(watch, law, ground, t, tau, state, size, ended, peak, held, held_end, marks):
    """Check the joints over a step: how far any opens or slips if it alone could.

    `peak` is the largest q of its direction before the step, `held` and `held_end` the accelerations of phi that a stop
    holds back at both ends.
    """
    notes, kept, d, q_cr = watch.notes, watch.kept, law.d, law.q_cr
    notes[FRESH] = 0.0
    notes[SO_FAR + d], notes[SO_FAR + 1 - d] = peak, marks[PEAK + 1 - d]
    s, per_end, unit = 1.0 - 2.0 * d, 1 / law.q_end, law.gravity / watch.gravity
    u0, ramp = s * ground.push * watch.slender, s * ground.ramp * watch.slender
    lift = ground.g - law.gravity
    if not abs(notes[SEEN] - t - tau) <= COINCIDE * size:  # else the step before has ended here
        now = weigh(watch, d, per_end, state.q, state.w, u0 + ramp * tau, unit, lift + ground.grade * tau, held)
        note(watch, d, q_cr, t + tau, state.q, now, notes[MOVING] > 0, marks)
    notes[SEEN] = t + tau + size
    copy_accelerations(watch, START_ACC)
    steps = max(1, ceil(size / watch.step - 1e-9))
    half = Demand(0.0, -1, -1, -1)
    if steps > 2:
        q, w = between(state, ended, size, 0.5)
        at = tau + size / 2
        middle = (held + held_end) / 2
        half = weigh(watch, d, per_end, q, w, u0 + ramp * at, unit, lift + ground.grade * at, middle)
        copy_accelerations(watch, HALF_ACC)
    at = tau + size
    last = weigh(watch, d, per_end, ended.q, ended.w, u0 + ramp * at, unit, lift + ground.grade * at, held_end)
    if steps <= 2:
        for j in range(watch.size):
            for end in range(4):
                kept[j, HALF_ACC + end] = (kept[j, START_ACC + end] + kept[j, GAP_ACC + end]) / 2
    rows = 0  # that move, or begin to
    for j in range(watch.size):
        for end in range(4):
            still = kept[j, START_ACC + end] <= 0 and kept[j, HALF_ACC + end] <= 0 and kept[j, GAP_ACC + end] <= 0
            column = end if end < 2 else end + SLIP - 2
            if not (still and kept[j, column + 2] <= 0 and (end >= 2 or kept[j, column] <= 0)):
                watch.active[rows] = 4 * j + end
                rows += 1
    if rows == 0:
        notes[MOVING] = 0.0
        crushes = last.crushes if half.crushes < 0 else half.crushes
        note(watch, d, q_cr, t + at, ended.q, Demand(0.0, -1, crushes, -1), False, marks)
        return
    for step in range(1, steps + 1):
        x = step / steps
        moving, most, where, parted = False, 0.0, -1, -1
        for k in range(rows):
            j, end = watch.active[k] // 4, watch.active[k] % 4
            now = through(kept, j, end, x)
            if advance_opening(kept, j, end, through(kept, j, end, x - 1 / steps), now, size / steps):
                moving = True
            if now > most:
                most, where = now, j
            if now > 0 and end < 2 and watch.contacts[j, d, OTHER] >= 0:
                parted = j
        q, _ = between(state, ended, size, x)
        crushes = last.crushes if step == steps else half.crushes if 2 * step >= steps else -1
        notes[MOVING] = 1.0 if moving else 0.0
        note(watch, d, q_cr, t + tau + size * x, q, Demand(most, where, crushes, parted), moving, marks)
        notes[SO_FAR + d] = max(notes[SO_FAR + d], q)


@inlined
def bears(watch, j, d, eta):
    """The least by which an impact presses the ends of a joint, or friction exceeds its shear, over the rate before.

    d is the direction that begins.
    """
    row, shear = d * watch.lines, watch.contacts[j, d, SHEAR]
    least, total = 0.0, 0.0
    if shear < 0:
        return least
    for end in range(2):
        r = watch.contacts[j, d, NORMAL + end]
        if r >= 0:
            p = watch.struck[row + r, 0] + eta * watch.struck[row + r, 1]
            total, least = total + p, min(least, p)
    friction = watch.bearing[j, FRICTION]
    if isfinite(friction):
        p = watch.struck[row + shear, 0] + eta * watch.struck[row + shear, 1]
        least = min(least, friction * max(total, 0.0) - abs(p))
    return least


@called
def strike(watch, d, t, place, impulses, rate, eta, marks):
    """Open the joints, or let them slide, that an impact does not press together.

    d is the direction that begins; or that which a stop ends for a moment, at a `place` above 0 of its range of q.
    `impulses` are those of `struck` or `stopped`.
    """
    kept, row = watch.kept, d * watch.lines
    moving, missing, where = False, 0.0, -1
    k = min(int(place * watch.cells), watch.cells - 1)
    x = place * watch.cells - k
    first = (2 * k + d) * watch.lines
    for j in range(watch.size):
        if place == 0 and watch.contacts[j, d, CHANGES]:
            kept[j, GAP : GAP + 4] = 0.0
        shear = watch.contacts[j, d, SHEAR]
        if shear < 0:
            continue
        total = 0.0
        for end in range(2):
            r = watch.contacts[j, d, NORMAL + end]
            if r >= 0:
                p = rate * (impulses[row + r, 0] + eta * impulses[row + r, 1])
                total += p
                if -p > missing:
                    missing, where = -p, j
                kept[j, GAP_RATE + end] += cubic(watch.rows[first + r], 16, x) * max(0.0, -p)
        friction = watch.bearing[j, FRICTION]
        if isfinite(friction):
            p = rate * (impulses[row + shear, 0] + eta * impulses[row + shear, 1])
            for sense in range(2):
                left = friction * max(total, 0.0) - (1.0 - 2.0 * sense) * p
                if -left > missing:
                    missing, where = -left, j
                kept[j, SLIP_RATE + sense] += cubic(watch.rows[first + shear], 16, x) * max(0.0, -left)
        for end in range(2):
            if kept[j, GAP + end] > 0 or kept[j, GAP_RATE + end] > 0 or kept[j, SLIP_RATE + end] > 0:
                moving = True
    watch.notes[MOVING] = 1.0 if moving else 0.0
    watch.notes[SEEN] = nan
    note(watch, d, 1.0, t, 0.0, Demand(missing, where, -1, -1), moving, marks)


@called
def settle(watch, t, marks):
    """Close all joints of a structure at rest; slips remain."""
    watch.kept[:, GAP : GAP + 4] = 0.0
    watch.kept[:, SLIP_RATE : SLIP_RATE + 2] = 0.0
    note(watch, 0, 1.0, t, 0.0, Demand(0.0, -1, -1, -1), False, marks)
    watch.notes[MOVING] = 0.0


@inlined
def steady(watch, u):
    """Whether no joint moves at rest, nor begins to under a ground acceleration u of a structure of usual weight."""
    if watch.size == 0:
        return True
    least, most = min(u, u * watch.slender), max(u, u * watch.slender)
    return watch.notes[MOVING] == 0 and watch.steady_from <= least and most <= watch.steady_to


@called
def stand(watch, t, size, steps, u0, u1, weight, lift0, lift1, marks):
    """Check the joints at rest over a step, as `look` does those of a motion.

    u is u_g'' and lift v_g'' at the start and the end of the step, which begins at t. Openings follow the slenderness
    of the history, as uplift does, and friction does not.
    """
    kept, h = watch.kept, size / steps
    watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
    for step in range(steps):
        ua, ub = u0 + (u1 - u0) * step / steps, u0 + (u1 - u0) * (step + 1) / steps
        la, lb = lift0 + (lift1 - lift0) * step / steps, lift0 + (lift1 - lift0) * (step + 1) / steps
        moving, missing, where = False, 0.0, -1
        for j in range(watch.size):
            rest, total_a, total_b = watch.rest[j], 0.0, 0.0
            for end in range(2):
                na = weight * rest[end, 0] + ua * rest[end, 1] + la * rest[end, 2]
                nb = weight * rest[end, 0] + ub * rest[end, 1] + lb * rest[end, 2]
                total_a, total_b = total_a + na, total_b + nb
                if advance_opening(kept, j, end, -na * rest[end, 3], -nb * rest[end, 3], h):
                    moving = True
                if -nb * rest[end, 3] > 0 and -nb > missing:
                    missing, where = -nb, j
            friction = watch.bearing[j, FRICTION]
            if isfinite(friction):
                ta = weight * rest[2, 0] + ua * watch.slender * rest[2, 1] + la * rest[2, 2]
                tb = weight * rest[2, 0] + ub * watch.slender * rest[2, 1] + lb * rest[2, 2]
                for sense in range(2):
                    way = 1.0 - 2.0 * sense
                    left_a, left_b = friction * max(total_a, 0.0) - way * ta, friction * max(total_b, 0.0) - way * tb
                    if advance_opening(kept, j, 2 + sense, -left_a * rest[2, 3], -left_b * rest[2, 3], h):
                        moving = True
                    if -left_b * rest[2, 3] > 0 and -left_b > missing:
                        missing, where = -left_b, j
        note(watch, 0, 1.0, t + h * (step + 1), 0.0, Demand(missing, where, -1, -1), moving, marks)
        watch.notes[MOVING] = 1.0 if moving else 0.0


@called
def watch_of(joints, m, size, slender, motion, room):
    """The joints of a structure, none of which has opened."""
    first, count, rows, cells, rows_at, struck_at, within_at, within_cells = joints.sizes[m]
    gravity, limit, quick, scales, push, fast, steady_from, steady_to = joints.numbers[m]
    slow = -1.0
    if motion.v.size == 0 and (scales != 0 or size == 1):
        strongest = abs(motion.factor) * size * slender * (motion.ahead[0] if motion.ahead.size > 0 else 0.0)
        slow = fast / size * (1 - strongest / push)
    return Watch(
        count,
        cells,
        rows,
        joints.contacts[first : first + count],
        joints.bearing[first : first + count],
        joints.rows[rows_at : rows_at + cells * 2 * rows],
        joints.struck[struck_at : struck_at + 2 * rows],
        joints.stopped[struck_at : struck_at + 2 * rows],
        joints.within[within_at : within_at + within_cells * 2],
        joints.rest[first : first + count],
        steady_from,
        steady_to,
        gravity,
        limit,
        min(LOOK, quick * sqrt(size)),
        scales != 0,
        slender,
        slow,
        room.kept[:count],
        room.notes,
        room.active[: 4 * count],
    )
