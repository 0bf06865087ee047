"""All cases, in the order of the report."""

from .arrays import ARRAYS
from .channels import CHANNELS
from .packs import PACKS
from .schemes import STUDY
from .spheres import COUETTE_CASE, STREAM, TORQUE, TOWED, WALLS_CASE
from .suspensions import SUSPENSIONS
from .tau import TAU

CASES = [CHANNELS, ARRAYS, TAU, STUDY, WALLS_CASE, TORQUE, TOWED, COUETTE_CASE, STREAM, PACKS, SUSPENSIONS]
