"""The history kernel in lock step: each lane of a vector follows a history of its own, with its own step and search.

What lanes have in common is the step of the pair, which one loop over all of them makes: straight arithmetic that a
compiler turns into vectors. What follows from a step is decided for each lane by the functions of the scalar kernel,
in its arithmetic, so that a history has the same bits in any lane, beside any others, as alone. What is rare, such as
rest, a joint that moves, or a rotation beyond the reach of the polynomials, the scalar kernel itself goes through, up
to the next sample at which a lane can go on.
"""

from __future__ import annotations

from math import inf, nan
from typing import NamedTuple

import numpy as np

from rocking_cli.dynamics.kernels import (
    CHATTER,
    LOOSE,
    RECORD,
    ROCKING,
    SIZE,
    SLENDER,
    START,
    STRUCTURE,
    U_FIRST,
    U_SIZE,
    Interval,
    Phase,
    Progress,
    Room,
    VerticalPiece,
    after_interval,
    close,
    fits_a_lane,
    follow,
    is_calm,
    is_lost,
    land,
    motion_of,
    ready,
    rebound,
    span_of,
    started,
    structure_of,
)
from rocking_cli.dynamics.openings import SEEN, SO_FAR, quiet, watch_of
from rocking_cli.dynamics.rates import keep_rate, may_have_peak, may_peak
from rocking_cli.dynamics.stepping import (
    BEND,
    BOUNDED,
    BOW,
    DONE,
    FASTEST,
    GRAVITY,
    HIT,
    IMPACT,
    IMPACTS,
    PARTS,
    PEAK,
    PER_REACH,
    Q_BOUND,
    Q_CR,
    Q_END,
    RATE_PEAK,
    REACHED,
    STEP,
    Flight,
    Ground,
    Inside,
    Law,
    P,
    Search,
    State,
    called,
    falls,
    inlined,
    judged,
    law_of,
    looked_into,
    misses,
    nystrom,
    probed,
    resumed,
    rises,
    set_out,
)
from rocking_cli.dynamics.stepping import SOURCE as SOURCE

LANES = 8
"""Histories that go on together: two vectors of AVX2, one of AVX-512."""
# Rows of the memory of lanes, each of one number a lane. What the step needs: the motion, the time in the interval and
# the size of the step, the ground, and numbers of the law; what a whole interval may not exceed, if it is to be
# uneventful, and whether it is one; what comes of it; and the polynomials.
(
    ROW_Q, ROW_W, ROW_F, ROW_TAU, ROW_X, ROW_SIGN, ROW_U0, ROW_U1, ROW_SPAN, ROW_WEIGHT, ROW_PER_REACH, ROW_Q_CR,
    ROW_RATE, ROW_SLOW, ROW_UP_TO, ROW_WHOLE, ROW_HIGHEST, ROW_FASTEST, ROW_BOW, ROW_BOUNDED, ROW_RATE_PEAK, ROW_Q1,
    ROW_W1, ROW_F1, ROW_E_Q, ROW_E_W, ROW_FARTHEST, ROW_GOES_ON, SMOOTH,
) = range(29)  # fmt: skip
MOST_PAIRS = 10
ROWS = SMOOTH + 4 * MOST_PAIRS
FEW_PAIRS, MORE_PAIRS = 5, 8  # pairs of powers for which the step is compiled, beside the most
# What is kept of a lane beside, as whole and as real numbers.
(
    INT_RUN, INT_MODE, INT_PART, INT_TRIES, INT_FALLING, INT_SIDE, INT_K, INT_LAST, INT_NEXT, INT_LOOPS, INT_IDLES,
    INT_CALM, INT_STRUCTURE, INT_SIZE, INT_EQUAL, INTEGERS,
) = range(16)  # fmt: skip
(
    REAL_TIME, REAL_H, REAL_H_BEFORE, REAL_END, REAL_BEFORE, REAL_FACTOR, REAL_PEAK_BEFORE, REAL_INSIDE_SIZE,
    REAL_INSIDE_Q, REAL_INSIDE_W, REAL_INSIDE_F, REAL_TURNS, REAL_EXTREME, REAL_LOW, REAL_HIGH, REAL_LEVEL, REAL_DT,
    REALS,
) = range(18)  # fmt: skip
# How a lane goes on: as it stands now, in the same interval, at the next sample, or by the scalar kernel.
PLACED, SAME_INTERVAL, NEXT_SAMPLE, ALONE = range(4)
EMPTY, ENTIRE = -2, -1  # modes of a lane beside those of a flight: without a history; at a whole interval in one step


