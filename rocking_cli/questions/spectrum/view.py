"""View of rocking spectra, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from textwrap import shorten
from typing import Any

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import MIN_MOTIONS, NO_UPLIFT, OVERTURNS, ROCKS, UNKNOWN
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.overturning.view import NO_JOINTS, numbers, source_of, spaced
from rocking_cli.questions.spectrum.study import Spectrum
from rocking_cli.short_repr import short_repr
from rocking_cli.views.column import Column, only_shown, rounded, table_of
from rocking_cli.views.verdict import INVALID_REASON, unchecked
from rocking_cli.views.view import ABSENT, ASIDE, Aside, Table, View, processing_data

MAX_TABLE_ROWS = 12  # rows of a table, besides that of the structure as given; --out and --json have the whole curves
SCALING_NOTE = (
    "All lengths are scaled, including the positions of loads and ties; their masses, stiffness and forces are not."
)
MAX_LISTED_FAILURES = 3  # histories that could not be simulated


@short_repr
@dataclass(frozen=True, eq=False)
class ShownSpectra:
    """Spectra, their ground motions, the fractiles to show (0.5 among them), and the polarity as given."""

    spectra: Sequence[Spectrum]
    motions: Sequence[Scaled]
    fractiles: tuple[float, ...]
    polarity: str

    @property
    def one(self) -> bool:
        """Whether there is a single motion, and so no fractile."""
        return len(self.motions) == 1

    @property
    def shaking(self) -> str:
        """The ground motions, for a heading."""
        first = self.motions[0]
        scaled = f" x {first.factor:.4g}" if first.factor != 1 else ""
        what = f"{first.motion.name}{scaled}" if self.one else f"{len(self.motions)} motions"
        return what + {"1": "", "-1": ", reversed", "both": ", either polarity"}[self.polarity]


def view(results: ShownSpectra) -> View:
    """Show the peaks as a function of the size of each shape, and a verdict on each."""
    verdicts = [_verdict(results, each) for each in results.spectra]
    sentences: list[Table | str] = [part for each in results.spectra for part in _curve(results, each)]
    if any(each.shape.slenderness is None for each in results.spectra):
        sentences.append(Aside(
            "Scale multiplies all lengths of the structure. Larger structures have a smaller frequency parameter p."
        ))  # fmt: skip
    if any(each.shape.hung for each in results.spectra):
        sentences.append(SCALING_NOTE)
    if any(each.unknown.any() for each in results.spectra):
        more = "; its peak is at least the number after >=." if results.one else ". Fractiles count it as overturning."
        sentences.append(f"The outcome is {UNKNOWN} if {INVALID_REASON}{more}")
    sentences += _joints(results)
    return View(lambda: _all(results), [*verdicts, *sentences])


def _all(results: ShownSpectra) -> dict[str, Any]:
    return {
        "model": results.spectra[0].shape.structure.model.name,
        "polarity": results.polarity,
        "fractiles": list(results.fractiles),
        "motions": [
            {"name": motion.name, "format": motion.format, "npts": motion.npts, "dt": motion.dt}
            | {"pga_g": motion.of_ground.pga_g, "scale": factor, **processing_data(motion)}
            for motion, factor, *_ in results.motions
        ],
        "spectra": [_data(results, each) for each in results.spectra],
    }


def _joints(results: ShownSpectra) -> list[str]:
    """Return sentences on joints of the structures that are not checked; empty if all are."""
    shapes, several = [each.shape for each in results.spectra], len(results.spectra) > 1
    # Those of an equivalent block of several bodies are not checked.
    sentences = [NO_JOINTS] * any(shape.structure.model.is_linear and shape.bodies > 1 for shape in shapes)
    sentences += [unchecked(shape.structure.name if several else "") for shape in shapes if not shape.structure.checked]
    return sentences + [f"Caution: {shape.structure.name}: {shape.caution}" for shape in shapes if shape.caution]


def title(results: ShownSpectra) -> str:
    """Return the motions and the model of the spectra, as a heading."""
    return f"{results.shaking}, {results.spectra[0].shape.structure.model.name}"


def lost(results: ShownSpectra) -> str:
    """List the responses that could not be simulated; empty if all could."""
    failures = [
        f"{each.shape.structure.name} at 2 pi/p = {each.periods[k]:.4g} s under {results.motions[m].motion.name}"
        for each in results.spectra
        for m, k in np.argwhere(np.isnan(each.peak_ratio)).tolist()
    ]
    if not failures:
        return ""
    more = f" and {len(failures) - MAX_LISTED_FAILURES} more" if len(failures) > MAX_LISTED_FAILURES else ""
    every = sum(each.peak_ratio.size for each in results.spectra)
    return (
        f"{len(failures)} of {every} responses could not be simulated and are left out: "
        f"{'; '.join(failures[:MAX_LISTED_FAILURES])}{more}"
    )


def table(results: ShownSpectra) -> Columns:
    """Return the columns of the peaks, with a row for each shape, motion and size."""
    return stacked(
        _sizes(results, each)
        | {
            "motion": under.motion.name, "peak_ratio": peaks, "peak_rate [rad/s]": rates,
            "overturned": np.where(unknown | np.isnan(peaks), np.nan, np.isinf(peaks)),
            "unknown": unknown if each.checked else np.nan, "peak_lower_bound": least,
        }
        for each in results.spectra
        for under, peaks, rates, unknown, least in zip(
            results.motions, each.peak_ratio, each.peak_rate, each.unknown,
            np.broadcast_to(each.lower_bound, each.peak_ratio.shape), strict=True,
        )
    )  # fmt: skip


def fractile_table(results: ShownSpectra) -> Columns:
    """Return the columns of the fractiles over the motions, with a row for each shape, fractile and size."""
    return stacked(
        _sizes(results, each)
        | {
            "fractile": q, "peak_ratio": each.fractile(q), "peak_rate [rad/s]": each.fractile(q, each.peak_rate),
            "motions": each.followed, "overturned": each.share,
            "unknown": each.share_at_most - each.share if each.checked else np.nan,
        }
        for each in results.spectra
        for q in results.fractiles
    )  # fmt: skip


def _sizes(results: ShownSpectra, each: Spectrum) -> dict[str, object]:
    """Return the columns of the sizes of a shape."""
    blocks = each.shape.slenderness is not None
    differ = any(other.shape.own is not None for other in results.spectra)
    return {
        "structure": each.shape.structure.name,
        "size [s]": [float(f"{period:.12g}") for period in each.periods.tolist()],  # equal for all shapes
        "scale": np.nan if blocks else each.scales,
        "R [m]": each.scales if blocks else np.nan,
        **({"lambda": each.uplifts} if differ else {}),
    }


def _data(results: ShownSpectra, each: Spectrum) -> dict[str, Any]:
    structure, blocks = each.shape.structure, each.shape.slenderness is not None
    return {
        "name": structure.name,
        "slenderness": each.shape.slenderness,
        "direction": structure.direction.label,
        "p": None if blocks else structure.p,
        "lambda": structure.lambda_,
        "eta": structure.eta,
        "alike": each.shape.own is None,
        "caution": each.shape.caution or None,
        "hung": each.shape.hung,
        "lambdas": each.uplifts.tolist() if each.shape.own is not None else None,
        "size": each.periods.tolist(),
        "scale": None if blocks else each.scales.tolist(),
        "R": each.scales.tolist() if blocks else None,
        "given": each.given,
        "motions": each.followed.tolist(),
        "overturned": each.overturned.tolist(),
        "unknown": each.doubtful.tolist() if each.checked else None,
        "peaks": [_finite(each.fractile(q)) for q in results.fractiles],
        "rates": [_finite(each.fractile(q, each.peak_rate)) for q in results.fractiles],
        "every_peak_ratio": [_finite(peaks) for peaks in each.peak_ratio],
        "every_peak_rate": [_finite(rates) for rates in each.peak_rate],
        "every_overturned": [
            [None if hidden else peak == np.inf for peak, hidden in zip(*row, strict=True)]
            for row in zip(each.peak_ratio.tolist(), each.unknown.tolist(), strict=True)
        ],
        "every_unknown": each.unknown.tolist() if each.checked else None,
        "every_peak_lower_bound": [
            numbers(bounds) for bounds in np.broadcast_to(each.lower_bound, each.peak_ratio.shape)
        ],
        "verdict": _verdict(results, each),
    }


def _finite(values: Reals) -> list[float | None]:
    return numbers(np.where(np.isfinite(values), values, np.nan))


def _peak(value: float, least: float = np.nan) -> str:
    """Format a peak; `least` is its lower bound if the outcome is unknown."""
    if least == least:
        return f"{UNKNOWN}, >= {least:.3g}"
    if value != value:
        return ABSENT
    return OVERTURNS if np.isinf(value) else f"{value:.3g}"


def _rate(value: float) -> str:
    return f"{value:.3g}" if np.isfinite(value) else ABSENT


def _curve(results: ShownSpectra, each: Spectrum) -> Iterator[Table | str]:
    """Yield the table of a shape, below its heading."""
    structure = each.shape.structure
    shown = sorted({*spaced(each.scales.size, MAX_TABLE_ROWS), *([] if each.given is None else [each.given])})
    side = "" if structure.symmetric else f" ({structure.direction.label})"
    yield (
        f"{structure.name}{side}, {structure.model.name}: uplift at {structure.lambda_:.4g} g, eta = "
        f"{structure.eta:.4g}{source_of(structure)}, under {results.shaking}"
    )
    if each.shape.own is not None:
        ends = (f"at {each.uplifts[k]:.4g} g at scale {each.scales[k]:.3g}" for k in (0, -1))
        yield (
            "Masses, loads or a strength that do not scale with the structure change its response, so every size was "
            f"built and simulated separately. Uplift is {' and '.join(ends)}."
        )
    if not results.one:
        few = "" if (each.followed >= MIN_MOTIONS).all() else (
            f" Except for the median they are '{ABSENT}' under fewer than {MIN_MOTIONS} motions, of which one decides "
            "them."
        )  # fmt: skip
        yield Aside(
            f"Median and fractiles of the peak phi/phi_cr; an overturning motion ranks above every finite peak.{few}"
        )
    yield table_of("", _columns(results, each), shown)


def _columns(results: ShownSpectra, each: Spectrum) -> Iterator[Column[int]]:
    """Yield the columns of the table of a shape, whose rows are its sizes."""
    yield only_shown("2 pi/p\n[s]", each.periods.item, rounded(3))
    scales = ["as given" if k == each.given else f"{scale:.3g}" for k, scale in enumerate(each.scales)]
    yield only_shown("scale" if each.shape.slenderness is None else "R\n[m]", scales.__getitem__)
    if results.one:
        least = np.broadcast_to(each.lower_bound, each.peak_ratio.shape)[0]
        yield only_shown("peak\nphi/phi_cr", lambda k: _peak(each.peak_ratio[0, k], least[k]))
        yield only_shown("peak\nphi_dot/p\n[rad]", lambda k: _rate(each.rate_over_p[0, k]), rank=1)
        return
    for q in results.fractiles:
        falls, peaks = each.fractile_overturns(q), [_peak(value) for value in each.fractile(q)]
        # Unknown outcomes count as overturning in a fractile; if only they make it overturn, the fractile is unknown.
        cells = [UNKNOWN if peak == OVERTURNS and not known else peak for peak, known in zip(peaks, falls, strict=True)]
        hidden = ASIDE * (set(cells) == {ABSENT})
        yield only_shown("median" if q == 0.5 else f"{100 * q:g} %", cells.__getitem__, rank=hidden or int(q != 0.5))
    rates = each.fractile(0.5, each.rate_over_p)
    yield only_shown("median\nphi_dot/p\n[rad]", lambda k: _rate(rates[k]), rank=2)
    yield only_shown("overturned", lambda k: f"{each.overturned[k]} of {each.followed[k]}")
    if each.unknown.any():
        yield only_shown(UNKNOWN, each.doubtful.item)


def _verdict(results: ShownSpectra, each: Spectrum) -> str:
    """Return sentences on the structure among larger and smaller ones, or on which blocks overturn."""
    place = each.given
    if place is None:
        return f"{each.shape.structure.name}: {_blocks(results, each)}"
    sides = [
        sentence
        for what, part in (("smaller", slice(None, place)), ("larger", slice(place + 1, None)))
        if (sentence := _side(results, each, what, part))
    ]
    return " ".join(
        [
            f"{each.shape.structure.name} as given, 2 pi/p = {each.periods[place]:.3g} s: {_itself(results, each)}.",
            *sides,
        ]
    )


def _itself(results: ShownSpectra, each: Spectrum) -> str:
    assert each.given is not None
    peaks, unknown = each.peak_ratio[:, each.given], each.unknown[:, each.given]
    if results.one and unknown[0]:
        return f"its outcome is {UNKNOWN}"
    if results.one:
        if np.isnan(peaks[0]):
            return "its motion could not be simulated"
        if np.isinf(peaks[0]):
            return f"it {OVERTURNS}"
        return f"it {ROCKS} to {peaks[0]:.3g} of phi_cr" if peaks[0] else f"it {NO_UPLIFT}"
    falls, count = np.flatnonzero(np.isinf(peaks) & ~unknown), np.count_nonzero(~np.isnan(peaks))
    if not count:
        return "no motion could be simulated"
    names = shorten(", ".join(results.motions[k].motion.name for k in falls.tolist()), 90, placeholder=" ...")
    median = float(each.fractile(0.5)[each.given])
    sentence = (
        f"{falls.size} of {count} motions overturn it ({names})" if falls.size else f"none of {count} overturns it"
    )
    if unknown.any():
        some = f"{falls.size} of {count} motions are known to overturn it ({names})" if falls.size else (
            f"none of {count} motions is known to overturn it"
        )  # fmt: skip
        sentence = f"{some}, the outcome of {np.count_nonzero(unknown)} is {UNKNOWN}"
    return sentence if np.isinf(median) else f"{sentence}, and its median peak is {median:.3g} of phi_cr"


def _side(results: ShownSpectra, each: Spectrum, what: str, part: slice) -> str:
    """Return a sentence on the sizes larger or smaller than the structure; empty if there are none."""
    falls, of, scales = each.overturned[part], each.followed[part], each.scales[part]
    if not falls.size:
        return ""
    doubtful = each.doubtful[part]
    end = f"down to scale {scales[0]:.3g}" if what == "smaller" else f"up to scale {scales[-1]:.3g}"
    called = [f"scale {scale:.3g}" for scale in scales]
    if doubtful.any():
        return f"Of the {what} sizes {end}, {_doubt(results, falls, doubtful, of, called)}."
    if not falls.any():
        return f"No {what} size {end} overturns."
    if not results.one:
        return f"Of the {what} sizes {end}, {_most(falls, of, called)}."
    if (falls == of).all():
        return f"Every {what} size {end} overturns."
    least, largest = scales[falls > 0][[0, -1]]
    where = f"at scale {least:.3g}" if least == largest else f"between scale {least:.3g} and {largest:.3g}"
    return f"Of the {what} sizes {end}, {falls.sum()} of {of.sum()} overturn, {where}."


def _blocks(results: ShownSpectra, each: Spectrum) -> str:
    """Return a sentence on the sizes of blocks that overturn."""
    falls, of = each.overturned, each.followed
    names = [f"{period:.3g} s (R = {R:.3g} m)" for period, R in zip(each.periods, each.scales, strict=True)]
    if each.doubtful.any():
        return f"{_doubt(results, falls, each.doubtful, of, names)}."
    if not falls.any():
        return f"no size up to {names[-1]} overturns."
    if not results.one:
        return f"{_most(falls, of, names)}."
    last = int(np.flatnonzero(falls)[-1])
    return f"{falls.sum()} of {of.sum()} sizes overturn, the largest at {names[last]}."


def _most(falls: Integers, of: Integers, names: Sequence[str]) -> str:
    """Return the largest number of motions that overturn one size, and the size above which none does, in words."""
    worst, last = int(np.argmax(falls / np.maximum(of, 1))), int(np.flatnonzero(falls)[-1])
    sentence = f"at most {falls[worst]} of {of[worst]} motions overturn any one size, at {names[worst]}"
    if last == len(names) - 1:
        return sentence
    return f"{sentence}, and none {'overturns a larger size' if worst == last else f'does above {names[last]}'}"


def _doubt(results: ShownSpectra, falls: Integers, doubtful: Integers, of: Integers, names: Sequence[str]) -> str:
    """Return in words how many sizes, or motions at the worst size, are known to overturn, and how many may."""
    places = np.flatnonzero(doubtful)
    where = f"at {names[places[0]]}" if places.size == 1 else f"between {names[places[0]]} and {names[places[-1]]}"
    if results.one:
        some = f"{falls.sum()} of {of.sum()} are known to overturn" if falls.any() else "none is known to overturn"
        return f"{some}, and the outcome of {doubtful.sum()} is {UNKNOWN}, {where}"
    at_most = falls + doubtful
    worst = int(np.argmax(at_most / np.maximum(of, 1)))
    return (
        f"{_most(falls, of, names) if falls.any() else 'none is known to overturn'}; the outcome of some motions is "
        f"{UNKNOWN} {where}, and counting these as overturning, at most {at_most[worst]} of {of[worst]} motions "
        f"overturn any one size, at {names[worst]}"
    )
