"""Clauses of the code that have the formulas: [C8.7.1.3] is a formula, §C8.7.1.2.1.7 a section.

References with C are to Circolare 7/2019, the others to NTC 2018. Formulas of a transcribed clause were checked against
a transcription of the text, not yet against the printed text.
"""

from __future__ import annotations

from rocking_cli.verification.results import Clause


def _held(place: str) -> Clause:
    return Clause(place, transcribed=True)


# Kinematic chain and capacity curve
ALPHA0, A_STAR, D, E_STAR = (_held(f"[C8.7.1.{k}]") for k in (1, 3, 4, 5))
ELASTIC = Clause("[C8.7.1.6]")
OWN_PERIOD, DAMAGE, DAMAGE_VIBRATING = (_held(f"[C8.7.1.{k}]") for k in (7, 8, 9))
T_SLV, T_SLC, FLOOR_DISPLACEMENT = (_held(f"[C8.7.1.{k}]") for k in (10, 11, 12))
MODE = Clause("§C8.7.1.2.1.4")
LIMITS, LINEAR, NONLINEAR, DYNAMIC = (_held(f"§C8.7.1.2.1.{k}") for k in (6, 7, 8, 9))
LINE = Clause("§C8.7.1.2.1.6")
ZETA = Clause("§8.3")
# Spectra of a floor
FLOOR_BOUND, FLOOR_SPECTRUM, FLOOR_PEAK, GAMMA = (_held(f"[C7.2.{k}]") for k in (5, 6, 7, 10))
PSI = Clause("§C7.2.3")
AMPLIFICATION = _held("[C7.2.6], [C7.2.9]")
# Hazard and spectra of the ground
REFERENCE_LIFE, MIN_REFERENCE_LIFE = Clause("§2.4.3"), Clause("§C2.4.3")
HAZARD, SOIL = Clause("§3.2, DM 14/01/2008 All. A"), Clause("§3.2.3")
S = Clause("[3.2.3]")
RETURN_PERIOD, SPECTRUM, DAMPING, TC, TB, TD = (_held(f"[3.2.{k}]") for k in (0, 2, 4, 5, 6, 7))
DISPLACEMENT, DISPLACEMENT_LONG, DISPLACEMENT_GROUND = (_held(f"[3.2.{k}]") for k in (10, 11, 12))
ANCHORED = Clause("not in the code")
OUTSIDE = Clause("not in this edition")
