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

from math import ceil, inf, isfinite, nan, sqrt
from typing import NamedTuple

import numpy as np

from rocking_cli.dynamics.openings import (
    APART,
    BOUND,
    COINCIDE,
    FRESH,
    GAP,
    LARGEST,
    LONGEST,
    MOVING,
    PASSED,
    PASSED_PEAK,
    SEEN,
    SINCE,
    SO_FAR,
    WARNED_PEAK,
    WEIGHTLESS,
    Joints,
    bears,
    look,
    passed,
    quiet,
    settle,
    stand,
    steady,
    strike,
    watch_of,
)
from rocking_cli.dynamics.rates import angle, keep_rate, may_have_peak
from rocking_cli.dynamics.stepping import (
    BOUND_ETA,
    COLUMNS,
    DONE,
    ENDED,
    ETA,
    FIRST_UPLIFT,
    GRAVITY,
    HELD,
    IMPACT,
    IMPACTS,
    KAPPA_G,
    LAMBDA,
    LIMIT,
    ONE_SIDED,
    PEAK,
    PER_CELL,
    Q_BOUND,
    Q_CR,
    Q_END,
    RATE,
    RATE_PEAK,
    REACHED,
    REST,
    SIDE,
    STATUS,
    STEP,
    STUCK,
    Flight,
    ForceTables,
    Ground,
    Inside,
    Law,
    P,
    Search,
    State,
    advance,
    balance,
    called,
    falls,
    force,
    inlined,
    judged,
    law_of,
    misses,
    passes,
    rises,
    set_out,
    up_to_corner,
)
from rocking_cli.dynamics.stepping import SOURCE as SOURCE

# Columns of `records`, one row a ground motion: first sample and number of samples of either component, and of the
# strongest that is still to come, and blocks; intervals.
U_FIRST, U_SIZE, V_FIRST, V_SIZE, AHEAD_FIRST, AHEAD_SIZE, BLOCK_FIRST, BLOCK_SIZE, DT, V_DT = range(10)
BLOCK = 32  # samples over which a structure at rest is taken at once if the strongest of them cannot move it
# Columns of `runs`, one row a history; an eta that is NaN is the structure's own.
# LOOSE tells whether its columns fall out of step at its first impact.
STRUCTURE, RECORD, FACTOR, V_FACTOR, SIZE, ETA_POSITIVE, ETA_NEGATIVE, START, SLENDER, LOOSE = range(10)
RUN_COLUMNS = 10
# How a motion ends; LEFT: its joints have opened so far that nothing is known any longer.
AT_REST, OVERTURNED, STILL_ROCKING, STALLED, LEFT = range(5)
ROCKING = -1  # it does not end yet
MARGIN = 1e-12  # share by which u_g'' must exceed the uplift acceleration, so that rounding never lifts a structure
# A motion ends if its rate after an impact is below REST; while the ground pushes beyond uplift, below REST FAINT.
FAINT = 1e-9
CHATTER = 1000  # impacts in one sample interval that count as rest, however elastic: with dt < 1 s below 1e-6 phi_cr
IDLE = 10_000  # sample intervals without impact after which a motion in a hollow beyond phi_cr never ends
LOOPS = 10_000  # events in one sample interval, or a piece of it, with which a motion stalls
STRIDE = 100.0  # longest step of the closed form, in 1/p; its cosh would overflow at 700
SLOW = 0.5  # length of an interval after the record, in 1/p
LONG = 1e3  # s after the record by which sliding at rest has stopped


