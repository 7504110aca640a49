"""Steps of the chain: weights, virtual displacements, what holds it back; at rest and displaced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.displaced import Displaced, Moved
from rocking_cli.core.attached import PointMass
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.document import Grid, Item, Part, Steps
from rocking_cli.views.sheet.language import Language

CLAUSE = clauses.ALPHA0
ROUNDING = 1e-12  # of the size of a thing: what is smaller is none
NONE = 1e-9  # of what makes up a sum: what is left of it is none


@dataclass(frozen=True)
class Scale:
    """What weights are printed in: kN, or newton for each kilogram of a structure without masses.

    Parameters
    ----------
    size : float
        Of one [N].
    unit : str
    length : float
        Size of the structure [m].
    """

    size: float
    unit: str
    length: float

    @classmethod
    def of(cls, chain: Chain) -> Scale:
        """That of a structure."""
        length = max(abs(each.spot.at) for each in chain.weights)
        return cls(1e3, "kN", length) if chain.mechanism.has_mass else cls(1.0, "N/kg", length)

    def weight(self, value: float) -> float:
        """A weight as it is printed."""
        return value / self.size

    def near(self, value: float) -> float:
        """A length without rounding about zero."""
        return 0.0 if abs(value) < ROUNDING * self.length else value


def part(say: Language, curve: ExactCurve, key: str) -> Part:
    """The chain at rest, to alpha0, e* and M*."""
    chain = curve.chain
    scale, rest = Scale.of(chain), Displaced(curve, 0.0)
    items: list[Item] = [
        _weights(say, chain, scale),
        Steps(list(_of_blocks(say, chain, scale))),
        at_work(say, rest, scale),
        *held(say, rest, scale),
        Steps(list(_sums(say, chain, rest, scale))),
    ]
    return Part(f"{key}-chain", say.say("chain"), items)


def _weights(say: Language, chain: Chain, scale: Scale) -> Grid:
    """Every mass that moves, and what of it counts."""
    mechanism, moving = chain.mechanism, {name for block in chain.blocks for name in block.bodies}
    named = [(body.name, body.mass, 1.0, 1.0) for body in mechanism.weighed() if body.name in moving]
    named += [
        (thing.name, thing.mass, thing.weight, thing.horizontal)
        for thing in mechanism.attached
        if isinstance(thing, PointMass) and thing.spot.body in moving
    ]
    rows = []
    for (name, mass, w, h), each in zip(named, chain.weights, strict=True):
        block = next(k for k, block in enumerate(chain.blocks, 1) if each.spot.body in block.bodies)
        numbers = [each.spot.at.real, each.spot.at.imag, mass, w, h]
        forces = [scale.weight(each.carried), scale.weight(each.inertial)]
        rows.append([name, str(block), *(say.number(value) for value in [*numbers, *forces])])
    heads = [say.say("weight"), say.say("block"), "x [m]", "y [m]", "M [kg]", "w", "h"]
    caption = say.say("weights", g=say.number(mechanism.gravity))
    return Grid(caption, [*heads, f"P [{scale.unit}]", f"P + Q [{scale.unit}]"], rows, range(1, 9))


def _of_blocks(say: Language, chain: Chain, scale: Scale) -> Iterator[Working]:
    """The weight of each block, and where it acts."""
    for k, block in enumerate(chain.blocks, 1):
        own = [each for each in chain.weights if each.spot.body in block.bodies]
        carried, inertial = ([scale.weight(getattr(each, key)) for each in own] for key in ("carried", "inertial"))
        which = " + ".join(block.bodies)
        for symbol, values, total, what in (
            (f"P_[{k}]", carried, scale.weight(block.P), "P"), (f"PQ_[{k}]", inertial, scale.weight(block.PQ), "PQ"),
        ):  # fmt: skip
            put = _added(say, values)
            yield Working(symbol, say.say(f"of_block_{what}", block=which), "Σ", put, total, scale.unit, CLAUSE)
        shares = inertial if block.PQ else carried
        for axis, at in (("x", block.at.real), ("y", block.at.imag)):
            places = [each.spot.at.real if axis == "x" else each.spot.at.imag for each in own]
            put = _mean(say, shares, places)
            symbol, formula = f"{axis}_[G{k}]", f"Σ (P+Q) {axis}/Σ (P+Q)"
            yield Working(symbol, say.say("G", block=which), formula, put, scale.near(at), "m", "", "plain")
        if block.P and block.P != block.PQ:
            places = [each.spot.at.real for each in own]
            value = sum(p * x for p, x in zip(carried, places, strict=True)) / scale.weight(block.P)
            put, formula = _mean(say, carried, places), "Σ P x/Σ P"
            yield Working(f"x_[P{k}]", say.say("GP", block=which), formula, put, scale.near(value), "m", "", "plain")


def _added(say: Language, values: Sequence[float]) -> str:
    return say.put(" + ".join(f"{{v{k}}}" for k in range(len(values))), **{f"v{k}": v for k, v in enumerate(values)})


def _mean(say: Language, shares: Sequence[float], places: Sequence[float]) -> str:
    given = {f"s{k}": s for k, s in enumerate(shares)} | {f"x{k}": x for k, x in enumerate(places)}
    some = range(len(shares))
    put = " + ".join(f"{{s{k}}} · {{x{k}}}" for k in some)
    return say.put(f"({put})/({' + '.join(f'{{s{k}}}' for k in some)})", **given)


def at_work(say: Language, position: Displaced, scale: Scale) -> Grid:
    """How each block goes on there: its centre of rotation, barycentres and virtual displacements."""
    rows = []
    for k, each in enumerate(position.blocks, 1):
        centre = ["–", "–"] if each.centre is None else [say.number(scale.near(z)) for z in _xy(each.centre)]
        at = [say.number(scale.near(z)) for z in _xy(each.at)]
        values = [each.turns, *_virtual(each, scale)]
        shown = [say.number(value) for value in values]
        rows.append([str(k), say.number(scale.near(each.gone)), *at, say.number(_x_of_P(position, each, scale)),
                     shown[0], *centre, *shown[1:]])  # fmt: skip
    caption = say.say("at_work_rest" if position.phi == 0 else "at_work", phi=say.number(position.phi), across="@")
    caption = caption.replace("@", "(x_[O] − x_[P])" if position.chain.direction > 0 else "(x_[P] − x_[O])")
    heads = [say.say("block"), "Δx [m]", "x_[G] [m]", "y_[G] [m]", "x_[P] [m]", "θ′", "x_[O] [m]", "y_[O] [m]",
             "x′ [m]", "y′ [m]"]  # fmt: skip
    return Grid(caption, heads, rows, range(1, 10))


def _virtual(each: Moved, scale: Scale) -> tuple[float, float]:
    return scale.near(each.dx), scale.near(each.dy)


def _x_of_P(position: Displaced, each: Moved, scale: Scale) -> float:
    """Where the barycentre of what a block carries is sideways [m]; that of P + Q where it carries nothing."""
    if each.centre is None or not each.block.P:
        return scale.near(each.at.real)
    return scale.near(each.centre.real - position.chain.direction * each.dy / each.turns)


def _xy(z: complex) -> tuple[float, float]:
    return z.real, z.imag


def held(say: Language, position: Displaced, scale: Scale) -> list[Item]:
    """What forces and ties do there, if there are any."""
    if not position.held:
        return []
    rows = [
        [
            each.name,
            *(say.number(v) for v in (scale.weight(each.force), scale.near(each.rate), scale.weight(each.work))),
        ]
        for each in position.held
    ]
    heads = [say.say("action"), f"F, N [{scale.unit}]", "r′, L′ [m]", f"−F r′, N L′ [{scale.unit} m]"]
    return [Grid(say.say("held"), heads, rows, (1, 2, 3))]


def _sum_over(say: Language, position: Displaced, scale: Scale, kind: str) -> tuple[str, float]:
    """The numbers of a sum over the blocks, and its value: P y', (P+Q) x' or (P+Q) x'^2."""
    numbers: dict[str, float] = {}
    terms = []
    total = most = 0.0
    for k, each in enumerate(position.blocks):
        force = each.block.P if kind == "Py" else each.block.PQ
        way = each.dy if kind == "Py" else each.dx
        numbers |= {f"p{k}": scale.weight(force), f"w{k}": scale.near(way)}
        terms.append(f"{{p{k}}} · {{w{k}}}" + ("^[2]" if kind == "PQxx" else ""))
        total += scale.weight(force) * way ** (2 if kind == "PQxx" else 1)
        most += abs(scale.weight(force) * scale.length)
    return say.put(" + ".join(terms), **numbers), 0.0 if abs(total) < NONE * most else total


