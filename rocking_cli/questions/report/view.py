"""View of a report: its answers in sentences, and all its content as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rocking_cli.names import peaks_over
from rocking_cli.questions.equiv.view import sides_of
from rocking_cli.questions.error.view import trust
from rocking_cli.questions.margin.view import margin_data
from rocking_cli.questions.report.study import Assessment
from rocking_cli.questions.report.words import PACKAGE, context, language_of
from rocking_cli.studies.conclusion import worst
from rocking_cli.studies.movements import Watched
from rocking_cli.verification.results import Verification
from rocking_cli.views import verification
from rocking_cli.views.conclusion import conclusion_data, headline, of_verification
from rocking_cli.views.response import fit_data, runs_data
from rocking_cli.views.sheet import template
from rocking_cli.views.sheet.document import Sentence, SheetPart
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import View, processing_data


def view(content: Assessment, verified: Verification | None = None, language: str = "en") -> View:
    """Show a report: its answer in a sentence, and all its content as plain data."""
    say, watched = language_of("en", is_plain=True), Watched(content.mechanism)
    values = context(content, say, verified)

    def said(name: str, **more: Any) -> list[SheetPart]:
        return template.parts(say, PACKAGE, name, {**values, **more})

    def answer(say: Language) -> str:
        parts = template.parts(say, PACKAGE, "answer", context(content, say, verified))
        if verified is None:
            return " ".join(_sentences(parts))
        by_code = verification.showing(verified).in_language(say.key).say
        return " ".join([*of_verification(verified, by_code), *_sentences(parts)])

    ends = [
        end for end in (verified.conclusion if verified is not None else None, content.conclusion) if end is not None
    ]
    over = peaks_over([side.phi_cr is None for side in content.structure.statics])
    data = {
        "structure": {
            "mechanism": content.mechanism.mechanism,
            "name": content.name,
            "file": content.file.name,
            "sha256": content.file.checksum,
        },
        "answer": answer(say),
        "conclusion": conclusion_data(worst(ends)) if ends else None,
        "doubts": _sentences(said("doubts")),
        "parameters": {side.direction.label: side.parameters for side in sides_of(content.structure)},
        "no_block": content.structure.why_no_block,
        "motions": [
            {
                "name": each.given.motion.name,
                "file": each.file.name if each.file else None,
                "sha256": each.file.checksum if each.file else None,
                "factor": each.given.factor,
                "pga_g": each.pga_of_ground,
                **processing_data(each.motion),
                "headline": f"{headline(each.conclusion, over)}{' (close)' if each.close else ''}",
                "unknown": each.unknown,
                "answers": _by_heading(said("answers", result=each, key="")),
                "doubts": _sentences(said("checks", result=each)),
                **runs_data(each, watched),
                "polarity": each.polarity,
                "margin": margin_data(each.margin),
                "pulses": [fit_data(fit) for fit in each.fits],
            }
            for each in content.results
        ],
        "linearisation": trust_of_block(content),
        **({"verification": verification.data(verified)} if verified is not None else {}),
        **content.title.known,
        "command": content.title.command,
        "date": content.title.date,
        "versions": dict(content.versions),
    }
    return View(data, [answer(language_of(language, is_plain=True))])


def _sentences(parts: list[SheetPart]) -> list[str]:
    return [item.text for part in parts for item in part.items if isinstance(item, Sentence)]


def _by_heading(parts: list[SheetPart]) -> Mapping[str, str]:
    return {part.heading: " ".join(_sentences([part])) for part in parts}


def trust_of_block(content: Assessment) -> str:
    """Return the error of the equivalent block in words, or why there is none."""
    if content.asked:
        return trust(content.curves, content.asked)
    none = "No equivalent block exists here, so there is no error to report"
    return f"{'The error of the equivalent block is left out' if content.has_block else none}: {content.no_error}."
