"""Values that `rocking selfcheck` compares with, by programs that share no code with the package.

python -m validation.selfcheck     # writes rocking_cli/questions/selfcheck/expected.json
"""

import json
from itertools import pairwise, product
from math import asin, atan, cos, erf, exp, hypot, log, nan, pi, sin, sqrt, tan
from pathlib import Path

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

FILE = Path(__file__).resolve().parents[1] / "rocking_cli" / "questions" / "selfcheck" / "expected.json"
GRAVITY = 9.80665
MOTIONS = (
    (0.1, (0, 2, 4, 3, -1, -4, -3, 0)),
    (0.2, (0, 3, 5, 0, -5, -4, 0, 2, 0)),  # overturns
    (0.15, (0, -4, 0, 4, -1, -4, 3, 0)),
    (0.07, (0, 4, -4, 1, 5, 2, -4, -5, -1, 3, 2, 0)),
)
"""Ground motions of a few samples [m/s2], straight in between, so that the solver meets few corners."""


# --- released structures: phi'^2 = 4 p^2 sin(alpha - (phi + phi0)/2) sin((phi0 - phi)/2)/m from phi0 ------------------
# m = 1 + 3 n sin^2(alpha - phi); n is 0 for a block [Housner, 1963], 1 for the wall of two blocks.


def block(width, height):
    """Alpha, p (p^2 = 3 g/(4 R), R half the diagonal), eta by the angular momentum, and n."""
    alpha = atan(width / height)
    return alpha, sqrt(1.5 * GRAVITY / hypot(width, height)), 1 - 1.5 * sin(alpha) ** 2, 0


def wall(thickness, height):
    """Alpha, p (p^2 = 3 g/(2 R), R half the diagonal of one of two blocks), an eta of its own, and n."""
    return atan(2 * thickness / height), sqrt(3 * GRAVITY / hypot(thickness, height / 2)), 0.9, 1


def fall(alpha, p, n, top, to=0.0):
    """The time from rest at a rotation to a smaller one [s], by phi = top (1 - x^2) without singularity."""

    def slope(x):
        phi, m = top * (1 - x * x), 1 + 3 * n * sin(alpha - top * (1 - x * x)) ** 2
        return top * x * sqrt(m / (sin(alpha - (phi + top) / 2) * sin((top - phi) / 2))) if x else 0.0

    return quad(slope, 0.0, sqrt(1 - to / top), epsabs=0.0, epsrel=1e-13)[0] / p


def impact_times(alpha, p, eta, n, tilt):
    """The times of the first eight impacts after a release from a fraction of the critical rotation [s]."""
    phi = alpha * tilt
    times = [fall(alpha, p, n, phi)]
    while len(times) < 8:
        energy = cos(alpha) + eta**2 * (cos(alpha - phi) - cos(alpha))  # its share that is left
        phi = alpha - atan(sqrt(1 - energy**2) / energy)
        times.append(times[-1] + 2 * fall(alpha, p, n, phi))
    return times


def release():
    sizes = [(block, (0.7, 2.8)), (wall, (0.3, 3.0)), (block, (0.05, 0.3)), (block, (2.0, 5.0)), (block, (1.0, 8.0))]
    cases = []
    for tilt, (of, size) in product((0.5, 0.05, -0.9, 0.99), [*sizes, (wall, (0.2, 6.0))]):
        names = ("width", "height") if of is block else ("thickness", "height")
        fields = dict(zip(names, size, strict=True)) | ({"restitution": 0.9} if of is wall else {})
        cases.append([of.__name__, fields, tilt, impact_times(*of(*size), abs(tilt))])
    return cases


# --- pulses ----------------------------------------------------------------------------------------------------------


def overturns(a, omega, eta):
    """Whether a sine pulse overturns a linear block, after one impact or none; None if it hits during the pulse.

    From the motion x'' = x + a sin(omega t + asin(1/a)) from x = -1 at rest, and the free motion after the pulse.
    """
    s, after = sqrt(a * a - 1), (2 * pi - asin(1 / a)) / omega
    grows, decays = (s - omega) * exp(after), (s + omega) * exp(-after)
    if grows >= a:
        return True
    if grows - decays + 2 * (1 + omega**2) / omega < 0:
        return None
    energy = (omega / (1 + omega**2)) ** 2 * (grows - a) * (a - decays)  # x^2 - x'^2 after the pulse
    return eta**2 * (1 - energy) >= 1


