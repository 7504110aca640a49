"""The checks of an installation: results against values of other programs, which `expected.json` holds.

The values are by quadrature, formulas and a general solver; the programs (validation/selfcheck.py) share no code with
the package. Only `threads` and `kernels` compare two results of the same code.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from math import hypot, inf, isclose, pi, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.ask.read import read_record
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import batch, exact_batch, ways
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcomes
from rocking_cli.errors import BrokenKernels, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.processing.steps import parse_step, process
from rocking_cli.questions.selfcheck.study import NotRun
from rocking_cli.structure import Structure
from rocking_cli.studies import neighbours as near
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.units import KINDS, read

FOLDER = Path(__file__).parent
EXPECTED: dict[str, Any] = json.loads((FOLDER / "expected.json").read_text(encoding="utf-8"))
QUICK_CASES = {"release": 2, "pulses": 1, "histories": 4}  # number of the first cases that suffice if it must be quick
GRAVITY = 9.80665  # m/s2


def _motion(dt: float, samples: ArrayLike) -> GroundMotion:
    return GroundMotion("motion", dt, np.asarray(samples, dtype=np.float64), unit="m/s2")


MOTIONS = tuple(_motion(*each) for each in EXPECTED["motions"])


def made(mechanism: str = "block", **fields: Any) -> Structure:
    """Return a structure of an installed mechanism; by default a block of .7 x 2.8 m."""
    return Structure(Registry()[mechanism].from_fields(fields or {"width": 0.7, "height": 2.8}))


def largest_difference(found: ArrayLike, expected: ArrayLike) -> float:
    """Return the largest difference between two rows of numbers; infinity if any is missing or not a number."""
    one, other = np.asarray(found, dtype=np.float64), np.asarray(expected, dtype=np.float64)
    if one.shape != other.shape or not np.isfinite([one, other]).all():
        return inf
    return float(np.abs(one - other).max(initial=0.0))


def different_values(one: NDArray[Any], other: NDArray[Any]) -> int:
    """Return how many values of two arrays of one shape and type differ in any bit; NaN has one value."""
    first, second = (np.ascontiguousarray(each).view(np.uint8).reshape(each.size, -1) for each in (one, other))
    neither = np.isnan(one).ravel() & np.isnan(other).ravel()
    return int(((first != second).any(axis=1) & ~neither).sum())


def _largest(name: str, quick: bool, difference: Callable[..., float]) -> float:
    """Return the largest difference of the cases of a check."""
    return max(difference(*case) for case in EXPECTED[name][: QUICK_CASES.get(name) if quick else None])


# --- values of other programs: the checks return the largest deviation, quick or not of all cases but where said -----


def release(quick: bool) -> float:
    """Return the largest difference between times of impacts of released structures [s]; of a few if quick."""

    def difference(mechanism: str, fields: dict[str, float], tilt: float, times: list[float]) -> float:
        history = follow(made(mechanism, **fields).model("nonlinear"), None, release=tilt)
        return largest_difference(history.impacts[: len(times), 0], times)

    return _largest("release", quick, difference)


def pulses(quick: bool) -> float:
    """Return the largest relative difference between amplitudes at which overturning begins or ends."""

    def difference(eta: float, brackets: list[list[float]]) -> float:
        period, low, high, begins, threshold = np.array(brackets).T
        equivalence = made().under(restitution=eta).equivalence
        for _ in range(50):  # halvings, to below the last bit
            middle = (low + high) / 2
            outcomes = exact_many(equivalence, Sine(1.0, 1.0), middle, period, kappa=2, gravity=GRAVITY, threads=1)
            beyond = outcomes.fell == (begins == 1)
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return largest_difference((low + high) / 2 / threshold, np.ones_like(threshold))

    return _largest("pulses", quick, difference)


def histories(quick: bool) -> float:
    """Return the largest difference between times of uplift, impacts and overturning [s]."""

    def difference(width: float, height: float, motion: int, name: Any, times: list[float]) -> float:
        history = follow(made(width=width, height=height).model(name), MOTIONS[motion])
        compared = [history.uplift_time, *history.impacts[:6, 0]]  # the times of later impacts depend on rounding
        return largest_difference(compared + [history.overturning_time] * history.fell, times)

    return _largest("histories", quick, difference)


def blocks(quick: bool) -> float:
    """Return the largest relative deviation of a parameter of an equivalent block."""

    def difference(mechanism: str, fields: dict[str, Any], parameters: dict[str, float]) -> float:
        equivalence = made(mechanism, **fields).equivalence
        sides = equivalence.positive, equivalence.negative
        ratios = [getattr(side, name) / value for side in sides for name, value in parameters.items()]
        return largest_difference(ratios, np.ones(len(ratios)))

    return _largest("blocks", quick, difference)


def neighbours(quick: bool) -> float:
    """Return the largest deviation of a share: of two under held accelerations, and of three of restitutions."""
    structure, shares = made(), []
    for x, around in ((1.02, near.Neighbourhood(slenderness=0.0)), (1.06, near.Neighbourhood(amplitude=0.0))):
        held = _motion(0.5, np.full(20, x * 0.25 * GRAVITY))
        shares.append(near.neighbours(Conditions(structure, around=around), held).overturned)
    drawn = near.Neighbourhood().drawn(structure.model("nonlinear")).eta[:, 0]
    shares += [float((drawn < eta).mean()) for eta in (0.85, 0.9, 0.95)]
    return largest_difference(shares, EXPECTED["neighbours"])


def openings(quick: bool) -> float:
    """Return the largest error of two times of slip [s], which steps of 1.3 ms limit."""
    cube = made(width=2.0, height=2.0, friction=0.2, one_sided="positive", rebound=0.5)
    history = follow(cube.model("nonlinear"), _motion(0.01, np.full(60, -0.21 * GRAVITY)))
    released = follow(made(width=0.7, height=2.8, friction=0.15).model("nonlinear"), None, release=0.95)
    return largest_difference([history.known_to, released.warned], EXPECTED["openings"])


def joints(quick: bool) -> float:
    """Return the largest deviation of a force at the corner of a rocking block, per kg and m/s2, by Newton's law.

    The tables have the factors of 1, u_g'', q.^2 and v_g'' in the forces, and the compliance of each alone. They are
    compared half-way between their nodes, where they are least right.
    """
    model, r = made().model("nonlinear"), hypot(0.35, 1.4)  # a mass of 1 kg
    assert model.joints is not None and model.tables is not None
    cells, inertia, worst = len(model.joints.rows), 4 / 3 * r**2, 0.0
    up = np.arctan(0.25) - (np.arange(cells) + 0.5) / cells * model.tables[0].end / sqrt(inertia)  # from the vertical
    sine, cosine, p2 = np.sin(up), np.cos(up), 0.75 * GRAVITY / r
    turn, push = -p2 * sine, -p2 * cosine / GRAVITY  # rotation acceleration, by gravity and by u_g''
    for side, sign in enumerate((1, -1)):
        place, _, across, _ = model.joints.contacts[0, side]
        computed = model.joints.rows[:, side].reshape(cells, -1, 5, 4) @ 0.5 ** np.arange(4)
        force, shear = GRAVITY + r * sine * turn, sign * r * cosine * turn
        down = force, sign * r * sine * push, -r * cosine / inertia, force / GRAVITY, 4 / (1 + 3 * cosine**2)
        along = shear, 1 + r * cosine * push, sign * r * sine / inertia, shear / GRAVITY, 4 / (1 + 3 * sine**2)
        worst = max(worst, largest_difference(computed[:, [place, across]], np.transpose([down, along], (2, 0, 1))))
    return worst


def filters(quick: bool) -> float:
    """Return the largest deviation of a filtered sine of amplitude 1, far from its ends: it is not shifted."""

    def difference(kind: str, corner: float, frequency: float, left: float) -> float:
        sine = np.sin(2 * pi * frequency * 0.01 * np.arange(6001))
        filtered = process(_motion(0.01, sine), [parse_step(kind, str(corner))]).acceleration
        return largest_difference(filtered[2500:3500], left * sine[2500:3500])

    return _largest("filters", quick, difference)


def units(quick: bool) -> float:
    """Return the largest relative deviation of the size of a unit, by the definitions."""
    sizes = EXPECTED["units"]
    if {kind: set(known) for kind, known in KINDS.items()} != {kind: set(known) for kind, known in sizes.items()}:
        return inf
    ratios = [read(f"1 {unit}", next(iter(known))) / known[unit] for known in sizes.values() for unit in known]
    return largest_difference(ratios, np.ones(len(ratios)))


# --- records ---------------------------------------------------------------------------------------------------------

SAMPLES = [sign * 0.25 * ((37 * k) % 79 - 39) for sign in (1, -1) for k in range(100)]
"""Samples that every format can hold exactly, at intervals of .01 s. Their mean is zero, as K-NET has its zero there.
"""


def records(quick: bool) -> float:
    """Return the largest deviation of a sample, over the largest one, of all formats and of text in all units."""
    text = (FOLDER / "records" / "text").read_text(encoding="utf-8")
    in_units: dict[str, Any] = {}
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        for unit, size in EXPECTED["units"]["acceleration"].items():
            name = f"text in {unit}".replace("/", " per ")
            (Path(folder) / name).write_text(text.replace("[m/s2]", f"[{unit}]"), encoding="utf-8")
            in_units[name] = "text", size, {}
        return max(_records(EXPECTED["records"], FOLDER / "records"), _records(in_units, Path(folder)))


def records_by_obspy(quick: bool) -> float:
    """Return the same as `records` for formats that obspy reads. Raises `NotRun` if it is not installed."""
    if find_spec("obspy") is None:
        raise NotRun("obspy, which reads SAC, miniSEED and more, is not installed: pip install 'rocking-cli[seismo]'")
    return _records(EXPECTED["records_by_obspy"], FOLDER / "records")


def _records(files: Mapping[str, Any], folder: Path) -> float:
    """Return the largest deviation of a sample, over the largest one. Raises `RockingError` with files read wrongly."""
    largest, wrong = 0.0, []
    for name, (title, unit, options) in files.items():
        try:
            motion = read_record(folder / name, **options)
        except RockingError as error:
            wrong.append(f"{name}: {str(error).splitlines()[0]}")
            continue
        if motion.format != title or not isclose(motion.dt, 0.01, rel_tol=1e-6):
            wrong.append(f"{name}: read as {motion.format} with an interval of {motion.dt:g} s")
        largest = max(largest, largest_difference(motion.acceleration / unit, SAMPLES) / max(SAMPLES))
    if wrong:
        raise RockingError("; ".join(wrong))
    return largest


# --- two results of the same code ------------------------------------------------------------------------------------

THREADS = 4
TIE = {"name": "bar", "from": {"ground": [-3.0, 2.8]}, "to": {"at": [-0.35, 2.8]}, "area": 1e-5, "modulus": 2e11}


def threads(quick: bool) -> float:
    """Return how many values of the outcomes are missing, or differ in any bit."""
    tasks, differing = 2 if quick else THREADS, 0
    models = [made("wall", thickness=0.3, height=3.0).model("nonlinear")]  # it has a joint that is checked for opening
    models += made().models(("nonlinear", "linear2"))
    scales = np.linspace(0.5, 2.0, tasks * batch.HISTORIES_PER_TASK // (len(models) * len(MOTIONS)))
    runs = Runs.every(len(models), len(MOTIONS), scales=scales.tolist())
    histories = partial(respond_many, models, MOTIONS, runs, only_peaks=True)
    for compute in (histories, partial(_under_pulses, tasks * exact_batch.PULSES_PER_TASK)):
        one, other = (compute(threads=count) for count in (1, THREADS))
        differing += sum(different_values(getattr(one, name), getattr(other, name)) for name in OUTCOME_FIELDS)
        differing += int(one.failed.sum() + other.failed.sum())  # runs that were never computed count as failed
    return differing


def _under_pulses(count: int, threads: int = 1) -> Outcomes:
    amplitudes, periods = np.geomspace(2.0, 20.0, count), np.geomspace(3.0, 0.3, count)
    sine, equivalence = Sine(1.0, 1.0), made().equivalence
    return exact_many(equivalence, sine, amplitudes, periods, kappa=2, gravity=GRAVITY, threads=threads)


def another_way() -> bool:
    """Return whether Python runs the kernels because the shipped ones are broken, and not as the user chose it."""
    return isinstance(ways.fault_of_shipped(), BrokenKernels) and not os.environ.get(ways.KERNELS_VARIABLE)


def kernels(quick: bool) -> float:
    """Return how many of the computed values differ in any bit.

    Raises
    ------
    NotRun
        If there are no kernels for this system.
    RockingError
        If the library for this system is damaged or missing, or does not load.
    """
    fault = ways.fault_of_shipped()
    if isinstance(fault, BrokenKernels):
        raise RockingError(str(fault)) from fault
    if fault is not None:
        raise NotRun(f"{fault}; Python computes histories") from fault
    computed = []
    for engine in ways.usable():
        with ways.forced(engine):
            computed.append(list(_computed(quick)))
    return sum(different_values(one, other) for one, *rest in zip(*computed, strict=True) for other in rest)


def _computed(quick: bool) -> Iterator[NDArray[Any]]:
    """Yield all arrays that the kernels fill."""
    tied = made(width=0.7, height=2.8, mass=1000.0, ties=[TIE])
    responses = _under_pulses(50)
    yield from (getattr(responses, name) for name in OUTCOME_FIELDS)
    models = [*made().models(("nonlinear", "linear2")), tied.model("nonlinear")]
    models.append(made("wall", thickness=0.3, height=3.0).model("nonlinear"))
    together = respond_many(models, MOTIONS[:1], Runs.every(len(models), 1, scales=(0.9, 1.2, 1.6)))  # in lanes
    yield from (getattr(together, name) for name in OUTCOME_FIELDS)
    for motion in MOTIONS[:1] if quick else MOTIONS:
        both = replace(motion, vertical=_motion(0.07, motion.acceleration[::-1] / 2))
        for model in models:
            for shaking in (motion, both):
                history = follow(model, shaking, eta=0.9, most_kept=20)
                yield from (history.phi, history.rate, history.impacts)
                yield np.array([getattr(history, name) for name in OUTCOME_FIELDS], dtype=np.float64)


def pages(_quick: bool) -> float:
    """Return 0 if the library of pages is the one that was shipped. Raises `BrokenKernels` if it is not."""
    from rocking_cli.dynamics import shipped  # some builds of Python have no ctypes

    shipped.for_pages()
    return 0.0
