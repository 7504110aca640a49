"""Histories as CSV and Parquet: a block at a time, and no line lost or changed between blocks."""

import csv
import io
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from mechanisms.block import Block
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.io import tables
from rocking_cli.io.tables import write_csv
from rocking_cli.questions.respond.history_table import blocks
from tests.following import respond

BLOCK = Block(width=0.7, height=2.8)
PULSE = GroundMotion("pulse", 0.01, -0.35 * STANDARD_GRAVITY * np.sin(np.linspace(0, 2 * np.pi, 81)), unit="m/s2")


class Sink(io.RawIOBase):
    """Counts what is written, and keeps nothing."""

    size = 0

    def writable(self):
        return True

    def write(self, data):
        self.size += len(data)
        return len(data)


def rows(histories, motion, **options):
    stream = io.BytesIO()
    write_csv(stream, blocks(histories, motion, **options))
    return list(csv.reader(io.StringIO(stream.getvalue().decode())))


def test_the_columns_are_time_ground_and_three_of_each_model():
    histories = respond(BLOCK, PULSE, models=("nonlinear", "linear2"))
    header, *lines = rows(histories, PULSE)
    assert header == [
        "t [s]", "a_g [g]", "nonlinear phi [rad]", "nonlinear phi_dot [rad/s]", "nonlinear phi_ratio",
        "linear2 phi [rad]", "linear2 phi_dot [rad/s]", "linear2 phi_ratio",
    ]  # fmt: skip
    table = np.array(lines, dtype=float).T
    run = histories["nonlinear"]
    size = run.time.size
    for column, want in zip(table[2:5], (run.phi, run.rate, run.ratio), strict=True):
        np.testing.assert_allclose(column[:size], want, rtol=1e-8)
    np.testing.assert_allclose(table[1][:81], PULSE.acceleration / STANDARD_GRAVITY, rtol=1e-8, atol=1e-12)
    assert (table[1][81:] == 0).all()


@pytest.mark.parametrize("size", [1, 7, 100, 10**9])
def test_blocks_of_any_size_give_the_same_lines(size, monkeypatch):
    histories = respond(BLOCK, PULSE.scaled(1.5))
    whole = rows(histories, PULSE)
    assert rows(histories, PULSE, rows=size) == whole
    monkeypatch.setattr(tables, "ROWS_PER_BLOCK", size)
    assert rows(histories, PULSE) == whole
    assert len(whole) == 1 + max(run.time.size for run in histories.values())


def test_after_overturning_fields_are_empty_and_after_rest_zero():
    fallen = respond(BLOCK, PULSE.scaled(5.0), models=("nonlinear",), tail=0.5)["nonlinear"]
    calm = respond(BLOCK, PULSE.scaled(0.1), models=("nonlinear",), tail=0.0)["nonlinear"]
    rocking = respond(BLOCK, PULSE, models=("nonlinear",), tail=3.0)["nonlinear"]
    assert fallen.overturned and rocking.time.size > max(fallen.time.size, calm.time.size)
    _, *lines = rows({"fallen": fallen, "calm": calm, "rocking": rocking}, PULSE)
    assert lines[-1][2:8] == ["", "", "", "0", "0", "0"]


def test_fields_are_empty_from_where_a_history_is_not_known():
    rocking = respond(BLOCK, PULSE, models=("nonlinear",), tail=3.0)["nonlinear"]
    smooth = BLOCK.model_copy(update={"friction": BLOCK.width / BLOCK.height + 1e-6})
    unknown = respond(smooth, PULSE, models=("nonlinear",), tail=0.0)["nonlinear"]
    assert unknown.unknown and rocking.time.size > unknown.time.size
    _, *lines = rows({"unknown": unknown, "rocking": rocking}, PULSE)
    assert lines[-1][2:5] == ["", "", ""] and "" not in lines[-1][5:]


@pytest.mark.rest
def test_a_long_history_never_stands_in_memory_as_text():
    one = respond(BLOCK, PULSE, models=("nonlinear",), tail=0.0)["nonlinear"]
    size = 300_000
    many = {name: np.zeros(size) for name in ("phi", "rate", "ratio")}
    long = replace(one, time=np.arange(size) * 0.01, **many)
    sink = Sink()
    tracemalloc.start()
    write_csv(sink, blocks({"nonlinear": long}, None))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert sink.size > 4_000_000 and peak < 0.75 * sink.size
    assert next(blocks({"nonlinear": long}, None, 10))["t [s]"].size == 10
