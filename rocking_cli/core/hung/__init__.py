"""What is attached to a mechanism: loads, ties and crossing walls; and the crushing of its pivots."""

from rocking_cli.core.hung.element import Element as Element
from rocking_cli.core.hung.element import Stretched as Stretched
from rocking_cli.core.hung.ties import Tie as Tie
