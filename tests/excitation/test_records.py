import gzip
import io
import os
import runpy
import sys
import time as clock
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.records.text import on_grid
from rocking_cli.units import header_unit
from tests.conftest import NEEDS_RECORDS, PROJECT, record

EXAMPLES = PROJECT / "examples"
G = STANDARD_GRAVITY

UNTIMED = settings(deadline=None)  # they write files: a slow disk is no failure


def problems(path: Path, **options) -> tuple[Problem, ...]:
    """What `read_record` finds wrong."""
    with pytest.raises(InputError) as caught:
        read_record(path, **options)
    return caught.value.problems


def problem(path: Path, **options) -> Problem:
    """The one thing `read_record` finds wrong, which must name the file as it was given."""
    (found,) = problems(path, **options)
    assert found.file == str(path)
    return found


def accelerations(motion: GroundMotion) -> list[float]:
    return motion.acceleration.tolist()


# --- delimited text: what is read -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "rows",
    [
        "0.00,0.1\n0.01,-0.2\n0.02,0.3\n",
        "0.00 , 0.1\n0.01 , -0.2\n0.02 , 0.3",
        "0.00 \t 0.1\n0.01\t-0.2\n0.02\t0.3\n",
        "0.00 0.1\r0.01 -0.2\r0.02 0.3\r",
        "\n0.00,0.1\n\n0.01,-0.2\n0.02,0.3\n\n  \n",
        "0.00,0.1,\n0.01,-0.2,\n0.02,0.3,\n,\n",
        "0.00,0.1\n# pause\n0.01,-0.2\n % more\n0.02,0.3\n",
        "0.00,1D-1\n0.01,-2.0d-01\n0.02,.3D+00\n",
        "0.0e+000 1.0e-001\n1.0e-002 -2.0e-001\n2.0e-002 3.0e-001\n",
        "-0.01,0.1\n0.00,-0.2\n0.01,0.3\n",
        "0.00,0.1\n0.01,-0.2\n0.02,0.3\n\x1a",
        "\ufeff0.00,0.1\n0.01,-0.2\n0.02,0.3\n",
        "0,00;0,1\n0,01;-0,2\n0,02;0,3\n",  # as spreadsheets write
        "0;0,1\n0,01;-,2\n0,02;3,0E-1\n",
        "0,00\t0,1\n0,01\t-0,2\n0,02\t0,3\n",
        '"0,00";"0,1"\n"0,01";"-0,2"\n"0,02";"0,3"\n',
        '"0.00","0.1"\n"0.01","-0.2"\n"0.02","0.3"\n',
        '"0.00" "0.1"\n"0.01" "-0.2"\n"0.02" "0.3"\n',
        '# "made up", 3.5\n"0.00",0.1\n"0.01",-0.2\n"0.02",0.3\n',
    ],
)
def test_two_columns(write, rows):
    motion = read_record(write(rows), units="m/s2")
    assert accelerations(motion) == [0.1, -0.2, 0.3]
    assert motion.dt == pytest.approx(0.01, rel=1e-12)
    assert (motion.name, motion.source_unit, motion.format) == ("record.txt", "m/s2", "text")


@pytest.mark.parametrize("rows", ["0.1\n-0.2\n0.3", "0.1,\n-0.2,\n0.3,\n", "  .1\n -.2\n\n  .3\n"])
def test_one_column_takes_the_interval_from_the_user(write, rows):
    motion = read_record(write(rows), dt=0.005, units="m/s2")
    assert accelerations(motion) == [0.1, -0.2, 0.3]
    assert motion.dt == 0.005


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("g", 9.80665), ("m/s2", 1.0), ("gal", 0.01), ("%g", 0.0980665)],
)
def test_units_are_converted_to_si(write, unit, factor):
    motion = read_record(write("0,1\n0.01,-2\n"), units=unit)
    np.testing.assert_allclose(motion.acceleration, [factor, -2 * factor], rtol=1e-15)
    assert motion.source_unit == unit


@pytest.mark.parametrize("name", ["record.AT2", "record.json"])
def test_the_format_is_found_from_the_content_not_the_name(write, name):
    assert read_record(write("t,accel_g\n0,1\n0.01,2\n", name)).format == "text"
    assert read_record(write(at2([1, 2]), name)).format == "PEER AT2"


@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_encodings(write, bom, encoding):
    content = "station é\ntime [s];a [m/s²]\r\n0.0;1\r\n0.5;2\r\n".encode(encoding)
    motion = read_record(write((bom if encoding == "utf-8" else b"") + content))
    assert accelerations(motion) == [1, 2]
    assert motion.source_unit == "m/s2"


@UNTIMED
@given(
    values=st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=40),
    dt=st.floats(1e-4, 10.0),
    first=st.sampled_from([0.0, 1.0, -0.5]),
    mark=st.sampled_from([",", ";", "\t", " ", " , ", "   "]),
    newline=st.sampled_from(["\n", "\r\n"]),
    header=st.sampled_from(["t{}a [m/s2]", "# t, a [m/s2]", "% made up\ntime{}acceleration_m/s2"]),
)
def test_round_trip_of_two_columns(tmp_path_factory, values, dt, first, mark, newline, header):
    rows = [header.format(mark), *(f"{first + i * dt!r}{mark}{value!r}" for i, value in enumerate(values))]
    path = tmp_path_factory.getbasetemp() / "round_trip.txt"
    path.write_bytes(newline.join(rows).encode())
    motion = read_record(path)
    assert accelerations(motion) == values
    assert motion.dt == pytest.approx(dt, rel=1e-9)


