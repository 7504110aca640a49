"""The list of mechanisms says what each is for, and draws each at its critical rotation."""

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.patches import Polygon

import rocking_cli as rk
from rocking_cli.plotting import style
from rocking_cli.questions.mechanisms.command import drawing
from rocking_cli.questions.mechanisms.picture import draw_chooser
from rocking_cli.views.mechanisms import InstalledMechanism
from tests.cli.test_cli import run, run_json

OWN = [name for name in rk.Registry() if rk.Registry().package_of(name).startswith("rocking-cli ")]


def test_the_list_says_what_each_is_for_and_the_next_step():
    listed = {each["name"]: each for each in run_json("mechanisms")["mechanisms"]}
    text = run("mechanisms").stdout
    for name in OWN:
        suits = listed[name]["suits"]
        assert suits == rk.Registry()[name].suits and 0 < len(suits) <= 60
        assert re.search(rf"^ *{name} +{re.escape(suits)} ", text, re.M)
    assert "rocking new NAME > structure.yaml" in text
    assert "leave out arch" in run("mechanisms", "arch", "--plot", "p.svg", code=2).stderr


def test_a_mechanism_is_drawn_at_its_critical_rotation_and_named_without_a_drawing():
    registry = rk.Registry()
    found = [(InstalledMechanism("block", "a block", "pedestal", ""), drawing("block", registry))]
    found.append((InstalledMechanism("odd", "odd thing", None, ""), None))
    figure = draw_chooser(found)
    words = [text.get_text() for text in figure.texts]
    assert words == ["block", "pedestal", "odd", "odd thing"]
    (block,) = (each for each in figure.axes[0].patches if isinstance(each, Polygon) and each.get_linestyle() == "-")
    corners = block.get_xy()[:-1]
    width, height = 0.7, 2.8
    assert np.min(corners[:, 1]) == pytest.approx(0, abs=1e-9)
    assert np.max(corners[:, 1]) == pytest.approx(np.hypot(width, height), rel=1e-9)  # its diagonal is upright
    (left, right), (low, high) = figure.axes[0].get_xlim(), figure.axes[0].get_ylim()
    assert left < corners[:, 0].min() and corners[:, 0].max() < right
    assert low < 0 and corners[:, 1].max() < high
    assert not figure.axes[1].patches
    with style.on_phone():
        assert draw_chooser(found).get_figwidth() == style.PHONE_WIDTH


@pytest.mark.rest
def test_all_are_drawn_with_a_shape():
    done = run("mechanisms", "--plot", "chooser.svg")
    assert "is not drawn" not in done.stderr
    text = Path("chooser.svg").read_text(encoding="utf-8")
    assert text.count('id="axes_') == len(list(rk.Registry()))
    shaped = {name for name in OWN if not any(part.assumed for part in drawing(name, rk.Registry()).parts)}
    assert set(OWN) - shaped == {"curve"}
