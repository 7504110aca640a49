"""The language of a sheet: its texts, and its number format."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, date, datetime
from functools import cache, cached_property
from importlib.resources import files
from math import isnan
from string import Formatter
from time import time
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking_cli import names
from rocking_cli.studies.remark import MINUS, Remark, in_plain
from rocking_cli.views import view

if TYPE_CHECKING:
    from rocking_cli.verification.results import Evaluated, Working

WITH_COMMA = frozenset({"it"})
"""The languages that write 1.5 with a comma."""
SIGNIFICANT_DIGITS = 6  # results recomputed from printed numbers agree to five digits
ABSENT = "–"
GROUND_NAME = "the ground"
OUTSIDE_SIGNS = str.maketrans("'[]|", "′()/")
DECIMAL = re.compile(r"(?<![\w§.])(\d+)\.(\d+)(?![\d.]*\.\d)")  # as in 0.5, and not as in §8.3 or 8.7.1
THOUSANDS = re.compile(r"\d{1,3}(,\d{3})+")
ADVICE = re.compile("⟦[^⟧]*⟧")
"""What the operator of the program may do: in texts for the terminal, and not on pages that are filed."""
SENTENCE_END = re.compile(r"(?<=\.) (?=[A-Z])")


def texts_of(package: str, key: str) -> Mapping[str, str]:
    """Return the texts that a package has in a language: by keys, or by their English form; none without a file."""
    file = files(package) / "texts" / f"{key}.toml"
    return _parsed(file.read_text(encoding="utf-8") if file.is_file() else "")


@cache
def _parsed(text: str) -> Mapping[str, str]:
    import tomllib

    return {name: " ".join(words.split()) for name, words in tomllib.loads(text).items()}


class _Printed(Formatter):
    """The format of texts in which numbers are written as a language prints them."""

    def __init__(self, say: Language) -> None:
        self.say = say

    def format_field(self, value: Any, spec: str) -> str:
        text: str = super().format_field(value, spec)
        return self.say.printed(text) if isinstance(value, float) else text


class BodyName(NamedTuple):
    """Name of a body in a line of a calculation, which may be the subscript of a symbol."""

    mechanism: str
    name: str
    symbol: str = ""


@dataclass(frozen=True)
class Language:
    """A language of the sheet.

    Parameters
    ----------
    key : str
        "en" or "it".
    own : mapping of str to str
        The texts of a code, in addition to those of every sheet.
    is_plain : bool
        Whether texts and numbers are in plain characters, as for the terminal.
    """

    key: str
    own: Mapping[str, str] = field(default_factory=dict, compare=False)
    is_plain: bool = False

    @cached_property
    def texts(self) -> Mapping[str, str]:
        """Texts of the language, by key or by their English form."""
        return {**texts_of("rocking_cli.views.sheet", self.key), **self.own}

    def __call__(self, text: str | Remark, /, **values: Any) -> str:
        """Return a text in this language, with its slots filled.

        Parameters
        ----------
        text : str or Remark
            The key of a text, or its English form: without a translation it stays as it is.
        **values
            Values of the slots: numbers, names, remarks, or lists of these. Marks of formulas in names are escaped.
        """
        key, values = (text.key, dict(text.values)) if isinstance(text, Remark) else (text, values)
        translated = self.texts.get(key, key)
        translated = in_plain(translated) if self.is_plain else ADVICE.sub("", translated)
        if not values:
            return translated
        return _Printed(self).format(translated, **{name: self._value(value) for name, value in values.items()})

    def _value(self, value: Any) -> Any:
        if isinstance(value, Remark):
            return self(value)
        if isinstance(value, list):
            *before, last = map(self._value, value)
            return f"{', '.join(before)} {self('and')} {last}" if before else last
        return plain(value) if isinstance(value, str) and not self.is_plain else value

    def number(self, value: float | None, digits: int = SIGNIFICANT_DIGITS) -> str:
        """Return a number as it is printed."""
        if self.is_plain:
            return self.formula(view.number(value, digits))
        if value is None or isnan(value):
            return ABSENT
        return self.printed(f"{value + 0.0:.{digits}g}")

    def percent(self, share: float) -> str:
        """Return a share in per cent, as it is printed."""
        return self.formula(names.percent(share)).replace("-", MINUS)

    def printed(self, number: str) -> str:
        """Return a number that Python wrote, such as -1.2e-05, as the language prints it."""
        if self.is_plain:
            return self.formula(number)
        mantissa, _, power = number.partition("e")
        text = self.formula(mantissa.replace("-", MINUS))
        return f"{text} · 10^[{str(int(power)).replace('-', MINUS)}]" if power else text

    def written(self, line: Evaluated) -> Working:
        """Return a line of a calculation in this language; its formula means a key of the texts, or an English text."""
        filled = {name: self.name(value) for name, value in line.names.items()}
        numbers = {name: self.formula(each) if isinstance(each, str) else each for name, each in line.numbers.items()}
        working = line.formula.working(line.value, filled, write=self.number, marks=self.formula, **numbers)
        return replace(
            working,
            meaning=self(line.formula.meaning, **filled),
            unit=self.texts.get(working.unit, working.unit),
            clause=self.texts.get(working.clause, working.clause),
        )

    def name(self, value: Any) -> Any:
        """Return the name of a body, several joined by plus signs, or a remark, in this language; else the value."""
        if isinstance(value, BodyName):
            text = self.body(value.mechanism, value.name)
            return f"{value.symbol}_[{as_subscript(text)}]" if value.symbol else text
        if isinstance(value, list):
            return " + ".join(map(self.name, value))
        return self(value) if isinstance(value, Remark) else value

    def formula(self, formula: str) -> str:
        """Return a formula with the decimal marks of its constants, such as 1.68, as the language writes them."""
        return DECIMAL.sub(r"\1,\2", formula) if self.key in WITH_COMMA else formula

    def items(self, text: str) -> str:
        """Return items parted by commas, such as T1=0.4,n=3, rounded, with the decimal marks of the language."""
        text = re.sub(r"\d+\.\d{7,}", lambda each: f"{float(each[0]):.{SIGNIFICANT_DIGITS}g}", text)
        return self.formula(text.replace(",", "; ")) if self.key in WITH_COMMA else text

    def today(self) -> str:
        """Return the date in words: of today, or of SOURCE_DATE_EPOCH, for a document with the same bytes each day."""
        return self.day(datetime.fromtimestamp(float(os.environ.get("SOURCE_DATE_EPOCH") or time()), UTC))

    def day(self, when: date) -> str:
        """Return a date in words."""
        return f"{when.day} {self(f'{when:%B}')} {when.year}"

    def mechanism(self, key: str, title: str) -> str:
        """Return the title of a mechanism in this language; the given title if there is no translation."""
        return self.texts.get(f"mechanism_{key}", plain(title))

    def body(self, mechanism: str, name: str) -> str:
        """Return the name of a body of a mechanism in this language; names that the user chose stay as they are."""
        return self.recognised(f"body_{mechanism}", name)

    def joint(self, mechanism: str, label: str) -> str:
        """Return the name of a joint of a mechanism in this language: its own, or that of the bodies it connects."""
        if name := self.texts.get(f"body_{mechanism} {label}"):
            return name
        bodies = (self(each) if each == GROUND_NAME else self.body(mechanism, each) for each in label.split(" and "))
        return f" {self('and')} ".join(bodies)

    def caution(self, key: str, text: str) -> str:
        """Return the caution about a mechanism in this language; the given text if there is no translation."""
        return self.texts.get(f"caution_{key}", text if self.is_plain else plain(text))

    def recognised(self, family: str, text: str) -> str:
        """Return a text that a mechanism wrote in English, in this language; what is not recognised stays as it is.

        Texts of a family are `FAMILY ENGLISH`, with slots for what varies; slots `name...` and `given...` keep what is
        in them. Each sentence is recognised alone; one that is not, is taken apart at semicolons, then at commas.
        """
        if len(sentences := SENTENCE_END.split(text)) > 1:
            return " ".join(self.recognised(family, each) for each in sentences)
        if (translated := self.matched(family, text)) is not None:
            return translated
        for separator in ("; ", ", "):
            if separator in text:
                return separator.join(self.recognised(family, each) for each in text.split(separator))
        return text if self.is_plain else plain(text)

    def matched(self, family: str, text: str) -> str | None:
        """Return a text that is one of a family as a whole, in this language; None for any other."""
        for english, translated in self._families.get(family, ()):
            if match := _pattern(english).fullmatch(text):
                parts = {key: self._part(family, key, part) for key, part in match.groupdict().items()}
                pieces = Formatter().parse(translated)  # numbers are texts already: how they are written is passed over
                return "".join(before + (parts[name] if name else "") for before, name, _, _ in pieces)
        return None

    def _part(self, family: str, key: str, part: str) -> str:
        if key.startswith(("name", "given")):
            return part if self.is_plain else plain(part)
        part = part.replace(",", ".") if self.key in WITH_COMMA and THOUSANDS.fullmatch(part) else part
        return self.formula(self.recognised(family, part))

    @cached_property
    def _families(self) -> Mapping[str, Sequence[tuple[str, str]]]:
        """The texts by the first word of their keys: the rest of the key, and the text."""
        families = defaultdict[str, list[tuple[str, str]]](list)
        for key, text in self.texts.items():
            family, _, english = key.partition(" ")
            families[family].append((english, text))
        return families


@cache
def _pattern(english: str) -> re.Pattern[str]:
    """Return the pattern of an English text with slots; a slot that stands twice is filled alike."""
    known, pattern = set[str](), ""
    for before, name, _, _ in Formatter().parse(english):
        pattern += re.escape(before)
        if name:
            sign = "[^;,]" if name.startswith("name") else "."  # a name is not parted by semicolons and commas
            pattern += f"(?P={name})" if name in known else f"(?P<{name}>{sign}*?)"
            known.add(name)
    return re.compile(pattern)


def translated(say: Language, shown: view.View) -> view.View:
    """Return a view in a language: its texts of the family `shown`, and its numbers with the marks of the language."""
    if say.key == ENGLISH.key:
        return shown

    def lines(text: str) -> str:
        return "\n".join(say.recognised("shown", line) for line in text.split("\n"))

    def table(each: view.Table) -> view.Table:
        rows = [[say.formula(lines(cell)) if k in each.numbers else lines(cell) for k, cell in enumerate(row)]
                for row in each.rows]  # fmt: skip
        return replace(each, title=lines(each.title), columns=[*map(lines, each.columns)], rows=rows)

    parts = [table(part) if isinstance(part, view.Table) else type(part)(lines(part)) for part in shown.parts]
    return view.View(shown.data, parts)


WORD_JOINER = "\N{WORD JOINER}"
"""Follows a sign in a text that is no mark."""


def as_subscript(name: str) -> str:
    """Return a name that users gave, without the signs of formulas and tables, so that it may be a subscript."""
    return name.translate(OUTSIDE_SIGNS)


def plain(text: str, *, keep_code: bool = False) -> str:
    """Escape a text so that nothing in it is read as a sub- or superscript, or as code unless it is kept."""
    return re.sub(r"[_^](?=\[)" if keep_code else r"[_^](?=\[)|`", rf"\g<0>{WORD_JOINER}", text)


ENGLISH = Language("en", is_plain=True)
"""Plain English, as on the terminal."""
