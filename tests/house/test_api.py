"""The package as Python users have it: classes to import, verbs, answers that show themselves, a page that runs."""

import doctest
import json
import pickle
import re
from importlib import import_module
from pkgutil import resolve_name

import numpy as np
import pytest
from mypy import api as mypy
from pydantic import ValidationError

import rocking_cli as rk
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics.model import MODELS
from rocking_cli.plugins.rooms import names
from rocking_cli.structure import build_models
from tests.cli.test_cli import run_json
from tests.cli.test_every_option import CALLS, RECORD, SITE
from tests.conftest import EXAMPLES, PROJECT
from tests.following import respond

ACCEL = str(EXAMPLES / "accel.csv")
DOCS = PROJECT / "docs"


@pytest.fixture(scope="module")
def maker():
    def load(name):
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(DOCS)
            return import_module(name)

    return load


@pytest.fixture(scope="module")
def wall():
    return rk.Wall(thickness=0.3, height=3.0)


# --- classes


@pytest.mark.parametrize("name", [name for name in Registry() if "rocking-cli " in Registry().package_of(name)])
def test_every_mechanism_can_be_imported_by_the_name_of_its_class(name):
    cls = Registry()[name]
    assert getattr(rk, cls.__name__) is cls
    assert cls.__name__ in dir(rk)
    assert rk.mechanisms[name] is cls


@pytest.mark.parametrize("name", rk._MOVED)
def test_a_name_that_is_gone_says_what_to_use(name):
    with pytest.raises(AttributeError, match=rf"^rocking_cli has no {name}: use ") as caught:
        getattr(rk, name)
    places = [word for word in re.findall(r"[\w.]+", str(caught.value).partition(": use ")[2]) if "." in word]
    assert places and all(callable(resolve_name(re.sub(r"^rk\b", "rocking_cli", place))) for place in places)
    assert name not in dir(rk)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"thickness": -0.3, "height": 3.0}, "thickness must be more than 0 m, got -0.3"),
        ({"thickness": 0.3}, "height is missing"),
        ({"thicknes": 0.3, "thickness": 0.3, "height": 3.0}, "did you mean thickness?"),
        ({"thickness": "30 kg", "height": 3.0}, "30 kg is a mass, not a length"),
    ],
)
def test_wrong_fields_are_an_input_error_that_names_them(fields, words):
    with pytest.raises(rk.InputError) as caught:
        rk.Wall(**fields)
    assert words in str(caught.value)
    assert not isinstance(caught.value, ValidationError)


@pytest.mark.docs
def test_the_stub_is_not_stale(maker):
    stub = maker("make_stub")
    assert stub.STUB.read_text(encoding="utf-8") == stub.stub(), "run make pages"


# --- answers


def test_a_response_is_the_histories_and_the_json_of_the_command(wall):
    answer = rk.respond(wall, ACCEL)
    alone = respond(wall, rk.read_record(ACCEL))
    assert list(answer) == list(alone)
    for name, run in alone.items():
        assert answer[name].peak_ratio == run.peak_ratio
    said = run_json("respond", EXAMPLES / "wall.yaml", "--record", ACCEL, "--neighbours", 0)
    assert rk.respond(EXAMPLES / "wall.yaml", ACCEL).to_dict()["responses"] == said["responses"]
    assert json.dumps(answer.to_dict())


def test_a_model_may_be_one_name_and_an_unknown_one_is_told(wall):
    assert list(rk.respond(wall, "sine:0.2g:1s", model="linear2")) == ["linear2"]
    with pytest.raises(rk.InputError, match="`model` must be one of nonlinear, linear1, linear2, got 'linear3'"):
        rk.respond(wall, "sine:0.2g:1s", model="linear3")


def test_a_motion_may_be_a_file_a_pulse_its_text_or_samples(wall):
    pulse = rk.parse_pulse("ricker:0.4g:0.8s")
    ways = [pulse, "ricker:0.4g:0.8s", pulse.sampled()]
    peaks = {rk.respond(wall, each, model="nonlinear")["nonlinear"].peak_ratio for each in ways}
    assert len(peaks) == 1
    assert rk.respond(wall, ACCEL, scale=-1.0, model="nonlinear")["nonlinear"].peak_ratio > 0
    with pytest.raises(rk.InputError, match="no such file"):
        rk.respond(wall, "nowhere.csv")


