"""Structures that do not name their contacts, so that all of their equation of motion can be tested."""

from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame


class UncheckedArch(Arch):
    """An arch whose joints are not checked: it moves as any other, and its histories are known to their end."""

    def contacts(self, direction):
        return None


class UncheckedFrame(AsymmetricFrame):
    """A frame whose joints are not checked."""

    def contacts(self, direction):
        return None
