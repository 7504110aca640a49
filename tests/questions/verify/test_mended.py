"""What limits a conclusion is mended in its files, key by key: then the verification is satisfied, or not, plainly."""

from copy import deepcopy
from math import pi, sqrt

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.codes.italian import remarks
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.verification.check import EFFECTS as OF_EVERY_CODE

PLAIN = (Concluded.SATISFIED, Concluded.NOT_SATISFIED)
SITE = {"FC": 1.35, "soil": "C", "ag": 0.1, "F0": 2.42, "TC_star": 0.31}
OWN_SPECTRUM = {"FC": 1.35, "spectrum": [[0.0, 0.15], [0.5, 0.4], [1.0, 0.1], [2.0, 0.02], [8.0, 0.002]]}
WALL = {"mechanism": "block", "name": "wall", "width": 0.6, "height": 8.0, "depth": 5.0, "density": 1800.0}
WALL |= {"one_sided": "positive"}
SHORT = {**WALL, "width": 0.5, "height": 2.2}
ROOF = {"name": "roof", "mass": 6000.0, "at": [0.0, 8.0], "floor": "borne"}
FORCE = {"name": "bar", "force": [-1.1e5, 0.0], "at": [-0.3, 7.5]}
TIE = {"name": "bar", "from": {"ground": [-60.0, 7.5]}, "to": {"at": [-0.3, 7.5]}}
PULLS = {**TIE, "stiffness": 0.0, "prestress": 5e4}
ANCHORED = {"plate": {"width": 0.5, "height": 0.5}, "wall": {"thickness": 0.6, "compression": 3e6, "shear": 3e5}}
HOLDS = {**TIE, **deepcopy(ANCHORED), "bars": 1, "diameter": 0.014, "steel": "S235", "gamma": 1.05, "elongation": 0.5}
HOLDS["wall"] |= {"gamma": 2.0, "source": "a test"}
WEAKLY = {**HOLDS, "elongation": None, "wall": {**HOLDS["wall"], "shear": 1e5}, "diameter": 0.04}
WEAKLY["plate"] = {**HOLDS["plate"], "thickness": 0.1, "gamma": 1.05}
BETWEEN = {"mechanism": "spanning_wall", "name": "w", "thickness": 0.3, "height": 3.0, "density": 1800.0, "depth": 1.0}
BETWEEN |= {"hinge": "weakest", "overburden": 2e4, "unusual": ["floor"]}
FLOOR = {"z": 0.3, "H": 9.0, "T1": 0.4, "xi1": 0.1, "n": 3}
FRAME = {"mechanism": "symmetric_frame", "name": "f", "column_width": 0.8, "column_height": 3.0, "columns": 2}
FRAME |= {"mass_ratio": 1.0, "restitution": 0.8}
WEAK = [f"sine:0.0{k}g:0.5s" for k in range(1, 8)]


def entries(structure, names, *lists):
    return [each for part in lists for each in structure.get(part, []) if each["name"] in names]


def to_steel(structure, names):
    """Forces and ties of unknown strength become bars of steel that yields at the same force."""
    for each in entries(structure, names, "loads"):
        structure["loads"].remove(each)
        x, y = each["at"]
        to = {"at": [x, y], **({"body": each["body"]} if "body" in each else {})}
        tie = {"name": each["name"], "from": {"ground": [x - 60.0, y]}, "to": to}
        structure.setdefault("ties", []).append({**tie, "prestress": -force(each["force"][0])})
    for tie in entries(structure, names, "ties"):
        N = force(tie.pop("prestress", 1e5))
        for key in ("stiffness", "area", "modulus"):
            tie.pop(key, None)
        tie.update({"bars": 1, "diameter": sqrt(4 * N / (pi * 235e6)), "yield": 235e6, "source": "a test"})


def force(given):
    return rk.units.read(given, "N") if isinstance(given, str) else given


