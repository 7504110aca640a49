"""Linkages from files: the textbook shapes rebuilt, what has no motion, and which joint is to blame."""

from math import pi, sqrt
from typing import ClassVar

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction, Guide, LinkageMotion, NoMotion, Pin, equivalent_block
from rocking_cli.errors import InputError


def rectangle(x0, y0, x1, y1):
    return {"polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}


def point(z):
    return [z.real, z.imag]


def numbers(body):
    return {"mass": body.mass, "centroid": point(body.centroid), "inertia": body.inertia}


def alike(one, other, digits=1e-10):
    """I, J, G, B over the whole motion, lambda, phi_cr, eta and the equivalent block of both directions."""
    for s in Direction:
        phi = np.linspace(0, 1.2 * other.critical_rotation(s), 41)
        a, b = one.coefficients(phi, s), other.coefficients(phi, s)
        for key in "IJGB":
            size = np.abs(b.I if key == "J" else getattr(b, key)).max()
            assert np.abs(getattr(a, key) - getattr(b, key)).max() <= digits * size, key
        assert one.uplift(s) == pytest.approx(other.uplift(s), rel=digits)
        assert one.critical_rotation(s) == pytest.approx(other.critical_rotation(s), rel=digits)
        assert one.restitution_from_kinematics(s) == pytest.approx(other.restitution_from_kinematics(s), rel=digits)
    mine, theirs = equivalent_block(one), equivalent_block(other)
    for s in Direction:
        assert mine[s].p == pytest.approx(theirs[s].p, rel=digits)


class TestRebuilt:
    def test_a_block(self):
        block = rk.Block(width=0.7, height=2.8, density=1800.0, depth=1.0)
        side = {"lead": "b", "joints": {"A": {"pivot": "b", "at": [0.35, 0.0]}}}
        alike(rk.Linkage(bodies={"b": rectangle(-0.35, 0, 0.35, 2.8)}, positive=side, density=1800.0, depth=1.0), block)

    def test_a_spanning_wall_with_its_floor(self):
        wall = rk.SpanningWall(
            thickness=0.3, height=3.0, hinge=0.6, overburden=3e4, density=1800.0, depth=1.0, overburden_inertia=0.5
        )
        bodies = {"lower block": rectangle(-0.15, 0, 0.15, 1.8), "upper block": rectangle(-0.15, 1.8, 0.15, 3.0)}
        joints = {
            "A": {"pivot": "lower block", "at": [0.15, 0.0]},
            "B": {"hinge": ["upper block", "lower block"], "at": [-0.15, 1.8]},
            "C": {"slide": "upper block", "at": [0.0, 3.0], "along": [0.0, 2.0]},
        }
        floor = {
            "name": "floor", "mass": 3e4 / 9.80665, "at": [0.0, 3.0], "body": "upper block", "horizontal": 0.0,
            "vertical": 0.5,
        }  # fmt: skip
        side = {"lead": "lower block", "joints": joints}
        alike(rk.Linkage(bodies=bodies, positive=side, density=1800.0, depth=1.0, loads=[floor]), wall)

    def test_an_asymmetric_frame(self):
        frame = rk.AsymmetricFrame(
            column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0
        )
        left, beam, right = frame.bodies()
        sides = {}
        for s in Direction:
            a, b, c, d = (point(z) for z in frame.hinges(s))
            joints = {
                "A": {"pivot": "left", "at": a},
                "B": {"hinge": ["left", "beam"], "at": b},
                "C": {"hinge": ["right", "beam"], "at": c},
                "D": {"pivot": "right", "at": d},
            }
            sides[s.label] = {"lead": "left", "joints": joints}
        shapes = {
            name: {"polygon": [point(z) for z in body.outline]}
            for name, body in (("left", left), ("beam", beam), ("right", right))
        }
        alike(rk.Linkage(bodies=shapes, density=2400.0, depth=1.0, **sides), frame)

    def test_an_arch_of_given_numbers_and_of_polygons(self):
        arch = rk.Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7, density=2400.0, depth=1.0)
        names = [body.name for body in arch.bodies()]
        sides = {}
        for s in Direction:
            link = {}
            for joint in arch.joints(s):
                kind = "pivot" if len(joint.bodies) == 1 else "hinge"
                link[joint.letter] = {
                    kind: joint.bodies[0] if kind == "pivot" else list(joint.bodies), "at": point(joint.point)
                }  # fmt: skip
            phi = np.array([0.01])
            together = {}
            for name, motion in zip(names, arch.motion(phi, s), strict=True):
                together.setdefault(round(float(motion.psi[0]), 12), []).append(name)
            for group in together.values():
                for other in group[1:]:
                    link[f"{group[0]} {other}"] = {"fixed": [group[0], other]}
            lead = next(joint.bodies[0] for joint in arch.joints(s) if joint.letter.startswith("A"))
            sides[s.label] = {"lead": lead, "joints": link}
        scale = arch.total_mass() / sum(body.mass for body in arch.bodies())
        exact = {
            body.name: {"mass": scale * body.mass, "centroid": point(body.centroid), "inertia": scale * body.inertia}
            for body in arch.bodies()
        }
        alike(rk.Linkage(bodies=exact, **sides), arch)

    def test_equal_columns_under_a_beam_have_an_equation_too_many(self):
        frame = rk.SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=2.0)
        bodies, joints = {}, {}
        for k, x in enumerate((0.0, 4.0, 8.0)):
            bodies[f"c{k}"] = rectangle(x - 0.5, 0, x + 0.5, 6.0)
            joints[f"A{k}"] = {"pivot": f"c{k}", "at": [x + 0.5, 0.0]}
            joints[f"B{k}"] = {"hinge": [f"c{k}", "beam"], "at": [x - 0.5, 6.0]}
        bodies["beam"] = rectangle(-0.5, 6.0, 8.5, 6.0 + 36 / 9)
        found = rk.Linkage(bodies=bodies, positive={"lead": "c0", "joints": joints})
        for s in Direction:
            assert found.uplift(s) == pytest.approx(frame.uplift(s), rel=1e-10)
            assert found.critical_rotation(s) == pytest.approx(frame.critical_rotation(s), rel=1e-10)
            assert found.limit(s) == pytest.approx(pi / 2)

    def test_an_image_has_the_same_mass_inertia_and_centroid(self):
        """Two columns under a beam: only with columns alike are they images of each other."""
        column = {"mass": 1000.0, "inertia": 3000.0}
        joints = {
            "A": {"pivot": "left", "at": [0.5, 0.0]}, "B": {"hinge": ["left", "beam"], "at": [-0.5, 6.0]},
            "C": {"hinge": ["right", "beam"], "at": [7.5, 6.0]}, "D": {"pivot": "right", "at": [8.5, 0.0]},
        }  # fmt: skip

        def frame(**other):
            bodies = {
                "left": {**column, "centroid": [0.0, 3.0]},
                "right": {**column, "centroid": [8.0, 3.0], **other},
                "beam": {"mass": 5000.0, "centroid": [4.0, 6.5], "inertia": 9000.0},
            }
            return rk.Linkage(bodies=bodies, positive={"lead": "left", "joints": joints})

        made = frame()
        assert made.uplift(Direction.POSITIVE) == pytest.approx(made.uplift(Direction.NEGATIVE), rel=1e-12)
        for other in ({"mass": 2000.0}, {"inertia": 4000.0}, {"centroid": [8.1, 3.0]}):
            with pytest.raises((InputError, ValueError), match="has no mirror image among the bodies"):
                frame(**other)

    @pytest.mark.parametrize("order", [["lower", "upper"], ["upper", "lower"]])
    def test_a_hinge_may_name_its_bodies_in_either_order(self, order):
        """The upper half of a wall bears on the lower one, with its own weight as it stands."""
        bodies = {"lower": rectangle(0, 0, 0.3, 1.5), "upper": rectangle(0, 1.5, 0.3, 3)}
        joints = {
            "A": {"pivot": "lower", "at": [0.3, 0]}, "B": {"hinge": order, "at": [0, 1.5]},
            "C": {"slide": "upper", "at": [0.3, 3], "along": [0, 1]},
        }  # fmt: skip
        wall = rk.Linkage(bodies=bodies, density=1800.0, depth=1.0, positive={"lead": "lower", "joints": joints})
        (joint,) = (each for each in wall.joints(Direction.POSITIVE) if each.letter == "B")
        assert joint.bodies == ("lower", "upper") and joint.normal == pytest.approx(1j)
        assert joint.face in ("lower", "upper")
        (contact,) = (each for each in wall.contacts(Direction.POSITIVE) if set(each.pieces) == {"lower", "upper"})
        assert contact.pieces == ("lower", "upper") and contact.normal == pytest.approx(1j)


