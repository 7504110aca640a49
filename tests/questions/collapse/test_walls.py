"""Walls of many blocks: the elevation with openings, what is said of many blocks, and how they are drawn."""

import io
import runpy

import numpy as np
import pytest
import yaml
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb

from mechanisms.assembly import Assembly
from mechanisms.symmetric_frame import SymmetricFrame
from rocking_cli.ask.read import read_record
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import load_structure
from rocking_cli.plotting import style
from rocking_cli.plotting.structure import LINE_WEIGHT_SHARE, MIN_FORCE_SHARE, draw_structure, weight
from rocking_cli.plotting.style import POINTS_PER_INCH
from rocking_cli.questions.animate.picture import animation_page
from rocking_cli.questions.collapse.verb import collapses
from rocking_cli.questions.collapse.view import data, view
from rocking_cli.studies.film import Film
from rocking_cli.studies.picture import MAX_SEPARATE_PARTS, START_SHARE, picture
from rocking_cli.text import in_short
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.following import respond

WALL = EXAMPLES / "masonry" / "wall_with_openings.yaml"
PIERS = [(1.5 * k, 1.5 * k + 0.5) for k in range(5)]  # from where to where [m], between heights of 1 m and 3 m


def words(shown):
    """What a view says, its tables as lines of cells."""
    lines = []
    for part in shown.parts:
        if isinstance(part, str):
            lines.append(part)
        else:
            lines += [part.title, "   ".join(part.columns), *("   ".join(row) for row in part.rows)]
    return "\n".join(lines)


@pytest.fixture(scope="module")
def wall():
    return load_structure(WALL)


@pytest.fixture(scope="module")
def found(wall):
    return collapses(wall)


@pytest.fixture(scope="module")
def shown(wall):
    return picture(wall)


def test_its_script_prints_the_file(capsys):
    runpy.run_path(str(WALL.with_name("make_wall.py")), run_name="__main__")
    assert capsys.readouterr().out == WALL.read_text(encoding="utf-8")


@pytest.mark.every(2)
@pytest.mark.parametrize("direction", list(Direction))
def test_the_elevation_sways_on_its_piers(found, direction):
    """By hand: each pier turns as a whole about opposite corners, and the upper storey goes along."""
    each = found[direction]
    assert sorted(len(group) for group in each.groups) == [12] * 5 + [101]
    storey = next(group for group in each.groups if len(group) == 101)
    assert "ring beam" in storey and len(each.rest) == 37 and {"left sill", "right sill"} <= set(each.rest)
    feet = [complex(right if direction > 0 else left, 1.0) for left, right in PIERS]
    heads = [complex(left if direction > 0 else right, 3.0) for left, right in PIERS]
    assert sorted((hinge.at for hinge in each.hinges), key=lambda z: (z.imag, z.real)) == pytest.approx(feet + heads)
    assert each.lambda_ == pytest.approx(0.5 / 2.0, rel=1e-9) and each.valid_to is None


def test_it_is_the_frame_of_the_paper(wall):
    """Five columns under one mass: the same rotation, uplift and frequency parameter by another code."""
    area = {1800: 2 * 6.5 * 0.25 + 5 * 2.5 * 0.25 + 0.5 * 0.25 + 2 * 6.5 * 0.25, 2500: 6.5 * 0.25, 2600: 6.0 * 0.25}
    above, piers = sum(density * size for density, size in area.items()), 5 * 0.5 * 2.0 * 1800
    frame = SymmetricFrame(column_width=0.5, column_height=2.0, columns=5, mass_ratio=above / piers)
    ours, theirs = (equivalent_block(each)[Direction.POSITIVE] for each in (wall, frame))
    for name in ("p", "phi_cr", "lambda_", "kappa1", "kappa2"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), rel=1e-9), name


def test_what_is_said_of_many_blocks_is_short_and_in_json_whole(wall, found):
    text = words(view(wall, found))
    plain = data(found[Direction.POSITIVE])
    for group in plain["groups"]:
        letters = [each["name"] for each in plain["hinges"] if "+".join(group) in each["between"]]
        said = f"{len(group)} blocks ({', '.join(group[:3])} and {len(group) - 3} more, on hinges {', '.join(letters)})"
        assert said in text
    assert max(map(len, text.splitlines())) < 1000
    joints = {each["joint"] for each in plain["thrust"]}
    assert f"{len(plain['thrust'])} joints bear" in text and len(joints) > 24
    hinges = {each["joint"] for each in plain["hinges"]}
    tables = [part for part in view(wall, found).parts if not isinstance(part, str)]
    rows = next(table.rows for table in tables if table.title.endswith("mechanism, positive"))
    assert {row[0] for row in rows} == hinges & joints


