"""`rk.equiv`: compute the equivalent rocking block of a structure."""

from __future__ import annotations

from functools import partial

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_figure, structure_of
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.core import Equivalence


def equiv(structure: StructureLike, *, watch: Watcher = SILENT) -> Answer[Equivalence | None]:
    """Compute the equivalent single rocking block of a structure, in both directions.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    watch : Watcher
        Told how to read the parameters.

    Returns
    -------
    Answer of Equivalence or None
        `positive` and `negative` are the blocks; see `equivalent_block`. None if no single block is equivalent; its
        sentences and `to_dict` give the reason.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 3: Eq. 9 for phi_cr, Eq. 10 for lambda, Eq. 13 for I_eq, G_eq and B_eq,
    Eqs. 15 and 20 for kappa1 and kappa2, Eq. 17 for p and theta_cr; eta from kinematics, for a block Housner (1963),
    unless it is given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.equiv(rk.Block(width=1.0, height=4.0))
    >>> round(answer.positive.lambda_, 6)
    0.25
    """
    from rocking_cli.views import equivalent_block as views

    ready = structure_of(structure)
    found = ready.equivalence if ready.why_no_block is None else None
    shown = views.view(ready)
    for text in views.notes(ready.mechanism):
        watch.note(text)
    columns, figure = partial(views.table, [ready]), partial(structure_figure, ready.mechanism)
    return Answer("equivalent block", found, shown, columns, figure)
