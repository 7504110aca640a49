"""Assemblies from files and Python, against the built-in arch, statics written out, hand formulas and users' errors."""

from itertools import product
from math import atan

import numpy as np
import pytest
import yaml
from pytest import approx
from scipy.optimize import linprog

import rocking_cli as rk
from mechanisms.assembly import from_the_left
from rocking_cli.core import Direction
from rocking_cli.core.released import released
from rocking_cli.errors import InputError, MechanismError, StructureError
from rocking_cli.studies.contact import Contacts
from tests.cli.test_cli import run, run_json

POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE
g = 9.80665
WEIGHT = {"density": 2000.0, "depth": 1.0}


def rectangle(x0, y0, x1, y1, **more):
    return {"polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]], **more}


FLOOR = {"floor": rectangle(-20.0, -1.0, 20.0, 0.0)}


def assembly(blocks, ground=None, **more):
    return rk.Assembly(blocks=blocks, ground=ground or FLOOR, **{**WEIGHT, **more})


# --- arches ----------------------------------------------------------------------------------------------------------


def sector(r, t, start, end):
    """Area, centroid and polar moment about it of an annular sector, by the textbook."""
    ro, ri, half = r + t / 2, r - t / 2, abs(end - start) / 2
    area = half * (ro**2 - ri**2)
    far = 2 / 3 * (ro**3 - ri**3) / (ro**2 - ri**2) * np.sin(half) / half
    return area, far * np.exp(1j * (start + end) / 2), half * (ro**4 - ri**4) / 2 - area * far**2


def ring(r=10.0, t=1.5, beta=157.5, n=7, edges=8, *, exact=False, digits=None):
    """Blocks and ground of an arch of its voussoirs."""
    angles = np.pi / 2 + np.radians(beta) * (0.5 - np.linspace(0, 1, n + 1))
    blocks, ground = {}, {}

    def drawn(z):
        return [[round(p.real, digits), round(p.imag, digits)] if digits else [p.real, p.imag] for p in z.tolist()]

    for k in range(n):
        way = np.exp(1j * np.linspace(angles[k], angles[k + 1], edges + 1))
        blocks[f"v{k + 1}"] = {"polygon": drawn(np.concatenate([(r + t / 2) * way, (r - t / 2) * way[::-1]]))}
        if exact:
            area, centre, inertia = sector(r, t, angles[k], angles[k + 1])
            at = [float(centre.real), float(centre.imag)]
            numbers = {"mass": float(2000 * area), "centroid": at, "inertia": float(2000 * inertia)}
            blocks[f"v{k + 1}"].update(numbers)
    for name, angle, side in (("left", angles[0], 1j), ("right", angles[-1], -1j)):
        e = np.exp(1j * angle)
        z = np.array([r - t, r + t, r + t + side * t, r - t + side * t]) * e
        ground[name] = {"polygon": drawn(z)}
    return blocks, ground


def arch_of(r=10.0, t=1.5, beta=157.5, n=7, **more):
    given = {**WEIGHT, **more}
    return rk.Arch(radius=r, thickness=t, inclusion_angle_deg=beta, voussoirs=n, **given)


@pytest.mark.every(4)
@pytest.mark.parametrize("digits", [None, 3])
@pytest.mark.parametrize(
    ("beta", "ratio", "n"), [(157.5, 0.15, 7), (120.0, 0.12, 8), (150.0, 0.13, 12), (157.5, 0.2, 9), (90.0, 0.1, 6)]
)
def test_voussoirs_have_the_hinges_of_the_built_in_arch(beta, ratio, n, digits):
    blocks, ground = ring(t=10 * ratio, beta=beta, n=n, edges=4, digits=digits)
    found = assembly(blocks, ground)
    arch = arch_of(t=10 * ratio, beta=beta, n=n)
    for direction in Direction:
        mine = [joint.point for joint in found.joints(direction)]
        theirs = sorted(arch.hinges(direction), key=lambda z: z.real)
        assert len(mine) == 4
        assert np.abs(np.array(mine) - theirs).max() < 1e-3 * 10
        assert found.uplift(direction) == approx(arch.uplift(direction), rel=5e-3)


def test_exact_voussoirs_are_the_built_in_arch():
    blocks, ground = ring(exact=True)
    arch = arch_of()
    lead = {"positive": "v1", "negative": "v7"}
    found = rk.Assembly(blocks=blocks, ground=ground, lead=lead)
    for direction in Direction:
        assert found.uplift(direction) == approx(arch.uplift(direction), rel=1e-9)
        assert found.critical_rotation(direction) == approx(arch.critical_rotation(direction), rel=1e-9)
        assert found.eta(direction) == approx(arch.eta(direction), rel=1e-9)
        said = found.collapse(direction)
        assert said.friction_needed == approx(0.4953, abs=2e-4)
        assert said.valid_to == approx(0.0280, abs=2e-4)
        assert found.critical_rotation(direction) == approx(0.0690, abs=2e-4)
        extras = {each.key: each for each in found.extras(direction)}
        assert extras["valid_to"].value == said.valid_to
        assert extras["friction_needed"].value == said.friction_needed
        at = found.coefficients(np.array([said.valid_to]), direction)
        assert said.held_by == approx(float(at.G[0] / at.B[0]), rel=1e-9)
    assert "v1 and v2" in {each.key: each for each in found.extras(POSITIVE)}["valid_to"].meaning


def test_an_arch_that_slides_says_when_and_has_no_model(tmp_path):
    blocks, ground = ring(exact=True)
    file = tmp_path / "arch.yaml"
    file.write_text(yaml.safe_dump({"mechanism": "assembly", "blocks": blocks, "ground": ground, "friction": 0.35}))
    said = run_json("collapse", file)["directions"]["positive"]
    assert said["lambda"] == approx(0.207, abs=5e-4)
    assert said["slides"]
    assert "no rocking model exists for sliding" in run("equiv", file, code=2).stderr


# --- limit analysis once more ----------------------------------------------------------------------------------------


class Enumerated:
    """All mechanisms of rectangles of density 1 and joints by hand: (bearing block or None, borne block, from, to)."""

    def __init__(self, bodies, joints):
        self.mass = np.array([(x1 - x0) * (y1 - y0) for x0, y0, x1, y1 in bodies.values()])
        self.centre = [complex(x0 + x1, y0 + y1) / 2 for x0, y0, x1, y1 in bodies.values()]
        number = {name: k for k, name in enumerate(bodies)}
        self.joints = [(number.get(a), number[b], p, q) for a, b, p, q in joints]

    def row(self, a, b, at, way):
        """The rate along `way` of a point of b against a."""
        row = np.zeros(3 * len(self.mass))
        for k, sign in ((b, 1), (a, -1)):
            if k is not None:
                arm = at - self.centre[k]
                row[3 * k : 3 * k + 3] = sign * np.array([way.real, way.imag, (np.conj(arm) * way).imag])
        return row

    def rows(self):
        for a, b, p, q in self.joints:
            along = (q - p) / abs(q - p)
            yield self.row(a, b, p, 1j * along), self.row(a, b, q, 1j * along), self.row(a, b, p, along)

    @property
    def weights(self):
        dead, live = np.zeros(3 * len(self.mass)), np.zeros(3 * len(self.mass))
        dead[1::3], live[0::3] = -self.mass, self.mass
        return dead, live

    def kinematic(self, s):
        """The least multiplier of all mechanisms of one degree of freedom: each joint shut, on an end, or lifted."""
        dead, live = self.weights
        rows, best = list(self.rows()), np.inf
        for states in product(range(4), repeat=len(rows)):
            held = [row for (n, m, t), state in zip(rows, states, strict=True)
                    for row in ((n, m, t), (n, t), (m, t), ())[state]]  # fmt: skip
            if len(held) < 3 * len(self.mass) - 1:
                continue
            _, values, ways = np.linalg.svd(np.array(held))
            rank = int((values > 1e-9).sum())
            if rank != 3 * len(self.mass) - 1:
                continue
            way = ways[rank]
            way = way * np.sign(s * live @ way)
            if s * live @ way < 1e-9 or min(min(n @ way, m @ way) for n, m, _ in rows) < -1e-9:
                continue
            best = min(best, -(dead @ way) / (s * live @ way))
        return best


def piers(seed):
    """Two piers of up to two blocks each under a lintel, or a stack, of random sizes."""
    rng = np.random.default_rng(seed)
    bodies, joints = {}, []

    def pier(name, x, top):
        under, y = None, 0.0
        for k in range(int(rng.integers(1, 3))):
            wide = rng.uniform(0.7, 1.2) if k == 0 else rng.uniform(0.5, 1.0) * (bodies[under][2] - bodies[under][0])
            high = rng.uniform(0.5, 1.5)
            left = x if k == 0 else bodies[under][0] + rng.uniform(0, bodies[under][2] - bodies[under][0] - wide)
            bodies[f"{name}{k}"] = [left, y, left + wide, y + high]
            joints.append((under, f"{name}{k}", complex(left, y), complex(left + wide, y)))
            under, y = f"{name}{k}", y + high
        if top is not None:
            bodies[under][3] = top
        return under

    if seed % 3:
        one, other = pier("a", 0.0, 3.0), pier("b", rng.uniform(2.0, 4.0), 3.0)
        left, right = bodies[one][0], bodies[other][2]
        bodies["lintel"] = [left, 3.0, right, 3.0 + rng.uniform(0.2, 0.8)]
        for under in (one, other):
            joints.append((under, "lintel", complex(bodies[under][0], 3.0), complex(bodies[under][2], 3.0)))
    else:
        pier("a", 0.0, None)
        top = list(bodies)[-1]
        x0, _, x1, y1 = bodies[top]
        bodies["cap"] = [x0 + 0.1 * (x1 - x0), y1, x1 - 0.2 * (x1 - x0), y1 + rng.uniform(0.3, 2.0)]
        joints.append((top, "cap", complex(bodies["cap"][0], y1), complex(bodies["cap"][2], y1)))
    return bodies, joints


def placed(bodies):
    return {name: rectangle(*box) for name, box in bodies.items()}


@pytest.mark.every(3)
@pytest.mark.parametrize("seed", range(10))
def test_random_piers_have_the_least_multiplier_of_all_their_mechanisms(seed):
    """That it is the greatest of statics too is tested of the search, see `test_assembly_limit`."""
    bodies, joints = piers(seed)
    every = Enumerated(bodies, joints)
    found = assembly(placed(bodies))
    for direction in Direction:
        assert found.uplift(direction) == approx(every.kinematic(int(direction)), rel=1e-9)


def test_an_arch_on_buttresses_by_its_line_of_thrust():
    """Seven voussoirs on two towers: forces and moments at each joint carried on from the first, all by hand."""
    blocks, ground = ring(r=3.0, t=0.6, beta=120.0, n=7, edges=1)
    lift, feet = 4.0, {}
    for name, each in ground.items():  # the springings are those of towers with a sloping top
        low, high = (complex(*each["polygon"][k]) for k in (0, 1))
        inner, outer = (low, high) if abs(low.real) < abs(high.real) else (high, low)
        reach = np.sign(outer.real) * 1.6
        feet[name] = [inner + 1j * lift, outer + 1j * lift, outer.real + reach + (outer.imag + lift) * 1j,
                      outer.real + reach + 0j, inner.real + 0j]  # fmt: skip
    order = [feet["left"], *([complex(x, y + lift) for x, y in blocks[f"v{k}"]["polygon"]] for k in range(1, 8))]
    order.append(feet["right"])
    outlines = [np.array(z if area(z) > 0 else z[::-1]) for z in order]
    names = ["left", *blocks, "right"]
    found = assembly({name: {"polygon": [[p.real, p.imag] for p in z.tolist()]}
                      for name, z in zip(names, outlines, strict=True)})  # fmt: skip
    angles = np.radians(150.0 - 120.0 * np.arange(8) / 7)
    cuts = [((2.7 * np.exp(1j * a)) + 1j * lift, (3.3 * np.exp(1j * a)) + 1j * lift) for a in angles]
    weights, centres = zip(*((area(z), middle(z)) for z in outlines), strict=True)
    for s in Direction:
        assert found.uplift(s) == approx(chained(outlines, cuts, weights, centres, int(s)), rel=1e-9)


def area(z):
    z = np.asarray(z)
    return float((np.conj(z) * np.roll(z, -1)).imag.sum() / 2)


def middle(z):
    following = np.roll(z, -1)
    return complex(((z + following) * (np.conj(z) * following).imag).sum() / (6 * area(z)))


def chained(outlines, cuts, weights, centres, s):
    """The greatest multiplier with the thrust inside every cut and both feet: F, M at the first cut are unknown."""
    # Unknown: Fx, Fy on the first voussoir, M about the origin, and the multiplier.
    upper, right = [], []

    def inside(p, q, inwards, force, moment):
        """Pressing at both ends of a joint: `force` and `moment` are rows over the unknowns with a constant last."""
        for end, other in ((p, q), (q, p)):
            about = moment - other.real * force[1] + other.imag * force[0]  # of what acts, about the other end
            arm = (np.conj(end - other) * inwards).imag  # of a unit normal force at this end
            upper.append(-(about / arm)[:4])
            right.append((about / arm)[4])

    unit = np.eye(5)
    force, moment = (unit[0], unit[1]), unit[2]
    for k, (p, q) in enumerate(cuts):
        if k:
            mass, at = weights[k], centres[k]
            across, down = s * mass * unit[3], -mass * unit[4]
            force = force[0] + across, force[1] + down
            moment = moment + at.real * down - at.imag * across
        inside(p, q, -1j * (q - p) / abs(q - p), force, moment)
    for k, sign, (over, turn) in ((0, -1, ((unit[0], unit[1]), unit[2])), (-1, 1, (force, moment))):
        mass, at = weights[k], centres[k]
        across, down = s * mass * unit[3], -mass * unit[4]
        total = sign * over[0] + across, sign * over[1] + down
        about = sign * turn + at.real * down - at.imag * across
        foot = sorted((z for z in outlines[k].tolist() if abs(z.imag) < 1e-12), key=lambda z: z.real)
        inside(foot[0], foot[1], -1j, total, about)
    found = linprog([0, 0, 0, -1], A_ub=np.array(upper), b_ub=np.array(right), bounds=[(None, None)] * 4,
                    options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10})  # fmt: skip
    return found.x[3]


