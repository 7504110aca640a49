"""`rocking figure`: recompute the figures of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import ReadingOptions
from rocking_cli.cli.help import Command

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.studies.paper_figures import PaperFigure

# The numbers are repeated here so that `--help` needs no numpy; a test compares them.
NUMBERS = ("3", "5", "6", "7", "8", "10", "11", "12", "13", "14", "15")


@click.command(cls=Command, short_help="Recompute the figures of the paper: plots and data.")
@click.argument("number", type=click.Choice([*NUMBERS, "all"]))
@click.option(
    "--record",
    "records",
    multiple=True,
    type=click.Path(),
    metavar="FILE",
    help="Record for Figure 14.  [default: the shipped synthetic example]",
)
@options.reading
@click.option(
    "-o",
    "--out",
    type=click.Path(file_okay=False),
    default=".",
    show_default="this one",
    metavar="FOLDER",
    help="Folder for the figures, created if missing.",
)
@click.option(
    "--format",
    "suffix",
    type=click.Choice(["png", "svg", "pdf"]),
    default="png",
    show_default=True,
    help="File format of the plots.",
)
@options.as_json
@options.grouped(reading=ReadingOptions)
def command(
    number: str,
    records: tuple[str, ...],
    reading: ReadingOptions,
    out: str,
    suffix: str,
    as_json: bool,
) -> None:
    """Recompute a figure of the paper, or all of them: figureN.png and its data, figureN.csv.

    \b
    Example:
      rocking figure 3
      rocking figure 14 --record accel.csv
      rocking figure all --out figures --format svg

    Source: DeJong and Dimitrakopoulos (2014). Geometries that are illegible in the scan are our choice;
    the captions say so.
    """
    if number not in ("14", "all") and records:
        raise click.UsageError("--record applies to Figure 14 only: leave it out.")
    if len(records) > 1:
        raise click.UsageError(f"Figure 14 uses a single record, but {len(records)} are given: {', '.join(records)}.")
    record = records[0] if records else None
    motion = _motion(record, reading) if number in ("14", "all") else None
    from rocking_cli.io.files import folder as make_folder

    wanted = [int(each) for each in (NUMBERS if number == "all" else [number])]
    place = make_folder(out)
    made: list[tuple[int, list[str]]] = []
    with terminal.progress(len(wanted), "figures") as advance:
        for each in wanted:
            written = _write(_compute(each, motion), place, suffix)
            made.append((each, [str(file) for file in written]))
            advance(1)
    if as_json:
        terminal.print_json({"figures": [{"figure": each, "files": files} for each, files in made]})
        return
    for each, files in made:
        terminal.sentence(f"figure {each}: {', '.join(files)}")


def _motion(record: str | None, reading: ReadingOptions) -> GroundMotion:
    """Return the record of Figure 14: the user's, or the shipped example."""
    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.excitation.records import read_record
    from rocking_cli.io.files import shipped

    if record is not None:
        return Motions((Path(record),), *reading.readings).one(0.0).motion
    return read_record(shipped("accel.csv"))


def _compute(number: int, motion: GroundMotion | None) -> PaperFigure:
    from rocking_cli.studies.paper_figures import paper_figure
    from rocking_cli.studies.paper_responses import equivalent_vulnerability, record_response

    if number == 14:
        assert motion is not None
        return record_response(motion)
    return equivalent_vulnerability() if number == 15 else paper_figure(number)


def _write(paper: PaperFigure, folder: Path, suffix: str) -> list[Path]:
    """Write the plot and the data, and return their paths."""
    import csv
    import io

    from rocking_cli.cli.written import save
    from rocking_cli.io.files import check_writable, write_whole
    from rocking_cli.plotting.paper_figures import draw_paper_figure

    picture, data = (folder / f"figure{paper.number}.{end}" for end in (suffix, "csv"))
    for file in (picture, data):
        check_writable(file)
    figure = draw_paper_figure(paper)
    save(picture, figure)
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(paper.rows())
    write_whole(data, lambda stream: stream.write(text.getvalue().encode()))
    return [picture, data]
