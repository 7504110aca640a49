"""Curves for OpenQuake, read back by the rules of its format, and curves as a table."""

import re
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.stats import lognorm, norm

from rocking_cli.errors import InputError
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import fit_curve
from rocking_cli.questions.fragility.exports import chosen, identifier, limit_id, nrml
from rocking_cli.questions.fragility.hazard_curve import intensity_type
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.results import curve_blocks
from tests.conftest import EXAMPLES, rows_of
from tests.stores import command

URL = "{http://openquake.org/xmlns/nrml/0.5}"
LEVELS = np.linspace(0.1, 1.5, 15)
RECORDS = 12


def curve(structure, limit, median, beta, measure="PGA", kind="lognormal"):
    """A curve fitted to records that exceed at capacities of these, spread evenly; other kinds from suitable data."""
    capacity = median * np.exp(beta * norm.ppf((np.arange(RECORDS) + 0.5) / RECORDS))
    if kind == "step":
        capacity[:] = median
    elif kind == "none":
        capacity[:] = 100.0
    x, record = np.tile(LEVELS, RECORDS), np.repeat(np.arange(RECORDS), LEVELS.size)
    seen = Observations.of(x, x > capacity[record], record)
    fitted = fit_curve(seen)
    assert fitted.kind == kind
    return Fragility(structure, limit, measure, seen, fitted, None)


def some(structure="pedestal", measure="PGA"):
    return [
        curve(structure, "uplift", 0.35, 0.3, measure), curve(structure, "overturning", 0.9, 0.3, measure),
        curve(structure, 0.5, 0.7, 0.3, measure), curve(structure, 0.1, 0.45, 0.3, measure),
        curve(structure, "25 mm", 0.5, 0.3, measure),
    ]  # fmt: skip


