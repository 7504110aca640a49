"""`rocking selfcheck`: check that this installation computes correctly."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Check that this installation computes correctly.")
@click.option("--quick", is_flag=True, help="Compute a few cases of each check only.")
@options.as_json
@click.pass_context
def command(ctx: click.Context, quick: bool, as_json: bool) -> None:
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
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.errors import SolverError
    from rocking_cli.questions.selfcheck.verb import selfcheck

    answer = selfcheck(quick=quick, watch=OnTerminal())
    terminal.show(answer.view, as_json=as_json)
    for each in answer.failed:
        terminal.debug_traceback(each.error)
    if answer.failed:
        ctx.exit(SolverError.exit_code)
