"""Structures with loads that do not grow with them: the spectrum is that of structures scaled by hand."""

from math import inf, pi

import numpy as np
import pytest
from pytest import approx

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from mechanisms.wall import Wall
from rocking_cli.core import Body, Direction, Mechanism, box, equivalent_block, length, quantity, rotation
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.questions.spectrum.picture import draw_spectra
from rocking_cli.questions.spectrum.study import count_histories, shape_of, spectra
from rocking_cli.structure import Structure
from tests.cli.test_cli import run as command
from tests.cli.test_cli import run_json
from tests.following import respond


class Laden(Mechanism):
    """A uniform block of a density with a statue of so many kilograms on its top."""

    mechanism = "laden"
    title = "block under a statue"
    source = "the tests"
    verified = "here"

    width: float = length("width")
    height: float = length("height")
    depth: float = length("depth", default=0.8)
    statue: float = quantity("mass of the statue", unit="kg", ge=0)

    def bodies(self):
        mass = 2000.0 * self.depth * self.width * self.height
        block = box("block", mass, self.width, self.height, 0.5j * self.height)
        return block, Body("statue", self.statue, 0.0, 1.3j * self.height)

    def motion(self, phi, direction):
        turn = rotation(phi, complex(direction * self.width / 2), -direction)
        return turn, turn

    def limit(self, direction):
        return pi / 2


LADEN = Laden(name="laden", width=0.8, height=2.4, statue=900.0)
MOTIONS = [parse_pulse("sine:0.5g:0.7s").sampled(), parse_pulse("ricker:0.6g:0.9s").sampled()]
PERIODS = np.array([1.1, 2.0, 4.0, 6.0])


def by_hand(scale):
    return Laden(width=scale * 0.8, height=scale * 2.4, depth=scale * 0.8, statue=900.0)


@pytest.mark.parametrize("model", ["nonlinear", "linear1", "linear2"])
def test_every_size_is_the_structure_scaled_by_hand(model):
    shape = shape_of(Structure(LADEN), model)
    (found,) = spectra([shape], PERIODS, MOTIONS)
    assert found.scales.size == 5 and found.scales[found.given] == 1.0
    assert np.ptp(found.uplifts) > 0.05
    for k, scale in enumerate(found.scales.tolist()):
        structure = by_hand(scale)
        block = equivalent_block(structure).positive
        assert found.periods[k] == approx(2 * pi / block.p, rel=1e-9)
        assert found.uplifts[k] == approx(block.lambda_lin if model == "linear1" else block.lambda_, rel=1e-9)
        for m, motion in enumerate(MOTIONS):
            run = respond(structure, motion, models=(model,))[model]
            assert found.peak_ratio[m, k] == approx(inf if run.overturned else run.peak_ratio, rel=1e-9)
    assert np.delete(found.periods, found.given) == approx(PERIODS, rel=1e-9)
    assert np.isfinite(found.peak_ratio).sum() > 3


def test_shape_alone_would_say_otherwise():
    shape = shape_of(Structure(LADEN), "nonlinear")
    assert shape.own is not None
    (right,) = spectra([shape], PERIODS, MOTIONS)
    (wrong,) = spectra([type(shape)(shape.structure)], PERIODS, MOTIONS)
    assert not np.allclose(right.peak_ratio, wrong.peak_ratio, rtol=0.05)


@pytest.mark.parametrize(
    "structure",
    [
        Block(width=0.7, height=2.8),
        Wall(thickness=0.3, height=3.0),
        RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [0.9, 3.2], [0.2, 3.0]]),
        Laden(width=0.8, height=2.4, statue=0.0),
        AsymmetricFrame(
            column_width=1.0,
            left_height=6.0,
            right_height=7.5,
            spacing=8.0,
            beam_depth=1.0,
            left_mass=14400.0,
            beam_mass=21600.0,
            right_mass=18000.0,
        ),
    ],
    ids=lambda each: each.mechanism,
)
def test_where_all_masses_keep_their_ratios_shape_alone_decides(structure):
    assert shape_of(Structure(structure), "linear2").own is None


@pytest.mark.parametrize("scale", [0.25, 3.0])
def test_enlarging_multiplies_lengths_in_lists_and_defaults_too_and_nothing_else(scale):
    stone = RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [0.5, 3.0]], restitution=0.9, gravity=9.7)
    other = stone.enlarged(scale)
    assert np.array(other.polygon) == approx(scale * np.array(stone.polygon))
    assert (other.restitution, other.gravity) == (0.9, 9.7)
    assert LADEN.enlarged(scale) == by_hand(scale).model_copy(update={"name": "laden"})


def test_of_several_motions_and_both_polarities_every_history_is_counted_and_progress_told():
    shape, done = shape_of(Structure(LADEN), "linear2"), []
    (found,) = spectra([shape], PERIODS, MOTIONS, polarities=(1, -1), progress=done.append)
    assert sum(done) == count_histories([shape], PERIODS, 2, (1, -1)) and found.peak_ratio.shape == (2, 5)


def test_a_size_that_cannot_be_built_is_named():
    with pytest.raises(InputError, match=r"laden at scale .* cannot be built: depth must be at most 1e\+06 m"):
        spectra([shape_of(Structure(LADEN), "linear2")], np.array([1e5]), MOTIONS)


def test_the_command_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr("rocking_cli.ask.inputs.parse_structure", lambda *text, **checked: LADEN)
    (tmp_path / "laden.yaml").touch()
    asked = ["spectrum", "laden.yaml", "--pulse", "sine:0.5g:0.7s", "--sizes", "1:4", "--count", "2"]
    result = command(*asked, "--plot", "s.png", "--out", "s.csv")
    assert "every size was built and simulated separately. Uplift is at 0." in " ".join(result.stdout.split())
    assert (tmp_path / "s.csv").read_text(encoding="utf-8").splitlines()[0].count(",lambda,") == 1
    (found,) = run_json(*asked)["spectra"]
    assert found["alike"] is False and len(found["lambdas"]) == len(found["size"]) == 3
    wanted = [equivalent_block(by_hand(scale))[Direction.POSITIVE].lambda_ for scale in found["scale"]]
    assert found["lambdas"] == approx(wanted, rel=1e-9)


def test_the_second_axis_of_the_picture_goes_through_the_sizes():
    (found,) = spectra([shape_of(Structure(LADEN), "linear2")], PERIODS, MOTIONS[:1])
    figure = draw_spectra([found], (0.5,), "title")
    figure.draw_without_rendering()
    (above,) = figure.axes[0].child_axes
    forward, backward = above._functions
    assert forward(found.radii) == approx(found.periods) and backward(found.periods) == approx(found.radii)
