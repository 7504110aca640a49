"""Limit states on how far the top moves: against closed forms, dense looks at the way, and single histories."""

import json
from math import pi, sin

import numpy as np
import pytest
import yaml
from scipy.optimize import brentq

from rocking_cli import load_structure
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.questions.fragility import tally
from rocking_cli.questions.fragility.campaign import left, prepare
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.questions.fragility.tally import first_reached, of_a_structure
from rocking_cli.studies.fragility.quantities import ROTATIONS_FACT, displacement_in_mm, is_quantity, kept, metres
from rocking_cli.studies.movements import Watched
from tests.conftest import EXAMPLES, rows_of
from tests.questions.fragility.test_study_runs import carry_out
from tests.stores import command

STUDY = {
    "structures": [
        str(EXAMPLES / "frame.yaml"),
        {
            "file": str(EXAMPLES / "block.yaml"), "name": "uncertain",
            "vary": {"width": {"normal": {"mean": 0.7, "deviation": 0.05}}, "height": {"values": [2.5, 2.8, 3.1]}},
        },
    ],
    "records": [str(EXAMPLES / "accel.csv"), {"pulse": "sine:0.6g:0.8s"}, {"pulse": "ricker:0.6g:1.2s"}],
    "method": "stripes",
    "levels": {"measure": "PGA", "least": 0.15, "most": 1.2, "count": 8},
    "polarity": "both",
    "samples": 3,
    "limit_states": ["uplift", "overturning", "25 mm", "0.2 m"],
}  # fmt: skip
LIMITS = ("25 mm", "200 mm")


def write(folder, **changes):
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump({**STUDY, **changes}), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("displacements")
    path = write(folder)
    return path, carry_out(path, folder / "study.runs", jobs=1), folder / "study.runs"


@pytest.mark.parametrize(("text", "limit"), [("2.5cm", "25 mm"), ("1 in", "25.4 mm"), ("0.03 m", "30 mm")])
def test_a_displacement_is_written_in_mm(text, limit):
    assert displacement_in_mm(text) == limit and is_quantity(limit)
    assert metres(limit) == pytest.approx(float(limit.split()[0]) / 1000)
    assert metres("uplift") is None and metres(0.5) is None and metres("25 kg") is None


def test_what_is_no_displacement_is_refused_with_its_line(tmp_path):
    limits = ["uplift", "25 kg", "0 mm", "1e999 m", "far"]
    with pytest.raises(InputError) as caught:
        load_study(write(tmp_path, limit_states=limits))
    said = {each.field: each.message for each in caught.value.problems}
    words = "a mass, not a length", "must be positive", "must be positive", "a displacement such as 25 mm"
    assert all(word in said[f"limit_states[{k}]"] for k, word in enumerate(words, 2))
    with pytest.raises(InputError, match="25 mm is given twice"):
        load_study(write(tmp_path, limit_states=["25 mm", "2.5 cm"]))


def test_a_block_moves_as_its_closed_form_says():
    block = load_structure(EXAMPLES / "block.yaml")
    b, h = block.width / 2, block.height
    wanted = [1e-6, 0.025, 0.2, 1.0, 2.5]
    for pair, u in zip(of_a_structure(block, wanted), wanted, strict=True):
        # About its right foot the middle of the top stands at (-b, h): it moves by b (1 - cos phi) + h sin phi.
        expected = brentq(lambda phi, u=u: b * (1 - np.cos(phi)) + h * np.sin(phi) - u, 0, np.pi / 2, xtol=1e-15)
        assert pair == pytest.approx((expected, expected), rel=1e-9)
    assert of_a_structure(block, [b + h + 0.001]) == [(None, None)]


@pytest.mark.parametrize("name", ["frame", "arch", "cone", "rigid_body"])
def test_it_is_the_first_rotation_at_which_the_top_is_there(name):
    structure = load_structure(EXAMPLES / f"{name}.yaml")
    spot = next(iter(Watched(structure).points.values()))
    for side in structure.directions:
        phi = np.linspace(0, structure.limit(side), 20_001)[:-1]
        body = [each.name for each in structure.bodies()].index(spot.body)
        moved = np.abs((structure.motion(phi, side)[body].carry(spot.at)[0] - spot.at).real)
        for share in (0.05, 0.5, 0.97):
            wanted = share * moved.max()
            (pair,) = of_a_structure(structure, [wanted])
            k = int(np.argmax(moved >= wanted))
            assert phi[k - 1] <= pair[0 if side is Direction.POSITIVE else 1] <= phi[k]


def test_a_bump_narrower_than_the_look_is_found_and_one_that_is_too_low_is_not():
    phi = np.linspace(0, 1, 65)

    def moved(x):
        return np.maximum(0.5 - 40 * np.abs(x - 0.3), 0) + 0.4 * np.sin(2 * np.pi * x) ** 2  # a spike on two hills

    top_of_it = float(moved(np.array([0.3]))[0])
    at = moved(phi)
    wanted = (at.max() + top_of_it) / 2  # between what is seen at the rotations looked at and what there is
    expected = brentq(lambda x: float(moved(np.array([x]))[0]) - wanted, 0.28, 0.3, xtol=1e-14)
    assert first_reached(moved, phi, at, wanted) == pytest.approx(expected, abs=1e-9)
    assert first_reached(moved, phi, at, 1.001 * top_of_it) is None


