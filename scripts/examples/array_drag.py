"""Drag of the simple cubic array: a fixed sphere in a periodic cube, driven by a mean pressure gradient.

    scripts/yade -j2 -x -n scripts/examples/array_drag.py [--tau 0.6 1 2] [--fraction 0.125] [--cells 14]

K = F / (6 pi mu R U), with F = density * acceleration * volume of the cell and U the superficial velocity, is compared
with the exact value. It must not depend on tau.
"""

import argparse
import math
import os
import sys

from yade import O, utils
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator

from yadelbm import LbmEngine

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
import tools  # noqa: E402

DX = 1e-4                            # [m]
DENSITY, VISCOSITY = 1000.0, 1e-3    # water [kg/m3], [Pa s]
REYNOLDS = 1e-4                      # of the sphere, so that inertia plays no part
LONGEST = 400                        # looks at the mean velocity, at most


def reference_drag(fraction):
    """K of the table at this solid fraction, or None."""
    for row in tools.reference_rows("02_cubic_arrays_stokes.csv"):
        if row["lattice"] == "SC" and abs(float(row["c"]) - fraction) < 1e-6:
            return float(row["K"])
    return None


def measure(tau, fraction, cells, convergence):
    """K from a run to the steady state, the number of steps, and the force on the sphere over the applied one."""
    side = cells * DX
    volume, radius = side**3, side * (3 * fraction / (4 * math.pi)) ** (1 / 3)
    nu = VISCOSITY / DENSITY
    guess = reference_drag(fraction) or 1 / (1 - fraction ** (1 / 3)) ** 2
    speed = REYNOLDS * nu / (2 * radius)
    acceleration = 6 * math.pi * nu * radius * guess * speed / volume
    O.reset()
    O.periodic = True
    O.cell.setBox(side, side, side)
    O.dt = (tau - 0.5) / 3 * DX**2 / nu
    sphere = O.bodies.append(utils.sphere([side / 2] * 3, radius, fixed=True, material=FrictMat(density=DENSITY)))
    fluid = LbmEngine(lower=(0, 0, 0), upper=(side,) * 3, dx=DX, density=DENSITY, viscosity=VISCOSITY, tau=tau,
                      acceleration=(acceleration, 0, 0), boundary=["periodic"] * 6, label="fluid")
    O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]
    fluid.plan()
    viscous_time = side**2 / (4 * math.pi**2 * nu)
    # the pressure in the cells inside the sphere evens out, the more slowly the larger tau is; outside its trace is 1e-5
    inside = 45 * (tau - 0.5) * (radius / DX) ** 2
    chunk = math.ceil(max(50, viscous_time / O.dt, inside))
    before = 0.0
    for _ in range(LONGEST):
        O.run(chunk, True)
        mean = fluid.averageVelocity()[0]
        if not math.isfinite(mean):
            raise RuntimeError(f"tau = {tau}: the velocity is not finite after {O.iter} steps")
        if abs(mean - before) < convergence * abs(mean):
            force = DENSITY * acceleration * volume
            return force / (6 * math.pi * VISCOSITY * radius * mean), O.iter, fluid.fluidForce(sphere)[0] / force
        before = mean
    raise RuntimeError(f"tau = {tau}: not steady after {O.iter} steps")


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                 prog="scripts/yade scripts/examples/array_drag.py")
parser.add_argument("--tau", nargs="+", type=float, default=[0.51, 0.6, 1, 2, 5, 10], help="relaxation times")
parser.add_argument("--fraction", type=float, default=0.125, help="solid fraction (default: 0.125)")
parser.add_argument("--cells", type=int, default=14, help="cells along the cube (default: 14)")
parser.add_argument("--convergence", type=float, default=1e-9,
                    help="relative change of the mean velocity from look to look (default: 1e-9)")
options = parser.parse_args(sys.argv[1:])

exact = reference_drag(options.fraction)
print(f"simple cubic array, c = {options.fraction}, {options.cells} cells, exact K = {exact or math.nan:.7f}")
print("tau      K            error       steps   force on the sphere / applied")
drags = []
for tau in options.tau:
    drag, steps, ratio = measure(tau, options.fraction, options.cells, options.convergence)
    drags.append(drag)
    error = f"{100 * (drag / exact - 1):+8.4f} %" if exact else "       -  "
    print(f"{tau:<7g}  {drag:.9f}  {error}  {steps:6d}   {ratio:.10f}", flush=True)
print(f"spread over tau: {max(drags) / min(drags) - 1:.1e}")
