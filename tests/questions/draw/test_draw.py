"""The picture of a structure: where its parts and hinges are, what is measured on it, and that it is drawn."""

import io
import json
from contextlib import nullcontext
from dataclasses import replace
from functools import cache, partial
from itertools import combinations
from math import atan2, degrees, hypot, pi

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from mechanisms._arch_collapse import Ring, thrust
from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.cone import Cone
from mechanisms.symmetric_frame import SymmetricFrame
from mechanisms.wall import Wall
from rocking_cli.core import Angle, Body, Direction, Hinge, Length, Mechanism, Sketch, box, rotation, three_digits
from rocking_cli.core.structure_file import load_structure
from rocking_cli.plotting import dimensions, style
from rocking_cli.plotting.labels import LabelPlace, Labels, mathematics
from rocking_cli.plotting.panels import Page, Panel
from rocking_cli.plotting.structure import draw_parts, draw_structure
from rocking_cli.studies.picture import ASSUMED_NOTE, NODES_PER_SIDE, _faces, picture
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

loaded = cache(load_structure)
shown_of = cache(lambda path: picture(loaded(path)))
FRAME = loaded(EXAMPLES / "frame.yaml")
ARCH = loaded(EXAMPLES / "arch.yaml")
FILES = sorted(EXAMPLES.glob("*.yaml"))
OF_STONE = {"density": 2400.0, "depth": 1.0}
EXTREMES = {
    "slender block": partial(Block, width=0.1, height=10.0),
    "flat block": partial(Block, width=10.0, height=0.3),
    "flat cone": partial(Cone, base_radius=5.0, height=2.0),
    "slender portico": partial(SymmetricFrame, column_width=0.1, column_height=10.0, mass_ratio=2.0),
    "flat portico": partial(SymmetricFrame, column_width=5.0, column_height=0.5, mass_ratio=2.0, columns=9),
    "slender frame": partial(
        AsymmetricFrame, column_width=0.1, left_height=10.0, right_height=7.0, spacing=1.0, beam_depth=0.2, **OF_STONE
    ),
    "flat frame": partial(
        AsymmetricFrame, column_width=0.5, left_height=1.0, right_height=1.2, spacing=12.0, beam_depth=0.1, **OF_STONE
    ),
    "small angle": partial(Arch, radius=10.0, thickness=0.3, inclusion_angle_deg=100.0),
    "thin arch": partial(Arch, radius=10.0, thickness=1.1, inclusion_angle_deg=180.0),
    "thick arch": partial(Arch, radius=3.0, thickness=1.2, inclusion_angle_deg=180.0),
}
SHAPES = {path.stem: partial(loaded, path) for path in FILES} | EXTREMES


shape_of = cache(lambda name: picture(SHAPES[name]()))


class Bare(Mechanism):
    """A wall of two blocks that says nothing of its picture: a plugin as they have always been."""

    mechanism, title, source = "bare", "bare", "a test"

    def bodies(self):
        return [box("lower", 1.0, 0.4, 2.0, 1j), box("upper", 1.0, 0.4, 2.0, 3j)]

    def motion(self, phi, direction):
        return Wall(thickness=0.4, height=4.0).motion(phi, direction)

    def limit(self, direction):
        return pi / 2


