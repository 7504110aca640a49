/* Loops in C to measure histories against, from the plainest one that computes anything to the same pair event-exact.

   Each follows `runs` scales of one record, and writes a number for each. The coordinate q of a structure has an inertia
   of one (q.. = -(weight + s u drive)); that of the block is phi. Compiled with -DTERMS=N, coefficients of a polynomial. */
#include <math.h>

#define G 9.80665
#define EXPORT(kind, name, loop)                                                                                   \
    void name(const Side *sides, const Record *record, long runs, const double *scales, double *out)               \
    {                                                                                                              \
        for (long i = 0; i < runs; i++)                                                                            \
            out[i] = loop(kind, sides, record, scales[i]);                                                         \
    }
#define INLINE static inline __attribute__((always_inline))

enum { LIBM, SERIES, POLYNOMIAL }; /* where weight and drive come from: the first two are of a block */

typedef struct {
    double uplift, q_cr, eta, rest, p; /* eta: rate after an impact over that before, in the coordinates of both sides */
    double sin_cr, cos_cr, per_q;      /* of the block; half the range of the polynomials is 1 / per_q */
    double weight[TERMS], drive[TERMS];
} Side;

typedef struct {
    long size;
    double dt;
    const double *u, *ahead; /* ground acceleration, and the strongest from each sample on */
} Record;

typedef struct {
    double q, w, f;
} State;

INLINE double slope(int kind, const Side *side, double q, double push)
{
    double weight, drive, z = q * q;
    if (kind == LIBM) {
        weight = sin(side->q_cr - q), drive = cos(side->q_cr - q);
    } else if (kind == SERIES) { /* to 1e-13 up to 0.6 rad */
        double s = q * (1 + z * (-1. / 6 + z * (1. / 120 + z * (-1. / 5040 + z * (1. / 362880 - z / 39916800)))));
        double c = 1 + z * (-1. / 2 + z * (1. / 24 + z * (-1. / 720 + z * (1. / 40320 + z * (-1. / 3628800 + z / 479001600)))));
        weight = side->sin_cr * c - side->cos_cr * s, drive = side->cos_cr * c + side->sin_cr * s;
    } else {
        double x = q * side->per_q - 1;
        weight = side->weight[TERMS - 1], drive = side->drive[TERMS - 1];
        for (int i = TERMS - 2; i >= 0; i--)
            weight = side->weight[i] + x * weight, drive = side->drive[i] + x * drive;
        return -(weight + push * drive);
    }
    return -side->p * side->p * (weight + push / G * drive);
}

/* Runge and Kutta's step of fourth order for q.. = f(t, q), under a straight push from a to b. */
INLINE State rk4(int kind, const Side *side, State y, double a, double b, double h)
{
    double middle = (a + b) / 2, q = y.q, w = y.w;
    double k1 = slope(kind, side, q, a), k2 = slope(kind, side, q + h / 2 * w, middle);
    double k3 = slope(kind, side, q + h / 2 * w + h * h / 4 * k1, middle);
    double k4 = slope(kind, side, q + h * w + h * h / 2 * k2, b);
    return (State){q + h * w + h * h / 6 * (k1 + k2 + k3), w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), 0};
}

/* One step a sample in one direction and no events: out of its range, it starts anew in the middle. */
INLINE double plain(int kind, const Side *sides, const Record *record, double scale)
{
    State y = {sides[0].q_cr / 2, 0, 0};
    for (long k = 0; k < record->size - 1; k++) {
        y = rk4(kind, sides, y, record->u[k] * scale, record->u[k + 1] * scale, record->dt);
        if (!(y.q > 0 && y.q < sides[0].q_cr))
            y = (State){sides[0].q_cr / 2, 0, 0};
    }
    return y.q;
}

