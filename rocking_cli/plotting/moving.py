"""Data of an HTML page with a moving structure, as read by `motionView` of data/motion.js."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import known_until
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.io.json_text import json_text
from rocking_cli.plotting import style
from rocking_cli.plotting.structure import colour
from rocking_cli.plotting.style import BINS_ACROSS, visible
from rocking_cli.studies.film import Film
from rocking_cli.views.animation import verdict_of, why_it_ends

Reals = NDArray[np.float64]
MAX_SHOWN_RATIO = 1.6  # largest ratio of phi to phi_cr: beyond it, a structure overturns or nearly does
MIN_FRAME_INTERVAL = 0.01  # s between the rotations of a page
MAX_FRAMES = 20_000  # rotations of a page
PULSE_POINTS = 200
NAMES: Mapping[ModelName, str] = {
    "nonlinear": "nonlinear", "linear1": "linear, κ₁", "linear2": "linear, κ₂"
}  # fmt: skip


def asset(name: str) -> str:
    """Return the text of a data file of the package that is part of a page, without its lines of comments."""
    text = files("rocking_cli").joinpath("data", name).read_text(encoding="utf-8")
    return re.sub(r"^ *(//.*|/\*.*\*/)\n", "", text, flags=re.MULTILINE)


def as_script(data: Mapping[str, Any]) -> str:
    """Return JSON that is safe inside a script element: no text in it can end the element."""
    text = json_text(data, compact=True)
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def moving(
    film: Film, charts: Sequence[Mapping[str, Any]], *, label: str, speed: float, moment: float
) -> dict[str, Any]:
    """Return all data that a moving structure on a page needs.

    Parameters
    ----------
    film : Film
        The motion to show.
    charts : sequence of mapping
        Charts below the structure, see `ratio_chart` and `ground_chart`.
    label : str
        Description of the drawing, for screen readers.
    speed : float
        Initial speed: seconds of motion per second.
    moment : float
        Time that is shown first [s].
    """
    picture = film.picture.grouped
    return {
        "picture": picture.as_dict(),
        "colours": {
            direction.label: [colour(picture, k, direction) for k in range(len(picture.parts))]
            for direction in picture.directions
        },
        "film": {
            **film.as_dict(max(MIN_FRAME_INTERVAL, film.end / MAX_FRAMES)),
            "ending": why_it_ends(film),
            "verdict": verdict_of(film),
        },
        "charts": list(charts),
        "ratio": style.over(film.history.ends_at_limit),
        "label": label,
        "speed": speed,
        "moment": moment,
    }


def ratio_chart(histories: Mapping[ModelName, History], bins: int = BINS_ACROSS) -> dict[str, Any]:
    """Return a chart of the rotation over the critical one (or the kinematic limit) against time.

    There is a curve for each model, with some two samples in each bin, until the time to which the outcome is known.
    """
    series, reach, until = [], 0.0, known_until(histories)
    first = next(iter(histories.values()))
    for name, run in histories.items():
        ratio = run.ratio[np.isfinite(run.ratio) & (run.time <= until)]
        reach = max(reach, float(np.abs(ratio).max()))
        shown = visible(ratio, bins)
        series.append(_series(NAMES[name], name, run.time[shown], ratio[shown]))
    levels = [
        {"at": level, "text": "kinematic limit" if at_limit else "critical rotation"}
        for level, at_limit in zip((1, -1), first.ends_at_limit, strict=True)
    ]
    tall = min(1.1 * reach, MAX_SHOWN_RATIO) if reach else MAX_SHOWN_RATIO
    return {
        "label": f"rotation {style.over(first.ends_at_limit)}, clockwise up",
        "tall": tall,
        "levels": levels,
        "series": series,
    }


def ground_chart(motion: GroundMotion, fits: Sequence[PulseFit], bins: int = BINS_ACROSS) -> dict[str, Any]:
    """Return a chart of the ground acceleration [g] against time, with the pulses in it."""
    motion = motion.kept
    ground = motion.acceleration / STANDARD_GRAVITY
    shown = visible(ground, bins)
    look = "record" if fits else "trace"
    series = [_series("ground", look, shown.astype(np.float64) * motion.dt, ground[shown])]
    for fit in fits:
        t = fit.start + np.linspace(0.0, fit.pulse.duration, PULSE_POINTS)
        series.append(_series(f"its pulse ({fit.pulse.title})", "pulse", t, fit.acceleration(t) / STANDARD_GRAVITY))
    tall = 1.1 * max(max(abs(value) for value in each["y"]) for each in series)
    return {"label": "ground acceleration [g]", "tall": tall or 1.0, "levels": [], "series": series}


def _series(name: str, look: str, x: Reals, y: Reals) -> dict[str, Any]:
    return {"name": name, "look": look, "x": _short(x, 7), "y": _short(y, 5)}


def _short(values: Reals, digits: int) -> list[float]:
    """Round values to as many digits as are visible, to keep the text short."""
    return [float(f"{value:.{digits}g}") for value in values.tolist()]
