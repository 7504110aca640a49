"""Exact motion of the linear model under a pulse that is a chain of sines and constants, any number of impacts.

In direction s the motion obeys phi.. = p^2 (phi - phi_cr - s kappa u_g''/g) [paper, Eqs. 12, 16]. With x = phi/phi_cr
and tau = p t of that direction, and the ground acceleration over that of uplift,

    x'' = x - 1 + c sin(W tau + angle),    c = -s amplitude kappa/(g phi_cr),    W = omega/p

whose solution is a sum of cosh, sinh and sin. An impact hands eta phi. over to the other direction, whose p, phi_cr,
kappa and eta may be others.

Plain floats and tuples, one source for two uses: Python runs it as it stands, without numpy, and it is compiled ahead
for maps (`exact_batch`). Sequences are indexed and never unpacked, so that a list and an array will both do.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from math import asin, expm1, floor, inf, log, log1p, nan, pi, sin, sqrt
from math import cos as cosine
from typing import NamedTuple

# How a motion ends; SPENT: too many impacts within the pulse.
DECIDED, OVERTURNED, SPENT = range(3)
# How a flight ends: at the end of its segment, at an impact, or where nothing can bring it back.
REACHED, IMPACT, FALLEN = range(3)
# What a search inside a flight is for: x at a level, x' = 0, x'' = x', x'' = 0 or x''' = 0.
HEIGHT, TURN, BALANCE, SPEED, PULL = range(5)

FAINT = 1e-10  # x' after an impact within the pulse below which it is at rest: it would rock to 5e-21 of phi_cr
STILL = 1e-6  # x' after an impact below which it is at rest after the pulse
EXCURSIONS = 20_000  # within the pulse; to come to rest a restitution of 0.99 needs 2300
SLIVER = 1e-12  # rest of a segment, or of a radian, that is too short to lift a structure
RESULTS = 8  # numbers of one of many pulses, see `many`
COLUMNS = 4  # of the log, an impact: time [s], sign of the direction that ends, phi. before [rad/s], peak of x before

Rows = Sequence[Sequence[float]]


class Side(NamedTuple):
    """The equivalent block in one direction of rocking."""

    p: float  # [rad/s]
    uplift: float  # ground acceleration at uplift, g phi_cr/kappa [m/s2]
    rate: float  # p phi_cr [rad/s], the unit of phi.
    eta: float  # of an impact that ends this direction


class PulseFlight(NamedTuple):
    """A motion within one segment, from tau = 0 there."""

    x: float
    v: float
    force: float  # x'' at its start
    in_phase: float  # c sin(angle), c cos(angle) at its start
    out_of_phase: float
    W: float


class Fate(NamedTuple):
    """Outcome of a structure under one pulse, in the dimensionless terms of the equation; `Outcome` has it in units."""

    status: int
    side: int  # index of the direction it ended in
    impacts: int  # up to the end of the pulse or overturning; more if they are logged
    uplift: float  # time of the first [s], NaN if there is none
    peaks: tuple[float, float]  # largest x in the positive and the negative direction
    rates: tuple[float, float]  # largest |x'| there
    crossed: float  # when phi_cr was passed for good [s], if it overturned and this was requested


def at(flight: PulseFlight, h: float) -> tuple[float, float, float, float]:
    """x, x', x'' and the growth of the push c sin(.), a time h after the start of a flight.

    The differences from the start are written such that none cancels for small h.
    """
    x, v, force, in_phase, out_of_phase, W = flight
    e = expm1(h)
    sh, ch1 = e * (2 + e) / (2 * (1 + e)), e * e / (2 * (1 + e))  # sinh h, cosh h - 1
    half = sin(W * h / 2)
    sn, cs1 = 2 * half * cosine(W * h / 2), 2 * half * half  # sin Wh, 1 - cos Wh
    q = 1 / (1 + W * W)
    return (
        x + v * sh + force * ch1 + q * (in_phase * (cs1 - W * W * ch1) + out_of_phase * (W * sh - sn)),
        v + v * ch1 + force * sh + q * W * (in_phase * (sn - W * sh) + out_of_phase * (ch1 + cs1)),
        force + force * ch1 + v * sh + q * W * (out_of_phase * (sh + W * sn) - in_phase * W * (ch1 + cs1)),
        W * (out_of_phase * (1 - cs1) - in_phase * sn),
    )


def root(flight: PulseFlight, sought: int, level: float, low: float, high: float, guess: float, falling: bool) -> float:
    """When x reaches level, or what else is sought vanishes: Newton, kept between low and high.

    What is sought is positive at low and not at high if it is falling, else the other way round.
    """
    h = guess if low < guess < high else (low + high) / 2
    for _ in range(200):
        x, v, force, growth = at(flight, h)
        if sought == SPEED:
            value, slope = force, v + growth
        elif sought == PULL:
            value, slope = v + growth, force - flight.W * flight.W * (force - x + 1)
        else:
            value = force - v if sought == BALANCE else v if sought == TURN else x - level
            slope = growth - value if sought == BALANCE else force if sought == TURN else v
        if value == 0:
            return h
        if (value < 0) == falling:
            high = h
        else:
            low = h
        trial = h - value / slope if slope != 0 else high
        if not low < trial < high:
            trial = (low + high) / 2
            if not low < trial < high:
                return high
        elif abs(trial - h) <= 1e-9 * trial:  # what is then missing is below rounding
            return trial
        h = trial
    return h


def top_speed(flight: PulseFlight, lo: float, hi: float) -> float:
    """The largest |x'| between two moments: at one of them, or where x'' vanishes on either side of where x''' does."""
    _, v_lo, force_lo, growth_lo = at(flight, lo)
    _, v_hi, force_hi, growth_hi = at(flight, hi)
    fastest = max(abs(v_lo), abs(v_hi))
    bend, force_bend = hi, force_hi
    if (v_lo + growth_lo) * (v_hi + growth_hi) < 0:
        bend = root(flight, PULL, 0.0, lo, hi, nan, v_lo + growth_lo > 0)
        _, _, force_bend, _ = at(flight, bend)
    for start, force_start, stop, force_stop in ((lo, force_lo, bend, force_bend), (bend, force_bend, hi, force_hi)):
        if force_start * force_stop < 0:
            _, v, _, _ = at(flight, root(flight, SPEED, 0.0, start, stop, nan, force_start > 0))
            fastest = max(fastest, abs(v))
    return fastest


def cross(
    flight: PulseFlight, angle: float, span: float, certain: float, timed: bool, fastest: float
) -> tuple[int, float, float, float, float, float, float]:
    """Fly to the first impact, the end of the segment, or x >= certain going out.

    Returns how it ended, tau, x and x' then, the peak on the way, when x last rose past 1 (NaN: it did not), and the
    largest |x'| or the `fastest` before.

    No turning point can be missed. With g = x'' - x', the growth of g e^tau is c W cos e^tau, whose zeros are known,
    and that of x' e^-tau is g e^-tau: g vanishes at most once between zeros of the cosine, and x' at most once between
    zeros of g. So x' between two such points needs a look only where it has one sign at both and turns to zero.
    """
    lo, x_lo, v_lo, g_lo = 0.0, flight.x, flight.v, flight.force - flight.v
    if x_lo == 0 and v_lo == 0:  # a lift: both grow from zero, whatever rounding says
        v_lo = g_lo = 1.0
    step = 1.0  # so that what grows out of all bounds is seen in time
    if x_lo == 0 and flight.force < 0:  # a hop: it lands after 2 v/-force or so
        step = min(step, -2.05 * flight.v / flight.force)
    bend = inf
    if flight.W > 0:
        bend = ((floor(angle / pi - 0.5) + 1.5) * pi - angle) / flight.W
    peak, crossed = 0.0, nan
    while lo < span:
        while bend <= lo:
            bend += pi / flight.W
        hi = min(lo + step, bend, span)
        step = 1.0
        x_hi, v_hi, force, _ = at(flight, hi)
        g_hi = force - v_hi
        if v_lo * v_hi > 0 and v_lo * g_lo < 0 and g_lo * g_hi < 0:
            cut = root(flight, BALANCE, 0.0, lo, hi, nan, g_lo > 0)
            x_cut, v_cut, _, _ = at(flight, cut)
            if v_lo * v_cut < 0:  # x turns twice: stop where that shows
                hi, x_hi, v_hi, g_hi = cut, x_cut, v_cut, -g_lo
        # Only where x' may exceed what it was is its largest sought.
        faster = max(abs(v_lo), abs(v_hi)) + (hi - lo) * max(abs(v_lo + g_lo), abs(force)) > fastest
        rising = v_lo > 0
        turn, x_turn = hi, x_hi
        if rising == (v_hi <= 0):
            turn = root(flight, TURN, 0.0, lo, hi, lo + (hi - lo) * v_lo / (v_lo - v_hi), rising)
            x_turn, _, _, _ = at(flight, turn)
        for start, x_start, stop, x_stop, up in (
            (lo, x_lo, turn, x_turn, rising),
            (turn, x_turn, hi, x_hi, not rising),
        ):
            if up:
                peak = max(peak, x_stop)
                if timed and x_start < 1 <= x_stop:
                    crossed = root(flight, HEIGHT, 1.0, start, stop, nan, False)
            elif x_stop <= 0 and start < stop:
                guess = hi - x_hi / v_hi if stop == hi and v_hi < 0 else nan
                hit = root(flight, HEIGHT, 0.0, start, stop, guess, True)
                _, v, _, _ = at(flight, hit)
                fastest = max(fastest, top_speed(flight, lo, hit)) if faster else fastest
                return IMPACT, hit, 0.0, min(v, 0.0), peak, crossed, fastest
        fastest = max(fastest, top_speed(flight, lo, hi)) if faster else fastest
        if v_hi >= 0 and x_hi >= certain:
            return FALLEN, hi, x_hi, v_hi, peak, crossed, fastest
        lo, x_lo, v_lo, g_lo = hi, x_hi, v_hi, g_hi
    return REACHED, span, x_lo, v_lo, peak, crossed, fastest


def fly(
    side: Side,
    sign: float,
    segments: Rows,
    amplitude: float,
    period: float,
    k: int,
    t: float,
    v: float,
    timed: bool,
    fastest: float,
) -> tuple[int, int, float, float, float, float, float]:
    """Follow one excursion from x = 0 at t, in segment k, through the pulse and after it.

    Returns IMPACT or FALLEN, the segment it ended in, the time, x' at the impact, its peak, when it passed phi_cr, and
    the largest |x'| or the `fastest` before.
    """
    x, peak, crossed = 0.0, 0.0, nan
    certain = 1.0
    for row in segments:
        certain = max(certain, 1 + abs(amplitude * row[2]) / side.uplift)
    while k < len(segments):
        row = segments[k]
        stop = row[1] * period
        span = (stop - t) * side.p
        if span > 0:
            c = -sign * amplitude * row[2] / side.uplift
            angle = row[3] * (t / period - row[0]) + row[4]
            in_phase, out_of_phase = c * sin(angle), c * cosine(angle)
            force = x - 1 + in_phase
            if x == 0 and v == 0:
                force = max(force, 0.0)
            flight = PulseFlight(x, v, force, in_phase, out_of_phase, row[3] / (period * side.p))
            event, h, x, v, top, passed, fastest = cross(flight, angle, span, certain, timed, fastest)
            peak = max(peak, top)
            crossed = t + passed / side.p if passed >= 0 else crossed
            if event != REACHED:
                return event, k, t + h / side.p, v, peak, crossed, fastest
            t = stop
        k += 1
    # Free motion: x = 1 + out e^tau + (x - 1 - v)/2 e^-tau
    out = (x - 1 + v) / 2
    if out >= 0:
        if x < 1:
            crossed = t + log((1 - x + v) / (2 * out)) / 2 / side.p if out > 0 else inf
        return FALLEN, k, t, v, peak, crossed, fastest
    u = max(v * v + x * (2 - x), 0.0)  # the square of x' at the ground
    if v > 0:
        peak = max(peak, u / (1 + sqrt(max(1 - u, 0.0))))
    end = t + log1p((sqrt(u) + x + v) / (1 - x - v)) / side.p
    return IMPACT, k, end, -sqrt(u), peak, crossed, max(fastest, abs(v), sqrt(u))


def next_lift(
    sides: tuple[Side, Side], segments: Rows, amplitude: float, period: float, k: int, t: float
) -> tuple[int, float, int]:
    """When a structure at rest at t, in segment k, lifts: segment, time and direction (-1: it does not).

    The push in a direction exceeds uplift where c sin(angle) > 1: between two angles of each cycle.
    """
    while k < len(segments):
        row = segments[k]
        start, stop = row[0] * period, row[1] * period
        begin = max(t, start)
        first, lifted = stop - SLIVER * (stop - start), -1
        for d in range(2):
            c = (2.0 * d - 1.0) * amplitude * row[2] / sides[d].uplift
            when = inf
            if row[3] == 0:
                if c * sin(row[4]) > 1:
                    when = begin
            elif abs(c) > 1:
                opens = asin(1 / abs(c)) + (0.0 if c > 0 else pi)
                shuts = pi - asin(1 / abs(c)) + (0.0 if c > 0 else pi)
                angle = row[3] * (begin - start) / period + row[4]
                cycles = floor((angle + SLIVER - shuts) / (2 * pi)) + 1  # the first that is not over
                when = begin + max(opens + 2 * pi * cycles - angle, 0.0) / row[3] * period
            if when < first:
                first, lifted = when, d
        if lifted >= 0:
            return k, first, lifted
        k += 1
    return k, t, -1


def follow(
    sides: tuple[Side, Side],
    segments: Rows,
    amplitude: float,
    period: float,
    timed: bool,
    impacts: MutableSequence[float],
) -> Fate:
    """Follow a structure from rest through a pulse until all is decided.

    Parameters
    ----------
    sides : tuple of Side
        The positive and the negative direction.
    segments : sequence of (start, stop, amplitude, omega, phase)
        The pieces of a pulse, one after the other from 0 on: see `rocking_cli.excitation.pulses.Segment`.
    amplitude, period : float
        Factors on the accelerations and the times of these; a negative amplitude reverses the pulse.
    timed : bool
        Whether to find when it passes phi_cr.
    impacts : mutable sequence of float
        Takes COLUMNS numbers of each impact, as many as find a place. The motion goes on until it rests or there is
        no place left; without any, only until later excursions must be lower than those before.

    Returns
    -------
    Fate
    """
    end = segments[len(segments) - 1][1] * period
    k, t, d, v = 0, 0.0, 0, 0.0
    resting, uplift = True, nan
    highest = rates = (0.0, 0.0)
    count, free = 0, 0
    while count < EXCURSIONS or t >= end:
        if resting:
            k, t, lifted = next_lift(sides, segments, amplitude, period, k, t)
            if lifted < 0:
                return Fate(DECIDED, d, count, uplift, highest, rates, nan)
            d, v, resting = lifted, 0.0, False
            uplift = uplift if uplift >= 0 else t
        event, k, t, v, peak, crossed, fastest = fly(
            sides[d], 1.0 - 2.0 * d, segments, amplitude, period, k, t, v, timed, rates[d]
        )
        highest = (max(highest[0], peak), highest[1]) if d == 0 else (highest[0], max(highest[1], peak))
        rates = (fastest, rates[1]) if d == 0 else (rates[0], fastest)
        if event == FALLEN:
            return Fate(OVERTURNED, d, count, uplift, highest, rates, crossed)
        place = COLUMNS * count
        full = place + COLUMNS > len(impacts)
        if not full:
            impacts[place] = t
            impacts[place + 1] = 1.0 - 2.0 * d
            impacts[place + 2] = -v * sides[d].rate
            impacts[place + 3] = peak
        count += 1
        v = -sides[d].eta * v * sides[d].rate / sides[1 - d].rate  # Eq. 6, on phi.
        d = 1 - d
        if t < end:
            resting = v <= FAINT
        else:
            # An impact takes energy: after the pulse each excursion is lower than the last one in its direction, and
            # the one that the pulse has left in the air may have had no time to show how high it could go.
            free += 1
            if free > 2 and (full or v <= STILL):
                return Fate(DECIDED, d, count, uplift, highest, rates, nan)
    return Fate(SPENT, d, count, uplift, highest, rates, nan)


def many(
    sides: tuple[Side, Side],
    segments: Rows,
    amplitudes: Sequence[float],
    periods: Sequence[float],
    first: int,
    stop: int,
    results: Sequence[MutableSequence[float]],
) -> None:
    """Follow the pulses first to stop of many.

    Each row of results takes the status, the side, the impacts, the uplift, and the peaks and the largest rates of both
    directions.
    """
    nothing = results[0][:0]
    for i in range(first, stop):
        motion = follow(sides, segments, amplitudes[i], periods[i], False, nothing)
        results[i][0] = motion.status
        results[i][1] = motion.side
        results[i][2] = motion.impacts
        results[i][3] = motion.uplift
        results[i][4] = motion.peaks[0]
        results[i][5] = motion.peaks[1]
        results[i][6] = motion.rates[0]
        results[i][7] = motion.rates[1]


SOURCE = (at, root, top_speed, cross, fly, next_lift, follow, many)
"""What is to be compiled, each after those it calls."""
INLINE = (at,)
"""What of it is to be set into each place that calls it."""
