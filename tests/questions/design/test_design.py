"""Where a requirement holds: against closed forms, and counted by hand."""

import json
from math import isclose, nan
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError
from rocking_cli.questions.design.metrics import METRICS, Excitation, Metric
from rocking_cli.questions.design.picture import draw_design
from rocking_cli.questions.design.study import Aim, Span, design
from rocking_cli.questions.design.view import answer
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood, neighbours
from rocking_cli.verification.check import verify
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.following import conditions

ACCEL = EXAMPLES / "accel.csv"
BLOCK = EXAMPLES / "block.yaml"
G = 9.80665
MASS = 12_000.0  # kg
TENDON = {"name": "tendon", "path": [{"ground": [0.0, 0.0]}, {"at": [0.0, 0.0]}], "stiffness": 0.0}


def tied():
    """The column of docs/loads.md: 1 m x 5 m, with a tendon of constant force along its axis."""
    return rk.Block(name="column", width=1.0, height=5.0, mass=MASS, ties=[TENDON])


def of(metric, values=(0.0, 1.0), points=11, until="m >= 0.5"):
    """A design of a metric that is a function of the width, which has no physics in it."""
    from unittest.mock import patch

    made = Metric("m", "", "a test", lambda structure, excitation: metric(structure.mechanism.width))
    with patch.dict(METRICS, {"m": made}):
        return design(Structure(rk.Block(width=1.0, height=2.0)), "width", values, Aim.parse(until), points=points)


class TestClosedForms:
    @pytest.mark.parametrize(
        ("until", "least"), [("lambda >= 0.2", True), ("lambda > 0.2", True), ("lambda <= 0.2", False)]
    )
    def test_the_width_of_a_block(self, until, least):
        found = rk.design(rk.Block(width=0.5, height=2.0), "width=200mm:0.8m", until, points=8)
        assert isclose(found.value, 0.4, rel_tol=1e-9)  # lambda = width/height
        assert found.monotone and found.is_least is least and len(found.holds) == 1
        low, high = found.holds[0]
        assert (isclose(low, 0.4), high == 0.8) == (True, True) if least else (low == 0.2, isclose(high, 0.4))

    @pytest.mark.parametrize("until", ["lambda >= 0.24", "phi_cr >= 0.23635507"])
    def test_the_force_of_a_tendon(self, until):
        """lambda = tan(alpha) (1 + N0/mg); the table of an independent program has phi_cr with N0/mg = 0.2."""
        found = rk.design(tied(), "ties.tendon.prestress=0:100kN", until, points=4)
        assert isclose(found.value, 0.2 * MASS * G, rel_tol=1e-5)
        assert found.is_least and found.unit == "N"

    def test_the_largest_load_on_top(self):
        """A mass M at a height h on a block of m, b, H: lambda = b (m + M)/(m H + 2 M h)."""
        b, height, m, h, level = 0.5, 2.0, 1000.0, 2.0, 0.2
        load = {"name": "bust", "mass": 10.0, "at": [0.0, h]}
        block = rk.Block(width=b, height=height, mass=m, loads=[load])
        wanted = m * (b - level * height) / (2 * level * h - b)
        for field in ("loads.bust.mass", "loads.0.mass"):
            found = rk.design(block, f"{field}=0.01t:2t", f"lambda >= {level}", points=4)
            assert isclose(found.value, wanted, rel_tol=1e-9) and not found.is_least


class TestMetrics:
    def test_of_two_directions_the_weaker_counts(self):
        load = {"name": "bust", "mass": 300.0, "at": [0.2, 2.0]}
        block = rk.Block(width=0.6, height=2.0, mass=900.0, loads=[load])
        both = rk.equiv(block)
        for name, worse in (("lambda", min), ("phi_cr", min), ("p", max)):
            key = "lambda_" if name == "lambda" else name
            sides = [getattr(each, key) for each in (both.positive, both.negative)]
            found = rk.design(block, ("width", 0.6, 0.7), f"{name} < 9", points=2).metric[0]
            assert sides[0] != sides[1] and isclose(found, worse(sides), rel_tol=1e-9)


