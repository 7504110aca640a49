"""`rk.verify`: verify a rocking mechanism of masonry by a code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import SiteLike, StructureLike, language_of, site_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, each_of, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.names import OPENING
from rocking_cli.verification.results import Verification

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.processing.listed import Scaled
    from rocking_cli.structure import Structure


MotionSet = Motion | Motions | Sequence[Motion]
"""Ground motions of one limit state."""


@takes_numbers
def verify(
    structure: StructureLike,
    site: SiteLike,
    *,
    strengthened: StructureLike | None = None,
    control: tuple[float, float] | tuple[float, float, str | None] | None = None,
    motions: MotionSet | Mapping[str, MotionSet] = (),
    polarity: str | int = "1",
    state: str | None = None,
    on_floor: bool = False,
    opening: float = OPENING,
    sheet: str | Path | None = None,
    language: str | None = None,
    project: str | None = None,
    place: str | None = None,
    client: str | None = None,
    author: str | None = None,
    logo: str | Path | None = None,
    every_step: bool = False,
    in_short: bool = False,
    origin: str | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Verification]:
    """Verify a rocking mechanism of masonry by a code, such as the Italian: NTC 2018 and Circolare 7/2019.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    site : mapping, str or Path
        Fields of a site file, or the file.
    strengthened : Mechanism, str or Path, optional
        The strengthened structure, or its file: it is verified in the same way, and compared with `structure`.
    control : tuple, optional
        Control point x, y [m], and the body it is on; by default the centroid of the moving weights.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these; or a mapping of str to these
        Motions of the dynamic method: records that match the spectrum of the site. An unknown outcome does not pass.
        A mapping has a set for each limit state, such as `{"SLV": "slv/set.yaml", "SLC": "slc/set.yaml"}`.
    polarity : {"1", "-1", "both"}
        Polarity of the motions: as given, reversed, or both, of which the worse governs.
    state : str, optional
        Limit state to which a single set of motions belongs, such as `"SLC"`; by default SLV. A set is checked against
        its limit state alone.
    on_floor : bool
        Whether the motions are those of the floor of the site; if not, ground motions are carried to it.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    sheet : str or Path, optional
        File for the calculation sheet: .html, or .docx and .pdf with extra packages (a browser does for .pdf).
    language : {"en", "it"}, optional
        Language of the answer and of the sheet; by default that of the site.
    project, place, client, author, logo : str, str, str, str, path, optional
        Entries for the heading of the sheet, and a picture in .png, .jpg or .svg.
    every_step : bool
        Whether the answer lists every line of the calculation.
    in_short : bool
        Whether the answer shows only what is needed to judge the verdict; its data are the same.
    origin : str, optional
        What the sheet says of how it was made; by default this function and the structure.
    watch : Watcher
        Told what was read and written, how far the work is, and which of several motions cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

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

    signs, known = signs_of(polarity), site_of(site)
    requested = _sets(motions, state, options)
    if not requested and (state is not None or on_floor):
        raise InputError("`state` and `on_floor` describe records: give `motions`")
    if not requested and signs != (1,):
        raise InputError("`polarity` reverses a ground motion: give `motions`")
    if not requested:
        refuse_idle("without ground motions", opening=opening != OPENING)
    if sheet is None:
        head = {"project": project, "place": place, "client": client, "author": author, "logo": logo}
        refuse_idle("without a calculation sheet: give `sheet`", **head)
    language = language_of(language, known, watch)
    refuse(known, control=control is not None, motions=bool(requested))
    if sheet is not None:
        from rocking_cli.questions.verify import sheets

        sheets.check(Path(sheet), known, language)
    ready = structure_of(structure, watch, opening)
    other = None if strengthened is None else structure_of(strengthened, watch, opening)
    for one in filter(None, (ready, other)):
        for each in questioned(one, known):
            watch.warn(f"{one.name}: {each.name} {each.words}")
    sets: dict[str | None, list[Scaled]] = {}
    for key, given in requested.items():
        if isinstance(motions, Mapping):
            watch.note(f"records of {key}:")
        sets[key] = given.gather(ready.growth, watch)
    chosen = [one for each in sets.values() for one in each]

    def verified(one: Structure, advance: Callable[[int], object]) -> Verification:
        result = study(one, known, None if control is None else control_at(one.mechanism, *control))
        for key, each in sets.items():
            histories = Histories(each, signs, key, on_floor, advance, requested[key].refused(each))
            result = with_histories(result, one, known, histories)
        return result

    with watch.progress(len(chosen) * (1 if other is None else 2), "records") as advance:
        verification = verified(ready, advance)
        if other is not None:
            verification = code_of(known).strengthened(verification, verified(other, advance), known.site)
    if sheet is not None:
        source = sheets.SheetOrigin.of(origin or "rocking_cli.verify(...)", ready, other)
        title = sheets.Head(project, place, client, author, logo).block(source, language)
        content = sheets.sheet_for(verification, known, site, chosen, language, title, source)
        try:
            sheets.write(Path(sheet), content, watch)
        except RockingError as error:
            watch.unwritten(error)
    shown = view(verification, known.site.name, language=language, every_step=every_step, in_short=in_short)
    figure = partial(_figure, verification, language)
    return Answer("verification", verification, shown, partial(table, verification), figure)


def _sets(
    given: MotionSet | Mapping[str, MotionSet], state: str | None, options: MotionArguments
) -> dict[str | None, Motions]:  # fmt: skip
    """Return the set of motions of each limit state, None for the default one; empty without motions."""
    if not isinstance(given, Mapping):
        motions = Motions.of(given, options)
        return {state: motions} if motions else {}
    if state is not None:
        hint = "leave it out"
        raise InputError(Problem("cannot be combined with motions of each limit state", field="`state`", hint=hint))
    empty = [key for key, each in given.items() if not isinstance(each, Motions) and not each_of(each)]
    if empty or not given:
        raise InputError(Problem(f"has no ground motion for {empty[0] if empty else 'any state'}", field="`motions`"))
    return {key: Motions.of(each, options) for key, each in given.items()}


def _figure(found: Verification, language: str) -> Figure:
    from rocking_cli.views.verification import showing

    return showing(found).in_language(language).draw(found)
