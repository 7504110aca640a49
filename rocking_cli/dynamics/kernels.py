"""The history kernel: one compiled function for every structure, on floats and arrays alone.

A direction of rocking is an index d (0 positive, 1 negative) with sign s. A motion is (phi, w): phi >= 0 inside its
direction, and w = sqrt(I) phi., the root of twice the kinetic energy. In w Lagrange's equation has no velocity term,

    phi. = c(phi) w        w. = -(g q(phi) + s r(phi) u)        c = 1/sqrt(I), q = G c, r = B c     [Eq. 8]

so three tables describe a mechanism. The linear model has I = 1, hence w = phi., and is advanced in closed form.

All of it stands in one file because the compiled code is kept by file: a function elsewhere could go stale.
"""

from __future__ import annotations

from math import cosh, inf, isfinite, log, nan, sinh, sqrt

from rocking_cli.dynamics.compiled import compile_kernel

# Columns of `numbers`, one row a direction.
UPLIFT, PHI_CR, ETA, RATE, REST, END, CELL, P, KAPPA_G, GRAVITY = range(10)
# What `marks` gathers on the way.
PEAK, CROSSED, FIRST_UPLIFT, IMPACTS, ENDED, SIDE = 0, 2, 3, 4, 5, 6
MARKS = 7
# How a motion ends.
AT_REST, OVERTURNED, STILL_ROCKING, STALLED = range(4)
# How a flight over part of a sample interval ends.
REACHED, IMPACT, LIMIT, STUCK = range(4)

NONLINEAR, LINEAR = 0, 1
MARGIN = 1e-12  # of the uplift acceleration: by how much it must be passed, so that rounding never lifts a structure
FAINT = 1e-9  # of the rate of rest: what still counts as motion while the ground is pushing beyond uplift
CHATTER = 1000  # impacts in one sample interval that count as rest, however elastic: with dt < 1 s below 1e-6 phi_cr
IDLE = 10_000  # intervals of `slow_dt` without impact after the record: swinging in a hollow beyond phi_cr, for ever
LOOPS = 10_000  # events in one sample interval before giving up


@compile_kernel
def slopes(cells, row, s, phi, w, u):
    """(phi., w.) of the nonlinear mechanism; beyond its ends the outermost cubic goes on smoothly."""
    place = phi / row[CELL]
    k = min(max(int(place), 0), cells.shape[0] - 1)
    x = place - k
    a = cells[k]
    c = a[0] + x * (a[1] + x * (a[2] + x * a[3]))
    q = a[4] + x * (a[5] + x * (a[6] + x * a[7]))
    r = a[8] + x * (a[9] + x * (a[10] + x * a[11]))
    return c * w, -(row[GRAVITY] * q + s * r * u)


@compile_kernel
def step(cells, row, s, phi, w, u, ramp, h):
    """One step h of Dormand and Prince's 5(4) pair: phi, w, both slopes of w, and the error of either.

    The ground acceleration is u at the start of the step and grows by ramp [m/s3].
    """
    a1, b1 = slopes(cells, row, s, phi, w, u)
    a2, b2 = slopes(cells, row, s, phi + h * (a1 / 5), w + h * (b1 / 5), u + ramp * h / 5)
    a3, b3 = slopes(
        cells, row, s, phi + h * (3 / 40 * a1 + 9 / 40 * a2), w + h * (3 / 40 * b1 + 9 / 40 * b2), u + ramp * h * 3 / 10
    )
    a4, b4 = slopes(
        cells,
        row,
        s,
        phi + h * (44 / 45 * a1 - 56 / 15 * a2 + 32 / 9 * a3),
        w + h * (44 / 45 * b1 - 56 / 15 * b2 + 32 / 9 * b3),
        u + ramp * h * 4 / 5,
    )
    a5, b5 = slopes(
        cells,
        row,
        s,
        phi + h * (19372 / 6561 * a1 - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4),
        w + h * (19372 / 6561 * b1 - 25360 / 2187 * b2 + 64448 / 6561 * b3 - 212 / 729 * b4),
        u + ramp * h * 8 / 9,
    )
    a6, b6 = slopes(
        cells,
        row,
        s,
        phi + h * (9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5),
        w + h * (9017 / 3168 * b1 - 355 / 33 * b2 + 46732 / 5247 * b3 + 49 / 176 * b4 - 5103 / 18656 * b5),
        u + ramp * h,
    )
    phi1 = phi + h * (35 / 384 * a1 + 500 / 1113 * a3 + 125 / 192 * a4 - 2187 / 6784 * a5 + 11 / 84 * a6)
    w1 = w + h * (35 / 384 * b1 + 500 / 1113 * b3 + 125 / 192 * b4 - 2187 / 6784 * b5 + 11 / 84 * b6)
    a7, b7 = slopes(cells, row, s, phi1, w1, u + ramp * h)
    e_phi = h * (71 / 57600 * a1 - 71 / 16695 * a3 + 71 / 1920 * a4 - 17253 / 339200 * a5 + 22 / 525 * a6 - a7 / 40)
    e_w = h * (71 / 57600 * b1 - 71 / 16695 * b3 + 71 / 1920 * b4 - 17253 / 339200 * b5 + 22 / 525 * b6 - b7 / 40)
    return phi1, w1, b1, b7, abs(e_phi), abs(e_w)


