"""View of the checks of an installation, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rocking_cli.questions.selfcheck.study import Checked, SelfCheck
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, table_of
from rocking_cli.views.view import View, number

VERDICTS = {True: "passed", False: "FAILED", None: "not run"}


def _with_unit(value: float | None, unit: str) -> str | None:
    return None if value is None else f"{number(value, 2)} {unit}".strip()


COLUMNS: tuple[Column[Checked], ...] = (
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


def view(found: SelfCheck) -> View:
    """Show the result of each check, and what to do if one failed."""
    data = {
        "passed": found.passed,
        "quick": found.quick,
        "seconds": found.seconds,
        "checks": [data_of(COLUMNS, each) for each in found.checks],
    }
    return View(data, [table_of("", COLUMNS, found.checks), *_sentences(found)])


def columns(found: SelfCheck) -> dict[str, list[Any]]:
    """Return the checks as columns by name."""
    return frame_of(COLUMNS, found.checks)


def _sentences(found: SelfCheck) -> Iterator[str]:
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
        yield f"All {total} checks passed in {found.seconds:.1f} s."
