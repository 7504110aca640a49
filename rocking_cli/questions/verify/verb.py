"""`rk.verify`: verify a rocking mechanism of masonry by a code."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.inputs import language_of, site_of, structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import RockingError, named
from rocking_cli.questions.verify.asked import VerifyAsked
from rocking_cli.verification.results import Verification

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.processing.reading import Scaled
    from rocking_cli.structure import Structure


@verb(VerifyAsked)
def verify(asked: VerifyAsked, watch: Watcher) -> Answer[Verification]:
    """Verify a rocking mechanism of masonry by a code, such as the Italian: NTC 2018 and Circolare 7/2019.

    Returns
    -------
    Answer of Verification
        `directions` holds the results of each direction, with `methods`, `states` and `workings`.

    Raises
    ------
    InputError
        If the site, the control point or a file cannot be used, or the structure has no capacity curve.
    MechanismError
        If the structure is not stable at rest.
    SolverError
        If a motion cannot be simulated to its end.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    >>> answer = rk.verify(rk.Block(width=0.6, height=8.0), site)
    >>> round(answer.directions[rk.Direction.POSITIVE].counts.a_g, 6)
    0.193382
    """
    from rocking_cli.verification.check import code_of, questioned, refuse, with_histories
    from rocking_cli.verification.check import verify as study
    from rocking_cli.verification.results import Histories, control_at
    from rocking_cli.views.verification import table, view

    known, requested = site_of(asked.site), asked.requested
    language = language_of(asked.language, known, watch)
    refuse(known, control=asked.control is not None, motions=bool(requested))
    if asked.sheet is not None:
        from rocking_cli.questions.verify import sheets

        sheets.check(asked.sheet, known, language)
    ready = structure_of(asked.structure, watch, asked.opening)
    other = None if asked.strengthened is None else structure_of(asked.strengthened, watch, asked.opening)
    for one in filter(None, (ready, other)):
        for each in questioned(one, known):
            watch.warn(f"{one.name}: {each.name} {each.words}")
    sets: dict[str | None, list[Scaled]] = {}
    for key, given in requested.items():
        if asked.sets:
            watch.note(f"records of {key}:")
        sets[key] = given.gather(ready.growth, watch)
    chosen = [one for each in sets.values() for one in each]

    def verified(one: Structure, advance: Callable[[int], object]) -> Verification:
        result = study(one, known, None if asked.control is None else control_at(one.mechanism, *asked.control))
        for key, each in sets.items():
            refused = requested[key].refused(each)
            result = with_histories(
                result, one, known, Histories(each, asked.signs, key, asked.on_floor, advance, refused)
            )
        return result

    with watch.progress(len(chosen) * (1 if other is None else 2), "records") as advance:
        verification = verified(ready, advance)
        if other is not None:
            verification = code_of(known).strengthened(verification, verified(other, advance), known.site)
    if asked.sheet is not None:
        source = sheets.SheetOrigin.of(asked.origin or "rocking_cli.verify(...)", ready, other)
        title = asked.title(source.command, language)
        content = sheets.sheet_for(verification, known, asked.site, chosen, language, title, source)
        try:
            sheets.write(asked.sheet, content, watch)
        except RockingError as error:
            watch.unwritten(error)
    in_short = not (asked.in_full or watch.in_detail)
    if in_short and not watch.as_json:
        watch.note(f"{named('in_full')} shows also the ground, both curves, every clause, and the remarks in full")
    shown = view(verification, known.site.name, language=language, every_step=watch.in_detail, in_short=in_short)
    figure = partial(_figure, verification, language)
    return Answer("verification", verification, shown, partial(table, verification), figure)


def _figure(found: Verification, language: str) -> Figure:
    from rocking_cli.views.verification import showing

    return showing(found).in_language(language).draw(found)
