"""Structures without masses: their moments and inertias are per unit mass, and the output states this."""

import csv
import json
import re
from io import StringIO

import numpy as np
import pytest

from mechanisms.cone import Cone
from mechanisms.wall import Wall
from rocking_cli import Registry, load_structure
from rocking_cli.core import Direction
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

HEAVY = "mechanism: asymmetric_frame\ncolumn_width: 1\nleft_height: 6\nright_height: 7.5\nspacing: 8\nbeam_depth: 1\n"
MASSES = {
    "density": "density: 2400\ndepth: 1\n",
    "masses": "left_mass: 14400\nbeam_mass: 0\nright_mass: 18000\n",  # a beam of 0 kg is given, too
}
WITHOUT = ["block", "wall", "arch", "cone", "point_mass", "rigid_body", "symmetric_frame"]


def flat(text):
    return " ".join(text.split())


@pytest.mark.parametrize("name", WITHOUT)
def test_without_masses_bodies_weigh_a_kilogram(name):
    structure = load_structure(EXAMPLES / f"{name}.yaml")
    assert not structure.has_mass
    assert sum(body.mass for body in structure.bodies()) == pytest.approx(1)


@pytest.mark.usefixtures("small_maps")
def test_without_masses_it_is_per_unit_mass(tmp_path):
    file = EXAMPLES / "wall.yaml"
    data, said = run_json("equiv", file), flat(run("equiv", file, "--all").stdout)
    assert data["per_unit_mass"] is True
    assert "kg" not in said and "linearised inertia, per unit mass" in said
    (row, _) = csv.DictReader(StringIO(run("equiv", file, "-o", "-").stdout))
    assert row["per unit mass"] == "yes" and float(row["I_eq [kg m2]"]) == pytest.approx(
        data["directions"]["positive"]["I_eq"], rel=1e-8
    )
    run("report", file, "-o", tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert not re.search(r"kg\sm", page) and ">m²<" in page and "are per unit mass of the whole structure." in page


@pytest.mark.usefixtures("small_maps")
def test_with_masses_it_is_in_kilograms(tmp_path):
    assert all(parse_structure(HEAVY + masses, "f.yaml", "f").has_mass for masses in MASSES.values())
    file = tmp_path / "frame.yaml"
    file.write_text(HEAVY + MASSES["masses"], encoding="utf-8")
    data, said = run_json("equiv", file), flat(run("equiv", file, "--all").stdout)
    assert data["per_unit_mass"] is False and "kg m2" in said and "per unit mass" not in said
    run("report", file, "-o", tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert re.search(r"kg\sm²", page) and "are per unit mass" not in page


# --- what a mechanism warns of


@pytest.mark.usefixtures("small_maps")
def test_the_caution_of_the_wall_is_shown_where_it_is_looked_up_and_used(tmp_path):
    wall, file = Registry()["wall"], EXAMPLES / "wall.yaml"
    assert "Unconservative without a load on top" in wall.caution
    assert json.loads(run("mechanisms", "wall", "--json").stdout)["caution"] == wall.caution
    assert wall.caution in flat(run("mechanisms", "wall").stdout)
    assert (
        wall.caution in flat(run("equiv", file, "--all").stdout) and run_json("equiv", file)["caution"] == wall.caution
    )
    out = tmp_path / "r.html"
    run("report", file, "-o", out)
    assert wall.caution.replace("lambda", "λ") in flat(out.read_text(encoding="utf-8"))
    assert wall.caution in json.loads(run("report", file, "--json").stdout)["doubts"]


def test_without_one_nothing_is_shown():
    assert json.loads(run("mechanisms", "block", "--json").stdout)["caution"] is None
    assert "caution" not in run("mechanisms", "block").stdout.lower()
    assert "caution" not in run("equiv", EXAMPLES / "block.yaml").stdout.lower()


def test_the_caution_is_right():
    """A hinge higher up the same wall, by statics: both blocks about their pivots under their own weight alone."""
    thickness, height = 0.3, 3.0

    def multiplier(share):
        # The lower block turns by 1 about the foot, the upper one by -share/(1 - share) so that its top stays in line.
        lower, upper = share * height, (1 - share) * height
        swing = lower * lower / 2 + upper * lower / 2  # mass per metre times x' of the centroids
        back = share / (1 - share)
        rise = lower * thickness / 2 + upper * (thickness + back * thickness / 2)
        return rise / swing

    wall = Wall(thickness=thickness, height=height)

    assert multiplier(0.5) == pytest.approx(wall.uplift(Direction.POSITIVE), rel=1e-12)
    assert all(multiplier(share) == pytest.approx(2 * thickness / (share * height)) for share in (0.3, 0.6, 0.9))
    assert multiplier(0.8) < multiplier(0.6) < multiplier(0.5)


@pytest.mark.parametrize("given", [{"mass": 5e4}, {"density": 2000.0, "depth": 1.0}])
@pytest.mark.parametrize("name", ["wall", "arch", "block", "symmetric_frame", "cone"])
def test_the_same_with_a_mass_of_the_whole(name, given):
    """Masses change what is per kilogram, and nothing else."""
    bare = load_structure(EXAMPLES / f"{name}.yaml")
    if name == "cone" and "density" in given:
        given = {"mass": 5e4}  # a shell has no volume
    heavy = bare.model_copy(update=given)
    for direction in Direction:
        assert heavy.uplift(direction) == pytest.approx(bare.uplift(direction), rel=1e-12)
        assert heavy.critical_rotation(direction) == pytest.approx(bare.critical_rotation(direction), rel=1e-9)
        assert heavy.eta(direction) == pytest.approx(bare.eta(direction), rel=1e-12)


DENSE = {
    "spanning wall": (
        "mechanism: spanning_wall\nthickness: 0.3\nheight: 3.0\nhinge: weakest\noverburden: 20 kN\ndensity: 1800\n",
        1, "depth", "is missing",
    ),
    "polygon": (
        "mechanism: rigid_body\npolygon: [[0, 0], [1, 0], [0.9, 3.2], [0.2, 3.0]]\ndensity: 2400\n",
        1, "depth", "is missing",
    ),
    "columns": (
        "mechanism: symmetric_frame\ncolumn_width: 0.7\ncolumn_height: 3.2\nmass_ratio: 2.5\ndensity: 1900\n",
        1, "depth", "is missing",
    ),
    "crushing under a tie outside": (
        "mechanism: rigid_body\npolygon: [[-1, 0], [0.5, 0], [0.5, 5], [-1, 5]]\ndensity: 1800\ndepth: 0.7\n"
        "crushing: {strength: 1 MPa}\nties:\n"
        "  - {name: bar, from: {ground: [-3, 5]}, to: {at: [2, 5]}, stiffness: 1}\n",
        7, "ties[1].to.at", "lies outside body",
    ),
    "no shape": (
        "mechanism: rigid_body\nR: 1.5\nalpha_deg: 14.0\ninertia_ratio: 1.3333\ndensity: 1800\ndepth: 1.0\n",
        5, "density", "the shape of its body is not known: give its mass instead",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", DENSE)
def test_masses_that_cannot_be_had_are_the_mistake_of_the_file(name):
    text, line, field, said = DENSE[name]
    with pytest.raises(InputError) as caught:
        parse_structure(text, "s.yaml", "s")
    (found,) = caught.value.problems
    assert (found.line, found.field) == (line, field) and said in found.message


@pytest.mark.parametrize("ratio", [None, 0.6])
def test_a_cone_weighs_what_its_slices_do(ratio):
    r, h, k = 0.5, 2.0, ratio or 0.0
    cone = Cone(base_radius=r, height=h, kind="hollow" if ratio else "solid", inner_ratio=ratio)
    z = (np.arange(20_000) + 0.5) * h / 20_000
    inner = np.where(z < k * h, k * r - z * r / h, 0.0)  # the inner cone stands on the same base
    assert cone.volume() == pytest.approx(np.pi * ((r - z * r / h) ** 2 - inner**2).sum() * h / 20_000, rel=1e-6)
