"""Every installed mechanism, built-in or third-party, keeps the contract: the registry decides, nothing is listed."""

import re
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from inspect import isfunction, signature
from math import pi
from textwrap import dedent
from typing import ClassVar

import numpy as np
import pytest
from pydantic import Field, ValidationError, model_validator
from pytest import approx

from rocking_cli.codes.italian.chain import Chain
from rocking_cli.core import (
    Body,
    Contact,
    Direction,
    Hinge,
    Joint,
    Mechanism,
    Piece,
    Sketch,
    annular_sector,
    box,
    equivalent_block,
    length,
    of_joints,
    polygon,
    rectangle,
    rotation,
)
from rocking_cli.core.mechanism import _is_final
from rocking_cli.core.mechanism_kinematics import Kinematics
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_fields import StructureFields
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.dynamics.tables import tabulate
from rocking_cli.errors import DoubtWarning, MechanismError, PluginError
from rocking_cli.plugins.errors import own_traceback
from rocking_cli.questions.equiv.view import hung_data, hung_in_words
from rocking_cli.testing import CHECKS, MechanismContract, contract
from rocking_cli.testing.mechanism import verdict
from rocking_cli.views.mechanisms import template
from tests.conftest import EXAMPLES, PROJECT

BUILT_IN = {
    "arch", "assembly", "asymmetric_frame", "block", "cone", "curve", "linkage", "point_mass", "rigid_body",
    "spanning_wall", "symmetric_frame", "wall",
}  # fmt: skip


@cache
def of_template(name):
    return parse_structure(template(Registry()[name]), f"{name}.yaml", name)


@pytest.mark.parametrize("name", list(Registry()))
class TestEveryInstalledMechanism(MechanismContract):
    """From the file that `rocking new` prints: it must work as it is."""

    @pytest.fixture
    def structure(self, name):
        return of_template(name)


@pytest.mark.rest
@pytest.mark.parametrize("file", sorted(path.name for path in EXAMPLES.glob("*.yaml")))
def test_every_example_keeps_the_contract(file):
    assert [each for each in contract(load_structure(EXAMPLES / file)) if not each.passed] == []


def test_the_built_in_mechanisms_come_in_through_the_registry():
    assert set(Registry()) >= BUILT_IN


def test_there_is_an_example_of_every_built_in_mechanism():
    assert {load_structure(path).mechanism for path in EXAMPLES.glob("*.yaml")} == BUILT_IN


class Plain(Mechanism):
    """A right block that says only what it must; every wrong one below differs from it in one thing."""

    mechanism, title, source = "plain", "a block", "a test"
    width: float = length("width", example=0.7)
    height: float = length("height", example=2.8)

    def bodies(self):
        return [box("block", 1.0, self.width, self.height, 0.5j * self.height)]

    def motion(self, phi, direction):
        return [rotation(phi, complex(direction * self.width / 2), -direction)]

    def limit(self, direction):
        return pi / 2


class LateBalance(Plain):
    def critical_rotation_alone(self, direction):
        return 1.001 * float(np.arctan(self.width / self.height))


class ShortLimit(Plain):
    def limit(self, direction):
        return 0.2


class FourTimesTheInertia(Plain):
    def bodies(self):
        (body,) = super().bodies()
        return [replace(body, inertia=4 * body.inertia)]


class Uniform(Plain):
    def sketch(self):
        return Sketch(outlines={"block": [rectangle(0.5j * self.height, self.width, self.height)]}, uniform=True)


class HalfTheUniformInertia(Uniform):
    def bodies(self):
        (body,) = super().bodies()
        return [replace(body, inertia=body.inertia / 2, outline=())]


class UniformOfNothing(Plain):
    def bodies(self):
        return [Body("block", 1.0, 0.5, 0.5j * self.height)]

    def sketch(self):
        return Sketch(uniform=True)


class OutsideItself(Plain):
    def bodies(self):
        (body,) = super().bodies()
        return [replace(body, centroid=body.centroid + 0.36)]