class TestCracks:
    WALL: ClassVar = rectangle(-0.15, 0, 0.15, 3.0)
    SIDE: ClassVar = {
        "lead": "wall below K",
        "joints": {
            "A": {"pivot": "wall", "at": [0.15, 0.0]},
            "B": {"hinge": ["wall below K", "wall above K"], "at": "K left"},
            "C": {"slide": "wall", "at": [0.0, 3.0], "along": [0.0, 1.0]},
        },
    }

    def cracked(self, load, **more):
        crack = {"K": {"body": "wall", "along": [[0.0, 0.3], [0.0, 2.9]]}}
        floor = {"name": "floor", "mass": load / 9.80665, "at": [0.0, 3.0], "body": "wall", "horizontal": 0.0}
        return rk.Linkage(
            bodies={"wall": self.WALL}, cracks=crack, density=1800.0, depth=1.0, loads=[{**floor, **more}],
            positive=self.SIDE,
        )  # fmt: skip

    def test_the_weakest_height_of_a_spanning_wall(self):
        """xi = 1/(1 + sqrt(rho k/(1 + rho))), rho = 1, k = 1/2: 9 t/h at 2/3, the same in both directions."""
        weight = 1800 * 0.9 * 9.80665
        found = self.cracked(weight)
        assert found.uplift(Direction.POSITIVE) == pytest.approx(0.9, rel=1e-12)
        assert found.extras(Direction.POSITIVE)[0].value == pytest.approx(2.0, rel=1e-6)
        assert [body.name for body in found.bodies()] == ["wall 1", "wall 2"]
        same = rk.SpanningWall(thickness=0.3, height=3.0, hinge=2 / 3, overburden=weight, density=1800.0, depth=1.0)
        alike(found, same, 1e-5)

    def test_other_heights_in_the_two_directions(self):
        weight = 1800 * 0.9 * 9.80665
        found = self.cracked(weight, at=[0.05, 3.0])
        wall = rk.SpanningWall(
            thickness=0.3, height=3.0, hinge="weakest", overburden=weight, overburden_eccentricity=0.05, support=0.0,
            density=1800.0, depth=1.0,
        )  # fmt: skip
        for s in Direction:
            assert found.uplift(s) == pytest.approx(wall.uplift(s), rel=1e-10)
            assert found.extras(s)[0].value == pytest.approx(3 * wall.extras(s)[0].value, rel=1e-5)
        assert len(found.bodies()) == 3
        assert found.restitution_from_kinematics(Direction.POSITIVE) == pytest.approx(
            wall.restitution_from_kinematics(Direction.POSITIVE), rel=1e-4
        )

    @pytest.mark.rest
    def test_two_cracks_by_brute_force(self):
        """A wall whose foot part rests: no pair of heights on a grid gives less."""
        side = {
            "lead": "wall between",
            "joints": {
                "A": {"hinge": ["wall below K", "wall above K"], "at": "K right"},
                "B": {"hinge": ["wall below M", "wall above M"], "at": "M left"},
                "C": {"slide": "wall above M", "at": [0.0, 3.0], "along": [0.0, 1.0]},
                "F": {"fixed": ["wall below K", "ground"]},
            },
        }
        side["lead"] = "wall above K"
        cracks = {
            "K": {"body": "wall", "along": [[0, 0.1], [0, 1.2]]},
            "M": {"body": "wall", "along": [[0, 1.4], [0, 2.8]]},
        }
        floor = {"name": "f", "mass": 3000.0, "at": [0.0, 3.0], "body": "wall", "horizontal": 0.0}
        given = {"density": 1800.0, "depth": 1.0, "one_sided": "positive", "rebound": 0.5, "negative": "none"}
        found = rk.Linkage(bodies={"wall": self.WALL}, cracks=cracks, positive=side, loads=[floor], **given)

        def at(low, high):
            parts = {"a": rectangle(-0.15, 0, 0.15, low), "b": rectangle(-0.15, low, 0.15, high)}
            parts["c"] = rectangle(-0.15, high, 0.15, 3.0)
            joints = {
                "A": {"hinge": ["a", "b"], "at": [0.15, low]},
                "B": {"hinge": ["b", "c"], "at": [-0.15, high]},
                "C": {"slide": "c", "at": [0.0, 3.0], "along": [0.0, 1.0]},
                "F": {"fixed": ["a", "ground"]},
            }
            top = {**floor, "body": "c"}
            one = rk.Linkage(bodies=parts, positive={"lead": "b", "joints": joints}, loads=[top], **given)
            return one.uplift(Direction.POSITIVE)

        grid = [at(low, high) for low in np.linspace(0.1001, 1.1999, 7) for high in np.linspace(1.41, 2.79, 15)]
        least = found.uplift(Direction.POSITIVE)
        assert least <= min(grid) * (1 + 1e-9) and least > 0.97 * min(grid)
        places = {extra.key: extra.value for extra in found.extras(Direction.POSITIVE)}
        assert least == pytest.approx(at(places["crack_K"], places["crack_M"]), rel=1e-9)
        assert "at the end of its line" in found.extras(Direction.POSITIVE)[0].meaning

    def test_a_crack_that_no_joint_speaks_of_is_closed(self):
        cracks = {name: {"body": "wall", "along": [[0.0, 0.3], [0.0, 2.9]]} for name in ("K", "M")}
        found = rk.Linkage(bodies={"wall": self.WALL}, cracks=cracks, positive=self.SIDE)
        assert [body.name for body in found.bodies()] == ["wall 1", "wall 2"]
        assert [extra.key for extra in found.extras(Direction.POSITIVE)] == ["crack_K"]

    @pytest.mark.parametrize(
        ("change", "said"),
        [
            ({"body": "roof"}, "there is no body 'roof'"),
            ({"along": [[0.0, 1.0], [0.1, 1.0]]}, "both ends have the same height"),
            ({"along": [[0.0, -2.0], [0.0, -1.0]]}, "does not cut wall in two"),
            ({"cut": "vertical", "along": [[-0.1, 1.0], [0.1, 1.0]]}, "is a point"),
        ],
    )
    def test_what_cannot_be_cut(self, change, said):
        crack = {"K": {"body": "wall", "along": [[0.0, 0.3], [0.0, 2.9]], **change}}
        with pytest.raises(InputError, match=said):
            rk.Linkage(
                bodies={"wall": self.WALL}, cracks=crack, positive=self.SIDE, negative="none", one_sided="positive",
                rebound=0.1,
            )  # fmt: skip


