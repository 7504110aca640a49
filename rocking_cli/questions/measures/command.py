"""`rocking measures`: list the installed intensity measures."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.help import Command


@click.command(cls=Command, short_help="List the installed intensity measures.")
@options.as_json
def command(as_json: bool) -> None:
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
    from rocking_cli.questions.measures.view import InstalledMeasure, view

    known, measures = IntensityMeasures(), []
    for name in known:
        package = known.package_of(name)
        try:
            cls = known[name]
            relative = not issubclass(cls, MotionMeasure)
            of = (cls.title, cls.unit, power_of(cls), relative, cls.source or None)
            measures.append(InstalledMeasure(name, cls.form(), package, *of))
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.debug_traceback(error)
            measures.append(InstalledMeasure(name, name, package))
    terminal.show(view(measures), as_json=as_json)
