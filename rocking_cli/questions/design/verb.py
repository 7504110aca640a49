"""`rk.design`: find the values of a field for which a structure meets a requirement."""

from __future__ import annotations

from functools import partial
from typing import cast

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import site_of, structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core.plausible import doubts
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.questions.design.asked import DesignAsked
from rocking_cli.questions.design.metrics import Excitation, Metric
from rocking_cli.questions.design.study import Aim, Design, Span
from rocking_cli.structure import Structure


@verb(DesignAsked)
def design(asked: DesignAsked, watch: Watcher) -> Answer[Design]:
    """Find the values of one field for which a structure meets a requirement.

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

    aim, span, requested = cast("Aim", asked.until), cast("Span", asked.vary), asked.ground_motions
    _check(aim.metric, motions=bool(requested), site=asked.site is not None)
    ready = structure_of(asked.structure, watch, asked.opening)
    ends = span.in_unit(ready.unit_of(span.field))
    _warn_of_sizes(ready, span.field, ends, watch)
    where = site_of(asked.site) if asked.site is not None else None
    for each in questioned(ready, where) if where is not None else ():
        watch.warn(f"{ready.name}: {each.name} {each.words}")
    shaken = [each.motion.scaled(each.factor) for each in requested.gather(ready.growth, watch)] if requested else []
    around = asked.neighbourhood(asked.neighbours)
    excitation = Excitation(shaken, asked.signs, around, where)
    with watch.progress(asked.points, "values") as advance:
        result = study(ready, span.field, ends, aim, excitation, points=asked.points, progress=advance)
    figure = drawn("questions.design.picture.draw_design", result)
    return Answer("design", result, view(result, excitation), partial(columns, result), figure)


def _check(metric: Metric, *, motions: bool, site: bool) -> None:
    """Raise `InputError` if a metric lacks motions or a site, or does not depend on those given."""
    if metric.shaken and not motions:
        raise InputError(Problem(f"{metric.name} needs a ground motion", hint=f"give {named('motions')}"))
    if motions and not metric.shaken:
        hint = f"leave out {named('motions')}"
        raise InputError(Problem(f"{metric.name} does not depend on a ground motion", hint=hint))
    if metric.sited and not site:
        hint = "give the file of a site: `rocking new site` prints one"
        raise InputError(Problem(f"{metric.name} requires a site", field=named("site"), hint=hint))
    if site and not metric.sited:
        raise InputError(Problem(f"{metric.name} does not depend on the site", hint=f"leave out {named('site')}"))


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