@pytest.mark.parametrize(
    ("wide", "high"),
    [((1.0, 1.0), (3.0, 1.0)), ((2.0, 0.6), (2.0, 3.0)), ((1.5, 1.0), (1.0, 4.0)), ((1.2, 1), (4, 2.2))],
)
def test_a_stack_of_two_by_hand(wide, high):
    low, top = (rectangle(-w / 2, y, w / 2, y + h) for w, h, y in zip(wide, high, (0.0, high[0]), strict=True))
    found = assembly({"low": low, "top": top})
    masses = [w * h for w, h in zip(wide, high, strict=True)]
    whole = wide[0] / 2 * sum(masses) / (masses[0] * high[0] / 2 + masses[1] * (high[0] + high[1] / 2))
    alone = wide[1] / high[1]
    assert found.uplift(POSITIVE) == approx(min(whole, alone), rel=1e-10)
    moves = [name for group in found._groups(POSITIVE).groups for name in group]
    assert moves == (["low", "top"] if whole < alone else ["top"])


# --- traps -----------------------------------------------------------------------------------------------------------


def refused(blocks, match, ground=None, **more):
    with pytest.raises(InputError, match=match) as caught:
        assembly(blocks, ground, **more)
    return str(caught.value)


def unmodelled(blocks, match, **more):
    """Check that an assembly has no rocking model, and that `collapse` says so; return why."""
    made = assembly(blocks, **more)
    with pytest.raises(MechanismError, match=match) as caught:
        made.uplift(POSITIVE)
    assert made.collapse(POSITIVE).no_model == str(caught.value)
    return str(caught.value)