class JumpingPivot(Plain):
    def motion(self, phi, direction):
        inner = np.where(phi < 0.1, 0.5, 0.4) * direction * self.width + 0j
        return [replace(rotation(phi, 0j, -direction), rest=inner, q=inner)]


class JumpingSpeed(Plain):
    def motion(self, phi, direction):
        turned = np.where(phi < 0.1, phi, 1.1 * phi - 0.01)
        (motion,) = super().motion(turned, direction)
        return [replace(motion, dpsi=motion.dpsi * np.where(phi < 0.1, 1, 1.1))]


class InnerPivot(Plain):
    def motion(self, phi, direction):
        return [rotation(phi, complex(0.4 * direction * self.width), -direction)]


class HighPivot(Plain):
    def motion(self, phi, direction):
        return [rotation(phi, complex(0.5 * direction * self.width, 0.1), -direction)]


class Two(Plain):
    """Two blocks side by side that turn alike, each on its own edge, and a lid that is one with the first."""

    beyond: ClassVar[float] = 0.0

    def bodies(self):
        (first,) = super().bodies()
        lid = box("lid", 0.1, self.width, 0.1, 1j * (self.height + 0.05))
        return [first, box("second", 1.0, self.width, self.height, first.centroid + 3), lid]

    def motion(self, phi, direction):
        (first,) = super().motion(phi, direction)
        return [first, rotation(phi, complex(3 + direction * (self.width / 2 + self.beyond)), -direction), first]


class OneOfTwoFloats(Two):
    beyond: ClassVar[float] = 0.05


class HingeElsewhere(Uniform):
    def sketch(self):
        hinges = {side: [Hinge("O", complex(0.4 * side * self.width), ("block",))] for side in Direction}
        return replace(super().sketch(), hinges=hinges)


class JointElsewhere(Uniform):
    def joints(self, direction):
        return (Joint("O", complex(0.4 * direction * self.width), ("block",)),)


class LongNormal(Uniform):
    def joints(self, direction):
        return (Joint("O", complex(0.5 * direction * self.width), ("block",), normal=2j),)


class TwoJoints(Uniform):
    def joints(self, direction):
        foot = complex(0.5 * direction * self.width)
        return Joint("O", foot, ("block",)), Joint("P", foot, ("block",))


class WrongSlope(Plain):
    def motion(self, phi, direction):
        (motion,) = super().motion(phi, direction)
        return [replace(motion, dpsi=1.0001 * motion.dpsi)]


class OneForAll(Plain):
    def motion(self, phi, direction):
        return super().motion(np.full_like(phi, phi[-1]), direction)


class Scalars(Plain):
    def motion(self, phi, direction):
        (motion,) = super().motion(phi, direction)
        return [replace(motion, dpsi=-float(direction))]


class StartsElsewhere(Plain):
    def motion(self, phi, direction):
        return super().motion(phi + 1e-3, direction)


class TwoOfOneName(Plain):
    def bodies(self):
        return [*super().bodies(), Body("block", 0.1, 0.0, 1j * self.height)]

    def motion(self, phi, direction):
        return [*super().motion(phi, direction)] * 2


class Massless(Plain):
    def bodies(self):
        return [replace(body, mass=0.0) for body in super().bodies()]


class Negative(Plain):
    def bodies(self):
        return [*super().bodies(), Body("cap", -0.1, 0.0, 1j * self.height)]


class Silent(Plain):
    load: float = Field(1.0)


class NoExample(Plain):
    load: float = length("a field that no file can be without")


class BadExample(Plain):
    load: float = length("a field with an example that it refuses", example=-1.0)


class Divides(Plain):
    def bodies(self):
        return [box("block", 1 / 0, self.width, self.height, 0j)]


class Leaves(Plain):
    def limit(self, direction):
        raise SystemExit(3)


class InCircles(Plain):
    """With loads its motion depends on its coefficients, which depend on its motion."""

    def motion(self, phi, direction):
        if self.loads:
            self.uplift(direction)
        return super().motion(phi, direction)


