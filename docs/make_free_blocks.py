"""Renew the evidence in docs/free_blocks.md: what contacts of free blocks do, beside what they should. Ten minutes.

python -m docs.make_free_blocks     # make free-blocks
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import cache
from itertools import pairwise
from math import atan, ceil, sin
from typing import NamedTuple

import numpy as np

from rocking_cli import Block, GroundMotion, Registry, load_structure, parse_pulse, read_record
from rocking_cli.arrays import Reals
from rocking_cli.core import Mechanism
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import follow
from rocking_cli.studies.engines.blocks import BlockModel, BlockMotion
from rocking_cli.studies.engines.free_blocks import FreeBlocks, free_blocks
from validation.pages import DOCS, renewed, table

PAGE, EXAMPLES = DOCS / "free_blocks.md", DOCS.parent / "examples"
G = 9.80665
AFTER = 1.5  # s after a motion for which its peak is looked for
RECOVERED = 10  # time constants in which contacts give back what they stored in an impact

# Motions whose peak is no chance: that of every neighbour (1 % of amplitude, .01 of restitution) is within 15 %.
HALVED = [
    (name, motion)
    for name, motions in {
        "block.yaml": ("accel.csv x 1", "sine:0.45g:0.5s", "cosine:0.45g:0.6s"),
        "masonry/portal.yaml": ("accel.csv x 1", "accel.csv x 1.5", "sine:0.42g:0.8s"),
        "wall.yaml": ("sine:0.9g:0.3s", "sine:1.1g:0.3s", "cosine:1.1g:0.3s"),
    }.items()
    for motion in motions
]
BOUNCES = [
    (slenderness, height, tilt) for slenderness in (3, 5, 10) for height in (0.1, 1.0, 10.0) for tilt in (0.3, 0.6)
]
# Structures with hinges, guides, loads, floors and ties that turn back from .3 of the critical rotation by themselves.
FALLING = (
    "block.yaml", "rigid_body.yaml", "cone.yaml", "wall.yaml", "frame.yaml", "symmetric_frame.yaml",
    "masonry/portal.yaml", "masonry/wall_of_three.yaml", "walls/column_with_tendon.yaml", "walls/floor_wall.yaml",
    "linkages/beam_on_pier.yaml", "linkages/pinnacle_on_buttress.yaml", "linkages/portico.yaml",
    "linkages/two_storeys.yaml",
)  # fmt: skip
FREE = ("block.yaml", "wall.yaml", "masonry/portal.yaml", "arch.yaml", "masonry/buttressed_arch.yaml")
SLIDES = ((0.3, 0.4), (0.39, 0.4), (0.5, 0.4), (0.7, 0.4), (0.7, 0.6))  # acceleration over g, friction


class Free(NamedTuple):
    """Free blocks, their model, and their motion."""

    blocks: FreeBlocks
    model: BlockModel
    motion: BlockMotion

    @property
    def phi(self) -> Reals:
        """Rotation [rad]."""
        return self.blocks.rotation(self.motion.moved)

    @property
    def energy(self) -> Reals:
        """Kinetic and potential energy, without that of contacts and ties [J]."""
        masses, inertias = (
            np.array([getattr(body, key) for body in self.blocks.bodies]) for key in ("mass", "inertia")
        )
        moved, rates = self.motion.moved, self.motion.rates
        return np.asarray(
            (masses * (self.blocks.gravity * moved[..., 1] + (rates[..., :2] ** 2).sum(axis=-1) / 2)).sum(axis=-1)
            + (inertias * rates[..., 2] ** 2 / 2).sum(axis=-1)
        )

    def growth(self, start: float = 0.0) -> float:
        """Return the largest growth of energy after a time, over its largest value.

        What contacts store in an impact they give back at once: the least energy is that of whole intervals.
        """
        dt = self.motion.time[1]
        count = ceil(RECOVERED * self.model.time_constant / dt) + 2
        energy = self.energy[ceil(start / dt) :]
        most = np.lib.stride_tricks.sliding_window_view(energy, count).max(axis=1)
        return float((most - np.minimum.accumulate(most)).max() / self.energy.max())


@cache
def structure(name: str) -> Structure:
    """Return an example."""
    return Structure(load_structure(EXAMPLES / name))


def motion_of(name: str) -> GroundMotion:
    """Return a scaled record, or a pulse."""
    record, _, factor = name.partition(" x ")
    return read_record(EXAMPLES / record).scaled(float(factor)) if factor else parse_pulse(name).sampled()


def simulated(mechanism: Mechanism, motion: GroundMotion | None, finer: float = 1.0, **how: float) -> Free:
    """Simulate a structure as free blocks."""
    blocks = free_blocks(mechanism)
    model = BlockModel(blocks, finer)
    return Free(blocks, model, model.simulate(motion, **how))


def released(mechanism: Mechanism, phi: float, finer: float = 1.0, **how: float) -> Free:
    """Simulate a structure as free blocks, let go from a tilt."""
    blocks = free_blocks(mechanism)
    model = BlockModel(blocks, finer)
    return Free(blocks, model, model.simulate(None, start=blocks.tilted(mechanism, phi), **how))


def halves(time: Reals, phi: Reals) -> list[tuple[float, float, int]]:
    """Return time at the end, peak, and place of the peak, of each half-cycle."""
    turns = [0, *(np.flatnonzero(np.diff(np.sign(phi)) != 0) + 1).tolist()]
    found = []
    for first, stop in pairwise(turns):
        place = first + int(np.abs(phi[first:stop]).argmax())
        share = phi[stop - 1] / (phi[stop - 1] - phi[stop]) if phi[stop] != phi[stop - 1] else 0.0
        found.append((float(time[stop - 1] + share * (time[stop] - time[stop - 1])), float(abs(phi[place])), place))
    return found


class Bounce(NamedTuple):
    """The first half-cycles of a block: what its contact does, and by how much the exact history differs."""

    kinematic: float
    eta: float
    times: float
    peaks: float


def bounce(slenderness: float, height: float, tilt: float) -> Bounce:
    """Let a block go from a share of its slenderness, and follow it exactly with the restitution that it shows."""
    alpha, how_long = atan(1 / slenderness), 9 * (height * slenderness / 30) ** 0.5
    block = Block(width=height / slenderness, height=height)
    free = released(block, tilt * alpha, most=how_long)
    first = halves(free.motion.time, free.phi)[:4]
    energies = free.energy[[place for _, _, place in first]]
    # Of the impacts between these half-cycles, by what is left of the energy.
    eta = float((energies[-1] / energies[0]) ** (0.5 / (len(energies) - 1)))
    history = follow(Structure(Block(width=height / slenderness, height=height, restitution=eta)), release=tilt)
    exact = halves(history.time, history.phi)[:3]
    times, peaks = (
        max(abs(one[k] / other[k] - 1) for one, other in zip(first[:3], exact, strict=True)) for k in (0, 1)
    )
    return Bounce(1 - 1.5 * sin(alpha) ** 2, eta, times, peaks)


def halved(name: str, motion: str) -> tuple[float, list[float]]:
    """Return the exact peak of a structure, and that of free blocks by the rule and with half of both [rad]."""
    of, given = structure(name), motion_of(motion)
    history, most = follow(of, given), given.duration + AFTER
    peaks = [float(np.abs(simulated(of.mechanism, given, finer, most=most).phi).max()) for finer in (1.0, 2.0)]
    return max(history.peak_positive, history.peak_negative), peaks


def fall(name: str, share: float = 0.3) -> tuple[float, float]:
    """Return the time from release to the first impact, exact and of free blocks [s]."""
    of = structure(name)
    history = follow(of, release=share)
    first = float(history.impacts[0][0])
    free = released(of.mechanism, share * of.model("nonlinear").phi_cr[0], most=1.2 * first)
    return first, halves(free.motion.time, free.phi)[0][0]


def slide(push: float, friction: float, finer: float = 1.0) -> tuple[float, float]:
    """Return how far a stout block slides in a second under a steady acceleration [g], and how far it should [m]."""
    motion = GroundMotion("steady", 0.01, G * np.r_[np.full(100, push), 0.0], unit="m/s2")
    free = simulated(Block(width=2.0, height=0.5, friction=friction), motion, finer, most=0.99)
    ended = free.motion.time[-1]
    return -float(free.motion.moved[-1, 0, 0]), max(push - friction, 0.0) * G * float(ended) ** 2 / 2


def laden(ratio: float) -> Mechanism:
    """Return a portal whose lintel carries a mass, over that of a pier."""
    boxes = {"left": (0, 0, 0.5, 2), "right": (2.5, 0, 3, 2), "lintel": (-0.1, 2, 3.1, 2.4), "floor": (-2, -1, 5, 0)}
    polygons = {
        name: {"polygon": [[left, low], [right, low], [right, high], [left, high]]}
        for name, (left, low, right, high) in boxes.items()
    }
    ground = {"floor": polygons.pop("floor")}
    load = {"name": "deck", "mass": ratio * 2000.0, "at": [1.5, 2.2], "body": "lintel"}
    fields = {"density": 2000.0, "depth": 1.0, "friction": 0.7, "blocks": polygons, "ground": ground, "loads": [load]}
    return Registry()["assembly"](**fields)


def heavy(ratio: float, finer: float = 1.0) -> tuple[float, float, float]:
    """Return the second maximum of a laden portal that is let go, exact and of free blocks, and the time constant."""
    of = Structure(laden(ratio))
    history = follow(of, release=0.4)
    exact = halves(history.time, history.phi)[1][1]
    how_long = 1.1 * float(history.impacts[1][0])
    free = released(of.mechanism, 0.4 * of.model("nonlinear").phi_cr[0], finer, most=how_long)
    return exact, halves(free.motion.time, free.phi)[1][1], free.model.time_constant


def worst(cases: Mapping[str, float], percent: bool = True) -> str:
    """Return the largest of some numbers with its case."""
    name = max(cases, key=lambda each: cases[each])
    value = f"{100 * cases[name]:.2f} %" if percent else f"{cases[name]:.1g}"
    return f"{value} ({name})"


def evidence() -> str:
    """Return the table of checks."""
    peaks = {f"{name}, {motion}": halved(name, motion) for name, motion in HALVED}
    bounces = {f"{tall} to 1, {height:g} m, {tilt:g}": bounce(tall, height, tilt) for tall, height, tilt in BOUNCES}
    falls = {name: fall(name) for name in FALLING}
    slides = {f"{push:g} g, {friction:g}": slide(push, friction) for push, friction in SLIDES}
    growths = {
        f"{name}, {share:g}": max(released(of.mechanism, share * of.model("nonlinear").phi_cr[0]).growth(), 0.0)
        for name in FREE for share in (0.2, 0.4) for of in [structure(name)]
    }  # fmt: skip
    laden = {f"{ratio:g}": heavy(ratio)[:2] for ratio in (1.0, 10.0, 100.0, 1000.0)}
    rows = {
        "peak, from the exact one":
            worst({name: abs(free / exact - 1) for name, (exact, (free, _)) in peaks.items()}),
        "peak, with half of time constant and step":
            worst({name: abs(two / one - 1) for name, (_, (one, two)) in peaks.items()}),
        "restitution of a block, from kinematics":
            worst({name: abs(each.eta - each.kinematic) for name, each in bounces.items()}, False),
        "its times":
            worst({name: each.times for name, each in bounces.items()}),
        "its peaks": worst({name: each.peaks for name, each in bounces.items()}),
        "time from a release to the first impact":
            worst({name: abs(two / one - 1) for name, (one, two) in falls.items()}),
        "distance of a block that slides":
            worst({name: abs(free / exact - 1) for name, (free, exact) in slides.items() if exact}),
        "creep of one that holds [m]":
            worst({name: free for name, (free, exact) in slides.items() if not exact}, False),
        "growth of energy after a release": worst(growths, False),
        "second maximum of a portal under a mass":
            worst({name: abs(free / exact - 1) for name, (exact, free) in laden.items()}),
    }  # fmt: skip
    return table(("what is compared", "largest difference"), rows.items())


def main() -> int:
    """Renew the page."""
    if len(sys.argv) != 1:
        print(__doc__)
        return 2
    text = renewed(PAGE.read_text(encoding="utf-8"), {"evidence": evidence()})
    PAGE.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
