"""A column of touching spheres between a closed base and a drained top: permeability, stiffness, consolidation under a load. Units: dx = 1, density = 1, fluid steps.

One stack of spheres of diameter d in a column of d x d cells that is periodic sideways: a simple cubic array. Springs of stiffness k between them give E_oed = k / d.
"""

import math

import numpy as np
from scene import arguments, leave
from yade import O, utils
from yade.wrapper import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
                          Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator)

from yadelbm import LbmEngine

given = arguments()
d, count, tau, modulus = (given[key] for key in ("d", "count", "tau", "modulus"))  # E_oed over the fluid's bulk modulus
nu = (tau - 0.5) / 3
bulk = 1 / 3
stiffness = modulus * bulk * d  # k
strain = 1e-3
load = strain * modulus * bulk * d**2  # on the top sphere: q d^2
height = count * d + d
O.dt = 1.0
# Normal stiffness of a contact: 2 E1 R1 E2 R2 / (E1 R1 + E2 R2), of two spheres young R; of a sphere and a hard wall twice as much: the lowest half of a sphere is as stiff as all others.
material = FrictMat(density=2.5, young=stiffness / (d / 2), poisson=0.3, frictionAngle=0)
O.materials.append(material)
O.bodies.append(utils.wall(0, axis=2, sense=1, material=FrictMat(young=1e6 * material.young, poisson=0.3, frictionAngle=0)))
shift = given["shift"]
overlap = load / stiffness  # the stack carries this load before
balls = [O.bodies.append(utils.sphere((d / 2 + shift[0], d / 2 + shift[1], d / 2 - overlap / 2 + i * (d - overlap)), d / 2, material=material)) for i in range(count)]
for b in balls:
    O.bodies[b].state.blockedDOFs = "xyXYZ"
fluid = LbmEngine(upper=(d, d, height), dx=1, density=1, viscosity=nu, tau=tau, inertia=False, lubrication=given["films"],
                  boundary=["periodic"] * 4 + ["noSlip" if given["kind"] == "load" else "pressure", "pressure"])
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
             fluid, NewtonIntegrator(damping=0)]
top, corner = O.bodies[balls[-1]], (shift[0] % d, shift[1] % d)
O.forces.setPermF(balls[-1], (0, 0, -load))


def pressure(z):
    """In the pore between four stacks."""
    return fluid.getPorePressure((*corner, z))


if given["kind"] == "dry":
    O.engines = [e for e in O.engines if e is not fluid]
    O.engines[-1].damping = 0.7
    start = top.state.pos[2]
    O.forces.setPermF(balls[-1], (0, 0, -2 * load))
    O.run(given["steps"], True)
    leave({"modulus": load * (count - 0.5) / d / (start - top.state.pos[2]) / bulk, "cells": 0, "steps": 0})
elif given["kind"] == "flow":
    # Seepage down through the stack, which it presses together by a tenth of the load.
    drop = 0.1 * load / d**2
    fluid.boundaryPressure = [0] * 5 + [drop]
    found, before = 0.0, 1.0
    while abs(found - before) > 1e-5 * abs(found):
        O.run(given["steps"], True)
        low, high = d * (count // 4), d * (3 * count // 4)
        before, found = found, -fluid.getBoundaryFlux(5) / d**2 * nu * (high - low) / (pressure(high) - pressure(low))
    leave({"permeability": found, "cells": d * d * height, "steps": fluid.fluidSteps})
else:
    # The load rises smoothly within two periods of the column's lowest sound, which then does not ring; time counts from the middle of the rise.
    porosity = 1 - math.pi / 6
    period = 4 * count * d * math.sqrt((porosity + 2.5 * (1 - porosity)) / (bulk * (1 + modulus)))
    start = top.state.pos[2]
    for i in range(100):
        O.forces.setPermF(balls[-1], (0, 0, -load * (1 + math.sin(0.5 * math.pi * (i + 0.5) / 100) ** 2)))
        O.run(round(period / 50), True)
    times, settlement, base, profiles = [], [], [], []  # of the surface, half a sphere above the centre of the top one, which bears the load alone from the start
    for time in given["times"]:
        O.run(max(1, round(time + period) - O.iter), True)
        times.append(O.iter - 50 * round(period / 50))
        settlement.append(((start - top.state.pos[2]) * stiffness / load + 0.5) / count)
        base.append(pressure(d) * d**2 / load)
        profiles.append([pressure(d * i) * d**2 / load for i in range(count + 1)])
    leave({"times": times, "settlement": settlement, "base": base, "profiles": profiles, "period": period, "cells": d * d * height, "steps": fluid.fluidSteps})
