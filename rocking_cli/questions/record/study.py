"""Intensity of one ground motion by several measures, including measures relative to a structure."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.intensity import Measure, Reference, RunMeasure
from rocking_cli.structure import Structure


def reference_of(structure: Structure) -> Reference:
    """Return the reference values of measures relative to a structure, in the direction that uplifts first."""
    gravity = structure.mechanism.gravity
    if structure.why_no_block is not None:
        return Reference(nan, min(side.lambda_ for side in structure.statics), gravity)
    block = min((structure.equivalence.positive, structure.equivalence.negative), key=lambda each: each.lambda_)
    return Reference(block.p, block.lambda_, gravity, block.v_imp)


def intensities(
    motion: GroundMotion, measures: Sequence[Measure], structure: Reference | None = None
) -> dict[Measure, float]:  # fmt: skip
    """Compute intensity measures of a ground motion.

    Parameters
    ----------
    motion : GroundMotion
        The scaled motion.
    measures : sequence of Measure
        The measures to compute.
    structure : Reference, optional
        Reference values of relative measures.

    Returns
    -------
    dict of Measure to float
        Value of each measure; NaN if the motion or the structure has none.

    Raises
    ------
    InputError
        If a measure is relative, and there is no structure.
    PluginError
        If the plugin of a measure fails.
    """
    bare = [str(measure) for measure in measures if measure.is_relative]
    if bare and structure is None:
        raise InputError(Problem(f"{', '.join(bare)}: relative to what is shaken", hint=f"give a {named('structure')}"))
    values: dict[Measure, float] = {}
    for measure in measures:
        if isinstance(measure, RunMeasure):
            assert structure is not None
            values[measure] = measure.value(motion, structure)
        else:
            assert measure.base is not None
            value = measure.base.value(motion)
            values[measure] = float(value if structure is None else measure.relative(value, structure))
    return values
