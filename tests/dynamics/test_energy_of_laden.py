"""Random structures with loads, ties and forces: what the ground puts in, less what impacts lose, is what is stored."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking_cli import GroundMotion, Registry
from rocking_cli.core import Direction, Mechanism
from rocking_cli.dynamics.history import follow
from rocking_cli.errors import FieldError
from rocking_cli.structure import build_models

shares = st.floats(0, 1)
across, up = st.floats(-0.5, 0.5), st.floats(0.0, 5.0)


@st.composite
def laden(draw):
    """A block 1 x 5 m of 10 t with anything on it that it can stand under, or None."""
    loads = [
        {"name": "mass", "mass": draw(st.floats(10, 5e3)), "at": [draw(across), draw(up)],
         "horizontal": draw(shares), "vertical": draw(shares), "weight": draw(shares)},
        {"name": "force", "force": [draw(st.floats(-2e3, 2e3)), draw(st.floats(-5e3, 5e3))], "at": [draw(across), 4.0]},
    ]  # fmt: skip
    ties = [
        {"name": "bar", "from": {"ground": [draw(st.floats(-6, -1)), draw(up)]}, "to": {"at": [-0.5, draw(up)]},
         "stiffness": draw(st.floats(0, 2e5)), "prestress": draw(st.floats(0, 3e3)),
         "only": draw(st.sampled_from([None, "tension"]))},
        {"name": "prop", "from": {"ground": [draw(st.floats(1, 6)), draw(up)]}, "to": {"at": [0.5, draw(up)]},
         "stiffness": draw(st.floats(1e2, 2e5)), "only": "compression"},
        {"name": "tendon", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 0.0]},
         "stiffness": draw(st.floats(1e2, 3e6))},
        {"name": "bed", "bed": {"from": [-0.5, 0.0], "to": [0.5, 0.0]}, "modulus": draw(st.floats(1e2, 1e5))},
    ]  # fmt: skip
    chosen = [tie for tie in ties if draw(st.booleans())]
    try:
        return Registry()["block"](
            width=1.0, height=5.0, mass=10e3, loads=loads[draw(st.integers(0, 2)) :], ties=chosen
        )
    except FieldError as error:
        assert "cannot stand" in str(error) or "nothing stretches" in str(error)
        return None


def energies(structure: Mechanism, phi, rate):
    """T + V along signed motions."""
    total = np.zeros(phi.shape)
    for direction in Direction:
        mine = phi * direction > 0
        at = np.abs(phi[mine])
        total[mine] = structure.kinetic_inertia(at, direction) * rate[mine] ** 2 / 2
        total[mine] += structure.potential_energy(at, direction)
    return total


def missing(structure, model, rtol):
    """By how much the energy of a motion from a tilt changes on its way to the first impact, over all of it."""
    still = GroundMotion("still", 0.002, np.zeros(2), unit="m/s2")
    history = follow(model, still, release=0.3, rtol=rtol)
    end = history.impacts[0, 0] if len(history.impacts) else history.time[-1]
    before = (history.time < end) & np.isfinite(history.phi) & (history.phi > 0)
    found = energies(structure, history.phi[before], history.rate[before])
    lost = abs(found - found[0]).max()
    if len(history.impacts):
        inertia = structure.kinetic_inertia(np.zeros(1), Direction.POSITIVE)[0]
        lost = max(lost, abs(inertia * history.impacts[0, 2] ** 2 / 2 - found[0]))
    return lost / found[0]


@pytest.mark.every(3)
@settings(max_examples=10)
@given(laden())
def test_from_a_tilt_to_the_impact_no_energy_is_lost(structure):
    if structure is not None and structure.uplift(Direction.POSITIVE) > 1e-3:
        (model,) = build_models(structure, ("nonlinear",))
        for rtol in (1e-6, 1e-9) if model.phi_cr[0] >= 1e-3 else ():
            assert missing(structure, model, rtol) < 100 * rtol


@pytest.mark.rest
@settings(max_examples=15)
@given(laden(), st.floats(-6.0, 6.0), st.floats(2.0, 12.0), st.booleans())
def test_what_the_ground_puts_in_less_what_impacts_lose_is_stored(structure, strength, pace, both_ways):
    """Over a motion with a vertical component: dE = -(u B s + v G) dphi, B and G of the bodies and loads."""
    if structure is None or min(structure.uplift(direction) for direction in Direction) < 1e-3:
        return
    dt = 0.05
    t = dt * np.arange(31)
    u, v = strength * np.sin(pace * t), (2.0 if both_ways else 0.0) * np.cos(pace * t)
    motion = GroundMotion("u", dt, u, vertical=GroundMotion("v", dt, v, unit="m/s2"), unit="m/s2")
    fine = 48  # samples of the history in each interval: the rule of Boole sees the corners of ties
    dense = np.arange(30 * fine + 1) * dt / fine
    shaken = GroundMotion(
        "u",
        dt / fine,
        np.interp(dense, t, u),
        vertical=GroundMotion("v", dt / fine, np.interp(dense, t, v), unit="m/s2"),
        unit="m/s2",
    )
    (model,) = build_models(structure, ("nonlinear",))
    history = follow(model, shaken, rtol=1e-11)
    assert follow(model, motion).uplift_time == pytest.approx(history.uplift_time, abs=1e-9, nan_ok=True)
    if not np.isfinite(history.uplift_time):
        return
    impacts = history.impacts[:, 0]
    # Stretches of 8 intervals without an impact, an uplift, or rest.
    for k in range(0, dense.size - 9, 8):
        piece = slice(k, k + 9)
        phi, rate, time = history.phi[piece], history.rate[piece], dense[piece]
        if not np.isfinite(phi).all() or (phi == 0).any() or ((impacts > time[0]) & (impacts < time[-1])).any():
            continue
        if np.sign(phi[0]) != np.sign(phi[-1]) or phi.size < 9:
            continue
        direction = Direction(int(np.sign(phi[0])))
        at = structure.coefficients(np.abs(phi), direction)
        power = -(shaken.acceleration[piece] * at.B + direction * shaken.vertical.acceleration[piece] * at.G) * rate
        boole = np.array([989, 5888, -928, 10496, -4540, 10496, -928, 5888, 989]) * 4 / 14175 * dt / fine
        stored = energies(structure, phi, rate)
        assert stored[-1] - stored[0] == pytest.approx(boole @ power, abs=1e-6 * (1 + abs(stored).max()))
