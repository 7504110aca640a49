"""Formulas as trees: what stands above and below a line, under a root, in brackets, and beside a symbol."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rocking_cli.studies.remark import MINUS
from rocking_cli.verification.results import Working

MAX_WIDTH = 60  # characters of a fraction, or in brackets; wider ones stay on the line, where they can be broken
TOKEN = re.compile(r"[_^]\[[^\[\]]*\]|\d+(?:[.,]\d+)?|[^\W\d_Σ]+| +|.")
PRIME = "\u2032"
BRACKETS = {"(": ")", "[": "]", "|": "|"}
BETWEEN = frozenset(f"+{MINUS}=≤≥:;…")
"""Signs between products."""


class Node(NamedTuple):
    """A piece of a formula.

    A leaf of the kind "number", "letter", "word", "sign", "bracket" or "gap" has a text. A "row" or a "root" has parts,
    as a "fence" with its two brackets as text has; a "fraction" has two, and a "script" the base, what is below and
    what is above.
    """

    kind: str
    text: str = ""
    parts: tuple[Node, ...] = ()


GAP = Node("gap", "\u2009")
"""The thin space between factors."""


class Unreadable(ValueError):
    """A text is no formula in this notation."""


def width(node: Node) -> float:
    """Return about how wide a formula is, in characters."""
    each = [width(part) for part in node.parts]
    if node.kind == "fraction":
        return max(each)
    if node.kind == "script":
        return each[0] + 0.7 * max(each[1:])
    return sum(each) + len(node.text)


def pieces(text: str) -> list[Node]:
    """Return a formula as one row, or if it is wide as several, between which a line may be broken.

    Parameters
    ----------
    text : str
        The formula, in the notation of the formulas of a code.

    Raises
    ------
    Unreadable
        If the text is in another notation.
    """
    nodes = _Reader(text).row("")
    if sum(map(width, nodes)) <= MAX_WIDTH:
        return [Node("row", parts=tuple(nodes))]
    rows, start = [], 0
    for k, node in enumerate(nodes):
        joins = node.kind == "sign" and k > start and nodes[k - 1].text not in BRACKETS
        if joins or k == len(nodes) - 1:
            rows.append(Node("row", parts=tuple(nodes[start : k + 1])))
            start = k + 1
    return rows


def leaves(text: str) -> Iterator[Node]:
    """Yield the tokens of a text: of two letters each is a symbol unless both are capital, as in FC."""
    for token in TOKEN.findall(text):
        if token[0].isdigit():
            yield Node("number", token)
        elif token in ("Σ", "*", PRIME):
            yield Node("word", token)
        elif not token[0].isalpha():
            yield Node("sign", token)
        elif len(token) > 2 or token == "ln" or (len(token) == 2 and token.isupper()):
            yield Node("word", token)
        else:
            yield from (Node("letter", letter) for letter in token)


class _Reader:
    """Reader of a formula, from its first token to its last."""

    def __init__(self, text: str) -> None:
        self.left = [*leaves(text)]

    @property
    def next(self) -> str:
        return self.left[0].text if self.left else ""

    def spaces(self) -> bool:
        """Skip spaces; return whether there were any."""
        if not self.next.isspace():
            return False
        self.left.pop(0)
        return True

    def row(self, closing: str) -> list[Node]:
        """Return products and the signs between them, up to a closing bracket."""
        nodes: list[Node] = []
        self.spaces()
        while self.next != closing:
            nodes += [self.left.pop(0)] if self.next in BETWEEN else self.product(closing)
            self.spaces()
        return nodes

    def product(self, closing: str) -> list[Node]:
        """Return factors; what is divided is all of them to the left, as on a calculator."""
        factors = self.factor()
        while True:
            apart = self.spaces()
            if self.next == "·":
                factors.append(self.left.pop(0))
                self.spaces()
                factors += self.factor()
            elif self.next == "/":
                self.left.pop(0)
                factors = _divided(factors, self.divisor(closing))
            elif self.ends(closing):
                return factors
            else:
                factors += [*([GAP] if apart else []), *self.factor()]

    def ends(self, closing: str) -> bool:
        return self.next in {"", closing, *BETWEEN}

    def divisor(self, closing: str) -> list[Node]:
        """Return the factor that divides: one, but a sum has all factors of its addend."""
        is_sum = self.next == "Σ"
        factors = self.factor()
        while is_sum and self.next.isspace() and self.left[1:] and self.left[1].text not in {"·", closing, *BETWEEN}:
            self.spaces()
            factors += [GAP, *self.factor()]
        return factors

    def factor(self) -> list[Node]:
        """Return a symbol, a number, a root or brackets, with the scripts and the argument that follow it."""
        if not self.left:
            raise Unreadable
        node = self.left.pop(0)
        if node.text == "√" and self.next == "(":
            factors = [Node("root", parts=(_row(_bare(self.factor())),))]
        elif node.text in BRACKETS:
            factors = self.fenced(node.text)
        elif node.kind == "sign":
            raise Unreadable(node.text)
        else:
            factors = [node]
        below, above = list[Node](), list[Node]()
        while self.next[:2] in ("_[", "^[") or self.next == PRIME:
            mark = self.left.pop(0).text
            if mark[0] == "_":
                below.append(Node("number" if mark[2:-1].isdigit() else "word", mark[2:-1]))
            else:
                above += leaves(mark if mark == PRIME else mark[2:-1])
        if below or above:
            factors[-1] = Node("script", parts=(factors[-1], _row(below), _row(above)))
        return factors + self.factor() if self.next == "(" else factors

    def fenced(self, opening: str) -> list[Node]:
        closing = BRACKETS[opening]
        inside = self.row(closing)
        if not self.left:
            raise Unreadable(opening)
        self.left.pop(0)
        if sum(map(width, inside)) <= MAX_WIDTH:
            return [Node("fence", opening + closing, tuple(inside))]
        return [Node("bracket", opening), *inside, Node("bracket", closing)]


def _row(nodes: Sequence[Node]) -> Node:
    return Node("row", parts=tuple(nodes))


def _bare(nodes: list[Node]) -> list[Node]:
    """Return what is in parentheses that a line makes needless."""
    return [*nodes[0].parts] if len(nodes) == 1 and nodes[0].kind == "fence" and nodes[0].text == "()" else nodes


def _divided(over: list[Node], under: list[Node]) -> list[Node]:
    parts = _row(_bare(over)), _row(_bare(under))
    fraction = Node("fraction", parts=parts)
    return [fraction] if width(fraction) <= MAX_WIDTH else [*over, Node("sign", "/"), *under]


def formulas_of(row: Working) -> tuple[list[tuple[str, str]], str]:
    """Return the formulas of a step, each with the sign before it, and the sign before the result.

    What is solved by trial has no numbers, and its formula is the condition that the result satisfies.
    """
    is_solved = bool(row.formula) and not row.numbers
    formulas = [("", row.symbol), (":" if is_solved else "=", row.formula), ("=", row.numbers)]
    return [each for each in formulas if each[1]], "⇒" if is_solved else "="
