"""What remarks do to a conclusion: each has a decision, no headline is without what limits it, and it can be mended."""

import re
from inspect import getsource
from itertools import cycle

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli.codes.italian import remarks
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.studies.conclusion import Concluded, Effect
from rocking_cli.verification.check import EFFECTS as OF_EVERY_CODE
from rocking_cli.views.conclusion import limit_in_words, of_verification
from rocking_cli.views.sheet.language import Language, texts_of
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.questions.verify.test_mended import NO_FIELD, PLAIN, mended

G, PACKAGE = 9.80665, "rocking_cli.codes.italian"
EFFECTS = {**remarks.EFFECTS, **OF_EVERY_CODE}
NOTHING = {
    # what was taken from the files, and how
    "by_grid", "on_node", "between_nodes", "short_life", "rows", "row", "without_state", "bound", "at_rest", "missing",
    "same_mode_further",
    # conservative, or our choice where the code is silent, of no effect on what decides
    # an assumption that has no field in some mechanisms: the terminal and the sheet state it
    "unlimited",
    "no_soil", "floor", "linear_SLV", "line", "elastic", "ties", "control", "control_a_g", "control_same",
    # the capacity ends there already
    "seat", "torn", "ends",
    # numbers beside `unsupported`, `onset_alone` and `wide`
    "follows", "tie_ends", "tie_ends_at", "let_go", "plates_bend",
    # by which rule limit states and zeta_E were chosen
    "rule_states", "rule_IV", "rule_IV_without_SLD", "rule_SLD", "rule_before", "rule_unknown", "no_class",
    "IV", "IV_without_SLD",
    # the verdict is on this mechanism alone
    "bends",
    # another reading that is on the other side; the one that counts fails
    "line_passes",
    # why methods differ
    "linear_same", "linear_less", "linear_more", "straight",
    # parts of sentences
    "above", "below", "more", "less", "seat_of", "alpha0_same", "alpha0_by_letter", "give_known", "give_crushing",
    "give_hinge", "rule_FC", "zeta_by_letter",
}  # fmt: skip
SITE = {"FC": 1.35, "soil": "C", "ag": 0.21, "F0": 2.42, "TC_star": 0.31}
WALL = {"mechanism": "block", "name": "wall", "width": 0.6, "height": 8.0, "depth": 5.0, "density": 1800.0}
WALL |= {"one_sided": "positive"}
ROOF = {"name": "roof", "mass": 6000.0, "at": [0.0, 8.0], "floor": "borne", "seat": 0.3}
BAR = {"name": "bar", "from": {"ground": [-5.0, 7.5]}, "to": {"at": [-0.3, 7.5]}, "bars": 1, "diameter": 0.024}
BAR |= {"steel": "S235"}
FORCE = {"name": "bar", "force": [-1.1e5, 0.0], "at": [-0.3, 7.5]}
SHORT = {**WALL, "height": 2.2, "width": 0.5}


def of(structure):
    return parse_structure(yaml.safe_dump(structure), "s.yaml", "test", Registry())


def verified(structure, **site):
    return rk.verify(of(structure), {**SITE, **site})


def keys(answer):
    return [each.key for each in answer.conclusion.limits]


def test_every_remark_has_a_decision():
    """Keys in the code that makes remarks; families are written out."""
    made = set(re.findall(r'Remark(?:\.of)?\(\s*"(\w+)"', getsource(remarks)))
    made |= {"at_rest", "unchecked"} | set(re.findall(r'key = "(\w+)" if', getsource(remarks)))
    made |= set(re.findall(r'" if [^"\n]* else "(\w+)"', getsource(remarks)))
    families = {"torn", "strength", "strength_alone", "bearing", "SLD", "SLV"}
    assert made - families <= EFFECTS.keys() | NOTHING and not EFFECTS.keys() & NOTHING
    known = rk_texts("en")
    assert {f"end_{key}" for key in EFFECTS} <= known.keys() and known.keys() - rk_texts("it").keys() == set()


