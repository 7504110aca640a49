"""Assemblies as free blocks: against two other engines of free blocks, and against one degree of freedom."""

import json

import numpy as np
import pytest

from rocking_cli import GroundMotion, Registry
from rocking_cli.dynamics.batch import Runs
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import engine_of
from tests.conftest import NEEDS_MUJOCO, SHARED
from tests.free_blocks import CHAOTIC, Pair, agreement, case, forty, side_by_side

pytestmark = NEEDS_MUJOCO
SAME_EVERYWHERE = 2100.0, 0.732  # what the generator gives the one below
BLOCKS = SHARED / "blocks" / "assemblies.json"


@pytest.mark.rest
@pytest.mark.skipif(not BLOCKS.is_file(), reason=f"no assemblies in {BLOCKS}")
def test_seventy_assemblies_as_two_other_engines_of_free_blocks_have_them():
    given = json.loads(BLOCKS.read_text(encoding="utf-8"))
    structures, motions = [], []
    for name, one in given.items():
        fields = {key: value for key, value in one["structure"].items() if key != "mechanism"}
        structures.append(Structure(Registry()["assembly"](**fields)))
        motions.append(GroundMotion(name, one["record"]["dt"], 9.80665 * np.array(one["record"]["a_g"]), unit="m/s2"))
    models = [structure.model("nonlinear") for structure in structures]
    runs = Runs.of(range(len(given)), range(len(given)))
    engine = engine_of("blocks", [structure.mechanism for structure in structures])
    found = engine.outcomes(models, motions, runs, threads=2)
    assert not found.unknown.any()
    wrong, within = [], []
    for k, (name, one) in enumerate(given.items()):
        others = [one[engine] for engine in ("moreau", "mujoco")]
        fell = {other["fell"] is not None for other in others}
        if fell in ({True}, {False}) and found.fell[k] not in fell:
            wrong.append(name)
        if fell == {False}:
            peaks = [*(other["peak"] for other in others), *(one["neighbours"]["peaks"] or ())]
            peak = max(found.peak_positive[k], found.peak_negative[k])
            within.append(0.9 * min(peaks) <= peak <= 1.1 * max(peaks))
    assert len(wrong) <= 2, wrong
    assert len(within) == 58 and np.mean(within) >= 0.9


@pytest.mark.rest
def test_twenty_of_forty_assemblies_as_one_degree_of_freedom_has_them_where_it_knows():
    """The others are in the evidence of docs/free_blocks.md, which `make free-blocks` computes."""
    found = agreement(side_by_side(forty()[::2], 2))
    assert found.cases == 20 and found.failed == 0
    assert found.known >= 10 and found.stand >= 2 and found.collapse >= 2
    assert found.outcomes == found.sure >= 10
    assert found.near >= 0.9 * found.peaks and found.peaks >= 10


def test_one_of_the_forty_by_both_engines():
    one = case("stack", 2)
    assert (one.structure.mechanism.density, one.structure.mechanism.friction) == SAME_EVERYWHERE
    pair = side_by_side([one], 1)[0]
    assert pair.stands and pair.agree and not pair.chaotic


def test_what_counts_as_agreement():
    alike = Pair("a", False, False, 0.0, 1.0, 1.04, (0.9, 1.1))
    chance = alike._replace(share=0.5, free=True)
    among, off = alike._replace(free_peak=1.08), alike._replace(free_peak=1.2)
    wrong, fails = alike._replace(free=True), alike._replace(exact=None, free=None)
    assert [pair.chaotic for pair in (alike, chance)] == [False, True]
    assert not any(alike._replace(share=share).chaotic for share in CHAOTIC)
    assert [(pair.close, pair.agree) for pair in (alike, among, off)] == [(True, True), (False, True), (False, False)]
    assert agreement([alike, chance, among, off, wrong, fails]) == (6, 5, 4, 3, 3, 2, 1, 0, 0, 1)
