"""Study why shares of 0.6 to 0.8 are stated where about half of the tests overturn: middle.json, in this folder.

    python -m validation.middle EXPERIMENTS [RUNS.npz]

EXPERIMENTS holds the tests of the granite boulders, see validation/granite.py. RUNS.npz, outside the repository,
keeps the time histories, which take a quarter of an hour on two processors; without it they are simulated anew.

What becomes of a symmetric body depends on the ratio of amplitude to slenderness and on the restitution only. So each
test is simulated for many values of both, and every way to draw neighbours is a set of weights on these histories.

middle.json has the standard deviations of the rule, and by it, in tests with a share of 0.6 to 0.8, number, mean stated
and observed share (with its interval) of all, of each specimen and of halves of the motions; the observed share in
several draws of neighbours; of all tests of each specimen the mean stated less the observed share in percentage points;
and by how many thousandths other ways to draw neighbours, or to describe the foot, change the mean log loss: each with
the value that is chosen on all tests, judged on halves of the motions (the mean of 100 divisions), on one specimen for
the other, and on all motions but one for this one.
"""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Callable, Sequence
from functools import cache, partial
from itertools import product
from math import atan, degrees, hypot, radians, tan
from multiprocessing import Pool
from pathlib import Path
from statistics import NormalDist
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from rocking_cli import load_structure, read_record
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import KINEMATIC_SPREAD, SLENDERNESS_SPREAD, Model
from rocking_cli.structure import Structure
from rocking_cli.studies import neighbours
from rocking_cli.studies.neighbours import Neighbourhood, simulate_neighbours
from rocking_cli.views.neighbours import deviations
from validation import granite
from validation.pages import prose
from validation.rules import ClusterDraws, ScoreEstimate, surprise

Reals = NDArray[np.float64]

FILE = Path(__file__).with_suffix(".json")
NAMES = tuple(granite.SPECIMENS)

POINTS = 2000  # histories of each test
WIDE, DEEP = 0.2, 0.35  # of these: deviation of ln(amplitude/slenderness), and largest loss of restitution
FURTHER = (1.25, 1.5, 2.0, 2.5)  # angle of the other edge of the foot over that of the first one
SEEDS = range(neighbours.SEED, neighbours.SEED + 12)
RULE = Neighbourhood(restitution=KINEMATIC_SPREAD, slenderness=SLENDERNESS_SPREAD)
LOW, HIGH = 0.6, 0.8
HALVINGS = 100
FEW = 5  # tests with the largest change of the log loss


def points() -> tuple[Reals, Reals, Reals]:
    """Return ln(amplitude/slenderness) and the restitution of the histories of a test, and one over their density."""
    k = np.arange(1, POINTS + 1)
    u, v = (k * 0.7548776662466927 + 0.5) % 1, (k * 0.5698402909980532 + 0.5) % 1  # evenly spread over a square
    z = np.array([NormalDist().inv_cdf(each) for each in u.tolist()])
    return WIDE * z, 1 - DEEP * v**1.5, np.exp(z**2 / 2) * np.sqrt(v)


@cache
def model(folder: Path, name: str, further: float = 1.0) -> Model:
    """Return the model of a boulder; the angle of the other edge of its foot is `further` times that of the first."""
    path = folder / f"{name}_{further:g}.yaml"
    text = (folder / f"{name}.yaml").read_text(encoding="utf-8")
    if further > 1:
        height, _, angle = granite.SPECIMENS[name]
        half, other = height * tan(radians(angle)), height * tan(radians(further * angle))
        text = text.replace(f"[{-half:.9g}, ", f"[{-other:.9g}, ")
        text += f"negative: {{lead: rock, joints: {{O: {{pivot: rock, at: [{-other:.9g}, 0]}}}}}}\n"
    path.write_text(text, encoding="utf-8", newline="\n")
    return Structure(load_structure(path)).model("nonlinear")


def simulate(folder: Path, test: str) -> tuple[NDArray[np.bool_], Reals, Reals]:
    """Return of both boulders in a test which points overturn, the share of each seed, and that of each foot."""
    motion = read_record(folder / "records" / f"{test}.csv")
    x, eta, _ = points()

    def share(body: Model, sign: int = 1) -> float:
        return float(simulate_neighbours(body, motion, RULE.drawn(body), polarity=sign, threads=1).fell.mean())

    fell, seeds, feet = [], [], []
    for name in NAMES:
        own = model(folder, name)
        runs = Runs.of(0, 0, scale=np.exp(x), eta=eta)
        fell.append(respond_many([own], [motion], runs, only_peaks=True, threads=1).fell)
        feet.append([(share(foot, 1) + share(foot, -1)) / 2 for foot in (model(folder, name, f) for f in FURTHER)])
        seeds.append([])
        for neighbours.SEED in SEEDS:
            seeds[-1].append(share(own))
        neighbours.SEED = SEEDS[0]
    return np.array(fell), np.array(seeds), np.array(feet)


