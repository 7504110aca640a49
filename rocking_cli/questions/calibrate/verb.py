"""`rk.calibrate`: find the restitution of a structure from a trace of free rocking, or from shake-table tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import cos, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.ground_motions import ReadingArguments
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.errors import InputError, Problem
from rocking_cli.questions.score.verb import motions_of, tests_of
from rocking_cli.studies.neighbours import Neighbourhood

if TYPE_CHECKING:
    from rocking_cli.questions.calibrate.region import JointRegion
    from rocking_cli.questions.calibrate.study import TraceFit
    from rocking_cli.questions.calibrate.trace import Trace
    from rocking_cli.questions.score.table import ObservedTest, TableOfTests
    from rocking_cli.structure import Structure

# Default ranges of slenderness and restitution in the grid, and default numbers of its points and neighbours.
SLENDERNESS_RANGE, RESTITUTION_RANGE, GRID_POINTS, GRID_NEIGHBOURS = (0.7, 1.3), (0.7, 0.99), 9, 40
MIN_GRID_POINTS, MAX_GRID_POINTS = 3, 101


@takes_numbers
def calibrate(
    structure: StructureLike,
    *,
    free: str | Path | Trace | None = None,
    tests: str | Path | Mapping[str, Sequence[Any]] | TableOfTests | None = None,
    free_geometry: bool = False,
    slenderness: tuple[float, float] | None = None,
    restitution: tuple[float, float] | None = None,
    points: int | None = None,
    neighbours: int | None = None,
    out: str | Path | None = None,
    threads: int | None = None,
    usual: Mapping[str, Any] | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[ReadingArguments],
) -> Answer[TraceFit] | Answer[JointRegion]:
    """Find the restitution of a structure from a trace of free rocking, or its joint region from shake-table tests.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    free : str or Path, or Trace, optional
        Angle over time of a free-rocking test, a CSV file with the headings `time [s]` and `angle [deg]` or [rad].
    tests : str or Path, or mapping, optional
        Shake-table tests as in `score`, of which those of this structure are used. Give `free` or `tests`.
    free_geometry : bool
        Whether the trace also determines p and alpha; only of a free-standing block with alpha of 0.07 rad or more.
    slenderness, restitution : (float, float), optional
        Ranges of the grid for `tests`: factors on the slenderness of the structure, by default 0.7 to 1.3, and
        coefficients of restitution, by default 0.7 to 0.99.
    points : int, optional
        Number of values of each of them, 3 to 101, by default 9; with `tests` only.
    neighbours : int, optional
        Number of neighbours of each test at each point of the grid, at least 1, by default 40; with `tests` only.
    out : str or Path, optional
        Write a copy of the file of the structure with the fitted `restitution` and its scatter (`uncertainty`) to this
        YAML file, and with `free_geometry` width and height too; with `free` only.
    threads : int, optional
        Number of tests at a time; by default, one for each processor.
    usual : mapping of str to object, optional
        Options for records of `tests` that do not state their unit, interval or channel themselves.
    watch : Watcher
        Told how far the work is.
    **options
        How the records are read and corrected: see `rocking_cli.ask.ground_motions.ReadingArguments`.

    Returns
    -------
    Answer of TraceFit or JointRegion
        From a trace: `eta`, its `scatter` from impact to impact, `etas`, `release`, `offset`, `drift`. From tests:
        the log-likelihood over the grid, the `best` point and the `ranges` of the joint region of 90 %.

    Raises
    ------
    InputError
        If neither or both of `free` and `tests` are given, if a file is not valid, or if what is given does not
        determine the restitution: fewer than three impacts above the noise, a best point on the edge of the grid, ...
    MechanismError
        If the structure has no critical rotation.
    """
    if (free is None) == (tests is None):
        raise InputError("give either `free`, a trace of free rocking, or `tests`, a table of shake-table tests")
    ready = structure_of(structure, watch)
    source = Path(ready.file) if ready.file is not None else None
    if free is not None:
        of_tests: dict[str, object] = {
            "slenderness": slenderness, "restitution": restitution, "points": points, "neighbours": neighbours,
            "threads": threads, **options,
        }  # fmt: skip
        if idle := [f"`{name}`" for name, value in of_tests.items() if value is not None]:
            verb = "has" if len(idle) == 1 else "have"
            raise InputError(f"{', '.join(idle)} {verb} no effect on a trace (`free`): give `tests`")
        return _of_trace(ready, source, free, free_geometry, out)
    assert tests is not None
    for name, is_given in (("free_geometry", free_geometry), ("out", out is not None)):
        if is_given:
            raise InputError(
                f"`{name}` requires a trace (`free`): outcomes alone leave slenderness and restitution open"
            )
    table = tests_of(tests)
    kept = _of_structure(table, source)
    axes = (("slenderness", slenderness or SLENDERNESS_RANGE), ("restitution", restitution or RESTITUTION_RANGE))
    grid = [_grid(name, ends, GRID_POINTS if points is None else points) for name, ends in axes]
    around = Neighbourhood(GRID_NEIGHBOURS if neighbours is None else neighbours)
    from rocking_cli.questions.calibrate.region import joint_region
    from rocking_cli.questions.calibrate.view import region_columns, region_view

    with watch.progress(len(kept), "tests") as advance:
        region = joint_region(
            kept, ready, motions_of(table, options, usual), around, *grid,
            threads=threads, progress=advance,
        )  # fmt: skip
    shown = region_view(region, ready.name, table.file, len(table.tests))
    figure = drawn("questions.calibrate.picture.draw_region", region, ready.name)
    return Answer("calibrate", region, shown, partial(region_columns, region), figure)


def _of_trace(
    ready: Structure, source: Path | None, free: str | Path | Trace, free_geometry: bool, out: str | Path | None
) -> Answer[TraceFit]:
    """Fit a trace, and write the structure with what was fitted."""
    from rocking_cli.questions.calibrate.study import fit_trace
    from rocking_cli.questions.calibrate.trace import Trace, read_trace
    from rocking_cli.questions.calibrate.view import trace_columns, trace_view

    trace = free if isinstance(free, Trace) else read_trace(Path(free))
    fit = fit_trace(ready, trace, free_geometry=free_geometry)
    ready.with_eta(fit.eta.value)  # raises an error if the structure cannot have this restitution
    if out is not None:
        if source is None:
            raise InputError(Problem("needs the file of the structure, of which it is a copy", field="`out`"))
        _write(ready, source, Path(out), fit)
    figure = drawn("questions.calibrate.picture.draw_trace", fit, ready.name)
    return Answer("calibrate", fit, trace_view(fit, ready), partial(trace_columns, fit), figure)


def _write(structure: Structure, source: Path, out: Path, found: TraceFit) -> None:
    """Write a copy of the file of a structure with the fitted restitution and its scatter."""
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.io.files import keep_apart, write_whole
    from rocking_cli.io.yaml_file import read_text, with_fields
    from rocking_cli.structure import Structure

    keep_apart([("`out`", out)], [str(source), found.trace.name])
    mechanism = structure.mechanism
    deviation = mechanism.uncertainty.slenderness if mechanism.uncertainty is not None else None
    uncertainty = {"slenderness": deviation, "restitution": round(found.scatter, 4)}
    words = ", ".join(f"{key}: {value:g}" for key, value in uncertainty.items() if value is not None)
    where = f"fitted to {Path(found.trace.name).name}, {len(found.etas)} impacts"
    fields = {
        "restitution" if mechanism.rocks_both_ways else "rebound": f"{found.eta.value:.4f}  # {where}",
        "uncertainty": f"{{{words}}}  # restitution: scatter from impact to impact, drawn towards {MEASURED_SPREAD:g}",
    }
    if found.p is not None and found.alpha is not None:
        size = 1.5 * mechanism.gravity / found.p.value**2  # 2R of a uniform block
        for name, length in (("width", size * sin(found.alpha.value)), ("height", size * cos(found.alpha.value))):
            fields[name] = f"{length:.5g}  # of a uniform block with p and alpha as {where}"
    text = with_fields(read_text(source, "structure"), fields, str(source))
    # Read the new file text back, to check what a user of the file will get.
    written = Structure(parse_structure(text, str(out), structure.name)).equivalence.positive
    if found.p is not None and found.alpha is not None:
        for one, other in ((written.p, found.p.value), (written.phi_cr, found.alpha.value)):
            if abs(one / other - 1) > 1e-3:
                what = f"cannot be written: no width and height give p = {found.p.value:.4g} rad/s and alpha = "
                raise InputError(Problem(f"{what}{found.alpha.value:.4g} rad with the other fields", field="`out`"))
    write_whole(out, lambda file: file.write(text.encode("utf-8")))


def _of_structure(table: TableOfTests, source: Path | None) -> Sequence[ObservedTest]:
    """Return the tests of a structure: those that name its file, or all of a structure without a file."""
    if source is None:
        return table.tests
    kept = [each for each in table.tests if (table.folder / each.structure).resolve() == source.resolve()]
    if not kept:
        names = list(dict.fromkeys(each.structure for each in table.tests))
        what = f"no test is of {source}: its structures are {', '.join(names[:5])}{', ...' * (len(names) > 5)}"
        raise InputError(Problem(what, table.file))
    return kept


def _grid(name: str, ends: tuple[float, float], points: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the values of one axis of the grid. Raises `InputError`."""
    low, high = ends
    if not MIN_GRID_POINTS <= points <= MAX_GRID_POINTS:
        raise InputError(
            Problem(f"must be from {MIN_GRID_POINTS} to {MAX_GRID_POINTS}, got {points}", field="`points`")
        )
    if not (0 < low < high and (name != "restitution" or high <= 1)):
        what = "from above 0 to 1" if name == "restitution" else "above 0"
        raise InputError(Problem(f"must be two increasing numbers {what}, got {low:g} and {high:g}", field=f"`{name}`"))
    return np.geomspace(low, high, points) if name == "slenderness" else np.linspace(low, high, points)
