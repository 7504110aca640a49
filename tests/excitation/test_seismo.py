"""SAC and miniSEED: files made with obspy where it is installed, and what is said where it is not."""

import io
import struct
import sys
import warnings
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.excitation.records.formats import miniseed, sac
from tests.excitation.test_record_formats import claims

VALUES = np.array([0.0, 0.5, -0.25, 0.75, -1.0, 0.125] * 40, dtype=np.float32)


@pytest.fixture(scope="module")
def obspy() -> ModuleType:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its own deprecations
        return pytest.importorskip("obspy", reason="obspy is not installed (the extra rocking-cli[seismo])")


@pytest.fixture
def made(obspy, tmp_path):
    """Write traces to a file: tuples of channel code, values, and seconds after the first, if not 0."""

    def made(form: str, *traces: tuple, dt: float = 0.005, name: str = "record.dat", **options) -> Path:
        stream = obspy.Stream()
        for code, values, *start in traces:
            header = {"delta": dt, "network": "XX", "station": "STA", "channel": code}
            stream.append(obspy.Trace(np.asarray(values), header))
            stream[-1].stats.starttime += start[0] if start else 0
        buffer = io.BytesIO()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stream.write(buffer, format=form, **options)
        path = tmp_path / name
        path.write_bytes(buffer.getvalue())
        return path

    return made


def problem(path: Path, **options) -> Problem:
    with pytest.raises(InputError) as caught:
        read_record(path, **({"units": "g"} | options))
    (found,) = caught.value.problems
    assert found.file == str(path)
    return found


def patch(path: Path, offset: int, word: bytes) -> Path:
    """Overwrite a word of a file."""
    data = path.read_bytes()
    path.write_bytes(data[:offset] + word + data[offset + len(word) :])
    return path


def integer(value: int) -> bytes:
    return struct.pack("<i", value)


VERSION, NPTS, KIND, QUANTITY, EVEN = (4 * word for word in (76, 79, 85, 86, 105))  # of a SAC header


# --- what is read ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("byteorder", "dt"), [("<", 0.005), (">", 1 / 256)])
def test_sac(made, byteorder, dt):
    path = made("SAC", ("HNE", VALUES), dt=dt, byteorder=byteorder)
    motion = read_record(path, units="g")
    np.testing.assert_array_equal(motion.acceleration, VALUES.astype(float) * G)
    assert (motion.name, motion.dt, motion.source_unit, motion.format) == ("record.dat", dt, "g", "SAC")


def test_sac_of_version_7_has_a_footer(made):
    path = patch(made("SAC", ("HNE", VALUES)), VERSION, integer(7))
    assert "do not make" in problem(path).message
    path.write_bytes(path.read_bytes() + bytes(22 * 8))
    assert read_record(path, units="g").npts == VALUES.size


@pytest.mark.parametrize(("byteorder", "encoding"), [("<", "FLOAT32"), (">", "FLOAT64"), (">", "STEIM2")])
def test_miniseed(made, byteorder, encoding):
    values = VALUES.astype({"FLOAT32": "f4", "FLOAT64": "f8"}.get(encoding, "i4"))
    motion = read_record(made("MSEED", ("HNE", values), encoding=encoding, byteorder=byteorder), units="cm/s2")
    np.testing.assert_allclose(motion.acceleration, values.astype(float) * 0.01, rtol=1e-15)
    assert (motion.dt, motion.source_unit, motion.format) == (0.005, "cm/s2", "miniSEED")


def test_channels(made):
    path = made("MSEED", ("HNE", VALUES), ("HNN", 2 * VALUES), ("HHZ", VALUES))
    hint = problem(path).hint
    assert f"1: HNE, {VALUES.size} points, PGA 1 g\n    2: HNN, {VALUES.size} points, PGA 2 g\n    3: HHZ" in hint
    assert hint.endswith("not of an accelerometer")  # the third is listed with what is wrong with it
    for channel in ("2", "hnn"):
        motion = read_record(path, units="g", channel=channel)
        assert (motion.name, motion.pga_g) == ("record.dat channel HNN", pytest.approx(2))
    assert "no channel 'Z'" in problem(path, channel="Z").message
    assert "records velocity" in problem(path, channel="HHZ").message


def test_channels_of_one_code_are_told_apart_by_their_stations(made):
    path = made("MSEED", ("HNE", VALUES), ("HNE", VALUES, 0.0))
    path.write_bytes(path.read_bytes().replace(b"STA  ", b"STB  ", 1))
    assert "1: XX.STB..HNE, " in problem(path).hint
    assert read_record(path, units="g", channel="xx.sta..hne").npts == VALUES.size


