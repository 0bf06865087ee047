"""A sphere lies down on the floor in an undamped contact that rings with the frequency omega: the motion that is left. SI units."""

import math

from coupling import start
from scene import arguments, leave
from yade import O, utils
from yade.wrapper import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, FrictMat, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
                          Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack)

from yadelbm import LbmEngine

given = arguments()
tau, omega_step, dx, nu = 0.7, given["omega_step"], 1e-3, 1e-5
box, d, ratio, gravity = 20, 8 * dx, 2.5, 0.02
step = (tau - 0.5) * dx**2 / (3 * nu)
mass = ratio * 1000 * math.pi / 6 * d**3
stiffness = mass * (omega_step / step) ** 2
material = FrictMat(density=ratio * 1000, young=2 * stiffness / d, poisson=0.3, frictionAngle=0)
O.materials.append(material)
O.bodies.append(utils.sphere((0.5 * box * dx, 0.5 * box * dx, d / 2 + dx), d / 2, material=material))
O.bodies.append(utils.wall(0, axis=2, material=material))
fluid = LbmEngine(upper=[box * dx] * 3, dx=dx, density=1000, viscosity=1000 * nu, tau=tau, gravity=(0, 0, -gravity),
                  lubrication=given["lubrication"])
n = max(1, math.ceil(omega_step / 0.1))
O.dt = step / n
coupling = start(fluid, given["scheme"], (0, 0, -gravity),
                 [InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
                  InteractionLoop([Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])])
O.run(1500 * n, True)
speeds = [abs(row[2]) for row in coupling.history]
found = [i.phys.kn for i in O.interactions if i.isReal]
assert all(math.isclose(kn, stiffness) for kn in found), (found, stiffness)
leave({"n": n, "left": max(speeds[-100:]) / max(speeds),
       "halfway": max(speeds[700:800]) / max(speeds), "cells": box**3, "steps": 1500})
