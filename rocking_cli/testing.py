"""The contract every mechanism must keep, as a test class for plugin authors.

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

import numpy as np

from rocking_cli.core import Direction, Mechanism, equivalent_block, polygon
from rocking_cli.registry import conformance

STEP = 1e-5  # of phi in difference quotients, whose error is then about 1e-10 of the third derivative
BEYOND = 1.2  # of the critical rotation: up to where the motion must be smooth,
REACH = 0.8  # of the kinematic limit, near which derivatives grow without bound
DRAWN = 2e-3  # how near, over the size of a body, its outlines with their straight sides must come to its inertia


class MechanismContract:
    """Tests of one structure; a subclass gives it as the fixture `structure`."""

    def test_is_declared(self, structure: Mechanism) -> None:
        """It has a name, a title and a source, and every abstract method."""
        assert conformance(type(structure), structure.mechanism) == []

    def test_fields_say_what_they_are(self, structure: Mechanism) -> None:
        """Every field has a description."""
        assert [key for key, field in type(structure).model_fields.items() if not field.description] == []

    def test_bodies_have_mass(self, structure: Mechanism) -> None:
        """Masses and inertias are finite and not negative, and there is some mass."""
        bodies = structure.bodies()
        numbers = [value for body in bodies for value in (body.mass, body.inertia)]
        assert np.isfinite(numbers).all() and min(numbers) >= 0
        assert sum(body.mass for body in bodies) > 0

    def test_moves_from_rest(self, structure: Mechanism) -> None:
        """At phi = 0 every body is where it rests, in both directions."""
        for direction in Direction:
            for body, motion in zip(structure.bodies(), structure.motion(np.zeros(1), direction), strict=True):
                assert abs(motion.carry(body.centroid)[0][0] - body.centroid) <= 1e-9 * (1 + abs(body.centroid))
                assert abs(motion.psi[0]) <= 1e-9

    def test_derivatives_are_those_of_the_motion(self, structure: Mechanism) -> None:
        """First and second derivatives agree with difference quotients of what they derive."""
        for direction in Direction:
            top = min(BEYOND * structure.critical_rotation(direction), REACH * structure.limit(direction))
            phi = np.linspace(0.02, 1.0, 9) * top
            moved = [structure.motion(phi + shift, direction) for shift in (-STEP, 0.0, STEP)]
            for body, before, here, after in zip(structure.bodies(), *moved, strict=True):
                (z0, dz0, _), (_, dz, ddz), (z1, dz1, _) = (
                    motion.carry(body.centroid) for motion in (before, here, after)
                )
                for values, derivative in (
                    ((z1 - z0), dz),
                    ((dz1 - dz0), ddz),
                    ((after.psi - before.psi), here.dpsi),
                    ((after.dpsi - before.dpsi), here.ddpsi),
                ):
                    scale = 1 + np.abs(derivative).max()
                    np.testing.assert_allclose(values / (2 * STEP), derivative, rtol=0, atol=1e-6 * scale)

    def test_energies_agree_with_coefficients(self, structure: Mechanism) -> None:
        """G is V'/g and J is I'/2."""
        for direction in Direction:
            phi = np.linspace(0.05, 0.95, 7) * structure.critical_rotation(direction)
            below, here, above = (structure.coefficients(phi + shift, direction) for shift in (-STEP, 0.0, STEP))
            np.testing.assert_allclose((above.V - below.V) / (2 * STEP), here.G, rtol=0, atol=1e-6 * here.G.max())
            np.testing.assert_allclose((above.I - below.I) / (4 * STEP), here.J, rtol=0, atol=1e-6 * here.I.max())

    def test_stands_and_can_overturn(self, structure: Mechanism) -> None:
        """It resists at rest, balances before its kinematic limit, and falls beyond."""
        for direction in Direction:
            assert structure.uplift(direction) > 0
            phi_cr, limit = structure.critical_rotation(direction), structure.limit(direction)
            assert 0 < phi_cr < limit
            around = structure.coefficients(np.array([0.999, 1.0, 1.001]) * phi_cr, direction)
            assert around.G[0] > 0 > around.G[2]
            assert abs(around.G[1]) <= 1e-12 * abs(around.dG[1])

    def test_closed_forms_agree_with_the_solvers(self, structure: Mechanism) -> None:
        """A solver that is overridden gives what the base class would have found."""
        for direction in Direction:
            np.testing.assert_allclose(
                structure.critical_rotation(direction), Mechanism.critical_rotation(structure, direction), rtol=1e-11
            )
            np.testing.assert_allclose(structure.uplift(direction), Mechanism.uplift(structure, direction), rtol=1e-11)

    def test_has_an_equivalent_block(self, structure: Mechanism) -> None:
        """All parameters are finite, and all but eta positive."""
        equivalence = equivalent_block(structure)
        for direction in Direction:
            parameters = equivalence[direction].as_dict()
            assert np.isfinite(list(parameters.values())).all()
            assert min(value for key, value in parameters.items() if key != "eta") > 0

    def test_an_impact_gains_no_energy(self, structure: Mechanism) -> None:
        """With the restitution of the kinematics."""
        rest = np.zeros(1)
        for direction in Direction:
            eta = structure.restitution_from_kinematics(direction)
            before = structure.kinetic_inertia(rest, direction)[0]
            assert eta**2 * structure.kinetic_inertia(rest, direction.opposite)[0] <= before * (1 + 1e-12)

    def test_outlines_are_those_of_the_bodies(self, structure: Mechanism) -> None:
        """What the sketch names is a body, outlines enclose something, and uniform ones have the body's inertia."""
        sketch = structure.sketch()
        bodies = {body.name: body for body in structure.bodies()}
        assert {*sketch.outlines, *sketch.copies} <= set(bodies)
        assert all(copies and copies[0] == 0 for copies in sketch.copies.values())
        for name, outlines in sketch.outlines.items():
            areas = []
            for each in outlines:
                z = np.asarray(each, np.complex128)
                assert z.size >= 3 and np.isfinite(z).all()
                areas.append(abs((z.conj() * np.roll(z, -1)).imag.sum()) / 2)
            assert outlines and min(areas) > 0
            if not sketch.uniform:
                continue
            body = bodies[name]
            plates = [
                polygon(name, body.mass * area / sum(areas), each) for area, each in zip(areas, outlines, strict=True)
            ]
            centroid = sum(plate.mass * plate.centroid for plate in plates) / body.mass
            inertia = sum(plate.inertia + plate.mass * abs(plate.centroid - centroid) ** 2 for plate in plates)
            size = max(abs(corner - body.centroid) for each in outlines for corner in each)
            assert abs(centroid - body.centroid) <= DRAWN * size
            np.testing.assert_allclose(inertia, body.inertia, rtol=0, atol=DRAWN * body.mass * size**2)

    def test_hinges_hold_together(self, structure: Mechanism) -> None:
        """The bodies that a hinge joins never part there; what it joins to the ground stays, or slides as it says."""
        names = [body.name for body in structure.bodies()]
        for direction, hinges in structure.sketch().hinges.items():
            top = min(BEYOND * structure.critical_rotation(direction), REACH * structure.limit(direction))
            moved = dict(zip(names, structure.motion(np.linspace(0.0, top, 9), direction), strict=True))
            for hinge in hinges:
                assert len(hinge.bodies) in (1, 2) and set(hinge.bodies) <= set(names)
                first, *others = (moved[name].carry(hinge.point)[0] for name in hinge.bodies)
                gap = first - (others[0] if others else hinge.point)
                across = (gap / hinge.slide).imag if hinge.slide else gap
                assert np.abs(across).max() <= 1e-9 * (1 + abs(hinge.point))
