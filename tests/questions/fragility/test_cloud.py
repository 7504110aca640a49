"""Runs of a study as the input of a cloud analysis, and what oq-vmtk makes of it."""

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.errors import DoubtWarning, InputError
from tests.questions.fragility.test_study_in_python import block

SHAPES = "sine", "ricker", "ricker_antisymmetric", "cosine"
PULSES = [f"{shape}:{a}g:{t}s" for shape in SHAPES for a in (0.1, 0.3, 0.5, 0.8) for t in (0.2, 0.35, 0.6, 0.9)]


@pytest.fixture(scope="module")
def answer():
    structures, limits = [block(), block("wide", 0.9)], ["uplift", 0.5, "25 mm", 0.1]
    return rk.fragility(structures, PULSES, method="cloud", limit_states=limits, measures=["PGV"])


def test_a_cloud_has_intensities_peaks_thresholds_and_limits(answer):
    imls, edps, thresholds, lower, censored = answer.to_cloud("Pgv", structure="wide", censored=2)
    runs = answer.runs()
    runs = runs[runs.structure == "wide"]
    np.testing.assert_array_equal(imls, runs.PGV)
    np.testing.assert_array_equal(edps, runs.peak_ratio.replace(np.inf, 2.0))
    assert {"does not uplift", "rocks", "overturns"} == set(runs.outcome)
    assert (edps[runs.uplift_time.isna()] == 0).all() and (edps[runs.fell_to != 0] == 2).all()
    assert (thresholds.tolist(), lower, censored) == ([0.1, 0.5, 1.0], pytest.approx(0.01), 2)


@pytest.mark.parametrize(
    ("field", "given"), [("structure", None), ("measure", "PGD"), ("edp", "drift"), ("censored", 1.0)]
)
def test_what_does_not_suit_a_study_is_refused(answer, field, given):
    with pytest.raises(InputError, match=rf"`{field}` does not suit this study: {given!r}\n  give "):
        answer.to_cloud(**({"structure": "pillar"} | {field: given}))


def test_runs_that_are_not_known_are_left_out_and_counted(answer, monkeypatch):
    (columns,) = answer.run_blocks()
    first = columns["structure"].index("pillar")
    columns["outcome"][first : first + 3], columns["PGA [g]"][first + 3] = ["failed", "unknown", "unknown"], 0.0
    monkeypatch.setattr(type(answer), "run_blocks", lambda self: [columns])
    with pytest.warns(DoubtWarning, match="4 of 64 runs are left out: 2 of unknown outcome, 1 failed, the others"):
        imls, edps, *_ = answer.to_cloud(structure="pillar")
    assert imls.size == edps.size == 60 and np.isfinite(edps).all()


@pytest.mark.filterwarnings("ignore")
def test_oq_vmtk_takes_it_and_finds_the_curve_of_the_runs(answer):
    processor = pytest.importorskip("openquake.vmtk.postprocessor", reason="oq-vmtk is not installed").postprocessor()
    given = answer.to_cloud("PGV", structure="pillar")
    regression = processor.do_cloud_analysis(*given, sigma_build2build=0.0)["fragility"]
    assert (np.diff(regression["medians"]) > 0).all() and len(regression["medians"]) == 3
    probit = processor.do_cloud_analysis(*given, sigma_build2build=0.0, fragility_method="probit")["fragility"]
    ours = [answer.curves["pillar", limit, "PGV"].median.value for limit in (0.1, 0.5)]
    assert probit["medians"][:2] == pytest.approx(ours, rel=0.02)