@compile_kernel
def locate(cells, row, s, phi, w, u, ramp, low, high, turning, level):
    """Where inside the step w vanishes (turning) or phi reaches level: Newton on the step itself, kept in a bracket.

    The sought function is not zero at low, and zero or of the other sign at high. Stepping anew to each trial point
    gives the event the full order of the pair, which no interpolant has.
    """
    phi1, w1, _, _, _, _ = step(cells, row, s, phi, w, u, ramp, low)
    positive = (w1 if turning else phi1 - level) < 0  # at high; there it may be zero
    h = (low + high) / 2
    for _ in range(100):
        phi1, w1, _, b1, _, _ = step(cells, row, s, phi, w, u, ramp, h)
        value = w1 if turning else phi1 - level
        a1, _ = slopes(cells, row, s, phi1, w1, u + ramp * h)
        rate = b1 if turning else a1
        if (value > 0) == positive:
            high = h
        else:
            low = h
        trial = h - value / rate if rate != 0 else low
        if not low < trial < high:
            trial = (low + high) / 2
        if abs(trial - h) <= 4e-16 * high or value == 0:
            break
        h = trial
    return h, phi1, w1


@compile_kernel
def fly(cells, row, s, d, t, tau, end, phi, w, u0, ramp, h, rtol, marks):
    """Advance the nonlinear motion from tau towards end, to the first impact or the kinematic limit.

    Returns what ended it, the new tau, phi and w, and the step to try next. u0 is the ground acceleration at tau = 0.
    """
    scale_phi, scale_w = 1e-2 * row[PHI_CR], 1e-2 * row[PHI_CR] * row[P] / row[RATE]
    for _ in range(1_000_000):
        left = end - tau
        if left <= 0:
            return REACHED, end, phi, w, h
        whole = h >= left
        size = left if whole else h
        u = u0 + ramp * tau
        phi1, w1, b0, b1, e_phi, e_w = step(cells, row, s, phi, w, u, ramp, size)
        error = max(e_phi / (rtol * max(abs(phi), abs(phi1), scale_phi)), e_w / (rtol * max(abs(w), abs(w1), scale_w)))
        if not error <= 1:
            h = size * (max(0.2, 0.9 * error**-0.2) if isfinite(error) else 0.1)
            if tau + h == tau:
                return STUCK, tau, phi, w, h
            continue
        grown = size * (5.0 if error < 1e-4 else min(5.0, 0.9 * error**-0.2))
        h = max(h, grown) if whole else grown

        # w may change sign twice inside the step: end the step at its turning point, where it shows.
        if w * w1 > 0 and w * b0 < 0 and b0 * b1 < 0:
            turn = size * hermite_turn(w, w1, size * b0, size * b1)
            phi2, w2, _, b2, _, _ = step(cells, row, s, phi, w, u, ramp, turn)
            if w * w2 < 0:
                size, phi1, w1, b1, whole = turn, phi2, w2, b2, False

        rising = w > 0 or (w == 0 and (phi == 0 or b0 > 0))  # from rest it lifts, whatever rounding says of b0
        turn, extreme = size, phi1
        if rising == (w1 <= 0):
            turn, extreme = turning_point(cells, row, s, phi, w, u, ramp, size, b0, b1, w1, rising)
        xa, va = 0.0, phi
        for part in range(2):  # up to where phi turns, then from there
            if part == 1 and turn == size:
                break
            xb, vb = (turn, extreme) if part == 0 else (size, phi1)
            if rising == (part == 0):
                marks[PEAK + d] = max(marks[PEAK + d], vb)
                if va < row[PHI_CR] <= vb:
                    x, _, _ = locate(cells, row, s, phi, w, u, ramp, xa, xb, False, row[PHI_CR])
                    marks[CROSSED] = t + tau + x
            elif vb <= 0:
                x, w1 = xa, 0.0
                if va > 0:
                    x, _, w1 = locate(cells, row, s, phi, w, u, ramp, xa, xb, False, 0.0)
                return IMPACT, min(tau + x, end), 0.0, min(w1, 0.0), h
            xa, va = xb, vb
        phi, w = phi1, w1
        tau = end if whole else tau + size
        if phi >= row[END]:
            return LIMIT, tau, phi, w, h
    return STUCK, tau, phi, w, h


