"""Steps of the chain in the sheet: weights, virtual displacements and restraints, at rest and displaced."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.displaced import DisplacedChain, ForceWork, Moved
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.core.hung.ties import Tie
from rocking_cli.verification.results import Working
from rocking_cli.views.sheet.document import Item, SheetPart, Steps
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

ROUNDING_SHARE = 1e-9  # share of the size of the structure below which a coordinate is zero
KILO = 1e3  # forces of ties are printed in kN, stresses in kN/m2
MIN_SHARE = 1e-9  # share of the terms of a sum below which the sum is zero


@dataclass(frozen=True)
class Scale:
    """Unit of printed weights: kN, or N per kg for a structure without masses.

    Parameters
    ----------
    size : float
        Size of one unit [N].
    unit : str
    length : float
        Size of the structure [m].
    """

    size: float
    unit: str
    length: float

    @classmethod
    def of(cls, chain: Chain) -> Scale:
        """Return the scale of a structure."""
        length = max(abs(each.spot.at) for each in chain.weights)
        return cls(1e3, "kN", length) if chain.mechanism.has_mass else cls(1.0, "N/kg", length)

    def weight(self, value: float) -> float:
        """Convert a weight [N] to the printed unit."""
        return value / self.size

    def work(self, each: ForceWork) -> float:
        """Convert the work of a force or tie [N m] to the printed unit; zero if its point does not move along it."""
        return self.weight(each.work) if self.near(each.rate) else 0.0

    def near(self, value: float) -> float:
        """Return a length, with rounding errors about zero removed [m]."""
        return 0.0 if abs(value) < ROUNDING_SHARE * self.length else value


def part(say: Language, curve: ExactCurve, key: str) -> SheetPart:
    """Return the part on the chain at rest, up to alpha0, e* and M*."""
    chain = curve.chain
    scale, rest = Scale.of(chain), DisplacedChain(curve, 0.0)
    items: list[Item] = [
        _weights(say, chain, scale),
        Steps(list(_of_blocks(say, chain, scale))),
        at_work(say, rest, scale),
        *(
            Steps(list(_of_steel(say, tie, chain.mechanism.depth)))
            for tie in chain.mechanism.ties or []
            if tie.is_steel
        ),
        *held(say, rest, scale),
        Steps(list(_sums(say, chain, rest, scale))),
    ]
    return SheetPart(f"{key}-chain", say("Kinematic chain, at rest"), items)


def _weights(say: Language, chain: Chain, scale: Scale) -> Table:
    """Return a table of every mass that moves, with its shares in P and in P + Q."""
    rows = []
    for each in chain.weights:
        block = next(k for k, block in enumerate(chain.blocks, 1) if each.spot.body in block.bodies)
        numbers = [*map(scale.near, (each.spot.at.real, each.spot.at.imag)), each.mass, each.w, each.h]
        forces = [scale.weight(each.carried), scale.weight(each.inertial)]
        rows.append([say.body(chain.mechanism.mechanism, each.name), str(block), *map(say.number, numbers + forces)])
    heads = [say("weight"), say("block"), "x [m]", "y [m]", "M [kg]", "w", "h"]
    caption = say("weights", g=say.number(chain.mechanism.gravity))
    return Table(caption, [*heads, f"P [{scale.unit}]", f"P + Q [{scale.unit}]"], rows, range(1, 9))


def _of_blocks(say: Language, chain: Chain, scale: Scale) -> Iterator[Working]:
    """Yield steps for the weight of each block and its point of action."""
    for k, block in enumerate(chain.blocks, 1):
        weights = [each for each in chain.weights if each.spot.body in block.bodies]
        carried, inertial = ([scale.weight(getattr(each, key)) for each in weights] for key in ("carried", "inertial"))
        key, of = chain.mechanism.mechanism, [each.name for each in weights]
        bodies = " + ".join(say.body(key, each) for each in block.bodies)
        names = {"k": str(k), "block": bodies, "unit": scale.unit}
        names |= {kind: _summands(kind, [say.body(key, each) for each in of]) for kind in ("P", "P+Q")}
        yield say.step(F.P, scale.weight(block.P), names, P=carried)
        moved = F.PQ if chain.is_by_the_letter else replace(F.PQ, standing="ours")
        yield say.step(moved, scale.weight(block.PQ), names, P=inertial)
        for axis, at in (("x", block.at.real), ("y", block.at.imag)):
            places = [scale.near(each.spot.at.real if axis == "x" else each.spot.at.imag) for each in weights]
            yield say.step(F.G, scale.near(at), {**names, "axis": axis}, P=inertial if block.PQ else carried, x=places)
        if block.P and block.P != block.PQ:
            places = [scale.near(each.spot.at.real) for each in weights]
            yield say.step(F.GP, scale.near(block.x_of_P), names, P=carried, x=places)


def _summands(kind: str, names: Sequence[str]) -> str:
    """Return the sum of the weights of a kind, P or P + Q, by the names of the masses."""
    return " + ".join(f"{kind.join('()') if '+' in kind else kind}_[{re.sub(r'[][]', '', each)}]" for each in names)


def at_work(say: Language, position: DisplacedChain, scale: Scale) -> Table:
    """Return a table of the motion of each block in a position: centre of rotation, barycentres, displacements."""
    rows = []
    for k, each in enumerate(position.blocks, 1):
        lengths = [each.gone, each.at.real, each.at.imag, _x_of_P(position, each), each.dx, each.dy]
        gone, x_G, y_G, x_P, dx, dy = map(scale.near, lengths)
        turns = 0.0 if each.centre is None else each.turns
        centre = (None, None) if each.centre is None else map(scale.near, (each.centre.real, each.centre.imag))
        rows.append([str(k), *map(say.number, (gone, x_G, y_G, x_P, turns, *centre, dx, dy))])
    caption = say("at_work_rest" if position.phi == 0 else "at_work", phi=say.number(position.phi), across="@")
    caption = caption.replace("@", "(x_[O] − x_[P])" if position.chain.direction > 0 else "(x_[P] − x_[O])")
    heads = [say("block"), "Δx [m]", "x_[G] [m]", "y_[G] [m]", "x_[P] [m]", "θ′", "x_[O] [m]", "y_[O] [m]",
             "x′ [m]", "y′ [m]"]  # fmt: skip
    return Table(caption, heads, rows, range(1, 10))


def _x_of_P(position: DisplacedChain, each: Moved) -> float:
    """Return the horizontal position of the barycentre of P of a block [m]; of P + Q if it carries nothing."""
    if each.centre is None or not each.block.P:
        return each.at.real
    return each.centre.real - position.chain.direction * each.dy / each.turns


def _of_steel(say: Language, tie: Tie, depth: float | None) -> Iterator[Working]:
    """Yield the steps to the strength of a tie of steel."""
    n, names = tie.number_of_bars(depth), {"tie": tie.name}
    strength, stress = tie.strength(n), {"f": tie.yield_of_steel / KILO}
    limits = {key: force / KILO for key, force in strength.limits.items()}
    if tie.spacing is not None:
        yield say.step(F.TIE_NUMBER, n, names, depth=depth, spacing=tie.spacing)
    if tie.diameter is None:
        yield say.step(F.TIE_YIELD_OF_AREA, limits["yield"], names, A=tie.area, **stress)
    else:
        yield say.step(F.TIE_YIELD, limits["yield"], names, n=n, d=tie.diameter, **stress)
    if tie.plate is None or tie.wall is None:
        return
    plate = {"n": n, "b": tie.plate.width, "h": tie.plate.height}
    yield say.step(F.TIE_PUNCHING, limits["punching"], names, t=tie.wall.thickness, f=tie.wall.shear / KILO, **plate)
    yield say.step(F.TIE_BEARING, limits["bearing"], names, f=tie.wall.compression / KILO, **plate)
    yield say.step(F.TIE, strength.force / KILO, names, N=[*limits.values()])


def named(say: Language, name: str) -> str:
    """Return the name of a force; that of crossing walls is of the program, all others are the user's."""
    return say(INTERLOCK_NAME) + name.removeprefix(INTERLOCK_NAME) if name.partition(",")[0] == INTERLOCK_NAME else name


