"""What is attached to a mechanism: loads and ties, crossing walls, and pivots that crush under them."""

from rocking_cli.core.hung.element import Element as Element
from rocking_cli.core.hung.element import Stretched as Stretched
from rocking_cli.core.hung.ties import Tie as Tie
