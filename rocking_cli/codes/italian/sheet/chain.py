"""Steps of the chain in the sheet: weights, displacements and restraints; centres and rotations of its blocks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isclose
from operator import attrgetter
from typing import Any, Literal

import numpy as np

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import (
    MIN_TURN,
    DisplacedChain,
    ExactCurve,
    ForceWork,
    Moved,
    thickness_of_plate,
)
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.sheet.geometry import SHARE_OF_ROUNDING, cleared, sharpened
from rocking_cli.core import Joint
from rocking_cli.core.centres import GROUND, Centre, Centres, Locus, Pair
from rocking_cli.core.hung.attached import Follow, Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.core.hung.ties import Tie
from rocking_cli.core.reactions import parts
from rocking_cli.verification.results import Evaluated
from rocking_cli.views.sheet.language import BodyName, Language, as_subscript

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


@dataclass(frozen=True)
class ChainSteps:
    """Lines and rows of the chain of a capacity curve, at rest and in other positions, in printed units.

    Parameters
    ----------
    curve : ExactCurve
        The capacity curve.
    """

    curve: ExactCurve

    @property
    def chain(self) -> Chain:
        """The moving blocks."""
        return self.curve.chain

    @cached_property
    def scale(self) -> Scale:
        """Unit of printed weights."""
        return Scale.of(self.chain)

    @cached_property
    def rest(self) -> DisplacedChain:
        """The chain at rest."""
        return DisplacedChain(self.curve, 0.0)

    @property
    def weights(self) -> Rows:
        """Row of every mass that moves: name, block, x, y, M, w, h, and its shares in P and in P + Q."""
        chain, scale, rows = self.chain, self.scale, []
        for each in chain.weights:
            block = next(k for k, block in enumerate(chain.blocks, 1) if each.spot.body in block.bodies)
            numbers = [*map(scale.near, (each.spot.at.real, each.spot.at.imag)), each.mass, each.w, each.h]
            forces = [scale.weight(each.carried), scale.weight(each.inertial)]
            rows.append([BodyName(chain.mechanism.mechanism, each.name), block, *map(float, numbers), *forces])
        return rows

    def of_blocks(self) -> Iterator[Evaluated]:
        """Yield steps for the weight of each block and its point of action."""
        chain, scale = self.chain, self.scale
        for k, block in enumerate(chain.blocks, 1):
            weights = [each for each in chain.weights if each.spot.body in block.bodies]
            carried, inertial = (
                [scale.weight(getattr(each, key)) for each in weights] for key in ("carried", "inertial")
            )
            key, of = chain.mechanism.mechanism, [each.name for each in weights]
            names: dict[str, Any] = {
                "k": k,
                "block": [BodyName(key, each) for each in block.bodies],
                "unit": scale.unit,
            }
            names |= {
                sign: [BodyName(key, each, symbol) for each in of] for sign, symbol in (("P", "P"), ("P+Q", "(P+Q)"))
            }
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

    def at_work(self, position: DisplacedChain) -> Rows:
        """Return a row for each block in a position: its displacement, barycentres, motion and angle."""
        scale, rows = self.scale, []
        for k, each in enumerate(position.blocks, 1):
            lengths = [each.gone, each.at.real, each.at.imag, _x_of_P(position, each), each.dx, each.dy]
            gone, x_G, y_G, x_P, dx, dy = map(scale.near, lengths)
            turns = 0.0 if each.centre is None else each.turns
            centre = (None, None) if each.centre is None else map(scale.near, (each.centre.real, each.centre.imag))
            rows.append([k, gone, x_G, y_G, x_P, turns, *centre, dx, dy, *([each.angle] if position.phi else [])])
        return rows

    def centres(self, position: DisplacedChain) -> ChainCentres:
        """Return the centres of rotation of the blocks in a position, from the joints."""
        return ChainCentres(position)

    def of_steel(self) -> Iterator[Evaluated]:
        """Yield the lines to the strength of each tie of steel."""
        mechanism = self.chain.mechanism
        for tie in mechanism.ties or []:
            if tie.is_steel:
                yield from of_steel(tie, mechanism.depth)

    def held(self, position: DisplacedChain) -> Rows:
        """Return a row for each force or tie in a position: name, force, displacement along it, and work."""
        scale = self.scale
        return [
            [each.name, scale.weight(each.force), scale.near(each.rate), scale.work(each)] for each in position.held
        ]

    def multiplier(self, position: DisplacedChain, at: str = "") -> Iterator[Evaluated]:
        """Yield the lines to alpha in a position, of which `at` is the symbol in parentheses; at rest it has none."""
        scale = self.scale
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

    def sums(self) -> Iterator[Evaluated]:
        """Yield the lines to alpha0, e* and M*."""
        chain, scale, rest = self.chain, self.scale, self.rest
        yield from self.multiplier(rest)
        names, inertial = {"unit": scale.unit}, [scale.weight(each.block.PQ) for each in rest.blocks]
        first, total, second = (scale.weight(value) for value in (chain.first, chain.inertial, chain.second))
        yield F.SUM_PQ.line(total, names, P=inertial)
        yield F.PQXX.line(second, names, P=inertial, x=[scale.near(each.dx) for each in rest.blocks])
        yield F.E_STAR.line(chain.e_star, first=first, PQ=total, second=second)
        if chain.mechanism.has_mass:
            g = chain.mechanism.gravity
            yield F.M_STAR.line(chain.e_star * chain.inertial / g, e=chain.e_star, PQ=total, g=g)


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


def _printed(position: DisplacedChain, scale: Scale, total: float, kind: str) -> float:
    """Return a sum over the weights P or PQ of the blocks in printed units, without rounding errors about zero."""
    value, largest = scale.weight(total), sum(abs(getattr(each.block, kind)) for each in position.blocks)
    return 0.0 if abs(value) < MIN_SHARE * scale.weight(largest) * scale.length else value


LEADING_ROTATIONS = (0.2, 0.5)  # shares of the limit at which the leading block has turned by phi
SAME_MOTION = 1e-7  # difference of rotations, and relative one of centres, that count as one
LEVEL_NORMAL = 1e-12  # vertical part of a level normal, over its length

JointKind = Literal["hinge", "rolls", "guide", "level"]


@dataclass(frozen=True)
class JointRow:
    """A joint of the chain in a position.

    Parameters
    ----------
    symbol : str
        Its letter in the drawing.
    kind : {"hinge", "rolls", "guide", "level"}
        A hinge, a point on which a rounded edge rolls, a guide, or a hinge under a block that stays level.
    blocks : tuple of int
        The two blocks it joins, 0 for the ground; the line of a guide turns with the first.
    at : complex
        Its position [m].
    normal : complex or None
        Unit normal of the line of a guide.
    """

    symbol: str
    kind: JointKind
    blocks: Pair
    at: complex
    normal: complex | None = None


@dataclass(frozen=True)
class Rotation:
    """Rotation of a block: its number, that of the block from which it follows, and its size, see `Moved.turns`."""

    block: int
    driver: int | None
    turns: float


@dataclass(frozen=True, eq=False)
class ChainCentres:
    """Joints of the chain in a position, and the centres and rotations of its blocks that follow from them.

    Parameters
    ----------
    position : DisplacedChain
        The chain in this position.
    """

    position: DisplacedChain

    @property
    def _chain(self) -> Chain:
        return self.position.chain

    @cached_property
    def _numbers(self) -> dict[str, int]:
        """Number of the block of each body, 0 at rest."""
        return dict(parts(self._chain.mechanism, self._chain.direction))

    @cached_property
    def joints(self) -> Sequence[JointRow]:
        """The joints between different blocks or with the ground; empty if the mechanism does not name them."""
        joints = self._chain.mechanism.guiding_joints(self._chain.direction)
        rows = [self._row(joint) for joint in joints]
        return [row for row in rows if row.blocks[0] != row.blocks[1]]

    @property
    def has_guides(self) -> bool:
        """Whether any joint is a guide, which has a normal."""
        return any(row.normal is not None for row in self.joints)

    def _row(self, joint: Joint) -> JointRow:
        names = joint.bodies if len(joint.bodies) > 1 else (None, *joint.bodies)
        one, other = (0 if name is None else self._numbers[name] for name in names)
        rises = 1j * joint.roll  # a rounded edge touches the ground below its centre, wherever that is
        carries = names[-1] if other or joint.is_guide else names[0]
        at = self._near(self._place(carries, joint.point + rises) - rises)
        symbol = as_subscript(joint.letter)
        if joint.is_guide:
            turned = self._place(names[0], 1 + 0j) - self._place(names[0], 0j) if one else 1.0
            return JointRow(symbol, "guide", (one, other), at, 1j * joint.slide / abs(joint.slide) * turned)
        return JointRow(symbol, "rolls" if joint.roll else "level" if joint.level else "hinge", (one, other), at)

    def _place(self, body: str | None, at: complex) -> complex:
        """Return where a point of a body, or of the ground, is in the position [m]."""
        return complex(self._follow(Spot(body, at)).z[0])

    @cached_property
    def _follow(self) -> Follow:
        return self._chain.mechanism.followed(np.array([self.position.phi]), self._chain.direction)

    @cached_property
    def _size(self) -> float:
        """Size of the chain [m]."""
        return max(abs(each.spot.at) for each in self._chain.weights)

    def _near(self, at: complex) -> complex:
        return cleared(at, self._size)

    @cached_property
    def _centres(self) -> Centres:
        hinges: dict[Pair, Centre] = {}
        lines: dict[Pair, list[Locus]] = {}
        for row in self.joints:
            one, other = sorted(row.blocks)
            if row.normal is not None:
                lines.setdefault((one, other), []).append(Locus(row.at, row.normal, (row.symbol,)))
                continue
            hinges.setdefault((one, other), Centre(row.symbol, row.at))
            if row.kind == "level":
                lines.setdefault((GROUND, max(row.blocks)), []).append(Locus(0j, 0j))
        return Centres(max(self._numbers.values()), hinges, lines, self._size)

    @cached_property
    def _lead(self) -> int | None:
        """Number of the block that turns by phi throughout, None if no block does."""
        chain = self._chain
        phi = np.array(LEADING_ROTATIONS) * chain.mechanism.limit(chain.direction)
        motions = chain.mechanism.motion(phi, chain.direction)
        turned = {
            number for number, motion in zip(self._numbers.values(), motions, strict=True)
            if number and np.abs(motion.psi + chain.direction * phi).max() < SAME_MOTION
        }  # fmt: skip
        return min(turned, default=None)

    @cached_property
    def rotations(self) -> Sequence[Rotation]:
        """Rotations of the blocks, each after the one that it follows from; not of blocks that no centre tells."""
        if self._lead is None or self._centres.between(GROUND, self._lead) is None:
            return []
        known = {self._lead: Rotation(self._lead, None, 1.0)}
        while steps := [step for i in known for j in self._blocks if (step := self._driven(known[i], j, known))]:
            step = min(
                steps, key=lambda step: (bool(self._between(step).by), step.block)
            )  # joints before other centres
            known[step.block] = step
        return list(known.values())

    @property
    def _blocks(self) -> Sequence[int]:
        return range(1, 1 + max(self._numbers.values()))

    def _between(self, step: Rotation) -> Centre:
        """Return the centre of a block and of the one from which its rotation follows."""
        assert step.driver is not None
        return self._centres.known[min(step.driver, step.block), max(step.driver, step.block)]

    def _driven(self, driver: Rotation, j: int, known: Mapping[int, Rotation]) -> Rotation | None:
        """Return the rotation of a block that follows from that of another; None if it does not, or is known."""
        if j in known or driver.turns == 0:
            return None
        between = self._centres.between(driver.block, j)
        first, other = (self._centres.between(GROUND, k) for k in (driver.block, j))
        if between is None or first is None or other is None:
            return None
        if other.is_at_infinity:
            return None if between.is_at_infinity else Rotation(j, driver.block, 0.0)
        if between.is_at_infinity:
            return Rotation(j, driver.block, driver.turns)
        if abs(between.at - other.at) <= MIN_TURN * abs(between.at - first.at):
            return None
        _, part = _larger(between.at - other.at)
        return Rotation(j, driver.block, driver.turns * part(between.at - first.at) / part(between.at - other.at))

    @cached_property
    def is_known(self) -> bool:
        """Whether the centres and rotations of all blocks follow from the joints, and are those of the motion."""
        turns = {each.block: each.turns for each in self.rotations}
        return turns.keys() == {*self._blocks} and all(
            isclose(turns[k], moved.turns, rel_tol=SAME_MOTION, abs_tol=SAME_MOTION)
            and self._is_at(self.centre(k), moved.centre)
            for k, moved in enumerate(self.position.blocks, 1)
        )

    def _is_at(self, one: complex | None, other: complex | None) -> bool:
        """Return whether two centres are the same, or both at infinity."""
        if one is None or other is None:
            return one is other
        return abs(one - other) <= SAME_MOTION * max(abs(other), self._size)

    def centre(self, block: int) -> complex | None:
        """Return the centre about which a block rotates [m]; None if it translates. The block must be known."""
        centre = self._centres.known[GROUND, block]
        return None if centre.is_at_infinity else centre.at

    @property
    def lines(self) -> Sequence[Evaluated]:
        """The lines from the joints to the centres and rotations; empty if these are not known."""
        if not self.is_known:
            return []
        driven = [step for step in self.rotations if step.driver is not None]
        pairs = [(GROUND, block) for block in self._blocks]
        pairs += [(step.driver or 0, step.block) for step in driven]
        centres = [line for centre in self._centres.traced(pairs) if centre.by for line in _located(centre, self._near)]
        return [*centres, *(line for step in self.rotations for line in self._turned(step))]

    def _turned(self, step: Rotation) -> Iterator[Evaluated]:
        """Yield the line for the rotation of a block, or for its translation."""
        if step.driver is None:
            yield F.LEADS.line(1.0, {"k": step.block})
            return
        driver = next(each for each in self.rotations if each.block == step.driver)
        between, first = self._between(step), self._centres.known[GROUND, step.driver]
        names = {"k": step.block, "i": step.driver, "C": between.symbol, "Oi": first.symbol}
        other = self._centres.known[GROUND, step.block]
        if other.is_at_infinity:
            yield F.TRANSLATES.line(0.0, names)
            arm = self._near(between.at - first.at)
            at = {"t": driver.turns, "C": between.at.imag, "O": first.at.imag}
            yield F.X_TRANSLATES.line(driver.turns * arm.imag, names, **at)
            at = {"t": driver.turns, "C": between.at.real, "O": first.at.real}
            s = self._chain.direction
            yield (F.Y_TRANSLATES if s > 0 else F.Y_TRANSLATES_BACK).line(-s * driver.turns * arm.real, names, **at)
        elif between.is_at_infinity:
            yield F.TURNS_ALIKE.line(step.turns, names, t=driver.turns)
        else:
            axis, part = _larger(between.at - other.at)
            numbers = {key: part(each.at) for key, each in (("C", between), ("Oi", first), ("Ok", other))}
            far = max(map(abs, numbers.values()))
            arms = [abs(numbers["C"] - numbers[key]) or far for key in ("Oi", "Ok")]
            yield sharpened(F.TURNS, far / min(arms)).line(
                step.turns, {**names, "axis": axis, "Ok": other.symbol}, t=driver.turns, **numbers
            )


def _larger(arm: complex) -> tuple[str, Callable[[complex], float]]:
    """Return the axis along which an arm is the longer one, and what gives the part of complex numbers along it."""
    return ("x", attrgetter("real")) if abs(arm.real) > abs(arm.imag) else ("y", attrgetter("imag"))


def _located(centre: Centre, near: Callable[[complex], complex]) -> Iterator[Evaluated]:
    """Yield the lines to a centre in which two lines cross."""
    one, other = sorted(centre.by, key=lambda locus: -len(locus.through))
    if one.is_at_infinity or other.is_at_infinity:
        return  # the block does not turn: the line of its rotation says so
    u, v = one.along, other.along
    points = [each.through[k] for each in (one, other) for k in (0, -1)]
    names = dict(zip("abcd", points, strict=True)) | {"O": centre.symbol}
    a, c = one.at, other.at
    ends = {"ax": a.real, "ay": a.imag, "bx": (a + u).real, "by": (a + u).imag, "ux": u.real, "uy": u.imag}
    ends |= {"cx": c.real, "cy": c.imag, "dx": (c + v).real, "dy": (c + v).imag, "vx": v.real, "vy": v.imag}
    kinds = len(one.through), len(other.through)
    if centre.is_at_infinity:
        yield F.PARALLEL[kinds].line(0.0, names, **ends)
        return
    cross, over = (u.conjugate() * v).imag, ((c - a).conjugate() * v).imag
    share = 0.0 if abs(over) <= SHARE_OF_ROUNDING * abs(c - a) * abs(v) else over / cross
    largest = max(abs(ends[key]) for key in ends if key[0] not in "uv"[kinds[0] - 1 :])
    arms = largest * max(abs(u), abs(v), abs(c - a))
    is_level = kinds == (2, 1) and abs(v.imag) <= LEVEL_NORMAL * abs(v)
    formula = F.SHARE_LEVEL if is_level else F.SHARE[kinds]
    yield sharpened(formula, arms / min(abs(cross), abs(over) if share else abs(cross))).line(share, names, **ends)
    at = near(a + share * u)
    for axis, value in (("x", at.real), ("y", at.imag)):
        numbers = {key: ends[f"{key}{axis}"] for key in "abu"}
        formula = sharpened(F.CENTRE[kinds[0]], largest * max(abs(share), 1.0) / (abs(value) or largest))
        yield formula.line(value, {**names, "axis": axis}, t=share, **numbers)
