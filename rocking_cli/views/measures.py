"""The measures of intensity that are installed, as people and programs read them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from rocking_cli.views.view import ABSENT, Table, View


@dataclass(frozen=True)
class InstalledMeasure:
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


def view(found: Sequence[InstalledMeasure]) -> View:
    """Show the installed measures in a table."""
    rows = [
        [each.form, each.unit or ABSENT, _power(each), each.title or "(cannot be loaded)", each.package]
        for each in found
    ]
    return View(
        {"measures": [asdict(each) for each in found]},
        [
            Table("Intensity measures", ["measure", "unit", "scales with", "description", "package"], rows),
            "The column 'scales with' gives the power of the record's scale factor. A measure that does not scale, or "
            "that is computed for every run, cannot define the levels of a study. `rocking record` computes any of "
            "them with `measures`; those relative to a structure also need `structure`.",
        ],
    )


def _power(each: InstalledMeasure) -> str:
    if each.title is None:
        return ABSENT
    if each.power is None:
        return "computed per run"
    return {0.0: "nothing", 1.0: "factor"}.get(each.power, f"factor^{each.power:g}")
