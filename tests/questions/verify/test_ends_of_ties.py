"""Where the displacement capacity ends with the ties: by hand, on a block that turns about its foot."""

import re
from html import unescape
from math import pi, sqrt

import numpy as np
import pytest
import yaml
from scipy.optimize import brentq

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.documents import sheet_page
from tests.conftest import RECORDS
from tests.questions.verify.test_verification import SITE, remarks

FOLDER = RECORDS.parent / "findings" / "verdicts"
G, FC = 9.80665, 1.35
PLUS, MINUS = Direction.POSITIVE, Direction.NEGATIVE
WALL = {"width": 0.6, "height": 8.0, "density": 18000 / G, "depth": 5.0}
LEFT = {"one_sided": "positive", "rebound": 0.4}
W, AT = 18000 * 0.6 * 8 * 5, 7.5
"""Weight of the wall [N], and height of the tie [m]."""


def bar(length=4.7, **fields):
    """A bar of 24 mm on the left of the wall: 106.3 kN."""
    place = {"from": {"ground": [-0.3 - length, AT]}, "to": {"at": [-0.3, AT]}}
    return {"name": "c", **place, "bars": 1, "diameter": 0.024, "steel": "S235", **fields}


def wall(*ties, sides=LEFT, **fields):
    return rk.Block(name="wall", **WALL, **sides, ties=list(ties) or None, **fields)


def verified(structure):
    return rk.verify(structure, SITE).directions[PLUS]


def longer(phi, length):
    """Elongation of the bar: its end, 0.6 m behind the foot, turns about the foot."""
    return abs(complex(-0.6, AT) * np.exp(-1j * phi) + 0.6 + length - 1j * AT) - length


def moment(phi, force=0.0, length=4.7):
    """Of the weight, and of a bar that pulls, about the foot: dU/dphi, by differences."""
    by_bar = force * (longer(phi + 1e-6, length) - longer(phi - 1e-6, length)) / 2e-6
    return W * (0.3 * np.cos(phi) - 4 * np.sin(phi)) + by_bar


def moved(phi):
    """Sideways displacement of the centroid, which is d of a single body."""
    return 4 * np.sin(phi) + 0.3 * (1 - np.cos(phi))


def a_star(phi, force=0.0, length=4.7):
    """a* of a single body: the moment over that of its weight sideways."""
    return moment(phi, force, length) / (W * (4 * np.cos(phi) + 0.3 * np.sin(phi))) * G / FC


N = pi * 0.024**2 / 4 * 235e6
BARE = brentq(moment, 0.0, 0.2, xtol=1e-15)


@pytest.mark.parametrize(("count", "strain"), [(1, None), (2, None), (6, None), (2, 0.03), (6, 0.01)])
def test_the_capacity_ends_where_the_tie_is_known_to_hold(count, strain):
    """Six bars would hold the wall at any displacement; d_SLV ends with them, and d0* is that of the wall alone."""
    found = verified(wall(bar(bars=count, elongation=strain)))
    ends = brentq(lambda phi: longer(phi, 4.7) - (strain or 0.02) * 4.7, 0.0, 0.2, xtol=1e-15)
    d = moved(ends)
    assert d < 0.4 * moved(BARE)
    slv, slc = found.states["SLV"], found.states["SLC"]
    assert (slv.by, slv.d, slv.a) == ("break", pytest.approx(d, rel=1e-9), pytest.approx(a_star(ends, count * N)))
    assert pytest.approx(1.68 * pi * sqrt(d / a_star(ends, count * N))) == slv.T
    assert found.d0 == pytest.approx(moved(BARE), rel=1e-9) and slc.d == pytest.approx(0.6 * moved(BARE), rel=1e-9)
    assert slc.a == pytest.approx(a_star(found.exact.rotation(slc.d)))  # without the bars
    assert found.a0 == pytest.approx((W * 0.3 + count * N * AT) / (W * 4) * G / FC)
    assert remarks(found)["tie_ends"] == {"name": "c", "d": pytest.approx(d), "e": (strain or 0.02) * 4.7}
    assert "wide" not in remarks(found)
    (said,) = remarks(found)["tie_limits"]["ties"]
    needed = longer(brentq(lambda phi: moved(phi) - 0.4 * moved(BARE), 0.0, 0.2, xtol=1e-15), 4.7) / 4.7
    assert said.values["held"] == (strain or 0.02) and 0 <= said.values["needed"] - needed < 1e-3
    assert f"while the wall could go on to {said.values['needed']:.3g}" in rk.verify(
        wall(bar(bars=count, elongation=strain)), SITE).sentences[0]  # fmt: skip
    longer_held = verified(wall(bar(bars=count, elongation=said.values["needed"])))
    assert longer_held.states["SLV"].by == "share" and longer_held.states["SLV"].d == pytest.approx(0.4 * moved(BARE))
    places = np.linspace(0.0, ends, 65)
    assert found.exact.largest == pytest.approx(max(a_star(places, count * N)), rel=1e-3)