def lifting(say: Language, position: Displaced, scale: Scale, at: str = "") -> Iterator[Working]:
    """Steps to V' at a position, its works added up: `at` names it."""
    unit = f"{scale.unit} m"
    put, value = _sum_over(say, position, scale, "Py")
    yield Working(f"ΣPy′{at}", say.say("Py"), "Σ P y′", put, value, unit, CLAUSE)
    if position.held:
        works = [scale.weight(each.work) for each in position.held]
        yield Working(f"L{at}", say.say("L"), "−Σ F r′ + Σ N L′", _added(say, works), sum(works), unit, CLAUSE)
    if position.rest:
        yield Working(f"V_[m]{at}", say.say("V_m"), "", "", scale.weight(position.rest), unit, "", "plain")


def driving(say: Language, position: Displaced, scale: Scale, at: str = "") -> Iterator[Working]:
    """Steps to the sum of (P+Q) x' at a position."""
    unit = f"{scale.unit} m"
    put, value = _sum_over(say, position, scale, "PQx")
    yield Working(f"Σ(P+Q)x′{at}", say.say("PQx"), "Σ (P+Q) x′", put, value, unit, CLAUSE)
    if position.more:
        yield Working(f"B_[m]{at}", say.say("B_m"), "", "", scale.weight(position.more), unit, "", "plain")


