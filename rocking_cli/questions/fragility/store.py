"""The runs of a study as files of a folder: `study.json`, and `runs-000123.npz` for each chunk of runs.

Each file is written whole or not at all, and zip keeps a checksum of every array. Two processes that compute one chunk
write the same, so nothing is locked: whoever comes last replaces a file by an equal one.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.files import folder, refusal, write_whole
from rocking_cli.io.json_text import json_text
from rocking_cli.questions.fragility.plan import Measured, Plan, Trial, described
from rocking_cli.questions.fragility.study import Record
from rocking_cli.text import numbered

LAYOUT = 9
STUDY, MEASURED = "study.json", "measured.npz"
OURS = re.compile(r"\..*|study\.json|measured\.npz|runs-\d+\.npz")  # what may be in the folder as it is started
STANDS, FAILED, UNKNOWN, OFF_EDGE = 0, 2, 3, 4  # outcomes; 1 and -1: overturns to a side; 4 and -4: off an edge
TYPES = {"run": np.int64, "outcome": np.int8, "by_blocks": np.bool_}  # of the columns that are not of float64
COMPRESSION = 1  # of zip: higher levels take three times as long to save a tenth
ROWS_PER_READ = 65_536
MAX_NAMED_FILES = 5  # damaged files that an error message names
CONTINUE_HINT = "finished runs are kept: run the same command again to continue"
DAMAGE = (zipfile.BadZipFile, zlib.error, ValueError, KeyError, EOFError, RuntimeError, OSError, OverflowError)
"""What numpy and zip raise for files that are not whole."""

Say = Callable[[str], None]
"""Called with a sentence for the user."""


@dataclass(frozen=True, eq=False)
class RunRows:
    """Finished runs; each field is an ndarray with one entry for each run.

    Parameters
    ----------
    run : ndarray of int
        Numbers of the runs.
    scale : ndarray
        Factor on the record.
    eta : ndarray
        Coefficient of restitution; NaN for the one of the structure.
    outcome : ndarray of int
        `STANDS`, `FAILED`, `UNKNOWN`, or the sign of the direction to which it overturned, times `OFF_EDGE` if off one.
    peak_ratio : ndarray
        Peak rotation over the critical one; NaN if the run overturned. For a run of unknown outcome, this and all other
        fields cover the time until `known_to`.
    peak_positive, peak_negative : ndarray
        Peak rotation in either direction [rad]; NaN in the direction in which the run overturned.
    peak_rate : ndarray
        Peak angular velocity [rad/s]; NaN if the run overturned, and in a store made before it was computed.
    uplift_time, overturning_time : ndarray
        Time of the first uplift, and time of passing the critical rotation for good [s]; NaN if never.
    known_to : ndarray
        Time until which a run of unknown outcome is known [s]; NaN for the others.
    lower_bound : ndarray
        For runs of unknown outcome: peak rotation over the critical one until the first joint would fail; NaN for
        others.
    opening : ndarray
        Largest opening or slip of a joint over D_cr, as far as the run was simulated; NaN if the joints are not known.
    slip : ndarray
        Largest displacement of a body that slides and never rocks [m]; 0 for others.
    slide_time : ndarray
        Time at which a joint first required more friction than available [s]; NaN if never, or if not checked.
    by_blocks : ndarray of bool
        Whether free blocks were simulated.
    """

    run: Annotated[Integers, "number of the run: polarity changes fastest, then level, restitution, record and sample"]
    scale: Annotated[Reals, "factor on the record"]
    eta: Annotated[Reals, "coefficient of restitution, NaN for that of the structure"]
    outcome: Annotated[
        Integers, "0 does not overturn, 1 or -1 overturns to that side, 4 or -4 falls off an edge, 2 failed, 3 unknown"
    ]
    peak_ratio: Annotated[Reals, "peak rotation over the critical rotation"]
    peak_positive: Annotated[Reals, "rad"]
    peak_negative: Annotated[Reals, "rad"]
    peak_rate: Annotated[Reals, "rad/s"]
    uplift_time: Annotated[Reals, "s"]
    overturning_time: Annotated[Reals, "s"]
    known_to: Annotated[Reals, "s"]
    lower_bound: Annotated[Reals, "peak rotation over the critical rotation before the first joint would fail"]
    opening: Annotated[Reals, "largest opening or slip of a joint over D_cr"]
    slip: Annotated[Reals, "m"]
    slide_time: Annotated[Reals, "s"]
    by_blocks: Annotated[Bools, "whether free blocks were simulated"]

    def __len__(self) -> int:
        return len(self.run)

    @property
    def failed(self) -> int:
        """Number of runs that could not be simulated."""
        return int((self.outcome == FAILED).sum())

    @property
    def peaks(self) -> Reals:
        """Peak rotations in the positive and the negative direction [rad], shape (n, 2)."""
        return np.stack([self.peak_positive, self.peak_negative], axis=1)

    @property
    def uplifts(self) -> Bools:
        """Whether each run uplifts."""
        return np.isfinite(self.uplift_time)

    @property
    def overturned(self) -> Bools:
        """Whether each run is known to overturn."""
        return np.asarray((np.abs(self.outcome) == 1) | self.off_edge)

    @property
    def off_edge(self) -> Bools:
        """Whether it overturns because a free block falls off an edge."""
        return np.asarray(np.abs(self.outcome) == OFF_EDGE)

    @property
    def unknown(self) -> Bools:
        """Whether the outcome of each run is unknown."""
        return np.asarray(self.outcome == UNKNOWN)

    def select(self, which: Bools | Integers) -> RunRows:
        """Return the runs that a mask or indices select."""
        return RunRows(**{name: getattr(self, name)[which] for name in COLUMNS})

    @classmethod
    def joined(cls, parts: Sequence[RunRows]) -> RunRows:
        """Join several, one after the other."""
        return cls(**{name: np.concatenate([getattr(each, name) for each in parts]) for name in COLUMNS})


COLUMNS = {name: hint.__metadata__[0] for name, hint in get_type_hints(RunRows, include_extras=True).items()}
"""Columns of a chunk, with their unit or their meaning."""
NO_RUNS = RunRows(**{name: np.zeros(0, TYPES.get(name, np.float64)) for name in COLUMNS})


class Store:
    """The folder with the runs of one study.

    Parameters
    ----------
    path : Path
        The folder; a link is followed.

    Attributes
    ----------
    facts : dict
        Everything in `study.json` by name, as plain data; empty as long as there is no study.

    Raises
    ------
    InputError
        If there is something else at the path, the description of the study is damaged, or of another layout.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(os.path.realpath(path))
        self.facts: dict[str, Any] = {}
        self._anew = False
        self._say: Say = lambda text: None
        self._mends = False  # what is damaged, beside its description
        self._state: tuple[int, int] | None = None
        self._text = b""

    @classmethod
    def reading(cls, path: str | Path) -> Store:
        """Open a store that exists, which may be that of a study that is still running."""
        store = cls(path)
        store._load()
        if store.empty:
            what = "this is not the store of a study, or it is still empty" if store.path.exists() else "no such store"
            raise InputError(Problem(what, str(path), hint="`rocking fragility STUDY.yaml` makes one"))
        return store

    @classmethod
    def writing(cls, path: str | Path, *, anew: bool = False, say: Say = lambda text: None) -> Store:
        """Open a store to add runs; the folder is made when the study starts.

        Parameters
        ----------
        path : Path
            The folder.
        anew : bool
            Put the present folder aside, under another name, when the study starts.
        say : callable, optional
            Called with the new name of the folder that is put aside.
        """
        store = cls(path)
        if not store.path.parent.is_dir():
            what = f"the folder {store.path.parent} does not exist"
            raise InputError(Problem(what, str(path), hint="create it first"))
        store._say, store._state, store._mends = say, _state(store.path / STUDY), True
        store._refuse_foreign()
        store._anew = anew and store.path.is_dir() and any(store.path.iterdir())
        if not store._anew:
            store._load()
        return store

    @property
    def empty(self) -> bool:
        """Whether the study has not started yet."""
        return not self.facts

    def started_meanwhile(self) -> bool:
        """Return whether another process has started the study since this store was opened, and read it then."""
        if not self.empty or self._state == _state(self.path / STUDY):
            return False
        self._anew = False
        self._load()
        return not self.empty

    @cached_property
    def plan(self) -> Plan:
        """The plan of the runs."""
        facts = self.facts
        try:
            of_run = self._of_runs()
        except DamagedFile as error:
            if not self._mends:
                hint = "run the study again: it computes the values of this file again"
                raise InputError(Problem(f"the store is damaged: {error}", str(self.path), hint=hint)) from None
            self._say(f"damaged, and computed again: {error}")
            of_run = {}

        def of(kind: str) -> dict[str, Reals]:
            return {name: np.array(values, np.float64) for name, values in facts["measured"][kind].items()}

        return Plan(
            [Trial(**each) for each in facts["samples"]],
            [Record(**each) for each in facts["records"]],
            np.array(facts["restitutions"], np.float64).tolist(),  # null of JSON is NaN
            facts["description"]["levels"]["measure"],
            facts["levels"],
            facts["polarities"],
            Measured(of("records"), of("samples"), of_run),
            described(facts["description"], facts["weights"]),
        )

    def keep(self, plan: Plan, facts: Mapping[str, Any]) -> None:
        """Write the plan and what else is known of the study; start the store with them if it is empty.

        Parameters
        ----------
        plan : Plan
            The plan of the runs.
        facts : mapping
            Plain data by name; those of the store that are not given stay.
        """
        measured = plan.measured
        new = {
            "layout": LAYOUT,
            "columns": COLUMNS,
            **self.facts,
            **facts,
            "runs": plan.size,
            "restitutions": plan.etas,
            "levels": plan.levels,
            "polarities": plan.polarities,
            "records": [asdict(each) for each in plan.records],
            "samples": [asdict(each) for each in plan.trials],
            "measured": {"records": measured.of_record, "samples": measured.of_sample, "runs": [*measured.of_run]},
        }
        text = json_text(new).encode()
        if self.empty:
            self._make_folder()
        if text != self._text:
            write = partial(write_whole, self.path / STUDY, lambda stream: stream.write(_sealed(text)))
            try:
                write()
            except InputError:  # another process may have put the folder aside meanwhile, and made an empty one
                if not self.path.is_dir():
                    raise self._moved() from None
                write()
        self._text, self.facts = text, json.loads(text)
        if measured.of_run:
            self._write(MEASURED, measured.of_run, self._usable())
        self.__dict__.pop("plan", None)
        self._state = _state(self.path / STUDY)

    def file(self, k: int) -> Path:
        """Return the path of a chunk."""
        return self.path / f"runs-{k:06d}.npz"

    @property
    def size(self) -> int:
        """Number of runs in a chunk, including those that cannot be simulated."""
        return int(self.facts["runs_per_chunk"])

    @property
    def chunks(self) -> range:
        """Numbers of the chunks of the study, whether or not they are finished."""
        return range(-(-int(self.facts["runs"]) // self.size))

    def ends(self, k: int) -> tuple[int, int]:
        """Return the number of the first run of a chunk, and of the first run after it."""
        return k * self.size, min((k + 1) * self.size, self.facts["runs"])

    def chunk(self, k: int) -> RunRows:
        """Return the runs of a chunk, none if it is not there yet.

        Raises
        ------
        DamagedFile
            If the file is not whole.
        InputError
            If its runs are of another study, or under other records.
        """
        name = self.file(k).name
        try:
            columns = self._arrays(name)
        except FileNotFoundError:
            return NO_RUNS
        try:
            columns.setdefault("peak_rate", np.full(columns["run"].shape, np.nan))  # of a store made before
            study, rows = str(columns["study"]), RunRows(**{name: columns[name] for name in COLUMNS})
            first, stop = self.ends(k)
            sizes = {each.shape for each in columns.values() if each.ndim}
            if sizes != {rows.run.shape} or (np.diff(rows.run, prepend=first - 1, append=stop) < 1).any():
                raise ValueError(f"its runs are not those from {first} to {stop - 1}")
        except DAMAGE as error:
            raise DamagedFile(name, error) from error
        if study != self._key(self._records_of(rows)):
            what = "its runs are of another study, of other records, or of another version"
            raise InputError(Problem(what, str(self.path / name), hint="move it away"))
        return rows

    def add(self, rows: RunRows) -> None:
        """Write finished runs of one chunk; they replace those that are there already.

        Raises
        ------
        InputError
            If another process has started another study in this folder.
        Refused
            If the system refuses, for example because the disk is full.
        """
        self._refuse_moved()
        k = int(rows.run[0]) // self.size
        with suppress(DamagedFile):
            old = self.chunk(k)
            rows = RunRows.joined([old.select(~np.isin(old.run, rows.run)), rows])
            rows = rows.select(np.argsort(rows.run))
        columns = {name: getattr(rows, name).astype(TYPES.get(name, np.float64)) for name in COLUMNS}
        try:
            self._write(self.file(k).name, columns, self._records_of(rows))
        except InputError:  # while it was written, the folder was moved, and another one may have taken its place
            self._refuse_moved()
            self._write(self.file(k).name, columns, self._records_of(rows))

    def rows(self, first: int, stop: int, counted: Callable[[int], None] = lambda numbers: None) -> Iterator[RunRows]:
        """Yield the finished runs with numbers from `first` to before `stop`, many at a time.

        Parameters
        ----------
        first, stop : int
            Numbers of runs.
        counted : callable, optional
            Called with the number of run numbers examined since the last call.

        Raises
        ------
        InputError
            If files are damaged (it names them), or another process has put this store aside.
        """
        waiting, held = [NO_RUNS], 0
        for k in range(first // self.size, -(-stop // self.size)):
            try:
                rows = self.chunk(k)
            except DamagedFile:
                raise self._damaged() from None
            if not len(rows) and self._state != _state(self.path / STUDY):
                raise self._moved()  # what was read before is of the store as it was
            begin, end = self.ends(k)
            if begin < first or end > stop:
                rows = rows.select((rows.run >= first) & (rows.run < stop))
            counted(min(end, stop) - max(begin, first))
            waiting.append(rows)
            held += len(rows)
            if held >= ROWS_PER_READ:
                yield RunRows.joined(waiting)
                waiting, held = [NO_RUNS], 0
        if held:
            yield RunRows.joined(waiting)

    def _damaged(self) -> InputError:
        """Return the error that names all damaged files, with the number of runs in the others."""
        bad, whole = [], 0
        for k in self.chunks:
            try:
                whole += len(self.chunk(k))
            except DamagedFile as error:
                bad.append(str(error))
        more = [f"and {len(bad) - MAX_NAMED_FILES} more"] if bad[MAX_NAMED_FILES:] else []
        named = "; ".join([*bad[:MAX_NAMED_FILES], *more])
        what = f"the store is damaged: {named}; {whole:,} of {self.plan.total:,} runs are whole"
        hint = "run the study again: it computes the runs of these files again"
        return InputError(Problem(what, str(self.path), hint=hint))

    def _arrays(self, name: str) -> dict[str, Any]:
        """Return the arrays of a file. Raises `DamagedFile` and `FileNotFoundError`."""
        try:
            content = (self.path / name).read_bytes()
            with np.load(io.BytesIO(content)) as file:
                return {each: file[each] for each in file.files}
        except FileNotFoundError:
            raise
        except DAMAGE as error:
            raise DamagedFile(name, error) from error

    def _of_runs(self) -> dict[str, Reals]:
        """Return the measures that differ from run to run. Raises `DamagedFile`."""
        names = self.facts["measured"]["runs"]
        if not names:
            return {}
        try:
            arrays = self._arrays(MEASURED)
            if str(arrays["study"]) != self._key(self._usable()):
                raise ValueError("it is of another study")
            return {name: arrays[name] for name in names}
        except (OSError, KeyError, ValueError) as error:
            raise DamagedFile(MEASURED, error) from error

    def _usable(self) -> Sequence[int]:
        return [k for k, each in enumerate(self.facts["records"]) if each["reason"] is None]

    def _records_of(self, rows: RunRows) -> Sequence[int]:
        """Return the indices of the records of some runs."""
        facts = self.facts
        block = len(facts["restitutions"]) * len(facts["levels"]) * len(facts["polarities"])
        return [int(k) for k in np.unique(rows.run // block % len(facts["records"]))]

    def _key(self, records: Sequence[int]) -> str:
        """Return the digest of all that decides runs under some records: study, versions and content of the records."""
        parts = [self.facts["hash"], self.facts["versions"], [self.facts["records"][k]["checksum"] for k in records]]
        return hashlib.sha256(json_text(parts, sort_keys=True).encode()).hexdigest()

    def _write(self, name: str, arrays: Mapping[str, Reals], records: Sequence[int]) -> None:
        """Write arrays with the digest of the study and of the records that they are of."""
        whole = io.BytesIO()  # zip takes a disk that fails for a pipe, and writes an equal file of other bytes
        with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED, compresslevel=COMPRESSION) as file:
            for each, values in {**arrays, "study": np.array(self._key(records))}.items():
                with file.open(f"{each}.npy", "w") as member:
                    np.lib.format.write_array(member, values)
        write_whole(self.path / name, lambda stream: stream.write(whole.getbuffer()))

    def _load(self) -> None:
        """Read the description of the study, if there is one."""
        place = self.path / STUDY
        self._state = _state(place)
        self._refuse_foreign()
        if self._state is None:
            return
        try:
            content = place.read_bytes()
        except OSError as error:
            raise InputError(Problem(f"cannot be read: {error.strerror}", str(place))) from None
        text = b"{" + content[len(_sealed(b"")) :]
        if content != _sealed(text):
            what = f"the store is damaged: {STUDY} does not match its checksum"
            raise InputError(Problem(what, str(self.path), hint=f"restore a copy of it, or {_restart()}"))
        facts = json.loads(text)
        if facts["layout"] != LAYOUT:
            what = f"this store has the layout {facts['layout']}, and this version of rocking reads {LAYOUT} only"
            raise InputError(Problem(what, str(self.path), hint=_restart()))
        self._text, self.facts = text, facts

    def _refuse_foreign(self) -> None:
        """Raise `InputError` if there is something else in this place."""
        if self.path.exists() and not self.path.is_dir():
            raise InputError(Problem("this is not the store of a study, which is a folder", str(self.path)))
        if not (self.path / STUDY).exists() and any(not OURS.fullmatch(each.name) for each in self.path.glob("*")):
            raise InputError(Problem("this folder is not the store of a study", str(self.path)))

    def _make_folder(self) -> None:
        """Put the old folder aside if the study starts anew, and make an empty one."""
        while self._anew:
            taken = [each.name for each in self.path.parent.iterdir()]
            aside = self.path.with_name(numbered(f"{self.path.stem}.before", self.path.suffix, taken))
            try:
                self.path.rename(aside)
                self._say(f"the store as it was is kept as {aside}")
            except FileNotFoundError:  # another process was faster
                pass
            except OSError as error:
                if aside.exists():  # another one has taken the name
                    continue
                raise refusal(error, "cannot be renamed", self.path) from None
            self._anew = False
        folder(str(self.path))

    def _refuse_moved(self) -> None:
        """Raise `InputError` if another process has put this store aside."""
        if self._state == _state(self.path / STUDY):
            return
        now, used = Store(self.path), self._usable()
        now._load()
        same = not now.empty and (now.facts["hash"], now.size) == (self.facts["hash"], self.size)
        if not same or now._key(used) != self._key(used):
            raise self._moved(", with other fields, records or versions")
        self._state = now._state

    def _moved(self, how: str = "") -> InputError:
        """Return the error for a store that another process has put aside."""
        what = f"another process has started this study from scratch{how}"
        if not (self.path / STUDY).exists():
            what = "this store has been moved or deleted"
        return InputError(Problem(what, str(self.path), hint="run the same command again to continue"))


class DamagedFile(Exception):
    """A file of a store that cannot be read, by name and with the reason."""

    def __init__(self, name: str, error: Exception) -> None:
        super().__init__(f"{name} ({error or type(error).__name__})")


def _restart() -> str:
    return f"run the study again with {named('restart')}, which keeps this folder under another name"


def _sealed(text: bytes) -> bytes:
    """Return the JSON text of a mapping with its checksum as the first item."""
    return b'{"checksum": "' + hashlib.sha256(text).hexdigest().encode() + b'", ' + text[1:]


def _state(path: Path) -> tuple[int, int] | None:
    """Return numbers that change when a file is replaced; None if there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns
