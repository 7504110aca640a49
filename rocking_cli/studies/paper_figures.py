"""The paper's figures on the equivalence, computed from scratch: 3, 5 to 8, and 10 to 13.

The scan of the paper has lost its pictures, and with them the ranges of some geometries. Values chosen here to show
what the text says are stated in the caption.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import cos, sin, sqrt, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Mechanism, equivalent_block
from rocking_cli.core.registry import Registry
from rocking_cli.errors import MechanismError
from rocking_cli.studies.linearisation import linearisation

Reals = NDArray[np.float64]
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


def paper_figure(number: int) -> PaperFigure:
    """Compute a figure of the paper.

    Parameters
    ----------
    number : int
        One of `NUMBERS`; Figures 14 and 15 are in `paper_responses`.

    Returns
    -------
    PaperFigure
    """
    return _FIGURES[number]()


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


_FIGURES: dict[int, Callable[[], PaperFigure]] = {
    3: wall_errors,
    5: frame_parameters,
    10: arch_parameters,
    **{number: lambda number=number: frame_errors(number) for number in (6, 7, 8)},  # type: ignore[misc]
    **{number: lambda number=number: arch_errors(number) for number in (11, 12, 13)},  # type: ignore[misc]
}
NUMBERS: Sequence[int] = sorted(_FIGURES)
