"""Site files: what they may say, and what is wrong with place and field."""

import pytest

from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.verification.check import read_site
from rocking_cli.verification.code import codes
from tests.cli.test_cli import run, run_json

GOOD = "FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\n"
TABLE = "FC: 1.35\nVN: 50\nCU: 1\nsoil: B\nhazard: [[30, .06, 2.4, .27], [475, .2, 2.4, .3], [2475, .3, 2.5, .36]]\n"
SPECTRUM = "FC: 1.35\nspectrum:\n- [0, 0.24]\n- [0.4, 0.6]\n- [9, 0.01]\n"


@pytest.fixture
def site(tmp_path):
    def written(text):
        (tmp_path / "site.yaml").write_text(text, encoding="utf-8")
        return tmp_path / "site.yaml"

    return written


@pytest.mark.parametrize(
    "text", [GOOD, TABLE, SPECTRUM, GOOD + "floor: {z: 2, H: 3, T1: 0.4, xi1: 0.1, n: 3}\nT0: 0.1\n"]
)
def test_the_ways_to_give_the_ground(text, site):
    assert read_site(site(text)).site.FC == 1.35


WRONG = [
    # text, line, field, what is said
    (GOOD.replace("1.35", "0.9"), 1, "FC", "must be at least 1, got 0.9"),
    (GOOD.replace("FC: 1.35\n", ""), 1, "FC", "is missing: confidence factor"),
    (GOOD.replace("TC: 0.4", "TC: 2.5"), 4, "TC", "is above T_D = 4 a_g/g + 1.6 = 2.4 s: got 2.5 s"),
    (GOOD + "floor: {z: 4, H: 3, T1: 0.4, xi1: 0.1, n: 3}\n", 6, "floor.z", "is above the roof"),
    (GOOD + "floor: {z: 2, H: 3, T1: 0.4, xi1: 0.1, n: 3, SLD: {T1: 0.3}}\n", 6, "floor.SLD.xi1", "is missing"),
    (GOOD + "soil: F\n", 6, "soil", "must be A, B, C, D or E"),
    (GOOD + "spectrum: [[0, 1], [1, 1]]\n", 6, "spectrum", "cannot be combined with ag"),
    (GOOD + "VN: 50\n", 6, "VN", "requires `hazard`, the table of return periods"),
    (GOOD + "code: EC9\n", 6, "code", "there is no code 'EC9'"),
    (SPECTRUM.replace("[0.4, 0.6]", "[0, 0.6]"), 4, "spectrum[2]", "has two ordinates at 0 s"),
    (SPECTRUM.replace("[0, 0.24]", "[0.1, 0.24]"), 3, "spectrum[1]", "the first ordinate must be at T = 0"),
    (SPECTRUM.replace("[9, 0.01]", "[9, 0]"), 5, "spectrum[3]", "has no positive acceleration at 9 s"),
    (TABLE.replace("[475", "[20"), 5, "hazard[2]", "return periods must increase, got 20 after 30 years"),
    (TABLE.replace("soil: B\n", ""), 1, "soil", "is missing: a hazard needs"),
    (TABLE + "ag: 0.2\n", 6, "ag", "cannot be combined with hazard"),
    (
        GOOD + "element: {kind: cantilever, L: 1, t: 0.3, w: 18000, E: 1.2e+9}\nT0: 0.1\n",
        6,
        "element",
        "cannot be combined with T0",
    ),
    (GOOD + "element: {kind: fixed, L: 1, t: 0.3, w: 18000, E: 1.2e+9}\n", 6, "element.kind", "cantilever or spanning"),
    ("", None, None, "the file is empty"),
]


@pytest.mark.parametrize(("text", "line", "field", "said"), WRONG, ids=[each[3][:30] for each in WRONG])
def test_what_is_wrong_has_its_place(text, line, field, said, site):
    with pytest.raises(InputError) as caught:
        read_site(site(text))
    found = [each for each in caught.value.problems if each.field == field and said in each.message]
    assert found, caught.value.problems
    assert found[0].line == line and found[0].file.endswith("site.yaml")


def test_one_mistake_does_not_hide_another(site):
    with pytest.raises(InputError) as caught:
        read_site(site(GOOD.replace("1.35", "0.9").replace("TC: 0.4", "TC: 3")))
    assert [each.field for each in caught.value.problems] == ["FC", "TC"]


def test_a_spectrum_that_ends_early_is_placed_in_the_file(site, tmp_path):
    (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 0.6\nheight: 8\n", encoding="utf-8")
    result = run("verify", "b.yaml", "--site", site(SPECTRUM.replace("[9,", "[2,")), code=2)
    assert "site.yaml:3:1: spectrum ends at 2 s, but the ordinate at 3.201 s is needed" in result.stderr
    late = GOOD + "SLC:\n  spectrum: [[0, 0.3], [4, 0.1]]\n"
    result = run("verify", "b.yaml", "--site", site(late), code=2)
    assert "site.yaml:7:13: SLC.spectrum ends at 4 s, but the ordinate at 4.459 s is needed" in result.stderr


class TestTheStarter:
    def test_it_works_as_it_is(self, tmp_path):
        (tmp_path / "s.yaml").write_text(run("new", "site").stdout, encoding="utf-8")
        assert run_json("verify", "--site", "s.yaml")["code"] == "NTC2018"

    @pytest.mark.parametrize("way", ["hazard", "spectrum", "floor", "T0", "SLC", "TC_star"])
    def test_so_do_the_lines_that_are_commented_out(self, way, site):
        lines = codes()["NTC2018"].starter.splitlines()
        more = {"hazard": ("VN", "class", "topography", "hazard"), "TC_star": ("TC_star", "topography")}.get(
            way, (way,)
        )
        kept = [
            line.removeprefix("# ") if line.startswith(tuple(f"# {key}:" for key in more)) else line for line in lines
        ]
        if way in ("hazard", "spectrum"):
            kept = [line for line in kept if not line.startswith(("ag:", "F0:", "TC:", "S:"))]
        if way == "TC_star":
            kept = [line for line in kept if not line.startswith(("TC:", "S:"))]
        found = read_site(site("\n".join(kept))).site
        assert getattr(found, way) is not None

    def test_it_is_one_json_object_too(self):
        assert run_json("new", "site")["site"] == "NTC2018"


def test_both_directions_are_there_unless_it_leans_on_walls(tmp_path, site):
    (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 0.6\nheight: 8\none_sided: negative\n", encoding="utf-8")
    data = run_json("verify", "b.yaml", "--site", site(GOOD))
    assert list(data["directions"]) == [Direction.NEGATIVE.label] and data["governs"] == "negative"