class TestScan:
    def test_every_range_of_what_turns(self):
        found = of(lambda x: np.sin(4 * np.pi * x), (0.001, 1.0), 41, "m >= 0.5")
        edges = [(1 / 24, 5 / 24), (13 / 24, 17 / 24)]
        assert not found.monotone and found.value is None
        assert np.allclose(found.holds, edges, rtol=1e-8)
        assert "at neither end" in answer(found)

    def test_nowhere_and_everywhere(self):
        nowhere, everywhere = (of(lambda x: x, (0.1, 0.9), until=f"m < {level}") for level in (0.1, 2))
        assert nowhere.holds == [] and nowhere.value is None and not nowhere.everywhere
        assert "holds at no value" in answer(nowhere) and "the smallest m is 0.1, at 0.1 m" in answer(nowhere)
        assert everywhere.holds == [(0.1, 0.9)] and everywhere.value is None and everywhere.everywhere
        assert "holds at every value" in answer(everywhere)

    def test_what_cannot_be_built_is_named(self):
        found = of(lambda x: 1 - x, (-0.5, 1.0), 16, "m >= 0.25")
        (part,) = found.not_built
        assert isclose(part.low, -0.5) and isclose(part.high, 0.0, abs_tol=1e-12)
        assert "width must be more than 0 m" in part.reason
        assert np.isnan(found.metric[:6]).all() and not np.isnan(found.metric[6:]).any()
        ((low, high),) = found.holds
        assert isclose(high, 0.75) and isclose(low, 1e-6, rel_tol=1e-6)
        gap = of(lambda x: nan if 0.4 < x < 0.6 else x, (0.05, 0.95), 19, "m >= 0.2")
        assert not gap.monotone and len(gap.holds) == 2 and gap.not_built[0].reason == "m does not exist"

    def test_a_metric_without_a_bound(self):
        found = of(lambda x: np.inf if x < 0.62 else 1 / x, (0.1, 1.0), 10, "m < 5")
        assert isclose(found.value, 0.62, rel_tol=1e-9) and found.monotone


DEEP = {"width": 0.45, "depth": 0.55, "height": 2.4}


class TestWeakerSide:
    def test_a_wider_base_helps_up_to_the_depth(self):
        found = rk.design(rk.Block(**DEEP), "width=0.3m:1m", "lambda >= 0.24")
        assert found.metric == pytest.approx(np.minimum(found.values, 0.55) / 2.4) and not found.holds
        assert found.depth_governs == [pytest.approx((0.55, 1.0))]
        assert "From 0.55 m on, the depth is the weaker side of the base and governs" in found.to_dict()["verdict"]
        held = rk.design(rk.Block(**DEEP, plane="width"), "width=0.3m:1m", "lambda >= 0.24")
        assert held.value == pytest.approx(0.24 * 2.4) and not held.depth_governs

    def test_the_depth_has_an_effect_while_it_is_the_smaller(self):
        found = rk.design(rk.Block(**DEEP), "depth=0.3m:1m", "lambda >= 0.15")
        assert found.value == pytest.approx(0.36) and found.depth_governs == [pytest.approx((0.3, 0.45))]
        assert "governs" not in rk.design(rk.Block(width=0.5, height=2.0), "width=0.2m:1m", "lambda > 0").sentences[0]

    def test_what_an_intervention_requires_is_by_the_weaker_side_too(self, tmp_path):
        site = (EXAMPLES / "verify" / "site.yaml").read_text(encoding="utf-8") + "\nintervention: improvement\n"
        (tmp_path / "site.yaml").write_text(site, encoding="utf-8")
        deep, thin = (rk.Block(width=w, depth=d, height=6.0, density=1800) for w, d in ((0.6, 0.4), (0.4, 0.6)))
        ends = [
            rk.design(each, "height=4:9", "ratio >= required", site=tmp_path / "site.yaml", points=3).aim.level
            for each in (deep, thin)
        ]
        assert ends[0] == pytest.approx(ends[1], rel=1e-9)

    def test_what_has_no_effect_on_shares_is_said(self):
        shaken = {"until": "overturned < 5%", "motions": "sine:0.3g:0.8s", "neighbours": 20, "points": 3}
        said = " ".join(rk.design(rk.Block(**DEEP), "depth=0.6m:1m", **shaken).sentences)
        assert "overturned is the same at every value tried: depth has no effect on it." in said
        assert "Motions as given only: unless the structure is symmetric" in said


