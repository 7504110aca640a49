"""The data centres' formats: real files where they are here, and small made ones with everything that can be wrong."""

import json
import re
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError, MechanismError, PluginWarning, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.records import layout
from rocking_cli.excitation.records.formats import FALLBACKS, Readers, load_readers, reader_for, takes_bytes
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.units import UNITS
from tests.conftest import FORMATS, NEEDS_RECORDS, RECORDS, record

G = STANDARD_GRAVITY
AKBMR = "us1000hyfh_akbmrp_AKBMR--n.1000hyfh.BNZ.--.acc.V2c"
VALUES = np.array([0.0, 1.5, -2.25, 3.0, -4.5, 0.75, 1.25, -0.5, 2.0, 10.0, -7.0])  # more than a line of any format


def problem(path: Path, **options) -> Problem:
    """The one thing `read_record` finds wrong."""
    with pytest.raises(InputError) as caught:
        read_record(path, **options)
    (found,) = caught.value.problems
    return found


def claims(text: str) -> list[str]:
    """Names of the readers that take a text for theirs, the last resort aside."""
    contents = {False: text, True: text.encode()}
    return [
        name
        for name, reader in load_readers().items()
        if name not in FALLBACKS and reader.sniff(contents[takes_bytes(reader)])
    ]


def columns(values, form: str, per_line: int, margin: str = "", after: str = "") -> str:
    """Fortran's fixed-width columns."""
    cells = [format(value, form) + after for value in values]
    return "".join(margin + "".join(cells[i : i + per_line]) + "\n" for i in range(0, len(cells), per_line))


# --- real files -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "channel", "form", "unit", "npts", "dt", "pga", "peak"),
    [
        # pga [cm/s2] as the header of the file itself, or its catalogue, says; peak: its sign
        ("formats/0111a.smc", None, "USGS SMC", "cm/s2", 6001, 0.005, 104.4078, 1),
        ("formats/20180212_211557_WPWS_20.V2A", "1", "GeoNet V2A", "mm/s2", 5800, 0.02, 4.16, -1),
        ("formats/20180212_211557_WPWS_20.V2A", "s74e", "GeoNet V2A", "mm/s2", 5800, 0.02, 19.40, -1),
        ("formats/20180212_211557_WPWS_20.V2A", "Up", "GeoNet V2A", "mm/s2", 5800, 0.02, 2.73, -1),
        ("formats/AOM0011801241951.EW", None, "K-NET/KiK-net", "gal", 10200, 0.01, 4.078, None),
        ("formats/NGNH311106302345.EW1", None, "K-NET/KiK-net", "gal", 12000, 0.01, 0.192, None),
        ("formats/Cosmos12TimeSeriesTest.v1", None, "COSMOS", "cm/s2", 7000, 0.01, 161.962, -1),
        ("formats/HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC", "HNE", "ESM ASCII", "cm/s2", 13876, 0.005, 0.227973, -1),
        ("formats/RSN763_LOMAP_GIL067.AT2", None, "PEER AT2", "g", 7999, 0.005, 351.6006, None),
        ("formats/ce36456p_CE36456.V2", "1", "CSMIP V2", "cm/s2", 3251, 0.02, 267.957, -1),
        ("formats/ce36456p_CE36456.V2", "up", "CSMIP V2", "cm/s2", 3250, 0.02, 94.805, -1),
        ("formats/ce36456p_CE36456.V2", "0", "CSMIP V2", "cm/s2", 3250, 0.02, 256.231, -1),
        (f"formats/{AKBMR}", "BNZ", "COSMOS", "cm/s2", 42000, 0.005, 6.851512, -1),
        ("SimCenter_Rinaldi.json", None, "SimCenter JSON", "g", 1991, 0.01, 0.874059 * 980.665, None),
    ],
)
def test_real_records(name, channel, form, unit, npts, dt, pga, peak):
    motion = read_record(record(name), channel=channel)
    assert (motion.format, motion.source_unit, motion.npts) == (form, unit, npts)
    assert motion.dt == pytest.approx(dt, rel=1e-9)
    largest = 100 * motion.acceleration[np.argmax(np.abs(motion.acceleration))]
    assert abs(largest) == pytest.approx(pga, rel=2e-4, abs=6e-4)
    assert peak is None or np.sign(largest) == peak


