"""What one ground motion does to a structure, as `respond` is asked: both polarities, and the pulse in it alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rocking_cli.cli import shaking, terminal
from rocking_cli.cli.motions import Scaled
from rocking_cli.cli.responses import Histories, Runs
from rocking_cli.dynamics.model import Model
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit, fit_pulses

# The pulses that are fitted, and the word for the one that fits best.
FITTED = ("sine", "ricker", "mavroeidis")
BEST = "best"


@dataclass(frozen=True)
class Question:
    """What is asked of every motion.

    Parameters
    ----------
    signs : tuple of int
        Polarities, of 1 and -1.
    release : float or None
        Start at rest from this fraction of phi_cr.
    tail : float
        How long the samples go on after the record [s].
    rtol : float
        Relative local error of a step.
    with_pulse : str or None
        Also the response to the pulse in the record alone: its shape, or "best".
    """

    signs: tuple[int, ...]
    release: float | None
    tail: float
    rtol: float
    with_pulse: str | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """What became of a structure under one motion.

    Parameters
    ----------
    given : Scaled or None
        The motion as read; None for a free release.
    first : GroundMotion or None
        The motion as scaled, in the first polarity asked for.
    runs : mapping of int to mapping of str to History
        The histories under each polarity.
    fit, to_pulse : PulseFit and mapping of str to History, optional
        The pulse in the motion, and the histories under it alone.
    """

    given: Scaled | None
    first: GroundMotion | None
    runs: Runs
    fit: PulseFit | None = None
    to_pulse: Histories | None = None


def answer(models: Sequence[Model], given: Scaled | None, asked: Question) -> Answer:
    """Follow the models of a structure under a motion, or freely from a release."""

    def follow(motion: GroundMotion | None) -> Histories:
        return shaking.respond(models, motion, asked.release, asked.tail, asked.rtol)

    if given is None:
        return Answer(None, None, {sign: follow(None) for sign in asked.signs})
    under = {sign: given.motion.scaled(sign * given.factor) for sign in asked.signs}
    first = under[asked.signs[0]]
    fit = _find(first, asked.with_pulse) if asked.with_pulse is not None else None
    runs = {sign: follow(motion) for sign, motion in under.items()}
    return Answer(given, first, runs, fit, follow(fit.alone(first)) if fit is not None else None)


def _find(motion: GroundMotion, shape: str) -> PulseFit:
    """The pulse of a shape, or of the best, that captures most energy of the velocity of a motion."""
    fits = fit_pulses(motion, FITTED if shape == BEST else (shape,), ("velocity",))
    fit = max(fits, key=lambda each: each.captured)
    terminal.note(
        f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
        f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
        f"{100 * fit.captured:.0f} % of the energy of the velocity"
    )
    return fit
