"""Rotation of two components of a record into the plane in which a structure rocks."""

from __future__ import annotations

from dataclasses import replace
from math import cos, isclose, radians, sin

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.text import exact

SAME = 1e-6  # relative difference of two intervals that are printed differently


def turned(one: GroundMotion, other: GroundMotion, azimuth: float) -> GroundMotion:
    """Return the motion in a direction between two components at right angles.

    Parameters
    ----------
    one, other : GroundMotion
        The components: the first is at 0 degrees, the second at 90.
    azimuth : float
        Angle of the direction, from the first component towards the second [deg].

    Returns
    -------
    GroundMotion
        one cos(azimuth) + other sin(azimuth).

    Raises
    ------
    InputError
        If the components differ in length or sampling interval.
    """
    if not isclose(one.dt, other.dt, rel_tol=SAME):
        message = f"its interval is {other.dt:.9g} s, that of {one.name} {one.dt:.9g} s"
        raise _unlike(other, message, "resample both alike")
    if one.npts != other.npts:
        message = f"it has {other.npts} samples, {one.name} has {one.npts}"
        raise _unlike(other, message, "trim both to the same times; they must begin at the same moment")
    ground = None
    if one.ground is not None and other.ground is not None:
        ground = turned(one.ground, other.ground, azimuth)
    c, s = (of(radians(azimuth)) for of in (cos, sin))
    c, s = (round(each) if abs(each - round(each)) < 1e-15 else each for each in (c, s))  # at right angles
    return replace(
        one,
        acceleration=c * one.acceleration + s * other.acceleration,
        points=None,
        ground=ground,
        remarks=(*one.remarks, *other.remarks),
        processing=(*one.processing, f"with {other.name}", f"azimuth {exact(azimuth)}"),
    )


def _unlike(other: GroundMotion, message: str, hint: str) -> InputError:
    return InputError(Problem(f"{message}: two components go sample by sample", other.name, field="`with`", hint=hint))
