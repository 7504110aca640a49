"""What `rocking selfcheck` and `rk.selfcheck` are asked."""

from __future__ import annotations

from rocking_cli.ask.asked import AskedModel, option


class SelfcheckAsked(AskedModel):
    """Check that this installation computes correctly, against formulas, literal values and a general solver.

    Released blocks and walls are compared with quadrature, thresholds of overturning, filters, shares of neighbours,
    sliding joints and equivalent blocks with formulas, time histories with a general solver, and records with the
    samples that were written. Two checks compare results of the same code: batches in several threads with those in
    one, and the shipped machine code with its source run by Python. Temporary files are written and removed.

    A check that cannot be run on this machine is reported, with the reason, and is not counted as passed. If a check
    fails, the output states what to do, and the exit code is 4.

    \b
    Example:
      rocking selfcheck
      rocking selfcheck --quick --json
    """

    quick: bool = option("Compute a few cases of each check only.", default=False)