def test_a_long_tie_ends_nothing_before_the_wall_falls():
    """Of 40 m it is known to 0.8 m, where the wall alone has fallen: d0* does not count on it, a* up to there does."""
    found = verified(wall(bar(40.0)))
    (lost,) = found.exact.lost
    assert longer(lost.phi, 40.0) == pytest.approx(0.8) and lost.phi > BARE
    assert found.d0 == pytest.approx(moved(BARE), rel=1e-9)
    slv = found.states["SLV"]
    assert (slv.by, slv.d) == ("share", pytest.approx(0.4 * moved(BARE), rel=1e-9))
    phi = found.exact.rotation(slv.d)
    assert slv.a == pytest.approx(a_star(phi, N, 40.0))


def test_a_tie_that_holds_longer_than_the_wall_stands_changes_nothing():
    """A weak bar of 60 m: a* vanishes with it before its end, as a rigid-plastic tie."""
    weak = bar(60.0, bars=None, diameter=None, area=2e-5, elongation=0.02)
    found = verified(wall(weak))
    ends = brentq(lambda phi: moment(phi, 2e-5 * 235e6, 60.0), 0.0, 0.5, xtol=1e-15)
    assert not found.exact.lost and found.d0 == pytest.approx(moved(ends), rel=1e-7)


def test_strong_ties_that_end_nowhere_do_not_count_for_d0():
    """Forty bars of 60 m, known to 30 m, hold the wall up to its kinematic limit."""
    found = verified(wall(bar(60.0, bars=40, elongation=0.5)))
    assert not found.exact.breaks and remarks(found)["let_go"] == {"names": ["c"]}
    assert found.d0 == pytest.approx(moved(BARE), rel=1e-9)
    assert found.states["SLV"].a == pytest.approx(a_star(found.exact.rotation(0.4 * moved(BARE)), 40 * N, 60.0))


def test_breaks_one_after_the_other_count_together():
    """Neither of two bars takes half of the largest a* away, both do: d_SLV ends at the second."""
    second = {**bar(elongation=0.025), "name": "e"}
    small = {"bars": None, "diameter": None, "area": 1.6e-4}
    found = verified(wall({**bar(), **small}, {**second, **small}))
    one = 1.6e-4 * 235e6
    first, last = (brentq(lambda phi, s=s: longer(phi, 4.7) - s * 4.7, 0.0, 0.2, xtol=1e-15) for s in (0.02, 0.025))
    assert a_star(first, 2 * one) - a_star(first, one) < found.exact.largest / 2
    assert a_star(last, 2 * one) - a_star(last) > found.exact.largest / 2
    assert found.states["SLV"].d == pytest.approx(moved(last), rel=1e-9)
    assert found.states["SLV"].a == pytest.approx(a_star(last, one))


def test_a_weak_tie_makes_no_wall_worse():
    """Its break would end d_SLV before that of the wall alone: then it is not counted, and a remark says so."""
    bare, tied = (rk.verify(each, SITE) for each in (wall(), wall(bar(diameter=0.012))))
    strong = rk.verify(wall(bar()), SITE)
    assert tied.conclusion.ratio == pytest.approx(bare.conclusion.ratio, rel=1e-12)
    assert strong.conclusion.ratio > bare.conclusion.ratio
    said = remarks(tied.directions[PLUS])["stronger_without"]
    assert said["names"] == ["c"] and said["ratio"] < bare.conclusion.ratio
    needed = said["ties"][0].values["needed"]
    assert f"could go on to {needed:.3g}" in tied.sentences[0] and "Not counted: the tie c" in tied.sentences[0]
    enough = rk.verify(wall(bar(diameter=0.012, elongation=needed)), SITE)
    assert enough.conclusion.ratio > bare.conclusion.ratio and not remarks(enough.directions[PLUS]).get("tie_limits")
    assert "stronger_without" not in remarks(strong.directions[PLUS])


