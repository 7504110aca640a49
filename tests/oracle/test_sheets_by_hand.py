"""The four calculation sheets of examples/verify, computed again from the HTML alone, by no code of the project.

`faults` lists what does not agree on a page; a page with one other digit has some.
"""

import random
import re
from cmath import phase
from collections import defaultdict
from dataclasses import replace
from functools import cache
from math import dist, isclose, pi, sqrt
from pathlib import Path

import pytest
import yaml

from tests.oracle.ntc import DAMPING, EXCEEDED, PERIOD, SHARE, Chain, Floor, Site, Weight, eta, solve, with_ag
from tests.oracle.sheets import (
    Grid,
    Heading,
    Sentence,
    Sheet,
    Step,
    Unknown,
    number,
    numbers_in,
    unit_of_digit,
    value_of,
)

PROJECT = Path(__file__).resolve().parents[2]
FOLDER = PROJECT / "examples" / "verify" / "sheets"
NAMES = ["arch_on_piers", "buttressed_arch", "facade", "parapet"]
G = 9.80665
# Numbers of the code and of units that stand in steps: shares, factors and bounds of formulas, probabilities, dampings
# in per cent, those of tables for soils B and C, and 1000 from t to kg.
CONSTANTS = [
    0.4, 0.6, 1.68, 1.56, 35, 0.63, 0.1, 0.05, 4, 1.6, 10, 5, 8, 0.55, 0.025, 1.1, 0.8, 1.2, 1, 2, 3, G, 6.2, 1000,
    1.4, 0.2, 1.7, 1.5, 1.05, 0.33,
]  # fmt: skip
SECTIONS = {
    r"(Ground at|Azione sismica allo) SL": "ground",
    r"Kinematic chain|Catena cinematica": "chain",
    r"Capacity curve|Curva di capacità": "curve",
    r"SL., .*(exact|esatta)": "exact",
    r"SL., .*(straight|retta)": "line",
    r"(Onset of rocking|Attivazione del meccanismo) a": "start",
    r"Linear method|Metodo lineare": "linear",
    r"(Nonlinear method|Metodo non lineare) al?t?l?o? SL.$": "nonlinear",
    r"(Nonlinear method|Metodo non lineare) al?t?l?o? SL., ": "nonlinear line",
    r"Dynamic method|Metodo dinamico": "dynamic",
}
OF_GROUND = re.compile(
    r"(a_\[g\]S?|F_\[0\]|T_\[C\](\^\[\*\])?|S|S_\[S\]|C_\[C\]|T_\[[BD1]\]|T_\[R\]|ξ_\[1\]|S_\[Z\]|ψ|γ|S_\[e\]\(T_\[1\]\)"
    r"|S_\[eZ?\]\(T_\[0\]\))$"
)
"""Symbols that have a value at each limit state."""


def kind_of(heading):
    return next((kind for pattern, kind in SECTIONS.items() if re.match(pattern, heading)), "")


def state_of(text):
    found = re.search(r"SL[ODVC]", text)
    return found[0] if found else ""


def close(value, printed, digit=5, least=0.0):
    """Whether a value is the printed one, to one unit of a digit."""
    return abs(value - printed) <= 1.001 * max(unit_of_digit(printed, digit), least) + 1e-12


def quantity(text):
    """A quantity of a structure file in kN and m, and in kN/m2."""
    if not isinstance(text, str):
        return float(text)
    value, _, unit = text.partition(" ")
    return float(value) * {"mm": 1e-3, "MPa": 1e3}.get(unit, 1.0)


