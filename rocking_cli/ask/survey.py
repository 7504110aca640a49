"""Surveys of many structures, and design of one structure, in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, StructureLike, each_of, motion_of, structure_of
from rocking_cli.ask.verification import _site

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.design import Design
    from rocking_cli.studies.survey import Survey, SurveyEntry

Table = str | Path | Mapping[str, Sequence[Any]]
"""CSV file, or columns by their headings."""


def survey(
    structures: Table | Sequence[StructureLike],
    motions: Motion | Sequence[Motion] = (),
    *,
    scale: float = 1.0,
    polarities: Sequence[int] = (1,),
    site: Mapping[str, Any] | str | Path | None = None,
    threads: int | None = None,
) -> Answer[Survey]:
    """Rank many structures by vulnerability.

    Parameters
    ----------
    structures : str or Path, or mapping, or sequence of Mechanism, str or Path
        A table of structures as a CSV file, or its columns by their headings (a frame of pandas is one); or structures,
        or their YAML files.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions; without any, the structures are ranked by their uplift acceleration.
    scale : float
        Scale factor on the motions.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.
    site : mapping, str or Path, optional
        Fields of a site file, or the file: each structure is verified by its code and ranked by the ratio of capacity
        to demand.
    threads : int, optional
        Number of structures at a time; by default, one for each processor.

    Returns
    -------
    Answer of Survey
        `rows` are the ranked structures, `bad` the unusable ones with their reasons.

    Raises
    ------
    InputError
        If the table or a motion cannot be used.

    Notes
    -----
    The blocks are those of DeJong and Dimitrakopoulos (2014), Section 3; see `equiv`.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> table = {"mechanism": ["block", "block"], "name": ["a", "b"], "width [mm]": [500, 300], "height": [2, 2]}
    >>> [row.name for row in rk.survey(table).rows]
    ['b', 'a']
    """
    from rocking_cli.studies.survey import survey as study
    from rocking_cli.views.survey import columns, title, view

    shaken = [motion_of(each).scaled(scale) for each in each_of(motions)]
    where = _site(site) if site is not None else None
    found = study(_entries(structures), shaken, polarities, site=where, threads=threads)

    def figure() -> Figure:
        from rocking_cli.plotting.survey import draw_survey

        return draw_survey(found, title(found))

    return Answer("survey", found, view(found), lambda: columns(found), figure)


def _entries(given: Any) -> Sequence[SurveyEntry]:
    from rocking_cli.studies.structure_table import StructureTable, of_mapping
    from rocking_cli.studies.survey import MadeStructure

    if isinstance(given, str | Path):
        return StructureTable.read(Path(given))
    if isinstance(given, Mapping) or hasattr(given, "columns"):
        return of_mapping(given)
    return [MadeStructure(structure_of(each).mechanism) for each in given]


def design(
    structure: StructureLike,
    vary: str | tuple[str, float, float],
    until: str,
    motions: Motion | Sequence[Motion] = (),
    *,
    scale: float = 1.0,
    polarities: Sequence[int] = (1,),
    neighbours: int = 200,
    site: Mapping[str, Any] | str | Path | None = None,
    points: int = 41,
) -> Answer[Design]:
    """Find the values of one field for which a structure meets a requirement.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    vary : str, or (str, float, float)
        Field and its range, such as `"width=0.2m:0.8m"`, or `("ties.bar.prestress", 0.0, 5e4)` in the unit of the
        field. An entry of a list is given by its number, from 0, or its name.
    until : str
        The requirement, such as `"lambda >= 0.2"`: a metric, `<`, `<=`, `>` or `>=`, and a number. The metrics are
        `lambda`, `phi_cr`, `p`, `alpha0`, with motions `peak_ratio` and `overturned`, of their neighbours, and with a
        site `ratio`, and `zeta_damage`, `zeta_linear` and `zeta_nonlinear` or the numbers of another code. A neighbour
        of unknown outcome counts as overturning.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions; the worst one governs.
    scale : float
        Scale factor on the motions.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.
    neighbours : int
        Number of neighbours of each motion to simulate.
    site : mapping, str or Path, optional
        Fields of a site file, or the file.
    points : int
        Number of values in the first scan.

    Returns
    -------
    Answer of Design
        `value` is the least value from which the requirement holds, or the largest up to which it holds; `holds` are
        the ranges in which it holds.

    Raises
    ------
    InputError
        If the field or metric does not exist, or the metric requires ground motions.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> round(rk.design(rk.Block(width=0.5, height=2.0), "width=0.2m:0.8m", "lambda >= 0.2").value, 9)
    0.4
    """
    from rocking_cli.studies.design import Aim, Span
    from rocking_cli.studies.design import design as study
    from rocking_cli.studies.metrics import Excitation
    from rocking_cli.studies.neighbours import Neighbourhood
    from rocking_cli.views.design import columns, view

    ready = structure_of(structure)
    span = Span.parse(vary) if isinstance(vary, str) else Span(vary[0], repr(float(vary[1])), repr(float(vary[2])))
    shaken = [motion_of(each).scaled(scale) for each in each_of(motions)]
    where = _site(site) if site is not None else None
    excitation = (
        Excitation(shaken, polarities, Neighbourhood(neighbours), where) if shaken or where is not None else None
    )
    found = study(
        ready, span.field, span.in_unit(ready.unit_of(span.field)), Aim.parse(until), excitation, points=points
    )

    def figure() -> Figure:
        from rocking_cli.plotting.design import draw_design

        return draw_design(found)

    return Answer("design", found, view(found, excitation), lambda: columns(found), figure)
