"""Formats that hold velocities, displacements or counts, and files that seismological libraries and sheets hold."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import DoubtWarning
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import read_measured
from rocking_cli.excitation.records.seismo import form_of
from tests.excitation.test_record_formats import VALUES, columns, cosmos, csmip, esm, geonet, problem, smc
from tests.questions.verify.test_grid import workbook


def peer(series: str) -> str:
    return (
        f"PEER NGA STRONG MOTION DATABASE RECORD\nMade Up, 1/17/1994, Somewhere, 228\n{series}\n"
        f"NPTS= {len(VALUES)}, DT= .0100 SEC\n" + columns(VALUES, "15.7E", 5)
    )


# --- velocities and displacements -----------------------------------------------------------------------------------

HELD = {
    "peer": (peer("VELOCITY TIME SERIES IN UNITS OF CM/S"), "velocity", 0.01),
    "esm_displacement": (esm(kind="DISPLACEMENT", unit="cm"), "displacement", 0.01),
    "csmip": (csmip(kinds=("VELOC",), names=("UP",)), "velocity", 0.01),
    "cosmos": (cosmos(kind="velocity", unit="cm/sec(05)"), "velocity", 0.01),
    "smc_displacement": (smc(first="4 DISPLACEMENT"), "displacement", 0.01),
    "text": ("t,v [ft/s]\n" + "".join(f"{0.01 * k:.2f},{each}\n" for k, each in enumerate(VALUES)), "velocity", 0.3048),
}


@pytest.mark.parametrize("name", HELD)
def test_a_file_of_another_quantity_says_the_way_in_which_it_is_then_read(name, write):
    content, quantity, size = HELD[name]
    path = write(content)
    found = problem(path)
    assert f"`quantity` {quantity}" in found.hint or "by `quantity`" in found.hint
    measured, of = read_measured(path, quantity=quantity)
    assert of == quantity
    np.testing.assert_allclose(measured.acceleration, size * VALUES, rtol=1e-7)
    if quantity == "velocity":
        inner = size * (VALUES[2:] - VALUES[:-2]) / 0.02
        np.testing.assert_allclose(read_record(path, quantity=quantity).acceleration[1:-1], inner, rtol=1e-6)
    other = "displacement" if quantity == "velocity" else "velocity"
    assert "`quantity`" in problem(path, quantity=other).hint


@pytest.mark.parametrize(
    ("content", "size"), [(csmip(), 0.01), (geonet(names=("S16W", "Up")), 0.001), (geonet(names=("Up",)), 0.001)]
)
def test_velocities_beside_the_accelerations(content, size, write):
    path = write(content)
    if content.count("UP") + content.count("S16W"):
        listed = problem(path, quantity="velocity").hint
        assert re.search(r"1: \S.*, 11 points, peak \S+ m/s\n", listed) and "PGA" not in listed
    measured, _ = read_measured(path, channel="1", quantity="velocity")
    np.testing.assert_allclose(measured.acceleration, VALUES * size, rtol=1e-12)
    stated = [doubt.kind for doubt in measured.remarks]  # the made header of GeoNet states a peak of 1.65 mm/s
    assert stated == ([] if "CORRECTED" in content else ["header_peak"])
    assert "`units` says m/s" in problem(path, channel="1", quantity="velocity", units="m/s").message


@pytest.mark.parametrize(
    "content",
    [
        peer("ACCELERATION TIME SERIES IN UNITS OF G"),
        esm(kind=""),
        cosmos().replace("acceleration pts", "velocity pts"),
    ],
)
def test_accelerations_are_not_read_as_velocities(content, write):
    found = problem(write(content), quantity="velocity", units="cm/s")
    assert "a unit of accelerations" in found.message and found.hint == "is it `quantity` acceleration?"


def test_a_velocity_has_no_unit_of_acceleration(write):
    path = write(esm(kind="VELOCITY", unit="cm/s"))
    assert "is not a unit of velocity" in problem(path, quantity="velocity", units="gal").message
    assert read_measured(path, quantity="velocity", units="cm/sec")[0].source_unit == "cm/sec"


def test_smc_of_unknown_kind_is_read_as_what_the_user_says(write):
    path = write(smc(first="0 UNKNOWN"))
    assert "`units`" in problem(path).hint
    np.testing.assert_allclose(read_record(path, units="cm/s2").acceleration, VALUES / 100)
    measured, _ = read_measured(path, units="cm/s", quantity="velocity")
    np.testing.assert_allclose(measured.acceleration, VALUES / 100)


def test_counts_of_cosmos_have_a_gain(write):
    counts = cosmos(100 * VALUES, kind="raw accel.", unit="counts(50)")
    path = write(counts)
    assert "`gain`" in problem(path).hint
    motion = read_record(path, gain="2e-4 m/s2/count")
    np.testing.assert_allclose(motion.acceleration, VALUES * 0.02, rtol=1e-12)
    assert "already" in problem(write(cosmos()), gain="2e-4 m/s2/count").message


# --- padding --------------------------------------------------------------------------------------------------------


def test_nul_bytes_pad_any_text(write):
    table = "t,acc [m/s²]\n0,1\n0.5,2\n1.0,3\n"
    plain = read_record(write(table)).acceleration.tolist()
    for spoilt in (
        table.encode("latin-1") + b"\0" * 40,
        b"\0\0\n" + table.encode(),
        table.encode("latin-1").replace(b"2\n", b"2\0\0\n"),
        table.encode() + b"\0\0\n\0\n",
    ):
        assert read_record(write(spoilt)).acceleration.tolist() == plain


# --- spreadsheets ---------------------------------------------------------------------------------------------------

ROWS = [["a note"], ["t [s]", "acc x (m/s2)", "acc y (m/s2)"], *([0.25 * k, 1.5 * k, -float(k)] for k in range(4))]


def test_a_sheet_is_a_table(tmp_path):
    pytest.importorskip("python_calamine", reason="calamine is not installed (the extra rocking-cli[spreadsheet])")
    path = workbook(tmp_path / "record.xlsx", {"notes": [], "data": ROWS})
    motion = read_record(path, channel="acc y")
    assert (motion.name, motion.dt, motion.source_unit) == ("record.xlsx channel acc y (m/s2)", 0.25, "m/s2")
    assert motion.acceleration.tolist() == [0.0, -1.0, -2.0, -3.0]
    path = workbook(tmp_path / "record.xlsx", {"notes": [["no numbers"]], "data": ROWS})
    found = problem(path)
    assert "the spreadsheet holds 2 sheets" in found.message and "\n    2: data" in found.hint
    motion = read_record(path, channel="data:2")
    assert motion.name == "record.xlsx channel data:acc y (m/s2)" and motion.acceleration[3] == -3.0
    assert "there is no sheet 'other'" in problem(path, channel="other").message
    assert problem(workbook(tmp_path / "empty.xlsx", {"x": []})).message == "the spreadsheet is empty"


def test_a_spreadsheet_that_is_damaged_is_refused(tmp_path):
    pytest.importorskip("python_calamine", reason="calamine is not installed (the extra rocking-cli[spreadsheet])")
    path = tmp_path / "record.xls"
    path.write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600))
    assert "spreadsheet cannot be read" in problem(path).message


def test_without_calamine_it_is_said_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "python_calamine", None)
    found = problem(workbook(tmp_path / "record.xlsx", {"data": ROWS}))
    assert "rocking-cli[spreadsheet]" in found.hint and "as CSV" in found.hint


# --- what obspy reads -----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def obspy():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its own deprecations
        return pytest.importorskip("obspy", reason="obspy is not installed (the extra rocking-cli[seismo])")


@pytest.mark.parametrize(("form", "title"), [("SLIST", "SLIST"), ("GSE2", "GSE2"), ("AH", "AH")])
def test_a_format_of_obspy_needs_a_unit_or_a_gain(form, title, obspy, tmp_path):
    path = tmp_path / "record.dat"
    counts = np.array([0, 50, -25, 75, -100, 12] * 40, dtype="i4" if form == "GSE2" else "f4")
    trace = obspy.Trace(counts, {"delta": 0.005, "network": "XX", "station": "STA", "channel": "HNE"})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        obspy.Stream([trace]).write(str(path), format=form)
    assert "does not say what unit" in problem(path).message
    motion = read_record(path, units="cm/s2")
    np.testing.assert_allclose(motion.acceleration, counts / 100, rtol=1e-6)
    assert (motion.dt, motion.format) == (pytest.approx(0.005), title)
    assert read_record(path, gain="1e-3 m/s2/count").pga_g == pytest.approx(0.1 / G)
    if form == "SLIST":  # its header may state the unit
        text = path.read_text().split("\n", 1)
        path.write_text(text[0] + "M/S**2\n" + text[1])
        assert read_record(path).pga_g == pytest.approx(100 / G)
        assert "but `units` says g" in problem(path, units="g").message
        path.write_text(text[0] + "Counts\n" + text[1])
        assert "`gain`" in problem(path).hint
        assert read_record(path, gain="1e-3 m/s2/count").pga_g == pytest.approx(0.1 / G)


@pytest.mark.parametrize(
    ("folder", "file", "form"),
    [
        ("kinemetrics", "BI008_MEMA-04823.evt", "Kinemetrics EVT"),
        ("reftek", "065520000_013EE8A0.rt130", "REFTEK 130"),
        ("win", "1070533011_1701260003.win", "WIN"),
    ],
)
def test_files_that_come_with_obspy_are_the_same_as_read_by_it(folder, file, form, obspy):
    path = Path(obspy.__file__).parent / "io" / folder / "tests" / "data" / file
    if not path.is_file():
        pytest.skip("this obspy comes without the files of its tests")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = obspy.read(str(path))[0]
    assert "does not say what unit" in problem(path).message
    motion = read_record(path, gain="1e-6 m/s2/count", channel="1")
    np.testing.assert_allclose(motion.acceleration, 1e-6 * theirs.data.astype(float), rtol=1e-12)
    assert motion.format == form and motion.dt == pytest.approx(theirs.stats.delta)


@pytest.mark.parametrize(
    "data",
    [b"", bytes(5000), b"\x7fELF" + bytes(3000), np.arange(2000.0).tobytes(), b"%PDF-1.7\n" + bytes(range(256)) * 9],
)
def test_other_binary_files_are_not_taken_for_one_of_obspy(data, obspy):
    assert form_of(data) is None


def test_a_pickle_is_never_opened(obspy, tmp_path):
    """It would run what is in it."""
    import pickle

    class Run:
        def __reduce__(self):
            return Path.touch, (tmp_path / "run",)

    path = tmp_path / "record.dat"
    path.write_bytes(pickle.dumps(Run()))
    assert "binary file" in problem(path, units="g").message
    assert not (tmp_path / "run").exists()


# --- arrays ---------------------------------------------------------------------------------------------------------


def test_samples_need_their_unit():
    with pytest.raises(Exception, match="`unit` is missing: samples in an array need their unit"):
        GroundMotion("x", 0.01, [0.0, 1.0])
    for unit in ("gal", "Gal", "GAL", "gals"):
        assert GroundMotion("x", 0.01, [0.0, 1.0], unit=unit).acceleration[1] == 0.01
    with pytest.raises(Exception, match=r'samples are a ground motion by GroundMotion\("mine"'):
        read_record(np.zeros(5))


def test_a_warning_points_to_the_line_of_the_user():
    import rocking_cli as rk

    with pytest.warns(DoubtWarning) as caught:
        rk.respond(rk.Block(name="b", width=0.6, height=2.6), 0.3 + 0.1 * np.sin(np.arange(200)), dt=0.01, units="g")
    assert {warning.filename for warning in caught} == {__file__}