class Walk:
    """One pass over a sheet, line by line, with the last value of each symbol.

    `faults` are lines that do not agree with what is printed above, `results` the values by direction, section, limit
    state and symbol.
    """

    def __init__(self, sheet):
        self.faults = []
        self.known = {"g": G, "a": 0.8, "b": 1.1, "κ": 6.2}
        self.structure, self.site = (yaml.safe_load(each) for each in sheet.files)
        self.given, self.ground, self.results = defaultdict(dict), defaultdict(dict), defaultdict(dict)
        self.seen = set()
        self.see([*CONSTANTS, *(each * scale for text in sheet.files for each in of_file(text) for scale in (1, 1e-3))])
        self.of_listing()
        self.direction, self.section, self.state, self.capacity = "", "", "", 0.0
        self.weights, self.blocks, self.held, self.corners = [], [], [], {}
        self.rest, self.tables, self.after, self.leads = {}, [], [], {}
        self.also, self.code, self.decides = [], {}, ""
        self.failing_without_ties = {}
        read = {Heading: self.heading, Grid: self.grid, Step: self.step, Sentence: self.sentence}
        for item in sheet.items:
            if type(item) in read:
                read[type(item)](item)

    def see(self, values):
        self.seen |= {f"{abs(value):.5g}" for value in values}

    def is_seen(self, value):
        return any(f"{value * (1 + off):.5g}" in self.seen for off in (0, 4e-6, -4e-6))

    def of_listing(self):
        """Sizes that formulas name and that only the files give."""
        element, tie = self.site.get("element", {}), (self.structure.get("ties") or [{}])[0]
        self.known |= {name: float(element[name]) for name in ("w", "E") if element}
        self.sizes = {"b": self.structure.get("width"), "h": self.structure.get("height")}
        self.sizes = {name: quantity(size) for name, size in self.sizes.items() if size}
        if element:
            self.known |= {"L": self.sizes["h"], "t": self.sizes["b"]}
        if tie:
            plate = tie["plate"]
            sizes = {"n": tie["bars"], "d": tie["diameter"], "b": plate["width"], "h": plate["height"]}
            sizes |= {"t": tie["wall"]["thickness"], "γ": tie.get("gamma", 1), "ε": tie["elongation"]}
            sizes |= {"L": dist(tie["from"]["ground"], tie["to"]["at"])}
            self.tie = {name: quantity(size) for name, size in sizes.items()}

    def fault(self, *what):
        self.faults.append((self.direction, self.section, self.state, *what))

    def heading(self, item):
        if self.section == "ground":
            self.ground[self.state] |= {name: value for name, value in self.known.items() if OF_GROUND.match(name)}
            self.known[f"a_[g,{self.state}]"] = self.known["a_[g]"]
        if item.level == 3:
            self.direction = item.text
        self.section, self.state = kind_of(item.text), state_of(item.text)
        if self.section:
            self.known |= {**self.given[self.state], **self.ground[self.state]}
        if self.section == "ground":
            self.known["P"] = EXCEEDED[self.state]

    def sentence(self, item):
        self.see(numbers_in(item.text))
        if re.match(r"(Check, with the ground of SL|Controllo, con l'azione dello SL)", item.text):
            self.known["a_[g]"] = self.capacity
        if "rocking --verbose verify" in item.text and state_of(item.text):
            self.decides = self.decides or state_of(item.text)
        if re.match(r"T_\[1\] (and|e) ξ_\[1\]", item.text):
            self.known |= self.given["SLD"]

    def grid(self, item):
        self.tables.append((self.direction, self.section, self.state, item))
        for row in item.rows:
            for cell in row:
                self.see(numbers_in(cell))
        heads = item.heads
        if heads[:2] in (["symbol", "quantity"], ["simbolo", "grandezza"]):
            self.of_site(item)
        elif heads[-1].endswith("A [m²]"):
            self.bodies = item.rows
        elif heads[:2] in (["property", "of"], ["proprietà", "di"]):
            for row in item.rows:
                if row[2]:
                    value = number(row[3]) * (1e3 if row[4] == "MPa" else 1)
                    self.known.setdefault(row[2], value)
                    self.see([value])
        elif "k [kN/m]" in heads:
            self.of_ties(item)
        elif "M g [kN]" in heads:
            self.loads = {}
            for (_, _, *body), row in zip(self.bodies, item.rows, strict=False):
                x, y, area = map(number, body)
                mass = area * self.known["ρ"] * quantity(self.structure["depth"])
                if [x, y] != [*map(number, row[2:4])] or not close(mass, number(row[4])):
                    self.fault("body", row)
            for row in item.rows:
                numbers = [cell for head, cell in zip(heads[2:-1], row[2:-1], strict=True) if head != "floor"]
                x, y, M, weight, *rest = map(number, numbers)  # but the seat
                length = quantity(self.structure["depth"]) if len(rest) == 3 else 1.0
                if not close(M * G / 1e3, weight) or (len(rest) == 3 and not close(weight / length, rest[0])):
                    self.fault("weight", row)
                self.loads[x, y, M, *rest[-2:]] = row[0]
        elif heads[-1] == "P + Q [kN]":
            self.of_weights(item)
        elif "Δx [m]" in heads:
            self.of_blocks(item)
        elif heads[0] in ("force or tie", "forza o catena"):
            self.of_held(item)
        elif heads[:2] in (["body", "corner"], ["corpo", "vertice"]):
            self.of_corners(item)
        elif heads[0] in ("joint", "vincolo"):
            for symbol, _, _, x, y, *_ in item.rows:
                self.known |= {f"x_[{symbol}]": number(x), f"y_[{symbol}]": number(y)}

    def of_site(self, item):
        for symbol, meaning, value, _ in item.rows:
            if re.match(r"[\d−]", value):
                where = self.given[state_of(meaning)] if state_of(meaning) else self.known
                where[symbol] = number(value)
                self.see([100 * number(value)] if symbol == "ξ_[1]" else [])
            elif re.fullmatch(r"T[1-4]", value):
                self.known["S_[T]"] = {"T1": 1.0, "T4": 1.4}.get(value, 1.2)

    def of_weights(self, item):
        self.weights = []
        for name, block, *cells in item.rows:
            x, y, M, w, h, P, PQ = map(number, cells)
            self.weights.append({"name": name, "block": int(block), "x": x, "y": y, "P": P, "Q": PQ - P})
            if not (close(w * M * G / 1e3, P) and close(h * M * G / 1e3, PQ) and (x, y, M, w, h) in self.loads):
                self.fault("weight", name)

    def of_blocks(self, item):
        clockwise = "(x_[O] − x_[P])" in item.caption
        self.blocks = []
        for row in item.rows:
            k, dx, x, y, x_P, turn, x_O, y_O, x1, y1, *_ = (number(each) if each != "–" else None for each in row)
            self.blocks.append({"k": int(k), "Δx": dx, "x′": x1, "y′": y1})
            if turn is not None and turn != 0:
                there = abs(turn) * 2e-5
                rounding = there * max(abs(y), abs(y_O)), there * max(abs(x_P), abs(x_O))
                if abs(turn * (y - y_O) - x1) > unit_of_digit(x1) + rounding[0]:
                    self.fault("x′ of block", k)
                if abs(turn * (x_O - x_P) * (1 if clockwise else -1) - y1) > unit_of_digit(y1) + rounding[1]:
                    self.fault("y′ of block", k)
                for name, value in ((f"θ_[{int(k)}]′", turn), (f"x_[O{int(k)}]", x_O), (f"y_[O{int(k)}]", y_O)):
                    if name in self.known and self.section != "" and not close(self.known.pop(name), value):
                        self.fault(name, "in the table")
                for name, value in ((f"x_[G{int(k)}]", x), (f"y_[G{int(k)}]", y), (f"x_[P{int(k)}]", x_P)):
                    if name in self.known and self.section == "chain" and not close(self.known[name], value):
                        self.fault(name, "in the table")

    def of_ties(self, item):
        for row, tie in zip(item.rows, self.structure["ties"], strict=True):
            fixed, at, force = tie_of(tie)
            area = tie["bars"] * pi * quantity(tie["diameter"]) ** 2 / 4
            for cell, value in zip((row[2], row[3], row[5]), (force, area, abs(at - fixed)), strict=True):
                if not close(value, number(cell)):
                    self.fault("tie", row)

    def of_held(self, item):
        self.held = []
        for name, *cells in item.rows:
            force, rate, work = map(number, cells)
            is_tie = close(force * rate, work)
            if not is_tie and not close(-force * rate, work):
                self.fault("work of", name)
            row = {"F": 0.0, "r′": 0.0, "N": 0.0, "L′": 0.0}
            self.held.append(row | ({"N": force, "L′": rate} if is_tie else {"F": force, "r′": rate}))

    def of_corners(self, item):
        body = 0
        for name, _, x, y in item.rows:
            body = int(name) if name else body
            self.corners.setdefault(body, []).append((number(x), number(y)))

    def rows_of(self, symbol):
        """What the sum of a step is over: weights of a block, forces and ties, corners, or blocks."""
        if found := re.match(r"[xy]_\[[GP](\d+)\]$", symbol):
            return [each for each in self.weights if each["block"] == int(found[1])]
        if re.match(r"L(\(|$)", symbol):
            return self.held
        if symbol.startswith("A_["):
            corners = self.corners.get(int(symbol[3:-1]), [])
            pairs = zip(corners, corners[1:] + corners[:1], strict=True)
            return [{"x_[i]": a, "y_[i]": b, "x_[i+1]": c, "y_[i+1]": d} for (a, b), (c, d) in pairs]
        forces = {
            each["k"]: (self.known.get(f"P_[{each['k']}]"), self.known.get(f"PQ_[{each['k']}]")) for each in self.blocks
        }
        forces = {k: (PQ if P is None else P, PQ) for k, (P, PQ) in forces.items() if PQ is not None}
        return [
            each | {"P": forces[each["k"]][0], "Q": forces[each["k"]][1] - forces[each["k"]][0]}
            for each in self.blocks
            if each["k"] in forces
        ]

    def context(self, step):
        """Symbols as they are meant in a step."""
        symbol, known = step.symbol, dict(self.known)
        for name in (symbol, re.sub(r"\(φ_\[\w+\]\)$", "", symbol)):  # a sum of a position is not that at rest
            known.pop(name, None)
        if argument := re.search(r"\((T_\[[^\]]*\]|t)\)$", symbol):
            known["T"] = known.get(argument[1])
        if symbol.startswith("η("):
            known["ξ"] = self.damping(symbol)
        if symbol in ("S_[S]", "T_[D]"):
            known["g"] = 1.0  # a_g is printed over g
        if re.match(r"d_\[0\]\^\[\*\]$|d\(", symbol):
            known |= self.rest | {
                "d_[C]": next(value for name, value in reversed(known.items()) if name.startswith("d_[C]"))
            }
        if re.match(r"[xy]_\[[GP]\d", symbol):
            known = {name: value for name, value in known.items() if not name.startswith("Σ")}
        if symbol.startswith("M_["):
            sizes = self.size_of(symbol)
            known |= {"L": quantity(self.structure["depth"]), **sizes}
            known |= {"B": sizes["b"], "H": sizes["h"]} if "b" in sizes else {}
        if symbol.startswith("P") and "Σ" not in step.formula:
            block = int(re.search(r"\d+", symbol)[0])
            for each in self.weights:
                if each["block"] == block:
                    known |= {f"P_[{each['name']}]": each["P"], f"(P+Q)_[{each['name']}]": each["P"] + each["Q"]}
        if re.fullmatch(r"N_\[[ypb]\]|s|ΔL_\[t\]", symbol):
            known |= self.tie
        if symbol.startswith("ζ"):
            known |= {name: value for name, value in self.ground[self.state].items() if name == "a_[g]"}
        if symbol == "d_[b]":
            known["S_[eZ](T_[1])"] = known["A"] * known["S_[Z]"]
        if {"T_[R,a]", "T_[R,b]", "a_[g,a]", "F_[0,a]"} & {*step.formula} or "T_[C,a]^[*]" in step.formula:
            known |= self.hazard_rows()
        return known

    def damping(self, symbol):
        if symbol == "η(ξ_[1])":
            return 100 * self.known["ξ_[1]"]
        return DAMPING[self.state] if self.section in ("exact", "line", "nonlinear", "nonlinear line") else 5.0

    def size_of(self, symbol):
        first = int(re.search(r"\d+", symbol)[0])
        if self.sizes:
            return self.sizes
        if f"A_[{first}]" in self.known:
            return {"A": self.known[f"A_[{first}]"]}
        x, y = zip(*[*self.structure["blocks"].values()][first - 1]["polygon"], strict=True)
        return {"b": max(x) - min(x), "h": max(y) - min(y)}

    def hazard_rows(self):
        rows, T = self.site["hazard"], self.known["T_[R]"]
        k = max(1, next((k for k, row in enumerate(rows) if row[0] >= T), len(rows) - 1))
        names = ("T_[R,{}]", "a_[g,{}]", "F_[0,{}]", "T_[C,{}]^[*]")
        return {
            name.format(end): row[i]
            for end, row in zip("ab", rows[k - 1 : k + 1], strict=True)
            for i, name in enumerate(names)
        }

    def step(self, item):
        printed = number(item.result)
        if item.numbers:
            value, least = value_of(item.numbers), 0.0
            if printed == 0 or abs(value - printed) > unit_of_digit(printed):
                least = max(unit_of_digit(each) for each in addends(item.numbers))
            if not close(value, printed, least=least if printed == 0 else 0.0):
                self.fault(item.symbol, "numbers give", value, "and not", item.result)
            for each in item.numbers:
                if re.match(r"\d", each) and not self.is_seen(number(each)):
                    self.fault(item.symbol, "nothing above has", each)
            if missing := constants(item.formula) - constants(item.numbers):
                self.fault(item.symbol, "has in symbols alone", missing)
        if item.symbol.startswith("Δx_["):
            loads = {each["name"]: each for each in self.structure["loads"]}
            if not close(printed, quantity(loads[item.symbol[4:-1]]["seat"])):
                self.fault(item.symbol, "is not the seat of the load")
        elif item.formula and item.relation == "=":
            self.check_symbols(item, printed)
        if item.symbol.startswith("θ") and not item.formula and printed != 1:
            self.fault(item.symbol, "of the mechanism is not 1")
        self.note(item, printed)

    def check_symbols(self, item, printed):
        try:
            value = value_of(item.formula, self.context(item), self.rows_of(item.symbol))
        except (Unknown, KeyError) as missing:
            self.fault(item.symbol, "nothing above has a value of", missing)
            return
        if item.symbol == "M^[*]":
            value *= 1000
        terms = [abs(number(each)) for each in item.numbers if re.match(r"\d", each)] if "−" in item.numbers else []
        least = (
            2 * unit_of_digit(max(terms)) if item.symbol.startswith(("Σ", "α", "t", "x", "y", "θ")) and terms else 0.0
        )
        if not close(value, printed, least=max(least, 2 * unit_of_digit(printed))):
            self.fault(item.symbol, "symbols give", value, "and not", item.result)

    def note(self, item, printed):
        symbol = item.symbol
        self.see([printed])
        if symbol.startswith("θ") and not item.formula and self.section == "chain":
            self.leads[self.direction] = int(re.search(r"\d+", symbol)[0])
        if item.relation == ":":
            self.after.append((self.direction, self.section, self.state, item))
        elif self.after and self.after[-1][:3] == (self.direction, self.section, self.state):
            self.found_by_trial(item, printed)
        self.known.pop(symbol, None)
        self.known[symbol] = printed
        if symbol.startswith("η("):
            self.known["η"] = printed
        if symbol == "T_[R,lin]":
            self.known["T_[R]"] = printed
        if symbol.startswith("a_[g,"):
            self.capacity = printed
        if symbol.startswith("Σ") and self.section == "chain":
            self.rest[symbol] = printed
        own = self.results[self.direction, self.section, self.state]
        own[f"{symbol} again" if symbol in own else symbol] = printed

    def found_by_trial(self, item, printed):
        """A value that was found by trial gives, in the steps below, what was asked for."""
        trial = self.after[-1][-1]
        cut = trial.formula.index("=")
        left, right = "".join(trial.formula[:cut]), "".join(trial.formula[cut + 1 :])
        wanted = 0.0 if right == "0" else self.known.get(right)
        left = re.sub(r"\((T_\[R\]|a_\[g\]|φ)\)$", "", left)
        if item.symbol != left and not (left in ("α", "d") and item.symbol.startswith(f"{left}(φ")):
            return
        if wanted is None or not close(printed, wanted, least=1e-6 if wanted == 0 else 0.0):
            self.fault(trial.symbol, "is found by trial, but gives", item.result, "and not", wanted)
        self.after.pop()


