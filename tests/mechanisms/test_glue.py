"""Assemblies whose joints have no friction: they carry any shear, and what that adds to lambda is said."""

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.errors import MechanismError
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

FLOOR = {"floor": {"polygon": [[-3.0, -0.5], [5.0, -0.5], [5.0, 0.0], [-3.0, 0.0]]}}
TOWER = {"polygon": [[0.0, 0.0], [1.2, 0.0], [1.2, 4.0], [0.0, 4.0]]}
BESIDE = {"polygon": [[1.2, 0.0], [1.8, 0.0], [1.8, 1.5], [1.2, 1.5]]}
TAPERED = {"polygon": [[0.0, 0.0], [1.2, 0.0], [1.2, 1.88], [1.0, 4.9], [0.3, 4.9]]}
LEANS = {"polygon": [[1.2, 0.0], [1.8, 0.0], [1.5, 1.35], [1.2, 1.35]]}


def glued(**fields):
    return rk.Assembly(
        name="glued", blocks={"tower": TOWER, "side": BESIDE}, ground=FLOOR, density=2200.0, depth=1.0, **fields
    )


@pytest.fixture
def file(tmp_path):
    given = glued().model_dump(exclude_unset=True) | {"mechanism": "assembly"}
    (tmp_path / "glued.yaml").write_text(yaml.safe_dump(given), encoding="utf-8")
    return tmp_path / "glued.yaml"


class TestGlue:
    """Joints without friction bear any shear: a tower that tips at 0.3 alone lifts its neighbour too."""

    def test_lambda_with_the_usual_friction_stands_beside_it(self):
        made, rough = glued(), glued(friction=0.6)
        for d in Direction:
            found = made.collapse(d)
            assert found.with_usual == pytest.approx(rough.collapse(d).lambda_, rel=1e-9)
            assert 1.2 / 4.0 < found.with_usual < 0.9 * found.lambda_
            assert {each.key: each.value for each in made.extras(d)}["lambda_with_usual"] == found.with_usual
            assert rough.collapse(d).with_usual is None
        assert rough.own_caution() == ""
        assert "0.347 g instead of 0.4117 g in the negative direction" in made.own_caution()

    def test_no_friction_at_all_between_them_leaves_the_tower_alone(self):
        """By hand: it tips about its corner at 1.2/4; its neighbour stands."""
        found = glued(friction_of={"tower and side": 0.0}).collapse(Direction.NEGATIVE)
        assert found.lambda_ == pytest.approx(0.3, rel=1e-9) == found.with_usual

    def test_nothing_is_said_where_it_changes_nothing(self):
        assert rk.load_structure(EXAMPLES / "masonry" / "portal.yaml").own_caution() == ""

    @pytest.mark.every(4)
    @pytest.mark.parametrize("command", [
        ("equiv",), ("collapse",), ("respond", "--pulse", "sine:0.5g:1s", "--neighbours", "0"),
        ("margin", "--pulse", "sine:0.5g:1s", "--neighbours", "5"),
        ("overturning", "--period", "1:2", "--ag", "0.5g:1g", "--points", "3"),
        ("spectrum", "--pulse", "sine:0.5g:1s", "--sizes", "1:2", "--count", "2"),
        ("design", "--vary", "density=2000kg/m3:2400kg/m3", "--until", "lambda > 0.2", "--points", "2"),
    ], ids=lambda command: command[0])  # fmt: skip
    def test_every_command_that_shows_lambda_says_so(self, command, file):
        name, *options = command
        said = " ".join(run(name, file, *options).stdout.split())
        assert "0.347 g instead of 0.4117 g in the negative direction" in said

    def test_a_survey_says_so_of_each(self, file):
        rows = file.with_name("rows.csv")
        rows.write_text("name,file\na,glued.yaml\n", encoding="utf-8")
        assert "0.347 g instead of 0.4117 g" in run_json("survey", rows)["rows"][0]["caution"]

    def test_a_mechanism_that_such_a_joint_locks_is_shown_with_the_joint(self):
        """Its three hinges are on one line, as the neighbour turns about a joint that bears no more than shear."""
        made = rk.Assembly(
            name="tapered", blocks={"tower": TAPERED, "side": LEANS}, ground=FLOOR, density=2373.0, depth=0.58
        )
        found = made.collapse(Direction.NEGATIVE)
        assert [hinge.at.imag for hinge in found.hinges] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
        assert "between tower and side" in found.no_model and "give `friction`" in found.no_model
        assert found.lambda_ > found.with_usual > 0.3 and not found.lead and found.valid_to is None
        with pytest.raises(MechanismError, match=r"between tower and side.* give `friction`"):
            made.uplift(Direction.NEGATIVE)
