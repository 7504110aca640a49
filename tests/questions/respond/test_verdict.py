"""The words say what the histories did, and which model to trust for it."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import rocking_cli as rk
from mechanisms.block import Block
from rocking_cli import names
from rocking_cli.core import Direction
from rocking_cli.core.equivalence import Grade
from rocking_cli.dynamics.verdict import agreements
from rocking_cli.structure import Structure
from rocking_cli.views.response import known_data
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.verdict import NO_JOINTS, OVERTURNS, joints_in_words, verdict
from rocking_cli.views.view import Aside
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES, rows_of
from tests.following import respond

RESTED = respond(Block(width=0.7, height=2.8), release=0.4, models=("nonlinear",))["nonlinear"]
ORDER = ("agrees", "first_estimate", "disregard")


def peak(ratio, **more):
    """A motion of this peak, RESTED enlarged or reduced."""
    if not ratio:
        return replace(RESTED, peak_ratio=0.0, ratio=0 * RESTED.ratio, uplift_time=np.nan, **more)
    return replace(RESTED, peak_ratio=ratio, ratio=RESTED.ratio * ratio / RESTED.peak_ratio, **more)


def fell(direction, at=2.0, **more):
    gone = np.where(RESTED.time < at, RESTED.ratio, np.nan)
    return replace(RESTED, peak_ratio=np.nan, fell_to=int(direction), overturning_time=at, ratio=gone, **more)


def unknown(after=2.0):
    """RESTED, of which no more is known after that time."""
    known = RESTED.time <= after
    return replace(RESTED, unknown=True, known_to=after, ratio=np.where(known, RESTED.ratio, np.nan))


UP, DOWN = Direction.POSITIVE, Direction.NEGATIVE
LOW = {"uplift_error": -0.33}


@pytest.mark.parametrize(
    ("histories", "words", "not_said"),
    [
        ({"nonlinear": peak(0.0), "linear2": peak(0.0)}, "linear2 agrees: it does not uplift either", "Disregard"),
        ({"nonlinear": peak(0.0), "linear1": peak(0.3)}, "linear1 disagrees: it rocks to 0.3", " agrees"),
        ({"nonlinear": peak(0.4), "linear1": peak(0.45)}, "a first estimate: its peak is 13 % higher", "Disr"),
        ({"nonlinear": peak(0.4), "linear1": peak(0.6)}, "Disregard linear1 here: its peak is 50 % higher", "close"),
        ({"nonlinear": peak(0.4), "linear1": peak(0.4, **LOW)}, "uplift acceleration is 33 % too low; here", "agrees"),
        ({"linear2": peak(0.9)}, "rocks to 0.9 of its critical rotation phi_cr. This is close", "linear2"),
        # Reaching the kinematic limit is overturning there, however far it still is from losing its weight's moment.
        ({"nonlinear": peak(0.9, ends_at_limit=(True, True))}, "0.9 of its kinematic limit", "close"),
        ({"nonlinear": peak(0.801)}, "This is close to overturning", "exceeds"),
        ({"nonlinear": peak(0.799)}, "rocks to 0.799", "close"),
        ({"linear1": peak(0.2, **LOW)}, "Disregard linear1: its uplift acceleration is 33 % too low.", "here"),
        ({"linear1": peak(0.2), "linear2": fell(UP)}, "By linear2 it overturns clockwise. Do not trust", "close"),
        ({"nonlinear": peak(1.75)}, "exceeds its critical rotation, reaching 1.75 times it", "rocks to"),
        ({"nonlinear": fell(UP)}, "The structure overturns clockwise.", "linear"),
        ({"nonlinear": fell(UP), "linear1": fell(DOWN)}, "a first estimate: it overturns the other way", "agrees"),
        ({"nonlinear": fell(UP), "linear1": fell(UP, 2.4)}, "linear1 agrees: it overturns too, 0.4 s later", "trust"),
        ({"nonlinear": peak(0.9), "linear2": fell(UP)}, "disagrees: it overturns clockwise. Do not trust", "close"),
        # What overturns by kappa1 alone, its uplift a third too low, is not near to overturning for that.
        ({"nonlinear": peak(0.01), "linear1": fell(UP, **LOW), "linear2": peak(0.01)},
         "too low; here it overturns clockwise. linear2 agrees", "trust"),
        ({"nonlinear": replace(peak(0.4), still_rocking=True)}, "nonlinear: still rocking", "overturns"),
        # An equivalent block has no joints, so that it neither agrees nor disagrees with what is not known.
        ({"nonlinear": unknown(), "linear2": fell(UP)}, "The outcome is unknown after 2 s: then", "linear2"),
        ({"nonlinear": unknown(), "linear2": fell(UP)}, "The structure may overturn.", "trust"),
        ({"nonlinear": unknown(), "linear2": peak(0.9)}, NO_JOINTS, "close"),
    ],
)  # fmt: skip
def test_the_verdict_says_what_happened(histories, words, not_said):
    said = verdict(histories, agreements(histories))
    assert words in said
    assert not_said not in said


@pytest.mark.parametrize(
    ("amplitude", "more", "shown"),
    [(0.3, (), False), (0.3, ("--model", "nonlinear,linear1"), True), (0.3, ("--all",), True), (0.38, (), True)],
)
def test_equivalent_blocks_are_shown_if_they_are_asked_for_or_overturn_alone(amplitude, more, shown):
    """At .38 g, linear1 overturns and the block itself does not; the first line is the outcome either way."""
    words = ("respond", EXAMPLES / "block.yaml", "--pulse", f"sine:{amplitude}g:0.8s", "--neighbours", 0)
    text, run_of = run(*words, *more).stdout, run_json(*words)["responses"]["nonlinear"]
    assert f". The structure rocks to {run_of['peak_ratio']:.4g} of its critical rotation" in text.splitlines()[0]
    assert ("linear1" in text) == shown and ("Do not trust" in text) == (amplitude == 0.38)
    assert ("Models: " in text) == ("--all" in more) and "not measured" in text
    assert ("peak rotation / phi_cr" in text) == shown
    assert ("overturning time" in text) == (amplitude == 0.38 or "--all" in more)


@pytest.mark.parametrize("name", ["arch", "assembly", "wall"])
def test_what_bears_on_an_outcome_is_shown_without_more(name):
    """Warnings, joints that open, unknown outcomes and shares are on the terminal without --all."""
    answer = rk.respond(EXAMPLES / f"{name}.yaml", EXAMPLES / "accel.csv", scale=1.5, engine="exact", neighbours=10)
    aside = " ".join(part for part in answer.view.parts if isinstance(part, Aside))
    told, kept = answer.to_dict(), " ".join(part for part in answer.sentences if not isinstance(part, Aside))
    of = told["responses"]["nonlinear"]
    assert aside and not re.search(r"Caution|unknown|not valid|unconservative|assume", aside)
    assert "Of 10 neighbouring motions, " in kept and all(each in kept for each in told["notes"])
    assert f"friction of up to {of['contact']['friction_needed']:.3g}" in kept
    ends = "overturns" if of["overturned"] else f"rocks to {of['peak_ratio'] or 0:.4g} of its"
    assert (f"unknown after {of['known_to']:.4g} s" if of["unknown"] else ends) in answer.sentences[0]


@pytest.mark.parametrize(
    ("eta", "given", "doubted"),
    [(0.9699, False, False), (0.9701, False, True), (0.9999, False, True), (0.9999, True, False)],
)
def test_a_restitution_of_kinematics_above_those_of_tests_is_doubted(eta, given, doubted):
    """A block has eta = 1 - 1.5 sin(alpha)^2, tan(alpha) its width over its height; tests found 0.97 at most."""
    alpha = np.arcsin(np.sqrt((1 - eta) / 1.5))
    block = Block(width=np.tan(alpha), height=1.0, restitution=eta if given else None)
    said = restitution_used(Structure(block))
    assert f"eta = {eta:.4g}, {'as given' if given else 'from rigid-body kinematics'}" in said
    assert ("about 0.95" in said) == doubted


def test_what_is_known_of_a_history_is_null_where_nothing_is():
    """Joints that were not checked make it neither known nor unknown, and a linear model has none."""
    known = known_data(RESTED)
    assert known == {"unknown": False, "known_to": None, "known_to_reason": None, "peak_lower_bound": None,
                     "opening": RESTED.opening}  # fmt: skip
    assert known_data(replace(RESTED, check=None))["unknown"] is None
    assert known_data(replace(RESTED, model="linear1", check=None))["unknown"] is False
    bound = replace(unknown(), lower_bound=0.3)
    for each in (bound, replace(bound, check=None)):
        data = known_data(each)
        assert (data["unknown"], data["known_to"], data["peak_lower_bound"]) == (True, 2.0, 0.3)
        assert data["known_to_reason"]
    assert known_data(replace(RESTED, lower_bound=0.3, warned=1.0))["peak_lower_bound"] is None


@pytest.mark.parametrize(
    ("ratio", "opening", "uncertain"),
    [(0.0199, 0.00101, True), (0.0201, 0.00101, False), (0.0199, 0.00099, False), (0.0, 0.00101, False)],
)
def test_a_small_peak_is_uncertain_where_a_joint_opens_by_more_than_a_thousandth(ratio, opening, uncertain):
    check = replace(RESTED.check, warned=1.0, largest=opening * RESTED.check.reach, largest_joint="a and b")
    said = joints_in_words(peak(ratio, check=check))
    assert ("the peak remain valid" in said) != uncertain and ("uncertain" in said) == uncertain


@pytest.mark.parametrize(
    ("warned", "bound", "said"),
    [(1.0, 0.2, ("a peak of 0.3 ", "is 0.2, that before")), (1.0, 0.3, ("is 0.3 of", "that until then")),
     (np.nan, 0.3, ("is 0.3 of", "that until then"))],
)  # fmt: skip
def test_a_lower_bound_is_the_peak_before_the_first_warning(warned, bound, said):
    text = joints_in_words(replace(unknown(), peak_ratio=0.3, warned=warned, lower_bound=bound))
    assert text.startswith("The outcome is unknown after 2 s") and all(each in text for each in said)
    assert ("that until then" in text) == (bound == 0.3)


def shifted(seconds):
    """RESTED, some time later."""
    late = np.interp(RESTED.time - seconds, RESTED.time, RESTED.ratio)
    return replace(RESTED, ratio=late)


def fading(size):
    """RESTED with another motion added, of which the rms is this part of its own; its peak stays."""
    other = np.where(np.abs(RESTED.ratio) < 0.5 * RESTED.peak_ratio, 1.0, 0.0) * np.sin(40 * RESTED.time)
    other *= size * np.sqrt(np.sum(RESTED.ratio**2) / np.sum(other**2))
    return replace(RESTED, ratio=RESTED.ratio + other)


@pytest.mark.parametrize(
    ("run_of", "expected"),
    [(peak(0.4 * 1.0499), "agrees"), (peak(0.4 * 1.0501), "first_estimate"), (peak(0.4 * 0.9501), "agrees"),
     (peak(0.4 * 1.1499), "first_estimate"), (peak(0.4 * 1.1501), "disregard"), (peak(0.4 * 0.8499), "disregard"),
     (fading(0.249), "agrees"), (fading(0.251), "first_estimate"), (fading(0.499), "first_estimate"),
     (fading(0.501), "disregard"), (replace(RESTED, uplift_error=0.1499), "agrees"),
     (replace(RESTED, uplift_error=-0.1501), "disregard")],
)  # fmt: skip
def test_motions_on_both_sides_of_the_bounds(run_of, expected):
    assert agreements({"nonlinear": RESTED, "linear2": run_of})["linear2"].grade.key == expected


def test_nothing_is_compared_with_what_is_not_known():
    assert agreements({"nonlinear": unknown(), "linear1": fell(UP), "linear2": RESTED}) == {}


@pytest.mark.parametrize(("delay", "expected"), [(0.99, Grade.AGREES), (1.01, Grade.ESTIMATE)])
def test_overturning_on_both_sides_of_1_over_p(delay, expected):
    runs = {"nonlinear": fell(UP, 2.0), "linear2": fell(UP, 2.0 + delay / RESTED.p)}
    assert agreements(runs)["linear2"].grade is expected


def test_a_motion_that_dies_out_earlier_does_not_agree_though_the_peaks_do():
    half = np.where(RESTED.time < RESTED.end_time / 8, RESTED.ratio, 0.0)
    short = replace(RESTED, ratio=half[half != 0])
    found = agreements({"nonlinear": RESTED, "linear2": short})["linear2"]
    assert found.peak_error == 0 and found.peak_delay == 0
    rest = RESTED.ratio[short.ratio.size :]
    assert found.difference == pytest.approx(np.sqrt(np.sum(rest**2) / np.sum(RESTED.ratio**2)))
    assert found.grade is not Grade.AGREES
    later = agreements({"nonlinear": short, "linear2": RESTED})["linear2"]  # the same, where the other goes on
    assert later.difference == pytest.approx(np.sqrt(np.sum(rest**2) / np.sum(short.ratio**2)))


def test_a_motion_that_comes_and_goes_between_two_samples_is_judged_by_its_peak():
    unseen = replace(RESTED, peak_ratio=1e-9, ratio=0 * RESTED.ratio)
    histories = {"nonlinear": unseen, "linear2": replace(unseen, peak_ratio=1.1e-9)}
    found = agreements(histories)["linear2"]
    assert (found.grade, found.difference, found.peak_delay) == (Grade.ESTIMATE, None, None)
    said = verdict(histories, agreements(histories))
    assert "linear2 is good for a first estimate: its peak is 10 % higher." in said
    json.dumps(vars(found), allow_nan=False)


def test_peaks_alike_to_rounding_are_had_when_the_first_of_them_is():
    wave = 0.3 * np.sin(2 * np.pi * RESTED.time / RESTED.time[-1] * 4)
    one = replace(RESTED, ratio=wave * (1 + 1e-15 * np.sign(RESTED.time - 1)), peak_ratio=0.3)
    other = replace(RESTED, ratio=wave * (1 - 1e-15 * np.sign(RESTED.time - 1)), peak_ratio=0.3)
    assert agreements({"nonlinear": one, "linear1": other})["linear1"].peak_delay == 0


# --- sentences against the numbers beside them, over structures and motions


STRUCTURES = {
    "slender": "mechanism: block\nwidth: 0.4\nheight: 4\n",
    "stocky": "mechanism: block\nwidth: 1.5\nheight: 2.5\n",
    "pedestal": "mechanism: block\nwidth: 0.7\nheight: 2.8\n",
    "wall": "mechanism: wall\nthickness: 0.45\nheight: 4.1\n",
    "frame": "mechanism: symmetric_frame\ncolumn_width: 1.1\ncolumn_height: 4.6\nmass_ratio: 0.8\n"
    "spacing: 4\nbeam_depth: 1\n",
    "valley": (EXAMPLES / "frame.yaml").read_text(encoding="utf-8"),
    "arch": "mechanism: arch\nradius: 6.3\nthickness: 0.819\ninclusion_angle_deg: 150\nvoussoirs: 9\n",
}
STRUCTURES["closed-arch"] = STRUCTURES["arch"]  # of which every outcome counts as known
MOTIONS = [
    ["--record", str(EXAMPLES / "accel.csv")],
    ["--record", str(EXAMPLES / "accel.csv"), "--scale", "0.4"],
    ["--record", str(EXAMPLES / "accel.csv"), "--scale", "2"],
    ["--pulse", "sine:0.3g:0.5s"],
    ["--pulse", "sine:0.6g:0.8s"],
    ["--pulse", "ricker:0.9g:0.6s"],
]


@pytest.mark.every(12)
@pytest.mark.parametrize("motion", MOTIONS, ids=lambda words: "-".join(words[1:]).rpartition("/")[2])
@pytest.mark.parametrize("structure", STRUCTURES)
def test_every_sentence_is_that_of_its_own_numbers(structure, motion, tmp_path):
    check(STRUCTURES[structure], motion, tmp_path, 1 if structure == "closed-arch" else 0.005)


def check(text, motion, folder, opening=0.005):
    """Recompute the grades and read the sentences, from the JSON and the table of the histories alone."""
    file, table = folder / "s.yaml", folder / "h.csv"
    file.write_text(text, encoding="utf-8")
    data = json.loads(
        run(
            "respond",
            file,
            *motion,
            "--neighbours",
            0,
            "--opening",
            opening,
            "--engine",
            "exact",
            "--json",
            "--out",
            table,
        ).stdout
    )
    block = json.loads(run("equiv", file, "--json").stdout)["directions"]
    rows = rows_of(table)
    said, runs = data["verdict"], data["responses"]
    p = max(side["p"] for side in block.values())
    curves = {name: np.array([float(row[f"{name} phi_ratio"] or "nan") for row in rows]) for name in runs}
    time = np.array([float(row["t [s]"]) for row in rows])
    uplift = max((side["lambda_ratio"] - 1 for side in block.values()), key=abs)
    best = runs["nonlinear"]
    assert best["unknown"] == (best["opening"] > opening)
    if best["unknown"]:
        after = f"The outcome is unknown after {best['known_to']:.4g} s: then {best['known_to_reason']}"
        assert said.startswith(f"{after}. The structure may overturn.")
        peak, bound = f"has a peak of {best['peak_ratio']:.4g} of", f" {best['peak_lower_bound']:.4g}"
        assert peak in said and bound in said.split("A lower bound of the peak is")[1]
        assert data["agreement"] == {"linear1": None, "linear2": None}
        assert NO_JOINTS in said and "linear" not in said
        beyond = time > best["known_to"]
        assert np.isfinite(curves["nonlinear"][~beyond]).all() and beyond.any()
        hidden = [row for row, late in zip(rows, beyond.tolist(), strict=True) if late]
        assert {row[name] for row in hidden for name in row if name.startswith("nonlinear")} == {""}
        return
    if best["overturned"]:
        sense = {"positive": "clockwise", "negative": "anticlockwise"}[best["overturning_direction"]]
        assert said.startswith(f"The structure overturns {sense}.")
    elif best["uplift_time"] is None:
        assert said.startswith("The structure does not uplift.")
    elif best["peak_ratio"] <= 1:
        assert said.startswith(f"The structure rocks to {best['peak_ratio']:.4g} of its critical rotation phi_cr.")
    differ = set()
    for name in ("linear1", "linear2"):
        found, one = data["agreement"][name], runs[name]
        worst, unfit = 0, name == "linear1" and abs(uplift) > 0.15
        sentence = next(each for each in re.split(r"\.(?: |$)", said) if name in each)
        fates = ["falls" if each["overturned"] else "rocks" if each["peak_ratio"] else "stays" for each in (one, best)]
        if fates[0] != fates[1]:
            worst = 2
            word = {"falls": "overturns", "rocks": "rocks", "stays": "does not uplift"}[fates[0]]
            assert f"it {word}" in sentence
        elif best["overturned"]:
            late = one["overturning_time"] - best["overturning_time"]
            assert found["delay"] == pytest.approx(late)
            alike = one["overturning_direction"] == best["overturning_direction"]
            worst = 0 if alike and abs(late) * p <= 1 else 1
            said_late = (
                "at the same time" if abs(late) < 1e-2 else f"{abs(late):.3g} s {'later' if late > 0 else 'ear'}"
            )
            assert said_late in sentence and ("too" in sentence.rpartition("overturns")[2]) == alike
        elif best["peak_ratio"]:
            x, y = np.nan_to_num(curves["nonlinear"]), np.nan_to_num(curves[name])
            off = one["peak_ratio"] / best["peak_ratio"] - 1
            apart = np.sqrt(np.trapezoid((x - y) ** 2) / np.trapezoid(x**2)) if hasattr(np, "trapezoid") else (
                np.sqrt(np.trapz((x - y) ** 2) / np.trapz(x**2))
            )  # fmt: skip
            when = [time[np.flatnonzero(np.abs(each) >= 0.999 * np.abs(each).max())[0]] for each in (x, y)]
            assert found["peak_error"] == pytest.approx(off, abs=1e-9)
            assert found["rms_difference"] == pytest.approx(apart, rel=1e-3, abs=1e-6)
            assert found["delay"] == pytest.approx(when[1] - when[0], abs=1e-9)
            worst = max(int(np.searchsorted((0.05, 0.15), abs(off))), int(np.searchsorted((0.25, 0.5), apart)),
                        int(abs(when[1] - when[0]) * p > 1))  # fmt: skip
            size = f"{names.percent(abs(off))} {'higher' if off > 0 else 'lower'}" if abs(off) > 5e-5 else "the same"
            assert f"its peak is {size}" in sentence and f"differs by {names.percent(apart)} (rms)" in sentence
            assert ("earlier" in sentence or "later" in sentence) == (abs(when[1] - when[0]) * p > 1)
        if unfit:
            worst = 2
            assert f"is {names.percent(abs(uplift))} too {'low' if uplift < 0 else 'high'}" in sentence
        else:
            assert "uplift acceleration" not in sentence
            differ.add(fates[0] == "falls")
        assert found["grade"] == ORDER[worst]
        opening = {0: f"{name} agrees", 1: f"{name} is good for a first estimate", 2: f"Disregard {name}"}[worst]
        assert sentence.startswith(f"{name} disagrees" if fates[0] != fates[1] and not unfit else opening)
    differ.add(best["overturned"])
    assert ("Do not trust any of them alone" in said) == (len(differ) > 1)
    assert not re.search(r"\de\+", said)


# --- one vocabulary


@pytest.mark.every(2)
@pytest.mark.usefixtures("small_maps")
@pytest.mark.parametrize(
    ("structure", "pulse", "word"),
    [
        ("block", "sine:0.1g:1s", "does not uplift"),
        ("block", "sine:0.4g:0.5s", "rocks"),
        ("block", "sine:1g:2s", "overturns"),
        ("masonry/portal", "sine:0.9g:0.6s", "unknown"),
    ],
)
def test_every_command_calls_an_outcome_the_same(structure, pulse, word, tmp_path):
    block = EXAMPLES / f"{structure}.yaml"
    _, amplitude, period = pulse.split(":")
    smaller = run("spectrum", block, "--pulse", pulse, "--sizes", "5:6", "--count", "2").stdout
    texts = {
        "respond": run("respond", block, "--pulse", pulse, "--neighbours", 0, "--engine", "exact").stdout,
        "animate": run("animate", block, "--pulse", pulse, "--neighbours", 0, "--out", tmp_path / "a.html").stdout,
        "report": run("report", "--neighbours", 2, block, "--pulse", pulse, "-o", tmp_path / "r.html").stdout,
        "spectrum": re.findall(r" s: (it.*?\w)\.", smaller)[0],
        "pulse": run("pulse", block, "--ag", amplitude, "--period", period[:-1]).stdout,
    }
    for command, text in texts.items():
        assert word in " ".join(text.split()), command
        said = " ".join(text.split()).replace(OVERTURNS, "").replace("neighbours overturns", "")
        before = re.split("Coefficient of restitution|No closed form|Closed form", said)[0]
        for other in {"does not uplift", "rocks", "overturns"} - {word, "rocks"}:
            assert other not in before, command
    everything = run("respond", block, "--pulse", pulse, "--neighbours", 0, "--engine", "exact", "--all").stdout
    table = next(line for line in everything.splitlines() if line.strip().startswith("outcome"))
    cells = re.split(r"\s{2,}", table.strip())[1:]
    assert cells == ([word] * 3 if word != "unknown" else [word, "-", "-"])  # no outcome of a block beside it


@pytest.mark.parametrize(
    ("share", "said"),
    [(0.0, "0 %"), (1e-6, "0 %"), (0.00049, "0.049 %"), (0.0489, "4.9 %"), (0.0994, "9.9 %"), (0.0996, "10 %"),
     (-0.33, "-33 %"), (0.575, "58 %"), (0.125, "13 %"), (0.995, "99.5 %"), (0.9999, "99.9 %"), (1.0, "100 %"), (2.83, "283 %"), (1234.5, "123450 %")],
)  # fmt: skip
def test_percentages_have_no_powers_of_ten(share, said):
    assert names.percent(share) == said


@pytest.mark.parametrize(
    "block",
    [
        Block(width=3, height=1),  # its kinematics give eta = -0.35
        Block(width=0.6, height=4, one_sided="positive", mass=2e3, loads=[{"name": "a", "mass": 1e-6, "at": [0, 2]}]),
    ],
    ids=["stocky", "one_sided"],
)
def test_a_release_without_a_known_restitution_ends_at_its_first_impact(block):
    """Its time and rate from the energy of a block alone: phi.^2/2 = p^2 (cos(alpha - phi_0) - cos(alpha - phi))."""
    alpha, radius = np.arctan2(block.width, block.height), np.hypot(block.width, block.height) / 2
    p, start = np.sqrt(3 * 9.80665 / (4 * radius)), alpha / 2

    def rate(phi):
        return p * np.sqrt(2 * (np.cos(alpha - start) - np.cos(alpha - phi)))

    s, weight = np.polynomial.legendre.leggauss(60)
    s, weight = (s + 1) / 2, weight / 2
    phi = start * (1 - s**2)  # in s the integrand 1/rate has no singularity
    time = float(np.sum(weight * 2 * start * s / rate(phi)))

    answer = rk.respond(block, release=0.5, engine="exact")
    assert list(answer.result) == ["nonlinear"]  # linear blocks have no first impact to stop at
    found = answer["nonlinear"]
    assert found.unknown and found.unmeasured and not found.apart and found.impact_count == 1
    assert found.known_to == pytest.approx(time, rel=1e-8) == found.impacts[0, 0]
    assert found.impacts[0, 2] == pytest.approx(rate(0.0), rel=1e-8)
    assert found.peak_ratio == pytest.approx(0.5) and np.isnan(found.phi[found.time > time]).all()
    assert answer.result.contacts[1].time < time - 1e-4  # nothing is said of the forces after it
    said = " ".join(each for each in answer.view.parts if isinstance(each, str))
    assert f"unknown after {time:.4g} s: then it has an impact, and its restitution is not known." in said
    assert "Next: give a measured `restitution` (or `rebound`)." in said and "rocking margin" not in said
    assert answer.to_dict()["conclusion"]["next"] == ["give_restitution", "free_blocks"]
    with pytest.raises(rk.InputError, match=r"restitution|rebound"):  # a ground motion goes on after impacts
        rk.respond(block, "sine:0.5g:0.5s", neighbours=0)
    with pytest.raises(rk.InputError, match=r"restitution|rebound"):
        rk.respond(block, release=0.5, model="linear2")
