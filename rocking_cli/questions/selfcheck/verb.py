"""`rk.selfcheck`: check that this installation computes correctly."""

from __future__ import annotations

from collections.abc import Iterator
from time import monotonic

from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.questions.selfcheck import study
from rocking_cli.questions.selfcheck.asked import SelfcheckAsked
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, table_of
from rocking_cli.views.view import View, number


@verb(SelfcheckAsked)
def selfcheck(asked: SelfcheckAsked, watch: Watcher) -> Answer[study.SelfCheck]:
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
    began = monotonic()
    with watch.progress(len(study.CHECKS), "checks") as advance:
        results = study.run_checks(study.CHECKS, quick=asked.quick, progress=advance, began=began)
    for each in results.failed:
        watch.fail(each.error)
    figure = no_plot("the checks of an installation have no plot", "`to_frame` has them as a table")
    return Answer("selfcheck", results, _view(results), lambda: frame_of(COLUMNS, results.checks), figure)


VERDICTS = {True: "passed", False: "FAILED", None: "not run"}


def _with_unit(value: float | None, unit: str) -> str | None:
    return None if value is None else f"{number(value, 2)} {unit}".strip()


COLUMNS: tuple[Column[study.Checked], ...] = (
    Column("check", of("check.name"), head="check", text=True),
    Column("meaning", of("check.meaning"), head="what is compared", text=True),
    Column("found", of("found")),
    Column("limit", of("check.limit")),
    Column("unit", of("check.unit"), text=True),
    only_shown("found", lambda each: _with_unit(each.found, each.check.unit)),
    only_shown("limit", lambda each: _with_unit(each.check.limit, each.check.unit)),
    Column("passed", of("passed"), head="result", form=VERDICTS.__getitem__, text=True),
    Column("why", of("why"), text=True),
    Column("seconds", of("seconds")),
)


def _view(found: study.SelfCheck) -> View:
    """Show the result of each check, and what to do if one failed."""
    data = {name: getattr(found, name) for name in ("passed", "quick", "seconds")}
    data["checks"] = [data_of(COLUMNS, each) for each in found.checks]
    return View(data, [table_of("", COLUMNS, found.checks), *_sentences(found)])


def _sentences(found: study.SelfCheck) -> Iterator[str]:
    for words, some in (("failed", found.failed), ("not run", found.not_run)):
        for why in dict.fromkeys(each.why for each in some):
            names = ", ".join(each.check.name for each in some if each.why == why)
            yield f"{names} {words}: {why}."
    total = len(found.checks)
    if found.failed:
        yield (
            f"{len(found.failed)} of {total} checks failed: do not rely on the results of this installation. Install "
            "rocking-cli into a new environment and check again. If the check fails there too, report it with this "
            "table and the output of `rocking info`, which has all versions."
        )
    elif found.not_run:
        passed = total - len(found.not_run)
        yield f"{passed} of {total} checks passed in {found.seconds:.1f} s, {len(found.not_run)} could not be run."
    else:
        yield f"All {total} checks passed in {found.seconds:.1f} s: of arithmetic, not of your files or a code."