class Deck(NamedTuple):
    """Structures and ground motions of a batch of histories, each kind in arrays one after the other."""

    structures: np.ndarray  # int (m, 3): first row and number of rows of the tables of each, and whether it is linear
    numbers: np.ndarray  # (m, 2, COLUMNS): see the columns above
    # (cells, 2, 8): in each cell, for either direction, the cubics of (G + Q/g)/sqrt(I) and B/sqrt(I), and of phi and
    # dphi/dq, powers 0 to 3 of the place in the cell. Where vertical motion meets a tie, forces are of (cells, 2, 3, 4)
    # with that of Q/(g sqrt(I)) behind: the kernel is compiled for each, and without it costs nothing more.
    forces: np.ndarray
    # (m, 2, 4 pairs): polynomials of the same two forces in y = q PER_REACH - 1: even and odd powers
    smooth: np.ndarray
    angles: np.ndarray
    # (cells, 2): largest ground acceleration, over g, that cannot stop an outward motion from there
    certain: np.ndarray
    held: np.ndarray  # (cells, 2): the largest |Q|/(g |B|) still to come; of no rows where `forces` are of two
    corners: np.ndarray  # int (cells, 2): corners of the force up to the start of each cell; of no rows if none has any
    records: np.ndarray  # (k, 10): see the columns above
    u: np.ndarray  # horizontal ground acceleration of all records [m/s2], straight between samples, zero after the last
    v: np.ndarray  # vertical ground acceleration
    ahead: np.ndarray  # at each sample of the horizontal component, the largest |u| from there on [m/s2]
    blocks: np.ndarray  # the largest |u| of every BLOCK samples, and of the next one [m/s2]
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


class Phase(NamedTuple):
    """What a motion is at a moment, in its direction: all that changes as it goes on."""

    law: Law
    state: State
    h: float  # step to try
    known: bool  # whether f is q.. at (q, w) now
    resting: bool
    held: bool  # whether the ground pushes it against a stop


class Progress(NamedTuple):
    """How far a history has come: its motion at tau in the interval k, which begins at time t."""

    phase: Phase
    t: float
    k: int
    j: int  # sample of the vertical component
    tau: float
    loops: int  # events in the interval, or the piece of it
    before: float  # impacts up to the end of the record
    idle: int  # intervals since then without an impact


class Interval(NamedTuple):
    """The time between two samples of the horizontal ground acceleration, u_g'' = u0 + ramp tau from time t."""

    t: float
    span: float
    u0: float
    ramp: float


class VerticalPiece(NamedTuple):
    """A piece of an interval with straight vertical ground acceleration: g + v_g'' = g + grade tau, up to tau = end."""

    g: float
    grade: float
    end: float


class Structure(NamedTuple):
    """The tables of one structure, and the numbers of one history."""

    linear: bool
    numbers: np.ndarray
    forces: ForceTables
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
    blocks: np.ndarray
    v_ahead: np.ndarray
    v_above: np.ndarray


@inlined
def fly(structure, law, ground, t, tau, end, state, h, rtol, watched, watch, marks):
    """Advance a motion from tau towards end, to the first impact, the bound or the kinematic limit.

    Parameters
    ----------
    structure, law, ground : Structure, Law, Ground
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
        Takes the peaks and the crossing of phi_cr, and what becomes of the joints.

    Returns
    -------
    tuple
        What ended it, the new tau and state, and the step to try next.
    """
    forces, corners = structure.forces, structure.corners
    flight = set_out(law, tau, end, h, state)
    peak, part, behind = marks[PEAK + law.d], nan, nan
    for _ in range(1_000_000):
        if flight.mode < DONE:
            ended, e_q, e_w = advance(forces, law, ground, flight.tau, flight.state, flight.search.x)
            if flight.mode == STEP:
                peak, behind = marks[PEAK + law.d], nan
                if corners.shape[0] > 0:
                    part, behind = up_to_corner(forces, corners, law, ground, flight, ended, peak)
                    if isfinite(behind):
                        inside, search = Inside(part, ended, part, ended.q, 0), Search(part, 0.0, part, False, 0.0, 0)
                        flight = Flight(STEP, flight.tau, end, flight.h, flight.state, inside, search)
                        ended, e_q, e_w = advance(forces, law, ground, flight.tau, flight.state, part)
            flight = judged(law, rtol, flight, ended, e_q, e_w, t, marks)
            if flight.mode < DONE:
                continue
        event, (size, ended, _, _, _) = flight.mode - DONE, flight.inside
        tau, h = flight.tau, flight.h
        if event == STUCK or end <= tau:
            return event, min(tau, end), flight.state, h
        last = event != REACHED
        if watched and (watch.notes[FRESH] != 0 or not quiet(watch, law, ground, tau + size, ended.q, ended.w)):
            look(watch, law, ground, t, tau, flight.state, size, ended, peak, 0.0, 0.0, marks)
            last = last or isfinite(marks[PASSED])
        keep_rate(structure, law, ground, t, tau, flight.state, size, ended, last, marks)
        whole = size == end - tau and not isfinite(behind)
        tau = end if whole else min(tau + size, end)
        if event != REACHED:
            return event, tau, ended, h
        if isfinite(behind) and size == part:
            ended = State(behind, ended.w, ended.f)
        if ended.q >= law.q_end:
            return LIMIT, tau, ended, h
        flight = set_out(law, tau, end, h, ended)
    return STUCK, flight.tau, flight.state, flight.h


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
        _, tau, state, h = fly(structure, law, ground, t, tau, drawn * dt - t, state, h, rtol, False, watch, nothing)
        phi, speed = angle(structure, law.d, state.q)
        samples.phi[drawn], samples.rate[drawn] = s * phi, s * state.w * speed
        drawn += 1
    return drawn


