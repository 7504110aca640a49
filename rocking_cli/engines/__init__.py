"""Engines, which simulate time histories of structures: the exact one and those of other packages.

Examples
--------
>>> from rocking_cli import Block, parse_pulse
>>> from rocking_cli.engines import engine
>>> from rocking_cli.structure import Structure
>>> history = engine("exact").follow(Structure(Block(width=0.7, height=2.8)), parse_pulse("sine:0.3g:0.8s").sampled())
>>> history.words
'rocks'
"""

from rocking_cli.dynamics.history import History as History
from rocking_cli.dynamics.outcome import UNCHECKED as UNCHECKED
from rocking_cli.engines.base import Engine as Engine
from rocking_cli.engines.installed import default_models as default_models
from rocking_cli.engines.installed import engine as engine
from rocking_cli.engines.installed import engine_of as engine_of
from rocking_cli.engines.installed import respond as respond
from rocking_cli.excitation.base import GroundMotion as GroundMotion
from rocking_cli.structure import Structure as Structure