class TestShares:
    SINE = "sine:0.5g:0.8s"

    def test_the_metrics_are_those_of_the_neighbours(self):
        motion, around = rk.parse_pulse(self.SINE).sampled(), Neighbourhood(10)
        # Requirements that hold everywhere and nowhere, so that no edge is searched.
        found = rk.design(BLOCK, "width=0.3:1.2", "overturned <= 100%", self.SINE, neighbours=10, points=4)
        peaks = rk.design(BLOCK, "width=0.3:1.2", "peak_ratio < 0", self.SINE, neighbours=10, points=4)
        block = rk.load_structure(BLOCK)
        for width, share, peak in zip(found.values, found.metric, peaks.metric, strict=True):
            near = neighbours(conditions(block.model_copy(update={"width": float(width)}), around), motion)
            assert share == near.overturned and peak == near.peak_ratio[1]

    def test_the_answer_holds_and_just_below_it_does_not(self):
        found = rk.design(BLOCK, "width=0.5:1.2", "overturned <= 50%", self.SINE, neighbours=10, points=3)
        assert found.monotone
        excitation = Excitation([rk.parse_pulse(self.SINE).sampled()], (1,), Neighbourhood(10))
        metric, block = METRICS["overturned"].at, Structure(rk.load_structure(BLOCK))

        at, below = (metric(block.varied("width", found.value - off), excitation)[0] for off in (0.0, 2e-3))
        assert at <= 0.5 < below

    def test_the_worse_of_motions_and_polarities_counts(self):
        frame, accel, sine = EXAMPLES / "frame.yaml", rk.read_record(ACCEL), rk.parse_pulse(self.SINE).sampled()
        structure = Structure(rk.load_structure(frame))

        def peak(motions, *polarities):
            return METRICS["peak_ratio"].at(structure, Excitation(motions, polarities, Neighbourhood(5)))[0]

        one, other, pulse, opposite = peak([accel], 1), peak([accel], -1), peak([sine], 1), peak([sine], -1)
        assert len({one, other, pulse, opposite}) == 4
        assert peak([accel], 1, -1) == max(one, other) and peak([accel, sine], 1) == max(one, pulse)
        given = {"polarity": "-1", "neighbours": 5, "points": 2}
        found = rk.design(frame, "gravity=9.80665:9.9", "peak_ratio < 1", [ACCEL, self.SINE], **given)
        assert found.metric[0] == max(other, opposite)

    def test_where_shares_turn_edges_are_values_that_were_tried(self):
        found = rk.design(BLOCK, "width=0.3:0.7", "overturned < 75%", ACCEL, neighbours=10, points=5)
        assert not found.monotone and len(found.holds) == 2
        assert all(edge in found.values for span in found.holds for edge in span)
        assert any("One time history is one sample" in said for said in found.sentences)


