"""What a pressure step puts into a closed box with a fixed array of spheres: the volume that stores fluid. Units: dx = 1, density = 1, fluid steps."""

import math

from scene import arguments, leave
from yade import O, utils
from yade.wrapper import ForceResetter, NewtonIntegrator

from yadelbm import LbmEngine

given = arguments()
d, n, layers, tau = given["d"], given["n"], given["layers"], given["tau"]
nu, height = (tau - 0.5) / 3, layers * n
for i in range(layers):
    O.bodies.append(utils.sphere((n / 2 + 0.2, n / 2 + 0.3, (i + 0.5) * n), d / 2, fixed=True))
rise = 1e-3 / 3  # of the pressure, a thousandth of the bulk modulus
fluid = LbmEngine(upper=(n, n, height), dx=1, density=1, viscosity=nu, tau=tau, inertia=False, boundary=["periodic"] * 4 + ["noSlip", "pressure"], boundaryPressure=[0] * 6)
O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]
O.dt = 1.0
O.run(1, True)
mass, ramp = fluid.totalMass(), given["ramp"]
for i in range(ramp):
    fluid.boundaryPressure = [0] * 5 + [rise * (i + 1) / ramp]
    O.run(1, True)
stored = []
for time in given["times"]:
    O.run(max(1, round(time + ramp / 2) - O.iter + 1), True)
    stored.append((fluid.totalMass() / mass - 1) / (3 * rise))
leave({"stored": stored, "porosity": 1 - layers * math.pi / 6 * d**3 / (n * n * height), "cells": n * n * height, "steps": fluid.fluidSteps})
