"""`rocking respond`: compute the response to a ground motion or a release."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click
from click.core import ParameterSource

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import NEIGHBOUR_OPTIONS, GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import INTERVAL, POSITIVE, TAIL, Parsed, quantity_of
from rocking_cli.processing.reading_options import ALL_AZIMUTHS

# The names of fitted pulses are repeated here so that `--help` does not import numpy.
FITTED_PULSES = ("sine", "ricker", "mavroeidis")
BEST_FIT = "best"


def _models(text: str) -> tuple[str, ...]:
    """Return the names of models in a text that separates them by commas."""
    chosen = tuple(dict.fromkeys(word.strip() for word in text.split(",")))
    if unknown := [word for word in chosen if word not in options.MODELS]:
        raise ValueError(f"{', '.join(unknown) or 'nothing'} is not a model: choose from {', '.join(options.MODELS)}")
    return chosen


@click.command(cls=Command, short_help="Compute the response to a ground motion or a release.")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@click.option(
    "--vertical", type=click.Path(), metavar="FILE", help="Vertical component of the motion: g becomes g + v_g''."
)
@options.record_option(
    "--vertical-dt",
    type=quantity_of(INTERVAL),
    metavar="TIME",
    help="Sampling interval of the vertical component in s, if its file has no times.",
)
@options.record_option("--vertical-channel", metavar="CHANNEL", help="Channel of the vertical component in its file.")
@options.scaling("1", "-1", "both")
@click.option(
    "--with-pulse",
    type=click.Choice((BEST_FIT, *FITTED_PULSES)),
    is_flag=False,
    flag_value=BEST_FIT,
    help="Shape of the pulse in the record whose response is computed as well; without a value, the best-fitting one.",
)
@options.release
@click.option(
    "--model",
    "models",
    type=Parsed("models", _models),
    metavar="MODEL,...",
    shell_complete=complete.listed(options.MODELS),
    help=options.HELP["model"],
)
@click.option(
    "--tail",
    type=quantity_of(TAIL),
    default=10.0,
    show_default=True,
    metavar="TIME",
    help="Length of output after the end of the record, in s.",
)
@click.option(
    "--rtol",
    type=POSITIVE,
    default=1e-9,
    show_default=True,
    metavar="TOLERANCE",
    help="Relative error tolerance per step of the nonlinear integration.",
)
@options.around()
@options.opening
@options.engine
@click.option("--impacts", is_flag=True, help="List the impacts: time, and angular velocity before and after.")
@click.option(
    "--each-block", is_flag=True, help="Let --out write the motion of each block: time, block, x, z, rotation."
)
@options.out(".csv", ".parquet", what="Write the time histories (.csv or .parquet).")
@options.plot("Plot the time histories")
@click.option(
    "--contact", is_flag=True, help="Plot the friction required as well; automatic if the file gives friction."
)
@options.as_json
@options.grouped(asked=GroundMotions, output=Output)
def command(files: tuple[str, ...], asked: GroundMotions, output: Output, **question: Any) -> None:
    """Compute the rocking response of a structure to a ground motion, a release from a tilt, or both.

    The model nonlinear is the mechanism itself; linear1 and linear2 are its equivalent block with kappa1 and kappa2. A
    positive rotation is clockwise and is started by a ground acceleration to the left. Every motion is simulated,
    beyond the end of the record if necessary, until the structure is at rest or certain to overturn. With --polarity
    both, the responses to the two polarities are computed one after the other.

    With several motions, the output has one row per motion (with --json, one object per line), and --out and --plot
    write one file per motion, with its name in the file name. A motion that cannot be used is reported and skipped, and
    the exit code is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking respond frame.yaml --record accel.csv --plot response.png
      rocking respond frame.yaml --record "records/*.AT2" --target-pga 0.4
      rocking respond --record accel.txt --dt 0.01 --units g --target-pga 0.4 --polarity both
      rocking respond arch.yaml --release 0.5
      rocking respond column.yaml --release 0.05rad
      rocking respond frame.yaml --pulse ricker:0.4g:1.2s --polarity both
      rocking respond frame.yaml --record accel.csv --with-pulse --plot response.png
      rocking respond arch.yaml --record accel.csv --engine auto
    """
    _check(asked, output, question)
    from rocking_cli.questions.respond.verb import respond

    motions = asked.motions
    around = motions.reading.azimuth == ALL_AZIMUTHS
    several = motions.count > 1 and not around
    if around or not motions:
        as_declared(question, *NEIGHBOUR_OPTIONS)
        if click.get_current_context().get_parameter_source("neighbours") is not ParameterSource.COMMANDLINE:
            question["neighbours"] = 0
    options.few_neighbours(question, 0)
    if not question["neighbours"]:
        as_declared(question, *NEIGHBOUR_OPTIONS[1:])
    output.keep_apart(*files, *motions.records, question["vertical"])
    if several:
        if str(output.out) == options.STANDARD_OUTPUT:
            raise click.UsageError("--out - works for a single motion only: for several, give a file name.")
        question |= {"out": output.out, "plot": output.plot}
    structure = asked.structure(files)
    answer = respond(structure, motions or None, polarity=asked.polarity, watch=output.watch, **question)
    if not several:
        output.show(answer)
    elif not output.as_json:
        terminal.show(answer.view, as_json=False)
    output.watch.end()


def _check(asked: GroundMotions, output: Output, question: Mapping[str, Any]) -> None:
    """Raise if options have no effect or cannot be combined."""
    if asked.records and asked.pulses:
        raise click.UsageError("--record and --pulse cannot be combined: choose one.")
    if not asked and question["release"] is None:
        raise click.UsageError("No excitation given: add --record FILE, --pulse PULSE or --release TILT.")
    asked.check(question["vertical"])
    if question["each_block"] and output.out is None:
        raise click.UsageError("--each-block is about the table: give --out FILE.")
    if question["contact"] and (output.plot is None or "nonlinear" not in (question["models"] or options.MODELS)):
        raise click.UsageError("--contact adds a panel to the plot of the nonlinear history: give --plot FILE.")