class TestPicture:
    def test_a_block_is_where_its_pivot_takes_it(self):
        """By hand: a quarter turn about the right foot of a block of 1 m x 4 m lays it to the right of it."""
        (outline,), pins = picture(Block(width=1.0, height=4.0)).placed(0.999 * pi / 2)
        np.testing.assert_allclose(outline[0], [0.5 + 1j, 0.5, 4.5, 4.5 + 1j], atol=0.01)
        assert pins[0] == pytest.approx(0.5)
        (outline,), pins = picture(Block(width=1.0, height=4.0)).placed(-0.999 * pi / 2)
        np.testing.assert_allclose(outline[0], [-0.5, -0.5 + 1j, -4.5 + 1j, -4.5], atol=0.01)
        assert pins[1] == pytest.approx(-0.5)

    def test_it_stops_at_the_end_of_the_mechanism(self):
        shown = picture(Block(width=1.0, height=4.0))
        np.testing.assert_array_equal(shown.at(np.array([10.0]))[0], shown.at(np.array([0.999 * pi / 2]))[0])

    @pytest.mark.every(4)
    @pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
    def test_the_table_of_a_page_has_every_position_between_its_nodes(self, path):
        """Straight between nodes, as a page does it, against the mechanism itself."""
        shown = shown_of(path)
        data = json.loads(json.dumps(shown.as_dict(), allow_nan=False))
        table = np.array(data["rotation"])
        ways = [0.9 * side for side in shown.directions]
        assert table.size == len(ways) * NODES_PER_SIDE + 1 and 0 in table and (np.diff(table) > 0).all()
        turns = np.linspace(min(0.0, *ways), max(0.0, *ways), 77) * min(shown.limit.values())
        size = abs(shown.extent[1] - shown.extent[0])
        centroids, psi = shown.at(turns)
        for part, z, angle in zip(data["parts"], centroids, psi, strict=True):
            x, y, turned = (np.interp(turns, table, part[key]) for key in ("x", "y", "psi"))
            assert np.abs(x + 1j * y - z).max() < 1e-3 * size
            assert np.abs(turned - angle).max() < 2e-3
        rest = data["rotation"].index(0.0)
        for pin, placed in zip(data["pins"], shown.placed(0.0)[1], strict=True):
            part = data["parts"][pin["part"]]
            at = part["x"][rest] + pin["point"][0], part["y"][rest] + pin["point"][1]
            assert complex(*at) == pytest.approx(placed, abs=1e-5)
        letters = {way: [pin.letter for pin in shown.pins if pin.direction is way] for way in Direction}
        if len(shown.directions) == 1:
            assert {pin.direction for pin in shown.pins} == set(shown.directions)
        else:
            assert letters[Direction.NEGATIVE] == [f"{each}'" if each else "" for each in letters[Direction.POSITIVE]]

    def test_copies_move_like_the_first_about_feet_of_their_own(self):
        shown = picture(SymmetricFrame(column_width=1.0, column_height=6.0, columns=3, mass_ratio=1.0))
        columns, beam = shown.parts[:3], shown.parts[3]
        centroids, psi = shown.at(np.array([0.1]))
        shifts = [part.shift for part in columns]
        assert len(set(shifts)) == 3
        np.testing.assert_allclose(centroids[:3, 0] - shifts, centroids[0, 0])
        assert psi[:, 0].tolist() == [-0.1, -0.1, -0.1, 0.0]
        feet = [pin.point for pin in shown.pins if pin.direction > 0 and pin.point.imag == 0]
        assert feet == [0.5 + shift for shift in shifts]
        assert [pin.letter for pin in shown.pins if pin.direction > 0] == ["A", "", "", "B", "", ""]
        # The beam lies on the lifted corners of all columns.
        _, pins = shown.placed(0.1)
        soffit = centroids[3, 0].imag - (beam.centroid.imag - 6.0)
        heights = [z.imag for pin, z in zip(shown.pins, pins, strict=True) if pin.direction > 0]
        assert heights[3:] == pytest.approx([soffit] * 3)

    def test_more_columns_than_can_be_drawn_are_said(self):
        many = picture(SymmetricFrame(column_width=1.0, column_height=6.0, columns=50, mass_ratio=1.0))
        assert len(many.parts) == 7
        assert "6 of 50 columns" in many.sketch.notes[0]

    def test_of_a_silent_plugin_pivots_hinges_and_shapes_are_found(self):
        shown = picture(Bare())
        for direction in Direction:
            found = [pin.point for pin in shown.pins if pin.direction is direction]
            np.testing.assert_allclose(found, [0.2 * direction, -0.2 * direction + 2j], atol=1e-9)
        # A box has said what shape it has.
        assert not any(part.assumed for part in shown.parts) and not shown.sketch.notes
        np.testing.assert_allclose(shown.parts[0].outlines[0], [-0.2, 0.2, 0.2 + 2j, -0.2 + 2j], atol=1e-12)
        (ground,) = shown.ground
        assert ground.imag.tolist() == [0.0, 0.0] and ground[0].real < -0.5 < 0.5 < ground[1].real

    def test_of_a_body_without_a_shape_a_disc_is_drawn_and_said(self):
        class Numbers(Bare):
            def bodies(self):
                return [replace(each, outline=()) for each in super().bodies()]

        shown = picture(Numbers())
        assert all(part.assumed for part in shown.parts)
        # A disc of mass m and radius a has the inertia m a^2/2.
        radius = np.abs(shown.parts[0].outlines[0] - 1j)
        np.testing.assert_allclose(radius, np.sqrt(2 * (0.4**2 + 2.0**2) / 12))
        assert list(shown.sketch.notes) == [ASSUMED_NOTE] and shown.as_dict()["notes"] == [ASSUMED_NOTE]

    def test_the_instantaneous_centre_of_a_beam_is_no_hinge(self):
        """Of a frame whose hinges are not given: A, B, C and D are found, and no centre that wanders."""

        class Silent(AsymmetricFrame):
            def sketch(self):
                return Sketch()

        silent = Silent(**{key: getattr(FRAME, key) for key in FRAME.model_fields_set})
        for direction in Direction:
            found = sorted((pin.point for pin in picture(silent).pins if pin.direction is direction), key=abs)
            np.testing.assert_allclose(found, sorted(silent.hinges(direction), key=abs), atol=1e-9)

    def test_every_body_that_turns_about_a_pivot_is_joined_to_it(self):
        class Capped(Bare):
            def motion(self, phi, direction):
                return [rotation(phi, complex(0.2 * direction), -direction)] * 2

        shown = picture(Capped())
        found = [(pin.part, round(pin.point.real, 9)) for pin in shown.pins]
        assert found == [(0, 0.2), (1, 0.2), (0, -0.2), (1, -0.2)]