def test_the_real_usc_record_is_the_same_straight_lines():
    path = record("formats/017m30lw.s0a")
    motion = read_record(path)
    assert (motion.format, motion.source_unit, motion.dt, motion.npts) == ("USC V1", "g/10", 0.001, 34717)
    rows = path.read_text().split("\n")[27:]
    pairs = np.array([float(cell) for row in rows for cell in re.findall(".{7}", row[1:])]).reshape(-1, 2)
    assert len(pairs) == 8095
    at_points = motion.acceleration[np.rint(pairs[:, 0] * 1000).astype(int)]
    np.testing.assert_allclose(at_points, pairs[:, 1] * G / 10, rtol=1e-12)
    assert motion.pga_g == pytest.approx(0.2647, abs=1e-9)
    assert np.sqrt((pairs[:, 1] ** 2).mean()) == pytest.approx(0.400, abs=0.001)  # as its header says


def test_the_real_records_of_simcenter_and_peer_agree():
    ours, theirs = read_record(record("SimCenter_Rinaldi.json")), read_record(record("Rinaldi228.AT2"))
    np.testing.assert_array_equal(ours.acceleration, theirs.acceleration)


@NEEDS_RECORDS
def test_each_real_record_is_claimed_by_one_reader():
    files = [path for path in [*FORMATS.iterdir(), *RECORDS.iterdir()] if path.suffix not in ("", ".md", ".dat")]
    assert len(files) > 10
    for path in files:
        assert len(claims(path.read_text("latin-1"))) == 1, path.name


# --- made files -----------------------------------------------------------------------------------------------------


def simcenter(values=VALUES, **changes) -> str:
    data = {"info": "ACCELERATION IN UNITS OF G", "numPoints": len(values), "dT": 0.01, "accel_data": list(values)}
    return json.dumps({key: value for key, value in {**data, **changes}.items() if value is not None}, indent=1)


def esm(values=VALUES, count=None, unit="cm/s^2", kind="ACCELERATION") -> str:
    header = {"EVENT_NAME": "MADE UP", "SAMPLING_INTERVAL_S": "0.010000", "NDATA": count or len(values)}
    header |= {
        "STREAM": "HNE",
        "UNITS": unit,
        "PGA_CM/S^2": f"{np.abs(values).max():.6f}",
        "DATA_TYPE": kind,
        "USER5": "",
    }
    return "".join(f"{key}: {value}\n" for key, value in header.items()) + columns(values, ".6f", 1)


def geonet(values=VALUES, count=None, unit="mm/s/s", names=("S16W", "S74E", "Up")) -> str:
    count = count or len(values)
    out = ""
    for factor, name in enumerate(names, start=1):
        out += "Corrected accelerogram made up\nSite\n" + "x\n" * 7
        out += f"Number of points {count:5d}    Duration {0.01 * (len(values) - 1):.2f} sec\n"
        out += f"Instrument corrected data at 0.010 sec intervals\nx\nComponent {name}  Axis\n"
        peak = factor * np.abs(values).max()
        out += f"Acceleration:  peak {peak:8.2f} {unit} at  43.68 sec     rms      2.2 {unit}\n"
        out += "Velocity:      peak     1.65 mm/s   at  43.56 sec\nDisplacement:  peak    0.131 mm\n"
        out += columns([0] * 30, "8d", 10) + f"   21200     250     250{count:8d}{count:8d}       0       0\n"
        out += columns([0.0] * 60, "8.1f", 10)
        out += columns(factor * values, "8.2f", 10) + columns(values, "8.2f", 10)
    return out


def csmip(
    values=VALUES, count=None, unit="(UNITS: CM/SEC/SEC)", names=("90 DEG", "UP"), kinds=("ACCEL", "VELOC")
) -> str:
    out = ""
    for place, name in enumerate(names, start=1):
        out += f"CORRECTED ACCELEROGRAM   36456-S4384       CHAN {place:2d}: {name:8}   FROM\n"
        out += "UNCORRECTED ACCELEROGRAM DATA\nMADE UP EARTHQUAKE\n" + f"CHAN {place:2d}: {name}\n"
        out += columns([0] * 20, "5d", 16) + columns([0.0] * 20, "10.3f", 8)
        for kind in kinds:
            what = unit if kind == "ACCEL" else "(UNITS: CM/SEC)"
            out += f" {count or len(values)} POINTS OF {kind} DATA EQUALLY SPACED AT  .010 SEC.  {what}\n"
            out += columns(place * values, "10.3f", 8)
        out += f"/&  ----------  END OF DATA FOR CHANNEL {place}  ----------\n"
    return out