def constants(formula):
    """The numbers of a formula but 1 and 2, which powers, roots and conjugates have."""
    return {number(each) for each in formula if re.match(r"\d", each)} - {1.0, 2.0}


def of_file(text):
    """All numbers of a file."""
    return [float(each) for each in re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)]


def addends(formula):
    """The values of the addends of a sum."""
    found, depth = [[]], 0
    for token in formula:
        depth += (token == "(") - (token == ")")
        if token in "+−" and depth == 0:
            found.append([])
        else:
            found[-1].append(token)
    return [value_of(each) for each in found if each]


# By the formulas of the code, from the files that a sheet lists.


def weights_of(walk):
    """The weights of the first chain, from the tables of weights of a direction."""
    return [
        Weight(each["block"], complex(each["x"], each["y"]), each["P"], each["P"] + each["Q"]) for each in walk.weights
    ]


def of_block(given, s):
    """The chain of a block, from its file alone: kN, m."""
    width, height, depth = (quantity(given[key]) for key in ("width", "height", "depth"))
    own = quantity(given["density"]) * width * height * depth
    weights = [Weight(1, 0.5j * height, own, own)]
    for load in given.get("loads", []):
        P, floor = quantity(load["mass"]) * depth, load.get("floor")  # half of a floor is carried elsewhere
        weights.append(Weight(1, complex(*load["at"]), 0.5 * P if floor else P, 0.0 if floor == "sliding" else P))
    ties = given.get("ties", [])
    return Chain(s, weights, [complex(s * width / 2, 0)], [1], tie_of(ties[0]) if ties else None)


