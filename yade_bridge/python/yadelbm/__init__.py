"""Resolved lattice-Boltzmann fluid for YADE: `from yadelbm import LbmEngine` in a script run by `yade`."""

try:
    import yade.wrapper
except ImportError as error:
    raise ImportError("yadelbm works inside YADE: run the script with `yade script.py`, not with python") from error

try:
    from ._yadelbm import FluidPlan, LbmEngine
except ImportError as error:
    if "undefined symbol" not in str(error) and "libyade" not in str(error):
        raise
    import yade.config

    raise ImportError(
        "yadelbm cannot be used with this YADE (version found: %s): its libraries do not have what yadelbm was built "
        "for: %s. Way out: build yadelbm again on this machine. YADE itself is not affected."
        % (yade.config.version, error)
    ) from error

__all__ = ["FluidPlan", "LbmEngine"]
