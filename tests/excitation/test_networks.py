"""Networks that print components side by side, and GeoNet V1A: small made files, as they should be and spoilt."""

import os
import re
import subprocess
import sys

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.excitation.records import formats
from tests.conftest import PROJECT
from tests.excitation import networks
from tests.excitation.networks import COMPONENTS, MADE, afad, asa, cwa, geonet_v1a, jma
from tests.excitation.test_record_formats import VALUES, claims, columns, problem

NAMES = {
    "afad": ("N-S", "E-W", "U-D"),
    "asa": ("N00E;L", "V;+", "N90W;T"),
    "cwa": ("U", "N", "E"),
    "jma": ("NS", "EW", "UD"),
}


@pytest.mark.parametrize("name", MADE)
def test_each_component_is_read_by_its_name(name, write):
    content = MADE[name]()
    assert claims(content) == [name]
    path = write(content)
    listed = problem(path).hint
    for place, (component, times) in enumerate(zip(NAMES[name], COMPONENTS, strict=True), start=1):
        assert f"{place}: {component}, {len(VALUES)} points" in listed
        motion = read_record(path, channel=component)
        np.testing.assert_allclose(motion.acceleration, times * VALUES / 100, rtol=1e-12)
        assert (motion.dt, motion.format, motion.remarks) == (0.01, getattr(formats, name).TITLE, ())
        assert motion.name == f"record.txt channel {component}"


@pytest.mark.parametrize("name", MADE)
def test_what_the_header_states_is_not_contradicted(name, write):
    path = write(MADE[name]())
    assert "`dt` says 0.02 s" in problem(path, channel="1", dt=0.02).message
    assert re.search("the unit is (gal|cm/s2), but `units` says g", problem(path, channel="1", units="g").message)
    assert read_record(path, channel="1", dt=0.01, units="cm/s2").npts == len(VALUES)


@pytest.mark.parametrize("name", MADE)
def test_a_row_that_lost_a_number_is_refused(name, write):
    rows = MADE[name]().rstrip("\n").split("\n")
    rows[-3] = rows[-3][: rows[-3].rstrip().rindex("," if name == "jma" else " ")]
    found = problem(write("\n".join(rows)), channel="1")
    assert "numbers, but the header names" in found.message and found.line == len(rows) - 2


@pytest.mark.parametrize("name", ["afad", "asa", "cwa"])
def test_a_file_that_was_cut_is_refused_with_both_counts(name, write):
    content = MADE[name]()
    cut = content[: content.rstrip("\n").rindex("\n") - 60]
    cut = cut[: cut.rindex("\n") + 1]
    found = problem(write(cut), channel="1")
    assert re.search(r"says 11 values, but \d follow|states a length of 0.11 s, its samples make 0.0\d", found.message)
    assert found.line is not None


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        (cwa(dt=0.02), "the times of the rows are not 0.01 s apart"),
        (cwa(unit="volt"), "'volt', which is not a known unit of acceleration"),
        (cwa(sequence="Time U(+); N(+)"), "this row has 4 numbers, but the header names 3 columns"),
        (cwa(rate="0"), "must be more than 0"),
        (asa(dt="-.01"), "must be more than 0"),
        (asa().replace("/0.01/0.01/0.01", "/0.01/0.02/0.01"), "the channels have several sample intervals: 0.01, 0.02"),
        (asa(unit="cuentas"), "'cuentas', which is not a known unit"),
        (jma(rate="slow"), "does not state the sampling rate"),
        (jma(names=""), "does not state the components"),
        (jma(unit="kine"), "'kine', which is not a known unit"),
        (jma([1.0]), "at least two samples"),
        (jma().replace("-4.500", "oops"), "'oops' is not a number"),
        (jma().replace("-4.500", "-4.5-00"), "this row has 4 numbers"),
    ],
)
def test_what_is_wrong_is_said(content, fragment, write):
    assert fragment in problem(write(content), channel="1").message


