"""Loads, ties and supports in all that is done with structures: copies, sizes, batches, pulses, studies."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import cos, sqrt

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import rocking_cli as rk
from rocking_cli import Registry, load_structure
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import follow
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.questions.equivalent_pulses.verb import under_equivalent_pulses
from rocking_cli.questions.spectrum.study import Sizes, shape_of
from rocking_cli.structure import Structure, build_models
from rocking_cli.studies.neighbours import Neighbourhood, neighbours
from rocking_cli.studies.under_pulses import outcomes, parse_shape, pulsed_model
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import conditions
from tests.oracle import Ground, simulate
from tests.twins import shaking, twin

G = 9.80665
PLUS, MINUS = Direction
BLOCK = {"width": 1.0, "height": 5.0, "mass": 10e3}
BAR = {"name": "bar", "from": {"ground": [-4.0, 1.0]}, "to": {"at": [-0.5, 3.0]}, "stiffness": 2e4}
SOFT = {**BAR, "stiffness": 4e3, "prestress": 800.0}
FRAME = {"column_width": 1.0, "column_height": 6.0, "columns": 4, "mass_ratio": 1.5, "mass": 50e3}


def made(mechanism, **fields):
    return Registry()[mechanism].from_fields(fields)


# --- a column and a frame, by virtual work


def by_virtual_work(columns, beam, each, ties, phi):
    """T = I phi.^2/2 and V of columns 1 x 6 m about a corner, of the beam on them, and of tendons through `ties`.

    A column turns about its corner: its centroid goes on a circle of radius R, the beam's level rises by twice as much
    as the centroid, and moves twice as far. A tendon through the axis opens by 2 b sin(phi/2) at the foot and as much
    at the top.
    """
    b, h = 0.5, 3.0
    R, alpha = sqrt(b * b + h * h), np.arctan(b / h)
    inertia = columns * 4 / 3 * R**2 + beam * (2 * R) ** 2
    rise = R * (np.cos(alpha - phi) - cos(alpha))
    stretch = 4 * b * np.sin(phi / 2)
    return inertia, G * (columns + 2 * beam) * rise + ties * (each[0] * stretch + each[1] * stretch**2 / 2)


@pytest.mark.parametrize("ratio", [0.0, 1.5])
@pytest.mark.parametrize(("n0", "k"), [(0.0, 0.0), (2e3, 0.0), (1e3, 5e4), (0.0, 4e6)])
def test_columns_with_a_tendon_in_each(ratio, n0, k):
    path = [{"ground": [0.0, 0.0]}, *({"body": "columns", "at": [0.0, y]} for y in (0.0, 6.0)),
            {"body": "beam", "at": [0.0, 6.0]}]  # fmt: skip
    tendon = {"name": "tendon", "path": path, "stiffness": k, "prestress": n0, "each": True}
    frame = made("symmetric_frame", **{**FRAME, "mass_ratio": ratio}, ties=[tendon])
    columns = 50e3 / (1 + ratio)
    phi = np.linspace(0.0, 1.2, 25)
    inertia, energy = by_virtual_work(columns, 50e3 - columns, (n0, k), 4, phi)
    for direction in Direction:
        assert frame.potential_energy(phi, direction) == pytest.approx(energy, rel=1e-12, abs=1e-6)
        assert frame.kinetic_inertia(phi, direction) == pytest.approx(np.full(25, inertia), rel=1e-12)
    # The first impact from a tilt, by the energy: phi = start - x^2, without a root at the start.
    start = 0.1
    top = by_virtual_work(columns, 50e3 - columns, (n0, k), 4, start)[1]

    def slowness(x):
        here = by_virtual_work(columns, 50e3 - columns, (n0, k), 4, start - x * x)[1]
        return 2 * x / sqrt(2 * (top - here) / inertia)

    time = quad(slowness, 0, sqrt(start), epsabs=0, epsrel=1e-10)[0]
    (model,) = build_models(frame, ("nonlinear",))
    impact = follow(model, None, release=start / model.phi_cr[0]).impacts[0]
    assert impact[0] == pytest.approx(time, abs=1e-8) and impact[2] == pytest.approx(sqrt(2 * top / inertia), rel=1e-9)


def test_each_counts_whichever_end_of_a_tie_is_on_the_columns():
    ends = [{"body": "columns", "at": [0.0, 5.0]}, {"body": "beam", "at": [0.3, 6.5]}]
    phi = np.array([0.1])
    one, other = (
        made("symmetric_frame", **FRAME, ties=[{"name": "t", "from": a, "to": b, "stiffness": 1e4, "each": True}])
        for a, b in (ends, ends[::-1])
    )
    assert pytest.approx(other.coefficients(phi, PLUS).U, rel=1e-12) == one.coefficients(phi, PLUS).U


# --- linear models with vertical motion and ties, by the equation itself


@pytest.mark.parametrize("name", ["linear1", "linear2"])
@pytest.mark.parametrize("release", [0.5, -0.5, None])
def test_a_linear_model_of_a_tied_structure_follows_its_equation(name, release):
    """I x.. = -(g G' + Q') x - v (G + G' x) - s B u at phi_cr, x = phi - phi_cr; linear2 with B over kappa1/kappa2."""
    tool = made("block", **BLOCK, ties=[SOFT], loads=[{"name": "m", "mass": 800.0, "at": [0.2, 4.0], "floor": "borne"}])
    motion, _ = shaking(vertical=True, factor=0.7)
    history = follow(build_models(tool, (name,))[0], motion, release=release or 0.0)
    side = PLUS if history.impacts[0, 1] > 0 else MINUS
    block = equivalent_block(tool)[side]
    at = tool.coefficients(np.array([block.phi_cr]), side)
    drive = at.B[0] * (1.0 if name == "linear1" else block.kappa2 / block.kappa1)
    t, v_t = motion.dt * np.arange(motion.npts), motion.vertical.dt * np.arange(motion.vertical.npts)

    def shaken(time):
        u = np.interp(time, t, motion.acceleration, right=0.0)
        return u, np.interp(time, v_t, motion.vertical.acceleration, right=0.0)

    def demand(time, x):
        u, v = shaken(time)
        weight = -(G * at.dG[0] + at.dQ[0]) * x - v * (at.G[0] + at.dG[0] * x)
        return weight - int(side) * drive * u

    start = 0.0
    if release is None:
        assert demand(history.uplift_time, -block.phi_cr) == pytest.approx(0.0, abs=1e-7 * at.B[0])
        start = history.uplift_time
    breaks = np.unique(np.r_[start, t[t > start], v_t[v_t > start], 1.3, 2.0, 4.0])
    y = np.array([abs(release or 0.0) * block.phi_cr - block.phi_cr, 0.0])
    for low, high in pairwise(breaks):

        def hits(_, y):
            return y[0] + block.phi_cr if y[1] < 0 else 1.0

        hits.terminal = True
        found = solve_ivp(
            lambda time, y: [y[1], demand(time, y[0]) / at.I[0]], (low, high), y, events=hits, method="DOP853",
            rtol=1e-12, atol=1e-14, first_step=1e-4 * (high - low),
        )  # fmt: skip
        y = found.y[:, -1]
        if found.t_events[0].size:
            break
    assert history.impacts[0, 0] == pytest.approx(found.t[-1], abs=1e-8)
    assert history.impacts[0, 2] == pytest.approx(abs(y[1]), rel=1e-7)


def test_more_weight_may_bring_back_what_a_thrust_has_pushed_over():
    """Beyond phi_cr its weight still holds it: it counted as overturned with only the ground's rise to come."""
    both = twin("block", loads=[{"name": "thrust", "force": [6000.0, 0.0], "at": [0.0, 5.0]}])
    dt, u, v = 0.1, np.zeros(30), np.zeros(30)
    u[1:3], v[6:15] = -0.45 * G, 30.0
    motion = GroundMotion("push", dt, u, vertical=GroundMotion("rise", dt, v, unit="m/s2"), unit="m/s2")
    (model,) = build_models(both.tool, ("nonlinear",))
    history = follow(model, motion)
    expected = simulate(both.oracle, Ground((dt * np.arange(30)).tolist(), u.tolist(), v.tolist()), impacts=1)
    assert expected.peaks[0].phi > 1.2 * model.phi_cr[0]
    assert history.impacts[0, 0] == pytest.approx(expected.impacts[0].time, abs=1e-8)


# --- batches


@cache
def mixed():
    tools = [
        made("block", **BLOCK),
        made("block", **BLOCK, ties=[SOFT]),
        made("block", **BLOCK, ties=[{**BAR, "only": "tension", "prestress": 500.0}], one_sided="positive",
             rebound=0.3),
        made("symmetric_frame", **FRAME,
             loads=[{"name": "f", "force": [900.0, -2e3], "at": [0.0, 6.0], "body": "beam"}]),
        made("block", **BLOCK, ties=[{**BAR, "stiffness": 5e6, "only": "compression"}]),
    ]  # fmt: skip
    linear = [build_models(tools[k], ("linear1",))[0] for k in (0, 1, 3)]
    return [*(build_models(tool, ("nonlinear",))[0] for tool in tools), *linear]


def test_many_are_each_as_if_alone_to_the_last_bit():
    motions = [shaking(vertical)[0] for vertical in (True, False)]
    models = mixed()
    scales = (0.6, 0.9, 1.3)
    runs = Runs.every(len(models), 2, scales=scales, polarities=(1, -1))
    together = respond_many(models, motions, runs, threads=2)
    for k in range(len(runs)):
        motion = motions[runs.record[k]]
        up = motion.vertical
        scaled = replace(
            motion,
            acceleration=motion.acceleration * runs.scale[k] * runs.polarity[k],
            vertical=replace(up, acceleration=up.acceleration * runs.scale[k]) if up is not None else None,
        )
        alone = follow(models[runs.model[k]], scaled)
        for field in ("fell", "peak_positive", "peak_negative", "uplift_time", "impact_count", "end_time"):
            assert np.array_equal(getattr(alone, field), getattr(together, field)[k], equal_nan=True), (k, field)


def test_what_rocks_to_one_side_never_goes_to_the_other():
    model = mixed()[2]
    assert not model.symmetric
    for sign in (1, -1):
        motion = shaking(vertical=True)[0].scaled(sign)
        history = follow(model, motion)
        assert history.peak_negative == 0 and not (history.phi < 0).any()
    # Pushed against its side walls alone it does not move.
    inwards = GroundMotion("inwards", 0.1, np.array([0.0, 9.0, 9.0, 0.0]), unit="m/s2")
    assert follow(model, inwards).peak_ratio == 0 and follow(model, inwards.scaled(-1)).peak_ratio != 0


# --- symmetry


def test_models_whose_directions_differ_a_little_are_not_symmetric():
    etas = {"positive_to_negative": 0.9, "negative_to_positive": 0.9005}
    for model in build_models(made("block", **BLOCK, restitution=etas), ("nonlinear", "linear1", "linear2")):
        assert not model.symmetric, model.name
    for model in build_models(made("block", **BLOCK), ("nonlinear", "linear1", "linear2")):
        assert model.symmetric, model.name
    for tie in ({**SOFT}, {**BAR, "only": "tension"}, {**BAR, "stiffness": 1.0}):
        assert not build_models(made("block", **BLOCK, ties=[tie]), ("nonlinear",))[0].symmetric
    duct = {"name": "t", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 0.0]}, "stiffness": 3e4}
    assert build_models(made("block", **BLOCK, ties=[duct]), ("nonlinear",))[0].symmetric