STACKED = {"low": rectangle(0.0, 0.0, 1.0, 1.0), "top": rectangle(0.7, 1.0, 1.7, 2.0)}
TOWERS = {"a": rectangle(0.0, 0.0, 1.0, 4.0), "b": rectangle(1.0, 0.0, 2.0, 4.0)}


def test_what_does_not_stand():
    refused(STACKED, r"blocks\.top: it does not stand by itself: nothing holds 'top'")
    refused({**STACKED, "top": rectangle(0.5, 1.0, 1.5, 2.0)}, "it barely stands")


def test_several_mechanisms_are_all_named():
    apart = {"a": rectangle(0.0, 0.0, 1.0, 4.0), "b": rectangle(5.0, 0.0, 6.0, 4.0)}
    unmodelled(apart, "several mechanisms start at 0.25 g, with these moving blocks: a; b")
    # The top alone at b/h = 1/4; with the plinth, 2.5 wide and h high, 1.25 (4 + 2.5 h) = .25 (8 + 4 h + 1.25 h^2).
    high = max(np.roots([0.3125, 1.0 - 3.125, 2.0 - 5.0]).real)
    tied = {"low": rectangle(0.0, 0.0, 2.5, high), "top": rectangle(0.75, high, 1.75, high + 4.0)}
    said = unmodelled(tied, "several mechanisms start at 0.25 g")
    assert "top" in said and "low and top" in said