class Lanes(NamedTuple):
    """Memory of all lanes."""

    rows: np.ndarray  # (ROWS LANES,)
    integers: np.ndarray  # int (LANES, INTEGERS)
    reals: np.ndarray  # (LANES, REALS)
    numbers: np.ndarray  # (LANES, 2, COLUMNS)
    kept: np.ndarray  # (LANES, joints, KEPT)
    notes: np.ndarray  # (LANES, NOTES)
    active: np.ndarray  # int (LANES, four of each joint)


class Lane(NamedTuple):
    """One lane, as the place of its polynomials."""

    rows: np.ndarray
    i: int
    pairs: int


@inlined
def smooth_force(lane, law, q, push, g):
    """q.. by the polynomials, as `force` has it within their reach."""
    rows, i = lane.rows, lane.i
    y = q * law.per_reach - 1
    z = y * y
    g_even = g_odd = b_even = b_odd = 0.0
    for pair in range(lane.pairs - 1, -1, -1):
        g_even = g_even * z + rows[(SMOOTH + 4 * pair) * LANES + i]
        g_odd = g_odd * z + rows[(SMOOTH + 4 * pair + 1) * LANES + i]
        b_even = b_even * z + rows[(SMOOTH + 4 * pair + 2) * LANES + i]
        b_odd = b_odd * z + rows[(SMOOTH + 4 * pair + 3) * LANES + i]
    return -(g * (g_even + y * g_odd) + push * (b_even + y * b_odd))


@inlined
def step_all(rows, pairs, rtol):
    """One step of the pair in every lane; a whole interval in which nothing happens is accepted at once.

    The conditions are those of `in_one_step`, and that neither a joint nor the end of the motion need be looked at.
    """
    for i in range(LANES):
        state = State(rows[ROW_Q * LANES + i], rows[ROW_W * LANES + i], rows[ROW_F * LANES + i])
        s, u0, span = rows[ROW_SIGN * LANES + i], rows[ROW_U0 * LANES + i], rows[ROW_SPAN * LANES + i]
        ramp = (rows[ROW_U1 * LANES + i] - u0) / span
        ground = Ground(s * u0, s * ramp, rows[ROW_WEIGHT * LANES + i], 0.0)
        q_cr, per_reach = rows[ROW_Q_CR * LANES + i], rows[ROW_PER_REACH * LANES + i]
        law = Law(False, 0, 0.0, rows[ROW_RATE * LANES + i], 0.0, q_cr, inf, inf, 0.0, 0, per_reach)
        tau, x = rows[ROW_TAU * LANES + i], rows[ROW_X * LANES + i]
        ended, e_q, e_w, farthest = nystrom(smooth_force, Lane(rows, i, pairs), law, ground, tau, state, x)
        within = (farthest * per_reach - 1 <= 1) & (ended.q < rows[ROW_UP_TO * LANES + i])
        quiet_enough = ended.w * ended.w <= rows[ROW_SLOW * LANES + i]
        up = (state.w > 0) & (ended.w > 0) & ((state.f >= 0) | (ended.f <= 0))
        down = (state.w < 0) & (ended.w < 0) & ((state.f <= 0) | (ended.f >= 0)) & (ended.q > 0)
        small = misses(law, rtol, state, ended, e_q, e_w) <= 1
        slow_enough = not may_peak(
            rows[ROW_FASTEST * LANES + i], rows[ROW_BOW * LANES + i], rows[ROW_BOUNDED * LANES + i],
            rows[ROW_RATE_PEAK * LANES + i], state, x, ended, False,
        )  # fmt: skip
        goes_on = (rows[ROW_WHOLE * LANES + i] > 0) & within & quiet_enough & (up | down) & small & slow_enough
        highest = rows[ROW_HIGHEST * LANES + i]
        rows[ROW_Q1 * LANES + i] = ended.q
        rows[ROW_W1 * LANES + i] = ended.w
        rows[ROW_F1 * LANES + i] = ended.f
        rows[ROW_E_Q * LANES + i] = e_q
        rows[ROW_E_W * LANES + i] = e_w
        rows[ROW_FARTHEST * LANES + i] = farthest
        rows[ROW_GOES_ON * LANES + i] = 1.0 if goes_on else 0.0
        rows[ROW_Q * LANES + i] = ended.q if goes_on else state.q
        rows[ROW_W * LANES + i] = ended.w if goes_on else state.w
        rows[ROW_F * LANES + i] = ended.f if goes_on else state.f
        rows[ROW_HIGHEST * LANES + i] = max(highest, ended.q) if goes_on else highest


