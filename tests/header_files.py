"""Small text files as networks and programs write them, made here: each with how it is read, and what is right."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from datetime import datetime, timedelta

import numpy as np

DT, COUNT = 0.01, 160
TIME = DT * np.arange(COUNT)
ENVELOPE = np.sin(np.pi * np.arange(COUNT) / COUNT) ** 2
NORTH = np.round(22.37 * ENVELOPE * np.sin(13.0 * TIME + 0.3), 5)
EAST = np.round(29.73 * ENVELOPE * np.cos(10.0 * TIME), 5)
UP = np.round(10.93 * ENVELOPE * np.sin(21.0 * TIME), 5)
GAL = 0.01  # m/s2
COMPONENTS = {"N": NORTH, "E": EAST, "U": UP}  # gal


def peak(component: str) -> float:
    return float(np.abs(COMPONENTS[component]).max())


@dataclass(frozen=True)
class TextFile:
    """A file: its text, what the user knows of it, the column of each channel, and what the header states."""

    text: str
    channels: dict[str | None, str] = field(default_factory=lambda: {None: "N"})
    unit: str | None = None  # that the user gives
    dt: float | None = None  # that the user gives
    factor: float = 1.0  # of the values, in gal
    run_on: bool = False
    states_count: bool = False


def rows(*columns, form: str = "{:.5f}", between: str = " ") -> str:
    return "".join(between.join(form.format(each) for each in row) + "\n" for row in zip(*columns, strict=True))


def running(values, per_line: int, form: str = "{:14.7E}") -> str:
    cells = [form.format(each) for each in values]
    return "".join("".join(cells[k : k + per_line]) + "\n" for k in range(0, len(cells), per_line))


def stamps(form: str, cut: int) -> list[str]:
    start = datetime(2020, 1, 1, 23, 59, 59)
    return [(start + timedelta(seconds=round(t, 6))).strftime(form)[:cut] for t in TIME]


THREE = {"NS": "N", "EW": "E", "UD": "U"}
IN_M = GAL * NORTH
IN_G = NORTH / 980.665

FILES = {
    "jma": TextFile(
        "SITE CODE= XYZ     ,35.0,135.0,  9,7.3,36805.5,  3.62,  6.15\n LAT.=   35.0000\n SAMPLING RATE= 100Hz \n"
        " UNIT  = gal(cm/s/s) \nINITIAL TIME = 2000 01 02 13 30 10\n NS,EW,UD\n"
        + rows(NORTH, EAST, UP, between=","), THREE),
    "afad": TextFile(
        "STRONG GROUND MOTION RECORDS\nPLACE                   : X\nNUMBER OF DATA          : 160\n"
        f"SAMPLING INTERVAL (sec) : 0.01\nRAW PGA VALUES (gal)    : (N-S) {peak('N'):.6f} (E-W) {peak('E'):.6f} "
        f"(U-D) {peak('U'):.6f}\nDATA OWNER\n       N-S          E-W          U-D\n"
        + rows(NORTH, EAST, UP, form="{:12.6f}"), {"N-S": "N", "E-W": "E", "U-D": "U"}, "gal", states_count=True),
    "cwa": TextFile(
        "#StationCode: XYZ\n#RecordLength(sec): 1.6\n#SampleRate(Hz): 100\n#AmplitudeUnit:  gal. DCoffset(corr)\n"
        + "".join(f"#AmplitudeMAX. {c}: {max(COMPONENTS[c]):8.3f}~ {min(COMPONENTS[c]):8.3f}\n" for c in "UNE")
        + "#DataSequence: Time U(+); N(+); E(+)\n#Data: 4F10.3 \n" + rows(TIME, UP, NORTH, EAST, form="{:9.3f}"),
        {"U": "U", "N": "N", "E": "E"}),
    "components with peaks": TextFile(
        f"Number of data: 160\nTime step: 0.01\nPGA VALUES (gal) : (N-S) {peak('N'):.6f} (E-W) {peak('E'):.6f} "
        f"(U-D) {peak('U'):.6f}\n       N-S          E-W          U-D\n"
        + rows(NORTH, EAST, UP, form="{:12.6f}"), {"N-S": "N", "E-W": "E", "U-D": "U"}, "gal", states_count=True),
    "sequence": TextFile(
        "#Rate of samples: 100 sps\n#Amplitude unit: gal\n"
        + "".join(f"#AmplitudeMAX. {c}: {max(COMPONENTS[c]):8.3f}~ {min(COMPONENTS[c]):8.3f}\n" for c in "UNE")
        + "#Sequence: Time U(+); N(+); E(+)\n#Data: 4F10.3 \n" + rows(TIME, UP, NORTH, EAST, form="{:9.3f}"),
        {"U": "U", "N": "N", "E": "E"}),
    "tab separated running on": TextFile(
        "made up, 160 samples, 100 sps, 2020-01-01T00:00:00.000000, FLOAT, M/S**2\n"
        + "".join("\t".join(f"{x:+.9e}" for x in IN_M[k : k + 6]) + "\n" for k in range(0, COUNT, 6)), run_on=True,
        states_count=True),
    "dt in the header": TextFile("dt=0.01\nacc: m/s2\n" + rows(IN_M, form="{:.8f}")),
    "counted table": TextFile(
        "# NPTS 160\n# points: 160\nTime [s],Acceleration [m/s2]\n" + rows(TIME, IN_M, form="{:.7f}", between=","),
        states_count=True),
    "deepsoil": TextFile(" 160  0.01\n" + rows(TIME, IN_G, form="{:14.6E}"), unit="g", states_count=True),
    "eqsig": TextFile("made up\n160 0.0100\n" + rows(IN_G, form="{:.8f}"), unit="g", states_count=True),
    "shake": TextFile(
        "".join(line + f"{k:8d}\n" for k, line in enumerate(running(IN_G, 8, "{:9.6f}").splitlines(), 1)),
        unit="g", dt=DT, run_on=True),
    "eera": TextFile("EERA made up\nTime step = 0.01 s\n" + running(IN_G, 8, " {:9.6f}"), unit="g", run_on=True),
    "opensees": TextFile(running(IN_G, 5, "{:16.7E}"), unit="g", dt=DT, run_on=True),
    "peer without header": TextFile(running(IN_G[:158], 5, "{:15.6E}"), unit="g", dt=DT, run_on=True),
    "glued": TextFile(
        "Acceleration in g, 5E14.7\nsamples: 160\nDT = 0.01 sec\n" + running(IN_G, 5, "{:14.7E}"), run_on=True,
        states_count=True),
    "slist": TextFile(
        "TIMESERIES XX_ABC__HNN_D, 160 samples, 100 sps, 2020-01-01T00:00:00.000000, SLIST, FLOAT, M/S**2\n"
        + "".join("\t".join(f"{x:+.9e}" for x in IN_M[k : k + 6]) + "\n" for k in range(0, COUNT, 6)), run_on=True,
        states_count=True),
    "iso times": TextFile(
        "time,acc (m/s2)\n"
        + "".join(f"{t}Z,{a:.7f}\n" for t, a in zip(stamps("%Y-%m-%dT%H:%M:%S.%f", 26), IN_M, strict=True))),
    "times of day": TextFile(
        "clock acc[m/s2]\n" + "".join(f"10:{t} {a:.7f}\n" for t, a in zip(stamps("00:%S.%f", 9), IN_M, strict=True))
        .replace("10:00:59", "09:59:59")),
    "two components": TextFile(rows(NORTH, EAST), {"1": "N", "2": "E"}, "gal", DT),
    "three components": TextFile(rows(NORTH, EAST, UP, between=" , "), {"1": "N", "2": "E", "3": "U"}, "gal", DT),
    "decimal commas": TextFile("passo temporale [s]: 0,01\naccelerazione [cm/s2]\n" + rows(NORTH).replace(".", ",")),
    "ran": TextFile(
        "Stazione: XYZ\nUnità di misura: cm/s^2\nNumero di punti: 160\nPasso di campionamento (s): 0,01\n"
        f"Accelerazione massima (cm/s^2): {peak('N'):.3f}\n" + rows(NORTH), states_count=True),
    "unam": TextFile(
        "Estación: XYZ\nFrecuencia de muestreo: 100 Hz\nNúmero de muestras: 160\nUnidades: gal\n"
        + "   NORTE-SUR   VERTICAL   ESTE-OESTE\n" + rows(NORTH, UP, EAST, form="{:12.5f}"),
        {"norte-sur": "N", "vertical": "U", "este-oeste": "E"}, states_count=True),
    "turkish": TextFile(
        "İSTASYON: XYZ\nÖrnekleme Aralığı (sn): 0.01\nVeri Sayısı : 160\nBirim : cm/s2\n"
        f"En büyük ivme (cm/s2): {peak('N'):.3f}\n   K-G   D-B   Düşey\n" + rows(NORTH, EAST, UP),
        {"K-G": "N", "D-B": "E", "düşey": "U"}, states_count=True),
    "romaji": TextFile(
        "Sanpuringu shuhasu: 100 Hz\nDeta su: 480\nTan'i: gal\nNanboku;Tozai;Joge\n"
        + rows(NORTH, EAST, UP, between=";"), {"nanboku": "N", "tozai": "E", "joge": "U"}, states_count=True),
    "numbered rows": TextFile(
        "Sampling interval: 10 ms\nNo NS(gal) EW(gal)\n"
        + "".join(f"{k} {n:.5f} {e:.5f}\n" for k, (n, e) in enumerate(zip(NORTH, EAST, strict=True), 1)),
        {"NS": "N", "EW": "E"}),
    "points at": TextFile(
        f"Some hall, component N10E\n# 160 points at 0.010 sec\n# PGA: {peak('N') / 980.665:.4f} g\nunits: g\n"
        + rows(IN_G, form="{:.8f}"), states_count=True),
}  # fmt: skip

OTHER_READERS = ("jma", "afad", "cwa", "slist")
"""Files that are read by readers of their own."""


def of_values(values: np.ndarray, component: str) -> bool:
    """Whether accelerations [m/s2] are those of a component, as far as they are printed."""
    right = GAL * COMPONENTS[component][: values.size]
    return values.size >= COUNT - 2 and bool(np.allclose(values, right, rtol=0, atol=1.2e-5))


# --- spoilt headers -------------------------------------------------------------------------------------------------

CLAIMS = {
    "rate": [
        "SAMPLING RATE= 100Hz", "Sampling interval (s): 0.01", "dt = 0.01", "#SampleRate(Hz): 100",
        "Passo di campionamento: 0,010 s", "Frecuencia de muestreo: 100 Hz", "Örnekleme Aralığı: 0.01 sn",
        "sanpuringu kankaku: 10 ms", "# 100 samples per second",
    ],
    "count": [
        "NPTS 160", "NUMBER OF DATA : 160", "# points: 160", "Numero di campioni = 160", "No. de datos: 160",
        "Veri sayısı: 160", "deta su: 160", "# 160 samples",
    ],
    "unit": [
        "UNIT = gal(cm/s/s)", "#AmplitudeUnit: gal", "Units: cm/s2", "Unidades: cm/s^2", "Birim: gal", "tan'i: gal",
        "Acceleration in cm/sec/sec",
    ],
    "peak": [
        f"Max. Acc. (gal): NS {peak('N'):.3f} EW {peak('E'):.3f} UD {peak('U'):.3f}",
        f"PGA (gal) : (N-S) {peak('N'):.3f} (E-W) {peak('E'):.3f} (U-D) {peak('U'):.3f}",
    ],
    "nothing": ["Station XYZ", "Full scale: 2 g", "Scale factor 3920(gal)/6182761", "LAT.= 35.0", "RMS 5.2 gal", ""],
}  # fmt: skip
LABELS = ("NS EW UD", "N-S E-W U-D", "north east up", "acc_N acc_E acc_U", "K-G D-B Dusey", "U(+) N(+) E(+)")
ORDERS = dict.fromkeys(LABELS[:5], "NEU") | {LABELS[5]: "UNE"}
CHARACTERS = "0123456789.,:;=()#-+ NSEWUDgalcms/2xZ\t"


@dataclass(frozen=True)
class Spoilt:
    """A file with a spoilt header: its text, the claims of intact lines, the order of its columns, and its shape."""

    text: str
    claims: frozenset[str]
    order: str
    names: tuple[str, ...]
    shape: str


def spoil(line: str, rng: random.Random) -> str:
    place = rng.randrange(len(line) + 1)
    return rng.choice((
        line[:place] + line[place + 1 :],
        line[:place] + rng.choice(CHARACTERS) + line[place:],
        line[:place] + rng.choice(CHARACTERS) + line[place + 1 :],
        line[:place],
        line[place:],
        line[: max(place - 1, 0)] + line[place : place + 1] + line[max(place - 1, 0) : place] + line[place + 1 :],
    ))  # fmt: skip


def spoilt(seed: int) -> Spoilt:
    """Return a file with lines of a header, of which one to three are spoilt, and some rows may be missing."""
    rng = random.Random(seed)
    shape = rng.choice(("table", "table", "table", "one column", "running on"))
    kinds = rng.sample(["rate", "count", "unit", "peak", "rate", "nothing", "nothing"], rng.randint(3, 6))
    if shape != "table":
        kinds = ["nothing" if kind == "peak" else kind for kind in kinds]
    lines = [(rng.choice(CLAIMS[kind]), kind) for kind in kinds]
    labels = rng.choice(LABELS)
    order, timed = ORDERS[labels], rng.random() < 0.4
    mark = rng.choice((" ", ",", ";", "\t", "  "))
    said = mark.join(["time"] * timed + labels.split())
    if shape == "table":
        lines.append((rng.choice(("", "# ")) + said, "labels"))
    whole = [*lines]
    for _ in range(rng.randint(1, 3)):
        place = rng.randrange(len(lines))
        line, kind = lines[place]
        change = rng.random()
        if change < 0.7:
            lines[place] = (spoil(line, rng), kind)
        elif change < 0.8:
            lines.insert(rng.randrange(len(lines)), (spoil(line, rng), kind))
        elif change < 0.9:
            del lines[place]
        else:
            other, _ = rng.choice(whole)
            lines.insert(rng.randrange(len(lines) + 1), (spoil(other, rng), "nothing"))
        if not lines:
            break
    claims = frozenset(kind for line, kind in lines if (line, kind) in whole and kind != "nothing")
    body = rows(*([TIME] * timed), *(COMPONENTS[each] for each in order), between=mark).splitlines()
    if shape != "table":
        body = (rows(NORTH) if shape == "one column" else running(NORTH, 8, " {:9.5f}")).splitlines()
    kept = body if rng.random() < 0.8 else body[: rng.randrange(len(body) // 2, len(body))]
    text = "\n".join([*(line for line, _ in lines), *kept]) + "\n"
    names = tuple(label.replace("(+)", "") for label in labels.split()) if shape == "table" else ()
    return Spoilt(text, claims, order, names, shape)