def tie_of(tie):
    """Where a tie is fixed, where it meets the block, and its strength: yield, punching or bearing."""
    wall, plate = tie["wall"], tie["plate"]
    d, t, b, h = (quantity(each) for each in (tie["diameter"], wall["thickness"], plate["width"], plate["height"]))
    steel = 1e3 * float(tie["steel"].removeprefix("S"))
    strengths = (
        tie["bars"] * pi * d**2 / 4 * steel,
        tie["bars"] * 2 * t * (b + h + 2 * t) * quantity(wall["shear"]),
        tie["bars"] * b * h * quantity(wall["compression"]),
    )
    return complex(*tie["from"]["ground"]), complex(*tie["to"]["at"]), min(strengths) / float(tie.get("gamma", 1))


def of_blocks(walk, direction, s):
    """The chain of an arch on its supports, from the printed tables of weights and joints."""
    tables = [each for where, *_, each in walk.tables if where == direction]
    weights = next(grid for grid in tables if grid.heads[-1] == "P + Q [kN]")
    joints = next(grid for grid in tables if grid.heads[0] in ("joint", "vincolo"))
    points = {
        frozenset(map(int, pair.split(", "))): complex(number(x), number(y)) for _, _, pair, x, y, *_ in joints.rows
    }
    on_ground = [next(iter(pair - {0})) for pair in points if 0 in pair]
    # The first block is that whose rotation is that of the mechanism.
    first = walk.leads[direction]
    last = next(k for k in on_ground if k != first)
    (middle,) = {k for pair in points for k in pair} - {0, first, last}
    hinges = [points[frozenset(pair)] for pair in ((0, first), (first, middle), (middle, last), (last, 0))]
    moving = [
        Weight(int(block), complex(number(x), number(y)), number(P), number(PQ))
        for _, block, x, y, _, _, _, P, PQ in weights.rows
    ]
    return Chain(s, moving, hinges, [first, middle, last])


def lost_seat(given, chain):
    """The displacement at which a load has moved sideways off its seat; None if none does before the end."""
    ends = []
    for load in given.get("loads", []):
        at, seat = complex(*load["at"]), quantity(load.get("seat", 1e9))
        moved = lambda phi, at=at: abs((chain.moved(1, at, phi) - at).real)  # noqa: E731
        if moved(chain.end) > seat:
            ends.append(chain.d(solve(lambda phi, moved=moved, seat=seat: moved(phi) - seat, 0.0, chain.end)))
    return min(ends, default=None)


def broken(walk, chain):
    """The rotation at which the tie of a block has its elongation at rupture; None without one."""
    elongation = walk.structure["ties"][0].get("elongation") if chain.tie else None
    if elongation is None:
        return None
    fixed, at, _ = chain.tie
    longer = lambda phi: abs(chain.moved(1, at, phi) - fixed) / abs(at - fixed) - 1 - float(elongation)  # noqa: E731
    return solve(longer, 0.0, chain.end) if longer(chain.end) > 0 else None


