"""Histories as tables: in blocks of rows, so that a long one is never in memory twice, or a row for each sample."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.movements import Watched
from rocking_cli.studies.response import Response

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

GROUND = ("a_g", "v_g")
"""Columns of a history that are those of the ground."""
ROWS_PER_BLOCK = 25_000


def wide(response: Response, structure: Structure) -> Iterator[dict[str, Reals]]:
    """Yield the histories of the first polarity, then those of the second, or those under the pulse alone."""
    first, *others = response.runs.values()
    runs: dict[str, History] = dict(first.items())
    runs |= {f"reversed {name}": run for other in others for name, run in other.items()}
    runs |= {f"pulse {name}": run for name, run in (response.to_pulse or {}).items()}
    contacts = Contacts(structure.mechanism)
    shear = {"nonlinear": contacts.base_shear(first["nonlinear"], response.first)} if "nonlinear" in first else {}
    yield from blocks(runs, response.first, watched=Watched(structure.mechanism), base_shear=shear)


def long(response: Response, structure: Structure) -> Columns:
    """Return the histories with a row for each sample of each, and what it is of."""
    from rocking_cli.io.tables import stacked

    first, fit, contacts = response.first, response.fit, Contacts(structure.mechanism)
    under: list[tuple[dict[str, int], GroundMotion | None, Mapping[ModelName, History]]] = [({}, first, response)]
    if first is not None and len(response.runs) > 1:
        motions = (first, first.scaled(-1))
        under = [
            ({"polarity": sign}, motion, runs)
            for (sign, runs), motion in zip(response.runs.items(), motions, strict=True)
        ]
    elif first is not None and fit is not None and response.to_pulse is not None:
        under = [({"pulse_alone": 0}, first, response), ({"pulse_alone": 1}, fit.alone(first), response.to_pulse)]

    def tables() -> Iterator[dict[str, object]]:
        for of, motion, runs in under:
            shear = {"nonlinear": contacts.base_shear(runs["nonlinear"], motion)} if "nonlinear" in runs else {}
            watched = Watched(structure.mechanism)
            wide = stacked(blocks(runs, motion, watched=watched, base_shear=shear))
            common = {head: values for head, values in wide.items() if head.partition(" ")[0] in ("t", *GROUND)}
            for model in runs:
                start = f"{model} "
                moved = {head.removeprefix(start): each for head, each in wide.items() if head.startswith(start)}
                yield {**of, "model": model, **common, **moved}

    return stacked(tables())


def of_each_block(response: Response, structure: Structure) -> Iterator[Columns]:
    """Yield the motion of each block, a row for each sample and block, of one polarity after the other."""
    for sign, runs in response.runs.items():
        run = runs["nonlinear"]
        names, places, turns = zip(*Watched(structure.mechanism).bodies(run), strict=True)
        z = np.stack(places, axis=1).ravel()
        polarity = {"polarity": np.full(z.size, sign)} if len(response.runs) > 1 else {}
        yield {
            **polarity, "t [s]": np.repeat(run.time, len(names)), "block": np.tile(names, run.time.size),
            "x [m]": z.real, "z [m]": z.imag, "rotation [rad]": np.stack(turns, axis=1).ravel(),
        }  # fmt: skip


def long_of_each_block(response: Response, structure: Structure) -> Columns:
    """Return the motion of each block as one table."""
    from rocking_cli.io.tables import stacked

    return stacked(of_each_block(response, structure))


def impacts(response: Response) -> Columns:
    """Return the impacts of all histories, a row for each."""
    rows = [
        (sign, name, *impact)
        for sign, runs in response.runs.items()
        for name, run in runs.items()
        for impact in run.impacts.tolist()
    ]
    heads = "polarity", "model", "t [s]", "direction", "phi_dot before [rad/s]"
    return {head: [row[k] for row in rows] for k, head in enumerate(heads)}


def blocks(
    histories: Mapping[ModelName, History] | Mapping[str, History],
    motion: GroundMotion | None,
    rows: int = ROWS_PER_BLOCK,
    watched: Watched | None = None,
    base_shear: Mapping[str, Reals] = MappingProxyType({}),
) -> Iterator[dict[str, Reals]]:
    """Yield histories as columns by their headings, a block of samples at a time.

    Parameters
    ----------
    histories : mapping of str to History
        At least one; all on the same samples.
    motion : GroundMotion, optional
        The ground motion of the histories.
    rows : int
        Largest number of samples in a block.
    watched : Watched, optional
        Points and ties: with them, further columns are displacements, elongations and forces in each history but that
        of free blocks, which do not move as the mechanism does.
    base_shear : mapping of str to ndarray, optional
        The horizontal force of the ground at each sample of some histories [N], without the impulses of impacts, as
        last columns; NaN at rest. [N/kg] if the `watched` structure has no masses.

    Yields
    ------
    dict of str to ndarray
        The columns; NaN after overturning, and after the time until which the motion is known.
    """
    sheared = "base shear [N]" if watched is None or watched.mechanism.has_mass else "base shear [N/kg]"
    longest = max(histories.values(), key=lambda run: run.time.size)
    shaken = motion.kept.acceleration if motion is not None else np.zeros(0)
    for start in range(0, longest.time.size, rows):
        part = slice(start, min(start + rows, longest.time.size))
        columns = {"t [s]": longest.time[part], "a_g [g]": _padded(shaken, part, 0.0) / STANDARD_GRAVITY}
        # The vertical component is zero after its last sample.
        if motion is not None and (up := motion.vertical) is not None:
            columns["v_g [g]"] = np.interp(longest.time[part], up.time, up.acceleration, right=0.0) / STANDARD_GRAVITY
        for name, run in histories.items():
            series = {"phi [rad]": run.phi, "phi_dot [rad/s]": run.rate, "phi_ratio": run.ratio}
            columns |= {f"{name} {what}": _padded(values, part, _after(run)) for what, values in series.items()}
            if run.slid is not None:
                columns[f"{name} slip [m]"] = np.asarray(_slip(run, part))
        if watched is not None:
            for name, run in ((name, run) for name, run in histories.items() if not run.by_blocks):
                phi = _padded(run.phi, part, _after(run))
                columns |= {f"{name} {what}": values for what, values in watched.columns(phi, _slip(run, part))}
        columns |= {f"{name} {sheared}": _padded(values, part, np.nan) for name, values in base_shear.items()}
        yield columns


def _slip(run: History, part: slice) -> Reals | float:
    """Return the slip of a history in a slice of its samples [m]; 0 if it does not slide."""
    return _padded(run.slid.displacement, part, run.slid.residual) if run.slid is not None else 0.0


def _after(run: History) -> float:
    """Return the value that follows the end of a history: 0 if it has come to rest, otherwise NaN."""
    return np.nan if run.fell or run.unknown else 0.0


def _padded(values: Reals, part: slice, after: float) -> Reals:
    """Return a slice of the values, filled with `after` beyond their end."""
    padded = values[part]
    return np.concatenate([padded, np.full(part.stop - part.start - padded.size, after)])