class OtherSide(Plain):
    """Leaning, it turns about the other edge."""

    def motion(self, phi, direction):
        half = self.width / 2 if self.rocks_both_ways else self.width / 3
        return [rotation(phi, complex(direction * half), -direction)]


class Stacked(Plain):
    """A statue that stays on its pedestal: one mechanism of two bodies, and of two pieces with a closed joint."""

    def bodies(self):
        low = box("pedestal", 1.0, self.width, self.height, 0.5j * self.height)
        return [low, box("statue", 0.3, 0.3, 1.0, 1j * (self.height + 0.5))]

    def motion(self, phi, direction):
        return super().motion(phi, direction) * 2

    def joints(self, direction):
        return (Joint("O" + direction.prime, complex(direction * self.width / 2), ("pedestal",)),)

    def under(self, **more):
        top = 1j * self.height
        return Contact(
            **{"pieces": ("pedestal", "statue"), "points": (top - 0.15, top + 0.15), "face": "pedestal"} | more
        )

    def contacts(self, direction):
        return [*of_joints(self.joints(direction), self.friction), self.under()]


class Overhanging(Stacked):
    """The statue beyond the edge of the joint that is said to bear it."""

    def contacts(self, direction):
        top = 1j * self.height
        return [*super().contacts(direction)[:1], self.under(points=(top - 0.15, top - 0.05))]


class UpsideDown(Stacked):
    def contacts(self, direction):
        return [*super().contacts(direction)[:1], self.under(normal=-1j)]


class OneEnd(Stacked):
    def contacts(self, direction):
        return [*super().contacts(direction)[:1], self.under(points=(1j * self.height,))]


class OtherFoot(Stacked):
    def contacts(self, direction):
        foot = Contact((None, "pedestal"), (complex(-direction * self.width / 2),))
        return [foot, self.under()]


class OnNothing(Stacked):
    def contacts(self, direction):
        return [*super().contacts(direction)[:1], self.under(pieces=("pedestal", "bust"))]


class HalfAStatue(Stacked):
    def pieces(self, direction):
        low, top = super().pieces(direction)
        return [low, Piece(replace(top.body, mass=top.body.mass / 2), top.of)]


class NoStatue(Stacked):
    def pieces(self, direction):
        return super().pieces(direction)[:1]


class OfNoBody(Stacked):
    def pieces(self, direction):
        low, top = super().pieces(direction)
        return [low, Piece(top.body, "bust")]


class TwoAlike(Stacked):
    def pieces(self, direction):
        return super().pieces(direction)[:1] * 2