def expected(walk, chain, seat):
    """Every result of a direction by section, limit state and symbol."""
    site, found = Site(walk.site), {}
    PQ, first, second = chain.sums
    a0, own, end, d_t = chain.alpha(0.0) * G / (chain.e_star * site.FC), own_period(walk), chain.end, None
    if (phi_t := broken(walk, chain)) is not None:  # beyond, the curve is that without the tie
        untied = replace(chain, tie=None)
        end = max(phi_t, untied.end)
        # A tie that gives more than half of the largest a* bounds the displacement by its rupture.
        d_t = chain.d(phi_t) if untied.alpha(0.0) < 0.5 * chain.alpha(0.0) else None
    d0 = chain.d(end)
    found["chain", ""] = {
        "α_[0]": chain.alpha(0.0), "Σ(P+Q)": PQ, "Σ(P+Q)x′": first, "Σ(P+Q)x′^(2)": second, "e^[*]": chain.e_star,
        "M^[*]": 1000 * chain.e_star * PQ / G,
        **{f"θ_[{k}]′": chain.turned(k) for k in chain.blocks},
    }  # fmt: skip
    found["curve", ""] = {"a_[0]^[*]": a0, "φ_[0]": end, "d_[0]^[*]": d0, "x_[C]′": first / PQ}
    demands = {state: site.at(state) for state in ("SLD", "SLV", "SLC")}
    for state, demand in demands.items():
        found["ground", state] = of_ground(site, state, demand, own)
        found["start", state] = of_start(demand, a0, own)
    for state in SHARE:
        demand, d = demands[state], min(SHARE[state] * d0, *(d0 if each is None else each for each in (seat, d_t)))
        phi = solve(lambda each, d=d: chain.d(each) - d, 0.0, chain.end)
        for section, end, a in (
            ("exact", "", chain.alpha(phi) * G / (chain.e_star * site.FC)), ("line", ",lin", a0 * (1 - d / d0)),
        ):  # fmt: skip
            at = a if own is None else min(a, 4 * pi**2 * d / own**2)
            T = PERIOD[state] * pi * sqrt(d / at)
            S_De = demand.S_De(T, DAMPING[state])
            found[section, state] = {
                f"a_[{state}{end}]^[*]": a, f"T_[{state}{end}]": T, f"S_[De](T_[{state}{end}])": S_De,
                f"ρ_[{state}{end}]": d / S_De, "η(ξ)": eta(DAMPING[state]),
                **({f"a_[{state}{end}]": at} if own is not None else {}),
            }  # fmt: skip
            capacity = solve(
                lambda ag, T=T, d=d, of=demand, xi=DAMPING[state]: with_ag(of, ag).S_De(T, xi) - d, 1e-4, 3
            )
            method = "nonlinear" if section == "exact" else "nonlinear line"
            found[method, state] = {f"a_[g,nl{end}]": capacity, f"ζ_[E{end}]": capacity / demand.ag}
            asked = lambda of, T=T, d=d, xi=DAMPING[state]: of.S_De(T, xi) - d  # noqa: E731
            found[method, state] |= lasting(site, state, asked, f"T_[R{end}]")
        found["exact", state] |= {f"d_[{state}]": d, f"φ_[{state}]": phi, f"α(φ_[{state}])": chain.alpha(phi)}
        found["exact", state] |= {} if seat is None else {"d_[a]": seat}
        found["exact", state] |= {} if d_t is None else {"d_[t]": d_t}
    for state in found:
        if state[0] == "start":
            found[state] |= lasting(site, state[1], lambda of: of.start(own) - a0, "T_[R]")
    linear = demands["SLD"].ag * a0 / demands["SLD"].start(own) * walk.site.get("q", 2.0)
    found["linear", "SLD"] = {"a_[g,q]": linear, "ζ_[E]": linear / demands["SLV"].ag}
    found["linear", "SLD"] |= lasting(site, "SLD", lambda of: of.start(own) - walk.site.get("q", 2.0) * a0, "T_[R]")
    walk.asked = {state: demand.ag for state, demand in demands.items()}
    return found


def own_period(walk):
    """T_0 of an element by its size [C8.7.1.7]."""
    if not (element := walk.site.get("element")):
        return None
    L, t = walk.sizes["h"], walk.sizes["b"]
    return 6.2 * L / t * L * sqrt(float(element["w"]) / (float(element["E"]) * G))


def of_ground(site, state, demand, own):
    ground = demand.ground if isinstance(demand, Floor) else demand
    found = {"S": ground.S, "T_[C]": ground.TC, "T_[B]": ground.TB, "T_[D]": ground.TD, "a_[g]S": ground.peak}
    if "hazard" in site.given:
        found |= {"V_[R]": site.life, "T_[R]": site.period(state), "a_[g]": ground.ag, "F_[0]": ground.F0}
        found |= {"T_[R] again": row[0]} if (row := site.row_of(state)) else {}
    if isinstance(demand, Floor):
        found |= {"S_[Z]": demand.peak, "T_[0]": own, "S_[eZ](T_[0])": demand.start(own)}
    return found


def of_start(demand, a0, own):
    capacity = demand.ag * a0 / demand.start(own)
    return {"a_[g,0]": capacity, "ζ_[E]": capacity / demand.ag}


def lasting(site, state, excess, symbol):
    """The return period at which the demand equals a capacity, if a table of a hazard has it."""
    if "hazard" not in site.given:
        return {}
    first, last = site.given["hazard"][0][0], site.given["hazard"][-1][0]
    at = lambda T: excess(site.at(state, site.on_rock(T)))  # noqa: E731
    if at(first) > 0 or at(last) < 0:
        return {}
    return {symbol: solve(at, first, last)}


PRINTED = ("chain", "curve", "ground", "exact", "start", "nonlinear")
"""Sections that a sheet has of the limit state that decides; the straight line and the linear method are not shown."""


