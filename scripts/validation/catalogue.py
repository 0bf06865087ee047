"""All cases, in the order of the report."""

from .arrays import ARRAYS

CASES = [ARRAYS]
