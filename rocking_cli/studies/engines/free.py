"""The engines of free blocks: of all motions, or of those whose outcome one degree of freedom does not tell."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from hashlib import sha256
from math import inf, nan
from pathlib import Path
from time import perf_counter
from typing import Any, ClassVar, Unpack

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.core import Mechanism
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import BlockPeaks, History, contact_lost
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, ROTATIONS, Outcome, Outcomes
from rocking_cli.dynamics.parallel import MAX_PROCESSES, in_processes
from rocking_cli.dynamics.sliding import Slid
from rocking_cli.errors import KeptWarning, SolverError, warn
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.json_text import json_text
from rocking_cli.names import TAIL_SECONDS
from rocking_cli.structure import Structure
from rocking_cli.studies.engines.blocks import SETTLING, STEPS, SUNK, BlockModel, BlockMotion, time_constant
from rocking_cli.studies.engines.exact import EXACT, Engine, EngineName, RunOptions, check_motion
from rocking_cli.studies.engines.free_blocks import FreeBlocks, free_blocks
from rocking_cli.studies.engines.scene import engine_version

FINER = (1.0, 2.0, 4.0)  # by how much contacts are stiffer than by the rule: the next if a body sank too deep
MEASURED = 1.0  # s of a motion that are simulated to measure how long the others will take
MOVED = 1e-3  # rotation over the critical one from which a structure has uplifted
DAMAGED = (sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
"""Errors of a file that has no such tables, or is no database; others, as of a locked file, may pass."""


class TooLong(SolverError):
    """More steps than a simulation may take."""


def simulate(
    free: FreeBlocks, models: dict[float, BlockModel], motion: GroundMotion | None, most_steps: float = inf, **how: Any
) -> BlockMotion:
    """Simulate free blocks, with stiffer contacts if a body sinks too deep.

    Parameters
    ----------
    free : FreeBlocks
        The blocks.
    models : dict of float to BlockModel
        Models of these blocks by the stiffness of their contacts, which this call adds to.
    most_steps : float
        Largest number of time steps, times the number of blocks, of all attempts together.
    motion, **how
        See `BlockModel.simulate`.

    Raises
    ------
    TooLong
        If it takes more steps.
    """
    lasts, settling = motion.duration if motion is not None else 0.0, SETTLING * free.unit_of_time
    for finer in FINER:
        seconds = most_steps / len(free.bodies) * time_constant(free) / (finer * STEPS) - settling
        if lasts > seconds:
            raise TooLong("a simulation takes too many steps")
        if finer not in models:
            models[finer] = BlockModel(free, finer)
        moved = models[finer].simulate(motion, most=seconds, **how)
        if moved.ended_early:
            raise TooLong("a simulation takes too many steps")
        if not moved.failed:
            break
        most_steps *= 1 - (float(moved.time[-1]) + settling) / (seconds + settling)
    return moved


def outcome_of(moved: BlockMotion, free: FreeBlocks, phi_cr: Sequence[float]) -> dict[str, Any]:
    """Return the fields of the outcome of a motion of free blocks."""
    phi = free.rotation(moved.moved)
    of_mechanism = phi[-1] if free.leads else 0.0  # zero where a block falls beside the mechanism
    way = of_mechanism or moved.moved[-1, _place(free, moved.block), 0]
    peaks = [float(np.max(sign * phi, initial=0.0)) for sign in (1, -1)]
    turning = free.rotation_rate(moved.moved, moved.rates)
    rates = [float(np.max(np.abs(turning), where=sign * phi > 0, initial=0.0)) for sign in (1, -1)]
    fell = np.isfinite(moved.collapsed)
    moving = np.abs(phi) > MOVED * np.where(phi < 0, phi_cr[1], phi_cr[0])
    uplifts = bool(moving.any()) or bool(fell)
    fell_to = (1 if way >= 0 else -1) if fell else 0
    ratio = max(peak / limit for peak, limit in zip(peaks, phi_cr, strict=True))
    slip = 0.0 if uplifts or not free.leads else abs(slid_of_blocks(moved).largest)
    end = float(moved.time[-1])
    return {
        "still_rocking": not (moved.at_rest or fell or moved.failed),
        "failed": False,
        "fell_to": fell_to,
        "peak_positive": nan if fell_to > 0 else peaks[0] * uplifts,
        "peak_negative": nan if fell_to < 0 else peaks[1] * uplifts,
        "peak_ratio": nan if fell else ratio * uplifts,
        "peak_rate_positive": nan if fell_to > 0 else rates[0] * uplifts,
        "peak_rate_negative": nan if fell_to < 0 else rates[1] * uplifts,
        "overturning_time": moved.collapsed,
        "uplift_time": float(moved.time[moving.argmax()]) if moving.any() else nan,
        "impact_count": len(impacts_of(moved.time, phi, turning, moving)),
        "end_time": nan if moved.failed else end,
        "unknown": bool(moved.failed),
        "known_to": end if moved.failed else nan,
        "warned": nan,
        "lower_bound": ratio if moved.failed else nan,
        "opening": nan,
        "by_blocks": True,
        "slip": slip if slip > SUNK * free.height else 0.0,
        "off_edge": bool(moved.off),
    }


def slid_of_blocks(moved: BlockMotion) -> Slid:
    """Return the slip of the block that slides farthest, in a motion of blocks without uplift."""
    across = moved.moved[..., 0]
    slip = across[:, np.abs(across).max(axis=0).argmax()]
    return Slid(float(slip[np.abs(slip).argmax()]), float(slip[-1]), float(np.abs(np.diff(slip)).sum()), slip)


def _place(free: FreeBlocks, block: str) -> int:
    return next((k for k, body in enumerate(free.bodies) if body.name == block), 0)


def blocks_of(moved: BlockMotion, free: FreeBlocks) -> BlockPeaks:
    """Return what the blocks do in a motion."""
    names = [body.name for body in free.bodies]
    turned, away = np.abs(moved.moved[..., 2]), np.hypot(moved.moved[..., 0], moved.moved[..., 1])
    turned_most, moved_most, left = (
        (float(each.max()), names[int(each.argmax())]) for each in (turned.max(axis=0), away.max(axis=0), away[-1])
    )
    at_rest = left if moved.at_rest else (nan, "")
    return BlockPeaks(moved.block, moved.off, turned_most, moved_most, at_rest, moved.least_turn, moved.least)


def impacts_of(time: Reals, phi: Reals, rate: Reals, moving: Bools) -> Reals:
    """Return time, sign of the direction that ends, and rate before of each return to rest after uplift.

    What does not go on to the other side, as at a side wall, has returned when it counts as uplifted no longer.
    """
    rows, side, back = [], 0, 0  # `back`: the first sample at which it counts as uplifted no longer
    for k in range(len(phi)):
        sign = np.sign(phi[k])
        if side and sign != side:
            ends = time[k - 1] + (time[k] - time[k - 1]) * phi[k - 1] / (phi[k - 1] - phi[k])
            rows.append((ends, side, abs(rate[k - 1])))
            side = back = 0
        if moving[k]:
            if back:
                rows.append((time[back], side, abs(rate[back - 1])))
            side, back = sign, 0
        elif side and not back:
            back = k
    if back:
        rows.append((time[back], side, abs(rate[back - 1])))
    return np.array(rows).reshape(-1, 3)


def history_of(moved: BlockMotion, free: FreeBlocks, model: Model | None, motion: GroundMotion | None) -> History:
    """Return a motion of free blocks as the history of the rotation that the mechanism has, if it has one."""
    phi, both = free.rotation(moved.moved), model.phi_cr if model is not None else (nan, nan)
    outcome = outcome_of(moved, free, both)
    phi_cr = np.where(phi < 0, both[1], both[0])
    rate = free.rotation_rate(moved.moved, moved.rates)
    return History(
        **outcome, model="blocks", time=moved.time, phi=phi, rate=rate, ratio=phi / phi_cr,
        impacts=impacts_of(moved.time, phi, rate, np.abs(phi) > MOVED * phi_cr),
        contact_lost=contact_lost(motion, free.gravity), p=model.p if model is not None else nan,
        ends_at_limit=model.ends_at_limit if model is not None else (False, False), blocks=blocks_of(moved, free),
        slid=slid_of_blocks(moved) if outcome["slip"] else None,
    )  # fmt: skip


class Blocks(Engine):
    """The engine of free blocks."""

    name: ClassVar[EngineName] = "blocks"

    def __init__(self, mechanisms: Sequence[Mechanism] = ()) -> None:
        engine_version()
        self.mechanisms = tuple(mechanisms)

    def follow(
        self,
        structure: Structure,
        motion: GroundMotion | None,
        *,
        release: float | None = None,
        tail: float = TAIL_SECONDS,
        most_steps: float = inf,
    ) -> tuple[History, BlockMotion, FreeBlocks]:
        """Return the history of a structure as free blocks, with the motion of the blocks, and the blocks.

        They are one model and need no tolerance; restitution is what contact gives, and that of the structure has no
        effect. Parameters are those of `exact.follow` and `simulate`.

        Raises
        ------
        InputError
            As `exact.follow`, or if the structure has something that free blocks cannot have.
        TooLong
            If it takes more than `most_steps`.
        SolverError
            If the blocks do not stand by themselves, a step diverges, or a body sinks too deep into another.
        """
        check_motion(structure, motion, release, tail)
        with structure.named():
            free = free_blocks(structure.mechanism)
            model = structure.model("nonlinear") if structure.no_model is None else None
            start = _start(structure.mechanism, free, model.phi_cr, release or 0.0) if model is not None else None
            moved = simulate(free, {}, motion, most_steps, start=start, tail=tail, friction=True)
        if moved.failed:
            raise SolverError(f"{structure.name}: free blocks failed at {moved.time[-1]:.4g} s: {moved.failed}")
        return history_of(moved, free, model, motion), moved, free

    def outcomes(
        self, models: Sequence[Model], motions: Sequence[GroundMotion | None], runs: Runs, **options: Unpack[RunOptions]
    ) -> Outcomes:
        """Simulate many motions in processes; those that fail are of unknown outcome.

        Restitution is what contact gives: that of a run has no effect.
        """
        progress = options.get("progress")
        work = _Work(self.mechanisms, [model.phi_cr for model in models], motions, runs, options.get("release"))
        keys = work.keys()
        known = recall(keys)
        left = [k for k, key in enumerate(keys) if key not in known]
        if progress is not None:
            progress(len(runs) - len(left))
        work.left = left
        processes = min(options.get("threads") or os.cpu_count() or 1, MAX_PROCESSES, len(left))
        parts = (
            in_processes(work, len(left), 1, processes)
            if processes > 1
            else ((k, work(k, k + 1)) for k in range(len(left)))
        )
        for k, outcome in parts:
            remember([(keys[left[k]], outcome)])
            known[keys[left[k]]] = outcome
            if progress is not None:
                progress(1)
        rows = [known[key] for key in keys]
        fields = {name: np.array([row[name] for row in rows]) for name in OUTCOME_FIELDS}
        for name in (*ROTATIONS, "slip"):
            fields[name] = fields[name] * runs.slender
        return Outcome(**fields)


class Auto(Engine):
    """The engine of one degree of freedom where it knows the outcome, that of free blocks where it does not."""

    name: ClassVar[EngineName] = "auto"

    def __init__(self, mechanisms: Sequence[Mechanism] = ()) -> None:
        self.free = Blocks(mechanisms)

    def outcomes(
        self, models: Sequence[Model], motions: Sequence[GroundMotion | None], runs: Runs, **options: Unpack[RunOptions]
    ) -> Outcomes:
        """Simulate many motions; each outcome states its engine."""
        progress, release = options.pop("progress", None), options.get("release")
        exact = EXACT.outcomes(models, motions, runs, **options)
        unknown = np.flatnonzero(exact.unknown)
        if progress is not None:
            progress(len(runs) - unknown.size)
        if not unknown.size:
            return exact
        some = replace(runs, **{name: getattr(runs, name)[unknown] for name in vars(runs)})
        if isinstance(release, np.ndarray):
            options["release"] = release[unknown]
        options["progress"] = progress
        free = self.free.outcomes(models, motions, some, **options)
        return exact.by_field(lambda one, other: _put(one, unknown, other), free)


def _put(values: Any, places: Any, others: Any) -> Any:
    values = values.copy()
    values[places] = others
    return values


def _start(mechanism: Mechanism, free: FreeBlocks, phi_cr: tuple[float, float], tilt: float) -> Reals | None:
    return free.tilted(mechanism, tilt * phi_cr[0 if tilt > 0 else 1]) if tilt else None


def cost(structure: Structure, motion: GroundMotion) -> tuple[float, int]:
    """Return how long a history of free blocks will take, measured over a part of it, and how many run at a time."""
    with structure.named():
        model = BlockModel(free_blocks(structure.mechanism))
        began = perf_counter()
        model.simulate(motion, most=MEASURED)
    return (perf_counter() - began) * max(motion.duration / MEASURED, 1.0), min(os.cpu_count() or 1, MAX_PROCESSES)


class _Work:
    """Motions of free blocks that processes share; each process makes its own models."""

    def __init__(
        self,
        mechanisms: Sequence[Mechanism],
        phi_cr: Sequence[tuple[float, float]],
        motions: Sequence[GroundMotion | None],
        runs: Runs,
        release: float | Reals | None,
    ) -> None:
        self.mechanisms, self.phi_cr, self.motions, self.runs = mechanisms, phi_cr, motions, runs
        self.tilts = np.broadcast_to(np.asarray(0.0 if release is None else release, np.float64), len(runs))
        self.left: list[int] = []
        self._models: dict[int, tuple[FreeBlocks, dict[float, BlockModel]]] = {}

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_models": {}}

    def _of(self, model: int) -> tuple[FreeBlocks, dict[float, BlockModel]]:
        if model not in self._models:
            free = free_blocks(self.mechanisms[model])
            self._models[model] = free, {1.0: BlockModel(free)}
        return self._models[model]

    def keys(self) -> list[str]:
        """Return a key of each run, of all on which its outcome depends."""
        used = sorted(set(self.runs.model.tolist()))
        structures = {k: f"{self._of(k)[1][1.0].digest}{self.phi_cr[k]!r}{OUTCOME_FIELDS}" for k in used}
        motions = {k: _digest(self.motions[k]) for k in sorted(set(self.runs.record.tolist()))}
        return [
            sha256(
                repr((structures[int(of)], motions[int(record)], scale, int(sign), slender, tilt)).encode()
            ).hexdigest()
            for of, record, scale, sign, slender, tilt in zip(
                self.runs.model, self.runs.record, self.runs.scale.tolist(), self.runs.polarity,
                self.runs.slender.tolist(), self.tilts.tolist(), strict=True,
            )
        ]  # fmt: skip

    def __call__(self, first: int, stop: int) -> dict[str, Any]:
        """Simulate one run, the only one from `first` to before `stop` of those that are left."""
        k = self.left[first]
        of = int(self.runs.model[k])
        free, models = self._of(of)
        scale, slender = float(self.runs.scale[k]), float(self.runs.slender[k])
        start = _start(self.mechanisms[of], free, self.phi_cr[of], float(self.tilts[k]))
        moved = simulate(
            free, models, self.motions[int(self.runs.record[k])], start=start,
            factor=scale * int(self.runs.polarity[k]) / slender, vertical_factor=abs(scale),
        )  # fmt: skip
        return outcome_of(moved, free, self.phi_cr[of])


def _digest(motion: GroundMotion | None) -> str:
    if motion is None:
        return ""
    digest = sha256(repr((motion.dt, motion.every)).encode())
    for each in (motion, motion.vertical):
        if each is not None:
            digest.update(repr(each.dt).encode() + np.ascontiguousarray(each.acceleration).tobytes())
    return digest.hexdigest()


# Histories that were simulated before, so that a study that was interrupted goes on where it stopped. The file is read
# as one of a stranger: a row is taken if its checksum, of key and outcome, is right.


def place() -> Path:
    """Return the file of the histories, in the user's cache."""
    import platformdirs

    return platformdirs.user_cache_path("rocking-cli", appauthor=False) / "blocks.sqlite"


