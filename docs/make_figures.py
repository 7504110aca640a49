"""Recompute the figures of DeJong and Dimitrakopoulos (2014): plots and data.

    python docs/make_figures.py 3
    python docs/make_figures.py 14 --record accel.csv
    python docs/make_figures.py all --out figures --format svg

Writes `figureN.png` and its data, `figureN.csv`. The scan of the paper has lost its pictures, and with them the ranges
of some geometries. Values chosen here to show what the text says are stated in the caption.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import cos, pi, sin, sqrt, tan
from pathlib import Path
from textwrap import fill
from typing import Any

import click
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter
from numpy.typing import NDArray

from rocking_cli import Mechanism, Registry
from rocking_cli.ask.read import read_record
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.dynamics.history import History, follow
from rocking_cli.errors import MechanismError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulse_fit import fit_pulse
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.plotting import style
from rocking_cli.plotting.structure import draw_at_rest
from rocking_cli.questions.error.study import linearisation
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.studies.picture import picture
from rocking_cli.studies.response import of_one_degree

Reals = NDArray[np.float64]
RECORD = Path(__file__).parents[1] / "examples" / "accel.csv"  # of Figure 14
AMPLITUDES = np.union1d(np.linspace(0.02, 0.98, 25), 1 - np.geomspace(0.002, 0.1, 16))  # closer where the curves bend
ACCELERATIONS = 1 + np.geomspace(0.02, 9.0, 40)  # closer where the curves bend
SLENDERNESS = (0.1, 0.2, 0.3, 0.4)  # rad, of the wall
HEIGHTS = (1.0, 1.1, 1.2, 1.3)  # H1/H of the frame
THICKNESSES = (0.12, 0.14, 0.16, 0.18, 0.20)  # t/r of the arch, as in the paper
ANGLES = (120.0, 130.0, 140.0, 157.5)  # deg, of the arch
OURS = "Ranges of the geometry are ours: the scan has lost them."
OVER_AMPLITUDE, OVER_ACCELERATION = r"$\phi/\phi_{cr}$", r"$\ddot u_g/g\lambda$"


@dataclass(frozen=True, eq=False)
class PaperCurve:
    """A line of a panel.

    Parameters
    ----------
    label : str
        Label that distinguishes the curve from others in the panel.
    x, y : ndarray
        Coordinates of the points.
    thin : bool
        Whether the curve is drawn thin, as a background to the others.
    """

    label: str
    x: Reals
    y: Reals
    thin: bool = False


@dataclass(frozen=True, eq=False)
class PaperPanel:
    """Axes with curves.

    Parameters
    ----------
    title, xlabel, ylabel : str
        Title and axis labels; labels may hold mathematics between dollars.
    curves : list of PaperCurve
        The curves.
    log : bool
        Whether x is logarithmic.
    """

    title: str
    xlabel: str
    ylabel: str
    curves: list[PaperCurve] = field(default_factory=list)
    log: bool = False


@dataclass(frozen=True, eq=False)
class PaperFigure:
    """A figure of the paper.

    Parameters
    ----------
    number : int
        Number of the figure in the paper.
    title, caption : str
        What the figure shows, and which values were chosen here.
    panels : list of list of PaperPanel
        The panels, by rows.
    structures : mapping of str to Mechanism, optional
        The structures, by name, drawn above the panels.
    """

    number: int
    title: str
    caption: str
    panels: list[list[PaperPanel]]
    structures: Mapping[str, Mechanism] = field(default_factory=dict)

    def rows(self) -> Iterator[list[str]]:
        """Yield the data as a table: a header, then a line for each point."""
        yield ["panel", "curve", "x", "y", "x is", "y is"]
        for panel in (each for row in self.panels for each in row):
            for curve in panel.curves:
                for x, y in zip(curve.x.tolist(), curve.y.tolist(), strict=True):
                    yield [panel.title, curve.label, f"{x:.9g}", f"{y:.9g}", panel.xlabel, panel.ylabel]


def wall_errors() -> PaperFigure:
    """Compute Figure 3, the errors of the equivalent block of a wall."""
    period = PaperPanel("free rocking period", OVER_AMPLITUDE, "$T_{r,block}/T_{r,wall}$")
    over = [_overturning(f"overturning time, $\\kappa_{k}$", "wall") for k in (1, 2)]
    for alpha in SLENDERNESS:
        wall = make("wall", thickness=2 * sin(alpha), height=4 * cos(alpha))
        found = linearisation(wall, Direction.POSITIVE, AMPLITUDES, ACCELERATIONS)
        label = rf"$\alpha$ = {alpha:g}"
        period.curves.append(PaperCurve(label, AMPLITUDES, found.period_ratio))
        over[0].curves.append(PaperCurve(label, ACCELERATIONS, found.overturning_ratio1))
        over[1].curves.append(PaperCurve(label, ACCELERATIONS, found.overturning_ratio2))
    slenderness = np.linspace(0.01, 0.5, 50)
    uplift = PaperPanel("uplift", r"$\alpha$ [rad]", r"$\lambda_{lin}/\lambda$")
    uplift.curves.append(PaperCurve("wall", slenderness, slenderness / np.tan(slenderness)))
    caption = (
        "Ratios of the equivalent block's value to the wall's, for slenderness of one block from 0.1 to 0.4. " + OURS
    )
    return PaperFigure(3, "Equivalent block of the wall", caption, [[period, over[0]], [uplift, over[1]]])


@dataclass(frozen=True)
class _FrameShape:
    """A family of asymmetric frames: slenderness of the left column, spacing and beam over its height 2H."""

    name: str
    slenderness: float
    spacing: float
    beam: float

    def frame(self, ratio: float) -> Mechanism:
        """Return the frame with H1/H = ratio; its size has no effect on the dimensionless results."""
        left = 8.0
        return make(
            "asymmetric_frame",
            column_width=left * tan(self.slenderness),
            left_height=left,
            right_height=left * ratio,
            spacing=left * self.spacing,
            beam_depth=left * self.beam,
            density=2500.0,
            depth=1.0,
        )


SHAPES = (
    _FrameShape("square, slender beam", 0.2, 1.0, 0.1),
    _FrameShape("narrow, thick beam", 0.2, 0.4, 1.0),
)
FRAMES = (
    "Left: columns of slenderness 0.2, their axes one left height apart, a beam a tenth as deep. Right: 0.4 of that "
    "height apart, a beam as deep as it. " + OURS
)


def frame_parameters() -> PaperFigure:
    """Compute Figure 5, the parameters of the equivalent block of the asymmetric frame."""
    ratios = np.linspace(1.0, 1.5, 21)
    names = (
        ("critical rotation", r"$\phi_{cr}/\alpha$"),
        ("frequency parameter", "$p/p(H_1 = H)$"),
        ("uplift", r"$\lambda/\tan\alpha$"),
        ("linearised uplift", r"$\lambda_{lin}/\lambda$"),
    )
    columns = []
    for shape in SHAPES:
        column = [PaperPanel(f"{title}: {shape.name}", "$H_1/H$", label) for title, label in names]
        blocks = [equivalent_block(shape.frame(ratio)) for ratio in ratios]
        for direction in Direction:
            each = [block[direction] for block in blocks]
            series = (
                [block.phi_cr / shape.slenderness for block in each],
                [block.p / each[0].p for block in each],
                [block.lambda_ / tan(shape.slenderness) for block in each],
                [block.lambda_lin / block.lambda_ for block in each],
            )
            for panel, values in zip(column, series, strict=True):
                panel.curves.append(PaperCurve(direction.label, ratios, np.array(values)))
        columns.append(column)
    caption = "Parameters of the equivalent block of the asymmetric frame, in both directions. " + FRAMES
    panels = [list(row) for row in zip(*columns, strict=True)]
    return PaperFigure(5, "Equivalent block of the asymmetric frame", caption, panels)


def frame_errors(number: int) -> PaperFigure:
    """Compute Figure 6 (free period), 7 or 8 (overturning time with kappa1 and kappa2)."""
    title, make, x, pick = _measure(number - 6, "frame")
    rows = []
    for direction in Direction:
        row = []
        for shape in SHAPES:
            panel = make(f"{direction.label} direction: {shape.name}")
            for ratio in HEIGHTS:
                y = pick(shape.frame(ratio), direction)
                panel.curves.append(PaperCurve(f"$H_1/H$ = {ratio:g}", x, y))
            row.append(panel)
        rows.append(row)
    caption = f"{title}: ratio of the equivalent block's value to the asymmetric frame's. {FRAMES}"
    return PaperFigure(number, f"Error of the equivalent block of the asymmetric frame: {title.lower()}", caption, rows)


def arch_parameters() -> PaperFigure:
    """Compute Figure 10, the parameters of the equivalent block of the arch."""
    angles = np.linspace(90.0, 170.0, 33)
    names = (
        ("critical rotation", r"$\phi_{cr}$ [rad]"),
        ("uplift", r"$\lambda$"),
        ("frequency parameter", r"$p\sqrt{r_a/g}$"),
        ("linearised uplift", r"$\lambda_{lin}/\lambda$"),
    )
    panels = [PaperPanel(title, r"$\beta$ [deg]", label) for title, label in names]
    for thickness in THICKNESSES:
        stands, blocks = [], []
        for angle in angles.tolist():
            arch = _arch(thickness, angle)
            if arch is not None:
                stands.append(angle)
                blocks.append((equivalent_block(arch).positive, arch.gravity))
        series = (
            [block.phi_cr for block, _ in blocks],
            [block.lambda_ for block, _ in blocks],
            [block.p * sqrt(10.0 / gravity) for block, gravity in blocks],
            [block.lambda_lin / block.lambda_ for block, _ in blocks],
        )
        for panel, values in zip(panels, series, strict=True):
            panel.curves.append(PaperCurve(f"$t_a/r_a$ = {thickness:g}", np.array(stands), np.array(values)))
    caption = (
        "Parameters of the equivalent block of the arch over its inclusion angle, hinges anywhere. The range of angles "
        "is ours; a curve is there where the arch has a four-hinge mechanism."
    )
    return PaperFigure(10, "Equivalent block of the arch", caption, [panels[:2], panels[2:]])


def arch_errors(number: int) -> PaperFigure:
    """Compute Figure 11 (free period), 12 or 13 (overturning time with kappa1 and kappa2)."""
    title, make, x, pick = _measure(number - 11, "arch")
    panels = []
    for thickness in (0.12, 0.14, 0.16, 0.20):
        panel = make(f"$t_a/r_a$ = {thickness:g}")
        for angle in ANGLES:
            arch = _arch(thickness, angle)
            if arch is not None:
                panel.curves.append(PaperCurve(rf"$\beta$ = {angle:g} deg", x, pick(arch, Direction.POSITIVE)))
        panels.append(panel)
    caption = (
        f"{title}: ratio of the equivalent block's value to the arch's, hinges anywhere; the least slender arches are "
        f"at the bottom right. {OURS} Arches of less than {ANGLES[0]:g} degrees, whose errors are larger, are left out."
    )
    rows = [panels[:2], panels[2:]]
    return PaperFigure(number, f"Error of the equivalent block of the arch: {title.lower()}", caption, rows)


def _measure(
    which: int, structure: str
) -> tuple[str, Callable[[str], PaperPanel], Reals, Callable[[Mechanism, Direction], Reals]]:
    """Return the title, a function for an empty panel, x, and a function for y, of one of the three errors."""
    if which == 0:
        ylabel = f"$T_{{r,block}}/T_{{r,{structure}}}$"
        return (
            "Free rocking period",
            lambda title: PaperPanel(title, OVER_AMPLITUDE, ylabel),
            AMPLITUDES,
            lambda mechanism, direction: linearisation(mechanism, direction, AMPLITUDES).period_ratio,
        )
    return (
        f"Overturning time with kappa{which}",
        lambda title: _overturning(title, structure),
        ACCELERATIONS,
        lambda mechanism, direction: getattr(
            linearisation(mechanism, direction, acceleration=ACCELERATIONS), f"overturning_ratio{which}"
        ),
    )


def _overturning(title: str, structure: str) -> PaperPanel:
    return PaperPanel(title, OVER_ACCELERATION, f"$t_{{over,block}}/t_{{over,{structure}}}$", log=True)


def make(name: str, **values: Any) -> Mechanism:
    """Build an installed mechanism from its name and its fields."""
    mechanism: Mechanism = Registry()[name](**values)
    return mechanism


def _arch(thickness: float, angle: float) -> Mechanism | None:
    """Return an arch of radius 10 m, or None if it does not stand or does not collapse on four hinges."""
    try:
        arch = make("arch", radius=10.0, thickness=10.0 * thickness, inclusion_angle_deg=angle)
        equivalent_block(arch)
    except (MechanismError, ValueError):
        return None
    return arch


A, OMEGA, ETA = 2.0, 5.0, 0.9  # of the pulse of Figure 15, and the restitution that all its structures are given
OVER = r"$\phi/\phi_{cr}$"
LABELS = {"nonlinear": "nonlinear", "linear2": r"linear, $\kappa_2$"}
SHOWN = 12.0  # of p t, in Figure 15


def record_response(record: Path = RECORD) -> PaperFigure:
    """Compute Figure 14: an asymmetric frame under a record, and under the sine pulse fitted to it alone.

    Parameters
    ----------
    record : Path
        File of the record; the paper has Northridge 1994, Rinaldi.
    """
    motion = read_record(record)
    # The paper gives lambda_p = 0.197 and lambda_n = 0.241; the rest of the geometry is chosen to meet them.
    frame = make(
        "asymmetric_frame",
        column_width=2.6059,
        left_height=9.0,
        right_height=15.9109,
        spacing=5.4,
        beam_depth=4.5,
        density=2500.0,
        depth=1.0,
    )
    fit = fit_pulse(motion, "sine", "acceleration")
    alone = fit.alone(motion)
    time = np.arange(motion.npts, dtype=np.float64) * motion.dt
    ground = PaperPanel("ground motion", "time [s]", r"$\ddot u_g$ [g]")
    called = motion.name.replace("$", r"\$")  # labels and captions hold mathematics: a $ in a name is a $
    ground.curves.append(PaperCurve(called, time, motion.acceleration / STANDARD_GRAVITY, thin=True))
    ground.curves.append(PaperCurve("sine pulse in it", time, alone.acceleration / STANDARD_GRAVITY))
    response = PaperPanel("response", "time [s]", OVER)
    for what, shaking in (("record", motion), ("its pulse", alone)):
        conditions = Conditions(Structure(frame), ("nonlinear", "linear2"), tail=0.0)
        for name, run in of_one_degree(conditions, shaking).items():
            response.curves.append(_followed(f"{LABELS[name]}, {what}", run))
    caption = (
        f"An asymmetric frame with the paper's uplift accelerations (0.197 g positive, 0.241 g negative) under "
        f"{called}, and under its sine pulse of {fit.pulse.amplitude / STANDARD_GRAVITY:.3g} g and "
        f"{fit.pulse.period:.3g} s alone, which captures {fit.captured:.0%} of the record's energy. The rest of the "
        "geometry is ours: left column 9 m, right 15.91 m high, 2.606 m wide, axes 5.4 m apart, beam 4.5 m deep."
    )
    title = "Seismic response of an asymmetric frame"
    return PaperFigure(14, title, caption, [[ground], [response]], {"": frame})


def _followed(label: str, run: History, scale: float = 1.0) -> PaperCurve:
    there = np.isfinite(run.ratio) & (np.abs(run.ratio) <= 1.5)  # a fall is cut off
    time: Reals = run.time[there] * scale
    return PaperCurve(label, time, run.ratio[there])


def structures() -> dict[str, Mechanism]:
    """Return the structures of Figure 15, all with one restitution; their dimensions are chosen here."""
    alpha = 0.2
    return {
        "block": make("block", width=2 * sin(alpha), height=2 * cos(alpha), restitution=ETA),
        "symmetric frame": make(
            "symmetric_frame",
            column_width=4 * sin(alpha),
            column_height=4 * cos(alpha),
            mass_ratio=2.0,
            restitution=ETA,
        ),
        "wall": make("wall", thickness=2 * sin(alpha), height=4 * cos(alpha), restitution=ETA),
        "arch": make("arch", radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, restitution=ETA),
    }


def equivalent_vulnerability() -> PaperFigure:
    """Compute Figure 15: four structures under the pulses to which they are equivalently vulnerable."""
    pulses = PaperPanel("the pulse of each", "time [s]", r"$\ddot u_g$ [g]")
    responses = PaperPanel("response", "$p\\,t$", OVER)
    for name, structure in structures().items():
        block = equivalent_block(structure).positive
        pulse = Sine(A * block.lambda_ * structure.gravity, 2 * pi / (OMEGA * block.p))
        motion = pulse.sampled()
        drawn = motion.kept
        time = np.arange(drawn.npts, dtype=np.float64) * drawn.dt
        pulses.curves.append(PaperCurve(name, time, drawn.acceleration / STANDARD_GRAVITY))
        model = Structure(structure).model("nonlinear")
        run = follow(replace(model, joints=None), motion, tail=SHOWN / block.p)  # as the paper: all joints hold
        curve = _followed(name, run, block.p)
        shown = curve.x <= SHOWN
        responses.curves.append(PaperCurve(name, curve.x[shown], curve.y[shown]))
    caption = (
        f"Full sine pulses of the same a = {A:g} and omega = {OMEGA:g} (with kappa2), and the nonlinear responses to "
        f"them, over p t. All have the restitution {ETA:g}. Geometry ours: block and frame of slenderness 0.2 (columns "
        "twice as large, beam twice as heavy as they are), wall of blocks of slenderness 0.2, Oppenheim's arch. As in "
        "the paper, joints do not open: `rocking respond` states that those of the arch would."
    )
    return PaperFigure(
        15,
        "Pulses to which different structures are equivalently vulnerable",
        caption,
        [[pulses], [responses]],
        structures(),
    )


CAPTION = 115  # characters a line
PANEL, DRAWN = 2.6, 1.4  # inches high
FLAT = 0.01  # what differs by less is shown flat
MOST = 1.5  # ratios beyond are cut off, and the caption says so
LEGEND = 0.3  # inches of a legend above all panels


def draw_paper_figure(paper: PaperFigure) -> Figure:
    """Plot a figure of the paper with its caption below.

    Parameters
    ----------
    paper : PaperFigure
        The figure to plot.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows, columns = len(paper.panels), len(paper.panels[0])
    if style.is_narrow():  # below one another
        rows, columns = rows * columns, 1
    cut = any(_is_ratio(panel) and _values(panel).max() > MOST for row in paper.panels for panel in row)
    said = f"Figure {paper.number} of DeJong and Dimitrakopoulos (2014), recomputed. {paper.caption}"
    characters = int(CAPTION * style.page_width() / style.PAGE_WIDTH)
    caption = fill(said + (f" Curves are cut off at a ratio of {MOST:g}." if cut else ""), characters)
    drawn = DRAWN if paper.structures else 0.0
    families = {
        tuple(curve.label for curve in panel.curves) for row in paper.panels for panel in row if len(panel.curves) > 1
    }
    above_all = LEGEND if len(families) == 1 else 0.0
    figure = style.new_figure(PANEL * rows + drawn + above_all + 0.5 + 0.14 * (caption.count("\n") + 1))
    below: Any = figure
    if paper.structures:
        parts: Any = figure.subfigures(2, 1, height_ratios=[drawn, PANEL * rows])
        above, below = parts
        places = above.subplots(1, len(paper.structures), squeeze=False)[0]
        for place, (name, structure) in zip(places, paper.structures.items(), strict=True):
            draw_at_rest(place, picture(structure), name)
    axes = below.subplots(rows, columns, squeeze=False)
    for panel, each in zip((p for row in paper.panels for p in row), axes.flat, strict=True):
        for k, curve in enumerate(panel.curves):
            width = 0.7 if curve.thin else 1.6 - 0.15 * k
            each.plot(curve.x, curve.y, label=curve.label, linewidth=width, **style.family(k))
        if panel.log:
            each.set_xscale("log")
            each.set_xticks([1, 2, 5, 10])
            each.xaxis.set_major_formatter(ScalarFormatter())
            each.minorticks_off()
        each.ticklabel_format(axis="y", useOffset=False)
        values = _values(panel)
        if _is_ratio(panel):
            each.axhline(1.0, color=style.FAINT, linewidth=style.THIN)
            low, high = values.min(), min(values.max(), MOST)
            margin = 0.05 * max(high - low, FLAT)
            each.set_ylim(min(low - margin, 1 - margin), max(high + margin, 1 + margin))
        elif np.ptp(values) < FLAT:
            each.set_ylim(values.mean() - FLAT, values.mean() + FLAT)
        each.set_title(panel.title, fontsize=style.TICK, loc="left")
        each.set_xlabel(panel.xlabel, fontsize=style.TICK)
        each.set_ylabel(panel.ylabel, fontsize=style.TICK)
        style.tidy(each)
    if above_all:  # one for all panels, on none of their curves
        handles = max((each.get_lines() for each in axes.flat), key=len)
        handles = [line for line in handles if not line.get_label().startswith("_")]
        look = style.LEGEND | {"fontsize": style.TICK, "handlelength": 3.0}
        ncols = min(len(handles), 3 if style.is_narrow() else len(handles))
        below.legend(handles=handles, loc="outside upper center", ncols=ncols, **look)
        families.clear()
    labels: list[str] = []
    for panel, each in zip((p for row in paper.panels for p in row), axes.flat, strict=True):
        if families and [curve.label for curve in panel.curves] != labels and len(panel.curves) > 1:  # where it changes
            labels = [curve.label for curve in panel.curves]
            each.legend(**style.LEGEND | {"fontsize": style.SMALL})
    below.supxlabel(caption, fontsize=style.SMALL, x=0.01, ha="left", color=style.INK)
    return figure


