"""Steps of the chain in the sheet: weights, virtual displacements and restraints, at rest and displaced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.displaced import DisplacedChain, ForceWork, Moved, thickness_of_plate
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.core.hung.ties import Tie
from rocking_cli.verification.results import Evaluated
from rocking_cli.views.sheet.language import BodyName, Language

ROUNDING_SHARE = 1e-9  # share of the size of the structure below which a coordinate is zero
KILO = 1e3  # forces of ties are printed in kN, stresses in kN/m2
Rows = Sequence[Sequence[Any]]
"""Rows of a table: names, and numbers to be written in a language."""
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


def weights(chain: Chain, scale: Scale) -> Rows:
    """Return a row for every mass that moves: name, block, x, y, M, w, h, and its shares in P and in P + Q."""
    rows = []
    for each in chain.weights:
        block = next(k for k, block in enumerate(chain.blocks, 1) if each.spot.body in block.bodies)
        numbers = [*map(scale.near, (each.spot.at.real, each.spot.at.imag)), each.mass, each.w, each.h]
        forces = [scale.weight(each.carried), scale.weight(each.inertial)]
        rows.append([BodyName(chain.mechanism.mechanism, each.name), block, *map(float, numbers), *forces])
    return rows


def of_blocks(chain: Chain, scale: Scale) -> Iterator[Evaluated]:
    """Yield steps for the weight of each block and its point of action."""
    for k, block in enumerate(chain.blocks, 1):
        weights = [each for each in chain.weights if each.spot.body in block.bodies]
        carried, inertial = ([scale.weight(getattr(each, key)) for each in weights] for key in ("carried", "inertial"))
        key, of = chain.mechanism.mechanism, [each.name for each in weights]
        names: dict[str, Any] = {"k": k, "block": [BodyName(key, each) for each in block.bodies], "unit": scale.unit}
        names |= {sign: [BodyName(key, each, symbol) for each in of] for sign, symbol in (("P", "P"), ("P+Q", "(P+Q)"))}
        yield F.P.line(scale.weight(block.P), names, P=carried)
        moved = F.PQ if chain.is_by_the_letter else replace(F.PQ, standing="ours")
        yield moved.line(scale.weight(block.PQ), names, P=inertial)
        for axis, at in (("x", block.at.real), ("y", block.at.imag)):
            places = [scale.near(each.spot.at.real if axis == "x" else each.spot.at.imag) for each in weights]
            yield F.G.line(scale.near(at), {**names, "axis": axis}, P=inertial if block.PQ else carried, x=places)
        if block.P and block.P != block.PQ:
            for axis, at in (("x", block.of_P.real), ("y", block.of_P.imag)):
                places = [scale.near(each.spot.at.real if axis == "x" else each.spot.at.imag) for each in weights]
                yield F.GP.line(scale.near(at), {**names, "axis": axis}, P=carried, x=places)


def at_work(position: DisplacedChain, scale: Scale) -> Rows:
    """Return a row for each block in a position: its displacement, barycentres, motion and angle."""
    rows = []
    for k, each in enumerate(position.blocks, 1):
        lengths = [each.gone, each.at.real, each.at.imag, _x_of_P(position, each), each.dx, each.dy]
        gone, x_G, y_G, x_P, dx, dy = map(scale.near, lengths)
        turns = 0.0 if each.centre is None else each.turns
        centre = (None, None) if each.centre is None else map(scale.near, (each.centre.real, each.centre.imag))
        rows.append([k, gone, x_G, y_G, x_P, turns, *centre, dx, dy, *([each.angle] if position.phi else [])])
    return rows


def _x_of_P(position: DisplacedChain, each: Moved) -> float:
    """Return the horizontal position of the barycentre of P of a block [m]; of P + Q if it carries nothing."""
    if each.centre is None or not each.block.P:
        return each.at.real
    return each.centre.real - position.chain.direction * each.dy / each.turns


def of_steel(tie: Tie, depth: float | None) -> Iterator[Evaluated]:
    """Yield the steps to the strength of a tie of steel."""
    n, names = tie.number_of_bars(depth), {"tie": tie.name}
    strength, stress = tie.strength(n), {"f": tie.yield_of_steel / KILO, "gamma": tie.gamma or 1.0}
    limits = {key: force / KILO for key, force in strength.limits.items()}
    if tie.spacing is not None:
        yield F.TIE_NUMBER.line(n, names, depth=depth, spacing=tie.spacing)
    if tie.diameter is None:
        yield F.TIE_YIELD_OF_AREA.line(limits["yield"], names, A=tie.area, **stress)
    else:
        yield F.TIE_YIELD.line(limits["yield"], names, n=n, d=tie.diameter, **stress)
    if tie.plate is None or tie.wall is None:
        return
    plate = {"n": n, "b": tie.plate.width, "h": tie.plate.height}
    wall, masonry = tie.wall, {**plate, "gamma": tie.wall.gamma or 1.0}
    yield F.TIE_PUNCHING.line(limits["punching"], names, t=wall.thickness, f=wall.shear / KILO, **masonry)
    yield F.TIE_BEARING.line(limits["bearing"], names, f=wall.compression / KILO, **masonry)
    if tie.plate.thickness is not None:
        steel = {**plate, "f": tie.plate.yield_stress / KILO, "gamma": tie.plate.gamma or 1.0}
        yield F.TIE_BENDING.line(limits["bending"], names, s=tie.plate.thickness, **steel)
    bends = "; N_[s]" if "bending" in limits else ""
    yield F.TIE.line(strength.force / KILO, {**names, "bends": bends}, N=[*limits.values()])
    if tie.plate.thickness is None:
        steel = {**plate, "f": tie.plate.yield_stress / KILO, "gamma": tie.plate.gamma or 1.0}
        yield F.TIE_THICKNESS.line(thickness_of_plate(tie, depth), names, N=strength.force / KILO, **steel)


def named(say: Language, name: str) -> str:
    """Return the name of a force; that of crossing walls is of the program, all others are the user's."""
    return say(INTERLOCK_NAME) + name.removeprefix(INTERLOCK_NAME) if name.partition(",")[0] == INTERLOCK_NAME else name


