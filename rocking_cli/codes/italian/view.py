"""View of a verification by the Italian code, as text and as data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import pulls, strengths
from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.results import Dynamic, ItalianVerification, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, OF_STATE, STATE_OF_METHOD
from rocking_cli.codes.italian.sheet.steps import PACKAGE, TERMINAL, ties
from rocking_cli.codes.italian.sheet.summary import METHOD_NAMES, comparison, histories, methods, verdicts
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.studies.remark import in_plain
from rocking_cli.verification.results import Verification
from rocking_cli.views.column import Column, frame_of, of
from rocking_cli.views.conclusion import digits_beside, headline
from rocking_cli.views.sheet.document import Sentence
from rocking_cli.views.sheet.language import texts_of
from rocking_cli.views.verification import METHODS, MethodRow, Showing, cited, named, rows_of, shown
from rocking_cli.views.view import Table, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS: Sequence[Column[MethodRow]] = (
    *METHODS[:2],
    Column("a_g", of("method.a_g"), "g"),
    Column("asked", of("method.demand"), "g"),
    Column("zeta_E", of("method.zeta")),
    Column("TR", of("method.return_period"), "years"),
    METHODS[-1],
)
OTHER_ROLES = {DAMAGE: "not required", LINEAR: "comparison"}
"""Roles of the methods that decide at no limit state, by their kind: rocking may start before SLV and SLC."""
IN_SHORT = replace(TERMINAL, own={**TERMINAL.own, **texts_of(PACKAGE, "en_in_short")})
OUTCOMES = {Concluded.SATISFIED: "passes", Concluded.NOT_SATISFIED: "fails", Concluded.UNKNOWN: "unknown",
            Concluded.NOT_DECIDED: "undecided"}  # fmt: skip
STATE_OUTCOMES = OUTCOMES | {Concluded.SATISFIED_IF: "only if"}
OF_SITE = [
    in_plain(each.symbol.format(at="T_[0]"))
    for each in (
        F.FC, F.Q, F.OWN_PERIOD, F.RETURN_PERIOD, *F.ON_ROCK, F.S, F.TC, F.PEAK, F.TD, F.T1, F.XI1, F.PSI, F.GAMMA,
        F.S_Z, F.AMPLIFIED, F.S_E_LEVEL, F.S_EZ_BOUND,
    )
]  # fmt: skip


class ItalianShowing(Showing[ItalianVerification, ItalianVerified]):
    """How the results of the Italian code are shown."""

    of_site, say, say_in_short = OF_SITE, TERMINAL, IN_SHORT
    package, notation = PACKAGE, ": [formula] or §section"

    def of_direction(self, found: ItalianVerification, each: ItalianVerified, where: str) -> Iterable[Table | str]:
        """Return the capacity curve, the methods, the verdicts, why the methods differ, and the time histories."""
        yield _capacity(each, where)
        yield from ties(self.say, each.exact, each.states)
        yield from methods(self.say, where, each)
        yield from verdicts(self.say, where, found, each)
        yield from map(self.say, [*differences(each, found.first), *each.remarks])
        for of_state in each.dynamic.values():
            for item in histories(self.say, of_state, each.exact.confidence):
                yield item.text if isinstance(item, Sentence) else item

    def in_short(self, found: ItalianVerification, each: ItalianVerified, where: str) -> Iterable[Table | str]:
        """Return the methods, the limit states and the ties where they are verified, and the time histories."""
        say = self.say_in_short
        yield _methods_in_short(found, each, where)
        yield from _states_in_short(each, where)
        verified = {state: at for state, at in each.states.items() if state in each.required}
        yield from ties(say, each.exact, verified)
        for extra in found.mechanism.extras(each.direction):
            if extra.key == "hinge":
                yield f"{where}: hinge at {number(extra.value, 4)} of the wall's height."
        texts = list(map(say, differences(each, found.first)))
        for of_state in each.dynamic.values():
            items = histories(say, of_state, each.exact.confidence)
            texts += [item.text for item in items if isinstance(item, Sentence)]
        if each.dynamic:
            yield _histories_in_short(each, where)
        yield from (f"{where}: {text}" for text in dict.fromkeys(texts) if text)

    def compared(self, found: ItalianVerification, strengthened: ItalianVerification) -> Iterable[Table]:
        """Return the capacity of the existing structure and of the strengthened one, side by side."""
        return comparison(self.say, found, strengthened)

    def data(self, found: ItalianVerification, each: ItalianVerified) -> dict[str, Any]:
        """Return a direction as plain data."""
        return _data(found, each)

    def data_of_all(self, found: ItalianVerification) -> dict[str, Any]:
        """Return an empty mapping, because the values of the ground are already among the workings."""
        return {}

    def table(self, found: ItalianVerification) -> Mapping[str, Sequence[Any]]:
        """Return a row for each direction and method."""
        return frame_of(COLUMNS, rows_of(found))

    def draw(self, found: ItalianVerification) -> Figure:
        """Draw the capacity curves of each direction, with capacity and demand at each limit state.

        The conclusion stands above the direction that decides it.
        """
        from rocking_cli.codes.italian.sheet.figures import draw_capacity

        title, structures = named(found.mechanism, self.say), dict[str, Verification]({"": found})
        if found.strengthened is not None:
            title, structures = (
                found.mechanism.name or title,
                {", existing": found, ", strengthened": found.strengthened},
            )
        sides, ends = dict[str, ItalianVerified](), dict[str, str]()
        for state, one in structures.items():
            for where, each in shown(one, self.say).items():
                sides[side := where + self.say(state)] = each
                if each is one.deciding or len(one.distinct) == 1:
                    ends[side] = f" ({self.say.recognised('shown', headline(one.conclusion, over=''))})"
        return draw_capacity(self.say, sides, title, ends)


def _capacity(each: ItalianVerified, where: str) -> Table:
    """Return a table of the capacity curve, exact and straight."""
    clause = {line.symbol: cited(line) for line in each.workings}
    rows = [
        ["alpha0", number(each.chain.alpha0), "", "", clause["alpha0"]],
        ["lambda", number(each.lambda_), "", "", ""],
        ["e*", number(each.chain.e_star), "", "", clause["e*"]],
        ["M*", number(each.M), "", "kg" if each.M is not None else "no masses", clause.get("M*", "")],
        ["a0*", number(each.a0), number(each.a0), "m/s2", clause["a0*"]],
        ["d0*", number(each.d0), number(each.d0), "m", clause["d0*"]],
    ]
    for name, at in each.states.items():
        line = each.straight_states[name]
        rows += [
            [f"d_{name}", number(at.d), number(line.d), "m", clause[f"d_{name}"]],
            [f"a*(d_{name})", number(at.a), number(line.a), "m/s2", clause[f"a*_{name}"]],
            [f"T_{name}", number(at.T), number(line.T), "s", clause[f"T_{name}"]],
        ]
        if at.demand is not None:
            rows += [
                [f"demand at {name}", number(at.demand), number(line.demand), "m", clause[f"S_De(T_{name})"]],
                [f"d_{name}/demand", number(at.ratio, 4), number(line.ratio, 4), "", clause[f"rho_{name}"]],
            ]
    title = f"{where}: capacity, on the exact curve and on the straight line from a0* to d0*"
    return Table(title, ["", "exact\ncurve", "straight\nline", "unit", "clause"], rows, numbers=(1, 2))


def _methods_in_short(found: ItalianVerification, each: ItalianVerified, where: str) -> Table:
    """Return a table of the capacity by each method on the exact curve, narrow enough for a small terminal."""
    rows = []
    for key, method in each.methods.items():
        if method.a_g is None or each.stands_back(key):
            continue
        name, end = METHOD_NAMES[key.split("_")[0]].capitalize(), f"at {STATE_OF_METHOD[key]}"
        state = each.decides(key)
        if state in each.required:
            end = f"{state} {STATE_OUTCOMES[found.concluded(each, state)]}"
        elif state:
            name, end = f"{name.split()[0]} at {state}", OTHER_ROLES[DAMAGE]
        else:
            end = OTHER_ROLES.get(key.split("_")[0], end)
        rows.append([name, end, number(method.a_g, 4), number(method.demand, 4), _ratio(method.zeta)])
    return Table(f"{where}: a_g [g] by each method", ["", "", "capacity", "demand", "zeta_E"], rows, numbers=(2, 3, 4))


def _states_in_short(each: ItalianVerified, where: str) -> list[Table]:
    """Return a table of the displacements at limit states, without those at which rocking does not start."""
    rows = [
        [state, number(at.d, 4), number(at.demand, 4), _ratio(at.ratio), number(at.T, 4)]
        for state, at in each.states.items()
        if at.demand is not None and each.governing[state] == OF_STATE[state][1]
    ]
    heads = ["", "capacity", "demand", "ratio of d", "T [s]"]
    return [Table(f"{where}: displacement d [m] at limit states", heads, rows, range(1, 5))] if rows else []


def _histories_in_short(each: ItalianVerified, where: str) -> Table:
    """Return a table of the time histories with FC at each limit state that has records."""
    rows = []
    for state, at in each.dynamic.items():
        numbers = (at.allowed, at.mean(confident=True), at.largest(confident=True))
        outcome = "too few" if at.requirement is None else OUTCOMES[at.requirement.concluded]
        rows.append([state, str(len(at.records)), *(number(value, 4) for value in numbers), outcome])
    heads = ["", "records", "capacity", "mean", "largest\nknown", ""]
    return Table(f"{where}: peak d [m] in time histories with FC", heads, rows, range(1, 5))


def _ratio(ratio: float | None) -> str:
    return number(ratio, 4 if ratio is None else max(4, digits_beside(ratio)))


def _data(found: ItalianVerification, each: ItalianVerified) -> dict[str, Any]:
    control = each.exact.control
    periods = {  # return periods exist only with a hazard
        key: {"years": method.return_period, "beyond": method.beyond}
        for key, method in each.methods.items()
        if method.return_period is not None
    }
    return {
        "control": {"x": control.at.real, "y": control.at.imag, "body": control.body},
        "alpha0": each.chain.alpha0,
        "lambda": each.lambda_,
        "e_star": each.chain.e_star,
        "M_star": each.M,
        "a0_star": each.a0,
        "d0_star": each.d0,
        "states": {name: _state(found, each, name, at) for name, at in each.states.items()},
        **({"ties": ties} if (ties := _ties(each)) else {}),
        "a_g": {key: method.a_g for key, method in each.methods.items() if key != "SLD"},
        "zeta": {key: method.zeta for key, method in each.methods.items()},
        "zeta_E": each.zeta_E,
        "required": dict(each.required),
        "governs": each.governs,
        "dynamic": {state: _histories(at) for state, at in each.dynamic.items()},
        **({"return_period": periods} if periods else {}),
    }


def _state(found: ItalianVerification, each: ItalianVerified, name: str, at: LimitState) -> dict[str, Any]:
    zeta, concluded = each.zeta_at(name), found.concluded(each, name) if name in each.required else None
    by = {
        "governs": None if zeta is None else each.governing[name], "zeta_E": zeta,
        "passes": None if concluded is Concluded.NOT_DECIDED else each.passes(name), "concluded": concluded,
    }  # fmt: skip
    return {"d": at.d, "a": at.a, "T": at.T, "demand": at.demand, "ratio": at.ratio, **by}


def _ties(each: ItalianVerified) -> dict[str, dict[str, Any]]:
    """Return force [N], elongation [m] and strain of each tie, and of each force against the motion, by limit state.

    A tie of steel has its strength [N] by each limit, and which of them governs.
    """
    by_tie: dict[str, dict[str, Any]] = {}
    for key in ("force", "elongation", "strain"):
        for name, at in each.states.items():
            for pull in pulls(each.exact, at.d):
                by_tie.setdefault(pull.name, {})[f"{key}_{name}"] = getattr(pull, key)
    for name, strength in strengths(each.chain.mechanism).items():
        by_tie[name] |= {"strength": strength.limits, "strength_governs": strength.governs}
    return by_tie


def _histories(dynamic: Dynamic) -> dict[str, Any]:
    def of(confident: bool) -> dict[str, Any]:
        return {
            "mean": dynamic.mean(confident=confident),
            "largest_known": dynamic.largest(confident=confident),
            "past_d0": dynamic.passed(confident=confident),
            "unknown": dynamic.unknown(confident=confident) if dynamic.checked else None,
            "holds": dynamic.holds(confident=confident),
        }

    return {
        "capacity": dynamic.allowed,
        "concluded": None if dynamic.requirement is None else dynamic.requirement.concluded,
        "motions": dynamic.motions.kind,
        "floor": dynamic.motions.floor,
        "records": [
            {
                "name": each.name,
                "scale_factor": each.scale_factor,
                "d_with_FC": each.with_confidence,
                "d_without_FC": each.without,
                "known_to_with_FC": each.known_to_with_confidence,
                "known_to_without_FC": each.known_to_without,
            }
            for each in dynamic.records
        ],
        "refused": list(dynamic.refused),
        "wanted": dynamic.enough,
        "with_FC": of(True),
        "without_FC": of(False),
    }
