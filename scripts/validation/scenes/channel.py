"""A channel of 4 by 4 by n cells between z faces, from rest: profiles at given times, or the amplitude of an oscillation."""

import builtins
import math

from scene import arguments, leave
from yade import O, utils
from yade.wrapper import ForceResetter, NewtonIntegrator, PyRunner

from yadelbm import LbmEngine

given = arguments()
n, tau, kind = given["n"], given["tau"], given["kind"]
O.dt = (tau - 0.5) / 3  # dx = 1, density = 1, viscosity = 1
SPEED = 0.01 / O.dt     # Mach 0.017
velocity = [(0, 0, 0)] * 6
drive = (0, 0, 0)
if kind == "couette":
    velocity[5] = (SPEED, 0, 0)
elif kind == "poiseuille":
    drive = (8 * SPEED / n**2, 0, 0)
fluid = LbmEngine(lower=(0, 0, 0), upper=(4, 4, n), dx=1, density=1, viscosity=1, tau=tau, inertia=False, acceleration=drive,
                  boundary=["periodic"] * 4 + ["noSlip"] * 2, boundaryVelocity=velocity, label="fluid")
O.bodies.append(utils.sphere((2, 2, 2 * n), 2, fixed=True))  # outside: LbmEngine wants to see a body
O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]


def profile():
    return fluid.velocity[:, 0, 0, 0] / SPEED


def start_up():
    """Profiles at the dimensionless times, linear between two steps."""
    profiles = []
    for time in given["times"]:
        part, step = math.modf(time * n**2 / O.dt)
        O.run(int(step) - O.iter, True)
        before = profile()
        O.run(1, True)
        profiles.append(list((1 - part) * before + part * profile()))
    return {"profiles": profiles}


def oscillation():
    """Complex amplitude in the last period, by projection."""
    omega = (given["alpha"] / n) ** 2
    steps = round(2 * math.pi / omega / O.dt)
    omega = 2 * math.pi / (steps * O.dt)

    def move():
        # the wall's velocity belongs to the middle of the step that is about to be done
        fluid.boundaryVelocity = [(0, 0, 0)] * 4 + [(SPEED * math.cos(omega * (O.time + O.dt / 2)), 0, 0), (0, 0, 0)]

    builtins.move = move
    O.engines = [PyRunner(command="move()", iterPeriod=1, initRun=True)] + O.engines
    O.run((given["periods"] - 1) * steps, True)
    amplitude = 0

    def project():
        nonlocal amplitude
        time = O.time + O.dt  # at the end of this step
        amplitude = amplitude + 2 / steps * profile() * complex(math.cos(omega * time), -math.sin(omega * time))

    builtins.project = project
    O.engines = O.engines + [PyRunner(command="project()", iterPeriod=1, initRun=True)]
    O.run(steps, True)
    return {"real": list(amplitude.real), "imaginary": list(amplitude.imag), "alpha_used": n * math.sqrt(omega)}


result = oscillation() if kind == "oscillating" else start_up()
leave({**result, "cells": 16 * n, "steps": O.iter})
