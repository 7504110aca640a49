"""What `rocking pulse` and `rk.pulse` are asked."""

from __future__ import annotations

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import BothWays, OfJoints, SizedPulse, StructureLike
from rocking_cli.ask.kinds import LOCAL_FILE, NUMBER, POSITIVE


class PulseAsked(SizedPulse, BothWays, OfJoints):
    """Compute the response of a structure, or of the dimensionless linear block, to a pulse.

    With a and omega, the response is that of the linear block. The closed form (Eqs. 41-42) is for one full sine and is
    valid only under three conditions. Each condition is checked, and the exact solution of the same equation is given
    for comparison. Rotations are divided by the critical rotation; times are tau = p t from uplift.

    With ag and period, the response is that of the structure in FILE, by its equivalent blocks with kappa1 and kappa2
    and by its nonlinear time history; polarity both gives one polarity after the other. Without FILE, the command uses
    rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking pulse --a 4 --omega 6 --restitution 0.9
      rocking pulse frame.yaml --ag 0.4g --period 0.8 --polarity both

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 40-42.
    """

    structure: StructureLike | None = option(
        "The structure, or its YAML file; without it, the dimensionless linear block.",
        where="input", on_terminal=LOCAL_FILE,
    )  # fmt: skip
    a: float | None = option("Dimensionless amplitude a = a_g/(g lambda), of the linear block.", POSITIVE)
    omega: float | None = option("Dimensionless frequency omega = omega_g/p, of the linear block.", POSITIVE)
    restitution: float = option("Coefficient of restitution of the linear block.", NUMBER, default=0.9, gt=0, le=1)
    idle = (
        Idle(
            "on the dimensionless block, which {a} and {omega} ask about",
            lambda asked: asked.on_block,
            ("ag", "period", "polarity", "opening"),
        ),
        Idle(
            "on the dimensionless block, which {a} and {omega} ask about: for a structure, give {ag} = a lambda g and "
            "{period} = 2 pi/(omega p), with lambda and p of `rocking equiv`",
            lambda asked: asked.on_block,
            ("structure",),
        ),
        Idle("on a structure, which has its own in its file", lambda asked: not asked.on_block, ("restitution",)),
    )

    @property
    def on_block(self) -> bool:
        """Whether the pulse is on the dimensionless block."""
        return self.a is not None or self.omega is not None
