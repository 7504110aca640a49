"""Two components turned all around: what is said of directions that overturn, and of those that are unknown."""

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, UNCHECKED_FIELDS, Outcome
from rocking_cli.questions.respond.azimuths import AzimuthResponses, columns, view
from rocking_cli.structure import Structure
from rocking_cli.views.view import Table

PEAKS = [0.2, 0.6, 0.9, np.nan, 0.4, 0.1]
FELL = [0, 0, 0, 1, 0, 0]
KNOWN_TO = [np.nan, np.nan, 3.0, np.nan, 2.0, np.nan]


def around(**fields):
    """Six directions, one of which overturns and two of which end before their peak is known."""
    unknown = np.isfinite(KNOWN_TO)
    usual = dict.fromkeys(OUTCOME_FIELDS, 0.0) | UNCHECKED_FIELDS | {"still_rocking": False, "failed": False}
    usual |= {"peak_ratio": PEAKS, "fell_to": FELL, "known_to": KNOWN_TO, "unknown": unknown, "lower_bound": 0.05}
    outcomes = Outcome(**{name: np.array(np.broadcast_to(value, 6)) for name, value in usual.items()})
    azimuths = np.arange(0.0, 360.0, 60.0)
    return AzimuthResponses(("x", "y"), 1.0, azimuths, np.ones(6), {"nonlinear": outcomes}, **fields)


def test_the_largest_peak_is_that_of_what_is_known_to_stand():
    shown = view(Structure(rk.Block(width=0.7, height=2.8)), around())
    (table,) = (part for part in shown.parts if isinstance(part, Table) and len(part.rows) == 1)
    assert "0.6" in str(table.rows) and "60" in str(table.rows) and "0.9" not in str(table.rows)
    said = " ".join(part for part in shown.parts if isinstance(part, str))
    assert "overturns in 1 of 6 directions, at 180 degrees" in said
    assert "unknown in 2 of 6 directions, at 120, 240 degrees" in said


@pytest.mark.parametrize("checked", [True, False])
def test_data_are_null_where_nothing_is_known(checked):
    data = view(Structure(rk.Block(width=0.7, height=2.8)), around(checked=checked)).data["responses"]["nonlinear"]
    assert data["overturned"] == [False, False, None, True, None, False]
    assert data["peak_ratio"] == [0.2, 0.6, 0.9, None, 0.4, 0.1]
    assert data["unknown"] == (np.isfinite(KNOWN_TO).tolist() if checked else None)
    np.testing.assert_array_equal(data["known_to"], KNOWN_TO)
    np.testing.assert_array_equal(data["peak_lower_bound"], np.where(np.isfinite(KNOWN_TO), 0.05, np.nan))
    table = columns(around())
    np.testing.assert_array_equal(table["overturned"], [0.0, 0.0, np.nan, 1.0, np.nan, 0.0])
