"""A sphere in a stream: drag coefficient, from a quarter of the flow. Units: dx = 1, density = 1, speed of the stream = 1."""

import math

import numpy as np
from scene import arguments, leave
from yade import O, utils
from yade.wrapper import ForceResetter, NewtonIntegrator, PyRunner

from yadelbm import LbmEngine

given = arguments()
reynolds, d, speed = given["reynolds"], given["d"], given["speed"]
width, before, behind = (round(given[key] * d) for key in ("half_width", "before", "behind"))
stream, still = (1, 0, 0), (0, 0, 0)
sphere = O.bodies.append(utils.sphere((before + given["shift"], 0, 0), d / 2, fixed=True))
fluid = LbmEngine(upper=(before + behind, width, width), dx=1, density=1, viscosity=d / reynolds, tau=0.5 + 3 * speed * d / reynolds,
                  initialVelocity=stream, boundary=["velocity", "pressure"] + ["freeSlip"] * 4, boundaryVelocity=[stream] + [still] * 5,
                  magicParameter=given["magic_parameter"] or math.nan, maxMach=0.5, lubrication=False)
O.dt = speed
drag = []
O.engines = [ForceResetter(), fluid, PyRunner(command="drag.append(fluid.fluidForce(sphere)[0])", iterPeriod=1), NewtonIntegrator(damping=0)]
O.run(round(given["duration"] * d / speed), True)
coefficients = 4 * np.array(drag) / (math.pi / 8 * d * d)
windows = np.array_split(coefficients, round(given["duration"] / 5))  # sound swings within, five diameters of the way each
leave({"Cd": float(windows[-1].mean()), "change": float(windows[-1].mean() / windows[-2].mean() - 1), "noise": float(windows[-1].std()),
       "history": [round(float(w.mean()), 5) for w in windows], "flux": fluid.getBoundaryFlux(1) / width**2,
       "cells": math.prod(fluid.cells), "steps": O.iter})
