"""Claims about the bridge, checked inside YADE. A test is a script of functions named after what they claim."""

import math
import os
import sys

REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference")  # before yade brings its own __file__

from yade import *
from yade.utils import sphere

FLUID = dict(density=1000, viscosity=1e-2, dx=1e-3)
PERIODIC = ["periodic"] * 6


def check(condition, message):
    if not condition:
        raise AssertionError(message)


def check_close(found, expected, tolerance, message=""):
    """Fails on NaN."""
    if not abs(found - expected) <= tolerance:
        raise AssertionError("%s: found %.17g, expected %.17g, tolerance %g" % (message, found, expected, tolerance))


def check_raises(kind, text, function):
    """`function` raises this kind with this text, and its message stands alone."""
    try:
        function()
    except Exception as error:
        check(isinstance(error, kind), "raised %r instead of %s" % (error, kind.__name__))
        check(text in str(error), "message %r does not say %r" % (str(error), text))
        return str(error)
    raise AssertionError("nothing raised; expected %s: %s" % (kind.__name__, text))


def fluid_step(tau, density=FLUID["density"], viscosity=FLUID["viscosity"], dx=FLUID["dx"]):
    return (tau - 0.5) * dx * dx * density / (3 * viscosity)


def engines(fluid, gravity=(0, 0, 0)):
    return [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]
        ),
        fluid,
        NewtonIntegrator(gravity=gravity, damping=0),
    ]


def box(lengths, **more):
    """An LbmEngine in a box of so many cells from the origin."""
    from yadelbm import LbmEngine

    values = dict(FLUID, upper=[n * FLUID["dx"] for n in lengths], label="fluid")
    values.update(more)
    return LbmEngine(**values)


def one_sphere(lengths=(12, 12, 12), radius=4e-3, fixed=True, **more):
    """A scene of one sphere in the middle of a box of fluid."""
    O.bodies.append(sphere([0.5 * n * FLUID["dx"] for n in lengths], radius, fixed=fixed))
    fluid = box(lengths, **more)
    O.engines = engines(fluid)
    O.dt = 1e-4
    return fluid


def prove(*claims):
    """Each claim in a scene of its own; the process ends with how it went."""
    failed = 0
    for claim in claims:
        O.reset()
        try:
            claim()
            print("holds:", claim.__name__, flush=True)
        except Exception:
            import traceback

            traceback.print_exc()
            print("FAILS:", claim.__name__, flush=True)
            failed += 1
    print("claims: %d hold, %d fail" % (len(claims) - failed, failed), flush=True)
    sys.exit(1 if failed else 0)
