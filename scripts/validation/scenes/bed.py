"""Permeability, over dx^2, of a fixed bed of eight spheres at a small Reynolds number. SI units, dx = 1 mm."""

import math

from scene import arguments, leave
from yade import O, utils
from yade.wrapper import ForceResetter, NewtonIntegrator

from yadelbm import LbmEngine

given = arguments()
tau, n, dx, nu, box = given["tau"], given["n"], 1e-3, 1e-5, 20
for i in range(8):
    centre = [box * dx * (0.25 + 0.5 * (i >> axis & 1) + 0.05 * math.sin(7 * i + 3 * axis)) for axis in range(3)]
    O.bodies.append(utils.sphere(centre, 4.5 * dx, fixed=True))
fluid = LbmEngine(upper=[box * dx] * 3, dx=dx, density=1000, viscosity=1000 * nu, tau=tau, boundary=["periodic"] * 6,
                  acceleration=(1e-4, 0, 0))
O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]
step = (tau - 0.5) * dx**2 / (3 * nu)
O.dt = step / n
fluid_steps = max(6 * (3 * dx) ** 2 / nu / step, 6400 * (tau - 0.5))  # viscous time, and that of the pressure inside the solids
O.run(math.ceil(fluid_steps * n), True)
leave({"permeability": fluid.permeability() / dx**2, "cells": box**3, "steps": fluid.fluidSteps})
