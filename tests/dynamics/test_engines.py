"""What is requested of a history of one structure, and what is refused."""

import re

import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import follow
from tests.following import respond

BLOCK = Structure(rk.Block(width=0.7, height=2.8))
LEANING = Structure(rk.Block(width=0.7, height=2.8, one_sided="positive", rebound=0.5))
PULSE = rk.parse_pulse("sine:0.4g:1s").sampled()


@pytest.mark.parametrize(
    ("structure", "asked", "said"),
    [
        (BLOCK, {"motion": "sine:0.3g:0.8s"}, "motion must be a GroundMotion, got str"),
        (BLOCK, {}, "nothing to respond to: give a ground motion, a release, or both"),
        *((BLOCK, {"release": each}, "release must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got")
          for each in (0.0, 1.0, -1.0, 1.5, float("nan"))),
        (LEANING, {"release": -0.5}, "release is against the supports"),
        *((BLOCK, {"motion": PULSE, "tail": each}, f"tail must be a time in seconds, 0 or more, got {each:g}")
          for each in (-1.0, float("nan"), float("inf"))),
    ],
)  # fmt: skip
def test_a_wrong_request_is_refused(structure, asked, said):
    with pytest.raises(InputError, match=f"^{re.escape(said)}"):
        follow(structure, **asked)


def test_models_are_known_and_not_none():
    for models in ((), ("nonlinear", "linear3")):
        with pytest.raises(InputError, match=r"models must be of nonlinear, linear1, linear2, got (none|linear3)"):
            respond(BLOCK.mechanism, PULSE, models=models)
