"""What a verb is given: a structure or its file, a motion, its file or a pulse as text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.ground_motions import kind_of
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.core.size import doubts
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.io.json_text import json_text
from rocking_cli.structure import Structure
from rocking_cli.structure_file import load_structure
from rocking_cli.text import one_line
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.verification.site_file import SiteFile

WIDEST_OPENING = 1000.0  # over D_cr
StructureLike = Mechanism | Structure | str | Path
"""Mechanism, or its YAML file, or a structure that was prepared."""
SiteLike = Mapping[str, Any] | str | Path
"""Fields of a site file, or the file."""


def structure_of(given: StructureLike, opening: float | None = None) -> Structure:
    """Read a structure from its file, or take a mechanism, named by its kind if it has no name.

    A given `opening` replaces that of its file: the largest opening of a joint, over D_cr, up to which a history is
    valid.

    Raises
    ------
    InputError
        If the file, or the opening, is not valid.
    """
    structure = _structure_of(given)
    if checked(opening) is None:
        return structure
    return replace(structure, mechanism=structure.mechanism.model_copy(update={"opening": opening}), _models={})


def checked(opening: float | None) -> float | None:
    """Return a largest opening of joints over D_cr, if any. Raises `InputError` if it is out of range."""
    if opening is not None and not 0 <= opening <= WIDEST_OPENING:
        raise InputError(Problem(f"must be from 0 to {WIDEST_OPENING:g}, got {opening:g}", field="`opening`"))
    return opening


def site_of(given: SiteLike) -> SiteFile:
    """Read the site for a code of practice from its file, or take its fields. Raises `InputError`."""
    from rocking_cli.io.yaml_file import parse
    from rocking_cli.studies.verification.check import read_site, site_in
    from rocking_cli.studies.verification.site_file import HINT

    if isinstance(given, Mapping):
        return site_in(parse(json_text(given), "site", "site", HINT))
    return read_site(Path(given))


def _structure_of(given: StructureLike) -> Structure:
    if isinstance(given, Structure):
        return given
    if isinstance(given, Mechanism):
        return Structure(given if given.name else given.model_copy(update={"name": given.mechanism}))
    if not isinstance(given, str | Path):
        hint = "make one, such as rk.Block(width=0.7, height=2.8)"
        raise InputError(
            Problem(f"must be a mechanism or a YAML file, got {kind_of(given)}", field="structure", hint=hint)
        )
    return Structure(load_structure(given), str(given))


def structures_of(
    given: Sequence[StructureLike],
    watch: Watcher = SILENT,
    read: Callable[[Any], Structure] = structure_of,
) -> list[Structure]:
    """Read several structures by `read`; those that cannot be used are left out.

    Raises
    ------
    InputError, MechanismError
        If none can be used; an `InputError` has the problems of all files.
    """
    ready: list[Structure] = []
    errors: list[InputError | MechanismError] = []
    for one in given:
        try:
            ready.append(read(one))
        except (InputError, MechanismError) as error:
            errors.append(error)
    if errors and not ready:
        raise next((error for error in errors if isinstance(error, MechanismError)), joined(errors))
    for refused in errors:
        watch.leave_out(refused)
    return ready


def joined(errors: Sequence[RockingError]) -> InputError:
    """Return one error with the problems of several inputs."""
    return InputError(*(problem for error in errors if isinstance(error, InputError) for problem in error.problems))


def told_apart(structures: Sequence[Structure]) -> list[Structure]:
    """Return structures of which those with the same name are named after their files too."""
    names = [structure.name for structure in structures]

    def named(structure: Structure) -> Structure:
        if names.count(structure.name) == 1 or structure.file is None:
            return structure
        name = f"{structure.name} ({one_line(Path(structure.file).name)})"
        return replace(structure, mechanism=structure.mechanism.model_copy(update={"name": name}), _models={})

    return [named(structure) for structure in structures]


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

    for field, value, example in (("`ag`", ag, "0.6 g"), ("`period`", period, "0.8 s")):
        if value is None:
            raise InputError(Problem("is missing for a pulse on a structure", field=field, hint=f"such as {example}"))
        if not 0 < value < inf:
            raise InputError(Problem(f"must be above 0, got {value:g}", field=field))
    assert ag is not None and period is not None
    return replace(parse_shape(shape), amplitude=ag * STANDARD_GRAVITY, period=period)


def doubts_of(mechanism: Mechanism) -> list[str]:
    """Return the doubts about the sizes and places of a structure."""
    return [f"{mechanism.name}: {doubt}" for doubt in doubts(mechanism)]


def models_of(given: str | Sequence[str] | None) -> tuple[ModelName, ...]:
    """Return the models of these names; all of them for None. Raises `InputError` for an unknown name."""
    chosen = MODELS if given is None else (given,) if isinstance(given, str) else tuple(given)
    if unknown := [name for name in chosen if name not in MODELS]:
        raise InputError(f"models must be of {', '.join(MODELS)}, got {', '.join(unknown)}")
    return chosen  # type: ignore[return-value]


def structure_figure(mechanism: Mechanism, found: Mapping[Direction, CollapseMechanism] | None = None) -> Figure:
    """Draw a structure; one without a rocking model as the mechanisms that were found for it start."""
    from rocking_cli.plotting.structure import draw_structure
    from rocking_cli.studies.picture import picture

    return draw_structure(picture(mechanism, found), heading(mechanism))


def yaml_of(mechanism: Mechanism) -> str:
    """Return the YAML file of a mechanism made in Python."""
    fields = {"mechanism": mechanism.mechanism, **mechanism.model_dump(exclude_unset=True)}
    return "".join(f"{key}: {json_text(value)}\n" for key, value in fields.items())
