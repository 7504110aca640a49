"""The engine of free blocks: what it says, what it refuses, what it remembers; and who is asked by `auto`."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.inputs import structure_of
from rocking_cli.dynamics.batch import Runs
from rocking_cli.errors import KeptWarning
from rocking_cli.studies.engines import blocks, engine_of, scene
from rocking_cli.studies.engines import free as memory
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.views.view import Table
from tests.conftest import EXAMPLES
from tests.following import free, respond

pytest.importorskip("mujoco", reason="free blocks need mujoco")

BLOCK = structure_of(rk.Block(width=1.0, height=2.0))  # it soon comes to rest
ACCEL = rk.read_record(EXAMPLES / "accel.csv")
HALF_SINE = rk.GroundMotion("half sine", 0.01, 8.0 * np.sin(np.pi * np.arange(41) / 40), unit="m/s2")


@pytest.fixture(autouse=True)
def own_memory(monkeypatch, tmp_path):
    monkeypatch.setattr(memory, "place", lambda: tmp_path / "blocks.sqlite")
    return tmp_path / "blocks.sqlite"


def peak(structure, factor):
    history = free(structure, ACCEL.scaled(factor))
    assert not history.fell
    return max(history.peak_positive, history.peak_negative)


@pytest.mark.rest
@pytest.mark.parametrize(("factor", "theirs"), [(1.0, 0.0742), (1.5, 0.1784)])
def test_a_portal_rocks_as_two_other_programs_have_it(factor, theirs):
    assert peak(structure_of(EXAMPLES / "masonry" / "portal.yaml"), factor) == pytest.approx(theirs, rel=0.05)


@pytest.mark.rest
@pytest.mark.parametrize(
    ("friction", "factor", "collapses"),
    [(None, 0.6, False), (None, 0.7, True), (None, 1.0, True), (1.5, 0.6, False), (1.5, 0.7, True)],
)
def test_the_arch_on_buttresses_ends_as_two_other_programs_have_it(friction, factor, collapses):
    arch = structure_of(EXAMPLES / "masonry" / "buttressed_arch.yaml")
    if friction is not None:
        arch = arch.of(arch.mechanism.replace(friction=friction))
    exact = respond(arch.mechanism, ACCEL.scaled(factor), models=["nonlinear"])["nonlinear"]
    assert exact.unknown
    asked = rk.respond(arch.mechanism, ACCEL.scaled(factor), engine="auto")
    assert asked["nonlinear"].known_to == exact.known_to
    assert asked["blocks"].fell == collapses and asked["blocks"].by_blocks
    if collapses and factor == 1:
        assert asked["blocks"].overturning_time == pytest.approx(4.12, abs=0.3)


def test_two_runs_are_the_same_to_the_last_bit():
    free = free_blocks(BLOCK.mechanism)
    one, other = (blocks.BlockModel(free).simulate(HALF_SINE, most=1.5).moved for _ in range(2))
    assert np.abs(one[..., 2]).max() > 0.01 and np.array_equal(one, other)


def outcomes(scales, engine="blocks", progress=None, **changed):
    runs = Runs.of(0, 0, scale=scales)
    asked = engine_of(engine, [BLOCK.mechanism])
    return asked.outcomes([BLOCK.model("nonlinear")], [HALF_SINE], runs, threads=1, progress=progress, **changed)


def test_runs_that_are_done_are_kept(own_memory, monkeypatch):
    first = outcomes([0.5, 1.0])
    monkeypatch.setattr("rocking_cli.studies.engines.free.simulate", None)  # nothing is simulated again
    again = outcomes([1.0, 0.5])
    assert np.array_equal(again.peak_ratio, first.peak_ratio[::-1]) and (first.peak_ratio > 0).any()
    with pytest.raises(TypeError):
        outcomes([1.1])
    own_memory.write_bytes(b"not a database")
    with pytest.raises(TypeError), pytest.warns(KeptWarning, match="made anew"):  # what cannot be read is not known
        outcomes([1.0])


def test_an_interrupted_study_goes_on_where_it_stopped(monkeypatch):
    done = []

    def stop(count):
        done.append(count)
        if len(done) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        outcomes([0.5, 1.0], progress=stop)
    counted = []
    outcomes([0.5, 1.0], progress=counted.append)
    assert done == [0, 1] and counted == [1, 1]


def test_other_blocks_motions_and_scales_have_other_keys():
    from rocking_cli.studies.engines.free import _Work

    def keys(mechanism, motion=HALF_SINE, **run):
        return _Work([mechanism], [(0.2, 0.2)], [motion], Runs.of(0, 0, **run), None).keys()[0]

    others = [
        keys(BLOCK.mechanism), keys(BLOCK.mechanism.replace(width=0.71)), keys(BLOCK.mechanism.replace(friction=0.5)),
        keys(BLOCK.mechanism, HALF_SINE.scaled(1.1)), keys(BLOCK.mechanism, scale=1.1),
        keys(BLOCK.mechanism, polarity=-1), keys(BLOCK.mechanism, slender=1.1),
    ]  # fmt: skip
    assert len({*others}) == len(others) and keys(BLOCK.mechanism) == others[0]
    assert keys(BLOCK.mechanism.replace(restitution=0.9)) == others[0]  # contact gives it


def test_auto_asks_free_blocks_only_where_one_degree_of_freedom_does_not_tell(monkeypatch):
    found = outcomes([0.5, 1.0], "auto")
    exact = outcomes([0.5, 1.0], "exact")
    assert not found.by_blocks.any() and np.array_equal(found.peak_ratio, exact.peak_ratio)


def test_a_body_that_sinks_too_deep_is_a_failed_run_and_never_an_answer(monkeypatch):
    monkeypatch.setattr(blocks.BlockModel, "_limits", -np.ones(2))  # any contact is too deep
    with pytest.raises(rk.SolverError, match="sink into each other by more than 1 per mille"):
        free(BLOCK, HALF_SINE)
    failed = outcomes([1.0])
    assert failed.unknown.all() and failed.by_blocks.all() and not failed.fell.any()
    assert failed.known_to[0] < 1


def test_without_the_extra_one_sentence_says_what_to_install(monkeypatch):
    monkeypatch.setattr(scene, "find_spec", lambda name: None)
    with pytest.raises(
        rk.InputError, match=r"MuJoCo, which is not installed[\s\S]*pip install 'rocking-cli\[blocks\]'"
    ):
        engine_of("blocks")


@pytest.mark.parametrize(
    ("package", "says"),
    [
        ("raise OSError('libmujoco.so: cannot open')", "does not load .libmujoco.so: cannot open"),
        ("raise RuntimeError('no display')", "does not load .no display"),
        ("__version__ = 'nightly'", "does not load"),
        ("", "does not load"),  # what is left of a package that another one replaced
        ("__version__ = '3.12.1'", "MuJoCo 3.12.1 misses contacts"),
    ],
)
def test_an_installation_that_is_broken_is_named_with_what_mends_it(monkeypatch, tmp_path, package, says):
    (tmp_path / "mujoco.py").write_text(package, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "mujoco")
    with pytest.raises(
        rk.InputError,
        match=rf"{says}[\s\S]*pip uninstall -y mujoco mujoco-core, then pip install 'rocking-cli\[blocks]'",
    ):
        scene.engine_version()


@pytest.mark.parametrize("call", ["MjData", "mj_step", "mj_step1", "mj_contactForce", "MjSpec"])
def test_whatever_a_damaged_one_raises_in_a_simulation_says_what_to_do(monkeypatch, call):
    def fails(*given, **named):
        raise RuntimeError("damaged\nhere")

    monkeypatch.setattr(f"mujoco.{call}", fails)
    with pytest.raises(rk.SolverError, match=r"failed: RuntimeError: damaged.*pip uninstall -y mujoco.*`engine` exact"):
        free(BLOCK, HALF_SINE)


@pytest.mark.parametrize(
    ("mechanism", "says"),
    [
        (rk.Block(width=0.7, height=2.8, density=2000, depth=1.0, crushing={"strength": 3e6}), "pivots that crush"),
        (rk.RigidBody(polygon=[[0, 0], [1, 0], [1, 3], [0, 3]], corner_radius=0.05), "rounded feet"),
        (rk.RigidBody(R=2.0, alpha_deg=15, inertia_ratio=1.4), "a body of unknown shape, as body"),
        (rk.SymmetricFrame(column_width=1, column_height=6, mass_ratio=2), "beam: give spacing and beam_depth"),
        (
            rk.Block(width=1, height=2, mass=1e3, loads=[{"name": "thrust", "force": [10.0, 0.0], "at": [0.0, 2.0]}]),
            "a constant force, as that of thrust",
        ),
    ],
    ids=["crushing", "rounded", "shapeless", "frame", "force"],
)  # fmt: skip
def test_what_free_blocks_cannot_have_is_refused_by_name(mechanism, says):
    with pytest.raises(rk.InputError, match=says):
        free(structure_of(mechanism), HALF_SINE)


def test_each_return_to_rest_is_an_impact():
    """Through rest to the other side, onto a side wall, and onto a foot that holds it just above rest."""
    phi = np.array([0.0, 0.2, -0.2, -0.1, 0.0, 0.0, -0.3, -1e-4, -0.2, 0.1, 1e-4, 1e-4])
    rate = np.arange(12.0)
    found = memory.impacts_of(np.arange(12.0), phi, rate, np.abs(phi) > 1e-3)
    assert found.tolist() == [[1.5, 1, 1], [4, -1, 3], [7, -1, 6], [pytest.approx(8 + 2 / 3), -1, 8], [10, 1, 9]]


def test_a_wall_that_leans_on_supports_has_impacts():
    wall = rk.Block(width=0.6, height=2.0, one_sided="positive", rebound=0.3)
    answer = rk.respond(wall, HALF_SINE.scaled(-0.6), engine="blocks")
    assert len(answer["nonlinear"].felt) > 0 < answer["blocks"].impact_count
    first = answer["nonlinear"].first_impact
    assert answer["blocks"].first_impact == pytest.approx(first, abs=0.02)


class TestRest:
    """Oppenheim's arch under a strong motion: its joints creep and chatter for good, by less than can be resolved."""

    def test_what_contacts_give_way_by_is_rest_and_a_block_that_turns_is_not(self):
        model = blocks.BlockModel(free_blocks(structure_of(EXAMPLES / "assembly.yaml").mechanism))
        time = np.linspace(0.0, model.free.unit_of_time, 100)
        moved = np.zeros((100, 7, 3))
        moved[..., 1] = -2.5e-5 * time[:, None]  # as simulated: creep, and tilts
        moved[..., 2] = 1.5e-5 * np.sin(40 * time)[:, None]
        assert model._rests(moved, np.full(7, model.yielding))
        moved[:, 3, 2] += 1e-3 * np.cosh(time / 0.7)  # one that turns back, slowly
        assert not model._rests(moved, np.full(7, model.yielding))

    @pytest.mark.parametrize(("width", "height"), [(0.4, 4.0), (0.1, 0.3), (3.0, 2.0)])
    def test_a_block_does_not_rest_as_it_uplifts(self, width, height):
        model = blocks.BlockModel(free_blocks(rk.Block(width=width, height=height)))
        moved = np.zeros((2, 1, 3))
        moved[1] = model.free.tilted(rk.Block(width=width, height=height), memory.MOVED * np.arctan2(width, height))
        assert not model._rests(moved, np.array([model.yielding]))

    def test_a_pile_on_a_slope_rests_though_its_joints_creep(self):
        slope, (width, height, count) = np.exp(1j * np.arctan(0.5)), (2.5, 0.5, 5)

        def laid(left, right, low, high):
            corners = slope * np.array([left + 1j * low, right + 1j * low, right + 1j * high, left + 1j * high])
            return {"polygon": [[z.real, z.imag] for z in corners.tolist()]}

        slabs = {f"b{k}": laid(0, width, k * height, (k + 1) * height) for k in range(count)}
        pile = rk.Assembly(blocks=slabs, ground={"g": laid(-6, 6, -1, 0)}, density=2000, depth=1, friction=0.6)
        found = blocks.BlockModel(free_blocks(pile)).simulate(None)
        assert found.at_rest and found.time[-1] < 1 and np.abs(found.moved).max() < found.least

    @pytest.mark.parametrize("share", [0.9999, 0.9999999])
    def test_what_is_released_beside_its_critical_rotation_does_not_rest_there(self, share):
        vase = rk.Block(width=0.015, height=0.05)
        model = blocks.BlockModel(free_blocks(vase))
        start = model.free.tilted(vase, share * np.arctan2(0.015, 0.05))
        found = model.simulate(None, start=start, tail=0.0)
        assert found.at_rest and np.abs(found.moved[-1]).max() < 1e-3 < np.abs(found.moved[0]).max()

    @pytest.mark.rest
    def test_the_arch_comes_to_rest(self):
        answer = rk.respond(EXAMPLES / "assembly.yaml", ACCEL, scale=1.5)
        run = answer["blocks"]  # unasked, as it takes few steps
        assert run.at_rest and run.end_time < 20 and answer.conclusion.blocks.concluded == "rocks"