def held(say: Language, position: DisplacedChain, scale: Scale) -> list[Item]:
    """Return a table of forces and ties in a position; empty if there are none."""
    if not position.held:
        return []
    rows = [
        [named(say, each.name), *map(say.number, (scale.weight(each.force), scale.near(each.rate), scale.work(each)))]
        for each in position.held
    ]
    heads = [say("force or tie"), f"F, N [{scale.unit}]", "r′, L′ [m]", f"−F r′, N L′ [{scale.unit} m]"]
    return [Table(say("held"), heads, rows, (1, 2, 3))]


def _printed(position: DisplacedChain, scale: Scale, total: float, kind: str) -> float:
    """Return a sum over the weights P or PQ of the blocks in printed units, without rounding errors about zero."""
    value, largest = scale.weight(total), sum(abs(getattr(each.block, kind)) for each in position.blocks)
    return 0.0 if abs(value) < MIN_SHARE * scale.weight(largest) * scale.length else value


def multiplier(say: Language, position: DisplacedChain, scale: Scale, symbol: str) -> Iterator[Working]:
    """Yield the steps to alpha in a position."""
    unit, blocks = {"unit": scale.unit}, position.blocks
    over = {F.PY.text: _printed(position, scale, position.lifted, "P")}
    under = {F.PQX.text: _printed(position, scale, position.driven, "PQ")}
    carried, inertial = ([scale.weight(getattr(each.block, key)) for each in blocks] for key in ("P", "PQ"))
    yield say.step(F.PY, over[F.PY.text], unit, P=carried, y=[scale.near(each.dy) for each in blocks])
    if position.held:
        works = [scale.work(each) for each in position.held]
        over["L"] = sum(works)
        yield say.step(F.HELD, over["L"], unit, L=works)
    if position.rest:
        over["V_[m]"] = scale.weight(position.rest)
        yield say.step(F.V_M, over["V_[m]"], unit)
    yield say.step(F.PQX, under[F.PQX.text], unit, P=inertial, x=[scale.near(each.dx) for each in blocks])
    if position.more:
        under["B_[m]"] = scale.weight(position.more)
        yield say.step(F.B_M, under["B_[m]"], unit)
    largest = sum(abs(each.block.P) for each in blocks) * scale.length / abs(position.driven)
    value = 0.0 if abs(position.alpha) < MIN_SHARE * largest else position.alpha
    names = {"symbol": symbol, "over": " + ".join(over), "under": " + ".join(under)}
    yield say.step(F.ALPHA, value, names, V=[*over.values()], B=[*under.values()])


def _sums(say: Language, chain: Chain, rest: DisplacedChain, scale: Scale) -> Iterator[Working]:
    yield from multiplier(say, rest, scale, "α_[0]")
    names, inertial = {"unit": scale.unit}, [scale.weight(each.block.PQ) for each in rest.blocks]
    first, total, second = (scale.weight(value) for value in (chain.first, chain.inertial, chain.second))
    yield say.step(F.SUM_PQ, total, names, P=inertial)
    yield say.step(F.PQXX, second, names, P=inertial, x=[scale.near(each.dx) for each in rest.blocks])
    yield say.step(F.E_STAR, chain.e_star, first=first, PQ=total, second=second)
    if chain.mechanism.has_mass:
        g = chain.mechanism.gravity
        yield say.step(F.M_STAR, chain.e_star * chain.inertial / g, e=chain.e_star, PQ=total, g=g)