def faults_of_code(walk):
    """Results that are not those of the formulas of the code from the files."""
    faults = []
    for direction in dict.fromkeys(each[0] for each in walk.results if each[1] == "chain"):
        s = -1 if re.match(r"Negative|Verso negativo", direction) else 1
        chain = of_block(walk.structure, s) if walk.sizes else of_blocks(walk, direction, s)
        seat = lost_seat(walk.structure, chain) if walk.sizes else None
        faults += faults_of_tables(walk, direction, chain)
        faults += faults_of_variants(walk, chain) if walk.sizes else []
        by_letter = replace(chain, weights=[each._replace(PQ=max(each.P, each.PQ)) for each in chain.weights])
        alpha, site = by_letter.alpha(0.0), Site(walk.site)
        walk.also += [alpha, alpha * G / (by_letter.e_star * site.FC)]
        walk.also += [*map(site.period, EXCEEDED)] if "hazard" in walk.site else []
        walk.code[direction] = expected(walk, chain, seat)
        for (section, state), values in walk.code[direction].items():
            own = next((found for key, found in walk.results.items() if key[1:] == (section, state) and (
                section == "ground" or key[0] == direction)), None)  # fmt: skip
            if own is None:
                if state in ("", walk.decides) and section in PRINTED:
                    faults.append((direction, section, state, "has no lines"))
                continue
            for symbol, value in values.items():
                if symbol not in own and value is not None:
                    faults.append((direction, section, state, symbol, "is not printed"))
                elif value is not None and not close(value, own[symbol], least=2 * unit_of_digit(own[symbol])):
                    faults.append((direction, section, state, symbol, own[symbol], "by the code", value))
    return faults


def faults_of_variants(walk, chain):
    """Cells of the table of variants that are not those of the chain without its tie, or with every P in P + Q."""
    letter = replace(chain, weights=[each._replace(PQ=max(each.P, each.PQ)) for each in chain.weights])
    variants = {
        r"as calculated|come calcolato": chain, r"without ties|senza catene": replace(chain, tie=None),
        r"every P in|ogni P in": letter,
    }  # fmt: skip
    faults = []
    for *_, grid in walk.tables:
        if not re.match(r"As calculated, and|Come calcolato e", grid.caption):
            continue
        for k, head in enumerate(grid.heads[1:], 1):
            own = next(each for pattern, each in variants.items() if re.match(pattern, head))
            found = expected(walk, own, lost_seat(walk.structure, own))
            for row in grid.rows:
                name, _, what = row[0].partition(": ")
                zeta = found.get(("start", name), {}).get("ζ_[E]")
                if name == "SLV" or name == "SLC":
                    exact = found["exact", name]
                    zeta = max(zeta, found["nonlinear", name]["ζ_[E]"])
                    if what[:4] in ("capa", "dema", "doma"):
                        value = exact[f"d_[{name}]"] if what[:4] == "capa" else exact[f"S_[De](T_[{name}])"]
                        faults += [] if is_printed(row[k], value) else [(head, row, value)]
                        continue
                if what.startswith("verif"):
                    if re.match(r"without|senza", head) and zeta < 1 and is_required(walk, name):
                        walk.failing_without_ties[name] = zeta
                    faults += [] if says(row[k], is_required(walk, name), zeta >= 1) else [(head, row, zeta)]
                elif what:
                    faults += [] if is_printed(row[k], zeta) else [(head, row, zeta)]
                else:
                    symbol = name.partition(" [")[0]
                    value = {**found["chain", ""], **found["curve", ""]}[symbol]
                    faults += [] if is_printed(row[k], value) else [(head, row, value)]
    return faults


def faults_of_tables(walk, direction, chain):
    """Places of blocks, joints and ties at each rotation that are not those of the chain."""
    faults, phi = [], 0.0
    for where, section, state, grid in walk.tables:
        if where != direction:
            continue
        if turned := re.search(r"φ = (\S+) rad", grid.caption):
            phi = number(turned[1])
        if "Δx [m]" in grid.heads:
            rows = [
                (f"block {row[0]}", [*map(number, row[1:5])], centres(chain, int(row[0]), phi)) for row in grid.rows
            ]
            if grid.heads[-1] == "θ [rad]":
                rows += [(f"turn of {row[0]}", [abs(number(row[-1]))], [turn(chain, int(row[0]), phi)])
                         for row in grid.rows]  # fmt: skip
        elif grid.heads[0] in ("joint", "vincolo"):
            wanted = zip(grid.rows, hinges_at(grid, chain, phi), strict=True)
            rows = [(f"joint {row[0]}", [*map(number, row[3:5])], (at.real, at.imag)) for row, at in wanted]
        elif chain.tie and grid.heads[-1] == "ΔL/L [%]":
            fixed, at, force = chain.tie
            rest, now = abs(at - fixed), abs(chain.moved(1, at, phi) - fixed)
            values = [*map(number, grid.rows[0][2:])]
            rows = [("tie", values, (force, now - rest, 100 * (now - rest) / rest))]
        else:
            continue
        for name, printed, values in rows:
            digits = [5] * len(printed) if name != "tie" else [5, 5, 3]
            size = max(map(abs, printed))
            for one, value, digit in zip(printed, values, digits, strict=True):
                if not close(value, one, digit, least=2e-6 * size):
                    faults.append((direction, section, state, name, one, "by the chain", value))
    return faults


def centres(chain, block, phi):
    """Δx, x_G, y_G and x_P of a block at a rotation."""
    own = [each for each in chain.weights if each.block == block]
    now, rest = ([(chain.moved(block, each.at, turn), each) for each in own] for turn in (phi, 0.0))
    G_now, G_rest, P_now = barycentre(now, "PQ"), barycentre(rest, "PQ"), barycentre(now, "P")
    return chain.s * (G_now - G_rest).real, G_now.real, G_now.imag, P_now.real


def turn(chain, block, phi):
    """The size of the finite rotation of a block at a rotation of the mechanism."""
    return abs(phase(chain.moved(block, 1, phi) - chain.moved(block, 0, phi)))


def barycentre(places, share):
    weights = [getattr(each, share) for _, each in places]
    return sum(weight * at for weight, (at, _) in zip(weights, places, strict=True)) / sum(weights)


