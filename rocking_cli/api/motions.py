"""What is made of ground motions, in Python: corrections, directions, floors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rocking_cli.api.answer import Answer
from rocking_cli.api.verbs import Motion, Structure, _models, _motion, _structure
from rocking_cli.dynamics.history import RTOL
from rocking_cli.dynamics.release import Release
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.steps import Step, parse_steps, process
from rocking_cli.studies.azimuths import Around
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns


def correct(motion: Motion, *steps: Step | str | Mapping[str, Any]) -> GroundMotion:
    """A ground motion after corrections, made in the order in which they are given.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    *steps : str
        Such as `"baseline linear"`, `"highpass 0.1"`, `"lowpass 25"`, `"taper 0.05"`, `"trim 2:20"`,
        `"resample 0.005"`: frequencies in Hz, times in s. As mappings, `{"highpass": 0.1}`, too.

    Returns
    -------
    GroundMotion
        Its `processing` says what was done.

    Raises
    ------
    InputError
        If there is no such step, or the motion does not allow it.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.correct("sine:0.3g:0.8s", "lowpass 5").processing
    ('lowpass 5',)
    """
    asked = [step for each in steps for step in ([each] if isinstance(each, Step) else parse_steps([each]))]
    return process(_motion(motion), asked)


def on_floor(motion: Motion, floor: Floor | str | Mapping[str, Any]) -> GroundMotion:
    """The motion of a floor of a building, by its first mode, over a motion of the ground.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        Of the ground.
    floor : Floor, str or mapping
        Such as `"T1=0.4,xi=0.05,z=0.67,gamma=1.29"`: period [s], damping ratio, height over that of the building and
        participation factor; `n`, a number of equal storeys, may stand for the last.

    Returns
    -------
    GroundMotion
        Its `ground` is the motion below.

    Raises
    ------
    InputError
        If it is no floor.
    """
    return (floor if isinstance(floor, Floor) else Floor.parse(floor)).of(_motion(motion))


def respond_around(
    structure: Structure,
    one: Motion,
    other: Motion,
    *,
    models: str | Sequence[str] | None = None,
    scale: float = 1.0,
    release: float | str | None = None,
    rtol: float = RTOL,
) -> Answer[Around]:
    """The response of a structure in every direction between two components.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    one, other : GroundMotion, Pulse, str or Path
        The components at 0 and at 90 degrees, of one length and interval.
    models : str or sequence of str, optional
        Of "nonlinear", "linear1" and "linear2"; all, unless given.
    scale : float
        Factor on both.
    release : float or str, optional
        Start at rest from this fraction of phi_cr, or from an angle such as "0.05rad".
    rtol : float
        Relative local error of a step of the nonlinear motion.

    Returns
    -------
    Answer of Around
        `azimuths` [deg], and `outcomes` of each model over them.

    Raises
    ------
    InputError
        If a value is out of range, or the components do not go together.
    SolverError
        If a motion cannot be followed.
    """
    from rocking_cli.studies.azimuths import all_around
    from rocking_cli.views.azimuths import columns, view

    ready = _structure(structure)
    chosen = _models(models) if models is not None else ready.default_models
    tilt = Release.of(release).ratio(ready) if release is not None else None
    found = all_around(ready, chosen, (_motion(one), _motion(other)), scale, release=tilt, rtol=rtol)

    def table() -> Columns:
        return columns(found)

    def figure() -> Figure:
        from rocking_cli.plotting import style
        from rocking_cli.plotting.azimuths import draw_azimuths

        first, second = (side.phi_cr is None for side in ready.statics)
        return draw_azimuths(found, heading(ready.mechanism), style.over((first, second), math=True))

    return Answer("all directions", found, view(ready, found), table, figure)
