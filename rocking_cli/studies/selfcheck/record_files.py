"""A small file of each record format, written from the description of the format alone, all with the same samples."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.json_text import json_text

_HALF = [0.25 * ((37 * k) % 79 - 39) for k in range(100)]
SAMPLES = [*_HALF, *(-each for each in _HALF)]
"""Samples that every format can hold exactly. Their mean is zero, as K-NET has its zero there."""
DT = 0.01
"""Sampling interval [s]."""
COUNT = len(SAMPLES)


class RecordFile(NamedTuple):
    """A file of a record format.

    Parameters
    ----------
    title : str
        Name of the format in messages and results.
    unit : float
        Unit of the samples in the file [m/s2].
    content : callable
        Returns the content of the file.
    options : dict
        Arguments with which the file is read, for what the format does not state.
    """

    title: str
    unit: float
    content: Callable[[], str | bytes]
    options: dict[str, Any] = {}  # noqa: RUF012 - it does not change


def _columns(cells: Iterable[str], to_a_line: int, margin: str = "") -> str:
    """Return cells in lines, as Fortran writes columns of fixed width."""
    cells = list(cells)
    lines = (cells[k : k + to_a_line] for k in range(0, len(cells), to_a_line))
    return "".join(f"{margin}{''.join(line)}\n" for line in lines)


def _numbers(values: Sequence[float], form: str, to_a_line: int) -> str:
    return _columns((format(value, form) for value in values), to_a_line)


def _text() -> str:
    rows = (f"{DT * k:.2f},{value}\n" for k, value in enumerate(SAMPLES))
    return "time [s],acceleration [m/s2]\n" + "".join(rows)


def _peer() -> str:
    head = "PEER NGA STRONG MOTION DATABASE RECORD\nMade up, 1/1/2000, Nowhere, 90\n"
    head += f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {COUNT}, DT=   {DT:.4f} SEC\n"
    return head + _numbers(SAMPLES, "15.7E", 5)


def _simcenter() -> str:
    return json_text({"info": "units of g", "numPoints": COUNT, "dT": DT, "accel_data": SAMPLES})


def _esm() -> str:
    head = {"EVENT_NAME": "MADE UP", "SAMPLING_INTERVAL_S": f"{DT:.6f}", "NDATA": COUNT, "STREAM": "HNE"}
    head |= {"UNITS": "cm/s^2", "DATA_TYPE": "ACCELERATION"}
    return "".join(f"{key}: {value}\n" for key, value in head.items()) + _numbers(SAMPLES, ".6f", 1)


def _geonet() -> str:
    return (
        "Corrected accelerogram made up\nSite\n" + "x\n" * 7
        + f"Number of points {COUNT:5d}    Duration {DT * (COUNT - 1):.2f} sec\n"
        + f"Instrument corrected data at {DT:.3f} sec intervals\nx\nComponent S16W  Axis\n"
        + f"Acceleration:  peak {max(SAMPLES):8.2f} mm/s/s at  0.00 sec     rms      2.2 mm/s/s\n"
        + "Velocity:      peak     1.65 mm/s   at  0.00 sec\nDisplacement:  peak    0.131 mm\n"
        + _numbers([0] * 30, "8d", 10) + f"   21200     250     250{COUNT:8d}       0       0       0\n"
        + _numbers([0.0] * 60, "8.1f", 10) + _numbers(SAMPLES, "8.2f", 10)
    )  # fmt: skip


def _csmip() -> str:
    return (
        "CORRECTED ACCELEROGRAM   36456-S4384       CHAN  1: 90 DEG    FROM\n"
        + "UNCORRECTED ACCELEROGRAM DATA\nMADE UP EARTHQUAKE\nCHAN  1: 90 DEG\n"
        + _numbers([0] * 20, "5d", 16) + _numbers([0.0] * 20, "10.3f", 8)
        + f" {COUNT} POINTS OF ACCEL DATA EQUALLY SPACED AT  {DT:.3f} SEC.  (UNITS: CM/SEC/SEC)\n"
        + _numbers(SAMPLES, "10.3f", 8) + "/&  ----------  END OF DATA FOR CHANNEL 1  ----------\n"
    )  # fmt: skip


def _csmip_v1() -> str:
    return (
        "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 01/01/00, MADE UP\n9400101\n" + "x\n" * 4
        + "CHAN  1: 90 DEG              (STA CHN:  1)\n" + "x\n" * 3
        + f"NO. OF POINTS =  {COUNT}  RECORD LENGTH = {DT * (COUNT - 1):.3f} SEC\n"
        + "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  -.975 G, AT  0.000 SEC.\nRMS OF RECORD\n"
        + _numbers([-999] * 100, "5d", 16) + _numbers([-999.0] * 50, "10.5f", 8) + _numbers(_pairs(), "7.3f", 10)
        + "/&  ----------  END OF DATA FOR CHANNEL  1  ----------\n"
    )  # fmt: skip


def _usc() -> str:
    return (
        "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:\nMADE UP EARTHQUAKE\nCOMP N90E             9\n"
        + f"NO. OF POINTS =   {COUNT}      DURATION = {DT * (COUNT - 1):7.3f} SEC       50\n"
        + "UNITS ARE SEC AND G/10                    22\n"
        + _numbers([0] * 100, "5d", 16) + _numbers([0.0] * 50, "10.3f", 8)
        + _columns((f"{value:7.3f}" for value in _pairs()), 10, margin=" ")
    )  # fmt: skip


def _pairs() -> list[float]:
    """Return each sample after its time, as films were digitised."""
    return [number for k, value in enumerate(SAMPLES) for number in (DT * k, value)]


def _smc() -> str:
    whole, real = [-32768] * 48, [1.7e38] * 50
    whole[15], whole[16], real[1] = 1, COUNT, 1 / DT  # lines of comment, points, samples a second
    cells = (f"{value:10.4E}".replace("E+0", "E+").replace("E-0", "E-").rjust(10) for value in SAMPLES)
    return (
        f"{'2 CORRECTED ACCELEROGRAM':80}\n*\nMADE UP\ncomponent=    360\n" + "*\n" * 7
        + _numbers(whole, "10d", 8) + _numbers(real, "15.7E", 5) + "| comment\n" + _columns(cells, 8)
    )  # fmt: skip


def _cosmos() -> str:
    real = [-999.0] * 100
    real[33], real[61] = 0.5, 1000 * DT
    return (
        "Corrected acceleration    (Format v01.20 with 13 text lines) Src: made up\n" + "x\n" * 7
        + "Sta Cha:  1: 340 deg (Rcrdr Chan  1) Location: nowhere\n" + "x\n" * 4
        + " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" + _numbers([-999] * 100, "8d", 10)
        + " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n" + _numbers(real, "13.6f", 6)
        + '  1 Comment line(s) follow, each starting with a "|":\n| made up\n'
        + f"   {COUNT}  acceleration pts, approx   2 secs, units=cm/sec2(04),Format=(8F10.5)\n"
        + _numbers(SAMPLES, "10.5f", 8) + "/&  ------  End of data for channel  1  ------\n"
    )  # fmt: skip


def _knet() -> str:
    head = {
        "Origin Time": "2000/01/01 00:00:00", "Lat.": 41.0, "Long.": 142.5, "Depth. (km)": 30, "Mag.": 6.2,
        "Station Code": "MADE", "Station Lat.": 41, "Station Long.": 142, "Station Height(m)": 39,
        "Record Time": "2000/01/01 00:00:00", "Sampling Freq(Hz)": f"{1 / DT:.0f}Hz",
        "Duration Time(s)": f"{DT * COUNT:.0f}", "Dir.": "E-W", "Scale Factor": "2000(gal)/1000000",
        "Max. Acc. (gal)": f"{max(SAMPLES):.3f}", "Last Correction": "2000/01/01 00:00:00", "Memo.": "",
    }  # fmt: skip
    counts = (f"{round(500 * value) - 12000:8d} " for value in SAMPLES)  # 0.002 gal each, from a zero of their own
    return "".join(f"{key:<18}{value}\n" for key, value in head.items()) + _columns(counts, 8)


def _sac() -> bytes:
    unset = -12345
    real, whole, texts = [float(unset)] * 70, [unset] * 40, [b"-12345  "] * 24
    real[0], real[1], real[2], real[5], real[6] = DT, min(SAMPLES), max(SAMPLES), 0.0, DT * (COUNT - 1)
    whole[:6] = 2000, 1, 0, 0, 0, 0  # year, day of the year, and time
    whole[6], whole[9], whole[15], whole[16] = 6, COUNT, 1, 8  # version, points, a time series, of acceleration
    whole[35:] = 1, 0, 1, 0, 0  # evenly spaced
    texts[20] = b"HNE     "
    return struct.pack("<70f40i", *real, *whole) + b"".join(texts) + struct.pack(f"<{COUNT}f", *SAMPLES)


def _miniseed() -> bytes:
    rate, start, length = round(1 / DT), 64, 1024  # samples a second; where they begin, and bytes of the record
    head = struct.pack(">6s2s5s2s3s2s", b"000001", b"D ", b"MADE ", b"  ", b"HNE", b"XX")
    head += struct.pack(">HHBBBBH", 2000, 1, 0, 0, 0, 0, 0)  # year, day of the year, and time
    head += struct.pack(">HhhBBBBiHH", COUNT, rate, 1, 0, 0, 0, 1, 0, start, 48)
    head += struct.pack(">HHBBBB", 1000, 0, 4, 1, length.bit_length() - 1, 0)  # numbers of 32 bits, big end first
    return (head.ljust(start, b"\0") + struct.pack(f">{COUNT}f", *SAMPLES)).ljust(length, b"\0")


FILES = {
    "cosmos": RecordFile("COSMOS", 0.01, _cosmos),
    "csmip_v1": RecordFile("CSMIP V1", STANDARD_GRAVITY / 10, _csmip_v1),
    "csmip_v2": RecordFile("CSMIP V2", 0.01, _csmip),
    "esm": RecordFile("ESM ASCII", 0.01, _esm),
    "geonet_v2a": RecordFile("GeoNet V2A", 0.001, _geonet),
    "knet": RecordFile("K-NET/KiK-net", 0.01, _knet),
    "peer_at2": RecordFile("PEER AT2", STANDARD_GRAVITY, _peer),
    "simcenter": RecordFile("SimCenter JSON", STANDARD_GRAVITY, _simcenter),
    "smc": RecordFile("USGS SMC", 0.01, _smc),
    "text": RecordFile("text", 1.0, _text),
    "usc_v1": RecordFile("USC V1", STANDARD_GRAVITY / 10, _usc),
}
"""A file of each format that this package reads, by the name of its reader."""

OBSPY_FILES = {
    "miniseed": RecordFile("miniSEED", 0.01, _miniseed, {"units": "cm/s2"}),
    "sac": RecordFile("SAC", 0.01, _sac, {"units": "cm/s2"}),
}
"""The same for the formats that are read by obspy."""