class TestWritten:
    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("lambda 0.2", "'lambda 0.2' is not a valid requirement"), ("lambda = 0.2", "is not a valid requirement"),
            ("lamda < 1", "did you mean lambda?"), ("phi_cr < 3 kg", "a mass, not an angle"),
            ("lambda < 1e999", "not a finite number"),
        ],
    )  # fmt: skip
    def test_requirements(self, text, said):
        with pytest.raises(InputError, match=said.replace("?", r"\?")):
            Aim.parse(text)

    def test_requirements_with_units(self):
        assert isclose(Aim.parse("phi_cr<=10 deg").level, np.radians(10))
        assert Aim.parse("overturned < 5 %").level == 0.05
        assert str(Aim.parse(" lambda>=0.2 ")) == "lambda >= 0.2"

    @pytest.mark.parametrize("text", ["width", "width=1:2:3", "=1:2"])
    def test_ranges(self, text):
        with pytest.raises(InputError, match="is not a valid FIELD=LOW:HIGH"):
            Span.parse(text)
        with pytest.raises(InputError, match="is not increasing"):
            Span.parse("width=2m:10cm").in_unit("m")

    @pytest.mark.parametrize(
        ("field", "said"),
        [
            ("widht", "did you mean width?"), ("name", "name is not a numeric field"), ("width.x", "holds no x"),
            ("ties.tendn.prestress", "tendon?"), ("ties.1.prestress", "no entry 1"),
        ],
    )  # fmt: skip
    def test_fields(self, field, said):
        with pytest.raises(InputError, match=said.replace("?", r"\?")):
            Structure(tied()).unit_of(field)

    def test_what_can_vary_is_named(self):
        feet = {"mass": 1250.0, "centroid": [0, 1.1], "inertia": 520.0, "left_foot": [-0.3, 0], "right_foot": [0.3, 0]}
        with pytest.raises(InputError, match="a number of this file can be varied, such as mass, inertia"):
            Structure(rk.RigidBody(**feet)).unit_of("right_foot")


@pytest.mark.parametrize(
    ("vary", "until", "field", "factor", "unit", "end"),
    [
        ("ties.tendon.prestress=0:200kN", "lambda >= 0.3", "prestress of tendon", 1e-3, "kN", "or more"),
        ("height=2m:6m", "lambda >= 0.3", "height", 1.0, "m", "or less"),
        ("width=100mm:400mm", "phi_cr >= 0.05 rad", "width", 1e3, "mm", "or more"),
    ],
)
def test_the_picture_has_the_words_and_units_of_engineers(vary, until, field, factor, unit, end):
    tendon = {**TENDON, "prestress": 0.1 * MASS * G}
    found = rk.design(rk.Block(width=1.0, height=5.0, mass=MASS, ties=[tendon]), vary, until, points=3).result
    (axes,) = draw_design(found).axes
    aim = until.replace("lambda", "λ").replace("phi_cr", "φcr").replace(">=", "≥")
    assert axes.get_title(loc="left") == f"block: {field} for {aim}"
    assert axes.get_xlabel() == f"{field} [{unit}]"
    assert axes.get_xlim() == pytest.approx(factor * found.values[[0, -1]])
    (star,) = (each for each in axes.lines if each.get_marker() == "*")
    assert star.get_xydata() == pytest.approx(np.array([[factor * found.value, found.aim.level]]))
    assert [each.get_text() for each in axes.texts] == [f"{factor * found.value:.5g} {unit} {end}"]
    (area,) = axes.patches
    assert area.get_label() == "satisfied"
    assert (area.get_x(), area.get_x() + area.get_width()) == pytest.approx(factor * np.array(found.holds[0]))


