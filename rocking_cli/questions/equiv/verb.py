"""`rk.equiv`: compute the equivalent rocking block of a structure."""

from __future__ import annotations

from functools import partial
from typing import Any

from rocking_cli.ask.answer import Answer, Answers
from rocking_cli.ask.inputs import structure_figure, structure_of, structures_of
from rocking_cli.ask.verbs import answers, verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core import Equivalence
from rocking_cli.errors import MechanismError
from rocking_cli.questions.equiv.asked import EquivAsked
from rocking_cli.structure import Structure


@verb(EquivAsked)
def equiv(asked: EquivAsked, watch: Watcher) -> Answer[Equivalence | None] | Answers[Answer[Equivalence | None]]:
    """Compute the equivalent single rocking block of structures, in both directions.

    Returns
    -------
    Answer of Equivalence or None
        `positive` and `negative` are the blocks, see `Equivalence`. None if no single block is equivalent; its
        sentences and `to_dict` give the reason. For a sequence of structures, `Answers` with one for each, by its name.

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
    given: Any = asked.structures
    if not isinstance(given, list | tuple):
        return _of_one(structure_of(given, watch), watch)
    ready = structures_of(given, watch)
    by_name, refused = dict[str, Answer[Equivalence | None]](), list[MechanismError]()
    for structure in ready:
        try:
            by_name[structure.name] = answer = _of_one(structure, watch)
        except MechanismError as error:
            refused.append(error)
            if len(refused) == len(ready):
                raise
            watch.leave_out(error)
        else:
            watch.take(answer)
    parts = [part for each in by_name.values() for part in each.view.parts]
    return answers("equivalent blocks", "structure", by_name, parts)


def _of_one(structure: Structure, watch: Watcher) -> Answer[Equivalence | None]:
    from rocking_cli.questions.equiv import view as views

    equivalence = structure.equivalence if structure.why_no_block is None else None
    shown = views.view(structure)
    for text in views.notes(structure.mechanism):
        watch.note(text)
    columns, figure = partial(views.table, [structure]), partial(structure_figure, structure.mechanism)
    return Answer("equivalent block", equivalence, shown, columns, figure)
