"""Fragility curves as NRML 0.5, the XML that OpenQuake reads.

OpenQuake's fragility model holds lognormal curves, by the mean and the standard deviation of the intensity itself. Each
function, of one taxonomy over one measure, gives every limit state of the file, in order of severity: the share in a
damage state is the difference of two curves.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import UNKNOWN, percent
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import MAX_DISPERSION, MIN_P_VALUE
from rocking_cli.questions.fragility.definition import OVERTURNING, SLIDING, UPLIFT, Limit
from rocking_cli.studies.fragility.quantities import metres
from rocking_cli.text import one_line

MAX_NAME_LENGTH = 60  # characters
# Intensity measure types of OpenQuake, and their units in one unit of here: PGV is in m/s here, there in cm/s.
TYPES: Mapping[str, tuple[str, float]] = {
    "PGA": ("PGA", 1.0),
    "PGV": ("PGV", 100.0),
    "PGD": ("PGD", 100.0),
    "Arias": ("IA", 1.0),
    "CAV": ("CAV", 1 / STANDARD_GRAVITY),
}
SPECTRAL_MEASURE = re.compile(r"SA\(\s*([0-9.]+)\s*s?\s*\)", re.IGNORECASE)  # values in g, here as in OpenQuake
NEGLIGIBLE_DEVIATIONS = 3.719  # standard deviations below the median: a probability of 1e-4
MIN_CROSSING = 0.001  # difference of probability up to which crossing curves are written with the same value
CROSSING_POINTS = 400  # intensities at which curves are checked for crossing


@dataclass(frozen=True, eq=False)
class Function:
    """A fragility function of OpenQuake: one structure over one measure.

    Parameters
    ----------
    name : str
        Taxonomy of the function.
    curves : sequence of Fragility
        The curve of each limit state, in order of severity.
    intensity_type : str
        Name of the measure in OpenQuake.
    factor : float
        Factor that converts the measure to the unit of OpenQuake.
    """

    name: str
    curves: Sequence[Fragility]
    intensity_type: str
    factor: float

    @property
    def parameters(self) -> list[tuple[float, float]]:
        """Mean and standard deviation of the intensity of each curve, in OpenQuake's unit."""
        return [(self.factor * mean, self.factor * deviation) for mean, deviation in map(moments, self.curves)]

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest intensity of the curves, in OpenQuake's unit; OpenQuake continues them flat.

        The lowest is where all curves are below 1e-4, or that of the data if lower; the highest is that of the data.
        """
        medians, spreads = zip(*map(median_and_spread, self.curves), strict=True)
        low = min(m * np.exp(-NEGLIGIBLE_DEVIATIONS * b) for m, b in zip(medians, spreads, strict=True))
        x = np.concatenate([each.seen.x for each in self.curves])
        return float(self.factor * min(low, x.min())), float(self.factor * x.max())

    @property
    def without_damage(self) -> float:
        """Intensity below which no limit state is exceeded, in OpenQuake's unit: a step that cuts every curve, if any.

        Otherwise the lowest intensity.
        """
        steps = [max((step.value for step in each.curve.steps), default=0.0) for each in self.curves]
        return max(self.ends[0], float(self.factor * min(steps)))


@dataclass(frozen=True)
class OpenQuakeModel:
    """The fragility model that is written for OpenQuake.

    Parameters
    ----------
    limits : sequence of str
        Names of the limit states, in order of severity.
    functions : sequence of Function
        The functions, each with a curve for every limit state.
    left_out : sequence of str
        A sentence on each curve that is not written, with the reason.
    doubts : sequence of str
        Warnings about the curves that are written.
    """

    limits: Sequence[str]
    functions: Sequence[Function]
    left_out: Sequence[str]
    doubts: Sequence[str]


def moments(found: Fragility) -> tuple[float, float]:
    """Return mean m exp(beta^2/2) and standard deviation mean sqrt(exp(beta^2) - 1) of a lognormal capacity."""
    median, beta = median_and_spread(found)
    with np.errstate(over="ignore"):
        mean = median * np.exp(beta**2 / 2)
        return float(mean), float(mean * np.sqrt(np.expm1(beta**2)))


def median_and_spread(found: Fragility) -> tuple[float, float]:
    """Return median and dispersion of a lognormal curve."""
    median, dispersion = found.curve.own.median, found.curve.dispersion
    assert median is not None and dispersion is not None
    return median.value, dispersion.value


def intensity_type(measure: str) -> tuple[str, float] | None:
    """Return the name of a measure in OpenQuake, and the factor to its unit; None if OpenQuake lacks the measure."""
    if spectral := SPECTRAL_MEASURE.fullmatch(measure):
        return f"SA({float(spectral[1]):g})", 1.0
    return TYPES.get(measure)


def chosen(curves: Sequence[Fragility]) -> OpenQuakeModel:
    """Choose the curves that one file of OpenQuake can hold together: of several such selections, the largest.

    Parameters
    ----------
    curves : sequence of Fragility
        All curves of a study.

    Raises
    ------
    InputError
        If no curve can be written; the message has the reasons.
    """
    reasons = [why_not(each) for each in curves]
    fit: dict[tuple[str, str], dict[Limit, Fragility]] = {}
    for each, reason in zip(curves, reasons, strict=True):
        if not reason:
            fit.setdefault((each.structure, each.measure), {})[each.limit] = each
    limits = _most_curves([frozenset(each) for each in fit.values()])
    held = {key: by_limit for key, by_limit in fit.items() if limits and limits <= by_limit.keys()}
    left_out = list(dict.fromkeys(filter(None, (
        reason or _why_not_together(each, limits, held, fit) for each, reason in zip(curves, reasons, strict=True)
    ))))  # fmt: skip
    if not held:
        raise InputError("OpenQuake accepts none of the curves: " + "; ".join(left_out or ["the study has no curves"]))
    order = by_severity(limits, next(iter(held.values())))
    functions = _functions(held, order)
    return OpenQuakeModel([limit_id(each) for each in order], functions, left_out, list(doubts(functions)))


def why_not(found: Fragility) -> str:
    """Return the reason why OpenQuake cannot hold a curve; empty if it can."""
    of = _name(found)
    if intensity_type(found.measure) is None:
        return f"all curves over {found.measure}: OpenQuake has no such intensity measure"
    if found.limit == SLIDING:
        return f"{of}: sliding is not a step on the way to overturning, and OpenQuake orders limit states by severity"
    if found.is_band:
        return (
            f"{of}: {percent(found.share or 0.0)} of the runs are of {UNKNOWN} outcome: the result is a band, and "
            "OpenQuake accepts only curves"
        )
    if found.curve.kind == "none":
        return f"{of}: no curve exists: {found.curve.why}"
    if found.curve.kind != "lognormal":
        return f"{of}: its curve is a {found.curve.kind} one, and OpenQuake accepts only lognormal curves"
    if found.curve.dispersion is None:
        return f"{of}: its dispersion is above {MAX_DISPERSION:g}: it does not depend on this measure"
    if not np.isfinite(moments(found)).all():
        return f"{of}: its dispersion is so large that its mean is not a finite number"
    return ""


def _why_not_together(
    found: Fragility,
    limits: Iterable[Limit],
    held: Mapping[tuple[str, str], Mapping[Limit, Fragility]],
    fit: Mapping[tuple[str, str], Mapping[Limit, Fragility]],
) -> str:
    """Return the reason why a curve is left out although it could be written alone; empty if it is not left out."""
    key = found.structure, found.measure
    same = "all functions of a file must have the same limit states"
    if key not in held:
        missing = [str(limit) for limit in limits if limit not in fit[key]]
        return f"{_name(found)}: {same}, and no lognormal curve exists for {', '.join(sorted(missing))}"
    if found.limit not in limits:
        other = next(each for each, by_limit in held.items() if found.limit not in by_limit)
        return f"{_name(found)}: {same}, and {other[0]} over {other[1]} has no lognormal curve for this one"
    return ""


def _most_curves(sets: Sequence[frozenset[Limit]]) -> frozenset[Limit]:
    """Return the limit states that give most curves: their number times the number of functions with all of them."""
    candidates = set(sets)
    while new := {one & other for one in candidates for other in candidates} - candidates:
        candidates |= new

    def score(limits: frozenset[Limit]) -> tuple[int, int, list[str]]:
        return len(limits) * sum(limits <= of_function for of_function in sets), len(limits), sorted(map(str, limits))

    return max(candidates, key=score, default=frozenset())


def by_severity(limits: Iterable[Limit], curves: Mapping[Limit, Fragility]) -> list[Limit]:
    """Sort limit states: uplift, then ratios and displacements merged by their medians, then overturning."""
    between = [limit for limit in limits if limit not in (UPLIFT, OVERTURNING)]
    ratios = sorted((each for each in between if isinstance(each, float)), reverse=True)
    moved = sorted((each for each in between if isinstance(each, str)), key=lambda each: metres(each) or 0.0)[::-1]
    merged: list[Limit] = [each for each in (UPLIFT,) if each in limits]
    while ratios or moved:
        if not moved or (ratios and _median(curves[ratios[-1]]) <= _median(curves[moved[-1]])):
            merged.append(ratios.pop())
        else:
            merged.append(moved.pop())
    return merged + [each for each in (OVERTURNING,) if each in limits]


def _median(found: Fragility) -> float:
    return median_and_spread(found)[0]


def _functions(held: Mapping[tuple[str, str], Mapping[Limit, Fragility]], order: Sequence[Limit]) -> list[Function]:
    """Build functions with unique names; with several measures the name contains the measure."""
    measures = list(dict.fromkeys(measure for _, measure in held))
    functions: list[Function] = []
    taken: set[str] = set()
    for (structure, measure), by_limit in held.items():
        there = intensity_type(measure)
        assert there is not None
        name = identifier(structure if len(measures) == 1 else f"{structure}-{there[0]}", taken)
        taken.add(name)
        functions.append(Function(name, [by_limit[limit] for limit in order], *there))
    return functions


def doubts(functions: Sequence[Function]) -> Iterable[str]:
    """Yield warnings about the curves that are written, and about names that differ from those of the study."""
    for function in functions:
        first = function.curves[0]
        if function.name != first.structure:
            yield f"{first.structure} over {first.measure} is called {function.name} there"
        if first.unknown is None:
            yield f"{first.structure}: its joints are not checked"
        for each in function.curves:
            goodness = each.curve.goodness
            if each.unknown:
                runs = f"{each.unknown} of {each.total} runs ({percent(each.share or 0.0)})"
                yield f"{_name(each)}: {runs} of {UNKNOWN} outcome are counted as exceeding"
            if each.curve.unbounded:
                yield f"{_name(each)}: the data do not bound its median"
            if goodness is not None and goodness.p_value is not None and goodness.p_value < MIN_P_VALUE:
                yield f"{_name(each)}: the data reject a lognormal curve (p = {goodness.p_value:.2g})"
        x = np.geomspace(function.without_damage, function.ends[1], CROSSING_POINTS) / function.factor
        for milder, graver in pairwise(function.curves):
            above = graver.curve.own.probability(x) - milder.curve.own.probability(x)
            k = int(above.argmax())
            if above[k] > MIN_CROSSING:
                yield (
                    f"{first.structure} over {first.measure}: the curves of {milder.limit} and {graver.limit} cross: "
                    f"at {x[k]:.3g} the probability of the graver is larger by {above[k]:.2g}, a share below zero"
                )
    yield from dict.fromkeys(
        each.curve.warning for function in functions for each in function.curves if each.curve.warning
    )  # fmt: skip


def _name(found: Fragility) -> str:
    """Return the name of a curve in sentences: structure, limit state and measure."""
    return f"{found.structure}, {found.limit} over {found.measure}"


def limit_id(limit: Limit) -> str:
    """Return a limit state as an identifier of OpenQuake: letters, digits and _, starting with a letter."""
    if isinstance(limit, float):
        return f"ratio_{_digits(limit)}"
    moved = metres(limit)
    return limit if moved is None else f"top_{_digits(float(limit.split()[0]))}_mm"


def _digits(value: float) -> str:
    return np.format_float_positional(value, trim="-").replace(".", "_")


def identifier(text: str, taken: Iterable[str] = ()) -> str:
    """Return a name as a unique identifier of OpenQuake: letters, digits, - and _, different from those taken."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    name = re.sub(r"[^A-Za-z0-9_-]+", "_", plain).strip("_")[:MAX_NAME_LENGTH] or "structure"
    used, k = set(taken), 1
    while (numbered := name if k == 1 else f"{name[: MAX_NAME_LENGTH - 6]}-{k}") in used:
        k += 1
    return numbered


NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"


def nrml(model: OpenQuakeModel, name: str, description: str) -> bytes:
    """Return an NRML document with the curves of a model.

    Parameters
    ----------
    model : OpenQuakeModel
        The curves.
    name : str
        Name of the study.
    description : str
        Description of the model in a sentence; characters that are not ASCII become question marks.
    """
    root = ElementTree.Element("nrml", {"xmlns": NAMESPACE})
    about = {"id": identifier(name), "assetCategory": "buildings", "lossCategory": "structural"}
    whole = ElementTree.SubElement(root, "fragilityModel", about)
    ElementTree.SubElement(whole, "description").text = one_line(description).encode("ascii", "replace").decode()
    ElementTree.SubElement(whole, "limitStates").text = " ".join(model.limits)
    for each in model.functions:
        kind = {"id": each.name, "format": "continuous", "shape": "logncdf"}
        function = ElementTree.SubElement(whole, "fragilityFunction", kind)
        least, most = map(repr, each.ends)
        ends = {"imt": each.intensity_type, "noDamageLimit": repr(each.without_damage), "minIML": least, "maxIML": most}
        ElementTree.SubElement(function, "imls", ends)
        for limit, (mean, deviation) in zip(model.limits, each.parameters, strict=True):
            parameters = {"ls": limit, "mean": repr(mean), "stddev": repr(deviation)}
            ElementTree.SubElement(function, "params", parameters)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"
