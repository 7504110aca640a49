"""The page of `rocking explore`: what its kernel needs of structures and motions, and the text of the file."""

from __future__ import annotations

import html
import re
from functools import partial
from typing import Any

import numpy as np

from rocking_cli.core.structure_file import structure_text
from rocking_cli.documents.figures import inline_svg
from rocking_cli.dynamics import shipped
from rocking_cli.dynamics.batch import DECISIVE_IMPACTS
from rocking_cli.dynamics.deck import MAX_IMPACTS, lay_out
from rocking_cli.dynamics.model import Model
from rocking_cli.errors import MechanismError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import OPENING, RTOL, TAIL_SECONDS, peaks_over
from rocking_cli.plotting.moving import as_script, asset
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.questions.explore.packing import deflated, packed
from rocking_cli.questions.explore.study import Exploration, check, slides_at, slides_from
from rocking_cli.questions.explore.view import first_shown
from rocking_cli.questions.margin.study import FACTORS
from rocking_cli.questions.overturning.study import usual_amplitudes, usual_periods
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import LEAST_SHARE
from rocking_cli.studies.neighbours import LEAST_ETA, Neighbourhood
from rocking_cli.studies.picture import ASSUMED_NOTE, picture
from rocking_cli.studies.under_pulses import parse_shape, pulsed_model
from rocking_cli.text import in_short, printable
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.verdict import unchecked

SHAPES = {"sine": "full sine", "cosine": "cosine", "half_sine": "half sine", "ricker": "Ricker pulse"}
ENLARGEMENT = 2.0  # of the second file of a structure, which shows what grows with its size
ALIKE = 1e-9  # relative difference of equal numbers of a structure in two sizes


def data_of(offered: Exploration) -> dict[str, Any]:
    """Return all that the page needs, as plain data."""
    motion = offered.given.motion
    shapes = {key: parse_shape(key) for key in SHAPES}
    pulses = {key: shape.sampled() for key, shape in shapes.items()}
    return {
        "kernel": deflated(shipped.for_pages()),
        "rtol": RTOL,
        "tail": TAIL_SECONDS,
        "mostImpacts": MAX_IMPACTS,
        "decisiveImpacts": DECISIVE_IMPACTS - 1,
        "g": STANDARD_GRAVITY,
        "leastShare": LEAST_SHARE,
        "factors": FACTORS.tolist(),
        "leastRestitution": LEAST_ETA,
        "command": offered.options,
        "motion": {
            "name": motion.name, "factor": offered.given.factor * offered.sign, "dt": motion.dt, "every": motion.every,
            "u": packed(motion.acceleration),
        },
        "pulses": {
            key: {
                "label": SHAPES[key], "dt": pulse.dt, "every": pulse.every, "u": packed(pulse.acceleration),
            }
            for key, pulse in pulses.items()
        },
        "amplitude": packed(offered.around.drawn(check(offered.structures[0])).amplitude),
        "uniform": packed(offered.around.uniform()[2]),
        "structures": [_structure(each, offered) for each in offered.structures],
    }  # fmt: skip


def _axes(structure: Structure, shape: str) -> dict[str, Any] | None:
    """Return the axes of the map of a structure: periods [s] and amplitudes [g]; None if no block is equivalent."""
    form = parse_shape(shape)
    try:
        subject = [pulsed_model(structure, "nonlinear", form)]
    except MechanismError:
        return None
    return {"periods": usual_periods(subject, form), "amplitudes": usual_amplitudes(subject)}


def _structure(structure: Structure, offered: Exploration) -> dict[str, Any]:
    varied, usual = offered.varied, [structure]
    if varied is not None:
        usual = [
            structure.varied(varied.field, value) if value != varied.given else structure for value in varied.values
        ]
    return {
        "name": structure.name,
        "file": structure.file,
        "notes": _notes(structure),
        "options": _options(structure),
        "vary": None if varied is None else {
            "label": varied.field, "unit": varied.unit, "values": list(varied.values),
            "usual": varied.values.index(varied.given),
        },
        "axes": {key: _axes(structure, key) for key in SHAPES},
        "variants": [_variant(each, offered.around) for each in usual],
    }  # fmt: skip


def _variant(structure: Structure, around: Neighbourhood) -> dict[str, Any]:
    mechanism = structure.mechanism
    drawn = picture(mechanism)
    low, high = (complex(each) for each in drawn.extent)
    spare = 0.25 * max(high.real - low.real, high.imag - low.imag)
    return {
        "stage": {
            "picture": drawn.grouped.as_dict(),
            "shades": {direction.label: drawn.grouped.shades[direction] for direction in drawn.directions},
            "middle": (low + high).real / 2,
            "box": [[low.real - spare, low.imag], [high.real + spare, high.imag + spare / 4]],
        },
        "yaml": [structure_text(mechanism), _enlarged(structure)],
        "over": peaks_over(check(structure).ends_at_limit),
        "model": _model(check(structure)),
        "linear": {name: _model(structure.model(name)) for name in structure.default_models if name != "nonlinear"},
        "neighbours": _neighbours(structure, around),
    }