def _values(panel: PaperPanel) -> Reals:
    """Return all finite values of a panel."""
    return np.concatenate([curve.y[np.isfinite(curve.y)] for curve in panel.curves])


def _is_ratio(panel: PaperPanel) -> bool:
    """Return whether a panel shows ratios of the block's times to the structure's."""
    return panel.ylabel.startswith(("$T", "$t"))


FIGURES: dict[int, Callable[[], PaperFigure]] = {
    3: wall_errors,
    5: frame_parameters,
    **{number: partial(frame_errors, number) for number in (6, 7, 8)},
    10: arch_parameters,
    **{number: partial(arch_errors, number) for number in (11, 12, 13)},
    14: record_response,
    15: equivalent_vulnerability,
}


@click.command()
@click.argument("number", type=click.Choice([*map(str, FIGURES), "all"]))
@click.option("--record", type=click.Path(path_type=Path), default=RECORD, help="Record for Figure 14.")
@click.option("--out", type=click.Path(path_type=Path), default=".", help="Folder for the figures.")
@click.option("--format", "suffix", default="png", help="File format of the plots: png, svg or pdf.")
def main(number: str, record: Path, out: Path, suffix: str) -> None:
    """Recompute a figure of the paper, or all of them."""
    out.mkdir(parents=True, exist_ok=True)
    for each in FIGURES if number == "all" else [int(number)]:
        paper = record_response(record) if each == 14 else FIGURES[each]()
        with (out / f"figure{each}.{suffix}").open("wb") as stream:
            style.save(draw_paper_figure(paper), stream, format=suffix)
        with (out / f"figure{each}.csv").open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows(paper.rows())


if __name__ == "__main__":
    main()
