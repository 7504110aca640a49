"""A report as a document, which can be written in any format and language."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.core.equivalence import Grade
from rocking_cli.plotting.moving import ground_chart, moving, ratio_chart
from rocking_cli.plotting.style import in_language
from rocking_cli.questions.equiv.view import PARAMETERS, EquivalentSide
from rocking_cli.questions.error.study import errors, preferred
from rocking_cli.questions.error.view import draw_linearisation
from rocking_cli.questions.margin.picture import draw_margins
from rocking_cli.questions.overturning.picture import draw_map
from rocking_cli.questions.report.study import Assessment, MotionResult, PulseMap, amplitude_in_g
from rocking_cli.questions.report.view import PACKAGE, context, language_of, printed
from rocking_cli.questions.respond.picture import draw_history
from rocking_cli.studies.conclusion import SEVERITY, Concluded
from rocking_cli.studies.film import Film
from rocking_cli.verification.results import Verification
from rocking_cli.views.sheet.build import SheetSources, about, of_files
from rocking_cli.views.sheet.document import Moving, Sentence, Sheet, SheetPart, guarded, sections
from rocking_cli.views.sheet.language import Language

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUBSCRIPT, NO_BREAK = re.compile("_(.+)|([₁₂])"), "\N{NO-BREAK SPACE}"

TOTAL_BINS = 6000  # bins of the curves of all motions: each curve has some two samples in a bin
MIN_BINS, MAX_BINS = 300, 2500  # bins of the curves of one motion
PageOf = Callable[[MotionResult], str]
OWN_PARTS = frozenset({"drawing", "inputs", "basis-4"})
"""Parts of a calculation sheet that a report leaves out: it contains them already, or has another order."""
BAD_CONCLUSIONS = frozenset(SEVERITY[SEVERITY.index(Concluded.NOT_CHECKED) :])


@dataclass(frozen=True, eq=False)
class VerifiedReport:
    """A verification and its calculation sheet, for a report."""

    found: Verification
    sheet: Sheet

    @property
    def answers(self) -> list[Sentence]:
        """What the sheet concludes."""
        return [item for item in self.sheet.parts[0].items if isinstance(item, Sentence) and item.answers]

    @property
    def parts(self) -> list[SheetPart]:
        """The sections of the sheet that the report does not have already, with anchors of their own."""
        return [*_apart(self.sheet.parts)]


def _apart(parts: Sequence[SheetPart]) -> Iterator[SheetPart]:
    for part in parts:
        if part.key not in OWN_PARTS:
            yield replace(part, key=f"verification-{part.key}", parts=[*_apart(part.parts)])


def document(
    content: Assessment,
    sources: SheetSources,
    verified: VerifiedReport | None,
    language: str,
    page_of: PageOf | None = None,
) -> Sheet:
    """Return the document of a report.

    Parameters
    ----------
    content : Assessment
        Content of the report.
    sources : SheetSources
        Source files and versions.
    verified : VerifiedReport, optional
        A verification to include in the report.
    language : str
        Language, "en" or "it".
    page_of : callable, optional
        Returns the page that takes the place of the animation under a motion.
    """
    say, mechanism = language_of(language), content.mechanism
    ends = [each for each in (verified.found.conclusion if verified else None, content.conclusion) if each is not None]
    values = context(content, say, verified.found if verified is not None else None)
    motions, sides = values["motions"], values["sides"]
    bins = int(np.clip(TOTAL_BINS // max(1, len(motions)), MIN_BINS, MAX_BINS))
    moving_pictures = [_moving(content, each.result, bins, say, page_of) for each in motions]
    of_block = [errors(content.asked, kappa) for kappa in (1, 2)] if content.asked else []
    graded = [each.grade for each in of_block]
    fits = [(each.name, each.result.fits[0]) for each in motions if each.result.file and each.result.fits]
    values |= of_files(mechanism, content.title, sources) | {
        "verified": verified,
        "site": verified.sheet.about.get(verified.sheet.language("Site"), "") if verified is not None else "",
        "cautions": [*map(guarded, _cautions(verified, say))] if verified is not None else [],
        "pictures": dict(zip((each.key for each in motions), moving_pictures, strict=True)),
        "pgas": [each.result.pga_of_ground for each in motions],
        "falls": content.conclusion is not None and content.conclusion.concluded in BAD_CONCLUSIONS,
        "next_steps": dict.fromkeys(step for end in ends for step in end.next),
        "around": motions[0].result.margin.around if motions else None,
        "one_model": len(content.structure.default_models) == 1,
        "parameters": _parameters(content, sides),
        "doubtful": any(each.result.neighbours[each.result.polarity].unknown for each in motions),
        "followed": any(contact.followed for each in motions for contact in each.result.contacts.values()),
        "fitted": [(name, fit, amplitude_in_g(fit)) for name, fit in fits],
        "errors": of_block,
        "prefer": preferred(content.asked) if content.asked else None,
        "first_estimate": bool(graded) and min(graded) is Grade.ESTIMATE,
        "figures": {
            "margins": in_language(say, partial(draw_margins, {each.name: each.result.margin for each in motions}, "")),
            "map": in_language(say, partial(_draw_map, content.map)) if content.map is not None else None,
            "errors": in_language(say, partial(draw_linearisation, content.curves, content.asked, "")),
        },
    }  # fmt: skip
    parts = sections(say, PACKAGE, "report", values)
    if verified is not None:
        parts = [replace(each, parts=verified.parts) if each.key == "verification" else each for each in parts]
    heading = say("{name}: will it overturn?", name=content.name)
    return Sheet(
        say,
        heading,
        say("report_subtitle"),
        about(say, mechanism, content.title.known, content.title, sources),
        parts,
        content.title.logo,
        author=content.title.author,
    )


def _cautions(verified: VerifiedReport, say: Language) -> list[str]:
    """Return the remarks of a verification that are cautions, such as on a tie that elongates too far."""
    remarks = [*(remark for each in verified.found.distinct for remark in each.remarks), *verified.found.remarks]
    sentences = dict.fromkeys(map(verified.sheet.language, remarks))
    return [each for each in sentences if each.startswith(say("Caution: {text}", text=""))]


def _parameters(content: Assessment, sides: Sequence[EquivalentSide]) -> list[dict[str, Any]]:
    """Return the rows of the table of parameters: key, symbol, values, unit, and meaning in English."""
    blocks = [side.parameters for side in sides]
    rows = [
        {
            "key": each.key, "symbol": SUBSCRIPT.sub(_below, each.symbol), "meaning": printed(each.words),
            "values": [block[each.key] for block in blocks], "angle": each.unit == "rad",
            "unit": each.unit_of(mass=content.mechanism.has_mass).replace("m2", "m²").replace(" ", NO_BREAK),
        }
        for each in PARAMETERS
        if not all(isnan(block[each.key]) for block in blocks)
    ]  # fmt: skip
    if content.has_block:
        return rows
    limits, stiffening = ([getattr(side.statics, name) for side in sides] for name in ("limit", "stiffening"))
    return [
        *rows,
        {"key": "stiffening", "symbol": "V''(0)/V'(0)", "unit": "1/rad", "values": stiffening, "angle": False,
         "meaning": "rate at which the restoring moment increases from rest, over the moment itself"},
        {"key": "limit", "symbol": "φ_[lim]", "unit": "rad", "values": limits, "angle": True,
         "meaning": "kinematic limit: there the structure lies on the ground or locks, and its motion ends"},
    ]  # fmt: skip


def _below(match: re.Match[str]) -> str:
    return f"_[{match[1] or ' ₁₂'.index(match[2])}]"


def _moving(content: Assessment, result: MotionResult, bins: int, say: Language, page_of: PageOf | None) -> Moving:
    """Return the moving structure under a motion, with the charts; on paper, the plot of the response."""
    picture = partial(draw_history, result.histories, result.motion, "", structure=content.structure)
    if page_of is not None:
        return Moving("", in_language(say, picture), page=page_of(result))
    best = result.histories["nonlinear"]
    film = Film(content.picture, best, result.motion, result.contacts[result.polarity].assumed_friction)
    pulses = [replace(each, sign=each.sign * result.polarity) for each in result.fits[:1] if result.file]
    charts = [ratio_chart(result.histories, bins), ground_chart(result.motion, pulses, bins)]
    moment = film.start
    if best.fell:  # show the moment of overturning, or otherwise that of the peak
        moment = min(float(best.time[int(np.searchsorted(best.time, best.overturning_time))]), film.end)
    elif best.peak_ratio:
        moment = float(best.time[int(np.nanargmax(np.abs(best.ratio)))])
    label = f"{content.name}, as it moves under {result.given.motion.name}"
    data = moving(film, charts, label=label, speed=1.0, moment=moment)
    return Moving("", in_language(say, picture), data=data if say.key == "en" else _translated(say, data))


def _translated(say: Language, data: Any) -> Any:
    """Return the data of a moving picture with its texts in a language."""
    if isinstance(data, dict):
        return {key: _translated(say, value) for key, value in data.items()}
    if isinstance(data, list):
        return [_translated(say, each) for each in data] if data and not isinstance(data[0], float) else data
    return say.recognised("figure", data) if isinstance(data, str) else data


def _draw_map(drawn: PulseMap) -> Figure:
    places = [(name, fit.pulse.period, amplitude_in_g(fit)) for name, fit in drawn.marks]
    return draw_map(drawn.found, "", dimensionless=False, marks=places)
