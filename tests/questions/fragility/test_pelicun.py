"""Curves for pelicun: the table of its damage models, and what pelicun makes of it."""

import numpy as np
import pytest
from scipy.stats import norm

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io.tables import write_table
from rocking_cli.questions.fragility.pelicun import components, demand
from tests.conftest import EXAMPLES, rows_of
from tests.questions.fragility.test_nrml import curve, replace_name, some, store  # noqa: F401, a fixture
from tests.stores import command

SAMPLES = 20_000  # of damage states


def test_a_row_has_the_curves_of_a_structure_in_order_of_severity():
    row = dict(zip(found := components(some()).columns, (value for (value,) in found.values()), strict=True))
    heads = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    kinds = ["Family", "Theta_0", "Theta_1", "DamageStateWeights"]
    assert list(row) == [*heads, *(f"LS{k}-{kind}" for k in range(1, 6) for kind in kinds)]
    assert [row[head] for head in heads] == ["pedestal", 0, "Peak Ground Acceleration", "g", 0, 1]
    ordered = [some()[k].curve for k in (0, 3, 4, 2, 1)]
    assert [row[f"LS{k}-Theta_0"] for k in range(1, 6)] == [each.median.value for each in ordered]
    assert [row[f"LS{k}-Theta_1"] for k in range(1, 6)] == [each.dispersion.value for each in ordered]


def test_measures_have_the_demand_types_of_pelicun_or_are_left_out():
    assert demand("PGV") == ("Peak Ground Velocity", "mps") and demand("Sa(1 s)") == ("Spectral Acceleration|1.0", "g")
    assert demand("PGD") is None and demand("Sa(1 s, 10 %)") is None  # a permanent deformation there
    sliding, step = curve("pedestal", "sliding", 0.5, 0.3), curve("other", 0.9, 0.82, 0, kind="step")
    found = components([*some(), *some(measure="PGD"), sliding, step])
    assert found.columns["ID"] == ["pedestal"] and found.states == [
        "pedestal: LS1 uplift, LS2 0.1, LS3 25 mm, LS4 0.5, LS5 overturning"
    ]
    over_pgd, of_sliding, of_step = found.left_out
    assert over_pgd.startswith("all curves over PGD: ") and "pelicun orders limit states" in of_sliding
    assert "its curve is a step one, and the table for pelicun has only lognormal curves" in of_step
    with pytest.raises(InputError, match="pelicun accepts none of the curves: all curves over PGD"):
        components(some(measure="PGD"))


def test_names_are_without_the_sign_at_which_pelicun_splits_them():
    found = components([*some("wall-1"), *some("wall_1")[:1], *some("wall-1", measure="PGV")])
    assert found.columns["ID"] == ["wall_1_PGA", "wall_1_PGA.2", "wall_1_PGV"]
    assert found.columns["LS2-Family"] == ["lognormal", "", "lognormal"]


def test_more_limit_states_than_pelicun_sorts_are_refused():
    many = [curve("a", k / 10, 0.4 + k / 50, 0.3) for k in range(1, 11)]
    with pytest.raises(InputError, match="a over PGA: pelicun sorts at most 9 limit states"):
        components(many)
    assert len(components(many[1:]).columns) == 6 + 4 * 9


def test_the_command_writes_the_table_and_names_the_rest(store, tmp_path):  # noqa: F811
    found = command("results", store, "--pelicun", tmp_path / "new" / "folder", code=0)
    (row,) = rows_of(tmp_path / "new" / "folder" / "fragility.csv")
    curves = rk.results(store).curves
    for k, limit in enumerate((0.5, "overturning"), 1):
        assert float(row[f"LS{k}-Theta_0"]) == pytest.approx(curves[limit].median.value)
        assert float(row[f"LS{k}-Theta_1"]) == pytest.approx(curves[limit].dispersion.value)
    assert "uplift over PGA: its curve is a step" in found.stderr and "pedestal: LS1 0.5, LS2" in found.stderr


def test_without_a_curve_the_rest_is_written(tmp_path):
    study = (EXAMPLES / "study" / "pedestal.yaml").read_text(encoding="utf-8").replace("../", f"{EXAMPLES}/")
    (tmp_path / "study.yaml").write_text(study + "measures: [PGA/(g lambda)]\n", encoding="utf-8")
    command("fragility", tmp_path / "study.yaml", code=0)
    places = "--nrml", tmp_path / "f.xml", "--pelicun", tmp_path / "new", "--out", tmp_path / "runs.csv"
    found = command("results", tmp_path / "study.db", *places)
    assert found.exit_code == 5 and "OpenQuake accepts none" in found.stderr and "pelicun accepts none" in found.stderr
    assert (tmp_path / "runs.csv").exists() and not (tmp_path / "new").exists()


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
    table = file_io.load_data(str(place), reindex=False, unit_conversion_factors=run.unit_conversion_factors)
    run.damage.load_model_parameters([table], {name})
    run.damage.calculate()
    (shares,) = run.damage.ds_model.probabilities().to_dict("records")
    return shares


@pytest.mark.filterwarnings("ignore")
def test_pelicun_draws_the_damage_states_of_the_curves(tmp_path):
    pytest.importorskip("pelicun.assessment", reason="pelicun is not installed")
    crossing = [curve("crossing", 0.5, 0.5, 0.2), curve("crossing", "overturning", 0.7, 0.9)]
    columns = components([*some("wall-1"), replace_name(some()[0], "wall_1"), *crossing]).columns
    place = tmp_path / "fragility.csv"
    write_table(place, [columns])
    order = [some()[k].curve for k in (0, 3, 4, 2, 1)]
    cases = {"wall_1": order, "wall_1.2": order[:1], "crossing": [each.curve for each in crossing]}
    for name, curves in cases.items():
        for at in (0.25, 0.5, 0.8):
            p = [norm.cdf(np.log(at / each.median.value) / each.dispersion.value) for each in curves]
            exceeding = np.maximum.accumulate(p[::-1])[::-1]  # the more severe one is used where curves cross
            shares = -np.diff([1, *exceeding, 0])
            found = damage_states(place, name, at)
            for k, share in enumerate(shares):
                error = 5 * np.sqrt(share * (1 - share) / SAMPLES) + 1e-9
                assert found.get(k, 0) == pytest.approx(share, abs=error), (name, at, k)
