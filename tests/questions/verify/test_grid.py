"""The hazard at a site by its coordinates: cells of the reference grid, and the tables in which it comes."""

import gzip
import hashlib
import os
import re
import sys
import zipfile
from functools import cache
from math import asin, cos, radians, sin, sqrt

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.codes.italian import grid
from rocking_cli.codes.italian.grid import distances, read_grid
from rocking_cli.errors import InputError
from rocking_cli.verification.check import read_site
from tests.cli.test_cli import run, run_json
from tests.conftest import SHARED

REAL = SHARED / "hazard" / "ntc_grid.csv.gz"
NEEDS_REAL = pytest.mark.skipif(not REAL.is_file(), reason=f"no reference grid in {REAL.parent}")
PERIODS = (30, 475, 2475)
HEADINGS = ["ID", "LON", "LAT", *(f"{name}_{years}" for years in PERIODS for name in ("ag", "F0", "TC"))]
SITE = "FC: LC1\nsoil: A\nVN: 50\nclass: II\nlongitude: {}\nlatitude: {}\ngrid: {}\n"


def node(i, j):
    """Longitude, latitude and values in tenths of g of a node of a grid that is turned by some degrees."""
    lon, lat = 13.0 + 0.07 * i + 0.004 * j, 42.0 - 0.002 * i + 0.05 * j
    return [
        lon,
        lat,
        *(value for k in range(3) for value in ((0.6 + k + 0.1 * i) * (1 + k), 2.4 + 0.1 * j, 0.3 + 0.01 * k)),
    ]


NODES = {(i, j): node(i, j) for i in range(4) for j in range(4)}


