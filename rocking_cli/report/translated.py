"""The picture of a structure in the language of a sheet: its few words, and its decimal marks."""

from __future__ import annotations

import re

from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.studies.verification.told import WITH_COMMA
from rocking_cli.views.sheet.language import Language


def translate(figure: Figure, language: Language) -> Figure:
    """The same figure with its texts in a language.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        As it is drawn, in English.
    language : Language
        The language.
    """
    for each in figure.findobj(Text):
        assert isinstance(each, Text)  # what was looked for
        words = language.words_of_pictures.get(each.get_text().split("\n")[0])
        text = each.get_text()
        if words is not None:
            text = "\n".join([words, *text.split("\n")[1:]])
        if language.key in WITH_COMMA:
            text = re.sub(r"(?<=\d)\.(?=\d)", ",", text)
        each.set_text(text)
    return figure