def read(document):
    """What OpenQuake makes of a document: by function its measure and its curves, after a look at every rule.

    The rules are those of the manual of its format, and of how it evaluates a continuous function.
    """
    root = ElementTree.fromstring(document)
    assert root.tag == f"{URL}nrml"
    (model,) = root
    assert model.tag == f"{URL}fragilityModel"
    assert re.fullmatch(r"[A-Za-z0-9_-]{1,60}", model.attrib["id"])
    assert model.attrib["assetCategory"] and model.attrib["lossCategory"] in (
        "structural", "nonstructural", "contents", "business_interruption",
    )  # fmt: skip
    description, states, *functions = model
    assert description.tag == f"{URL}description" and description.text.strip() and description.text.isascii()
    assert states.tag == f"{URL}limitStates"
    limits = states.text.split()
    assert limits and len(set(limits)) == len(limits)
    assert all(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", each) for each in limits)
    found = {}
    for function in functions:
        assert function.tag == f"{URL}fragilityFunction"
        assert (function.attrib["format"], function.attrib["shape"]) == ("continuous", "logncdf")
        name = function.attrib["id"]
        assert re.fullmatch(r"[A-Za-z0-9_-]{1,100}", name) and name not in found
        imls, *params = function
        assert imls.tag == f"{URL}imls"
        assert re.fullmatch(r"PGA|PGV|PGD|IA|CAV|SA\([0-9.]+\)", imls.attrib["imt"])
        least, most, none = (float(imls.attrib[each]) for each in ("minIML", "maxIML", "noDamageLimit"))
        assert 0 < least < most < np.inf and 0 < none < most  # below `none` nothing is damaged
        assert [each.tag for each in params] == [f"{URL}params"] * len(limits)
        assert [each.attrib["ls"] for each in params] == limits
        pairs = np.array([[float(each.attrib["mean"]), float(each.attrib["stddev"])] for each in params])
        assert (pairs > 0).all() and np.isfinite(pairs).all()
        found[name] = SimpleNamespace(imt=imls.attrib["imt"], least=least, most=most, pairs=dict(zip(limits, pairs)))  # noqa: B905
    assert found
    return limits, found


def evaluated(pair, x):
    """The probability that OpenQuake takes, from the mean and the standard deviation of the intensity."""
    mean, deviation = pair
    ratio = (deviation / mean) ** 2
    return lognorm.cdf(x, np.sqrt(np.log(1 + ratio)), scale=mean / np.sqrt(1 + ratio))


def test_what_is_read_back_is_the_curve():
    curves = some()
    limits, found = read(nrml(chosen(curves), "a study", "some words"))
    assert limits == ["uplift", "ratio_0_1", "top_25_mm", "ratio_0_5", "overturning"]
    assert set(found) == {"pedestal"} and found["pedestal"].imt == "PGA"
    x = np.linspace(0.05, 2, 50)
    for each in curves:
        pair = found["pedestal"].pairs[limit_id(each.limit)]
        np.testing.assert_allclose(evaluated(pair, x), each.curve.probability(x), rtol=1e-9, atol=1e-12)
        median, beta = each.curve.median.value, each.curve.dispersion.value
        # The moments of that distribution, by its own quadrature over the logarithm.
        u, weight = np.polynomial.hermite_e.hermegauss(60)
        values = median * np.exp(beta * u)
        mean = weight @ values / weight.sum()
        deviation = np.sqrt(weight @ (values - mean) ** 2 / weight.sum())
        assert pair == pytest.approx((mean, deviation), rel=1e-9)


def test_it_is_flat_beyond_its_ends_only_where_that_changes_little():
    _, found = read(nrml(chosen([curve("a", "uplift", 0.35, 0.6), curve("a", "overturning", 0.9, 0.3)]), "a", "b"))
    function = found["a"]
    assert function.most == 1.5 and function.least < 0.1
    assert max(evaluated(pair, function.least) for pair in function.pairs.values()) == pytest.approx(1e-4, rel=1e-3)
    _, found = read(nrml(chosen([curve("a", "overturning", 0.9, 0.3)]), "a", "b"))
    assert found["a"].least == 0.1  # where the data begin


@pytest.mark.parametrize(
    ("measure", "imt", "factor"),
    [
        ("PGV", "PGV", 100), ("SA(0.50 s)", "SA(0.5)", 1), ("CAV", "CAV", 1 / 9.80665),
    ],
)  # fmt: skip
def test_measures_are_in_the_units_of_openquake(measure, imt, factor):
    curves = some(measure=measure)
    limits, found = read(nrml(chosen(curves), "a", "b"))
    x = np.linspace(0.1, 1.5, 20)
    for limit, each in zip(limits, (curves[0], curves[3], curves[4], curves[2], curves[1]), strict=True):
        values = evaluated(found["pedestal"].pairs[limit], factor * x)
        np.testing.assert_allclose(values, each.curve.probability(x), rtol=1e-9)
    assert found["pedestal"].imt == imt and found["pedestal"].most == pytest.approx(1.5 * factor)


def test_measures_relative_to_the_structure_are_left_out():
    assert intensity_type("PGA/(g lambda)") is None and intensity_type("p PGV/(g lambda)") is None
    model = chosen([*some(), *some(measure="PGA/(g lambda)")])
    assert len(model.functions) == 1
    assert model.left_out == ["all curves over PGA/(g lambda): OpenQuake has no such intensity measure"]
    with pytest.raises(InputError, match="OpenQuake accepts none of the curves: all curves over PGA/"):
        chosen(some(measure="PGA/(g lambda)"))


def test_curves_of_other_kinds_and_sliding_are_left_out_and_named():
    curves = [*some(), curve("pedestal", 0.9, 0.82, 0, kind="step"), curve("pedestal", 2.0, 0, 0, kind="none")]
    curves.append(curve("pedestal", "sliding", 0.5, 0.3))
    model = chosen(curves)
    assert len(model.limits) == 5 and len(model.left_out) == 3
    said = " ".join(model.left_out)
    assert "0.9 over PGA: its curve is a step" in said and "2.0 over PGA: no curve exists: none of the" in said
    assert "sliding is not a step" in said


def test_several_structures_have_the_same_limit_states_and_most_curves_are_kept():
    one, other = some("one"), some("other")[:2]
    third = [curve("third", 0.5, 0.7, 0.3)]
    model = chosen([*one, *other, *third])
    # 5 of one; uplift and overturning of two are 4; 0.5 of two is 2.
    assert [each.name for each in model.functions] == ["one"] and len(model.limits) == 5
    assert len(model.left_out) == 3 and "no lognormal curve exists for 0.1, 0.5, 25 mm" in model.left_out[0]
    model = chosen([*one, *other, *[replace_name(each, f"more{k}") for k in range(2) for each in other]])
    assert len(model.functions) == 4 and model.limits == ["uplift", "overturning"]
    assert len(model.left_out) == 3 and "has no lognormal curve for this one" in model.left_out[0]


def replace_name(found, name):
    return Fragility(name, found.limit, found.measure, found.seen, found.curve, None)


def test_with_several_measures_each_function_has_a_name_of_its_own():
    _, found = read(nrml(chosen([*some(), *some(measure="PGV")]), "a", "b"))
    assert {name: each.imt for name, each in found.items()} == {"pedestal-PGA": "PGA", "pedestal-PGV": "PGV"}


def test_names_of_any_kind_become_names_of_openquake_and_that_is_said():
    names = ["Säule <1>&\"'", "Säule (1)", "木", "x" * 200]
    model = chosen([each for name in names for each in some(name)])
    _, found = read(nrml(model, "<&>", "a <b> & ü 木 \x1b[31m"))
    assert list(found) == ["Saule_1", "Saule_1-2", "structure", "x" * 60]
    assert sum("is called" in each for each in model.doubts) == 4
    assert identifier("a" * 80, {"a" * 60}) == "a" * 54 + "-2"


def test_curves_that_cross_are_said_and_others_are_not():
    assert not any("cross" in each for each in chosen(some()).doubts)
    wide = [curve("a", 0.5, 0.5, 0.2), curve("a", "overturning", 0.7, 0.9)]
    (said,) = [each for each in chosen(wide).doubts if "cross" in each]
    x = np.linspace(0.05, 1.5, 2000)
    above = wide[1].curve.probability(x) - wide[0].curve.probability(x)
    assert f"larger by {above.max():.2g}" in said and "a over PGA: the curves of 0.5 and overturning" in said


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    place = tmp_path_factory.mktemp("nrml") / "pedestal.runs"
    command("fragility", EXAMPLES / "study" / "pedestal.yaml", "--store", place, code=0)
    return place


def test_the_command_writes_what_openquake_takes_and_names_the_rest(store, tmp_path):
    out = tmp_path / "fragility.xml"
    found = command("results", store, "--nrml", out)
    assert found.exit_code == 0 and "not in" in found.stderr and "uplift over PGA: its curve is a step" in found.stderr
    limits, functions = read(out.read_bytes())
    assert limits == ["ratio_0_5", "overturning"] and set(functions) == {"pedestal"}
    assert "wrote" in found.stderr and "pedestal under pulses" in found.stdout
    assert command("fragility", EXAMPLES / "study" / "pedestal.yaml", "--store", store, "--nrml", out).exit_code == 0


def test_curves_as_a_table(store, tmp_path):
    command("results", store, "--curves", tmp_path / "curves.csv", code=0)
    rows = rows_of(tmp_path / "curves.csv")
    names = ["structure", "limit_state", "measure", "unit", "kind", "median", "dispersion", "scale"]
    other = [f"lower_{name}" for name in ("median", "dispersion", "scale", "probability", "low", "high")]
    assert list(rows[0]) == [*names, "x", "probability", "low", "high", "unknown", *other]
    for each in rows:  # all outcomes are known, so that there is one curve
        assert float(each["unknown"]) == 0
        assert all(each[name] == each[name.removeprefix("lower_")] for name in other)
    assert {(each["limit_state"], each["kind"]) for each in rows} == {
        ("uplift", "step"), ("0.5", "lognormal"), ("overturning", "lognormal"),
    }  # fmt: skip
    step = [(float(each["x"]), float(each["probability"])) for each in rows if each["kind"] == "step"]
    assert {p for x, p in step if x <= 0.25} == {0.0} and {p for x, p in step if x > 0.25} == {1.0}
    assert rows[0]["unit"] == "g" and not rows[0]["scale"]


def test_a_curve_that_is_not_there_is_named_and_a_table_of_none_has_its_heading(store, tmp_path):
    assert [list(each) for each in curve_blocks([])] == [list(next(iter(curve_blocks(some()))))]
    study = tmp_path / "study.yaml"
    text = (EXAMPLES / "study" / "pedestal.yaml").read_text(encoding="utf-8").replace("../", f"{EXAMPLES}/")
    study.write_text(re.sub("levels:.*", "levels: {measure: PGA, values: [0.01, 0.02]}", text), encoding="utf-8")
    command("fragility", study, code=0)
    out = tmp_path / "none.csv"
    found = command("results", study.with_suffix(".runs"), "--curves", out)
    assert "pedestal, overturning against PGA: no curve: none of the 22 runs exceed" in found.stderr
    rows = rows_of(out)
    assert {each["limit_state"] for each in rows} == {"uplift"}  # which is known without a run
