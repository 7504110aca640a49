"""Remarks on a verification by the Italian code: which of them hold, and their numbers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import ceil, isclose

import numpy as np

from rocking_cli.codes.italian.capacity import (
    BREAK,
    MAX_OVERHANG_SHARE,
    SEAT,
    ExactCurve,
    beyond,
    elastic,
    ends,
    furthest,
    pulls,
    strengths,
    thickness_of_plate,
)
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import FloorSpectrum, GroundSpectrum, TableSpectrum
from rocking_cli.codes.italian.ground import SiteGround, bounded, of_ground, return_period
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerification, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import (
    DAMAGE,
    FIRST_STATE,
    FURTHER_STATES,
    LINEAR,
    LONG_PERIOD,
    NONLINEAR,
    OF_STATE,
    RULES,
    STATES,
    THRESHOLDS,
)
from rocking_cli.codes.italian.site import LARGEST_FC, ItalianSite
from rocking_cli.core import Mechanism
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.core.hung.ties import MAX_STRAIN
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import digits_apart
from rocking_cli.studies.conclusion import Effect
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.results import CAPACITY_TOLERANCE

EFFECTS: Mapping[str, Effect] = {
    **dict.fromkeys(("confidence", "letter", "onset_alone", "stronger_without", "tie_limits"), Effect.REPLACES),
    **dict.fromkeys(
        ("seats", "factors", "sources", "strength_alone", "plate_alone", "anchored", "carries", "wide", "one_mode",
         "low_floor", "same_mode", "own_formula", "carried", "line_fails", "structure", "mid_height", "joint",
         "unchecked", "below_target", "ours_fails"),
        Effect.CONDITION,
    ),
    **dict.fromkeys(("long", "unsupported"), Effect.UNDECIDED),
}  # fmt: skip
"""What each remark does to the conclusion at the limit states that it names; other remarks do nothing."""
ROUNDING_RATIO = 1e-9
SAME_RATIO = 0.005  # relative difference of a_g below which two methods agree
MAX_LINE_DEVIATION = 0.01  # share of a* by which the straight line may be off without a remark


def _capacities(states: Iterable[str]) -> list[Remark]:
    """Return the symbols of the displacement capacities of limit states."""
    return [Remark.of(f"d_[{state}]") for state in states]


def of_site(ground: SiteGround, directions: Collection[ItalianVerified], given_FC: float) -> list[Remark]:
    """Return remarks on the site, with FC as its file gives it, and on both directions."""
    asked = ground.site.asked
    onset = [state for state in STATES if any(state not in each.by_displacement for each in directions)]
    remarks: list[Remark] = [*of_ground(ground), *_of_spectrum(ground, onset), *_of_lives(ground)]
    long = [
        (at.T, state) for each in directions for state, at in each.states.items()
        if state in asked and at.demand is not None and at.T > LONG_PERIOD
        and not isinstance(ground.on_ground(state), TableSpectrum)
    ]  # fmt: skip
    if long:
        decided = {state for each in directions for _, state in long if each.is_long(state)}
        remarks.append(Remark("long", {"T": max(long)[0], "most": LONG_PERIOD}, sorted(decided)))
    if missing := [state for state in asked if ground.spectrum(state) is None]:
        remarks.append(Remark.of("missing", states=missing))
    if given_FC != ground.site.FC:
        give = _mending_confidence(next(iter(directions)).chain)
        remarks.append(Remark.of("confidence", FC=given_FC, least=ground.site.FC, give=give))
    if seats := _without_seat(directions):
        by_displacement = {state for each in directions for state in each.by_displacement}
        limited = _capacities(rule.state for rule in RULES)
        remarks.append(Remark("seats", {"limited": limited, "seats": seats}, sorted(by_displacement)))
    mechanism = next(iter(directions)).chain.mechanism
    if mechanism.crushing is None and not mechanism.strength:
        remarks.append(Remark.of("unlimited"))
    return remarks + _of_mechanism(mechanism)


def _mending_confidence(chain: Chain) -> Remark:
    """Return what to give so that FC counts as it is: `crushing` only where pivots can, at a height of the hinge."""
    mechanism, s = chain.mechanism, chain.direction
    if not mechanism.bearing(s):
        return Remark.of("give_known")
    hinges = [each.value for each in mechanism.extras(s) if each.key == "hinge"]
    return Remark.of("give_hinge", hinge=f"{hinges[0]:.4g}") if hinges else Remark.of("give_crushing")


def of_rules(site: ItalianSite, mechanism: Mechanism, before: Mapping[str, float | None]) -> list[Remark]:
    """Return by which rules limit states, zeta_E and FC were chosen, with zeta_E before an intervention if known."""
    first, is_IV, threshold = site.asked[0], site.class_of_use == "IV", THRESHOLDS[site.rule]
    use = site.class_of_use or Remark.of("no_class")
    key = "IV" if is_IV and not site.states else "IV_without_SLD" if is_IV and "SLD" not in site.asked else "states"
    rules = [Remark.of(f"rule_{key}", states=list(site.asked), use=use)]
    if site.rule:
        zeta = before.get(first)
        known = Remark.of("rule_unknown") if zeta is None else Remark.of("rule_before", zeta=zeta, state=first)
        values = {"case": site.case or "", "least": threshold.least or 0.0, "use": use, "before": known}
        rules.append(Remark(f"rule_{site.rule.removesuffix(f'_{site.case}')}", values))
    if threshold.more != 0 and site.rule and "SLD" in site.asked:
        rules.append(Remark.of("rule_SLD"))
    if site.FC_without_strength and mechanism.crushing is None and site.FC < LARGEST_FC:
        rules.append(Remark.of("rule_FC", FC=site.FC, least=LARGEST_FC))
    return rules


def _without_seat(directions: Collection[ItalianVerified]) -> list[Remark]:
    """Return each load without a seat, with the largest displacement of its point that decides."""
    moved: dict[str, float] = {}
    for each in directions:
        mechanism = each.chain.mechanism
        spots = {mass.name: mass.spot for mass in mechanism.hung.masses}
        d = max((each.states[state].d for state in each.by_displacement), default=0.0)
        phi = np.array([each.exact.rotation(d)])
        for load in mechanism.loads or []:
            if not load.is_force and load.seat is None:
                moved[load.name] = max(moved.get(load.name, 0.0), float(each.exact.slid(spots[load.name], phi)[0]))
    return [Remark.of("seat_of", name=name, length=length) for name, length in moved.items()]


def _of_mechanism(mechanism: Mechanism) -> list[Remark]:
    """Return the cautions on the statics of a structure that limit its verification."""
    caution = mechanism.own_caution()
    remarks = [Remark.of("structure", text=caution)] if caution and not mechanism.columns_alone() else []
    return [*remarks, Remark.of("mid_height")] if mechanism.mechanism == "wall" else remarks


def _of_spectrum(ground: SiteGround, onset: Sequence[str]) -> list[Remark]:
    """Return remarks on the spectrum that decides; those on a floor limit what the onset of rocking decides."""
    spectrum = ground.spectrum(ground.site.asked[0])
    remarks: list[Remark] = []
    on_ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(on_ground, GroundSpectrum) and on_ground.soil is None:
        remarks.append(Remark.of("no_soil"))
    if ground.state_of_activation != "SLD" and ground.on_ground("SLV") is not None:
        remarks.append(Remark.of("linear_SLV"))
    if isinstance(spectrum, FloorSpectrum):
        remarks += [Remark.of("floor"), Remark("one_mode", {}, onset), *_of_modes(ground)]
        if spectrum.peak < spectrum.ground.peak:
            floor, under = (peak / STANDARD_GRAVITY for peak in (spectrum.peak, spectrum.ground.peak))
            remarks.append(Remark("low_floor", {"floor": floor, "ground": under}, onset))
    return remarks


def _of_modes(ground: SiteGround) -> list[Remark]:
    """Return a remark on a floor whose T1 and xi1 are the same at several limit states."""
    floor = ground.site.floor
    same = [state for state in FURTHER_STATES if floor is not None and getattr(floor, state) is None]
    if floor is None or not same:
        return []
    values = {"T1": floor.T1, "xi1": floor.xi1}
    if "SLD" in same:
        return [Remark.of("same_mode", **values)]
    states = [state for state in same if ground.spectrum(state) is not None]
    return [Remark.of("same_mode_further", **values, states=states)] if states else []


def _of_lives(ground: SiteGround) -> list[Remark]:
    life = ground.site.life
    if ground.hazard is None or life is None:
        return []
    exact = {state: return_period(life, state) for state in STATES}
    return [
        Remark.of("bound", state=state, TR=TR, bound=bounded(TR)) for state, TR in exact.items() if bounded(TR) != TR
    ]


def of_direction(
    curve: ExactCurve, states: Mapping[str, LimitState], ground: SiteGround, moved: Sequence[str]
) -> list[Remark]:
    """Return remarks on one direction, with the required limit states at which displacement governs."""
    asked = {state: at for state, at in states.items() if state in ground.site.asked}
    remarks = [*_of_line(curve, states), *_of_ties(curve, states, moved), *_of_break(curve, states)]
    remarks += [*_of_seat(curve, states), *_of_stretch(curve, asked, moved), *_of_letter(curve.chain)]
    remarks += _of_joint(curve, states, moved)
    T0 = ground.site.own_period
    if T0 is not None:
        on = [rule.state for rule in RULES if states[rule.state].a < curve.acceleration(states[rule.state].d)]
        if on:
            remarks.append(Remark.of("elastic", states=_capacities(on), T0=T0))
    return remarks


def _of_line(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    d, a = curve.points()
    off = max(abs(curve.a0 * (1 - d / curve.d0) - a)) / curve.a0
    if off <= MAX_LINE_DEVIATION:
        return []
    at = states["SLV"]
    there = curve.a0 * (1 - at.d / curve.d0) / at.a - 1
    side = Remark.of("above" if there > 0 else "below")
    return [Remark.of("line", most=100 * float(off), there=100 * abs(there), side=side)]


def of_reach(
    curve: ExactCurve, states: Mapping[str, LimitState], methods: Mapping[str, ItalianMethod], moved: Iterable[str]
) -> list[Remark]:
    """Return what counts in place of displacements that rely on ties or forces beyond what is known of them.

    It is the onset of rocking; if that fails and the displacement passes, nothing is decided.
    """
    by: dict[str, dict[str, list[str]]] = {"unsupported": {}, "onset_alone": {}}
    for state in moved:
        if names := beyond(pulls(curve, states[state].d)):
            open_ = methods[OF_STATE[state][1]].passed and not methods[OF_STATE[state][0]].passed
            by["unsupported" if open_ else "onset_alone"][state] = names
    return [
        Remark(key, {"states": [*of], "names": [*of.values()][-1]}, [*of])  # the largest displacement is the last
        for key, of in by.items() if of
    ]  # fmt: skip


def _of_ties(curve: ExactCurve, states: Mapping[str, LimitState], moved: Sequence[str]) -> list[Remark]:
    mechanism = curve.chain.mechanism
    remarks: list[Remark] = [*_of_strength(mechanism)]
    if remarks and len(mechanism.bodies()) == 1:
        remarks.append(Remark.of("bends"))
    if elastic(mechanism):
        remarks += [Remark.of("ties", largest=curve.largest, over=curve.largest / curve.a0)]
    known = {tie.name for tie in mechanism.ties or []} - strengths(mechanism).keys()
    for pull in pulls(curve, max((states[state].d for state in moved), default=0.0)):
        if pull.name in known and pull.force > 0:
            remarks.append(Remark.of("carries", name=pull.name, force=pull.force / 1e3))
    return [*remarks, *_of_anchorages(curve, {state: states[state].d for state in moved})]


def _of_anchorages(curve: ExactCurve, moved: Mapping[str, float]) -> Iterator[Remark]:
    """Yield each tie whose anchorages give way before its bars yield, where it counts longer than elastic bars are."""
    mechanism = curve.chain.mechanism
    for tie in [tie for tie in mechanism.ties or [] if tie.is_steel]:
        count, strength = tie.number_of_bars(mechanism.depth), strengths(mechanism)[tie.name]
        stretch = strength.force / (count * tie.k)
        held = {state: next(pull for pull in pulls(curve, d) if pull.name == tie.name) for state, d in moved.items()}
        far = {state: pull.elongation for state, pull in held.items() if pull.force > 0 and pull.elongation > stretch}
        if far and strength.governs != "yield":
            state = max(far, key=far.__getitem__)
            values = {"name": tie.name, "N": strength.force / 1e3, "governs": Remark.of(strength.governs)}
            values |= {"state": state, "e": far[state], "pulled": far[state] - stretch, "stretch": stretch}
            yield Remark("anchored", values, [*far])


def _of_strength(mechanism: Mechanism) -> Iterator[Remark]:
    """Yield remarks on the strength of each tie of steel, and on what its formulas rest on."""
    for name, strength in strengths(mechanism).items():
        force = {key: value / 1e3 for key, value in strength.limits.items()}
        key = "strength" if "bearing" in force else "strength_alone"
        bends = Remark.of("plates_bend", bending=force["bending"]) if "bending" in force else ""
        values = {"name": name, "N": strength.force / 1e3, "governs": Remark.of(strength.governs), **force}
        yield Remark(key, {**values, "bends": bends})
    ties = [tie for tie in mechanism.ties or [] if tie.is_steel]
    for tie in ties:
        if tie.plate is not None and tie.plate.thickness is None:
            least = ceil(1e3 * thickness_of_plate(tie, mechanism.depth)) / 1e3
            yield Remark.of("plate_alone", name=tie.name, N=strengths(mechanism)[tie.name].force / 1e3, least=least)
    bending = {tie.name: tie.plate for tie in ties if tie.plate is not None and tie.plate.thickness is not None}
    factored = {tie.name: (tie, tie.wall, bending.get(tie.name)) for tie in ties}
    sourced = {tie.name: (None if tie.steel else tie, tie.wall) for tie in ties}
    for key, field, of in (("factors", "gamma", factored), ("sources", "source", sourced)):
        if names := [name for name, parts in of.items() if None in (getattr(each, field) for each in parts if each)]:
            yield Remark.of(key, names=names)


def _of_stretch(curve: ExactCurve, states: Mapping[str, LimitState], moved: Sequence[str]) -> list[Remark]:
    """Return remarks on forces with large displacements, and on blocks that move far."""
    remarks: dict[str, Remark] = {}
    for state, at in sorted(states.items(), key=lambda pair: -pair[1].d):  # largest displacements first
        held = pulls(curve, at.d)
        for pull in held:
            e = pull.elongation
            if pull.strain is None and e > 0:
                far = {"most": 100 * MAX_STRAIN, "length": e / MAX_STRAIN}
                remarks.setdefault(pull.name, Remark.of("follows", state=state, name=pull.name, e=e, **far))
        gone, thickness = furthest(curve, at.d)
        if any(pull.force for pull in held) and gone > MAX_OVERHANG_SHARE * thickness / 2:
            limits = [state] if state in moved else []
            remarks.setdefault("", Remark("wide", {"state": state, "moved": gone, "thickness": thickness}, limits))
    return list(remarks.values())


def _of_joint(curve: ExactCurve, states: Mapping[str, LimitState], moved: Sequence[str]) -> list[Remark]:
    """Return the joint of a searched mechanism that opens before a displacement that decides."""
    if (
        not moved
        or (weakest := curve.chain.mechanism.collapse(curve.chain.direction)) is None
        or weakest.valid_to is None
    ):
        return []
    past = [state for state in moved if curve.rotation(states[state].d) > weakest.valid_to]
    d = curve.displacement_at(weakest.valid_to)
    one, _, other = weakest.opens.partition(" and ")
    return (
        [Remark("joint", {"joint": Remark.of("{one} and {other}", one=one, other=other), "d": d}, past)] if past else []
    )


def _of_break(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    remarks = [Remark.of("let_go", names=curve.let_go)] if curve.let_go else []
    for lost in curve.lost:
        key = "torn" if lost.name == INTERLOCK_NAME else "tie_ends"
        remarks.append(Remark.of(key, name=lost.name, d=curve.displacement_at(lost.phi), e=lost.length))
    if states["SLV"].by == BREAK:
        ties = elongations(curve)
        remarks.append(Remark("tie_limits", {"ties": ties}, ["SLV"]) if ties else Remark.of("ends"))
    return remarks


def elongations(curve: ExactCurve) -> list[Remark]:
    """Return the ties that end before a* vanishes, each with its `elongation` and that with which d_SLV goes on."""
    d = min(d for by, d in ends(curve, RULES[0]).items() if by != BREAK)
    lost, known = {each.name for each in curve.lost}, {tie.name: tie for tie in curve.chain.mechanism.ties or []}
    return [
        Remark.of("tie_ends_at", name=pull.name, held=known[pull.name].elongation or MAX_STRAIN,
                  needed=ceil(1e3 * pull.strain) / 1e3)
        for pull in pulls(curve, d)
        if pull.name in lost and pull.strain is not None and pull.strain > (known[pull.name].elongation or MAX_STRAIN)
    ]  # fmt: skip


def _of_seat(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    seat = curve.seat
    limited = [state for state, at in states.items() if at.by == SEAT]
    if seat is None or not limited:
        return []
    return [Remark.of("seat", name=seat.load, length=seat.length, d=seat.d, limited=_capacities(limited))]


def _of_letter(chain: Chain) -> list[Remark]:
    alpha0, lambda_ = chain.alpha0, chain.mechanism.uplift(chain.direction)
    if abs(alpha0 / lambda_ - 1) <= ROUNDING_RATIO:
        return []
    return [Remark("own_formula", {"alpha0": alpha0, "lambda_": lambda_}, None if lambda_ < alpha0 else ())]


def of_letter(verification: ItalianVerification, ours: ItalianVerification) -> Remark:
    """Return what our reading of P + Q would give in place of the letter of the code that counts."""
    side, reading = verification.deciding, ours.deciding
    values = {"a_letter": side.a0, "a_own": reading.a0, "letter": side.chain.alpha0, "own": reading.chain.alpha0}
    return Remark("letter", {**values, "ratio": ours.conclusion.ratio})


def _apart(letter: float, own: float) -> dict[str, float | int]:
    return {"letter": letter, "own": own, "digits": digits_apart(letter, own, 4)}


def of_control(chosen: ItalianMethod, usual: ItalianMethod, d0: float, usual_d0: float) -> Remark:
    """Return a remark on the effect of a chosen control point on d0* [m] and the nonlinear method."""
    change = d0 / usual_d0 - 1
    if abs(change) < ROUNDING_RATIO:
        return Remark.of("control_same", d0=d0)
    side = Remark.of("more" if change > 0 else "less")
    values = {"d0": d0, "change": 100 * abs(change), "side": side, "own": usual_d0}
    if chosen.a_g is None or usual.a_g is None:
        return Remark("control", values)
    return Remark("control_a_g", {**values, "a_g": chosen.a_g, "usual": usual.a_g})


def of_reading(verified: ItalianVerified) -> list[Remark]:
    """Return the limit states at which the straight line, which the code allows too, changes the outcome, with zeta_E.

    So may the letter of the code for weights of the mechanism itself. A condition is only that which passes otherwise.
    """
    remarks = [*_carried(verified)]
    for state in verified.by_displacement:
        passes, required = verified.passes(state), verified.required[state]
        zetas = [zeta for key in OF_STATE[state] if (zeta := verified.straight_methods[key].zeta) is not None]
        if passes is not None and required is not None and zetas:
            on_line = max(zetas) >= required * (1 - CAPACITY_TOLERANCE)
            if on_line != passes:
                values = {"state": state, "zeta": max(zetas)}
                remarks.append(Remark("line_fails" if passes else "line_passes", values, [state]))
    return remarks


def _carried(verified: ItalianVerified) -> Iterator[Remark]:
    """Yield what the letter of the code gives for weights of the mechanism itself that do not move sideways."""
    chain, letter = verified.chain, verified.letter
    if letter is None:
        return
    same = isclose(letter.chain.alpha0, chain.alpha0, rel_tol=ROUNDING_RATIO)
    alpha = Remark("alpha0_same" if same else "alpha0_by_letter", _apart(letter.chain.alpha0, chain.alpha0))
    zetas = {
        state: (one, other) for state in verified.required
        if (one := letter.zeta_at(state)) is not None and (other := verified.zeta_at(state)) is not None
    }  # fmt: skip
    fails = [
        state
        for state in zetas
        if verified.passes(state) and not replace(letter, required=verified.required).passes(state)
    ]
    state = next(iter([*fails, *zetas]), "")
    each = Remark.of("zeta_by_letter", state=state, **_apart(*zetas[state])) if zetas else ""
    values = {"alpha0": alpha, **_apart(letter.a0, verified.a0), "zeta": each}
    yield Remark("carried", values, fails)


def differences(verified: ItalianVerified, first: str) -> Iterator[Remark]:
    """Explain why the linear method and the straight line differ from the method and curve that govern."""
    linear, counts, at = verified.methods[LINEAR].a_g, verified.counts.a_g, verified.states[first]
    if linear is None or counts is None or first != FIRST_STATE:  # the linear method is one at SLV
        return
    ratio, begins = linear / counts, verified.methods[DAMAGE].a_g or 0.0
    key = "linear_same" if abs(ratio - 1) <= SAME_RATIO else "linear_less" if ratio < 1 else "linear_more"
    values = {"linear": linear, "ratio": ratio, "share": 100 * ratio, "times": linear / begins, "T": at.T, "d": at.d}
    yield Remark(key, {**values, "state": first})
    line, exact = verified.straight_methods[NONLINEAR].a_g, verified.methods[NONLINEAR].a_g
    if line is not None and exact is not None and abs(line / exact - 1) > SAME_RATIO:
        side = Remark.of("more" if line > exact else "less")
        yield Remark.of("straight", line=line, change=100 * abs(line / exact - 1), side=side)
