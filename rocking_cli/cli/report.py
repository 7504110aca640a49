"""`rocking report`: write a report on a structure as one HTML page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, heads, inputs, motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Near
from rocking_cli.cli.heads import Head
from rocking_cli.cli.help import Command
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.excitation.scaled import Scaled


@click.command(cls=Command, short_help="Write a complete report on a structure as one HTML page.")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both", default="both")
@options.out(".html", what="Output file.  [default: FILE with the ending .html, in this folder; none with --json]")
@heads.head
@click.option(
    "--verify", "site_file", type=click.Path(), metavar="SITE.yaml", shell_complete=complete.files,
    help="Site file of a verification by code that becomes part of the report.",
)  # fmt: skip
@options.state
@options.on_floor
@options.around
@options.opening
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, head=Head, near=Near)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    asked: GroundMotions,
    out: Path | None,
    head: Head,
    near: Near,
    site_file: str | None,
    state: str | None,
    on_floor: bool,
    as_json: bool,
) -> None:
    """Write a report on a structure: one HTML file that opens in any browser, without a network, and can be printed.

    The report starts with a summary in words: whether the structure uplifts or overturns, how close it is to
    overturning, which model is reliable, and what is doubtful. Then follow the drawing, the parameters, the response to
    each ground motion (with --polarity both, that of the worse polarity), the pulses and the overturning map, the error
    of the equivalent block, and the inputs and versions needed to reproduce the results. Without a ground motion, the
    report contains only the parts that need none.

    With --verify SITE.yaml, the report also contains the verification by the code of the site, step by step as in
    `rocking verify --sheet`; --state and --on-floor are those of `rocking verify`.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A record that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking report frame.yaml --record accel.csv -o report.html
      rocking report arch.yaml --record one.AT2 --record two.AT2 --target-pga 0.3
    """
    asked.check()
    if (state is not None or on_floor) and (site_file is None or not asked):
        raise click.UsageError(
            "--state and --on-floor describe records of a verification: give --verify SITE.yaml and --record FILE."
        )
    if not near.neighbours:
        raise click.UsageError("The report shows how close the result is: --neighbours must be at least 1.")
    from rocking_cli.cli import sheets, structures
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.io.files import check_writable, keep_apart, write_whole
    from rocking_cli.studies.assessment import gather, steps
    from rocking_cli.views.assessment import view

    if out is None and not as_json:
        out = Path(f"{structures.stem(files[0] if files else None)}.html")
        check_writable(out)
    site = sheets.site_of_report(Path(site_file), motions=bool(asked)) if site_file is not None else None
    paths, bad = motion_files.find(asked.records)
    keep_apart([("--out", out)], [*files, *(str(each.path) for each in paths), *head.inputs, site_file])
    title = head.block(heads.command_line(ctx))
    structure = inputs.structure(files, asked.records)
    several = len(paths) + bad + len(asked.pulses) > 1
    given: list[Scaled] = []
    refused = 0
    if paths or asked.pulses:
        given, refused = inputs.gather(paths, asked, structure.growth, several=several)
    bad += refused
    if bad and not given:
        ctx.exit(InputError.exit_code)
    compile_first()
    verified = None
    if site is not None:
        verified = sheets.of_report(
            structure, site, files[0] if files else None, given, asked.signs, title, state=state,
            on_floor=on_floor,
        )  # fmt: skip
    with terminal.progress(steps(given), "parts of the report") as advance:
        content = gather(
            structure, heads.file_of(structure, files[0] if files else None), given, asked.signs, around=near.around,
            title=title, progress=advance,
        )  # fmt: skip
    if out is not None:
        from rocking_cli.report.page import render

        page = render(content, verified).encode()
        write_whole(out, lambda stream: stream.write(page))
        terminal.note(f"wrote {out} ({len(page) / 1e6:.2g} MB)")
    terminal.show(view(content, verified.found if verified is not None else None), as_json=as_json)
    if bad:
        ctx.exit(INCOMPLETE)
