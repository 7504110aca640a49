"""What a verb is given: a structure or its file, a motion, its file or a pulse as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.excitation.records import read_record
from rocking_cli.io.json_text import json_text
from rocking_cli.structure import Structure
from rocking_cli.structure_file import load_structure
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure


StructureLike = Mechanism | str | Path
"""Mechanism, or its YAML file."""
Motion = GroundMotion | Pulse | str | Path
"""Ground motion or pulse, file of a record, or pulse as text such as `sine:0.6g:0.8s`."""


def structure_of(given: StructureLike) -> Structure:
    """Read a structure from its file, or take a mechanism, named by its kind if it has no name. Raises `InputError`."""
    if isinstance(given, Mechanism):
        return Structure(given if given.name else given.model_copy(update={"name": given.mechanism}))
    if not isinstance(given, str | Path):
        hint = "make one, such as rk.Block(width=0.7, height=2.8)"
        raise InputError(
            Problem(f"must be a mechanism or a YAML file, got {kind_of(given)}", field="structure", hint=hint)
        )
    return Structure(load_structure(given), str(given))


def motion_of(given: Motion) -> GroundMotion:
    """Read a ground motion from its file, or sample a pulse. Raises `InputError`."""
    given = _read(given)
    return given.sampled() if isinstance(given, Pulse) else given


def _read(given: Motion) -> GroundMotion | Pulse:
    """Read a motion from its file, or a pulse from its text; a file of the same name has priority."""
    if isinstance(given, GroundMotion | Pulse):
        return given
    if isinstance(given, str) and given.partition(":")[0] in PulseShapes() and not Path(given).exists():
        return parse_pulse(given)
    if not isinstance(given, str | Path):
        hint = "make one with rk.GroundMotion(name, dt, acceleration), the acceleration in m/s2"
        what = f"must be a ground motion, a pulse or a file, got {kind_of(given)}"
        raise InputError(Problem(what, field="motion", hint=hint))
    return read_record(given)


def kind_of(given: object) -> str:
    """Return the type of a value, for messages: `a dict`."""
    name = type(given).__name__
    return f"{'an' if name[0].lower() in 'aeiou' else 'a'} {name}"


def each_of(given: Any) -> list[Any]:
    """Return a list or tuple as a list, and one thing as a list of one."""
    return list(given) if isinstance(given, list | tuple) else [given]


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