def test_every_structure_under_every_motion_with_every_factor(wall):
    block = rk.Block(width=0.7, height=2.8)
    answer = rk.respond_each([block, wall], ["sine:0.4g:0.8s", ACCEL], model="nonlinear", scale=[0.5, -1.0, 2.0])
    found = answer["nonlinear"]
    assert found.peak_ratio.shape == (2, 2, 3)
    one = rk.respond(wall, ACCEL, scale=-1.0, model="nonlinear", tail=0.0)["nonlinear"]
    assert found.peak_ratio[1, 1, 1] == one.peak_ratio and found.fell_to[1, 1, 1] == one.fell_to
    frame = answer.to_frame()
    assert len(frame) == 12 and frame["peak_ratio"][10] == one.peak_ratio
    assert frame.loc[10, ["structure", "motion", "scale"]].tolist() == ["wall", "accel.csv", -1.0]


def test_doubts_are_warnings_of_python_unless_something_watches():
    tall = rk.Block(width=0.5, height=700.0)
    with pytest.warns(rk.DoubtWarning, match="did you mean 700 mm"):
        rk.equiv(tall)
    with pytest.warns(rk.DoubtWarning, match="displacement ends"):
        rk.record(rk.parse_pulse("sine:0.4g:0.8s").sampled())

    class Patient(Watcher):
        def warn(self, text):
            said.append(text)

    said = []
    rk.equiv(tall, watch=Patient())
    assert "did you mean 700 mm" in said[0]


