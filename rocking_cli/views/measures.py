"""View of the installed intensity measures, as text and as data."""

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
        Name of the measure, how it is written, and the distribution and version that it comes from.
    title : str or None
        Description; this and all further fields are None if the measure cannot be loaded.
    unit : str or None
        Unit of its values.
    power : float or None
        Power of the scale factor to which the measure is proportional; None if it is computed for every run.
    relative : bool or None
        Whether the measure depends on the structure.
    source : str or None
        Literature source.
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
