"""The kernel's steps: the equation of motion by tables or in closed form, and where inside a step something happens.

Here too are the columns of arrays that all files of the kernel share, and the list of functions to compile.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cosh, isfinite, nan, sinh, sqrt
from typing import NamedTuple, TypeVar

import numpy as np

# Columns of `numbers`, one row a direction.
# Q_BOUND is the q at which something else than the mechanism decides, in `Deck` the phi [rad], infinite where nothing
# does; BOUND_ETA the restitution of a stop there, NaN where the motion is not known beyond. RATE is dphi/dq at rest,
# FASTEST the largest and BOW the largest |d2phi/dq2| over it, both up to the q BOUNDED. PAIRS is how many pairs of
# powers the polynomials of the forces have, 0 if there are none, and PER_REACH is 2 over the q up to which they hold.
LAMBDA, Q_CR, ETA, RATE, REST, Q_END, PER_CELL, P, KAPPA_G, GRAVITY, HELD, ONE_SIDED, Q_BOUND, BOUND_ETA = range(14)
FASTEST, BOW, BOUNDED, PAIRS, PER_REACH = range(14, 19)
COLUMNS = 19
# What `marks` gathers on the way, a row a history; of the joints, see `openings`. RATE_PEAK is the largest |phi.| of
# either direction, up to where the outcome is unknown.
PEAK, CROSSED, FIRST_UPLIFT, IMPACTS, ENDED, SIDE, STATUS, RATE_PEAK = 0, 2, 3, 4, 5, 6, 7, 24
MARKS = 26
# How a flight over part of a sample interval ends.
REACHED, IMPACT, LIMIT, STUCK = range(4)
# What a flight waits for: the end of a step; in its inside q.. = 0 (BEND, BACK), w = 0 (TURN), or q at a level: phi_cr,
# the bound, rest, or a corner of the force (CROSS, BOUND, HIT, NODE). From DONE on it waits for nothing: DONE + how.
STEP, BEND, BACK, TURN, CROSS, BOUND, HIT, NODE, PARTS, DONE = range(10)
MOST_PROBES = 200  # trial points of a search inside a step, far more than a bisection to the last bit takes
BEHIND = 1e-11  # distance behind a corner of the force at which a motion goes on, over a cell

SOURCE: list[Callable[..., object]] = []
"""The functions to compile, each after those it calls."""
INLINE: list[Callable[..., object]] = []
"""Those of them that are compiled into their callers: a call would cost more than the few sums inside."""
Function = TypeVar("Function", bound=Callable[..., object])


def called(function: Function) -> Function:
    """Mark a function of the kernel."""
    SOURCE.append(function)
    return function


def inlined(function: Function) -> Function:
    """Mark a function of the kernel that is compiled into its callers."""
    INLINE.append(function)
    return called(function)


class Law(NamedTuple):
    """Numbers of the equation of motion in one direction, beside its force table."""

    exact: bool  # the closed form holds
    d: int
    per_cell: float
    p: float
    kappa_g: float
    q_cr: float
    q_end: float
    q_bound: float
    gravity: float
    pairs: int
    per_reach: float


class ForceTables(NamedTuple):
    """The forces of a structure: as tables, and as polynomials of the most of them that are smooth."""

    table: np.ndarray  # see `kernels.Deck.forces`
    smooth: np.ndarray  # see `kernels.Deck.smooth`


class Ground(NamedTuple):
    """The shaking over a piece of time: s u_g'' and g + v_g'' at tau = 0, and what they grow by [m/s2, m/s3]."""

    push: float
    ramp: float
    g: float
    grade: float


class State(NamedTuple):
    """A motion at a moment: q, w = q. and f = q.. ."""

    q: float
    w: float
    f: float


class Inside(NamedTuple):
    """A step and its end, where in it q turns first and the q it reaches, and the part of it that is looked at."""

    size: float
    ended: State
    turn: float
    extreme: float
    part: int  # 0 up to where q turns, 2 from there on; 1 and 3 behind the crossing of phi_cr in it


class Search(NamedTuple):
    """The time in a step to try, and of a search inside it the bracket, its kind and how often it was tried."""

    x: float
    low: float
    high: float
    falling: bool  # whether what is sought is positive at low and not at high
    level: float
    tries: int


class Flight(NamedTuple):
    """A flight from tau towards end, which asks for the state a time `search.x` after tau."""

    mode: int
    tau: float
    end: float
    h: float  # step to try next
    state: State  # at tau
    inside: Inside
    search: Search


@inlined
def law_of(exact, numbers, d):
    """The law of one direction."""
    return Law(
        exact,
        d,
        numbers[d, PER_CELL],
        numbers[d, P],
        numbers[d, KAPPA_G],
        numbers[d, Q_CR],
        numbers[d, Q_END],
        numbers[d, Q_BOUND],
        numbers[d, GRAVITY],
        int(numbers[d, PAIRS]),
        numbers[d, PER_REACH],
    )


@inlined
def by_table(table, law, q, push, g):
    """q.. by the tables; beyond their ends the outermost cubic goes on smoothly."""
    d = law.d
    place = q * law.per_cell
    k = min(max(int(place), 0), table.shape[0] - 1)
    x = place - k
    if table.ndim == 4:
        a0 = g * table[k, d, 0, 0] + push * table[k, d, 1, 0] + (law.gravity - g) * table[k, d, 2, 0]
        a1 = g * table[k, d, 0, 1] + push * table[k, d, 1, 1] + (law.gravity - g) * table[k, d, 2, 1]
        a2 = g * table[k, d, 0, 2] + push * table[k, d, 1, 2] + (law.gravity - g) * table[k, d, 2, 2]
        a3 = g * table[k, d, 0, 3] + push * table[k, d, 1, 3] + (law.gravity - g) * table[k, d, 2, 3]
        return -(a0 + x * a1 + x * x * (a2 + x * a3))
    # One cubic of both forces: they need not wait for x.
    b0 = g * table[k, d, 0] + push * table[k, d, 4]
    b1 = g * table[k, d, 1] + push * table[k, d, 5]
    b2 = g * table[k, d, 2] + push * table[k, d, 6]
    b3 = g * table[k, d, 3] + push * table[k, d, 7]
    return -(b0 + x * b1 + x * x * (b2 + x * b3))


@inlined
def force(forces, law, q, push, g):
    """q.. by the polynomials; beyond their reach, or without any, by the tables."""
    d, y = law.d, q * law.per_reach - 1
    if law.pairs > 0 and y <= 1:
        smooth, z = forces.smooth, y * y
        g_even = g_odd = b_even = b_odd = 0.0
        for pair in range(law.pairs - 1, -1, -1):
            g_even = g_even * z + smooth[d, 4 * pair]
            g_odd = g_odd * z + smooth[d, 4 * pair + 1]
            b_even = b_even * z + smooth[d, 4 * pair + 2]
            b_odd = b_odd * z + smooth[d, 4 * pair + 3]
        return -(g * (g_even + y * g_odd) + push * (b_even + y * b_odd))
    return by_table(forces.table, law, q, push, g)


@inlined
def nystrom(force, forces, law, ground, tau, state, h):
    """One step h of Dormand, El-Mikkawy and Prince's Nystrom pair 6(4)6FM [IMA J. Numer. Anal. 7, 1987].

    Returns the state at its end, the difference to order 4 in q and in w, and the largest q at which it takes a force.
    """
    q, w, f = state
    ramp, grade = ground.ramp, ground.grade
    push, g = ground.push + ramp * tau, ground.g + grade * tau
    hh = h * h
    q2 = q + h * (w * 0.1) + hh * (f * (1 / 200))
    k2 = force(forces, law, q2, push + h * (ramp * 0.1), g + h * (grade * 0.1))
    q3 = q + h * (w * 0.3) + hh * (f * (-1 / 2200) + k2 * (1 / 22))
    k3 = force(forces, law, q3, push + h * (ramp * 0.3), g + h * (grade * 0.3))
    q4 = q + h * (w * 0.7) + hh * (f * (637 / 6600) + k2 * (-7 / 110) + k3 * (7 / 33))
    k4 = force(forces, law, q4, push + h * (ramp * 0.7), g + h * (grade * 0.7))
    q5 = (
        q
        + h * (w * 0.68)
        + hh * (f * (225437 / 1968750) + k2 * (-30073 / 281250) + k3 * (65569 / 281250) + k4 * (-9367 / 984375))
    )
    k5 = force(forces, law, q5, push + h * (ramp * 0.68), g + h * (grade * 0.68))
    q1 = (
        q
        + h * w
        + hh * (f * (151 / 2142) + k2 * (5 / 116) + k3 * (385 / 1368) + k4 * (55 / 168) + k5 * (-6250 / 28101))
    )
    k6 = force(forces, law, q1, push + h * ramp, g + h * grade)
    w1 = w + h * (
        f * (151 / 2142)
        + k2 * (25 / 522)
        + k3 * (275 / 684)
        + k4 * (275 / 252)
        + k5 * (-78125 / 112404)
        + k6 * (1 / 12)
    )
    e_q = hh * (
        f * (151 / 2142 - 1349 / 157500)
        + k2 * (5 / 116 - 7873 / 50000)
        + k3 * (385 / 1368 - 192199 / 900000)
        + k4 * (55 / 168 - 521683 / 2100000)
        + k5 * (16 / 125 - 6250 / 28101)
    )
    e_w = h * (
        f * (151 / 2142 - 1349 / 157500)
        + k2 * (25 / 522 - 7873 / 45000)
        + k3 * (275 / 684 - 27457 / 90000)
        + k4 * (275 / 252 - 521683 / 630000)
        + k5 * (2 / 5 - 78125 / 112404)
    )
    farthest = max(max(max(q2, q3), max(q4, q5)), q1)
    return State(q1, w1, k6), abs(e_q), abs(e_w), farthest


@inlined
def balance(law, q, push):
    """q.. of the linear model without vertical ground motion [Eqs. 12, 16]."""
    return law.p * law.p * (q - law.q_cr - law.kappa_g * push)


@inlined
def hyperbolic(y):
    """cosh y - 1, sinh y and sinh y - y, none of which cancels for small y."""
    if abs(y) < 0.1:
        z = y * y
        lag = y * z / 6 * (1 + z * (1 / 20) * (1 + z * (1 / 42) * (1 + z * (1 / 72) * (1 + z * (1 / 110)))))
        return z / 2 * (1 + z * (1 / 12) * (1 + z * (1 / 30) * (1 + z * (1 / 56) * (1 + z * (1 / 90))))), y + lag, lag
    half = sinh(y / 2)
    sh = 2 * half * cosh(y / 2)
    return 2 * half * half, sh, sh - y


@inlined
def closed_form(law, ground, state, h):
    """A time h of the linear model on a straight ramp of the ground acceleration [Eqs. 12, 16].

    q.. = p^2 (q - q_s), q_s = phi_cr + s kappa u_g''/g the rotation of balance, growing by slope:
    q = q_0 + (q - q_s)_0 (cosh ph - 1) + w_0/p sinh ph - slope/p (sinh ph - ph)
    """
    q, w, f = state
    p, per_p = law.p, 1 / law.p
    slack = f * per_p * per_p
    drift = (w - law.kappa_g * ground.ramp) * per_p  # the rate, over p, at which it moves away from balance
    ch1, sh, lag = hyperbolic(p * h)
    moved = slack * ch1 + drift * lag + w * h
    return State(q + moved, w + p * (slack * sh + drift * ch1), p * p * (slack * (1 + ch1) + drift * sh))


@inlined
def advance(forces, law, ground, tau, state, h):
    """The state a time h after tau, and the errors of its q and w."""
    if law.exact:
        return closed_form(law, ground, state, h), 0.0, 0.0
    ended, e_q, e_w, _ = nystrom(force, forces, law, ground, tau, state, h)
    return ended, e_q, e_w


@inlined
def misses(law, rtol, state, ended, e_q, e_w):
    """Error of a step over the tolerance: rtol times q and w, at least rtol times a hundredth of phi_cr."""
    if law.exact:
        return 0.0
    least = 1e-2 * law.q_cr
    most_q = max(least, max(abs(state.q), abs(ended.q)))
    most_w = max(least * law.p, max(abs(state.w), abs(ended.w)))
    return max(e_q * most_w, e_w * most_q) / (rtol * most_q * most_w)


@inlined
def rises(law, state, ended):
    """Whether q grows all through a step, and passes neither phi_cr nor the bound in it."""
    outward = state.w > 0 and ended.w > 0 and (state.f >= 0 or ended.f <= 0)
    return outward and (ended.q < law.q_cr or state.q >= law.q_cr) and ended.q < law.q_bound


@inlined
def falls(state, ended):
    """Whether q falls all through a step, and does not reach 0 in it."""
    return state.w < 0 and ended.w < 0 and (state.f <= 0 or ended.f >= 0) and ended.q > 0


@called
def first_root(a, b, c):
    """The least x > 0 with a x^2 + b x + c = 0, without cancellation; NaN if there is none."""
    discriminant = b * b - 4 * a * c
    if not discriminant >= 0:
        return nan
    k = -(b + (sqrt(discriminant) if b >= 0 else -sqrt(discriminant))) / 2
    one = k / a if a != 0 else nan
    other = c / k if k != 0 else nan
    if not one > 0:
        return other
    return min(one, other) if other > 0 else one


@inlined
def set_out(law, tau, end, h, state):
    """A flight at the start of a step."""
    left = end - tau
    size = min(left, h)
    if state.q == 0 and state.f < 0 and state.w > 0:  # a hop: it lands after 2 w/-f or so
        size = min(size, -2.05 * state.w / state.f)
    mode = STEP if left > 0 else DONE + REACHED
    return Flight(
        mode, tau, end, h, state, Inside(size, state, size, state.q, 0), Search(size, 0.0, size, False, 0.0, 0)
    )


@inlined
def seek(flight, mode, inside, low, high, guess, falling, level):
    """The same flight, at the start of a search between two times inside its step."""
    x = guess if low < guess < high else (low + high) / 2
    search = Search(x, low, high, falling, level, 0)
    return Flight(mode, flight.tau, flight.end, flight.h, flight.state, inside, search)


@inlined
def ended_by(flight, how, size, ended):
    """The same flight, at the end of a step or of the part of it that is left."""
    inside = Inside(size, ended, flight.inside.turn, flight.inside.extreme, flight.inside.part)
    return Flight(DONE + how, flight.tau, flight.end, flight.h, flight.state, inside, flight.search)


@inlined
def quintic(state, ended, size):
    """The coefficients, from power 1 on, of the polynomial of order 5 through both ends of a step, over its size."""
    q, w, f = state
    q1, w1, f1 = ended
    v, v1, a, a1 = w * size, w1 * size, f * size * size, f1 * size * size
    rise = q1 - q - v - a / 2
    steer = v1 - v - a
    bend = a1 - a
    return (
        v, a / 2, 10 * rise - 4 * steer + bend / 2, -15 * rise + 7 * steer - bend, 6 * rise - 3 * steer + bend / 2
    )  # fmt: skip


@inlined
def guessed(state, ended, size, x, level, turns):
    """When q is at a level, or turns, by the polynomial of order 5 of a step: Newton from x; x where that fails."""
    c1, c2, c3, c4, c5 = quintic(state, ended, size)
    y = x / size
    for _ in range(2):
        speed = c1 + y * (2 * c2 + y * (3 * c3 + y * (4 * c4 + y * 5 * c5)))
        if turns:
            y -= speed / (2 * c2 + y * (6 * c3 + y * (12 * c4 + y * 20 * c5)))
        else:
            y -= (state.q - level + y * (c1 + y * (c2 + y * (c3 + y * (c4 + y * c5))))) / speed
    return y * size if 0 < y < 1 else x


@inlined
def is_rising(state):
    """Whether a step begins outward: from rest it lifts, whatever rounding says of f."""
    return state.w > 0 or (state.w == 0 and (state.q == 0 or state.f > 0))


@inlined
def first_turn(flight, peak):
    """Look for the first turning point of q in a step; `peak` is the largest q of the direction so far."""
    (q, w, f), size, (q1, w1, f1) = flight.state, flight.inside.size, flight.inside.ended
    rising = is_rising(flight.state)
    if q == 0 and q1 <= 0 and w > 0 and f < 0 and f1 < 0 and w * size <= peak:
        turn = 0.0  # a hop too low for a new peak: only its landing matters
    elif rising == (w1 <= 0):
        if w == 0:  # a start at rest: look behind the moment of greatest speed
            return seek(flight, BACK, flight.inside, 0.0, size, size / 2, f > 0, 0.0)
        guess = guessed(flight.state, flight.inside.ended, size, first_root((f1 - f) / (2 * size), f, w), 0.0, True)
        return seek(flight, TURN, flight.inside, 0.0, size, guess, rising, 0.0)
    else:
        turn = size
    inside = Inside(size, flight.inside.ended, turn, q1, 0)
    return Flight(PARTS, flight.tau, flight.end, flight.h, flight.state, inside, flight.search)


@inlined
def probed(mode, search, there):
    """Go on with a search inside a step after its trial point: Newton on the step itself, kept in a bracket.

    Stepping anew to each trial point gives an event the full order of the pair, which no interpolant has. Returns
    whether it is met, when and in which state, and the search with its next trial point.
    """
    (q, w, f), (h, low, high, falling, level, tries) = there, search
    balances = mode in (BEND, BACK)
    value = f if balances else w if mode == TURN else q - level
    rate = 0.0 if balances else f if mode == TURN else w
    # What then is missing is 1e-13 at most: near a turn q stands still.
    close = 1e-4 if mode == TURN or balances else 1e-8
    if value == 0:
        return True, h, there, search
    if (value < 0) == falling:
        high = h
    else:
        low = h
    trial, met = h - value / rate if rate != 0 else high, tries == MOST_PROBES
    if not low < trial < high:
        trial = (low + high) / 2
        met = met or high - low <= (1e-6 if balances else 4e-16) * high
    elif abs(trial - h) <= close * high:
        x = trial - h
        met, h, there = True, trial, State(q + x * (w + x / 2 * f), w + x * f, f)
    return met, h, there, Search(trial, low, high, falling, level, tries + 1)


@inlined
def resumed(flight, h, there, peak):
    """Go on with a flight whose search inside a step has met what it sought at h."""
    (q, w, f), mode, inside = there, flight.mode, flight.inside
    if mode == BEND:
        if flight.state.w * w < 0:  # end the step at its extreme, where it shows
            inside = Inside(h, there, h, q, 0)
        return first_turn(seek(flight, BEND, inside, 0.0, h, h, False, 0.0), peak)
    if mode == BACK and w != 0 and (w > 0) == is_rising(flight.state):
        guess = first_root((inside.ended.f - flight.state.f) / (2 * inside.size), flight.state.f, flight.state.w)
        return seek(flight, TURN, inside, h, inside.size, guess, is_rising(flight.state), 0.0)
    if mode == BOUND:
        return ended_by(flight, LIMIT, h, State(flight.search.level, w, f))
    if mode == HIT:
        return ended_by(flight, IMPACT, h, State(0.0, min(w, 0.0), f))
    if mode == BACK:
        inside = Inside(inside.size, inside.ended, 0.0, flight.state.q, 0)
    elif mode == TURN:
        inside = Inside(inside.size, inside.ended, h, q, 0)
    elif mode == CROSS:
        inside = Inside(inside.size, inside.ended, inside.turn, inside.extreme, inside.part + 1)
    search = Search(h, 0.0, h, False, 0.0, 0)
    return Flight(PARTS, flight.tau, flight.end, flight.h, flight.state, inside, search)


@inlined
def narrowed(flight, there, peak):
    """Go on with a search inside the step of a flight."""
    met, h, there, search = probed(flight.mode, flight.search, there)
    if met:
        return resumed(flight, h, there, peak)
    return Flight(flight.mode, flight.tau, flight.end, flight.h, flight.state, flight.inside, search)


@inlined
def looked_into(law, flight, t, marks):
    """Look for impact, peak, bound and crossing of phi_cr in a step: up to where q turns, and from there."""
    (q, w, _), (size, ended, turn, extreme, part) = flight.state, flight.inside
    rising, side = is_rising(flight.state), PEAK + law.d
    while part < 4:
        second = part >= 2
        if turn == (size if second else 0.0):
            part = 4 if second else 2
            continue
        xa, qa = (turn, extreme) if second and turn > 0 else (0.0, q)
        xb, qb = (size, ended.q) if second else (turn, extreme)
        if rising != second:
            inside = Inside(size, ended, turn, extreme, part)
            if part % 2 == 1:
                marks[CROSSED] = t + flight.tau + flight.search.x
            elif qa < law.q_cr <= min(qb, law.q_bound):
                return seek(flight, CROSS, inside, xa, xb, nan, False, law.q_cr)
            marks[side] = max(marks[side], min(qb, law.q_bound))
            if qa < law.q_bound <= qb:
                return seek(flight, BOUND, inside, xa, xb, nan, False, law.q_bound)
        elif qb <= 0:
            if not (qa > 0 or w > 0):
                return ended_by(flight, IMPACT, xa, State(0.0, 0.0, 0.0))
            guess = nan
            if xb == size:  # back from the end of the step: a parabola, then the polynomial
                guess = size - first_root(ended.f / 2, -ended.w, ended.q)
                guess = guessed(flight.state, ended, size, guess, 0.0, False)
            return seek(flight, HIT, Inside(size, ended, turn, extreme, part), xa, xb, guess, True, 0.0)
        part = 4 if second else 2
    return ended_by(flight, REACHED, size, ended)


@inlined
def resized(error):
    """The next step over one with this error: about its fifth root, of operations that all processors round alike."""
    fourth = sqrt(sqrt(error))
    return 0.9 * sqrt(sqrt(fourth)) / fourth


@inlined
def judged(law, rtol, flight, there, e_q, e_w, t, marks):
    """Go on with a flight from the state that it has asked for."""
    if flight.mode == STEP:
        tau, end, h, state, size = flight.tau, flight.end, flight.h, flight.state, flight.inside.size
        error = misses(law, rtol, state, there, e_q, e_w)
        if not error <= 1:
            h = size * (max(0.2, resized(error)) if isfinite(error) else 0.1)
            again = set_out(law, tau, end, h, state)
            return ended_by(again, STUCK, 0.0, state) if tau + h == tau else again
        if size == h and not law.exact:
            h = size * (5.0 if error < 1e-4 else min(5.0, resized(error)))
        flight = Flight(STEP, tau, end, h, state, Inside(size, there, size, there.q, 0), flight.search)
        if rises(law, state, there):
            marks[PEAK + law.d] = max(marks[PEAK + law.d], there.q)
            return ended_by(flight, REACHED, size, there)
        if falls(state, there):
            return ended_by(flight, REACHED, size, there)
        # w may change sign twice inside, unless it is too fast for that.
        slows = state.w * there.w > 0 and state.w * state.f < 0 and state.f * there.f < 0
        if slows and abs(state.w) < 2 * size * abs(state.f):
            return seek(flight, BEND, flight.inside, 0.0, size, size / 2, state.f > 0, 0.0)
        flight = first_turn(flight, marks[PEAK + law.d])
    else:
        flight = narrowed(flight, there, marks[PEAK + law.d])
    return looked_into(law, flight, t, marks) if flight.mode == PARTS else flight


@inlined
def corners_below(corners, law, q):
    """How many corners of the force lie below q."""
    return corners[min(max(int(q * law.per_cell), 0), corners.shape[0] - 1), law.d]


@inlined
def passes(corners, law, q, q1):
    """Whether there is a corner of the force between two places."""
    return corners.shape[0] > 0 and corners_below(corners, law, q) != corners_below(corners, law, q1)


@called
def up_to_corner(forces, corners, law, ground, flight, ended, peak):
    """The part of a step up to the first corner of the force, which no step of any order may pass, and q behind it.

    Where the step meets none, all of it and NaN.
    """
    tau, state, size = flight.tau, flight.state, flight.inside.size
    q, reached, until = state.q, ended.q, size
    rising = is_rising(state)
    if rising == (ended.w <= 0):  # it may go there and come back
        flight = Flight(STEP, tau, flight.end, flight.h, state, Inside(size, ended, size, q, 0), flight.search)
        flight = first_turn(flight, -1.0)
        while flight.mode != PARTS:
            there, _, _ = advance(forces, law, ground, tau, state, flight.search.x)
            flight = narrowed(flight, there, -1.0)
        if passes(corners, law, q, flight.inside.extreme):
            reached, until = flight.inside.extreme, flight.inside.turn
    if not passes(corners, law, q, reached):
        return size, nan
    outward = reached > q
    way = 1 if outward else -1
    here = corners_below(corners, law, q)
    k = min(max(int(q * law.per_cell), 0), corners.shape[0] - 1)
    while corners[k, law.d] == here:
        k += way
    node = k if outward else k + 1
    flight = seek(flight, NODE, flight.inside, 0.0, until, nan, not outward, node / law.per_cell)
    while flight.mode == NODE:
        there, _, _ = advance(forces, law, ground, tau, state, flight.search.x)
        flight = narrowed(flight, there, -1.0)
    return flight.search.x, (node + way * BEHIND) / law.per_cell
