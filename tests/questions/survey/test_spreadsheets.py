"""Surveys from spreadsheets and into them, and tables of other commands as spreadsheets."""

import datetime
import io
import sys
from pathlib import Path

import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io import tables
from rocking_cli.io.spreadsheet import parse_sheet, read_sheet
from tests.cli.test_cli import run, some
from tests.conftest import PROJECT

HINT = "is not installed (the extra rocking-cli[spreadsheet])"
calamine = pytest.importorskip("python_calamine", reason=f"calamine {HINT}")
xlsxwriter = pytest.importorskip("xlsxwriter", reason=f"XlsxWriter {HINT}")
BLOCKS = [["mechanism", "name", "width", "height"], ["block", "a", 0.5, 2], ["block", "b", 0.3, 2]]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def book(sheets, merged=(), file="t.xlsx"):
    """Write a spreadsheet: rows of cells by the names of sheets, and cells of the first that are merged."""
    with xlsxwriter.Workbook(file) as written:
        day = written.add_format({"num_format": "yyyy-mm-dd"})
        for name, rows in sheets.items():
            sheet = written.add_worksheet(name)
            for line, row in enumerate(rows):
                for k, cell in enumerate(row):
                    if isinstance(cell, datetime.date):
                        sheet.write_datetime(line, k, cell, day)
                    else:
                        sheet.write(line, k, cell)
        for place in merged:
            written.worksheets()[0].merge_range(place, None)
            line, k = xlsxwriter.utility.xl_cell_to_rowcol(place.partition(":")[0])
            written.worksheets()[0].write(line, k, next(iter(sheets.values()))[line][k])
    return file


def cells(file):
    return calamine.CalamineWorkbook.from_path(file).get_sheet_by_index(0).to_python()


class TestReading:
    def test_cells_are_those_of_a_text(self):
        day = datetime.date(2020, 1, 2)
        file = book({"S": [["n", "real", "true", "day", "text", "long"], [300, 0.125, True, day, " a\nb ", 1e22]]})
        assert read_sheet(Path(file)).rows[0].cells == ("300", "0.125", "True", "2020-01-02", "a\nb", "1e+22")

    def test_numbers_typed_as_text_may_have_decimal_commas_beside_numbers(self):
        """0.125 would be ambiguous in a text in which other numbers have commas."""
        head = ["mechanism", "name", "width", "height", "spessore\n[mm]", "# piece"]
        file = book({"S": [head, ["block", "a", 0.125, "1,25", "", 1.5], ["block", "b", "", 2, "500,5", "0071"]]})
        rows = {row.name: row.lambda_ for row in rk.survey(file).rows}
        assert rows == pytest.approx({"a": 0.1, "b": 0.25025})
        file = book({"S": [head, ["block", "a", "1.500", "1,25", "", 1], ["block", "b", 1, 2, "", ""]]})
        words = " ".join(some("survey", file).stderr.split())
        assert "t.xlsx:2: width: 1.500 is ambiguous" in words

    def test_empty_rows_and_columns_before_the_table_and_their_lines(self):
        file = book({"S": [[], [], *([None, *row] for row in BLOCKS), [], [None, "block", "c", -1, 2]]})
        sheet = read_sheet(Path(file))
        assert (sheet.line, [row.line for row in sheet.rows]) == (3, [4, 5, 7])
        assert "t.xlsx:7: width must be more than 0 m" in some("survey", file).stderr

    def test_a_title_above_the_headings_is_refused_with_what_to_do(self):
        file = book({"S": [["Museum"], *BLOCKS]}, ["A1:D1"])
        words = " ".join(run("survey", file, code=2).stderr.split())
        assert "t.xlsx:1: the table has neither a column mechanism nor a column file" in words
        assert "take rows above the headings away" in words

    def test_a_cell_merged_over_rows_is_that_of_each(self):
        rows = [
            ["mechanism", "name", "width", "height"],
            ["block", "a", 0.5, 2],
            ["", "b", "", 4],
            [],
            ["block", "c", 1, 2],
        ]
        file = book({"S": rows}, ["A2:A4", "C2:C4"])
        answer = rk.survey(file)
        assert {row.name: row.lambda_ for row in answer.rows} == {"a": 0.25, "b": 0.125, "c": 0.5} and not answer.bad

    def test_of_several_sheets_the_first_with_cells_is_read_and_named(self):
        file = book({"Empty": [], "Hall": [*BLOCKS, ["block", "c", -1, 2]], "Notes": [["x"]], "More": [["y"]]})
        result = some("survey", file, "--page", "p.html")
        assert "table: t.xlsx, Hall; sheets not read: Notes, More" in result.stderr
        assert "t.xlsx, Hall:4: width must be" in result.stderr
        assert "t.xlsx, Hall" in Path("p.html").read_text(encoding="utf-8")
        assert "sheets" not in run("survey", book({"Empty": [], "Hall": BLOCKS})).stderr

    def test_a_spreadsheet_without_cells_and_one_that_is_none_are_refused(self):
        assert "t.xlsx: the table is empty" in run("survey", book({"S": []}), code=2).stderr
        Path("n.xlsx").write_bytes(b"PK\x03\x04 and no more")
        assert "n.xlsx: the spreadsheet cannot be read" in run("survey", "n.xlsx", code=2).stderr
        Path("p.csv").write_text("PK,mechanism,width,height\n,block,1,2\n", encoding="utf-8")
        assert "PK is not a field of block" in run("survey", "p.csv", code=2).stderr

    def test_bytes_are_read_as_a_file_is(self):
        file = book({"S": BLOCKS})
        assert parse_sheet(Path(file).read_bytes(), "standard input").rows == read_sheet(Path(file)).rows