def recall(keys: Sequence[str]) -> dict[str, Any]:
    """Return what is known of histories, by their keys; nothing if the file cannot be read."""
    outcomes: dict[str, Any] = {}
    if not os.path.isfile(place()):  # noqa: PTH113 - pathlib raises where a folder may not be entered
        return outcomes
    rows, damaged = list[tuple[str, Any]](), 0

    def read(database: sqlite3.Connection) -> None:
        (fault,) = database.execute("PRAGMA quick_check(1)").fetchone()
        if fault != "ok":
            raise sqlite3.DatabaseError(fault)
        for key in keys:
            rows.extend((key, kept) for (kept,) in database.execute("SELECT outcome FROM kept WHERE key = ?", (key,)))

    _opened(read)
    for key, kept in rows:
        checksum, _, text = str(kept).partition(" ")
        if checksum == _checksum(key, text):
            outcomes[key] = {name: nan if value is None else value for name, value in json.loads(text).items()}
        else:
            damaged += 1
    if damaged:
        warn(KeptWarning(f"{place()}: rows that are damaged and are simulated again: {damaged}"))
    return outcomes


def remember(outcomes: Iterable[tuple[str, Any]]) -> None:
    """Keep outcomes of histories by their keys; in vain if the file cannot be written."""
    texts = [(key, json_text(outcome)) for key, outcome in outcomes]
    rows = [(key, f"{_checksum(key, text)} {text}") for key, text in texts]
    _opened(lambda known: known.executemany("INSERT OR REPLACE INTO kept VALUES (?, ?)", rows))


def _checksum(key: str, text: str) -> str:
    return sha256(f"{key} {text}".encode(errors="replace")).hexdigest()


def _opened(use: Callable[[sqlite3.Connection], object]) -> None:
    """Use the file, as far as that is possible; one that is damaged is removed, so that the next call makes it anew."""
    try:
        place().parent.mkdir(parents=True, exist_ok=True)
        with closing(sqlite3.connect(place(), timeout=10.0)) as known, known:
            known.text_factory = lambda text: text.decode(errors="replace")
            known.execute("CREATE TABLE IF NOT EXISTS kept (key TEXT PRIMARY KEY, outcome TEXT) WITHOUT ROWID")
            use(known)
    except OSError:
        pass
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the second by `sqlite3`, of a damaged name of a column
        if getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF in DAMAGED:
            for ending in ("-journal", "-wal", "-shm", ""):
                with suppress(OSError):
                    Path(f"{place()}{ending}").unlink()
            warn(KeptWarning(f"{place()}: damaged, and made anew: {error}"))