@called
def steps(rows, pairs, rtol):
    """One step of the pair in every lane, by polynomials of at least as many pairs of powers."""
    if pairs <= FEW_PAIRS:
        step_all(rows, FEW_PAIRS, rtol)
    elif pairs <= MORE_PAIRS:
        step_all(rows, MORE_PAIRS, rtol)
    else:
        step_all(rows, MOST_PAIRS, rtol)


@called
def evaluate(step, rows, pairs, rtol):
    """`steps`; machine code calls that of the level of this processor, whose address and arguments are in `step`."""
    steps(rows, pairs, rtol)


@inlined
def launch(i, lanes, flight):
    """Keep a flight in lane i, whose next step is the one that it asks for."""
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    _, tau, end, h, state, inside, search = flight
    # The rest of an interval may be uneventful, too.
    whole = flight.mode == STEP and search.x == end - tau and search.x < h and rows[ROW_SPAN * LANES + i] <= h
    rows[ROW_TAU * LANES + i], rows[ROW_X * LANES + i] = tau, search.x
    rows[ROW_WHOLE * LANES + i] = 1.0 if whole and integers[i, INT_K] + 1 < integers[i, INT_LAST] else 0.0
    rows[ROW_Q * LANES + i], rows[ROW_W * LANES + i], rows[ROW_F * LANES + i] = state.q, state.w, state.f
    integers[i, INT_MODE], reals[i, REAL_END], reals[i, REAL_H] = flight.mode, end, h
    if flight.mode != STEP:
        keep(i, lanes, search)
        integers[i, INT_FALLING], reals[i, REAL_LEVEL] = 1 if search.falling else 0, search.level
    if flight.mode != STEP and flight.mode != HIT:
        integers[i, INT_PART], reals[i, REAL_INSIDE_SIZE] = inside.part, inside.size
        reals[i, REAL_TURNS], reals[i, REAL_EXTREME] = inside.turn, inside.extreme
        ended = inside.ended
        reals[i, REAL_INSIDE_Q], reals[i, REAL_INSIDE_W], reals[i, REAL_INSIDE_F] = ended.q, ended.w, ended.f


@inlined
def keep(i, lanes, search):
    """Keep a search in lane i."""
    lanes.rows[ROW_X * LANES + i], lanes.integers[i, INT_TRIES] = search.x, search.tries
    lanes.reals[i, REAL_LOW], lanes.reals[i, REAL_HIGH] = search.low, search.high


@inlined
def search_of(i, lanes):
    """The search of lane i."""
    integers, reals = lanes.integers, lanes.reals
    return Search(
        lanes.rows[ROW_X * LANES + i], reals[i, REAL_LOW], reals[i, REAL_HIGH], integers[i, INT_FALLING] != 0,
        reals[i, REAL_LEVEL], integers[i, INT_TRIES],
    )  # fmt: skip


@inlined
def flight_of(i, lanes, state, search):
    """The flight of lane i."""
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    ended = State(reals[i, REAL_INSIDE_Q], reals[i, REAL_INSIDE_W], reals[i, REAL_INSIDE_F])
    inside = Inside(
        reals[i, REAL_INSIDE_SIZE], ended, reals[i, REAL_TURNS], reals[i, REAL_EXTREME], integers[i, INT_PART]
    )
    return Flight(
        integers[i, INT_MODE], rows[ROW_TAU * LANES + i], reals[i, REAL_END], reals[i, REAL_H], state, inside, search
    )


@inlined
def watched(i, lanes, deck, what, motion):
    """The joints of the structure in lane i."""
    room = Room(lanes.numbers[i], lanes.kept[i], lanes.notes[i], lanes.active[i])
    return watch_of(deck.joints, int(what[STRUCTURE]), what[SIZE], what[SLENDER], motion, room)


@inlined
def begun(i, lanes, pairs, deck, what, progress, marks):
    """Go on in lane i from where a motion has come to; False if its joints must be looked at, which no lane does."""
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    (law, state, h, known, _, _), t, k, _, tau, loops, before, idle = progress
    numbers, factor, starts = lanes.numbers[i], reals[i, REAL_FACTOR], tau == 0 and loops == 0
    shaken, s, g = k < integers[i, INT_SIZE] - 1, 1.0 - 2.0 * law.d, lanes.numbers[i, 0, GRAVITY]
    span, place = span_of(shaken, reals[i, REAL_DT], numbers), integers[i, INT_NEXT] + k
    u0, u1 = (deck.u[place - 1] * factor, deck.u[place] * factor) if shaken else (0.0, 0.0)
    ramp = (u1 - u0) / span
    if integers[i, INT_SIDE] < 0 or (integers[i, INT_SIDE] != law.d and integers[i, INT_EQUAL] == 0):
        for column in range(4 * pairs):
            rows[(SMOOTH + column) * LANES + i] = deck.smooth[integers[i, INT_STRUCTURE], law.d, column]
        rows[ROW_PER_REACH * LANES + i], rows[ROW_Q_CR * LANES + i], rows[ROW_RATE * LANES + i] = (
            law.per_reach, law.q_cr, law.p,
        )  # fmt: skip
        rows[ROW_FASTEST * LANES + i], rows[ROW_BOW * LANES + i] = numbers[law.d, FASTEST], numbers[law.d, BOW]
        rows[ROW_BOUNDED * LANES + i] = numbers[law.d, BOUNDED]
        rows[ROW_UP_TO * LANES + i] = min(law.q_cr, min(law.q_end, law.q_bound))
    rows[ROW_SIGN * LANES + i], integers[i, INT_SIDE] = s, law.d
    if not known or (starts and not shaken):  # as `balanced`
        known = False
        f = smooth_force(Lane(rows, i, pairs), law, state.q, s * (u0 + ramp * tau), g)
        state = State(state.q, state.w, max(f, 0.0) if state.q == 0 and state.w == 0 else f)
        slow = state.w * state.w <= rows[ROW_SLOW * LANES + i] and state.q <= law.q_cr
        if not slow and deck.joints.sizes[integers[i, INT_STRUCTURE], 1] > 0:
            watch = watched(i, lanes, deck, what, motion_of(deck, what))
            if not quiet(watch, law, Ground(s * u0, s * ramp, g, 0.0), tau, state.q, state.w):
                return False
    rows[ROW_SPAN * LANES + i], rows[ROW_WEIGHT * LANES + i] = span, g
    rows[ROW_U0 * LANES + i], rows[ROW_U1 * LANES + i] = u0, u1
    rows[ROW_HIGHEST * LANES + i], rows[ROW_RATE_PEAK * LANES + i] = marks[PEAK + law.d], marks[RATE_PEAK + law.d]
    integers[i, INT_K], integers[i, INT_IDLES], integers[i, INT_LOOPS] = k, idle, 0
    reals[i, REAL_TIME], reals[i, REAL_BEFORE] = t, before
    if starts and known and h >= span:
        rows[ROW_TAU * LANES + i], rows[ROW_X * LANES + i], rows[ROW_WHOLE * LANES + i] = 0.0, span, 1.0
        rows[ROW_Q * LANES + i], rows[ROW_W * LANES + i], rows[ROW_F * LANES + i] = state.q, state.w, state.f
        integers[i, INT_MODE], reals[i, REAL_H] = ENTIRE, h
    else:
        integers[i, INT_LOOPS] = loops + 1
        reals[i, REAL_PEAK_BEFORE], reals[i, REAL_H_BEFORE] = marks[PEAK + law.d], h
        launch(i, lanes, set_out(law, tau, span, h, state))
    return True


