"""Fragility curves for other programs: NRML 0.5, the XML that OpenQuake reads, and a table for pelicun.

OpenQuake's fragility model holds lognormal curves, by the mean and the standard deviation of the intensity itself. Each
function, of one taxonomy over one measure, gives every limit state of the file, in order of severity: the share in a
damage state is the difference of two curves.

A row of pelicun's damage models is a component, one structure over one measure. pelicun takes the highest limit state
of a row whose capacity the demand exceeds. The capacities of a row are perfectly correlated, so the share in a damage
state is the difference of two curves there, too; where curves cross, the more severe one is used.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import merge
from itertools import chain, count, pairwise
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.names import UNKNOWN, percent
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import MAX_DISPERSION
from rocking_cli.questions.fragility.definition import OVERTURNING, SLIDING, UPLIFT, Limit
from rocking_cli.questions.fragility.hazard_curve import SPECTRAL_MEASURE, intensity_type
from rocking_cli.studies.fragility.quantities import metres
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns


MAX_NAME_LENGTH = 60  # characters
NEGLIGIBLE_DEVIATIONS = 3.719  # standard deviations below the median: a probability of 1e-4
MIN_CROSSING = 0.001  # difference of probability up to which crossing curves are written with the same value
CROSSING_POINTS = 400  # intensities at which curves are checked for crossing
ONE_SET = "all functions of a file must have the same limit states"
DOCUMENT = """\
<?xml version='1.0' encoding='utf-8'?>
<nrml xmlns="http://openquake.org/xmlns/nrml/0.5">
  <fragilityModel id="{{ name }}" assetCategory="buildings" lossCategory="structural">
    <description>{{ description }}</description>
    <limitStates>{{ model.limits | join(" ") }}</limitStates>
    {% for each in model.functions %}
    <fragilityFunction id="{{ each.name }}" format="continuous" shape="logncdf">
      {% set least, most = each.ends %}
      <imls imt="{{ each.measure }}" noDamageLimit="{{ each.undamaged }}" minIML="{{ least }}" maxIML="{{ most }}" />
      {% for mean, deviation in each.moments %}
      <params ls="{{ model.limits[loop.index0] }}" mean="{{ mean }}" stddev="{{ deviation }}" />
      {% endfor %}
    </fragilityFunction>
    {% endfor %}
  </fragilityModel>
