"""Every reader has a sample that `make soak` spoils, and what it sees in a process is told."""

import random

import pytest

from rocking_cli.excitation.records.formats import load_readers
from tests import readers


def test_every_reader_has_a_sample():
    pytest.importorskip("obspy", reason="obspy is not installed (the extra rocking-cli[seismo])")
    assert set(load_readers()) <= set(readers.samples())


def test_a_spoilt_record_is_the_same_again():
    sample = readers.samples()["esm"].content
    spoilt = [readers.spoil(sample, random.Random(seed)) for seed in (1, 1, 2)]
    assert spoilt[0] == spoilt[1] != spoilt[2]


def test_a_record_that_is_cut_is_refused(tmp_path):
    place = tmp_path / "record.dat"
    place.write_bytes(readers.samples()["peer_at2"].content[:-60])
    assert readers.examine(place)[0] == 2