def hinges_at(grid, chain, phi):
    """Where the joints of a table are at a rotation."""
    if len(chain.hinges) == 1:
        return chain.hinges
    a, b, c, d = chain.hinges
    first, middle, last = chain.blocks
    places = {
        frozenset((0, first)): a, frozenset((first, middle)): chain.moved(first, b, phi),
        frozenset((middle, last)): chain.moved(last, c, phi), frozenset((last, 0)): d,
    }  # fmt: skip
    return [places[frozenset(map(int, row[2].split(", ")))] for row in grid.rows]


# What is said: the tables and sentences of the verdict, and those of the time histories.


def is_satisfied(text):
    return not re.search(r"not satisfied|non (è )?soddisfatta|unknown|non nota|non è not", text)


def is_printed(cell, value):
    """Whether a cell has a value, to its digits but at most four; None is a dash."""
    cell = cell.removesuffix(" g").removesuffix(" m")
    if value is None or cell == "–":
        return value is None and cell == "–"
    return isclose(number(cell), value, rel_tol=1e-9) or abs(number(cell) - value) <= 0.51 * unit_of_digit(value, 4)


def directions_of(walk):
    return list(dict.fromkeys(each[0] for each in walk.results if each[1] == "chain"))


def records_of(walk):
    """The tables of records by direction and limit state."""
    heads = ("record", "accelerogramma")
    tables = (each for each in walk.tables if each[1] == "dynamic" and each[-1].heads[0] in heads)
    return {(direction, state): grid for direction, _, state, grid in tables}


def peaks(grid, column):
    """The peaks of the records of a table by name; None is unknown."""
    cells = {row[0]: row[column] for row in grid.rows[:-3]}
    return {name: None if re.search(r"unknown|non noto", cell) else number(cell) for name, cell in cells.items()}


def mean(found):
    values = list(found.values())
    return None if None in values else sum(values) / len(values)


def faults_of_records(walk, sheet):
    """Means, largest peaks, capacities and sentences that are not those of the peaks of the records."""
    faults, sentences = [], [each.text for each in sheet.items if isinstance(each, Sentence)]
    said = [each for each in sentences if re.match(r"(With|Without|Con|Senza) FC, SL", each)]
    for (direction, state), grid in records_of(walk).items():
        capacity = walk.code[direction]["exact", state][f"d_[{state}]"]
        for column in (2, 3):
            found = peaks(grid, column)
            known = [each for each in found.values() if each is not None]
            wanted = mean(found), max(known), capacity
            for row, value in zip(grid.rows[-3:], wanted, strict=True):
                if (value is None) != (row[column] == "–") or (
                    value is not None and not close(value, number(row[column]))
                ):
                    faults.append((direction, state, row, value))
            text = said.pop(0)
            unknown = [name for name, each in found.items() if each is None]
            if is_satisfied(text) != (not unknown and wanted[0] <= capacity) or not all(
                name in text for name in unknown
            ):
                faults.append((direction, state, text))
            if any(name in text for name in found.keys() - set(unknown)):
                faults.append((direction, state, text))
    return faults + [("no table has", each) for each in said]


def is_required(walk, state):
    """Whether a limit state decides: SLV, and SLD for class IV."""
    return state == "SLV" or (state == "SLD" and str(walk.site.get("class")) == "IV")


def says(text, required, holds):
    """Whether the words of a verdict are those of what is required and of what holds; None is unknown."""
    if not required:
        return bool(re.search(r"not required|non richiesta|[Nn]o verification is required", text))
    if holds is None:
        return bool(re.search(r"not decided|non decisa|unknown|non nota", text))
    return is_satisfied(text) == holds and bool(re.search(r"satisfied|soddisfatta", text))


def row_of_state(walk, direction, row):
    """The values of a row of the table of limit states, whether it holds, and the ratio that decides."""
    state, of = state_of(row[0]), lambda section: walk.code[direction][section, state_of(row[0])]
    start = of("start")
    if state == "SLD":
        ratio = start["ζ_[E]"]
        return [start["a_[g,0]"], walk.asked[state], None, None, ratio], ratio >= 1, ratio
    exact = of("exact")
    if "," in row[0]:  # time histories
        found = mean(peaks(records_of(walk)[direction, state], 2))
        ratio = None if found is None else exact[f"d_[{state}]"] / found
        return [exact[f"d_[{state}]"], found, None, ratio, None], None if ratio is None else ratio >= 1, ratio
    ratio, zeta = exact[f"ρ_[{state}]"], max(start["ζ_[E]"], of("nonlinear")["ζ_[E]"])
    values = [exact[f"d_[{state}]"], exact[f"S_[De](T_[{state}])"], exact[f"T_[{state}]"], ratio, zeta]
    return values, zeta >= 1, zeta


def row_of_method(walk, direction, row):
    """The values of a row of the table of methods, and its return period."""
    state, linear = state_of(row[0]), "linear" in row[0].lower() and "nonlinear" not in row[0].lower()
    linear = linear and "non lineare" not in row[0]
    section, state = ("linear", "SLD") if linear else (kind_of(row[0]), state)
    exact = walk.code[direction][section, state]
    line = walk.code[direction].get((f"{section} line", state), exact)
    capacity = next(name for name in ("a_[g,q]", "a_[g,nl]", "a_[g,0]") if name in exact)
    of_line = line.get(f"{capacity[:-1]},lin]", exact[capacity])
    return [exact[capacity], of_line, walk.asked["SLV" if linear else state], exact["ζ_[E]"]], exact.get("T_[R]")


def lasts(cell, period):
    """Whether a cell has a return period in whole years, or says that it is beyond the table; a clause is none."""
    if not re.match(r"[<>\d]", cell):
        return period is None
    return period is None if cell[0] in "<>" else period is not None and abs(number(cell) - period) <= 0.51