def test_shear_that_is_free_is_glue_and_is_told():
    glued = assembly(TOWERS)
    assert glued.uplift(POSITIVE) == approx(0.5, rel=1e-12)
    needed = {each.key: each.value for each in glued.extras(POSITIVE)}["friction_needed"]
    assert needed == approx(2.0, rel=1e-5)  # no masonry has it: `equiv` shows it too
    unmodelled(TOWERS, "several mechanisms start at 0.25 g", friction_of={"a and b": 0.0})
    one = {"a": rectangle(0.0, 0.0, 1.0, 3.9), "b": rectangle(1.0, 0.0, 2.0, 4.0)}
    smooth = assembly(one, friction_of={"b and a": 0.0})
    assert smooth.uplift(POSITIVE) == approx(0.25, rel=1e-12)


@pytest.mark.parametrize(
    ("blocks", "more", "match"),
    [
        ({"a": {"polygon": [[0.0, 0.0], [1.0, 0.0]]}}, {}, "at least 3 entries"),
        ({"a": {"polygon": [[0.0, 0.0], [1.0, 4.0], [1.0, 0.0], [0.0, 4.0]]}}, {}, r"a\.polygon: its sides cross"),
        ({**TOWERS, "b": rectangle(0.5, 0.0, 1.5, 4.0)}, {}, "'a' and 'b' overlap"),
        ({"a": rectangle(0.0, -0.5, 1.0, 4.0)}, {}, "'a' and 'floor' overlap"),
        ({**TOWERS, "c": rectangle(5.0, 3.0, 6.0, 4.0)}, {}, r"blocks\.c: 'c' touches nothing along an edge"),
        ({"floor": rectangle(0.0, 0.0, 1.0, 4.0)}, {}, r"ground\.floor is a block too"),
        ({"a": {}}, {}, r"blocks\.a\.polygon is missing"),
        (TOWERS, {"lead": {"positive": "c"}}, r"lead\.positive: there is no block 'c'"),
        (
            TOWERS, {"friction_of": {"a und b": 0.3}},
            r"friction_of\.a und b does not name a joint: write the names of two bodies",
        ),
        (TOWERS, {"friction_of": {"a and roof": 0.3}}, r"friction_of\.a and roof does not name a joint"),
        ({**TOWERS, "b": rectangle(3.0, 0.0, 4.0, 4.1)}, {"friction_of": {"a and b": 0.3}}, "have no joint"),
        (TOWERS, {"mass": 1.0}, "give mass, or density and depth"),
    ],
)  # fmt: skip
def test_bad_input_has_its_place(blocks, more, match):
    refused(blocks, match, **more)


def test_names_may_have_an_and_of_their_own():
    blocks = {"salt and pepper": rectangle(0.0, 0.0, 1.0, 4.0), "top": rectangle(0.2, 4.0, 0.8, 4.4)}
    found = assembly(blocks, friction_of={"top and salt and pepper": 0.9, "salt and pepper and floor": 0.8})
    assert {(c.a, c.b): c.friction for c in found._contacts} == {
        ("floor", "salt and pepper"): 0.8, ("salt and pepper", "top"): 0.9,
    }  # fmt: skip
    names = {"a": 1, "b and c": 1, "a and b": 1, "c": 1}
    row = {name: rectangle(3.0 * k, 0.0, 3.0 * k + 1, 2.0 + k) for k, name in enumerate(names)}
    refused(row, "fits several pairs of bodies", friction_of={"a and b and c": 0.5})


def test_names_of_any_kind():
    blocks = {
        "Pfeiler ∂ 1": TOWERS["a"],
        "mass": rectangle(3.0, 0.0, 4.0, 4.5),
        "ground": rectangle(6.0, 0.0, 7.0, 4.2),
    }
    found = assembly(blocks)
    assert found._groups(POSITIVE).groups == (("mass",),)
    with pytest.raises(InputError, match=r"blocks\.mass\.depth must be more than 0"):
        assembly({**blocks, "mass": rectangle(3.0, 0.0, 4.0, 4.5, depth=-1.0)})


def test_a_lead_that_cannot_lead():
    step = {"base": rectangle(-3.0, 0.0, 3.0, 1.0), "a": rectangle(0.0, 1.0, 1.0, 5.0)}
    refused(
        step,
        r"lead\.positive: base rests in the positive direction: it cannot lead; a could",
        lead={"positive": "base"},
    )
    wall = {"low": rectangle(0.0, 0.0, 0.3, 1.5), "top": rectangle(0.0, 1.5, 0.3, 3.0)}
    held = {"C": {"slide": "top", "at": [0.3, 3.0], "along": [0.0, 1.0]}}
    refused(wall, r"lead\.positive: top turns the other way", joints=held, lead={"positive": "top"})
    found = assembly(wall, joints=held)
    assert found.uplift(POSITIVE) == approx(0.4, rel=1e-12)  # that of the wall hinged at mid-height, 2 tan(alpha)
    assert found.critical_rotation(POSITIVE) == approx(np.arctan(0.2), rel=1e-9)


