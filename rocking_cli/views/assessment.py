"""View of a report: a sentence, and plain data."""

from __future__ import annotations

from rocking_cli.studies.assessment import Assessment
from rocking_cli.studies.conclusion import worst
from rocking_cli.studies.movements import Watched
from rocking_cli.studies.verification.results import Verification
from rocking_cli.views import assessment_words as words
from rocking_cli.views import processing, verification
from rocking_cli.views.conclusion import conclusion_data
from rocking_cli.views.equivalent_block import sides_of
from rocking_cli.views.margin import margin_data
from rocking_cli.views.response import HistoryDetails, fit_data, runs_data
from rocking_cli.views.view import View


def view(content: Assessment, verified: Verification | None = None) -> View:
    """Show a report: its answer in a sentence, and all its content as plain data."""
    verdicts, watched = words.verdicts(content), Watched(content.mechanism)
    ends = [
        end for end in (verified.conclusion if verified is not None else None, content.conclusion) if end is not None
    ]
    data = {
        "structure": {
            "mechanism": content.mechanism.mechanism,
            "name": content.name,
            "file": content.file.name,
            "sha256": content.file.checksum,
        },
        "answer": words.in_a_sentence(content, verified),
        "conclusion": conclusion_data(worst(ends)) if ends else None,
        "doubts": words.doubts(content),
        "parameters": {side.direction.label: side.parameters for side in sides_of(content.structure)},
        "no_block": content.structure.why_no_block,
        "motions": [
            {
                "name": each.given.motion.name,
                "file": each.file.name if each.file else None,
                "sha256": each.file.checksum if each.file else None,
                "factor": each.given.factor,
                "pga": each.pga_of_ground,
                **processing.data(each.motion),
                "headline": said.headline,
                "unknown": each.unknown,
                "answers": {item.question: item.answer for item in said.answers},
                "doubts": list(said.doubts),
                **runs_data(
                    each.runs,
                    each.neighbours,
                    HistoryDetails(watched, mechanism=content.mechanism, contacts=each.contacts),
                    each.given.motion.name,
                ),
                "polarity": each.polarity,
                "margin": margin_data(each.margin),
                "pulses": [fit_data(fit) for fit in each.fits],
            }
            for each, said in zip(content.results, verdicts, strict=True)
        ],
        "linearisation": words.trust_of_block(content),
        **({"verification": verification.data(verified)} if verified is not None else {}),
        **content.title.known,
        "command": content.title.command,
        "date": content.title.date,
        "versions": dict(content.versions),
    }
    return View(data, [words.in_a_sentence(content, verified)])