@compile_kernel
def hermite_turn(v0, v1, d0, d1):
    """Where in (0, 1) the cubic with end values v and end slopes d of opposite sign turns."""
    a = 6 * (v0 - v1) + 3 * (d0 + d1)
    b = 6 * (v1 - v0) - 2 * (2 * d0 + d1)
    # a x^2 + b x + d0 = 0 has one root in (0, 1), as its ends differ in sign; this form does not cancel.
    root = sqrt(max(b * b - 4 * a * d0, 0.0))
    k = -(b + (root if b >= 0 else -root)) / 2
    x = k / a if a != 0 else inf
    if not 0 < x < 1:
        x = d0 / k if k != 0 else inf
    return x if 0 < x < 1 else 0.5


@compile_kernel
def turning_point(cells, row, s, phi, w, u, ramp, size, b0, b1, w1, rising):
    """Where in a step phi turns, from rising to falling or back, and the phi it reaches."""
    start = 0.0
    if w == 0:  # a start at rest: look behind the moment of greatest speed
        start = size * hermite_turn(w, w1, size * b0, size * b1)
        _, w2, _, _, _, _ = step(cells, row, s, phi, w, u, ramp, start)
        if w2 == 0 or (w2 > 0) != rising:
            return 0.0, phi
    x, extreme, _ = locate(cells, row, s, phi, w, u, ramp, start, size, True, 0.0)
    return x, extreme


@compile_kernel
def linear_at(p, slack, slope, phi, w, x):
    """(phi, phi.) of the linear model a time x later, in closed form [Eqs. 12, 16].

    phi = phi_0 + slack (cosh px - 1) + w/p sinh px + slope (x - sinh(px)/p), with slack = phi - phi_s at the start,
    phi_s = phi_cr + s kappa u/g the rotation of balance under the ground acceleration u, and slope = phi_s' [1/s].
    """
    y = p * x
    half = sinh(y / 2)
    ch1 = 2 * half * half
    sh = 2 * half * cosh(y / 2)
    y2 = y * y
    # x - sinh(px)/p cancels for small px
    lag = x - sh / p if y >= 0.1 else -y * y2 / 6 * (1 + y2 / 20 * (1 + y2 / 42 * (1 + y2 / 72))) / p
    return phi + slack * ch1 + w / p * sh + slope * lag, p * slack * sh + w * (1 + ch1) - slope * ch1


@compile_kernel
def linear_root(p, slack, slope, phi, w, low, high, turning, level):
    """Where in [low, high] phi. vanishes (turning) or phi reaches level: Newton kept in a bracket."""
    v1, w1 = linear_at(p, slack, slope, phi, w, low)
    positive = (w1 if turning else v1 - level) < 0  # at high; there it may be zero
    x = (low + high) / 2
    for _ in range(200):
        v, rate = linear_at(p, slack, slope, phi, w, x)
        value = rate if turning else v - level
        if turning:  # phi.. = p^2 (phi - phi_s)
            rate = p * p * (slack + (v - phi) - slope * x)
        if (value > 0) == positive:
            high = x
        else:
            low = x
        trial = x - value / rate if rate != 0 else low
        if not low < trial < high:
            trial = (low + high) / 2
        if abs(trial - x) <= 4e-16 * high or value == 0:
            break
        x = trial
    return x