def test_what_is_jammed_is_said_with_its_direction():
    ground = {**FLOOR, "left": rectangle(-1.0, 0.0, 0.0, 2.0)}
    refused({"a": TOWERS["a"]}, r"in the positive direction no acceleration .*joints without it never slide", ground)
    between = {**ground, "right": rectangle(1.0, 0.0, 2.0, 2.0)}
    beside = {"a": rectangle(0.0, 0.0, 1.0, 1.0), "b": rectangle(5.0, 0.0, 6.0, 4.0)}
    assert assembly(beside, between)._groups(POSITIVE).groups == (("b",),)


# --- in use ----------------------------------------------------------------------------------------------------------

PORTAL = {
    "left": rectangle(0.0, 0.0, 0.8, 3.0), "right": rectangle(3.2, 0.0, 4.0, 3.0),
    "lintel": rectangle(0.0, 3.0, 4.0, 3.6),
}  # fmt: skip
WALL = {
    "bodies": {"lower": rectangle(0.0, 0.0, 0.3, 1.5), "upper": rectangle(0.0, 1.5, 0.3, 3.0)},
    "positive": {
        "lead": "lower",
        "joints": {
            "A": {"pivot": "lower", "at": [0.3, 0.0]},
            "B": {"hinge": ["lower", "upper"], "at": [0.0, 1.5]},
            "C": {"slide": "upper", "at": [0.3, 3.0], "along": [0.0, 1.0]},
        },
    },
}
CRACKED = {
    "bodies": {"wall": rectangle(-0.15, 0.0, 0.15, 3.0)},
    "cracks": {"K": {"body": "wall", "along": [[0.0, 0.3], [0.0, 2.9]]}},
    "positive": {
        "lead": "wall below K",
        "joints": {
            "A": {"pivot": "wall", "at": [0.15, 0.0]},
            "B": {"hinge": ["wall below K", "wall above K"], "at": "K left"},
            "C": {"slide": "wall", "at": [0.0, 3.0], "along": [0.0, 1.0]},
        },
    },
}


def test_all_that_has_a_length_is_enlarged():
    held = {"C": {"slide": "upper", "at": [0.3, 3.0], "along": [0.0, 1.0]}}
    cases = [assembly(PORTAL, gap=0.001), rk.Linkage(**WALL, **WEIGHT), rk.Linkage(**CRACKED, **WEIGHT)]
    enlarged = [small.enlarged(2.0) for small in cases]
    for small, large in zip(cases, enlarged, strict=True):
        assert large.uplift(POSITIVE) == approx(small.uplift(POSITIVE), rel=1e-6)
        assert large.critical_rotation(POSITIVE) == approx(small.critical_rotation(POSITIVE), rel=1e-6)
        ratio = large.kinetic_inertia(np.zeros(1), POSITIVE) / small.kinetic_inertia(np.zeros(1), POSITIVE)
        assert ratio[0] == approx(2.0**5, rel=1e-5)  # of depth too
    assert enlarged[0].ground["floor"].polygon[1] == [40.0, -2.0] and enlarged[0].gap == approx(0.002)
    guided = assembly(WALL["bodies"], joints=held).enlarged(2.0)
    assert guided.supports["C"].at == [0.6, 6.0]
    assert guided.uplift(POSITIVE) == approx(0.4, rel=1e-12)
    crack, larger = (each.extras(POSITIVE)[0].value for each in (cases[2], enlarged[2]))
    assert larger == approx(2 * crack, rel=1e-5)


def test_a_crack_of_one_direction_leaves_the_body_whole_in_the_other(tmp_path):
    other = {"lead": "wall", "joints": {"A": {"pivot": "wall", "at": [-0.15, 0.0]}}}
    found = rk.Linkage(**CRACKED, negative=other, **WEIGHT)
    assert found.uplift(NEGATIVE) == approx(0.1, rel=1e-10)  # t/h of the whole wall
    file = tmp_path / "wall.yaml"
    rough = {"friction": 5.0}  # else `equiv` looks for the least that it needs
    file.write_text(yaml.safe_dump({"mechanism": "linkage", **CRACKED, "negative": other, **WEIGHT, **rough}))
    row = next(line for line in run("equiv", file).stdout.splitlines() if line.strip().startswith("crack_K"))
    assert "-" in row.split()


def test_the_two_directions_may_open_other_joints(tmp_path):
    blocks, ground = ring(edges=2)
    blocks["v7"]["density"] = 2300.0
    file = tmp_path / "arch.yaml"
    file.write_text(yaml.safe_dump({"mechanism": "assembly", "blocks": blocks, "ground": ground, **WEIGHT}))
    row = next(line for line in run("equiv", file, "--all").stdout.splitlines() if "valid_to" in line)
    assert "positive: " in row and "negative: " in row


def test_only_one_direction_may_be_left():
    leans = {"one_sided": "negative", "rebound": 0.4}
    found = rk.Linkage(**WALL, **WEIGHT, **leans)
    assert found.uplift(NEGATIVE) == approx(0.4, rel=1e-12)
    assert rk.draw(found)
    assert rk.draw(assembly(PORTAL, **leans))


