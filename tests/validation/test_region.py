"""The joint region of slenderness and restitution: against shares one by one, and as a user runs the command."""

import csv
from math import atan, cos, hypot, sin

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood
from tests.conftest import EXAMPLES
from tests.validation.test_score import run, run_json
from validation.likelihood import JointRegion, joint_region
from validation.region import LOWER, command, draw_region, region, view
from validation.table import parse_columns

GRID = {"slenderness": (0.8, 1.25), "restitution": (0.32, 0.98), "points": 3, "neighbours": 12}
SCATTER = {"restitution": 0.05, "slenderness": 0.03}


@pytest.fixture(scope="module")
def outcomes():
    """Outcomes drawn by the shares of a block with eta .65."""
    block = rk.Block(width=0.7, height=2.8, restitution=0.65, uncertainty=SCATTER)
    pulses = [f"sine:{level:g}g:{period:g}s" for level in np.arange(0.3, 0.6, 0.03) for period in (0.6, 0.9, 1.3)]
    shares = np.array([rk.shares(block, pulse, neighbours=12).overturned for pulse in pulses])
    assert 5 < shares.sum() < shares.size - 5
    return {
        "structure": ["x"] * 30, "record": pulses, "polarity": [1] * 30,
        "overturned": (np.random.default_rng(1).random(30) < shares).astype(int).tolist(),
        "cluster": [f"c{k // 2}" for k in range(30)],
    }  # fmt: skip


class TestRegion:
    @pytest.mark.rest
    def test_the_likelihood_is_that_of_shares(self, outcomes):
        block = rk.Block(width=0.7, height=2.8, uncertainty=SCATTER)
        found = region(block, outcomes, **GRID)
        assert found.best == pytest.approx((1, 0.65))
        # Once more at another point: its shares one by one, and the formula written out.
        other = rk.Block(width=0.7, height=2.8, restitution=0.98, uncertainty=SCATTER)
        shares = np.array([rk.shares(other, each, neighbours=12).overturned for each in outcomes["record"]])
        held = np.clip(shares, 0.5 / 13, 1 - 0.5 / 13)
        total = np.log(np.where(np.array(outcomes["overturned"]) == 1, held, 1 - held)).sum()
        assert (found.tests, found.clusters) == (30, 15)
        assert found.likelihood[1, 2] == pytest.approx(total * 15 / 30, rel=1e-9)
        assert found.inside[1, 1] and not found.inside.all()
        (low, high), (least, most) = found.ranges
        assert low <= found.best[0] <= high and least <= found.best[1] <= most

    @pytest.mark.rest
    def test_a_factor_on_slenderness_is_a_structure_made_anew(self, outcomes):
        """Of twice the slenderness, the same uplift is twice the acceleration: by scaling, and by another block."""
        tests = parse_columns(outcomes).tests
        motions = {test.record: rk.parse_pulse(test.record).sampled() for test in tests}
        block = rk.Block(width=0.7, height=2.8, restitution=0.65, uncertainty=SCATTER)
        grid = np.array([0.5, 1.0, 1.5]), np.array([0.5, 0.65, 0.8])
        found = joint_region(tests, Structure(block), motions.__getitem__, Neighbourhood(12), *grid)
        size, alpha = hypot(0.7, 2.8), 1.5 * atan(0.25)
        wide = rk.Block(width=size * sin(alpha), height=size * cos(alpha), restitution=0.65, uncertainty=SCATTER)
        shares = np.array([rk.shares(wide, each, neighbours=12).overturned for each in outcomes["record"]])
        assert found.likelihood[2, 1] == pytest.approx(
            np.log(np.where(np.array(outcomes["overturned"]) == 1, shares, 1 - shares).clip(0.5 / 13, 1)).sum() / 2,
            rel=0.1,
        )

    @pytest.mark.rest
    def test_a_best_point_on_the_edge_is_refused(self, outcomes):
        grid = {**GRID, "restitution": (0.65, 0.98)}
        with pytest.raises(InputError, match=r"lies on its edge \(restitution 0\.65\)"):
            region(rk.Block(width=0.7, height=2.8, uncertainty=SCATTER), outcomes, **grid)

    @pytest.mark.rest
    def test_the_command_and_its_words(self, tmp_path, outcomes):
        (tmp_path / "block.yaml").write_text(
            "mechanism: block\nwidth: 0.7\nheight: 2.8\nuncertainty: {slenderness: 0.03}\n", encoding="utf-8"
        )
        with (tmp_path / "tests.csv").open("w", newline="", encoding="utf-8") as stream:
            table = csv.writer(stream)
            table.writerow(outcomes)
            table.writerows(zip(*({**outcomes, "structure": ["block.yaml"] * 30}).values(), strict=True))
        asked = [command, tmp_path / "block.yaml", tmp_path / "tests.csv", "--points", 3]
        asked += ["--slenderness", "0.8:1.25", "--restitution", "0.32:0.98", "--neighbours", 10]
        data = run_json(*asked, "--plot", tmp_path / "region.png")
        assert data["tests"] == 30 and data["clusters"] == 15
        assert np.shape(data["grid"]["log_likelihood"]) == (3, 3)
        assert data["region"]["probability"] == 0.9
        text = run(*asked).stdout
        assert f"restitution {data['best']['restitution']:.3g}" in text and "30 of 30 tests are of" in text
        assert (tmp_path / "region.png").read_bytes().startswith(b"\x89PNG")
        said = run(command, EXAMPLES / "block.yaml", tmp_path / "tests.csv", code=2).stderr
        assert "no test is of" in said and "its structures are block.yaml" in said

    @pytest.mark.parametrize(("drop", "wide"), [(1.0, True), (9.0, False)])
    def test_a_region_that_reaches_the_edge_is_said_to(self, drop, wide):
        likelihood = np.full((3, 3), -drop)
        likelihood[1, 1] = 0.0
        found = JointRegion(
            Neighbourhood(9), np.array([0.8, 1, 1.2]), np.array([0.8, 0.9, 0.95]), likelihood, 5, 4, 0.0
        )
        text = " ".join(part for part in view(found, "a", "f", 5).parts if isinstance(part, str))
        assert ("the region reaches the edge" in text) == wide
        assert found.inside.sum() == (9 if wide else 1)
        axes = draw_region(found, "a").axes[0]  # levels that the likelihood does not reach are left out
        labels = {text.get_text() for text in axes.texts}
        assert labels == (set() if wide else {f"{level:g}" for level in LOWER if level > -drop})