def test_names_in_short():
    names = [f"b{k}" for k in range(10)]
    assert in_short(names[:8]) == "b0, b1, b2, b3, b4, b5, b6, b7"
    assert in_short(names[:9], "; ") == "b0; b1; b2; b3; b4; b5; b6; b7 and 1 more"
    assert in_short(names * 200, most=1) == "b0 and 1,999 more" and in_short([]) == ""


@pytest.mark.rest
class TestPicture:
    def test_blocks_that_move_as_one_are_one_part(self, shown):
        grouped = shown.grouped
        assert len(shown.parts) == 198 > MAX_SEPARATE_PARTS and len(grouped.parts) == 7  # piers, storey, and what rests
        assert grouped.grouped is grouped
        for rotation in (0.0, 0.1, -0.2):
            ours, theirs = (
                np.array([each for part in of.placed(rotation)[0] for each in part]) for of in (grouped, shown)
            )
            apart = np.abs(ours[:, None] - theirs).max(axis=2)
            assert apart.shape == (198, 198) and sorted(apart.argmin(axis=1)) == list(range(198))
            assert apart.min(axis=1).max() < 1e-9
            assert grouped.placed(rotation)[1] == pytest.approx(shown.placed(rotation)[1])

    def test_the_centroid_of_each_link_is_marked(self, shown):
        marks = shown.grouped.marks(0.0)
        assert len(marks) == 6  # not of what rests
        piers = sorted(marks, key=lambda z: z.imag)[:5]
        assert sorted(piers, key=lambda z: z.real) == pytest.approx([complex(left + 0.25, 2.0) for left, _ in PIERS])

    def test_the_centroid_of_a_link_is_that_of_all_its_blocks(self):
        """A tower in steps: all of it turns to the left, and its upper half alone to the right."""
        widths = [1.4] * 20 + [0.8] * 22
        corners = [[[0.0, k], [width, k], [width, k + 1.0], [0.0, k + 1.0]] for k, width in enumerate(widths)]
        blocks = {f"b{k}": {"polygon": each} for k, each in enumerate(corners)}
        tower = Assembly(blocks=blocks, ground=SLIDES["ground"], density=2000.0, depth=1.0)
        grouped = picture(tower).grouped
        assert len(grouped.parts) == 2
        low, high = 20 * 1.4, 22 * 0.8
        middle = (low * (0.7 + 10.0j) + high * (0.4 + 31.0j)) / (low + high)
        turned = grouped.marks(-1e-6)
        assert turned == pytest.approx([middle], abs=1e-4)
        assert grouped.marks(0.0) == pytest.approx([0.4 + 31.0j])

    def test_parts_with_a_hinge_in_common_differ_in_shade(self, shown):
        for direction in Direction:
            shade = dict(zip((part.name for part in shown.parts), shown.shades[direction], strict=True))
            pairs = [hinge.bodies for hinge in shown.sketch.hinges[direction]]
            assert len(pairs) == 10
            for one, other in pairs:
                assert shade[one] != shade[other], (one, other)

    def test_its_files_are_small(self, shown, wall):
        figure = draw_structure(shown, "wall")
        drawn = io.BytesIO()
        style.save(figure, drawn, format="svg")
        assert len(drawn.getvalue()) < 400_000
        record = read_record(EXAMPLES / "accel.csv")
        history = respond(wall, record, models=("linear2",))["linear2"]
        assert len(animation_page(Film(shown, history, record), "wall")) < 300_000

    def test_lines_are_lighter_the_smaller_the_blocks(self, shown):
        side = 0.25 * POINTS_PER_INCH * LINE_WEIGHT_SHARE  # of a block, in points at an inch a metre
        assert weight(shown, 1.0) == pytest.approx(side) and side > style.HAIR
        assert weight(shown, 0.1) == style.HAIR and weight(shown, 10.0) == style.MEDIUM
        portal = picture(load_structure(EXAMPLES / "masonry" / "portal.yaml"))
        assert weight(portal, 0.01) == style.MEDIUM

    def test_strokes_lie_along_the_forces(self, shown, found):
        orange = pytest.approx(to_rgb(style.THRUST["color"]))
        lines = [each for each in draw_structure(shown, "wall").axes[0].collections if isinstance(each, LineCollection)]
        (strokes,) = (each for each in lines if each.get_color()[0][:3] == orange)
        thrust = found[Direction.POSITIVE].thrust
        greatest = max(abs(force) for _, _, force in thrust)
        drawn = [(at, force) for _, at, force in thrust if abs(force) > MIN_FORCE_SHARE * greatest]
        widest = max(strokes.get_linewidths())
        ends = zip(strokes.get_segments(), strokes.get_linewidths(), drawn, strict=True)
        for (start, end), width, (at, force) in ends:
            assert complex(*(start + end)) / 2 == pytest.approx(at)
            along = complex(*(end - start)) / force
            assert abs(along.imag) < 1e-9 * along.real
            assert width == pytest.approx(widest * np.sqrt(abs(force) / greatest))