def test_segments_that_follow_on_each_other_are_one_channel(made):
    path = made("MSEED", ("HNE", VALUES, VALUES.size * 0.005), ("HNE", 2 * VALUES))
    expected = np.r_[2 * VALUES, VALUES].astype(float) * G
    np.testing.assert_array_equal(read_record(path, units="g").acceleration, expected)


# --- units and quantities -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", ["SAC", "MSEED"])
def test_the_unit_must_be_given(made, form):
    path = made(form, ("HNE", VALUES))
    found = problem(path, units=None)
    assert "does not say what unit" in found.message and "`units`" in found.hint
    with pytest.raises(InputError, match="'V' is not a known unit"):
        read_record(path, units="V")


@pytest.mark.parametrize("form", ["SAC", "MSEED"])
def test_the_interval_and_the_channel_may_not_be_contradicted(made, form):
    path = made(form, ("HNE", VALUES))
    assert read_record(path, units="g", dt=0.005, channel="HNE").dt == 0.005
    assert "`dt` says 0.01 s" in problem(path, dt=0.01).message
    with pytest.raises(InputError, match="no channel 'HNZ'"):
        read_record(path, units="g", channel="HNZ")


@pytest.mark.parametrize(("form", "code"), [("SAC", "HHE"), ("MSEED", "BLZ"), ("MSEED", "EPN")])
def test_seismometers_record_velocity(made, form, code):
    found = problem(made(form, (code, VALUES)))
    assert f"channel {code} is of a seismometer" in found.message and "HNE" in found.hint


@pytest.mark.parametrize(("form", "code"), [("SAC", "BGZ"), ("SAC", ""), ("MSEED", "L"), ("MSEED", "90")])
def test_other_codes_say_nothing_against_an_acceleration(made, form, code):
    assert read_record(made(form, (code, VALUES)), units="g").npts == VALUES.size


@pytest.mark.parametrize(("quantity", "word"), [(6, "displacement"), (7, "velocity"), (50, "voltage")])
def test_sac_may_say_that_it_is_no_acceleration(made, quantity, word):
    found = problem(patch(made("SAC", ("HNE", VALUES)), QUANTITY, integer(quantity)))
    assert f"are a {word}, not an acceleration (IDEP)" in found.message


def test_sac_that_says_it_is_an_acceleration_outweighs_the_code(made):
    assert read_record(patch(made("SAC", ("HHE", VALUES)), QUANTITY, integer(8)), units="g").npts == VALUES.size


def test_counts_are_no_accelerations(made):
    path = made("MSEED", ("HNE", (VALUES * 100_000).astype("i4")))
    found = problem(path, units="gal")
    assert "a peak of 102 g" in found.message and "remove_response" in found.hint
    assert read_record(made("MSEED", ("HNE", VALUES * 100_000)), units="gal").pga_g > 100  # not whole numbers: as given


# --- what is wrong with a file --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("shift", "what"), [(1.0, "a gap of 1 s"), (-0.5, "an overlap of 0.5 s")])
def test_a_channel_with_a_break_is_refused_where_it_is(made, shift, what):
    path = made("MSEED", ("HNE", VALUES), ("HNE", VALUES, VALUES.size * 0.005 + shift), ("HNN", VALUES))
    message = f"channel HNE has {what} after sample 240, at 1970-01-01T00:00:01.195"
    assert message in problem(path, channel="HNE").message
    assert message in problem(path).hint
    assert read_record(path, units="g", channel="HNN").npts == 240


def test_a_channel_that_changes_its_rate_is_refused(made, tmp_path):
    one, two = (
        made("MSEED", ("HNE", VALUES, start), dt=dt, name=f"{dt}").read_bytes()
        for start, dt in ((0, 0.005), (1.2, 0.01))
    )
    path = tmp_path / "both"
    path.write_bytes(one + two)
    assert "goes from 0.005 s to 0.01 s between samples after sample 240" in problem(path).message


@pytest.mark.parametrize(("form", "bad"), [("SAC", np.nan), ("MSEED", np.inf), ("SAC", 1e35)])
def test_a_sample_that_is_no_number_is_pointed_at(made, form, bad):
    values = VALUES.copy()
    values[123] = bad
    said = problem(made(form, ("HNE", values))).message
    assert f"sample 124 of channel HNE is not a finite number of sensible size: {bad:g}" in said