class TestMotion:
    def test_a_slide_on_a_line_that_turns(self):
        """A block hung in a slotted crank: its pin stays on the crank's line, the tangent is atan of the geometry."""
        turn = LinkageMotion(
            {"crank": 1j, "rod": 2.0 + 1j},
            [Pin("A", ("crank",), 0j), Pin("B", ("rod",), 3.0 + 0j), Guide("C", ("rod", "crank"), 1.0 + 1j, 1.0 + 1j)],
            "crank", Direction.POSITIVE,
        )  # fmt: skip
        phi = np.linspace(0, 0.3, 9)
        z = turn.motions(phi)["rod"].carry(1.0 + 1j)[0]
        assert np.abs(z - 3.0) == pytest.approx(sqrt(5.0), rel=1e-12)
        assert np.angle(z) == pytest.approx(pi / 4 - phi, rel=1e-12)
        self._derivatives(turn)

    def test_a_beam_that_no_hinge_holds_to_the_ground(self):
        """A ladder between wall and floor, both smooth: its ends stay on them."""
        ladder = LinkageMotion(
            {"ladder": 1.0 + 1.5j}, [Guide("foot", ("ladder",), 2 + 0j, 1 + 0j), Guide("top", ("ladder",), 3j, 1j)],
            "ladder", Direction.NEGATIVE,
        )  # fmt: skip
        phi = np.linspace(0, 0.5, 11)
        moved = ladder.motions(phi)["ladder"]
        start = np.arctan2(3.0, 2.0)
        assert moved.carry(2 + 0j)[0] == pytest.approx(sqrt(13) * np.cos(start - phi) + 0j, abs=1e-12)
        assert moved.carry(3j)[0] == pytest.approx(1j * sqrt(13) * np.sin(start - phi), abs=1e-12)
        self._derivatives(ladder)

    def _derivatives(self, linkage, step=5e-4):
        phi = np.linspace(0.05, 0.25, 5)
        by = [linkage.motions(phi + k * step) for k in (-2, -1, 0, 1, 2)]
        for name in by[0]:
            for z in (0j, 1 + 1j):
                values = [each[name].carry(z) for each in by]
                for k in (0, 1):
                    slope = (values[0][k] - 8 * values[1][k] + 8 * values[3][k] - values[4][k]) / (12 * step)
                    assert slope == pytest.approx(values[2][k + 1], abs=1e-8, rel=1e-8)

    def test_a_lock_ends_it(self):
        """Crank of 1, rod of 1 to a point held at height 0 on x <= -1.8...: straight at acos(.9)."""
        rod = 1.0 * np.exp(-1j * np.arccos(0.9))
        linkage = LinkageMotion(
            {"crank": rod / 2, "rod": rod * 0.7},
            [Pin("A", ("crank",), 0j), Pin("B", ("crank", "rod"), rod), Guide("C", ("rod",), 1.8 + 0j, 1 + 0j)],
            "crank", Direction.NEGATIVE,
        )  # fmt: skip
        # The crank goes up through the line of both, where the slide turns back but nothing locks; the rod never does.
        assert linkage.limit == pytest.approx(pi / 2)
        driven = LinkageMotion(
            {"crank": rod / 2, "rod": rod * 0.7},
            [Pin("A", ("crank",), 0j), Pin("B", ("crank", "rod"), rod), Guide("C", ("rod",), 1.8 + 0j, 1j)],
            "crank", Direction.NEGATIVE,
        )  # fmt: skip
        # C on the upright at 1.8: the rod lies level when the crank's end is at x = .8.
        assert driven.limit == pytest.approx(np.arccos(0.8) + np.arccos(0.9), rel=1e-8)

    def test_it_may_be_told_to_end(self):
        side = {"lead": "b", "limit_deg": 20.0, "joints": {"A": {"pivot": "b", "at": [0.5, 0.0]}}}
        assert rk.Linkage(bodies={"b": rectangle(-0.5, 0, 0.5, 2)}, positive=side).limit(Direction.POSITIVE) == (
            pytest.approx(pi / 9)
        )


