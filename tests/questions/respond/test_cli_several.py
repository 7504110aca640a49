"""Several ground motions in one call of `respond`, `animate` and `report`."""

import cmath
import json
import re
from pathlib import Path

import pytest

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.views.view import Table
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES, rows_of

FRAME = str(EXAMPLES / "frame.yaml")
ACCEL = EXAMPLES / "accel.csv"
BLOCK = str(EXAMPLES / "block.yaml")


def lines(*arguments, code=0):
    return [json.loads(line) for line in run(*arguments, "--json", code=code).stdout.splitlines()]


@pytest.fixture
def records(tmp_path):
    """Three records in a folder, a pattern for them, and a bad file beside it."""
    motion = read_record(ACCEL)
    (tmp_path / "r").mkdir()
    for name, factor in (("east", 0.1), ("north", 1.0), ("west", 6.0)):
        rows = (f"{motion.dt * i!r},{a!r}" for i, a in enumerate((factor * motion.acceleration).tolist()))
        (tmp_path / "r" / f"{name}.csv").write_text("t,a [m/s2]\n" + "\n".join(rows), encoding="utf-8")
    (tmp_path / "bad.csv").write_text("t,accel_g\n0,0\n0.01,x\n", encoding="utf-8")
    return "r/*.csv"


class TestRespond:
    def test_every_record_is_answered_with_the_object_it_has_alone(self, records):
        asked = ("respond", FRAME, "--polarity", "both", "--target-pga", "0.3", "--impacts")
        together = lines(*asked, "--record", records)
        alone = [lines(*asked, "--record", f"r/{name}.csv")[0] for name in ("east", "north", "west")]
        assert together == alone
        assert lines(*asked, *(word for each in ("east", "west") for word in ("--record", f"r/{each}.csv"))) == [
            alone[0],
            alone[2],
        ]

    def test_nothing_is_shown_where_one_is_not_read_and_the_other_has_no_answer(self, records, monkeypatch):
        def refuse(*_, **__):
            raise InputError("no answer")

        monkeypatch.setattr("rocking_cli.questions.respond.verb.response_of", refuse)
        result = run("respond", BLOCK, "--record", "bad.csv", "--record", "r/east.csv", code=InputError.exit_code)
        assert result.stdout == "" and "bad.csv" in result.stderr and "east.csv: no answer" in result.stderr

    def test_a_row_each_and_how_many_overturn_it(self, records):
        text = run("respond", BLOCK, "--record", records, "--model", "linear2,nonlinear").stdout
        rows = {line.split()[0]: line.split()[1:] for line in text.splitlines() if ".csv  " in line}
        objects = {each["record"]["name"]: each for each in lines("respond", BLOCK, "--record", records)}
        assert list(rows) == list(objects) == ["east.csv", "north.csv", "west.csv"]
        for name, (pga, *cells) in rows.items():
            assert pga == f"{objects[name]['record']['pga_g']:.4g}"
            *cells, moved, share, sign, median = " ".join(cells).replace("no uplift", "none").split()
            top = objects[name]["responses"]["nonlinear"]["points"]["top"]["horizontal"]
            assert moved == ("-" if top is None else f"{1000 * top:.4g}")
            near = objects[name]["neighbours"]
            assert sign == "%" and float(share) == pytest.approx(100 * near["overturned"], abs=0.5)
            middle = near["peak_ratio"]["50"]
            assert median == ("overturns" if middle is None else f"{middle:.3g}")
            for model, cell in zip(("linear2", "nonlinear"), cells, strict=True):
                found = objects[name]["responses"][model]
                if found["overturned"]:
                    assert cell == "overturns"
                else:
                    assert cell == ("none" if found["uplift_time"] is None else f"{found['peak_ratio']:.4g}")
        assert {cell for row in rows.values() for cell in row[1:]} >= {"overturns", "uplift"}
        found = {name: each["responses"]["nonlinear"] for name, each in objects.items()}
        assert [name for name, each in found.items() if each["overturned"]] == ["west.csv"]
        still = sum(each["uplift_time"] is None for each in found.values())
        counts = [
            "overturns under 1 of 3 motions (west.csv)",
            f"rocks under {2 - still}",
            f"does not uplift under {still}",
        ]
        said = " and ".join(", ".join(each for each in counts if not each.endswith(" 0")).rsplit(", ", 1))
        assert f"By the nonlinear model, the structure {said}. west.csv governs: " in " ".join(text.split())
        weak = run("respond", FRAME, "--pulse", "sine:0.1g:1s", "--pulse", "ricker:0.1g:1s").stdout
        assert "By the nonlinear model, the structure uplifts under none of 2 motions.\n" in weak

    def test_a_row_has_millimetres_of_the_top_and_the_force_of_each_tie(self):
        """A spring from (-3, 2) of the ground to (-0.35, 2) of a block that turns clockwise about (0.35, 0).

        At phi, the top (0, 2.8) is at 0.35 + |r| cos(atan2(2.8, -0.35) - phi), and the spring is as much longer than
        2.65 m as its end has gone.
        """
        tie = {"name": "bar", "stiffness": 2e4, "from": {"ground": [-3.0, 2.0]}, "to": {"at": [-0.35, 2.0]}}
        block = rk.Block(name="b", width=0.7, height=2.8, mass=3000.0, one_sided="positive", ties=[tie])
        answer = rk.respond(block, ["sine:0.4g:0.5s", "sine:0.5g:0.6s", "sine:0.05g:0.5s"], model="nonlinear")
        frame = answer.frames["peaks"]
        assert list(frame) == ["motion", "pga_g", "top_horizontal_displacement", "bar_force"]
        (table,) = (part for part in answer.view.parts if isinstance(part, Table))
        assert table.columns[3:5] == ["top\n[mm]", "bar\n[kN]"]
        for k, (name, each) in enumerate(answer.items()):
            phi = each["nonlinear"].peak_positive
            turned = [complex(0.35) + complex(x - 0.35, y) * cmath.exp(-1j * phi) for x, y in ((0, 2.8), (-0.35, 2))]
            moved, force = turned[0].real, 2e4 * (abs(turned[1] - complex(-3, 2)) - 2.65)
            row = frame.iloc[k].tolist()
            assert row == [name, pytest.approx(each.given.motion.pga_g), pytest.approx(moved), pytest.approx(force)]
            assert table.rows[k][3:5] == [f"{1000 * moved:.4g}", f"{force / 1000:.4g}"]
            data = each.to_dict()["responses"]["nonlinear"]
            assert (data["points"]["top"]["horizontal"], data["ties"]["bar"]["peak_force"]) == tuple(row[2:])
        assert frame.iloc[2, 2] == frame.iloc[2, 3] == 0.0 < frame.iloc[0, 2] < frame.iloc[1, 2]

    def test_both_polarities_and_the_pulses_in_them_have_rows_of_their_own(self, records):
        both = run("respond", FRAME, "--record", records, "--polarity", "both").stdout
        table, _, said = both.partition("Neighbours: ")
        assert both.startswith("By the nonlinear model, ")
        table = table[table.index("peak phi") :]
        assert table.count(".csv, reversed") == 3 and table.count(".csv") == 6
        assert said.count("Friction that the joints require: ") == 1 and "usual for masonry" in said
        pulses = run("respond", FRAME, "--record", records, "--with-pulse", "sine", "--target-pga", "0.3").stdout
        assert pulses.count("its sine pulse alone") == 3

    def test_a_file_for_each(self, records, tmp_path):
        asked = ("respond", FRAME, "--record", records, "--model", "linear1")
        run(*asked, "--out", "o.csv", "--plot", "p.png")
        run("respond", FRAME, "--record", "r/north.csv", "--model", "linear1", "--out", "alone.csv")
        names = {each.name for each in tmp_path.iterdir()} - {"r", "bad.csv", "alone.csv"}
        assert names == {
            f"{stem}-{each}.{end}" for stem, end in (("o", "csv"), ("p", "png")) for each in ("east", "north", "west")
        }
        assert (tmp_path / "o-north.csv").read_bytes() == (tmp_path / "alone.csv").read_bytes()
        assert {float(row["linear1 phi [rad]"]) for row in rows_of(tmp_path / "o-east.csv")} == {0.0}

    def test_names_that_meet_are_told_apart_and_no_input_is_replaced(self, records, tmp_path):
        (tmp_path / "s").mkdir()
        (tmp_path / "s" / "east.csv").write_bytes((tmp_path / "r" / "east.csv").read_bytes())
        (tmp_path / "o-east-r.csv").write_bytes((tmp_path / "r" / "east.csv").read_bytes())
        run("respond", "--record", "?/east.csv", "--out", "x.csv", "--model", "linear2")
        assert {each.name for each in tmp_path.glob("x*")} == {"x-east.csv", "x-east-s.csv"}
        before = (tmp_path / "o-east-r.csv").read_bytes()
        (tmp_path / "east-r.csv").write_bytes(before)
        asked = ("respond", "--record", "east-r.csv", "--record", "o-east-r.csv", "--out", "o.csv")
        assert "would overwrite an input file" in run(*asked, code=2).stderr
        assert (tmp_path / "o-east-r.csv").read_bytes() == before

    def test_a_bad_one_is_reported_and_the_others_are_shown(self, records):
        result = run(
            "respond", FRAME, "--record", "bad.csv", "--record", records, "--record", "no.csv", "--json", code=5
        )
        assert [json.loads(line)["record"]["name"] for line in result.stdout.splitlines()] == [
            "east.csv",
            "north.csv",
            "west.csv",
        ]
        assert "bad.csv:3" in result.stderr and "no.csv: no such file" in result.stderr
        assert (
            "under east.csv, the structure does not uplift"
            in run("respond", FRAME, "--record", "bad.csv", "--record", "r/east.csv", code=5).stdout
        )
        assert run("respond", FRAME, "--record", "bad.csv", "--record", "no.csv", code=2).stdout == ""

    def test_one_that_cannot_be_followed_is_left_out(self, records, monkeypatch):
        from rocking_cli.dynamics import history
        from rocking_cli.errors import SolverError

        whole = history.follow

        def some_fail(model, motion, **more):
            if "north" in motion.name:
                raise SolverError("too small steps")
            return whole(model, motion, **more)

        monkeypatch.setattr(history, "follow", some_fail)
        for command in (("respond",), ("animate", "--out", "m.html")):
            result = run(*command, BLOCK, "--record", records, "--json", code=5)
            assert len(result.stdout.splitlines()) == 2 and "north.csv: too small steps" in result.stderr
        run("respond", BLOCK, "--record", "r/north.csv", code=4)

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (("--record", "r/*.csv", "--vertical", "r/east.csv"), "--vertical has no effect with several motions"),
            (("--record", "r/east.csv", "r/north.csv"), "use a quoted pattern: --record '*.csv'"),
            ((BLOCK, BLOCK, "--record", "r/east.csv"), "One structure is expected, but 2 are given"),
        ],
    )
    def test_what_does_not_go_together(self, records, options, said):
        result = run("respond", *options, code=2)
        assert said in result.stderr and result.stdout == ""


