"""Reader of block models of compas_dem in JSON: assemblies of prisms, seen along their axis."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.errors import named
from rocking_cli.io.drawings import contract
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnText, LineDrawing

TITLE = "JSON of compas_dem"
ENDINGS = (".json",)
PLANES = {"xz": [0, 2, 1], "yz": [1, 2, 0]}
"""Axes to the right, upwards, and along the prisms."""
MAX_BYTES = 100_000_000
SAME_PLACE = 1e-6  # distance that is none, over the size of a block


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is a block model."""
    return re.match(rb'\s*\{\s*"dtype"\s*:\s*"compas_(dem|model)\.models/', data) is not None


def read(data: bytes, file: str, plane: str = "xz") -> LineDrawing:
    """Return the sections of the blocks in a plane; supports are ground. Raises `DrawingError`."""
    contract.check_content(data, MAX_BYTES, file)
    chains, labels, ends = list[DrawnLine](), list[DrawnText](), list[Reals]()
    try:
        model = json.loads(data)["data"]
        if isinstance(model["elements"], list):
            raise DrawingError("damaged", "it is of an older compas_model: save it by compas_dem 0.6 or later", file)
        names = Counter(element.get("name") for element in model["elements"].values())
        for guid, moved in _placed(model):
            block = model["elements"][guid]
            label, of, is_support = block.get("name", ""), block["data"], block["data"]["is_support"]
            label = label if names[label] == 1 else ""
            rings, between = _section(of["geometry"]["data"], moved, PLANES[plane])
            name, fault = label or f"{of['name']} {guid[:8]}", "" if rings else "is not a prism"
            ends.append(between)
            if rings and np.abs(between - ends[0]).max() > SAME_PLACE * np.ptp(between):
                here, there = (f"from {each[0]:.6g} to {each[1]:.6g}" for each in (between, ends[0]))
                fault = f"reaches {here}, and not {there},"
            if fault:
                what = f"the block {name} {fault} along the axis across {plane}"
                hint = f"{named('plane')} is the plane of the assembly: xz or yz"
                raise DrawingError("not_plane", what, file, hint=hint)
            layer, shape = "ground" if is_support else "blocks", guid if rings[1:] else ""
            chains += [DrawnLine(z, np.zeros(len(z)), True, layer, "block", guid, shape) for z in rings]
            stone = (model.get("materials") or {}).get(of.get("material"))
            texts = [] if is_support else [label, f"{stone['data']['density']} kg/m3" if stone else ""]
            labels += [DrawnText(text, contract.inside(rings), layer, "block", guid) for text in texts if text]
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        what = f"cannot be read as {TITLE}: {type(error).__name__} {error}"
        raise DrawingError("damaged", what, file) from None
    return LineDrawing(TITLE, chains, labels, depth=float(np.ptp(ends[0])) if ends else None)


def _placed(model: Mapping[str, Any]) -> Iterator[tuple[str, Reals]]:
    """Yield the name of each element of a model, and how it is moved: with those that it is part of."""

    def matrix(item: Mapping[str, Any]) -> Reals:
        given = item.get("transformation")
        return np.array(given["data"]["matrix"], float) if given else np.eye(4)

    todo = [(node, matrix(model)) for node in model["tree"]["root"].get("children", [])]
    for node, moved in todo:
        if guid := node.get("element"):
            moved = moved @ matrix(model["elements"][guid]["data"])
            yield guid, moved
        todo += [(child, moved) for child in node.get("children", [])]


def _section(mesh: Mapping[str, Any], moved: Reals, axes: list[int]) -> tuple[list[Points], Reals]:
    """Return the rings of the section of a prism, none of another body, and both ends of it."""
    import shapely

    with np.errstate(all="ignore"):  # infinite coordinates are refused below
        points = {key: (moved @ [*(at[axis] for axis in "xyz"), 1.0])[axes] for key, at in mesh["vertex"].items()}
    faces = [np.array([points[str(key)] for key in face]) for face in mesh["face"].values()]
    least, most = (way(np.concatenate(faces), axis=0) for way in (np.min, np.max))
    ends, tolerance = np.array([least[2], most[2]]), SAME_PLACE * float((most - least).max())
    if not max(most.max(), -least.min()) < contract.MAX_NUMBER:
        raise ValueError(f"a coordinate is not a number below {contract.MAX_NUMBER:g}")
    flat = shapely.make_valid([shapely.Polygon(face[:, :2]) for face in faces])
    at_end = np.array([[np.abs(face[:, 2] - end).max() <= tolerance for face in faces] for end in ends])
    low, high = (shapely.union_all(flat[at]) for at in at_end)
    off = shapely.area(flat[~at_end.any(axis=0)]).sum() + low.symmetric_difference(high).area
    is_prism = low.geom_type == "Polygon" and off <= tolerance * low.length
    rings = shapely.get_rings(low.simplify(tolerance)).tolist() if is_prism else []
    return [shapely.get_coordinates(ring)[:-1] @ [1, 1j] for ring in rings], ends
