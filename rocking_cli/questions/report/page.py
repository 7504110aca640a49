"""A report as a single HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import degrees, isnan
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from rocking_cli.core import Angle, Length
from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.documents.sheet_page import parts
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.plotting import style
from rocking_cli.plotting.moving import as_script, asset, ground_chart, moving, ratio_chart
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.questions.equiv.view import (
    PARAMETERS,
    EquivalentSide,
    is_symmetric,
    kappa_in_words,
    sentence,
    sides_of,
)
from rocking_cli.questions.error.picture import draw_linearisation
from rocking_cli.questions.error.view import ERRORS
from rocking_cli.questions.error.view import rows as error_rows
from rocking_cli.questions.margin.picture import draw_margins
from rocking_cli.questions.overturning.picture import draw_map
from rocking_cli.questions.overturning.study import Region
from rocking_cli.questions.report import view as words
from rocking_cli.questions.report.hung import hung_on
from rocking_cli.questions.report.study import Assessment, MotionResult, PulseMap, amplitude_in_g, share
from rocking_cli.studies.conclusion import Concluded, Conclusion
from rocking_cli.studies.film import Film
from rocking_cli.studies.movements import Watched
from rocking_cli.text import printable
from rocking_cli.verification.results import Verification
from rocking_cli.views.contact import contact_columns
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.response import outcome_table
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.sheet.document import Sheet, SheetPart
from rocking_cli.views.verdict import SENSE
from rocking_cli.views.verification import showing

TOTAL_BINS = 6000  # bins of the curves of all motions: each curve has some two samples in a bin
MIN_BINS, MAX_BINS = 300, 2500  # bins of the curves of one motion
ABSENT = "-"
PER_MASS = " Per unit mass of the whole structure: the file gives no masses."
SUBSCRIPT = re.compile(r"([φθλωψ]|\b[A-Za-z])_([A-Za-z]+(?:,\d)?)")
GREEK = {"lambda": "λ", "kappa1": "κ₁", "kappa2": "κ₂", "phi": "φ"}
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
Rows = list[list[str]]


OWN_FIELDS = frozenset({"drawing", "structure_text"})
"""Parts of a calculation sheet that a report leaves out, as it contains them already."""


@dataclass(frozen=True, eq=False)
class VerifiedReport:
    """A verification and its calculation sheet, for a report."""

    found: Verification
    sheet: Sheet

    @property
    def within(self) -> Sheet:
        """The sheet without parts that the report has already, with anchors distinct from the report's."""
        return replace(self.sheet, parts=[_apart(each) for each in self.sheet.parts if each.key not in OWN_FIELDS])


def _apart(part: SheetPart) -> SheetPart:
    below = [_apart(each) for each in part.parts if each.key not in OWN_FIELDS]
    return replace(part, key=f"verification-{part.key}", parts=below)


BAD_CONCLUSIONS = frozenset({Concluded.OVERTURNS, Concluded.UNKNOWN, Concluded.NOT_SATISFIED, Concluded.NOT_CHECKED})


def cautioned(found: Verification) -> list[str]:
    """Return the remarks of a verification that are cautions, such as on a tie that elongates too far."""
    remarks = [*(remark for each in found.distinct for remark in each.remarks), *found.remarks]
    sentences = dict.fromkeys(map(showing(found).say, remarks))
    return [each for each in sentences if each.startswith("Caution")]


def _is_bad(end: Conclusion | None) -> bool:
    return end is not None and end.concluded in BAD_CONCLUSIONS