def edges(path: Path) -> list[float]:
    """Return by what a scanned boulder turns about the edges of its resting facet until it is balanced [deg]."""
    with path.open(encoding="utf-8") as lines:
        vertices = np.array([[float(v) for v in line.split()[1:4]] for line in lines if line.startswith("v ")])
    centre = vertices.mean(axis=0)
    for _ in range(3):  # the solid is made of pyramids from its centroid to all facets
        reach = vertices - centre
        facets = reach[ConvexHull(reach / np.linalg.norm(reach, axis=1)[:, None]).simplices]
        volumes = np.abs(np.linalg.det(facets))
        centre = centre + volumes @ facets.sum(axis=1) / (4 * volumes.sum())
    hull = ConvexHull(vertices - centre)
    for corners, (*normal, offset) in zip(hull.points[hull.simplices], hull.equations, strict=True):
        shares = np.linalg.solve(corners.T, -offset * np.array(normal))  # of each corner in the foot of the centroid
        if normal[2] < -0.99 and shares.min() >= 0:
            sides = np.linalg.norm(np.roll(corners, 1, axis=0) - np.roll(corners, -1, axis=0), axis=1)
            area = np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
            return sorted(degrees(atan(each)) for each in (shares * area / sides / -offset).tolist())
    raise ValueError(f"{path}: rests on no facet")


class Candidate(NamedTuple):
    """A way to state shares: what it does, the values among which it chooses, and the shares by each of them."""

    words: str
    values: Sequence[str]
    shares: Reals  # (values, tests, specimens)


