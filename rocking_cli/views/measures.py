"""The measures of intensity that are installed, as people and programs read them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from rocking_cli.views.view import ABSENT, Table, View


@dataclass(frozen=True)
class Installed:
    """A measure that is installed.

    Parameters
    ----------
    name, form, package : str
        Its own, how it is given, and the distribution and version that it comes from.
    title : str or None
        What it is; this and the rest are None if it cannot be loaded.
    unit : str or None
        Of its values.
    power : float or None
        Of the factor on a motion; None where it is computed of every run.
    relative : bool or None
        Whether it asks what is shaken.
    source : str or None
        Where it comes from.
    """

    name: str
    form: str
    package: str
    title: str | None = None
    unit: str | None = None
    power: float | None = None
    relative: bool | None = None
    source: str | None = None


def view(found: Sequence[Installed]) -> View:
    """All that there are."""
    rows = [
        [each.form, each.unit or ABSENT, _power(each), each.title or "(cannot be loaded)", each.package]
        for each in found
    ]
    return View(
        {"measures": [asdict(each) for each in found]},
        [
            Table("Measures of intensity", ["measure", "unit", "goes with", "what it is", "package"], rows),
            "What a measure goes with is a power of the factor on the record: levels of a study cannot be of one that "
            "is the same whatever the factor, or is computed of every run. `rocking record` gives any of them with "
            "`measures`, those that are relative to what is shaken with a `structure` too.",
        ],
    )


def _power(each: Installed) -> str:
    if each.title is None:
        return ABSENT
    if each.power is None:
        return "each run"
    return {0.0: "nothing", 1.0: "factor"}.get(each.power, f"factor^{each.power:g}")