def test_a_long_record_is_read_quickly(write):
    # The ordinary reader takes about a second for a million lines; the line-by-line one several times as long.
    n = 200_000
    path = write("time_s,accel_g\n" + "".join(f"{i * 0.005:.3f},{i % 7}.25\n" for i in range(n)))
    begin = clock.perf_counter()
    motion = read_record(path)
    assert clock.perf_counter() - begin < 3
    assert (motion.npts, motion.acceleration[-1]) == (n, ((n - 1) % 7 + 0.25) * G)


# --- units in headers -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("spelling", "name"),
    [
        *[(s, "g") for s in ("g", "G", " g ")],
        *[(s, "m/s2") for s in ("m/s2", "m/s^2", "m/s**2", "m/s/s", "m s-2", "m/sec2", "M/SEC/SEC", "m/s²", "m s⁻²")],
        *[(s, "m/s2") for s in ("m·s-2", "m s^-2", "m / s^2", "m/s 2", "mps2", "m_s2", "ms-2")],
        *[(s, "cm/s2") for s in ("cm/s2", "cm/s^2", "CM/SEC/SEC", "cm/sec**2", "CM/S/S", "cm s-2")],
        *[(s, "mm/s2") for s in ("mm/s2", "mm/s^2", "mm/s/s")],
        *[(s, "gal") for s in ("gal", "Gal", "GAL", "gals", "Gals")],
        *[(s, "ft/s2") for s in ("ft/s2", "ft/s^2", "FT/SEC/SEC", "ft/sec**2", "ft/s²")],
        *[(s, "in/s2") for s in ("in/s2", "in/s^2", "IN/SEC/SEC", "in / s 2")],
        *[(s, "m/s2") for s in ("m/sec/sec", "m/sec**2", "m.s-2")],
        *[(s, "mg") for s in ("mg", "mG", "MG", "milli g", "milli-g", "millig")],
        *[(s, "%g") for s in ("%g", "% g", "percent g")],
        *[(s, None) for s in ("m/s", "cm", "ft s2", "in s2", "in s-2", "%", "", "s", "m/s3", "g/10", "km/s2", "gs2")],
        *[(s, None) for s in ("gall", "mgal")],
    ],
)
def test_spellings(spelling, name):
    assert header_unit(spelling) == name


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("time_s,accel_g", "g"),
        ('"time","ACCEL_G"', "g"),
        ("t;Acceleration in g", "g"),
        ("t,a_g[g]", "g"),
        ("t,a_g [m/s2]", "m/s2"),
        ("t [s]  a [m/s^2]", "m/s2"),
        ("Time (sec)\tacc (cm/s^2)", "cm/s2"),
        ("t,a_g_m/s2", "m/s2"),
        ("t,accel_m_s2", "m/s2"),
        ("t,a\ns,g", "g"),
        ("t,a\n(s),(m/s2)", "m/s2"),
        ("# Acceleration, m/s2", "m/s2"),
        ("% units: cm/s**2\n% processed in 2003", "cm/s2"),
        ("#time_s accel_g", "g"),
        ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=23.0 Hz", "g"),
        ("# PGA: 19.6 (m/s2)\nt,accel_g", "g"),
        ("# Peak velocity (cm/s): 23, Vs30 = 360 m/s\nt,accel_g", "g"),
        ("Station 5\n\nNorth\nt [s],a [gal]", "gal"),
        ("# units: gal\nt,a [cm/s2]", "cm/s2"),
        ("t,accel_mg", "mg"),
        ("time,Acceleration (% g)", "%g"),
        ("t;a [m/s²]", "m/s2"),
    ],
)
def test_unit_from_the_header(write, header, unit):
    motion = read_record(write(f"{header}\n0.0,1\n0.5,2\n"))
    assert motion.source_unit == unit
    assert motion.npts == 2


@pytest.mark.parametrize(
    "header",
    [
        "",
        "t,a\n",
        "t,a_g\n",
        "t,g\n",
        "# PGA = 0.00204 g\n",
        "# Peak acceleration (g): 0.00204\n",
        "# gravity acceleration g = 9.81 m/s2\nt,a_g\n",
        "# recorded in g-building 4\n",
        "# Scale Factor 3920(gal)/6182761\n",
        "# acceleration, g = 9.81 m/s2\nt,a_g\n",
        "t,acceleration (g)/10\n",
    ],
)
def test_the_unit_is_never_guessed(write, header):
    path = write(f"{header}0.0,1\n0.5,2\n")
    found = problem(path)
    assert "does not say what unit" in found.message
    assert "`units`" in found.hint
    assert "g, m/s2, cm/s2, mm/s2, gal, mg, %g" in found.hint
    assert read_record(path, units="cm/s2").acceleration[0] == 0.01


def test_unknown_unit_of_the_user(write):
    (found,) = problems(write("0,1\n0.5,2\n"), units="km/s2")
    assert "'km/s2' is not a known unit" in found.message
    assert found.field == "`units`"
    assert "g, m/s2, cm/s2, mm/s2, gal" in found.hint


def test_two_units_in_a_header_are_not_guessed_between(write):
    path = write("# units: m/s2\nt,accel_g\n0,1\n0.5,2\n")
    found = problem(path)
    assert "more than one unit" in found.message
    assert "m/s2" in found.message
    assert found.line == 2
    assert "`units`" in found.hint
    assert read_record(path, units="g").source_unit == "g"
    assert "`units` says cm/s2" in problem(path, units="cm/s2").message


# --- the sample interval --------------------------------------------------------------------------------------------


def test_everything_missing_is_said_at_once(write):
    unit, interval = problems(write("1\n2\n"))
    assert "`units`" in unit.hint
    assert "`dt`" in interval.hint