class TestAnimate:
    def test_a_page_each_a_row_each_and_a_line_each(self, records, tmp_path):
        asked = ("animate", BLOCK, "--record", records, "--record", "bad.csv", "--out", "m.html")
        found = lines(*asked, code=5)
        assert [each["file"] for each in found] == ["m-east.html", "m-north.html", "m-west.html"]
        assert all(Path(each["file"]).read_text(encoding="utf-8").startswith("<!") for each in found)
        alone = lines("animate", BLOCK, "--record", "r/west.csv", "--out", "m-west.html")
        assert alone == found[2:]
        text = run(*asked, code=5).stdout
        assert [name for name in ("east", "north", "west") if f"{name}.csv" in text] == ["east", "north", "west"]
        assert "does not uplift" in text and "overturns" in text


def test_what_governs_is_over_the_limit_where_nothing_is_critical(tmp_path):
    """A tie that holds a block up to its limit: there is no phi_cr to speak of."""
    file = tmp_path / "tied.yaml"
    file.write_text(
        "mechanism: block\nwidth: 0.6\nheight: 4.0\ndensity: 2000\ndepth: 1.0\none_sided: positive\nrebound: 0.5\n"
        "ties:\n  - {name: bar, from: {ground: [-4.0, 4.0]}, to: {at: [-0.3, 4.0]}, stiffness: 1e6}\n",
        encoding="utf-8",
    )
    said = " ".join(run("respond", file, "--pulse", "sine:0.4g:0.8s", "--pulse", "sine:0.5g:0.8s").stdout.split())
    assert "of the limit" in said and "governs" in said and "phi_cr." not in said.split("governs")[1].split(".")[0]
    governs = re.search(r"governs: the structure rocks to [\d.]+ ([a-z_ ]+), and", said)
    assert governs is not None and governs[1] == "of the limit"