def held(position: DisplacedChain, scale: Scale) -> Rows:
    """Return a row for each force or tie in a position: name, force, displacement along it, and work."""
    return [[each.name, scale.weight(each.force), scale.near(each.rate), scale.work(each)] for each in position.held]


def _printed(position: DisplacedChain, scale: Scale, total: float, kind: str) -> float:
    """Return a sum over the weights P or PQ of the blocks in printed units, without rounding errors about zero."""
    value, largest = scale.weight(total), sum(abs(getattr(each.block, kind)) for each in position.blocks)
    return 0.0 if abs(value) < MIN_SHARE * scale.weight(largest) * scale.length else value


def multiplier(position: DisplacedChain, scale: Scale, at: str = "") -> Iterator[Evaluated]:
    """Yield the lines to alpha in a position, of which `at` is the symbol in parentheses; at rest it has none."""
    names, blocks = {"unit": scale.unit, "at": at}, position.blocks
    carried, inertial = ([scale.weight(getattr(each.block, key)) for each in blocks] for key in ("P", "PQ"))
    lifted, driven = (
        _printed(position, scale, total, kind) for total, kind in ((position.lifted, "P"), (position.driven, "PQ"))
    )
    over = [F.PY.line(lifted, names, P=carried, y=[scale.near(each.dy) for each in blocks])]
    if position.held:
        works = [scale.work(each) for each in position.held]
        forces = [scale.weight(each.force) for each in position.held]
        arms = [work / force if force else 0.0 for work, force in zip(works, forces, strict=True)]
        over.append(F.HELD.line(sum(works), names, N=forces, r=arms))
    if position.rest:
        over.append(F.V_M.line(scale.weight(position.rest), names))
    under = [F.PQX.line(driven, names, P=inertial, x=[scale.near(each.dx) for each in blocks])]
    if position.more:
        under.append(F.B_M.line(scale.weight(position.more), names))
    yield from (*over, *under)
    largest = sum(abs(each.block.P) for each in blocks) * scale.length / abs(position.driven)
    value = 0.0 if abs(position.alpha) < MIN_SHARE * largest else position.alpha
    sides = {
        key: " + ".join(line.formula.symbol.format(at=at) for line in lines)
        for key, lines in (("over", over), ("under", under))
    }
    formula = F.ALPHA if at else F.ALPHA_0
    yield formula.line(
        value,
        {"symbol": f"α{at or '_[0]'}", **sides},
        V=[each.value for each in over],
        B=[each.value for each in under],
    )


def sums(chain: Chain, rest: DisplacedChain, scale: Scale) -> Iterator[Evaluated]:
    """Yield the lines to alpha0, e* and M*."""
    yield from multiplier(rest, scale)
    names, inertial = {"unit": scale.unit}, [scale.weight(each.block.PQ) for each in rest.blocks]
    first, total, second = (scale.weight(value) for value in (chain.first, chain.inertial, chain.second))
    yield F.SUM_PQ.line(total, names, P=inertial)
    yield F.PQXX.line(second, names, P=inertial, x=[scale.near(each.dx) for each in rest.blocks])
    yield F.E_STAR.line(chain.e_star, first=first, PQ=total, second=second)
    if chain.mechanism.has_mass:
        g = chain.mechanism.gravity
        yield F.M_STAR.line(chain.e_star * chain.inertial / g, e=chain.e_star, PQ=total, g=g)
