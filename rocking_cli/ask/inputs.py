"""Arguments of verbs: a structure or its file, a motion, its file or a pulse as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.ground_motions import type_in_words
from rocking_cli.ask.kinds import LOCAL_FILE
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.core.plausible import doubts
from rocking_cli.core.structure_file import default_name, parse_structure
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError, named, of_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.excitation.records.opening import STANDARD_INPUT, name_of, original
from rocking_cli.io.yaml_file import decoded, read_text
from rocking_cli.names import LANGUAGES, OPENING
from rocking_cli.structure import Structure, with_name
from rocking_cli.text import numbered, one_line
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.spreadsheet import Spreadsheet
    from rocking_cli.verification.code import SiteFile

StructureLike = Mechanism | Structure | Answer[Any] | str | Path
"""Mechanism, or its YAML file, "-" for standard input; a structure that was opened before, or an import of one."""
SiteLike = Mapping[str, Any] | str | Path
"""Fields of a site file, or the file."""
DEFAULT_STRUCTURE = "mechanism: block\nname: default block, 0.7 m x 2.8 m\nwidth: 0.7\nheight: 2.8\n"
# Numbers of polygons from which a structure is slow (about a second) and very slow, and the largest one timed.
MIN_SLOW_POLYGONS, MIN_VERY_SLOW_POLYGONS, MAX_TIMED_POLYGONS = 100, 500, 1000


def structure_of(
    given: StructureLike, watch: Watcher = SILENT, opening: float = OPENING, restitution: float | None = None
) -> Structure:
    """Open a mechanism (named by its kind if it has no name), or a file, as a structure; warn of doubts about it.

    Parameters
    ----------
    given : Mechanism, str or Path
        The structure, or its YAML file, "-" for standard input. One that was opened before is taken without warnings.
    watch : Watcher
        Told which file was read, and what is doubtful about the structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    restitution : float, optional
        Restitution of all impacts that is given for the run; by default that of the structure.

    Raises
    ------
    InputError
        If the file, the opening or the restitution is not valid.
    MechanismError
        If the plugin of the mechanism cannot be used.
    """
    if isinstance(given, Answer):
        given = getattr(given.result, "structure", given)
    if isinstance(given, Structure):
        return given.under(opening=opening, restitution=restitution)
    if isinstance(given, Mechanism):
        ready = Structure(with_name(given), opening=opening, restitution=restitution)
    elif isinstance(given, str | Path):
        ready = _read(given, watch).under(opening=opening, restitution=restitution)
    else:
        hint = "make one, such as rk.Block(width=0.7, height=2.8)"
        raise InputError(
            Problem(f"must be a mechanism or a YAML file, got {type_in_words(given)}", field="structure", hint=hint)
        )
    note_remarks(ready.mechanism, watch)
    warn_of(ready.mechanism, watch)
    return ready


def _read(given: str | Path, watch: Watcher) -> Structure:
    """Read a structure from its file."""
    if given is LOCAL_FILE and not LOCAL_FILE.exists():
        watch.note(f"structure: the default block, 0.7 m wide and 2.8 m high (no FILE given, no {LOCAL_FILE} here)")
        return Structure(parse_structure(DEFAULT_STRUCTURE, "default block", "default block"))
    if given is LOCAL_FILE:
        watch.note(f"structure: {LOCAL_FILE} of this folder")
    file, is_input = name_of(given), str(given) == STANDARD_INPUT
    text = decoded(original(given), file, "structure") if is_input else read_text(Path(given), "structure")
    count = text.count("polygon")
    announce = partial(watch.note, _what_blocks_take(count)) if count >= MIN_VERY_SLOW_POLYGONS else None
    name = "structure" if is_input else default_name(given)
    try:
        with watch.working(f"analysing {count} polygons") if count >= MIN_SLOW_POLYGONS else nullcontext():
            mechanism = parse_structure(text, file, name, checked=announce)
    except MechanismError as error:
        raise of_structure(error, file) from error
    place = file if is_input else Path(given).resolve()
    watch.detail(f"structure: {mechanism.name} ({mechanism.mechanism}), of {place}")
    return Structure(mechanism, file)


def _what_blocks_take(count: int) -> str:
    """Return how much time and memory the limit analysis of many blocks takes, in words."""
    if count <= MAX_TIMED_POLYGONS:
        return f"{count} polygons: up to about a minute and 250 MB; Ctrl-C stops it"
    minutes = round((count / 1000) ** 2)  # a minute for 1000 polygons
    least = "a minute" if minutes < 2 else f"{minutes} minutes" if minutes < 120 else f"{minutes / 60:.0f} hours"
    return (
        f"{count} polygons: {least} and {0.2 * count:.0f} MB at least, and perhaps many times as much, as no more than "
        f"{MAX_TIMED_POLYGONS} have been measured; Ctrl-C stops it"
    )


def structures_of(
    given: Sequence[StructureLike], watch: Watcher = SILENT, opening: float = OPENING,
    restitution: float | None = None, *, least: int = 1,
) -> list[Structure]:  # fmt: skip
    """Open several structures; those that cannot be used are left out. Files or numbers tell equal names apart.

    Raises
    ------
    InputError, MechanismError
        If fewer than the `least` number can be used; an `InputError` has the problems of all files.
    """
    ready: list[Structure] = []
    errors: list[InputError | MechanismError] = []
    for one in given:
        try:
            ready.append(structure_of(one, watch, opening, restitution))
        except (InputError, MechanismError) as error:
            errors.append(error)
    if errors and len(ready) < least:
        raise next((error for error in errors if isinstance(error, MechanismError)), joined(errors))
    for refused in errors:
        watch.leave_out(refused)
    names, used = [structure.name for structure in ready], list[str]()
    for k, structure in enumerate(ready):
        name = structure.name
        if names.count(name) > 1 and structure.file is not None:
            name = f"{name} ({one_line(Path(structure.file).name)})"
        name = numbered(name, "", used)
        used.append(name)
        if name != structure.name:
            ready[k] = structure.of(structure.mechanism.model_copy(update={"name": name}))
    return ready


def sheet_of(given: str | Path) -> Spreadsheet:
    """Read a table from its file, "-" for standard input. Raises `InputError`."""
    from rocking_cli.io.spreadsheet import parse_sheet, read_sheet

    return parse_sheet(original(given), name_of(given)) if str(given) == STANDARD_INPUT else read_sheet(Path(given))


def site_of(given: SiteLike) -> SiteFile:
    """Read the site for a code of practice from its file, or take its fields. Raises `InputError`."""
    from rocking_cli.io.yaml_file import parse
    from rocking_cli.verification.check import read_site, site_in
    from rocking_cli.verification.code import SITE_HINT

    if isinstance(given, Mapping):
        from rocking_cli.io.json_text import json_text

        return site_in(parse(json_text(given), "site", "site", SITE_HINT))
    return read_site(Path(given))


def language_of(asked: str | None, site: SiteFile | None, watch: Watcher = SILENT) -> str:
    """Return the language of an answer: as asked, or that of the site; the watcher is told in it from then on."""
    language = asked or (site.site.language if site is not None else None) or LANGUAGES[0]
    watch.speak(language)
    return language


def joined(errors: Sequence[RockingError]) -> InputError:
    """Return one error with the problems of several inputs."""
    return InputError(*(problem for error in errors if isinstance(error, InputError) for problem in error.problems))


def note_remarks(mechanism: Mechanism, watch: Watcher) -> None:
    """Note how the fields of a structure were read: weights as masses, openings at the edges of bricks."""
    for remark in mechanism.remarks:
        watch.note(f"{mechanism.name}: {remark}")


def warn_of(mechanism: Mechanism, watch: Watcher) -> None:
    """Warn of doubts about a structure."""
    if not mechanism.verified:
        watch.warn(f"the mechanism {mechanism.mechanism} has not been verified: check its results yourself")
    for doubt in doubts_of(mechanism):
        watch.warn(doubt)


def warn_misleading(structures: Sequence[Structure], watch: Watcher) -> None:
    """Warn of structures for which the linear models mislead."""
    for structure in structures:
        if structure.misleading is not None:
            watch.warn(f"{structure.name}: {structure.misleading}")


def sized_pulse(shape: str, ag: float | None, period: float | None) -> Pulse:
    """Return a pulse of an amplitude [standard gravity] and a period [s]. Raises `InputError`."""
    from rocking_cli.studies.under_pulses import parse_shape

    for name, value, example in (("ag", ag, "0.6g"), ("period", period, "0.8s")):
        if value is None:
            hint = f"such as {example}"
            raise InputError(Problem("is missing for a pulse on a structure", field=named(name), hint=hint))
    assert ag is not None and period is not None
    return replace(parse_shape(shape), amplitude=ag * STANDARD_GRAVITY, period=period)


def doubts_of(mechanism: Mechanism) -> list[str]:
    """Return the doubts about the sizes and places of a structure."""
    return [f"{mechanism.name}: {doubt}" for doubt in doubts(mechanism)]


def structure_figure(mechanism: Mechanism, found: Mapping[Direction, CollapseMechanism] | None = None) -> Figure:
    """Draw a structure; one without a rocking model as the mechanisms that were found for it start."""
    from rocking_cli.plotting.structure import draw_structure
    from rocking_cli.studies.picture import picture

    return draw_structure(picture(mechanism, found), heading(mechanism))


def yaml_of(mechanism: Mechanism) -> str:
    """Return the YAML file of a mechanism made in Python."""
    fields = {"mechanism": mechanism.mechanism, **mechanism.model_dump(exclude_unset=True)}
    from rocking_cli.io.json_text import json_text

    return "".join(f"{key}: {json_text(value)}\n" for key, value in fields.items())
