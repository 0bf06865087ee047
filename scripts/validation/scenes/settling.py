"""A sphere of six cells settles from rest in a closed box, at a Reynolds number of about 0.04. SI units, dx = 1 mm."""

import math

from scene import arguments, leave
from yade import O, utils
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator

from yadelbm import LbmEngine

given = arguments()
tau, n, dx, nu = given["tau"], given["n"], 1e-3, 1e-5
box, d, fall = (16, 16, 24), 6 * dx, 1.5
stokes = 0.1 * nu / d
gravity = 18 * nu * stokes / d**2  # at twice the fluid's density
O.bodies.append(utils.sphere((0.5 * box[0] * dx, 0.5 * box[1] * dx, 16 * dx), d / 2, material=FrictMat(density=2000)))
fluid = LbmEngine(upper=[c * dx for c in box], dx=dx, density=1000, viscosity=1000 * nu, tau=tau, gravity=(0, 0, -gravity))
O.engines = [ForceResetter(), fluid, NewtonIntegrator(gravity=(0, 0, -gravity), damping=0)]
step = (tau - 0.5) * dx**2 / (3 * nu)
O.dt = step / n
heights, unit = [], 0.1 * fall * d / (0.35 * stokes)  # walls leave a good third of the velocity
for i in range(1, 11):
    O.run(max(1, math.ceil(i * unit / O.dt) - O.iter), True)
    state = O.bodies[0].state
    heights.append((state.pos[2] - state.vel[2] * (O.time - i * unit)) / d)  # the step does not end at the time: back along the velocity
    if i == 7:
        velocity = -state.vel[2] / stokes
leave({"heights": heights, "velocity": velocity, "mach": math.sqrt(3) * velocity * stokes * step / dx,
       "cells": math.prod(box), "steps": fluid.fluidSteps})