def smc(values=VALUES, count=None, first="2 CORRECTED ACCELEROGRAM", rate=100.0, comments=2, said=2) -> str:
    integers, reals = [-32768] * 48, [1.7e38] * 50
    integers[15], integers[16], reals[1] = said, count or len(values), rate
    cells = [f"{value:10.4E}".replace("E+0", "E+").replace("E-0", "E-").rjust(10) for value in values]
    return (
        f"{first:80}\n*\nMADE\n" + "component=    360\n" + "*\n" * 7
        + columns(integers, "10d", 8) + columns(reals, "15.7E", 5) + "| 1 comment\n" * comments
        + columns(cells, "s", 8)
    )  # fmt: skip


def cosmos(
    values=VALUES, count=None, unit="cm/sec2(04)", kind="acceleration", dt_ms=10.0, length=0, names=("340 deg",)
) -> str:
    out = ""
    for factor, name in enumerate(names, start=1):
        reals = [-999.0] * 100
        reals[33], reals[61] = 0.5, dt_ms
        out += "Corrected acceleration    (Format v01.20 with 13 text lines) Src: made up\n" + "x\n" * 7
        out += f"Sta Cha:  {factor}: {name} (Rcrdr Chan  1) Location: nowhere\n" + "x\n" * 4
        out += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" + columns([-999] * 100, "8d", 10)
        out += " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n" + columns(reals, "13.6f", 6)
        out += '  1 Comment line(s) follow, each starting with a "|":\n| 3.0 made up\n'
        out += f"   {count or len(values)}  {kind} pts, approx   {length} secs, units={unit},Format=(8F10.5)\n"
        out += columns(factor * values, "10.5f", 8) + f"/&  ------  End of data for channel  {factor}  ------\n"
    return out


def usc(values=VALUES, times=None, count=None, unit="G/10") -> str:
    times = 0.01 * np.arange(len(values)) if times is None else times
    pairs = np.column_stack([times, values]).ravel()
    head = "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:\nMADE UP EARTHQUAKE\nCOMP N90E             9\n"
    head += f"NO. OF POINTS =   {count or len(values)}      DURATION = {times[-1]:7.3f} SEC       50\n"
    head += f"UNITS ARE SEC AND {unit}                    22\n"
    return head + columns([0] * 100, "5d", 16) + columns([0.0] * 50, "10.3f", 8) + columns(pairs, "7.3f", 10, " ")


def knet(values=VALUES, duration=11, rate="1Hz", scale="2000(gal)/1000000") -> str:
    header = {"Origin Time": "2018/01/24 19:51:00", "Lat.": 41.0, "Long.": 142.5, "Depth. (km)": 30, "Mag.": 6.2}
    header |= {"Station Code": "MADE", "Station Lat.": 1, "Station Long.": 1, "Station Height(m)": 39, "Record Time": 0}
    header |= {"Sampling Freq(Hz)": rate, "Duration Time(s)": duration, "Dir.": "E-W", "Scale Factor": scale}
    header |= {"Max. Acc. (gal)": f"{np.abs(values - values.mean()).max():.3f}", "Last Correction": 0, "Memo.": ""}
    counts = np.rint(500 * values).astype(int) - 12000
    return "".join(f"{key:<18}{value}\n" for key, value in header.items()) + columns(counts, "8d", 8, after=" ")


MADE = {
    "simcenter": (simcenter, "g", G, 0.01),
    "esm": (esm, "cm/s2", 0.01, 0.01),
    "geonet_v2a": (lambda *a, **k: geonet(*a, **{"names": ("S16W",)} | k), "mm/s2", 0.001, 0.01),
    "csmip_v2": (lambda *a, **k: csmip(*a, **{"names": ("90 DEG",)} | k), "cm/s2", 0.01, 0.01),
    "smc": (smc, "cm/s2", 0.01, 0.01),
    "cosmos": (cosmos, "cm/s2", 0.01, 0.01),
    "usc_v1": (usc, "g/10", G / 10, 0.01),
    "knet": (knet, "gal", 0.01, 1.0),
}
BY_FORMAT = pytest.mark.parametrize("name", MADE)