class TestNoMotion:
    def test_three_hinges_in_line(self):
        joints = [Pin("A", ("l",), 0j), Pin("B", ("l", "u"), 1 + 0j), Pin("C", ("u",), 2 + 0j)]
        with pytest.raises(NoMotion, match="the joints allow only an infinitesimal rotation"):
            LinkageMotion({"l": 0.5 + 0j, "u": 1.5 + 0j}, joints, "l", Direction.POSITIVE)

    def test_two_slides_at_one_height(self):
        joints = [Guide("A", ("b",), 0j, 1 + 0j), Guide("B", ("b",), 1 + 0j, 1 + 0j), Guide("C", ("b",), 1j, 1 + 0j)]
        with pytest.raises(NoMotion):
            LinkageMotion({"b": 0.5 + 0.5j}, joints[:2], "b", Direction.POSITIVE)
        # Three level lines: it goes along them, and turns not.
        with pytest.raises(NoMotion, match="b cannot lead, because it does not rotate"):
            LinkageMotion({"b": 0.5 + 0.5j}, joints, "b", Direction.POSITIVE)

    def test_what_is_loose_is_named(self):
        joints = [Pin("A", ("l",), 0j), Pin("B", ("l", "u"), 1j)]
        with pytest.raises(NoMotion, match="with l held still, u can still move"):
            LinkageMotion({"l": 0.5j, "u": 1.5j}, joints, "l", Direction.POSITIVE)
        with pytest.raises(NoMotion, match="no joint holds u: if it stays at rest, fix it to the ground"):
            LinkageMotion({"l": 0.5j, "u": 1.5j}, joints[:1], "l", Direction.POSITIVE)
        LinkageMotion({"l": 0.5j, "u": 1.5j}, joints[:1], "l", Direction.POSITIVE, ground=["u"])

    def test_the_joint_too_many_is_named(self):
        joints = [Pin("A", ("l",), 0j), Pin("B", ("l", "u"), 1j), Pin("C", ("u",), 1 + 0j)]
        with pytest.raises(NoMotion, match="nothing can move: without one of A, B, C it could") as found:
            LinkageMotion({"l": 0.5j, "u": 0.5 + 0.5j}, joints, "l", Direction.POSITIVE)
        assert found.value.joint == "C"


