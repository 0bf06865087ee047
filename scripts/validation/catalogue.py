"""All cases, in the order of the report."""

from .arrays import ARRAYS
from .channels import CHANNELS
from .tau import TAU

CASES = [CHANNELS, ARRAYS, TAU]
