"""`rocking report`: a document of one file on a structure, to hand over."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import defaults, inputs, motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Near
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.dynamics.prepared import Prepared
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.studies.assessment import File, TitleBlock


@dataclass(frozen=True)
class Head:
    """What stands at the head of a report."""

    project: str | None
    place: str | None
    author: str | None
    logo: Path | None

    def block(self, command: str) -> TitleBlock:
        """With the command and the day."""
        from rocking_cli.studies.assessment import TitleBlock

        today = datetime.now(UTC).strftime("%d %B %Y").lstrip("0")
        picture = None
        if self.logo is not None:
            from rocking_cli.report.logo import embedded

            picture = embedded(self.logo)
        return TitleBlock(command, today, self.project, self.place, self.author, picture)


@click.command(short_help="A document to hand over: one page with all that there is to say.")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both", both="the worse is shown", default="both")
@options.out(".html", what="Where to.  [default: FILE with .html, in this folder; none with --json]")
@click.option("--project", metavar="TEXT", help="Of the report: its head names it.")
@click.option("--place", metavar="TEXT", help="Where the structure stands.")
@click.option("--author", metavar="TEXT", help="Who hands it over.")
@click.option("--logo", type=click.Path(path_type=Path), metavar="FILE", help="Their logo (.png, .jpg or .svg).")
@options.around
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
    as_json: bool,
) -> None:
    """Write a report on a structure: one HTML file that opens in any browser, without a network, and prints.

    A summary in words first: will it uplift, will it overturn, how close, which model to trust, what is doubtful. Then
    the drawing, the parameters, the response to each ground motion, the pulses and the overturning map, the error of
    the equivalent block, and the inputs and versions to compute it again. Without a ground motion, what needs none.

    Without FILE it takes rocking.yaml of this folder, else a block of 0.7 m x 2.8 m. A record that cannot be used is
    reported, the others are in the report, and the exit code is 5.

    \b
    Example:
      rocking report frame.yaml --record accel.csv -o report.html
      rocking report arch.yaml --record one.AT2 --record two.AT2 --target-pga 0.3
    """
    asked.check()
    if not near.neighbours:
        raise click.UsageError("A report says how close a result is: --neighbours must be at least 1 here.")
    from rocking_cli.cli import structures
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.io.files import check_writable, keep_apart, write_whole
    from rocking_cli.studies.assessment import gather, steps
    from rocking_cli.views.assessment import view

    if out is None and not as_json:
        out = Path(f"{structures.stem(files[0] if files else None)}.html")
        check_writable(out)
    paths, bad = motion_files.find(asked.records)
    keep_apart(
        [("--out", out)], [*files, *(str(each.path) for each in paths), *([str(head.logo)] if head.logo else [])]
    )
    title = head.block(_command_line(ctx))
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
    with terminal.progress(steps(given), "parts of the report") as advance:
        content = gather(
            structure, _file(structure, files), given, asked.signs, around=near.around,
            title=title, progress=advance,
        )  # fmt: skip
    if out is not None:
        from rocking_cli.report.page import render

        page = render(content).encode()
        write_whole(out, lambda stream: stream.write(page))
        terminal.note(f"wrote {out} ({len(page) / 1e6:.2g} MB)")
    terminal.show(view(content), as_json=as_json)
    if bad:
        ctx.exit(INCOMPLETE)


def _file(structure: Prepared, files: tuple[str, ...]) -> File:
    """The content of the file that a structure stands in."""
    from rocking_cli.cli import structures
    from rocking_cli.excitation.records.opening import original
    from rocking_cli.studies.assessment import File

    if structure.file is None:
        return File("default block", structures.DEFAULT.encode())
    return File(structure.file, original(files[0] if files else structure.file))


def _place(value: object) -> int:
    """Where an option stands among the others: corrections in their order, all else before them."""
    return value.place if isinstance(value, options.Placed) else 0


def _command_line(ctx: click.Context) -> str:
    """The command as it was given, for a POSIX shell, with the user's defaults, which hold nowhere else."""
    from click.core import ParameterSource

    said = ["rocking", "report"]
    taken = defaults.of_run(ctx)
    for param in sorted(ctx.command.params, key=lambda each: _place(ctx.params.get(each.name or ""))):
        value = ctx.params.get(param.name or "")
        if default := taken.get(param.name or ""):
            said += [f"--{default.option}", default.value]
        if ctx.get_parameter_source(param.name or "") is not ParameterSource.COMMANDLINE:
            continue
        for each in value if isinstance(value, tuple) else (value,):
            said += [] if isinstance(param, click.Argument) else [param.opts[0]]
            said += [] if each is True else [str(each)]
    places = ", ".join(f"--{each.option} from {each.place}" for each in taken.values())
    return shlex.join(said) + (f"  # {places}" if places else "")