@compile_kernel
def fly_linear(row, s, d, t, tau, end, phi, w, u0, ramp, marks):
    """Advance the linear motion from tau towards end, to the first impact; exact on the ramp.

    phi.. changes sign at most once on a ramp, so phi. vanishes at most once on either side of that moment, and
    between those turning points phi is monotonic: every impact, peak and crossing is bracketed.
    """
    p = row[P]
    slack = phi - (row[PHI_CR] + s * row[KAPPA_G] * (u0 + ramp * tau))
    if phi == 0 and w == 0:  # from rest it lifts, whatever rounding says of the balance
        slack = max(slack, 0.0)
    slope = s * row[KAPPA_G] * ramp
    span = end - tau
    x0, v0, r0 = 0.0, phi, w
    x2, v2, r2 = span, 0.0, 0.0
    # Where phi.. = p^2 (slack cosh + (w - slope)/p sinh) changes sign: tanh(px) = -slack p/(w - slope).
    inflection = inf
    drive = w - slope
    if drive != 0:
        ratio = -slack * p / drive
        if 0 < ratio < 1:
            inflection = 0.5 / p * log((1 + ratio) / (1 - ratio))
    for part in range(2):
        if part == 0:
            x2 = min(inflection, span)
        elif inflection < span:
            x2 = span
        else:
            break
        v2, r2 = linear_at(p, slack, slope, phi, w, x2)
        turn, top = x2, v2
        if r0 * r2 < 0:
            turn = linear_root(p, slack, slope, phi, w, x0, x2, True, 0.0)
            top, _ = linear_at(p, slack, slope, phi, w, turn)
        for half in range(2):  # up to the turning point, then from it
            xa, va, xb, vb = (x0, v0, turn, top) if half == 0 else (turn, top, x2, v2)
            if half == 1 and turn == x2:
                break
            if vb > va:
                marks[PEAK + d] = max(marks[PEAK + d], vb)
                if va < row[PHI_CR] <= vb:
                    marks[CROSSED] = t + tau + linear_root(p, slack, slope, phi, w, xa, xb, False, row[PHI_CR])
            elif vb <= 0 and va >= 0 and vb < va:
                x = linear_root(p, slack, slope, phi, w, xa, xb, False, 0.0)
                _, rate = linear_at(p, slack, slope, phi, w, x)
                return IMPACT, min(tau + x, end), 0.0, min(rate, 0.0)
        x0, v0, r0 = x2, v2, r2
    return REACHED, end, v2, r2


@compile_kernel
def is_certain(kind, row, certain, phi, w, strongest):
    """Whether the motion overturns whatever comes: moving out, where no later acceleration can turn it back."""
    if w < 0 or phi <= row[PHI_CR]:
        return False
    if kind == LINEAR:
        return phi >= row[PHI_CR] + row[KAPPA_G] * strongest
    return certain[min(int(phi / row[CELL]), certain.size - 1)] >= strongest


@compile_kernel
def lifts_at(numbers, tau, end, u0, ramp):
    """When a structure at rest lifts between tau and end, and in which direction (-1: it does not).

    It lifts where the ramp crosses the uplift acceleration, not at the sample.
    """
    for d in range(2):
        threshold = numbers[d, UPLIFT]
        if (2.0 * d - 1.0) * (u0 + ramp * tau) - threshold > MARGIN * threshold:
            return tau, d
    for d in range(2):
        threshold = numbers[d, UPLIFT]
        now = (2.0 * d - 1.0) * (u0 + ramp * tau) - threshold
        then = (2.0 * d - 1.0) * (u0 + ramp * end) - threshold
        if then > MARGIN * threshold:
            return min(max(tau - (end - tau) * now / (then - now), tau), end), d
    return end, -1