def test_a_tie_may_leave_no_critical_rotation():
    bar = {"name": "bar", "from": {"ground": [-3.0, 4.0]}, "to": {"at": [0.0, 4.0]}}
    tower = {"a": TOWERS["a"]}
    stiff = assembly(tower, ties=[{**bar, "stiffness": 1e8, "only": "tension"}], one_sided="positive", rebound=0.2)
    assert stiff.uplift(POSITIVE) == approx(0.25, rel=1e-10)
    assert next(each.key for each in stiff.extras(POSITIVE)) == "friction_needed"
    pulled = assembly(tower, ties=[{**bar, "stiffness": 1e3, "prestress": 5e3}], one_sided="positive", rebound=0.2)
    assert pulled.uplift(POSITIVE) == approx(0.25 + 5e3 * 4 / (8000 * g * 2), rel=1e-9)
    load = {"name": "roof", "mass": 4000.0, "at": [0.5, 4.0]}
    laden = assembly(tower, loads=[load])
    assert laden.uplift(POSITIVE) == approx(0.5 * 12 / (8 * 2 + 4 * 4), rel=1e-10)


@pytest.mark.parametrize(
    ("field", "unit"),
    [("blocks.left.density", "kg/m3"), ("blocks.lintel.polygon.2.1", "m"), ("friction_of.left and lintel", "")],
)
def test_what_is_in_mappings_can_vary(field, unit):
    from rocking_cli.structure import Structure

    portal = assembly({**PORTAL, "left": {**PORTAL["left"], "density": 2100.0}}, friction_of={"left and lintel": 0.9})
    varied = Structure(portal)
    assert varied.unit_of(field) == unit
    assert varied.varied(field, varied.value_of(field)).mechanism == portal
    with pytest.raises(InputError, match=r"blocks\.lft\.density: blocks has no lft\n  did you mean left"):
        Structure(portal).unit_of("blocks.lft.density")
    with pytest.raises(InputError, match="is not a numeric field, so it cannot be varied"):
        Structure(portal).unit_of("friction_of")
    with pytest.raises(InputError, match=r"volume is not a field of blocks\.left"):
        Structure(portal).unit_of("blocks.left.volume")


@pytest.mark.rest
def test_every_command_takes_both(tmp_path):
    files = {
        "asm": {"mechanism": "assembly", "blocks": PORTAL, "ground": FLOOR},
        "link": {"mechanism": "linkage", **WALL},
    }
    site = tmp_path / "site.yaml"
    site.write_text("{FC: 1.35, ag: 0.2, F0: 2.5, TC: 0.4, S: 1.2}")
    for name, fields in files.items():
        file = tmp_path / f"{name}.yaml"
        file.write_text(yaml.safe_dump({**fields, **WEIGHT}))
        varied = "blocks.left.density" if name == "asm" else "bodies.lower.density"
        # Only these know of the new: heavier models are those of all structures.
        run("draw", file, "--json")
        run("design", file, "--vary", f"{varied}=1500:2500", "--until", "lambda > 0.1", "--points", 2)
        run("spectrum", file, "--pulse", "sine:0.5g:0.8s", "--sizes", "1:2", "--count", "2")
        said = run_json("verify", file, "--site", site)["directions"]["positive"]
        assert said["alpha0"] == approx(rk.load_structure(file).uplift(POSITIVE), rel=1e-9)


def test_what_rests_is_ground_to_the_base_shear():
    """A block on a plinth that rests: base shear and friction are those of the block on the ground."""
    step = {"low": rectangle(-1.0, 0.0, 2.0, 1.0), "top": rectangle(0.0, 1.0, 1.0, 5.0)}
    found = []
    for each in (assembly(step), rk.Block(width=1.0, height=4.0, **WEIGHT)):
        history = rk.respond(each, "sine:0.4g:0.8s", model="nonlinear", engine="exact")["nonlinear"]
        found.append(Contacts(each).check(history, None))
    assert found[0].base_shear == approx(found[1].base_shear, rel=1e-9) and found[0].base_shear > 1e3
    assert found[0].friction_needed == approx(found[1].friction_needed, rel=1e-9)
    assert found[0].opens is not None and np.isnan(found[0].opens)


# --- forces and motion -----------------------------------------------------------------------------------------------


