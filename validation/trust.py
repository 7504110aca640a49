"""Renew docs/how_far_to_trust_it.md: what the tool says, compared with shake-table tests and simulated traces.

    python -m validation.trust EXPERIMENTS [--check]     # or make trust, with its data; make trust-check

EXPERIMENTS holds the granite boulders (`granite_boulders.csv`, `granite_motions_100hz.npz`): data outside the project,
see validation/granite.py. traces.csv and middle.json, beside this file, are written by validation/traces.py and
validation/middle.py, and the scores of other sets stand in docs/scoreboard.md. With --check the page is not written:
the exit code is 1 if it is stale. Without EXPERIMENTS the shares are not checked.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from difflib import unified_diff
from functools import cache
from io import BytesIO
from math import isnan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from rocking_cli import load_structure, read_record
from rocking_cli.plotting import style
from rocking_cli.structure import Structure
from validation import granite, middle, traces
from validation.pages import DOCS, MADE, prose, renewed, table
from validation.picture import draw_reliability
from validation.rules import CalibrationBin, Scored, ScoreEstimate, score_tests
from validation.scoreboard import HEADS, RATES, SHAKEBOT, kept
from validation.scoreboard import PAGE as SCOREBOARD
from validation.table import read_tests

PAGE, PICTURE = DOCS / "how_far_to_trust_it.md", DOCS / "static" / "reliability.png"
RULES = {
    "tool": "neighbours",
    "base_rate": "base rate of all other motions",
    "west": "West: PGA > lambda g",
    "velocity": "PGV > v_imp",
    "fitted_pgv": "logistic curve on ln PGV, fitted to all other motions",
}


class Given(NamedTuple):
    """Tests with a stated share in one bin, of the half that was kept apart."""

    tests: int
    stated: float
    observed: float


# Numbers of the half of the programme that is kept apart, from those who hold it: no script here can compute them.
KEPT_APART = (
    Given(228, 0.028, 0.039),
    Given(23, 0.288, 0.304),
    Given(12, 0.486, 0.417),
    Given(14, 0.701, 0.429),
    Given(103, 0.966, 0.971),
)
NEAR = 0.05  # difference of stated and observed shares up to which a bin is counted as right


def scores(source: Path) -> Scored:
    """Score the tests of EXPERIMENTS."""
    with TemporaryDirectory() as made:
        folder = Path(made)
        granite.write(source, folder)

        @cache
        def structure(name: str) -> Structure:
            return Structure(load_structure(folder / name))

        tests = read_tests(folder / "tests.csv").tests
        return score_tests(tests, structure, cache(lambda name: read_record(folder / name)))


def picture(found: Scored) -> None:
    """Write the reliability diagram of the page."""
    stream = BytesIO()
    style.save(draw_reliability(found), stream, format="png")
    PICTURE.write_bytes(stream.getvalue())


def cell(each: ScoreEstimate | None) -> str:
    """Return an estimate and its interval."""
    return "" if each is None or isnan(each.value) else f"{each.value:.3f} [{each.low:.3f} {each.high:.3f}]"


def rules(found: Scored) -> str:
    """Return the table of rules and their scores."""
    rows = [[RULES[key], cell(found.scores[key].brier), cell(found.differences.get(key))] for key in RULES]
    return table(["rule", "Brier score", "neighbours less rule"], rows)


def bins(found: Scored) -> str:
    """Return the table of stated and observed shares, of these tests and of those that were kept apart."""
    rows = [
        [f"{each.low:g} to {each.high:g}", str(each.tests), f"{each.stated:.3f}", cell(each.observed),
         str(other.tests), f"{other.stated:.3f}", f"{other.observed:.3f}"]
        for each, other in zip(found.bins, KEPT_APART, strict=True)
    ]  # fmt: skip
    heads = ["stated share", "tests", "mean stated", "observed", "kept apart: tests", "mean stated", "observed"]
    return table(heads, rows)


def near(each: Sequence[CalibrationBin | Given]) -> str:
    """Return in how many bins the stated share is near the observed one."""
    observed = [one.observed if isinstance(one, Given) else one.observed.value for one in each]
    count = sum(abs(one.stated - seen) <= NEAR for one, seen in zip(each, observed, strict=True))
    return f"{count} of {len(each)} bins"


def together(found: Scored) -> str:
    """Return what was stated and observed in the fourth bin of all tests."""
    one, other = found.bins[3], KEPT_APART[3]
    tests = one.tests + other.tests
    stated = (one.tests * one.stated + other.tests * other.stated) / tests
    observed = (one.tests * one.observed.value + other.tests * other.observed) / tests
    return f"{tests} tests, stated {stated:.2f}, observed {observed:.2f}"


def apart(found: Scored) -> str:
    """Return the mean gap, and the mean stated share less the observed one, in words."""
    low, high = found.bias[1:]
    whether = "includes" if low <= 0 <= high else "excludes"
    side = "above" if found.bias.value > 0 else "below"
    return (
        f"On average, the stated share is {100 * abs(found.bias.value):.2g} percentage points {side} the observed one "
        f"[{100 * low:.2g} {100 * high:.2g}]; the interval {whether} 0. The mean gap of the bins is "
        f"{100 * found.mean_gap:.2g} points."
    )


def alike(found: Scored) -> str:
    """Return how often both boulders had the same outcome, and which of them overturned alone, in words."""
    outcomes = np.array([each.test.overturned for each in found.observed]).reshape(-1, 2)  # two rows for each motion
    differ = outcomes[:, 0] != outcomes[:, 1]
    first = int(outcomes[differ, 0].sum())
    return prose(
        f"The {len(found.observed)} tests are of two boulders under {found.clusters} motions, at several intensities.",
        f"The scans of both differ little. In {100 * (~differ).mean():.0f} % of the pairs of tests the outcome was the",
        f"same. Of the other {differ.sum()}, specimen 1 overturned alone in {first},",
        f"specimen 2 in {differ.sum() - first}.",
    )


def whether_high(found: Scored) -> str:
    """Return whether shares of .6 to .8 are too high in both halves, in words."""
    both_ = (found.bins[3].stated > found.bins[3].observed.value, KEPT_APART[3].stated > KEPT_APART[3].observed)
    return "**Shares of 0.6 to 0.8 are too high in both halves**" if all(both_) else "Of shares of 0.6 to 0.8"


def last(name: str) -> Sequence[str]:
    """Return the cells of the last line of a set in the scoreboard."""
    return next(each.cells for each in reversed(kept(SCOREBOARD.read_text(encoding="utf-8"))) if each.cells[0] == name)


def shakebot() -> str:
    """Return the scores of the other set of tests at hand."""
    own, base = last(SHAKEBOT), last(RATES)
    brier, rates = own[HEADS.index("Brier score")], base[HEADS.index("Brier score")]
    worse = float(brier.split()[0]) >= float(rates.split()[0])
    verdict = ": **no better than base rates**" if worse else ""
    return prose(
        f"On {own[2]} tests of a printed rock, the Brier score of the shares is {brier}, that of base rates",
        f"{rates}{verdict}.",
    )


def verdict(found: Scored) -> str:
    """Return whether neighbours are better than every other rule, and what no rule can fall below, in words."""
    shares = np.array([each.share for each in found.observed])
    compared = found.differences
    others = [RULES[key] for key in RULES if key in compared and compared[key].high >= 0]
    said = f"every other rule but these: {', '.join(others)}" if others else "every other rule of the table"
    least = (shares * (1 - shares)).mean()
    return prose(
        f"The share of neighbours is better than {said}. The whole interval of the difference is below 0. If every",
        f"stated share were right, the Brier score would be {least:.3f}.",
    )


def without_tests() -> dict[str, str]:
    """Return the parts of the page that need no tests."""
    return {"middle": middle.summary(), "traces": traces.summary(), "pulses": shakebot()}


def of_tests(found: Scored) -> dict[str, str]:
    """Return the parts of the page that are made of the tests."""
    agree = f"Both differ by less than five points in {near(found.bins)}, and in {near(KEPT_APART)} of the other half."
    said = prose(apart(found), agree, f"{whether_high(found)}: {together(found)}.")
    return {
        "boulders": alike(found),
        "scores": f"{rules(found)}\n\n{verdict(found)}",
        "bins": f"{bins(found)}\n\n{said}",
    }


NUMBER = re.compile(r"\d*\.?\d+")


def is_same(before: str, now: str) -> bool:
    """Return whether two lines have the same words, and numbers that differ by no more than a unit of their last digit.

    Another processor rounds differently.
    """
    if NUMBER.split(before) != NUMBER.split(now):
        return False
    pairs = zip(NUMBER.findall(before), NUMBER.findall(now), strict=True)
    return all(abs(float(a) - float(b)) <= 1.01 * 10.0 ** -len(a.partition(".")[2]) for a, b in pairs)


def stale(before: str, now: str) -> list[str]:
    """Return the lines of a page that are no longer what the scripts make."""
    old, new = before.splitlines(), now.splitlines()
    if len(old) == len(new):
        new = [a if is_same(a, b) else b for a, b in zip(old, new, strict=True)]
    return list(unified_diff(old, new, PAGE.name, "what the scripts make", n=0, lineterm=""))


def outdated() -> list[str]:
    """Return the data of the page whose first results are no longer what they were made of."""
    return [f"{module.FILE.name}: {each}" for module in (traces, middle) for each in module.stale()]


def checked(source: Path) -> int:
    """Print what of the page is stale, and return 1 if anything is; without EXPERIMENTS its shares are not checked."""
    text, wrong = PAGE.read_text(encoding="utf-8"), outdated()
    if (source / "granite_boulders.csv").is_file():
        parts = of_tests(scores(source))
    else:
        print(f"The shares of docs/{PAGE.name} were not checked: no shake-table tests in {source}")
        parts = {part["name"]: part["text"].strip("\n") for part in MADE.finditer(text)}
    wrong += stale(text, renewed(text, parts | without_tests()))
    print("\n".join([*wrong, "run `make trust`"]) if wrong else f"docs/{PAGE.name} is not stale")
    return int(bool(wrong))


def main() -> int:
    """Renew the page and its picture, or check them."""
    check = sys.argv[2:] == ["--check"]
    if len(sys.argv) != 2 + check:
        print(__doc__)
        return 2
    source = Path(sys.argv[1])
    if check:
        return checked(source)
    found = scores(source)
    picture(found)
    text = renewed(PAGE.read_text(encoding="utf-8"), of_tests(found) | without_tests())
    PAGE.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