@BY_FORMAT
def test_made_files_are_read(name, tmp_path):
    make, unit, size, dt = MADE[name]
    path = tmp_path / "record.dat"
    path.write_text(make())
    motion = read_record(path)
    expected = (VALUES - VALUES.mean() if name == "knet" else VALUES) * size
    np.testing.assert_allclose(motion.acceleration, expected, rtol=1e-12, atol=1e-9)
    assert (motion.name, motion.source_unit, motion.format) == ("record.dat", unit, load_readers()[name].TITLE)
    assert motion.dt == pytest.approx(dt, rel=1e-12)
    assert motion.remarks == ()


@BY_FORMAT
def test_the_unit_of_the_file_may_not_be_contradicted(name, write):
    path = write(MADE[name][0]())
    assert "but `units` says m/s2" in problem(path, units="m/s2").message
    assert "is not a unit of acceleration" in problem(path, units="km").message


@BY_FORMAT
def test_the_interval_of_the_file_may_not_be_contradicted(name, write):
    make, _, _, dt = MADE[name]
    path = write(make())
    assert read_record(path, dt=dt).dt == pytest.approx(dt)
    assert f"`dt` says {2 * dt:g} s" in problem(path, dt=2 * dt).message


@BY_FORMAT
@pytest.mark.parametrize("count", [10, 13])
def test_a_wrong_number_of_points_is_refused(name, count, write):
    if name == "knet":
        content = knet(duration=count)
    else:
        content = MADE[name][0](**{"numPoints" if name == "simcenter" else "count": count})
    found = problem(write(content))
    assert found.file.endswith("record.txt")
    assert found.line
    assert found.hint


@BY_FORMAT
def test_a_file_cut_short_is_refused(name, write):
    # Accelerations without the velocities that often follow are whole.
    content = MADE[name][0](**{"kinds": ("ACCEL",)} if name == "csmip_v2" else {})
    lines = content.split("\n")
    for end in range(1, len(lines)):
        cut = "\n".join(lines[:end])
        if cut.split() == content.split() or (lines[end].startswith(("/&",)) and not "".join(lines[end + 1 :])):
            continue  # only an end mark is missing
        with pytest.raises(InputError):
            read_record(write(cut))


@BY_FORMAT
def test_a_spoilt_value_is_pointed_at(name, write):
    lines = MADE[name][0]().split("\n")
    spoilt = {"simcenter": ("-4.5", "oops"), "knet": ("  -11625", "    oops"), "esm": ("1.500000", "oops")}
    spoilt |= {"smc": ("1.5000E+0", "     oops"), "cosmos": ("   1.50000", "   *******"), "usc_v1": ("1.500", " oops")}
    old, new = spoilt.get(name, ("1.500", "*****") if name == "csmip_v2" else (" 1.50", " oops"))
    place = next(index for index, line in enumerate(lines) if old in line)
    lines[place] = lines[place].replace(old, new)
    found = problem(write("\n".join(lines)))
    assert found.line is not None


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        (esm(kind="VELOCITY", unit="cm/s"), "no acceleration, but VELOCITY"),
        (esm(unit="cm/s"), "a velocity or displacement"),
        (csmip(kinds=("VELOC", "DISPL")), "no acceleration"),
        (smc(first="3 VELOCITY"), "no acceleration, but velocity"),
        (smc(first="5 RESPONSE SPECTRA"), "no acceleration, but 5 RESPONSE SPECTRA"),
        (cosmos(kind="velocity", unit="cm/sec(05)"), "no acceleration, but velocity"),
        (cosmos(kind="raw accel.", unit="counts(50)"), "no acceleration, but raw accel."),
        (knet(scale="2000(kine)/1000000"), "the header says 'kine', which is not a known unit of acceleration"),
    ],
)
def test_what_is_no_acceleration_is_refused(content, fragment, write):
    assert fragment in problem(write(content)).message