GOOD = """mechanism: linkage
density: 1800
depth: 1.0
bodies:
  lower: {polygon: [[0, 0], [0.3, 0], [0.3, 1.5], [0, 1.5]]}
  upper: {polygon: [[0, 1.5], [0.3, 1.5], [0.3, 3], [0, 3]]}
positive:
  lead: lower
  joints:
    A: {pivot: lower, at: [0.3, 0]}
    B: {hinge: [lower, upper], at: [0, 1.5]}
    C: {slide: upper, at: [0.3, 3], along: [0, 1]}
negative: mirror
"""
WRONG = [
    # what is changed, into what, line, what is said
    ("pivot: lower, at: [0.3, 0]", "pivot: lower, at: [0, 0]", 10, "A closes: there lower and the ground"),
    ("at: [0, 1.5]}", "at: [0.3, 1.5]}", 11, "B closes: there lower and upper would go into one another"),
    ("at: [0, 1.5]}", "at: [0, 15]}", 11, "[0, 15] is 13.5 m outside lower: a joint must lie on the bodies it joins"),
    ("lead: lower", "lead: middle", 8, "there is no body 'middle'; the bodies are lower, upper"),
    ("[lower, upper]", "[lower, uper]", 11, "there is no body 'uper'"),
    ("[lower, upper]", "[lower, lower]", 11, "joins lower to itself"),
    ("pivot: lower", "pivot: lower, hinge: [lower, upper]", 10, "give one of pivot, hinge, slide and fixed"),
    (", along: [0, 1]", "", 12, "is missing: a slide needs it"),
    (", along: [0, 1]", ", along: [0, 0]", 12, "is not a valid direction"),
    ("    C: {slide: upper, at: [0.3, 3], along: [0, 1]}\n", "", 8, "with lower held still, upper can still move"),
    ("slide: upper, at: [0.3, 3], along: [0, 1]", "pivot: upper, at: [0.3, 3]", 12, "nothing can move: without one of"),
    ("lead: lower", "lead: upper", 8, "upper turns the wrong way: let another body lead"),
    ("negative: mirror", "negative: none", 13, "give one_sided: positive"),
    ("[0.3, 3], [0, 3]]", "[0, 3], [0.3, 3]]", 6, "its sides cross"),
    ("depth: 1.0\n", "", None, "depth is missing: density needs the size out of plane"),
    ("[0.3, 3], [0, 3]]}", "[0.4, 3], [0, 3]]}", 13, "has no mirror image"),
    ("upper: {polygon", "ground: {polygon", 6, "is what joints call the ground"),
]


