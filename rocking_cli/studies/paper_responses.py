"""The paper's illustrative examples, computed from scratch: Figures 14 and 15."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np

from rocking_cli.core import Mechanism, equivalent_block
from rocking_cli.dynamics.history import History, follow
from rocking_cli.engines import respond
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import fit_pulse
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.structure import Structure
from rocking_cli.studies.paper_figures import PaperCurve, PaperFigure, PaperPanel, Reals, make
from rocking_cli.text import printable

A, OMEGA, ETA = 2.0, 5.0, 0.9  # of the pulse of Figure 15, and the restitution that all its structures are given
OVER = r"$\phi/\phi_{cr}$"
LABELS = {"nonlinear": "nonlinear", "linear2": r"linear, $\kappa_2$"}
SHOWN = 12.0  # of p t, in Figure 15


def record_response(motion: GroundMotion) -> PaperFigure:
    """Compute Figure 14: an asymmetric frame under a record, and under the sine pulse fitted to it alone.

    Parameters
    ----------
    motion : GroundMotion
        The record; the paper has Northridge 1994, Rinaldi.
    """
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
    called = printable(motion.name).replace("$", r"\$")  # labels and captions hold mathematics: a $ in a name is a $
    ground.curves.append(PaperCurve(called, time, motion.acceleration / STANDARD_GRAVITY, thin=True))
    ground.curves.append(PaperCurve("sine pulse in it", time, alone.acceleration / STANDARD_GRAVITY))
    response = PaperPanel("response", "time [s]", OVER)
    for what, shaking in (("record", motion), ("its pulse", alone)):
        for name, run in respond(Structure(frame), shaking, models=("nonlinear", "linear2"), tail=0.0).items():
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