class TestCommand:
    def test_json_table_and_picture(self):
        arguments = ("design", BLOCK, "--vary", "width=200mm:0.8m", "--until", "lambda >= 0.2", "--points", "7")
        data = json.loads(run(*arguments, "--json", "--plot", "p.svg", "--out", "o.csv").stdout)
        assert isclose(data["value"], 0.56) and data["field"] == "width" and data["unit"] == "m"
        assert data["holds"][0][1] == 0.8 and data["monotone"] and data["in_file"] == 0.7
        assert data["scan"]["metric"] == pytest.approx([each / 2.8 for each in data["scan"]["values"]])
        assert Path("p.svg").stat().st_size > 1000
        lines = Path("o.csv").read_text(encoding="utf-8").splitlines()
        assert lines[0] == "width [m],lambda,holds" and len(lines) == 8
        said = run(*arguments).stdout
        smallest = "The smallest width for which lambda >= 0.2 holds is 0.56 m; from there it holds to the end of the"
        assert f"{smallest} range tried, 0.8 m." in " ".join(said.split())

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (("--vary", "width=1:2", "--until", "overturned < 1"), "needs a ground motion"),
            (("--vary", "width=1:2", "--until", "lambda < 1", "--pulse", "sine:1g:1s"),
             "lambda does not depend on a ground motion"),
            (("--vary", "width=1:2", "--until", "peak_ratio < 1", "--pulse", "sine:1g:1s", "--neighbours", "0"),
             "at least 1"),
            (("--vary", "\x1b[31m=1:2", "--until", "lambda < 1"), r"\x1b[31m"),
        ],
    )  # fmt: skip
    def test_what_cannot_be_is_refused(self, arguments, said):
        assert said in " ".join(run("design", BLOCK, *arguments, code=2).stderr.split())

    def test_a_range_without_any_structure_is_a_result(self):
        said = run("design", BLOCK, "--vary", "width=-2:-1", "--until", "lambda < 1", "--plot", "p.png").stdout
        assert "lambda could not be computed at any of these values" in said
        assert "From -2 m to -1 m lambda could not be computed: width must be more than 0 m, got -2.0." in said


def test_a_range_that_looks_like_millimetres_is_warned_of(tmp_path):
    file = tmp_path / "block.yaml"
    file.write_text("mechanism: block\nwidth: 0.7\nheight: 2.8\n", encoding="utf-8")
    odd = run("design", file, "--vary", "width=200:800", "--until", "lambda > 0.1", "--points", "3").stderr
    assert "at width = 200 m: width is 200 m: did you mean 200 mm or 200 cm?" in " ".join(odd.split())
    right = run("design", file, "--vary", "width=200mm:800mm", "--until", "lambda > 0.1", "--points", "3").stderr
    assert "did you mean" not in right


TIE = {"name": "bar", "from": {"ground": [-6, 7.5]}, "to": {"at": [-0.3, 7.5]}, "prestress": 2e3}
FACADE = {"name": "facade", "width": 0.6, "height": 8.0, "density": 1800.0, "depth": 5.0,
          "one_sided": "positive", "rebound": 0.4}  # fmt: skip
SITE = {"FC": 1.35, "ag": 0.25, "F0": 2.5, "TC": 0.4, "S": 1.2}


class TestWhatHasNoEffect:
    def facade(self, **tie):
        return rk.Block(**FACADE, ties=[{**TIE, **tie}])

    def test_the_area_of_a_tie_that_would_hold_for_ever_says_why(self):
        """The reason is that of `verify`, and its advice is one that works."""
        found = rk.design(
            self.facade(area=5e-4, modulus=2e11), "ties.bar.area=100mm2:900mm2", "zeta_nonlinear >= 1", site=SITE,
            points=3,
        )  # fmt: skip
        said = " ".join(found.sentences)
        assert found.holds == [] and "holds at no value of ties.bar.area" in said
        assert [each.name for each in found.taken_otherwise] == ["bar"]
        (why,) = found.to_dict()["taken_otherwise"]
        assert why in " ".join(rk.verify(self.facade(area=5e-4, modulus=2e11), SITE).sentences)
        assert why in said and "give its `steel` or `yield`, so that it counts" in why
        assert "zeta_nonlinear is the same at every value tried: ties.bar.area has no effect on it." in said
        held = {key: value for key, value in TIE.items() if key != "prestress"} | {"area": 5e-4, "steel": "S235"}
        counted = rk.Block(**FACADE, ties=[held])
        found = verify(Structure(counted), site_of(SITE))
        assert found.directions[rk.Direction.POSITIVE].methods["nonlinear"].zeta > 1
        assert found.conclusion.left_out == []