class TestFiles:
    @pytest.mark.parametrize(("old", "new", "line", "said"), WRONG, ids=[each[3][:40] for each in WRONG])
    def test_what_is_wrong_has_its_place(self, old, new, line, said, tmp_path):
        assert old in GOOD
        (tmp_path / "s.yaml").write_text(GOOD.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(InputError) as found:
            rk.load_structure(tmp_path / "s.yaml")
        assert said in str(found.value)
        if line is not None:
            assert f"s.yaml:{line}" in str(found.value)

    def test_one_direction_only(self, tmp_path):
        text = GOOD.replace("negative: mirror", "negative: none\none_sided: positive\nrebound: 0.4")
        (tmp_path / "s.yaml").write_text(text, encoding="utf-8")
        found = rk.load_structure(tmp_path / "s.yaml")
        assert found.directions == [Direction.POSITIVE]
        assert found.uplift(Direction.POSITIVE) == pytest.approx(0.4, rel=1e-12)
        answer = rk.respond(found, rk.GroundMotion("r", 0.01, 4.5 * np.sin(np.linspace(0, 6, 40)), unit="m/s2"))
        assert 0 < answer["nonlinear"].peak_ratio < 1


class TestGivenFaces:
    SLOPE: ClassVar = {"polygon": [[0.0, 0.0], [1.0, 0.2], [1.0, 3.0], [0.0, 3.0]]}

    def made(self, **more):
        joints = {
            "A": {"pivot": "low", "at": [1.0, 0.2], **more},
            "closed": {"fixed": ["low", "high"], "friction": 0.3},
        }
        bodies = {"low": self.SLOPE, "high": rectangle(0.0, 3.0, 1.0, 4.0)}
        side = {"lead": "low", "joints": joints}
        return rk.Linkage(bodies=bodies, positive=side, negative="none", one_sided="positive", friction=0.6)

    def test_a_face_and_a_friction_are_those_of_the_contact(self):
        pivot, closed = self.made(face=[[0.0, 0.0], [1.0, 0.1]]).contacts(Direction.POSITIVE)
        assert pivot.normal == pytest.approx(1j * (1 + 0.1j) / abs(1 + 0.1j)) and pivot.friction == 0.6
        assert closed.friction == 0.3 and set(closed.points) == {3j, 1 + 3j}
        pivot, _ = self.made().contacts(Direction.POSITIVE)
        assert pivot.normal == pytest.approx(1j * (1 + 0.2j) / abs(1 + 0.2j))  # of the polygon

    def test_a_hinge_turns_with_the_first_of_its_bodies(self):
        joints = {
            "A": {"pivot": "low", "at": [1.0, 0.0]},
            "B": {"hinge": ["high", "low"], "at": [0.0, 3.0], "face": [[1.0, 3.0], [0.0, 3.0]]},
            "C": {"slide": "high", "at": [1.0, 6.0], "along": [0.0, 1.0]},
        }
        bodies = {"low": rectangle(0, 0, 1, 3), "high": rectangle(0, 3, 1, 6)}
        linkage = rk.Linkage(bodies=bodies, positive={"lead": "low", "joints": joints})
        (hinge,) = (each for each in linkage.contacts(Direction.POSITIVE) if each.letter == "B")
        assert (hinge.pieces, hinge.face, hinge.normal) == (("low", "high"), "high", 1j)
        (image,) = (each for each in linkage.contacts(Direction.NEGATIVE) if each.letter == "B'")
        assert (image.pieces, image.face, image.normal, image.points) == (("low", "high"), "high", 1j, (1 + 3j,))

    def test_several_faces_of_one_pair(self):
        fixed = {
            "sole": {"fixed": ["foot", "post"], "face": [[1.0, 1.0], [2.0, 1.0]]},
            "back": {"fixed": ["foot", "post"], "face": [[1.0, 2.0], [1.0, 1.0]]},
            "A": {"pivot": "foot", "at": [4.0, 0.0]},
        }
        foot = {"polygon": [[0, 0], [4, 0], [4, 1], [1, 1], [1, 2], [0, 2]]}
        bodies = {"foot": foot, "post": rectangle(1.0, 1.0, 2.0, 5.0)}
        side = {"lead": "foot", "joints": fixed}
        linkage = rk.Linkage(bodies=bodies, positive=side, negative="none", one_sided="positive")
        faces = {each.normal: each for each in linkage.contacts(Direction.POSITIVE) if len(each.points) == 2}
        assert {normal: (each.pieces, each.points) for normal, each in faces.items()} == {
            1j: (("foot", "post"), (1 + 1j, 2 + 1j)),
            1 + 0j: (("foot", "post"), (1 + 2j, 1 + 1j)),
        }

    @pytest.mark.parametrize(
        ("joint", "said"),
        [
            ({"slide": "low", "along": [0.0, 1.0], "at": [0.5, 4.0], "face": [[0, 0], [1, 0]]}, "face is given"),
            ({"fixed": ["low", "high"], "bonded": True, "friction": 0.5}, "friction is given of a joint that does not"),
            ({"fixed": ["low", "high"], "face": [[0, 3], [0, 3]]}, "face has both ends at the same point"),
        ],
    )
    def test_what_has_no_face_is_refused(self, joint, said):
        bodies = {"low": self.SLOPE, "high": rectangle(0.0, 3.0, 1.0, 4.0)}
        joints = {"A": {"pivot": "low", "at": [1.0, 0.2]}, "B": joint}
        with pytest.raises(InputError, match=said):
            rk.Linkage(bodies=bodies, positive={"lead": "low", "joints": joints})