class TestWhatIsMeasured:
    """The numbers on a picture come from its points: they are the fields of the file, or the paper's formulas."""

    def values(self, structure, direction=None):
        sketch = structure.sketch()
        measured = [*sketch.lengths, *sketch.angles]
        return {each.symbol: each.value for each in measured if each.direction in (None, direction)}

    @pytest.mark.parametrize(
        ("structure", "expected"),
        [
            (Block(width=0.7, height=2.8), {"2b": 0.7, "2h": 2.8, "R": hypot(0.35, 1.4), "α": atan2(0.35, 1.4)}),
            (Wall(thickness=0.3, height=3.0), {"2b": 0.3, "4h": 3.0, "R": hypot(0.15, 0.75), "α": np.arctan(0.2)}),
        ],
    )
    def test_of_a_block_and_of_a_wall(self, structure, expected):
        assert self.values(structure, Direction.POSITIVE) == pytest.approx(expected)

    def test_of_a_leaning_stone_in_both_directions(self):
        stone = loaded(EXAMPLES / "rigid_body.yaml")
        for direction, sign in ((Direction.POSITIVE, "₊"), (Direction.NEGATIVE, "₋")):
            values = self.values(stone, direction)
            assert values[f"α{sign}"] == pytest.approx(stone.alpha(direction))
            assert values[f"R{sign}"] == pytest.approx(abs(stone.arm(direction)))

    @pytest.mark.parametrize("direction", list(Direction))
    def test_of_a_frame(self, direction):
        s, b, H, H1, L, h = int(direction), 0.8, 3.5, 5.0, 10.0, 0.75
        assert self.values(FRAME, direction) == pytest.approx(
            {
                "2b": 2 * b, "2H": 2 * H, "2H₁": 2 * H1, "L": L, "2h": 2 * h,
                "R₀": hypot(b, H), "R₁": hypot(b, H1), "r_BC": hypot(L / 2 + s * b, h),
                "φ₀": pi / 2 + s * np.arctan(b / H), "ψ_BC": np.arctan(h / (L / 2 + s * b)),
            }
        )  # fmt: skip

    def test_of_an_arch(self):
        assert self.values(ARCH) == pytest.approx({"r": 10.0, "t": 1.5, "β": np.radians(157.5)})
        values = self.values(ARCH, Direction.POSITIVE)
        A, B, C, D = ARCH.hinges(Direction.POSITIVE)
        assert values["φ₀"] == pytest.approx(np.angle(B - A))
        inner, outer = 9.25, 10.75
        for link, one, other, k in (("AB", A, B, 0), ("BC", B, C, 1), ("CD", D, C, 2)):
            # Independent: the link in small pieces.
            turns = np.linspace(*ARCH.hinge_angles[k : k + 2], 20_001)
            middles = (pi + np.radians(157.5)) / 2 - (turns[1:] + turns[:-1]) / 2
            centroid = np.exp(1j * middles).mean() * 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2)
            assert values[f"r_{link}"] == pytest.approx(abs(centroid - one))
            assert values[f"ψ_{link}"] == pytest.approx(abs(np.angle((centroid - one) / (other - one))))

    @pytest.mark.parametrize(("value", "text"), [(1.44309, "1.44"), (157.5, "157.5"), (2500, "2500"), (1e-5, "1e-05")])
    def test_three_digits_are_enough_to_check_by(self, value, text):
        assert three_digits(value) == text

    def test_the_hinges_have_the_papers_letters(self):
        for structure in (FRAME, ARCH):
            for direction in Direction:
                lettered = {hinge.letter: hinge.point for hinge in structure.sketch().hinges[direction]}
                letters = ["A", "B", "C", "D"] if direction > 0 else ["A'", "B'", "C'", "D'"]
                assert lettered == dict(zip(letters, structure.hinges(direction), strict=True))


