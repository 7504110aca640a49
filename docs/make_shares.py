"""Compare the shares of overturning that are stated with what 600 shake-table tests showed.

The result is the part of docs/validation.md on shares, docs/validation_shares.md.

    python docs/make_shares.py FOLDER

FOLDER holds the granite boulders (`granite_boulders.csv`, `granite_motions_100hz.npz`): data outside the project.
Intervals are those of 2000 draws of the ground motions with replacement, 5 to 95 %.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from math import sqrt, tan
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rocking_cli import GroundMotion, Registry, build_models
from rocking_cli.dynamics.model import Model
from rocking_cli.studies.neighbours import Neighbourhood, neighbours

Reals = NDArray[np.float64]
PART = Path(__file__).resolve().with_name("validation_shares.md")
SHAPES = ((0.2943, 0.0510, 4.97), (0.2920, 0.0507, 5.47))  # height [m], squared radius of gyration [m2], angle [deg]
G = 9.80665
DRAWS, SEED = 2000, 7
BINS = 5


def boulder(height: float, gyration: float, angle: float) -> Model:
    """Return a body on an edge by the place of its centroid, with the restitution of its kinematics."""
    half = height * tan(np.radians(angle))
    shape = {
        "polygon": [[-half, 0.0], [half, 0.0], [half, 2 * height], [-half, 2 * height]],
        "mass": 100.0, "centroid": [0.0, height], "inertia": 100.0 * gyration,
    }  # fmt: skip
    side = {"lead": "rock", "joints": {"O": {"pivot": "rock", "at": [half, 0.0]}}}
    return build_models(Registry()["linkage"](bodies={"rock": shape}, positive=side), ("nonlinear",))[0]


def housner(height: float, gyration: float, angle: float) -> float:
    """Return the velocity step of the ground that just overturns the body [m/s]."""
    alpha = np.radians(angle)
    r = height / np.cos(alpha)
    return float(sqrt(2 * G * (gyration + r * r) * (r - height)) / height)


def tests(folder: Path) -> tuple[dict[str, Reals], Reals, Reals]:
    """Return the predictions of each rule, the outcomes and the number of the ground motion of every test."""
    shaken = np.load(folder / "granite_motions_100hz.npz")
    numbers = shaken["test"].tolist()
    specimens = [(boulder(*shape), shape, name) for shape, name in zip(SHAPES, ("sp1", "sp2"), strict=True)]
    rows: list[tuple[float, float, float, float]] = []
    motions: list[str] = []
    with (folder / "granite_boulders.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            k = numbers.index(int(row["test"]))
            part = slice(shaken["start"][k], shaken["start"][k] + shaken["length"][k])
            motion = GroundMotion(row["test"], 0.01, shaken["samples"][part] / 32767 * float(shaken["peak"][k]))
            for model, shape, name in specimens:
                share = neighbours(model, motion, Neighbourhood()).overturned
                west = float(float(row["pga_acc_g"]) > tan(np.radians(shape[2])))
                velocity = float(float(row["pgv_disp_ms"]) > housner(*shape))
                rows.append((share, west, velocity, float(row[name])))
                motions.append(row["motion"])
    share, west, velocity, seen = np.array(rows).T
    clusters = np.unique(motions, return_inverse=True)[1].astype(np.float64)
    base = np.array([seen[clusters != each].mean() for each in clusters])
    rules = {
        "neighbours": share,
        "base rate of all other ground motions": base,
        "PGA > g tan alpha (West)": west,
        "PGV > velocity step that overturns (Housner)": velocity,
    }
    return rules, seen, clusters


def brier(stated: Reals, seen: Reals) -> float:
    """Return the mean squared difference of shares and outcomes."""
    return float(np.mean((stated - seen) ** 2))


def log_loss(stated: Reals, seen: Reals) -> float:
    """Return the mean of -ln of the share stated for what happened; shares are held off 0 and 1."""
    off = 0.5 / (Neighbourhood().count + 1)
    held = np.clip(stated, off, 1 - off)
    return float(-np.mean(seen * np.log(held) + (1 - seen) * np.log(1 - held)))


def right(stated: Reals, seen: Reals) -> float:
    """Return the share of outcomes that the more likely one foretells."""
    return float(np.mean((stated > 0.5) == seen))


def gap(stated: Reals, seen: Reals) -> float:
    """Return the mean difference of stated and observed in five equal bins, weighted by tests."""
    return sum(abs(float((stated - seen)[inside].sum())) for inside in binned(stated)) / len(seen)


def binned(stated: Reals) -> list[NDArray[np.bool_]]:
    """Return which shares are in each of five equal bins."""
    place = np.minimum((stated * BINS).astype(int), BINS - 1)
    return [place == k for k in range(BINS)]


SCORES: dict[str, Callable[[Reals, Reals], float]] = {
    "right": right, "Brier score": brier, "log loss": log_loss, "gap": gap,
}  # fmt: skip


def page(rules: dict[str, Reals], seen: Reals, clusters: Reals) -> str:
    """Return the part of the page."""
    random = np.random.default_rng(SEED)
    groups = [np.flatnonzero(clusters == each) for each in np.unique(clusters)]
    draws = [np.concatenate([groups[k] for k in random.integers(len(groups), size=len(groups))]) for _ in range(DRAWS)]

    def cell(score: Callable[[Reals, Reals], float], stated: Reals) -> str:
        low, high = np.quantile([score(stated[draw], seen[draw]) for draw in draws], (0.05, 0.95))
        return f"{score(stated, seen):.3f} [{low:.3f} {high:.3f}]"

    table = [f"| prediction | {' | '.join(SCORES)} |", "|---" * (1 + len(SCORES)) + "|"]
    for name, stated in rules.items():
        table.append(f"| {name} | {' | '.join(cell(score, stated) for score in SCORES.values())} |")
    stated = rules["neighbours"]
    bins = ["| stated share | tests | mean stated | observed |", "|---|---|---|---|"]
    for k, inside in enumerate(binned(stated)):
        numbers = f"{inside.sum()} | {stated[inside].mean():.3f} | {seen[inside].mean():.3f}"
        bins.append(f"| {k / BINS:.1f} to {(k + 1) / BINS:.1f} | {numbers} |")
    return f"""## Shares of overturning, stated and observed

{len(seen)} shake-table tests of two granite boulders under {len(groups)} ground motions at several intensities. The
data are those of Chen and others (virtual_shake_robot), and not part of this project. Each boulder is a rigid body on
the first edge of its foot, with the restitution of its kinematics. The share is that of 200 neighbours, drawn as
`rocking respond` draws them. The gap is the mean difference between stated and observed shares in the five bins below,
weighted by tests. Brackets hold 5 to 95 % of {DRAWS} draws of the ground motions.

{chr(10).join(table)}

{chr(10).join(bins)}

A forecaster without fault would have a Brier score of about 0.05 here and a gap of 0.02: the two boulders, which are
nearly identical, had the same outcome in 88 % of the tests only. `docs/make_shares.py` makes this part;
`tests/test_shares.py` checks a third of it.
"""


def main() -> int:
    """Write the part of the page."""
    PART.write_text(page(*tests(Path(sys.argv[1]))), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