def pulses():
    """Period, two amplitudes that enclose a threshold, whether overturning begins there, and the threshold."""
    alpha, p, *_ = block(0.7, 2.8)
    unit = GRAVITY * tan(alpha)
    omegas = (5.0, 2.5), (8.0, 1.5, 1.9, 3.2, 4.0, 6.3, 10.0, 20.0)  # up to 6 they overturn after an impact as well
    cases = []
    for eta, some in ((0.9, omegas[0]), (0.9, omegas[1]), (0.7, sum(omegas, ())), (0.8, sum(omegas, ()))):
        rows = []
        for omega in some:
            fates = [(a, overturns(a, omega, eta)) for a in np.geomspace(1.01, 100.0, 250).tolist()]
            for (low, fell), (high, falls) in pairwise(fates):
                if {fell, falls} == {True, False}:
                    one, other = low, high
                    for _ in range(60):
                        middle = (one + other) / 2
                        beyond = (overturns(middle, omega, eta) is True) == falls
                        one, other = (one, middle) if beyond else (middle, other)
                    rows.append([2 * pi / (p * omega), low * unit, high * unit, falls, (one + other) / 2 * unit])
        cases.append([eta, rows])
    return cases


# --- time histories --------------------------------------------------------------------------------------------------


def event_times(size, motion, model):
    """The times of uplift, of the first six impacts, and of overturning if a block overturns before these [s]."""
    (alpha, p, eta, _), (dt, samples) = block(*size), motion
    ground = np.array(samples) / GRAVITY
    time, uplift = dt * np.arange(ground.size), alpha if model == "linear1" else tan(alpha)
    k = int((np.abs(ground) > uplift).argmax()) - 1
    t = float(np.interp(uplift, np.abs(ground[k : k + 2]), time[k : k + 2]))
    s, y, impacts, crossed = (-1 if ground[k + 1] > 0 else 1), [0.0, 0.0], [t], nan

    def slopes(t, y):
        push = s * (ground[k] + (ground[k + 1] - ground[k]) * (t - time[k]) / dt) if k + 1 < time.size else 0.0
        if model != "nonlinear":
            return y[1], p**2 * (y[0] - alpha - alpha / uplift * push)
        return y[1], -(p**2) * (sin(alpha - y[0]) + push * cos(alpha - y[0]))

    events = [lambda t, y, level=level: y[0] - level for level in (0.0, alpha, 2 * alpha)]
    for event, terminal, direction in zip(events, (True, False, True), (-1, 1, 1), strict=True):
        event.terminal, event.direction = terminal, direction
    while len(impacts) <= 6:  # the times of later impacts depend on rounding
        stop = time[k + 1] if k + 1 < time.size else t + 10.0
        run = solve_ivp(slopes, (t, stop), y, "DOP853", events=events, rtol=1e-12, atol=1e-14, max_step=0.02)
        impact, passed, far = run.t_events
        crossed = passed[-1] if passed.size else crossed
        t, y = float(run.t[-1]), run.y[:, -1]
        if far.size:
            return [*impacts, float(crossed)]
        if impact.size:
            impacts.append(t)
            s, y = -s, [0.0, -eta * y[1]]
        else:
            k += 1
    return impacts


def histories():
    sizes, models = ((0.7, 2.8), (0.3, 1.5), (1.0, 3.0)), ("nonlinear", "linear2", "linear1")
    cases = list(product(sizes, range(4), models))
    cases.sort(key=lambda case: not (case[0] == sizes[0] and case[1] < 2 and case[2] != "linear1"))  # quick ones first
    return [[*size, k, model, event_times(size, MOTIONS[k], model)] for size, k, model in cases]


# --- equivalent blocks -----------------------------------------------------------------------------------------------

OPPENHEIM = {"lambda_": 0.370009738022, "phi_cr": 0.069064693539, "kappa1": 0.280404501561, "p": 1.841795997344}
"""Oppenheim's arch, r = 10 m: lambda by the static theorem (linear programme of the line of thrust), the others by
Eq. 39 and a four-bar linkage that Newton's method follows: see tests/questions/selfcheck/test_expected.py."""


