"""Pure mechanics: where the bodies of a mechanism are, and what follows from it."""

from rocking_cli.core.bodies import Body as Body
from rocking_cli.core.bodies import annular_sector as annular_sector
from rocking_cli.core.bodies import box as box
from rocking_cli.core.bodies import polygon as polygon
from rocking_cli.core.coefficients import Coefficients as Coefficients
from rocking_cli.core.equivalence import Equivalence as Equivalence
from rocking_cli.core.equivalence import EquivalentBlock as EquivalentBlock
from rocking_cli.core.equivalence import equivalent_block as equivalent_block
from rocking_cli.core.kinematics import Direction as Direction
from rocking_cli.core.kinematics import Reals as Reals
from rocking_cli.core.kinematics import RigidMotion as RigidMotion
from rocking_cli.core.kinematics import four_bar as four_bar
from rocking_cli.core.kinematics import four_bar_limit as four_bar_limit
from rocking_cli.core.kinematics import rotation as rotation
from rocking_cli.core.mechanism import Mechanism as Mechanism
from rocking_cli.core.mechanism import geometry_error as geometry_error
from rocking_cli.core.mechanism import length as length
from rocking_cli.core.mechanism import quantity as quantity
from rocking_cli.core.sketch import Angle as Angle
from rocking_cli.core.sketch import Hinge as Hinge
from rocking_cli.core.sketch import Length as Length
from rocking_cli.core.sketch import Line as Line
from rocking_cli.core.sketch import Outline as Outline
from rocking_cli.core.sketch import Sketch as Sketch
from rocking_cli.core.sketch import disc as disc
from rocking_cli.core.sketch import rectangle as rectangle