@pytest.mark.parametrize("content", [esm(unit=""), csmip(unit=""), cosmos(unit="  "), usc(unit="-")])
def test_a_missing_unit_is_not_guessed(content, write):
    path = write(content)
    hint = problem(path, channel="1").hint
    assert "`units`" in hint
    assert read_record(path, channel="1", units="mm/s2").acceleration[1] == pytest.approx(0.0015)


@pytest.mark.parametrize("make", [geonet, csmip, lambda: cosmos(names=("90 deg", "Up"))])
def test_channels(make, write):
    path = write(make())
    found = problem(path)
    assert "channels, and only one" in found.message
    assert re.search(r"1: \S.*, 11 points, PGA \S+ g\n", found.hint)
    one, two = read_record(path, channel="1"), read_record(path, channel=" 2")
    np.testing.assert_allclose(two.acceleration, 2 * one.acceleration)
    assert one.name.startswith("record.txt channel ")
    up = read_record(path, channel="UP")
    assert up.name.lower() == "record.txt channel up"
    for unknown in ("0", "9", "N", ""):
        found = problem(path, channel=unknown)
        assert f"no channel '{unknown}'" in found.message
        assert found.field == "`channel`"
        assert "11 points" in found.hint


def test_an_azimuth_may_be_given_without_its_unit(write):
    path = write(csmip(names=("90 DEG", "UP", "0 DEG")))
    assert read_record(path, channel="90").name == read_record(path, channel="90 deg").name
    assert read_record(path, channel="0").name.endswith("0 DEG")
    assert "2 channels are called 'up'" in problem(write(csmip(names=("UP", "UP"))), channel="up").message


@pytest.mark.parametrize("content", ["t,accel_g\n0,1\n0.01,2\n", "NPTS= 2, DT= .01 SEC\nACCELERATION IN G\n1 2\n"])
def test_one_component_has_one_channel(content, write):
    assert read_record(write(content), channel="1", units="g").npts == 2
    assert "there is no channel 'up'" in problem(write(content), channel="up", units="g").message


def test_columns_may_touch(write):
    touching = np.array([-12345.12, -23456.25, 1.0])
    assert read_record(write(csmip(touching, names=("UP",)))).acceleration[:2] == pytest.approx([-123.4512, -234.5625])


@pytest.mark.parametrize("rate", [1.7e38, 0.0])
def test_a_film_of_smc_is_called_one(rate, write):
    found = problem(write(smc(first="1 UNCORRECTED ACCELEROGRAM", rate=rate)))
    assert "uncorrected film record" in found.message
    assert "kind 2" in found.hint
    assert found.line == 18
    assert read_record(write(smc(first="1 UNCORRECTED ACCELEROGRAM"))).npts == len(VALUES)


@pytest.mark.parametrize(
    ("said", "unit"),
    [
        ("11 acceleration pts, approx  0 secs, units=g.     (02)Format=(8f10.5)", "g"),
        ("11 acceleration pts, approx  0 secs, units=cm/sec2(04) Format=(8F10.5)", "cm/s2"),
        ("11 acceleration pts, approx 0 secs, units = cm/s^2 (4), Format = ( 8F10.5 )", "cm/s2"),
        ("11 acceleration pts, approx 0 secs, units=cm/s^2,Format=(8F10.5)", "cm/s2"),
        ("11 acceleration pts approx 0 secs units=mg format=(8E10.5E2)", "mg"),
    ],
)
def test_cosmos_says_the_same_in_several_ways(said, unit, write):
    content = re.sub(r" *11 +acceleration pts.*", f"  {said}", cosmos())
    motion = read_record(write(content))
    np.testing.assert_allclose(motion.acceleration, VALUES * UNITS[unit], rtol=1e-15)
    assert (motion.source_unit, motion.dt) == (unit, 0.01)


def test_cosmos_with_velocities_below_the_accelerations(write):
    whole = cosmos()
    velocities = "  2 velocity pts, approx 0 secs, units=cm/sec(05),Format=(8F10.5)\n" + columns([9, 9], "10.5f", 8)
    path = write(whole.replace("/&", velocities + "/&"))
    np.testing.assert_allclose(read_record(path).acceleration, VALUES / 100)


