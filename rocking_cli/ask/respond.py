"""`rk.respond`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.given import Motion, StructureLike, models_of, motion_of, structure_of
from rocking_cli.core import Mechanism
from rocking_cli.dynamics.history import RTOL, TAIL, History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.engines import default_models
from rocking_cli.engines import respond as histories
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure
from rocking_cli.studies.release import Release
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.studies.contact import ContactDemand


def respond(
    structure: StructureLike,
    motion: Motion | None = None,
    *,
    models: str | Sequence[str] | None = None,
    scale: float = 1.0,
    release: float | str | None = None,
    tail: float = TAIL,
    rtol: float = RTOL,
) -> MappingAnswer[ModelName, History]:
    """Compute the response of a structure to a ground motion, a release or both; `respond_each` is for many.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, optional
        The motion, its file, or a pulse as text.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scale : float
        Scale factor on the motion; a negative one reverses it.
    release : float or str, optional
        Initial tilt of a release from rest: a fraction of phi_cr, between -1 and 1, or an angle such as "0.05rad";
        negative is anticlockwise.
    tail : float
        Length of output after the end of the record [s].
    rtol : float
        Relative error tolerance per step of the nonlinear integration.

    Returns
    -------
    MappingAnswer of str to History
        Time histories, by model.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be used, or kinematics give no restitution for rocking to continue.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If the motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014): the nonlinear model is Eq. 8, the linear ones are Eq. 16 with kappa1 of Eq. 15
    and kappa2 of Eq. 20; an impact leaves eta of the rate of rotation, Eq. 6.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.respond(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.8s", models="nonlinear")
    >>> answer["nonlinear"].words
    'rocks'
    """
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.views.response import runs_view

    ready = structure_of(structure)
    shaking = motion_of(motion).scaled(scale) if motion is not None else None
    chosen = models_of(models) if models is not None else default_models(ready)
    tilt = Release.of(release).ratio(ready) if release is not None else None
    found = histories(ready, shaking, models=chosen, release=tilt, tail=tail, rtol=rtol)
    title = heading(ready.mechanism) + (f", {shaking.name}" if shaking is not None else "")
    nonlinear = found.get("nonlinear")
    contacts = {1: Contacts(ready.mechanism).check(nonlinear, shaking)} if nonlinear is not None else {}

    columns = partial(_history_columns, found, shaking, ready.mechanism)
    figure = partial(_history_figure, found, shaking, ready, title, contacts)
    return MappingAnswer("response", found, runs_view(title, {1: found}, ready.mechanism, contacts), columns, figure)


def _history_columns(found: Mapping[ModelName, History], shaking: GroundMotion | None, mechanism: Mechanism) -> Columns:
    from rocking_cli.studies.movements import Watched
    from rocking_cli.views import history_table

    runs = {str(name): run for name, run in found.items()}
    blocks = list(history_table.blocks(runs, shaking, watched=Watched(mechanism)))
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _history_figure(
    found: Mapping[ModelName, History],
    shaking: GroundMotion | None,
    ready: Structure,
    title: str,
    contacts: Mapping[int, ContactDemand],
) -> Figure:
    from rocking_cli.plotting.history import draw_history
    from rocking_cli.studies.movements import Watched

    checked = list(contacts.values()) if ready.mechanism.friction is not None else []
    watched = Watched(ready.mechanism)
    return draw_history(found, shaking, title, uplift=ready.uplift, contacts=checked, watched=watched)
