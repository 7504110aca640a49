"""Translation of the words and decimal marks in the drawing of a structure."""

from __future__ import annotations

import re

from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.studies.verification.told import WITH_COMMA
from rocking_cli.views.sheet.language import Language


def translate(figure: Figure, language: Language) -> Figure:
    """Translate the texts of a figure to a language, and return the figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure with English texts.
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