def render(content: Assessment, verified: VerifiedReport | None = None) -> str:
    """Return the page of a report.

    Parameters
    ----------
    content : Assessment
        Content of the report; every text in it is escaped.
    verified : VerifiedReport, optional
        A verification to include in the report.
    """
    bins = int(np.clip(TOTAL_BINS // max(1, len(content.results)), MIN_BINS, MAX_BINS))
    sides = _shown(content)
    lengths: list[Length | Angle] = [*content.picture.sketch.lengths, *content.picture.sketch.angles]
    demands = [column for column in contact_columns(content.mechanism) if column.head is not None]
    margins = {each.given.motion.name: each.margin for each in content.results}
    page = template("report.html", symbols=symbols, greek=_greek).render(
        content=content,
        verified=verified,
        verification=parts(verified.within, level=3) if verified is not None else "",
        answer=words.in_a_sentence(content, verified.found if verified is not None else None),
        falls=_is_bad(content.conclusion) or (verified is not None and _is_bad(verified.found.conclusion)),
        verdicts=words.verdicts(content),
        overview=words.overview(content, _over(content)),
        doubts=words.doubts(content),
        cautioned=cautioned(verified.found) if verified is not None else [],
        restitution=_greek(restitution_used(content.structure)),
        drawing=inline_svg(lambda: draw_structure(content.picture, content.name), "drawing"),
        measured=[f"{each.text} ({each.direction.label})" if each.direction else each.text for each in lengths],
        directions=[f"{each.direction.label} ({SENSE[each.direction]})" for each in sides] if sides[1:] else ["value"],
        hung=hung_on(content),
        alone=words.why_alone(content) if len(content.structure.default_models) == 1 else "",
        over=_over(content),
        parameters=_parameters(content),
        advice=_advice(content),
        trust=_greek(words.trust_of_block(content)),
        geometry=_geometry(content),
        responses=[_response(content, each, k, bins) for k, each in enumerate(content.results)],
        contacts=[
            [
                each.given.motion.name + (", reversed" if sign < 0 else ""),
                *(column.cell(contact) for column in demands),
                _known(each.runs[sign]["nonlinear"]),
            ]
            for each in content.results
            for sign, contact in each.contacts.items()
        ],
        checked=any(contact.followed for each in content.results for contact in each.contacts.values()),
        contact_columns=["ground motion", *(column.head for column in demands), "outcome known"],
        margins=inline_svg(lambda: draw_margins(margins, ""), "margins") if margins else None,
        around=content.results[0].margin.around if content.results else None,
        deviations=deviations(content.results[0].margin.around) if content.results else "",
        maps=[_map(each, k) for k, each in enumerate(content.maps)],
        errors=inline_svg(lambda: draw_linearisation(content.curves, content.asked, ""), "errors")
        if content.curves
        else None,
        error_tables=[
            (
                each.direction.label if len(content.asked) > 1 else "",
                [
                    [_greek(column.cell(row)) for column in ERRORS]
                    for row in error_rows(each, content.mechanism.gravity)
                ],
            )
            for each in content.asked
        ],
        measures=[_measures(each) for each in content.results],
        style=Markup(asset("motion.css")),
        dark_figures=dark_figures(),
        script=Markup(asset("motion.js")),
    )
    return printable(page)  # names and contents of files may have characters that a page cannot hold


def symbols(text: str) -> Markup:
    """Return a text of this package as HTML, with an underscore after a symbol turned into a subscript."""
    return Markup(SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _greek(text: str) -> str:
    """Return a text of this package with the names of symbols replaced by the symbols."""
    return re.sub("|".join(GREEK), lambda word: GREEK[word[0]], text)


def _over(content: Assessment) -> str:
    """Return the label of a normalised rotation."""
    return style.over([side.phi_cr is None for side in content.structure.statics]).replace("φcr", "φ_cr")


def _number(value: float | None, digits: int = 4) -> str:
    if value is None or isnan(value):
        return ABSENT
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    return f"{mantissa} \N{MULTIPLICATION SIGN} 10{str(int(power)).translate(SUPERSCRIPTS)}" if power else mantissa


def _shown(content: Assessment) -> list[EquivalentSide]:
    """Return the directions to show; one if both have the same values."""
    sides = sides_of(content.structure)
    return sides[:1] if is_symmetric(content.structure) else sides


def _parameters(content: Assessment) -> list[dict[str, Any]]:
    shown = _shown(content)
    blocks = [side.parameters for side in shown]
    rows = [
        {
            "symbol": each.symbol,
            "values": [
                _number(block[each.key])
                + (f" ({degrees(block[each.key]):.3g}°)" if each.unit == "rad" and not isnan(block[each.key]) else "")
                for block in blocks
            ],
            "unit": each.printed_unit if content.mechanism.has_mass else each.printed_unit.removeprefix("kg "),
            "meaning": each.meaning + (PER_MASS if each.of_mass and not content.mechanism.has_mass else ""),
        }
        for each in PARAMETERS
        if not all(isnan(block[each.key]) for block in blocks)
    ]
    return rows if content.has_block else rows + _without_block(shown)


def _without_block(shown: Sequence[EquivalentSide]) -> list[dict[str, Any]]:
    """Return the further parameters of a structure without an equivalent block."""
    limits = [side.statics.limit for side in shown]
    return [
        {
            "symbol": "V''(0)/V'(0)",
            "values": [_number(side.statics.stiffening) for side in shown],
            "unit": "1/rad",
            "meaning": (
                "Stiffening: rate at which the restoring moment increases with rotation from rest, over the moment "
                "itself."
            ),
        },
        {
            "symbol": "φ_lim",
            "values": [f"{_number(limit)} ({degrees(limit):.3g}°)" for limit in limits],
            "unit": "rad",
            "meaning": (
                "Kinematic limit: the rotation at which the structure lies on the ground or locks, so that its "
                "motion ends."
            ),
        },
    ]


def _advice(content: Assessment) -> list[str]:
    shown = _shown(content)
    labels = [""] if len(shown) == 1 else [f"{side.direction.label}: " for side in shown]
    sentences = [kappa_in_words(side.block) if side.block is not None else sentence(side) for side in shown]
    if not content.has_block:
        sentences = [f"{each[0].upper()}{each[1:]}" for each in sentences]
    return [_greek(f"{label}{each}") for label, each in zip(labels, sentences, strict=True)]


def _geometry(content: Assessment) -> Rows:
    """Return the input fields that are one number or word: field, symbol, value, unit, meaning."""
    rows = []
    for key, info in type(content.mechanism).model_fields.items():
        value = getattr(content.mechanism, key)
        if key != "name" and isinstance(value, (int, float, str)):
            extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
            shown = _number(value, 6) if isinstance(value, float) else str(value)
            rows.append([key, str(extra.get("symbol", "")), shown, str(extra.get("unit", "")), info.description or ""])
    return rows


def _response(content: Assessment, result: MotionResult, k: int, bins: int) -> dict[str, Any]:
    best = result.histories["nonlinear"]
    film = Film(content.picture, best, result.motion, result.contacts[result.polarity].assumed_friction)
    pulses = [replace(each, sign=each.sign * result.polarity) for each in result.fits[:1] if result.file]
    charts = [ratio_chart(result.histories, bins), ground_chart(result.motion, pulses, bins)]
    moment = film.start
    if best.fell:  # show the moment of overturning, or otherwise that of the peak
        moment = min(float(best.time[int(np.searchsorted(best.time, best.overturning_time))]), film.end)
    elif best.peak_ratio:
        moment = float(best.time[int(np.nanargmax(np.abs(best.ratio)))])
    rows = outcome_table("", result, result.polarity, Watched(content.mechanism)).rows
    label = f"{content.name}, as it moves under {result.given.motion.name}"
    data = moving(film, charts, label=label, speed=1.0, moment=moment)
    return {
        "name": result.given.motion.name,
        "reversed": result.polarity == -1,
        "unknown": result.unknown,
        "moment": moment,
        "data": Markup(as_script(data)),
        "id": f"motion-{k}",
        "models": [words.MODELS[name] for name in result.histories],
        "rows": [[_greek(cell) for cell in row] for row in rows],
        "fits": [_fit(fit) for fit in result.fits if result.file],
        "alone": words.alone(result),
    }


def _known(run: History) -> str:
    """Return until when the outcome of a nonlinear history is known."""
    return f"until {run.known_to:.4g} s" if run.unknown else "not checked" if run.check is None else "throughout"


def _fit(fit: PulseFit) -> list[str]:
    return [
        fit.pulse.title,
        _number(amplitude_in_g(fit)),
        _number(fit.pulse.period),
        _number(fit.start),
        "reversed" if fit.sign < 0 else "as given",
        f"{100 * fit.captured:.0f}",
    ]


def _map(each: PulseMap, k: int) -> dict[str, Any]:
    shaken = each.found.structure
    places = [(name, fit.pulse.period, amplitude_in_g(fit)) for name, fit in each.marks]
    return {
        "title": each.found.shape.title,
        "shape": each.found.shape.name,
        "picture": inline_svg(lambda: draw_map(each.found, "", dimensionless=False, marks=places), f"map-{k}"),
        "share": f"{100 * share(each.found):.0f} %",
        "unknown": f"{100 * each.found.shares[Region.UNKNOWN]:.0f} %" if each.found.outcome.unknown.any() else "",
        "p": _number(shaken.p),
        "lambda": _number(shaken.lambda_),
        "rows": [
            [
                name,
                _number(fit.pulse.period),
                _number(amplitude_in_g(fit)),
                _number(2 * np.pi / fit.pulse.period / shaken.p, 3),
                _number(fit.pulse.amplitude / shaken.unit, 3),
                f"{100 * fit.captured:.0f}",
            ]
            for name, fit in each.marks
        ],
    }


def _measures(result: MotionResult) -> dict[str, Any]:
    given, measured = result.given, result.measured
    motion = given.motion
    return {
        "name": motion.name,
        "file": result.file,
        "rows": [
            ["format", motion.format, ""],
            ["unit in the file", motion.source_unit, ""],
            ["samples", f"{motion.npts}", "1"],
            ["sampling interval", _number(motion.dt), "s"],
            ["scale factor", _number(given.factor, 6), "1"],
            *([["processed", step, ""] for step in motion.processing]),
            *([["PGA of the ground", _number(result.pga_of_ground), "g"]] if motion.ground is not None else []),
            [
                f"peak acceleration ({'of the floor' if motion.ground is not None else 'PGA'})",
                _number(measured.pga),
                "g",
            ],
            ["peak velocity (PGV)", _number(measured.pgv), "m/s"],
            ["peak displacement (PGD)", _number(measured.pgd), "m"],
            ["Arias intensity", _number(measured.arias), "m/s"],
            ["significant duration, 5 to 95 % of the Arias intensity", _number(measured.significant_duration), "s"],
            ["mean period", _number(measured.mean_period), "s"],
        ],
    }