def multiplier(say: Language, position: Displaced, scale: Scale, symbol: str, at: str = "") -> Iterator[Working]:
    """Steps to alpha at a position."""
    yield from lifting(say, position, scale, at)
    yield from driving(say, position, scale, at)
    _, lifted = _sum_over(say, position, scale, "Py")
    _, driven = _sum_over(say, position, scale, "PQx")
    numbers, over, under = {"P": lifted, "x": driven}, ["P"], ["x"]
    formula, below = ["Σ P y′"], ["Σ (P+Q) x′"]
    if position.held:
        numbers["L"] = sum(scale.weight(each.work) for each in position.held)
        over.append("L")
        formula.append("L")
    if position.rest:
        numbers["V"] = scale.weight(position.rest)
        over.append("V")
        formula.append("V_[m]")
    if position.more:
        numbers["B"] = scale.weight(position.more)
        under.append("B")
        below.append("B_[m]")
    put = say.put(f"({_slots(over)})/({_slots(under)})", **numbers)
    alpha = position.alpha
    most = sum(abs(each.block.P) for each in position.blocks) * scale.length / abs(position.driven)
    value = 0.0 if abs(alpha) < NONE * most else alpha
    text = f"({' + '.join(formula)})/({' + '.join(below)})"
    yield Working(symbol, say.say("alpha"), text, put, value, "", CLAUSE)


def _slots(names: Sequence[str]) -> str:
    return " + ".join(f"{{{name}}}" for name in names)


def _sums(say: Language, chain: Chain, rest: Displaced, scale: Scale) -> Iterator[Working]:
    unit = scale.unit
    yield from multiplier(say, rest, scale, "α_[0]")
    inertial = [scale.weight(block.PQ) for block in chain.blocks]
    total = scale.weight(chain.inertial)
    yield Working("Σ(P+Q)", say.say("PQ"), "Σ (P+Q)", _added(say, inertial), total, unit, CLAUSE)
    put, second = _sum_over(say, rest, scale, "PQxx")
    yield Working("Σ(P+Q)x′^[2]", say.say("PQxx"), "Σ (P+Q) x′^[2]", put, second, f"{unit} m²", clauses.E_STAR)
    first = scale.weight(chain.first)
    put = say.put("{a}^[2]/({b} · {c})", a=first, b=total, c=second)
    formula = "[Σ (P+Q) x′]^[2]/(Σ (P+Q) · Σ (P+Q) x′^[2])"
    yield Working("e^[*]", say.say("e"), formula, put, chain.e_star, "", clauses.E_STAR)
    if chain.mechanism.has_mass:
        g = chain.mechanism.gravity
        put = say.put("1000 · {e} · {PQ}/{g}", e=chain.e_star, PQ=total, g=g)
        mass = chain.e_star * chain.inertial / g
        yield Working("M^[*]", say.say("M"), "e^[*] Σ (P+Q)/g", put, mass, "kg", say.say("not_in_edition"), "ours")
