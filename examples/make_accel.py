"""Write `accel.csv` and `accel_transverse.csv`: the two components of a synthetic ground motion near a fault.

Write also `verify/records.csv`, seven motions of shaking alone in one table, for the dynamic method of a code.

The fault ruptures towards the site; the first component is across it, where the pulse is.

It is the sum of two parts, in units of standard gravity:

- a velocity pulse of period 1 s, a cosine under a raised-cosine bell (the shape of Mavroeidis and Papageorgiou, 2003),
  which carries the directivity effect that overturns large blocks;
- random shaking between 0.4 and 12 Hz that rises fast and dies away slowly, which carries the high-frequency peaks.

The sum is corrected so that the ground ends at rest, brought smoothly to zero at both ends, and scaled to a peak of
0.55 g. The second component has other shaking, and half the pulse. The seven motions have a peak of 0.2 g, and every
second sample. None of this is a record of any earthquake: use it to try the tool, not to design with.

    python make_accel.py [FILE [FILE [FILE]]]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DT = 0.01  # s
DURATION = 12.0  # s
PEAK = 0.55  # g, of the sum
SEED = 20030613
TRANSVERSE_PEAK, TRANSVERSE_PULSE, TRANSVERSE_SEED = 0.4, 0.4, 20030627  # of the second component
SET_PEAK, SET_BAND, SET_STEP = 0.2, (0.3, 5.0), 2  # of the seven motions, in g, Hz and samples
SET_SEEDS = (
    20160836,
    20160859,
    20160864,
    20160866,
    20160871,
    20160874,
    20160876,
)  # the ground ends about where it began

PULSE_FREQUENCY = 1.0  # Hz
PULSE_CYCLES = 2.0  # length of the bell, in periods
PULSE_PHASE = 0.5 * np.pi
PULSE_TIME = 3.5  # s, middle of the bell
PULSE_PEAK, NOISE_PEAK = 0.8, 0.5  # of each part, before the sum is scaled

BAND = (0.4, 12.0)  # Hz
ENDS = (0.5, 2.0)  # s, length of the tapers


def pulse(time: Array) -> Array:
    """Acceleration of the velocity pulse v = (1 + cos(w t / n)) cos(w t + phase) / 2, with a peak of one."""
    w, n = 2 * np.pi * PULSE_FREQUENCY, PULSE_CYCLES
    t = time - PULSE_TIME
    bell, wave = 1 + np.cos(w * t / n), np.cos(w * t + PULSE_PHASE)
    slope = -np.sin(w * t / n) / n * wave - bell * np.sin(w * t + PULSE_PHASE)
    inside = np.abs(t) <= n / (2 * PULSE_FREQUENCY)
    return _with_unit_peak(np.where(inside, slope, 0.0))


def noise(time: Array, seed: int, band: tuple[float, float] = BAND) -> Array:
    """Band-limited noise under an envelope that peaks with the pulse, with a peak of one."""
    white = np.random.default_rng(seed).standard_normal(time.size)
    frequency = np.fft.rfftfreq(time.size, DT)
    low, high = band
    # Gentle slopes on both sides of the band, so that the filter does not ring.
    gain = (frequency / low) ** 4 / (1 + (frequency / low) ** 4) / (1 + (frequency / high) ** 4)
    shaking = np.fft.irfft(np.fft.rfft(white) * gain, time.size)
    envelope = (time / PULSE_TIME) ** 2 * np.exp(2 * (1 - time / PULSE_TIME))
    return _with_unit_peak(shaking * envelope)


def taper(time: Array) -> Array:
    """Window that is zero at both ends and one in between."""
    rise = np.clip(time / ENDS[0], 0, 1)
    fall = np.clip((time[-1] - time) / ENDS[1], 0, 1)
    window: Array = np.sin(0.5 * np.pi * rise) ** 2 * np.sin(0.5 * np.pi * fall) ** 2
    return window


def accelerogram(
    peak: float = PEAK, pulse_peak: float = PULSE_PEAK, seed: int = SEED, band: tuple[float, float] = BAND
) -> tuple[Array, Array]:
    """Return times [s] and accelerations [g], as they are printed to the file."""
    time = np.linspace(0, DURATION, round(DURATION / DT) + 1)
    window = taper(time)
    acceleration = (pulse_peak * pulse(time) + NOISE_PEAK * noise(time, seed, band)) * window
    acceleration -= window * acceleration.sum() / window.sum()  # no velocity left at the end
    acceleration = peak * _with_unit_peak(acceleration)
    return np.round(time, 2), np.round(acceleration, 6) + 0.0  # + 0.0: no "-0.000000"


def _with_unit_peak(values: Array) -> Array:
    scaled: Array = values / np.abs(values).max()
    return scaled


def write(path: Path, *of: Any) -> None:
    """Write an accelerogram as comma-separated text; `of` are the arguments of `accelerogram`."""
    rows = [f"{t:.2f},{a:.6f}" for t, a in zip(*accelerogram(*of), strict=True)]
    path.write_text("\n".join(["time_s,accel_g", *rows]) + "\n", encoding="utf-8", newline="\n")


def write_set(path: Path) -> None:
    """Write the seven motions as one table, with a column for each."""
    motions = [accelerogram(SET_PEAK, 0.0, seed, SET_BAND) for seed in SET_SEEDS]
    columns = [motions[0][0], *(acceleration for _, acceleration in motions)]
    rows = [
        f"{t:.2f}," + ",".join(f"{np.round(a, 5) + 0.0:.5f}" for a in at)
        for t, *at in list(zip(*columns, strict=True))[::SET_STEP]
    ]
    heads = ["time_s", *(f"motion {k} [g]" for k in range(1, len(motions) + 1))]
    path.write_text("\n".join([",".join(heads), *rows]) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    here = Path(__file__)
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else here.with_name("accel.csv"))
    transverse = Path(sys.argv[2]) if len(sys.argv) > 2 else here.with_name("accel_transverse.csv")
    write(transverse, TRANSVERSE_PEAK, TRANSVERSE_PULSE, TRANSVERSE_SEED)
    write_set(Path(sys.argv[3]) if len(sys.argv) > 3 else here.parent / "verify" / "records.csv")
