"""Check of the record readers: the samples of a small file of each format against those written to it."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from math import isclose
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking_cli.errors import RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import read_record
from rocking_cli.studies.selfcheck.check import NotRun
from rocking_cli.studies.selfcheck.comparing import largest_difference
from rocking_cli.studies.selfcheck.record_files import DT, FILES, OBSPY_FILES, SAMPLES, RecordFile


def deviation(quick: bool) -> float:
    """Return the largest deviation of a sample, over the largest sample; quick or not, all formats are read."""
    return _deviation(FILES)


def deviation_by_obspy(quick: bool) -> float:
    """Return the same as `deviation` for formats that obspy reads. Raises `NotRun` if it is not installed."""
    if find_spec("obspy") is None:
        raise NotRun("obspy, which reads SAC and miniSEED, is not installed: pip install 'rocking-cli[seismo]'")
    return _deviation(OBSPY_FILES)


def _deviation(files: Mapping[str, RecordFile]) -> float:
    """Raises `RockingError`, with all formats that are not read, or not as themselves."""
    found, wrong = 0.0, []
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        for name, file in files.items():
            try:
                motion = _read(Path(folder) / name, file)
            except RockingError as error:
                wrong.append(f"{name}: {str(error).splitlines()[0]}")
                continue
            if motion.format != file.title or not isclose(motion.dt, DT, rel_tol=1e-6):
                wrong.append(f"{name}: read as {motion.format} with an interval of {motion.dt:g} s")
            found = max(found, largest_difference(motion.acceleration / file.unit, SAMPLES) / max(SAMPLES))
    if wrong:
        raise RockingError("; ".join(wrong))
    return found


def _read(path: Path, file: RecordFile) -> GroundMotion:
    content = file.content()
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return read_record(path, **file.options)