def blocks():
    """Structures and the parameters of their equivalent blocks: Table I of the paper, the wall, and an arch."""
    alpha, p, eta, _ = block(0.7, 2.8)
    common = {"lambda_": 0.25, "phi_cr": alpha, "kappa1": 1.0, "kappa2": alpha / 0.25}
    gamma = 0.5  # mass of the beam over that of the columns
    frame = {"p": p * sqrt((1 + 2 * gamma) / (1 + 3 * gamma))}
    frame["eta"] = (1 - 1.5 * sin(alpha) ** 2 + 3 * gamma * cos(2 * alpha)) / (1 + 3 * gamma)
    h, r = 2.0, 0.2  # height and radius of a solid cone
    cone = {"lambda_": 4 * r / h, "phi_cr": atan(4 * r / h), "kappa1": 1.0}
    cone["p"] = sqrt(5 * GRAVITY * hypot(h, 4 * r) / (2 * h**2 + 23 * r**2))
    cone["eta"] = (2 * h**2 - 17 * r**2) / (2 * h**2 + 23 * r**2)
    turn, q, *_ = wall(0.3, 3.0)
    own = {"lambda_": 2 * tan(turn), "phi_cr": turn, "p": q, "kappa1": 0.5, "kappa2": turn / (2 * tan(turn))}
    fields = {"columns": 2, "column_width": 0.7, "column_height": 2.8, "mass_ratio": gamma}
    arch = {"radius": 10.0, "thickness": 1.5, "inclusion_angle_deg": 157.5, "voussoirs": 7}
    return [
        ["block", {"width": 0.7, "height": 2.8}, common | {"p": p, "eta": eta}],
        ["symmetric_frame", fields, common | frame],
        ["cone", {"base_radius": r, "height": h, "kind": "solid"}, cone],
        ["wall", {"thickness": 0.3, "height": 3.0}, own | {"lambda_lin": 2 * turn}],
        ["arch", arch, OPPENHEIM],
    ]


# --- neighbours, openings and filters --------------------------------------------------------------------------------


def neighbours():
    """Shares of neighbours that overturn under a held acceleration, and of restitutions below .85, .9 and .95.

    An acceleration held at x lambda g overturns every neighbour that it uplifts, whatever the restitution: a share of
    Phi(ln x/s) if amplitude or slenderness alone scatters, by .04 and .10. Restitutions scatter by .05 up to 1.
    """

    def normal(x):
        return (1 + erf(x / sqrt(2))) / 2

    eta = block(0.7, 2.8)[2]
    shares = [normal(log(1.02) / 0.04), normal(log(1.06) / 0.1)]
    return shares + [normal((each - eta) / 0.05) / normal((1 - eta) / 0.05) for each in (0.85, 0.9, 0.95)]


def openings():
    """When the slip of a cube of 2 m opens its joint too far, and when a released block first slides [s].

    The cube on friction mu = .2 beside a wall under an acceleration of .21 g does not uplift: it slides by (a - mu g)
    t^2/2, and its motion is unknown once this exceeds .5 % of the displacement of its centroid at the critical
    rotation, 45 degrees. The block slides when the shear force at its corner exceeds .15 N, both by Newton's law.
    """
    slip = 0.005 * 2 * sqrt(2) * sin(pi / 8)
    (alpha, p, *_), radius = block(0.7, 2.8), hypot(0.35, 1.4)
    top = 0.95 * alpha

    def spare(phi):
        turn, up = -(p**2) * sin(alpha - phi), alpha - phi  # rotation acceleration, angle from the vertical
        square = 4 * p**2 * sin(alpha - (phi + top) / 2) * sin((top - phi) / 2)  # square of the rotation rate
        shear = radius * (turn * cos(up) + square * sin(up))
        return 0.15 * (GRAVITY + radius * (turn * sin(up) - square * cos(up))) - abs(shear)

    return [sqrt(2 * slip / (0.01 * GRAVITY)), fall(alpha, p, 0, top, brentq(spare, 0.0, top, xtol=1e-15))]


def filters():
    """Kind, corner, frequency, and what is left of a sine: 1/(1 + r^8), of order 4 forwards and backwards.

    r is the ratio of the tangents of pi f dt of frequency and corner, or its inverse.
    """
    cases = ("highpass", 1.0, 0.8), ("highpass", 1.0, 2.0), ("lowpass", 4.0, 5.0), ("lowpass", 4.0, 2.0)
    ratios = [tan(pi * f * 0.01) / tan(pi * corner * 0.01) for _, corner, f in cases]
    return [
        [*case, 1 / (1 + ratio ** (8 if case[0] == "lowpass" else -8))]
        for case, ratio in zip(cases, ratios, strict=True)
    ]


