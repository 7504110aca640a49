"""Sentences in English that can be translated to other languages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

Texts = Mapping[str, Mapping[str, str]]
"""Of each language the texts by their keys, with the same slots in each."""
WITH_COMMA = frozenset({"it"})
"""The languages that write 1.5 with a comma."""


class _Comma(float):
    """A number that is written with a decimal comma, in any format."""

    def __format__(self, spec: str) -> str:
        return super().__format__(spec).replace(".", ",")


def filled(text: str, language: str, values: Mapping[str, Any]) -> str:
    """Fill the slots of a text, with numbers as the language writes them."""
    if language in WITH_COMMA:
        values = {name: _Comma(value) if isinstance(value, float) else value for name, value in values.items()}
    return text.format(**values)


class Told(str):
    """A sentence in English, as a string, that can be translated to other languages."""

    __slots__ = ("_key", "_texts", "_values")
    _key: str
    _texts: Texts
    _values: Mapping[str, Any]

    @classmethod
    def of(cls, texts: Texts, key: str, **values: Any) -> Self:
        """Return the sentence of a key with its slots filled; values that are sentences are translated with it."""
        told = cls(filled(texts["en"][key], "en", values))
        told._key, told._texts, told._values = key, texts, values
        return told

    def said_in(self, language: str) -> str:
        """Return the sentence in the given language."""
        values = {k: v.said_in(language) if isinstance(v, Told) else v for k, v in self._values.items()}
        return filled(self._texts[language][self._key], language, values)


def said_in(language: str, text: str) -> str:
    """Return a sentence in the given language if a translation exists, otherwise unchanged."""
    return text.said_in(language) if isinstance(text, Told) else text