@compile_kernel
def follow(
    kind,
    cells,
    certain,
    numbers,
    u,
    strongest,
    dt,
    direction,
    phi,
    rtol,
    slow_dt,
    most_impacts,
    phi_out,
    rate_out,
    impacts,
    marks,
):
    """Follow a motion to its end: at rest, overturned, or still rocking after `most_impacts` impacts.

    Parameters
    ----------
    kind : int
        NONLINEAR or LINEAR.
    cells, certain : ndarray
        Tables of both directions (nonlinear), shapes (2, n, 12) and (2, n + 1).
    numbers : ndarray, shape (2, 10)
        See the columns above.
    u : ndarray, shape (npts,)
        Ground acceleration [m/s2], straight between samples, zero after the last; may be empty.
    strongest : ndarray, shape (npts,)
        Largest |u| from each sample on [m/s2].
    dt, slow_dt : float
        Sample interval, and the interval to go on with once nothing is drawn any more [s].
    direction, phi : int, float
        Index of the direction and rotation [rad] to start from, at rest.
    rtol : float
        Relative local error of a nonlinear step.
    most_impacts : int
        When to give up after the end of the record.
    phi_out, rate_out : ndarray, shape (m,)
        Signed rotation [rad] and rate [rad/s] at the samples, to be filled; NaN after overturning.
    impacts : ndarray, shape (k, 3)
        Time [s], sign of the direction that ends and rate before [rad/s] of the first k impacts, to be filled.
    marks : ndarray, shape (MARKS,)
        Peaks of both directions, last upward crossing of phi_cr, first uplift, number of impacts, end time, and the
        index of the direction it ended in, to be filled.

    Returns
    -------
    int
        AT_REST, OVERTURNED, STILL_ROCKING or STALLED.
    """
    marks[:] = nan
    marks[PEAK : PEAK + 2] = 0.0
    marks[IMPACTS] = 0.0
    marks[ENDED] = 0.0
    phi_out[:] = nan
    rate_out[:] = nan
    d = direction
    s = 1.0 - 2.0 * d
    w = 0.0
    marks[PEAK + d] = phi
    resting = phi == 0.0
    h = dt
    t = 0.0
    before = 0.0  # impacts up to the end of what is drawn
    idle = 0
    k = 0
    last = u.size - 1
    while True:
        if k < phi_out.size:
            phi_out[k] = s * phi
            speed = 1.0 if kind == LINEAR else slopes(cells[d], numbers[d], s, phi, 1.0, 0.0)[0]
            rate_out[k] = s * w * speed
        if resting and k >= last and k >= phi_out.size - 1:
            marks[SIDE] = d
            return AT_REST
        drawn = k < phi_out.size - 1 or k < last
        end = dt if drawn else slow_dt
        u0, u1 = (u[k], u[k + 1]) if k < last else (0.0, 0.0)
        ramp = (u1 - u0) / end
        tau = 0.0
        loops = 0
        while tau < end:
            loops += 1
            if loops > LOOPS:
                marks[ENDED], marks[SIDE] = t + tau, d
                return STALLED
            if resting:
                tau, lifted = lifts_at(numbers, tau, end, u0, ramp)
                if lifted < 0 or tau >= end:  # on the sample: the next interval begins with it
                    break
                resting = False
                d = lifted
                s = 1.0 - 2.0 * d
                phi, w = 0.0, 0.0
                if not isfinite(marks[FIRST_UPLIFT]):
                    marks[FIRST_UPLIFT] = t + tau
            row = numbers[d]
            if kind == LINEAR:
                event, tau, phi, w = fly_linear(row, s, d, t, tau, end, phi, w, u0, ramp, marks)
            else:
                event, tau, phi, w, h = fly(cells[d], row, s, d, t, tau, end, phi, w, u0, ramp, h, rtol, marks)
            if event == STUCK:
                loops = LOOPS
                continue
            if event == LIMIT:
                marks[ENDED], marks[SIDE] = t + tau, d
                return OVERTURNED
            if event == IMPACT:
                idle = 0
                n = int(marks[IMPACTS])
                if n < impacts.shape[0]:
                    impacts[n, 0], impacts[n, 1], impacts[n, 2] = t + tau, s, abs(w) * row[RATE]
                marks[IMPACTS] += 1
                w = row[ETA] * -w * row[RATE] / numbers[1 - d, RATE]  # Eq. 6, on phi.
                d = 1 - d
                s = -s
                phi = 0.0
                _, lifted = lifts_at(numbers, tau, tau, u0, ramp)
                if w <= numbers[d, REST] * (FAINT if lifted >= 0 else 1.0) or (lifted < 0 and loops > CHATTER):
                    resting, w = True, 0.0
                    marks[ENDED] = t + tau
        t += end
        k += 1
        if drawn:
            t = k * dt
            before = marks[IMPACTS]
        if not resting and is_certain(kind, numbers[d], certain[d], phi, w, strongest[k] if k < last else 0.0):
            marks[ENDED], marks[SIDE] = t, d
            return OVERTURNED
        idle += 0 if drawn else 1
        if marks[IMPACTS] - before > most_impacts or idle > IDLE:
            marks[ENDED], marks[SIDE] = t, d
            return STILL_ROCKING