SLIDES = {
    "blocks": {
        "low": {"polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]},
        "high": {"polygon": [[0.1, 1.0], [0.8, 1.0], [0.8, 2.5], [0.1, 2.5]]},
    },
    "ground": {"floor": {"polygon": [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]]}},
    "friction": 0.5,
    "friction_of": {"floor and low": 0.05},
    "density": 2000.0,
    "depth": 1.0,
    "restitution": 0.8,
}  # fmt: skip


class TestWhatHasNoModel:
    def test_it_is_shown_as_it_starts(self):
        structure = Assembly(**SLIDES)
        found = collapses(structure)
        shown = picture(structure, found)
        for direction in Direction:
            each = found[direction]
            assert not each.lead and each.slides == ["floor and low"]
            assert each.lambda_ == pytest.approx(0.05)
            outlines, _ = shown.placed(direction * 1.0)
            moved = [part[0] - rest.outlines[0] for part, rest in zip(outlines, shown.parts, strict=True)]
            # The flow is associated: it rises by the friction times how far it slides, all corners alike.
            way = (direction + 0.05j) / abs(1 + 0.05j)
            size = abs(1.0 + 2.5j)
            for each_moved in moved:
                assert each_moved == pytest.approx(np.full(4, 0.999 * START_SHARE * size * way), abs=1e-9)
        assert shown.usual == dict.fromkeys(Direction, 1.0)
        titles = [axes.get_title() for axes in draw_structure(shown, "two blocks").axes]
        assert titles.count("positive\nas it starts") == 1

    def test_a_single_block_moves_as_far_as_can_be_seen(self):
        one = {**SLIDES, "blocks": {"low": SLIDES["blocks"]["low"]}}
        structure = Assembly(**one)
        shown = picture(structure, collapses(structure))
        outlines, _ = shown.placed(1.0)
        moved = outlines[0][0] - shown.parts[0].outlines[0]
        assert abs(moved) == pytest.approx(np.full(4, 0.999 * START_SHARE * abs(1 + 1j)))

    def test_ties_are_drawn_as_they_are_at_rest(self):
        """Whether one is slack depends on a motion that there is none of."""
        to = {"body": "high", "at": [0.8, 2.0]}
        tie = {"name": "bar", "from": {"ground": [2.0, 2.0]}, "to": to, "stiffness": 1e5, "only": "tension"}
        structure = Assembly(**SLIDES, ties=[tie])
        found = collapses(structure)
        assert not any(each.lead for each in found.values())
        shown = picture(structure, found)
        assert len(shown.ties) == 1 and shown.hung(1.0, 0.1)[2] == [False]

    def test_loads_and_a_restitution_do_not_hide_it(self, tmp_path):
        """Both need the motion: it is refused where it is asked for, but not the mechanism."""
        file = tmp_path / "slides.yaml"
        loads = [{"name": "floor", "mass": "2 t", "at": [0.45, 2.5], "body": "high"}]
        file.write_text(yaml.safe_dump({"mechanism": "assembly", **SLIDES, "loads": loads}), encoding="utf-8")
        plot = tmp_path / "slides.svg"
        assert "slides between floor and low" in run("collapse", file, "--plot", plot).stdout and plot.exists()
        assert "no rocking model exists for sliding" in run("equiv", file, code=2).stderr

    def test_it_begins_with_lambda_in_each_direction(self):
        """A block that leans by .4 m to the right: its centroid is .3 m and .7 m from its corners, 2 m high."""
        ground = {"floor": {"polygon": [[-3, -1], [6, -1], [6, 0], [-3, 0]]}}
        leaning = Assembly(blocks={"block": {"polygon": [[0, 0], [1, 0], [1.4, 4], [0.4, 4]]}}, ground=ground)
        first, *_ = view(leaning, collapses(leaning)).parts
        assert "lambda = 0.15 g in the positive direction; lambda = 0.35 g in the negative direction." in first

    def test_a_sentence_takes_the_place_of_a_table_of_no_hinges(self):
        structure = Assembly(**SLIDES)
        text = words(view(structure, collapses(structure)))
        assert "lambda = 0.05 g in" in text and "direction, without hinges." in text and "hinge   between" not in text
