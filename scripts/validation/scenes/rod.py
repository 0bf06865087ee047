"""A free dumb-bell of two touching spheres, a clump, turns in the shear between two plates. Units: dx = 1, density = 1, viscosity = 1."""

import math

import numpy as np
from scene import arguments, leave
from yade import O, Vector3, utils
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator, PyRunner

from yadelbm import LbmEngine

given = arguments()
n, a, tau, strain = given["n"], given["radius"], given["tau"], given["strain"]
gamma = given["reynolds"] / a**2
O.dt = (tau - 0.5) / 3
O.materials.append(FrictMat(density=1))
middle = (0.5 * n + 0.2, 0.5 * n + 0.4, 0.5 * n)
_, members = O.bodies.appendClumped([utils.sphere((middle[0], middle[1], middle[2] + sign * a), a) for sign in (1, -1)])
speed, still = gamma * n / 2, (0, 0, 0)
fluid = LbmEngine(upper=(n, n, n), dx=1, density=1, viscosity=1, tau=tau, inertia=False, boundary=["periodic"] * 4 + ["noSlip"] * 2,
                  boundaryVelocity=[still] * 4 + [(-speed, 0, 0), (speed, 0, 0)])
angles = []


def record():
    """The angle from the gradient towards the flow [rad]."""
    along = O.bodies[members[0]].state.pos - O.bodies[members[1]].state.pos
    angles.append(math.atan2(along[0], along[2]))


O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0), PyRunner(command="record()", iterPeriod=20)]
O.run(math.ceil(strain / gamma / O.dt), True)
turned = np.unwrap(angles)
strains = 20 * gamma * O.dt * (1 + np.arange(len(turned)))
# strains at which it lies along the flow
aligned = [float(np.interp(angle, turned, strains)) for angle in math.pi / 2 + math.pi * np.arange(8) if turned[0] <= angle <= turned[-1]]
state = O.bodies[members[0]].state.pos + O.bodies[members[1]].state.pos
leave({"aligned": aligned, "angles": [round(float(t), 4) for t in turned[:: max(1, len(turned) // 100)]], "drift": float((Vector3(*middle) - 0.5 * state).norm() / a),
       "cells": n**3, "steps": O.iter})
