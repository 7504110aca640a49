"""Whatever it is given, it answers or says what is wrong: no traceback, no warning of a library, no hang.

A few hundred inputs in the suite, always the same; `make fuzz INPUTS=100000` tries others for as long as one likes.
"""

import faulthandler
import json
import os
import warnings

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rocking_cli.ask.read import read_record
from rocking_cli.cli.main import main
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError, MechanismError, RockingError
from rocking_cli.excitation.measures import measure
from tests import hostile

pytestmark = pytest.mark.rest

INPUTS = int(os.environ.get("ROCKING_FUZZ", "0"))
PATIENCE = 120.0  # s for one input, where hangs are looked for
EXPANSION = 1000  # samples that a byte of a record may become, and then some


def fuzz(share: float, in_the_suite: int):
    """Return the settings of a test: a few fixed examples in the suite, or a share of all that are requested."""
    return settings(
        max_examples=max(int(share * INPUTS), 1) if INPUTS else in_the_suite,
        derandomize=not INPUTS,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )


@pytest.fixture(scope="module", autouse=True)
def _no_hang():
    """Where the machine's state is not the suite's, a hang ends the run and shows where it was."""
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


def _watch() -> None:
    if INPUTS:
        faulthandler.dump_traceback_later(PATIENCE, exit=True)


@fuzz(0.5, 250)
@given(
    text=hostile.spoilt(hostile.records()),
    encoding=st.sampled_from(["utf-8", "utf-8", "utf-8", "latin-1", "utf-16"]),
    units=st.sampled_from([None, None, "g", "cm/s2", "furlong"]),
    dt=st.sampled_from([None, None, 0.01, 1e-300, 1e300]),
    channel=st.sampled_from([None, None, "1", "2", "-1", "up", ""]),
)
def test_records(text, encoding, units, dt, channel, place):
    _watch()
    path = place / "record"
    path.write_bytes(text.encode(encoding, errors="replace"))
    try:
        motion = read_record(path, units=units, dt=dt, channel=channel)
        measured = measure(motion)
    except InputError as error:
        assert str(error)
        return
    assert np.isfinite(motion.acceleration).all() and 0 < motion.dt < np.inf
    assert motion.npts <= EXPANSION * len(text) + 100_000
    assert np.isfinite([measured.pga_g, measured.pgv]).all()


@fuzz(0.3, 150)
@given(text=hostile.spoilt(hostile.structures()))
def test_structures(text):
    _watch()
    try:
        mechanism = parse_structure(text, "fuzz.yaml", "fuzz")
        block = equivalent_block(mechanism)
        found = [mechanism.coefficients(np.linspace(0, 1, 5) * block[s].phi_cr, s) for s in Direction]
        mechanism.sketch()
    except (InputError, MechanismError) as error:
        assert str(error)
        return
    assert all(np.isfinite(each.I).all() and np.isfinite(each.G).all() for each in found)


@pytest.fixture(scope="module")
def files(place):
    """Structures and motions for the command lines: mostly good ones, some bad, some not there."""

    def write(texts, suffix):
        paths = [place / f"{suffix}{k}.{suffix}" for k in range(len(texts))]
        for path, text in zip(paths, texts, strict=True):
            path.write_text(text, encoding="utf-8")
        return [str(path) for path in paths]

    huge = "mechanism: block\nwidth: 1e5\nheight: 4e5\n"
    tiny = "mechanism: block\nwidth: 1e-5\nheight: 4e-5\n"
    stocky = "mechanism: block\nwidth: 5\nheight: 0.01\n"
    bad = [*write(["", "\0", "a: [", "1 2 3\n4 5\n"], "bad"), "", "missing", str(place)]
    yaml = write([*hostile.structures(), huge, tiny, stocky], "yaml")
    return [*yaml, *yaml, *bad, *write(hostile.studies(), "study")], [*write(hostile.records(), "csv") * 2, *bad]


@fuzz(0.2, 60)
@given(data=st.data())
def test_command_lines(data, files, place):
    _watch()
    words = data.draw(hostile.command_lines(*files, str(place / "out")))
    (place / "out").mkdir(exist_ok=True)
    runner = CliRunner()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = runner.invoke(main, words, env={"COLUMNS": str(data.draw(st.sampled_from([20, 80, 200])))})
    if result.exception is not None and not isinstance(result.exception, SystemExit | RockingError):
        raise AssertionError(f"rocking {words}") from result.exception
    assert result.exit_code in (0, 2, 3, 4, 5), result.output
    assert "Traceback" not in result.output and "Warning:" not in result.output
    if "--json" in words and result.exit_code == 0 and "--help" not in words:
        for line in result.stdout.splitlines():
            json.loads(line, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