def test_only_hinges_of_one_link_are_joined_by_a_line():
    def chains(file):
        shown = shown_of(EXAMPLES / file)
        return shown.chains([pin for pin in shown.pins if pin.direction is Direction.POSITIVE])

    assert chains("frame.yaml") == chains("arch.yaml") == [[0, 1, 2, 3]]
    # Three columns, foot and head each, and the beam from head to head; what a hinge is called says nothing.
    assert chains("linkages/portico.yaml") == [[0, 1], [2, 3], [4, 5], [1, 3], [3, 5]]
    assert chains("masonry/portal.yaml") == [[0, 1], [2, 3], [0, 2]]


class TestLineOfThrust:
    def test_it_balances_every_part_of_the_ring(self):
        """Independent: the ring cut into slices, their weights and inertia summed, and the moment about the line."""
        ring = Ring(0.15, np.radians(157.5))
        hinges = Arch(radius=1.0, thickness=0.15, inclusion_angle_deg=157.5, voussoirs=7).hinge_angles
        M0, Fx, Fy, lam = thrust(ring, hinges)
        slices = 20_000
        for share in (0.13, 0.41, 0.77, 1.0):
            angle = share * ring.beta
            middles = (np.arange(slices) + 0.5) / slices * angle
            turn = np.exp(1j * ((pi + ring.beta) / 2 - middles))
            inner, outer = 1 - 0.075, 1 + 0.075
            weight = (outer**2 - inner**2) / 2 * angle / slices
            at = turn * 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2)
            point = ring.thrust_radius(np.array(angle), np.array([M0, Fx, Fy, lam]))
            point = point * np.exp(1j * ((pi + ring.beta) / 2 - angle))
            # About the point: the reaction, whose moment about the centre is M0, the weights, the inertia to the right.
            moment = M0 + (-point.real * Fy + point.imag * Fx)
            moment += (-(at - point).real * weight - (at - point).imag * lam * weight).sum()
            assert abs(moment) < 1e-7

    @pytest.mark.parametrize("voussoirs", [None, 7])
    def test_it_passes_through_the_hinges_and_stays_inside(self, voussoirs):
        arch = Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=voussoirs)
        for line in arch.sketch().lines:
            z = np.array(line.points)
            assert (np.abs(np.abs(z) - 10.0) <= 0.75 + 1e-6).all()
            for hinge in arch.hinges(line.direction):
                assert np.abs(z - hinge).min() < 1e-6
            assert f"{arch.uplift(line.direction):.3g} g" in line.name