/* As people write it: uplift and impact at samples; the peak over q_cr, or infinity. */
INLINE double crude(int kind, const Side *sides, const Record *record, double scale)
{
    State y = {0, 0, 0};
    double peak = 0;
    for (long k = 0, d = -1; k < record->size - 1; k++) {
        double a = record->u[k] * scale, b = record->u[k + 1] * scale;
        if (d < 0 && fabs(a) <= sides[a > 0].uplift)
            continue;
        if (d < 0)
            d = a > 0;
        y = rk4(kind, &sides[d], y, d ? -a : a, d ? -b : b, record->dt);
        if (y.q < 0) {
            y = (State){-y.q * sides[d].eta, -y.w * sides[d].eta, 0};
            d = y.w < 100 * sides[d].rest ? -1 : 1 - d;
            if (d < 0)
                y = (State){0, 0, 0};
        }
        peak = fmax(peak, d < 0 ? 0 : y.q / sides[d].q_cr);
        if (y.q > 1.5)
            return INFINITY;
    }
    return peak;
}

/* The Nystrom pair 6(4)6FM of Dormand, El-Mikkawy and Prince; *error is that of order 4 over what rtol allows. */
INLINE State pair(int kind, const Side *side, State y, double push, double ramp, double h, double rtol, double *error)
{
    double q = y.q, w = y.w, f = y.f, hh = h * h, end = q + h * w, least = 0.01 * side->q_cr;
#define AT(share, increment) slope(kind, side, q + h * (share) * w + hh * (increment), push + h * (share) * ramp)
    double b = AT(0.1, f / 200);
    double c = AT(0.3, f * (-1. / 2200) + b / 22);
    double d = AT(0.7, f * (637. / 6600) + b * (-7. / 110) + c * (7. / 33));
    double e = AT(0.68, f * (225437. / 1968750) + b * (-30073. / 281250) + c * (65569. / 281250) + d * (-9367. / 984375));
#undef AT
    double q1 = end + hh * (f * (151. / 2142) + b * (5. / 116) + c * (385. / 1368) + d * (55. / 168) + e * (-6250. / 28101));
    double g = slope(kind, side, q1, push + h * ramp);
    double w1 = w + h * (f * (151. / 2142) + b * (25. / 522) + c * (275. / 684) + d * (275. / 252) + e * (-78125. / 112404) + g / 12);
    double q2 = end + hh * (f * (1349. / 157500) + b * (7873. / 50000) + c * (192199. / 900000) + d * (521683. / 2100000) + e * (-16. / 125));
    double w2 = w + h * (f * (1349. / 157500) + b * (7873. / 45000) + c * (27457. / 90000) + d * (521683. / 630000) + e * (-2. / 5) + g / 12);
    double most_q = fmax(least, fmax(fabs(q), fabs(q1))), most_w = fmax(least * side->p, fmax(fabs(w), fabs(w1)));
    *error = fmax(fabs(q1 - q2) / most_q, fabs(w1 - w2) / most_w) / rtol;
    return (State){q1, w1, g};
}

/* When in a step q (or w, if `turn`) vanishes, by Newton on the step itself; sign makes it positive before. */
static double root(int kind, const Side *side, State y, double push, double ramp, double high, double h, int turn,
                   double sign, State *there)
{
    double low = 0, unused, close = turn ? 1e-4 : 1e-8;
    for (int i = 0; i < 100; i++) {
        if (!(h > low && h < high))
            h = (low + high) / 2;
        State x = pair(kind, side, y, push, ramp, h, 1, &unused);
        double value = turn ? x.w : x.q, next = h - value / (turn ? x.f : x.w), step = next - h;
        *there = (State){x.q + step * (x.w + step / 2 * x.f), x.w + step * x.f, x.f};
        if (fabs(step) <= close * high || high - low < 4e-16 * high)
            return next;
        if (sign * value > 0)
            low = h;
        else
            high = h;
        h = next;
    }
    return h;
}