OF_A_MAP = (
    "omega; a; period [s]; ag [g]; outcome; overturned; unknown; peak_ratio; impact_count; known_to [s]; "
    "peak_lower_bound"
)
FRAMES = {
    "equiv": (
        "structure; mechanism; direction; p [rad/s]; phi_cr [rad]; lambda [g]; lambda_lin [g]; kappa1; kappa2; "
        "theta_cr1 [rad]; theta_cr2 [rad]; eta; v_imp [m/s]; I_eq [kg m2]; G_eq [kg m]; B_eq [kg m]; per unit mass",
        {"lambda [g]": lambda _, data: [side["lambda"] for side in data["directions"].values()]},
    ),
    "collapse": (
        "direction; lambda; hinge; between; x [m]; y [m]",
        {"y [m]": lambda _, data: [each["at"][1] for side in data["directions"].values() for each in side["hinges"]]},
    ),
    "draw": ("length", {"length": lambda answer, _: [each.text for each in answer.sketch.lengths]}),
    "error": (
        "structure; direction; kappa; quantity; amplitude; acceleration; unit; value; ratio",
        {"ratio": lambda _, data: [
            ratio if isinstance(ratio, float) else ratio[f"kappa{kappa}"] for side in data["directions"].values()
            for kappa in (1, 2)
            for ratio in (
                side["uplift_ratio"], side["v_imp_ratio"], side["free_period"][0]["ratio"],
                side["overturning_time"][0]["ratio"],
            )
        ]},
    ),
    "respond": (
        "model; t [s]; a_g [g]; phi [rad]; phi_dot [rad/s]; phi_ratio; top u_x [m]; top u_y [m]; base shear [N/kg]",
        {"phi_ratio": lambda answer, _: [value for model in MODELS for value in padded(answer, model)]},
    ),
    "respond_each": (
        "structure; model; motion; scale; polarity; restitution; pga_g [g]; pgv [m/s]; outcome; overturned; unknown; "
        "peak_ratio; peak_rotation [rad]; peak_rate [rad/s]; peak_displacement [m]; impact_count; uplift_time [s]; "
        "overturning_time [s]; end_time [s]; known_to [s]; peak_lower_bound; opening; slip [m]",
        {"peak_ratio": lambda _, data: [data[model]["peak_ratio"][0][0][0] for model in MODELS]},
    ),
    "respond_around": (
        "model; azimuth [deg]; pga_g [g]; peak_ratio; overturned; unknown; known_to [s]",
        {"pga_g [g]": lambda _, data: data["pga_g"]},
    ),
    "animate": ("t [s]; phi [rad]", {"phi [rad]": lambda answer, _: answer.film.history.phi}),
    "pulse": (
        "polarity; model; peak_ratio; outcome",
        {"peak_ratio": lambda _, data: [each["peak_ratio"] for each in data["responses"].values()]},
    ),
    "spectrum": (
        "structure; size [s]; scale; R [m]; motion; peak_ratio; peak_rate [rad/s]; overturned; unknown; "
        "peak_lower_bound",
        {"scale": lambda _, data: data["spectra"][0]["scale"] * 2,
         "unknown": lambda _, data: np.ravel(data["spectra"][0]["every_unknown"])},
    ),
    "overturning": (OF_A_MAP, {"omega": lambda _, data: data["omega"] * 3}),
    "overturning_map": (OF_A_MAP, {"ag [g]": lambda _, data: np.repeat(data["ag"], 3)}),
    "overturning_curves": (
        "structure; period [s]; least [g]; possible [g]; first",
        {"possible [g]": lambda _, data: [value for each in data["structures"] for value in each["possible"]]},
    ),
    "margin": (
        "motion; scale; pga_g [g]; overturned; unknown; uplift",
        {"scale": lambda _, data: data["motions"][0]["factors"],
         "overturned": lambda _, data: data["motions"][0]["shares"]},
    ),
    "shares": ("overturned; stands; unknown; checked", {"stands": lambda _, data: [data["stands"]]}),
    "survey": (
        "rank; name; mechanism; side; row; line; share_lowest; share_highest; overturned; unknown; peak_ratio; "
        "slip [m]; peak_over; outcome; worst; lambda; "
        "uplift [g]; direction; p [rad/s]; phi_cr [rad]; kappa1; kappa2; eta; no_block; doubt; caution",
        {"p [rad/s]": lambda _, data: [row["p"] for row in data["rows"]]},
    ),
    "design": (
        "width [m]; peak_ratio; unknown; holds",
        {"width [m]": lambda _, data: data["scan"]["values"], "peak_ratio": lambda answer, _: answer.metric},
    ),
    "equivalent_pulses": (
        "structure; p_t; t [s]; phi_ratio",
        {"phi_ratio": lambda answer, _: [
            value for each in (*(one.history for one in answer.members), answer.linear) for value in each.ratio
        ]},
    ),
    "response_spectrum": (
        "motion; damping; period [s]; pseudo Sa [g]; pseudo Sv [m/s]; Sd [m]",
        {"pseudo Sv [m/s]": lambda _, data: data["sv"]},
    ),
    "record": ("t [s]; a_g [g]", {"a_g [g]": lambda *_: RECORD.acceleration / 9.80665}),
    "verify": (
        "direction; method; a_g [g]; asked [g]; zeta_E; TR [years]; governs",
        {"a_g [g]": lambda answer, _: [
            method.a_g for side in answer.directions.values() for method in side.methods.values()
        ]},
    ),
    "demand": (
        "state; period [s]; Sa [g]; Sd [m]",
        {"Sa [g]": lambda _, data: [value for each in data["states"].values() for value in each["acceleration"]]},
    ),
    "select": (
        "motion; period [s]; Sa [g]; target Sa [g]; mean Sa [g]",
        {"mean Sa [g]": lambda _, data: data["spectrum"]["mean"] * 2},
    ),
    "fragility": (
        "structure; limit_state; measure; unit; kind; median; dispersion; scale; x; probability; low; high; unknown; "
        "lower_median; lower_dispersion; lower_scale; lower_probability; lower_low; lower_high",
        {"median": lambda answer, data: [data["curves"][0]["median"]["value"]] * len(answer.to_frame())},
    ),
    "fit_fragility": (
        "intensity; probability; low; high; robust_low; robust_high; lower_probability; lower_low; lower_high; "
        "lower_robust_low; lower_robust_high",
        {"probability": lambda answer, _: answer.curve.probability(answer.to_frame()["intensity"])},
    ),
    "report": (
        "motion; peak_ratio; overturned; unknown",
        {"motion": lambda _, data: [each["name"] for each in data["motions"]],
         "peak_ratio": lambda _, data: [
             each["polarities"][f"{each['polarity']}"]["responses"]["nonlinear"]["peak_ratio"]
             for each in data["motions"]
         ]},
    ),
    "calibrate": (
        "time [s]; angle [rad]; fitted [rad]; fitted, eta of each impact [rad]",
        {"fitted [rad]": lambda answer, _: answer.fitted},
    ),
    "selfcheck": (
        "check; meaning; found; limit; unit; passed; why; seconds",
        {name: lambda _, data, name=name: [each[name] for each in data["checks"]] for name in ("check", "found")},
    ),
}  # fmt: skip
FRAMES["results"] = FRAMES["fragility"]
"""The columns of the frame of each verb, and numbers of some as answer or data have them."""
QUESTIONS = {verb: given for verb, (given, _) in CALLS.items()} | {
    "verify": {"structure": CALLS["equiv"][0]["structures"], "site": SITE},
    "results": {"store": "in.runs"},
    "selfcheck": {"quick": True},
}  # fmt: skip


