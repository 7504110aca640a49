"""`rk.calibrate`: find the restitution of a structure from a trace of free rocking, or from shake-table tests."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import cos, sin
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.calibrate.asked import CalibrateAsked
from rocking_cli.questions.score.verb import motions_of, tests_of
from rocking_cli.studies.neighbours import Neighbourhood

if TYPE_CHECKING:
    from rocking_cli.questions.calibrate.region import JointRegion
    from rocking_cli.questions.calibrate.study import TraceFit
    from rocking_cli.questions.score.table import ObservedTest, TableOfTests
    from rocking_cli.structure import Structure


@verb(CalibrateAsked)
def calibrate(asked: CalibrateAsked, watch: Watcher) -> Answer[TraceFit] | Answer[JointRegion]:
    """Find the restitution of a structure from a trace of free rocking, or its joint region from shake-table tests.

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
    ready = structure_of(asked.structure, watch)
    source = Path(ready.file) if ready.file is not None else None
    return _of_tests(ready, source, asked, watch) if asked.free is None else _of_trace(ready, source, asked, watch)


def _of_tests(ready: Structure, source: Path | None, asked: CalibrateAsked, watch: Watcher) -> Answer[JointRegion]:
    """Return the joint region of the outcomes of tests."""
    from rocking_cli.questions.calibrate.region import joint_region
    from rocking_cli.questions.calibrate.view import region_columns, region_view

    assert asked.tests is not None
    table = tests_of(asked.tests)
    kept = _of_structure(table, source)
    grid = np.geomspace(*asked.slenderness, asked.points), np.linspace(*asked.restitution, asked.points)
    with watch.progress(len(kept), "tests") as advance:
        region = joint_region(
            kept, ready, motions_of(table, asked), Neighbourhood(asked.neighbours), *grid,
            threads=asked.jobs, progress=advance,
        )  # fmt: skip
    shown = region_view(region, ready.name, table.file, len(table.tests))
    figure = drawn("questions.calibrate.picture.draw_region", region, ready.name)
    return Answer("calibrate", region, shown, partial(region_columns, region), figure)


def _of_trace(ready: Structure, source: Path | None, asked: CalibrateAsked, watch: Watcher) -> Answer[TraceFit]:
    """Fit a trace, and write the structure with what was fitted."""
    from rocking_cli.questions.calibrate.study import fit_trace
    from rocking_cli.questions.calibrate.trace import Trace, read_trace
    from rocking_cli.questions.calibrate.view import trace_columns, trace_view

    assert asked.free is not None
    trace = asked.free if isinstance(asked.free, Trace) else read_trace(Path(asked.free))
    fit = fit_trace(ready, trace, free_geometry=asked.free_geometry)
    ready.under(restitution=fit.eta.value)  # raises an error if the structure cannot have this restitution
    if asked.out is not None:
        if source is None:
            raise InputError(Problem("needs the file of the structure, of which it is a copy", field=named("out")))
        _write(ready, source, asked.out, fit)
        watch.note(f"wrote {asked.out}")
    figure = drawn("questions.calibrate.picture.draw_trace", fit, ready.name)
    return Answer("calibrate", fit, trace_view(fit, ready), partial(trace_columns, fit), figure)


def _write(structure: Structure, source: Path, out: Path, found: TraceFit) -> None:
    """Write a copy of the file of a structure with the fitted restitution and its scatter."""
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.io.files import keep_apart, write_whole
    from rocking_cli.io.yaml_file import read_text, with_fields
    from rocking_cli.structure import Structure

    keep_apart([(named("out"), out)], [str(source), found.trace.name])
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
                raise InputError(
                    Problem(f"{what}{found.alpha.value:.4g} rad with the other fields", field=named("out"))
                )
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
