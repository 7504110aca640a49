"""Common style of plots: legible in print, in grey, and to colour-blind readers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache, lru_cache
from pathlib import Path
from textwrap import shorten
from typing import IO, TYPE_CHECKING, Any, NamedTuple, cast
from warnings import catch_warnings, filterwarnings

import numpy as np
from matplotlib import rc_context, rcParams
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure, SubFigure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import ConstrainedLayoutEngine, TightLayoutEngine
from matplotlib.legend import Legend
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation, Text
from matplotlib.ticker import Formatter, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, PercentFormatter
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import write_whole
from rocking_cli.text import printable

if TYPE_CHECKING:
    from rocking_cli.views.sheet.language import Language

PAGE_WIDTH, PHONE_WIDTH = 7.2, 3.3  # inches of text on paper, and on a phone, where it is enlarged to the screen
DPI = 150
DATES = {"svg": ["Date"], "pdf": ["CreationDate"]}  # in files of a format
POINTS_PER_INCH = 72
MAX_SIDE_MARGIN = 0.9  # inches at the sides of a panel
MAX_HEADING_LENGTH, MAX_HEADING_LINES = 240, 3  # characters and lines
LINE_SPACING = 1.3  # height of a line of text over its size of type
LEAST_LEFT = 0.3  # share of the height of a panel that a legend below it is taken to leave
INK, FAINT, SHADE, GRID, PAPER = "#222222", "#9a9a9a", "#eeeeee", "#dddddd", "#ffffff"
# Colours of curves: colour-blind readers can tell each two of them apart, on a dark page too.
BLACK, ORANGE, BLUE = "#111111", "#cc7a00", "#1b6ca8"
VIOLET, BROWN, STONE = "#a21ce6", "#6b3a0a", "#93886a"
# Words need more contrast than curves: the tones of the names of these.
WORDS = {ORANGE: "#9c5c00", STONE: "#6c634b"}
TITLE, LABEL, TICK, SMALL, TINY = 10, 9, 8, 7, 5  # sizes of type [pt]
HAIR, THIN, CURVE, MEDIUM, BOLD, HALO_WEIGHT = 0.4, 0.6, 0.7, 1.0, 1.6, 2.5  # weights of line [pt]
LEGEND: dict[str, Any] = {"fontsize": TICK, "frameon": True, "framealpha": 0.9, "edgecolor": "none"}
# Structures: bodies differ in darkness too; marks are black, dimensions blue, thrust lines dashed.
BODIES = ("#cbd8e4", "#eed7a6", "#a6b8ca")
RESTING_COLOUR = "#f4f3f0"  # colour of parts at rest while the links of a structure move
EARTH, MEASURE = "#8a7f70", "#2b5d86"
CURSOR = "#c4371a"
TRACE: dict[str, Any] = {"color": INK, "linestyle": "-", "linewidth": 0.9}
THRUST: dict[str, Any] = {"color": "#b3541e", "linestyle": (0, (3, 1)), "linewidth": 1.8}
OTHER_THRUST: dict[str, Any] = {"color": VIOLET, "linestyle": (0, (1, 1)), "linewidth": 1.6}  # in the other direction
TIE: dict[str, Any] = {"color": "#1d6b4f", "linewidth": 1.3}
SLACK = (0, (2.5, 2))
# Curves differ in darkness, dash and weight as well as in hue; the heaviest is visible behind the others.
LINES = {
    "nonlinear": {"color": BLACK, "linestyle": "-", "linewidth": 1.9},
    "linear1": {"color": ORANGE, "linestyle": "--", "linewidth": 1.3},
    "linear2": {"color": BLUE, "linestyle": "-.", "linewidth": 0.9},
    "blocks": {"color": BLUE, "linestyle": "-", "linewidth": 1.3},
}
RECORD_COLOUR = "#8a8a8a"  # pale, as bold curves are drawn over it
PULSES: tuple[dict[str, Any], ...] = (
    {"color": BLACK, "linestyle": "-", "linewidth": 2.4},
    {"color": ORANGE, "linestyle": "--", "linewidth": 2.0},
    {"color": BLUE, "linestyle": "-.", "linewidth": 1.6},
)
LABELS = {
    "nonlinear": "nonlinear",
    "linear1": r"linear, $\kappa_1$",
    "linear2": r"linear, $\kappa_2$",
    "blocks": "free blocks",
}

# Regions of a plane of pulses, and the boundaries between them.
# From white to dark, so that the order is visible in grey; blue to orange to brown for the colour-blind.
REGIONS = {
    names.NO_UPLIFT: PAPER,
    names.ROCKS: "#c6dcec",
    f"{names.OVERTURNS} after one impact": "#f2b04a",
    f"{names.OVERTURNS} after two or more": "#c46a1b",
    f"{names.OVERTURNS} without impact": "#5b3a55",
    names.UNKNOWN: "#c9c9c9",  # grey, and hatched too
}
BOUNDARIES: dict[str, dict[str, Any]] = {
    "uplift": {"color": INK, "linestyle": "-", "linewidth": 1.0},
    "without_impact": {"color": BLACK, "linestyle": "-", "linewidth": 2.0},
    "after_one_impact": {"color": BLACK, "linestyle": (0, (4, 1.5)), "linewidth": 1.6},
    "impact_at_end": {"color": BLACK, "linestyle": (0, (1, 1.5)), "linewidth": 1.3},
}

MARKED: dict[str, Any] = {
    "marker": "o", "markersize": 8, "color": PAPER, "markeredgecolor": BLACK, "markeredgewidth": 1.8
}  # fmt: skip

STAR: dict[str, Any] = {"marker": "*", "markersize": 15, "markeredgecolor": PAPER, "linestyle": "none", "zorder": 6}

HALO = [withStroke(linewidth=HALO_WEIGHT, foreground=PAPER)]
"""The path effects of words over lines."""

UNKNOWN: dict[str, Any] = {"facecolor": "none", "edgecolor": FAINT, "hatch": "////", "linewidth": 0.0}
"""The look of areas in which the outcome is not known: hatched in grey."""

SPARED, EXCEEDED = BLUE, "#b35900"  # runs below and above a limit; their marks differ, too
SATISFIED = REGIONS[names.ROCKS]  # areas in which a requirement or a band is met
MEAN, TARGET, MISSED, OVERTURNED = BLACK, "#c46a1b", VIOLET, "#c46a1b"
RANKS = ("#4a1306", "#b3450f", "#e99a3c", "#f8dfa4")  # from the first of a ranking to the last

# For any number of curves: dashes and marks distinguish them in grey, and where they overlap.
_DASHES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (3, 1)))
HUES = (BLACK, ORANGE, BLUE, VIOLET, BROWN, STONE)
_MARKS = ("o", "s", "^", "D", "v", "P")

DARK = {
    PAPER: "#16181b", INK: "#e8e6e1", FAINT: "#84888e", SHADE: "#26292e", GRID: "#3a3d42", "#000000": "#f4f2ee",
    BLACK: "#f4f2ee", ORANGE: "#ffb454", BLUE: "#6db3f2", VIOLET: "#a06bff", BROWN: "#c56d28", STONE: "#b5a886",
    "#cbd8e4": "#435567", "#eed7a6": "#6a5730", "#a6b8ca": "#667c92", RESTING_COLOUR: "#2b2e32", EARTH: "#a99c88",
    MEASURE: "#7fb6e6", CURSOR: "#ff8a65", "#b3541e": "#ff9d5c", "#1d6b4f": "#4fbf94", RECORD_COLOUR: "#8b8e94",
    "#b35900": "#ff9a4d", "#c6dcec": "#20384b", "#f2b04a": "#9a6413", "#c46a1b": "#dc8a45", "#5b3a55": "#dcb6d4",
    "#c9c9c9": "#5c6066", "#9c5c00": "#ffb454", "#6c634b": "#b5a886",
}  # fmt: skip
"""The colour on a dark page that takes the place of each colour of a picture."""


def dark_rules(scope: str = "") -> str:
    """Return a style sheet that shows the SVG of pictures, those within `scope`, in the colours of a dark page."""
    rules = [f"{scope}text:not([style*='fill']) {{ fill: {DARK['#000000']} }}"]
    for light, dark in DARK.items():
        rules += [f"{scope}[style*='{what}: {light}'] {{ {what}: {dark} !important }}" for what in ("fill", "stroke")]
    return "\n".join(rules)


_width: ContextVar[float] = ContextVar("width", default=PAGE_WIDTH)


def page_width() -> float:
    """Return the width of a new figure [inches]."""
    return _width.get()


def is_narrow() -> bool:
    """Return whether new figures are for the screen of a phone: their panels are below one another, words shorter."""
    return page_width() < PAGE_WIDTH


@contextmanager
def on_phone() -> Iterator[None]:
    """Have pictures drawn for the screen of a phone: not smaller, but narrow."""
    token = _width.set(PHONE_WIDTH)
    try:
        yield
    finally:
        _width.reset(token)


def distinct(k: int) -> dict[str, Any]:
    """Return the style of curve number k of several; from the seventh on, a colour has another dash and mark."""
    again = k + k // len(HUES)
    return {
        "color": HUES[k % len(HUES)],
        "linestyle": _DASHES[again % len(_DASHES)],
        "marker": _MARKS[again % len(_MARKS)],
        "markersize": 4.5,
        "linewidth": 1.5,
    }


def family(k: int) -> dict[str, Any]:
    """Return the style of curve number k of a family of at most six, without marks, for small panels."""
    return {"color": HUES[k], "linestyle": _DASHES[k]}


def new_figure(height: float) -> Figure:
    """Return an empty figure of the common width; `height` in inches."""
    return Figure(figsize=(page_width(), height), dpi=DPI, layout="constrained")


Target = Axes | Figure | SubFigure


class _Given(NamedTuple):
    """What the user gave to draw in, and the legends that are below its panels."""

    target: Target
    below: list[Legend]


_given: ContextVar[_Given | None] = ContextVar("given", default=None)


@contextmanager
def drawing_in(target: Target) -> Iterator[None]:
    """Have a picture drawn in axes or in an empty figure of the user, not in one of its own.

    At the end, words that are too wide there are broken into lines. A figure without a layout is laid out once.
    """
    below: list[Legend] = []
    token, before = _given.set(_Given(target, below)), set(target.findobj(Annotation))
    try:
        yield
        panels = [target] if isinstance(target, Axes) else target.axes
        left = 1 - sum(key.get_window_extent().height for key in below) / target.bbox.height
        for axes in panels:
            _break_lines(axes, before, max(left, LEAST_LEFT))
        for key in below:
            if isinstance(key.parent, Axes):
                _put_below(key, key.parent)
        if isinstance(target, Figure) and _layout(target) is None and any(each.get_subplotspec() for each in panels):
            ConstrainedLayoutEngine().execute(target)
    finally:
        _given.reset(token)


def given() -> Target | None:
    """Return the axes or the figure of the user in which a picture is drawn; None if it makes a figure of its own."""
    context = _given.get()
    return None if context is None else context.target


def inches(of: Target) -> complex:
    """Return width and height of axes or a figure [inches]."""
    root = cast("Figure", of.get_figure(root=True))
    return complex(of.bbox.width, of.bbox.height) / root.dpi


def several(count: int) -> InputError:
    """Return the error that a plot has several panels, where the user gave axes."""
    hint = "give `figure`: a figure of matplotlib, or a part of one, such as `figure.subfigures(1, 2)[0]`"
    return InputError(Problem(f"is for plots of one panel, and this plot has {count}", field="`ax`", hint=hint))


def panels(
    height: float, rows: int = 1, columns: int = 1, *, projection: str = "rectilinear", **how: Any
) -> tuple[Figure, NDArray[Any]]:
    """Return a figure, new or of the user, and its panels.

    Parameters
    ----------
    height : float
        Height of a new figure [inches].
    rows, columns : int
        Number of panels.
    projection : str
        Projection of the panels.
    **how
        Further options of `Figure.subplots`.

    Returns
    -------
    matplotlib.figure.Figure
        The figure; it is a SubFigure if the user gave one.
    ndarray of Axes, shape (rows, columns)
        The panels, or the axes of the user.

    Raises
    ------
    InputError
        If the user gave axes that the panels do not fit.
    """
    target = given()
    if isinstance(target, Axes):
        if rows * columns > 1:
            raise several(rows * columns)
        if target.name != projection:
            hint = f'`figure.add_subplot(projection="{projection}")`'
            raise InputError(
                Problem(f"must have the projection {projection}, not {target.name}", field="`ax`", hint=hint)
            )
        return cast("Figure", target.figure), np.array([[target]])
    how |= {"subplot_kw": {"projection": projection}}
    if target is None and is_narrow() and columns > 1:  # below one another
        figure = new_figure(height * columns)
        tall = np.repeat(how.get("height_ratios", np.ones(rows)), columns).tolist()
        stacked = figure.subplots(rows * columns, 1, squeeze=False, subplot_kw=how["subplot_kw"], height_ratios=tall)
        return figure, stacked.reshape(rows, columns)
    figure = new_figure(height) if target is None else cast("Figure", target)
    return figure, figure.subplots(rows, columns, squeeze=False, **how)


def one_panel(height: float, title: str) -> tuple[Figure, Axes]:
    """Return a figure, of this height [in] if it is new, and its only panel under a heading."""
    figure, ((axes,),) = panels(height)
    heading(axes, title)
    return figure, axes


@lru_cache(maxsize=4096)
def size_of(text: str, points: float, weight: str = "normal") -> complex:
    """Return width and height of a text [inches]; mathematics is between dollars, other dollars are escaped."""
    if "\n" in text:
        sizes = [size_of(line, points, weight) for line in text.split("\n")]
        return complex(max(each.real for each in sizes), LINE_SPACING * points / POINTS_PER_INCH * len(sizes))
    text = printable(text)  # text as it is written to the file
    math = text.count("$") > text.count(r"\$")
    with catch_warnings():
        filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        width, height, _ = _measure().get_text_width_height_descent(
            text if math else text.replace(r"\$", "$"), FontProperties(size=points, weight=weight), math
        )
    return complex(width, height) / DPI


@cache
def _measure() -> Any:
    return RendererAgg(1, 1, DPI)  # type: ignore[no-untyped-call]


def fitted(text: str, width: float | None = None, points: float = TITLE) -> str:
    """Shorten a text, without mathematics, to the words that fit a width [inches], by default that of the page."""
    width = page_width() - 0.3 if width is None else width
    for most in range(MAX_HEADING_LENGTH, 10, -5):
        short = shorten(text, most, placeholder=" ...")
        if size_of(plain(short), points).real <= width:
            break
    return short


def folded(text: str, width: float, points: float, indent: str = "") -> str:
    """Break a text into lines that fit a width [inches] where they can; mathematics between dollars stays whole."""
    lines: list[str] = []
    for word in re.findall(r"(?:\\\$|\$[^$]*\$|[^ \n])+", text):
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and size_of(longer, points).real > width:
            lines.append(indent + word)
        else:
            lines[-1:] = [longer]
    return "\n".join(lines)


def in_lines(text: str, width: float) -> str:
    """Break a title into lines of a width [inches], with dollars escaped; only a very long one is cut."""
    for most in range(MAX_HEADING_LENGTH, 10, -10):
        lines = folded(plain(shorten(text, most, placeholder=" ...")), width, TITLE)
        if lines.count("\n") < MAX_HEADING_LINES:
            break
    return lines


def heading(axes: Axes, text: str) -> None:
    """Write the title of a plot above its first panel; dollars in names are plain characters."""
    width = page_width() - MAX_SIDE_MARGIN if given() is None else inches(axes).real
    lines = in_lines(text, width).replace(r"\$", "$")
    axes.set_title(lines, loc="left", fontsize=TITLE, color=INK, parse_math=False)


def heading_of_all(figure: Figure, text: str) -> None:
    """Write the title of a plot above all its panels."""
    width = page_width() - 0.3 if given() is None else 0.97 * inches(figure).real
    figure.suptitle(in_lines(text, width), fontsize=TITLE, x=0.01, ha="left", color=INK)


def over(ends_at_limit: Sequence[bool], *, math: bool = False) -> str:
    """Return the axis label of rotations divided by the critical rotation.

    In directions without a critical rotation, rotations are divided by the kinematic limit, and the label says so.
    """
    label = "φ/limit" if all(ends_at_limit) else "φ/φcr or limit" if any(ends_at_limit) else "φ/φcr"
    return label.replace("φcr", r"$\phi_{cr}$").replace("φ", r"$\phi$") if math else label


def angle_unit(reach: float) -> tuple[float, str]:
    """Return the factor and the unit in which rotations up to `reach` [rad] without a critical one are plotted."""
    return (180 / np.pi, "°") if reach >= np.pi / 180 else (1000.0, " mrad")


def plain(text: str) -> str:
    """Escape dollars in a text, so that they are not read as mathematics."""
    return text.replace("$", r"\$")


def save(figure: Figure, stream: IO[Any], **options: Any) -> None:
    """Write a figure; characters that an SVG file cannot hold are spelled out.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure to write.
    stream : file
        Stream to write to.
    **options
        Options of `Figure.savefig`.
    """
    _spell_out(figure)
    # Without a date, and with names from a fixed salt, the same figure is the same file.
    options = {"metadata": dict.fromkeys(DATES.get(options["format"], ()))} | options
    with catch_warnings(), rc_context({"svg.hashsalt": rcParams["svg.hashsalt"] or "rocking"}):
        filterwarnings("ignore", "Glyph .* missing from", UserWarning)  # a missing glyph is drawn as an empty box
        figure.savefig(stream, **options)


def write(path: Path, figure: Figure) -> None:
    """Write a figure completely or not at all, in the format of the suffix of the path."""
    write_whole(path, lambda stream: save(figure, stream, format=path.suffix[1:].lower()))


def lay_out(figure: Figure) -> None:
    """Place the panels of a new figure, so that they can be measured."""
    _spell_out(figure)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)


def _spell_out(figure: Figure) -> None:
    """Spell out the characters of names that neither fonts nor an SVG file can hold."""
    for each in figure.findobj(Text):
        if isinstance(each, Text) and each.get_text() != printable(each.get_text()):
            each.set_text(printable(each.get_text()))


def note(axes: Axes, text: str, height: float = 0.96) -> None:
    """Write a remark at the right edge of a panel, at a fraction of its height, legible over curves."""
    axes.annotate(
        text,
        (0.99, height),
        xycoords="axes fraction",
        ha="right",
        va="top",
        fontsize=TICK,
        parse_math=False,  # a $ in a name is not mathematics
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
    )


def plain_numbers(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Set plain numbers along a logarithmic axis, at given multiples of the powers of ten."""
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def logarithmic(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Make an axis logarithmic, with plain numbers."""
    axes = axis.axes
    (axes.set_xscale if axis is axes.xaxis else axes.set_yscale)("log")
    plain_numbers(axis, subs)


def time_axis(axes: Axes, first: float, last: float) -> tuple[float, float]:
    """Set an axis of times so that it shows those between two [s], and begins and ends at a tick; return its ends."""
    ticks = MaxNLocator(5 if is_narrow() else 9, steps=[1, 2, 2.5, 5, 10]).tick_values(first, last)
    axes.set_xticks(ticks)
    axes.set_xlim(ticks[0], ticks[-1])
    return float(ticks[0]), float(ticks[-1])


def in_percent(axis: Axis) -> None:
    """Number an axis of shares in per cent."""
    axis.set_major_formatter(PercentFormatter(1.0))


def legend_below(
    figure: Figure, handles: Sequence[Any] | None = None, ncols: int = 2, *, grows: bool = False, **look: Any
) -> None:  # fmt: skip
    """Draw the legend of a figure below its panels; in a figure of the user where no layout makes room, in a panel.

    A new figure that `grows` becomes higher by its legend.
    """
    context, below = _given.get(), {"fontsize": TICK, "frameon": False, **look}
    target = figure if context is None else context.target
    panels = [target] if isinstance(target, Axes) else target.axes
    lowest, layout = min(panels, key=lambda axes: axes.bbox.y0), _layout(target)
    handles = [each for axes in panels for each in axes.get_legend_handles_labels()[0]] if handles is None else handles
    outside = isinstance(target, Figure) and (layout is None or context is None)
    outside |= not isinstance(target, Axes) and isinstance(layout, ConstrainedLayoutEngine)
    labels, ncols = _in_columns(handles, inches(target if outside else lowest).real, ncols, look)
    if outside:
        key = target.legend(handles, labels, loc="outside lower center", ncols=ncols, **below)
        if context is not None:
            context.below.append(key)
        elif grows:
            figure.set_figheight(figure.get_figheight() + key.get_window_extent().height / figure.dpi)
    elif layout is not None and context is not None:
        context.below.append(lowest.legend(handles, labels, loc="upper center", ncols=ncols, **below))
    else:
        lowest.legend(handles, labels, loc="best", **LEGEND, **look)


def _in_columns(handles: Sequence[Any], room: float, ncols: int, look: dict[str, Any]) -> tuple[list[str], int]:
    """Return the labels of a legend, broken into lines, and its columns, at most `ncols`, that fit a width [inches]."""
    beside = (look.get("handlelength", 2.0) + 3.5) * TICK / POINTS_PER_INCH  # room of handle and gaps in a column
    labels = [printable(str(each.get_label())) for each in handles]
    widest = max((size_of(line, TICK).real for each in labels for line in each.split("\n")), default=0.0)
    if widest + beside > room:
        labels = [folded(each, room - beside, TICK, "    ") for each in labels]
    return labels, max(1, min(ncols, int(room / (widest + beside))))


def legends_below(figure: Figure, keys: Sequence[tuple[Axes, Sequence[Any]]], ncols: int = 3) -> None:
    """Draw legends below some panels, given from top to bottom; a new figure becomes taller by what they take."""
    others, handles = keys[:-1], keys[-1][1]
    for axes, its in others:
        labels, columns = _in_columns(its, inches(axes).real, ncols, {})
        axes.legend(its, labels, loc="upper left", bbox_to_anchor=(0, 0), ncols=columns, fontsize=TICK, frameon=False)
    legend_below(figure, handles, ncols)
    if given() is None:
        every = [*figure.legends, *(each for axes, _ in others if (each := axes.get_legend()) is not None)]
        taken = sum(each.get_window_extent().height for each in every) / figure.dpi
        figure.set_figheight(figure.get_figheight() + taken)


def _layout(target: Target) -> ConstrainedLayoutEngine | TightLayoutEngine | None:
    """Return what makes room for words in the figure of the user, if anything does."""
    engine = cast("Figure", target.get_figure(root=True)).get_layout_engine()
    return engine if isinstance(engine, ConstrainedLayoutEngine | TightLayoutEngine) else None


def _put_below(key: Legend, axes: Axes) -> None:
    """Put the legend of axes below the words of their horizontal axis, and of that of their twins."""
    root = cast("Figure", axes.get_figure(root=True))
    twins = [each for each in root.axes if np.allclose(each.bbox.bounds, axes.bbox.bounds)]
    words = [box for each in twins if (box := each.xaxis.get_tightbbox()) is not None]
    depth = max([0.0, *(axes.bbox.y0 - box.y0 for box in words)]) / root.dpi
    key.set_bbox_to_anchor((0.5, 0.0), axes.transAxes + ScaledTranslation(0, -depth, root.dpi_scale_trans))


def _break_lines(axes: Axes, before: set[Any], height_share: float) -> None:
    """Break the labels of a panel, and the notes in it that are not among those before, into lines that fit.

    Legends below the panels leave `height_share` of its height.
    """
    size = inches(axes)
    added = [each for each in axes.texts if isinstance(each, Annotation) and each not in before]
    notes = [(note, size.real) for note in added if note.xycoords == "axes fraction"]
    for label, room in ((axes.xaxis.label, size.real), (axes.yaxis.label, height_share * size.imag), *notes):
        escape: Callable[[str], str] = str if label.get_parse_math() else plain
        text = folded(escape(label.get_text()), room, float(label.get_fontsize()))
        label.set_text(text if label.get_parse_math() else text.replace(r"\$", "$"))


def tidy(axes: Axes, x: str = "", y: str = "") -> None:
    """Apply the common style to axes."""
    if x:
        place = axes.get_subplotspec()
        side_by_side = 1 if place is None else place.get_gridspec().ncols
        axes.set_xlabel(folded(x, page_width() / side_by_side - MAX_SIDE_MARGIN, LABEL), fontsize=LABEL)
    if y:
        axes.set_ylabel(y, fontsize=LABEL)
    axes.grid(True, color=GRID, linewidth=THIN)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=TICK, colors=INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


BINS_ACROSS = 4000  # more than the pixels of a picture, so that nothing is lost even enlarged in print


def visible(values: NDArray[np.float64], bins: int = BINS_ACROSS) -> NDArray[np.intp]:
    """Return the indices of the samples to draw: all of a short curve, lowest and highest of each bin of a long one.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite values at even times.
    bins : int
        Number of bins.

    Returns
    -------
    ndarray of int
        Increasing indices, including the first and the last sample and the extremes.
    """
    size = values.size // bins
    if size <= 2:
        return np.arange(values.size)
    whole = values[: bins * size].reshape(bins, size)
    starts = np.arange(bins) * size
    rest = np.arange(bins * size, values.size)  # the last values, fewer than the bins
    return np.unique(
        np.concatenate([[0, values.size - 1], starts + whole.argmin(axis=1), starts + whole.argmax(axis=1), rest])
    )


def draw_samples(axes: Axes, values: NDArray[np.float64], dt: float, start: float = 0.0, **look: Any) -> None:
    """Plot even samples against time, those that are visible."""
    shown = visible(values)
    axes.plot(start + shown * dt, values[shown], **look)


class _Numbers(Formatter):
    """Labels along an axis, with the decimal marks of a language."""

    def __init__(self, say: Language, own: Formatter) -> None:
        self.say, self.own = say, own

    def __call__(self, value: float, pos: int | None = None) -> str:
        return self.say.formula(self.own(value, pos))

    def format_ticks(self, values: list[float]) -> list[str]:
        return [*map(self.say.formula, self.own.format_ticks(values))]


def in_language(say: Language, draw: Callable[[], Figure]) -> Callable[[], Figure]:
    """Return what draws a plot in a language; a text that is not recognised stays in English.

    Parameters
    ----------
    say : Language
        The language, whose texts of the family `figure` are those of plots.
    draw : callable
        Draws the plot in English.
    """
    if say.key == "en":
        return draw

    def translated() -> Figure:
        figure = draw()
        for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
            axis.set_major_formatter(_Numbers(say, axis.get_major_formatter()))
        for each in figure.findobj(Text):
            assert isinstance(each, Text)  # as selected above
            each.set_text(say.formula(_translated(say, each.get_text().split("\n"), float(each.get_fontsize()))))
        return figure

    return translated


def _translated(say: Language, lines: list[str], points: float) -> str:
    """Return a text of a plot in a language; one sentence in several lines is broken anew, into no wider lines."""
    if len(lines) > 1 and (whole := say.matched("figure", " ".join(lines))) is not None:
        return folded(whole, max(size_of(line, points).real for line in lines), points)
    return "\n".join(say.recognised("figure", line) for line in lines)
