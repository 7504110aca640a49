"""What `rocking respond`, `rk.respond`, `rk.respond_around` and `rk.respond_each` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import model_validator

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import (
    ANY_MOTIONS,
    DEVIATIONS,
    Around,
    EngineName,
    Excited,
    FromTilt,
    ModelName,
    Motion,
    Motions,
    OfJoints,
    OfRestitution,
    OfStructure,
    Reading,
    StructureLike,
    WithTable,
    neighbours,
    plot_file,
    table_file,
)
from rocking_cli.ask.kinds import FILE, INTERVAL, NUMBER, POSITIVE, TAIL, WHOLE, each, output, several, word
from rocking_cli.errors import InputError, named
from rocking_cli.names import FINEST_RTOL, RTOL, TAIL_SECONDS
from rocking_cli.processing.reading_options import ALL_AZIMUTHS
from rocking_cli.units import KINDS

if TYPE_CHECKING:
    from typing import Self

    from numpy.typing import ArrayLike

    from rocking_cli.excitation.base import GroundMotion
else:  # heavy to import, and not checked by the model
    ArrayLike = GroundMotion = Any

PulseShape = Literal["best", "sine", "ricker", "mavroeidis"]
"""Shapes that are fitted to a record."""
NEIGHBOURS_ON_TERMINAL = 200  # neighbours of a motion on the terminal


class OfModels(AskedModel):
    """A question about motions by one model or several."""

    model: ModelName | Sequence[ModelName] | None = option(
        "One model or several: nonlinear (the mechanism itself), and its equivalent block (linear1, linear2).",
        several(word("nonlinear", "linear1", "linear2", what="model"), "MODEL,..."), min_length=1,
        usual="all, or nonlinear alone if the others mislead",
    )  # fmt: skip

    def models(self, usual: Sequence[Any]) -> tuple[Any, ...]:
        """Return the models, each once; `usual` if none is given."""
        return tuple(dict.fromkeys(self.model or usual))


class ByTolerance(AskedModel):
    """How exact a nonlinear history is."""

    rtol: float = option(
        "Relative error tolerance per step of the nonlinear integration.", POSITIVE, default=RTOL, ge=FINEST_RTOL, lt=1
    )


class OfOneMotion(AskedModel):
    """What else is there under a motion: its vertical component, and the pulse in it."""

    heading: ClassVar[str] = "Ground motions"
    vertical: GroundMotion | Path | None = option(
        "Vertical component of the motion, or its file: g becomes g + v_g''.", FILE
    )
    vertical_dt: float | None = option(
        "Sampling interval of the vertical component, if its file has no times.", INTERVAL
    )
    vertical_channel: str | None = option("Channel of the vertical component in its file.", Kind(str, "CHANNEL"))
    transverse: GroundMotion | str | Path | None = option(
        "Component of the motion along the depth of the body, in three dimensions: a file, or a pulse such as "
        "sine:0.2g:0.8s.",
        FILE,
    )
    transverse_channel: str | None = option("Channel of the transverse component in its file.", Kind(str, "CHANNEL"))
    with_pulse: PulseShape | None = option(
        "Shape of the pulse in the record whose response is computed as well; without a value, the best-fitting one.",
        alone="best",
    )


class InSpace(AskedModel):
    """Whether the structure moves in three dimensions, and its shape there."""

    in_space: bool = option(
        "Simulate a single free body in three dimensions (experimental), under the motion along its width.",
        default=False, typed="3d",
    )  # fmt: skip
    mesh: Path | None = option(
        "Mesh of the body, its shape in three dimensions: OBJ, PLY or STL, z upwards, the motion along x.", FILE
    )
    mesh_units: str | None = option("Unit of the coordinates of the mesh.", word(*KINDS["length"], what="unit"))


class Shown(AskedModel):
    """What is shown of a response."""

    heading: ClassVar[str] = "Output"
    impacts: bool = option(
        "List the impacts: time, and angular velocity before and after; in a table the first, without chatter.",
        default=False,
    )
    contact: bool = option(
        "Plot the friction required as well; automatic if the file gives friction.", default=False, only_in="plot"
    )
    each_block: bool = option(
        "Make the table the motion of each block, by the nonlinear model: time, block, x, z of its centroid, rotation.",
        default=False, only_in="out",
    )  # fmt: skip
    title: str | None = option(
        "Title of tables and plot.", Kind(str), where="Python", usual="the name of the structure"
    )


def _near(given: Mapping[str, Any], *, as_json: bool) -> int:
    """Return the number of neighbours of a command: by free blocks none, as each of them takes long."""
    return 0 if given.get("engine") in WITH_BLOCKS else NEIGHBOURS_ON_TERMINAL


WITH_BLOCKS = ("blocks", "auto")
NOT_BY_ENGINES = ("model", "with_pulse")
"""Fields that cannot be combined with free blocks that were requested."""
NOT_OF_BLOCKS = (
    *NOT_BY_ENGINES, "rtol", "opening", "impacts", "contact", "each_block", "restitution", "restitution_deviation",
    "neighbours", "out", "plot", "animate",
)  # fmt: skip
"""Fields that have no effect if free blocks alone simulate."""
NOT_IN_SPACE = (
    *NOT_BY_ENGINES, "rtol", "opening", "impacts", "contact", "each_block", "restitution", "neighbours", *DEVIATIONS,
    "animate", "release", "tail", "other", "other_channel", "azimuth",
)  # fmt: skip
IN_SPACE = ("transverse", "transverse_channel", "mesh", "mesh_units")
"""Fields that have no effect in three dimensions, and those that have one there alone."""


class RespondAsked(
    OfStructure, Excited, OfOneMotion, InSpace, OfModels, ByTolerance, OfRestitution, OfJoints, Around,
    Shown, WithTable,
):  # fmt: skip
    """Compute the rocking response of a structure to a ground motion, a release from a tilt, or both.

    The model nonlinear is the mechanism itself; linear1 and linear2 are its equivalent block with kappa1 and kappa2. A
    positive rotation is clockwise and is started by a ground acceleration to the left. Every motion is simulated,
    beyond the end of the record if necessary, until the structure is at rest or certain to overturn. With --polarity
    both, the responses to the two polarities are computed one after the other.

    Where the outcome of a single motion is unknown, free blocks go on by themselves: the same bodies with contact and
    friction, simulated by MuJoCo (pip install 'rocking-cli[blocks]'). If they would take longer than some seconds, only
    --engine auto lets them; --engine exact leaves them out; --engine blocks simulates them always. The output then has
    the outcome and the peak by each engine, when their rotations part, the friction that each requires, and how far the
    joints open that the mechanism keeps closed. Restitution has no effect on free blocks: it is what their contacts
    give. They overturn when a block falls by 0.15 of the structure's height, or turns by 0.8 rad. With --3d, a single
    body rocks, rolls, turns and slides in three dimensions (experimental).

    With several motions, the output has one row per motion (with --json, one object per line), and --out and --plot
    write one file per motion, with its name in the file name. A motion that cannot be used is reported and skipped, and
    the exit code is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking respond frame.yaml --record accel.csv --plot response.png
      rocking respond frame.yaml --record "records/*.AT2" --target-pga 0.4
      rocking respond --record accel.txt --dt 0.01 --units g --target-pga 0.4 --polarity both
      rocking respond arch.yaml --release 0.5
      rocking respond column.yaml --release 0.05rad
      rocking respond frame.yaml --pulse ricker:0.4g:1.2s --polarity both
      rocking respond frame.yaml --record accel.csv --with-pulse --plot response.png
      rocking respond arch.yaml --record accel.csv --scale 2 --engine blocks --animate both.html
      rocking respond statue.yaml --record x.AT2 --engine blocks --3d --transverse y.AT2 --vertical z.AT2
    """

    writes_each: ClassVar[bool] = True
    motions: Motion | Sequence[Motion] | Motions | None = option(ANY_MOTIONS, where="input")  # type: ignore[assignment]
    engine: EngineName | None = option(
        "Engine: exact (one degree of freedom), blocks (free blocks beside it), or auto (blocks beside it if exact "
        "tells no outcome).",
        usual="auto for a single motion, as far as free blocks are installed and take few steps; otherwise exact",
    )
    tail: float = option("Length of output after the end of the record.", TAIL, default=TAIL_SECONDS)
    # Whoever reads one answer on a terminal should see how close it is; a program asks often, and for speed.
    neighbours: int = neighbours(
        default=0,
        on_terminal=_near,
        usual=f"{NEIGHBOURS_ON_TERMINAL} on the terminal, 0 in Python and with free blocks",
    )
    out: Path | None = table_file("Write the time histories", ".parquet")
    plot: Path | None = plot_file("Plot the time histories")
    animate: Path | None = option(
        "Animate one degree of freedom, with free blocks beside it if they simulate the motion: .gif, .mp4 (requires "
        "ffmpeg), or .html, a self-contained page with a slider.",
        output(".html", ".gif", ".mp4"),
    )
    idle = (
        Idle(
            "with {azimuth} all: give one angle", lambda asked: asked.all_around,
            ("polarity", "with_pulse", *Shown.model_fields, "tail", "neighbours", "engine", "animate"),
        ),
        Idle(
            "without a ground motion: give {motions}", lambda asked: not asked.ground_motions,
            ("polarity", "vertical", "vertical_dt", "vertical_channel", "neighbours", "animate", "in_space"),
        ),
        Idle("without {in_space}", lambda asked: not asked.in_space, IN_SPACE),
        Idle("without {engine} blocks", lambda asked: asked.engine != "blocks", ("in_space",)),
        Idle("in three dimensions", lambda asked: asked.in_space, NOT_IN_SPACE),
        Idle("without {transverse}", lambda asked: asked.transverse is None, ("transverse_channel",)),
        Idle("without {mesh}", lambda asked: asked.mesh is None, ("mesh_units",)),
        Idle("without a record", lambda asked: not asked.ground_motions.has_records, ("with_pulse",)),
        Idle(
            "with {polarity} both: give one polarity", lambda asked: asked.polarity == "both",
            ("with_pulse", "animate", "in_space"),
        ),
        Idle("without {vertical}", lambda asked: asked.vertical is None, ("vertical_dt", "vertical_channel")),
        Idle(
            "with several motions: give the one to which it belongs", lambda asked: asked.ground_motions.count > 1,
            ("vertical", "animate", "in_space"),
        ),
        Idle(
            "with free blocks that are requested: leave out {engine}, so that they go on by themselves",
            lambda asked: asked.engine in WITH_BLOCKS, NOT_BY_ENGINES,
        ),
        Idle("for free blocks", lambda asked: asked.engine == "blocks", ("restitution_deviation",)),
        Idle(
            "without free blocks: leave out {engine}, or use `rocking animate`", lambda asked: asked.engine == "exact",
            ("animate",),
        ),
        Idle(
            "on linear blocks, which have no joints", lambda asked: "nonlinear" not in asked.models(("nonlinear",)),
            ("opening", "contact", "each_block"),
        ),
        Idle(
            "without the nonlinear model", lambda asked: "nonlinear" not in asked.models(("nonlinear",)), ("animate",)
        ),
        Idle("without neighbours", lambda asked: not asked.neighbours, DEVIATIONS),
    )  # fmt: skip

    @property
    def all_around(self) -> bool:
        """Whether the response is computed in all directions of a record and its second component."""
        return bool(self.ground_motions.reading.azimuth == ALL_AZIMUTHS)


class RespondAroundAsked(OfModels, FromTilt, ByTolerance):
    """Compute the response of a structure in every direction between two components."""

    structure: StructureLike = option("The structure, or its YAML file.", where="input in Python", default=...)
    one: Motion = option(
        "The component at 0 degrees: a motion, its file, or a pulse as text.", where="input in Python", default=...
    )
    other: Motion = option(
        "The component at 90 degrees, of equal length and sampling interval.", where="input in Python", default=...
    )
    scale: float = option("Scale factor on both.", NUMBER, default=1.0)


def _numbers(value: Any) -> Any:
    """Return numbers as an array with one dimension."""
    import numpy as np

    from rocking_cli.ask.ground_motions import type_in_words

    try:
        values = np.atleast_1d(np.asarray(value, dtype=np.float64))
    except (TypeError, ValueError):
        raise ValueError(f"must be numbers, got {type_in_words(value)}") from None
    if values.ndim > 1 or not values.size:
        raise ValueError(f"must be one number or a list of them, got an array of shape {values.shape}")
    return values


def _signs(value: Any) -> Any:
    """Return polarities as an array of whole numbers."""
    signs = _numbers((1, -1) if isinstance(value, str) and value == "both" else value)
    if wrong := [each for each in signs.tolist() if abs(each) != 1]:
        raise ValueError(f"must be 1 or -1, got {wrong[0]:g}")
    return signs.astype(int)


class RespondEachAsked(Reading, OfModels, OfJoints, WithTable):
    """Compute the outcome of every structure under every motion with every factor, polarity and restitution."""

    structures: StructureLike | Sequence[StructureLike] = option(
        "One structure or several, or their YAML files.", Kind(each), where="input in Python", default=..., min_length=1
    )
    motions: Motion | Sequence[Motion] = option(
        "One motion or several, their files, patterns such as `records/*.AT2`, or pulses as text; or samples in an "
        "array of shape (npts,), or (n, npts) for n motions, with `dt` [s] and `units`, both required.",
        where="input in Python", default=...,
    )  # fmt: skip
    scale: ArrayLike | None = option(
        "Scale factors on the motions; negative ones reverse them.", Kind(_numbers), usual="1"
    )
    target_pga: ArrayLike | None = option(
        "In place of `scale`: peak ground accelerations to which each motion is scaled [g], the third axis then.",
        Kind(_numbers),
    )
    polarity: ArrayLike | None = option(
        "Polarity of the motions, 1 or -1, or several or both, as a further axis.", Kind(_signs), usual="as given"
    )
    restitution: ArrayLike | None = option(
        "Ratios of the rotation rates after and before an impact, as a further axis; NaN for that of the structure.",
        Kind(_numbers),
    )
    histories: bool = option("Keep the rotations in time: `answer.rotation[model]` at `answer.time`.", default=False)
    jobs: int | None = option("Number of time histories at a time.", WHOLE, ge=1, usual="one for each processor")
    out: Path | None = table_file("Write the rows of `to_frame`, with units in the headings", ".parquet")

    @model_validator(mode="after")
    def _one_scale(self) -> Self:
        """Refuse two ways to scale."""
        if self.scale is not None and self.target_pga is not None:
            raise InputError(f"{named('scale')} and {named('target_pga')} cannot be combined: give one of them")
        return self