@pytest.mark.parametrize("count", [1, 6])
def test_a_passive_tie_verifies_in_both_directions(count):
    """To the right it pulls, to the left the wall is alone: no force at rest turns it."""
    found = rk.verify(wall(bar(bars=count), sides={}), SITE)
    one_sided, alone = (rk.verify(each, SITE).directions[PLUS] for each in (wall(bar(bars=count)), wall()))
    right, left = (found.directions[side] for side in (PLUS, MINUS))
    assert right.states == one_sided.states and right.a0 == one_sided.a0
    assert [left.a0, left.d0] == pytest.approx([alone.a0, alone.d0], rel=1e-12)
    assert not found.conclusion.left_out and "Another mechanism" not in " ".join(found.sentences)


@pytest.mark.parametrize("count", [1, 30])
def test_a_tie_given_as_a_force(count):
    """The length that a tie needs is said. Thirty bars hold up to the kinematic limit, and d0* is without them."""
    force = {"name": "t", "force": [-count * N, 0.0], "at": [-0.3, AT]}
    found = verified(wall(loads=[force]))
    phi = found.exact.rotation(found.states["SLV"].d)
    across = 0.3 + (complex(-0.6, AT) * np.exp(-1j * phi)).real + 0.3
    assert remarks(found)["follows"]["length"] == pytest.approx(across / 0.02)
    assert found.a0 == pytest.approx((W * 0.3 + count * N * AT) / (W * 4) * G / FC)
    if count == 30:
        assert found.d0 == pytest.approx(moved(BARE), rel=1e-9) and remarks(found)["let_go"] == {"names": ["t"]}
    else:
        assert "let_go" not in remarks(found) and found.d0 > moved(BARE)


def test_a_wall_that_falls_without_its_tie_ends_with_it():
    """A thrust of more than the weight holds: a* ends where the tie does."""
    thrust = {"name": "vault", "force": [5e4, 0.0], "at": [0.3, 6.0]}
    held = wall({**bar(), **dict.fromkeys(("bars", "diameter", "steel")), "stiffness": 0.0, "prestress": 8e4},
                loads=[thrust])  # fmt: skip
    assert W * 0.3 < 5e4 * 6
    found = verified(held)
    ends = brentq(lambda phi: longer(phi, 4.7) - 0.02 * 4.7, 0.0, 0.2, xtol=1e-15)
    assert found.d0 == pytest.approx(moved(ends), rel=1e-9) and "tie_ends" in remarks(found)
    assert found.states["SLV"].d == pytest.approx(0.4 * moved(ends), rel=1e-9)


WEAK = {"plate": {"width": 0.3, "height": 0.3, "thickness": 0.05}, "wall": {"thickness": 0.6, "compression": 5e6}}


@pytest.mark.parametrize(("shear", "length", "more", "is_one"), [
    (2e4, 12.0, {}, True),
    (2e5, 12.0, {}, False),  # the bar yields first
    (2e4, 4000.0, {}, False),  # elastic bars stretch further
    (2e4, 12.0, {"elongation": 0.02}, True),  # a number of the bar says nothing of the wall that is punched
    (2e4, 12.0, {"elongation": 0.5}, True),
])  # fmt: skip
def test_how_far_anchorages_hold_that_give_way_first_is_a_condition(shear, length, more, is_one):
    """Punching of a cone at 45 degrees, by hand; the bar stretches N L/(E A), and its anchorages by the rest."""
    force = 2 * 0.6 * (0.3 + 0.3 + 2 * 0.6) * shear
    tied = wall(bar(length, **{**WEAK, "wall": {**WEAK["wall"], "shear": shear}}, **more))
    answer = rk.verify(tied, {**SITE, "ag": 0.1})
    found, limits = answer.directions[PLUS], {each.key: each for each in answer.conclusion.limits}
    assert found.governing["SLV"] == "nonlinear"
    assert ("anchored" in limits) == is_one
    if is_one:
        stretch = force * length / (210e9 * pi * 0.024**2 / 4)
        e = longer(found.exact.rotation(found.states["SLV"].d), length)
        told = limits["anchored"].values
        assert [told["N"], told["stretch"], told["pulled"]] == pytest.approx([force / 1e3, stretch, e - stretch])
        assert f"hold {force / 1e3:.4g} kN while they are pulled by {e - stretch:.3g} m at d_SLV" in answer.sentences[0]


