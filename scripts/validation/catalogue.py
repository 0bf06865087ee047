"""All cases, in the order of the report."""

from .arrays import ARRAYS
from .channels import CHANNELS
from .consolidation import CONSOLIDATION, SKEMPTON
from .dumb_bell import DUMB_BELL
from .fluidisation import FLUIDISATION
from .free import FREE
from .lubrication import LUBRICATION
from .packs import PACKS
from .rod import ROD
from .schemes import STUDY
from .schemes_geometry import GEOMETRY
from .spheres import COUETTE_CASE, TORQUE, TOWED, WALLS_CASE
from .streams import STREAM
from .suspensions import SUSPENSIONS
from .tau import TAU
from .ten_cate import TEN_CATE
from .time_coupling import TIME_COUPLING
from .time_steps import TIME_STEPS

CASES = [CHANNELS, ARRAYS, TAU, STUDY, GEOMETRY, WALLS_CASE, TORQUE, TOWED, DUMB_BELL, ROD, LUBRICATION, FREE, TEN_CATE, COUETTE_CASE, STREAM, TIME_COUPLING, TIME_STEPS,
         PACKS, SUSPENSIONS, SKEMPTON, CONSOLIDATION, FLUIDISATION]