@inlined
def go_on(i, lanes, pairs, runs, deck, way, progress, rtol, most_impacts, brief, samples, all_marks):
    """Go on with the history of lane i, in the lane or, where that is not possible, by `follow`.

    `way` tells whether its interval is over, or whether `follow` is to go on. The lane is empty when the history ends.
    """
    run, numbers = lanes.integers[i, INT_RUN], lanes.numbers[i]
    what, marks, how = runs[run], all_marks[run], ROCKING
    if way == NEXT_SAMPLE:
        phase, t, k, _, _, _, before, idle = progress
        lost, shaken = False, k < lanes.integers[i, INT_SIZE] - 1
        if phase.state.q > phase.law.q_cr:
            lost = is_lost(structure_of(deck, what, numbers), motion_of(deck, what), phase, k + 1)
        dt = lanes.reals[i, REAL_DT]
        interval = Interval(t, span_of(shaken, dt, numbers), 0.0, 0.0)
        how, t, before, idle = after_interval(
            lost, dt, phase, interval, shaken, k + 1, before, idle, most_impacts, brief, marks
        )
        progress = Progress(phase, t, k + 1, 0, 0.0, 0, before, idle)
    alone = way == ALONE
    while how == ROCKING:
        if not alone and begun(i, lanes, pairs, deck, what, progress, marks):
            return
        structure, motion = structure_of(deck, what, numbers), motion_of(deck, what)
        watch = watched(i, lanes, deck, what, motion)
        how, progress = follow(
            structure, motion, progress, what[LOOSE] != 0, rtol, most_impacts, brief, True, watch, samples, marks
        )
        alone = False
    close(structure_of(deck, what, numbers), how, marks)
    lanes.integers[i, INT_MODE] = EMPTY


@inlined
def have_equal_sides(smooth, numbers):
    """Whether a step needs no other numbers in the other direction."""
    equal = True
    for column in range(4 * MOST_PAIRS):
        equal = equal and smooth[0, column] == smooth[1, column]
    for column in (PER_REACH, Q_CR, P, Q_END, Q_BOUND, FASTEST, BOW, BOUNDED):
        equal = equal and numbers[0, column] == numbers[1, column]
    return equal


@inlined
def filled(i, lanes, run, runs, deck, samples, all_marks):
    """Begin a history in lane i. Returns how to go on, and from where."""
    what, marks, numbers = runs[run], all_marks[run], lanes.numbers[i]
    ready(deck, what, numbers)
    structure, motion = structure_of(deck, what, numbers), motion_of(deck, what)
    watch = watched(i, lanes, deck, what, motion)
    of = deck.records[int(what[RECORD])]
    lanes.integers[i, INT_RUN], lanes.integers[i, INT_SIDE] = run, -1
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    rows[ROW_SLOW * LANES + i] = watch.slow if watch.size > 0 else inf
    integers[i, INT_STRUCTURE], integers[i, INT_SIZE] = int(what[STRUCTURE]), motion.u.size
    reals[i, REAL_FACTOR], reals[i, REAL_DT] = motion.factor, motion.dt
    # A motion that is loose is asked at every sample whether it ends.
    integers[i, INT_LAST] = int(of[U_SIZE]) - 1 if what[LOOSE] == 0 else -1
    integers[i, INT_NEXT] = int(of[U_FIRST]) + 1
    integers[i, INT_EQUAL] = 1 if have_equal_sides(deck.smooth[int(what[STRUCTURE])], numbers) else 0
    integers[i, INT_CALM] = 1 if is_calm(watch, numbers) else 0
    how, progress = started(structure, motion, what[START], watch, samples, marks)
    if how != ROCKING:
        close(structure, how, marks)
    return (ALONE if how == ROCKING else PLACED), progress


