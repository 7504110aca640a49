"""What `rocking fragility` and `rk.fragility` are asked: the fields of a study, and how it is run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from pydantic import model_validator

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import EngineName, ModelName, Polarity
from rocking_cli.ask.kinds import FOLDER, SHARE, WHOLE, as_given, output
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from distributed import Client
    from numpy.typing import ArrayLike

    from rocking_cli.core import Mechanism
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse

    Shaken = Mechanism | str | Path | Mapping[str, Any]
    """A structure of a study in Python, its file, or an entry with either of them as `file`."""
    Shaking = GroundMotion | Pulse | str | Path | Mapping[str, Any]
    """A ground motion of a study in Python, a file or a pattern, a pulse as text, or an entry."""
else:  # heavy to import, and not checked by the model
    ArrayLike = Client = Shaken = Shaking = Any

UPLIFT, OVERTURNING, SLIDING = "uplift", "overturning", "sliding"
MAX_LEVELS = 100_000  # levels of intensity, or samples: more is a typing error
in_file = partial(option, where="Python")


def _part(value: Any) -> tuple[int, int]:
    """Return the part and the number of parts of a text such as 3/40, or of two numbers."""
    try:
        k, parts = (int(each) for each in (value.split("/") if isinstance(value, str) else value))
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is not a part of the runs: give a text such as 3/40") from None
    if not 1 <= k <= parts:
        raise ValueError(f"{value!r} is not a part of the runs: 1/40 is the first of 40, and 40/40 the last")
    return k, parts


def confidence() -> Any:
    """Declare the confidence of a fit."""
    return in_file("Confidence level of intervals and bands.", SHARE, default=0.95, gt=0.5, lt=1)


class FitFragilityAsked(AskedModel):
    """Fit a fragility curve to data of one's own."""

    intensity: ArrayLike = option(
        "Intensity of each run, in any unit. Runs whose intensity is not above zero, or NaN, have no logarithm and are "
        "left out.",
        where="input in Python", default=...,
    )  # fmt: skip
    exceeded: ArrayLike = option(
        "Whether each run exceeds the limit state: 1 or True, 0 or False; NaN if that is unknown. Unknown runs are "
        "counted as exceeding in the fit, and as not exceeding in its `lower`: more than 2 % of them make a band.",
        where="input in Python", default=...,
    )  # fmt: skip
    clusters: ArrayLike | None = option(
        "What runs have in common, such as the names of their records or sites: runs of one cluster are not "
        "independent. By default each run is independent of the others.",
        where="input in Python",
    )  # fmt: skip
    curve: Literal["lognormal", "logit"] = in_file(
        "P = Phi(ln(x/median)/dispersion), or P = 1/(1 + (median/x)^b) with b = pi/(sqrt(3) dispersion), logistic in "
        "ln x.",
        default="lognormal",
    )
    confidence: float = confidence()
    label: str = in_file(
        "Name of the intensity with its unit, such as `PGA [g]`, for the plot and the frame.",
        Kind(str), default="intensity",
    )  # fmt: skip


class OfStudy(AskedModel):
    """The fields of a study: keys of its file, and arguments in Python."""

    structures: Shaken | Sequence[Shaken] = option(
        "Structures or their files; or entries with a structure or a file as `file`, and `name` and `vary`, the "
        "distributions of uncertain fields. In Python also the file of a whole study, or its fields, without motions.",
        where="input", default=..., typed="STUDY.yaml",
    )  # fmt: skip
    motions: Shaking | Sequence[Shaking] | None = option(
        "Ground motions: files of records, patterns such as `records/*.AT2`, lists of records, and pulses such as "
        "`ricker:1g:0.8s`; or entries with a motion or a file as `file` (and `units`, `dt`, `channel`, `vertical`, "
        "`from`, `gain`, `with`, `azimuth`, `processing`, `floor`) or a `pulse`. An entry may have a `weight`, and the "
        "`level` to whose set of records it belongs.",
        where="input in Python",
    )  # fmt: skip
    processing: Sequence[str | Mapping[str, Any]] = in_file(
        "Corrections of every record, in their order, after its own.", default=[]
    )
    floor: str | Mapping[str, Any] | None = in_file("The floor of a building on which the structures stand.")
    method: Literal["cloud", "stripes", "ida"] | None = in_file(
        "How records and intensities are combined: each record as it is (cloud), every record at every level "
        "(stripes), or scaled up until the structure overturns (ida)."
    )
    levels: Mapping[str, Any] | None = in_file(
        "Intensities to which every record is scaled: `measure`, and either `values` or `least`, `most`, `count` (and "
        "`spacing: log`). A cloud may leave them out."
    )
    polarity: Polarity = in_file(
        "Polarity of the records: 1 as given, -1 reversed, both for two runs of each.", Kind(str), default="1"
    )
    restitution: Sequence[float] | None = in_file(
        "Coefficients of restitution to run one after the other, in both directions.", min_length=1,
        usual="those of the structures",
    )  # fmt: skip
    samples: int = in_file(
        "How many structures are drawn from the distributions in `vary`.", default=1, ge=1, le=MAX_LEVELS
    )
    sampling: Literal["random", "latin hypercube"] = in_file(
        "How they are drawn: latin hypercube or random.", default="latin hypercube"
    )
    seed: int = in_file("Seed of the random numbers.", default=0, ge=0, lt=2**63)
    model: ModelName = in_file("Equation of motion: nonlinear, linear1 or linear2.", default="nonlinear")
    engine: EngineName = in_file(
        "Who simulates the runs: one degree of freedom (exact), free blocks (blocks), or free blocks where one degree "
        "of freedom does not tell the outcome (auto). Free blocks run in processes unless `jobs` is 1: a script then "
        'needs `if __name__ == "__main__"`.',
        default="exact",
    )  # fmt: skip
    opening: float = in_file(
        "Largest opening or slip of a joint up to which a run holds, over D_cr.", SHARE, default=OPENING, ge=0, le=1
    )
    limit_states: Sequence[str | float] = in_file(
        f"Any of {UPLIFT}, {SLIDING}, {OVERTURNING}; numbers, that is values of phi/phi_cr (for a tied structure "
        "without a critical rotation: over its kinematic limit); and displacements of the top such as `25 mm`.",
        default=[UPLIFT, OVERTURNING], min_length=1,
    )  # fmt: skip
    measures: Sequence[str] | None = in_file(
        "Intensity measures over which curves are fitted.", min_length=1,
        usual="that of the levels and that of the hazard",
    )  # fmt: skip
    bivariate: Sequence[Sequence[str]] = in_file("Pairs of measures over which surfaces are fitted.", default=[])
    confidence: float = confidence()
    hazard: Mapping[str, Any] | None = in_file(
        "How often intensities are exceeded at the site, per year: `measure`, and `file` (CSV of intensity and annual "
        "rate, or hazard curve of OpenQuake) or `points`."
    )
    name: str | None = in_file("Name of the study.", usual="that of its file")


