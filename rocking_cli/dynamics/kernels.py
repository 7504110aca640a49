"""The history kernel: one function for every structure, on floats and arrays alone.

A direction of rocking is an index d (0 positive, 1 negative) with sign s. A motion is (q, w): q = 0 at rest, dq =
sqrt(I) dphi along it, and w = q. the root of twice the kinetic energy. In this coordinate the inertia is one, and
Lagrange's equation has no velocity term:

    q.. = -((g + v_g'') G(q) + Q(q) + s B(q) u_g'') / sqrt(I(q))        [Eq. 8]

so two tables describe a mechanism, and Nystrom's methods for q.. = f(t, q) apply: G + Q/g and B. Under vertical ground
motion a third one says how much of the first, Q/g, does not follow g + v_g''. The linear model is q = phi; without
vertical ground motion it is advanced in closed form.

It is one source for two uses (`rocking_cli.dynamics.ways`): compiled ahead, and run by Python as it stands. Nothing in
it allocates memory or raises: code that is compiled ahead has no other library to call than that of C.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, cosh, inf, isfinite, nan, sinh, sqrt
from typing import NamedTuple, TypeVar

import numpy as np

# Columns of `numbers`, one row a direction.
# Q_BOUND is the q at which something else than the mechanism decides, in `Deck` the phi [rad], infinite where nothing
# does; BOUND_ETA the restitution of a stop there, NaN where the motion is not known beyond.
LAMBDA, Q_CR, ETA, RATE, REST, Q_END, PER_CELL, P, KAPPA_G, GRAVITY, HELD, ONE_SIDED, Q_BOUND, BOUND_ETA = range(14)
COLUMNS = 14
# Columns of `records`, one row a ground motion: first sample and number of samples of either component, and of the
# strongest that is still to come; intervals.
U_FIRST, U_SIZE, V_FIRST, V_SIZE, AHEAD_FIRST, AHEAD_SIZE, DT, V_DT = range(8)
# Columns of `runs`, one row a history; an eta that is NaN is the structure's own.
# LOOSE tells whether its columns fall out of step at its first impact.
STRUCTURE, RECORD, FACTOR, V_FACTOR, SIZE, ETA_POSITIVE, ETA_NEGATIVE, START, SLENDER, LOOSE = range(10)
RUN_COLUMNS = 10
# What `marks` gathers on the way, a row a history. Of the joints: when their opening passes its limit, why and where,
# with peaks and impacts until then; the first moment at which one does not bear, where, with the peaks until then; the
# largest opening [m], where and when, the longest time for which a joint is open, and when and where first a joint that
# stays closed would open.
PEAK, CROSSED, FIRST_UPLIFT, IMPACTS, ENDED, SIDE, STATUS = 0, 2, 3, 4, 5, 6, 7
PASSED, REASON, WHERE, PASSED_PEAK, PASSED_IMPACTS, WARNED, WARNED_WHERE, WARNED_PEAK = 8, 9, 10, 11, 13, 14, 15, 16
LARGEST, LARGEST_WHERE, LARGEST_AT, LONGEST, PARTED, PARTED_WHERE = 18, 19, 20, 21, 22, 23
MARKS = 24
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
# How a motion ends; LEFT: its joints have opened so far that nothing is known any longer.
AT_REST, OVERTURNED, STILL_ROCKING, STALLED, LEFT = range(5)
# How a flight over part of a sample interval ends.
REACHED, IMPACT, LIMIT, STUCK = range(4)
# What a search inside a step is for: q at a level, w = 0, or q.. = 0.
HEIGHT, TURN, BALANCE = range(3)

MARGIN = 1e-12  # share by which u_g'' must exceed the uplift acceleration, so that rounding never lifts a structure
# A motion ends if its rate after an impact is below REST; while the ground pushes beyond uplift, below REST FAINT.
FAINT = 1e-9
CHATTER = 1000  # impacts in one sample interval that count as rest, however elastic: with dt < 1 s below 1e-6 phi_cr
IDLE = 10_000  # sample intervals without impact after which a motion in a hollow beyond phi_cr never ends
LOOPS = 10_000  # events in one sample interval, or a piece of it, with which a motion stalls
STRIDE = 100.0  # longest step of the closed form, in 1/p; its cosh would overflow at 700
SLOW = 0.5  # length of an interval after the record, in 1/p
LOOK = 1.25e-3  # s: longest step in which openings of joints are advanced, eight in 0.01 s
BEHIND = 1e-11  # distance behind a corner of the force at which a motion goes on, over a cell
COINCIDE = 1e-9  # distance of moments that coincide, over a sample interval
LONG = 1e3  # s after the record by which sliding at rest has stopped

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


class Deck(NamedTuple):
    """Structures and ground motions of a batch of histories, each kind in arrays one after the other."""

    structures: np.ndarray  # int (m, 3): first row and number of rows of the tables of each, and whether it is linear
    numbers: np.ndarray  # (m, 2, COLUMNS): see the columns above
    # (cells, 2, 8): in each cell, for either direction, the cubics of (G + Q/g)/sqrt(I) and B/sqrt(I), and of phi and
    # dphi/dq, powers 0 to 3 of the place in the cell. Where vertical motion meets a tie, forces are of (cells, 2, 3, 4)
    # with that of Q/(g sqrt(I)) behind: the kernel is compiled for each, and without it costs nothing more.
    forces: np.ndarray
    angles: np.ndarray
    certain: (
        np.ndarray
    )  # (cells, 2): largest ground acceleration, over g, that cannot stop an outward motion from there
    held: np.ndarray  # (cells, 2): the largest |Q|/(g |B|) still to come; of no rows where `forces` are of two
    corners: np.ndarray  # int (cells, 2): corners of the force up to the start of each cell; of no rows if none has any
    records: np.ndarray  # (k, 8): see the columns above
    u: np.ndarray  # horizontal ground acceleration of all records [m/s2], straight between samples, zero after the last
    v: np.ndarray  # vertical ground acceleration
    ahead: np.ndarray  # at each sample of the horizontal component, the largest |u| from there on [m/s2]
    v_ahead: np.ndarray  # the largest -v from each sample of the vertical component on [m/s2]
    v_above: np.ndarray  # the largest v from there on [m/s2]
    joints: Joints


class Samples(NamedTuple):
    """Where the samples and impacts of a history are written; empty arrays where they are not wanted."""

    every: int  # of how many samples of the ground motion one is kept
    phi: np.ndarray  # (samples,): signed rotation [rad], NaN after overturning
    rate: np.ndarray  # (samples,): rate [rad/s]
    impacts: np.ndarray  # (most, 3): time [s], sign of the direction that ends and rate before [rad/s]
    aside: np.ndarray  # (MARKS,): what the flights between samples note, which nobody reads


class Room(NamedTuple):
    """Memory for one history at a time."""

    numbers: np.ndarray  # (2, COLUMNS)
    kept: np.ndarray  # (most joints of a structure, KEPT)
    notes: np.ndarray  # (NOTES,)
    active: np.ndarray  # int (four of each joint,)


class Structure(NamedTuple):
    """The tables of one structure, and the numbers of one history."""

    linear: bool
    numbers: np.ndarray
    forces: np.ndarray
    angles: np.ndarray
    certain: np.ndarray
    held: np.ndarray
    corners: np.ndarray


class Motion(NamedTuple):
    """One ground motion: both components with their factors and intervals, and the strongest that is to come."""

    u: np.ndarray
    factor: float
    dt: float
    v: np.ndarray
    v_factor: float
    v_dt: float
    ahead: np.ndarray
    v_ahead: np.ndarray
    v_above: np.ndarray


class Demand(NamedTuple):
    """Forces that are missing at the joints at one moment; joints by their numbers, -1 for none."""

    missing: float  # largest force missing at any joint [N]
    where: int  # joint of that force
    crushes: int  # joint that crushes
    parted: int  # closed joint at which the largest force is missing


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
def cubic(at, first, x):
    """A cubic of a row at a place of its cell."""
    return at[first] + x * (at[first + 1] + x * (at[first + 2] + x * at[first + 3]))


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


@called
def passed(watch, d, t, q, reason, where, marks):
    """Note in `marks` that the outcome is unknown from here on, with the reason and the joint."""
    marks[PASSED], marks[REASON], marks[WHERE], marks[PASSED_IMPACTS] = t, reason, where, marks[IMPACTS]
    for side in range(2):
        marks[PASSED_PEAK + side] = watch.notes[SO_FAR + side]
    marks[PASSED_PEAK + d] = max(watch.notes[SO_FAR + d], q)


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
def between(state, ended, size, x):
    """q and w inside a step, by the polynomial of order 5 through both of its ends."""
    q, w, f = state
    q1, w1, f1 = ended
    v, v1, a, a1 = w * size, w1 * size, f * size * size, f1 * size * size
    rise = q1 - q - v - a / 2
    steer = v1 - v - a
    bend = a1 - a
    c3 = 10 * rise - 4 * steer + bend / 2
    c4 = -15 * rise + 7 * steer - bend
    c5 = 6 * rise - 3 * steer + bend / 2
    height = q + x * (v + x * (a / 2 + x * (c3 + x * (c4 + x * c5))))
    speed = v + x * (a + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))
    return max(height, 0.0), speed / size


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


@inlined
def fly(forces, corners, law, ground, t, tau, end, state, h, rtol, watched, watch, marks):
    """Advance a motion from tau towards end, to the first impact, the bound or the kinematic limit.

    Parameters
    ----------
    forces, corners, law, ground : ndarray, ndarray, Law, Ground
        What the motion obeys.
    t, tau, end : float
        Time of the sample, and from there the start and the end of the flight [s].
    state : State
        The motion at tau.
    h, rtol : float
        Step to try, and relative local error.
    watched : bool
        Whether to look at the joints.
    watch : Watch
        The joints.
    marks : ndarray
        Takes the peak and the crossing of phi_cr, and what becomes of the joints.

    Returns
    -------
    tuple
        What ended it, the new tau and state, and the step to try next.
    """
    d = law.d
    for _ in range(1_000_000):
        left = end - tau
        if left <= 0:
            return REACHED, end, state, h
        q, w, f = state
        size = min(left, h)
        if q == 0 and f < 0 and w > 0:  # a hop: it lands after 2 w/-f or so
            size = min(size, -2.05 * w / f)
        whole = size == left
        ended, e_q, e_w = advance(forces, law, ground, tau, state, size)
        part, behind = size, nan
        if corners.shape[0] > 0:
            part, behind = up_to_corner(forces, corners, law, ground, tau, state, size, ended)
            if isfinite(behind):
                size, whole = part, False
                ended, e_q, e_w = advance(forces, law, ground, tau, state, size)
        error = misses(law, rtol, state, ended, e_q, e_w)
        if not error <= 1:
            h = size * (max(0.2, 0.9 * error**-0.2) if isfinite(error) else 0.1)
            if tau + h == tau:
                return STUCK, tau, state, h
            continue
        if size == h and not law.exact:
            h = size * (5.0 if error < 1e-4 else min(5.0, 0.9 * error**-0.2))
        peak, event = marks[PEAK + d], REACHED
        if rises(law, state, ended):
            marks[PEAK + d] = max(marks[PEAK + d], ended.q)
        elif not falls(state, ended):
            event, inside, ended = inspect(forces, law, ground, t, tau, state, size, ended, marks)
            whole = whole and inside == size
            size = inside
            if inside < part:
                behind = nan
        if watched and (watch.notes[FRESH] != 0 or not quiet(watch, law, ground, tau + size, ended.q, ended.w)):
            look(watch, law, ground, t, tau, state, size, ended, peak, 0.0, 0.0, marks)
        if event != REACHED:
            return event, end if whole else min(tau + size, end), ended, h
        state = State(behind, ended.w, ended.f) if isfinite(behind) else ended
        tau = end if whole else tau + size
        if state.q >= law.q_end:
            return LIMIT, tau, state, h
    return STUCK, tau, state, h


@called
def is_certain(structure, d, q, strongest, weight, most_weight):
    """Whether an outward motion from q beyond phi_cr overturns for certain: no later ground motion can turn it back.

    `weight` and `most_weight` are the least and the largest (g + v_g'')/g to come: less weight pulls less, while what
    ties it back stays, and more holds it against what pushes it over.
    """
    numbers = structure.numbers
    if weight <= 0:
        return False
    held = structure.held.shape[0] > 0 and (weight != 1 or most_weight != 1)
    if structure.linear:
        return not held and q >= numbers[d, Q_CR] + numbers[d, KAPPA_G] * (strongest / weight)
    cell = min(int(q * numbers[d, PER_CELL]), structure.certain.shape[0] - 1)
    needed = strongest / weight
    if held:  # -w g G - Q = -w (g G + Q) - (1 - w) Q
        tied = numbers[d, GRAVITY] * structure.held[cell, d]
        light, heavy = strongest + (1 - weight) * tied, strongest + (most_weight - 1) * tied
        needed = max(light / weight, heavy / most_weight)
    return numbers[d, GRAVITY] * structure.certain[cell, d] >= needed


@inlined
def uplift(numbers, d, g):
    """The ground acceleration that lifts a structure while g + v_g'' is g [m/s2]."""
    return numbers[d, LAMBDA] * g + numbers[d, HELD] * (numbers[d, GRAVITY] - g)


@called
def lifts_at(numbers, tau, end, u, ramp, g, grade):
    """When a structure at rest lifts between tau and end, and in which direction (-1: it does not).

    It lifts where the ramp crosses the uplift acceleration [(g + v_g'') G + Q]/B, not at the sample. Without weight
    both directions are open: it takes the first, or the one with more behind it.
    """
    lifted, most = -1, 0.0
    for d in range(2):
        threshold = uplift(numbers, d, g + grade * tau)
        excess = (2.0 * d - 1.0) * (u + ramp * tau) - threshold
        if excess > MARGIN * abs(threshold) and excess > most:
            lifted, most = d, excess
    if lifted >= 0:
        return tau, lifted
    first = end
    for d in range(2):
        threshold = uplift(numbers, d, g + grade * end)
        then = (2.0 * d - 1.0) * (u + ramp * end) - threshold
        if then > MARGIN * abs(threshold):
            now = (2.0 * d - 1.0) * (u + ramp * tau) - uplift(numbers, d, g + grade * tau)
            crossing = min(max(tau - (end - tau) * now / (then - now), tau), end)
            if lifted < 0 or crossing < first:
                first, lifted = crossing, d
    return first, lifted


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
def stays(numbers, u):
    """Whether a ground acceleration lifts a structure at rest in neither direction."""
    g = numbers[0, GRAVITY] * (1 + MARGIN)
    return -numbers[1, LAMBDA] * g <= -u and -u <= numbers[0, LAMBDA] * g


@called
def pressure(structure, law, push, g):
    """The acceleration of phi with which the ground pushes a structure that does not move against its stop."""
    q = law.q_bound
    _, speed = angle(structure, law.d, q)
    return speed * (balance(law, q, push) if law.exact else force(structure.forces, law, q, push, g))


@called
def draw(structure, law, ground, t, flight, rtol, dt, drawn, watch, samples):
    """Fill in the output samples between tau and end by a separate integration.

    Sampling therefore never affects the motion. Returns how many samples are done.
    """
    tau, end, state, h = flight
    nothing = samples.aside
    nothing[:] = 0.0
    s = 1.0 - 2.0 * law.d
    while drawn < samples.phi.size and drawn * dt <= t + end:
        _, tau, state, h = fly(
            structure.forces,
            structure.corners,
            law,
            ground,
            t,
            tau,
            drawn * dt - t,
            state,
            h,
            rtol,
            False,
            watch,
            nothing,
        )
        phi, speed = angle(structure, law.d, state.q)
        samples.phi[drawn], samples.rate[drawn] = s * phi, s * state.w * speed
        drawn += 1
    return drawn


@called
def follow(structure, motion, start, loose, rtol, most_impacts, brief, watch, samples, marks):
    """Follow one motion to its end: at rest, overturned, or still rocking after `most_impacts` impacts.

    It begins at rest, with q = `start`. If `loose`, nothing is known from its first impact on. Returns how it ended.
    """
    linear, numbers, forces, _, _, _, corners = structure
    u, factor, dt, v, v_factor, v_dt, ahead, v_ahead, v_above = motion
    every, phi_out, rate_out, impacts, _ = samples
    marks[:] = nan
    marks[PEAK : PEAK + 2] = 0.0
    marks[IMPACTS] = 0.0
    marks[ENDED] = 0.0
    marks[LARGEST] = marks[LONGEST] = 0.0
    watched = watch.size > 0
    watch.kept[:] = 0.0
    watch.notes[:] = 0.0
    watch.notes[SINCE] = watch.notes[SEEN] = nan
    phi_out[:] = nan
    rate_out[:] = nan
    gravity = numbers[0, GRAVITY]
    unit = gravity / watch.gravity  # the structure's own accelerations are those of the size of its joints times this
    exact = linear and v.size == 0
    slow_dt = SLOW / max(numbers[0, P], numbers[1, P])
    last, v_last = u.size - 1, v.size - 1
    out_dt = every * dt

    d = 1 if start < 0 else 0
    s = 1.0 - 2.0 * d
    law = law_of(exact, numbers, d)
    q, w, f = abs(start), 0.0, 0.0
    known = fresh = False  # whether f is q.. at (q, w) now; whether it was found anew
    held = False  # whether the ground pushes it against a stop
    resting = q == 0.0
    marks[PEAK + d] = q
    if q >= law.q_bound:
        marks[SIDE] = d
        watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
        passed(watch, d, 0.0, q, BOUND, -1, marks)
        return LEFT
    h = STRIDE / max(numbers[0, P], numbers[1, P]) if exact else dt
    t = 0.0
    k, j = 0, 0
    shaken = True  # whether the record goes on
    drawn = 0  # samples of the output that are done
    before = 0.0  # impacts up to the end of the record
    idle = 0
    while True:
        if resting and v.size == 0:  # quiet: on to the last sample before the ground lifts it
            while (
                k < last
                and stays(numbers, u[k] * factor)
                and stays(numbers, u[k + 1] * factor)
                and steady(watch, u[k] * factor / unit)
                and steady(watch, u[k + 1] * factor / unit)
            ):
                if k < every * phi_out.size and k % every == 0:
                    phi_out[k // every] = rate_out[k // every] = 0.0
                    drawn = k // every + 1
                k += 1
            t = k * dt
        if shaken and k < every * phi_out.size and k % every == 0:  # t is the time of sample k
            phi, speed = angle(structure, d, q)
            drawn = k // every
            phi_out[drawn], rate_out[drawn] = s * phi, s * w * speed
            drawn += 1
        shaken = k < last or j < v_last
        if resting and not shaken:
            later = t
            while (
                watched and watch.notes[MOVING] != 0 and later < t + LONG
            ):  # it slides on until friction has stopped it
                stand(watch, later, watch.step, 1, 0.0, 0.0, unit, 0.0, 0.0, marks)
                later += watch.step
            phi_out[drawn:] = rate_out[drawn:] = 0.0
            marks[SIDE] = d
            return AT_REST
        span = dt if shaken else slow_dt
        u0, u1 = (u[k] * factor, u[k + 1] * factor) if k < last else (0.0, 0.0)
        ramp = (u1 - u0) / span
        if k >= last:
            known = False
        elif exact and known:
            f = balance(law, q, s * u0)
        tau = 0.0
        if known and not resting and v.size == 0 and h >= span:
            # The most common interval by far: one step, and nothing happens in it.
            state = State(q, w, f)
            ended, e_q, e_w = advance(forces, law, Ground(s * u0, s * ramp, gravity, 0.0), 0.0, state, span)
            uneventful = ended.q < min(law.q_end, law.q_bound) and (rises(law, state, ended) or falls(state, ended))
            uneventful = uneventful and not passes(corners, law, q, ended.q)
            if uneventful and watched:  # else the step is made again, and its joints are looked at
                ground = Ground(s * u0, s * ramp, gravity, 0.0)
                uneventful = watch.notes[FRESH] == 0 and quiet(watch, law, ground, span, ended.q, ended.w)
            if uneventful and misses(law, rtol, state, ended, e_q, e_w) <= 1:
                marks[PEAK + d] = max(marks[PEAK + d], ended.q)
                q, w, f = ended
                tau = span
        g, grade, end = gravity, 0.0, span
        while tau < span:
            loops = 0
            if v.size > 0:  # a piece of the interval, up to the next sample of the vertical component
                while j < v_last and (j + 1) * v_dt - t <= tau + COINCIDE * v_dt:
                    j += 1
                g, grade, end = gravity, 0.0, span
                if j < v_last:
                    v0, v1 = v[j] * v_factor, v[j + 1] * v_factor
                    grade = (v1 - v0) / v_dt
                    g += v0 + grade * (t - j * v_dt)
                    if (j + 1) * v_dt - t < span - COINCIDE * v_dt:
                        end = (j + 1) * v_dt - t
                    if not linear and g + grade * end <= 0 and not isfinite(marks[PASSED]):
                        gone = -g / grade if g + grade * tau > 0 else tau
                        if gone > tau:
                            end = gone
                        else:
                            watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
                            passed(watch, d, t + tau, q, WEIGHTLESS, -1, marks)
                else:
                    known = False
            while tau < end:
                loops += 1
                if loops > LOOPS:
                    marks[ENDED], marks[SIDE] = t + tau, d
                    return STALLED
                if resting:
                    began = tau
                    tau, lifted = lifts_at(numbers, tau, end, u0, ramp, g, grade)
                    u_began, u_ended = u0 + ramp * began, u0 + ramp * tau
                    calm = v.size == 0 and steady(watch, u_began / unit) and steady(watch, u_ended / unit)
                    if watched and not calm and tau > began:
                        steps = max(1, ceil((tau - began) / watch.step - 1e-9))
                        lift0, lift1 = g + grade * began - gravity, g + grade * tau - gravity
                        stand(watch, t + began, tau - began, steps, u_began, u_ended, unit, lift0, lift1, marks)
                    if lifted < 0 or tau >= end:  # on the sample: the next piece begins with it
                        tau = end
                        break
                    resting = False
                    watch.kept[:, GAP : GAP + 4] = 0.0
                    d = lifted
                    s = 1.0 - 2.0 * d
                    law = law_of(exact, numbers, d)
                    q, w, known = 0.0, 0.0, False
                    if not isfinite(marks[FIRST_UPLIFT]):
                        marks[FIRST_UPLIFT] = t + tau
                if held:
                    pressed = later = 0.0
                    for last_moment in range(2):
                        pressed, at = later, end if last_moment == 1 else tau
                        later = pressure(structure, law, s * (u0 + ramp * at), g + grade * at)
                    until = tau
                    if pressed > 0:
                        until = end if later > 0 else tau + (end - tau) * pressed / (pressed - later)
                    if watched and until > tau:
                        later = max(later, 0.0)
                        there, ground = State(q, 0.0, 0.0), Ground(s * u0, s * ramp, g, grade)
                        look(watch, law, ground, t, tau, there, until - tau, there, q, max(pressed, 0.0), later, marks)
                    held = until >= end
                    tau = min(until, end)
                    if held:
                        break
                if not known:
                    push = s * (u0 + ramp * tau)
                    f = balance(law, q, push) if exact else force(forces, law, q, push, g + grade * tau)
                    if q == 0 and w == 0:  # from rest it lifts, whatever rounding says of the balance
                        f = max(f, 0.0)
                    known = fresh = True
                ground = Ground(s * u0, s * ramp, g, grade)
                if fresh and watched and not quiet(watch, law, ground, tau, q, w):
                    watch.notes[FRESH] = 1.0
                fresh = False
                began, state, step = tau, State(q, w, f), h
                event, tau, (q, w, f), h = fly(
                    forces, corners, law, ground, t, tau, end, state, h, rtol, watched, watch, marks
                )
                if not shaken and drawn * out_dt <= t + tau and drawn < phi_out.size:
                    flight = (began, tau, state, step)
                    drawn = draw(structure, law, ground, t, flight, rtol, out_dt, drawn, watch, samples)
                if event == STUCK:
                    marks[ENDED], marks[SIDE] = t + tau, d
                    return STALLED
                if event != REACHED:
                    met = event == LIMIT  # rather the bound of its motion than the ground
                    if met:
                        marks[ENDED], marks[SIDE] = t + tau, d
                        if q < law.q_bound:
                            return OVERTURNED
                    watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
                    marks[IMPACTS] += 0.0 if met else 1.0
                    eta = numbers[d, BOUND_ETA] if met else numbers[d, ETA]
                    ends = not isfinite(eta) if met else loose
                    if ends and not isfinite(marks[PASSED]):
                        passed(watch, d, t + tau, q, BOUND if met else APART, -1, marks)
                    if ends and met:
                        return LEFT
                    side = d if met or numbers[d, ONE_SIDED] else 1 - d  # a rebound keeps its direction
                    _, speed = angle(structure, d, q)
                    rate = abs(w) * speed
                    if watched:
                        impulses = watch.stopped if met else watch.struck
                        strike(watch, side, t + tau, q / law.q_end, impulses, rate, eta, marks)
                    if met:
                        held = eta * w <= numbers[d, REST] or loops > CHATTER
                        w, known = 0.0 if held else -eta * w, False
                if event == IMPACT:
                    idle = 0
                    n = int(marks[IMPACTS]) - 1
                    if n < impacts.shape[0]:
                        impacts[n, 0], impacts[n, 1], impacts[n, 2] = t + tau, s, rate
                    w = numbers[d, ETA] * -w * numbers[d, RATE] / numbers[side, RATE]  # Eq. 6, on phi.
                    d = side
                    s = 1.0 - 2.0 * d
                    law = law_of(exact, numbers, d)
                    q, known = 0.0, False
                    _, lifted = lifts_at(numbers, tau, tau, u0, ramp, g, grade)
                    if w <= numbers[d, REST] * (FAINT if lifted >= 0 else 1.0) or (lifted < 0 and loops > CHATTER):
                        resting, w = True, 0.0
                        marks[ENDED] = t + tau
                        if watched:
                            settle(watch, t + tau, marks)
        t += span
        k += 1
        if shaken:
            t = k * dt
            before = marks[IMPACTS]
        else:
            idle += 1
        if not resting and w >= 0 and q > law.q_cr and law.q_bound > law.q_end:
            strongest = ahead[k] * abs(factor) if k < ahead.size else 0.0
            weight = 1 - v_ahead[k] * v_factor / gravity if k < v_ahead.size and v_ahead[k] > 0 else 1.0
            most_weight = 1 + v_above[k] * v_factor / gravity if k < v_above.size else 1.0
            if is_certain(structure, d, q, strongest, weight, most_weight):
                marks[ENDED], marks[SIDE] = t, d
                return OVERTURNED
        if brief and q < law.q_cr and isfinite(marks[PASSED]):
            marks[ENDED], marks[SIDE] = t, d
            return LEFT
        if marks[IMPACTS] - before > most_impacts or idle > IDLE:
            marks[ENDED], marks[SIDE] = t, d
            return STILL_ROCKING


@called
def numbers_of(usual, what, numbers):
    """Fill in the numbers of one history: those of its structure, in its size and with its restitution.

    A structure of another size has the same motion as this one under accelerations divided by its size.
    """
    for d in range(2):
        for column in range(COLUMNS):
            numbers[d, column] = usual[d, column]
        numbers[d, P] /= sqrt(what[SIZE])
        numbers[d, REST] /= sqrt(what[SIZE])
        numbers[d, GRAVITY] /= what[SIZE]
        numbers[d, KAPPA_G] *= what[SIZE]
        eta = what[ETA_POSITIVE + d]
        if isfinite(eta):
            numbers[d, ETA] = eta


@called
def bound_of(structure, d, slender):
    """The q of the bound of a direction, in a history whose rotations are larger by its slenderness."""
    end = structure.numbers[d, Q_END]
    low, high = 0.0, end
    for _ in range(60 if isfinite(structure.numbers[d, Q_BOUND]) else 0):
        q = (low + high) / 2
        phi, _ = angle(structure, d, q)
        if phi * slender < structure.numbers[d, Q_BOUND]:
            low = q
        else:
            high = q
    return high if high < end else inf


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


@called
def run(first, stop, runs, deck, rtol, most_impacts, brief, samples, all_marks, room):
    """Follow the histories first to stop of `runs`, one after the other.

    Parameters
    ----------
    first, stop : int
        Which rows of `runs`.
    runs : ndarray, shape (n, RUN_COLUMNS)
        What each history is of, see the columns above: structure and record by number, factors on the two components
        (s of the horizontal one is the polarity), size of the structure as a factor, restitution of either direction,
        and q to start from at rest, negative in the negative direction.
    deck : Deck
        The structures and records.
    rtol : float
        Relative local error of a step.
    most_impacts : int
        When to give up after the end of the record.
    brief : bool
        Whether to leave a motion when nothing is known of it any longer.
    samples : Samples
        Takes the samples and impacts of the last history.
    all_marks : ndarray, shape (n, MARKS)
        For each history peaks of both directions [rad], last upward crossing of phi_cr, first uplift, number of
        impacts, end time, index of the direction it ended in, and how it ended; to be filled.
    room : Room
        Memory of this call.
    """
    for i in range(first, stop):
        what = runs[i]
        m, r = int(what[STRUCTURE]), int(what[RECORD])
        numbers_of(deck.numbers[m], what, room.numbers)
        cells = slice(deck.structures[m, 0], deck.structures[m, 0] + deck.structures[m, 1])
        linear = deck.structures[m, 2] == 1
        held = deck.held[cells] if deck.held.shape[0] > 0 else deck.held
        corners = deck.corners[cells] if deck.corners.shape[0] > 0 else deck.corners
        structure = Structure(
            linear, room.numbers, deck.forces[cells], deck.angles[cells], deck.certain[cells], held, corners
        )
        for d in range(2):
            room.numbers[d, Q_BOUND] = bound_of(structure, d, what[SLENDER])
        of, size = deck.records[r], what[SIZE]
        horizontal = slice(int(of[U_FIRST]), int(of[U_FIRST]) + int(of[U_SIZE]))
        vertical = slice(int(of[V_FIRST]), int(of[V_FIRST]) + int(of[V_SIZE]))
        later = slice(int(of[AHEAD_FIRST]), int(of[AHEAD_FIRST]) + int(of[AHEAD_SIZE]))
        v_later = later if of[V_SIZE] > 0 else slice(0, 0)
        motion = Motion(
            deck.u[horizontal],
            what[FACTOR] / size,
            of[DT],
            deck.v[vertical],
            what[V_FACTOR] / size,
            of[V_DT],
            deck.ahead[later],
            deck.v_ahead[v_later],
            deck.v_above[v_later],
        )
        marks = all_marks[i]
        watch = watch_of(deck.joints, m, size, what[SLENDER], motion, room)
        loose = what[LOOSE] != 0
        marks[STATUS] = follow(structure, motion, what[START], loose, rtol, most_impacts, brief, watch, samples, marks)
        for d in range(2):
            for peak in (PEAK, PASSED_PEAK, WARNED_PEAK):
                if isfinite(marks[peak + d]):
                    marks[peak + d], _ = angle(structure, d, marks[peak + d])