@inlined
def attended(i, lanes, runs, deck, rtol, samples, all_marks):
    """Look at the step of lane i, which was no uneventful interval. Returns how to go on, and from where."""
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    d, run, k = integers[i, INT_SIDE], integers[i, INT_RUN], integers[i, INT_K]
    what, marks = runs[run], all_marks[run]
    law, t, h, span = (
        law_of(False, lanes.numbers[i], d),
        reals[i, REAL_TIME],
        reals[i, REAL_H],
        rows[ROW_SPAN * LANES + i],
    )
    marks[PEAK + d] = rows[ROW_HIGHEST * LANES + i]
    there = State(rows[ROW_Q1 * LANES + i], rows[ROW_W1 * LANES + i], rows[ROW_F1 * LANES + i])
    s, u0 = rows[ROW_SIGN * LANES + i], rows[ROW_U0 * LANES + i]
    ramp = (rows[ROW_U1 * LANES + i] - u0) / span
    loops, before, idle = integers[i, INT_LOOPS], reals[i, REAL_BEFORE], integers[i, INT_IDLES]
    mode, tau, far = integers[i, INT_MODE], rows[ROW_TAU * LANES + i], rows[ROW_FARTHEST * LANES + i]
    state = State(rows[ROW_Q * LANES + i], rows[ROW_W * LANES + i], rows[ROW_F * LANES + i])
    entire = mode == ENTIRE
    if entire:
        reals[i, REAL_PEAK_BEFORE], reals[i, REAL_H_BEFORE], reals[i, REAL_END] = marks[PEAK + d], h, span
        loops = integers[i, INT_LOOPS] = 1
    end = reals[i, REAL_END]
    # To go back to the start of the step, if it must be made again.
    phase = Phase(law, state, reals[i, REAL_H_BEFORE], True, False, False)
    again = Progress(phase, t, k, 0, tau, loops - 1, before, idle)
    if far * law.per_reach - 1 > 1:
        marks[PEAK + d] = reals[i, REAL_PEAK_BEFORE]
        return ALONE, again
    event, size, ended = REACHED, 0.0, there
    met, search = True, search_of(i, lanes)
    if mode >= BEND:
        met, size, ended, search = probed(mode, search, there)
        if not met:
            keep(i, lanes, search)
            return PLACED, again
    if mode == HIT:
        event, ended = IMPACT, State(0.0, min(ended.w, 0.0), ended.f)
    else:
        if mode <= STEP:
            flight = set_out(law, tau, end, h, state)
            if not (entire and flight.search.x != span):  # else a hop, which has not been tried yet
                e_q, e_w = rows[ROW_E_Q * LANES + i], rows[ROW_E_W * LANES + i]
                flight = judged(law, rtol, flight, there, e_q, e_w, t, marks)
        else:
            flight = resumed(flight_of(i, lanes, state, search), size, ended, marks[PEAK + d])
            if flight.mode == PARTS:
                flight = looked_into(law, flight, t, marks)
        if flight.mode < DONE:
            rows[ROW_HIGHEST * LANES + i] = marks[PEAK + d]
            if flight.mode == STEP:
                reals[i, REAL_PEAK_BEFORE], reals[i, REAL_H_BEFORE] = marks[PEAK + d], flight.h
            launch(i, lanes, flight)
            return PLACED, again
        event, (size, ended, _, _, _) = flight.mode - DONE, flight.inside
        simple = entire and (rises(law, state, ended) or falls(state, ended))
        if not simple or may_have_peak(lanes.numbers[i], d, state, size, ended, False, marks):
            h = flight.h  # else as in `in_one_step`
    rows[ROW_HIGHEST * LANES + i] = marks[PEAK + d]
    looks, slow = False, ended.w * ended.w <= rows[ROW_SLOW * LANES + i] and ended.q <= law.q_cr
    if not slow and deck.joints.sizes[integers[i, INT_STRUCTURE], 1] > 0:
        watch = watched(i, lanes, deck, what, motion_of(deck, what))
        ground = Ground(s * u0, s * ramp, rows[ROW_WEIGHT * LANES + i], 0.0)
        looks = not quiet(watch, law, ground, tau + size, ended.q, ended.w)
    if looks or (event != IMPACT and not (event == REACHED and ended.q < law.q_end)):
        marks[PEAK + d] = reals[i, REAL_PEAK_BEFORE]
        return ALONE, again
    if may_have_peak(lanes.numbers[i], d, state, size, ended, event != REACHED, marks):
        structure, ground = (
            structure_of(deck, what, lanes.numbers[i]),
            Ground(s * u0, s * ramp, rows[ROW_WEIGHT * LANES + i], 0.0),
        )
        keep_rate(structure, law, ground, t, tau, state, size, ended, event != REACHED, marks)
        rows[ROW_RATE_PEAK * LANES + i] = marks[RATE_PEAK + d]
    tau = end if size == end - tau else min(tau + size, end)
    phase = Phase(law, ended, h, True, False, False)
    if event == REACHED:
        if tau < end:
            reals[i, REAL_PEAK_BEFORE], reals[i, REAL_H_BEFORE] = marks[PEAK + d], h
            launch(i, lanes, set_out(law, tau, end, h, ended))
            return PLACED, again
        return NEXT_SAMPLE, Progress(phase, t, k, 0, 0.0, 0, before, idle)
    interval, piece = Interval(t, span, u0, ramp), VerticalPiece(rows[ROW_WEIGHT * LANES + i], 0.0, span)
    side, after, resting = rebound(lanes.numbers[i], law, ended.w, interval, piece, tau, loops)
    alone = tau >= end or loops > CHATTER
    loose, loud = what[LOOSE] != 0, integers[i, INT_CALM] == 0
    if resting or loose or loud:
        structure, motion = structure_of(deck, what, lanes.numbers[i]), motion_of(deck, what)
        watch = watched(i, lanes, deck, what, motion)
        phase = land(structure, phase, interval, piece, tau, loose, loops, loud, watch, samples, marks)
        alone = alone or not fits_a_lane(phase, watch)
    else:
        lanes.notes[i, SO_FAR], lanes.notes[i, SO_FAR + 1], lanes.notes[i, SEEN] = marks[PEAK], marks[PEAK + 1], nan
        marks[IMPACTS] += 1.0
        phase = Phase(law_of(False, lanes.numbers[i], side), State(0.0, after, ended.f), h, False, False, False)
    return (ALONE if alone else SAME_INTERVAL), Progress(phase, t, k, 0, tau, loops, before, 0)


