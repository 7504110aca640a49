"""What is said of the joints of a history: which were checked, and what the result rests on."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.dynamics import kernels, openings, stepping
from rocking_cli.dynamics.deck import lay_out, run_deck
from rocking_cli.dynamics.joints import checked_joints
from rocking_cli.dynamics.resting import FEET_PLACE
from rocking_cli.structure import build_models
from rocking_cli.studies.contact import Contacts
from rocking_cli.views.animation import verdict_of
from rocking_cli.views.verdict import contact_words, joints_in_words
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.dynamics.test_rest import CRACKS, of
from tests.following import respond

SQUAT = rk.Block(width=1.2, height=1.2)
FRAME = rk.load_structure(EXAMPLES / "frame.yaml")
VALID = re.compile(r"(?<!not )(?<!no longer )\bvalid\b")


def under(structure, pulse):
    motion = rk.parse_pulse(pulse).sampled()
    history = respond(structure, motion, models=("nonlinear",))["nonlinear"]
    return history, Contacts(structure).check(history, motion)


@pytest.mark.parametrize(
    ("structure", "said"),
    [
        ("wall.yaml", "feet A, A'; hinges B, B'"),
        ("linkages/corner_pier.yaml", "foot A; hinge B"),
        ("linkages/portico.yaml", "feet A, A', C, C' and 2 more; hinges B, B', D, D' and 2 more"),
        ("masonry/wall_of_three.yaml", "feet A', B; hinges A, B'; closed joint base and middle"),
        (
            "masonry/buttressed_arch.yaml",
            "feet A', D; hinges A, B, B', C and 2 more; closed joints left and v1, right and v11, v3 and v4, v4 and v5 "
            "and 2 more",
        ),
        (CRACKS, "feet A, A'; hinges B, B'"),  # each hinge is a joint that stays closed in the other direction
    ],
    ids=lambda value: str(value)[:24].strip(),
)
def test_joints_that_are_checked_are_named_by_kind(structure, said):
    made = of(structure) if structure == CRACKS else rk.load_structure(next(EXAMPLES.rglob(structure)))
    assert "; ".join(checked_joints(made)) == said


@pytest.mark.parametrize("name", ["frame", "linkage", "portal"])
def test_all_joints_of_the_tables_are_named_and_no_others(name, monkeypatch):
    """A joint has one letter in each direction in which it is a hinge, and the name of both bodies if in none."""
    monkeypatch.setattr("rocking_cli.dynamics.joints.MAX_LISTED_NAMES", 1000)
    made = rk.load_structure(next(EXAMPLES.rglob(f"{name}.yaml")))
    (model,) = build_models(made, ("nonlinear",))
    named = [each for kind in model.joints.checked for each in re.sub(r"^(closed )?\w+ ", "", kind).split(", ")]
    hinges = {(c.label, d) for d in Direction for c in made.contacts(d) if c.held is None and len(c.points) == 1}
    closed = set(model.joints.labels) - {label for label, _ in hinges} - {FEET_PLACE}
    letters = {joint.letter for direction in Direction for joint in made.joints(direction) if not joint.is_guide}
    assert len(named) == len(hinges) + len(closed) and set(named) == closed | letters


def test_the_sentence_names_what_is_checked_and_what_is_not():
    wall = rk.load_structure(next(EXAMPLES.rglob("wall.yaml")))
    history, found = under(wall, "sine:0.2g:0.5s")
    assert np.isnan(history.warned) and found.assumed_friction is None
    bear = "All checked joints bear throughout the motion (feet A, A'; hinges B, B')"
    taken = "Not checked, but assumed to hold: the support of upper block."
    assert joints_in_words(history) == f"{bear}. {taken}"
    check = replace(history.check, warned=1.5, warned_joint="a and b", largest=1e-8)
    said = joints_in_words(replace(history, check=check))
    assert said == f"{bear}, except the joint between a and b for an instant at 1.5 s. {taken}"


@pytest.mark.parametrize("pulse", ["sine:1.5g:0.3s", "sine:2g:0.3s", "sine:2.5g:1s", "sine:2g:0.5s"])
def test_what_needs_more_friction_than_masonry_has_is_not_called_valid(pulse):
    """Of a squat block nothing opens, it opens a little, it bears beyond phi_cr, and too much: all need friction."""
    history, found = under(SQUAT, pulse)
    assert found.friction_needed > 2
    assumes = (
        f"The friction required, {found.friction_needed:.3g}, is more than the 0.6 usual for masonry: the result "
        "assumes that nothing slides."
    )
    said = joints_in_words(history, found.assumed_friction)
    assert assumes in said and not VALID.search(said)
    assert replace(found, friction=10.0).assumed_friction is None


def test_the_answer_and_the_film_say_once_what_friction_they_assume(tmp_path):
    pulse, assumes = "sine:2g:0.5s", "is more than the 0.6 usual for masonry: the result assumes that nothing slides."
    answer = rk.respond(SQUAT, pulse, model="nonlinear", neighbours=0)
    whole = " ".join(answer.sentences)
    assert whole.count(assumes) == 1 and not VALID.search(whole)
    assert assumes in answer.to_dict()["verdict"]
    film = rk.animate(SQUAT, pulse, out=tmp_path / "x.html", neighbours=0).film
    assert assumes in verdict_of(film) and not VALID.search(verdict_of(film))


def test_with_friction_in_the_file_a_small_opening_leaves_a_valid_result():
    history, found = under(rk.Block(width=1.0, height=3.0, friction=0.345), "sine:0.5g:0.2s")
    assert found.assumed_friction is None and 0 < history.opening < 0.005 and history.peak_ratio > 0.02
    assert joints_in_words(history).endswith("less than the limit, so the outcome and the peak remain valid.")


def test_joints_of_several_bodies_bear_but_need_friction():
    history, found = under(FRAME, "sine:0.4g:0.8s")
    assert found.friction_needed < 0.6 and found.assumed_friction is None
    assert replace(found, friction_needed=0.61).assumed_friction == 0.61
    assert replace(found, friction_needed=0.61, friction=0.7).assumed_friction is None
    assert joints_in_words(history, 0.61) == (
        "All checked joints bear throughout the motion (feet A, A', D, D'; hinges B, B', C, C'). The friction "
        "required, 0.61, is more than the 0.6 usual for masonry: the result assumes that nothing slides."
    )


def test_a_pulse_and_a_report_say_what_friction_they_assume(tmp_path):
    file = tmp_path / "squat.yaml"
    file.write_text("mechanism: block\nwidth: 1.2\nheight: 1.2\n", encoding="utf-8")
    pulse = " ".join(run("pulse", file, "--ag", "2g", "--period", 0.3).stdout.split())
    report = json.dumps(run_json("report", file, "--pulse", "sine:2g:0.3s", "--neighbours", 1, "--polarity", 1))
    for said in (pulse, report):
        assert "is more than the 0.6 usual for masonry: the result assumes that nothing slides." in said
        assert "so the outcome" not in said
    assert "The result assumes that nothing slides: see below how much friction this requires." in report


UNCERTAIN = (
    "less than the limit, so the outcome remains valid. The peak is uncertain by some 20 %, as it is below 0.02 of the "
    "critical rotation and the opening is above 0.1 % of D_cr."
)


@pytest.mark.parametrize(
    ("peak", "opening", "uncertain"),
    [(0.0199, 0.0011, True), (0.0201, 0.0011, False), (0.0199, 0.0009, False), (0.0, 0.0011, False)],
)
def test_a_small_peak_beside_an_opening_is_uncertain(peak, opening, uncertain):
    history, _ = under(SQUAT, "sine:2g:0.3s")
    check = replace(history.check, largest=opening * history.check.reach)
    said = joints_in_words(replace(history, peak_ratio=peak, check=check))
    assert (UNCERTAIN in said) == uncertain
    assert uncertain or said.endswith("so the outcome and the peak remain valid.")


def test_a_block_that_slides_a_little_and_hardly_rocks():
    block = rk.Block(width=1.0, height=3.0, friction=0.345)
    history, found = under(block, "sine:0.5g:0.15s")
    assert found.assumed_friction is None and 0 < history.peak_ratio < 0.02 and 0.001 < history.opening < 0.005
    assert joints_in_words(history).endswith(UNCERTAIN)
    history, found = under(SQUAT, "sine:2.5g:0.1s")
    said = joints_in_words(history, found.assumed_friction)
    assert not VALID.search(said) and "limit. The peak is uncertain by some 20 %" in said and "nothing slides" in said


def test_a_row_of_base_shear_says_that_impacts_are_left_out():
    asked = ("respond", EXAMPLES / "block.yaml", "--pulse", "sine:0.4g:0.8s", "--neighbours", 0)
    found = run_json(*asked)["responses"]["nonlinear"]["contact"]["base_shear"]
    row = next(line for line in run(*asked).stdout.splitlines() if "base shear" in line)
    assert row.split()[:4] == ["base", "shear,", "without", "impacts"]
    assert float(row.split()[4]) in (float(f"{found:.4g}"), float(f"{found / 1000:.4g}"))


@pytest.mark.parametrize(
    ("name", "pulse"),
    [("block", "sine:2g:2s"), ("symmetric_frame", "sine:2g:2s"), ("frame", "sine:2g:2s"), ("wall", "sine:0.8g:1.5s")],
)
def test_no_sentence_speaks_of_a_joint_after_overturning(name, pulse):
    structure = rk.load_structure(EXAMPLES / f"{name}.yaml")
    history, found = under(structure, pulse)
    assert history.fell and np.isnan(history.warned) and np.isnan(history.check.warned)
    assert found.opens is None or np.isnan(found.opens)
    said = f"{joints_in_words(history)} {contact_words(found, structure)}"
    times = [float(each) for each in re.findall(r"[Aa]t ([\d.]+) s\b", said)]
    assert times and max(times) <= history.overturning_time + 1e-4 and "for an instant" not in said
    # The kernel did see a joint that would open then, so that it is left out on purpose.
    (model,) = build_models(structure, ("nonlinear",))
    marks = np.full((1, stepping.MARKS), np.nan)
    rows = np.zeros((1, kernels.RUN_COLUMNS))
    rows[0, [kernels.FACTOR, kernels.V_FACTOR, kernels.SIZE, kernels.SLENDER]] = 1.0
    rows[0, [kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE]] = np.nan
    run_deck(lay_out([model], [rk.parse_pulse(pulse).sampled()]), rows, marks, rtol=1e-9)
    assert history.overturning_time == marks[0, stepping.CROSSED] < marks[0, openings.WARNED]
