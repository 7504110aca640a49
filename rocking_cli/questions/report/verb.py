"""`rk.report`: write a report on a structure as a page of HTML, as PDF, or for a word processor."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import SiteLike, StructureLike, language_of, site_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, RockingError
from rocking_cli.names import OPENING
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.listed import Scaled
    from rocking_cli.questions.report.document import VerifiedReport
    from rocking_cli.questions.report.study import Assessment
    from rocking_cli.questions.verify.sheets import SheetOrigin
    from rocking_cli.structure import Structure
    from rocking_cli.studies.provenance import TitleBlock
    from rocking_cli.verification.code import SiteFile
    from rocking_cli.verification.results import Histories


@takes_numbers
def report(
    structure: StructureLike,
    motions: Motion | Motions | Sequence[Motion] = (),
    out: str | Path | None = "report.html",
    *,
    polarity: str | int = "both",
    neighbours: int = Neighbourhood.count,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    verify: SiteLike | None = None,
    state: str | None = None,
    on_floor: bool = False,
    opening: float = OPENING,
    project: str | None = None,
    place: str | None = None,
    client: str | None = None,
    author: str | None = None,
    logo: str | Path | None = None,
    language: str | None = None,
    origin: str | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Assessment]:
    """Write a report: one HTML file that opens in any browser and can be printed, a PDF, or a .docx file.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions, their files, or pulses as text; may be empty.
    out : str or Path, optional
        File to write: .html, .pdf (by a browser, or with the extra `pdf`) or .docx (with the extra `docx`); None to
        write none.
    polarity : {"both", "1", "-1"}
        Polarity of the motions: as given, reversed, or both, of which the worse is shown.
    neighbours : int
        Number of neighbours of each motion to simulate, at least 1.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    verify : mapping, str or Path, optional
        Fields of a site file, or the file, of a verification by code that becomes part of the report.
    state : str, optional
        Limit state of the verification to which the motions belong, such as `"SLC"`.
    on_floor : bool
        Whether the motions are those of the floor of the site; if not, ground motions are carried to it.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    project, place, client, author, logo : str, str, str, str, path, optional
        Entries for the heading of the report, and a picture in .png, .jpg or .svg.
    language : {"en", "it"}, optional
        Language of the report; by default that of the site.
    origin : str, optional
        What the report says of how it was made; by default this function and the structure.
    watch : Watcher
        Told what was read and written, how far the work is, and which of several motions cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of Assessment
        Contents of the report.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be read or written.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The report contains the results of `equiv`, `respond`, `margin`, `overturning_map` and `linearisation`, and those
    of `verify` if a site is given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.report(rk.Block(width=0.7, height=2.8), out=None)
    >>> answer.has_block
    True
    """
    from rocking_cli.io.files import check_writable
    from rocking_cli.questions.report.document import document
    from rocking_cli.questions.report.study import count_steps, gather
    from rocking_cli.questions.report.view import view
    from rocking_cli.questions.verify import sheets
    from rocking_cli.questions.verify.sheets import Head, SheetOrigin
    from rocking_cli.verification.check import refuse
    from rocking_cli.verification.results import Histories
    from rocking_cli.views.sheet.build import sheet_of

    if out is not None:
        check_writable(Path(out), ".html", ".pdf", ".docx")
    signs, requested = signs_of(polarity), Motions.of(motions, options)
    if (state is not None or on_floor) and (verify is None or not requested):
        raise InputError("`state` and `on_floor` describe records of a verification: give `verify` and `motions`")
    if not requested:
        refuse_idle(
            "without ground motions",
            polarity=len(signs) == 1,
            neighbours=neighbours != Neighbourhood.count,
            amplitude_deviation=amplitude_deviation != Neighbourhood.amplitude,
            slenderness_deviation=slenderness_deviation,
            restitution_deviation=restitution_deviation,
            opening=opening != OPENING,
        )
    if not neighbours:
        raise InputError("a report shows how close the result is: `neighbours` must be at least 1")
    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    site = site_of(verify) if verify is not None else None
    language = language_of(language, site, watch)
    if site is not None:  # checked before long computations
        sheet_of(site)
        refuse(site, motions=bool(requested))
    ready = structure_of(structure, watch, opening)
    source = SheetOrigin.of(origin or "rocking_cli.report(...)", ready)
    title = Head(project, place, client, author, logo).block(source, language)
    chosen = requested.gather(ready.growth, watch) if requested else []
    verified = None
    if verify is not None and site is not None:
        histories = Histories(chosen, signs, state, on_floor, refused=requested.refused(chosen))
        verified = _verified(ready, site, verify, chosen, histories, language, title, source)
    with watch.progress(count_steps(chosen), "parts of the report") as advance:
        content = gather(ready, source.structure, chosen, signs, around=around, title=title, progress=advance)
    if out is not None:
        made = sheets.sources(ready.mechanism, verify, chosen, source, site)
        try:
            sheets.write(Path(out), document(content, made, verified, language), watch, by_browser=True)
        except RockingError as error:
            watch.unwritten(error)
    shown = view(content, verified.found if verified is not None else None, language)
    figure = drawn("plotting.structure.draw_structure", content.picture, heading(content.mechanism))
    return Answer("report", content, shown, partial(_columns, content), figure)


def _verified(
    structure: Structure, site: SiteFile, given: SiteLike, motions: Sequence[Scaled], histories: Histories,
    language: str, title: TitleBlock, origin: SheetOrigin,
) -> VerifiedReport:  # fmt: skip
    """Return the verification in a report, with time histories under its ground motions."""
    from rocking_cli.questions.report.document import VerifiedReport
    from rocking_cli.questions.verify.sheets import sheet_for
    from rocking_cli.verification.check import verify, with_histories

    verification = verify(structure, site)
    if motions:
        verification = with_histories(verification, structure, site, histories)
    return VerifiedReport(verification, sheet_for(verification, site, given, motions, language, title, origin))


def _columns(found: Assessment) -> Columns:
    runs = [(each.given.motion.name, each.histories["nonlinear"]) for each in found.results]
    return {
        "motion": [name for name, _ in runs],
        "peak_ratio": [run.peak_ratio for _, run in runs],
        "overturned": [run.overturned for _, run in runs],
        "unknown": [run.unknown for _, run in runs],
    }