@pytest.mark.parametrize("language", ["en", "it"])
@pytest.mark.parametrize("given", [None, 0.03])
def test_the_sheet_works_out_what_limits_a_tie_and_has_no_raw_marks(language, given, tmp_path, monkeypatch):
    """By hand: its elongation, the thickness of its plates, and what holds the top of a wall between floors."""
    monkeypatch.setattr(sheet_page, "inline_svg", lambda figure, _: "")
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(SITE))
    spanning = rk.SpanningWall(
        name="w", thickness=0.3, height=3.0, hinge=0.5, overburden=2e4, density=1800.0, depth=1.0
    )
    masonry = {"plate": {"width": 0.3, "height": 0.25}, "wall": {"thickness": 0.6, "compression": 5e6, "shear": 2e4}}
    found, pages = verified(wall(bar(bars=6, elongation=given, **masonry))), []
    assert found.states["SLV"].by == "break"
    for structure in [found.chain.mechanism, *([] if given else [spanning])]:
        rk.verify(structure, tmp_path / "site.yaml", sheet=tmp_path / "o.html", language=language)
        text = unescape(re.sub(r"<[^>]*>", " ", page := (tmp_path / "o.html").read_text(encoding="utf-8")))
        assert not re.search("[_^]\u2060?\\[", page)
        pages.append(re.sub(r"\s+", " ", text.replace(",", ".")))
    N = 6 * 2 * 0.6 * (0.3 + 0.25 + 1.2) * 2e4
    s, share = sqrt(N / (6 * 2 * 235e6 * 0.25 / 0.3)), given or 0.02
    assert f"= {s:.6g} m" in pages[0] and f"= {share} · 4.7 = {share * 4.7:.6g} m" in pages[0]
    said = {"en": ("assumed by the program", "structure file"), "it": ("assunto dal programma", "file della struttura")}
    assert f"{share * 4.7:.6g} {share}. {said[language][given is not None]}" in pages[0]
    top = {each.key: each.value for each in spanning.extras(PLUS)}["top_force"] / 1e3
    assert given or f" {top:.6g} kN" in pages[1]


@pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no files of verdicts in {FOLDER} (beside ROCKING_RECORDS)")
@pytest.mark.parametrize(("name", "ratio", "governs"), [("tie", 1.0718, "damage"), ("n6", 5.637, "damage"),
                                                        ("c11", 0.7625, "nonlinear")])  # fmt: skip
def test_files_that_were_refused_or_satisfied_by_a_long_tie(name, ratio, governs):
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    site = yaml.safe_load((FOLDER / "site.yaml").read_text(encoding="utf-8"))
    found = rk.verify(parse_structure(text, f"{name}.yaml", name), site)
    assert found.conclusion.ratio == pytest.approx(ratio, abs=1e-4) and found.conclusion.method == governs
    side = found.directions[PLUS]
    assert side.states["SLV"].d < 0.06 and side.methods["damage"].zeta > 1


