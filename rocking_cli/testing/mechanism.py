"""Contract of all mechanisms: for the check of an installed mechanism, and as a test class for authors.

The mechanics that a mechanism defines are checked against its bodies and their motion alone.

Examples
--------
In the tests of a plugin::

    import pytest
    from rocking_cli.testing import MechanismContract

    class TestCappedBlock(MechanismContract):
        @pytest.fixture
        def structure(self):
            return CappedBlock(width=0.8, height=2.0, cap_mass=0.5)
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from functools import partial
from inspect import cleandoc
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import ValidationError

from rocking_cli.core import (
    Body,
    Direction,
    Hinge,
    Mechanism,
    NoEquivalentBlock,
    Outline,
    Piece,
    RigidMotion,
    equivalent_block,
    polygon,
)
from rocking_cli.core.coefficients import NoCriticalRotation, jump
from rocking_cli.core.hung import Element
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.kinematics import area_of, distance
from rocking_cli.core.reactions import reactions
from rocking_cli.core.registry import Verdict as Verdict
from rocking_cli.core.registry import conformance
from rocking_cli.core.released import Pieces, Undetermined, released
from rocking_cli.errors import RockingError
from rocking_cli.plugins.errors import own_traceback
from rocking_cli.studies.picture import picture

Reals = NDArray[np.float64]
Points = NDArray[np.complex128]

MAX_STEP = 1e-4  # largest step of difference quotients [rad]
FINE_STEP_SHARE = 0.02  # finer step, over the step
STEP_SHARE = 1e-3  # step of difference quotients, over the range of rotations
SMOOTH_ROTATION = 1.2  # rotation up to which the motion must be smooth, over the critical rotation
SMOOTH_LIMIT_SHARE = 0.8  # rotation up to which motion must be smooth, over the kinematic limit, where derivatives grow
NO_JUMP_SHARE = 0.999  # rotation up to which there must be no jump, over the kinematic limit
STENCIL = (-2, -1, 1, 2)  # steps at which difference quotients take values
JUMP_INTERVALS = 4096
EQUAL_VALUES = 1e-9  # largest difference of equal values, over their size
OUTLINE_DIFFERENCE = 2e-3  # largest difference of inertia or centroid from the outlines, over the size of the body
ABOVE_GROUND_ROTATION = 0.25  # rotation up to which nothing may pass through the ground, over the critical rotation
GROUND_HEIGHT = 1e-8  # height that counts as on the ground, over the size of the structure
MAX_IMBALANCE = 1e-6  # largest imbalance of contact forces, over the weight
TRIAL_LOAD_SHARE = 0.01  # weight of the loads that are tried, over the weight of the structure
TRIAL_MASS = 1000.0  # kg, of a structure without masses
SIDED_FIELDS = ("one_sided", "rebound")
COMMON_FIELDS = ("loads", "ties", "interlock", *SIDED_FIELDS)
TRIAL_REBOUND = 0.625  # differs from the rebound of every structure


def contract(structure: Mechanism) -> list[Verdict]:
    """Run all checks of the contract on a structure; needs no pytest.

    Parameters
    ----------
    structure : Mechanism
        Any structure.

    Returns
    -------
    list of Verdict
        Verdicts in the order of `CHECKS`. A check that raises an error of the plugin is failed.
    """
    return [verdict(each.__name__, meaning(each), partial(_alone, each, structure)) for each in CHECKS]


def verdict(name: str, meaning: str, check: Callable[[], object]) -> Verdict:
    """Return the verdict of one check, which fails by raising any error."""
    try:
        with np.errstate(all="ignore"):  # NaN fails the comparisons
            check()
    except AssertionError as error:
        return Verdict(name, meaning, str(error))
    except RockingError as error:
        return Verdict(name, meaning, str(error), own_traceback(error))
    except Exception as error:  # the plugin returned something unusable
        return Verdict(name, meaning, f"{type(error).__name__}: {error}", traceback.format_exc().rstrip("\n"))
    return Verdict(name, meaning)


def meaning(check: Callable[..., object]) -> str:
    """Return the requirement of a check: the first paragraph of its docstring."""
    return cleandoc(check.__doc__ or "").partition("\n\n")[0].replace("\n", " ")


def is_declared(structure: Mechanism) -> None:
    """The mechanism has a name, a title and a source, and defines every abstract method."""
    faults = conformance(type(structure), structure.mechanism)
    _demand(not faults, "; ".join(faults))


def fields_say_what_they_are(structure: Mechanism) -> None:
    """Every field has a description, required fields have an example too, and the examples make a structure."""
    cls = type(structure)
    silent = [key for key, field in cls.model_fields.items() if not field.description]
    _demand(not silent, f"no description: {', '.join(silent)}")
    unknown = [key for key in cls.starter if key not in cls.model_fields]
    _demand(not unknown, f"starter has names that are not fields: {', '.join(unknown)}")
    needed = [key for key, field in cls.model_fields.items() if field.is_required() or key in cls.starter]
    examples = {key: (cls.model_fields[key].examples or [None])[0] for key in needed}
    without = [key for key, example in examples.items() if example is None]
    _demand(not without, f"no example for `rocking new` to print: {', '.join(without)}")
    try:
        cls.from_fields(examples)
    except ValueError as error:
        raise AssertionError(f"the examples of its fields are not a valid structure: {error}") from error


def bodies_have_mass(structure: Mechanism) -> None:
    """Masses and inertias are finite and not negative, a body has a mass, and the names of bodies are unique."""
    bodies = structure.bodies()
    for body in bodies:
        _demand(isinstance(body, Body), f"{body!r} is not a Body")
        for what, value in (("mass", body.mass), ("inertia", body.inertia)):
            _demand(0 <= value < np.inf, f"the {what} of {body.name} is {value}")
    _demand(sum(body.mass for body in bodies) > 0, "no body has a mass")
    names = [body.name for body in bodies]
    _demand(len(set(names)) == len(names), f"two bodies have the same name: {', '.join(names)}")


def gives_a_motion_for_each_body(structure: Mechanism) -> None:
    """The motion at n rotations has n places for each body, each the same as if computed alone."""
    bodies = structure.bodies()
    for direction in structure.directions:
        phi = np.linspace(0.0, 0.5, 7) * structure.limit(direction)
        together = structure.motion(phi, direction)
        _demand(len(together) == len(bodies), f"{len(together)} motions for {len(bodies)} bodies")
        for body, motion in zip(bodies, together, strict=True):
            for field in fields(RigidMotion)[1:]:
                shape = np.shape(getattr(motion, field.name))
                _demand(
                    shape == phi.shape, f"{field.name} of {body.name} has the shape {shape} for {phi.size} rotations"
                )
        for k, value in enumerate(phi):
            alone = structure.motion(np.array([value]), direction)
            for body, one, all_ in zip(bodies, alone, together, strict=True):
                for quantity, (mine, its) in _paired(one, all_, body.centroid).items():
                    size = 1 + np.abs(its).max()
                    where = f"{quantity} of {body.name} at phi = {value:.4g} rad, {direction.label} direction,"
                    _demand(
                        abs(mine[0] - its[k]) <= EQUAL_VALUES * size,
                        f"{where} is {mine[0]:.6g} if computed alone and {its[k]:.6g} among others",
                    )


def moves_from_rest(structure: Mechanism) -> None:
    """At phi = 0 every body is at its place of rest, in both directions."""
    size = _size(structure)
    for direction in structure.directions:
        for body, motion in zip(structure.bodies(), structure.motion(np.zeros(1), direction), strict=True):
            place, turn = complex(motion.carry(body.centroid)[0][0]), float(motion.psi[0])
            _demand(
                abs(place - body.centroid) <= EQUAL_VALUES * (size + abs(body.centroid)) and abs(turn) <= EQUAL_VALUES,
                f"{body.name} rests at {body.centroid:.6g} m and starts in the {direction.label} direction "
                f"from {place:.6g} m, turned by {turn:.3g} rad",
            )


def moves_without_jumps(structure: Mechanism) -> None:
    """The places and velocities of all bodies are continuous up to the kinematic limit."""
    size = _size(structure)
    for direction in structure.directions:
        x = np.linspace(0.0, 1.0, JUMP_INTERVALS + 1)
        phi = NO_JUMP_SHARE * structure.limit(direction) * x * (2 - x)  # finer near the limit, where a linkage locks
        for body, motion in zip(structure.bodies(), structure.motion(phi, direction), strict=True):
            z, dz, ddz = motion.carry(body.centroid)
            jumps = [jump(phi, part(z) - part(z[0]), part(dz), size) for part in (np.real, np.imag)]
            jumps += [jump(phi, part(dz), part(ddz), size) for part in (np.real, np.imag)]
            jumps += [jump(phi, motion.psi, motion.dpsi, 1.0), jump(phi, motion.dpsi, motion.ddpsi, 1.0)]
            _demand(
                min(jumps) == np.inf,
                f"{body.name} jumps at phi = {min(jumps):.4g} rad in the {direction.label} direction",
            )


def derivatives_are_those_of_the_motion(structure: Mechanism) -> None:
    """First and second derivatives agree with difference quotients."""
    for direction in structure.directions:
        top = _top(structure, direction)
        step = min(MAX_STEP, STEP_SHARE * top)
        phi = np.linspace(0.02, 1.0, 9) * top
        here = structure.motion(phi, direction)
        # The wide step fails at a bend of a derivative, which is allowed.
        steps = (step, FINE_STEP_SHARE * step)
        around = [structure.motion(phi + shift * step, direction) for step in steps for shift in STENCIL]
        for body, motion, *moved in zip(structure.bodies(), here, *around, strict=True):
            _, dz, ddz = motion.carry(body.centroid)
            speed = _size(structure) + np.abs(dz).max()
            for what, values, derivative, size in (
                ("dq", [place.carry(body.centroid)[0] for place in moved], dz, speed),
                ("ddq", [place.carry(body.centroid)[1] for place in moved], ddz, speed + np.abs(ddz).max()),
                ("dpsi", [place.psi for place in moved], motion.dpsi, 1 + np.abs(motion.dpsi).max()),
                ("ddpsi", [place.dpsi for place in moved], motion.ddpsi, 1 + np.abs(motion.ddpsi).max()),
            ):
                wide, fine = (_quotient(values[k : k + 4], step) for k, step in zip((0, 4), steps, strict=True))
                quotient = np.where(np.abs(wide - derivative) <= np.abs(fine - derivative), wide, fine)
                what = f"{what} of {body.name}, {direction.label} direction,"
                _near(what, phi, derivative, quotient, 1e-6 * size, "the difference quotient is")


def stands_and_can_overturn(structure: Mechanism) -> None:
    """The structure is stable at rest, balances before its kinematic limit and falls beyond, unless it is tied."""
    for direction in structure.directions:
        if not _overturns(structure, direction):
            _demand(structure.uplift(direction) > 0, f"it is not stable at rest in the {direction.label} direction")
            continue
        lam, phi_cr, limit = (
            structure.uplift(direction),
            structure.critical_rotation(direction),
            structure.limit(direction),
        )
        here = f"in the {direction.label} direction"
        _demand(lam > 0, f"it is not stable at rest {here}: lambda = {lam:.4g}")
        _demand(
            0 < phi_cr < limit < np.inf,
            f"phi_cr = {phi_cr:.4g} rad is not between rest and the kinematic limit of {limit:.4g} rad {here}",
        )
        around = structure.coefficients(np.array([0.999, 1.0, 1.001]) * phi_cr, direction)
        moment, slope = around.restoring(structure.gravity), around.stiffness(structure.gravity)
        _demand(
            moment[0] > 0 > moment[2] and abs(moment[1]) <= 1e-12 * abs(slope[1]),
            f"phi_cr = {phi_cr:.6g} rad {here} is not the rotation at which its bodies "
            f"balance: there G is {moment[1]:.3g} kg m",
        )


def closed_forms_agree_with_the_solvers(structure: Mechanism) -> None:
    """The critical rotation in closed form agrees with the bodies and their motion."""
    # Crushing moves pivots, but only under a mass.
    for direction in structure.directions if structure.crushing is None else ():
        alone = structure.critical_rotation_alone(direction)
        if alone is not None and _overturns(structure, direction):
            what = f"critical_rotation_alone in the {direction.label} direction"
            _agree(what, alone, structure.solved_critical_rotation(direction))


def has_an_equivalent_block(structure: Mechanism) -> None:
    """The parameters of the equivalent block are finite and, except eta, positive; ties may leave no block."""
    try:
        equivalence = equivalent_block(structure)
    except NoEquivalentBlock as error:
        _demand(structure.bends, str(error))
        return
    for direction in structure.directions:
        for key, value in equivalence[direction].as_dict().items():
            here = f"{key} of the equivalent block in the {direction.label} direction is {value}"
            _demand(bool(np.isfinite(value)) and (value > 0 or key == "eta"), here)


def contacts_bear_its_weight(structure: Mechanism) -> None:
    """The forces at its contacts, if it names them, balance its weight, and all contacts press as rocking starts."""
    weight = structure.gravity * sum(body.mass for body in structure.weighed())
    for direction in structure.directions:
        contacts = structure.contacts(direction)
        if not contacts:
            continue
        here = f"the contacts of the {direction.label} direction"
        names = [each.body.name for each in _pieces(structure, direction)]
        for contact in contacts:
            known = {*contact.pieces, contact.face} <= {None, *names}
            _demand(known, f"the contact of {contact.label} names a piece that does not exist: there are {names}")
        try:
            forces = released(structure, direction, np.zeros(1))
        except Undetermined as error:
            needed = "n pieces need 3n - 1 forces, two at a hinge, three at a joint that stays closed, one at a guide"
            _demand(error.redundant, f"{here} do not leave one degree of freedom: {needed}")
            continue
        assert forces is not None
        starts = np.array([1.0, -int(direction) * structure.uplift(direction) * structure.gravity, 0.0, 0.0])
        force, there = forces.force[0] @ starts, Pieces(structure, direction, np.zeros(1))
        jacobian = there.rates(contacts)[0].dense()[0]  # without the rows of loads on guides
        missing = np.abs(jacobian.T @ force[: len(jacobian)] - there.demands()[0] @ starts) / there.scale
        k = int(missing.argmax())
        _demand(
            missing[k] <= MAX_IMBALANCE * weight,
            f"{here} do not balance {names[k // 3]} as rocking starts, {missing[k]:.4g} N are missing: they must be "
            "the joints that its motion keeps together",
        )
        for contact, (normal, _) in zip(forces.contacts, forces.rows, strict=True):
            least = min((float(force[row]) for row in normal), default=0.0)
            _demand(
                least >= -MAX_IMBALANCE * weight,
                f"the contact of {contact.label} pulls with {-least:.4g} N as rocking starts in the {direction.label} "
                "direction: its normal must point from the first piece into the second",
            )


def _pieces(structure: Mechanism, direction: Direction) -> Sequence[Piece]:
    """Return the pieces of a direction, after checking that the pieces of each moving body add up to the body.

    A body at rest needs no pieces.
    """
    bodies, pieces = structure.weighed(), structure.pieces(direction)
    names = {body.name for body in bodies}
    _demand(len({piece.body.name for piece in pieces}) == len(pieces), "two pieces have the same name")
    for piece in pieces:
        _demand(
            piece.of is None or piece.of in names, f"the piece {piece.body.name} is of {piece.of}, which is no body"
        )
    for body, motion in zip(bodies, structure.motion(np.zeros(1), direction), strict=True):
        parts = [piece for piece in pieces if piece.of == body.name]
        if parts:
            mass = sum(part.body.mass for part in parts)
            moment = sum(part.body.mass * (part.body.centroid - part.shift) for part in parts) - mass * body.centroid
            _demand(
                abs(mass - body.mass) <= MAX_IMBALANCE * body.mass
                and abs(moment) <= OUTLINE_DIFFERENCE * body.mass * _size(structure),
                f"the pieces of {body.name} have {mass:.6g} kg of its {body.mass:.6g} kg, or another centroid",
            )
        else:
            rates = abs(complex(motion.carry(body.centroid)[1][0])), abs(float(motion.dpsi[0]))
            _demand(max(rates) <= EQUAL_VALUES * _size(structure), f"{body.name} moves, but no piece is of it")
    return pieces


def carries_what_hangs_on_it(structure: Mechanism) -> None:
    """With a load, a force and a tie, unless it refuses them, coefficients and restitution include all of them."""
    bare = _with(structure, crushing=None)  # with crushing, pivots would move with the load
    _demand(bare is not None, "it accepts no mass")
    assert bare is not None
    spot, size = _liveliest(bare), _size(bare)
    weight = bare.gravity * sum(body.mass for body in bare.weighed())
    mass, force, stiffness = (
        TRIAL_LOAD_SHARE * weight / bare.gravity,
        TRIAL_LOAD_SHARE * weight * (0.3 - 1j),
        TRIAL_LOAD_SHARE * weight / size,
    )
    prestress, anchor = 0.1 * TRIAL_LOAD_SHARE * weight, spot.at - size * (1 + 0.5j)
    share = {"horizontal": 0.6, "vertical": 0.7, "weight": 0.8}
    at = {"body": spot.body, "at": [spot.at.real, spot.at.imag]}
    ends = {"from": {"ground": [anchor.real, anchor.imag]}, "to": at}
    loads = [{"name": "mass", "mass": mass, **share, **at}, {"name": "force", "force": [force.real, force.imag], **at}]
    ties = [{"name": "tie", **ends, "stiffness": stiffness, "prestress": prestress}]
    laden = _with(bare, loads=loads, ties=ties)
    if laden is None:
        return

    def energies(phi: Reals, direction: Direction) -> tuple[Reals, Reals]:
        """Return the energies of what hangs on a point, from where it moves: of the weight over g, of tie and force."""
        z = bare.followed(phi, direction)(spot).z
        elongation = np.abs(z - anchor) - abs(spot.at - anchor)
        of_weight, work = share["weight"] * mass * (z - spot.at).imag, ((z - spot.at) * np.conj(force)).real
        return of_weight, prestress * elongation + stiffness * elongation**2 / 2 - work

    for direction in structure.directions:
        top = _top(bare, direction)
        step = min(MAX_STEP, STEP_SHARE * top)
        phi = np.linspace(0.02, 1.0, 9) * top
        laden_ones, bare_ones = (each.coefficients(phi, direction) for each in (laden, bare))
        z = [bare.followed(phi + shift * step, direction)(spot).z for shift in STENCIL]
        moved = _quotient(z, step)
        around = [energies(phi + shift * step, direction) for shift in STENCIL]
        here = energies(phi, direction)
        inertia = mass * (share["horizontal"] * moved.real**2 + share["vertical"] * moved.imag**2)
        moment = np.abs(bare_ones.G).max() + np.abs(bare_ones.B).max()
        for name, added, big in (
            ("I", inertia, bare_ones.I.max()),
            ("G", _quotient([each[0] for each in around], step).real, moment),
            ("B", direction * bare.driven * share["horizontal"] * mass * moved.real, moment),
            ("V", here[0], moment),
            ("Q", _quotient([each[1] for each in around], step).real, bare.gravity * moment),
            ("U", here[1], bare.gravity * moment),
        ):
            what = f"{name} of coefficients with a load and a tie, {direction.label} direction,"
            expected = getattr(bare_ones, name) + added
            _near(what, phi, getattr(laden_ones, name), expected, 1e-6 * big, "bodies and load give")
        beside = [laden.coefficients(phi + shift * step, direction).Q for shift in STENCIL]
        what, quotient = f"dQ, {direction.label} direction,", _quotient(beside, step).real
        _near(what, phi, laden_ones.dQ, quotient, 1e-6 * bare.gravity * moment, "the difference quotient is")
        if bare.rocks_both_ways:
            masses = share["horizontal"] * mass, share["vertical"] * mass
            _restitution_has_the_mass(bare, laden, spot, masses, direction)


def _restitution_has_the_mass(
    bare: Mechanism, laden: Mechanism, spot: Spot, masses: tuple[float, float], direction: Direction
) -> None:
    """The restitution with a load is that without it and the momentum of its horizontal and vertical masses [kg]."""
    old, new = (complex(bare.followed(np.zeros(1), side)(spot).dz[0]) for side in (direction, direction.opposite))
    before, after = bare.restitution_from_kinematics(direction), laden.restitution_from_kinematics(direction)
    base = float(bare.coefficients(np.zeros(1), direction.opposite).I[0])

    def product(one: complex, other: complex) -> float:
        return masses[0] * one.real * other.real + masses[1] * one.imag * other.imag

    expected = (before * base - product(old, new)) / (base + product(new, new))
    _demand(abs(after - expected) <= 1e-9, f"eta with a load is {after:.9g}, but from bodies and load {expected:.9g}")


def may_lean_on_side_walls(structure: Mechanism) -> None:
    """One-sided rocking, unless refused, has the uplift and critical rotation of that side."""
    for direction in structure.directions:
        sided = _with(structure, one_sided=direction.label, rebound=TRIAL_REBOUND, restitution=None)
        if sided is None:
            return
        here = f"if it rocks in the {direction.label} direction only"
        _agree(f"uplift {here}", sided.uplift(direction), structure.uplift(direction))
        _agree(f"critical_rotation {here}", sided.critical_rotation(direction), structure.critical_rotation(direction))


def outlines_are_those_of_the_bodies(structure: Mechanism) -> None:
    """Outlines enclose an area, and the mass and inertia of their bodies are possible for such shapes."""
    sketch = structure.sketch()
    bodies = {body.name: body for body in structure.bodies()}
    for name in [*sketch.outlines, *sketch.copies]:
        _demand(name in bodies, f"the sketch names {name!r}, which is not a body")
    for name, copies in sketch.copies.items():
        _demand(bool(copies) and copies[0] == 0, f"the first of the copies of {name} must be itself, 0")
    for name, body in bodies.items():
        outlines = sketch.outlines.get(name) or ([body.outline] if body.outline else [])
        _demand(bool(outlines) or name not in sketch.outlines, f"the list of outlines of {name} is empty")
        for outline in outlines:
            z = np.asarray(outline, np.complex128)
            _demand(z.size >= 3 and bool(np.isfinite(z).all()), f"an outline of {name} has fewer than three corners")
            _demand(area_of(outline) != 0, f"an outline of {name} encloses no area")
        if sketch.uniform:
            _demand(bool(outlines), f"the sketch declares the bodies uniform, but gives no outline of {name}")
            _is_uniform(body, outlines)
        elif body.outline:
            _can_be_within(body)


def hinges_hold_together(structure: Mechanism) -> None:
    """Bodies joined by a hinge stay together there; a hinge on the ground stays in place, or slides as declared.

    If the bodies are the plates that are drawn, hinges are on their edges.
    """
    sketch = structure.sketch()
    bodies = {body.name: body for body in structure.bodies()}
    for direction, hinges in sketch.hinges.items():
        for hinge in hinges:
            which = f"hinge {hinge.letter or hinge.point} of the {direction.label} direction"
            _holds_together(structure, direction, hinge, which)
            for name in hinge.bodies if sketch.uniform else ():
                outlines = sketch.outlines.get(name) or [bodies[name].outline]
                size = max(abs(corner - bodies[name].centroid) for each in outlines for corner in each)
                off = min(float(distance(np.array([hinge.point]), np.asarray(each))[0]) for each in outlines)
                _demand(off <= OUTLINE_DIFFERENCE * size, f"{which} is {off:.3g} m off the edge of {name}")


def joints_hold_what_moves(structure: Mechanism) -> None:
    """Joints, if any, join bodies that stay together there, and leave the bodies one degree of freedom."""
    for direction in structure.directions:
        joints = structure.joints(direction)
        names = [body.name for body in structure.bodies()]
        for joint in joints:
            which = f"joint {joint.letter or joint.point} of the {direction.label} direction"
            _holds_together(structure, direction, joint, which)
            _demand(
                joint.face is None or joint.face in names,
                f"the face of {which} does not turn with a body: {joint.face}",
            )
            size = abs(joint.normal)
            _demand(
                joint.is_guide or abs(size - 1) <= EQUAL_VALUES,
                f"the normal of {which} has the length {size:.6g}, not 1",
            )
        if joints:
            known = not reactions(structure, direction, np.zeros(1), np.zeros(1)).is_whole
            subject = f"the joints of the {direction.label} direction"
            _demand(
                known,
                f"{subject} do not leave one degree of freedom: n parts need 3n - 1 forces, "
                "two at a joint, one at a guide",
            )


def _holds_together(structure: Mechanism, direction: Direction, hinge: Hinge, which: str) -> None:
    """Check that bodies joined by a hinge stay together there."""
    bodies = [body.name for body in structure.bodies()]
    phi = np.linspace(0.0, 1.0, 33) * _top(structure, direction)
    moved = dict(zip(bodies, structure.motion(phi, direction), strict=True))
    known = len(hinge.bodies) in (1, 2) and set(hinge.bodies) <= set(bodies)
    _demand(known, f"{which} must join one or two bodies, but joins {', '.join(hinge.bodies) or 'none'}")
    about = hinge.point + 1j * hinge.roll
    first, *others = (moved[name].carry(about)[0] for name in hinge.bodies)
    gap = first - (others[0] if others else about + direction * hinge.roll * phi)
    across = np.abs((gap / hinge.slide).imag if hinge.slide else gap)
    held = bool(across.max() <= EQUAL_VALUES * (_size(structure) + abs(hinge.point)))
    _demand(held, f"{which} opens by {across.max():.3g} m at phi = {phi[across.argmax()]:.4g} rad")


def stands_on_the_edge_of_its_base(structure: Mechanism) -> None:
    """At the onset of rocking no body passes through the ground, and the edge of each base stays on it.

    Bodies that move as one stand as one. Bodies without known outlines are left out.
    """
    drawn, sketch = picture(structure), structure.sketch()
    known = [part for part in drawn.parts if not part.assumed]
    if not known:
        return
    size = abs(drawn.extent[1] - drawn.extent[0])
    flush = GROUND_HEIGHT * size
    bodies, level = structure.bodies(), not sketch.ground
    for direction in structure.directions:
        phi = np.linspace(0.0, ABOVE_GROUND_ROTATION, 9) * _phi_cr(structure, direction)
        motions = structure.motion(phi, direction)
        as_one = _moving_as_one(motions, size)
        within = f"within {phi[-1]:.4g} rad of the {direction.label} direction: it must turn about the edge of its base"
        # Keys: group of bodies that move as one, and shift of the copy.
        feet: dict[tuple[int, complex], list[Reals]] = {}
        for part in known:
            corners = np.concatenate(part.outlines) - part.shift
            moved = np.array([motions[part.body].carry(corner)[0] for corner in corners]) + part.shift
            for above in _heights(moved, drawn.ground, flush):
                lowest = above[:, 0].min(initial=0.0)
                _demand(
                    lowest >= -flush or not level,
                    f"{part.name} reaches {-lowest:.4g} m below the pivot of the {direction.label} direction: it must "
                    "turn about the edge of its base, or the sketch must define the ground",
                )
                above = above[above[:, 0] >= -flush]
                sinks = max(
                    (each.value for each in structure.found(direction) if each.key == "inwards_foot"), default=0.0
                )
                deep = (above + sinks * phi).min(initial=0.0)
                _demand(deep >= -flush, f"{part.name} goes {-deep:.4g} m through the ground {within}")
                feet.setdefault((as_one[part.body], part.shift), []).extend(above[above[:, 0] <= flush])
        # A base of unknown shape may be wider than its known part; a point has no base.
        wider = {as_one[part.body] for part in drawn.parts if part.assumed and bodies[part.body].inertia > 0}
        # The contact point of a rolling body changes; the check of hinges covers that.
        rolling = {name for hinge in sketch.hinges.get(direction, ()) if hinge.roll for name in hinge.bodies}
        wider |= {as_one[k] for k, body in enumerate(bodies) if body.name in rolling}
        for (one, _), heights in feet.items():
            lift = np.min(heights, axis=0).max() if heights and one not in wider else 0.0
            _demand(lift <= flush, f"all of the base of {bodies[one].name} leaves the ground, by {lift:.4g} m {within}")


CHECKS: tuple[Callable[[Mechanism], None], ...] = (
    is_declared,
    fields_say_what_they_are,
    bodies_have_mass,
    gives_a_motion_for_each_body,
    moves_from_rest,
    moves_without_jumps,
    derivatives_are_those_of_the_motion,
    stands_and_can_overturn,
    closed_forms_agree_with_the_solvers,
    has_an_equivalent_block,
    outlines_are_those_of_the_bodies,
    hinges_hold_together,
    joints_hold_what_moves,
    contacts_bear_its_weight,
    carries_what_hangs_on_it,
    may_lean_on_side_walls,
    stands_on_the_edge_of_its_base,
)
"""Checks of the contract. Each takes a structure and raises an AssertionError with the fault."""


class MechanismContract:
    """Test class with each of `CHECKS` as a test; a subclass gives the structure as the fixture `structure`."""


def _as_test(check: Callable[[Mechanism], None]) -> Callable[[MechanismContract, Mechanism], None]:
    def test(self: MechanismContract, structure: Mechanism) -> None:
        _alone(check, structure)

    test.__name__, test.__doc__ = f"test_{check.__name__}", check.__doc__
    return test


for _check in CHECKS:
    setattr(MechanismContract, f"test_{_check.__name__}", _as_test(_check))


def _demand(holds: object, otherwise: str) -> None:
    """Fail with a sentence, also under `python -O`, unlike `assert`."""
    if not holds:
        raise AssertionError(otherwise)


def _alone(check: Callable[[Mechanism], object], structure: Mechanism) -> object:
    """Run a check on a structure without loads, ties and the like, which may leave it no critical rotation."""
    hung = [key for key in COMMON_FIELDS if getattr(structure, key, None) is not None]
    if not hung:
        return check(structure)
    alone = _with(structure, **dict.fromkeys(hung))
    if alone is None:  # the structure cannot rock in the other direction
        alone = structure.model_copy(update=dict.fromkeys([key for key in hung if key not in SIDED_FIELDS]))
    return check(alone)


def _with(structure: Mechanism, **fields: object) -> Mechanism | None:
    """Return the structure with these fields, and with masses; None if it refuses the fields."""
    masses = {} if structure.has_mass else {"mass": TRIAL_MASS}
    try:
        return structure.model_copy(update={**masses, **fields})
    except ValidationError as error:
        if all(each["type"] == "geometry" for each in error.errors()):
            return None
        raise


def _liveliest(structure: Mechanism) -> Spot:
    """Return the corner, or centroid of a body of unknown shape, that moves most at the onset of rocking."""
    sketch = structure.sketch()
    spots = []
    for body in structure.bodies():
        known = sketch.outlines.get(body.name, ()) if sketch.uniform else ()
        shapes = [body.outline] if body.outline else list(known)
        spots += [Spot(body.name, complex(corner)) for shape in shapes or [[body.centroid]] for corner in shape]
    follow = structure.followed(np.zeros(1), Direction.POSITIVE)
    return max(spots, key=lambda spot: abs(complex(follow(spot).dz[0])))


def _agree(what: str, actual: float, expected: float) -> None:
    _demand(
        abs(actual - expected) <= 1e-11 * abs(expected), f"{what} is {actual:.12g}, but its bodies give {expected:.12g}"
    )


def _near(what: str, phi: Reals, actual: ArrayLike, expected: ArrayLike, allowed: float, by: str) -> None:
    """Check that two arrays over `phi` agree; NaN does not."""
    actual, expected = np.asarray(actual), np.asarray(expected)
    _demand(actual.shape == phi.shape, f"{what} has the shape {actual.shape} for {phi.size} rotations")
    wrong = np.flatnonzero(~(np.abs(actual - expected) <= allowed))
    if wrong.size:
        k = wrong[np.argmax(np.nan_to_num(np.abs(actual - expected)[wrong], nan=np.inf))]
        raise AssertionError(f"{what} is {actual[k]:.6g} at phi = {phi[k]:.4g} rad, but {by} {expected[k]:.6g}")


def _quotient(values: Sequence[ArrayLike], step: float) -> NDArray[np.complex128]:
    """Return the derivative from values at the steps of `STENCIL`."""
    before2, before, after, after2 = (np.asarray(each) for each in values)
    return np.asarray((8 * (after - before) - (after2 - before2)) / (12 * step))


def _phi_cr(structure: Mechanism, direction: Direction) -> float:
    """Return the critical rotation by the solver, or the limit if ties leave none [rad]."""
    try:
        return structure.solved_critical_rotation(direction)
    except NoCriticalRotation:
        if not structure.bends:
            raise
        return structure.limit(direction)


def _overturns(structure: Mechanism, direction: Direction) -> bool:
    """Return whether the structure has a critical rotation; a tied one may have none."""
    return _phi_cr(structure, direction) < structure.limit(direction)


def _top(structure: Mechanism, direction: Direction) -> float:
    """Return the rotation up to which the motion must be smooth [rad]."""
    return min(SMOOTH_ROTATION * _phi_cr(structure, direction), SMOOTH_LIMIT_SHARE * structure.limit(direction))


def _size(structure: Mechanism) -> float:
    """Return the largest speed of a centroid per unit rate of phi at rest [m], which has the size of the lever arms."""
    return max(
        abs(complex(motion.carry(body.centroid)[1][0]))
        for direction in structure.directions
        for body, motion in zip(structure.bodies(), structure.motion(np.zeros(1), direction), strict=True)
    )


def _heights(corners: Points, ground: Sequence[Points], flush: float) -> Iterator[Reals]:
    """Yield, for each straight piece of the ground, the heights of the corners above it at rest [m]."""
    for line in ground:
        for start, end in pairwise(line):
            length = abs(end - start)
            place = (corners - start) * length / (end - start)  # real part along the ground, imaginary part above it
            yield place[(-flush <= place[:, 0].real) & (place[:, 0].real <= length + flush)].imag


def _moving_as_one(motions: Sequence[RigidMotion], size: float) -> list[int]:
    """Return for each body the first one with the same motion."""
    places = [np.concatenate([motion.carry(0j)[0], motion.carry(complex(size))[0]]) for motion in motions]
    return [
        next(
            j
            for j, other in enumerate(places)
            if np.abs(place - other).max() <= EQUAL_VALUES * (size + np.abs(place).max())
        )
        for place in places
    ]


def _paired(one: RigidMotion, other: RigidMotion, point: complex) -> dict[str, tuple[Points, Points]]:
    """Return place and rotation in two motions, with their derivatives."""
    moved = zip(("q", "dq", "ddq"), one.carry(point), other.carry(point), strict=True)
    turned = {name: (getattr(one, name), getattr(other, name)) for name in ("psi", "dpsi", "ddpsi")}
    return {**{name: (mine, its) for name, mine, its in moved}, **turned}


def _is_uniform(body: Body, outlines: Sequence[Outline]) -> None:
    areas = [abs(area_of(each)) for each in outlines]
    plates = [polygon("", body.mass * area / sum(areas), each) for area, each in zip(areas, outlines, strict=True)]
    mass = body.mass or 1.0
    centroid = sum(plate.mass * plate.centroid for plate in plates) / mass
    inertia = sum(plate.inertia + plate.mass * abs(plate.centroid - centroid) ** 2 for plate in plates)
    size = max(abs(corner - body.centroid) for each in outlines for corner in each)
    _demand(
        body.mass == 0 or abs(centroid - body.centroid) <= OUTLINE_DIFFERENCE * size,
        f"the centroid of {body.name} is {body.centroid:.6g} m, but that of its outlines {centroid:.6g} m",
    )
    _demand(
        abs(inertia - body.inertia) <= OUTLINE_DIFFERENCE * body.mass * size**2,
        f"the inertia of {body.name} is {body.inertia:.6g} kg m2, but that of its outlines {inertia:.6g} kg m2",
    )


def _can_be_within(body: Body) -> None:
    """Check that the centroid is in the convex hull of the outline, and the inertia possible for a mass within it."""
    corners = np.asarray(body.outline, np.complex128)
    reach = float(np.abs(corners - body.centroid).max())
    turned = np.exp(1j * np.linspace(0.0, 2 * np.pi, 360, endpoint=False))
    out = float(((body.centroid - corners[:, None]) * turned).real.min(axis=0).max())
    _demand(out <= OUTLINE_DIFFERENCE * reach, f"the centroid of {body.name} is {out:.4g} m outside of its outline")
    _demand(
        body.inertia <= body.mass * reach**2 * (1 + OUTLINE_DIFFERENCE),
        f"the inertia of {body.name} is {body.inertia:.6g} kg m2, more than that of all its mass at the furthest "
        f"corner of its outline, {body.mass * reach**2:.6g} kg m2",
    )


ELONGATION_POINTS = 20_001
MAX_RELATIVE_ERROR = 1e-6  # error of the differences over the largest value


def check_law(element: Element, shortest: float, longest: float) -> None:
    """Check the law of an element for consistency over a range of elongations.

    Parameters
    ----------
    element : Element
        Any element without memory or rate dependence.
    shortest, longest : float
        The range [m]; 0 need not be in it.

    Raises
    ------
    AssertionError
        If its energy at rest is not 0, its energy is not the integral of its force, or its slope not the derivative of
        its force.

    Examples
    --------
    >>> from rocking_cli.core import Spot
    >>> from rocking_cli.core.hung.element import Spring
    >>> check_law(Spring("bar", (Spot(None, 0j), Spot("block", 3j)), 1e6, 2e4, only="tension"), -0.05, 0.05)
    """
    e = np.linspace(shortest, longest, ELONGATION_POINTS)
    force, energy, slope = element.force(e), element.energy(e), element.slope(e, np.ones(ELONGATION_POINTS))
    _demand(abs(float(element.energy(np.zeros(1))[0])) == 0, f"{element.name}: its energy is not 0 at rest")
    step = e[1] - e[0]
    # Compare changes between points without a corner in between to the slopes at these points.
    for value, rate, fault in ((energy, force, "its energy is not the integral of its force"),
                              (force, slope, "its slope is not the derivative of its force")):  # fmt: skip
        change, mean = np.diff(value), step / 2 * (rate[1:] + rate[:-1])
        off = np.abs(change - mean) > np.abs(np.diff(rate)) * step + MAX_RELATIVE_ERROR * np.abs(mean).max()
        _demand(not off.any(), f"{element.name}: {fault}, at e = {e[int(off.argmax())]:.4g} m")
