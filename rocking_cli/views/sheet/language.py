"""The language of a sheet: its texts, and its number format."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from functools import cached_property
from math import isnan
from typing import Any, NamedTuple

from rocking_cli.studies.verification.told import WITH_COMMA, filled, said_in
from rocking_cli.studies.verification.working import MINUS, Formula, Working
from rocking_cli.views.sheet import texts_en, texts_it

DIGITS = 6  # significant: recomputed from printed numbers, a result agrees to five
ABSENT = "–"


class LanguageTexts(NamedTuple):
    """Words of a language: texts, names of months, titles and cautions of mechanisms, and words in drawings."""

    texts: Mapping[str, str]
    months: Sequence[str]
    mechanisms: Mapping[str, str]
    cautions: Mapping[str, str]
    pictures: Mapping[str, str]


TABLES = {
    key: LanguageTexts(each.TEXTS, each.MONTHS, each.MECHANISMS, each.CAUTIONS, each.PICTURES)
    for key, each in (("en", texts_en), ("it", texts_it))
}


@dataclass(frozen=True)
class Language:
    """A language of the sheet.

    Parameters
    ----------
    key : str
        "en" or "it".
    own : mapping of str to str
        The texts of a code, in addition to those of every sheet.
    spelled : mapping of str to str
        Printed forms of the symbols in plain sentences.
    """

    key: str
    own: Mapping[str, str] = field(default_factory=dict, compare=False)
    spelled: Mapping[str, str] = field(default_factory=dict, compare=False)

    @cached_property
    def texts(self) -> Mapping[str, str]:
        """Texts of the language, by key."""
        return {**TABLES[self.key].texts, **self.own}

    def say(self, key: str, **values: Any) -> str:
        """Return a text with its slots filled; marks of formulas in values are escaped."""
        ready = {name: plain(value) if isinstance(value, str) else value for name, value in values.items()}
        return filled(self.texts[key], self.key, ready)

    def remark(self, text: str) -> str:
        """Return a sentence of the study in this language, if translated, with its symbols as printed."""
        said, marks = said_in(self.key, text), "|".join(map(re.escape, self.spelled))
        return re.sub(marks, lambda found: self.spelled[found[0]], said) if marks else said

    def number(self, value: float | None, digits: int = DIGITS) -> str:
        """Return a number as it is printed."""
        if value is None or isnan(value):
            return ABSENT
        mantissa, _, power = f"{value + 0.0:.{digits}g}".partition("e")
        text = mantissa.replace("-", MINUS)
        if self.key in WITH_COMMA:
            text = text.replace(".", ",")
        return f"{text} · 10^[{str(int(power)).replace('-', MINUS)}]" if power else text

    def step(
        self, formula: Formula, value: float, names: Mapping[str, Any] | None = None, /, **numbers: Any
    ) -> Working:
        """Return a line of a calculation by a formula of the code, in this language; see `Formula.working`."""
        found = formula.working(value, names, write=self.number, marks=self.formula, **numbers)
        return replace(
            found,
            meaning=self.say(found.meaning, **(names or {})),
            unit=self.texts.get(f"unit {found.unit}", found.unit),
            clause=self.texts.get(f"clause {found.clause}", found.clause),
        )

    def formula(self, formula: str) -> str:
        """Return a formula with the decimal marks of its constants, such as 1.68, as the language writes them."""
        return re.sub(r"(?<=\d)\.(?=\d)", ",", formula) if self.key in WITH_COMMA else formula

    def day(self, when: date) -> str:
        """Return a date in words."""
        return f"{when.day} {TABLES[self.key].months[when.month - 1]} {when.year}"

    @property
    def words_of_pictures(self) -> Mapping[str, str]:
        """Translations of the words in drawings, by their English form."""
        return TABLES[self.key].pictures

    def mechanism(self, key: str, title: str) -> str:
        """Return the title of a mechanism in this language; the given title if there is no translation."""
        return TABLES[self.key].mechanisms.get(key, plain(title))

    def caution(self, key: str, text: str) -> str:
        """Return the caution about a mechanism in this language; the given text if there is no translation."""
        return TABLES[self.key].cautions.get(key, plain(text))


def plain(text: str) -> str:
    """Escape a text so that nothing in it is read as a sub- or superscript."""
    return re.sub(r"([_^])\[", "\\1\N{WORD JOINER}[", text)