def mend_seats(structure, site, values):
    for each in values["seats"]:
        for load in entries(structure, [each.values["name"]], "loads"):
            load["seat"] = 1.001 * each.values["length"]


def mend_letter(structure, site, values):
    for load in structure["loads"]:
        if "mass" in load:
            load["floor"] = "borne"


def mend_structure(structure, site, values):
    words = values["text"]
    assert [each in words for each in ("`plane: width`", "`hinge: weakest`", "Give `friction`")].count(True) == 1
    structure.update({"plane": "width"} if "`plane" in words else {"hinge": "weakest"} if "hinge" in words else {})
    if "Give `friction`" in words:
        structure["support"] = 0.0


def anchor(structure, site, values):
    for tie in entries(structure, [values["name"]], "ties"):
        tie.update(deepcopy(ANCHORED))


def factor(structure, site, values):
    for tie in entries(structure, values["names"], "ties"):
        for part in (tie, tie.get("wall", {}), tie.get("plate", {})):
            part["gamma"] = 1.0


def state_sources(structure, site, values):
    for tie in entries(structure, values["names"], "ties"):
        for part in (tie, tie.get("wall", {})):
            part["source"] = "a test"


def strengthen_anchorage(structure, site, values):
    """Thicker plates on stronger masonry, with which the bars yield first."""
    for tie in entries(structure, [values["name"]], "ties"):
        tie["plate"]["thickness"] = 0.2
        tie["wall"].update({"shear": 1e6, "compression": 2e7})


def lengthen(structure, site, values):
    for each in values["ties"]:
        for tie in entries(structure, [each.values["name"]], "ties"):
            tie["elongation"] = each.values["needed"]


def thicken(structure, site, values):
    for tie in entries(structure, [values["name"]], "ties"):
        tie["plate"]["thickness"] = values["least"]


def mend_mid_height(structure, site, values):
    """Without a load on top the weakest hinge is that of a wall that turns about its foot."""
    structure.update({"mechanism": "spanning_wall", "hinge": "weakest", "friction": 0.8, "overburden": 3e4})
    structure.update({"density": 1800.0, "depth": 1.0})


def hold_friction(structure, site, values):
    structure.update({"friction": 1.01 * values["needed"], "unusual": ["friction"]})


def own_spectrum(structure, site, values):
    site.clear()
    site.update(OWN_SPECTRUM)


