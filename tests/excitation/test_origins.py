"""Which earthquake and station a record is of, from the headers of every format that states it, and from no other."""

import warnings

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.excitation.base import NOT_SAID, Origin
from rocking_cli.excitation.records import statements
from tests.cli.test_cli import run, run_json
from tests.conftest import record
from tests.excitation import test_record_formats as made

TITLE, SERIES = "PEER NGA STRONG MOTION DATABASE RECORD", "ACCELERATION TIME SERIES IN UNITS OF G"
PEER = f"{TITLE}\n{{}}\n{SERIES}\nNPTS= 4, DT= .01 SEC\n.1 .2 -.3 0.\n"


def of(tmp_path, text: str, **options) -> Origin:
    path = tmp_path / "record.txt"
    path.write_bytes(text.encode())
    return read_record(path, **options).origin


@pytest.mark.parametrize(
    ("line", "event", "station"),
    [
        ("Made Up-01, 1/17/1994, Some Receiving Sta, 228", "Made Up-01", "Some Receiving Sta"),
        ("MADE UP 10/15/79 2319, SOME ARRAY 4, 140 (CDMG STATION 955)", "MADE UP 10/15/79 2319", "SOME ARRAY 4"),
        ("Made \x9b31mUp, 1/17/1994, \u202eSta\tion, 228", "Made 31mUp", "Sta ion"),
        ("Made Up, 1/17/1994, -, 228", "Made Up", None),
        ("Unknown, 1/17/1994, -999, 228", None, None),
        ("Made Up, Some Station, 228", None, None),  # no date: which is which is not guessed
        ("", None, None),
    ],
)
def test_peer(tmp_path, line, event, station):
    assert of(tmp_path, PEER.format(line)) == Origin(event, station, None, None)


def test_the_second_line_of_another_than_the_database_says_nothing(tmp_path):
    text = PEER.format("Made Up, 1/17/1994, Station, 228").replace(TITLE, "Of us")
    assert of(tmp_path, text) == NOT_SAID


def test_simcenter_quotes_the_title_of_peer(tmp_path):
    info = f"{TITLE} Made Up-01, 1/17/1994, Some Sta, 228 {SERIES}"
    assert of(tmp_path, made.simcenter(info=info)) == Origin("Made Up-01", "Some Sta", None, None)
    assert of(tmp_path, made.simcenter()) == NOT_SAID


def test_esm(tmp_path):
    more = "EVENT_DATE_YYYYMMDD: 20120529\nEVENT_TIME_HHMMSS: 070002\nMAGNITUDE_W: 6.0\nMAGNITUDE_L: 5.8\nNETWORK: IV\n"
    more += "STATION_CODE: T0819\nEPICENTRAL_DISTANCE_KM: 6.7\n"
    assert of(tmp_path, more + made.esm()) == Origin("MADE UP 2012-05-29 07:00:02", "IV.T0819", 6.0, 6.7)
    local = more.replace("MAGNITUDE_W: 6.0", "MAGNITUDE_W: ").replace("6.7", "unknown").replace("NETWORK: IV\n", "")
    assert of(tmp_path, local + made.esm()) == Origin("MADE UP 2012-05-29 07:00:02", "T0819", 5.8, None)
    # A name without a day is that of a region, of many earthquakes.
    assert of(tmp_path, made.esm()) == NOT_SAID


def test_knet(tmp_path):
    assert of(tmp_path, made.knet()) == Origin("2018/01/24 19:51:00", "MADE", 6.2, None)
    odd = made.knet().replace("2018/01/24", "some day  ").replace("6.2", "16.2").replace("MADE", "----")
    assert of(tmp_path, odd) == NOT_SAID


def test_geonet(tmp_path):
    lines = made.geonet(names=("Up",)).split("\n")
    lines[1:9] = ["Site WPWS  39 56 38S", *["x"] * 5, "2018 February 12         21:15:54 UT",
                  "Epicentre  40 03 27S 176 32 45E  Bearing S15W  Dist   13km  Depth    9km M  4.17"]  # fmt: skip
    assert of(tmp_path, "\n".join(lines)) == Origin("2018 February 12 21:15:54 UT", "WPWS", 4.17, 13.0)
    assert of(tmp_path, made.geonet(names=("Up",))) == NOT_SAID


def test_smc(tmp_path):
    lines = made.smc().split("\n")
    lines[3:7] = ["     1989  10  18    0004 Made Up, CA", "Moment Mag=      7.1 Ms=      7.2 Ml=      7.0",
                  "station = Town, 12 Street component=  360", "epicentral dist =   89.0   pk = 104.4"]  # fmt: skip
    assert of(tmp_path, "\n".join(lines)) == Origin("Made Up, CA 1989-10-18 00:04", "Town, 12 Street", 7.1, 89.0)
    lines[4] = "Moment Mag=          Ms=      7.2 Ml=      7.0"
    assert of(tmp_path, "\n".join(lines)).magnitude == 7.0
    assert of(tmp_path, made.smc()) == NOT_SAID


def test_usc(tmp_path):
    lines = made.usc().split("\n")
    event = "MADE UP EARTHQUAKE JAN 17, 1994 -1230 GMT"
    lines[2:2] = ["x", "x", "STATION USC# 0016   34 05 22N", "x", "x", event.replace("JAN", "  JAN") + "    46"]
    assert of(tmp_path, "\n".join(lines)) == Origin(event, "USC# 0016", None, None)
    assert of(tmp_path, made.usc()) == NOT_SAID


CSMIP = ["MADE UP EARTHQUAKE     MAY 2, 1983 16:42 PDT", "HYPOCENTER(BRK): 36.25N,120.28W, H=9KM.  ML=6.5(BRK)",
         "STATION NO. 36456   35.908N, 120.458W     SMA-1  S/N 4384", "SOME FAULT ZONE 14"]  # fmt: skip