@pytest.mark.parametrize("cut", [10, 300, 512, 4000])
@pytest.mark.parametrize("form", ["SAC", "MSEED"])
def test_a_file_cut_short_is_refused(made, form, cut):
    path = made(form, ("HNE", np.tile(VALUES, 20)), **({"reclen": 4096} if form == "MSEED" else {}))
    path.write_bytes(path.read_bytes()[:-cut])
    assert "cut short" in problem(path).hint or "damaged" in problem(path).hint


def test_rubbish_between_records_is_refused(made):
    path = made("MSEED", ("HNE", np.tile(VALUES, 20)), reclen=512)
    data = path.read_bytes()
    path.write_bytes(data[:512] + b"rubbish!" * 64 + data[512:])
    said = problem(path).message
    assert "obspy has doubts about this file: " in said and "\n" not in said


def test_a_channel_of_text_is_no_record(made):
    path = made("MSEED", ("LOG", np.frombuffer(b"hello, world", "S1")), encoding="ASCII")
    assert "sample 1 of channel LOG is not a finite number" in problem(path).message


@pytest.mark.parametrize(
    ("offset", "value", "fragment"), [(EVEN, 0, "unevenly spaced (LEVEN)"), (KIND, 2, "not a time series (IFTYPE = 2)")]
)
def test_sac_that_is_no_even_time_series_is_refused(made, offset, value, fragment):
    assert fragment in problem(patch(made("SAC", ("HNE", VALUES)), offset, integer(value))).message


def test_sac_with_a_wrong_number_of_points_is_refused(made):
    assert "the header says 99 points" in problem(patch(made("SAC", ("HNE", VALUES)), NPTS, integer(99))).message


@pytest.mark.parametrize("offset", [4, 8])
def test_sac_that_says_other_extremes_is_doubted(made, offset):
    path = made("SAC", ("HNE", VALUES), byteorder="<")
    assert read_record(path, units="g").remarks == ()
    (doubt,) = read_record(patch(path, offset, struct.pack("<f", 0.76)), units="g").remarks
    assert (doubt.kind, doubt.value) == ("header_peak", 1.0) and "go from -1 to 0.75" in doubt.text
    unset = patch(path, offset, struct.pack("<f", -12345.0))
    assert read_record(unset, units="g").remarks == ()


def test_miniseed_3_is_recognised_though_not_read(tmp_path):
    path = tmp_path / "three"
    path.write_bytes(b"MS\x03\0" + bytes(4) + struct.pack("<HH", 2024, 60) + bytes(60))
    assert "miniSEED 3" in problem(path).message


# --- detection ------------------------------------------------------------------------------------------------------


def test_each_claims_its_own(made):
    assert sac.sniff(made("SAC", ("HNE", VALUES)).read_bytes())
    assert not miniseed.sniff(made("SAC", ("HNE", VALUES)).read_bytes())
    assert miniseed.sniff(made("MSEED", ("HNE", VALUES)).read_bytes())
    assert not sac.sniff(made("MSEED", ("HNE", VALUES)).read_bytes())


@pytest.mark.parametrize("offset, word", [(VERSION, integer(5)), (EVEN, integer(7)), (KIND, integer(0)), (0, bytes(4))])
def test_an_implausible_header_is_not_of_sac(made, offset, word):
    assert not sac.sniff(patch(made("SAC", ("HNE", VALUES)), offset, word).read_bytes())


@pytest.mark.parametrize("offset, word", [(0, b"x"), (6, b"V"), (7, b"x"), (20, b"\0\0"), (22, b"\xff\xff")])
def test_an_implausible_header_is_not_of_miniseed(made, offset, word):
    assert not miniseed.sniff(patch(made("MSEED", ("HNE", VALUES)), offset, word).read_bytes())


@pytest.mark.parametrize("content", [b"", b"000001D ", bytes(47), bytes(632), bytes(10_000), b"\xff" * 10_000])
def test_other_bytes_are_claimed_by_neither(content):
    assert not sac.sniff(content)
    assert not miniseed.sniff(content)


def test_numbers_with_a_letter_are_text():
    assert claims("000001D 1\n" * 100) == []


# --- without obspy --------------------------------------------------------------------------------------------------


def test_without_obspy_it_is_said_what_to_install(tmp_path, monkeypatch):
    words = [0] * 158
    words[76], words[79], words[85], words[105] = 6, 1, 1, 1
    path = tmp_path / "record.sac"
    path.write_bytes(struct.pack("<f", 0.01) + struct.pack("<157i", *words[1:]) + bytes(4))
    monkeypatch.setitem(sys.modules, "obspy", None)
    found = problem(path)
    assert "obspy" in found.message and "pip install 'rocking-cli[seismo]'" in found.hint