@inlined
def cleared(watch, samples, marks):
    """Make memory ready for one history."""
    marks[:] = nan
    marks[PEAK : PEAK + 2] = marks[RATE_PEAK : RATE_PEAK + 2] = 0.0
    marks[IMPACTS] = 0.0
    marks[ENDED] = 0.0
    marks[LARGEST] = marks[LONGEST] = 0.0
    watch.kept[:] = 0.0
    watch.notes[:] = 0.0
    watch.notes[SINCE] = watch.notes[SEEN] = nan
    samples.phi[:] = nan
    samples.rate[:] = nan


@inlined
def ends(marks, t, d, how):
    """Note when and in which direction a history ends, and return how."""
    marks[ENDED], marks[SIDE] = t, d
    return how


@inlined
def unknown_from(watch, d, t, q, reason, marks):
    """Note that nothing is known from here on, for a reason that is of no joint."""
    watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
    passed(watch, d, t, q, reason, -1, marks)


@inlined
def calms(numbers, watch, unit, u):
    """Whether a ground acceleration neither lifts a structure at rest nor moves its joints."""
    return stays(numbers, u) and steady(watch, u / unit)


@inlined
def wait_for_uplift(numbers, motion, unit, k, drawn, watch, samples):
    """Go on to the last sample before the ground lifts a structure at rest, or moves its joints.

    Returns this sample, and how many samples of the output are done.
    """
    u, factor, every = motion.u, motion.factor, samples.every
    while k < u.size - 1:
        block, passed_over = k // BLOCK, 1
        if k % BLOCK == 0 and block < motion.blocks.size:
            strongest = motion.blocks[block] * factor
            if calms(numbers, watch, unit, strongest) and calms(numbers, watch, unit, -strongest):
                passed_over = min(BLOCK, u.size - 1 - k)
        if passed_over == 1 and not (
            calms(numbers, watch, unit, u[k] * factor) and calms(numbers, watch, unit, u[k + 1] * factor)
        ):
            break
        for sample in range(k, min(k + passed_over, every * samples.phi.size)):
            if sample % every == 0:
                samples.phi[sample // every] = samples.rate[sample // every] = 0.0
                drawn = sample // every + 1
        k += passed_over
    return k, drawn


@inlined
def slide_to_rest(watch, t, unit, marks):
    """Let a structure at rest slide on after the record until friction has stopped it."""
    later = t
    while watch.size > 0 and watch.notes[MOVING] != 0 and later < t + LONG:
        stand(watch, later, watch.step, 1, 0.0, 0.0, unit, 0.0, 0.0, marks)
        later += watch.step


@inlined
def in_one_step(structure, phase, interval, rtol, watch, marks):
    """Try a whole interval as one step in which nothing happens, by far the most common one.

    Returns whether nothing does, and the state at its end.
    """
    law, state = phase.law, phase.state
    s, span = 1.0 - 2.0 * law.d, interval.span
    ground = Ground(s * interval.u0, s * interval.ramp, structure.numbers[0, GRAVITY], 0.0)
    ended, e_q, e_w = advance(structure.forces, law, ground, 0.0, state, span)
    uneventful = ended.q < min(law.q_end, law.q_bound) and (rises(law, state, ended) or falls(state, ended))
    uneventful = uneventful and not passes(structure.corners, law, state.q, ended.q)
    if uneventful and watch.size > 0:  # else the step is made again, and its joints are looked at
        uneventful = watch.notes[FRESH] == 0 and quiet(watch, law, ground, span, ended.q, ended.w)
    uneventful = uneventful and not may_have_peak(structure.numbers, law.d, state, span, ended, False, marks)
    if uneventful and misses(law, rtol, state, ended, e_q, e_w) <= 1:
        marks[PEAK + law.d] = max(marks[PEAK + law.d], ended.q)
        return True, ended
    return False, state


@inlined
def piece_of(structure, motion, phase, interval, tau, j, watch, marks):
    """The piece of an interval from tau up to the next sample of the vertical component.

    Returns it with the vertical sample before it, and whether that component goes on. A piece ends where the weight
    does.
    """
    gravity, v, v_dt = structure.numbers[0, GRAVITY], motion.v, motion.v_dt
    t, span = interval.t, interval.span
    last = v.size - 1
    while j < last and (j + 1) * v_dt - t <= tau + COINCIDE * v_dt:
        j += 1
    if j >= last:
        return j, False, VerticalPiece(gravity, 0.0, span)
    v0, v1 = v[j] * motion.v_factor, v[j + 1] * motion.v_factor
    grade = (v1 - v0) / v_dt
    g = gravity + (v0 + grade * (t - j * v_dt))
    end = (j + 1) * v_dt - t if (j + 1) * v_dt - t < span - COINCIDE * v_dt else span
    if not structure.linear and g + grade * end <= 0 and not isfinite(marks[PASSED]):
        gone = -g / grade if g + grade * tau > 0 else tau
        if gone > tau:
            end = gone
        else:
            d, (q, w, _) = phase.law.d, phase.state
            _, speed = angle(structure, d, q)
            marks[RATE_PEAK + d] = max(marks[RATE_PEAK + d], abs(w) * speed)
            unknown_from(watch, d, t + tau, q, WEIGHTLESS, marks)
    return j, True, VerticalPiece(g, grade, end)


@inlined
def rest(structure, motion, interval, piece, tau, unit, watch, marks):
    """Leave a structure at rest until the ground lifts it, while its joints may open and slide.

    Returns when it lifts, and in which direction (-1: not within the piece).
    """
    t, u0, ramp, gravity = interval.t, interval.u0, interval.ramp, structure.numbers[0, GRAVITY]
    began = tau
    tau, lifted = lifts_at(structure.numbers, tau, piece.end, u0, ramp, piece.g, piece.grade)
    u_began, u_ended = u0 + ramp * began, u0 + ramp * tau
    calm = motion.v.size == 0 and steady(watch, u_began / unit) and steady(watch, u_ended / unit)
    if watch.size > 0 and not calm and tau > began:
        steps = max(1, ceil((tau - began) / watch.step - 1e-9))
        lift0, lift1 = piece.g + piece.grade * began - gravity, piece.g + piece.grade * tau - gravity
        stand(watch, t + began, tau - began, steps, u_began, u_ended, unit, lift0, lift1, marks)
    if tau >= piece.end:  # on the sample: the next piece begins with it
        return piece.end, -1
    return tau, lifted


@inlined
def press(structure, phase, interval, piece, tau, watch, marks):
    """Leave a structure at its stop for as long as the ground pushes it there; returns until when."""
    law, q, end = phase.law, phase.state.q, piece.end
    s = 1.0 - 2.0 * law.d
    pressed = later = 0.0
    for last_moment in range(2):
        pressed, at = later, end if last_moment == 1 else tau
        later = pressure(structure, law, s * (interval.u0 + interval.ramp * at), piece.g + piece.grade * at)
    until = tau
    if pressed > 0:
        until = end if later > 0 else tau + (end - tau) * pressed / (pressed - later)
    if watch.size > 0 and until > tau:
        later = max(later, 0.0)
        there, ground = State(q, 0.0, 0.0), Ground(s * interval.u0, s * interval.ramp, piece.g, piece.grade)
        look(watch, law, ground, interval.t, tau, there, until - tau, there, q, max(pressed, 0.0), later, marks)
    return until


@inlined
def balanced(structure, phase, interval, ground, tau, watch):
    """The state with q.. as the ground has it now; whether joints begin to move is found anew."""
    law, (q, w, f) = phase.law, phase.state
    push = (1.0 - 2.0 * law.d) * (interval.u0 + interval.ramp * tau)
    f = balance(law, q, push) if law.exact else force(structure.forces, law, q, push, ground.g + ground.grade * tau)
    if q == 0 and w == 0:  # from rest it lifts, whatever rounding says of the balance
        f = max(f, 0.0)
    if watch.size > 0 and not quiet(watch, law, ground, tau, q, w):
        watch.notes[FRESH] = 1.0
    return State(q, w, f)


@inlined
def meet(structure, phase, t, loops, watch, marks):
    """Throw a motion back from the bound of its direction, or end it there.

    Returns how it ends (`ROCKING` if it does not), and how it goes on.
    """
    numbers, law, (q, w, f) = structure.numbers, phase.law, phase.state
    d, eta = law.d, numbers[law.d, BOUND_ETA]
    marks[ENDED], marks[SIDE] = t, d
    if q < law.q_bound:
        return OVERTURNED, phase
    watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
    if not isfinite(eta):
        if not isfinite(marks[PASSED]):
            passed(watch, d, t, q, BOUND, -1, marks)
        return LEFT, phase
    _, speed = angle(structure, d, q)
    if watch.size > 0:
        strike(watch, d, t, q / law.q_end, watch.stopped, abs(w) * speed, eta, marks)
    held = eta * w <= numbers[d, REST] or loops > CHATTER
    return ROCKING, Phase(law, State(q, 0.0 if held else -eta * w, f), phase.h, False, False, held)


@inlined
def rebound(numbers, law, w, interval, piece, tau, loops):
    """The direction and the rate after an impact with the rate w, and whether a structure comes to rest by it."""
    d = law.d
    side = d if numbers[d, ONE_SIDED] else 1 - d  # a rebound keeps its direction
    w = numbers[d, ETA] * -w * numbers[d, RATE] / numbers[side, RATE]  # Eq. 6, on phi.
    _, lifted = lifts_at(numbers, tau, tau, interval.u0, interval.ramp, piece.g, piece.grade)
    return side, w, w <= numbers[side, REST] * (FAINT if lifted >= 0 else 1.0) or (lifted < 0 and loops > CHATTER)


@inlined
def land(structure, phase, interval, piece, tau, loose, loops, loud, watch, samples, marks):
    """Go on after an impact, in the other direction or by a rebound, or come to rest.

    `loud` tells whether it may open a joint.
    """
    numbers, law, (q, w, f) = structure.numbers, phase.law, phase.state
    d, t, rate = law.d, interval.t + tau, 0.0
    watch.notes[SO_FAR], watch.notes[SO_FAR + 1] = marks[PEAK], marks[PEAK + 1]
    marks[IMPACTS] += 1.0
    if loose and not isfinite(marks[PASSED]):
        passed(watch, d, t, q, APART, -1, marks)
    side, after, resting = rebound(numbers, law, w, interval, piece, tau, loops)
    n = int(marks[IMPACTS]) - 1
    if loud or n < samples.impacts.shape[0]:
        _, speed = angle(structure, d, q)
        rate = abs(w) * speed
    if loud:
        strike(watch, side, t, q / law.q_end, watch.struck, rate, numbers[d, ETA], marks)
    else:
        watch.notes[SEEN] = nan
    if n < samples.impacts.shape[0]:
        samples.impacts[n, 0], samples.impacts[n, 1], samples.impacts[n, 2] = t, 1.0 - 2.0 * d, rate
    if resting:
        after = 0.0
        marks[ENDED] = t
        if watch.size > 0:
            settle(watch, t, marks)
    return Phase(law_of(law.exact, numbers, side), State(0.0, after, f), phase.h, False, resting, False)


@called
def is_calm(watch, numbers):
    """Whether an impact presses all joints together, so that none opens or slides by it, however fast it is."""
    for d in range(2):
        side = d if numbers[d, ONE_SIDED] else 1 - d
        for j in range(watch.size):
            if bears(watch, j, side, numbers[d, ETA]) < 0:
                return False
    return True


@inlined
def is_lost(structure, motion, phase, k):
    """Whether a motion at sample k overturns for certain under what is still to come."""
    law, q = phase.law, phase.state.q
    if phase.resting or not (phase.state.w >= 0 and q > law.q_cr and law.q_bound > law.q_end):
        return False
    v_factor, ahead, v_ahead, v_above = motion.v_factor, motion.ahead, motion.v_ahead, motion.v_above
    gravity = structure.numbers[0, GRAVITY]
    strongest = ahead[k] * abs(motion.factor) if k < ahead.size else 0.0
    weight = 1 - v_ahead[k] * v_factor / gravity if k < v_ahead.size and v_ahead[k] > 0 else 1.0
    most_weight = 1 + v_above[k] * v_factor / gravity if k < v_above.size else 1.0
    return is_certain(structure, law.d, q, strongest, weight, most_weight)


@called
def started(structure, motion, start, watch, samples, marks):
    """The start of a motion at rest, with q = `start`. Returns how it ends (`ROCKING` if it goes on), and its start."""
    cleared(watch, samples, marks)
    numbers = structure.numbers
    exact = structure.linear and motion.v.size == 0
    law = law_of(exact, numbers, 1 if start < 0 else 0)
    q = abs(start)
    h = STRIDE / max(numbers[0, P], numbers[1, P]) if exact else motion.dt
    phase = Phase(law, State(q, 0.0, 0.0), h, False, q == 0, False)
    marks[PEAK + law.d] = q
    how = ROCKING
    if q >= law.q_bound:
        marks[SIDE] = law.d
        unknown_from(watch, law.d, 0.0, q, BOUND, marks)
        how = LEFT
    return how, Progress(phase, 0.0, 0, 0, 0.0, 0, 0.0, 0)


@inlined
def span_of(shaken, dt, numbers):
    """The length of an interval, in the record or after it."""
    return dt if shaken else SLOW / max(numbers[0, P], numbers[1, P])


@inlined
def after_interval(lost, dt, phase, interval, shaken, k, before, idle, most_impacts, brief, marks):
    """The end of the interval before sample k: how the motion ends (`ROCKING` if it goes on), and the next one."""
    t = interval.t + interval.span
    if shaken:
        t, before = k * dt, marks[IMPACTS]
    else:
        idle += 1
    how = ROCKING
    if lost:
        how = ends(marks, t, phase.law.d, OVERTURNED)
    elif brief and phase.state.q < phase.law.q_cr and isfinite(marks[PASSED]):
        how = ends(marks, t, phase.law.d, LEFT)
    elif marks[IMPACTS] - before > most_impacts or idle > IDLE:
        how = ends(marks, t, phase.law.d, STILL_ROCKING)
    return how, t, before, idle


@inlined
def fits_a_lane(phase, watch):
    """Whether a motion may go on in a lane: it rocks where its forces are polynomials, and no joint moves."""
    law, q = phase.law, phase.state.q
    free = not (phase.resting or phase.held) and law.pairs > 0 and q * law.per_reach - 1 <= 1
    return free and (watch.size == 0 or (watch.notes[MOVING] == 0 and watch.notes[FRESH] == 0))


@called
def follow(structure, motion, progress, loose, rtol, most_impacts, brief, for_lane, watch, samples, marks):
    """Follow one motion to its end: at rest, overturned, or still rocking after `most_impacts` impacts.

    If `loose`, nothing is known from its first impact on. If `for_lane`, it is left, as `ROCKING`, at the next sample
    at which it may go on in a lane. Returns how it ended, and how far it has come.
    """
    numbers = structure.numbers
    dt, every, phi_out, rate_out = motion.dt, samples.every, samples.phi, samples.rate
    exact = structure.linear and motion.v.size == 0
    # The structure's own accelerations are those of the size of its joints times this.
    unit = numbers[0, GRAVITY] / watch.gravity
    calm = is_calm(watch, numbers)
    last, v_last = motion.u.size - 1, motion.v.size - 1
    phase, t, k, j, tau, loops, before, idle = progress
    drawn = 0  # samples of the output that are done
    shaken = True  # whether the record goes on
    while True:
        begins = tau == 0 and loops == 0
        if begins and phase.resting and motion.v.size == 0:
            k, drawn = wait_for_uplift(numbers, motion, unit, k, drawn, watch, samples)
            t = k * dt
        if shaken and k < every * phi_out.size and k % every == 0:  # t is the time of sample k
            s = 1.0 - 2.0 * phase.law.d
            phi, speed = angle(structure, phase.law.d, phase.state.q)
            drawn = k // every
            phi_out[drawn], rate_out[drawn] = s * phi, s * phase.state.w * speed
            drawn += 1
        shaken = k < last or j < v_last
        span = span_of(shaken, dt, numbers)
        u0, u1 = (motion.u[k] * motion.factor, motion.u[k + 1] * motion.factor) if k < last else (0.0, 0.0)
        interval = Interval(t, span, u0, (u1 - u0) / span)
        if begins and phase.resting and not shaken:
            slide_to_rest(watch, t, unit, marks)
            phi_out[drawn:] = rate_out[drawn:] = 0.0
            marks[SIDE] = phase.law.d
            return AT_REST, progress
        if begins and k >= last:
            phase = Phase(phase.law, phase.state, phase.h, False, phase.resting, phase.held)
        elif begins and exact and phase.known:
            f = balance(phase.law, phase.state.q, (1.0 - 2.0 * phase.law.d) * u0)
            phase = Phase(phase.law, State(phase.state.q, phase.state.w, f), phase.h, True, phase.resting, phase.held)
        if begins and phase.known and not phase.resting and motion.v.size == 0 and phase.h >= span:
            whole, state = in_one_step(structure, phase, interval, rtol, watch, marks)
            phase = Phase(phase.law, state, phase.h, True, False, phase.held)
            tau = span if whole else 0.0
        piece = VerticalPiece(numbers[0, GRAVITY], 0.0, span)
        while tau < span:
            if motion.v.size > 0:
                j, goes_on, piece = piece_of(structure, motion, phase, interval, tau, j, watch, marks)
                known = phase.known and goes_on
                phase = Phase(phase.law, phase.state, phase.h, known, phase.resting, phase.held)
            while tau < piece.end:
                loops += 1
                if loops > LOOPS:
                    return ends(marks, t + tau, phase.law.d, STALLED), progress
                if phase.resting:
                    tau, lifted = rest(structure, motion, interval, piece, tau, unit, watch, marks)
                    if lifted < 0:
                        tau = piece.end
                        break
                    watch.kept[:, GAP : GAP + 4] = 0.0
                    law = law_of(exact, numbers, lifted)
                    phase = Phase(law, State(0.0, 0.0, phase.state.f), phase.h, False, False, phase.held)
                    if not isfinite(marks[FIRST_UPLIFT]):
                        marks[FIRST_UPLIFT] = t + tau
                if phase.held:
                    until = press(structure, phase, interval, piece, tau, watch, marks)
                    held = until >= piece.end
                    phase = Phase(phase.law, phase.state, phase.h, phase.known, False, held)
                    tau = min(until, piece.end)
                    if held:
                        break
                s = 1.0 - 2.0 * phase.law.d
                ground = Ground(s * u0, s * interval.ramp, piece.g, piece.grade)
                state = phase.state if phase.known else balanced(structure, phase, interval, ground, tau, watch)
                began, flown = tau, phase.h
                event, tau, ended, h = fly(
                    structure, phase.law, ground, t, began, piece.end, state, flown, rtol,
                    watch.size > 0, watch, marks,
                )  # fmt: skip
                phase = Phase(phase.law, ended, h, True, False, phase.held)
                if not shaken and drawn * (every * dt) <= t + tau and drawn < phi_out.size:
                    flight = (began, tau, state, flown)
                    drawn = draw(structure, phase.law, ground, t, flight, rtol, every * dt, drawn, watch, samples)
                if event == STUCK:
                    return ends(marks, t + tau, phase.law.d, STALLED), progress
                if event == LIMIT:
                    how, phase = meet(structure, phase, t + tau, loops, watch, marks)
                    if how != ROCKING:
                        return how, progress
                if event == IMPACT:
                    idle = 0
                    loud = watch.size > 0 and not (calm and watch.notes[MOVING] == 0)
                    phase = land(structure, phase, interval, piece, tau, loose, loops, loud, watch, samples, marks)
            loops = 0
        k += 1
        lost = is_lost(structure, motion, phase, k)
        how, t, before, idle = after_interval(
            lost, dt, phase, interval, shaken, k, before, idle, most_impacts, brief, marks
        )
        tau, loops = 0.0, 0
        progress = Progress(phase, t, k, j, 0.0, 0, before, idle)
        if how != ROCKING or (for_lane and fits_a_lane(phase, watch)):
            return how, progress


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


@inlined
def structure_of(deck, what, numbers):
    """The structure of a history, whose numbers are in `numbers`."""
    m = int(what[STRUCTURE])
    cells = slice(deck.structures[m, 0], deck.structures[m, 0] + deck.structures[m, 1])
    return Structure(
        deck.structures[m, 2] == 1,
        numbers,
        ForceTables(deck.forces[cells], deck.smooth[m]),
        deck.angles[cells],
        deck.certain[cells],
        deck.held[cells] if deck.held.shape[0] > 0 else deck.held,
        deck.corners[cells] if deck.corners.shape[0] > 0 else deck.corners,
    )


@inlined
def motion_of(deck, what):
    """The ground motion of a history, divided by the size of its structure."""
    of, size = deck.records[int(what[RECORD])], what[SIZE]
    horizontal = slice(int(of[U_FIRST]), int(of[U_FIRST]) + int(of[U_SIZE]))
    vertical = slice(int(of[V_FIRST]), int(of[V_FIRST]) + int(of[V_SIZE]))
    later = slice(int(of[AHEAD_FIRST]), int(of[AHEAD_FIRST]) + int(of[AHEAD_SIZE]))
    v_later = later if of[V_SIZE] > 0 else slice(0, 0)
    return Motion(
        deck.u[horizontal],
        what[FACTOR] / size,
        of[DT],
        deck.v[vertical],
        what[V_FACTOR] / size,
        of[V_DT],
        deck.ahead[later],
        deck.blocks[int(of[BLOCK_FIRST]) : int(of[BLOCK_FIRST]) + int(of[BLOCK_SIZE])],
        deck.v_ahead[v_later],
        deck.v_above[v_later],
    )


@called
def ready(deck, what, numbers):
    """Fill in the numbers of a history, with its bounds."""
    numbers_of(deck.numbers[int(what[STRUCTURE])], what, numbers)
    structure = structure_of(deck, what, numbers)
    for d in range(2):
        numbers[d, Q_BOUND] = bound_of(structure, d, what[SLENDER])


@inlined
def close(structure, how, marks):
    """Note how a history ended, and its peaks as rotations."""
    marks[STATUS] = how
    for d in range(2):
        for peak in (PEAK, PASSED_PEAK, WARNED_PEAK):
            if isfinite(marks[peak + d]):
                marks[peak + d], _ = angle(structure, d, marks[peak + d])


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
        impacts, end time, index of the direction it ended in, how it ended, and peak rates [rad/s]; to be filled.
    room : Room
        Memory of this call.
    """
    for i in range(first, stop):
        what, marks = runs[i], all_marks[i]
        ready(deck, what, room.numbers)
        structure, motion = structure_of(deck, what, room.numbers), motion_of(deck, what)
        watch = watch_of(deck.joints, int(what[STRUCTURE]), what[SIZE], what[SLENDER], motion, room)
        how, progress = started(structure, motion, what[START], watch, samples, marks)
        if how == ROCKING:
            loose = what[LOOSE] != 0
            how, _ = follow(structure, motion, progress, loose, rtol, most_impacts, brief, False, watch, samples, marks)
        close(structure, how, marks)
