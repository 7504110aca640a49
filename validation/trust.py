"""Write docs/how_far_to_trust_it.md: what the tool says, compared with shake-table tests and simulated traces.

    python -m validation.trust EXPERIMENTS [--check]     # or make trust, with its parts; make trust-check

EXPERIMENTS holds the granite boulders (`granite_boulders.csv`, `granite_motions_100hz.npz`): data outside the project,
see validation/granite.py. The parts in docs/trust are written by validation/traces.py and
validation/middle.py. With --check the page is not written: the exit code is 1 if it is stale, and 0 without
EXPERIMENTS if its parts are as they should be, as the shares cannot be checked then.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from difflib import unified_diff
from functools import cache
from io import BytesIO
from math import isnan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from rocking_cli import load_structure, read_record
from rocking_cli.dynamics.model import Model
from rocking_cli.plotting import style
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Draws, Neighbourhood
from validation import granite
from validation.middle import sample as first_of_middle
from validation.picture import draw_reliability
from validation.rules import DRAWS, CalibrationBin, Scored, ScoreEstimate, score_tests, scored
from validation.table import read_tests
from validation.traces import sample as first_traces

DOCS = Path(__file__).resolve().parents[1] / "docs"
PAGE, TRACES, MIDDLE = DOCS / "how_far_to_trust_it.md", DOCS / "trust" / "traces.md", DOCS / "trust" / "middle.md"
EARLIER = "earlier"
RULES = {
    "tool": "neighbours",
    EARLIER: "neighbours as they were drawn before",
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
KEPT_APART_SCORES = """\
| rule | Brier score | log loss | right | mean gap of the bins |
|---|---|---|---|---|
| neighbours | 0.060 [0.044 0.081] | 0.199 | 0.911 | 0.022 |
| neighbours as they were drawn before | 0.081 [0.060 0.106] | 0.278 | 0.889 | 0.067 |
| logistic curve on PGV, fitted to the 600 tests above | 0.089 | 0.291 | 0.871 | 0.040 |
| 3DEC, a model of the authors with distinct elements | 0.105 | 0.633 | 0.895 | 0.105 |
| a forecaster without fault | 0.052 [0.041 0.064] | | | 0.023 [0.011 0.038] |"""
NEAR = 0.05  # difference of stated and observed shares up to which a bin is counted as right


class EarlierNeighbourhood(Neighbourhood):
    """Neighbours as they were drawn before: evenly within 2 % of amplitude and .02 of restitution, clipped at 1."""

    def drawn(self, model: Model) -> Draws:
        """Draw the neighbours of a model."""
        random = np.random.default_rng(1963)
        amplitude, eta = (np.arange(self.count) + random.random((2, self.count))) / self.count
        etas = np.array(model.eta) + 0.02 * (2 * random.permutation(eta)[:, None] - 1)
        return Draws(1 + 0.02 * (2 * amplitude - 1), np.ones(self.count), np.minimum(etas, 1.0))


def both(folder: Path) -> tuple[Scored, Scored]:
    """Score the tests of a folder with the neighbours of before, and with those of today and the others as rules."""
    table = read_tests(folder / "tests.csv")

    @cache
    def structure(name: str) -> Structure:
        return Structure(load_structure(folder / name))

    motion = cache(lambda name: read_record(folder / name))
    earlier = score_tests(table.tests, structure, motion, EarlierNeighbourhood())
    today = score_tests(table.tests, structure, motion)
    compared = [
        replace(one, test=replace(one.test, forecasts={EARLIER: other.share}))
        for one, other in zip(today.tests, earlier.tests, strict=True)
    ]
    return earlier, scored(compared, today.around)


def picture(found: Scored, name: str) -> None:
    """Write a reliability diagram beside the page."""
    stream = BytesIO()
    style.save(draw_reliability(found), stream, format="png")
    (DOCS / "trust" / name).write_bytes(stream.getvalue())


def cell(each: ScoreEstimate | None) -> str:
    """Return an estimate and its interval."""
    return "" if each is None or isnan(each.value) else f"{each.value:.3f} [{each.low:.3f} {each.high:.3f}]"


def rules(found: Scored) -> str:
    """Return the table of rules and their scores."""
    heads = ["rule", "Brier score", "neighbours less rule", "log loss", "right", "area"]
    rows = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for key, name in RULES.items():
        score = found.scores[key]
        cells = (score.brier, found.differences.get(key), score.log_loss, score.right, score.auc)
        rows.append(f"| {name} | {' | '.join(cell(each) for each in cells)} |")
    return "\n".join(rows)


def bins(found: Scored) -> str:
    """Return the table of stated and observed shares, of these tests and of those that were kept apart."""
    heads = [
        "stated share",
        "tests",
        "motions",
        "mean stated",
        "observed",
        "kept apart: tests",
        "mean stated",
        "observed",
    ]
    rows = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for each, other in zip(found.bins, KEPT_APART, strict=True):
        numbers = f"{each.tests} | {each.clusters} | {each.stated:.3f} | {cell(each.observed)}"
        others = f"{other.tests} | {other.stated:.3f} | {other.observed:.3f}"
        rows.append(f"| {each.low:g} to {each.high:g} | {numbers} | {others} |")
    return "\n".join(rows)


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


def off(found: Scored) -> str:
    """Return a sentence on the bins whose interval excludes what is stated."""
    wrong = [each for each in found.bins if each.outside]
    if not wrong:
        return "In every bin, the interval of the observed share includes the stated one."
    said = " and ".join(
        f"from {each.low:g} to {each.high:g} (stated {each.stated:.3f}, observed {cell(each.observed)})"
        for each in wrong
    )
    return f"The interval of the observed share excludes the stated one in the bin{'s' * (len(wrong) > 1)} {said}."


def alike(found: Scored) -> str:
    """Return how often both boulders had the same outcome, and which of them overturned alone, in words."""
    outcomes = np.array([each.test.overturned for each in found.observed]).reshape(-1, 2)  # two rows for each motion
    differ = outcomes[:, 0] != outcomes[:, 1]
    first = int(outcomes[differ, 0].sum())
    return (
        "Two boulders whose scans differ little had the same outcome in\n"
        f"{100 * (~differ).mean():.0f} % of the motions. "
        f"Of the other {differ.sum()}, specimen 1 overturned alone in {first}, specimen 2 in {differ.sum() - first}:\n"
        "part of this is sensitivity, part the difference of the two."
    )


def middle(found: Scored) -> str:
    """Return whether shares of .6 to .8 are too high in both halves, in words."""
    both_ = (found.bins[3].stated > found.bins[3].observed.value, KEPT_APART[3].stated > KEPT_APART[3].observed)
    return "**Shares of 0.6 to 0.8 are too high in both halves**:\n" if all(both_) else "Of shares of 0.6 to 0.8:\n"


def last(name: str) -> list[str]:
    """Return the cells of the last line of a set in the scoreboard."""
    lines = (DOCS / "scoreboard.md").read_text(encoding="utf-8").splitlines()
    line = next(line for line in reversed(lines) if line.startswith(f"| {name} |"))
    return [cell.strip() for cell in line.split("|")[1:-1]]


def shakebot() -> str:
    """Return the scores of the other set of tests at hand."""
    own, base = map(last, ("shakebot pulses", "shakebot pulses, by base rates"))
    worse = float(own[4].split()[0]) >= float(base[4].split()[0])
    verdict = ": **no better than base rates**" if worse else ""
    return f"""On {own[2]} tests of a printed rock the shares have a Brier score of {own[4]}, base rates one of
{base[4]}, and a coin .25{verdict}. Posture, sign and size of that rock are not documented, a
block was fitted to the other tests, and the motions are those commanded, whose peaks are off by a factor of about two;
whether this is the cause has not been shown. So good scores are known of one set only."""


def witness() -> str:
    """Return on what free blocks and one degree of freedom agree."""
    _, _, known, outcomes, peaks, close, _, unknown, stand, collapse, _ = last("forty assemblies")
    return f"""One degree of freedom knows the outcome of {known} assemblies. Where their neighbours agree on it,