class TestFigure:
    @pytest.mark.every(3)
    @pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
    def test_every_example_has_a_panel_for_rest_and_each_direction_to_scale(self, path):
        structure = loaded(path)
        figure = draw_structure(shown_of(path), "a title with $ in it", 0.5)
        assert len(figure.axes) == 1 + len(structure.directions)
        size = figure.get_size_inches()
        for axes in figure.axes:
            x, y = (np.diff(limits)[0] for limits in (axes.get_xlim(), axes.get_ylim()))
            place = axes.get_position()
            assert x / (place.width * size[0]) == pytest.approx(y / (place.height * size[1]))
            assert 0 <= place.x0 < place.x1 <= 1 + 1e-9 and 0 <= place.y0 < place.y1 <= 1
        words = " ".join(text.get_text() for axes in figure.axes for text in axes.texts)
        for each in [*structure.sketch().lengths, *structure.sketch().angles]:
            if each.direction is not Direction.NEGATIVE:
                assert (mathematics(each) in words) is not getattr(each, "derived", False)
        assert [line.get_marker() for axes in figure.axes for line in axes.lines].count("|") == 1  # scale bars

    def test_the_displaced_panels_show_the_block_at_its_rotation(self):
        block = Block(width=0.7, height=2.8)
        figure = draw_structure(picture(block), "block", 0.5)
        by_title = {axes.get_title().split(" ")[0]: axes for axes in figure.axes}
        for direction in Direction:
            axes = by_title[direction.label]
            phi = 0.5 * block.critical_rotation(direction)
            assert f"{phi:.3g} rad = {three_digits(degrees(phi))}°" in axes.get_title()
            moved = [each for each in axes.patches if to_hex(each.get_edgecolor()) == style.INK]
            corners = moved[0].get_xy()[:4] @ [1, 1j]
            foot = complex(direction * 0.35)
            at_rest = np.array([-0.35, 0.35, 0.35 + 2.8j, -0.35 + 2.8j])
            expected = foot + np.exp(-1j * direction * phi) * (at_rest - foot)
            np.testing.assert_allclose(corners, expected, atol=1e-12)

    def test_lengths_side_by_side_share_a_row_and_others_do_not(self):
        low, high = 0j, 10 + 10j
        first, second, across = Length("a", 0j, 4j), Length("b", 4j, 10j), Length("c", 2j, 6j)
        rows, inside = dimensions.in_rows([first, second, across, Length("d", 3 + 3j, 5 + 4j)], low, high)
        assert rows["left"] == [[first, second], [across]]
        assert [each.symbol for each in inside] == ["d"]

    @pytest.mark.every(7)
    @pytest.mark.parametrize(
        ("structure", "screen"),
        [*((name, style.on_phone) for name in SHAPES), *((name, nullcontext) for name in ("arch", "frame", *EXTREMES))],
    )
    def test_words_neither_meet_nor_leave_the_picture(self, structure, screen):
        title = "a structure with a title that is longer than the screen of a phone"
        with screen():
            figure = draw_structure(shape_of(structure), title)
        assert title in [text.get_text().replace("\n", " ") for text in figure.texts]
        if figure.get_figwidth() < style.PAGE_WIDTH:
            rest, *others = sorted((axes.get_position() for axes in figure.axes), key=lambda place: -place.y0)
            assert rest.y0 > max(place.y1 for place in others)
        canvas = FigureCanvasAgg(figure)
        figure.draw_without_rendering()
        inside = figure.bbox
        words = [text for axes in figure.axes for text in [*axes.texts, axes.title] if text.get_text()]
        areas = []
        for text in [*words, *(text for text in figure.texts if text.get_text())]:
            box_of = text.get_window_extent(canvas.get_renderer())
            assert inside.x0 <= box_of.x0 and box_of.x1 <= inside.x1, text.get_text()
            assert inside.y0 <= box_of.y0 and box_of.y1 <= inside.y1, text.get_text()
            if text.get_rotation() % 90 == 0:  # of what is turned obliquely the box is too large
                areas.append((text.get_text(), box_of))
        for (one, area), (other, beside) in combinations(areas, 2):
            across = min(area.x1, beside.x1) - max(area.x0, beside.x0)
            up = min(area.y1, beside.y1) - max(area.y0, beside.y0)
            assert min(across, up) < 3, f"{one} lies on {other}"  # pixels: an extent has room around its letters

    def test_words_lie_beside_the_line_they_name(self):
        """A label of a length alone in a panel: none of the points of the line is under it."""
        figure = Figure(figsize=(4, 4))
        panel = Panel(0j, 1 + 1j, (0.5, 0.5, 0.5, 0.5), scale=3.0)
        axes = panel.axes(Page(figure, 4 + 4j))
        labels = Labels(axes, panel)
        dimensions.draw_inside(axes, [Length("R", 0.1 + 0.2j, 0.5 + 0.9j)], [], panel, labels)
        (text,) = (each for each in axes.texts if each.get_text())
        assert text.get_text() == "$R$ = 0.806 m"
        along = np.linspace(0.1 + 0.2j, 0.5 + 0.9j, 200)
        place = (along - complex(*text.xy)) / np.exp(1j * np.radians(text.get_rotation())) * panel.scale
        size = style.size_of(text.get_text(), style.LABEL)
        assert not ((np.abs(place.real) < size.real / 2) & (np.abs(place.imag) < size.imag / 2)).any()
        assert np.abs(place.imag).min() < size.imag  # and near it

    @pytest.mark.rest
    @pytest.mark.parametrize("word", ["$", "$a", "a$b$", "\udcff", "\u5b57", "\\frac{1", "R_", "_", ""])
    def test_any_word_of_a_plugin_can_be_drawn(self, word):
        class Odd(Block):
            def sketch(self):
                return Sketch(
                    lengths=[Length(word, 0j, 1j), Length(word, 0.1 + 0j, 0.2 + 3j, Direction.NEGATIVE)],
                    angles=[Angle(word, 0j, 1j, 1 + 1j, Direction.POSITIVE)],
                    hinges={direction: [Hinge(word, direction * 0.5 + 0j, ("block",))] for direction in Direction},
                )

        style.save(draw_structure(picture(Odd(width=1.0, height=4.0)), word), io.BytesIO(), format="png", dpi=20)

    def test_symbols_have_their_subscripts(self):
        for symbol, shown in (
            ("R₁", "$R_{1}$"), ("2H₁", "$2H_{1}$"), ("r_BC", r"$r_{\mathrm{BC}}$"), ("α₋", "$α_{-}$"), ("2b", "$2b$"),
            ("height", "height"), ("a $", r"a \$"),
        ):  # fmt: skip
            assert mathematics(Length(symbol, 0j, 2 + 0j)) == f"{shown} = 2 m"

    @pytest.mark.parametrize("direction", list(Direction))
    def test_a_link_of_an_arch_has_one_colour(self, direction):
        """The segments between two hinges: AB, BC and CD each in its own, and what stays at rest in another."""
        shown = shape_of("thin arch")
        arch = shown.mechanism
        cuts = np.array(arch._cuts)
        middles = (cuts[1:] + cuts[:-1]) / 2
        along = middles if direction > 0 else pi - middles
        expected = [k - 1 if 0 < k < 4 else None for k in np.searchsorted(arch.hinge_angles, along)]
        assert list(shown.links[direction].values()) == expected
        assert None in expected and {0, 1, 2} < set(expected)
        axes = Figure().subplots()
        draw_parts(axes, shown, 0.01 * direction, style.MEDIUM)
        for link, patch in zip(expected, axes.patches, strict=True):
            moving = (style.INK, style.MEDIUM) if link is not None else (style.EARTH, style.THIN)
            assert (to_hex(patch.get_edgecolor()), patch.get_linewidth()) == moving
            assert (to_hex(patch.get_facecolor()) == style.RESTING_COLOUR) is (link is None)
        assert {to_hex(patch.get_facecolor()) for patch in axes.patches} == {*style.BODIES, style.RESTING_COLOUR}

    def test_the_line_of_thrust_is_drawn_in_both_directions(self):
        figure = draw_structure(shown_of(EXAMPLES / "arch.yaml"), "arch")
        (rest,) = (axes for axes in figure.axes if axes.get_title() == "at rest")
        for line, look in zip(ARCH.sketch().lines, (style.THRUST, style.OTHER_THRUST), strict=True):
            (drawn,) = (each for each in rest.lines if each.get_color() == look["color"])
            np.testing.assert_array_equal(drawn.get_xydata() @ [1, 1j], line.points)
            assert f"{line.name} ({line.direction.label} direction)" in figure.texts[1].get_text().replace("\n", " ")

    def test_labels_cost_what_they_cover(self):
        """Against each point and each place one by one."""
        panel = Panel(0j, 1 + 1j, (0.5, 0.5, 0.5, 0.5), scale=3.0)
        labels, size = Labels(panel.axes(Page(Figure(figsize=(4, 4)), 4 + 4j)), panel), 0.6 + 0.2j
        z = np.random.default_rng(1).uniform(0, 1, (300, 2)) @ [1, 1j]
        for k, each in enumerate(z):
            labels.keep_off([each], 1.0 + k % 3)
        places = [LabelPlace(3 * at, turned, 0.5) for at in z[:40] for turned in (0.0, 30.0)]
        for place, cost in zip(places, labels._cost(places, size), strict=True):
            local = (3 * z - place.middle) * np.exp(-1j * np.radians(place.turned))
            hit = (np.abs(local.real) < 0.32) & (np.abs(local.imag) < 0.12)
            around = np.array([0.3 + 0.1j, 0.3 - 0.1j, -0.3 + 0.1j, -0.3 - 0.1j])
            corners = place.middle + around * np.exp(1j * np.radians(place.turned))
            over = sum(max(0.0, -0.5 - low, high - 3.5) for low, high in (
                (corners.real.min(), corners.real.max()), (corners.imag.min(), corners.imag.max())
            ))  # fmt: skip
            assert cost == pytest.approx((1.0 + np.arange(300) % 3)[hit].sum() + 0.5 + 1000 * over)

    def test_a_block_of_the_ground_shows_what_bears(self):
        """Its face upwards, and the side at which a body rests; not its other sides."""
        corners = [0j, 4 + 0j, 4 - 2j, -2j, 0j]
        beside = np.array([4 - 1j, 5 - 1j, 5 - 3j, 4 - 3j])
        assert [line.tolist() for line in _faces(np.array(corners), [beside + 1])] == [[0j, 4 + 0j]]
        assert [line.tolist() for line in _faces(np.array(corners), [beside])] == [[0j, 4 + 0j, 4 - 2j]]
        assert all((np.diff(line).real > 0).all() for line in picture(loaded(EXAMPLES / "masonry/portal.yaml")).ground)

    def test_a_point_without_inertia_or_mass_can_be_drawn(self):
        class Point(Mechanism):
            mechanism, title, source = "point", "point", "a test"

            def bodies(self):
                return [Body("point", 1.0, 0.0, 2j), Body("nothing", 0.0, 0.0, 3j)]

            def motion(self, phi, direction):
                return [rotation(phi, complex(0.5 * direction), -direction)] * 2

            def limit(self, direction):
                return pi / 2

        draw_structure(picture(Point()), "point")