def faults_of_verdict(walk, sheet):
    """Rows and sentences of a verdict that are not those of the results."""
    faults, passed, ratios = [], [], []
    for item in (each for each in sheet.items if isinstance(each, Grid) and ": " in each.caption):
        direction = item.caption.partition(": ")[0]
        for row in item.rows if item.heads[0] in ("limit state", "stato limite") else ():
            values, holds, ratio = row_of_state(walk, direction, row)
            cells = [*row[1:5], row[7]]
            wrong = [pair for pair in zip(cells, values, strict=True) if not is_printed(*pair)]
            required = ("," in row[0] and "SLD" not in row[0]) or is_required(walk, state_of(row[0]))
            if wrong or not says(row[5], required, holds):
                faults.append((direction, row, wrong, holds))
            if required:
                passed.append(holds)
                ratios.append(ratio)
        for row in item.rows if item.heads[0] in ("method", "metodo") else ():
            values, period = row_of_method(walk, direction, row)
            wrong = [pair for pair in zip(row[1:5], values, strict=True) if not is_printed(*pair)]
            if wrong or not lasts(row[5], period):
                faults.append((direction, row, wrong, period))
    answer, *more = [each.text for each in sheet.items if isinstance(each, Sentence) and "answer" in each.kind]
    said = re.findall(r"= (\S+) (?:at|allo) (\w+)", "".join(more).replace("0,", "0."))
    failing = [(f"{zeta:.3g}", state) for state, zeta in walk.failing_without_ties.items()] if all(passed) else []
    if said != failing:
        faults.append(("without ties", more, failing))
    least = "" if None in ratios else f" {min(ratios):.3g}".replace(".", "[.,]") + r"(\.|\s|$)"
    if (
        is_satisfied(answer.partition(".")[0]) != all(passed)
        or state_of(answer) != walk.decides
        or not re.search(least, answer)
    ):
        faults.append(("the answer", answer, passed, ratios))
    return faults + faults_of_sentences(walk, sheet)


def faults_of_sentences(walk, sheet):
    """Verdicts that do not follow from their ratios, and numbers of four digits or more that no line has."""
    faults = []
    results = [*walk.results.values(), *(each for own in walk.code.values() for each in own.values())]
    seen = {f"{value:.4g}" for values in (walk.also, *(each.values() for each in results)) for value in values}
    cells = [
        cell
        for each in sheet.items
        if isinstance(each, Grid) and "%" not in each.caption
        for row in each.rows
        for cell in row
    ]
    seen |= {f"{value:.4g}" for cell in cells for value in numbers_in(cell)} | {f"{each:.4g}" for each in CONSTANTS}
    for each in sheet.items:
        if (
            isinstance(each, Step)
            and each.symbol.startswith("ρ")
            and re.search("satisfied|soddisfatta", each.what)
            and is_satisfied(each.what) != (number(each.result) >= 1)
        ):
            faults.append((each.symbol, each.what))
        if not isinstance(each, Sentence):
            continue
        # A joint that opens is of a push of all blocks, not of the chain: no line has its displacement.
        if re.match(r"(The joint|Il giunto) .* (opens|si apre) ", each.text):
            continue
        for text in re.findall(r"(?<![\w.,§])\d+[.,]\d+(?: · 10\^\[[−\d]+\])?", each.text):
            if len(re.sub(r"\D", "", text.partition(" ")[0]).lstrip("0")) > 3 and f"{number(text):.4g}" not in seen:
                faults.append((text, each.text))
        if found := re.match(
            r"(?P<direction>[^,]*?), (?:[^,]*, )?(?P<state>SL.): ([Tt]he verification|la verifica|verifica|no verif)",
            each.text,
        ):
            if "ζ_[E] =" not in each.text:  # of time histories, which have records of their own
                continue
            state, zeta = found["state"], number(re.search(r"ζ_\[E\] = (\d+[.,]?\d*)", each.text)[1])
            if not says(each.text.partition(".")[0], is_required(walk, state), zeta >= 1):
                faults.append((state, each.text))
    return faults


@cache
def page_of(name):
    return (FOLDER / f"{name}.html").read_text(encoding="utf-8")


def faults(page):
    """Everything on a page that does not agree with what is printed on it."""
    sheet = Sheet.read(page)
    walk = Walk(sheet)
    left = [each[-1] for each in walk.after if each[-1].symbol not in ("d_[a]", "d_[t]")]
    found = [*walk.faults, *(("found by trial and not checked", each) for each in left)]
    return [*found, *faults_of_code(walk), *faults_of_records(walk, sheet), *faults_of_verdict(walk, sheet)]


@pytest.mark.parametrize("name", NAMES)
def test_every_line_of_a_sheet_follows_from_what_is_printed_and_from_the_code(name):
    steps = [each for each in Sheet.read(page_of(name)).items if isinstance(each, Step)]
    assert len(steps) > 80 and sum(bool(each.formula and each.numbers) for each in steps) > 75
    assert faults(page_of(name)) == []


PLACES = re.compile(
    r'(?<=<mn>)[\d.,]+(?=</mn>)|(?<=<strong class="result">)[−\d.,]+|(?<=<td class="number">)[−\d.,]+(?= g</td>|</td>)'
)
"""Numbers in steps and tables."""


def mutated(page, pick):
    """A page with another digit among the first four of a number of its verdict or workings, and what was changed."""
    parts = re.split(r'(?=<section id="(?:input|figures|workings|standing)")', page)
    chosen = pick.choice(
        [k for k, part in enumerate(parts) if re.search('id="(summary|remarks|workings)"', part[:900]) or k == 0]
    )
    found = [each for each in PLACES.finditer(parts[chosen]) if len(re.sub(r"\D", "", each[0]).lstrip("0")) > 3]
    # The peak of a record, in the first column of its row, is of a file that is not on the page.
    of_record = re.compile(r'channel [^<]*</th><td class="number">$')
    found = [each for each in found if not of_record.search(parts[chosen][: each.start()][-200:])]
    place = pick.choice(found)
    digits = [
        each.start() for each in re.finditer(r"\d", place[0]) if re.search("[1-9]", place[0][: each.start() + 1])
    ][:4]
    at = place.start() + pick.choice(digits)
    old = parts[chosen][at]
    new = pick.choice([each for each in "123456789" if each != old])
    parts[chosen] = parts[chosen][:at] + new + parts[chosen][at + 1 :]
    return "".join(parts), f"{place[0]}: {old} is {new}: {parts[chosen][at - 300 : at + 30]}"


@pytest.mark.every(4)
@pytest.mark.parametrize("seed", range(10))
def test_another_digit_is_found(seed):
    pick = random.Random(seed)
    page, what = mutated(page_of(NAMES[seed % len(NAMES)]), pick)
    assert faults(page), what
