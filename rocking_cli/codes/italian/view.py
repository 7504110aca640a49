"""View of a verification by the Italian code, as text and as data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from rocking_cli import names
from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian import words
from rocking_cli.codes.italian.results import (
    Dynamic,
    ItalianVerification,
    ItalianVerified,
    LimitState,
    RecordPeak,
)
from rocking_cli.codes.italian.ties import pulls
from rocking_cli.studies.verification.working import in_plain
from rocking_cli.views.verification import Showing, cited, columns
from rocking_cli.views.view import ABSENT, Table, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure


OF_SITE = [
    in_plain(each.symbol.format(at="T_[0]"))
    for each in (
        F.FC, F.Q, F.OWN_PERIOD, F.RETURN_PERIOD, *F.ON_ROCK, F.S, F.TC, F.PEAK, F.TD, F.T1, F.XI1, F.PSI, F.GAMMA,
        F.S_Z, F.AMPLIFIED, F.S_E_LEVEL, F.S_EZ_BOUND,
    )
]  # fmt: skip


class ItalianShowing(Showing[ItalianVerification, ItalianVerified]):
    """How the results of the Italian code are shown."""

    of_site, compared = OF_SITE, "capacity to demand"
    notation = ": [formula] or §section"

    def of_direction(self, found: ItalianVerification, each: ItalianVerified, where: str) -> Iterable[Table | str]:
        """Return the capacity curve, the methods, the verdict and why the methods differ."""
        yield _capacity(each, where)
        yield from _pulls(each)
        yield _methods(each)
        yield words.verdict(each, found.first, where)
        yield from words.differences(each, found.first)
        yield from words.beyond_first(each, found.first)
        yield from each.remarks
        if each.dynamic is not None:
            rows = [
                [record.name, *(_peak(record, each.dynamic, confident) for confident in (True, False))]
                for record in each.dynamic.records
            ]
            heads = ["record", "with FC", "without"]
            yield Table("Time histories: largest d [m]", heads, rows, numbers=(1, 2))
            yield from words.of_histories(each.dynamic, each.exact.confidence)

    def data(self, found: ItalianVerification, each: ItalianVerified) -> dict[str, Any]:
        """Return a direction as plain data."""
        return _data(each)

    def data_of_all(self, found: ItalianVerification) -> dict[str, Any]:
        """Return an empty mapping, because the values of the ground are already among the workings."""
        return {}

    def table(self, found: ItalianVerification) -> dict[str, Sequence[Any]]:
        """Return a row for each direction and method."""
        return columns(
            ["direction", "method", "a_g [g]", "asked [g]", "zeta_E", "TR [years]", "governs"],
            [
                [
                    direction.label,
                    key,
                    method.a_g,
                    method.demand,
                    method.zeta,
                    method.return_period,
                    key == each.governs,
                ]
                for direction, each in found.directions.items()
                for key, method in each.methods.items()
            ],
        )

    def draw(self, found: ItalianVerification) -> Figure:
        """Draw the capacity curves."""
        from rocking_cli.codes.italian.curves import draw_verification

        return draw_verification(found)


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
                [f"capacity/demand, {name}", number(at.ratio, 4), number(line.ratio, 4), "passes if >= 1", ""],
            ]
    title = f"{where}: capacity, on the exact curve and on the straight line from a0* to d0*"
    return Table(title, ["", "exact\ncurve", "straight\nline", "unit", "clause"], rows, numbers=(1, 2))


def _methods(each: ItalianVerified) -> Table:
    """Table of the capacity by each method."""
    known = any(method.return_period is not None for method in each.methods.values())
    rows = []
    for key, method in each.methods.items():
        if method.a_g is None or each.stands_back(key):
            continue
        line = each.straight_methods[key]
        years = [method.lasts or ABSENT] if known else []
        governs = f"decides {state}" if (state := each.decides(key)) else ""
        rows.append(
            [
                method.title,
                *(number(each, 4) for each in (method.a_g, line.a_g, method.demand, method.zeta)),
                *years,
                method.clause,
                governs,
            ]
        )
    heads = [
        "",
        "a_g [g]\nexact\ncurve",
        "a_g [g]\nstraight\nline",
        "a_g [g]\ndemand",
        "zeta_E",
        *(["TR\n[years]"] if known else []),
    ]
    return Table("Capacity by method", [*heads, "clause", ""], rows, numbers=range(1, len(heads)))


def _peak(record: RecordPeak, found: Dynamic, confident: bool) -> str:
    d, known_to = record.peak(confident=confident), record.known_to(confident=confident)
    if known_to is not None:
        return f"{names.UNKNOWN} after {known_to:.4g} s"
    if d is None:
        return "overturns"
    return f"{d:.4g}{' past d0*' if d >= found.d0 else ''}"


def _data(each: ItalianVerified) -> dict[str, Any]:
    control = each.exact.control
    periods = {  # if the hazard is known
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
        "states": {name: _state(each, name, at) for name, at in each.states.items()},
        **({"ties": ties} if (ties := _ties(each)) else {}),
        "a_g": {key: method.a_g for key, method in each.methods.items() if key != "SLD"},
        "zeta": {key: method.zeta for key, method in each.methods.items()},
        "governs": each.governs,
        "dynamic": _histories(each.dynamic) if each.dynamic is not None else None,
        **({"return_period": periods} if periods else {}),
    }


def _state(each: ItalianVerified, name: str, at: LimitState) -> dict[str, Any]:
    passes = each.passes(name)
    by = {"governs": each.governing[name] if passes is not None else None, "passes": passes}
    return {"d": at.d, "a": at.a, "T": at.T, "demand": at.demand, "ratio": at.ratio, **by}


def _ties(each: ItalianVerified) -> dict[str, dict[str, float | None]]:
    """Return force [N], elongation [m] and strain of each tie, and of each force against the motion, by limit state."""
    found: dict[str, dict[str, float | None]] = {}
    for key in ("force", "elongation", "strain"):
        for name, at in each.states.items():
            for pull in pulls(each.exact, at.d):
                found.setdefault(pull.name, {})[f"{key}_{name}"] = getattr(pull, key)
    return found


def _pulls(each: ItalianVerified) -> list[Table]:
    """Return a table of ties, and of forces against the motion, at each limit state; empty if there are none."""
    rows = [
        [pull.name, f"d_{state}", number(pull.force / 1e3), number(pull.elongation, 4),
         ABSENT if pull.strain is None else number(100 * pull.strain, 3)]
        for state, at in each.states.items() for pull in pulls(each.exact, at.d)
    ]  # fmt: skip
    heads = ["", "at", "force\n[kN]", "elongation\n[m]", "elongation\n[%]"]
    title = "Ties, and forces against the motion with the way of their points"
    return [Table(title, heads, rows, numbers=(2, 3, 4))] if rows else []


def _histories(found: Dynamic) -> dict[str, Any]:
    def of(confident: bool) -> dict[str, Any]:
        return {
            "mean": found.mean(confident=confident),
            "past_d0": found.passed(confident=confident),
            "unknown": found.unknown(confident=confident) if found.checked else None,
            "holds": {state: found.holds(state, confident=confident) for state in found.allowed},
        }

    return {
        "state": next(iter(found.allowed)),
        "motions": found.motions.kind,
        "floor": found.motions.floor,
        "records": [
            {
                "name": each.name,
                "d_with_FC": each.with_confidence,
                "d_without_FC": each.without,
                "known_to_with_FC": each.known_to_with_confidence,
                "known_to_without_FC": each.known_to_without,
            }
            for each in found.records
        ],
        "wanted": found.enough,
        "with_FC": of(True),
        "without_FC": of(False),
    }