def test_csmip_v2_says_it_of_each_channel(tmp_path):
    lines = made.csmip().split("\n")
    second = next(k for k, line in enumerate(lines) if "CHAN  2" in line)
    lines[second + 2 : second + 3] = [line.replace("SOME", "OTHER") for line in CSMIP]
    lines[2:3] = CSMIP
    text = "\n".join(lines)
    event = "MADE UP EARTHQUAKE MAY 2, 1983 16:42 PDT"
    assert of(tmp_path, text, channel="1") == Origin(event, "SOME FAULT ZONE 14", 6.5, None)
    assert of(tmp_path, text, channel="2") == Origin(event, "OTHER FAULT ZONE 14", 6.5, None)
    unnamed = text.replace("SOME FAULT ZONE 14\n", "", 1)  # the line of the channel comes next
    assert of(tmp_path, unnamed, channel="1").station == "36456"
    assert of(tmp_path, made.csmip(), channel="2") == NOT_SAID  # an earthquake without a year


def test_cosmos(tmp_path):
    lines = made.cosmos().split("\n")
    lines[1:6] = ["Record of Made Up Quake of Fri Nov 30, 2018 17:29 UTC", "Hypocenter: 61.3 -149.9 ML=6.8, Mw=7.0",
                  "x", "Statn No: 37-000011 Code:AK-BMR     UAF  Some River, AK, USA", "x"]  # fmt: skip
    first = next(k for k, line in enumerate(lines) if "Real-header" in line) + 1
    cells = lines[first + 2]
    lines[first + 2] = cells[: 4 * 13] + f"{290.06:13.6f}" + cells[5 * 13 :]  # the 17th, six a line
    event = "Made Up Quake of Fri Nov 30, 2018 17:29 UTC"
    assert of(tmp_path, "\n".join(lines)) == Origin(event, "Some River, AK, USA", 7.0, 290.06)
    lines[4] = "Statn No: 37-000011 Code:AK-BMR"
    assert of(tmp_path, "\n".join(lines)).station == "AK-BMR"
    assert of(tmp_path, made.cosmos()) == NOT_SAID  # -999 is no distance


def test_delimited_text_says_nothing(tmp_path):
    assert of(tmp_path, "Made Up, 1/17/1994, Station, 228\nt [s],a [g]\n0,0\n0.01,0.1\n0.02,0\n") == NOT_SAID


@pytest.mark.parametrize("form", ["SAC", "MSEED"])
def test_seismologists_formats(tmp_path, form):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        obspy = pytest.importorskip("obspy", reason="obspy is not installed (the extra rocking-cli[seismo])")
        header = {"delta": 0.01, "network": "XX", "station": "STA", "channel": "HNE"}
        if form == "SAC":
            header["sac"] = {"kevnm": "made up", "mag": 6.5, "dist": 12.5}
        path = tmp_path / "record.dat"
        obspy.Trace(np.array([0, 0.5, -0.5, 0] * 20, dtype=np.float32), header).write(str(path), format=form)
    expected = ("made up", "XX.STA", 6.5, 12.5) if form == "SAC" else (None, "XX.STA", None, None)
    assert read_record(path, units="g").origin == expected


@pytest.mark.parametrize(
    ("given", "magnitude", "distance"),
    [
        ("6.5", 6.5, 6.5),
        (-999.0, None, None),
        (float("nan"), None, None),
        ("11", None, 11.0),
    ],
)
def test_numbers_that_make_no_sense_are_left_out(given, magnitude, distance):
    assert statements.origin("a", "b", given, given) == Origin("a", "b", magnitude, distance)


def test_a_name_of_any_length_is_cut():
    assert len(statements.name("ab " * 400) or "") <= statements.MAX_NAME_CHARACTERS


@pytest.mark.parametrize(
    ("name", "channel", "expected"),
    [
        ("Rinaldi228.AT2", None, ("Northridge-01", "Rinaldi Receiving Sta", None, None)),
        ("formats/0111a.smc", None, ("Loma Prieta, CA 1989-10-18 00:04", "San Francisco, 1295 Shafter, F", 7.1, 89.0)),
        ("formats/AOM0011801241951.EW", None, ("2018/01/24 19:51:00", "AOM001", 6.2, None)),
        ("formats/20180212_211557_WPWS_20.V2A", "2", ("2018 February 12 21:15:54 UT", "WPWS", 4.17, 13.0)),
        (
            "formats/ce36456p_CE36456.V2",
            "3",
            ("COALINGA EARTHQUAKE MAY 2, 1983 16:42 PDT", "PARKFIELD FAULT ZONE 14", 6.5, None),
        ),
        ("formats/017m30lw.s0a", None, ("NORTHRIDGE EARTHQUAKE JAN 17, 1994 -1230 GMT", "USC# 0016", None, None)),
    ],
)
def test_real_records(name, channel, expected):
    assert read_record(record(name), channel=channel).origin == Origin(*expected)


def test_the_command_shows_what_is_known(tmp_path):
    (tmp_path / "a.AT2").write_text(PEER.format("Made Up-01, 1/17/1994, Some Sta, 228"))
    (tmp_path / "b.csv").write_text("t [s],a [g]\n0,0\n0.01,0.1\n0.02,0\n")
    told = run("record", "a.AT2").stdout
    assert all(word in told for word in ("earthquake", "Made Up-01", "Some Sta"))
    assert "magnitude" not in told  # nothing is known of it
    assert "earthquake" not in run("record", "b.csv").stdout
    origin = run_json("record", "a.AT2")["origin"]
    assert origin == {"event": "Made Up-01", "station": "Some Sta", "magnitude": None, "distance": None}
