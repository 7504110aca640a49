"""`rocking verify`: verify a rocking mechanism of masonry by a code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, heads, motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions
from rocking_cli.cli.heads import SheetAsked
from rocking_cli.cli.help import Command
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.processing.listed import Listed
    from rocking_cli.structure import Structure
    from rocking_cli.studies.assessment import TitleBlock
    from rocking_cli.studies.verification.results import Verification
    from rocking_cli.studies.verification.site_file import SiteFile

Point = tuple[float, float, str | None]


def _point(ctx: click.Context, param: click.Parameter, value: str | None) -> Point | None:
    """Return a point x,y of a body, or x,y,body."""
    if value is None:
        return None
    x, _, rest = value.partition(",")
    y, _, body = rest.partition(",")
    try:
        found = float(x), float(y), body.strip() or None
    except ValueError:
        found = float("nan"), 0.0, None
    if not (abs(found[0]) < float("inf") and abs(found[1]) < float("inf")):
        raise click.BadParameter(
            f"{value!r} is not a valid point: give x,y in m, or x,y,BODY, such as 0.3,8.0.", ctx, param
        )
    return found


@click.command(cls=Command, short_help="Verify a masonry mechanism by a code, such as NTC 2018.")
@click.argument("file", metavar="[FILE]", required=False, type=click.Path())
@click.option(
    "--site", "site_file", required=True, type=click.Path(), metavar="SITE.yaml", shell_complete=complete.files,
    help=options.HELP["site"],
)  # fmt: skip
@click.option(
    "--control", callback=_point, metavar="X,Y[,BODY]",
    help="Control point, in m.  [default: centroid of the moving weights]",
)  # fmt: skip
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both")
@options.opening
@options.state
@options.on_floor
@options.plot("Plot the capacity curves")
@heads.sheet
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, sheet=SheetAsked)
def command(
    ctx: click.Context,
    file: str | None,
    site_file: str,
    control: Point | None,
    asked: GroundMotions,
    sheet: SheetAsked,
    state: str | None,
    on_floor: bool,
    plot: Path | None,
    as_json: bool,
) -> None:
    """Verify a rocking mechanism by the code that the site file names: the Italian, NTC 2018 and Circolare 7/2019.

    The command compares the damage, linear and nonlinear methods for each direction, on the exact capacity curve and on
    its straight-line approximation: the capacity by each method, which one governs, and why they differ. Every number
    is given with its clause. The exit code is 0 whether the structure passes or fails.

    With --record (repeatable), the dynamic method is added: time histories on the capacity curve, with and without the
    confidence factor; with --polarity both, the worse of the two polarities governs. A record whose outcome is unknown,
    because a joint opens or slides that the model keeps closed, does not pass. A set of records belongs to one limit
    state, given by --state, and is checked against it alone. If the site has a floor, ground motions are carried to
    it, unless --on-floor states that they are motions of the floor. Whether the records match the spectrum of the site
    is not checked. --sheet writes the calculation sheet for submission: every formula with its
    numbers, in English or Italian.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking new block > block.yaml
      rocking new site > site.yaml
      rocking verify block.yaml --site site.yaml
      rocking verify block.yaml --site site.yaml --sheet block.html --language it
      rocking verify block.yaml --site site.yaml --control 0.35,2.8
      rocking verify block.yaml --site site.yaml --record "records/*.AT2" --target-pga 0.24
    """
    asked.check()
    if not asked and asked.polarity != "1":
        raise click.UsageError("--polarity reverses a ground motion: give --record FILE or --pulse PULSE.")
    if not asked and (state is not None or on_floor):
        raise click.UsageError("--state and --on-floor describe records: give --record FILE or --pulse PULSE.")
    from rocking_cli.cli import structures
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.verification.check import read_site, refuse, verify
    from rocking_cli.studies.verification.control import control_at
    from rocking_cli.views.verification import showing, view

    paths, missing = motion_files.find(asked.records)
    given = [file, site_file, *sheet.inputs, *(str(each.path) for each in paths)]
    keep_apart([("--plot", plot), ("--sheet", sheet.sheet)], given)
    site = read_site(Path(site_file))
    refuse(site, control=control is not None, motions=bool(asked))
    title = _title(ctx, sheet, site)
    structure = structures.prepared([file] if file else [])
    found = verify(structure, site, control_at(structure.mechanism, *control) if control is not None else None)
    refused = 0
    chosen: list[Scaled] = []
    if asked:
        found, chosen, refused = _histories(found, structure, site, asked, paths, state, on_floor=on_floor)
    if plot is not None:
        from rocking_cli.cli.pictures import write_picture

        write_picture(plot, showing(found).draw(found))
    if title is not None:
        from rocking_cli.cli import sheets

        sheets.write(sheet, found, site, title, sheets.made(structure, file, Path(site_file), chosen))
    every = terminal.asked("verbose")
    terminal.show(view(found, site.site.name, every_step=every), as_json=as_json)
    if missing or refused:
        ctx.exit(INCOMPLETE)


def _title(ctx: click.Context, asked: SheetAsked, site: SiteFile) -> TitleBlock | None:
    """Return the heading of the sheet, if one is requested. Raises, before any work, if it cannot be written."""
    if asked.sheet is None:
        return None
    from rocking_cli.cli import sheets

    sheets.check(asked, site)
    return asked.title(heads.command_line(ctx))


def _histories(
    found: Verification,
    structure: Structure,
    site: SiteFile,
    asked: GroundMotions,
    paths: list[Listed],
    state: str | None,
    *,
    on_floor: bool,
) -> tuple[Verification, list[Scaled], int]:
    """Add time histories to a verification, and return the motions used and the number of unusable ones too.

    Raises if no motion can be used.
    """
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.studies.verification.check import with_histories
    from rocking_cli.studies.verification.motions import Histories

    chosen, refused = motion_files.gather(
        paths, asked.pulses, asked.reading, asked.scaling, structure.growth, "this structure"
    )
    if not chosen:
        raise InputError("no ground motion can be used")
    compile_first()
    motions = [each.motion.scaled(each.factor) for each in chosen]
    with terminal.progress(len(motions), "records") as advance:
        under = with_histories(found, structure, site, Histories(motions, asked.signs, state, on_floor, advance))
    return under, chosen, refused