def test_samples_between_the_points_of_a_film_are_not_clipped(write):
    """Two points as high as each other have any number of samples between them; three points may be clipped."""
    times = np.array([0.0, 0.007, 0.020, 0.050, 0.051, 0.064, 0.080])
    for peaks, points in ((1, None), (2, None), (3, 3)):
        values = np.array([0.0, 1.0, *[2.0] * peaks, *[0.5] * (3 - peaks), -1.0, 0.0])[: len(times)]
        motion = read_record(write(usc(values=values, times=times)))
        assert motion.points is not None
        np.testing.assert_allclose(motion.acceleration[motion.points], values * G / 10, rtol=1e-12)
        found = [doubt for doubt in doubts(motion.scaled(-2), measure(motion.scaled(-2))) if doubt.kind == "clipped"]
        assert [doubt.value for doubt in found] == ([points] if points else [])
        assert all("3 points in a row" in doubt.text for doubt in found)


def test_usc_times_that_are_uneven_are_kept(write):
    motion = read_record(write(usc(np.array([0.0, 1.0, -1.0]), times=[0.0, 0.004, 0.01])))
    assert motion.dt == 0.002
    np.testing.assert_allclose(motion.acceleration, np.array([0, 0.5, 1, 1 / 3, -1 / 3, -1]) * G / 10, atol=1e-15)
    assert "does not increase" in problem(write(usc(np.ones(3), times=[0.0, 0.01, 0.01]))).message
    assert read_record(write(usc(unit="G"))).acceleration[1] == 1.5 * G


@pytest.mark.parametrize(
    "below",
    [
        columns([0.0, 1.5, 0.01, -2.5], "7.3f", 10),
        "  4 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)\n" + columns(VALUES[:4], "9.6f", 8),
    ],
    ids=["film", "evenly"],
)
@pytest.mark.parametrize("options", [{}, {"units": "g", "dt": 0.01, "channel": "1"}])
def test_csmip_v1_is_refused_by_name_and_not_read_otherwise(below, options, write):
    head = "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 01/01/00, MADE UP\n9400101\n" + "x\n" * 8
    numbers = columns([-999] * 100, "5d", 16) + columns([-999.0] * 50, "10.5f", 8)
    found = problem(write(head + numbers + below), **options)
    assert "CSMIP V1" in found.message and "CSMIP V2" in found.hint


# --- the registry ---------------------------------------------------------------------------------------------------


def reader(title: str, *, claims: bool) -> SimpleNamespace:
    def read(text, file, **options):
        return GroundMotion(title, 0.01, [0, 1], unit="m/s2")

    return SimpleNamespace(TITLE=title, SIGN=f"sign of {title}", sniff=lambda text: claims, read=read)


def test_the_readers_come_in_through_entry_points():
    assert set(load_readers()) == {
        *MADE,
        "peer_at2",
        "sac",
        "miniseed",
        "gse",
        "slist",
        "geonet_v1a",
        "afad",
        "asa",
        "cwa",
        "jma",
        *FALLBACKS,
    }


def test_two_claims_are_an_error_that_says_why():
    readers = {name: reader(name.upper(), claims=name != "c") for name in "abc"}
    with pytest.raises(InputError, match=r"a \(A: sign of A\); b \(B: sign of B\)") as caught:
        reader_for("", "x", readers)
    assert "C" not in caught.value.problems[0].message


def test_the_fallback_is_asked_last():
    readers = {"a": reader("A", claims=True), FALLBACKS[0]: reader("T", claims=True)}
    assert reader_for("", "x", readers).TITLE == "A"
    assert reader_for("", "x", {**readers, "a": reader("A", claims=False)}).TITLE == "T"


def taking_bytes(title: str, mark: bytes) -> SimpleNamespace:
    def read(data, file, **options):
        assert isinstance(data, bytes)
        return GroundMotion(title, 0.01, np.frombuffer(data.removeprefix(mark), "<f8"), unit="m/s2")

    return SimpleNamespace(
        TITLE=title, SIGN=mark.hex(), BINARY=True, sniff=lambda data: data.startswith(mark), read=read
    )


