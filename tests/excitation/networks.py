"""Small files of networks that print components side by side, and of GeoNet V1A, with values known by construction."""

import numpy as np

from tests.excitation.test_record_formats import VALUES, columns

COMPONENTS = 1.0, -2.0, 0.5  # what each of the components is of the values


def side_by_side(values) -> np.ndarray:
    return np.outer(values, COMPONENTS)


def jma(values=VALUES, unit="gal(cm/s/s)", rate="100Hz", names="NS,EW,UD") -> str:
    rows = "".join(",".join(f"{each:.3f}" for each in row) + "\n" for row in side_by_side(values))
    return (
        f"SITE CODE= ABC\x94T    ,35.0,135.0,  9,7.3\n LAT.=   35.0000\n LON.=  135.0000\n SAMPLING RATE= {rate} \n"
        f" UNIT  = {unit} \nINITIAL TIME = 2000 01 02 13 30 10\n {names}\n{rows}"
    )


def cwa(
    values=VALUES, count=None, unit="gal. DCoffset(corr)", rate="100", dt=0.01, sequence="Time U(+); N(+); E(+)"
) -> str:
    table = side_by_side(values)
    out = "#Earthquake Information\n#StationCode: XYZ\n#InstrumentKind: A900\n"
    out += (
        f"#RecordLength(sec):   {0.01 * (count or len(values)):.3f}\n#SampleRate(Hz): {rate}\n#AmplitudeUnit:  {unit}\n"
    )
    for name, column in zip("UNE", table.T, strict=True):
        out += f"#AmplitudeMAX. {name}: {column.max():9.3f}~{column.min():9.3f}\n"
    times = dt * np.arange(len(values))
    return out + f"#DataSequence: {sequence}\n#Data: 4F10.3\n" + columns(np.c_[times, table].ravel(), "10.3f", 4)


def afad(values=VALUES, count=None, unit="gal", dt="0.01", times=1.0) -> str:
    table = side_by_side(values)
    peaks = " ".join(
        f"({name}) {times * peak:.6f}" for name, peak in zip(["N-S", "E-W", "U-D"], abs(table).max(0), strict=True)
    )
    return (
        "STRONG GROUND MOTION RECORDS\nPLACE                   : MADE UP\n"
        "EARTHQUAKE DATE : 17/08/1999 00:01:39.07 (GMT)\n"
        f"STATION ID              : 9999\nNUMBER OF DATA          : {count or len(values)}\n"
        f"SAMPLING INTERVAL (sec) : {dt}\nRAW PGA VALUES ({unit})    : {peaks}\nDATA OWNER\n"
        "       N-S          E-W          U-D\n" + columns(table.ravel(), "12.6f", 3)
    )


def asa(values=VALUES, count=None, unit="cm/s/s (Gal)", dt="0.01", six="C1-C6") -> str:
    table, count = side_by_side(values), count or len(values)
    peaks = "/".join(f"{peak:.3f}" for peak in abs(table).max(0))
    return (
        "Formato de datos\n1.-INSTITUCION\nARCHIVO ESTANDAR DE ACELERACION   ASA VERSION 2.0\n"
        "NOMBRE DE LA ESTACION                    : MADE UP\nCLAVE DE LA ESTACION                     : ABCD\n"
        f"VEL. DE MUESTREO, {six} (muestras/s)     : /100/100/100/\n"
        f"INTERVALO DE MUESTREO, {six} (s)         : /{dt}/{dt}/{dt}///\n"
        f"ORIENTACION {six} (rumbo;orientacion)    : /N00E;L/V;+/N90W;T///\n"
        "FECHA DEL SISMO [GMT]                    : 1985/09/19\n"
        "HORA EPICENTRO (GMT)                     : 13:17:42.0\n"
        "MAGNITUD(ES)                             : /Ms=8.1/Mw=8.0\n"
        f"NUM. TOTAL DE MUESTRAS, {six}            : /{count}/{count}/{count}///\n"
        f"ACEL. MAX.(Gal), {six}                   : /{peaks}///\n"
        f"UNIDADES DE LOS DATOS                    : {unit}\n"
        "DATOS DE ACELERACION:\n   CANAL-1   CANAL-2   CANAL-3\n    N00E       V       N90W\n"
        "---------+---------+---------\n" + columns(table.ravel(), "10.3f", 3)
    )


def geonet_v1a(values=VALUES, count=None, step="1.00", lost=0, sizes=True, names=("N10E", "Up")) -> str:
    """`lost` values before and after the others are missing."""
    count = count or len(values) + 2 * lost
    stated = count if sizes else 0
    out = ""
    for factor, name in enumerate(names, start=1):
        out += "Uncorrected accelerogram 20200101_000000_ABCD_20 Centre\nSite ABCD      42 31 24S\n" + "x\n" * 5
        out += (
            "2020 January 01         11:02:56 UT\nEpicentre  42 41 33S 173 01 19E  Dist   25km  Depth   15km M 5.82\n"
        )
        out += f"Number of points {count:6d}    Duration {0.01 * count:.2f} s\n"
        out += (
            f"Raw readings in units of {step} mm/s/s  at intervals of 0.010 s\nData is unfiltered\nComponent {name}\n"
        )
        peak = factor * float(step) * np.abs(values).max()
        out += f"Acceleration:  Peak {peak:8.1f} mm/s/s at  2.00 s     RMS   20.89 mm/s/s\n"
        out += "Velocity record unevaluated\nDisplacement record unevaluated\n"
        out += (
            columns([0] * 30, "8d", 10)
            + f"{stated:8d}       0       0{stated:8d}       0       0       0       0      13   25845\n"
        )
        out += columns([0.0] * 60, "8.1f", 10)
        out += columns([*[999999.9] * lost, *factor * values, *[999999.9] * lost], "8.1f", 10)
    return out


MADE = {"afad": afad, "asa": asa, "cwa": cwa, "jma": jma}