[free blocks](free_blocks.md) have the same outcome in {outcomes}. The peaks agree in {peaks}, and are within 5 % in
{close}. Of the other {unknown} assemblies, {stand} stand and {collapse} collapse as free blocks: `unknown` means
neither. [The scoreboard](scoreboard.md#free-blocks) says how this was counted."""


def faultless(found: Scored) -> float:
    """Return the mean Brier score that is left if every stated share is right."""
    shares = np.array([each.share for each in found.observed])
    return float((shares * (1 - shares)).mean())


def page(earlier: Scored, today: Scored) -> str:
    """Return the text of the page."""
    compared = today.differences
    others = [RULES[key] for key in RULES if key in compared and compared[key].high >= 0]
    whole = "the whole interval of the difference is below 0"
    verdict = (
        f"Of every other rule but these, {whole}: {', '.join(others)}."
        if others
        else f"The share of neighbours is better than every other rule of the table: {whole}."
    )
    return f"""# How far to trust it

What the tool says of overturning is checked here against shake-table tests, good or bad, and what it reads off a trace
against simulated traces of a known restitution. `make trust` writes this page. `make trust-check` computes the shares,
the first trace of each kind and the deviations of the rule again, and says whether they are stale.
[Validation](validation.md) checks its formulas against other formulas, [the scoreboard](scoreboard.md) has one line for
each set of tests and version, and `rocking selfcheck` checks the arithmetic of your installation, by no test. To score
it on tests of your own, see [Score your own tests](scoring.md).

## Shares of overturning

Rocking near overturning is sensitive. {alike(today)}
So `rocking respond` states the share of neighbouring motions that overturn. Such a share must be met: of all tests of
which 30 % is stated, about 30 % overturn. A base rate meets this too, so the scores below also reward shares near 0
and 1.

These are {len(today.observed)} shake-table tests, of both boulders under {today.clusters} motions at several
intensities. The data are those of Chen and others (virtual_shake_robot), and not part of this project;
`validation/granite.py` writes them as a table. Each boulder is a rigid body on the first edge of its foot, with the
restitution of its kinematics. Brackets hold 5 to 95 % of {DRAWS} draws of the motions with replacement. They contain
what another choice of motions would change, and not what other boulders would: there are two.

{rules(today)}

The Brier score is the mean squared difference of share and outcome: 0 is perfect, .25 is a coin. A forecaster without
fault would have {faultless(today):.3f} here. {verdict}
A base rate may have an area below one half: it is lower for a motion that overturns much, which is left out of it.

**Three choices were made after seeing outcomes**: the scatter of kinematic restitution (.05), the first edge of the
foot instead of its outermost corners or its facets, and restitutions that are drawn above 1 being redrawn instead of
clipped. So the scores above are not those of a forecast. The other half of the programme, 380 tests of the same
boulders under 24 other motions, is kept apart by those who hold it. It had no part in the choice of the scatter; of
foot and redrawing it is not known to have had none. The numbers of that half, in the next table
and in the last columns of the one after, were given by them; no script of the project computes them:

{KEPT_APART_SCORES}

Stated and observed shares of both halves:

{bins(today)}

{apart(today)}
{off(today)}
Stated and observed shares differ by less than five points in {near(today.bins)}, and in
{near(KEPT_APART)} of the half that was kept apart. {middle(today)}{together(today)}.

![Observed against stated shares](trust/reliability_today.png)

{part(MIDDLE)}

### Before

Until the neighbours were drawn as widely as they are now (4 % of amplitude, 10 % of slenderness, .05 of kinematic
restitution, redrawn above 1), they were drawn evenly within 2 % of amplitude and .02 of restitution, clipped at 1.
{apart(earlier)}

![Observed against stated shares, with the neighbours of before](trust/reliability_before.png)

{part(TRACES)}

### Another set of tests

{shakebot()}

## Another engine

{witness()}

## What no test here shows

- No measured trace with a known restitution was fitted. The simulated ones obey the equation that is fitted: they show
  errors of the fit, not those of real contact, such as bouncing, sliding, twisting and crushing.
- These are two bodies of one kind, some .3 m from foot to centroid, on a table with one axis. The error in the
  description of a body is the same in all of its tests, so there are two samples of such an error, not 600.
- No wall, frame or arch, no tie and no load has been checked against observed shares: the checks of their mechanics are
  in [Validation](validation.md).
- Peak rotations were not recorded in these tests. Where your table has a `peak`, it is ranked among those of the
  neighbours.
- A share says what neighbouring motions do to the structure as described. It does not know that the structure is
  another one: other edges, a crushed corner, a foot on soft ground.
- Where joints open that the model keeps closed, the outcome is `unknown`, and is counted as such: see
  [Until when a result is known](commands.md#until-when-a-result-is-known).
"""


def part(path: Path) -> str:
    """Return a part of the page that another script writes."""
    return path.read_text(encoding="utf-8").rstrip()


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
    """Return the parts of the page whose first results are no longer what they were made of."""
    samples = {TRACES: first_traces, MIDDLE: first_of_middle}
    return [
        f"docs/trust/{path.name} is stale" for path, first in samples.items()
        for sample in [first()]
        if sample not in (text := path.read_text(encoding="utf-8"))
        and not any(is_same(line, sample) for line in text.splitlines())
    ]  # fmt: skip


def made(source: Path) -> tuple[str, Scored, Scored]:
    """Return the text of the page, and what it rests on: the scores of before and those of today."""
    with TemporaryDirectory() as folder:
        granite.write(source, Path(folder))
        earlier, today = both(Path(folder))
    return page(earlier, today), earlier, today


def checked(source: Path) -> int:
    """Print what of the page is stale, and return 1 if anything is; without EXPERIMENTS only its parts are checked."""
    text, wrong = PAGE.read_text(encoding="utf-8"), outdated()
    if (source / "granite_boulders.csv").is_file():
        wrong += stale(text, made(source)[0])
    else:
        print(f"The shares of docs/{PAGE.name} were not checked: no shake-table tests in {source}")
        wrong += [
            f"docs/{PAGE.name} lacks docs/trust/{each.name}" for each in (TRACES, MIDDLE) if part(each) not in text
        ]
    print("\n".join([*wrong, "run `make trust`"]) if wrong else f"docs/{PAGE.name} is not stale")
    return int(bool(wrong))


def main() -> int:
    """Write the page and its pictures, or check them."""
    check = sys.argv[2:] == ["--check"]
    if len(sys.argv) != 2 + check:
        print(__doc__)
        return 2
    source = Path(sys.argv[1])
    if check:
        return checked(source)
    text, earlier, today = made(source)
    picture(earlier, "reliability_before.png")
    picture(today, "reliability_today.png")
    PAGE.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
