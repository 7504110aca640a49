"""`rk.design`: find the values of a field for which a structure meets a requirement."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Unpack

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import SiteLike, StructureLike, site_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.core.plausible import doubts
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.names import OPENING
from rocking_cli.questions.design.metrics import Excitation, Metric
from rocking_cli.questions.design.study import SCAN_POINTS, Aim, Design, Span
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.text import cut


@takes_numbers
def design(
    structure: StructureLike,
    vary: Span | str | tuple[str, float | str, float | str],
    until: Aim | str,
    motions: Motion | Motions | Sequence[Motion] = (),
    *,
    polarity: str | int = "1",
    neighbours: int = Neighbourhood.count,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    site: SiteLike | None = None,
    points: int = SCAN_POINTS,
    opening: float = OPENING,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Design]:
    """Find the values of one field for which a structure meets a requirement.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    vary : str, or (str, float or str, float or str)
        Field and its range, such as `"width=0.2m:0.8m"` or `("width", "0.2m", 0.8)`, numbers in the unit of the
        field. An entry of a list is given by its number, from 0, or its name.
    until : str
        The requirement, such as `"lambda >= 0.2"`: a metric, `<`, `<=`, `>` or `>=`, and a number, or `required` for
        what the code of the site requires of the structure after the change. The metrics are
        `lambda`, `phi_cr`, `p`, `alpha0`, with motions `peak_ratio`, `peak_displacement`, `drift`, `tie_force` and
        `overturned`, of their neighbours, and with a site `ratio`, and `zeta_SLD`, `zeta_SLV`, `zeta_SLC`,
        `zeta_damage`, `zeta_linear` and `zeta_nonlinear` or the numbers of another code. A neighbour of unknown outcome
        counts as overturning.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions; the worst one governs.
    polarity : {"1", "-1", "both"}
        Polarity of the motions: as given, reversed, or both, of which the worse governs.
    neighbours : int
        Number of neighbours of each motion to simulate, at least 1.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    site : mapping, str or Path, optional
        Fields of a site file, or the file.
    points : int
        Number of values in the first scan.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told what was read, how far the work is, what is doubtful, and which of several motions cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of Design
        `value` is the least value from which the requirement holds, or the largest up to which it holds; `holds` are
        the ranges in which it holds, and `steel` the bars of a tie whose force varies.

    Raises
    ------
    InputError
        If the field or metric does not exist, or the metric requires ground motions or a site, or does not depend on
        those that are given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> round(rk.design(rk.Block(width=0.5, height=2.0), "width=0.2m:0.8m", "lambda >= 0.2").value, 9)
    0.4
    """
    from rocking_cli.questions.design.study import design as study
    from rocking_cli.questions.design.view import columns, view
    from rocking_cli.verification.check import questioned

    aim = until if isinstance(until, Aim) else Aim.parse(until)
    span = _span(vary)
    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    signs, requested = signs_of(polarity), Motions.of(motions, options)
    if not aim.metric.shaken:
        refuse_idle(
            f"on {aim.metric.name}, which does not depend on a ground motion",
            polarity=signs != (1,),
            opening=opening != OPENING,
            neighbours=neighbours != Neighbourhood.count,
            amplitude_deviation=amplitude_deviation != Neighbourhood.amplitude,
            slenderness_deviation=slenderness_deviation,
            restitution_deviation=restitution_deviation,
        )
    _check(aim.metric, motions=bool(requested), neighbours=neighbours, site=site is not None)
    ready = structure_of(structure, watch, opening)
    ends = span.in_unit(ready.unit_of(span.field))
    _warn_of_sizes(ready, span.field, ends, watch)
    where = site_of(site) if site is not None else None
    for each in questioned(ready, where) if where is not None else ():
        watch.warn(f"{ready.name}: {each.name} {each.words}")
    shaken = [each.motion.scaled(each.factor) for each in requested.gather(ready.growth, watch)] if requested else []
    excitation = Excitation(shaken, signs, around, where) if requested or where is not None else None
    with watch.progress(points, "values") as advance:
        result = study(ready, span.field, ends, aim, excitation, points=points, progress=advance)
    figure = drawn("questions.design.picture.draw_design", result)
    return Answer("design", result, view(result, excitation), partial(columns, result), figure)


def _span(given: object) -> Span:
    match given:
        case Span():
            return given
        case str():
            return Span.parse(given)
        case (str() as field, low, high):
            return Span(field, str(low), str(high))
    what = f"must be FIELD=LOW:HIGH or (field, low, high), got {cut(repr(given))}"
    raise InputError(Problem(what, field="`vary`", hint="such as width=0.2m:0.8m"))


def _check(metric: Metric, *, motions: bool, neighbours: int, site: bool) -> None:
    """Raise `InputError` if a metric lacks motions, neighbours or a site, or does not depend on those given."""
    if metric.shaken and not motions:
        raise InputError(Problem(f"{metric.name} needs a ground motion", hint="give `motions`"))
    if motions and not metric.shaken:
        raise InputError(Problem(f"{metric.name} does not depend on a ground motion", hint="leave out `motions`"))
    if metric.shaken and not neighbours:
        raise InputError(f"{metric.name} is computed from neighbouring motions: `neighbours` must be at least 1")
    if metric.sited and not site:
        hint = "give the file of a site: `rocking new site` prints one"
        raise InputError(Problem(f"{metric.name} requires a site", field="`site`", hint=hint))
    if site and not metric.sited:
        raise InputError(Problem(f"{metric.name} does not depend on the site", hint="leave out `site`"))


def _warn_of_sizes(structure: Structure, field: str, span: tuple[float, float], watch: Watcher) -> None:
    """Warn if a range looks as if it were given in another unit."""
    known = doubts(structure.mechanism)
    for value in span:
        try:
            odd = doubts(structure.varied(field, value).mechanism)
        except RockingError:  # the scan lists the values that cannot be built
            continue
        for doubt in (each for each in odd if each not in known):
            watch.warn(f"at {f'{field} = {value:g} {structure.unit_of(field)}'.strip()}: {doubt}")
