"""`rocking measures`: list the installed intensity measures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import Command, as_json, in_full
from rocking_cli.errors import named
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.view import View


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


def _power(each: InstalledMeasure) -> str | None:
    if each.title is None or each.power is None:
        return None if each.title is None else "computed per run"
    return {0.0: "nothing", 1.0: "factor"}.get(each.power, f"factor^{each.power:g}")


COLUMNS: tuple[Column[InstalledMeasure], ...] = (
    Column("name", of("name")),
    Column("form", of("form"), head="measure", text=True),
    Column("unit", of("unit")),
    only_shown("unit", lambda each: each.unit or None, text=True),
    Column("power", of("power")),
    only_shown("scales with", _power, text=True, rank=1),
    Column("title", of("title")),
    only_shown("description", lambda each: each.title or "(cannot be loaded)", text=True),
    Column("package", of("package"), head="package", text=True, rank=2),
    Column("relative", of("relative")),
    Column("source", of("source")),
)


def view(found: Sequence[InstalledMeasure]) -> View:
    """Show the installed measures in a table."""
    return View(
        {"measures": [data_of(COLUMNS, each) for each in found]},
        [
            table_of("Intensity measures", COLUMNS, found),
            "The column 'scales with' gives the power of the record's scale factor. A measure that does not scale, or "
            "that is computed for every run, cannot define the levels of a study. `rocking record` computes any of "
            f"them with {named('measures')}; those relative to a structure also need {named('structure')}.",
        ],
    )


@click.command(cls=Command, short_help="List the installed intensity measures.")
@in_full
@as_json
def command(as_json: bool, in_full: bool) -> None:
    """List the installed intensity measures: their form, unit and dependence on the scale factor of a record.

    `rocking record --measures` computes them for records. In fragility studies, `measures`, `levels`, `bivariate` and
    `hazard` accept their names, in any case and spacing.

    \b
    Example:
      rocking measures
      rocking record accel.csv --measures "Sa(1.0), Sa_avg(0.2:2), CAV"
    """
    from rocking_cli.errors import MechanismError
    from rocking_cli.processing.intensity import IntensityMeasures, MotionMeasure, power_of

    known, measures = IntensityMeasures(), []
    for name in known:
        package = known.package_of(name)
        try:
            cls = known[name]
            relative = not issubclass(cls, MotionMeasure)
            described = (cls.title, cls.unit, power_of(cls), relative, cls.source or None)
            measures.append(InstalledMeasure(name, cls.form(), package, *described))
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.debug_traceback(error)
            measures.append(InstalledMeasure(name, name, package))
    terminal.show(view(measures), as_json=as_json)
