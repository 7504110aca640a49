"""Free blocks as a model of MuJoCo.

Size, weight and gravitational acceleration of the structure are 1 in it, so that what is small is small for a pinnacle
and for a tower. The plane of the structure is x-z, and depths are along y: blocks are prisms that cannot leave it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from importlib.util import find_spec
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core import PointMass
from rocking_cli.core.hung.element import Spring
from rocking_cli.errors import InputError, Problem, RockingError, SolverError
from rocking_cli.studies.engines.free_blocks import FreeBlocks, HalfPlane, HeldPoint
from rocking_cli.text import one_line

if TYPE_CHECKING:
    import mujoco

IMPEDANCE = (0.95, 0.99)  # share of a force by which a contact resists: at first touch, and from a depth on
FULL_DEPTH = 10.0  # this depth, over gravity times the square of the time in which a contact recovers
SLIP_STIFFNESS = 10.0  # stiffness of friction over that of contact
DEPTH = 0.1  # of the prisms, over the size; without effect
PEG = 0.01  # radius of the pegs that guides and floors act on, over the size
UNBOUNDED = 1e6  # over the size
FIRST_VERSION = (3, 13)  # of MuJoCo: older ones miss corners of tilted faces that touch
REINSTALL = "pip uninstall -y mujoco mujoco-core, then pip install 'rocking-cli[blocks]'"


def engine_version() -> str:
    """Return the version of MuJoCo. Raises `InputError` if it is not installed, broken, or too old."""
    if find_spec("mujoco") is None:
        what = "free blocks are simulated by MuJoCo, which is not installed"
        raise InputError(Problem(what, field="engine", hint="pip install 'rocking-cli[blocks]'"))
    try:
        import mujoco

        version = str(mujoco.__version__)
        numbers = tuple(map(int, version.split(".")[:2]))
    except Exception as error:  # a damaged library raises errors of any kind
        why = f"MuJoCo, which simulates free blocks, is installed but does not load ({one_line(str(error))})"
        raise InputError(Problem(why, field="engine", hint=REINSTALL)) from None
    if numbers < FIRST_VERSION:
        why = f"MuJoCo {version} misses contacts of tilted bodies, by which peaks are off by up to 13 %"
        raise InputError(Problem(why, field="engine", hint=REINSTALL))
    return version


@contextmanager
def mujoco_errors() -> Iterator[None]:
    """Make a `SolverError`, which says what to do, of whatever MuJoCo raises."""
    try:
        yield
    except (RockingError, MemoryError):
        raise
    except Exception as error:  # a damaged library raises errors of any kind
        what = f"MuJoCo, which simulates free blocks, failed: {type(error).__name__}: {one_line(str(error))}"
        raise SolverError(
            f"{what}: reinstall it ({REINSTALL}), or leave free blocks out with `engine` exact"
        ) from error


@dataclass(frozen=True, eq=False)
class BlockScene:
    """Free blocks as a model of MuJoCo.

    Parameters
    ----------
    model : mujoco.MjModel
        The model: each block has three coordinates, in the order of the blocks.
    size : float
        The unit of length: the diagonal of the box around the structure [m].
    unit_of_time : float
        [s]
    mass : float
        The unit of mass, the mass of the structure [kg].
    owners : sequence of str
        The block of each geometry of the model; empty for what does not move.
    sizes : ndarray, shape (geometries,)
        The largest width of each geometry of a block; infinite for what does not move [m].
    """

    model: mujoco.MjModel
    size: float
    unit_of_time: float
    mass: float
    owners: tuple[str, ...]
    sizes: Reals

    @mujoco_errors()
    def digest(self) -> str:
        """Return a digest of the model and of the version of MuJoCo."""
        import mujoco

        buffer = np.zeros(mujoco.mj_sizeModel(self.model), np.uint8)
        mujoco.mj_saveModel(self.model, None, buffer)
        return sha256(buffer.tobytes() + engine_version().encode()).hexdigest()


@mujoco_errors()
def scene(free: FreeBlocks, time_constant: float) -> BlockScene:
    """Return free blocks as a model of MuJoCo.

    Parameters
    ----------
    free : FreeBlocks
        The blocks.
    time_constant : float
        Time in which a contact recovers [s].

    Raises
    ------
    InputError
        If MuJoCo is not installed.
    SolverError
        If MuJoCo fails.
    """
    engine_version()
    return _Builder(free, time_constant).built()


def softness(time_constant: float) -> dict[str, Any]:
    """Return the parameters of contacts that recover in a time, over the unit of time."""
    return {"solref": [time_constant, 1.0], "solimp": [*IMPEDANCE, FULL_DEPTH * time_constant**2, 0.5, 2.0]}


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return a model with the solver of free blocks."""
    import mujoco

    model = spec.compile()
    option = model.opt
    option.cone, option.integrator = mujoco.mjtCone.mjCONE_ELLIPTIC, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.iterations, option.tolerance, option.impratio = 100, 1e-10, SLIP_STIFFNESS
    return model


