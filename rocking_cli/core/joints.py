"""Where the bodies of a mechanism bear on one another and on the ground, and on which face."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.core.sketch import Hinge


@dataclass(frozen=True)
class Joint(Hinge):
    """A hinge at which a corner bears on a face, or a guide that holds a point sideways.

    Parameters
    ----------
    letter : str
        What it is called.
    point : complex
        Where it is at rest [m].
    bodies : tuple of str
        The two bodies it joins, the one that bears the other first; or the one that the ground bears.
    slide : complex
        Of a guide: the direction in which it lets its point move. It has no face, and there is nothing to check.
    normal : complex
        The normal of the face at rest, as it pushes the last of `bodies`: up where something stands on it.
    face : str, optional
        The body that the face turns with; None: it stays as it is, such as the ground.
    level : bool
        Whether it stands for several alike, at places not known, which keep level what they bear: forces here are sums
        over all of them, and what would turn the last of `bodies` is shared out among them.
    """

    normal: complex = 1j
    face: str | None = None
    level: bool = False

    @property
    def is_guide(self) -> bool:
        """Whether it only holds a point sideways."""
        return self.slide != 0