# --- restitution


@pytest.mark.parametrize("eta", [1.0, 0.999])
def test_a_restitution_for_all_that_a_structure_cannot_have_is_refused(eta):
    frame = load_structure(EXAMPLES / "frame.yaml")
    most = min(frame.greatest_restitution(direction) for direction in Direction)
    assert most < 0.999
    with pytest.raises(InputError, match=r"must be at most 0\.99"):
        Structure(frame).under(restitution=eta)
    with pytest.raises(InputError, match=r"must be at most 0\.99"):
        under_equivalent_pulses([Structure(frame)], parse_pulse("sine:0.5g:1s"), eta=eta)
    asked = ("overturning", EXAMPLES / "frame.yaml", "--restitution", eta, "--points", 3)
    said = " ".join(run(*asked, code=2).stderr.split())
    assert "--restitution: valley bridge" in said and "would add energy at an impact" in said


def test_one_restitution_for_all_is_the_rebound_of_what_rocks_to_one_side():
    sided = made("block", width=0.6, height=8.0, one_sided="positive")
    assert shape_of(Structure(sided, restitution=0.5), "nonlinear").structure.model.eta == (0.5, 0.5)
    with pytest.raises(InputError, match="less than 1"):
        shape_of(Structure(sided, restitution=1.0), "nonlinear")


