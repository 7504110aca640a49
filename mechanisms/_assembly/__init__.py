"""Limit analysis of an assembly of rigid blocks: its weakest mechanism, and up to which rotation this is valid.

Blocks touch along joints without tension. `contacts` finds the joints, `collapse` the multiplier and the velocities of
the weakest mechanism, `friction` the coefficient of friction that it requires, `linkage` its groups and hinges, and
`thrust` the line of thrust. `DisplacedAssembly` checks whether the joints still carry the forces once displaced.
"""

from mechanisms._assembly.blocks import AssemblyBlock as AssemblyBlock
from mechanisms._assembly.blocks import AssemblyContact as AssemblyContact
from mechanisms._assembly.blocks import AssemblyFault as AssemblyFault
from mechanisms._assembly.blocks import ContactFault as ContactFault
from mechanisms._assembly.blocks import DoesNotStand as DoesNotStand
from mechanisms._assembly.blocks import NoAnswer as NoAnswer
from mechanisms._assembly.blocks import NothingMoves as NothingMoves
from mechanisms._assembly.contacts import contacts as contacts
from mechanisms._assembly.displaced import SEARCH_STEPS as SEARCH_STEPS
from mechanisms._assembly.displaced import Admissible as Admissible
from mechanisms._assembly.displaced import DisplacedAssembly as DisplacedAssembly
from mechanisms._assembly.displaced import first_violation as first_violation
from mechanisms._assembly.displaced import remaining as remaining
from mechanisms._assembly.friction import MAX_FRICTION as MAX_FRICTION
from mechanisms._assembly.friction import Friction as Friction
from mechanisms._assembly.friction import friction as friction
from mechanisms._assembly.friction import sheared as sheared
from mechanisms._assembly.friction import with_usual as with_usual
from mechanisms._assembly.limit import Collapse as Collapse
from mechanisms._assembly.limit import Shared as Shared
from mechanisms._assembly.limit import collapse as collapse
from mechanisms._assembly.mechanism import AssemblyHinge as AssemblyHinge
from mechanisms._assembly.mechanism import AssemblyLinkage as AssemblyLinkage
from mechanisms._assembly.mechanism import Opening as Opening
from mechanisms._assembly.mechanism import Passage as Passage
from mechanisms._assembly.mechanism import Thrust as Thrust
from mechanisms._assembly.mechanism import leading as leading
from mechanisms._assembly.mechanism import linkage as linkage
from mechanisms._assembly.mechanism import thrust as thrust
from mechanisms._assembly.problem import Bearings as Bearings
