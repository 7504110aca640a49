"""`rocking error`: how far to trust the equivalent block of a structure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.pictures import write_picture

if TYPE_CHECKING:
    from rocking_cli.studies.linearisation import Linearisation


def _checked(
    ctx: click.Context, param: click.Parameter, values: tuple[float, ...]
) -> tuple[float, ...]:  # fmt: skip
    from rocking_cli.studies.linearisation import why_no_acceleration, why_no_amplitude

    why_not = why_no_amplitude if param.name == "amplitudes" else why_no_acceleration
    for value in values:
        if why := why_not(value):
            raise click.BadParameter(f"{why}.", ctx, param)
    return values


@click.command(short_help="Error of the equivalent block: period, uplift, overturning time.")
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--at", "amplitudes", type=options.Finite(), multiple=True, default=(0.5,), show_default="0.5", metavar="RATIO",
    callback=_checked, help="Amplitude phi/phi_cr of interest; may be repeated.",
)  # fmt: skip
@click.option(
    "--accel", "accelerations", type=options.Finite(), multiple=True, default=(2.0,), show_default="2",
    metavar="TIMES", callback=_checked, help="Constant acceleration over that at uplift; may be repeated.",
)  # fmt: skip
@options.plot("Draw the errors over their ranges")
@options.as_json
def command(
    file: str | None, amplitudes: tuple[float, ...], accelerations: tuple[float, ...], plot: Path | None, as_json: bool
) -> None:
    """How far to trust the equivalent block of a structure, in each direction.

    Errors of its free rocking period, of its uplift acceleration, and of its overturning time under a constant
    acceleration, with kappa1 and kappa2, against the mechanism itself: exact integrals of its energy, no time steps.
    Positive: the block's value is too large.

    Without FILE it takes rocking.yaml of this folder, else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking error arch.yaml --at 0.3 --at 0.7 --accel 1.5 --plot error.png

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 24-25.
    """
    from rocking_cli.cli import structures
    from rocking_cli.errors import RockingError
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.linearisation import compare
    from rocking_cli.studies.trust import errors, trust

    keep_apart([("--plot", plot)], [file])
    structure = structures.prepared([file] if file else [])
    mechanism, equivalence = structure.mechanism, structure.equivalence
    try:
        curves, asked = compare(mechanism, equivalence, amplitudes, accelerations)
    except RockingError as error:
        raise type(error)(f"{mechanism.name}: {error}") from error
    verdict = trust(curves, asked)
    if plot is not None:
        _draw(plot, curves, asked, structures.label(mechanism))
    if as_json:
        terminal.print_json(
            {
                "mechanism": mechanism.mechanism,
                "name": mechanism.name,
                "symmetric": equivalence.symmetric,
                "directions": {each.direction.label: _as_json(each) for each in asked},
                "prefer": _preferred(asked),
                "grades": {f"kappa{kappa}": errors(asked, kappa).grade.key for kappa in (1, 2)},
                "verdict": verdict,
            }
        )
        return
    for each in asked:
        heading = structures.label(mechanism)
        terminal.table(
            heading if len(asked) == 1 else f"{heading}, {each.direction.label} direction",
            ["error of", "at", "kappa1", "kappa2"],
            _rows(each),
            numbers=(2, 3),
        )
    terminal.result(verdict)


def _draw(path: Path, curves: list[Linearisation], asked: list[Linearisation], title: str) -> None:
    from rocking_cli.plotting.linearisation import draw_linearisation

    write_picture(path, draw_linearisation(curves, asked, title))


def _rows(each: Linearisation) -> list[list[str]]:
    rows = [["uplift acceleration", "", _percent(each.uplift_ratio1), _percent(each.uplift_ratio2)]]
    rows += [
        ["free period", f"phi/phi_cr = {r:g}", _percent(ratio), _percent(ratio)]
        for r, ratio in zip(each.amplitude.tolist(), each.period_ratio.tolist(), strict=True)
    ]
    rows += [
        ["overturning time", f"a/lambda = {a:g}", _percent(one), _percent(two)]
        for a, one, two in zip(
            each.acceleration.tolist(), each.overturning_ratio1.tolist(), each.overturning_ratio2.tolist(), strict=True
        )
    ]
    return rows


def _percent(ratio: float) -> str:
    if ratio == float("inf"):
        return "no uplift"
    error = 100 * (ratio - 1)
    return f"{error:+.0f} %" if abs(error) >= 99.95 else f"{error:+.3g} %"


def _preferred(asked: list[Linearisation]) -> str | None:
    from rocking_cli.studies.trust import preferred

    return {None: None, 0: "either", 1: "kappa1", 2: "kappa2"}[preferred(asked)]


def _as_json(each: Linearisation) -> dict[str, Any]:
    def finite(value: float) -> float | None:
        return value if value < float("inf") else None

    return {
        "uplift_ratio": {"kappa1": each.uplift_ratio1, "kappa2": each.uplift_ratio2},
        "free_period": [
            {"amplitude": r, "period": T, "ratio": ratio}
            for r, T, ratio in zip(
                each.amplitude.tolist(), each.period.tolist(), each.period_ratio.tolist(), strict=True
            )
        ],
        "overturning_time": [
            {"acceleration": a, "time": t, "ratio": {"kappa1": finite(one), "kappa2": two}}
            for a, t, one, two in zip(
                each.acceleration.tolist(),
                each.overturning.tolist(),
                each.overturning_ratio1.tolist(),
                each.overturning_ratio2.tolist(),
                strict=True,
            )
        ],
    }
