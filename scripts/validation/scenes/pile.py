"""Five grains lie down on the floor between walls, in undamped contacts that ring with omega dt = 0.7: the motion that is left. SI units."""

import math

from scene import arguments, leave
from yade import O, utils
from yade.wrapper import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom,
                          InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack,
                          NewtonIntegrator)

from yadelbm import LbmEngine

given = arguments()
tau, n, dx, nu = given["tau"], given["n"], 1e-3, 1e-5
box, d, ratio = (16, 16, 22), 8 * dx, 2.5
gravity = 0.005 if tau < 2 else 0.002  # tau = 2: so that the weight compresses the fluid by 12 %, not by 29
mass = ratio * 1000 * math.pi / 6 * d**3
step = (tau - 0.5) * dx**2 / (3 * nu)
material = FrictMat(density=ratio * 1000, young=mass * (0.7 / step) ** 2 / 2 / (d / 2), poisson=0.3, frictionAngle=0.4)
O.materials.append(material)
for x in (4, 12):  # between the walls, so that none can roll
    for y in (4, 12):
        O.bodies.append(utils.sphere((x * dx, y * dx, 4.05 * dx), d / 2, material=material))
O.bodies.append(utils.sphere((8 * dx, 8 * dx, 10 * dx), d / 2, material=material))
for axis in range(3):
    O.bodies.append(utils.wall(0, axis=axis, sense=1, material=material))
    O.bodies.append(utils.wall(box[axis] * dx, axis=axis, sense=-1, material=material))
fluid = LbmEngine(upper=[c * dx for c in box], dx=dx, density=1000, viscosity=1000 * nu, tau=tau, gravity=(0, 0, -gravity))
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                             [Law2_ScGeom_FrictPhys_CundallStrack()]),
             fluid, NewtonIntegrator(gravity=(0, 0, -gravity), damping=0)]
O.dt = step / n
stokes = (ratio - 1) * gravity * d**2 / (18 * nu)  # of a lone grain
grains = [O.bodies[i] for i in range(5)]
speeds, end = [], 0.075 / gravity  # [s]
while O.time < end:
    O.run(10 * n, True)
    speeds.append((O.time, max(b.state.vel.norm() for b in grains) / stokes))
leave({"peak": max(v for _, v in speeds), "halfway": max(v for t, v in speeds if 0.45 * end < t < 0.5 * end),
       "left": max(v for t, v in speeds if t > 0.95 * end), "cells": math.prod(box), "steps": fluid.fluidSteps})