def diverged(data: mujoco.MjData) -> bool:
    """Return whether a step has diverged."""
    import mujoco

    kinds = mujoco.mjtWarning
    warned = data.warning.number[[int(kinds.mjWARN_BADQPOS), int(kinds.mjWARN_BADQVEL), int(kinds.mjWARN_BADQACC)]]
    return bool(warned.any()) or not np.isfinite(data.qvel).all()


class _Builder:
    """A model of MuJoCo that is being built; its geometries are named by their number."""

    def __init__(self, free: FreeBlocks, time_constant: float) -> None:
        import mujoco

        self.mujoco, self.free = mujoco, free
        low, high = free.box
        self.size = abs(high - low)
        self.unit_of_time = free.unit_of_time
        self.mass = sum(body.mass for body in free.bodies) + sum(load.mass for load in free.floors)
        self.spec = mujoco.MjSpec()
        self.soft = softness(time_constant / self.unit_of_time)
        self.geometries: list[tuple[str, float]] = []  # owner and size
        self.bodies = {body.name: self._block(body.name) for body in free.bodies}

    def built(self) -> BlockScene:
        """Return the model, with all that it has besides blocks."""
        for piece in (piece for pieces in self.free.ground.values() for piece in pieces):
            if isinstance(piece, HalfPlane):
                self._plane(piece, self.free.friction)
            else:
                self._prism(self.spec.worldbody, piece, 0j, "", self.free.friction)
        for wall in self.free.walls:
            self._plane(wall, 0.0)
        for guide in self.free.guides:
            self._hold(guide)
        for floor in self.free.floors:
            self._lay(floor)
        for tie in self.free.ties:
            self._tie(tie)
        for (one, other), friction in self.free.frictions.items():
            for a, b in ((a, b) for a in self._of(one) for b in self._of(other)):
                self.spec.add_pair(
                    geomname1=a, geomname2=b, condim=3 if friction else 1, friction=[friction, friction, 0, 0, 0],
                    **self.soft,
                )  # fmt: skip
        model = compiled(self.spec)
        # MuJoCo orders geometries by their bodies.
        owners, sizes = zip(*(self.geometries[int(model.geom(k).name)] for k in range(model.ngeom)), strict=True)
        return BlockScene(model, self.size, self.unit_of_time, self.mass, owners, np.array(sizes))

    def _block(self, name: str) -> mujoco.MjsBody:
        body = next(each for each in self.free.bodies if each.name == name)
        joints, at = self.mujoco.mjtJoint, body.centroid / self.size
        block = self.spec.worldbody.add_body(
            name=name, pos=[at.real, 0.0, at.imag], mass=body.mass / self.mass, ipos=[0.0, 0.0, 0.0],
            inertia=[body.inertia / (self.mass * self.size**2)] * 3, explicitinertial=True,
        )  # fmt: skip
        block.add_joint(type=joints.mjJNT_SLIDE, axis=[1, 0, 0])
        block.add_joint(type=joints.mjJNT_SLIDE, axis=[0, 0, 1])
        block.add_joint(type=joints.mjJNT_HINGE, axis=[0, -1, 0])  # anticlockwise
        for z in self.free.shapes[name]:
            self._prism(block, z, body.centroid, name, self.free.friction)
        return block

    def _of(self, owner: str) -> list[str]:
        return [str(k) for k, (name, _) in enumerate(self.geometries) if name == owner]

    def _named(self, owner: str, size: float = inf) -> str:
        """Return the name of the next geometry."""
        self.geometries.append((owner, size))
        return str(len(self.geometries) - 1)

    def _prism(self, body: mujoco.MjsBody, z: Points, about: complex, owner: str, friction: float) -> None:
        """Add a convex polygon to a body, whose place is `about`."""
        name = self._named(owner, float(np.abs(z[:, None] - z).max()) if owner else inf)
        away = (z - about) / self.size
        corners = [(point.real, y, point.imag) for y in (-DEPTH / 2, DEPTH / 2) for point in away.tolist()]
        self.spec.add_mesh(name=name, uservert=np.ravel(corners).tolist())
        body.add_geom(
            name=name, type=self.mujoco.mjtGeom.mjGEOM_MESH, meshname=name, mass=0.0, **self._rough(friction),
            **self.soft,
        )  # fmt: skip

    def _plane(self, plane: HalfPlane, friction: float) -> None:
        at, normal = plane.at / self.size, plane.normal
        self.spec.worldbody.add_geom(
            name=self._named(""), type=self.mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=[at.real, 0.0, at.imag],
            zaxis=[normal.real, 0.0, normal.imag], **self._rough(friction), **self.soft,
        )  # fmt: skip

    def _rough(self, friction: float) -> dict[str, Any]:
        """Return the friction of a geometry; one without any has none against all others."""
        return {"friction": [friction, 0.0, 0.0], "condim": 3 if friction else 1, "priority": 0 if friction else 1}

    def _place(self, block: str | None, at: complex) -> tuple[mujoco.MjsBody, list[float]]:
        """Return a block, or the ground, and the place of a point in its frame."""
        about = next((body.centroid for body in self.free.bodies if body.name == block), 0j)
        away = (at - about) / self.size
        return self.bodies[block] if block else self.spec.worldbody, [away.real, 0.0, away.imag]

    def _hold(self, guide: HeldPoint) -> None:
        """Hold a point in place, or between two smooth faces."""
        if guide.along == 0:
            _, where = self._place(guide.block, guide.at)
            self.spec.add_equality(
                type=self.mujoco.mjtEq.mjEQ_CONNECT, objtype=self.mujoco.mjtObj.mjOBJ_BODY, name1=guide.block,
                name2="world", data=[*where, *[0.0] * 9], **self.soft,
            )  # fmt: skip
            return
        peg, across = self._peg(guide.block, guide.at), 1j * guide.along / abs(guide.along)
        for normal in (across, -across):
            self._face(self.spec.worldbody, guide.at / self.size, normal, peg)

    def _lay(self, floor: PointMass) -> None:
        """Lay a plate that only moves up and down on a point of a block."""
        at = floor.spot.at / self.size
        plate = self.spec.worldbody.add_body(
            pos=[at.real, 0.0, at.imag], mass=floor.vertical * floor.mass / self.mass, ipos=[0.0, 0.0, 0.0],
            inertia=[1.0] * 3, explicitinertial=True, gravcomp=1 - floor.weight / floor.vertical,
        )  # fmt: skip
        plate.add_joint(type=self.mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
        # MuJoCo disregards gravcomp unless one of all bodies is positive.
        self.spec.worldbody.add_body(gravcomp=1.0)
        self._face(plate, 0j, -1j, self._peg(floor.spot.body or "", floor.spot.at))

    def _peg(self, block: str, at: complex) -> str:
        body, where = self._place(block, at)
        name = self._named(block)
        sphere = self.mujoco.mjtGeom.mjGEOM_SPHERE
        body.add_geom(name=name, type=sphere, size=[PEG, 0, 0], pos=where, mass=0.0, contype=0, conaffinity=0)
        return name

    def _face(self, body: mujoco.MjsBody, at: complex, normal: complex, peg: str) -> None:
        """Hold a peg at a place on the side of a smooth face to which the normal points."""
        name, away = self._named(""), at - (PEG + DEPTH) * normal
        body.add_geom(
            name=name, type=self.mujoco.mjtGeom.mjGEOM_BOX, size=[UNBOUNDED, UNBOUNDED, DEPTH],
            pos=[away.real, 0.0, away.imag], zaxis=[normal.real, 0.0, normal.imag], mass=0.0, contype=0, conaffinity=0,
        )  # fmt: skip
        self.spec.add_pair(geomname1=name, geomname2=peg, condim=1, **self.soft)

    def _tie(self, tie: Spring) -> None:
        stiffness = tie.count * tie.stiffness * self.size / (self.mass * self.free.gravity)
        long = sum(abs(there.at - here.at) for here, there in pairwise(tie.spots))
        slack = (long - tie.prestress / tie.stiffness) / self.size
        spans: Mapping[str | None, list[float]] = {"tension": [0.0, slack], "compression": [slack, UNBOUNDED]}
        tendon = self.spec.add_tendon(
            name=f"{len(self.spec.tendons)}", stiffness=[stiffness, 0, 0],
            springlength=[max(each, 0.0) for each in spans.get(tie.only, [slack, slack])],
        )  # fmt: skip
        if slack < 0:  # it pulls at any length: a spring that has no length of its own, and a constant force
            self.spec.add_actuator(
                target=tendon.name, trntype=self.mujoco.mjtTrn.mjTRN_TENDON, gainprm=[0.0] * 10,
                biastype=self.mujoco.mjtBias.mjBIAS_AFFINE, biasprm=[stiffness * slack, *[0.0] * 9],
            )  # fmt: skip
        for k, spot in enumerate(tie.spots):
            body, where = self._place(spot.body, spot.at)
            site = f"{tendon.name} {k}"
            body.add_site(name=site, pos=where)
            tendon.wrap_site(site)