def test_a_reader_of_bytes_gets_bytes_and_the_others_text(tmp_path, monkeypatch):
    readers = {"a": reader("A", claims=True), "b": taking_bytes("B", b"MADE\0")}
    monkeypatch.setattr("rocking_cli.excitation.records.load_readers", lambda: readers)
    path = tmp_path / "record"
    path.write_bytes(b"MADE\0" + VALUES.tobytes())
    assert read_record(path).acceleration.tolist() == VALUES.tolist()
    path.write_text("plain")
    assert read_record(path).name == "A"
    path.write_bytes(b"PK\0\0")
    found = problem(path)
    assert "binary file, and none of a record format" in found.message
    assert found.hint.endswith("binary formats: B")  # a reader of text was not asked


def test_a_file_of_no_format_lists_what_was_tried(write):
    found = problem(write("nothing of the kind\n"))
    assert all(reader.TITLE in found.hint for reader in load_readers().values())
    assert "\n" not in found.hint


def test_a_broken_reader_is_named(monkeypatch):
    point = EntryPoint(name="odd", value="elsewhere:odd", group=Readers.group)
    monkeypatch.setitem(sys.modules, "elsewhere", SimpleNamespace(odd=SimpleNamespace(sniff=len)))
    monkeypatch.setattr(
        "rocking_cli.plugins.registry.entry_points", lambda group: [point] if group == Readers.group else []
    )
    monkeypatch.setattr("rocking_cli.plugins.registry._LEFT_OUT", set())
    why = r"elsewhere:odd.* is not a record reader: it has no read, TITLE, SIGN"
    with pytest.warns(PluginWarning, match=f"{why}; it is left out"):
        readers = load_readers()
    assert list(load_readers()) == ["odd"]  # without another warning, which would be an error here
    with pytest.raises(InputError, match=rf"odd \(cannot be used: .*{why}"):
        reader_for("", "x", readers)
    with pytest.raises(MechanismError, match=why):
        readers["odd"].read("", "x", dt=None, units=None, channel=None)


# --- the command ----------------------------------------------------------------------------------------------------


def test_channel_choice_knows_files_without_names():
    motion = layout.choose("x", "made up", [layout.Channel("", 0.01, VALUES, "g")] * 2, Asked(channel="2"))
    assert motion.name.startswith("x channel")


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        *((simcenter(dT=wrong), "dT must be positive") for wrong in (0, -1, "0.01", True)),
        (simcenter(dT=None), "dT is missing"),
        (simcenter(info=None), "say which it is with `units`"),
        (simcenter([float("nan"), 1.0]), "value 1 is not a finite number"),
        (simcenter([1, 10**400]), "value 2 is not a finite number"),
        (simcenter()[:-20], ":14:7: not valid JSON"),
        (simcenter().replace('"dT"', '"dT": 1, "dT"'), ':4: the key "dT" is there more than once'),
        (knet(rate="fast"), "sampling frequency"),
        (knet(scale="0(gal)/0"), "scale factor"),
        (cosmos(length=60), "sample interval is unclear"),
        (cosmos() + "left over\n", "begin here"),
        (cosmos().replace("(10I8)", "none"), "format such as"),
        (cosmos().replace("units=", "measured in "), "is not understood"),
        (smc(comments=3), "comment lines"),
        (smc(rate=0.0), "samples per second"),
        (smc(said=99), "ends before its values"),
        (esm().replace("STREAM", "stream").replace("NDATA", "x\nNDATA"), "does not state NDATA"),
        (csmip(names=("UP",)).replace("     1.500", "     1E300"), "not a finite number of sensible size"),
        (
            geonet().replace("Corrected accelerogram", "X", 2).replace("X", "Corrected accelerogram", 1),
            "must begin here",
        ),
        (geonet().replace("      11      11       0", "      11"), "followed by two more counts"),
    ],
)
def test_headers_that_are_spoilt(content, fragment, write):
    assert fragment in str(problem(write(content)))


def test_what_is_not_as_usual_but_clear_is_read(write):
    assert read_record(write(simcenter(info=None)), units="m/s2").acceleration[1] == 1.5
    assert read_record(write(simcenter(numPoints=len(VALUES) + 1))).npts == len(VALUES)
    assert "no channel '2'" in problem(write(simcenter()), channel="2").message
    assert read_record(write(cosmos(dt_ms=-999.0, length=5))).dt == 0.5  # the raw one