@pytest.mark.parametrize("language", ["en", "it"])
def test_filed_pages_state_facts_and_the_terminal_what_to_give(language):
    plain, page = (Language(language, texts_of(PACKAGE, language), is_plain) for is_plain in (True, False))
    own = {key for key in page.texts if key.removeprefix("end_") in EFFECTS.keys() | NOTHING}
    advice = re.compile(r"[:(] ?give |Give `|\bassegn(i|ino)\b|`rocking")
    assert sum(bool(advice.search(plain(key))) for key in own) >= 12
    assert not [key for key in own if advice.search(page(key))]
    assert not [key for key in page.texts if re.search("[⟦⟧]", page(key) + plain(key))]


@pytest.mark.parametrize(("structure", "given"), [
    (SHORT, {"crushing": {"strength": 2e6}}),
    ({"mechanism": "spanning_wall", "thickness": 0.5, "height": 4.0, "depth": 1.0, "density": 1800.0,
      "hinge": "weakest", "overburden": 3e4, "friction": 0.8}, {"crushing": {"strength": 2e6}, "hinge": None}),
    ({"mechanism": "arch", "radius": 4.0, "thickness": 0.8, "inclusion_angle_deg": 157.5, "voussoirs": 7}, {}),
])  # fmt: skip
def test_what_is_advised_for_FC_is_accepted(structure, given):
    found = verified({"name": "s", **structure}, FC=1.2, unusual=["floor"])
    (advice,) = re.findall(r"give (.*) in the site file", found.sentences[0])
    fields = dict.fromkeys(re.findall(r"`(\w+)", advice))
    assert fields.keys() == {*given, "FC_without_strength"}
    for hinge in re.findall(r"`hinge: ([\d.]+)`", advice):
        given["hinge"] = float(hinge)
    mended = verified({**structure, **given, "name": "s"}, FC=1.2, unusual=["floor"])
    assert ("confidence" in keys(mended)) == (not given)


def rk_texts(language):
    return Language(language).texts