class TestStrengths:
    """n of one bar, by hand; factors divide, and the plate bends from the bar to its edges."""

    PLATE, MASONRY = {"width": 0.3, "height": 0.25}, {"thickness": 0.6, "compression": 2e6, "shear": 1e5}

    def limits(self, plate=None, masonry=None, **fields):
        plates = {"plate": {**self.PLATE, **(plate or {})}, "wall": {**self.MASONRY, **(masonry or {})}}
        found = rk.verify(wall(bar(bars=2, **plates, **fields)), SITE)
        return found.to_dict()["directions"]["positive"]["ties"]["c"]["strength"], found

    def test_factors_divide(self):
        plain, _ = self.limits()
        bars, _ = self.limits(gamma=1.05)
        masonry, found = self.limits(masonry={"gamma": 2})
        assert bars["yield"] == pytest.approx(plain["yield"] / 1.05) and bars["bearing"] == plain["bearing"]
        assert [masonry[key] for key in ("punching", "bearing")] == pytest.approx(
            [2 * 2 * 0.6 * (0.55 + 1.2) * 1e5 / 2, 2 * 0.3 * 0.25 * 2e6 / 2]
        )
        assert masonry["yield"] == plain["yield"] == pytest.approx(2 * N)
        assert found.directions[PLUS].a0 == pytest.approx((W * 0.3 + masonry["bearing"] * AT) / (W * 4) * G / FC)

    @pytest.mark.parametrize(("b", "h"), [(0.3, 0.25), (0.2, 0.4)])
    def test_a_plate_bends(self, b, h):
        """An even pressure on either half about the bar, against a plastic section: by the integral of p x."""
        strength, s, f = {}, 0.012, 275e6
        for span, across in ((b, h), (h, b)):
            x = (np.arange(2000) + 0.5) * span / 2 / 2000  # from the bar to the edge
            lever = (x * across).sum() * span / 2 / 2000 / (b * h)  # moment for a force of 1
            strength[span] = across * s**2 / 4 * f / lever
        plate = {"width": b, "height": h, "thickness": s, "yield": f}
        assert self.limits(plate)[0]["bending"] == pytest.approx(2 * min(strength.values()), rel=1e-6)
        assert self.limits({**plate, "gamma": 1.1})[0]["bending"] == pytest.approx(2 * min(strength.values()) / 1.1)
        assert "bending" not in self.limits()[0]
        thin, found = self.limits({**plate, "thickness": 0.004})
        assert "bending of the plates governs" in " ".join(found.sentences) and min(thin.values()) == thin["bending"]
        lines = {line.symbol: line for line in found.directions[PLUS].workings if line.symbol.startswith("N")}
        assert lines["N_s"].value * 1e3 == pytest.approx(thin["bending"]) and lines["N_s"].value == lines["N"].value

    @pytest.mark.parametrize(
        ("fields", "missing"),
        [
            ({}, {"factors", "sources"}),
            ({"gamma": 1.05}, {"factors", "sources"}),
            ({"gamma": 1.05, "masonry": {"gamma": 2}}, {"sources"}),
            ({"gamma": 1.05, "masonry": {"gamma": 2, "source": "C8.5.I"}}, set()),
            ({"gamma": 1.05, "masonry": {"gamma": 2, "source": "C8.5.I"}, "plate": {"thickness": 0.02}}, {"factors"}),
            ({"gamma": 1.05, "masonry": {"gamma": 2, "source": "C8.5.I"}, "steel": None, "yield": 2e8}, {"sources"}),
            ({"gamma": 1.05, "masonry": {"gamma": 2, "source": "C8.5.I"}, "steel": None, "yield": 2e8,
              "source": "three tests"}, set()),
        ],
    )  # fmt: skip
    def test_what_is_not_given_is_said_once(self, fields, missing):
        said = remarks(self.limits(**fields)[1].directions[PLUS])
        assert {"factors", "sources"} & said.keys() == missing
        assert all(said[key] == {"names": ["c"]} for key in missing)


@pytest.mark.every(2)
@pytest.mark.parametrize(("points", "tried"), [(9, 100), (3, 3)])
def test_a_design_varies_the_number_of_bars(points, tried):
    """The least number n whose onset, (W b + n N h)/(W H) g/FC, is that asked."""
    asked = 20.5
    found = rk.design(wall(bar()), "ties.c.bars=1:100", f"ratio >= {asked}", site=SITE, points=points)
    of = {n: rk.verify(wall(bar(bars=n)), SITE).conclusion.ratio for n in (int(found.value), int(found.value) - 1)}
    assert of[found.value] >= asked > of[found.value - 1] and len(found.values) == min(points, tried)
    assert all(float(value).is_integer() for value in found.values)
    assert found.steel.proposals[0].number == found.value and found.steel.proposals[0].diameter == 0.024
    a0 = asked * SITE["ag"] * SITE["S"] * G
    assert found.value == np.ceil((a0 * FC / G * W * 4 - W * 0.3) / (N * AT))
