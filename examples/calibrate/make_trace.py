"""Write a trace of free rocking, made up: a block of 0.1 m x 0.5 m is let go, with noise, drift and a gap.

    python examples/calibrate/make_trace.py > examples/calibrate/trace.csv

The equation of motion is integrated here step by step, by nothing of the package, and the restitution scatters from
impact to impact by .01 about .93.
"""

from __future__ import annotations

from math import atan, degrees, hypot, sin, sqrt

import numpy as np

WIDTH, HEIGHT, G = 0.1, 0.5, 9.80665
ALPHA, P = atan(WIDTH / HEIGHT), sqrt(3 * G / (2 * hypot(WIDTH, HEIGHT)))
DT, STEPS, HELD, SAMPLES = 0.01, 200, 40, 400


def main() -> None:
    """Print the trace."""
    random = np.random.default_rng(11)
    angle, rate, side = 0.7 * ALPHA, 0.0, 1
    print("time [s],angle [deg]")
    for k in range(SAMPLES):
        time = k * DT
        if not 1.9 < time < 2.02:  # a gap
            read = angle + 0.01 * ALPHA * time + random.normal(0, 0.005 * ALPHA)
            print(f"{time:.2f},{degrees(read):.3f}")
        for _ in range(STEPS if k >= HELD else 0):
            h = DT / STEPS
            middle = angle + h / 2 * rate
            rate -= h * P**2 * sin(side * ALPHA - middle)
            angle = middle + h / 2 * rate
            if angle * side < 0:
                rate *= random.normal(0.93, 0.01)
                side = -side


if __name__ == "__main__":
    main()