class TestKinds:
    @pytest.mark.parametrize("mend", [{"crushing": {"strength": 2e6}}, {"FC_without_strength": True}])
    def test_FC_without_a_strength_is_that_of_LC1(self, mend):
        """Hand: a0* = b/h g/FC."""
        alpha = 0.5 / 2.2
        found = verified(SHORT, FC=1.0, ag=0.19)
        assert found.directions[rk.Direction.POSITIVE].a0 == pytest.approx(alpha * G / 1.35, rel=1e-9)
        assert keys(found) == ["confidence"] and "FC = 1.35 is used instead of 1" in found.sentences[0]
        of_structure = {key: each for key, each in mend.items() if key == "crushing"}
        of_site = {key: each for key, each in mend.items() if key != "crushing"}
        mended = verified({**SHORT, **of_structure}, FC=1.0, ag=0.19, **of_site)
        assert keys(mended) == [] and ("FC" in mended.sentences[0]) == bool(of_site)
        assert found.ratio < 1 < mended.ratio or of_structure
        assert mended.conclusion.concluded is (Concluded.SATISFIED if of_site else mended.conclusion.concluded)

    def test_FC_below_that_of_LC1_by_its_field_is_said_at_the_start(self):
        said = "FC = 1.2, below the 1.35 of LC1, by the field `FC_without_strength`"
        found = verified(SHORT, FC=1.2, FC_without_strength=True)
        assert said in found.sentences[0] and "rule_FC" in found.conclusion.rules and "confidence" not in keys(found)
        for other in (verified(SHORT, FC=1.35, FC_without_strength=True), verified(SHORT, FC=1.2)):
            assert "rule_FC" not in other.conclusion.rules
        crushed = verified({**SHORT, "crushing": {"strength": 2e6}}, FC=1.2, FC_without_strength=True)
        assert "rule_FC" not in crushed.conclusion.rules

    def test_the_letter_of_the_code_decides_on_weights_left_out(self):
        """Hand: half of a sliding floor is carried; by the letter it moves sideways too."""
        m, W = 6000.0, 0.6 * 8.0 * 5.0 * 1800.0
        roof = {**ROOF, "floor": "sliding"}
        found = verified({**WALL, "loads": [roof]})
        side = found.directions[rk.Direction.POSITIVE]
        lifted, carried = (W + m / 2) * 0.3, m / 2
        assert side.chain.alpha0 == pytest.approx(lifted / (4 * W + 8 * carried), rel=1e-9)
        assert keys(found) == ["letter"]
        (limit,) = found.conclusion.limits
        assert limit.values["own"] == pytest.approx(lifted / (4 * W), rel=1e-9)
        ours = found.result.variants()["our_reading"]
        assert limit.values["ratio"] == pytest.approx(ours.ratio, rel=1e-9)
        assert f"capacity over demand would be {ours.ratio:.3g}" in found.sentences[0]
        mended = verified({**WALL, "loads": [{**roof, "floor": "borne"}]})
        assert keys(mended) == [] and "By the letter" not in " ".join(mended.sentences)

    def test_a_long_period_is_not_decided_without_records_or_an_own_spectrum(self):
        tall = {**WALL, "height": 16.0, "rebound": 0.4}
        found = verified(tall, ag=0.12)
        T = found.directions[rk.Direction.POSITIVE].states["SLV"].T
        assert T > 4 and found.ratio > 1 and found.conclusion.concluded is Concluded.NOT_DECIDED
        assert f"not decided: the period of {T:.3g} s is above 4 s" in found.sentences[0]
        assert verified(tall).conclusion.concluded is Concluded.NOT_DECIDED and verified(tall).ratio < 1
        own = {"FC": 1.35, "spectrum": [[0.0, 0.15], [0.5, 0.4], [1.0, 0.1], [2.0, 0.02], [8.0, 0.002]]}
        assert rk.verify(of(tall), own).conclusion.concluded is Concluded.SATISFIED
        weak = [f"sine:0.0{k}g:0.5s" for k in range(1, 8)]
        by_records = rk.verify(of(tall), {**SITE, "ag": 0.12}, motions=weak).conclusion
        assert by_records.concluded is Concluded.SATISFIED_IF
        assert [each.key for each in by_records.limits] == ["below_target"]
        assert (by_records.method, len(by_records.motions)) == ("histories", 7)
        few = rk.verify(of(tall), {**SITE, "ag": 0.12}, motions=weak[:3]).conclusion
        assert few.concluded is Concluded.NOT_DECIDED

    def test_a_displacement_that_relies_on_a_force_against_it_does_not_count(self):
        """The onset of rocking counts where it passes; if it fails, nothing is decided."""
        wall = {**WALL, "loads": [ROOF, FORCE]}
        for ag, concluded in ((0.12, None), (0.25, Concluded.NOT_DECIDED), (2.0, Concluded.NOT_SATISFIED)):
            found = verified(wall, ag=ag, unusual=["ag"])
            side, end = found.directions[rk.Direction.POSITIVE], found.conclusion
            onset, reaches = side.methods["damage"], side.states["SLV"].ratio >= 1
            assert end.ratio == pytest.approx(onset.zeta) and end.method == "damage"
            assert end.concluded is concluded or (concluded is None and onset.passed)
            assert ("unsupported" in keys(found)) == (reaches and not onset.passed)
            assert ("onset_alone" in keys(found)) == (onset.passed or not reaches)

    def test_a_load_without_a_seat_is_named_with_the_length_that_it_needs(self):
        wall = {**WALL, "loads": [{key: each for key, each in ROOF.items() if key != "seat"}]}
        found = verified(wall, ag=0.1)
        side = found.directions[rk.Direction.POSITIVE]
        phi = side.exact.rotation(side.states["SLV"].d)
        moved = float(8 * np.sin(phi) + 0.3 * (1 - np.cos(phi)))
        assert found.conclusion.concluded is Concluded.SATISFIED_IF and keys(found) == ["seats"]
        assert f"(roof over {moved:.3g} m)" in found.sentences[0]
        mended = verified({**wall, "loads": [{**ROOF, "seat": 1.001 * moved}]}, ag=0.1)
        assert mended.conclusion.concluded is Concluded.SATISFIED and mended.ratio == pytest.approx(
            found.ratio, rel=1e-9
        )
        assert mended.sentences[0].partition("The verification is ")[2].startswith("satisfied.")
        shorter = verified({**wall, "loads": [{**ROOF, "seat": 0.9 * moved}]}, ag=0.1)
        assert shorter.ratio < found.ratio

    def test_a_narrow_depth_is_a_condition(self):
        block = {"mechanism": "block", "name": "b", "width": 0.5, "height": 1.5, "depth": 0.4, "density": 1800.0}
        found = verified({**block, "unusual": ["width"]}, ag=0.1)
        assert found.conclusion.concluded is Concluded.SATISFIED_IF and keys(found) == ["structure"]
        assert "(Its depth, 0.4 m, is less than its width" in found.sentences[0]

    def test_plates_of_unknown_thickness_are_a_condition_that_the_thickness_mends(self):
        """Hand: each plate bends on either side of its bar at 2 s^2 f_y, as it is square."""
        plate, wall = {"width": 0.3, "height": 0.3}, {"thickness": 0.6, "compression": 5e6, "shear": 5e4}
        bar = {
            **BAR,
            "gamma": 1.05,
            "elongation": 0.02,
            "plate": plate,
            "wall": {**wall, "gamma": 2.0, "source": "tests"},
        }
        found = verified({**WALL, "ties": [bar]}, ag=0.1)
        N = min(np.pi * 0.012**2 * 235e6 / 1.05, 2 * 0.6 * 1.8 * 5e4 / 2, 0.09 * 5e6 / 2)
        least = float(np.ceil(1e3 * np.sqrt(N / (2 * 235e6))))
        assert keys(found) == ["plate_alone", "anchored", "tie_limits"]
        assert found.conclusion.concluded is Concluded.SATISFIED_IF
        assert f"only if the plates of the tie bar are at least {least / 1e3:g} m thick" in found.sentences[0]
        for s, governs in ((least, "punching"), (least - 1, "bending")):
            known = {**bar, "plate": {**plate, "thickness": s / 1e3, "gamma": 1.0}}
            mended = verified({**WALL, "ties": [known]}, ag=0.1)
            assert keys(mended) == ["anchored", "tie_limits"]
            ties = mended.to_dict()["directions"]["positive"]["ties"]
            assert ties["bar"]["strength_governs"] == governs

    def test_strength_is_said_to_be_unlimited_unless_it_is_given(self):
        for more, said in (
            ({}, True),
            ({"loads": [{**ROOF, "seat": None}]}, True),
            ({"crushing": {"strength": 1e6}}, False),
        ):
            assert (
                "compressive strength is taken as unlimited" in " ".join(verified({**WALL, **more}).sentences)
            ) == said

    def test_a_reading_of_sliding_floors_that_fails_is_a_condition_of_the_letter_that_passes(self):
        wall = {**WALL, "loads": [{**ROOF, "mass": 12000.0, "floor": "sliding"}]}
        letter = verified(wall, ag=0.15)
        (ours,) = [each.values["ratio"] for each in letter.conclusion.limits if each.key == "letter"]
        assert ours < letter.ratio
        for share, fails in ((0.99, False), (1.01, True)):
            found = verified(wall, ag=0.15 * ours * share)
            assert ("ours_fails" in keys(found)) == fails and found.ratio > 1
            assert found.conclusion.concluded is (Concluded.SATISFIED_IF if fails else Concluded.SATISFIED)
        assert "by our reading, capacity over demand is 0.9" in found.sentences[0]
        upgraded = rk.verify(of(wall), {**SITE, "ag": 0.15 * ours * 1.01, "intervention": "upgrading", "case": "c"})
        assert "ours_fails" not in keys(upgraded)

    def test_a_wall_between_floors_that_are_not_given_is_one_on_the_ground(self, tmp_path):
        wall = {"mechanism": "spanning_wall", "name": "w", "thickness": 0.5, "height": 3.0, "density": 1800.0}
        wall |= {"depth": 1.0, "hinge": "weakest", "overburden": 3e4, "friction": 0.8}
        found = verified(wall, ag=0.05)
        assert found.conclusion.concluded is Concluded.SATISFIED_IF and keys(found) == ["no_floor"]
        assert "only if the wall stands on the ground" in found.sentences[0]
        (tmp_path / "w.yaml").write_text(yaml.safe_dump(wall))
        (tmp_path / "s.yaml").write_text(yaml.safe_dump(SITE))
        for language, said in (("en", "stand on the ground"), ("it", "sul terreno")):
            shown = run("verify", str(tmp_path / "w.yaml"), "--site", str(tmp_path / "s.yaml"), "--language", language)
            assert said in shown.stdout and "--floor" not in shown.output
            assert ("is missing" in shown.output) == (language == "en")
            height = of(wall).extras(rk.Direction.POSITIVE)[0].value
            english, italian = f"hinge at {height:.4g} of the wall's height", f"cerniera a {height:.4g} dell'altezza"
            assert (english if language == "en" else italian.replace(".", ",")) in shown.stdout
        floor = {"z": 3.0, "H": 9.0, "T1": 0.4, "xi1": 0.1, "n": 3}
        assert "no_floor" not in keys(verified(wall, ag=0.05, floor=floor))
        assert keys(verified({**wall, "unusual": ["floor"]}, ag=0.05)) == []

    def test_the_straight_line_is_a_condition_where_it_changes_the_outcome(self):
        """Hand: S_De = a_g S g eta F0 TC T/(4 pi^2) between TC and TD, at 8 % of damping."""
        wall = {**WALL, "height": 9.0, "loads": [{**ROOF, "at": [-0.2, 8.5], "seat": 0.15}]}
        known = {"width": 0.3, "height": 0.3, "thickness": 0.02, "gamma": 1.0}
        masonry = {"thickness": 0.6, "compression": 5e6, "shear": 6e4, "gamma": 2.0, "source": "tests"}
        bar = {**BAR, "from": {"ground": [-12.3, 7.5]}, "gamma": 1.05, "plate": known, "wall": masonry}
        bar["elongation"] = 0.02
        wall, site = {**wall, "ties": [bar]}, {"FC": 1.35, "F0": 2.5, "TC": 0.4, "S": 1.2}
        side = rk.verify(of(wall), {**site, "ag": 0.2}).directions[rk.Direction.POSITIVE]
        d, a = side.states["SLV"].d, side.a0 * (1 - side.states["SLV"].d / side.d0)
        of_T = 1.2 * G * np.sqrt(10 / 13) * 2.5 * 0.4 / (4 * np.pi**2)
        ag = d / (of_T * 1.68 * np.pi * np.sqrt(d / a))  # zeta_E on the line is 1 here
        said = "on the straight line, which the code also allows, zeta_E is {:.3g} at SLV, which fails"
        for share, expected in ((0.99, []), (1.02, ["line_fails"])):
            found = rk.verify(of(wall), {**site, "ag": float(share * ag)})
            assert keys(found) == [*expected, "anchored"] and found.ratio > 1.05
        assert said.format(1 / 1.02) in found.sentences[0]
        for share, expected in ((1.02, []), (1.27, ["line_fails"])):  # zeta_E of 0.8 is enough
            upgraded = {"intervention": "upgrading", "case": "c", "ag": float(share * ag)}
            assert keys(rk.verify(of(wall), {**site, **upgraded})) == [*expected, "anchored"]