class TestPython:
    """What commands do of several, verbs do of a sequence."""

    def test_motions(self, records, tmp_path):
        typed = lines("respond", FRAME, "--record", records, "--neighbours", 0, "--impacts")
        found = rk.respond(FRAME, [records], impacts=True, out="o.csv", plot="p.svg")
        assert list(found) == ["east.csv", "north.csv", "west.csv"]
        assert [json.loads(json.dumps(each)) for each in found.to_dict().values()] == typed
        table = rk.respond(FRAME, records).to_frame()
        frame = found.to_frame()
        assert list(dict.fromkeys(frame["motion"])) == list(found) and frame.equals(table)
        assert (
            frame.query("motion == 'north.csv'")
            .drop(columns="motion")
            .reset_index(drop=True)
            .equals(rk.respond(FRAME, "r/north.csv").to_frame())
        )
        assert found.frames["west.csv"].equals(found["west.csv"].to_frame())
        impacts = found["west.csv"].frames["impacts"]
        runs = found["west.csv"].result.runs[1].values()
        assert len(impacts) == sum(len(run.impacts) for run in runs) > 0
        files = {
            f"{stem}-{name}{end}" for stem, end in (("o", ".csv"), ("p", ".svg")) for name in ("east", "north", "west")
        }
        assert {each.name for each in tmp_path.glob("[op]-*")} == files
        with pytest.raises(InputError, match="several motions have no common plot"):
            found.plot()
        with pytest.raises(InputError, match=r"bad.csv:3"):
            rk.respond(FRAME, ["bad.csv", records])

    def test_all_azimuths(self, records):
        pair = {"other": "r/west.csv", "azimuth": "all", "model": "nonlinear"}
        found = rk.respond(BLOCK, "r/north.csv", **pair)
        asked = ("respond", BLOCK, "--record", "r/north.csv", "--with", "r/west.csv", "--azimuth", "all")
        assert lines(*asked, "--model", "nonlinear") == [found.to_dict()]
        assert f"one every {found.to_dict()['azimuths'][1]:g} degrees" in found.view.parts[1]
        for given in ({"polarity": "both"}, {"neighbours": 5}, {"tail": 3.0}, {"impacts": True}):
            with pytest.raises(InputError, match=f"`{next(iter(given))}` has no effect with `azimuth` all"):
                rk.respond(BLOCK, "r/north.csv", **pair, **given)
        with pytest.raises(InputError, match="`azimuth` can be all for `respond` only"):
            rk.margin(BLOCK, "r/north.csv", other="r/west.csv", azimuth="all")