@pytest.mark.parametrize("dt", [0.0, -0.01, float("nan"), float("inf")])
@pytest.mark.parametrize("content", ["accel_g\n1\n2\n", "t,accel_g\n0,1\n0.01,2\n"])
def test_the_interval_must_be_positive_and_finite(write, content, dt):
    (found,) = problems(write(content), dt=dt)
    assert "is not positive" in found.message or "is not a finite number" in found.message
    assert found.field == "`dt`"


def test_an_interval_that_is_given_must_agree_with_the_times(write):
    path = write("t,accel_g\n0,1\n0.01,2\n0.02,3\n")
    assert read_record(path, dt=0.01).dt == pytest.approx(0.01)
    found = problem(path, dt=0.02)
    assert "0.01 s" in found.message
    assert "`dt` says 0.02 s" in found.message


def times(write, *printed: str) -> Path:
    return write("t,accel_g\n# comment\n\n" + "".join(f"{t},1\n" for t in printed))


def test_a_missing_sample_is_found_where_it_is(write):
    printed = [f"{i * 0.005:.3f}" for i in range(3000) if i != 1234]
    found = problem(times(write, *printed))
    assert found.excerpt == "6.175,1"
    assert found.line == 1234 + 4


def test_steps_that_grow_bit_by_bit_are_refused(write):
    # Steps differ by half a percent at most, but half way the samples are a quarter of a second off.
    steps = np.where(np.arange(20000) < 10000, 0.01, 0.01005)
    found = problem(times(write, *(f"{t:.6f}" for t in np.cumsum(steps))))
    assert "a constant interval would give" in found.message


@pytest.mark.parametrize(("dt", "decimals"), [(1 / 128, 4), (1 / 256, 4), (1 / 150, 4), (0.005, 3), (1 / 3, 2)])
@pytest.mark.parametrize("n", [2, 10, 4000])
def test_rounded_times_are_accepted(write, dt, decimals, n):
    motion = read_record(times(write, *(f"{i * dt:.{decimals}f}" for i in range(n))))
    assert motion.dt == pytest.approx(dt, abs=1.01 * 10**-decimals / (n - 1))


@UNTIMED
@given(
    n=st.integers(6, 60),
    where=st.floats(0, 1),
    shift=st.floats(0.05, 0.9) | st.floats(-0.9, -0.05),
    dt=st.sampled_from([0.001, 0.005, 0.01, 1.0]),
)
def test_one_time_out_of_step_is_always_noticed(tmp_path_factory, n, where, shift, dt):
    moved = 1 + int(where * (n - 3))
    printed = [f"{(i + (shift if i == moved else 0)) * dt:.9f}" for i in range(n)]
    path = tmp_path_factory.getbasetemp() / "uneven.txt"
    path.write_text("".join(f"{t},1\n" for t in printed))
    assert problem(path, units="g").line == moved + 1


# --- what is wrong with a text file ---------------------------------------------------------------------------------


def peer_of(
    body: str, npts: int | None = 3, dt: str | None = ".01", series: str = "ACCELERATION TIME SERIES IN UNITS OF G"
) -> str:
    """A PEER AT2 file with a header of four lines."""
    said = [f"NPTS= {npts}"] * (npts is not None) + [f"DT= {dt} SEC"] * (dt is not None)
    return f"PEER NGA STRONG MOTION DATABASE RECORD\nmade up\n{series}\n{', '.join(said)}\n{body}\n"