def slip_of_a_sine(amplitude, period, friction):
    """Return the largest slip of a body on the ground under one sine [m], in small steps and without the program."""
    steps = 40_000
    dt, slip, rate, most = 2 * period / steps, 0.0, 0.0, 0.0
    for k in range(steps):
        t = (k + 0.5) * dt
        push = -amplitude * 9.80665 * sin(2 * pi * t / period) if t < period else 0.0
        grip = friction * 9.80665 * dt
        tried = rate + push * dt
        rate = tried - min(max(tried, -grip), grip)  # friction stops it, or brakes it by all it has
        slip += rate * dt
        most = max(most, abs(slip))
    return most


def test_a_body_that_only_slides_exceeds_what_its_slip_exceeds(tmp_path):
    plinth = "mechanism: block\nname: plinth\nwidth: 0.4\nheight: 0.9\nfriction: 0.15\n"
    (tmp_path / "plinth.yaml").write_text(plinth, encoding="utf-8")
    levels = [0.12, 0.2, 0.24, 0.3, 0.36, 0.43]  # of one that rocks from 0.444 g
    limits = ["uplift", "sliding", "20 mm", "80 mm", "overturning"]
    path = write(
        tmp_path, structures=["plinth.yaml"], records=[{"pulse": "sine:1g:0.8s"}], samples=1, limit_states=limits,
        levels={"measure": "PGA", "values": levels}, polarity=1,
    )  # fmt: skip
    carry_out(path, tmp_path / "study.runs", jobs=1)
    slips = np.array([slip_of_a_sine(level, 0.8, 0.15) for level in levels])
    assert min(abs(slips - 0.02).min(), abs(slips - 0.08).min()) > 1e-3
    shown = command("results", tmp_path / "study.runs", "--json", "--out", tmp_path / "runs.csv")
    curves = json.loads(shown.stdout)["curves"]
    counts = {each["limit_state"]: each["exceedances"] for each in curves}
    expected = {"sliding": slips > 0, "20 mm": slips > 0.02, "80 mm": slips > 0.08}
    assert counts == {"uplift": 0, "overturning": 0} | {limit: int(seen.sum()) for limit, seen in expected.items()}
    assert not any(each["cut"] for each in curves)  # below lambda nothing uplifts, but all may slide
    rows = rows_of(tmp_path / "runs.csv")
    assert [float(row["slip [m]"]) for row in rows] == pytest.approx(slips.tolist(), abs=2e-4)
    assert [row["outcome"] for row in rows] == ["does not uplift"] + ["does not overturn; slides"] * 5


def test_samples_of_another_geometry_have_rotations_of_their_own(whole):
    path, _, place = whole
    study = load_study(path)
    store = Store.reading(place)
    table = kept(store.facts, LIMITS)["25 mm"]
    for pair, sample in zip(table[1:], study.samples[1:], strict=True):
        b, h = sample.mechanism.width / 2, sample.mechanism.height
        for phi in pair:
            assert b * (1 - np.cos(phi)) + h * np.sin(phi) == pytest.approx(0.025, rel=1e-9)
    assert len(set(table[1:, 0].tolist())) == 3


def test_a_store_without_them_opens_and_a_study_that_asks_adds_them_and_runs_nothing(whole, tmp_path, monkeypatch):
    path = write(tmp_path, limit_states=["uplift", "overturning"])
    place = tmp_path / "study.runs"
    carry_out(path, place, jobs=1)
    store = Store.reading(place)
    assert ROTATIONS_FACT not in store.facts
    write(tmp_path)
    store = Store.writing(place)
    assert not left(prepare(load_study(path), store), "exact").chunks
    found, expected = (json.loads(command("results", each, "--json").stdout)["curves"] for each in (place, whole[2]))
    assert found == expected and {each["limit_state"] for each in found} >= set(LIMITS)
    # What is known is not looked for again, also where the limits of today are others.
    monkeypatch.setattr(tally, "of_a_structure", lambda mechanism, wanted: [(float(each), None) for each in wanted])
    write(tmp_path, limit_states=["25 mm", "1 m"])
    store = Store.writing(place)
    prepare(load_study(path), store)
    store = Store.reading(place)
    table = kept(store.facts, ["25 mm", "1000 mm"])
    assert table["1000 mm"].tolist() == [[1.0, np.inf]] * 4
    assert table["25 mm"].max() < 0.02


def test_a_top_that_cannot_move_so_far_is_named(tmp_path):
    path = write(tmp_path, limit_states=["uplift", "overturning", "9 m"])
    carry_out(path, tmp_path / "study.runs", jobs=1)
    shown = command("results", tmp_path / "study.runs")
    assert "uncertain: its top never moves by 9000 mm, whatever its rotation" in " ".join(shown.stdout.split())
    curves = json.loads(command("results", tmp_path / "study.runs", "--json").stdout)["curves"]
    numbers = {(each["structure"], each["limit_state"]): each["exceedances"] for each in curves}
    for name in ("uncertain", "valley bridge"):
        assert numbers[name, "9000 mm"] == numbers[name, "overturning"]


def test_a_top_that_is_held_is_warned_of(tmp_path):
    wall, frame = (str(EXAMPLES / f"{name}.yaml") for name in ("spanning_wall", "frame"))
    for limits, warned in ((["10 mm", "uplift"], True), (["uplift", 0.2], False)):
        path = write(tmp_path, structures=[wall, frame], samples=1, limit_states=limits)
        found = command("fragility", path, "--check")
        said = " ".join(found.stderr.split())
        assert found.exit_code == 0 and ("limits such as 10 mm are of the top" in said) == warned
        assert "bridge: its top" not in said