class TestWriting:
    def test_numbers_are_numbers_and_codes_and_formulas_are_texts(self):
        Path("t.csv").write_text(
            "mechanism;name;width [mm];height;# number;# list;# formula\nblock;=1+1;250;1,10;0071;1,5;=2+3\n"
            "block;b;300;2 m;9876543210123456;;\nblock;c;500;2;-0,5;;\n",
            encoding="utf-8",
        )
        run("survey", "t.csv", "--out", "o.xlsx")
        head, *rows = cells("o.xlsx")
        assert head == list(rk.survey("t.csv").columns())
        by_name = {row[1]: dict(zip(head, row, strict=True)) for row in rows}
        assert [*by_name] == ["b", "=1+1", "c"]
        first, second, third = by_name["=1+1"], by_name["b"], by_name["c"]
        assert (first["rank"], first["lambda"], first["width [mm]"], first["height"]) == (
            2.0,
            pytest.approx(0.25 / 1.1),
            250.0,
            1.1,
        )
        assert (first["# number"], first["# list"], first["# formula"]) == ("0071", 1.5, "=2+3")
        assert (second["# number"], second["height"], third["# number"]) == ("9876543210123456", "2 m", -0.5)
        assert second["doubt"] == "" and b"<f>" not in Path("o.xlsx").read_bytes()

    def test_a_spreadsheet_comes_back_as_it_went(self):
        rows = [[*BLOCKS[0], "# room", "# true"], ["block", "a", 0.5, 2, "hall", True], ["block", "b", 0.25, 2, 7, ""]]
        run("survey", book({"S": rows}), "--out", "o.xlsx")
        head, *written = cells("o.xlsx")
        kept = [[row[head.index(name)] for name in ("width", "height", "# room", "# true")] for row in written]
        assert kept == [[0.25, 2.0, 7.0, ""], [0.5, 2.0, "hall", "True"]]

    def test_what_is_no_number_is_empty_or_a_text(self):
        stream = io.BytesIO()
        columns = {"a": [float("nan"), float("inf"), -0.0], "b": [None, True, 10**15], "c": ["", "x\x01", "=1"]}
        tables._write_xlsx(stream, [columns, columns])
        Path("o.xlsx").write_bytes(stream.getvalue())
        rows = [["", "", ""], ["inf", True, "x\ufffd"], [0.0, 1e15, "=1"]]
        head, *written = cells("o.xlsx")
        assert head == ["a", "b", "c"] and [row[:2] for row in written] == [row[:2] for row in rows * 2]
        assert [row[2] for row in written][::3] == ["", ""] and written[2][2] == "=1"

    @pytest.mark.parametrize("more", [("equiv",), ("design", "--vary", "width=0.3m:1m", "--until", "lambda >= 0.3")])
    def test_other_commands_write_their_tables_too(self, more):
        command, *options = more
        block = PROJECT / "examples" / "block.yaml"
        run(command, block, *options, "--out", "o.xlsx")
        run(command, block, *options, "--out", "o.csv")
        head, first, *_ = cells("o.xlsx")
        assert head == Path("o.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
        assert any(isinstance(cell, float) and cell % 1 for cell in first)
        assert "--separator writes a CSV table, and o.xlsx is not one" in " ".join(
            run(command, block, *options, "--out", "o.xlsx", "--separator", ";", code=2).stderr.split()
        )

    def test_without_the_package_it_is_refused_before_any_work(self, monkeypatch):
        monkeypatch.setattr(tables, "find_spec", lambda name: None)
        with pytest.raises(InputError, match=r"\.xlsx needs the package xlsxwriter") as refused:
            rk.survey({"mechanism": ["block"], "width": [1], "height": [2]}, out="o.xlsx")
        assert "pip install 'rocking-cli[spreadsheet]', or give a name that ends in .csv" in str(refused.value)

    def test_without_the_reader_it_is_said_what_to_install(self, monkeypatch):
        file = book({"S": BLOCKS})
        monkeypatch.setitem(sys.modules, "python_calamine", None)
        assert "pip install 'rocking-cli[spreadsheet]', or save" in run("survey", file, code=2).stderr

    def test_more_rows_than_a_sheet_has_are_refused(self, monkeypatch):
        monkeypatch.setattr(tables, "MAX_SHEET_ROWS", 3)
        Path("o.xlsx").write_text("before")
        with pytest.raises(InputError, match="more than the 3 rows of a sheet"):
            rk.survey({"mechanism": ["block"] * 3, "width": [1] * 3, "height": [2] * 3}, out="o.xlsx")
        assert Path("o.xlsx").read_text() == "before"
        rk.survey({"mechanism": ["block"] * 2, "width": [1] * 2, "height": [2] * 2}, out="o.xlsx")
        assert len(cells("o.xlsx")) == 3
