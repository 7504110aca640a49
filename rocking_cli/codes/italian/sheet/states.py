"""Steps from the capacity curve to the capacity and the demand at each limit state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.displaced import Displaced
from rocking_cli.codes.italian.ground import Ground
from rocking_cli.codes.italian.results import State, Verified
from rocking_cli.codes.italian.rules import RULES, Rule
from rocking_cli.codes.italian.sheet import chain as chains
from rocking_cli.codes.italian.sheet import spectra
from rocking_cli.codes.italian.sheet.chain import Scale
from rocking_cli.codes.italian.ties import pulls
from rocking_cli.core.attached import Spot
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.document import Grid, Item, Part, Sentence, Steps
from rocking_cli.views.sheet.language import Language

LINE = "lin"  # in subscripts: on the straight line


@dataclass(frozen=True)
class Writer:
    """A direction at a site, and the language it is told in."""

    say: Language
    ground: Ground
    found: Verified

    @property
    def curve(self) -> ExactCurve:
        """The exact capacity curve."""
        return self.found.exact

    @property
    def scale(self) -> Scale:
        """What weights are printed in."""
        return Scale.of(self.curve.chain)

    def parts(self, key: str) -> Iterator[Part]:
        """The chain, the curve's ends, and each limit state."""
        say = self.say
        yield chains.part(say, self.curve, key)
        yield Part(f"{key}-curve", say.say("curve"), list(self._ends()))
        for rule in RULES:
            items = list(self._state(rule))
            yield Part(f"{key}-{rule.state}", say.say("state", state=rule.state), items)
            line = list(self._on_line(rule))
            heading = say.say("state_line", state=rule.state)
            yield Part(f"{key}-{rule.state}-line", heading, [Sentence(say.say("line_is")), Steps(line)])

    def _ends(self) -> Iterator[Item]:
        """a0* and d0*."""
        say, curve, g = self.say, self.curve, self.curve.chain.mechanism.gravity
        rows = [self._accelerated("a_[0]^[*]", "α_[0]", curve.chain.alpha0, curve.a0, say.say("a0"), g)]
        yield Steps([*rows, *self._control()])
        end = Displaced(curve, curve.end)
        yield Steps([Working("φ_[0]", say.say("phi_0"), "α(φ) = 0", "", curve.end, "rad", clauses.D)])
        yield chains.at_work(say, end, self.scale)
        yield from chains.held(say, end, self.scale)
        rows = list(chains.multiplier(say, end, self.scale, "α(φ_[0])"))
        yield Steps([*rows, *self._moved(end, "φ_[0]", "d_[0]^[*]", say.say("d0"))])

    def _accelerated(self, symbol: str, name: str, alpha: float, value: float, what: str, g: float) -> Working:
        """a* from a multiplier."""
        chain, FC = self.curve.chain, self.curve.confidence
        put = self.say.put("{alpha} · {g}/({e} · {FC})", alpha=alpha, g=g, e=chain.e_star, FC=FC)
        return Working(symbol, what, f"{name} g/(e^[*] FC)", put, value, "m/s²", clauses.A_STAR)

    def _control(self) -> Iterator[Working]:
        """x_C' of the control point."""
        say, curve, scale = self.say, self.curve, self.scale
        chain, control = curve.chain, curve.control
        dx = chain.sideways(control)
        if control.body is None:
            put = say.put("{a}/{b}", a=scale.weight(chain.first), b=scale.weight(chain.inertial))
            what, formula = say.say("control_barycentre"), "Σ (P+Q) x′/Σ (P+Q)"
            yield Working("x_[C]′", what, formula, put, dx, "m", clauses.D, "ours")
            return
        what = say.say("control_point", body=control.body, x=say.number(control.at.real), y=say.number(control.at.imag))
        own = next(each for each in Displaced(curve, 0.0).blocks if control.body in each.block.bodies)
        if own.centre is None:
            yield Working("x_[C]′", what, "x′", say.put("{x}", x=own.dx), dx, "m", clauses.D)
            return
        put = say.put("{t} · ({y} − {o})", t=own.turns, y=control.at.imag, o=scale.near(own.centre.imag))
        yield Working("x_[C]′", what, "θ′ (y_[C] − y_[O])", put, dx, "m", clauses.D)

    def _moved(self, position: Displaced, name: str, symbol: str, what: str) -> Iterator[Working]:
        """d_C and d at a position."""
        say, curve, scale = self.say, self.curve, self.scale
        chain, control = curve.chain, curve.control
        d_C = chain.displacement_of_control(position.phi, control)
        if control.body is None:
            given = {f"p{k}": scale.weight(each.block.PQ) for k, each in enumerate(position.blocks)}
            given |= {f"x{k}": each.gone for k, each in enumerate(position.blocks)}
            terms = " + ".join(f"{{p{k}}} · {{x{k}}}" for k in range(len(position.blocks)))
            put = say.put(f"({terms})/{{total}}", **given, total=scale.weight(chain.inertial))
            formula = "Σ (P+Q) Δx/Σ (P+Q)"
        else:
            follow = chain.mechanism.followed(np.array([position.phi]), chain.direction)
            x = float(follow(Spot(control.body, control.at)).z[0].real)
            one, other = (x, control.at.real) if chain.direction > 0 else (control.at.real, x)
            put = say.put("{one} − {other}", one=scale.near(one), other=scale.near(other))
            formula = "|x_[C](φ) − x_[C](0)|"
        yield Working(f"d_[C]({name})", say.say("d_C"), formula, put, d_C, "m", clauses.D)
        first, second = scale.weight(chain.first), scale.weight(chain.second)
        put = say.put("{d} · {b}/({x} · {a})", d=d_C, b=second, x=chain.sideways(control), a=first)
        formula = "d_[C] Σ (P+Q) x′^[2]/(x_[C]′ Σ (P+Q) x′)"
        d = curve.displacement_at(position.phi)
        yield Working(symbol, what, formula, put, d, "m", clauses.D)

    def _state(self, rule: Rule) -> Iterator[Item]:
        """A limit state on the exact curve."""
        say, s, at = self.say, rule.state, self.found.states[rule.state]
        yield Steps([self._allowed(rule, at)])
        broken = rule.at_breaks and self.curve.broken is not None and at.d == self.curve.broken
        phi = self.curve.torn if broken and self.curve.torn is not None else self.curve.rotation(at.d)
        position = Displaced(self.curve, phi)
        yield Steps([Working(f"φ_[{s}]", say.say("phi"), f"d(φ) = d_[{s}]", "", phi, "rad", clauses.D)])
        yield chains.at_work(say, position, self.scale)
        yield from chains.held(say, position, self.scale)
        yield from self._ties(rule, at)
        rows = list(self._moved(position, f"φ_[{s}]", f"d(φ_[{s}])", say.say("d_again", state=s)))
        rows += chains.multiplier(say, position, self.scale, f"α(φ_[{s}])")
        here = self.curve.acceleration_at(phi)
        g = self.curve.chain.mechanism.gravity
        symbol = f"a^[*]_[{s}]"
        rows.append(self._accelerated(symbol, f"α(φ_[{s}])", position.alpha, here, say.say("a_there"), g))
        yield Steps([*rows, *self._period_and_demand(rule, at, s, here)])

    def _ties(self, rule: Rule, at: State) -> Iterator[Item]:
        """Yield the force and elongation of ties, and of forces against the motion."""
        say = self.say
        rows = [
            [pull.name, say.number(pull.force / 1e3), say.number(pull.elongation),
             say.number(None if pull.strain is None else 100 * pull.strain, 3)]
            for pull in pulls(self.curve, at.d)
        ]  # fmt: skip
        if rows:
            heads = [say.say("tie"), "N [kN]", "ΔL [m]", "ΔL/L [%]"]
            yield Grid(say.say("ties_at", state=rule.state), heads, rows, (1, 2, 3))

    def _allowed(self, rule: Rule, at: State) -> Working:
        """The displacement that a limit state allows."""
        say, curve, s = self.say, self.curve, rule.state
        ends = {"t": curve.broken if rule.at_breaks else None, "a": curve.seat.d if curve.seat is not None else None}
        known = {name: d for name, d in ends.items() if d is not None}
        formula, put = f"{rule.share:g} d_[0]^[*]", "{share} · {d0}"
        if known:
            formula = f"min({'; '.join([formula, *(f'd_[{name}]' for name in known)])})"
            put = f"min({'; '.join([put, *(f'{{{name}}}' for name in known)])})"
        formula, put = say.formula(formula), say.put(put, share=rule.share, d0=curve.d0, **known)
        return Working(f"d_[{s}]", say.say("d_state", state=s), formula, put, at.d, "m", clauses.LIMITS)

    def _period_and_demand(self, rule: Rule, at: State, name: str, a: float) -> Iterator[Working]:
        """T, S_De there and the ratio; `a` is a* of the curve that `name` is on [m/s2]."""
        say, s, T0 = self.say, rule.state, self.ground.site.own_period
        if T0 is not None:
            put = say.put("min({a}; 4 · π^[2] · {d}/{T}^[2])", a=a, d=at.d, T=T0)
            formula = f"min(a^[*]_[{name}]; 4 π^[2] d_[{s}]/T_[0]^[2])"
            yield Working(f"a_[{name}]", say.say("a_elastic"), formula, put, at.a, "m/s²", clauses.ELASTIC)
        symbol = f"a_[{name}]" if T0 is not None else f"a^[*]_[{name}]"
        put = say.put(f"{rule.factor:g} · π · √({{d}}/{{a}})", d=at.d, a=at.a)
        formula = say.formula(f"{rule.factor:g} π √(d_[{s}]/{symbol})")
        yield Working(f"T_[{name}]", say.say("T", state=s), formula, put, at.T, "s", rule.clause)
        spectrum = self.ground.spectrum(s)
        if spectrum is None or at.demand is None or at.ratio is None:
            return
        yield from spectra.displacement(say, spectrum, spectra.At(f"T_[{name}]", at.T, rule.damping))
        put = say.put("{d}/{demand}", d=at.d, demand=at.demand)
        formula = f"d_[{s}]/S_[De](T_[{name}])"
        still = self.found.passes(s) and not at.passes and LINE not in name
        what = say.say("passes" if at.passes else "passes_still" if still else "fails", state=s)
        yield Working(f"ρ_[{name}]", what, formula, put, at.ratio, "", clauses.NONLINEAR)

    def _on_line(self, rule: Rule) -> Iterator[Working]:
        """The same limit state on the straight line."""
        say, s, at, curve = self.say, rule.state, self.found.straight_states[rule.state], self.curve
        a = curve.a0 * (1 - at.d / curve.d0)
        name = f"{s},{LINE}"
        put = say.put("{a0} · (1 − {d}/{d0})", a0=curve.a0, d=at.d, d0=curve.d0)
        formula = f"a_[0]^[*] (1 − d_[{s}]/d_[0]^[*])"
        yield Working(f"a^[*]_[{name}]", say.say("a_line"), formula, put, a, "m/s²", clauses.LINE)
        yield from self._period_and_demand(rule, at, name, a)