def thrust_along(arch, direction, phi, rate, ground):
    """Forces at all joints of an arch in motion, from one springing to the other: least squares of statics by hand.

    Unknown are the force and moment at the left springing; at hinges the moment about them vanishes.
    """
    at = arch.coefficients(np.array([phi]), direction)
    turning = float((-at.J * rate**2 - g * at.G - direction * at.B * ground)[0] / at.I[0])
    hinges = {joint.bodies: joint.point for joint in arch.joints(direction)}
    forces, rows, right, cuts = 0j, [], [], []
    bodies = list(zip(arch.weighed(), arch.motion(np.array([phi]), direction), strict=True))
    moment = 0.0  # about the origin, of what acts on the voussoirs so far
    angles = np.pi / 2 + np.radians(157.5) * (0.5 - np.linspace(0, 1, len(bodies) + 1))
    for k, turned in enumerate(np.exp(1j * angles)):
        names = [name for name in (f"v{k}", f"v{k + 1}") if name in arch.blocks]
        carrier = bodies[k - 1][1] if k else None
        ends = [carrier.carry(z)[0][0] if carrier else z for z in (9.25 * turned, 10.75 * turned)]
        cuts.append((names, ends, forces, moment))
        hinge = next((z for key, z in hinges.items() if set(key) == set(names)), None)
        if hinge is not None:
            place = carrier.carry(hinge)[0][0] if carrier else hinge
            # Moment about the hinge of F0, M0 at the origin and of all that acts before it.
            rows.append([place.imag, -place.real, 1.0])
            right.append(-(moment + place.imag * forces.real - place.real * forces.imag))
        if k < len(bodies):
            body, motion = bodies[k]
            z, dz, ddz = (each[0] for each in motion.carry(body.centroid))
            force = -body.mass * (dz * turning + ddz * rate**2 + ground + 1j * g)
            couple = -body.inertia * (motion.dpsi * turning + motion.ddpsi * rate**2)
            forces += force
            moment += (np.conj(z) * force).imag + float(np.ravel(couple)[0])
    start = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    assert np.abs(np.array(rows) @ start - right).max() < 1e-7 * abs(moment)  # four hinges, three unknowns: in balance
    margins = {}
    weight = g * sum(body.mass for body, _ in bodies)
    for names, (p, q), force, before in cuts:
        total = force + complex(start[0], start[1])
        about = before + start[2]

        def about_point(z, total=total, about=about):
            return about - (np.conj(z) * total).imag

        # Normal forces at the two ends that make the moment about the other; the sign is that of a joint that presses.
        ends = (about_point(q) / abs(q - p), -about_point(p) / abs(q - p))
        side = np.sign(sum(ends)) or 1.0
        margins[" and ".join(names)] = min(side * each for each in ends) / weight
    return margins


@pytest.mark.parametrize(
    ("phi", "rate", "ground"), [(1e-3, 0.0, -0.3), (2e-3, 0.1, -0.36), (0.01, -0.2, 0.0), (0.02, 0.05, 0.1)]
)
def test_what_would_open_by_a_line_of_thrust(phi, rate, ground):
    blocks, ground_bodies = ring(exact=True)
    arch = rk.Assembly(blocks=blocks, ground=ground_bodies, lead={"positive": "v1", "negative": "v7"})
    by_hand = thrust_along(arch, POSITIVE, phi, rate, ground * g)
    found = released(arch, POSITIVE, np.array([phi]))
    force = found.force[0] @ np.array([1.0, ground * g, rate**2, 0.0]) / (g * sum(body.mass for body in arch.weighed()))
    least = {
        contact.label: force[list(normal)].min()
        for contact, (normal, _) in zip(found.contacts, found.rows, strict=True)
        if len(normal) == 2
    }
    assert len(least) == 4  # of eight joints four hinge
    theirs = {frozenset(name.split(" and ")) - {"left", "right", "ground"}: value for name, value in by_hand.items()}
    for name, ours in least.items():
        pair = frozenset(each for each in name.split(" and ") if each in blocks)
        assert ours == approx(theirs[pair], rel=1e-6, abs=1e-9)


# --- linkages that are no good ---------------------------------------------------------------------------------------


def changed(**joints):
    return {**WALL, "positive": {"lead": "lower", "joints": {**WALL["positive"]["joints"], **joints}}, **WEIGHT}


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        (
            changed(D={"slide": "upper", "at": [0.0, 3.0], "along": [0.0, 1.0]}),
            "the joints allow only an infinitesimal rotation",
        ),
        (changed(A={"pivot": "lower", "at": [float("nan"), 0.0]}), r"positive\.joints\.A\.at\[1\] must be a finite"),
        (
            changed(B={"hinge": ["lower", "upper"], "at": "K left"}),
            r"positive\.joints\.B\.at is a point \[x, y\]; got",
        ),
        ({**WALL, **WEIGHT, "positive": "mirror"}, "is the mirror of the other direction"),
    ],
)
def test_linkages_that_are_no_good(fields, match):
    with pytest.raises(InputError, match=match) as caught:
        rk.Linkage(**fields)
    assert "must be mirror or none" not in str(caught.value)  # only what was meant is spoken of


def test_what_cannot_rock_that_way_says_so():
    stack = {"a": rectangle(0.0, 0.0, 1.0, 4.0), "top": rectangle(0.0, 4.0, 1.0, 5.0)}
    with pytest.raises(MechanismError, match="slides between a and top"):
        assembly(stack, friction_of={"a and top": 0.1}).uplift(POSITIVE)


def test_what_leans_on_a_wall_leaves_it():
    """Its heel slips up the wall and off it to second order; with the joint glued nothing could move."""
    leans = {"one_sided": "positive", "rebound": 0.3}
    ground = {"floor": rectangle(-2.0, -1.0, 3.0, 0.0), "wall": rectangle(-1.0, 0.0, 0.0, 2.0)}
    block = {"l": rectangle(0.0, 0.0, 1.0, 4.0)}
    found = assembly(block, ground=ground, friction_of={"wall and l": 0.0}, **leans)
    assert found.uplift(POSITIVE) == approx(0.25, rel=1e-12)
    assert found.critical_rotation(POSITIVE) == approx(atan(0.25), rel=1e-12)
    refused(block, "no acceleration sets it in motion", ground=ground, **leans)


def test_a_heel_that_would_go_into_a_wall_does_not_move():
    wall = {"polygon": [[-1.0, 0.0], [0.0, 0.0], [0.4, 2.0], [-1.0, 2.0]]}
    block = {"l": {"polygon": [[0.0, 0.0], [1.0, 0.0], [1.4, 4.0], [0.8, 4.0]]}}
    ground = {"floor": rectangle(-2.0, -1.0, 3.0, 0.0), "wall": wall}
    leans = {"one_sided": "positive", "rebound": 0.3}
    refused(block, "no acceleration sets it in motion", ground=ground, friction_of={"wall and l": 0.0}, **leans)