/* Every uplift, impact and turn where it is; the peak over q_cr, or infinity if the motion overturns for certain. */
INLINE double exact(int kind, const Side *sides, const Record *record, double scale)
{
    const double rtol = 1e-9, more = 1 + 1e-12, *u = record->u;
    const long last = record->size - 1;
    State y = {0, 0, 0};
    double h = record->dt, peak = 0, error;
    int d = 0, resting = 1, known = 0;
    for (long k = 0; k < last + 1000000; k++) {
        while (resting && k < last && fabs(u[k] * scale) <= sides[u[k] > 0].uplift * more
               && fabs(u[k + 1] * scale) <= sides[u[k + 1] > 0].uplift * more)
            k++;
        if (resting && k >= last)
            return peak;
        double span = k < last ? record->dt : 0.5 / sides[0].p, u0 = k < last ? u[k] * scale : 0;
        double u1 = k < last ? u[k + 1] * scale : 0, ramp = (u1 - u0) / span;
        known = known && k < last;
        for (double tau = 0, loops = 0; tau < span; loops++) {
            double now = u0 + ramp * tau;
            if (resting) {
                int lifts = fabs(now) > sides[now > 0].uplift * more;
                d = lifts ? now > 0 : u1 > 0;
                if (!lifts && fabs(u1) <= sides[d].uplift * more)
                    break;
                if (!lifts)
                    tau += ((d ? 1 : -1) * sides[d].uplift - now) / ramp, now = u0 + ramp * tau;
                resting = known = 0, y = (State){0, 0, 0};
                if (tau >= span)
                    break;
            }
            const Side *side = &sides[d];
            double s = d ? -1 : 1, push = s * now, left = span - tau, size = fmin(left, h);
            if (!known)
                y.f = slope(kind, side, y.q, push), known = 1;
            if (y.q == 0 && y.w == 0)
                y.f = fmax(y.f, 0);
            if (y.q == 0 && y.f < 0 && y.w > 0) /* a hop lands after some 2 w / -f */
                size = fmin(size, -2.05 * y.w / y.f);
            State e = pair(kind, side, y, push, s * ramp, size, rtol, &error), there = e;
            if (error > 1) {
                h = size * fmax(0.2, 0.9 * pow(error, -0.2));
                continue;
            }
            double still = size * y.f / (y.f - e.f);
            if (y.w * e.w > 0 && y.f * e.f < 0 && y.w * (y.w + y.f * still / 2) < 0) { /* w changes its sign twice */
                h = still;
                continue;
            }
            if (size == h)
                h *= error < 1e-4 ? 5 : fmin(5, 0.9 * pow(error, -0.2));
            double reached = size;
            int impact = e.q <= 0;
            if ((y.w >= 0) == (e.w <= 0)) { /* it turns; downwards, it may touch before */
                double bend = (e.f - y.f) / (2 * size), rooted = y.f * y.f - 4 * bend * y.w;
                double guess = -2 * y.w / (y.f + (y.f < 0 ? -1 : 1) * sqrt(fmax(rooted, 0)));
                double turn = root(kind, side, y, push, s * ramp, size, y.w == 0 ? -y.f / bend : guess, 1, y.w < 0 ? -1 : 1, &there);
                if (y.w < 0 && there.q <= 0)
                    impact = 1, reached = turn;
                else if (y.w >= 0)
                    peak = fmax(peak, there.q / side->q_cr);
            }
            if (!impact) {
                peak = fmax(peak, e.q / side->q_cr);
                y = e, tau = size == left ? span : tau + size;
                continue;
            }
            double guess = y.q == 0 ? -2 * y.w / y.f : reached * y.q / (y.q - e.q);
            tau += root(kind, side, y, push, s * ramp, reached, guess, 0, 1, &there);
            now = u0 + ramp * tau;
            int lifts = fabs(now) > sides[now > 0].uplift * more;
            y = (State){0, -side->eta * there.w, 0}, d = 1 - d, known = 0;
            resting = y.w <= sides[d].rest * (lifts ? 1e-9 : 1) || (!lifts && loops > 1000);
        }
        double strongest = k + 1 < last ? record->ahead[k + 1] * scale : 0;
        if (!resting && y.w >= 0 && y.q > sides[d].q_cr && slope(kind, &sides[d], y.q, strongest) >= 0)
            return INFINITY;
    }
    return NAN;
}

EXPORT(LIBM, plain_libm, plain)
EXPORT(SERIES, plain_series, plain)
EXPORT(POLYNOMIAL, plain_polynomial, plain)
EXPORT(LIBM, crude_libm, crude)
EXPORT(SERIES, exact_series, exact)