def written(folder, nodes=NODES, headings=HEADINGS, separator=";", above=(), name="grid.csv"):
    comma = separator != ","
    rows = [[str(k), *(f"{value:.7g}" for value in each)] for k, each in enumerate(nodes.values())]
    lines = [*above, separator.join(headings), *(separator.join(row) for row in rows)]
    text = "\n".join(
        [*lines[: len(above) + 1], *(x.replace(".", ",") if comma else x for x in lines[len(above) + 1 :])]
    )
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def workbook(path, sheets):
    """Write a spreadsheet of the kind .xlsx: its least parts, by the standard ECMA-376."""
    office = "http://schemas.openxmlformats.org"
    main, linked = f"{office}/spreadsheetml/2006/main", f"{office}/officeDocument/2006/relationships"
    parts = {"xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{linked}"><sheets>'}
    links = {"_rels/.rels": [("officeDocument", "xl/workbook.xml")], "xl/_rels/workbook.xml.rels": []}
    for k, (name, rows) in enumerate(sheets.items(), 1):
        parts["xl/workbook.xml"] += f'<sheet name="{name}" sheetId="{k}" r:id="rId{k}"/>'
        links["xl/_rels/workbook.xml.rels"].append(("worksheet", f"worksheets/sheet{k}.xml"))
        cells = [
            "".join(
                f'<c t="inlineStr"><is><t>{each}</t></is></c>' if isinstance(each, str) else f"<c><v>{each!r}</v></c>"
                for each in row
            )
            for row in rows
        ]
        body = "".join(f"<row>{each}</row>" for each in cells)
        parts[f"xl/worksheets/sheet{k}.xml"] = f'<worksheet xmlns="{main}"><sheetData>{body}</sheetData></worksheet>'
    parts["xl/workbook.xml"] += "</sheets></workbook>"
    for part, targets in links.items():
        lines = [f'<Relationship Id="rId{k}" Type="{linked}/{kind}" Target="{target}"/>'
                 for k, (kind, target) in enumerate(targets, 1)]  # fmt: skip
        space = f"{office}/package/2006/relationships"
        parts[part] = f'<Relationships xmlns="{space}">{"".join(lines)}</Relationships>'
    with zipfile.ZipFile(path, "w") as archive:
        for part, text in parts.items():
            archive.writestr(part, f'<?xml version="1.0"?>{text}')
    return path


def haversine(lon, lat, other_lon, other_lat):
    a, b = radians(lat), radians(other_lat)
    half = sin((a - b) / 2) ** 2 + cos(a) * cos(b) * sin(radians(lon - other_lon) / 2) ** 2
    return 2 * 6371 * asin(sqrt(half))


def by_hand(corners, lon, lat):
    """The rule of Allegato A: each value is the mean of the corners, weighted by the inverse of their distances."""
    weights = [1 / haversine(lon, lat, *each[:2]) for each in corners]
    return [sum(w * each[k] for w, each in zip(weights, corners, strict=True)) / sum(weights) for k in range(2, 11)]


class TestCells:
    @pytest.mark.parametrize(
        ("i", "j", "u", "v"),
        [(0, 0, 0.5, 0.5), (1, 1, 0.1, 0.9), (1, 1, 0.98, 0.02), (2, 0, 0.49, 0.51), (2, 0, 0.001, 0.3)],
    )
    def test_the_four_corners_by_the_inverse_of_their_distances(self, i, j, u, v, tmp_path):
        (lon, lat), (right, up) = NODES[i, j][:2], ((0.07, -0.002), (0.004, 0.05))
        lon, lat = lon + u * right[0] + v * up[0], lat + u * right[1] + v * up[1]
        cell = read_grid(written(tmp_path)).cell(lon, lat)
        corners = [NODES[i + a, j + b] for a in (0, 1) for b in (0, 1)]
        wanted = by_hand(corners, lon, lat)
        assert [row[0] for row in cell.rows] == [30, 475, 2475]
        values = [value for row in cell.rows for value in (10 * row[1], *row[2:])]
        assert values == pytest.approx(wanted, rel=1e-6)
        found = sorted(each.longitude for each in cell.corners)
        assert found == pytest.approx(sorted(each[0] for each in corners), rel=1e-6)
        assert sum(each.share for each in cell.corners) == pytest.approx(1)

    def test_on_a_node_its_own(self, tmp_path):
        cell = read_grid(written(tmp_path)).cell(*NODES[1, 2][:2])
        (corner,) = cell.corners
        assert corner.distance == 0 and corner.share == 1
        assert cell.rows[1][1:] == pytest.approx([NODES[1, 2][5] / 10, *NODES[1, 2][6:8]])

    def test_along_the_edge_of_two_cells_and_at_the_edge_of_the_grid(self, tmp_path):
        made = read_grid(written(tmp_path))
        for one, other in (((1, 1), (2, 1)), ((0, 0), (0, 1)), ((3, 2), (3, 3))):
            lon, lat = ((a + b) / 2 for a, b in zip(NODES[one][:2], NODES[other][:2], strict=True))
            assert len(made.cell(lon, lat).corners) == 4

    def test_distances_are_those_on_a_sphere(self):
        """A degree of a meridian is 6371 pi/180 km, and one of a parallel shorter by the cosine of the latitude."""
        places = np.array([13 + 43j, 14 + 42j])
        north, east = distances(places, 13.0, 42.0)
        assert north == pytest.approx(6371 * np.pi / 180, rel=1e-9)
        assert east == pytest.approx(6371 * np.pi / 180 * cos(radians(42)), rel=1e-4)
        assert east == pytest.approx(haversine(13, 42, 14, 42), rel=1e-12)

    @pytest.mark.parametrize(
        ("lon", "lat", "said"),
        [
            (14.5, 42.1, "is outside the grid: no cell contains the site at 14.5, 42.1; the nearest node, 13.222, "),
            (
                13.12,
                42.07,
                "is in a hole or at the edge of the grid: a node is missing around the site at 13.12, 42.07",
            ),
            (42.1, 13.1, "is 42.1 and latitude 13.1: outside the grid, but inside it the other way round"),
        ],
    )
    def test_a_site_without_a_cell_is_refused_with_what_to_do(self, lon, lat, said, tmp_path):
        written(tmp_path, {key: each for key, each in NODES.items() if key != (2, 1)})
        (tmp_path / "site.yaml").write_text(SITE.format(lon, lat, "grid.csv"), encoding="utf-8")
        (problem,) = self.refused(tmp_path / "site.yaml")
        assert problem.message.startswith(said) and (problem.line, problem.field) == (5, "longitude")
        if "other way" in said:
            assert problem.hint == "exchange longitude and latitude"
        else:
            assert "`hazard`" in problem.hint and "Sardinia" in problem.hint and "table 2" in problem.hint

    @staticmethod
    def refused(file):
        with pytest.raises(InputError) as caught:
            read_site(file)
        return caught.value.problems


class TestTables:
    WANTED = NODES[1, 1][2] / 10  # g

    @pytest.mark.parametrize(
        ("headings", "above"),
        [
            (HEADINGS, ()),
            (["id", "lon", "lat", *(f"{name} {years} [{unit}]" for years in PERIODS
                                    for name, unit in (("ag", "g/10"), ("F0", "-"), ("TC*", "s")))], ()),
            (["n", "longitude", "latitude", *(f"T{years}_{name}" for years in PERIODS
                                              for name in ("ag", "Fo", "Tc"))], ()),
            (["", "lon", "lat", *(f"{name}_{years}" for years in PERIODS
                                  for name in ("ag_tenths_g", "F0", "TC_star"))], ()),
            (["ID", "LON", "LAT", *("ag", "Fo", "T*c") * 3],
             ("Table 1;;;;;;;;;;;", ";;;TR = 30 years;;;TR=475;;;2475;;")),
        ],
    )  # fmt: skip
    def test_headings_as_they_come(self, headings, above, tmp_path):
        made = read_grid(written(tmp_path, headings=headings, above=above))
        assert made.periods.tolist() == [30, 475, 2475]
        assert made.cell(*NODES[1, 1][:2]).rows[0][1:] == pytest.approx([self.WANTED, *NODES[1, 1][3:5]])

    @pytest.mark.parametrize("separator", [";", ",", "\t"])
    def test_separators_and_decimal_commas(self, separator, tmp_path):
        made = read_grid(written(tmp_path, separator=separator))
        assert made.cell(*NODES[1, 1][:2]).rows[0][1] == pytest.approx(self.WANTED)

    def test_quoted_decimal_commas_between_commas(self, tmp_path):
        file = written(tmp_path)
        lines = file.read_text(encoding="utf-8").splitlines()
        file.write_text(
            "\n".join(",".join(f'"{cell}"' for cell in line.split(";")) for line in lines), encoding="utf-8"
        )
        assert read_grid(file).cell(*NODES[1, 1][:2]).rows[0][1] == pytest.approx(self.WANTED)

    def test_the_order_of_columns_is_free_and_gzip_is_read(self, tmp_path):
        file = written(tmp_path)
        rows = [line.split(";")[::-1] for line in file.read_text(encoding="utf-8").splitlines()]
        packed = tmp_path / "grid.csv.gz"
        packed.write_bytes(gzip.compress("\n".join(map(";".join, rows)).encode()))
        assert read_grid(packed).cell(13.12, 42.07).rows == read_grid(file).cell(13.12, 42.07).rows

    @pytest.mark.parametrize(
        ("unit", "factor", "key", "said"),
        [
            ("", 1.0, "ag_too_large_for_g", "its headings do not give the unit, and no ground has such values in g"),
            (" [g/10]", 1.0, "ag_in_tenths", "a_g is in tenths of g, by its headings"),
            (" [g]", 0.1, "ag_in_g", "a_g is in g, by its headings"),
        ],
    )
    def test_the_unit_is_that_of_the_headings_or_the_only_possible(self, unit, factor, key, said, tmp_path):
        nodes = {k: [v * factor if n in (2, 5, 8) else v for n, v in enumerate(each)] for k, each in NODES.items()}
        file = written(tmp_path, nodes, [f"{each}{unit}" if each.startswith("ag") else each for each in HEADINGS])
        assert read_grid(file).unit == key
        site = {"FC": 1.0, "soil": "A", "VN": 50, "CU": 1, "longitude": 13.12, "latitude": 42.07, "grid": str(file)}
        found = rk.demand(site)
        assert any(said in each for each in found.sentences)
        wanted = by_hand([NODES[i, j] for i in (1, 2) for j in (1, 2)], 13.12, 42.07)[0] / 10
        assert found.demand.tables[1].rows[0][1] == pytest.approx(wanted, rel=1e-5)

    WRONG = (
        (
            lambda text: text.replace("ag_30;", "ag;", 1),
            "the heading 'ag' must have one return period",
            "columns lon, lat",
        ),
        (lambda text: text.replace("TC_475", "xx"), "at 475 years one of ag, F0 and TC is missing", "columns lon, lat"),
        (lambda text: text.replace("LON", "E"), "no heading names the longitude", "columns lon, lat"),
        (lambda text: text.replace("LAT", "N"), "columns are missing", "columns lon, lat"),
        (
            lambda text: text.replace("ag_30", "ag_30 [gal]"),
            "the headings give ag in gal: not one known",
            "`ag_30 [g]`",
        ),
        (lambda text: text.replace("ag_30", "ag_30 [g]"), "ag reaches 8.7 g, which is more than any", "`ag_30 [g]`"),
        (lambda text: "\n".join(text.splitlines()[:4]), "has 3 nodes, of which a cell needs four", "columns lon"),
        (lambda text: "", "no heading names the longitude", "columns lon, lat"),
    )

    @pytest.mark.parametrize(("change", "said", "hint"), WRONG, ids=[each[1][:30] for each in WRONG])
    def test_a_table_that_cannot_be_used_says_why(self, change, said, hint, tmp_path):
        file = written(tmp_path)
        file.write_text(change(file.read_text(encoding="utf-8")), encoding="utf-8")
        with pytest.raises(InputError) as caught:
            read_grid(file)
        (problem,) = caught.value.problems
        assert said in problem.message and hint in problem.hint and problem.file == str(file)

    def test_small_values_without_a_unit_may_be_either(self, tmp_path):
        nodes = {k: [v * 0.1 if n in (2, 5, 8) else v for n, v in enumerate(each)] for k, each in NODES.items()}
        with pytest.raises(InputError, match=r"whether ag is in g or in tenths of g, and it reaches only 0\.87"):
            read_grid(written(tmp_path, nodes))

    @pytest.mark.parametrize("text", ["x", "", "nan"])
    def test_a_cell_that_is_no_number_has_its_line(self, text, tmp_path):
        file = written(tmp_path)
        lines = file.read_text(encoding="utf-8").splitlines()
        lines[3] = ";".join([*lines[3].split(";")[:5], text, *lines[3].split(";")[6:]])
        file.write_text("\n".join(lines), encoding="utf-8")
        with pytest.raises(InputError) as caught:
            read_grid(file)
        assert caught.value.problems[0].line == 4 and "a number is missing" in caught.value.problems[0].message

    def test_a_node_whose_hazard_does_not_grow_has_its_line(self, tmp_path):
        nodes = NODES | {(0, 2): [*NODES[0, 2][:5], 0.5, *NODES[0, 2][6:]]}
        with pytest.raises(InputError) as caught:
            read_grid(written(tmp_path, nodes))
        assert caught.value.problems[0].line == 4
        assert "ag must increase with the return period" in caught.value.problems[0].message

    @pytest.mark.parametrize(
        ("content", "said"),
        [
            (b"PK\x03\x04 of a sheet", "the spreadsheet cannot be read"),
            (b"\xd0\xcf\x11\xe0 of an old sheet", "the spreadsheet cannot be read"),
            (b"\x1f\x8b\x08 cut", "the gzip file cannot be unpacked"),
        ],
    )
    def test_a_damaged_file_is_refused(self, content, said, tmp_path):
        (tmp_path / "grid.xls").write_bytes(content)
        with pytest.raises(InputError) as caught:
            read_grid(tmp_path / "grid.xls")
        assert said in caught.value.problems[0].message

    def test_a_spreadsheet_is_read_as_its_table_in_csv(self, tmp_path):
        rows = [["Tabella 1"], HEADINGS, *([k, *each] for k, each in enumerate(NODES.values()))]
        from_sheet = read_grid(workbook(tmp_path / "grid.xlsx", {"note": [["see the next sheet"]], "griglia": rows}))
        from_text = read_grid(written(tmp_path))
        assert from_sheet.periods.tolist() == from_text.periods.tolist() and from_sheet.unit == from_text.unit
        assert from_sheet.values == pytest.approx(from_text.values, rel=1e-6)
        assert from_sheet.places == pytest.approx(from_text.places, rel=1e-6)

    def test_without_its_package_or_its_table_a_spreadsheet_says_what_to_do(self, tmp_path, monkeypatch):
        file = workbook(tmp_path / "grid.xlsx", {"note": [["no table"]]})
        with pytest.raises(InputError, match="no sheet has a heading that names the longitude"):
            read_grid(file)
        monkeypatch.setitem(sys.modules, "python_calamine", None)
        grid._read.cache_clear()
        with pytest.raises(InputError, match="save the sheet with the table as CSV"):
            read_grid(file)


class TestInASiteFile:
    def test_the_grid_is_beside_the_site_file(self, tmp_path):
        folder = tmp_path / "site"
        folder.mkdir()
        written(folder)
        (folder / "site.yaml").write_text(SITE.format(13.12, 42.07, "grid.csv"), encoding="utf-8")
        data = run_json("demand", folder / "site.yaml")
        wanted = by_hand([NODES[i, j] for i in (1, 2) for j in (1, 2)], 13.12, 42.07)
        assert [row["ag"] for row in data["hazard"]] == pytest.approx([each / 10 for each in wanted[::3]], rel=1e-6)
        assert sorted(data["nodes"][0]) == ["distance", "latitude", "longitude", "weight"] and len(data["nodes"]) == 4
        said = run("demand", folder / "site.yaml").stdout
        assert "Nodes of the reference grid" in said and "on a sphere of 6371 km" in said
        (tmp_path / "site.yaml").write_text(SITE.format(13.12, 42.07, "grid.csv"), encoding="utf-8")
        error = run("demand", tmp_path / "site.yaml", code=2).stderr
        assert "site.yaml:7:7: grid names no file: " in error and "from the folder of the site file" in error

    def test_verify_and_its_sheet_take_it(self, tmp_path):
        written(tmp_path)
        (tmp_path / "site.yaml").write_text(SITE.format(13.12, 42.07, "grid.csv"), encoding="utf-8")
        run("verify", "--site", "site.yaml", "--sheet", "s.html", "--language", "it")
        page = (tmp_path / "s.html").read_text(encoding="utf-8")
        assert "Nodi del reticolo di riferimento" in page and "pesata con l'inverso delle distanze" in page.replace(
            "&#39;", "'"
        )
        checksum = hashlib.sha256((tmp_path / "grid.csv").read_bytes()).hexdigest()
        assert re.search(rf"<code>grid</code></th><td>[^<]*grid.csv</td><td>{checksum}</td>", page)
        (tmp_path / "walls.csv").write_text(
            "name,mechanism,width,height\na,block,0.6,8\nb,block,0.7,9\n", encoding="utf-8"
        )
        assert all(row["ratio"] for row in run_json("survey", "walls.csv", "--site", "site.yaml")["rows"])

    def test_it_is_read_once_as_long_as_it_does_not_change(self, tmp_path, monkeypatch):
        file, texts = written(tmp_path), []
        lines_of = grid._lines
        monkeypatch.setattr(grid, "_lines", lambda path: texts.append(path) or lines_of(path))
        site = {"FC": 1.0, "soil": "A", "VN": 50, "CU": 1, "latitude": 42.07, "grid": str(file)}
        first = [rk.demand(site | {"longitude": 13.1 + 0.01 * k}).states["SLV"].values["ag"] for k in range(3)]
        assert len(texts) == 1
        changed = {key: [*each[:2], *(1.1 * value for value in each[2:])] for key, each in NODES.items()}
        written(tmp_path, changed)
        os.utime(file, ns=(1, 1))
        again = rk.demand(site | {"longitude": 13.1}).states["SLV"].values["ag"]
        assert len(texts) == 2 and again == pytest.approx(1.1 * first[0], rel=1e-5)


@NEEDS_REAL
class TestTheRealGrid:
    @staticmethod
    @cache
    def table():
        with gzip.open(REAL, "rt", encoding="utf-8") as stream:
            return np.loadtxt(stream, delimiter=",", skiprows=1)

    def test_the_node_of_l_aquila(self):
        cell = read_grid(REAL).cell(13.42252, 42.33493)
        assert len(cell.corners) == 1
        assert cell.rows[6] == pytest.approx([475, 0.2610, 2.364, 0.347], abs=5e-5 + 5e-4 * 0.1)

    @pytest.mark.parametrize(
        ("lon", "lat"), [(13.3995, 42.3498), (12.4964, 41.9028), (9.19, 45.4642), (14.2681, 40.8518), (15.55, 38.19),
                         (13.95, 40.73), (7.6869, 45.0703), (18.1720, 40.3530)],
    )  # fmt: skip
    def test_the_corners_are_the_nearest_in_each_quarter_and_the_values_their_mean(self, lon, lat):
        """The grid is turned by up to five degrees: quarters are those of the line to the nearest node's neighbour."""
        table = self.table()
        d = np.array([haversine(lon, lat, *row[:2]) for row in table])
        nearest = table[d.argmin()]
        z = (table[:, 0] - lon) * cos(radians(lat)) + 1j * (table[:, 1] - lat)
        from_node = np.array([haversine(*nearest[:2], *row[:2]) for row in table])
        along = z[from_node.argsort()[1]] - z[d.argmin()]
        quarter = np.floor(np.angle(z / along) / (np.pi / 2)).astype(int)
        corners = [min(np.flatnonzero(quarter == k), key=d.__getitem__) for k in range(-2, 2)]
        weights = 1 / d[corners]
        wanted = (table[corners, 2:].T @ weights / weights.sum()).reshape(9, 3)
        cell = read_grid(REAL).cell(lon, lat)
        assert sorted(each.distance for each in cell.corners) == pytest.approx(sorted(d[corners].tolist()), rel=1e-9)
        assert np.array(cell.rows)[:, 1:] == pytest.approx(wanted * [0.1, 1, 1], rel=1e-9)

    @pytest.mark.parametrize(("lon", "lat"), [(9.11, 39.22), (12.61, 35.5), (10.32, 42.79), (8.0, 40.0)])
    def test_sardinia_and_small_islands_are_not_in_it(self, lon, lat):
        with pytest.raises(InputError, match="is outside the grid"):
            read_grid(REAL).cell(lon, lat)