def test_answers_say_their_engine():
    answer = rk.respond(BLOCK.mechanism, HALF_SINE, engine="blocks")
    assert list(answer) == ["nonlinear", "blocks"] and answer["blocks"].by_blocks
    assert answer.to_dict()["responses"]["blocks"]["engine"] == "blocks"
    said = " ".join(str(part) for part in answer.view.parts)
    assert (
        "Overturning of free blocks is collapse: a block falls by 0.15" in said and "friction is 0.6, as usual" in said
    )
    margin = rk.margin(rk.Block(width=0.7, height=2.8), HALF_SINE, engine="auto", polarity="1")
    assert margin.to_dict()["engine"] == "auto" and margin.to_dict()["motions"][0]["by_blocks"] == 0
    assert margin["half sine"].around.count == 20


def test_a_foot_is_one_whatever_rounding_does_to_its_normal():
    from rocking_cli.core.contacts import Contact
    from rocking_cli.studies.engines.free_blocks import _hold

    held = []
    for normal, at in ((1j, -1.0), (1j * np.exp(1e-15j), 1.0), (1.0 + 0j, 2.0)):
        _hold(held, "wall", Contact((None, "wall"), (complex(at),), normal))
    assert [each.points for each in held] == [[-1.0, 1.0], [2.0]]
    guides = []
    for normal in (1.0 + 0j, -1.0 + 0j):
        _hold(guides, "wall", Contact((None, "wall"), (3j,), normal, held="slide"))
    assert len(guides) == 1 and len(guides[0].points) == 2