MENDS = {
    "confidence": lambda structure, site, values: site.update({"FC_without_strength": True}),
    "letter": mend_letter,
    "onset_alone": lambda structure, site, values: to_steel(structure, values["names"]),
    "unsupported": lambda structure, site, values: to_steel(structure, values["names"]),
    "seats": mend_seats,
    "factors": factor,
    "sources": state_sources,
    "strength_alone": anchor,
    "plate_alone": thicken,
    "anchored": strengthen_anchorage,
    "stronger_without": lengthen,
    "tie_limits": lengthen,
    "carries": lambda structure, site, values: to_steel(structure, [values["name"]]),
    "wide": lambda structure, site, values: structure["ties"][0].update({"elongation": 0.001}),
    "one_mode": own_spectrum,  # of the floor, with all modes of the building
    "low_floor": lambda structure, site, values: site.pop("floor", None),
    "same_mode": lambda structure, site, values: site["floor"].update({"SLD": {"T1": 0.3, "xi1": 0.05}}),
    "structure": mend_structure,
    "mid_height": mend_mid_height,
    "unchecked": lambda structure, site, values: structure.update({"spacing": 6.0, "beam_depth": 0.5}),
    "glued": hold_friction,
    "unusual": lambda structure, site, values: structure.setdefault("unusual", []).append(values["what"]),
    "no_floor": lambda structure, site, values: structure.update({"unusual": ["floor"]}),
    "long": own_spectrum,
}  # fmt: skip
TOGETHER = {"letter", "seats", "factors", "sources"}
"""What can be mended with something else at once: none of them changes what another one mends."""
NO_FIELD = {
    "own_formula": "a mechanism whose own lambda differs from its statics: its author mends it",
    "carried": "weights among the fields of a mechanism that move sideways with less than their mass: of plugins",
    "line_fails": "a reading of the code, which allows the exact curve and the straight line",
    "joint": "nothing in an assembly holds one of its joints closed",
    "below_target": "records: others, or a larger factor, are to be chosen",
    "ours_fails": "a reading of the code, which its letter does not follow",
    "bonded": "no friction is sufficient, so that the other mechanism is the one to describe",
}
"""Why no field of a file mends what a remark says."""
ELSEWHERE = {
    "confidence": (SHORT, {**SITE, "FC": 1.0}),
    "onset_alone": ({**WALL, "loads": [FORCE]}, SITE),
    "carries": ({**WALL, "loads": [{**ROOF, "seat": 0.3}], "ties": [PULLS]}, {**SITE, "ag": 0.05}),
    "strength_alone": ({**WALL, "ties": [{**TIE, "bars": 1, "diameter": 0.024, "steel": "S235"}]}, SITE),
    "plate_alone": ({**WALL, "ties": [HOLDS]}, SITE),
    "anchored": ({**WALL, "ties": [WEAKLY]}, SITE),
    "no_floor": ({**BETWEEN, "friction": 0.8, "unusual": None}, {**SITE, "ag": 0.05}),
    "wide": ({**WALL, "ties": [HOLDS]}, SITE),
    "one_mode": (SHORT, {**SITE, "floor": FLOOR}),
    "low_floor": (SHORT, {**SITE, "floor": {**FLOOR, "SLD": {"T1": 0.3, "xi1": 0.05}}}),
    "same_mode": (SHORT, {**SITE, "ag": 0.05, "floor": {**FLOOR, "z": 3.0}}),
    "structure": ({**SHORT, "one_sided": None, "depth": 0.4, "unusual": ["width"]}, SITE),
    "structure of a hinge": ({**BETWEEN, "hinge": 0.5, "friction": 0.8}, {**SITE, "ag": 0.05}),
    "unchecked": (FRAME, SITE),
}  # fmt: skip
"""What no example has, by the key of a remark."""


def verified(structure, site, motions):
    parsed = parse_structure(yaml.safe_dump(structure), "s.yaml", "test", Registry())
    return rk.verify(parsed, site, motions=motions) if motions else rk.verify(parsed, site)


def mended(structure, site, key="", motions=()):
    """The keys that limited the conclusion until each was mended, in order, and the last conclusion."""
    structure, site, seen = deepcopy(structure), deepcopy(site), []
    while limits := (conclusion := verified(structure, site, motions).conclusion).limits:
        can = [each for each in limits if each.key not in NO_FIELD]
        if not can:
            break
        first = next((each for each in can if each.key == key), can[0])
        assert len(seen) < 20, (first, structure)
        for limit in [first, *(each for each in can if each is not first and each.key in TOGETHER)]:
            seen.append(limit.key)
            MENDS[limit.key](structure, site, limit.values)
    return seen, conclusion


def test_each_remark_can_be_mended_or_says_why_not():
    assert {*MENDS, *NO_FIELD} == {*remarks.EFFECTS, *OF_EVERY_CODE} and not MENDS.keys() & NO_FIELD.keys()


@pytest.mark.parametrize("key", ELSEWHERE)
def test_files_with_each_condition_mended_are_satisfied_plainly(key):
    structure, site = ELSEWHERE[key]
    key = key.partition(" ")[0]
    seen, end = mended(structure, site, key, WEAK if key == "unchecked" else ())
    weak = ["below_target"] * (key == "unchecked")  # the motions that uplift no frame
    assert seen[0] == key and [each.key for each in end.limits] == weak
    assert end.concluded is (Concluded.SATISFIED_IF if weak else Concluded.SATISFIED)
