"""Curves for pelicun: the table of its damage models, and what pelicun makes of it."""

import numpy as np
import pytest
from scipy.stats import norm

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io.tables import write_table
from rocking_cli.questions.fragility.exports import components, demand, table
from tests.conftest import EXAMPLES, rows_of
from tests.questions.fragility.test_nrml import curve, replace_name, some, store  # noqa: F401, a fixture
from tests.stores import command

SAMPLES = 20_000  # of damage states
ORDER = 0, 3, 4, 2, 1  # of severity


def test_measures_have_the_demand_types_of_pelicun_or_are_left_out():
    assert demand("PGV") == ("Peak Ground Velocity", "mps") and demand("Sa(1 s)") == ("Spectral Acceleration|1.0", "g")
    assert demand("PGD") is None and demand("Sa(1 s, 10 %)") is None  # a permanent deformation there
    sliding, step = curve("pedestal", "sliding", 0.5, 0.3), curve("other", 0.9, 0.82, 0, kind="step")
    (row,), (over_pgd, of_sliding, of_step) = components([*some(), *some(measure="PGD"), sliding, step])
    assert [each.limit for each in row.curves] == ["uplift", 0.1, "25 mm", 0.5, "overturning"]
    assert over_pgd.startswith("all curves over PGD: ") and "pelicun orders limit states" in of_sliding
    assert "its curve is a step one, and the table for pelicun accepts only lognormal curves" in of_step
    with pytest.raises(InputError, match="pelicun accepts none of the curves: all curves over PGD"):
        components(some(measure="PGD"))


def test_names_are_without_the_sign_at_which_pelicun_splits_them():
    rows, _ = components([*some("wall-1"), *some("wall_1")[:1], *some("wall-1", measure="PGV")])
    assert [row.name for row in rows] == ["wall_1_PGA", "wall_1_PGA.2", "wall_1_PGV"]
    assert table(rows)["LS2-Family"] == ("lognormal", "", "lognormal")


def test_more_limit_states_than_pelicun_sorts_are_refused():
    many = [curve("a", k / 10, 0.4 + k / 50, 0.3) for k in range(1, 11)]
    with pytest.raises(InputError, match="a over PGA: pelicun sorts at most 9 limit states"):
        components(many)
    assert len(table(components(many[1:])[0])) == 6 + 4 * 9


def test_the_command_writes_the_table_and_names_the_rest(store, tmp_path):  # noqa: F811
    found = command("results", store, "--pelicun", tmp_path / "new" / "folder", code=0)
    (row,) = rows_of(tmp_path / "new" / "folder" / "fragility.csv")
    assert list(row.values())[:6] == ["pedestal", "0", "Peak Ground Acceleration", "g", "0", "1"]
    for k, limit in enumerate((0.5, "overturning"), 1):
        each = rk.results(store).curves[limit]
        numbers = float(row[f"LS{k}-Theta_0"]), float(row[f"LS{k}-Theta_1"])
        assert numbers == pytest.approx((each.median.value, each.dispersion.value))
    assert "uplift over PGA: its curve is a step" in found.stderr and "pedestal: LS1 0.5, LS2" in found.stderr


def test_without_a_curve_the_rest_is_written(tmp_path):
    study = (EXAMPLES / "study" / "pedestal.yaml").read_text(encoding="utf-8").replace("../", f"{EXAMPLES}/")
    (tmp_path / "study.yaml").write_text(study + "measures: [PGA/(g lambda)]\n", encoding="utf-8")
    command("fragility", tmp_path / "study.yaml", code=0)
    found = command("results", tmp_path / "study.runs", "--nrml", tmp_path / "f.xml", "--pelicun", tmp_path / "new")
    assert found.exit_code == 5 and "OpenQuake accepts none" in found.stderr and "pelicun accepts none" in found.stderr
    assert not (tmp_path / "new").exists()


def damage_states(place, name, at):
    """The share of samples that pelicun puts in each damage state of a component, for a PGA."""
    from pandas import DataFrame
    from pelicun import assessment, file_io

    run = assessment.Assessment({"PrintLog": False, "Seed": 1})
    run.demand.load_sample(DataFrame({"PGA-0-1": ["g", *[at] * SAMPLES]}, index=["Units", *range(SAMPLES)]))
    run.stories = 0
    there = {"Units": "ea", "Location": "0", "Direction": "1", "Theta_0": 1.0, "Blocks": 1}
    run.asset.load_cmp_model({"marginals": DataFrame(there, index=[name])})
    run.asset.generate_cmp_sample(SAMPLES)
    read = file_io.load_data(str(place), reindex=False, unit_conversion_factors=run.unit_conversion_factors)
    run.damage.load_model_parameters([read], {name})
    run.damage.calculate()
    (shares,) = run.damage.ds_model.probabilities().to_dict("records")
    return shares


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("at", [0.25, 0.5, 0.8])
def test_pelicun_draws_the_damage_states_of_the_curves(tmp_path, at):
    pytest.importorskip("pelicun.assessment", reason="pelicun is not installed")
    crossing = [curve("crossing", 0.5, 0.5, 0.2), curve("crossing", "overturning", 0.7, 0.9)]
    rows, _ = components([*some("wall-1"), replace_name(some()[0], "wall_1"), *crossing])
    write_table(tmp_path / "fragility.csv", [table(rows)])
    cases = {"wall_1": [some()[k] for k in ORDER], "wall_1.2": some()[:1], "crossing": crossing}
    for name, curves in cases.items():
        p = [norm.cdf(np.log(at / each.median.value) / each.dispersion.value) for each in curves]
        exceeding = np.maximum.accumulate(p[::-1])[::-1]  # the more severe one is used where curves cross
        shares = -np.diff([1, *exceeding, 0])
        found = damage_states(tmp_path / "fragility.csv", name, at)
        for k, share in enumerate(shares):
            error = 5 * np.sqrt(share * (1 - share) / SAMPLES) + 1e-9
            assert found.get(k, 0) == pytest.approx(share, abs=error), (name, k)
