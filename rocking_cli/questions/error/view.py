"""The errors of the equivalent block of a structure as text, as data and as a plot."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import inf, isfinite, isnan, nan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Equivalence, Mechanism
from rocking_cli.core.equivalence import SMALL_ERROR, Grade
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import percent
from rocking_cli.questions.error.study import Errors, Linearisation, errors, preferred, velocity_ratios
from rocking_cli.views.column import Column, of, only_shown, table_of
from rocking_cli.views.verdict import uplift_in_words
from rocking_cli.views.view import ABSENT, View, heading

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NEVER_UPLIFTS = "infinite (it never uplifts)"
UPLIFT_TOLERANCE = 1e-9  # error of the uplift acceleration that counts as zero
PREFERRED_STYLE, OTHER_STYLE = {"linestyle": "-", "linewidth": 2.0}, {"linestyle": "--", "linewidth": 1.3}
MAX_SHOWN_ERROR = 0.5  # largest error that is drawn, of either sign
PREFERRED_KAPPA = {None: None, 0: "either", 1: "kappa1", 2: "kappa2"}


class ErrorRow(NamedTuple):
    """An error: the quantity, its amplitude or acceleration, and the ratio of block to structure with each kappa."""

    what: str
    at: str
    ratio1: float
    ratio2: float


QUANTITIES: dict[str, tuple[tuple[str, ...], str]] = {
    "uplift": ((), "g"), "v_imp": ((), "m/s"), "period": (("amplitude",), "s"), "overturning": (("acceleration",), "s"),
}  # fmt: skip
"""What the ratios are of, by name: what each varies along, and its unit."""


def ratios(structure: str, found: Sequence[Linearisation], gravity: float) -> Columns:
    """Return all ratios as columns, with a row for each direction, kappa, quantity, and amplitude or acceleration."""

    def of_one(each: Linearisation, kappa: int) -> Iterator[dict[str, Any]]:
        block, velocity = each.block, velocity_ratios(each.block, gravity)[kappa - 1]
        uplift, overturning = (getattr(each, f"{name}_ratio{kappa}") for name in ("uplift", "overturning"))
        yield {"quantity": "uplift", "value": block.lambda_, "ratio": uplift}
        yield {"quantity": "v_imp", "value": block.v_imp, "ratio": velocity}
        yield {"quantity": "period", "amplitude": each.amplitude, "value": each.period, "ratio": each.period_ratio}
        yield {
            "quantity": "overturning", "acceleration": each.acceleration, "value": each.overturning,
            "ratio": overturning,
        }  # fmt: skip

    return stacked(
        {"structure": structure, "direction": each.direction.label, "kappa": kappa}
        | {"quantity": row["quantity"], "amplitude": nan, "acceleration": nan, "unit": QUANTITIES[row["quantity"]][1]}
        | row
        for each in found
        for kappa in (1, 2)
        for row in of_one(each, kappa)
    )


def of_quantity(columns: Callable[[], Columns], quantity: str) -> Columns:
    """Return the rows of one quantity, with columns of its own for value and ratio."""
    table = {name: np.asarray(values) for name, values in columns().items()}
    mine = {name: values[table["quantity"] == quantity] for name, values in table.items()}
    unit = QUANTITIES[quantity][1]
    return mine | {f"{quantity} [{unit}]": mine["value"], f"{quantity}_ratio": mine["ratio"]}


def _percent(ratio: float) -> str:
    if isnan(ratio):
        return ABSENT
    if ratio == inf:
        return "no uplift"
    error = 100 * (ratio - 1)
    return f"{error:+.0f} %" if abs(error) >= 99.95 else f"{error:+.3g} %"


ERRORS: tuple[Column[ErrorRow], ...] = (
    only_shown("error of", of("what"), text=True),
    only_shown("at", of("at"), text=True),
    only_shown("kappa1", of("ratio1"), _percent),
    only_shown("kappa2", of("ratio2"), _percent),
)


def view(
    mechanism: Mechanism, equivalence: Equivalence, curves: Sequence[Linearisation], asked: Sequence[Linearisation]
) -> View:
    """Show the errors at the given values, and a verdict that also uses the curves."""
    advice, numbers, *ranges = sentences(list(curves), list(asked))
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "symmetric": equivalence.symmetric,
        "directions": {each.direction.label: _data(each, mechanism.gravity) for each in asked},
        "prefer": PREFERRED_KAPPA[preferred(list(asked))],
        "grades": {f"kappa{kappa}": errors(list(asked), kappa).grade.key for kappa in (1, 2)},
        "verdict": trust(list(curves), list(asked)),
    }
    title = heading(mechanism)
    titles = [title] if len(asked) == 1 else [f"{title}, {each.direction.label} direction" for each in asked]
    tables = [table_of(where, ERRORS, rows(each, mechanism.gravity)) for where, each in zip(titles, asked, strict=True)]
    return View(data, [advice, *tables, numbers, *ranges])


def rows(each: Linearisation, gravity: float) -> Iterator[ErrorRow]:
    """Yield the errors of a direction."""
    yield ErrorRow("uplift acceleration", "", each.uplift_ratio1, each.uplift_ratio2)
    ratios = velocity_ratios(each.block, gravity)
    yield ErrorRow("overturning velocity", f"v_imp = {each.block.v_imp:.4g} m/s", *ratios)
    for r, ratio in zip(each.amplitude, each.period_ratio, strict=True):
        yield ErrorRow("free period", f"phi/phi_cr = {r:g}", ratio, ratio)
    for a, *both in zip(each.acceleration, each.overturning_ratio1, each.overturning_ratio2, strict=True):
        yield ErrorRow("overturning time", f"a/lambda = {a:g}", *both)


def _data(each: Linearisation, gravity: float) -> dict[str, Any]:
    def of_both(one: float, two: float) -> dict[str, float | None]:
        return {"kappa1": one if one < inf else None, "kappa2": two if two < inf else None}

    periods = zip(each.amplitude, each.period, each.period_ratio, strict=True)
    times = zip(each.acceleration, each.overturning, each.overturning_ratio1, each.overturning_ratio2, strict=True)
    return {
        "uplift_ratio": of_both(each.uplift_ratio1, each.uplift_ratio2),
        "v_imp": each.block.v_imp,
        "v_imp_ratio": of_both(*velocity_ratios(each.block, gravity)),
        "free_period": [{"amplitude": r, "period": T, "ratio": ratio} for r, T, ratio in periods],
        "overturning_time": [{"acceleration": a, "time": t, "ratio": of_both(*both)} for a, t, *both in times],
    }


def trust(curves: Sequence[Linearisation], asked: Sequence[Linearisation]) -> str:
    """Return the sentences on which kappa to use as one text."""
    return " ".join(sentences(curves, asked))


def sentences(curves: Sequence[Linearisation], asked: Sequence[Linearisation]) -> list[str]:
    """Say which kappa to use, or the nonlinear history instead; then which errors to expect, and over which ranges.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, increasing, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations of interest.

    Returns
    -------
    list of str
        The sentences; of two directions the larger error counts.
    """
    prefer = preferred(asked)
    order = (1, 2) if prefer == 1 else (2, 1)
    one, two = (_on(kappa, errors(asked, kappa)) for kappa in order)
    amplitudes = ", ".join(f"{r:g}" for r in asked[0].amplitude.tolist())
    accelerations = ", ".join(f"{a:g}" for a in asked[0].acceleration.tolist())
    worse = ", in the worse of the two directions" if len(asked) > 1 else ""
    where = f"At phi/phi_cr = {amplitudes} and {accelerations} times the uplift acceleration{worse}"
    history = "the nonlinear time history of `rocking respond`"
    advice = {None: f"rely on neither kappa: use {history}", 0: "either kappa is adequate"}
    sentence = f"{where}, {advice.get(prefer, f'prefer kappa{prefer}')}."
    if prefer is not None and min(errors(asked, kappa).grade for kappa in (1, 2)) is Grade.ESTIMATE:
        sentence += f" Base decisions on {history}."
    return [sentence, f"{one[0].upper()}{one[1:]}; {two}.", *_ranges(curves, order[0])]


def _on(kappa: int, found: Errors) -> str:
    """Describe what the block with a kappa is good for, with its errors."""
    uplift = "kept" if abs(found.uplift) < UPLIFT_TOLERANCE else uplift_in_words(found.uplift)
    overturning = f"off by {percent(found.overturning)}" if isfinite(found.overturning) else NEVER_UPLIFTS
    numbers = (
        f"uplift acceleration {uplift}, free period off by {percent(found.period)}, overturning time {overturning}"
    )
    good = {
        Grade.AGREES: f"kappa{kappa} agrees",
        Grade.ESTIMATE: f"kappa{kappa} is good for a first estimate",
        Grade.DISREGARD: f"disregard kappa{kappa}",
    }[found.grade]
    return f"{good} ({numbers})"


def _ranges(curves: Sequence[Linearisation], kappa: int) -> list[str]:
    """Return sentences on the ranges in which errors are no longer small."""
    sentences = []
    far = [each.amplitude[np.abs(each.period_ratio - 1) > SMALL_ERROR] for each in curves]
    if any(values.size for values in far):
        wide = np.concatenate(far)
        where = f"for phi/phi_cr from {wide.min():.2g} to {wide.max():.2g}"
        if any(values.size == each.amplitude.size for values, each in zip(far, curves, strict=True)):
            where = "at every amplitude"
        sentences.append(f"The free period is off by more than {percent(SMALL_ERROR)} {where}.")
    slow = [each.acceleration[np.abs(getattr(each, f"overturning_ratio{kappa}") - 1) > SMALL_ERROR] for each in curves]
    if any(values.size for values in slow):
        where = f"for accelerations below {np.concatenate(slow).max():.3g} times uplift"
        if any(values.size == each.acceleration.size for values, each in zip(slow, curves, strict=True)):
            where = "at every acceleration"
        sentences.append(f"The overturning time with kappa{kappa} is off by more than {percent(SMALL_ERROR)} {where}.")
    return sentences


def draw_linearisation(curves: Sequence[Linearisation], asked: Sequence[Linearisation], title: str) -> Figure:
    """Plot the errors of the equivalent block, a row of panels for each direction.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations to mark.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from rocking_cli.plotting import style

    best = preferred(asked)
    dots = {"marker": "o", "linestyle": "none", "color": style.INK, "markersize": 4}
    bold = best or 2  # if both are equally good, kappa 2, which is exact at uplift
    figure, panels = style.panels(2.9 * len(curves) + 0.3, len(curves), 2, sharey="col")
    for (left, right), curve, marks in zip(panels, curves, asked, strict=True):
        _draw_error(left, curve.amplitude, curve.period_ratio, {"label": "either kappa"} | style.LINES["nonlinear"])
        _draw_error(left, marks.amplitude, marks.period_ratio, dots)
        left.set_xlim(0.0, 1.0)
        for kappa in (1, 2):
            ratio = getattr(curve, f"overturning_ratio{kappa}")
            label = rf"$\kappa_{kappa}$" + (", preferred" if kappa == best else "")
            look = style.LINES[f"linear{kappa}"] | (PREFERRED_STYLE if kappa == bold else OTHER_STYLE)
            _draw_error(right, curve.acceleration, ratio, {"label": label} | look)
            _draw_error(right, marks.acceleration, getattr(marks, f"overturning_ratio{kappa}"), dots)
        right.set_xscale("log")
        right.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
        right.minorticks_off()
        right.set_xlim(1.0, curve.acceleration.max())
        ratios = np.concatenate([curve.overturning_ratio1, curve.overturning_ratio2])
        beyond = (np.abs(ratios - 1) > MAX_SHOWN_ERROR).any()
        cut = f" (not drawn: beyond {100 * MAX_SHOWN_ERROR:g} %)" if beyond else ""
        for axes, x, y in (
            (left, r"amplitude $\phi/\phi_{cr}$ (dots: as in the table)", "error of the free period"),
            (right, rf"constant acceleration $a/\lambda${cut}", "error of the overturning time"),
        ):
            if len(curves) > 1:
                axes.set_title(f"{curve.direction.label} direction", fontsize=style.LABEL, loc="left")
            axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
            style.in_percent(axes.yaxis)
            style.tidy(axes, x, y)
    style.heading_of_all(figure, title)
    for _, right in panels:  # the preferred one may differ
        right.legend(loc="best", **style.LEGEND)
    return figure


def _draw_error(axes: Axes, x: Reals, ratio: Reals, look: Mapping[str, Any]) -> None:
    axes.plot(x, np.where(np.abs(ratio - 1) <= MAX_SHOWN_ERROR, ratio - 1, np.nan), **look)
