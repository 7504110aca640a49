"""The ground motions of a study: their files, checksums and samples."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD, SAMPLING, parse_pulse
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.steps import process
from rocking_cli.questions.fragility.definition import RecordEntry
from rocking_cli.short_repr import short_repr

MAX_SAMPLES_IN_MEMORY = 32_000_000  # samples of all records: a quarter of a gigabyte


@dataclass(frozen=True)
class Source:
    """One ground motion of a study.

    Parameters
    ----------
    name : str
        Name of the motion: the file as the study names it, or the pulse's specification; with the set if it is in one.
    entry : RecordEntry
        The entry of the study file.
    reading : Reading
        How to read and process the record.
    file : str
        The name without the set.
    path, vertical : Path, optional
        The files of the record and of its vertical component.
    motion : GroundMotion, optional
        The motion itself, if it was given in Python.
    """

    name: str
    entry: RecordEntry
    reading: Reading
    file: str
    path: Path | None = None
    vertical: Path | None = None
    motion: GroundMotion | None = None

    @property
    def is_simple(self) -> bool:
        """Whether it is a horizontal motion of the ground, without a vertical component and not on a floor."""
        made = self.motion is not None and (self.motion.vertical is not None or self.motion.ground is not None)
        return self.vertical is None and self.reading.floor is None and not made

    def checksum(self) -> str:
        """Return the SHA-256 of its files, or of its samples, or of the pulse and its sampling.

        Raises `InputError` without a file.
        """
        digest = hashlib.sha256()
        for path in (Path(each) for each in (self.path, self.vertical, self.reading.other) if each is not None):
            try:
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            except OSError as error:
                raise InputError(Problem(f"cannot be read: {error.strerror or error}", str(path))) from None
        if self.motion is not None:
            for each in _parts(self.motion):
                digest.update(f"{each.dt!r} {each.npts} ".encode())
                digest.update(each.acceleration.astype("<f8").tobytes())
        elif self.entry.pulse is not None:
            pulse = parse_pulse(self.entry.pulse).specification
            digest.update(f"{pulse}, {COARSE_POINTS_PER_PERIOD} a period: {SAMPLING}".encode())
        return digest.hexdigest()

    def read(self) -> GroundMotion:
        """Read the motion, unscaled. Raises `InputError` if it cannot be read."""
        if self.motion is not None:
            return self.reading.on_floor(process(self.motion, self.reading.steps))
        if self.entry.pulse is not None:
            return self.reading.on_floor(parse_pulse(self.entry.pulse).sampled(COARSE_POINTS_PER_PERIOD))
        assert self.path is not None
        motion = self.reading.read(self.path)
        if self.vertical is not None:
            motion = replace(motion, vertical=self.reading.vertical(self.vertical))
        return motion


def _parts(motion: GroundMotion) -> list[GroundMotion]:
    """Return a motion with its vertical component and the motion of the ground below, as far as it has them."""
    below = [each for each in (motion.vertical, motion.ground) if each is not None]
    return [motion, *(part for each in below for part in _parts(each))]


@short_repr
@dataclass(frozen=True)
class Record:
    """A ground motion of a study as its store keeps it: checksum, peaks and sampling.

    Parameters
    ----------
    name, checksum : str
        See `Source`; the checksum of a file that cannot be read is empty.
    reason : str or None
        Why the motion cannot be used; None if it can.
    dt : float
        Sampling interval [s]; this and all further fields are 0 if the motion cannot be used.
    npts : int
        Number of samples.
    pga, pgv : float
        Peak acceleration [standard gravity] and peak velocity [m/s].
    doubts : int
        Number of doubts about the motion; `rocking record` lists them.
    """

    name: str
    checksum: str
    reason: str | None = None
    dt: float = 0.0
    npts: int = 0
    pga: float = 0.0
    pgv: float = 0.0
    doubts: int = 0


class KeptMotions:
    """The ground motions of a study, of which the ones used last are kept in memory.

    Parameters
    ----------
    sources : iterable of Source
        The motions.
    """

    def __init__(self, sources: Iterable[Source]) -> None:
        self._sources = list(sources)
        self._checksums: dict[int, str] = {}
        self._kept: OrderedDict[int, GroundMotion] = OrderedDict()
        self._size = 0

    def examine(self, k: int, known: Record | None) -> Record:
        """Return the record of a motion; if it is known and usable, only its checksum is computed again."""
        source = self._sources[k]
        record = replace(known, checksum="") if known is not None and known.reason is None else Record(source.name, "")
        is_measured = record.npts > 0
        try:
            record = replace(record, checksum=source.checksum())
            if not is_measured:
                motion = source.read()
                measured = measure(motion.of_ground)
                if measured.pga_g == 0:
                    raise InputError(f"{source.name}: zero throughout: there is nothing to scale")
                # Only records are checked: a pulse is exactly what its formula gives.
                doubtful = len(doubts(motion.of_ground, measured)) if source.entry.pulse is None else 0
                numbers = (motion.dt, motion.npts, measured.pga_g, measured.pgv, doubtful)
                record = Record(source.name, record.checksum, None, *numbers)
                self._keep(k, motion)
        except InputError as error:
            if not is_measured:
                record = replace(record, reason=str(error).splitlines()[0])
        self._checksums[k] = record.checksum
        return record

    def __getitem__(self, k: int) -> GroundMotion:
        """Return a motion by its index. Raises `InputError` if its file has changed."""
        if k in self._kept:
            self._kept.move_to_end(k)
            return self._kept[k]
        source = self._sources[k]
        if source.checksum() != self._checksums[k]:
            raise InputError(Problem("has changed while the study ran", source.name, hint="start the study again"))
        return self._keep(k, source.read())

    def _keep(self, k: int, motion: GroundMotion) -> GroundMotion:
        self._kept[k] = motion
        self._size += motion.npts
        while self._size > MAX_SAMPLES_IN_MEMORY and len(self._kept) > 1:
            _, dropped = self._kept.popitem(last=False)
            self._size -= dropped.npts
        return motion