ARCH = {"radius": 6.0, "thickness": 0.8, "inclusion_angle_deg": 150.0, "voussoirs": 9}
LADEN = {"width": 0.6, "height": 8.0, "one_sided": "positive", "density": 1800.0, "depth": 1.0}
SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}


class TestWithoutARebound:
    """Only time histories need the rebound of a one-sided structure: what is static does without."""

    @pytest.mark.every(2)
    @pytest.mark.parametrize(
        ("mechanism", "fields"),
        [
            ("block", {**LADEN, "loads": [{"name": "roof", "mass": 5.0, "at": [0.0, 1.0]}]}),
            ("block", {**LADEN, "crushing": {"strength": 1e6}}),
            ("arch", {**ARCH, "one_sided": "positive"}),
        ],
    )
    def test_static_answers_are_those_with_one_and_histories_ask_for_it(self, mechanism, fields):
        free, given = made(mechanism, **fields), made(mechanism, **fields, rebound=0.4)
        assert np.isnan(free.eta(Direction.POSITIVE))
        one, other = (rk.verify(each, SITE).to_dict() for each in (free, given))
        assert one == other
        with pytest.raises(InputError, match="rebound is missing: a time history of a one-sided structure needs it"):
            build_models(free, ("nonlinear",))
        with pytest.raises(InputError, match="rebound is missing"):
            rk.verify(free, SITE, motions=["sine:0.1g:0.5s"])
        build_models(given, ("nonlinear",))

    def test_the_commands_say_so_with_the_file(self, tmp_path):
        arch = {"mechanism": "arch", **ARCH, "one_sided": "positive"}
        for name, fields in (("a.yaml", arch), ("s.yaml", SITE)):
            (tmp_path / name).write_text("".join(f"{k}: {v}\n" for k, v in fields.items()), encoding="utf-8")
        asked = ("verify", tmp_path / "a.yaml", "--site", tmp_path / "s.yaml")
        assert run_json(*asked)["directions"]["positive"]["alpha0"] > 0
        wrong = run(*asked, "--pulse", "sine:0.1g:0.5s", code=2).stderr
        assert "a.yaml: rebound is missing: a time history" in wrong and "a number in [0, 1)" in wrong
        text = run("equiv", tmp_path / "a.yaml").stdout
        assert "Its rebound is not given" in " ".join(text.split()) and "nan" not in text
        found = run_json("equiv", tmp_path / "a.yaml")
        assert found["restitution"] == "missing" and found["directions"]["positive"]["eta"] is None


