"""What NTC 2018 requires of a calculation by a program (section 10.2.1); open where only the designer can write."""

from __future__ import annotations

import platform
from importlib.metadata import metadata, version
from math import isclose

from rocking_cli.codes.italian.results import ItalianVerification, ItalianVerified
from rocking_cli.views.sheet.document import Sentence, SheetPart
from rocking_cli.views.sheet.language import Language

SAME_MULTIPLIER = 1e-6  # relative difference up to which two multipliers agree


def part(say: Language, found: ItalianVerification) -> SheetPart:
    """Return the part with the headings of the code for a calculation by a program."""
    mechanism, histories = found.mechanism, found.deciding.dynamic
    licence = metadata("rocking-cli")["License-Expression"]
    kind = [Sentence(say("kind_of_analysis", states=list(found.deciding.states)))]
    if histories is not None:
        kind.append(Sentence(say("kind_dynamic", count=len(histories.records))))
    title, source = say.mechanism(mechanism.mechanism, mechanism.title), mechanism.source
    program = say("origin_of_program", version=version("rocking-cli"), licence=licence, mechanism=title, source=source)
    machine = say("machine", python=platform.python_version(), system=platform.platform(terse=True))
    texts = {
        "Kind of analysis": kind,
        "Origin and features of the program": [Sentence(program)],
        "Reliability and validation of the program": [
            Sentence(say("validation")), Sentence(say("selfcheck"), is_open=True)
        ],
        "Presentation of the results": [Sentence(say("presentation"))],
        "General information on the calculation": [Sentence(machine)],
        "Reasoned judgement of the acceptability of the results": [
            *(Sentence(_multipliers(say, each)) for each in found.distinct),
            Sentence(say("judgement"), is_open=True),
        ],
    }  # fmt: skip
    subparts = [SheetPart(f"basis-{k}", say(heading), items) for k, (heading, items) in enumerate(texts.items(), 1)]
    return SheetPart("basis", say("Calculation by a program (NTC 2018, §10.2.1)"), [], subparts)


def _multipliers(say: Language, side: ItalianVerified) -> str:
    """Return whether the multiplier of the chain is that of the mechanism."""
    alpha0, lambda_ = side.chain.alpha0, side.lambda_
    key = "multipliers_agree" if isclose(alpha0, lambda_, rel_tol=SAME_MULTIPLIER) else "multipliers_differ"
    return say(key, way=say(side.direction.label), alpha0=alpha0, lambda_=lambda_)