def test_blocks_that_slide_at_the_friction_given_are_told_so():
    tall = {"a": rectangle(0.0, 0.0, 1.0, 1.0), "b": rectangle(0.0, 1.0, 1.0, 2.0)}
    said = unmodelled(tall, "several mechanisms start at 0.3 g", friction=0.3)
    assert "This equals the friction given: the blocks slide" in said


def test_joints_that_do_not_fit_are_named():
    """A fan of leaning walls in two courses, drawn to some millimetres: each joint has corners of its own."""
    random, foot, tops = np.random.default_rng(8), [0.2, 1.25, 2.3, 3.35, 4.4, 5.45], [0.0, 1.45, 2.9, 4.35, 5.8, 7.25]
    rise = [2.7, 1.4, 2.0, 1.4, 2.7]
    blocks = {}
    for k, y in enumerate(rise):
        left, right = (foot[j] + (tops[j] - foot[j]) * y / 4 for j in (k, k + 1))
        low = [(foot[k], 0), (foot[k + 1], 0), (right, y), (left, y)]
        for name, corners in ((f"l{k}", low), (f"u{k}", [(left, y), (right, y), (tops[k + 1], 4), (tops[k], 4)])):
            off = random.uniform(-0.004, 0.004, (4, 2))
            off[:2, 1] *= name[0] == "u"
            blocks[name] = {"polygon": (np.array(corners) + off).tolist()}
    fan = assembly(blocks)
    with pytest.raises(StructureError, match=r"joints do not fit, .* mm apart, .* give `gap` 6 mm: within it"):
        rk.collapse(fan)
    fitted = assembly(blocks, gap=0.006)
    assert rk.collapse(fitted) and all(fitted.uplift(d) == approx(fan.uplift(d), rel=1e-3) for d in Direction)


@pytest.mark.parametrize(("turn", "digits", "gap"), [(0, 16, None), (1, 7, None), (30, 7, None), (5, 3, 0.002)])
def test_a_running_bond_that_is_turned_moves(turn, digits, gap):
    """All of it turns about a corner of its foot: the force there passes its centroid, and needs this much friction."""
    width, height, count, courses, way = 0.6, 0.3, 2, 3, np.exp(1j * np.radians(turn))

    def turned(x0, y0, x1, y1):
        z = np.array([x0 + 1j * y0, x1 + 1j * y0, x1 + 1j * y1, x0 + 1j * y1]) * way
        return {"polygon": np.round(np.column_stack([z.real, z.imag]), digits).tolist()}

    blocks = {}
    for course in range(courses):
        ends = np.arange(count + 1.0) if course % 2 == 0 else np.array([0.0, *(np.arange(count) + 0.5), count])
        for k, (left, right) in enumerate(zip(ends[:-1] * width, ends[1:] * width, strict=True)):
            blocks[f"{course}.{k}"] = turned(left, course * height, right, (course + 1) * height)
    wall = assembly(blocks, {"floor": turned(-1.0, -1.0, 4.0, 0.0)}, gap=gap)
    corner = atan(count * width / (courses * height))
    rel = 10.0**-digits * 3 + 1e-9
    for direction in Direction:
        assert wall.uplift(direction) == approx(np.tan(corner + int(direction) * np.radians(turn)), rel=rel)
        assert not wall.collapse(direction).hinges[1:]
        assert wall.extras(direction)[0].value == approx(np.tan(corner), rel=rel + 1e-5)


def test_a_friction_that_there_is_not_is_no_number(tmp_path):
    """With hardly any friction between them the towers jam as if glued, and no greater one would carry that."""
    jammed = {"blocks": TOWERS, "ground": {"floor": rectangle(-5.0, -1.0, 9.0, 0.0)}, "friction_of": {"a and b": 0.001}}
    (tmp_path / "s.yaml").write_text(yaml.safe_dump({"mechanism": "assembly", **jammed}), encoding="utf-8")
    found = run_json("equiv", tmp_path / "s.yaml")["directions"]["positive"]
    assert found["friction_needed"] is None and found["lambda"] == approx(0.5, rel=0.01)
    assert "no friction up to 10 does" in " ".join(run("equiv", tmp_path / "s.yaml", "--all").stdout.split())


@pytest.mark.parametrize("by", [0.0, 1e-13, -1e-13])
def test_hinges_above_one_another_come_from_below(by):
    """Whatever the last bits of where they are."""
    points = [complex(1.0 + by, 3.0), 4 + 0j, complex(1.0 - by, 0.0), -2 + 5j, complex(1.0, 1.0)]
    assert from_the_left(points) == [3, 2, 4, 0, 1]
    assert from_the_left([]) == [] and from_the_left([2j, 1j]) == [1, 0]


def test_joint_forces_of_an_assembly_without_masses_are_per_unit_mass(tmp_path):
    tower = {"mechanism": "assembly", "blocks": {"a": TOWERS["a"]}, "ground": FLOOR}
    for name, fields in (("heavy", WEIGHT), ("light", {})):
        (tmp_path / f"{name}.yaml").write_text(yaml.safe_dump({**tower, **fields}), encoding="utf-8")
    heavy, light = (run("collapse", f"{name}.yaml", "--all").stdout for name in ("heavy", "light"))
    assert "Fx [kN]" in heavy and "N/kg" not in heavy
    assert "Fx [N/kg]" in light and "kN" not in light
    assert run_json("collapse", "light.yaml")["per_unit_mass"]