</nrml>
"""
Key = tuple[str, str]
"""Structure and measure of a function."""


@dataclass(frozen=True, eq=False)
class Function:
    """A fragility function of OpenQuake: the curves of one structure over one measure, in order of severity."""

    name: str
    curves: Sequence[Fragility]
    measure: str
    factor: float

    @property
    def moments(self) -> list[list[float]]:
        """Mean and standard deviation of the intensity of each curve, in OpenQuake's unit."""
        return [[self.factor * each for each in moments(curve)] for curve in self.curves]

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest intensity of the curves, in OpenQuake's unit; OpenQuake continues them flat.

        The lowest is where all curves are below 1e-4, or that of the data if lower; the highest is that of the data.
        """
        low = min(m * np.exp(-NEGLIGIBLE_DEVIATIONS * beta) for m, beta in map(median_and_spread, self.curves))
        x = np.concatenate([each.seen.x for each in self.curves])
        return float(self.factor * min(low, x.min())), float(self.factor * x.max())

    @property
    def undamaged(self) -> float:
        """Intensity below which no limit state is exceeded, in OpenQuake's unit: a step that cuts every curve, if any.

        Otherwise the lowest intensity.
        """
        steps = [max((step.value for step in each.curve.steps), default=0.0) for each in self.curves]
        return max(self.ends[0], float(self.factor * min(steps)))


@dataclass(frozen=True)
class OpenQuakeModel:
    """The names of the limit states of a file, its functions, a sentence on each curve left out, and warnings."""

    limits: Sequence[str]
    functions: Sequence[Function]
    left_out: Sequence[str]
    doubts: Sequence[str]


def median_and_spread(found: Fragility) -> tuple[float, float]:
    """Return median and dispersion of a lognormal curve."""
    median, dispersion = found.curve.own.median, found.curve.dispersion
    assert median is not None and dispersion is not None
    return median.value, dispersion.value


def moments(found: Fragility) -> tuple[float, float]:
    """Return mean m exp(beta^2/2) and standard deviation mean sqrt(exp(beta^2) - 1) of a lognormal capacity."""
    median, beta = median_and_spread(found)
    with np.errstate(over="ignore"):
        mean = median * np.exp(beta**2 / 2)
        return float(mean), float(mean * np.sqrt(np.expm1(beta**2)))


def chosen(curves: Sequence[Fragility]) -> OpenQuakeModel:
    """Choose the curves that one file of OpenQuake can hold together: of several such selections, the largest.

    Raises
    ------
    InputError
        If no curve can be written; the message has the reasons.
    """
    reasons = [why_not(each) for each in curves]
    fit = _grouped(each for each, reason in zip(curves, reasons, strict=True) if not reason)
    limits = _most_curves([frozenset(by_limit) for by_limit in fit.values()])
    held = {key: by_limit for key, by_limit in fit.items() if limits <= by_limit.keys()}
    for k, each in enumerate(curves):
        key = each.structure, each.measure
        if reasons[k] or (key in held and each.limit in limits):
            continue
        if key in held:
            structure, measure = next(other for other, by_limit in held.items() if each.limit not in by_limit)
            lacks = f"{structure} over {measure} has no lognormal curve for this one"
        else:
            lacks = f"no lognormal curve exists for {', '.join(sorted(map(str, limits - fit[key].keys())))}"
        reasons[k] = f"{_name(each)}: {ONE_SET}, and {lacks}"
    left_out = [reason for reason in dict.fromkeys(reasons) if reason]
    if not held:
        raise InputError("OpenQuake accepts none of the curves: " + "; ".join(left_out or ["the study has no curves"]))
    order = by_severity(limits, next(iter(held.values())))
    functions = list(_functions(held, order))
    return OpenQuakeModel([limit_id(each) for each in order], functions, left_out, list(doubts(functions)))


def _grouped(curves: Iterable[Fragility]) -> dict[Key, dict[Limit, Fragility]]:
    """Return curves by structure and measure, and then by limit state."""
    groups: dict[Key, dict[Limit, Fragility]] = {}
    for each in curves:
        groups.setdefault((each.structure, each.measure), {})[each.limit] = each
    return groups


def why_not(found: Fragility, program: str = "OpenQuake") -> str:
    """Return the reason why a program cannot hold a curve; empty if it can."""
    curve, of = found.curve, f"{_name(found)}: "
    if intensity_type(found.measure) is None:
        return f"all curves over {found.measure}: {program} has no such intensity measure"
    if found.limit == SLIDING:
        return f"{of}sliding is not a step on the way to overturning, and {program} orders limit states by severity"
    if found.is_band:
        share = f"{percent(found.share or 0.0)} of the runs are of {UNKNOWN} outcome"
        return f"{of}{share}: the result is a band, and {program} accepts only curves"
    if curve.kind == "none":
        return f"{of}no curve exists: {curve.why}"
    if curve.kind != "lognormal":
        return f"{of}its curve is a {curve.kind} one, and {program} accepts only lognormal curves"
    if curve.dispersion is None:
        return f"{of}its dispersion is above {MAX_DISPERSION:g}: it does not depend on this measure"
    if not np.isfinite(moments(found)).all():
        return f"{of}its dispersion is so large that its mean is not a finite number"
    return ""


def _most_curves(sets: Collection[frozenset[Limit]]) -> frozenset[Limit]:
    """Return the limit states that give most curves: their number times the number of functions with all of them."""
    candidates = set(sets)
    while new := {one & other for one in candidates for other in candidates} - candidates:
        candidates |= new

    def score(limits: frozenset[Limit]) -> tuple[int, int, list[str]]:
        return len(limits) * sum(limits <= of_function for of_function in sets), len(limits), sorted(map(str, limits))

    return max(candidates, key=score, default=frozenset())


def by_severity(limits: Collection[Limit], curves: Mapping[Limit, Fragility]) -> list[Limit]:
    """Sort limit states: uplift, then ratios and displacements merged by their medians, then overturning."""
    ratios = sorted(each for each in limits if isinstance(each, float))
    moved = sorted((each for each in limits if metres(each) is not None), key=lambda each: metres(each) or 0.0)
    between = merge(ratios, moved, key=lambda each: median_and_spread(curves[each])[0])
    return [each for each in (UPLIFT, *between, OVERTURNING) if each in limits]


def _functions(held: Mapping[Key, Mapping[Limit, Fragility]], order: Sequence[Limit]) -> Iterator[Function]:
    """Yield functions with unique names; with several measures the name contains the measure."""
    several = len({measure for _, measure in held}) > 1
    taken: set[str] = set()
    for (structure, measure), by_limit in held.items():
        known = intensity_type(measure)
        assert known is not None
        name = identifier(f"{structure}-{known[0]}" if several else structure, taken)
        taken.add(name)
        yield Function(name, [by_limit[limit] for limit in order], *known)


def doubts(functions: Sequence[Function]) -> Iterator[str]:
    """Yield names that differ from those of the study, and curves that cross; the summary has other doubts."""
    for function in functions:
        first = function.curves[0]
        of = f"{first.structure} over {first.measure}"
        if function.name != first.structure:
            yield f"{of} is called {function.name} there"
        x = np.geomspace(function.undamaged, function.ends[1], CROSSING_POINTS) / function.factor
        for milder, graver in pairwise(function.curves):
            above = graver.curve.own.probability(x) - milder.curve.own.probability(x)
            k = int(above.argmax())
            if above[k] > MIN_CROSSING:
                yield (
                    f"{of}: the curves of {milder.limit} and {graver.limit} cross: at {x[k]:.3g} the probability of "
                    f"the graver is larger by {above[k]:.2g}, a share below zero"
                )


def _name(found: Fragility) -> str:
    return f"{found.structure}, {found.limit} over {found.measure}"


def limit_id(limit: Limit) -> str:
    """Return a limit state as an identifier of OpenQuake: letters, digits and _, starting with a letter."""
    if isinstance(limit, str) and metres(limit) is None:
        return limit
    value, form = (limit, "ratio_{}") if isinstance(limit, float) else (float(limit.split()[0]), "top_{}_mm")
    return form.format(np.format_float_positional(value, trim="-").replace(".", "_"))


def identifier(text: str, taken: Collection[str] = ()) -> str:
    """Return a name as a unique identifier of OpenQuake: letters, digits, - and _, different from those taken."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    name = re.sub(r"[^A-Za-z0-9_-]+", "_", plain).strip("_")[:MAX_NAME_LENGTH] or "structure"
    names = chain([name], (f"{name[: MAX_NAME_LENGTH - 6]}-{k}" for k in count(2)))
    return next(each for each in names if each not in taken)