def _options(structure: Structure) -> dict[str, float | None]:
    """Return what commands are told of a structure beside its file, None where they are told nothing."""
    return {
        "restitution": structure.restitution, "opening": None if structure.opening == OPENING else structure.opening
    }  # fmt: skip


def _notes(structure: Structure) -> list[str]:
    """Return what the results of a structure rest on, and what stands for a body in its drawing."""
    unknown = [unchecked(why=structure.mechanism.unchecked)] if check(structure).joints is None else []
    assumed = [f"{ASSUMED_NOTE}."] if any(part.assumed for part in picture(structure.mechanism).parts) else []
    return [restitution_used(structure), *unknown, *assumed]


def _enlarged(structure: Structure) -> str | None:
    """Return the file of a larger structure; None if what it carries does not grow as its weight does."""
    larger = structure.mechanism.enlarged(ENLARGEMENT)
    one, other = (each.model("nonlinear") for each in (structure, structure.of(larger)))
    grown = np.array([*other.phi_cr, *other.lambda_, other.p * np.sqrt(ENLARGEMENT)])
    alike = np.allclose(grown, [*one.phi_cr, *one.lambda_, one.p], rtol=ALIKE)
    crushes = one.joints is not None and np.isfinite(one.joints.bearing[:, 1]).any()
    return structure_text(larger) if alike and not crushes else None


def _model(model: Model) -> dict[str, Any]:
    """Return a model as the arrays of the kernel, and what the answers need of it."""
    deck = lay_out([model], [None])
    joints, tables = deck.joints, model.joints
    cells, fine = int(joints.sizes[0, 3]), len(joints.within) // 2
    return {
        "deck": {
            **{key: packed(getattr(deck, key)) for key in ("structures", "numbers", "smooth", "held", "corners")},
            "certain": packed(deck.certain, "smooth"),
            "forces": packed(deck.forces, "cubics"),
            "angles": packed(deck.angles, "cubics"),
        },
        "joints": {
            **{key: packed(getattr(joints, key)) for key in joints._fields if key not in ("rows", "within")},
            "rows": packed(joints.rows, "grid", cells) if cells else packed(joints.rows),
            "within": packed(joints.within, "smooth", fine) if fine else packed(joints.within),
        },
        "phiCr": list(model.phi_cr),
        "restitution": list(model.eta),
        "mostRestitution": list(model.most_eta),
        "reach": model.reach if tables is not None else None,
        "limit": tables.limit if tables is not None else None,
        "labels": list(tables.labels) if tables is not None else [],
        "sliding": [int(each) for each in tables.sliding] if tables is not None else [],
        "atLimit": list(model.ends_at_limit),
        "bounds": [None if each is None else each.words for each in model.bounds],
        "slidesFrom": None if model.sliding is None else slides_from(model.sliding),
        "slidesAt": None if model.sliding is None else slides_at(model.sliding),
        "oneSided": model.one_sided is not None,
    }


def _neighbours(structure: Structure, around: Neighbourhood) -> dict[str, Any]:
    """Return the neighbours of a structure as drawn, and what the page needs to draw those of another restitution."""
    model = structure.model("nonlinear")
    given = structure.under(restitution=min(1.0, *model.most_eta) / 2).model("nonlinear")  # any one that is given
    drawn, of = around.drawn(model), around.of(model)
    return {
        "slender": packed(drawn.slender),
        "restitution": packed(drawn.eta),
        "spread": around.of(given).restitution,
        "deviations": deviations(of),
        "deviationsGiven": deviations(around.of(given)),
    }


def page(offered: Exploration) -> str:
    """Return the text of the page."""
    motion, names = offered.given.motion, in_short([each.name for each in offered.structures])
    still = inline_svg(partial(draw_structure, picture(offered.structures[0].mechanism), ""), "still")
    told = "".join(f"<p>{html.escape(each)}</p>" for each in first_shown(offered))
    given = f"given: {motion.name}, PGA {motion.pga_g * abs(offered.given.factor):.3g} g; nonlinear model"
    parts = {
        "TITLE": html.escape(f"{names}: what if?"),
        "ABOUT": html.escape(given),
        "STYLE": asset("motion.css") + asset("explore.css"),
        "STILL": f"{told}{still}",
        "DATA": as_script(data_of(offered)),
        "KERNEL": asset("kernel.js"),
        "SCRIPT": asset("motion.js") + asset("explore.js"),
    }
    return printable(re.sub(f"@({'|'.join(parts)})@", lambda match: parts[match[1]], asset("explore.html")))
