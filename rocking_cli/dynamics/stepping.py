"""The kernel's steps: the equation of motion by tables or in closed form, and where inside a step something happens.

Here too are the columns of arrays that all files of the kernel share, and the list of functions to compile.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cosh, nan, sinh, sqrt
from typing import NamedTuple, TypeVar

# Columns of `numbers`, one row a direction.
# Q_BOUND is the q at which something else than the mechanism decides, in `Deck` the phi [rad], infinite where nothing
# does; BOUND_ETA the restitution of a stop there, NaN where the motion is not known beyond.
LAMBDA, Q_CR, ETA, RATE, REST, Q_END, PER_CELL, P, KAPPA_G, GRAVITY, HELD, ONE_SIDED, Q_BOUND, BOUND_ETA = range(14)
COLUMNS = 14
# What `marks` gathers on the way, a row a history; of the joints, see `openings`.
PEAK, CROSSED, FIRST_UPLIFT, IMPACTS, ENDED, SIDE, STATUS = 0, 2, 3, 4, 5, 6, 7
MARKS = 24
# How a flight over part of a sample interval ends.
REACHED, IMPACT, LIMIT, STUCK = range(4)
# What a search inside a step is for: q at a level, w = 0, or q.. = 0.
HEIGHT, TURN, BALANCE = range(3)
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
    )


@inlined
def force(forces, law, q, push, g):
    """q.. by the tables; beyond their ends the outermost cubic goes on smoothly."""
    place = q * law.per_cell
    k = min(max(int(place), 0), forces.shape[0] - 1)
    d = law.d
    x = place - k
    if forces.ndim == 4:
        a0 = g * forces[k, d, 0, 0] + push * forces[k, d, 1, 0] + (law.gravity - g) * forces[k, d, 2, 0]
        a1 = g * forces[k, d, 0, 1] + push * forces[k, d, 1, 1] + (law.gravity - g) * forces[k, d, 2, 1]
        a2 = g * forces[k, d, 0, 2] + push * forces[k, d, 1, 2] + (law.gravity - g) * forces[k, d, 2, 2]
        a3 = g * forces[k, d, 0, 3] + push * forces[k, d, 1, 3] + (law.gravity - g) * forces[k, d, 2, 3]
        return -(a0 + x * a1 + x * x * (a2 + x * a3))
    # One cubic of both forces: they need not wait for x.
    b0 = g * forces[k, d, 0] + push * forces[k, d, 4]
    b1 = g * forces[k, d, 1] + push * forces[k, d, 5]
    b2 = g * forces[k, d, 2] + push * forces[k, d, 6]
    b3 = g * forces[k, d, 3] + push * forces[k, d, 7]
    return -(b0 + x * b1 + x * x * (b2 + x * b3))


@inlined
def nystrom(forces, law, ground, tau, state, h):
    """One step h of Dormand, El-Mikkawy and Prince's Nystrom pair 6(4)6FM [IMA J. Numer. Anal. 7, 1987].

    Returns the state at its end, and the difference to order 4 in q and in w.
    """
    q, w, f = state
    ramp, grade = ground.ramp, ground.grade
    push, g = ground.push + ramp * tau, ground.g + grade * tau
    hh = h * h
    k2 = force(forces, law, q + h * (w / 10) + hh * (f / 200), push + h * (ramp / 10), g + h * (grade / 10))
    k3 = force(
        forces,
        law,
        q + h * (w * 0.3) + hh * (f * (-1 / 2200) + k2 * (1 / 22)),
        push + h * (ramp * 0.3),
        g + h * (grade * 0.3),
    )
    k4 = force(
        forces,
        law,
        q + h * (w * 0.7) + hh * (f * (637 / 6600) + k2 * (-7 / 110) + k3 * (7 / 33)),
        push + h * (ramp * 0.7),
        g + h * (grade * 0.7),
    )
    k5 = force(
        forces,
        law,
        q
        + h * (w * 0.68)
        + hh * (f * (225437 / 1968750) + k2 * (-30073 / 281250) + k3 * (65569 / 281250) + k4 * (-9367 / 984375)),
        push + h * (ramp * 0.68),
        g + h * (grade * 0.68),
    )
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
    return State(q1, w1, k6), abs(e_q), abs(e_w)


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
    return nystrom(forces, law, ground, tau, state, h)


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
def locate(forces, law, ground, tau, state, low, high, guess, sought, level, falling):
    """Where inside a step q reaches level, w vanishes or q.. vanishes: Newton on the step itself, kept in a bracket.

    The sought function is positive at low and not at high if it is falling, else the other way round. Stepping anew
    to each trial point gives the event the full order of the pair, which no interpolant has. Returns the time, and
    the state then.
    """
    q, w, f = state
    h = guess if low < guess < high else (low + high) / 2
    close = 1e-8 if sought == HEIGHT else 1e-4  # what then is missing is 1e-13 at most: near a turn q stands still
    for _ in range(200):
        (q, w, f), _, _ = advance(forces, law, ground, tau, state, h)
        value = f if sought == BALANCE else w if sought == TURN else q - level
        rate = 0.0 if sought == BALANCE else f if sought == TURN else w
        if value == 0:
            break
        if (value < 0) == falling:
            high = h
        else:
            low = h
        trial = h - value / rate if rate != 0 else high
        if not low < trial < high:
            trial = (low + high) / 2
            if high - low <= (1e-6 if sought == BALANCE else 4e-16) * high:
                break
        elif abs(trial - h) <= close * high:
            x = trial - h
            return trial, State(q + x * (w + x / 2 * f), w + x * f, f)
        h = trial
    return h, State(q, w, f)


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


@called
def turning_point(forces, law, ground, tau, state, size, f1, rising):
    """Where in a step q turns, from rising to falling or back, and the q it reaches."""
    q, w, f = state
    start = 0.0
    if w == 0:  # a start at rest: look behind the moment of greatest speed
        start, (_, w2, _) = locate(forces, law, ground, tau, state, 0.0, size, size / 2, BALANCE, 0.0, f > 0)
        if w2 == 0 or (w2 > 0) != rising:
            return 0.0, q
    guess = first_root((f1 - f) / (2 * size), f, w)
    x, (extreme, _, _) = locate(forces, law, ground, tau, state, start, size, guess, TURN, 0.0, rising)
    return x, extreme


@called
def inspect(forces, law, ground, t, tau, state, size, ended, marks):
    """Look inside a step of the given size and end for impact, turning points, peak and the crossing of phi_cr.

    Returns what ends the step (`REACHED` if nothing does), and the step that is left with the state at its end: up to
    the impact, the bound, or a turning point that the ends of the step do not show.
    """
    q, w, f = state
    q1, w1, f1 = ended
    d = law.d
    # w may change sign twice inside: end the step at its extreme, where it shows.
    if w * w1 > 0 and w * f < 0 and f * f1 < 0:
        x, (q2, w2, f2) = locate(forces, law, ground, tau, state, 0.0, size, size / 2, BALANCE, 0.0, f > 0)
        if w * w2 < 0:
            size, q1, w1, f1 = x, q2, w2, f2
    rising = w > 0 or (w == 0 and (q == 0 or f > 0))  # from rest it lifts, whatever rounding says of f
    turn, extreme = size, q1
    if q == 0 and q1 <= 0 and w > 0 and f < 0 and f1 < 0 and w * size <= marks[PEAK + d]:
        turn = 0.0  # a hop too low for a new peak: only its landing matters
    elif rising == (w1 <= 0):
        turn, extreme = turning_point(forces, law, ground, tau, state, size, f1, rising)
    xa, qa = 0.0, q
    for part in range(2):  # up to where q turns, then from there
        if (turn == 0.0 and part == 0) or (turn == size and part == 1):
            continue
        xb, qb = (turn, extreme) if part == 0 else (size, q1)
        if rising == (part == 0):
            bounded = False
            for crossing in range(2):  # one search for both: each is compiled with a step inside
                level = law.q_bound if crossing == 0 else law.q_cr
                if qa < level <= qb:
                    x, there = locate(forces, law, ground, tau, state, xa, xb, nan, HEIGHT, level, False)
                    if crossing == 0:
                        bounded, xb, qb, ended = True, x, level, there
                    else:
                        marks[CROSSED] = t + tau + x
            marks[PEAK + d] = max(marks[PEAK + d], qb)
            if bounded:
                return LIMIT, xb, State(qb, ended.w, ended.f)
        elif qb <= 0:
            if not (qa > 0 or w > 0):
                return IMPACT, xa, State(0.0, 0.0, 0.0)
            guess = nan
            if xb == size:  # back from the end of the step: a parabola, then the cubic
                x = first_root(f1 / 2, -w1, q1)
                jerk = (f1 - f) / size
                x -= (q1 - x * (w1 - x / 2 * (f1 - x / 3 * jerk))) / (x * (f1 - x / 2 * jerk) - w1)
                guess = size - x
            x, (_, w2, f2) = locate(forces, law, ground, tau, state, xa, xb, guess, HEIGHT, 0.0, True)
            return IMPACT, x, State(0.0, min(w2, 0.0), f2)
        xa, qa = xb, qb
    return REACHED, size, State(q1, w1, f1)


@inlined
def corners_below(corners, law, q):
    """How many corners of the force lie below q."""
    return corners[min(max(int(q * law.per_cell), 0), corners.shape[0] - 1), law.d]


@inlined
def passes(corners, law, q, q1):
    """Whether there is a corner of the force between two places."""
    return corners.shape[0] > 0 and corners_below(corners, law, q) != corners_below(corners, law, q1)


@called
def up_to_corner(forces, corners, law, ground, tau, state, size, ended):
    """The part of a step up to the first corner of the force, which no step of any order may pass, and q behind it.

    Where the step meets none, all of it and NaN.
    """
    q, w, f = state
    q1, w1, f1 = ended
    reached, until = q1, size
    rising = w > 0 or (w == 0 and (q == 0 or f > 0))
    if rising == (w1 <= 0):  # it may go there and come back
        turn, extreme = turning_point(forces, law, ground, tau, state, size, f1, rising)
        if passes(corners, law, q, extreme):
            reached, until = extreme, turn
    if not passes(corners, law, q, reached):
        return size, nan
    outward = reached > q
    way = 1 if outward else -1
    here = corners_below(corners, law, q)
    k = min(max(int(q * law.per_cell), 0), corners.shape[0] - 1)
    while corners[k, law.d] == here:
        k += way
    node = k if outward else k + 1
    x, _ = locate(forces, law, ground, tau, state, 0.0, until, nan, HEIGHT, node / law.per_cell, not outward)
    return x, (node + way * BEHIND) / law.per_cell
