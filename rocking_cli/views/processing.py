"""The processing of a ground motion, in words and as data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion


def in_words(motion: GroundMotion) -> str:
    """Return the processing steps of a motion, and the file that was prepared by them, in a few words, if any."""
    from rocking_cli.excitation.records.record_units import QUANTITIES
    from rocking_cli.processing import reading

    steps = list(motion.processing)
    for quantity in QUANTITIES:
        if (step := f"from {quantity}") in steps:
            steps[steps.index(step)] += f" ({reading.in_words(quantity, motion.of_ground.dt)})"
    parts = [f"processed: {', '.join(steps)}"] if steps else []
    return "; ".join(parts + ([f"prepared from {motion.prepared_from}"] if motion.prepared_from else []))


def data(motion: GroundMotion) -> dict[str, Any]:
    """Return the processing steps of a motion in order, as options spell them; for a floor also its peak [g].

    For a prepared record also its file.
    """
    entry: dict[str, Any] = {"processing": list(motion.processing)}
    if motion.prepared_from:
        entry["prepared_from"] = motion.prepared_from
    if motion.ground is not None:
        entry["floor_pga"] = motion.pga_g
    return entry
