"""A free sphere in a periodic cube of fluid at rest: released under a force, or given a velocity or a spin.

The force is weight, and a drive takes it up again, so that the whole stays at rest. dx = 1, density = 1, viscosity = 1.
"""

import math

from coupling import start
from scene import arguments, leave
from yade import O, Vector3, utils
from yade.wrapper import FrictMat

from yadelbm import LbmEngine

given = arguments()
motion, q, tau, n = given["motion"], given["q"], given["tau"], given["n"]  # n: grain steps per fluid step
radius, box = given["radius"], given["box"]
step = (tau - 0.5) / 3
unit = radius**2  # R^2 / nu
speed = 1e-4 / radius  # Re = 1e-4
force = 6 * math.pi * radius * speed if motion == "release" else 0
O.bodies.append(utils.sphere([0.5 * box + o for o in given["offset"]], radius, material=FrictMat(density=q)))
state = O.bodies[0].state
if motion == "velocity":
    state.vel = Vector3(0, 0, speed)
elif motion == "spin":
    state.angVel = Vector3(0, 0, speed / radius)
fluid = LbmEngine(lower=(0, 0, 0), upper=[box] * 3, dx=1, density=1, viscosity=1, tau=tau, boundary=["periodic"] * 6,
                  acceleration=(0, 0, -force / box**3), stopFile="")
O.dt = step / n
coupling = start(fluid, given["scheme"], (0, 0, force / state.mass))
z0 = state.pos[2]
scale = state.mass * speed


def bounded():
    return all(abs(row[2]) < 2 * speed and abs(row[3]) < 2 * speed / radius for row in coupling.history)


stable = True
try:
    O.run(n, True)
    before = fluid.totalMomentum() + state.mass * state.vel
    O.run(math.ceil(given["until"] * unit / O.dt) + n, True)
except RuntimeError:
    stable = False
stable = stable and bounded()
result = {"stable": stable, "cells": box**3, "steps": len(coupling.history)}
if stable:
    after = fluid.totalMomentum() + state.mass * state.vel
    result["drift"] = (after - before).norm() / scale
    column = {"release": 2, "velocity": 1, "spin": 3}[motion]
    scales = {"release": speed, "velocity": speed * unit, "spin": speed / radius}
    values = [(row[column] - (z0 if motion == "velocity" else 0)) / scales[motion] for row in coupling.history]
    found = []
    for time in given["times"]:
        part, i = math.modf(time * unit / step)
        found.append((1 - part) * values[int(i)] + part * values[int(i) + 1])
    result["found"] = found
leave(result)