class Study:
    """The tests, and the shares that different ways to draw neighbours state of them."""

    def __init__(self, source: Path, fell: NDArray[np.bool_], seeds: Reals, feet: Reals) -> None:
        with (source / "granite_boulders.csv").open(encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        self.seen = np.array([[float(row[name]) for name in NAMES] for row in rows])
        self.pga, self.pgv = (np.array([[float(row[k])] * 2 for row in rows]) for k in ("pga_acc_g", "pgv_disp_ms"))
        motions = [row["motion"] for row in rows]
        self.draws = ClusterDraws([name for name in motions for _ in NAMES])
        self.cluster = self.draws.of.reshape(-1, 2)[:, 0]
        self.fell, self.seeds, self.feet = fell.astype(np.float64), seeds, feet
        self.eta = [self.own_eta(name) for name in NAMES]
        self.edges = edges(source / "granite_specimen_2.obj")
        self.rule = self.shares()

    @staticmethod
    def own_eta(name: str) -> float:
        """Return the restitution of the kinematics of a boulder."""
        height, gyration, angle = granite.SPECIMENS[name]
        half = height * tan(radians(angle))
        return 1 - 2 * half**2 / (height**2 + half**2 + gyration)

    def shares(
        self, slenderness: float = SLENDERNESS_SPREAD, restitution: float = KINEMATIC_SPREAD,
        stout: float = 0.0, density: Callable[[Reals], Reals] | None = None,
    ) -> Reals:  # fmt: skip
        """Return the share of each test, shape (tests, specimens).

        Parameters
        ----------
        slenderness, restitution : float
            Standard deviations, of ln slenderness and of the restitution below 1.
        stout : float
            Mean of ln slenderness.
        density : callable, optional
            Density of the loss of restitution, instead of the normal one around the value of the kinematics.
        """
        x, eta, weight = points()
        weight = weight * np.exp(-0.5 * ((x + stout) / hypot(RULE.amplitude, slenderness)) ** 2)
        found = []
        for k, own in enumerate(self.eta):
            w = weight * (density(1 - eta) if density else np.exp(-0.5 * ((eta - own) / restitution) ** 2))
            found.append(self.fell[:, k] @ w / w.sum())
        return np.stack(found, axis=-1)

    def loss(self, shares: Reals) -> Reals:
        """Return the log loss of each test."""
        return surprise(shares, self.seen, RULE.count)

    def candidates(self) -> list[Candidate]:
        """Return the ways that are compared with the rule."""

        def by(words: str, values: Sequence[object], shares: Callable[..., Reals]) -> Candidate:
            made = [shares(*each) if isinstance(each, tuple) else shares(each) for each in values]
            said = [" and ".join(f"{v:g}" for v in each) if isinstance(each, tuple) else f"{each:g}" for each in values]
            return Candidate(words, said, np.array(made))

        scatter, wide = (0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.1), (0.05, 0.08, 0.1, 0.12, 0.15, 0.18, 0.2)
        tails = (0.02, 0.03, 0.04, 0.05, 0.06, 0.07)
        odds = np.log(np.clip(self.rule, 0.002, 0.998) / (1 - np.clip(self.rule, 0.002, 0.998)))
        # The other edge is drawn evenly between the first angle and a multiple of it.
        feet = np.concatenate([self.rule[..., None], self.feet], axis=-1).cumsum(axis=-1)
        edges = (1.0, *FURTHER)
        return [
            by("scatter of slenderness (and of amplitude)", wide, lambda s: self.shares(slenderness=s)),
            by("scatter of restitution", scatter, lambda s: self.shares(restitution=s)),
            by("both scatters", list(product(wide, scatter)), self.shares),
            by("exponential tail of restitution, mean loss", tails,
               lambda m: self.shares(density=lambda loss: np.exp(-loss / m))),
            by("gamma tail of restitution, mean loss", tails,
               lambda m: self.shares(density=lambda loss: loss * np.exp(-2 * loss / m))),
            by("median of slenderness, factor", (0.9, 0.95, 1.0, 1.05, 1.1), lambda f: self.shares(stout=np.log(f))),
            by("third source: other edge of the foot, up to the factor", edges,
               lambda f: feet[..., edges.index(f)] / (edges.index(f) + 1)),
            by("ln of stated odds, factor and addend", list(product((0.6, 0.8, 1.0, 1.2), (-0.6, -0.3, 0.0, 0.3))),
               lambda a, b: 1 / (1 + np.exp(-a * odds - b))),
        ]  # fmt: skip

    def splits(self) -> dict[str, list[list[NDArray[np.bool_]]]]:
        """Return the ways to split the tests: for each, repetitions of parts, each of which is left out in turn."""
        every, random = np.arange(self.draws.count), np.random.default_rng(neighbours.SEED)
        second = np.broadcast_to(np.arange(2) == 1, self.seen.shape)

        def tests(clusters: NDArray[np.int64]) -> NDArray[np.bool_]:
            return np.broadcast_to(np.isin(self.cluster, clusters)[:, None], self.seen.shape)

        halves = [tests(random.permutation(every)[: every.size // 2]) for _ in range(HALVINGS)]
        return {
            "halves": [[half, ~half] for half in halves],
            "specimens": [[second, ~second]],
            "one motion left out": [[tests(each) for each in every]],
        }

    def left_out(self, losses: Reals, parts: Sequence[NDArray[np.bool_]]) -> Reals:
        """Return the loss of each test by the value that is best on all other parts, shape (tests, specimens)."""
        found = np.empty(self.seen.shape)
        for part in parts:
            found[part] = losses[losses[:, ~part].mean(axis=1).argmin()][part]
        return found


def thousandths(each: ScoreEstimate) -> list[float]:
    """Return a change of the log loss in thousandths, with its interval."""
    return [round(1000 * value, 1) for value in each[:3]]


def middle(study: Study, shares: Reals, inside: NDArray[np.bool_] | None = None) -> dict[str, Any]:
    """Return the number of tests in the middle of the scale, what is stated of them, and what was observed."""
    kept = (shares >= LOW) & (shares < HIGH) & (True if inside is None else inside)
    seen = study.draws.mean(study.seen.ravel(), kept.ravel())
    observed = [round(value, 3) for value in (seen.value, seen.low, seen.high)]
    return {"tests": int(kept.sum()), "stated": round(float(shares[kept].mean()), 3), "observed": observed}


def where(study: Study) -> dict[str, Any]:
    """Return where the tests in the middle are."""
    rule, both = study.rule, np.ones(study.seen.shape, dtype=bool)
    kept = (rule >= LOW) & (rule < HIGH)
    parts = {"all": both} | {f"specimen {k + 1}": both & (np.arange(2) == k) for k in range(2)}
    for words, value in (("PGA", study.pga), ("PGV", study.pgv)):
        low = value <= np.median(value[kept])
        parts |= {f"lower half by {words}": low, f"upper half by {words}": ~low}
    return {words: middle(study, rule, inside) for words, inside in parts.items()}


def compared(study: Study) -> list[dict[str, Any]]:
    """Return the candidates, and of each that is better however the tests are split, what few tests gain of it [%]."""
    own, splits = study.loss(study.rule), study.splits()
    rows = []
    for words, values, shares in study.candidates():
        losses = study.loss(shares)
        best = int(losses.mean(axis=(1, 2)).argmin())
        found = {
            name: study.draws.mean((np.mean([study.left_out(losses, each) for each in parts], axis=0) - own).ravel())
            for name, parts in splits.items()
        }
        change = losses[best] - own
        few = 100 * np.sort(change.ravel())[:FEW].sum() / change.sum()
        better = {"of its gain by few tests": round(few)} if all(each.high < 0 for each in found.values()) else {}
        judged = {name: thousandths(each) for name, each in found.items()}
        rows.append({"what": words, "value": values[best], **judged, **middle(study, shares[best]), **better})
    return rows


def found(study: Study) -> dict[str, Any]:
    """Return what the file holds."""
    own, kept = study.loss(study.rule), (study.rule >= LOW) & (study.rule < HIGH)
    motions = np.bincount(study.cluster, kept.sum(axis=1)).astype(int)
    bias = [study.draws.mean(np.where(np.arange(2) == k, study.rule - study.seen, np.nan).ravel()) for k in range(2)]
    stout = study.loss(study.feet[..., FURTHER.index(2.0)]) - own
    foot = [study.draws.mean(np.where(np.arange(2) == k, stout, np.nan).ravel()) for k in range(2)]
    draws = [float(study.seen[(each >= LOW) & (each < HIGH)].mean()) for each in np.moveaxis(study.seeds, -1, 0)]
    return {
        "rule": deviations(RULE),
        "tests": where(study),
        "motions": {"number": int((motions > 0).sum()), "most tests of one": int(motions.max())},
        "draws": {"number": len(draws), "observed": [round(x, 3) for x in (min(draws), max(draws), np.mean(draws))],
                  "of the tool": round(draws[0], 3)},
        "stated less observed": [[round(100 * value, 1) for value in each[:3]] for each in bias],
        "log loss": round(float(own.mean()), 4),
        "candidates": compared(study),
        "other edge at twice the angle": [thousandths(each) for each in foot],
        "edges of the foot of specimen 2": [round(each, 1) for each in study.edges],
    }  # fmt: skip


def stale() -> list[str]:
    """Return whether the rule has changed since the study was made."""
    rule, now = json.loads(FILE.read_text(encoding="utf-8"))["rule"], deviations(RULE)
    return [] if rule == now else [f"the rule has {now}"]


def summary() -> str:
    """Return the part of the page."""
    said = json.loads(FILE.read_text(encoding="utf-8"))
    tests, draws, bias = said["tests"], said["draws"], said["stated less observed"]

    def interval(values: Sequence[float], form: str) -> str:
        value, low, high = (format(each, form) for each in values)
        return f"{value} [{low} {high}]"

    least, most, mean = draws["observed"]
    better = [
        f"{each['what']}, {each['value']}. {FEW} tests make {each['of its gain by few tests']} % of its gain, and its "
        f"shares of 0.6 to 0.8 are {100 * (each['stated'] - each['observed'][0]):.1f} points too high"
        for each in said["candidates"] if "of its gain by few tests" in each
    ]  # fmt: skip
    every, ways = tests["all"], len(said["candidates"])
    return prose(
        f"The rule has {said['rule']}. Without the chance of a draw, {every['tests']} tests have such a share: stated",
        f"{every['stated']:.3f}, observed {interval(every['observed'], '.3f')}. In {draws['number']} draws of",
        f"{RULE.count} neighbours, the observed share is {least:.3f} to {most:.3f}, mean {mean:.3f}. Of all tests, the",
        f"mean stated share is above the observed one by {interval(bias[0], '.1f')} percentage points for specimen 1,",
        f"and by {interval(bias[1], '.1f')} for specimen 2. Of {ways} other ways to draw neighbours or to describe the",
        f"foot, {len(better)} has a smaller log loss, with the whole interval below 0, on whichever part of the tests",
        f"its value is not chosen{': ' * bool(better)}{'; '.join(better)}.",
    )


def main() -> int:
    """Simulate what is not there yet, and write the file."""
    if len(sys.argv) not in (2, 3):
        print(__doc__)
        return 2
    source, kept = Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None
    if kept is not None and kept.is_file():
        with np.load(kept) as stored:
            runs = [stored[name] for name in ("fell", "seeds", "feet")]
    else:
        with TemporaryDirectory() as made, Pool() as pool:
            granite.write(source, Path(made))
            with (source / "granite_boulders.csv").open(encoding="utf-8") as stream:
                tests = [row["test"] for row in csv.DictReader(stream)]
            parts = pool.map(partial(simulate, Path(made)), tests, chunksize=3)
        runs = [np.array(part) for part in zip(*parts, strict=True)]
        if kept is not None:
            np.savez_compressed(kept, **dict(zip(("fell", "seeds", "feet"), runs, strict=True)))
    text = json.dumps(found(Study(source, *runs)), indent=1)
    FILE.write_text(f"{text}\n", encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