class TestCommand:
    def test_it_writes_a_picture_named_after_the_file(self, tmp_path):
        result = run("draw", EXAMPLES / "frame.yaml")
        assert (tmp_path / "frame.png").read_bytes().startswith(b"\x89PNG")
        assert "2H₁ = 10 m" in result.stdout and "wrote frame.png" in result.stderr

    def test_json_is_the_picture(self, tmp_path):
        data = run_json("draw", EXAMPLES / "frame.yaml")
        assert data == {**picture(FRAME).as_dict(), "given": {}} and len(data["parts"]) == 3
        assert list(tmp_path.iterdir()) == []

    def test_a_rotation_beyond_the_end_is_refused(self):
        assert "at most 6." in run("draw", "--at", "7", code=2).stderr
        assert "more than 0" in run("draw", "--at", "-0.5", code=2).stderr


@pytest.mark.parametrize(
    "given", [{"lines": [(0j, 1j)]}, {"lengths": [("b", 0j, 1j)]}, {"angles": [1]}, {"notes": "abc"}]
)
def test_a_sketch_that_no_picture_can_be_made_of_is_refused_where_it_is_made(given):
    (name,) = given
    with pytest.raises(TypeError, match=f"{name} of a sketch must be a sequence of"):
        Sketch(**given)
