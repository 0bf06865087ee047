"""A sphere of eight cells falls in a closed box, at a Reynolds number of about four: its trajectory. SI units, dx = 1 mm."""

from coupling import start
from scene import arguments, leave
from yade import O, utils
from yade.wrapper import FrictMat

from yadelbm import LbmEngine

given = arguments()
tau, n, dx, nu = given["tau"], given["n"], 1e-3, 1e-5
box, d = (24, 24, 48), 8 * dx
O.bodies.append(utils.sphere((0.5 * box[0] * dx, 0.5 * box[1] * dx, 36 * dx), d / 2, material=FrictMat(density=2000)))
fluid = LbmEngine(upper=[c * dx for c in box], dx=dx, density=1000, viscosity=1000 * nu, tau=tau, gravity=(0, 0, -0.02))
O.dt = (tau - 0.5) * dx**2 / (3 * nu) / n
coupling = start(fluid, given["scheme"], (0, 0, -0.02))
while O.bodies[0].state.pos[2] > d / 2 + 2 * dx and O.iter < 1500 * n:
    O.run(20 * n, True)
history = coupling.history[::5]
leave({"times": [row[0] for row in history], "heights": [row[1] / d for row in history], "peak": max(-row[2] for row in coupling.history),
       "reynolds": max(-row[2] for row in coupling.history) * d / nu, "cells": 24 * 24 * 48, "steps": len(coupling.history)})
