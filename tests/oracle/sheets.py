"""Calculation sheets read back from their HTML, and their formulas evaluated as a pocket calculator does.

    sheet = Sheet.read(Path("sheet.html").read_text(encoding="utf-8"))
    [value_of(each.numbers) for each in sheet.items if isinstance(each, Step) and each.numbers]

A formula is a list of tokens: numbers as printed, symbols such as `a_[0]^[*]`, signs. A fraction and a root
have parentheses of their own, an exponent is `^ ( ... )`, and factors that follow one another are multiplied.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import unescape
from itertools import chain
from math import floor, log, log10, pi, sqrt
from typing import NamedTuple
from xml.etree.ElementTree import Element, fromstring

SIGNS = {"+", "−", "·", "/", ";", ")", "]", "≤", "≥", "="}
"""Signs that end a product of factors that follow one another."""
FUNCTIONS = {"max": max, "min": min, "ln": log}
ITEM = re.compile(
    r'<h(?P<level>[1-5])\b[^>]*>(?P<heading>.*?)</h[1-5]>|<table class="grid">(?P<table>.*?)</table>'
    r'|<li><p class="what">(?P<what>.*?)</p>\s*<p class="work">(?P<work>.*?)</p></li>'
    r"|<pre><code>(?P<listing>.*?)</code></pre>|<p\b(?P<kind>[^>]*)>(?P<text>.*?)</p>",
    re.DOTALL,
)

Tokens = list[str]


class Unknown(Exception):
    """A symbol in a formula that has no value."""


class Heading(NamedTuple):
    """A heading and its level."""

    level: int
    text: str


class Sentence(NamedTuple):
    """A paragraph, and its attributes."""

    kind: str
    text: str


class Listing(NamedTuple):
    """The lines of a file, or a command."""

    text: str


class Grid(NamedTuple):
    """A table with its caption."""

    caption: str
    heads: list[str]
    rows: list[list[str]]

    def column(self, head: str) -> list[str]:
        """Return the cells under a head."""
        return [row[self.heads.index(head)] for row in self.rows]


class Step(NamedTuple):
    """A line of the calculation; `relation` is "=" or ":", by which the result was found."""

    what: str
    symbol: str
    relation: str
    formula: Tokens
    numbers: Tokens
    result: str
    unit: str


Item = Heading | Sentence | Listing | Grid | Step


def tokens(element: Element) -> Tokens:
    """Return the tokens of a formula in MathML."""
    inside = [tokens(each) for each in element]
    match element.tag:
        case "mspace":
            return []
        case "mn" | "mi" | "mo":
            return [element.text or ""]
        case "mfrac":
            return ["(", "(", *inside[0], ")", "/", "(", *inside[1], ")", ")"]
        case "msqrt":
            return ["√", "(", *chain(*inside), ")"]
        case "msub" | "msup" | "msubsup":
            base, above = inside[0], inside[-1] if "sup" in element.tag else []
            if "sub" in element.tag:
                base = [f"{''.join(base)}_[{''.join(element[1].itertext())}]"]
            while above and above[0] in ("′", "*"):
                base, above = [f"{''.join(base)}{'′' if above[0] == '′' else '^[*]'}"], above[1:]
            return [*base, "^", "(", *above, ")"] if above else base
    return [*chain(*inside)]


def text_of(html: str) -> str:
    """Return a piece of a page as text, with marks of what is above and below."""
    html = re.sub(r"<su([bp])>(.*?)</su[bp]>", lambda each: f"{'_' if each[1] == 'b' else '^'}[{each[2]}]", html)
    return unescape(re.sub(r"<[^>]+>", "", html)).replace("\xa0", " ").strip()


def step(what: str, work: str) -> Step:
    """Return a line of the calculation from its two paragraphs."""
    *pieces, last = re.split(r'<span class="piece"[^>]*>', work)[1:]
    formulas = [
        [*chain(*(tokens(fromstring(each)) for each in re.findall(r"<math.*?</math>", piece, re.DOTALL)))]
        for piece in pieces
    ]
    result, unit = map(text_of, last.split("</strong>"))
    relation = text_of(pieces[1])[0] if len(pieces) > 1 else ""
    symbol, formula, numbers = [*formulas, [], []][:3]
    return Step(text_of(what), "".join(symbol), relation, formula, numbers, result.split(" ", 1)[1], unit)


def grid(table: str) -> Grid:
    """Return a table."""
    cells = [
        [*map(text_of, re.findall(r"<t[hd]\b[^>]*>(.*?)</t[hd]>", row, re.DOTALL))]
        for row in re.findall(r"<tr>(.*?)</tr>", table, re.DOTALL)
    ]
    caption = re.search(r"<caption>(.*?)</caption>", table, re.DOTALL)
    return Grid(text_of(caption[1]) if caption else "", cells[0], cells[1:])


@dataclass
class Sheet:
    """What a sheet has, in its order; files are those that it lists."""

    items: list[Item]
    files: list[str] = field(default_factory=list)

    @classmethod
    def read(cls, page: str) -> Sheet:
        """Return the sheet on a page."""
        body = re.sub(r"<style.*?</style>|<svg.*?</svg>|<nav.*?</nav>", "", page, flags=re.DOTALL)
        items: list[Item] = []
        for each in ITEM.finditer(body):
            if each["level"]:
                items.append(Heading(int(each["level"]), text_of(each["heading"])))
            elif each["table"]:
                items.append(grid(each["table"]))
            elif each["what"]:
                items.append(step(each["what"], each["work"]))
            elif each["listing"]:
                items.append(Listing(unescape(each["listing"])))
            else:
                items.append(Sentence(each["kind"], text_of(each["text"])))
        return cls(items, [each.text for each in items if isinstance(each, Listing)][1:])


def number(text: str) -> float:
    """Return a number as it is printed, with a decimal point or comma, and a power of ten."""
    mantissa, _, power = text.replace("−", "-").replace(",", ".").partition(" · 10^[")
    return float(mantissa) * 10.0 ** int(power.rstrip("]") or 0)


def numbers_in(text: str) -> list[float]:
    """Return all numbers in a text; a minus before one is that of a difference or of itself."""
    return [abs(number(each)) for each in re.findall(r"\d+(?:[.,]\d+)?(?: · 10\^\[[−\d]+\])?", text)]


def unit_of_digit(value: float, digit: int = 5) -> float:
    """Return one unit of a significant digit of a number; 0 of zero."""
    return 10.0 ** (floor(log10(abs(value))) - digit + 1) if value else 0.0


class Reader:
    """Evaluates a formula.

    Parameters
    ----------
    formula : list of str
        Its tokens.
    known : mapping of str to float
        Values of symbols, also of several tokens, such as `a_[g]S`.
    rows : sequence of mappings
        Values of the symbols under a sum, by rows.
    """

    def __init__(self, formula: Tokens, known: Mapping[str, float], rows: Sequence[Mapping[str, float]] = ()) -> None:
        self.formula, self.known, self.rows, self.at = formula, known, rows, 0

    @property
    def next(self) -> str:
        return self.formula[self.at] if self.at < len(self.formula) else ""

    def take(self, *wanted: str) -> bool:
        found = self.next in wanted
        self.at += found
        return found

    def value(self) -> float:
        """The value of the whole formula; a value between or above bounds is held there."""
        found = self.sum()
        if self.take("≥"):
            found = max(found, self.sum())
        if self.take("≤"):
            middle = self.sum()
            assert self.take("≤")
            found = max(found, min(middle, self.sum()))
        assert not self.next, self.formula
        return found

    def sum(self) -> float:
        found = -self.product() if self.take("−") else self.product()
        while self.next in ("+", "−"):
            sign = 1 if self.take("+") else -1 if self.take("−") else 0
            found += sign * self.product()
        return found

    def product(self) -> float:
        found = self.power()
        while self.next and self.next not in SIGNS - {"·", "/"}:
            if self.take("/"):
                found /= self.power()
            else:
                self.take("·")
                found *= self.power()
        return found

    def power(self) -> float:
        found = self.atom()
        return found ** self.atom() if self.take("^") else found

    def inside(self) -> Tokens:
        """The tokens up to the bracket that closes the one before."""
        depth, end = 1, self.at
        while depth:
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(self.formula[end], 0)
            end += 1
        return self.formula[self.at : end - 1]

    def body(self) -> Tokens:
        """The tokens of the product under a sum."""
        depth, end = 0, self.at
        while end < len(self.formula) and (depth or self.formula[end] not in SIGNS):
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(self.formula[end], 0)
            end += 1
        return self.formula[self.at : end]

    def atom(self) -> float:
        token = self.next
        self.at += 1
        if re.match(r"\d", token):
            return number(token)
        if token in ("(", "["):
            return self.group()
        if token == "π":
            return pi
        if token == "√":
            return sqrt(self.atom())
        if token == "−":
            return -self.power()
        if token == "Δ":
            token += self.next
            self.at += 1
        if token == "Σ":
            body = self.body()
            self.at += len(body)
            if (whole := "Σ" + "".join(body)) in self.known:
                return self.known[whole]
            return sum(Reader(body, {**self.known, **row}).value() for row in self.rows)
        if token in FUNCTIONS:
            assert self.take("(")
            values = [self.sum()]
            while self.take(";"):
                values.append(self.sum())
            assert self.take(")")
            return FUNCTIONS[token](values) if len(values) > 1 else FUNCTIONS[token](values[0])
        if self.next == "(":
            self.at += 1
            inside = self.inside()
            if (called := f"{token}({''.join(inside)})") in self.known:
                self.at += len(inside) + 1
                return self.known[called]
            self.at -= 1
        if token not in self.known:
            raise Unknown(token)
        return self.known[token]

    def group(self) -> float:
        inside = self.inside()
        if len(inside) > 1 and (whole := "".join(inside)) in self.known:
            self.at += len(inside) + 1
            return self.known[whole]
        found = self.sum()
        assert self.take(")", "]"), self.formula
        return found


def value_of(
    formula: Tokens, known: Mapping[str, float] | None = None, rows: Sequence[Mapping[str, float]] = ()
) -> float:  # fmt: skip
    """Return the value of a formula. Raises `Unknown` if a symbol has none."""
    return Reader(formula, known or {}, rows).value()
