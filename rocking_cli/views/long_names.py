"""What the names of columns stand for, in the words of an axis."""

from __future__ import annotations

LONG_NAMES = {
    "a": "amplitude of the pulse over the uplift acceleration",
    "a_g": "ground acceleration",
    "ag": "amplitude of the pulse",
    "acceleration": "constant acceleration over the uplift acceleration",
    "amplitude": "amplitude over the critical rotation",
    "kappa": "linearisation coefficient of the equivalent block",
    "known_to": "time until which the outcome is known",
    "lambda": "uplift acceleration",
    "least": "smallest amplitude known to overturn",
    "omega": "frequency of the pulse over the frequency parameter",
    "opening": "largest opening of a joint over D_cr",
    "overturned": "whether, or by which share, it overturns",
    "peak_lower_bound": "lower bound of the peak ratio",
    "peak_ratio": "peak rotation over the critical rotation",
    "pga_g": "peak ground acceleration",
    "pgv": "peak ground velocity",
    "phi": "rotation",
    "phi_dot": "rate of rotation",
    "phi_ratio": "rotation over the critical rotation",
    "possible": "smallest amplitude that overturns or has an unknown outcome",
    "restitution": "coefficient of restitution as given",
    "scale": "scale factor",
    "size": "size, 2 pi/p",
    "t": "time",
    "target_pga": "peak ground acceleration after scaling",
    "unknown": "whether, or by which share, the outcome is unknown",
    "v_g": "vertical ground acceleration",
}
"""Meanings of names that are not words themselves."""


def long_name(name: str) -> str:
    """Return what a column stands for; its name in words if that is enough.

    Examples
    --------
    >>> long_name("peak_ratio"), long_name("uplift_time")
    ('peak rotation over the critical rotation', 'uplift time')
    """
    return LONG_NAMES.get(name, name.replace("_", " "))
