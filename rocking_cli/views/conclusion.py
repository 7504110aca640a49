"""Words of a conclusion, the same on every surface that shows it; of a verification in English and Italian."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rocking_cli import names
from rocking_cli.studies.conclusion import Concluded, Conclusion
from rocking_cli.studies.verification.results import Verification
from rocking_cli.studies.verification.told import Told

MOST_DIGITS = 9
ENGLISH = {
    "satisfied": "The verification is satisfied.",
    "satisfied_at": "The verification is satisfied at all limit states that the site gives ({states}).",
    "not_satisfied": "The verification is not satisfied.",
    "unknown": "The verification is not satisfied: the outcome under the motions is unknown, which does not pass.",
    "not_checked": "The site does not give what the code requires: no verification was made.",
    "governs_at": "{state} governs ({method}{direction}): {ratio}.",
    "governs": "{method} governs{direction}: {ratio}.",
    "direction_positive": ", positive direction",
    "direction_negative": ", negative direction",
    "ratio": "capacity over demand {ratio:.{digits}g}",
    "past": "a motion takes the structure past its capacity",
    "unproven": "neither satisfied nor disproved",
    "elastic": "Not counted: the stiffness of {names}, because an elastic tie would never let the structure fall.",
    "too_few": "Not counted: time histories under {names}, because the code requires more records.",
    "too_few_and_past": (
        "Not counted, because the code requires more records: time histories under {names}, which take the structure "
        "past its capacity."
    ),
    "not_covered": "The verification does not cover the structure, because another mechanism starts first.",
    "starts_first": "Another mechanism starts before the one verified, at the joint between {names}.",
}
ITALIAN = {
    "satisfied": "La verifica è soddisfatta.",
    "satisfied_at": "La verifica è soddisfatta per tutti gli stati limite assegnati dal sito ({states}).",
    "not_satisfied": "La verifica non è soddisfatta.",
    "unknown": "La verifica non è soddisfatta: l'esito sotto gli accelerogrammi non è noto.",
    "not_checked": "Il sito non assegna quanto richiede la norma: la verifica non è stata svolta.",
    "governs_at": "Governa lo {state} ({method}{direction}): {ratio}.",
    "governs": "Governa: {method}{direction}: {ratio}.",
    "direction_positive": ", verso positivo",
    "direction_negative": ", verso negativo",
    "ratio": "rapporto tra capacità e domanda {ratio:.{digits}g}",
    "past": "un accelerogramma porta la struttura oltre la sua capacità",
    "unproven": "né soddisfatta né smentita",
    "elastic": ("Non è messa in conto la rigidezza di {names}: con una catena elastica la struttura non cadrebbe mai."),
    "too_few": "Non sono messe in conto le analisi sotto {names}: la norma richiede più accelerogrammi.",
    "too_few_and_past": (
        "Non sono messe in conto, perché la norma richiede più accelerogrammi, le analisi sotto {names}, che portano "
        "la struttura oltre la sua capacità."
    ),
    "not_covered": "La verifica non riguarda la struttura, perché un altro meccanismo si attiva prima.",
    "starts_first": "Un altro meccanismo si attiva prima di quello verificato, al giunto tra {names}.",
}
TEXTS = {"en": ENGLISH, "it": ITALIAN}


def of_verification(found: Verification, title: str | None = None) -> list[Told]:
    """Return the conclusion of a verification as sentences, which can be translated.

    Parameters
    ----------
    found : Verification
        The verification.
    title : str, optional
        Name of the method that governs, in the language of the reader; by default that of the method.
    """
    end = found.conclusion
    covers = all(each.what != "mechanism" for each in end.left_out)
    first = end.concluded.value if covers or end.concluded is not Concluded.NOT_CHECKED else "not_covered"
    said = [_told("satisfied_at", states=", ".join(end.limit_states)) if _at_all(end) else _told(first)]
    if end.concluded is not Concluded.NOT_CHECKED:
        said.append(_governs(end, title or _method(found, end)))
    for why in dict.fromkeys(each.why for each in end.left_out):
        said.append(_told(why, names=", ".join(each.name for each in end.left_out if each.why == why)))
    return said


def _at_all(end: Conclusion) -> bool:
    return end.concluded is Concluded.SATISFIED and len(end.limit_states) > 1


def _governs(end: Conclusion, method: str) -> Told:
    direction = _told(f"direction_{end.direction}") if end.direction else ""
    if end.ratio is not None:
        ratio = _told("ratio", ratio=end.ratio, digits=digits_beside_one(end.ratio))
    else:
        ratio = _told("unproven" if end.concluded is Concluded.UNKNOWN else "past")
    if end.limit_state:
        return _told("governs_at", state=end.limit_state, direction=direction, method=method, ratio=ratio)
    return _told("governs", direction=direction, method=f"{method[:1].upper()}{method[1:]}", ratio=ratio)


def _method(found: Verification, end: Conclusion) -> str:
    each = next(iter(found.directions.values()))
    title = each.methods[end.method].title if end.method in each.methods else "time histories"
    return title.removesuffix(f" at {end.limit_state}")


def _told(key: str, **values: Any) -> Told:
    return Told.of(TEXTS, key, **values)


def digits_beside_one(ratio: float) -> int:
    """Return how many digits of a ratio show on which side of 1 it is, at least three."""
    return next((n for n in range(3, MOST_DIGITS) if (float(f"{ratio:.{n}g}") < 1) == (ratio < 1)), MOST_DIGITS)


def headline(end: Conclusion) -> str:
    """Return what is concluded in a few words, for a heading: with the peak, the limit state, or until when known."""
    if end.known_until is not None:
        return f"{names.UNKNOWN} after {end.known_until:.3g} s"
    if end.concluded is Concluded.ROCKS and end.ratio is not None:
        return f"{names.ROCKS} to {end.ratio:.3g}"
    said = end.concluded.value.replace("_", " ")
    return f"{end.limit_state} {said}" if end.limit_state and end.concluded is not Concluded.SATISFIED else said


def conclusion_data(end: Conclusion) -> dict[str, Any]:
    """Return a conclusion as plain data: absent texts are null, and what does not apply is left out."""
    lists = ("limit_states", "motions", "polarities", "directions")
    found = {key: list(each) if key in lists else None if each == "" else each for key, each in asdict(end).items()}
    found["left_out"] = [each._asdict() for each in end.left_out]
    found["share"] = end.share._asdict() if end.share is not None else None
    return found