WRONG = [
    (Overhanging, "contacts_bear_its_weight", "the contact of pedestal and statue pulls with .* N as rocking starts"),
    (
        UpsideDown,
        "contacts_bear_its_weight",
        "pulls with .*: its normal must point from the first piece into the second",
    ),
    (OneEnd, "contacts_bear_its_weight", "the contacts of the positive direction do not leave one degree of freedom"),
    (OtherFoot, "contacts_bear_its_weight", "of the positive direction do not balance .* joints that its motion keeps"),
    (OnNothing, "contacts_bear_its_weight", "contact of pedestal and bust names a piece that does not exist"),
    (HalfAStatue, "contacts_bear_its_weight", "the pieces of statue have 0.15 kg of its 0.3 kg"),
    (NoStatue, "contacts_bear_its_weight", "statue moves, but no piece is of it"),
    (OfNoBody, "contacts_bear_its_weight", "the piece statue is of bust, which is no body"),
    (TwoAlike, "contacts_bear_its_weight", "two pieces have the same name"),
    (InCircles, "carries_what_hangs_on_it", "RecursionError"),
    (OtherSide, "may_lean_on_side_walls", "uplift if it rocks in the positive direction only is 0.16"),
    (LateBalance, "closed_forms_agree_with_the_solvers", "critical_rotation_alone in the positive direction is 0.245"),
    (LateBalance, "stands_and_can_overturn", "is not the rotation at which its bodies balance"),
    (ShortLimit, "stands_and_can_overturn", "no unstable equilibrium|not between rest and the kinematic limit"),
    (FourTimesTheInertia, "outlines_are_those_of_the_bodies", "more than that of all its mass at the furthest corner"),
    (HalfTheUniformInertia, "outlines_are_those_of_the_bodies", "the inertia of block is .* of its outlines"),
    (UniformOfNothing, "outlines_are_those_of_the_bodies", "gives no outline of block"),
    (OutsideItself, "outlines_are_those_of_the_bodies", "the centroid of block is 0.01 m outside of its outline"),
    (JumpingPivot, "moves_without_jumps", "block jumps at phi = 0.0999?[0-9]* rad in the positive direction|0.1 rad"),
    (JumpingPivot, "has_an_equivalent_block", "jumps at phi = 0.1 rad|jumps at phi = 0.09"),
    (JumpingSpeed, "moves_without_jumps", "block jumps at phi = 0.0999?[0-9]* rad in the positive direction|0.1 rad"),
    (InnerPivot, "stands_on_the_edge_of_its_base", "block goes .* through the ground .* edge of its base"),
    (HighPivot, "stands_on_the_edge_of_its_base", "block reaches 0.1 m below the pivot of the positive direction"),
    (OneOfTwoFloats, "stands_on_the_edge_of_its_base", "all of the base of second leaves the ground"),
    (HingeElsewhere, "hinges_hold_together", "hinge O of the positive direction opens by"),
    (JointElsewhere, "joints_hold_what_moves", "joint O of the positive direction opens by"),
    (LongNormal, "joints_hold_what_moves", "the normal of joint O of the positive direction has the length 2, not 1"),
    (TwoJoints, "joints_hold_what_moves", "do not leave one degree of freedom"),
    (WrongSlope, "derivatives_are_those_of_the_motion", "dq of block|dpsi of block"),
    (OneForAll, "gives_a_motion_for_each_body", "if computed alone and"),
    (Scalars, "gives_a_motion_for_each_body", r"dpsi of block has the shape \(\) for 7 rotations"),
    (StartsElsewhere, "moves_from_rest", "block rests at .* turned by -0.001 rad"),
    (TwoOfOneName, "bodies_have_mass", "two bodies have the same name: block, block"),
    (Massless, "bodies_have_mass", "no body has a mass"),
    (Negative, "bodies_have_mass", "failed in bodies: ValueError: the mass of body 'cap' is -0.1 kg"),
    (Silent, "fields_say_what_they_are", "no description: load"),
    (NoExample, "fields_say_what_they_are", "no example for `rocking new` to print: load"),
    (BadExample, "fields_say_what_they_are", "the examples of its fields are not a valid structure"),
    (Divides, "bodies_have_mass", r"failed in bodies: ZeroDivisionError: .* \(.*test_contract\.py:\d+\)"),
    (Leaves, "stands_and_can_overturn", r"failed in limit: SystemExit: 3 \(.*test_contract\.py:\d+\)"),
]


def made(cls, **more):
    return cls(width=0.7, height=2.8, **({"load": 1.0} if "load" in cls.model_fields else {}), **more)


@pytest.mark.parametrize("cls", [Plain, Uniform, Two, Stacked])
def test_a_right_mechanism_passes_every_check(cls):
    assert [each for each in contract(made(cls)) if not each.passed] == []


@pytest.mark.parametrize(("cls", "check", "words"), WRONG, ids=[f"{cls.__name__}-{check}" for cls, check, _ in WRONG])
def test_a_wrong_mechanism_fails_the_check_that_is_for_it(cls, check, words):
    (its_own,) = (each for each in CHECKS if each.__name__ == check)
    found = verdict(check, "", partial(its_own, made(cls)))
    assert not found.passed
    assert re.search(words, found.why), found.why


def test_there_is_a_wrong_mechanism_for_every_check_that_a_class_can_fail():
    # What is declared is tested with the registry.
    assert {check for _, check, _ in WRONG} | {"is_declared"} == {check.__name__ for check in CHECKS}