@inlined
def at_the_end(i, lanes, all_marks):
    """How to go on with lane i after the last interval of its record, in which nothing has happened, and from where."""
    rows, integers, reals, d = lanes.rows, lanes.integers, lanes.reals, lanes.integers[i, INT_SIDE]
    all_marks[integers[i, INT_RUN], PEAK + d] = rows[ROW_HIGHEST * LANES + i]
    state = State(rows[ROW_Q * LANES + i], rows[ROW_W * LANES + i], rows[ROW_F * LANES + i])
    phase = Phase(law_of(False, lanes.numbers[i], d), state, reals[i, REAL_H], True, False, False)
    k, before = integers[i, INT_K], reals[i, REAL_BEFORE]
    return NEXT_SAMPLE, Progress(phase, reals[i, REAL_TIME], k, 0, 0.0, 0, before, integers[i, INT_IDLES])


@called
def run_lanes(first, stop, runs, deck, step, pairs, rtol, most_impacts, brief, samples, all_marks, lanes):
    """Follow the histories first to stop of `runs`, as `run` does, several at a time.

    Parameters
    ----------
    step : ndarray of int
        What `evaluate` calls.
    pairs : int
        The largest number of pairs of powers of any structure.
    lanes : Lanes
        Memory of this call, of zeros.
    first, stop, runs, deck, rtol, most_impacts, brief, samples, all_marks
        As those of `run`; no samples are kept, and no motion has a vertical component.
    """
    rows, integers, reals = lanes.rows, lanes.integers, lanes.reals
    following, active = first, LANES
    for i in range(LANES):
        integers[i, INT_MODE] = EMPTY
    while active > 0:
        active = 0
        for i in range(LANES):
            if rows[ROW_GOES_ON * LANES + i] != 0 and integers[i, INT_K] + 1 < integers[i, INT_LAST]:
                k = integers[i, INT_K] + 1
                integers[i, INT_K], reals[i, REAL_TIME] = k, k * rows[ROW_SPAN * LANES + i]
                if integers[i, INT_MODE] != ENTIRE:
                    integers[i, INT_MODE], integers[i, INT_LOOPS] = ENTIRE, 0
                    rows[ROW_TAU * LANES + i], rows[ROW_X * LANES + i] = 0.0, rows[ROW_SPAN * LANES + i]
                rows[ROW_U0 * LANES + i] = rows[ROW_U1 * LANES + i]
                rows[ROW_U1 * LANES + i] = deck.u[integers[i, INT_NEXT] + k] * reals[i, REAL_FACTOR]
                active += 1
                continue
            while True:
                if integers[i, INT_MODE] == EMPTY:
                    if following == stop:  # a step of no length, which no one looks at
                        rows[ROW_WHOLE * LANES + i] = rows[ROW_X * LANES + i] = rows[ROW_GOES_ON * LANES + i] = 0.0
                        rows[ROW_SPAN * LANES + i] = 1.0
                        break
                    way, progress = filled(i, lanes, following, runs, deck, samples, all_marks)
                    following += 1
                elif rows[ROW_GOES_ON * LANES + i] != 0:
                    way, progress = at_the_end(i, lanes, all_marks)
                else:
                    way, progress = attended(i, lanes, runs, deck, rtol, samples, all_marks)
                if way != PLACED:
                    go_on(i, lanes, pairs, runs, deck, way, progress, rtol, most_impacts, brief, samples, all_marks)
                rows[ROW_GOES_ON * LANES + i] = 0.0
                if integers[i, INT_MODE] != EMPTY:
                    active += 1
                    break
        if active > 0:
            evaluate(step, rows, pairs, rtol)