def structures():
    """The examples on the two sites in turn."""
    sites = cycle(["site", "ground"])
    for folder in ("", "verify", "walls", "masonry", "linkages"):
        for file in sorted((EXAMPLES / folder).glob("*.yaml")):
            if re.search("^mechanism:", file.read_text("utf-8"), re.MULTILINE):
                site = next(sites)
                yield pytest.param(file, site, id=f"{site}-{folder}-{file.stem}")


@pytest.mark.every(6)
@pytest.mark.parametrize(("file", "site"), [*structures()])
def test_no_headline_of_an_example_is_without_what_limits_it(file, site):
    """By the remarks themselves, in both languages; JSON has the same."""
    answer = rk.verify(file, EXAMPLES / "verify" / f"{site}.yaml")
    found, end = answer.result, answer.conclusion
    effects = set()
    for side in found.directions.values():
        for check in side.checks:
            every = [each for each in (*side.remarks, *found.remarks) if not isinstance(each, str)]
            effects |= {found.effects[each.key] for each in every if each.key in found.effects
                        and (each.states is None or check.state in each.states)}  # fmt: skip
    if end.concluded is Concluded.SATISFIED:
        assert effects <= {Effect.REPLACES}
    if not {Effect.CONDITION, Effect.UNDECIDED} & effects:
        assert end.concluded not in (Concluded.SATISFIED_IF, Concluded.NOT_DECIDED)
    for say in (Language("en", is_plain=True), Language("it")):
        said = " ".join(of_verification(found, say))
        assert all(limit_in_words(each, say) in said for each in end.limits)
    data = answer.to_dict()["conclusion"]["limits"]
    assert [(each["key"], each["effect"]) for each in data] == [(each.key, each.effect.value) for each in end.limits]
    assert all(each["text"] in answer.sentences[0] or each["text"] in " ".join(answer.sentences[:2]) for each in data)
    if end.limits:
        files = (yaml.safe_load(each.read_text("utf-8")) for each in (file, EXAMPLES / "verify" / f"{site}.yaml"))
        _, plain = mended(*files)
        assert {each.key for each in plain.limits} <= NO_FIELD.keys() and (plain.limits or plain.concluded in PLAIN)


