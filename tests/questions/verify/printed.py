"""Steps of a calculation sheet as they are printed, read back from the mathematics of a page or of a document."""

import re
from html import unescape
from typing import NamedTuple
from xml.etree.ElementTree import fromstring

from rocking_cli.views.sheet.document import Steps

PAGE_NAMES = {"mfrac": "f", "msqrt": "rad", "msub": "sSub", "msup": "sSup", "msubsup": "sSubSup"}
"""Elements of MathML, by the names of those of Office Math that are the same."""
LISTS = "mrow", "math", "oMath", "e", "num", "den", "sub", "sup", "r"


class Step(NamedTuple):
    """A step as it is printed."""

    symbol: str
    formula: str
    numbers: str
    result: str
    unit: str
    mark: str


def formula_of(element):
    """The formula of an element, in which each line and root has parentheses of its own."""
    own = element.tag.rpartition("}")[2]
    name = PAGE_NAMES.get(own, own)
    children = [each for each in element if not each.tag.endswith("Pr")]
    inside = [formula_of(each) for each in children]
    if name == "f":
        return f"({inside[0]})/({inside[1]})"
    if name == "rad":
        return f"√({''.join(inside)})"
    if name == "d":
        opening, closing = (next(iter(each.attrib.values())) for each in element[0])
        return f"{opening}{''.join(inside)}{closing}"
    if name in ("sSub", "sSup", "sSubSup"):
        below = f"_[{inside[1]}]" if "Sub" in name else ""
        above = inside[-1] if name != "sSub" else ""
        primes = len(above) - len(above.lstrip("′"))
        return inside[0] + below + above[:primes] + (f"^[{above[primes:]}]" if above[primes:] else "")
    if name in LISTS:
        return "".join(inside)
    return (element.text or "").replace("\u2009", " ")


def same(one, other):
    """Whether two formulas are the same but for spaces and for parentheses that a line or a root makes needless."""
    return bare(one) == bare(other)


def bare(formula):
    formula = re.sub(r"(\^\[[^]]*\])(_\[[^]]*\])", r"\2\1", formula)
    return re.sub(r"[()\s]", "", formula)


def text_of(html):
    """The text of a piece of a page, with its formulas as they are read back and marks of what is above and below."""
    html = re.sub(r"<math.*?</math>", lambda each: formula_of(fromstring(each[0])), html, flags=re.DOTALL)
    html = re.sub(r"<su([bp])>(.*?)</su[bp]>", lambda each: f"{'_' if each[1] == 'b' else '^'}[{each[2]}]", html)
    return unescape(re.sub(r"<[^>]+>", "", html)).replace("\xa0", " ").strip()


def step(pieces, result, unit, mark):
    """A step of the formulas with the sign before each, the first of which is its symbol."""
    symbol, *others = pieces
    formula, numbers, *more = [*(each.partition(" ")[2] for each in others), "", ""]
    assert not any(more) and [each[0] for each in others] in ([], ["="], ["=", "="], [":"])
    gives, _, value = result.partition(" ")
    assert gives == ("⇒" if formula and not numbers else "=")
    return Step(symbol, formula, numbers, value, unit, mark)


def steps_of_page(page):
    """The steps on a page, from what is between its tags."""
    steps = []
    for what, work in re.findall(r'<li><p class="what">(.*?)</p>\s*<p class="work">(.*?)</p></li>', page, re.DOTALL):
        mark = "".join(map(text_of, re.findall(r'<span class="clause">(.*?)</span>', what)))
        *pieces, last = map(str, re.split(r'<span class="piece"[^>]*>', work)[1:])
        result, unit = map(text_of, last.split("</strong>"))
        steps.append(step([*map(text_of, pieces)], result, unit, mark))
    return steps


def steps_of_document(document):
    """The steps in a document, from its tables with formulas; the mark is the meaning with it."""
    steps = []
    for row in (row for table in document.tables for row in table.rows if row._tr.xpath(".//m:oMath")):
        what, work = row.cells[1].paragraphs
        shown = result = unit = ""
        for each in work._p.xpath("w:r | m:oMath"):
            if each.tag.endswith("}oMath"):
                shown += formula_of(each)
                continue
            text = f"^[{each.text}]" if each.xpath("w:rPr/w:vertAlign") else each.text
            if each.xpath("w:rPr/w:b"):
                result += text
            elif result:
                unit += text
            else:
                shown += text
        *pieces, gives = re.split(r" (?=[=:⇒] )", shown)
        steps.append(step(pieces, gives + result, unit.strip(), what.text))
    return steps


def items_in(parts):
    """Every item of the parts of a sheet, in order."""
    for part in parts:
        yield from part.items
        yield from items_in(part.parts)


def rows_in(parts):
    """Every step of the parts of a sheet, in order."""
    return [row for item in items_in(parts) if isinstance(item, Steps) for row in item.rows]