def test_the_class_and_the_function_make_the_same_checks():
    tests = {name for name in dir(MechanismContract) if name.startswith("test_")}
    assert tests == {f"test_{check.__name__}" for check in CHECKS}
    with pytest.raises(AssertionError, match="dq of block"):
        MechanismContract().test_derivatives_are_those_of_the_motion(made(WrongSlope))
    MechanismContract().test_derivatives_are_those_of_the_motion(made(Plain))


MEMBERS = {
    name: member
    for base in (StructureFields, *(each for each in Mechanism.__mro__ if issubclass(each, Kinematics)))
    for name, member in vars(base).items()
    if name[0] != "_" and (isfunction(member) or isinstance(member, property | cached_property | classmethod))
}
OWN = object()
ARGUMENTS = {"phi": np.zeros(1), "direction": Direction.POSITIVE, "body": "block", "at": 1j, "factor": 2.0}


@pytest.mark.parametrize("name", MEMBERS)
def test_an_override_takes_effect_with_loads_too_or_is_refused_by_name(name):
    member, on = MEMBERS[name], False

    def own(self, *given):
        return OWN if on else getattr(super(Own, self), name)(*given)

    def own_value(self):
        return OWN if on else getattr(super(Own, self), name)

    members = {name: own if isfunction(member) or isinstance(member, classmethod) else property(own_value)}
    fields = {"__module__": __name__, "__qualname__": "Own", **members}
    if _is_final(member):
        with pytest.raises(TypeError, match=f"Own cannot override {name}, "):
            type("Own", (Plain,), fields)
        return
    Own = type("Own", (Plain,), fields)
    structures = made(Own), made(Own, mass=9.0, loads=[{"name": "cap", "mass": 1.0, "at": [0, 2.8]}])
    on = True
    for structure in structures:
        answer = getattr(structure, name)
        if isfunction(member):
            answer = answer(*(ARGUMENTS[each] for each in list(signature(member).parameters)[1:]))
        assert answer is OWN


def test_a_closed_form_counts_for_the_mechanism_alone():
    late, plain = made(LateBalance), made(Plain)
    alone = 1.001 * plain.critical_rotation(Direction.POSITIVE)
    assert late.critical_rotation(Direction.POSITIVE) == approx(alone, rel=1e-12)
    mass = {"mass": 9.0, "loads": [{"name": "cap", "mass": 1.0, "at": [0, 2.8]}]}
    laden = [made(cls, **mass).critical_rotation(Direction.POSITIVE) for cls in (LateBalance, Plain)]
    assert laden[0] == laden[1] < plain.critical_rotation(Direction.POSITIVE)
    with pytest.raises(TypeError, match="give a closed form as `critical_rotation_alone`"):
        type("Own", (Plain,), {"__module__": __name__, "critical_rotation": lambda self, direction: 1.0})


@dataclass(frozen=True)
class Drag:
    """Something attached of a class that this package does not know: a constant moment against the motion [N m]."""

    name: str
    moment: float

    def act(self, total, direction, follow):
        total.Q[:] += self.moment
        total.U[:] += self.moment * total.phi

    def forces(self, direction, follow):
        return ()


class Dragged(Plain):
    drag: float = 0.0

    def carries(self):
        return (Drag("drag", self.drag),)


def test_what_a_plugin_attaches_by_a_class_of_its_own_counts_in_statics_and_verification():
    plain, dragged = (made(Dragged, mass=2000.0, drag=drag) for drag in (0.0, 400.0))
    more = 400.0 / (dragged.gravity * float(dragged.coefficients(np.zeros(1), Direction.POSITIVE).B[0]))
    uplift = plain.uplift(Direction.POSITIVE) + more
    assert dragged.uplift(Direction.POSITIVE) == approx(uplift, rel=1e-12)
    assert Chain(dragged, Direction.POSITIVE).alpha0 == approx(uplift, rel=1e-12)
    assert list(hung_in_words(dragged)) == ["With drag: its contribution to the equation of motion."]
    assert hung_data(dragged) == [{"name": "drag", "kind": "Drag"}]


