"""Verification by a code, in Python."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, SiteLike, StructureLike, motion_of, site_of, structure_of
from rocking_cli.errors import InputError
from rocking_cli.studies.verification.results import Verification

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def verify(
    structure: StructureLike,
    site: SiteLike,
    *,
    control: tuple[float, float] | tuple[float, float, str] | None = None,
    motions: Sequence[Motion] = (),
    polarities: Sequence[int] = (1,),
    state: str | None = None,
    on_floor: bool = False,
) -> Answer[Verification]:
    """Verify a rocking mechanism of masonry by a code, such as the Italian: NTC 2018 and Circolare 7/2019.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    site : mapping, str or Path
        Fields of a site file, or the file.
    control : tuple, optional
        Control point x, y [m], and the body it is on; by default the centroid of the moving weights.
    motions : sequence of GroundMotion, Pulse, str or Path
        Motions of the dynamic method: records that match the spectrum of the site, already scaled. An unknown outcome
        does not pass.
    polarities : sequence of int
        Polarities of the motions, of 1 and -1; with both, the worse governs.
    state : str, optional
        Limit state to which the motions belong, such as `"SLC"`; by default SLV. They are checked against it alone.
    on_floor : bool
        Whether the motions are those of the floor of the site; if not, ground motions are carried to it.

    Returns
    -------
    Answer of Verification
        `directions` holds the results of each direction, with `methods`, `states` and `workings`.

    Raises
    ------
    InputError
        If the site, the control point or a file cannot be used, or the structure has no capacity curve.
    MechanismError
        If the structure is not stable at rest.
    SolverError
        If a motion cannot be simulated to its end.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    >>> answer = rk.verify(rk.Block(width=0.6, height=8.0), site)
    >>> round(answer.directions[rk.Direction.POSITIVE].counts.a_g, 6)
    0.193382
    """
    from rocking_cli.studies.verification.check import verify, with_histories
    from rocking_cli.studies.verification.control import control_at
    from rocking_cli.studies.verification.motions import Histories
    from rocking_cli.views import verification as views

    wrong = [sign for sign in polarities if sign not in (1, -1)]
    if wrong or not polarities:
        raise InputError(f"polarities must be of 1 and -1, got {', '.join(map(str, wrong)) or 'none'}")
    ready, known = structure_of(structure), site_of(site)
    point = None
    if control is not None:
        x, y, *body = control
        point = control_at(ready.mechanism, x, y, body[0] if body else None)
    found = verify(ready, known, point)
    if motions:
        asked = Histories([motion_of(each) for each in motions], polarities, state, on_floor)
        found = with_histories(found, ready, known, asked)

    def draw() -> Figure:
        return views.showing(found).draw(found)

    view = views.view(found, known.site.name)
    return Answer("verification", found, view, lambda: views.table(found), draw)
