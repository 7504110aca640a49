"""Data of an HTML page with a moving structure, as read by `motionView` of data/motion.js."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from math import floor, inf, log10
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import known_until
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.io.json_text import json_text
from rocking_cli.plotting import style
from rocking_cli.plotting.style import BINS_ACROSS, visible
from rocking_cli.studies.film import Film, Scene
from rocking_cli.views.animation import drawing_in_words, fate, scale_in_words, why_it_ends

MAX_SHOWN_RATIO = 1.6  # largest ratio of phi to phi_cr: beyond it, a structure overturns or nearly does
MIN_FRAME_INTERVAL = 0.01  # s between the rotations of a page
MAX_FRAMES = 20_000  # rotations of a page
PULSE_POINTS = 200
NAMES: Mapping[ModelName, str] = {
    "nonlinear": "nonlinear", "linear1": "linear, κ₁", "linear2": "linear, κ₂"
}  # fmt: skip
LEVELS = {
    (True, True): "kinematic limit", (False, False): "critical rotation", (False, True): "critical rotation or limit"
}  # fmt: skip
"""Names of a ratio of 1, by whether in all and in any curves rotations are divided by the kinematic limit."""


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
    film: Film,
    charts: Sequence[Mapping[str, Any]],
    *,
    label: str,
    speed: float,
    moment: float,
    beside: Sequence[Film] = (),
) -> dict[str, Any]:
    """Return all data that moving structures on a page need.

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
    beside : sequence of Film
        Motions of other structures under the same ground motion, to show beside it.
    """
    scene = Scene((film, *beside))
    step = max(MIN_FRAME_INTERVAL, (scene.end - scene.start) / MAX_FRAMES)
    time = scene.start + np.arange(0.0, scene.end - scene.start + step, step)
    size = abs(np.subtract(*scene.box(film)))
    return {
        "start": scene.start,
        "end": scene.end,
        "step": step,
        "enlargement": scene.enlargement,
        "ground": [round(value, 5 - floor(log10(size))) for value in scene.shift(time).tolist()],
        "scale": scale_in_words(scene),
        "drawn": drawing_in_words(scene),
        "stages": [_stage(scene, each, time, label if not beside else f"{each.name}, {label}") for each in scene.films],
        "charts": list(charts),
        "speed": speed,
        "moment": moment,
    }


def _stage(scene: Scene, film: Film, time: Reals, label: str) -> dict[str, Any]:
    """Return one of the structures, with its rotations [rad] at some times."""
    picture, rotation, place = film.picture.grouped, film.rotation(time), film.place(time)
    return {
        "name": film.name,
        "label": label,
        "picture": picture.as_dict(),
        "shades": {direction.label: picture.shades[direction] for direction in picture.directions},
        "ratio": style.over(film.history.ends_at_limit),
        "rotation": _short(rotation, 5),
        **({} if np.array_equal(place, rotation) else {"place": _short(place, 6)}),
        "middle": (picture.extent[0] + picture.extent[1]).real / 2,
        "box": [[corner.real, corner.imag] for corner in scene.box(film)],
        "stops": None if film.stops == inf else film.stops,
        "ending": why_it_ends(film),
        "fate": fate(film),
    }


def ratio_chart(histories: Mapping[ModelName, History], bins: int = BINS_ACROSS) -> dict[str, Any]:
    """Return a chart of the rotation over the critical one (or the kinematic limit) against time.

    There is a curve for each model, with some two samples in each bin, until the time to which the outcome is known.
    """
    until = known_until(histories)
    return _ratio_chart([(NAMES[name], name, run, until) for name, run in histories.items()], bins)


def ratio_charts(films: Sequence[Film]) -> dict[str, Any]:
    """Return a chart like `ratio_chart` with a curve for each of several structures, as far as its outcome is known."""
    curves = [(each.name, f"curve-{k}", each.history, inf) for k, each in enumerate(films)]
    return _ratio_chart(curves, BINS_ACROSS)


def _ratio_chart(curves: Sequence[tuple[str, str, History, float]], bins: int) -> dict[str, Any]:
    series, reach = [], 0.0
    for name, look, run, until in curves:
        ratio = run.ratio[np.isfinite(run.ratio) & (run.time <= until)]
        reach = max(reach, float(np.abs(ratio).max()))
        shown = visible(ratio, bins)
        series.append(_series(name, look, run.time[shown], ratio[shown]))
    limits = [run.ends_at_limit for _, _, run, _ in curves]
    levels = [
        {"at": level, "text": LEVELS[all(at_limit), any(at_limit)]}
        for level, at_limit in zip((1, -1), zip(*limits, strict=True), strict=True)
    ]
    tall = min(1.1 * reach, MAX_SHOWN_RATIO) if reach else MAX_SHOWN_RATIO
    over = style.over([each for pair in limits for each in pair])
    return {"label": f"rotation {over}, clockwise up", "tall": tall, "levels": levels, "series": series}


def ground_chart(motion: GroundMotion, fits: Sequence[PulseFit], bins: int = BINS_ACROSS) -> dict[str, Any]:
    """Return a chart of the acceleration [g] of the ground, or the floor, against time, with the pulses in it."""
    motion = motion.kept
    ground = motion.acceleration / STANDARD_GRAVITY
    shown = visible(ground, bins)
    look = "record" if fits else "trace"
    what = "ground" if motion.ground is None else "floor"
    series = [_series(what, look, shown.astype(np.float64) * motion.dt, ground[shown])]
    for fit in fits:
        t = fit.start + np.linspace(0.0, fit.pulse.duration, PULSE_POINTS)
        series.append(_series(f"its pulse ({fit.pulse.title})", "pulse", t, fit.acceleration(t) / STANDARD_GRAVITY))
    tall = 1.1 * max(max(abs(value) for value in each["y"]) for each in series)
    return {"label": f"{what} acceleration [g]", "tall": tall or 1.0, "levels": [], "series": series}


def _series(name: str, look: str, x: Reals, y: Reals) -> dict[str, Any]:
    return {"name": name, "look": look, "x": _short(x, 7), "y": _short(y, 5)}


def _short(values: Reals, digits: int) -> list[float]:
    """Round values to as many digits as are visible, to keep the text short."""
    return [float(f"{value:.{digits}g}") for value in values.tolist()]