SIZES = {
    "length": {"m": 1, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "acceleration": {
        "m/s2": 1, "cm/s2": 1e-2, "mm/s2": 1e-3, "gal": 1e-2, "g": 9.80665, "mg": 9.80665e-3, "%g": 9.80665e-2,
        "ft/s2": 0.3048, "in/s2": 0.0254,
    },
    "mass": {"kg": 1, "g": 1e-3, "t": 1e3, "Mg": 1e3, "lb": 0.45359237},
    "force": {
        "N": 1, "daN": 10, "kN": 1e3, "MN": 1e6, "kgf": 9.80665, "lbf": 4.4482216152605, "kip": 4448.2216152605,
    },
    "stiffness": {
        "N/m": 1, "daN/m": 10, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6, "kgf/m": 9.80665,
    },
    "area": {"m2": 1, "cm2": 1e-4, "mm2": 1e-6},
    "pressure": {
        "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "daN/m2": 10, "kN/m2": 1e3,
        "daN/cm2": 10 / 0.01**2, "kg/cm2": 9.80665 / 0.01**2, "kgf/cm2": 9.80665 / 0.01**2, "bar": 1e5,
        "psi": 4.4482216152605 / 0.0254**2, "ksi": 4448.2216152605 / 0.0254**2,
    },
    "density": {"kg/m3": 1, "t/m3": 1e3, "g/cm3": 1e3, "kg/dm3": 1e3, "lb/ft3": 0.45359237 / 0.3048**3},
    "mass per length": {"kg/m": 1, "t/m": 1e3},
    "mass per area": {"kg/m2": 1, "t/m2": 1e3},
    "weight density": {
        "N/m3": 1, "daN/m3": 10, "kN/m3": 1e3, "kgf/m3": 9.80665, "lbf/ft3": 4.4482216152605 / 0.3048**3,
    },
    "time": {"s": 1, "ms": 1e-3, "min": 60},
    "velocity": {"m/s": 1, "cm/s": 1e-2, "mm/s": 1e-3, "in/s": 0.0254, "ft/s": 0.3048},
    "angle": {"rad": 1, "deg": pi / 180, "°": pi / 180, "mrad": 1e-3},
}  # fmt: skip
"""Sizes of units by their definitions, in the first one of each kind."""
RECORDS = {
    "afad": ("AFAD", 0.01), "asa": ("ASA", 0.01), "cosmos": ("COSMOS", 0.01),
    "csmip_v2": ("CSMIP V2", 0.01), "cwa": ("CWA", 0.01), "esm": ("ESM ASCII", 0.01),
    "geonet_v1a": ("GeoNet V1A", 0.001), "geonet_v2a": ("GeoNet V2A", 0.001), "jma": ("JMA", 0.01),
    "knet": ("K-NET/KiK-net", 0.01), "peer_at2": ("PEER AT2", GRAVITY), "simcenter": ("SimCenter JSON", GRAVITY),
    "smc": ("USGS SMC", 0.01), "text": ("text", 1.0), "usc_v1": ("USC V1", GRAVITY / 10),
}  # fmt: skip
"""Format and unit of the file of each reader in `records`; all hold the same samples."""
BY_OBSPY = {
    "gse": ("GSE2", 0.01, {"gain": "0.25 cm/s2"}), "miniseed": ("miniSEED", 0.01, {"units": "cm/s2"}),
    "obspy": ("AH", 0.01, {"units": "cm/s2"}), "sac": ("SAC", 0.01, {"units": "cm/s2"}), "slist": ("SLIST", 0.01, {}),
}  # fmt: skip
"""The same of the readers that use obspy, with arguments for what their format does not state."""


def expected():
    channels = {name: {"channel": "1"} for name in ("afad", "asa", "cwa", "jma")}
    return {
        "motions": [[dt, list(samples)] for dt, samples in MOTIONS],
        "release": release(),
        "pulses": pulses(),
        "histories": histories(),
        "blocks": blocks(),
        "neighbours": neighbours(),
        "openings": openings(),
        "filters": filters(),
        "units": SIZES,
        "records": {name: [*file, channels.get(name, {})] for name, file in RECORDS.items()},
        "records_by_obspy": {name: list(file) for name, file in BY_OBSPY.items()},
    }


def as_text(values):
    """JSON with a line for each case."""
    parts = []
    for name, cases in values.items():
        if isinstance(cases, dict):
            rows = [f'"{key}": {json.dumps(case, ensure_ascii=False)}' for key, case in cases.items()]
            body = "{\n  " + ",\n  ".join(rows) + "\n }"
        else:
            body = "[\n  " + ",\n  ".join(json.dumps(case) for case in cases) + "\n ]"
        parts.append(f' "{name}": {body}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


if __name__ == "__main__":
    FILE.write_text(as_text(expected()), encoding="utf-8", newline="\n")
