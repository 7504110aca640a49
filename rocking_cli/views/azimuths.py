"""The responses of a structure in all directions, as people and programs read them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.io.tables import Columns
from rocking_cli.names import percent
from rocking_cli.studies.azimuths import Around, sectors
from rocking_cli.views.view import ABSENT, Table, View, heading


def view(structure: Prepared, found: Around, doubts: Iterable[str] = ()) -> View:
    """What a pair of components does in all directions."""
    one, other = found.names
    heads = ["model", "directions\noverturn", "do not\nuplift", "largest peak\nof the others", "at\n[deg]"]
    rows = [[name, *_cells(found, each)] for name, each in found.outcomes.items()]
    said = (
        f"0 degrees is {one}, 90 degrees {other}; {found.azimuths.size} directions of the structure's plane, one every "
        f"{found.azimuths[1] - found.azimuths[0]:g} degrees. PGA {found.pga.min():.3g} to {found.pga.max():.3g} g, the "
        f"largest at {found.azimuths[found.pga.argmax()]:g} degrees."
    )
    parts: list[Table | str] = [heading(structure.mechanism), said, Table("", heads, rows, numbers=(1, 2, 3, 4))]
    parts += [f"{name}: {in_words(found, each)}" for name, each in found.outcomes.items()]
    return View(_data(structure, found), [*parts, *doubts])


def in_words(found: Around, outcomes: Outcomes) -> str:
    """Where a structure overturns, a sentence."""
    falls = outcomes.overturned
    if not falls.any():
        return "it overturns in no direction."
    if falls.all():
        return "it overturns in every direction."
    ranges = [f"{a:g}" if a == b else f"{a:g} to {b:g}" for a, b in sectors(found.azimuths, falls)]
    return f"it overturns in {int(falls.sum())} of {falls.size} directions, at {', '.join(ranges)} degrees."


def columns(found: Around) -> Columns:
    """A row for each direction; the peak ratio of a motion that overturns is absent."""
    table: dict[str, Any] = {"azimuth [deg]": found.azimuths, "PGA [g]": found.pga}
    for name, each in found.outcomes.items():
        table |= {f"peak phi/phi_cr {name}": each.peak_ratio, f"overturns {name}": each.overturned.astype(int)}
    return table


def _cells(found: Around, each: Outcomes) -> list[str]:
    standing = np.where(each.overturned, -1.0, each.peak_ratio)
    k = int(standing.argmax())
    peak = [f"{standing[k]:.4g}", f"{found.azimuths[k]:g}"] if standing[k] > 0 else [ABSENT, ABSENT]
    return [percent(float(each.overturned.mean())), percent(float((~each.lifted).mean())), *peak]


def _data(structure: Prepared, found: Around) -> dict[str, Any]:
    mechanism = structure.mechanism
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "components": list(found.names),
        "scale": found.scale,
        "azimuths": found.azimuths.tolist(),
        "pga": found.pga.tolist(),
        "responses": {
            name: {
                "peak_ratio": [None if np.isnan(peak) else peak for peak in each.peak_ratio.tolist()],
                "overturned": each.overturned.tolist(),
                "uplifts": each.lifted.tolist(),
                "sectors_that_overturn": [list(pair) for pair in sectors(found.azimuths, each.overturned)],
                "said": in_words(found, each),
            }
            for name, each in found.outcomes.items()
        },
    }