class JumpsLate(Plain):
    def motion(self, phi, direction):
        inner = np.where(phi < 0.8, 0.5, 0.49) * direction * self.width + 0j
        return [replace(rotation(phi, 0j, -direction), rest=inner, q=inner)]


class TestWithoutTheContract:
    """What no command may give numbers for, whether or not its author has run the contract."""

    @pytest.mark.parametrize("answer", [equivalent_block, tabulate])
    @pytest.mark.parametrize("cls", [JumpingPivot, JumpingSpeed])
    def test_a_jump_before_the_critical_rotation_has_no_equivalent_block(self, cls, answer):
        with pytest.raises(MechanismError, match=r"mechanism plain jumps at phi = 0\.(09\d*|1) rad in the positive"):
            answer(made(cls))

    def test_a_jump_beyond_it_has_no_history(self):
        assert equivalent_block(made(JumpsLate)) == equivalent_block(made(Plain))
        with pytest.raises(MechanismError, match=r"mechanism plain jumps at phi = 0\.(79\d*|8) rad in the positive"):
            tabulate(made(JumpsLate))

    def test_masses_and_inertias_are_finite_and_not_negative(self):
        for mass, inertia, words in (
            (-1.0, 0.0, "the mass of body 'b' is -1 kg"),
            (np.nan, 0.0, "the mass of body 'b' is nan kg"),
            (1.0, -1e-9, "the inertia of body 'b' is -1e-09 kg m2"),
            (1.0, np.inf, "the inertia of body 'b' is inf kg m2"),
        ):
            with pytest.raises(ValueError, match=re.escape(words)):
                Body("b", mass, inertia, 1j)
        with pytest.raises(ValueError, match="the centroid of body 'b'"):
            Body("b", 1.0, 1.0, complex(np.nan, 1))
        with pytest.raises(
            PluginError, match="the mechanism plain failed in bodies: ValueError: the mass of body 'cap'"
        ):
            equivalent_block(made(Negative))

    def test_rounding_makes_no_inertia_negative(self):
        assert annular_sector("s", 1.0, 1 - 1e-9, 1 + 1e-9, 0.0, 1e-9).inertia >= 0
        assert polygon("p", 1.0, [0j, 1e8 + 0j, 1e8 + 1e-9j]).inertia >= 0

    def test_a_mistake_of_the_plugin_is_not_one_of_the_sizes(self):
        with pytest.raises(PluginError, match="failed in bodies: ZeroDivisionError") as caught:
            equivalent_block(made(Divides))
        assert "1 / 0" in own_traceback(caught.value) and "check the sizes" not in str(caught.value)

    def test_sizes_that_are_too_large_are_not_a_mistake_of_the_plugin(self):
        class Large(Plain):
            def bodies(self):
                return [box("block", 1.0, 1e200 * self.width, self.height, 0.5j * self.height)]

        with pytest.raises(MechanismError, match=r"beyond the range of numbers .* check the sizes"):
            equivalent_block(made(Large))

    def test_an_interrupt_is_not_an_error_of_the_plugin(self):
        class Interrupted(Plain):
            def bodies(self):
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            equivalent_block(made(Interrupted))

    def test_a_validator_that_fails_in_its_own_way_is_blamed(self):
        class Odd(Plain):
            @model_validator(mode="after")
            def _fits(self):
                if self.width > 1:
                    raise KeyError("lost")
                return self

        with pytest.raises(PluginError, match="the mechanism plain failed on these fields: KeyError: 'lost'"):
            made(Odd).model_copy(update={"width": 2.0})
        with pytest.raises(ValidationError):
            made(Odd).model_copy(update={"width": -2.0})


def test_a_class_in_a_script_is_a_structure_as_the_guide_has_it(capsys):
    guide = (PROJECT / "docs" / "plugins.md").read_text(encoding="utf-8")
    code = guide.partition("\n## Try it in a script\n")[2].partition("\nEvery question")[0]
    with pytest.warns(DoubtWarning, match="the mechanism slab has not been verified"):
        exec(dedent(code), {"__name__": "guide"})
    assert "The structure overturns clockwise." in capsys.readouterr().out