class OfCurves(AskedModel):
    """What is shown and written of the curves of a study, whose verb writes its files."""

    heading: ClassVar[str] = "Output"
    writes_each: ClassVar[bool] = True
    quantiles: bool = option(
        "Show quantiles of the peak rotation at each intensity: 16, 50 and 84 % of the runs.", default=False
    )
    rank_measures: bool = option(
        "Rank the intensity measures as well, by how well they predict the outcome.", default=False
    )
    plot: Path | None = option("Plot every curve into this folder, created if missing.", FOLDER)
    nrml: Path | None = option("Write the lognormal curves for OpenQuake (NRML 0.5).", output(".xml"))


SHOWN = (*OfCurves.model_fields,)


class FragilityAsked(OfStudy, OfCurves):
    """Run a fragility study and fit its curves.

    STUDY.yaml names structures, records, intensity levels and limit states; docs/fragility.md lists its fields.
    Finished runs are kept in a store, a folder next to the study file. You may stop the command at any time: the same
    command continues with the missing runs, and the final store is the same. `rocking results` shows and exports it;
    `rocking measures` lists the intensity measures that can be ranked.

    A record that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking fragility study.yaml --check
      rocking fragility study.yaml --plot pictures --rank-measures
      rocking fragility study.yaml --scheduler tcp://10.0.0.1:8786
      rocking fragility study.yaml --share 3/40
      rocking results study.runs --out runs.csv
    """

    heading: ClassVar[str] = "Options"
    check: bool = option("Show what would be run, without running it.", default=False)
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    scheduler: str | Client | None = option(
        "Address of a dask.distributed scheduler, or in Python a client of it, to run there.",
        Kind(as_given, "tcp://HOST:PORT"),
    )
    share: tuple[int, int] | None = option(
        "Run only this part of the runs, such as 3/40, into the store that all parts share, and fit no curves.",
        Kind(_part, "K/PARTS"), type="str | None",
    )  # fmt: skip
    store: Path | None = option(
        "Folder in which the runs are stored. Without one and a study file, the runs last as long as the answer.",
        FOLDER, usual="next to the study file, such as study.runs",
    )  # fmt: skip
    restart: bool = option("Start from scratch; the existing store is kept under another name.", default=False)
    idle = (
        Idle("if only the plan is shown", lambda asked: asked.check, ("jobs", "scheduler", "share", "restart", *SHOWN)),
        Idle(
            "with a part of the runs: give it in a command without a part, before or after all parts",
            lambda asked: asked.share is not None,
            ("restart", *SHOWN),
        ),
        Idle("on a cluster, which has its own number of workers", lambda asked: asked.scheduler is not None, ("jobs",)),
        Idle(
            "without a store or a study file",
            lambda asked: asked.store is None and asked.file is None,
            ("restart", "share"),
        ),
        Idle(
            "beside a study: put them into it, or give motions",
            lambda asked: asked.whole is not None,
            (*OfStudy.model_fields,)[2:],
        ),
    )

    @property
    def whole(self) -> str | Path | Mapping[str, Any] | None:
        """The file or the fields of a study that is given as a whole."""
        given = self.structures if self.motions is None else None
        return given if isinstance(given, str | Path | Mapping) else None

    @property
    def file(self) -> Path | None:
        """The file of the study; None if its fields are given."""
        return None if self.whole is None or isinstance(self.whole, Mapping) else Path(self.whole)

    @property
    def place(self) -> Path | None:
        """Where the store is; None for one that lasts as long as the answer."""
        return self.file.with_suffix(".runs") if self.store is None and self.file is not None else self.store

    @property
    def study(self) -> str | Path | Mapping[str, Any]:
        """The file of the study, or its fields by their keys in a file."""
        from rocking_cli.ask.ground_motions import each_of

        if self.whole is not None:
            return self.whole
        given = {name: each for name, each in self.part(OfStudy).items() if name not in ("structures", "motions")}
        return {**given, "structures": each_of(self.structures), "records": each_of(self.motions)}

    @model_validator(mode="after")
    def _has_motions(self) -> Self:
        """Refuse a structure without motions."""
        if self.motions is None and self.whole is None:
            raise InputError(Problem("is missing", field=named("motions"), hint="or give the file of a whole study"))
        return self
