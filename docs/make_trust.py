"""Write docs/how_far_to_trust_it.md: what the tool says, held against shake-table tests and simulated traces.

    python docs/make_trust.py EXPERIMENTS

EXPERIMENTS holds the granite boulders (`granite_boulders.csv`, `granite_motions_100hz.npz`): data outside the project,
see scripts/granite_tests.py. The part on traces is docs/trust/traces.md.
"""

from __future__ import annotations

import runpy
import sys
from dataclasses import replace
from functools import cache
from io import BytesIO
from math import isnan
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rocking_cli import load_structure, read_record
from rocking_cli.dynamics.model import Model
from rocking_cli.plotting import style
from rocking_cli.plotting.score import draw_reliability
from rocking_cli.structure import Structure
from rocking_cli.studies.experiments.score import Scored, score_tests, scored
from rocking_cli.studies.experiments.scores import DRAWS, ScoreEstimate
from rocking_cli.studies.experiments.table import read_tests
from rocking_cli.studies.neighbours import Draws, Neighbourhood

DOCS = Path(__file__).resolve().parent
PAGE, TRACES = DOCS / "how_far_to_trust_it.md", DOCS / "trust" / "traces.md"
EARLIER = "earlier"
RULES = {
    "tool": "neighbours",
    EARLIER: "neighbours as they were drawn before",
    "base_rate": "base rate of all other motions",
    "west": "West: PGA > lambda g",
    "velocity": "PGV > v_imp",
}


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
    """Return the table of stated and observed shares."""
    rows = ["| stated share | tests | motions | mean stated | observed |", "|---|---|---|---|---|"]
    for each in found.bins:
        numbers = f"{each.tests} | {each.clusters} | {each.stated:.3f} | {cell(each.observed)}"
        rows.append(f"| {each.low:g} to {each.high:g} | {numbers} |")
    return "\n".join(rows)


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
    wrong = [each for each in found.bins if each.tests and not each.observed.low <= each.stated <= each.observed.high]
    if not wrong:
        return "In every bin, the interval of the observed share includes the stated one."
    said = " and ".join(
        f"from {each.low:g} to {each.high:g} (stated {each.stated:.3f}, observed {cell(each.observed)})"
        for each in wrong
    )
    return f"The interval of the observed share excludes the stated one in the bin{'s' * (len(wrong) > 1)} {said}."


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

What the tool says of overturning is held here against shake-table tests, good or bad, and what it reads off a trace
against traces of a known restitution. `docs/make_trust.py` writes this page. [Validation](validation.md) holds its
formulas against other formulas, [the scoreboard](scoreboard.md) has one line for each set of tests and version, and
`rocking selfcheck` repeats the most important checks on your own machine. To score it on tests of your own, see
[rocking score](commands.md#rocking-score-testscsv).

## Shares of overturning

Rocking near overturning is chaotic: the two granite boulders below are nearly identical, and had the same outcome in
88 % of the tests only. So `rocking respond` states the share of neighbouring motions that overturn. Such a share is
good if, of all tests of which 30 % is stated, about 30 % overturn.

These are {len(today.observed)} shake-table tests, of both boulders under {today.clusters} motions at several
intensities. The data are those of Chen and others (virtual_shake_robot), and not part of this project;
`scripts/granite_tests.py` writes them as a table. Each boulder is a rigid body on the first edge of its foot, with the
restitution of its kinematics. Brackets hold 5 to 95 % of {DRAWS} draws of the motions with replacement.

One number was chosen on these very tests: the scatter of kinematic restitution, .05. On 380 tests of the same boulders
under 24 other motions, which were kept apart, the Brier score was .060 [.044 .081], the log loss .201, .911 were right
and the mean gap was 1.8 points: no worse.

{rules(today)}

The Brier score is the mean squared difference of share and outcome: 0 is perfect, .25 is a coin. A forecaster without
fault would have about .05 here. {verdict} A base rate may have an area below one half: it is lower for a motion
that overturns much, which is left out of it.

{bins(today)}

{apart(today)} {off(today)}

![Observed against stated shares](trust/reliability_today.png)

Until the neighbours were drawn as widely as they are now (4 % of amplitude, 10 % of slenderness, .05 of kinematic
restitution, redrawn above 1), they were drawn evenly within 2 % of amplitude and .02 of restitution, clipped at 1.
{apart(earlier)}

![Observed against stated shares, with the neighbours of before](trust/reliability_before.png)

{TRACES.read_text(encoding="utf-8").rstrip() if TRACES.is_file() else ""}

## What no test here shows

- These are two bodies of one kind, some .3 m from foot to centroid, on a table with one axis. No wall, frame or arch,
  no tie and no load has been held against observed shares: the checks of their mechanics are in
  [Validation](validation.md).
- Peak rotations were not recorded in these tests. Where your table has a `peak`, `rocking score` ranks it among those
  of the neighbours.
- A share says what neighbouring motions do to the structure as described. It does not know that the structure is
  another one: other edges, a crushed corner, a foot on soft ground.
- Where joints open that the model keeps closed, the outcome is `unknown`, and is counted as such: see
  [Until when a result is known](commands.md#until-when-a-result-is-known).
"""


def main() -> int:
    """Write the page and its pictures."""
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    script = runpy.run_path(str(DOCS.parent / "scripts" / "granite_tests.py"))
    with TemporaryDirectory() as made:
        script["write"](Path(sys.argv[1]), Path(made))
        earlier, today = both(Path(made))
    picture(earlier, "reliability_before.png")
    picture(today, "reliability_today.png")
    PAGE.write_text(page(earlier, today), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
