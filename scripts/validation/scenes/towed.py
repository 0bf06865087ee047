"""A sphere towed through a periodic cube of n cells, in Stokes flow: mean and noise of its load."""

import math

import numpy as np
from scene import arguments, leave
from yade import O, Vector3, utils
from yade.wrapper import ForceResetter, NewtonIntegrator, PyRunner

from yadelbm import LbmEngine

REYNOLDS = 0.2  # small: the flow in the lattice's frame is unsteady, and that is inertia, also without the quadratic terms
CELLS = 4       # along the path, while it is measured

given = arguments()
n, tau = given["n"], given["tau"]
radius = n * (3 * given["c"] / (4 * math.pi)) ** (1 / 3)
O.dt = (tau - 0.5) / 3  # dx = 1, density = 1, viscosity = 1
along = np.array(given["direction"], dtype=float)
along /= np.linalg.norm(along)
speed = REYNOLDS / (2 * radius)
force = 6 * math.pi * radius * given["K"] * speed  # what the drive has to make up for
fluid = LbmEngine(lower=(0, 0, 0), upper=(n,) * 3, dx=1, density=1, viscosity=1, tau=tau, inertia=False, scheme=given["scheme"],
                  acceleration=tuple(-force / n**3 * along), boundary=["periodic"] * 6, label="fluid")
ball = O.bodies.append(utils.sphere((0.5 * n + 0.1, 0.5 * n + 0.2, 0.5 * n + 0.3), radius))
O.bodies[ball].state.blockedDOFs = "xyzXYZ"
O.bodies[ball].state.vel = Vector3(*(speed * along))
O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]
settle = math.ceil(8 * n**3 / force * speed / O.dt / 100) * 100 + 500  # eight times the relaxation time of the mean flow
O.run(settle, True)
loads, velocities = [], []
steps = math.ceil(CELLS / (speed * O.dt))
every = max(1, steps // 1600)


def record():
    """What a step leaves: in the loop, since each O.run waits for up to 40 ms."""
    loads.append(list(fluid.fluidForce(ball)))
    velocities.append(list(fluid.averageVelocity()))


O.engines = [*O.engines, PyRunner(command="record()", iterPeriod=every)]
O.run(steps // every * every, True)
loads, mean = np.array(loads), np.mean(loads, axis=0)
relative = speed - float(np.mean(velocities, axis=0) @ along)
drag = -float(mean @ along)
leave({"K": drag / (6 * math.pi * radius * relative), "noise": float(np.sqrt(((loads - mean) ** 2).sum(1).mean()) / drag),
       "fluid_over_speed": 1 - relative / speed, "diameter": 2 * radius, "cells": n**3, "steps": O.iter})
