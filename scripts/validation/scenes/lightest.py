"""The smallest density ratio from which on all that were tried are stable: a light sphere is released in a periodic cube."""

import math

from coupling import start
from scene import arguments, leave
from yade import O, utils
from yade.wrapper import FrictMat

from yadelbm import LbmEngine

given = arguments()
radius, box, steps, tau = 4.5, 20, given["steps"], given["tau"]
speed = 1e-4 / radius
force = 6 * math.pi * radius * speed


def is_stable(q):
    """Whether it ends below twice its Stokes velocity. Before, it may go beyond: a light sphere takes up its load over several steps."""
    O.reset()
    O.bodies.append(utils.sphere([0.5 * box + 0.2] * 3, radius, material=FrictMat(density=q)))
    fluid = LbmEngine(lower=(0, 0, 0), upper=[box] * 3, dx=1, density=1, viscosity=1, tau=tau, boundary=["periodic"] * 6,
                      acceleration=(0, 0, -force / box**3), stopFile="")
    O.dt = (tau - 0.5) / 3
    coupling = start(fluid, given["scheme"], (0, 0, force / O.bodies[0].state.mass))
    try:
        O.run(steps, True)
    except RuntimeError:
        return False
    return all(abs(row[2]) < 2 * speed for row in coupling.history[2 * steps // 3:])


smallest, done = None, 0
for ratio in given["ratios"]:
    done += 1
    if not is_stable(ratio):
        break
    smallest = ratio
leave({"smallest": smallest, "cells": box**3, "steps": steps * done})
