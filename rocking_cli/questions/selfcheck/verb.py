"""`rk.selfcheck`: check that this installation computes correctly."""

from __future__ import annotations

from functools import partial
from time import monotonic
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.questions.selfcheck.asked import SelfcheckAsked

if TYPE_CHECKING:
    from rocking_cli.questions.selfcheck.study import SelfCheck


@verb(SelfcheckAsked)
def selfcheck(asked: SelfcheckAsked, watch: Watcher) -> Answer[SelfCheck]:
    """Check that this installation computes correctly, against formulas, literal values and a general solver.

    Returns
    -------
    Answer of SelfCheck
        `passed` is whether no check failed; `checks` are the results, `failed` and `not_run` some of them. A check
        that ends by an error fails; this is not raised. `seconds` is the time it took.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.selfcheck(quick=True).passed
    True
    """
    from rocking_cli.questions.selfcheck.study import CHECKS, run_checks
    from rocking_cli.questions.selfcheck.view import columns, view

    began = monotonic()
    with watch.progress(len(CHECKS), "checks") as advance:
        results = run_checks(CHECKS, quick=asked.quick, progress=advance, began=began)
    for each in results.failed:
        watch.fail(each.error)
    figure = no_plot("the checks of an installation have no plot", "`to_frame` has them as a table")
    return Answer("selfcheck", results, view(results), partial(columns, results), figure)