@pytest.mark.parametrize("order", [1, -1])
def test_what_rocks_to_one_side_is_equivalent_to_no_block_of_two(order):
    pair = [made("block", width=0.6, height=8.0, one_sided="positive"), made("block", width=0.7, height=2.8)]
    with pytest.raises(InputError, match="rocks in the positive direction only"):
        under_equivalent_pulses([Structure(each) for each in pair[::order]], parse_pulse("sine:0.5g:1s"))


def test_a_rebound_of_nothing_stays_where_it_hits():
    still = made("block", **BLOCK, one_sided="positive", rebound=0.0)
    (model,) = build_models(still, ("nonlinear",))
    motion = shaking(vertical=False)[0]
    near = neighbours(conditions(still, Neighbourhood(20)), motion)
    assert near.as_itself == 1.0
    history = follow(model, None, release=0.4)
    assert history.impact_count == 1 and history.at_rest
    shape = parse_shape("sine")
    structure = pulsed_model(Structure(still), "nonlinear", shape)
    pulses = outcomes(structure, shape, np.array([0.8]), np.array([4.0]))
    assert not pulses.failed.any() and pulses.peak_ratio[0] > 0


STUDY = """\
structures: [facade.yaml]
records: [{pulse: "sine:0.3g:0.8s"}]
method: stripes
levels: {measure: PGA, values: [0.1, 0.3]}
"""


