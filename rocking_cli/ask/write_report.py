"""`rk.write_report`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, StructureLike, _read, each_of, structure_of, yaml_of
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns


def write_report(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] = (),
    file: str | Path = "report.html",
    *,
    polarities: Sequence[int] = (1, -1),
    project: str | None = None,
    place: str | None = None,
    author: str | None = None,
) -> Answer[Any]:
    """Write a report: one HTML file that opens in any browser and can be printed.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions
        None, one or several, as for `respond`.
    file : str or Path
        File to write.
    polarities : sequence of int
        Polarities, of 1 and -1.
    project, place, author : str, optional
        Entries for the heading of the report.

    Returns
    -------
    Answer of Assessment
        Contents of the report.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be read or written.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The report contains the results of `equiv`, `respond`, `margin`, `overturning_map` and `linearisation`.
    """
    from datetime import UTC, datetime

    from rocking_cli.io.files import check_writable, write_whole
    from rocking_cli.report.page import render
    from rocking_cli.studies.assessment import File, TitleBlock, gather
    from rocking_cli.views.assessment import view

    check_writable(Path(file))
    ready = structure_of(structure)
    text = Path(ready.file).read_bytes() if ready.file is not None else yaml_of(ready.mechanism).encode()
    given = [_scaled(each) for each in each_of(motions)]
    today = datetime.now(UTC).strftime("%d %B %Y").lstrip("0")
    found = gather(
        ready,
        File(ready.file or ready.name, text),
        given,
        polarities,
        title=TitleBlock("rocking_cli.write_report(...)", today, project, place, author),
    )
    page = render(found).encode()
    write_whole(Path(file), lambda stream: stream.write(page))

    def columns() -> Columns:
        runs = [(each.given.motion.name, each.histories["nonlinear"]) for each in found.results]
        return {
            "motion": [name for name, _ in runs],
            "peak_ratio": [run.peak_ratio for _, run in runs],
            "overturned": [None if run.unknown else run.overturned for _, run in runs],
            "unknown": [run.unknown for _, run in runs],
        }

    def figure() -> Figure:
        from rocking_cli.plotting.structure import draw_structure

        return draw_structure(found.picture, heading(ready.mechanism))

    return Answer("report", found, view(found), columns, figure)


def _scaled(given: Motion) -> Scaled:
    if isinstance(given, Scaled):
        return given
    read = _read(given)
    if isinstance(read, Pulse):
        return Scaled(read.sampled(), 1.0, pulse=read)
    return Scaled(read, 1.0, file=None if isinstance(given, GroundMotion | Pulse) else Path(given))
