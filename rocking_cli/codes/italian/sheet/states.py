"""Steps from the capacity curve to the capacity and the demand at each limit state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import ExactCurve, StraightCurve
from rocking_cli.codes.italian.displaced import DisplacedChain
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import RULES, Rule
from rocking_cli.codes.italian.sheet import chain as chains
from rocking_cli.codes.italian.sheet import spectra
from rocking_cli.codes.italian.sheet.chain import Scale
from rocking_cli.codes.italian.ties import pulls
from rocking_cli.core.hung.attached import Spot
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.document import Item, Sentence, SheetPart, Steps
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

LINE = "lin"  # in subscripts: on the straight line


@dataclass(frozen=True)
class Writer:
    """A direction at a site, written in a language."""

    say: Language
    ground: SiteGround
    found: ItalianVerified

    @property
    def curve(self) -> ExactCurve:
        """The exact capacity curve."""
        return self.found.exact

    @property
    def scale(self) -> Scale:
        """Unit of printed weights."""
        return Scale.of(self.curve.chain)

    def parts(self, key: str) -> Iterator[SheetPart]:
        """Yield the parts on the chain, on the ends of the curve, and on each limit state."""
        say = self.say
        yield chains.part(say, self.curve, key)
        yield SheetPart(f"{key}-curve", say("Capacity curve"), list(self._ends()))
        for rule in RULES:
            items = list(self._state(rule))
            yield SheetPart(f"{key}-{rule.state}", say("{state}, on the exact capacity curve", state=rule.state), items)
            line = list(self._on_line(rule))
            heading = say("{state}, on the straight line", state=rule.state)
            steps: list[Item] = [Sentence(say("line_is")), Steps(line)]
            yield SheetPart(f"{key}-{rule.state}-line", heading, steps)

    def _ends(self) -> Iterator[Item]:
        """Yield the steps to a0* and d0*."""
        say, curve = self.say, self.curve
        a0 = say.step(F.A0, curve.a0, **self._accelerated(curve.chain.alpha0))
        yield Steps([a0, self._control()])
        end = DisplacedChain(curve, curve.end)
        yield Steps([say.step(F.PHI_0, curve.end)])
        yield chains.at_work(say, end, self.scale)
        yield from chains.held(say, end, self.scale)
        rows = list(chains.multiplier(say, end, self.scale, "α(φ_[0])"))
        yield Steps([*rows, *self._moved(end, {"at": "φ_[0]", "symbol": "d_[0]^[*]"}, "d0")])

    def _accelerated(self, alpha: float) -> dict[str, float]:
        """Return values for the slots of the formula of a*, for a multiplier."""
        chain, FC = self.curve.chain, self.curve.confidence
        return {"alpha": alpha, "g": chain.mechanism.gravity, "e": chain.e_star, "FC": FC}

    def _control(self) -> Working:
        """Return the step for x_C' of the control point."""
        say, scale, control = self.say, self.scale, self.curve.control
        chain = self.curve.chain
        dx = chain.sideways(control)
        if control.body is None:
            return say.step(F.X_C, dx, first=scale.weight(chain.first), PQ=scale.weight(chain.inertial))
        names = {"body": control.body, "x": say.number(control.at.real), "y": say.number(control.at.imag)}
        own = next(each for each in DisplacedChain(self.curve, 0.0).blocks if control.body in each.block.bodies)
        if own.centre is None:
            return say.step(F.X_C_STRAIGHT, dx, names, x=own.dx)
        return say.step(F.X_C_TURNS, dx, names, turns=own.turns, y=control.at.imag, O=scale.near(own.centre.imag))

    def _moved(self, position: DisplacedChain, names: Mapping[str, str], meaning: str) -> Iterator[Working]:
        """Yield the steps to d_C and d in a position."""
        say, curve, scale = self.say, self.curve, self.scale
        chain, control = curve.chain, curve.control
        d_C, total = chain.displacement_of_control(position.phi, control), scale.weight(chain.inertial)
        if control.body is None:
            weights, ways = [scale.weight(each.block.PQ) for each in position.blocks], [b.gone for b in position.blocks]
            yield say.step(F.D_C, d_C, names, P=weights, x=ways, PQ=total)
        else:
            follow = chain.mechanism.followed(np.array([position.phi]), chain.direction)
            x = float(follow(Spot(control.body, control.at)).z[0].real)
            one, other = (x, control.at.real) if chain.direction > 0 else (control.at.real, x)
            yield say.step(F.D_C_POINT, d_C, names, one=scale.near(one), other=scale.near(other))
        first, second = scale.weight(chain.first), scale.weight(chain.second)
        d = curve.displacement_at(position.phi)
        yield say.step(
            replace(F.D, meaning=meaning), d, names, d=d_C, second=second, x=chain.sideways(control), first=first
        )

    def _state(self, rule: Rule) -> Iterator[Item]:
        """Yield the steps of a limit state on the exact curve."""
        say, s, at = self.say, rule.state, self.found.states[rule.state]
        names = {"state": s, "on": s, "at": f"φ_[{s}]", "symbol": f"d(φ_[{s}])"}
        yield Steps([self._allowed(rule, at)])
        broken = rule.at_breaks and self.curve.broken is not None and at.d == self.curve.broken
        phi = self.curve.torn if broken and self.curve.torn is not None else self.curve.rotation(at.d)
        position = DisplacedChain(self.curve, phi)
        yield Steps([say.step(F.PHI, phi, names)])
        yield chains.at_work(say, position, self.scale)
        yield from chains.held(say, position, self.scale)
        yield from ties(say, self.curve, {s: at})
        rows = list(self._moved(position, names, "d_again"))
        rows += chains.multiplier(say, position, self.scale, f"α(φ_[{s}])")
        here = self.curve.acceleration_at(phi)
        rows.append(say.step(F.A_THERE, here, names, **self._accelerated(position.alpha)))
        yield Steps([*rows, *self._period_and_demand(rule, at, s, here)])

    def _allowed(self, rule: Rule, at: LimitState) -> Working:
        """Return the step for the displacement capacity at a limit state."""
        curve = self.curve
        ends = {"t": curve.broken if rule.at_breaks else None, "a": curve.seat.d if curve.seat is not None else None}
        known = {f"d_[{name}]": d for name, d in ends.items() if d is not None}
        names = {"state": rule.state, "share": f"{rule.share:g}", "ends": "; ".join(known)}
        formula = F.ALLOWED_LEAST if known else F.ALLOWED
        return self.say.step(formula, at.d, names, share=rule.share, d0=curve.d0, d=[*known.values()])

    def _period_and_demand(self, rule: Rule, at: LimitState, name: str, a: float) -> Iterator[Working]:
        """Yield the steps for T, S_De and the ratio; `a` is a* of the curve that `name` denotes [m/s2]."""
        say, s, T0 = self.say, rule.state, self.ground.site.own_period
        names = {"state": s, "on": name, "a": f"a^[*]_[{name}]" if T0 is None else f"a_[{name}]"}
        if T0 is not None:
            yield say.step(F.A_ELASTIC, at.a, names, a=a, d=at.d, T0=T0)
        yield say.step(F.PERIOD[s], at.T, names, d=at.d, a=at.a)
        spectrum = self.ground.spectrum(s)
        if spectrum is None or at.demand is None or at.ratio is None:
            return
        yield from spectra.displacement(say, spectrum, spectra.At(f"T_[{name}]", at.T, rule.damping))
        still = self.found.passes(s) and not at.passes and LINE not in name
        meaning = "passes" if at.passes else "passes_still" if still else "fails"
        yield say.step(replace(F.RHO, meaning=meaning), at.ratio, names, d=at.d, demand=at.demand)

    def _on_line(self, rule: Rule) -> Iterator[Working]:
        """Yield the steps of a limit state on the straight line."""
        s, at, curve = rule.state, self.found.straight_states[rule.state], self.curve
        a, name = StraightCurve(curve.a0, curve.d0).acceleration(at.d), f"{rule.state},{LINE}"
        yield self.say.step(F.A_LINE, a, {"state": s, "on": name}, a0=curve.a0, d=at.d, d0=curve.d0)
        yield from self._period_and_demand(rule, at, name, a)


def ties(say: Language, curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Table]:
    """Return a table of ties, and of forces against the motion, at limit states; empty if there are none."""
    rows = [
        [pull.name, f"d_[{state}]" if not say.is_plain else f"d_{state}", say.number(pull.force / 1e3),
         say.number(pull.elongation), say.number(None if pull.strain is None else 100 * pull.strain, 3)]
        for state, at in states.items() for pull in pulls(curve, at.d)
    ]  # fmt: skip
    heads = [say("tie"), "", "N [kN]", *map(say, ("ΔL [m]", "ΔL/L [%]"))]
    return [Table(say("ties_at", state=list(states)), heads, rows, (2, 3, 4))] if rows else []
