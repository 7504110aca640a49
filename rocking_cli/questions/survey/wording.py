"""What is told of the objects of a list in plain words: their classes, the peaks that topple them, and remedies."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, floor, log10
from typing import NamedTuple

from rocking_cli.questions.survey.inventory import ListedObject
from rocking_cli.questions.survey.remedies import Remedy
from rocking_cli.questions.survey.study import LEVELS, Survey, Surveyed
from rocking_cli.views.sheet.language import Language, texts_of

DANGERS = ("falls", "may fall", "stands")
"""The classes of `Surveyed.danger`, the worst first; each is a text too."""
MIN_TOLD_SLIP = 0.01  # m


class SurveyedObject(NamedTuple):
    """An object of a list with its results."""

    item: ListedObject
    found: Surveyed

    @property
    def danger(self) -> str:
        """Its class; with enough neighbours every object has one."""
        assert self.found.danger is not None
        return self.found.danger

    def number(self, say: Language) -> str:
        """Return its number in the list, or its row."""
        return self.item.code or say("row {line}", line=self.item.line)


def objects(found: Survey) -> list[SurveyedObject]:
    """Return the objects of a survey that could be used, the worst class first."""
    every = [SurveyedObject(found.items[each.row - 1], each) for each in found.rows]
    return sorted(every, key=lambda each: DANGERS.index(each.danger))


def printed(key: str) -> Language:
    """Return a language with the texts of a survey, as documents print them."""
    return Language(key, texts_of("rocking_cli.questions.survey", key))


def in_words(remedy: Remedy, say: Language) -> str:
    """Return a remedy as a clause, with conservative numbers: what must hold is rounded up, friction down.

    Parameters
    ----------
    remedy : Remedy
        The remedy.
    say : Language
        The language, with the texts of a survey.

    Examples
    --------
    >>> from rocking_cli.views.sheet.language import ENGLISH
    >>> in_words(Remedy("isolate", suffices=True, numbers={"period": 2.0, "stroke": 0.1431}), ENGLISH)
    'an isolator with a period of 2 s and a stroke of 15 cm'
    """
    return say(_text_of(remedy), **{key: _written(key, value, say) for key, value in _of(remedy).items()})


def _text_of(remedy: Remedy) -> str:
    if remedy.against:
        return "do not tie it or stick it down: slender and brittle, it may crack"
    if remedy.kind == "wax":
        if remedy.suffices is False:
            return "wax would need {area} cm2, more than its foot has"
        pull = "{pull} of pull and " if remedy.numbers["pull"] > 0 else ""
        area = " on {area} cm2" if "area" in remedy.numbers else ", by its maker"
        return f"wax under its foot that holds {pull}{{shear}} of shear{area}"
    if remedy.kind == "slide" and not remedy.suffices:
        return "sliding needs {clearance} cm of free space, more than it has"
    return {
        "base": "a base that is {wider} cm wider, {side} cm on each side",
        "ballast": "{mass} kg of sand or weights in its foot",
        "wires": "wires that hold {force} at a height of {height} m",
        "slide": "let it slide: friction of at most {friction}, and {clearance} cm of free space all around",
        "isolate": "an isolator with a period of {period} s and a stroke of {stroke} cm",
        "below": "hold what it stands on",
        "none": "none of the remedies that were tried suffices",
    }[remedy.kind]


def _of(remedy: Remedy) -> Mapping[str, float]:
    """Return the numbers of a remedy; a base becomes wider by twice what is printed for a side."""
    numbers = remedy.numbers
    side = _whole(100 * numbers.get("wider", 0.0) / 2) / 100
    return {"side": side, "wider": 2 * side} if side else numbers


def _written(key: str, value: float, say: Language) -> str:
    """Return a number of a remedy in the unit of its text; a force with its unit."""
    if key == "friction":
        return say.formula(f"{floor(100 * value + 1e-9) / 100:g}")
    if key in ("height", "period"):
        return say.formula(f"{value:.2g}")
    if key in ("force", "pull", "shear"):
        return f"{_up(value / 1000, say)} kN" if value >= 1000 else f"{_up(value, say)} N"
    if key in ("area", "mass"):
        return _up(value * (1e4 if key == "area" else 1), say)
    return say.formula(f"{_whole(100 * value):g}")


def _whole(length: float) -> float:
    """Return a length rounded up to a half below 10, and to a whole one above [cm]."""
    step = 0.5 if length < 10 else 1.0
    return step * ceil(length / step - 1e-6)


def _up(value: float, say: Language) -> str:
    """Return a number rounded up to two digits."""
    step = 10.0 ** (floor(log10(value)) - 1) if value > 0 else 1.0
    return say.formula(f"{ceil(value / step - 1e-6) * step:.6g}")


def advice(one: SurveyedObject, say: Language, most: int | None = None) -> str:
    """Return what to do about an object, the first `most` of what suffices by itself, and what not to do.

    Remedies of an object on another one hold if that stays in place.
    """
    remedies = one.found.remedies
    helps = [each for each in remedies if each.suffices and not each.against][:most]
    helps = helps or [each for each in remedies if not each.against and (each.suffices is None or each.kind == "none")]
    slip = one.found.clearance
    if not remedies:
        slides = say("it slides: keep {slip} cm free all around", slip=say.formula(f"{_whole(100 * slip):g}"))
        return slides if slip >= MIN_TOLD_SLIP else say("nothing to do")
    text = f"; {say('or')} ".join(in_words(each, say) for each in helps)
    text = say("{text}, with {below} fixed", text=text, below=one.item.on) if one.item.on else text
    return "; ".join(dict.fromkeys([text, *(in_words(each, say) for each in remedies if each.against)]))


def topples_from(found: Surveyed, level: float, say: Language) -> str:
    """Return from what PGA [g] a share `level` of the cases topples an object: a range over several motions.

    Bounds are marked: "below" if the weakest motion tried does, ">" if the strongest does not.
    """
    reached, over, weakest = list[float](), list[float](), list[float]()
    for each in found.topples:
        factor = each.factors[level]
        (over if factor is None else reached).append(each.pga * (each.tried[1] if factor is None else factor))
        weakest += [each.pga * each.tried[0]] if factor is not None and factor <= each.tried[0] else []
    if not reached:
        return f"> {_peak(min(over), say)} g"
    low, high = (_peak(value, say) for value in (min(reached), max(*reached, *over, 0.0)))
    below = say("below {low}", low=low) if min(reached) in weakest else low
    high = f"> {high}" if over else high
    return f"{below} g" if low == high and not over else say("{low} to {high} g", low=below, high=high)


def _peak(value: float, say: Language) -> str:
    return say.formula(f"{value:.2g}" if value < 0.1 else f"{value:.{1 if value >= 1 else 2}f}")


def topples_share(found: Surveyed, say: Language) -> str:
    """Return the share of the cases of the worst motion that topple an object; a range if outcomes are unknown."""
    worst = max((each.share for each in found.topples), key=lambda each: (each.highest, each.lowest))
    low, high = say.percent(worst.lowest), say.percent(worst.highest)
    return high if low == high else say("{low} to {high}", low=low.removesuffix(" %"), high=high)


def reading(one: SurveyedObject, say: Language) -> list[str]:
    """Return number, object, class, what topples it, what to do, and how sure that is, as cells."""
    peaks = [topples_from(one.found, level, say) for level in LEVELS]
    return [one.number(say), one.item.title, say(one.danger), *peaks, advice(one, say), topples_share(one.found, say)]
