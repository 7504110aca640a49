"""Structures with their loads and ties, each twice: as the tool takes it, and as the second program does."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from rocking_cli import GroundMotion
from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from tests.oracle import GROUND, Block, Frame, Ground, Structure, Wall

NAMES: Mapping[str, Mapping[str, str]] = {
    "asymmetric_frame": {"left column AB": "left column", "beam BC": "beam", "right column CD": "right column"},
    "wall": {"lower block": "lower", "upper block": "upper"},
}
"""What the second program calls the bodies of a mechanism, where it does not call them the same."""

BARE: Mapping[str, tuple[dict[str, Any], Structure]] = {
    "block": ({"width": 1.0, "height": 5.0, "mass": 10e3}, Block(1.0, 5.0, 10e3)),
    # A box 1 x 3 m with a triangle 0.6 x 3 m leaning against it from the right, 2 t per m2.
    "rigid_body": (
        {"polygon": [[-0.8, 0.0], [0.8, 0.0], [0.2, 3.0], [-0.8, 3.0]], "density": 2000.0, "depth": 1.0},
        Block(
            1.6, 3.0, 7800.0,
            centre=(3 * (-0.3 + 1.5j) + 0.9 * (0.4 + 1j)) / 3.9,
            inertia=2000 * (
                3 * (1 + 9) / 12 + 0.9 * (0.36 + 9) / 18 + 3 * 0.9 / 3.9 * abs(0.7 - 0.5j) ** 2
            ),
        ),
    ),
    "wall": (
        {"thickness": 0.3, "height": 3.0, "mass": 1500.0},
        Wall(0.3, 3.0, 1500.0),
    ),
    "asymmetric_frame": (
        {"column_width": 1.0, "left_height": 6.0, "right_height": 7.5, "spacing": 8.0, "beam_depth": 1.0,
         "left_mass": 1000.0, "beam_mass": 4000.0, "right_mass": 1250.0},
        Frame(1.0, 6.0, 8.0, 1.0, column=1000.0, beam=4000.0, right_height=7.5, right_column=1250.0),
    ),
    # Two columns: the second program has both, with the beam on top.
    "symmetric_frame": (
        {"column_width": 1.0, "column_height": 6.0, "mass_ratio": 2.0, "mass": 6000.0},
        Frame(1.0, 6.0, 8.0, 1.0, column=1000.0, beam=4000.0),
    ),
}  # fmt: skip
"""Fields of a mechanism, and its twin."""


@dataclass(frozen=True)
class Twin:
    """One structure in both programs."""

    tool: Mechanism
    oracle: Structure


def twin(
    mechanism: str, loads: Sequence[Mapping[str, Any]] = (), ties: Sequence[Mapping[str, Any]] = (), **more: Any
) -> Twin:
    """A mechanism of `BARE` with loads and ties as a file has them, and `more` of its fields."""
    fields, oracle = BARE[mechanism]
    for load in loads:
        oracle = _loaded(oracle, mechanism, load)
    for tie in ties:
        oracle = _tied(oracle, mechanism, tie)
    hung = {key: [dict(each) for each in value] for key, value in (("loads", loads), ("ties", ties)) if value}
    tool = Registry()[mechanism].from_fields({**fields, **hung, **more})
    return Twin(tool, oracle)


FLOORS = {"borne": (1.0, 1 / 3, 0.5), "sliding": (0.0, 1 / 3, 0.5), "dragged": (1.0, 1 / 3, 0.5)}


def _bodies(mechanism: str, name: str | None, each: bool) -> list[tuple[str, complex]]:
    """The bodies of the second program that are meant, and how far to the right each stands of where it is given."""
    if mechanism == "symmetric_frame" and name == "columns":
        return [("left column", 0j), ("right column", 8 + 0j)] if each else [("left column", 0j)]
    alone = {"block": "block", "rigid_body": "block"}.get(mechanism)
    assert name is not None or alone
    return [(alone or NAMES.get(mechanism, {}).get(str(name), str(name)), 0j)]


def _loaded(oracle: Structure, mechanism: str, load: Mapping[str, Any]) -> Structure:
    for body, aside in _bodies(mechanism, load.get("body"), bool(load.get("each"))):
        at = complex(*load["at"]) + aside
        if "force" in load:
            oracle = oracle.with_force(body, at, complex(*load["force"]))
        else:
            shares = FLOORS[load["floor"]] if "floor" in load else (1.0, 1.0, 1.0)
            horizontal, vertical, weight = (
                load.get(key, share) for key, share in zip(("horizontal", "vertical", "weight"), shares, strict=True)
            )
            oracle = oracle.with_load(body, at, load["mass"], horizontal, vertical, weight)
    return oracle


def _tied(oracle: Structure, mechanism: str, tie: Mapping[str, Any]) -> Structure:
    if "bed" in tie:
        bed = tie["bed"]
        ((body, aside),) = _bodies(mechanism, bed.get("body"), False)
        ends = (complex(*bed[key]) + aside for key in ("from", "to"))
        return oracle.with_bed(body, *ends, k=tie["modulus"], acts="both")
    places = tie.get("path") or [tie["from"], tie["to"]]
    several = max(
        len(_bodies(mechanism, place.get("body"), bool(tie.get("each")))) for place in places if "at" in place
    )
    for k in range(several):
        path = []
        for place in places:
            if "ground" in place:
                path.append((GROUND, complex(*place["ground"]) + 8 * k))
            else:
                found = _bodies(mechanism, place.get("body"), bool(tie.get("each")))
                body, aside = found[min(k, len(found) - 1)]
                path.append((body, complex(*place["at"]) + (aside if len(found) > 1 else 8 * k)))
        length = tie.get("length") or sum(abs(b - a) for (_, a), (_, b) in pairwise(path))
        stiffness = tie["stiffness"] if "stiffness" in tie else tie["area"] * tie["modulus"] / length
        oracle = oracle.with_tie(*path, k=stiffness, n0=tie.get("prestress", 0.0), acts=tie.get("only", "both"))
    return oracle


def shaking(vertical: bool, factor: float = 1.0) -> tuple[GroundMotion, Ground]:
    """A motion of straight lines, some with a vertical component of another interval."""
    dt, v_dt = 0.1, 0.07
    t, v_t = np.arange(0, 1.21, dt), np.arange(0, 1.05, v_dt)
    u, v = factor * (1.1 * np.cos(11 * t) - 5.0 * np.sin(6.0 * t)), 3.0 * np.cos(9.0 * v_t) - 0.5
    u[0] = u[-1] = 0.0
    v[0] = v[-1] = 0.0
    up = GroundMotion("up", v_dt, v, unit="m/s2")
    both = np.union1d(np.round(t, 12), np.round(v_t, 12))
    ground = Ground(
        both.tolist(),
        np.interp(both, t, u, right=0.0).tolist(),
        np.interp(both, v_t, v, right=0.0).tolist() if vertical else None,
    )
    return GroundMotion("shaking", dt, u, vertical=up if vertical else None, unit="m/s2"), ground