@pytest.mark.parametrize(
    ("content", "line", "fragment", "options"),
    [
        ("t,accel_g\n0,1\n0.01,abc\n0.02,3\n", 3, "'abc' is not a number", {}),
        ("t,accel_g\nO.00,1\n0.01,2\n0.02,2\n", 2, "'O.00' is not a number", {}),
        ("t,accel_g\n0,1_0\n0.01,2\n", 2, "'1_0' is not a number", {}),
        ("t,accel_g\n0,1\n0.01,NaN\n0.02,3\n", 3, "'NaN' is not a finite number", {}),
        ("t,accel_g\n0,1\n0.01,-inf\n", 3, "'-inf' is not a finite number", {}),
        ("t,accel_g\n0,1\n0.01,1e300\n", 3, "'1e300' is not a finite number of sensible size", {}),
        ("t,accel_g\n\n0,1\n# c\n0.01\n0.02,3\n", 5, "has 1 column, the rows before it have 2", {}),
        ("t,accel_g\n0,1\n0.01,2,3\n", 3, "has 3 columns, the rows before it have 2", {}),
        ("t,accel_g\n0,1\n0.01,,2\n", 3, "a value is missing", {}),
        ("t,accel_g\n0,1\n", 2, "at least two samples", {}),
        ("6 km south of the fault\naccel_g\n1\n2\n", 1, "'km' is not a number", {}),
        ("accel_g\n1\n", 2, "at least two samples", {"dt": 0.01}),
        ("accel_g\n1\n2\n", None, "no sample interval", {}),
        ("t a [g]\n0,00 0,10\n0,01 0,20\n", 2, "point, not a comma", {}),
        ("1 -2 3 -4 5 -6 7 -8\n2 -3 4 -5 6 -7 8 -9\n0 1 0 1 0 1 0 1\n", None, "run on from line", {"units": "g"}),
        ("0,00;0,1\n0,01;1.234\n0,02;0,3\n", 2, "a point", {"units": "g"}),
        ("0,00;0,1\n0,01;1,2,3\n0,02;0,3\n", 2, "'1.2.3' is not a number", {"units": "g"}),
        ('"0,00","0,1"\n"0,01","0,2"\n', 1, "quotation marks", {"units": "g"}),
        ('"0.00","0.1"\n"0.01","1,234"\n', 2, "has 3 columns", {"units": "g"}),
        # times
        ("time_ms,accel_g\n0,1\n5,2\n", 1, "'ms'", {}),
        ("t,accel_g\n0,1\n5e-324,2\n", None, "sample interval of", {}),
        ("t,accel_g\n0,1\n# c\n\n0.01,1\n,\n0.02,1\n% c\n0.04,1\n0.05,1\n", 9, "uneven", {}),
        ("t,a\n0,1\n0.01,1\n0.02,1\n0.021,1\n0.03,1\n0.04,1\n", 5, "uneven", {"units": "g"}),
        ("t,a\n0,1\n0.01,1\n0.02,1\n0.0202,1\n", 5, "uneven", {"units": "g"}),
        ("t,a\n0,1\n0.01,1\n0.01,1\n0.02,1\n", 4, "does not increase: 0.01 s is repeated", {"units": "g"}),
        ("t,a\n0,1\n0.02,1\n0.015,1\n0.03,1\n", 4, "0.015 s comes after 0.02 s", {"units": "g"}),
        ("accel_g,time_s\n0,0\n1,1\n", 1, "the time is in the second column", {}),
        ('"acc (g)",Time\n0,0\n1,1\n', 1, "the time is in the second column", {}),
        # units and quantities
        ("# made up\nt,accel_g\n0,1\n0.5,2\n", 2, "but `units` says m/s2", {"units": "m/s2"}),
        ("t,a [furlong/s2]\n0,1\n0.5,2\n", 1, "says 'furlong/s2', which is not a known unit", {}),
        ("# made up\nTime (sec); acc (kine)\n0;1\n0.5;2\n", 2, "says 'kine', which is not a known unit", {}),
        ("# units: furlong/fortnight^2\nt,a\n0,1\n0.5,2\n", 1, "says 'furlong/fortnight^2', which", {}),
        ("t [s],v [m/s]\n0,1\n0.5,2\n", 1, "'m/s'", {}),
        ("# one\nt [s];u (cm)\n0;1\n0.5;2\n", 2, "'cm'", {"units": "g"}),
        ("t,acceleration [cm/s]\n0,1\n0.5,2\n", 1, "'cm/s'", {"units": "g"}),
        ("# VELOCITY TIME SERIES IN UNITS OF CM/S\nt,x\n0,1\n0.5,2\n", 1, "'cm/s'", {}),
        ("# accelerations\nt,vel\n0,1\n0.5,2\n", 2, "velocity or displacement", {"units": "g"}),
        ("t,accel [km/s2]\n0,1\n0.5,2\n", 1, "'km/s2' cannot be read", {}),
        ("t,accel [counts]\n0,1\n0.5,2\n", 1, "'counts' cannot be read", {"units": "g"}),
        # PEER AT2
        (peer_of("1 2 3\n4 oops 6", 6), 6, "'oops' is not a number", {}),
        (peer_of("1 2 3\n4 ******** 6", 6), 6, "'********' is not a number", {}),
        (peer_of("1 2,5 3"), 5, "'2,5' is not a number", {}),
        (peer_of("1 2 3", None), None, "(NPTS)", {}),
        (peer_of("1 2 3", 3, None), 4, "(DT)", {}),
        (peer_of("1 2 3", 4), 4, "3 values", {}),
        (peer_of("1", 1), 4, "at least two samples", {}),
        (peer_of("1 2 3", dt="-.01"), 4, "positive", {}),
        (peer_of("1 2 3", series="VELOCITY TIME SERIES IN UNITS OF CM/S"), 3, "not an acceleration", {}),
        # Fortran drops the E of a three-digit exponent; read as two numbers it would be a sample of -102 g.
        (peer_of(".1234-102 .2 .3"), 4, "has 4 values", {}),
        # any file
        *((empty, None, "empty", {}) for empty in ("", "\n \r\n", "\ufeff", "\x1a")),
        *((binary, None, "binary", {}) for binary in (b"\x89PNG\r\n\x1a\n\0\0\0", "\x02")),
        ("0,1\n\0\0\0\n0.1,2\n", 2, "NUL bytes alone", {}),
        ("0,1\n\x02\n".encode("utf-16"), None, "binary", {}),
        ("t,accel_g\n0,1\n0.1,2\n".encode("utf-16")[:-1], None, "cut or damaged", {}),
        *(
            (other, None, "PEER AT2", {})
            for other in ("hello\n", "t,accel_g\n", "# a\n", '{"a": [\n0.1]}', "<a>\n1\n2")
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_line(write, content, line, fragment, options):
    found = problem(write(content), **{"dt": 0.01} | options if "run on" in fragment else options)
    assert fragment in str(found)
    assert found.line == line and "\n" not in (found.excerpt or "")


# --- what is wrong with any file ------------------------------------------------------------------------------------


def test_a_file_is_named_as_the_user_named_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, said in (
        ("./nowhere.csv", "no such file"),
        (str(tmp_path), "this is a folder"),
        ("a\0b", "cannot be read"),
    ):
        assert said in problem(name).message


@UNTIMED
@given(st.text(alphabet="0123456789.,;-+eEdDnaif# \t\nNPTS=DTg[]", max_size=80), st.sampled_from([None, "g"]))
def test_rubbish_is_read_or_refused_never_a_traceback(tmp_path_factory, content, units):
    path = tmp_path_factory.getbasetemp() / "rubbish.txt"
    path.write_text(content)
    try:
        motion = read_record(path, dt=0.01, units=units)
    except InputError as error:
        assert error.problems
    else:
        assert np.isfinite(motion.acceleration).all()
        assert motion.dt > 0


@UNTIMED
@given(st.sampled_from([b"", b"\x1f\x8b\x08", b"PK\x03\x04", b"PK\x05\x06", b"\xff\xfe"]), st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(tmp_path_factory, mark, content):
    path = tmp_path_factory.getbasetemp() / "bytes.txt"
    path.write_bytes(mark + content)
    try:
        read_record(path, dt=0.01, units="g")
    except InputError as error:
        assert error.problems


# --- PEER AT2 -------------------------------------------------------------------------------------------------------

TITLE = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/2000, Station (upper left), 228\n"
UNITS_OF_G = "ACCELERATION TIME SERIES IN UNITS OF G\n"


def at2(values, *, dt: str = ".0100", npts: int | None = None, units: str = UNITS_OF_G, per_line: int = 5) -> str:
    npts = len(values) if npts is None else npts
    rows = [values[i : i + per_line] for i in range(0, len(values), per_line)]
    body = "\n".join("".join(f"{value:16.7E}" for value in row) for row in rows)
    return f"{TITLE}{units}NPTS={npts:7d}, DT= {dt:>7} SEC,   0 POLE @    30.00000 HZ\n{body}\n"


VALUES = [0.001 * i * (-1) ** i for i in range(1, 14)]


@pytest.mark.parametrize("per_line", [1, 5, 8])
def test_peer(write, per_line):
    path = write(at2(VALUES, per_line=per_line), "RSN1.AT2")
    motion = read_record(path)
    np.testing.assert_allclose(motion.acceleration, np.array(VALUES) * G, rtol=1e-12)
    assert (motion.dt, motion.name, motion.source_unit, motion.format) == (0.01, "RSN1.AT2", "g", "PEER AT2")


@pytest.mark.parametrize(
    "header",
    [
        f"{TITLE}{UNITS_OF_G}   3    0.0050    NPTS, DT\n",
        f"{TITLE}{UNITS_OF_G}NPTS=3,DT=5.0E-03\n",
        f"{TITLE}{UNITS_OF_G}npts = 3, dt = .5D-02 sec\n",
        f"{TITLE}{UNITS_OF_G}DT= .0050 SEC\nNPTS= 3\n",
        "Data, older version\n3 points at 0.005 sec in 8F10.5\nThe units are (g)\nNPTS=  3, DT= .00500 SEC\n",
        f"{TITLE}processed twice\nfiltered\n\n{UNITS_OF_G}NPTS= 3, DT= .005 SEC\n",
        f"{UNITS_OF_G}NPTS= 3, DT= .005 SEC\n",
        "NPTS= 3, DT= .005 SEC\nUNITS OF G\n\n",
    ],
)
def test_peer_headers(write, header):
    motion = read_record(write(header + "  .1000000E+00  -.2000000E+00   .3000000E+00\n"))
    np.testing.assert_allclose(motion.acceleration, [0.1 * G, -0.2 * G, 0.3 * G], rtol=1e-15)
    assert (motion.dt, motion.source_unit, motion.format) == (0.005, "g", "PEER AT2")


@pytest.mark.parametrize(
    "body",
    [
        ".998E-03 -.25D-02 .1",
        "  .998E-03\n\n  -.25d-02  1D-1\n",
        ".998E-03-.25D-02+.1E+00",
        "9.98e-4,".rstrip(",") + "\t-2.5e-3\r\n.1\r\n\x1a",
        ".000998-.002500 .1",
    ],
)
def test_fortran_numbers(write, body):
    motion = read_record(write(at2([], npts=3) + body))
    np.testing.assert_allclose(motion.acceleration, np.array([0.998e-3, -0.25e-2, 0.1]) * G, rtol=1e-14)


@UNTIMED
@given(values=st.lists(st.floats(-9.9e9, -1e-9), min_size=2, max_size=40), per_line=st.sampled_from([1, 5, 8]))
def test_round_trip_of_values_run_together(tmp_path_factory, values, per_line):
    rows = ["".join(f"{v:.16E}" for v in values[i : i + per_line]) for i in range(0, len(values), per_line)]
    path = tmp_path_factory.getbasetemp() / "together.AT2"
    path.write_text(at2([], npts=len(values), units="UNITS OF M/S/S\n") + "\n".join(rows))
    assert accelerations(read_record(path)) == values


def test_unit_missing_or_contradicted_in_peer(write):
    path = write(at2(VALUES, units="\n"))
    assert "`units`" in problem(path).hint
    assert read_record(path, units="gal").source_unit == "gal"
    found = problem(write(at2(VALUES)), units="m/s2")
    assert "the unit is g, but `units` says m/s2" in found.message
    assert found.line == 3


def test_comments_in_peer_are_passed_over(write):
    content = "# NPTS= 99, DT= 1.0\n" + at2([], npts=3).rstrip("\n") + "\n.1 .2\n# pause\n.3\n"
    motion = read_record(write(content))
    assert (motion.npts, motion.dt) == (3, 0.01)
    assert "oops" in problem(write(content + "# c\noops\n")).message


def test_text_with_a_peer_header_in_comments_is_text(write):
    content = "".join(f"# {line}\n" for line in at2([], npts=2).splitlines()) + "0,1\n0.01,2\n"
    motion = read_record(write(content))
    assert (motion.format, motion.npts, motion.source_unit) == ("text", 2, "g")


# --- real records, and the example ----------------------------------------------------------------------------------


@NEEDS_RECORDS
@pytest.mark.parametrize(
    ("name", "options", "npts", "dt", "pga", "form"),
    [
        ("Rinaldi228.AT2", {}, 1991, 0.01, 0.874, "PEER AT2"),
        ("RSN6_IMPVALL.I_I-ELC180.AT2", {}, 5372, 0.01, 0.281, "PEER AT2"),
        ("RSN77_SFERN_PUL164.AT2", {}, 4172, 0.01, 1.219, "PEER AT2"),
        ("elCentro.AT2", {}, 1559, 0.02, 0.319, "PEER AT2"),
        ("elcentro_NS_full_2col.dat", {"units": "g"}, 2688, 0.02, 0.349, "text"),
    ],
)
def test_real_records(name, options, npts, dt, pga, form):
    motion = read_record(record(name), **options)
    assert (motion.name, motion.npts, motion.format, motion.source_unit) == (name, npts, form, "g")
    assert motion.dt == pytest.approx(dt, rel=1e-9)
    assert motion.pga_g == pytest.approx(pga, abs=0.0005)


@pytest.fixture(scope="module")
def make_accel():
    return runpy.run_path(str(EXAMPLES / "make_accel.py"))


def test_the_example_is_what_its_script_makes(make_accel, tmp_path):
    make_accel["write"](tmp_path / "accel.csv")
    made, kept = read_record(tmp_path / "accel.csv"), read_record(EXAMPLES / "accel.csv")
    np.testing.assert_allclose(made.acceleration, kept.acceleration, rtol=0, atol=1e-9)
    time, acceleration = make_accel["accelerogram"]()
    np.testing.assert_allclose(kept.acceleration, acceleration * G, rtol=0, atol=1e-9)
    np.testing.assert_allclose(np.arange(kept.npts) * kept.dt, time, rtol=0, atol=1e-9)


# --- tables of several columns --------------------------------------------------------------------------------------

TABLE = "time_s,ax [g],ay [m/s2],vel (cm/s)\n0.00,0.1,1,9\n0.01,-0.2,-2,9\n0.02,0.3,3,9\n"


@pytest.mark.parametrize(
    ("channel", "unit", "values"),
    [
        ("1", "g", [0.1, -0.2, 0.3]),
        ("AX [g]", "g", [0.1, -0.2, 0.3]),
        ("2", "m/s2", [1, -2, 3]),
    ],
)
def test_a_column_is_chosen_by_place_or_name(write, channel, unit, values):
    motion = read_record(write(TABLE), channel=channel)
    size = G if unit == "g" else 1.0
    np.testing.assert_allclose(motion.acceleration, size * np.array(values), rtol=1e-15)
    assert (motion.source_unit, motion.dt) == (unit, pytest.approx(0.01))
    assert motion.name == f"record.txt channel {'ax [g]' if unit == 'g' else 'ay [m/s2]'}"


def test_without_a_choice_the_columns_are_listed(write):
    found = problem(write(TABLE))
    assert "2 columns that may be accelerations" in found.message
    for said in ("`channel`", "1: ax [g], column 2, in g, peak 0.3", "2: ay [m/s2], column 3, in m/s2, peak 3"):
        assert said in found.hint
    assert "column 1, time_s, is time" in found.hint
    assert "column 4, vel (cm/s), is no acceleration" in found.hint


@pytest.mark.parametrize("channel", ["3", "vel", "²"])
def test_a_column_that_is_not_there_is_listed_too(write, channel):
    found = problem(write(TABLE), channel=channel)
    assert f"there is no channel '{channel}'" in found.message
    assert "2: ay [m/s2]" in found.hint
    assert "leave `channel` out" not in str(found)


@pytest.mark.parametrize("columns", [3, 8])
@pytest.mark.parametrize("mark", [",", "\t", "  "])
@pytest.mark.parametrize("labelled", [True, False])
def test_tables_of_any_width(write, columns, mark, labelled):
    table = np.array([[0.01 * row, *(row * (-1) ** row + k for k in range(1, columns))] for row in range(6)])
    header = mark.join(["Time (s)", *(f"acc{k} (gal)" for k in range(1, columns))]) + "\n"
    path = write(header * labelled + "".join(mark.join(map(repr, map(float, row))) + "\n" for row in table))
    for k in range(1, columns):
        motion = read_record(path, channel=str(k), units=None if labelled else "gal")
        np.testing.assert_allclose(motion.acceleration, 0.01 * table[:, k], rtol=1e-15)
        assert motion.dt == pytest.approx(0.01)
    assert f"{columns - 1}: " in problem(path, units="gal").hint


def test_two_rows_of_labels(write):
    path = write("t,north,east\ns,g,cm/s2\n0,1,2\n0.1,2,3\n")
    assert read_record(path, channel="north").source_unit == "g"
    assert read_record(path, channel="east").source_unit == "cm/s2"
    assert "'ms'" in problem(write("time,north,east\nms,g,g\n0,1,2\n5,2,3\n"), channel="1").message
    assert "'ms'" in problem(write("time,north\nms,g\n0,1\n5,2\n")).message


def test_the_only_column_of_accelerations_needs_no_choice(write):
    motion = read_record(write("t,acc [g],vel [m/s],disp [m]\n0,1,5,5\n0.5,2,6,7\n"))
    assert (accelerations(motion), motion.name) == ([G, 2 * G], "record.txt")
    assert "none of the columns" in problem(write("t,vel [m/s],disp [m]\n0,1,5\n0.5,2,6\n")).message


def test_a_table_without_times_needs_an_interval(write):
    path = write("ns [g],ew [g],ud [g]\n1,2,3\n-1,5,6\n1,8,10\n")
    assert "no column is called time" in problem(path, channel="ew").message
    motion = read_record(path, channel="ew", dt=0.01)
    assert (accelerations(motion), motion.dt) == ([2 * G, 5 * G, 8 * G], 0.01)


def test_a_column_called_t_may_be_the_transverse_component(write):
    path = write("L V T\n0.1 0.2 0.3\n0.2 0.1 0.1\n0.1 0.2 0.3\n")
    assert accelerations(read_record(path, channel="T", dt=0.1, units="m/s2")) == [0.3, 0.1, 0.3]


def test_each_column_has_the_times_before_it(write):
    path = write("t1,a,t2,b\n0,1,0,5\n0.01,2,0.02,6\n0.02,1,0.04,7\n")
    assert read_record(path, channel="a", units="g").dt == pytest.approx(0.01)
    assert read_record(path, channel="b", units="g").dt == pytest.approx(0.02)
    found = problem(write("t1,a,t2,b\n0,1,0,5\n0.01,2,0.02,6\n0.02,1,0.04,7\n0.03,1,0.07,7\n"), channel="b", units="g")
    assert (found.line, found.field) == (5, "column 3 (t2)")


def test_a_bad_value_in_a_table_names_its_column(write):
    found = problem(write("t,ax [g],ay [g]\n0,1,2\n0.01,x,3\n"), channel="ay")
    assert (found.line, found.field) == (3, "column 2 (ax [g])")
    assert "'x' is not a number" in found.message


def test_accelerations_that_repeat_the_times_are_no_times(write):
    path = write("x,y\n0,0\n0.02,0.02\n")
    assert accelerations(read_record(path, channel="1", units="m/s2")) == [0, 0.02]


# --- times with few digits ------------------------------------------------------------------------------------------


def printed(dt: float, n: int, form: str = ".6g") -> list[str]:
    return [format(k * dt, form) for k in range(n)]


@pytest.mark.parametrize(("dt", "n"), [(1 / 800, 16872), (1 / 256, 5000)])
def test_times_of_six_digits_are_even(write, dt, n):
    motion = read_record(times(write, *printed(dt, n)))
    assert motion.npts == n
    assert motion.dt == pytest.approx(dt, rel=1e-4)


def test_times_of_few_decimals_are_not_taken_for_times_of_few_digits(write):
    rows = [f"{k * 0.005:.3f}" for k in range(4000)]
    rows[3000] = "15.001"
    assert problem(times(write, *rows)).line == 3000 + 4


@pytest.mark.parametrize("missing", [10, 12345])
def test_a_missing_sample_is_found_among_times_of_six_digits(write, missing):
    rows = printed(1 / 800, 16000)
    del rows[missing]
    assert problem(times(write, *rows)).line == missing + 4


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("content", ["Zeit;a [m/s²]\r\n0,0;1,5\r\n0,5;2\r\n", "t,accel [m/s2]\n0.0,1.5\n0.5,2\n"])
def test_utf_16(write, encoding, content):
    motion = read_record(write(content.encode(encoding)))
    assert (accelerations(motion), motion.source_unit) == ([1.5, 2], "m/s2")


# --- packed files ---------------------------------------------------------------------------------------------------

ONE = "t,accel_g\n0,1\n0.01,2\n"


def zipped(**files: str | bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return out.getvalue()


def test_a_gzip_file(write):
    motion = read_record(write(gzip.compress(ONE.encode()), "record.csv.gz"))
    assert (accelerations(motion), motion.name) == ([G, 2 * G], "record.csv.gz")
    assert problem(write(gzip.compress(b"t,accel_g\n0,1\n0.01,x\n"))).line == 3


def test_an_archive_of_one_record(write):
    hidden = {"__MACOSX/._a.csv": "x", "folder/": "", ".DS_Store": "x"}
    path = write(zipped(**{"folder/a.csv": ONE}, **hidden), "records.zip")
    assert read_record(path).name == "records.zip"
    assert read_record(path, channel="1").npts == read_record(path, channel="a.csv").npts == 2
    (found,) = problems(write(zipped(**{"a.csv": ONE + "x\n"}), "records.zip"))
    assert (found.file, found.line) == (f"{path}/a.csv", 4)


def test_of_an_archive_of_several_one_is_chosen(write):
    path = write(zipped(**{"a.csv": ONE, "b/b.csv": TABLE, "readme.txt": "read me"}), "records.zip")
    found = problem(path)
    assert "3 files" in found.message
    assert "2: b/b.csv" in found.hint
    assert "`channel`" in found.hint
    assert read_record(path, channel="a.csv").name == "records.zip channel a.csv"
    for asked in ("2:ay", "b.csv:2", "B/b.csv:AY"):
        assert read_record(path, channel=asked).name == "records.zip channel b/b.csv:ay [m/s2]"
        assert read_record(path, channel=asked).source_unit == "m/s2"
    assert "no file '4'" in problem(path, channel="4").message
    assert "2 columns" in problems(path, channel="b.csv")[0].message


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        (b"PK\x03\x04abc", "cannot be unpacked"),
        (b"\x1f\x8b\x08abc", "cannot be unpacked"),
        (gzip.compress(ONE.encode() * 9)[:-12], "cannot be unpacked"),
        (zipped(a=ONE)[:-30], "cannot be unpacked"),
        (zipped(), "holds no file"),
        (zipped(**{"[Content_Types].xml": "", "xl/workbook.xml": ""}), "spreadsheet"),
        (zipped(a=zipped(b=ONE)), "another archive"),
        (zipped(a=gzip.compress(b"0")), "another archive"),
        (gzip.compress(gzip.compress(b"0")), "another archive"),
        (gzip.compress(b"a.txt".ljust(257, b"\0") + b"ustar\0"), "another archive"),
    ],
)
def test_what_is_packed_otherwise_is_refused(write, content, fragment):
    (found,) = problems(write(content))
    assert fragment in found.message
    assert len(str(found)) < 600


def test_what_expands_too_far_is_refused(write, monkeypatch):
    monkeypatch.setattr("rocking_cli.excitation.records.opening.MAX_UNPACKED_BYTES", 100_000)
    long = b"0\n" * 100_000
    for packed in (gzip.compress(long), zipped(a=long)):
        (found,) = problems(write(packed))
        assert "unpacked it is larger than 0.1 MB" in found.message
    lying = bytearray(zipped(a=long))
    place = lying.index(b"PK\x01\x02") + 24
    lying[place : place + 4] = (1000).to_bytes(4, "little")  # says in its list that it is small
    assert problems(write(bytes(lying)))


def test_what_was_packed_a_thousand_times_smaller_is_refused_before_it_fills_the_memory(write):
    path = write(gzip.compress(b"0\n" * 20_000_000, compresslevel=1))
    tracemalloc.start()
    try:
        (found,) = problems(path)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert "unpacked it is larger than" in found.message and most < 60e6


def test_more_samples_than_a_record_has_are_refused_before_they_are_read(write, monkeypatch):
    monkeypatch.setattr("rocking_cli.excitation.records.text.MOST_SAMPLES", 1000)
    monkeypatch.setattr("rocking_cli.excitation.records.text.MAX_NUMBERS", 4000)
    monkeypatch.setattr("rocking_cli.excitation.records.simcenter.MOST_SAMPLES", 1000)
    (found,) = problems(write(b"# unit: g\n" + b"0\n" * 1001), dt=0.01)
    assert "at most 1000 samples in each column" in found.message
    (found,) = problems(write(b"0 1 2 3 4 5 6 7 8 9\n" * 401))
    assert "at most 400 samples in each column" in found.message
    (found,) = problems(write(b'{"dT": 0.01, "accel_data": [' + b"0.5, " * 1001 + b"1.0]}"))
    assert "at most 1000 samples" in found.message
    (found,) = problems(write(b"0 " * 1_000_000))
    assert "a line of numbers has at most 1000000 characters" in found.message and found.line == 1
    at2 = "A\nB\nACCELERATION IN UNITS OF G\nNPTS= 20000001, DT= .005 SEC\n 0.1 0.2\n"
    (found,) = problems(write(at2.encode()))
    assert "must be a whole number from 0 to 20000000" in found.message and found.line == 4


def test_a_hostile_name_in_an_archive_is_shown_escaped(write):
    (found,) = problems(write(zipped(**{"\x1b[31ma": ONE, "b": ONE})))
    assert "\\x1b[31ma" in found.hint
    assert "\x1b" not in str(found)


# --- standard input -------------------------------------------------------------------------------------------------


@pytest.fixture
def given_on_standard_input(monkeypatch):
    """Put bytes on standard input."""

    def give(content: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))

    return give


@pytest.mark.parametrize("content", [ONE.encode(), gzip.compress(ONE.encode())])
def test_standard_input(given_on_standard_input, content):
    given_on_standard_input(content)
    motion = read_record("-")
    assert (motion.name, accelerations(motion)) == ("standard input", [G, 2 * G])
    found = problem_of_standard_input()
    assert "once" in found.message


def problem_of_standard_input() -> Problem:
    (found,) = problems("-")
    assert found.file == "standard input"
    return found


def test_what_is_wrong_with_standard_input_is_said_of_it(given_on_standard_input, monkeypatch):
    given_on_standard_input(b"t,accel_g\n0,1\n0.01,x\n")
    assert problem_of_standard_input().line == 3
    given_on_standard_input(b"")
    assert "empty" in problem_of_standard_input().message
    monkeypatch.setattr("rocking_cli.excitation.records.opening.MAX_FILE_BYTES", 10)
    given_on_standard_input(b"0\n" * 10)
    assert "larger than" in problem_of_standard_input().message
    given_on_standard_input(b"")
    sys.stdin.close()
    assert "cannot be read" in problem_of_standard_input().message
    monkeypatch.setattr(sys, "stdin", None)
    assert "there is no standard input" in problem_of_standard_input().message


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_is_refused_with_what_to_do(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    found = problem(tmp_path / "pipe")
    assert "a pipe" in found.message
    assert "give - in its place" in found.hint


def test_the_interval_of_a_time_column_is_the_number_that_was_written(tmp_path):
    """1.2/120 of times in steps of 0.01 s ends in ...98 where it is divided."""
    for npts in (121, 1201, 4001):
        file = tmp_path / f"{npts}.csv"
        rows = "".join(f"{3 + 0.01 * k:.2f},{(-1) ** k * 0.1}\n" for k in range(npts))
        file.write_text(f"t (s),a (g)\n{rows}", encoding="utf-8")
        assert read_record(file).dt == 0.01


def test_how_uneven_times_are_is_told_by_the_step_that_is_farthest_off():
    """Steps of 10, 10, 4, 10, 10 and 12 ms: the one of 4 ms is 6 ms off, longer ones only 2 ms."""
    time = np.cumsum([0.0, 0.01, 0.01, 0.004, 0.01, 0.01, 0.012])
    dt, values, doubt = on_grid(time, 3 * time)
    assert dt == 0.01 and values == pytest.approx(0.03 * np.arange(6))
    assert doubt.kind == "uneven" and doubt.value == pytest.approx(0.006)
    assert "2 of 6 steps are not within 1 % of 0.01 s, they go from 0.004 to 0.012 s (at 0.044 s)" in doubt.text