def nrml(model: OpenQuakeModel, name: str, description: str) -> bytes:
    """Return an NRML document; characters of the description that are not ASCII become question marks."""
    from jinja2 import Template

    template = Template(DOCUMENT, autoescape=True, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    plain = one_line(description).encode("ascii", "replace").decode()
    document: str = template.render(model=model, name=identifier(name), description=plain)
    return document.encode()


DEMANDS = {"PGA": ("Peak Ground Acceleration", "g"), "PGV": ("Peak Ground Velocity", "mps")}
MAX_LIMITS = 9  # pelicun sorts limit states as text, LS10 before LS2
DIRECTIONAL = 1  # a demand that is not directional is multiplied, by 1.2 unless told otherwise


def demand(measure: str) -> tuple[str, str] | None:
    """Return the demand type and the unit of a measure in pelicun; None if it cannot be written.

    The PGD of pelicun is a permanent deformation of the ground, and its spectral displacement has no damping.
    """
    spectral = SPECTRAL_MEASURE.fullmatch(measure)
    return (f"Spectral Acceleration|{float(spectral[1])}", "g") if spectral else DEMANDS.get(measure)


def components(curves: Sequence[Fragility]) -> tuple[list[Function], list[str]]:
    """Return the components of a study with their curves in order of severity, and why other curves are left out.

    Parameters
    ----------
    curves : sequence of Fragility
        All curves of a study.

    Raises
    ------
    InputError
        If no curve can be written; the message has the reasons.
    """
    over = "curves for pelicun are over PGA, PGV or Sa of 5 % damping"
    reasons = [
        f"all curves over {each.measure}: {over}"
        if demand(each.measure) is None
        else why_not(each, "the table for pelicun")
        for each in curves
    ]
    held = _grouped(each for each, reason in zip(curves, reasons, strict=True) if not reason)
    left_out = dict.fromkeys(filter(None, reasons))  # in order, each once
    several = len({measure for _, measure in held}) > 1
    rows: list[Function] = []
    for (structure, measure), by_limit in held.items():
        kind, factor = intensity_type(measure) or (measure, 1.0)
        taken = [row.name.replace(".", "-") for row in rows]  # pelicun splits names at -
        name = f"{structure}_{kind}" if several else structure
        name = identifier(name.replace("-", "_"), taken).replace("-", ".")
        if len(by_limit) > MAX_LIMITS:
            left_out[f"{structure} over {measure}: pelicun sorts at most {MAX_LIMITS} limit states correctly"] = None
        else:
            ordered = [by_limit[limit] for limit in by_severity(by_limit, by_limit)]
            rows.append(Function(name, ordered, kind, factor))
    if not rows:
        raise InputError("pelicun accepts none of the curves: " + "; ".join(left_out or ["the study has no curves"]))
    return rows, list(left_out)


def table(rows: Sequence[Function]) -> Columns:
    """Return the table of components by its headings."""
    most = max(len(row.curves) for row in rows)
    heads = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    of_state = "Family", "Theta_0", "Theta_1", "DamageStateWeights"
    heads += [f"LS{k}-{head}" for k in range(1, most + 1) for head in of_state]
    cells = []
    for row in rows:
        line = [row.name, 0, *(demand(row.curves[0].measure) or ()), 0, DIRECTIONAL]
        for curve in row.curves:
            line += ["lognormal", *median_and_spread(curve), ""]
        cells.append(line + [""] * (len(heads) - len(line)))
    return dict(zip(heads, zip(*cells, strict=True), strict=True))
