"""`rocking verify`: verify a rocking mechanism of masonry by a code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import complete, options, terminal
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Parsed, number
from rocking_cli.questions.verify import heads

if TYPE_CHECKING:
    from rocking_cli.ask.ground_motions import Motions


def _point(text: str) -> tuple[float, float, str | None]:
    """Return a point x,y of a body, or x,y,body."""
    x, _, rest = text.partition(",")
    y, _, body = rest.partition(",")
    try:
        return number(x), number(y), body.strip() or None
    except ValueError:
        raise ValueError(f"{text!r} is not a valid point: give x,y in m, or x,y,BODY, such as 0.3,8.0") from None


def _given(asked: GroundMotions, states: tuple[str, ...], sets: tuple[str, ...]) -> Motions | dict[str, Motions]:
    """Return the set of records of each state; those of `--record` and `--pulse` if there is no `--set`."""
    if not sets:
        if len(states) > 1:
            raise click.UsageError(f"--state is given {len(states)} times: give the records of each state with --set.")
        asked.check()
        return asked.motions
    if asked:
        hint = "give all records of a state as one set"
        raise click.UsageError(f"--set cannot be combined with --record or --pulse: {hint}.")
    if len(states) != len(sets):
        counts = f"--state is given for {len(states)}, and --set for {len(sets)}"
        raise click.UsageError(f"{counts} of the limit states: give a --state for each --set, in the same order.")
    if twice := [state for k, state in enumerate(states) if state in states[:k]]:
        raise click.UsageError(f"--state {twice[0]} is given twice: give all its records as one set.")
    return {state: asked.of(Path(place)) for state, place in zip(states, sets, strict=True)}


@click.command(cls=Command, short_help="Verify a masonry mechanism by a code, such as NTC 2018.")
@options.structure
@click.option(
    "--site", required=True, type=click.Path(), metavar="SITE.yaml", shell_complete=complete.files,
    help=options.HELP["site"],
)  # fmt: skip
@click.option(
    "--strengthened", type=click.Path(path_type=Path), metavar="FILE", shell_complete=complete.files,
    help="The strengthened structure, to be verified too and compared with FILE.",
)  # fmt: skip
@click.option(
    "--control", type=Parsed("point", _point), metavar="X,Y[,BODY]",
    help="Control point, in m.  [default: centroid of the moving weights]",
)  # fmt: skip
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.opening
@click.option(
    "--state",
    "states",
    multiple=True,
    metavar="STATE",
    help="Limit state to which the records belong, such as SLC, if the site gives it. Repeatable.  "
    "[default: that of the verdict]",
)
@click.option(
    "--set",
    "sets",
    multiple=True,
    metavar="PLACE",
    shell_complete=complete.files,
    help="Records of the --state at the same place in the order: a folder or list that `rocking select` wrote, a file, "
    "or a quoted pattern. Repeatable.",
)
@options.on_floor
@options.plot("Plot the capacity curves")
@click.option(
    "--all", "in_full", is_flag=True, help="Show also the ground, both curves, every clause and the remarks in full."
)
@heads.sheet
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, output=Output)
def command(
    ctx: click.Context,
    file: str | Path,
    site: str,
    asked: GroundMotions,
    states: tuple[str, ...],
    sets: tuple[str, ...],
    sheet: Path | None,
    output: Output,
    in_full: bool,
    **question: Any,
) -> None:
    """Verify a rocking mechanism by the code that the site file names: the Italian, NTC 2018 and Circolare 7/2019.

    The command compares the damage, linear and nonlinear methods for each direction, on the exact capacity curve and on
    its straight-line approximation: the capacity by each method, which one governs, and why they differ. The terminal
    shows what is needed to judge the verdict; --all shows all, every number with its clause. The exit code is 0 whether
    the structure passes or fails.

    With --record (repeatable), the dynamic method is added: time histories on the capacity curve, with and without the
    confidence factor; with --polarity both, the worse of the two polarities governs. A record whose outcome is unknown,
    because a joint opens or slides that the model keeps closed, does not pass. A set of records belongs to one limit
    state, given by --state, and is checked against it alone. For several limit states, give each its own set, as
    --state SLV --set PLACE --state SLC --set PLACE. If the site has a floor, ground motions are carried to
    it, unless --on-floor states that they are motions of the floor. Whether the records match the spectrum of the site
    is not checked; the sheet draws both. With --strengthened, a second structure is verified too, and both are compared
    side by side. --sheet writes the calculation sheet for submission: every formula with its numbers, in English or
    Italian.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking new block > block.yaml
      rocking new site > site.yaml
      rocking verify block.yaml --site site.yaml
      rocking verify block.yaml --site site.yaml --sheet block.html --language it
      rocking verify block.yaml --site site.yaml --control 0.35,2.8
      rocking verify block.yaml --strengthened tied.yaml --site site.yaml
      rocking verify block.yaml --site site.yaml --record "records/*.AT2" --target-pga 0.24
      rocking verify block.yaml --site site.yaml --state SLV --set slv --state SLC --set slc
    """
    given = _given(asked, states, sets)
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.verify.verb import verify

    if sheet is None:
        as_declared(question, *heads.HEAD_OPTIONS)
    every = given if isinstance(given, dict) else {"": given}
    records = [str(one.path) for each in every.values() for one in each.records]
    read = [file, site, question["strengthened"], question["logo"], *records]
    keep_apart([("--plot", output.plot), ("--sheet", sheet)], read)
    every_step = terminal.asked("verbose")
    in_short = not (in_full or every_step)
    answer = verify(
        file, site, motions=given, polarity=asked.polarity, state=states[0] if states and not sets else None,
        sheet=sheet, every_step=every_step, in_short=in_short, origin=heads.command_line(ctx), watch=output.watch,
        **question,
    )  # fmt: skip
    output.show(answer)
    if in_short and not output.as_json:
        output.watch.note("--all shows also the ground, both curves, every clause, and the remarks in full")