def test_peaks_of_the_header_are_compared_with_the_values(write):
    (doubt,) = read_record(
        write(cwa().replace("-7.000\n", "-9.000\n", 1).replace("10.000~", "99.000~", 1)), channel="1"
    ).remarks
    assert (doubt.kind, doubt.value) == ("header_peak", 10.0) and "states a peak of 99 gal" in doubt.text
    path = write(asa().replace("/10.000/", "/11.000/"))
    (doubt,) = read_record(path, channel="1").remarks
    assert "a peak of 11 " in doubt.text


def test_the_unit_of_afad_is_that_of_peaks_which_the_values_have(write):
    assert read_record(write(afad(unit="gal")), channel="E-W").pga_g == pytest.approx(20 / 980.665)
    path = write(afad(times=1.5))  # the peaks are of another processing
    found = problem(path, channel="E-W")
    assert "does not say what unit" in found.message and "`units`" in found.hint
    motion = read_record(path, channel="E-W", units="mm/s2")
    assert motion.pga_g == pytest.approx(20 / 9806.65) and motion.remarks[0].kind == "header_peak"


def test_more_than_six_channels_have_a_second_line_each(write):
    content = asa()
    more = "".join(
        f"{line.replace('C1-C6', 'C7-C12').replace('N00E', 'ROOF')}\n"
        for line in content.split("\n")
        if "C1-C6" in line
    )
    header, _, _ = content.replace("FECHA", more + "FECHA", 1).partition("---------+")
    table = networks.side_by_side(VALUES)
    path = write(header + "---------+---------\n" + columns(np.c_[table, 3 * table].ravel(), "10.3f", 6))
    np.testing.assert_allclose(read_record(path, channel="ROOF;L").acceleration, 3 * VALUES / 100, rtol=1e-12)


# --- GeoNet V1A -----------------------------------------------------------------------------------------------------


def test_raw_accelerations_of_geonet(write):
    for step, sizes in (("1.00", True), ("0.50", False)):
        path = write(geonet_v1a(step=step, sizes=sizes))
        assert claims(path.read_text()) == ["geonet_v1a"]
        motion = read_record(path, channel="Up")
        np.testing.assert_allclose(motion.acceleration, float(step) * np.round(2 * VALUES, 1) / 1000, atol=1e-12)
        assert (motion.dt, motion.format, motion.source_unit) == (0.01, "GeoNet V1A", "mm/s2")


def test_values_missing_before_and_after_a_record_are_left_out_and_said(write):
    motion = read_record(write(geonet_v1a(lost=3)), channel="1")
    np.testing.assert_allclose(motion.acceleration, np.round(VALUES, 1) / 1000, atol=1e-4)
    assert motion.npts == len(VALUES)
    (doubt,) = [each for each in motion.remarks if each.kind == "count"]
    assert "begins with 3 missing values and ends with 3" in doubt.text
    gap = geonet_v1a(names=("Up",)).replace("    -4.5", "999999.9")
    assert "missing within the component" in problem(write(gap)).message


# --- the reader that fits -------------------------------------------------------------------------------------------


READ = """
import sys
from rocking_cli import read_record
from rocking_cli.excitation.records import formats
known = [each for each in vars(formats).values() if isinstance(each, formats.Format)]
modules = {each.module.partition('.')[0] for each in known}
for place, channel in (("text", None), ("jma", "1")):
    read_record(place, channel=channel)
    print(sorted(each for each in modules if formats.__package__ + '.' + each in sys.modules), 'obspy' in sys.modules)
"""


def test_reading_a_file_imports_the_reader_of_no_other_format(tmp_path):
    from tests.readers import samples

    for name in ("text", "jma"):
        (tmp_path / name).write_bytes(samples()[name].content)
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    done = subprocess.run([sys.executable, "-c", READ], capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.stdout == f"[] False\n{[formats.jma.module]} False\n", done.stderr


def test_the_made_files_are_in_the_check_of_the_installation():
    from rocking_cli.questions.selfcheck import checks

    assert set(networks.MADE) <= set(checks.EXPECTED["records"])