def test_it_stands_on_every_surface(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wall = {**WALL, "rebound": 0.4, "loads": [{key: each for key, each in ROOF.items() if key != "seat"}]}
    (tmp_path / "wall.yaml").write_text(yaml.safe_dump(wall), "utf-8")
    (tmp_path / "site.yaml").write_text(yaml.safe_dump({**SITE, "ag": 0.1}), "utf-8")
    (tmp_path / "rows.csv").write_text("file,name\nwall.yaml,one\n", "utf-8")
    (limit,) = run_json("verify", "wall.yaml", "--site", "site.yaml")["conclusion"]["limits"]
    assert limit["effect"] == "condition" and "roof over" in limit["text"]
    first = run("survey", "rows.csv", "--site", "site.yaml").stdout
    assert first.startswith("0 of 1 structure satisfy the verification; 1 only on conditions.")
    (row,) = run_json("survey", "rows.csv", "--site", "site.yaml")["rows"]
    assert row["concluded"] == "satisfied_only_if" and limit["text"] in row["caution"]
    found = rk.design("wall.yaml", "width=0.4m:0.8m", "ratio >= 1", site="site.yaml", points=5)
    assert found.conclusion.concluded is Concluded.SATISFIED_IF
    assert "this holds only if each load without a `seat`" in found.sentences[0]
    run("verify", "wall.yaml", "--site", "site.yaml", "--sheet", "o.html", "--language", "it")
    page = (tmp_path / "o.html").read_text("utf-8")
    assert "La verifica è soddisfatta soltanto se ogni carico privo di" in re.sub(r"<[^>]*>", "", page)


def test_a_design_does_not_call_an_undecided_ratio_reached():
    """Up to a height the wall passes by displacement; where its period is long, nothing is decided."""
    found = rk.design(of({**WALL, "height": 16.0}), "width=0.4m:1m", "ratio >= 1", site={**SITE, "ag": 0.12}, points=5)
    assert found.holds and found.conclusion.concluded is Concluded.NOT_DECIDED
    assert "this is not decided: the period" in found.sentences[0]


# The verdict by another program, from printed numbers alone


def by_hand(data, structure):
    """What is concluded, from the numbers and conditions of JSON and the structure file."""
    words = []
    for side in data["directions"].values():
        for state, at in side["states"].items():
            if state not in side["required"]:
                continue
            onset = side["zeta"]["damage" if state == "SLV" else f"damage_{state}"]
            by_displacement = side["zeta"]["nonlinear" if state == "SLV" else f"nonlinear_{state}"]
            starts, reaches = onset < 1 - 1e-12, at["d"] / at["demand"] >= 1 - 1e-12
            moves = by_displacement >= onset
            far = False
            for tie in side.get("ties", {}).values():
                strain, longer = tie.get(f"strain_{state}"), tie[f"elongation_{state}"]
                far = far or (longer > 1e-6 if strain is None else strain > 0.02 * (1 + 1e-9))
            if moves and far:
                words.append("ok" if not starts else "open" if reaches else "fails")
            elif moves and at["T"] > 4:
                words.append("open")
            else:
                words.append("ok" if not starts or (moves and reaches) else "fails")
        if "SLD" in side["required"]:
            words.append("ok" if side["zeta"]["SLD"] >= 1 - 1e-12 else "fails")
    conditional = any(each["effect"] == "condition" for each in data["conclusion"]["limits"])
    if "fails" in words:
        return "not_satisfied"
    if "open" in words:
        return "not_decided"
    return "satisfied_only_if" if conditional else "satisfied"


def random_case(random):
    h = random.uniform(2, 18)
    wall = {**WALL, "height": h, "width": random.uniform(0.3, 0.9), "depth": 5.0}
    if random.random() < 0.4:
        del wall["one_sided"]
    loads = []
    if random.random() < 0.6:
        loads.append({"name": "roof", "mass": random.uniform(500, 9000), "at": [0.0, h]})
        if kind := random.choice(["borne", "sliding", "dragged", ""]):
            loads[0]["floor"] = str(kind)
        if random.random() < 0.7:
            loads[0]["seat"] = random.uniform(0.05, 0.4)
    if "one_sided" in wall and random.random() < 0.6:
        x, y = -wall["width"] / 2, 0.9 * h
        if random.random() < 0.3:
            loads.append({"name": "bar", "force": [-random.uniform(5e3, 8e4), 0.0], "at": [x, y]})
        else:
            steel = {"bars": 1, "diameter": random.uniform(0.008, 0.02), "steel": "S235"}
            held = steel if random.random() < 0.6 else {"stiffness": 0.0, "prestress": random.uniform(5e3, 8e4)}
            wall["ties"] = [
                {"name": "bar", "from": {"ground": [x - random.uniform(1, 60), y]}, "to": {"at": [x, y]}, **held}
            ]
    if loads:
        wall["loads"] = loads
    site = {**SITE, "ag": random.uniform(0.02, 0.3), "FC": float(random.choice([1.0, 1.2, 1.35]))}
    if random.random() < 0.5:
        site["SLC"] = {"ag": 1.3 * site["ag"], "F0": 2.45, "TC_star": 0.33}
    if random.random() < 0.5:
        site["SLD"] = {"ag": 0.3 * site["ag"], "F0": 2.4, "TC_star": 0.28}
    if random.random() < 0.5:
        site["states"] = [state for state in ("SLV", "SLC", "SLD") if state == "SLV" or state in site]
    return wall, site


@pytest.mark.every(10)
@pytest.mark.parametrize("part", range(10))
def test_the_verdict_of_another_program_from_the_printed_numbers(part):
    random, seen = np.random.default_rng(7300 + part), []
    while len(seen) < 20:
        wall, site = random_case(random)
        try:
            data = rk.verify(of(wall), site).to_dict()
        except InputError:  # held at any displacement
            continue
        seen.append(data["conclusion"]["concluded"])
        assert seen[-1] == by_hand(data, wall), (wall, site)
        for side in data["directions"].values():  # FC as it counts
            assert side["a0_star"] == pytest.approx(side["alpha0"] * G / (side["e_star"] * 1.35), rel=1e-9)
        bare = any("seat" not in load and "force" not in load for load in wall.get("loads", ()))
        moves = any(
            at["governs"] and at["governs"].startswith("nonlinear")
            for side in data["directions"].values() for at in side["states"].values()
        )  # fmt: skip
        limits = {each["key"] for each in data["conclusion"]["limits"]}
        if seen[-1] in ("satisfied", "satisfied_only_if"):
            assert ("seats" in limits) == (bare and moves)
    assert len(set(seen)) >= 3
