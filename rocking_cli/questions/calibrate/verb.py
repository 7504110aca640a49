"""`rk.calibrate`: find the restitution of a structure from a trace of its free rocking."""

from __future__ import annotations

from functools import partial
from math import cos, sin
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.calibrate.asked import CalibrateAsked

if TYPE_CHECKING:
    from rocking_cli.questions.calibrate.study import TraceFit
    from rocking_cli.structure import Structure


@verb(CalibrateAsked)
def calibrate(asked: CalibrateAsked, watch: Watcher) -> Answer[TraceFit]:
    """Find the restitution of a structure from a trace of its free rocking.

    Returns
    -------
    Answer of TraceFit
        `eta`, its `scatter` from impact to impact, `etas`, `release`, `offset`, `drift`.

    Raises
    ------
    InputError
        If a file is not valid, or if the trace does not determine the restitution, such as by fewer than three impacts
        above the noise.
    MechanismError
        If the structure has no critical rotation.
    """
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.calibrate.study import Trace, fit_trace, read_trace
    from rocking_cli.questions.calibrate.view import trace_columns, trace_view

    structure = structure_of(asked.structure, watch)
    trace = asked.free if isinstance(asked.free, Trace) else read_trace(Path(asked.free))
    if asked.out is not None:
        if structure.file is None:
            raise InputError(Problem("needs the file of the structure, of which it is a copy", field=named("out")))
        keep_apart([(named("out"), asked.out)], [structure.file, trace.name])
    fit = fit_trace(structure, trace, free_geometry=asked.free_geometry)
    structure.under(restitution=fit.eta.value)  # raises an error if the structure cannot have this restitution
    if asked.out is not None and structure.file is not None:
        _write(structure, Path(structure.file), asked.out, fit)
        watch.note(f"wrote {asked.out}")
    figure = drawn("questions.calibrate.view.draw_trace", fit, structure.name)
    return Answer("calibrate", fit, trace_view(fit, structure), partial(trace_columns, fit), figure)


def _write(structure: Structure, source: Path, out: Path, found: TraceFit) -> None:
    """Write a copy of the file of a structure with the fitted restitution and its scatter."""
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.io.files import write_whole
    from rocking_cli.io.yaml_file import read_text, with_fields
    from rocking_cli.structure import Structure

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