def padded(answer, model):
    """The ratios of a history, zero after its end."""
    return np.concatenate([answer[model].ratio, np.zeros(max(run.time.size for run in answer.values()))])[
        : max(run.time.size for run in answer.values())
    ]


def name_of(head):
    """The name that a column of a file has in a frame: "known to [s]" is known_to."""
    words = "".join(
        each if each.isalnum() or each in "_." else " " for each in head.split(" [")[0].replace("/", " over ")
    )
    return "_".join(words.split())


GRIDS = {
    "respond": {"model", "t"}, "respond_each": {"model", "structure", "motion", "scale"},
    "respond_around": {"model", "azimuth"}, "spectrum": {"structure", "motion", "size"},
    "overturning_map": {"ag", "period"}, "overturning": {"ag", "period"}, "overturning_curves": {"structure", "period"},
    "margin": {"motion", "scale"}, "error": {"direction", "kappa", "amplitude", "acceleration"},
    "equivalent_pulses": {"structure", "p_t"}, "response_spectrum": {"motion", "period"}, "demand": {"state", "period"},
    "select": {"motion", "period"}, "fragility": {"structure", "sample", "motion", "level"},
}  # fmt: skip
"""The dimensions of the labelled arrays of each verb whose frame is a grid."""


@pytest.mark.every(3)
@pytest.mark.filterwarnings("ignore::rocking_cli.DoubtWarning")
@pytest.mark.parametrize("verb", FRAMES)
def test_an_answer_has_its_columns_and_numbers_and_shows_itself(verb, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    heads, numbers = FRAMES[verb]
    if verb == "results":
        rk.fragility(**QUESTIONS["fragility"], store="in.runs")
    answer = getattr(rk, verb)(**QUESTIONS[verb])
    frame, data = answer.to_frame(), answer.to_dict()
    assert list(answer.columns()) == heads.split("; ")
    names = {head: name_of(head) for head in heads.split("; ")}
    assert list(frame) == list(names.values()) and not any(set(" /[]") & set(name) for name in frame)
    units = {name: head.split(" [")[1][:-1] for head, name in names.items() if head.endswith("]")}
    assert frame.attrs["units"] == units
    numeric = frame.select_dtypes("floating")
    assert not (np.signbit(numeric) & (numeric == 0)).to_numpy().any()
    assert "-0.0" not in re.findall(r"-0\.0\b(?!\d)", json.dumps(data, allow_nan=False))
    for head, of in numbers.items():
        expected, head = list(of(answer, data)), names[head]
        if isinstance(expected[0], str):
            assert frame[head].tolist() == expected
        else:
            np.testing.assert_allclose(frame[head].astype(float), np.array(expected, float), rtol=1e-12)
    text, page = repr(answer), answer._repr_html_()
    assert text.startswith("<") and text.endswith(">") and "\n" not in text and len(text) < 160
    assert ("<table>" in page or verb == "draw") and page.count("<table") == page.count("</table>")
    if verb in GRIDS:
        check_grid(answer, answer.runs() if verb == "fragility" else frame, GRIDS[verb])


def check_grid(answer, frame, dims):
    """The labelled arrays of an answer have the numbers of its frame."""
    pytest.importorskip("xarray")
    arrays = answer.to_xarray()
    assert set(arrays.dims) == dims
    for name, each in arrays.variables.items():
        assert each.attrs["long_name"]
        if name in frame:
            assert each.attrs.get("units") == frame.attrs["units"].get(name), name
    for _, row in frame.iloc[:: len(frame) // 7 + 1].iterrows():
        for name, each in arrays.data_vars.items():
            if name in frame:
                there = each.sel({dim: row[dim] for dim in each.dims}).item()
                assert there == row[name] or (there != there and row[name] != row[name]), name


def test_ratios_of_the_equivalent_block_are_one_frame_and_arrays_of_each_quantity():
    asked = {"at": [0.2, 0.6], "a": [1.5, 2.0, 4.0]}
    answer = rk.error(EXAMPLES / "frame.yaml", **asked)
    frame, (positive, _) = answer.to_frame(), answer.result
    assert frame.quantity.value_counts().to_dict() == {"overturning": 12, "period": 8, "uplift": 4, "v_imp": 4}
    mine = frame.query("direction == 'positive' and quantity == 'overturning'")
    for kappa in (1, 2):
        own = mine[mine.kappa == kappa]
        assert own.acceleration.tolist() == asked["a"] and own.value.tolist() == positive.overturning.tolist()
        assert own.ratio.tolist() == getattr(positive, f"overturning_ratio{kappa}").tolist()
    pytest.importorskip("xarray")
    arrays = answer.to_xarray()
    assert arrays.period_ratio.sel(direction="positive", kappa=2).values.tolist() == positive.period_ratio.tolist()
    assert arrays.uplift_ratio.sel(direction="positive").values.tolist() == [
        positive.uplift_ratio1, positive.uplift_ratio2,
    ]  # fmt: skip
    assert arrays.overturning.attrs["units"] == "s" and arrays.v_imp.dims == ("direction",)


def test_several_answers_are_one_grid_and_what_is_none_says_so(monkeypatch):
    block = rk.Block(width=0.7, height=2.8)
    with pytest.raises(rk.InputError, match="an answer of equivalent block is not a grid"):
        rk.equiv(block).to_xarray()
    pytest.importorskip("xarray")
    answers = rk.respond(block, ["sine:0.3g:0.8s", "ricker:0.3g:0.8s"], model="nonlinear")
    arrays = answers.to_xarray()
    for name, each in answers.items():
        history, own = each["nonlinear"], arrays.phi.sel(motion=name, model="nonlinear").dropna("t")
        assert own.values.tolist() == history.phi.tolist() and own.t.values.tolist() == history.time.tolist()
    monkeypatch.setattr("rocking_cli.ask.answer.find_spec", lambda name: None)
    with pytest.raises(rk.InputError, match=r"labelled arrays require the package xarray\n  pip install"):
        answers.to_xarray()


def test_names_of_others_are_text_in_a_notebook():
    answer = rk.equiv(rk.Block(name="<img src=x>", width=0.7, height=2.8))
    assert "<img" not in answer._repr_html_() and "&lt;img" in answer._repr_html_()


def test_a_map_of_a_structure_is_that_of_the_command():
    pulses = {"period": (0.3, 2.0), "ag": (0.1, 1.0), "points": 9}
    answer = rk.overturning_map(EXAMPLES / "block.yaml", **pulses)
    said = run_json("overturning", EXAMPLES / "block.yaml", "--period", "0.3:2", "--ag", "0.1g:1g", "--points", 9)
    assert answer.to_dict() == said
    assert np.isnan(answer.outcome.peak_ratio[answer.outcome.fell]).all()


def test_a_report_is_written_with_what_gives_the_structure_again(tmp_path):
    answer = rk.report(rk.Block(name="made here", width=0.7, height=2.8), out=tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "made here" in page and "width: 0.7" in page
    assert "made here" in repr(answer)


def test_a_study_given_in_python_is_that_of_its_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = {
        "structures": [rk.Block(name="pillar", width=0.6, height=2.6, restitution=0.9), EXAMPLES / "wall.yaml"],
        "records": [{"pulse": "sine:1g:0.6s"}, {"pulse": "ricker:1g:1s"}],
        "method": "stripes",
        "levels": {"measure": "PGA", "least": 0.2, "most": 1.6, "count": 6},
        "limit_states": ["overturning"],
    }
    first = rk.fragility(study, store="pillar.runs")
    (tmp_path / "pillar.yaml").write_text("mechanism: block\nname: pillar\nwidth: 0.6\nheight: 2.6\nrestitution: 0.9\n")
    file = json.dumps({**study, "structures": ["pillar.yaml", str(EXAMPLES / "wall.yaml")]})
    (tmp_path / "study.yaml").write_text(file)
    assert first.to_frame().equals(rk.fragility("study.yaml", store="other.runs").to_frame())
    assert rk.results("pillar.runs").to_frame().equals(first.to_frame())
    with pytest.raises(rk.InputError, match=r"study: structures must be a list"):
        rk.fragility({**study, "structures": study["structures"][0]}, store="bad.runs")


def test_a_mechanism_stands_for_the_file_of_an_entry(tmp_path):
    width = {"normal": {"mean": 0.6, "deviation": 0.06}}
    study = {
        "structures": [
            {"file": rk.Block(name="pillar", width=0.6, height=2.6), "vary": {"width": width}},
            {"file": EXAMPLES / "block.yaml", "name": "other"},
        ],
        "records": [{"file": EXAMPLES / "accel.csv", "factor": 2}],
        "method": "cloud",
        "samples": 2,
    }
    plan = rk.fragility(study, store=tmp_path / "a.runs", check=True).result
    assert [each.structure for each in plan.trials] == ["pillar", "pillar", "other"]
    assert len({each.lambda_ for each in plan.trials}) == 3


# --- what the documentation shows


PICTURES = {"scatter.png", "response.png", "spectrum.png", "fragility.png"}
PAGES = [("tutorial.md", {"response.png"}), ("python.md", PICTURES), ("import.md", {"import.png"})]


@pytest.mark.docs
@pytest.mark.parametrize(("page", "pictures"), PAGES)
def test_the_pages_on_python_do_what_they_show(page, pictures, maker, tmp_path):
    assert maker("make_python").run(tmp_path, page) == 0
    assert {path.name for path in tmp_path.glob("*.png")} == pictures


TYPED = """
from typing import assert_type
import rocking_cli as rk
from rocking_cli.questions.record.verb import RecordAnswer
from rocking_cli.questions.respond.verb import ResponseAnswer
from rocking_cli.ask.answer import Answers
block = rk.Block(width=0.7, height=2.8)
assert_type(rk.respond(block, "sine:0.3g:0.5s", tail=3), ResponseAnswer)
assert_type(rk.respond(structure=block, motions=["a.csv", "b.csv"]), Answers[ResponseAnswer])
assert_type(rk.record("a.csv", scale=2.0), RecordAnswer)
assert_type(rk.record(["a.csv"]), Answers[RecordAnswer])
rk.animate(block, "a.csv", out="a.html").film
rk.animate(block, ["a.csv"], out="a.html")["a.csv"].film
rk.equiv(block).positive
rk.equiv([block])["block"].positive
rk.respond(block, "a.csv", tale=3)
"""


@pytest.mark.types
def test_a_type_checker_accepts_the_page_and_tells_one_motion_from_several(maker, tmp_path):
    (tmp_path / "page.py").write_text(maker("make_python").script(), encoding="utf-8")
    (tmp_path / "typed.py").write_text(TYPED, encoding="utf-8")
    options = ["--config-file", str(PROJECT / "pyproject.toml"), "--cache-dir", str(PROJECT / ".mypy_cache")]
    files = [str(tmp_path / "page.py"), str(tmp_path / "typed.py")]
    out, err, code = mypy.run([*options, "--disable-error-code", "no-untyped-call", *files])
    assert code in (0, 1), out + err
    assert not [line for line in out.splitlines() if "page.py" in line and "Wall" not in line], out
    wrong = [line for line in out.splitlines() if "typed.py" in line and " error: " in line]
    assert wrong and all(f":{TYPED.count(chr(10))}:" in line for line in wrong), out


VERBS = [
    name.removeprefix("rocking_cli")
    for name in sorted(set(names().values()))
    if ">>>" in (PROJECT / f"{name.replace('.', '/')}.py").read_text(encoding="utf-8")
]
MODULES = (
    "",
    *VERBS,
    ".ask.answer",
    ".ask.watcher",
    ".core.structure_fields",
    ".dynamics.batch",
    ".dynamics.exact",
    ".dynamics.outcome",
    ".excitation.base",
    ".io.tables",
    ".names",
    ".short_repr",
    ".structure",
    ".units",
    ".views.column",
    ".views.column",
)


@pytest.mark.every(2)
@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_run(name, monkeypatch):
    monkeypatch.chdir(PROJECT)
    found = doctest.testmod(import_module(f"rocking_cli{name}"))
    assert found.attempted > 0 and found.failed == 0


def test_a_motion_keeps_samples_of_its_own():
    samples = np.zeros(100)
    made = []
    for k in (1, 2, 3):
        samples[:] = k
        made.append(rk.GroundMotion(f"m{k}", 0.01, samples, unit="m/s2"))
    assert [each.pga_g for each in made] == pytest.approx([k / 9.80665 for k in (1, 2, 3)])
    with pytest.raises(ValueError, match="read-only"):
        made[0].acceleration[0] = 9.0
    assert made[0].scaled(1.0).acceleration is not samples


# --- what is refused, and what travels


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda block: rk.equiv({"mechanism": "block"}), "structure must be a mechanism or a YAML file, got a dict"),
        (lambda block: rk.respond(build_models(block)[0], ACCEL), "structure must be a mechanism or a YAML file"),
        (lambda block: rk.respond(block, np.zeros(9)), "`dt` is missing: samples in an array"),
        (lambda block: rk.spectrum(block, ACCEL, count=-1), "`count` must be at least 1, got -1"),
        (lambda block: rk.spectrum(block, ACCEL, count=0), "`count` must be at least 1, got 0"),
        (lambda block: block.coefficients(0.1, rk.Direction.POSITIVE), "phi must be an array of rotations, got 0.1"),
        (lambda block: block.coefficients("a", rk.Direction.POSITIVE), "phi must be an array of rotations, got 'a'"),
        (lambda block: block.kinetic_inertia(0.1, rk.Direction.POSITIVE), "phi must be an array of rotations"),
    ],
)
def test_an_argument_of_another_kind_is_an_error_of_the_tool(ask, said):
    with pytest.raises(rk.InputError, match=said):
        ask(rk.Block(width=0.7, height=2.8))


def test_answers_can_be_pickled_with_their_plots():
    block = rk.Block(width=0.7, height=2.8)
    for answer in (rk.equiv(block), rk.respond(block, "sine:0.3g:0.8s", model="nonlinear")):
        copy = pickle.loads(pickle.dumps(answer))
        assert copy.to_dict() == answer.to_dict() and copy.sentences == answer.sentences
        columns = answer.columns()
        for name, values in columns.items():
            np.testing.assert_array_equal(copy.columns()[name], values)
        assert len(copy.plot().axes) == len(answer.plot().axes)
        assert pickle.loads(pickle.dumps(copy)).to_dict() == answer.to_dict()
    many = pickle.loads(pickle.dumps(rk.respond_each(block, "sine:0.3g:0.8s", model="nonlinear")))
    assert len(many.plot().axes) == 1