def test_several_motions_have_a_row_each_and_say_who_gave_it():
    twice = [HALF_SINE, replace(HALF_SINE.scaled(0.5), name="half of it")]
    for engine in ("blocks", "auto"):
        answers = rk.respond(BLOCK.mechanism, twice, engine=engine)
        assert "and free blocks where it does not tell" in answers.view.parts[0]
        (table,) = (part for part in answers.view.parts if isinstance(part, Table))
        assert [each.replace("\n", " ") for each in table.columns][2:4] == ["nonlinear", "free blocks"]


def test_what_follows_from_the_mechanism_is_not_said_of_free_blocks():
    facade = EXAMPLES / "walls" / "facade.yaml"
    answer = rk.respond(facade, HALF_SINE, engine="blocks")
    rows = answer.to_frame().set_index("model")
    moved = [name for name in rows if "force" in name or "u_x" in name]
    assert (
        moved
        and rows.loc["blocks", moved].isna().all(axis=None)
        and not rows.loc["nonlinear", moved].isna().all(axis=None)
    )
    told = answer.to_dict()["responses"]["blocks"]
    assert told["points"] == {} and told["ties"] == {} and told["impact_velocity"] is None
    assert answer.to_dict()["agreement"] == {}


def test_unknown_outcomes_of_free_blocks_are_said_to_be_failures(monkeypatch):
    monkeypatch.setattr(blocks.BlockModel, "_limits", -np.ones(2))
    monkeypatch.setattr(
        "rocking_cli.studies.engines.free.in_processes", lambda work, n, *_: ((k, work(k, k + 1)) for k in range(n))
    )
    found = rk.overturning_map(
        BLOCK.mechanism, model="nonlinear", engine="blocks", points=2, period=(0.4, 0.8), ag=(0.8, 0.9)
    )
    said = " ".join(str(part) for part in found.view.parts)
    assert "unknown where free blocks failed: a step diverged" in said and "joint opens" not in said