@pytest.mark.parametrize(("rebound", "eta"), [("", ""), ("rebound: 0\n", ""), ("", "restitution: [0.3, 0.5]\n")])
def test_a_study_of_what_rocks_to_one_side(rebound, eta, tmp_path):
    text = f"mechanism: block\nwidth: 0.6\nheight: 8\none_sided: positive\n{rebound}"
    (tmp_path / "facade.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY + eta, encoding="utf-8")
    data = run_json("fragility", tmp_path / "study.yaml", "--store", tmp_path / "store.runs")
    assert data["runs"] == (4 if eta else 2)


# --- sizes


def test_a_size_that_cannot_stand_says_which_field():
    sizes = {"width": 1.0, "height": 5.0, "density": 2000.0, "depth": 1.0}
    tied = made("block", **sizes, name="post", ties=[{**SOFT, "prestress": 900.0}])
    with pytest.raises(InputError, match=r"post at scale 0\.1 cannot be built: ties: the structure cannot stand"):
        Sizes(tied, "nonlinear", PLUS).at(0.1)


def test_an_enlarged_structure_has_its_ties_where_they_were_and_as_stiff():
    bar = {key: value for key, value in BAR.items() if key != "stiffness"} | {"area": 1e-4, "modulus": 2e11}
    bed = {"name": "bed", "bed": {"from": [-0.5, 0.0], "to": [0.5, 0.0]}, "modulus": 1e4}
    tied = made("block", **BLOCK, ties=[bar, bed], loads=[{"name": "m", "mass": 10.0, "at": [0.2, 4.0], "seat": 0.1}])
    large = tied.enlarged(3.0)
    assert large.loads[0].seat == pytest.approx(0.3)
    assert large.height == 15.0 and large.mass == tied.mass and large.loads[0].at == pytest.approx([0.6, 12.0])
    assert large.ties[0].k == tied.ties[0].k and large.ties[0].span == pytest.approx(3 * tied.ties[0].span)
    phi = np.array([0.2])
    one, other = (each.coefficients(phi, PLUS) for each in (tied, large))
    assert pytest.approx(3 * one.G, rel=1e-12) == other.G and pytest.approx(9 * one.I, rel=1e-12) == other.I
    # The bar stretches by three times as much at three times the lever; so does the bed, which is three times as long.
    of_bed = made("block", **BLOCK, ties=[bed]).coefficients(phi, PLUS).Q
    assert pytest.approx(9 * (one.Q - of_bed) + 27 * of_bed, rel=1e-10) == other.Q


def test_a_copy_without_its_ties_is_bare():
    tied = made("block", **BLOCK, ties=[SOFT])
    bare = tied.model_copy(update={"ties": None})
    assert not bare.attached and tied.attached
    assert bare.uplift(PLUS) == pytest.approx(0.2, rel=1e-12) != tied.uplift(PLUS)
    again = tied.model_copy(update={"mass": 20e3})
    assert again.coefficients(np.zeros(1), PLUS).Q == tied.coefficients(np.zeros(1), PLUS).Q
    assert again.uplift(PLUS) - 0.2 == pytest.approx((tied.uplift(PLUS) - 0.2) / 2, rel=1e-9)
