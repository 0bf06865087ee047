"""A bed of free grains over a permeable floor, in a flow upwards that is raised and lowered by stages. Units: cells, fluid steps, density of the fluid."""

import math
import random

import numpy as np
from scene import arguments, leave
from yade import O, Vector3, utils
from yade.wrapper import (Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys,
                          Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator)

from yadelbm import LbmEngine

given = arguments()
d, columns, layers, tau, archimedes, ratio = (given[key] for key in ("d", "columns", "layers", "tau", "archimedes", "ratio"))
nu = (tau - 0.5) / 3
side = columns * 5 * d // 4  # grains fall from a grid that is wider than they are by a quarter
area = side**2
volume = math.pi / 6 * d**3
gravity = archimedes * nu**2 / d**3 / (ratio - 1)
count = columns**2 * layers
weight = count * volume * (ratio - 1) * gravity  # in the fluid
bottom = d + 4  # of the bed
height = bottom + math.ceil(1.5 * count * volume / 0.58 / area) + d
substeps = 4
O.dt = 1 / substeps
material = FrictMat(density=ratio, young=2 * ratio * volume * 0.5**2 / d, poisson=0.3, frictionAngle=given["friction"])  # omega dt = 0.5 for the fluid's step
O.materials.append(material)
O.periodic = True
O.cell.setBox(side, side, height + 2 * d * layers)
random.seed(given["seed"])
balls = []
for layer in range(layers):
    for i in range(columns):
        for j in range(columns):
            at = [(k + 0.5) * 1.25 * d + 0.11 * d * random.uniform(-1, 1) for k in (i, j)]
            balls.append(O.bodies.append(utils.sphere((*at, bottom + (layer + 0.6) * 1.25 * d), d / 2)))
# The floor, a layer of small fixed spheres: it carries the grains and lets the flow through.
beads = round(side / (0.625 * d))
FLOOR = [O.bodies.append(utils.sphere(((i + 0.5) * side / beads, (j + 0.5) * side / beads, bottom - d / 4), d / 4, fixed=True)) for i in range(beads) for j in range(beads)]


def contacts():
    return [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
            InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])]


O.engines = contacts() + [NewtonIntegrator(gravity=(0, 0, -3 * gravity), damping=0.4)]  # dry
fall = math.sqrt(2 * 1.25 * d * layers / (3 * gravity))
O.run(math.ceil(8 * fall / O.dt), True)
grains = [O.bodies[b] for b in balls]
dry_speed = max(g.state.vel.norm() for g in grains)
for g in grains:
    g.state.vel = g.state.angVel = Vector3.Zero


def floor_force():
    """What the floor carries of the grains, by its contacts."""
    up = 0.0
    for contact in O.interactions:
        if contact.isReal and (contact.id1 in FLOOR or contact.id2 in FLOOR):
            up += (contact.phys.normalForce[2] + contact.phys.shearForce[2]) * (1 if contact.id1 in FLOOR else -1)  # on the second body
    return up


def bed_drop():
    """Times the area: pressure drop, less what the floor itself resists."""
    return -fluid.getBoundaryForce(4)[2] - fluid.getBoundaryForce(5)[2] - sum(fluid.fluidForce(b)[2] + volume / 8 * fluid.gravity[2] for b in FLOOR)


def porosity():
    """Of the middle of the bed, between a quarter and three quarters of the grains."""
    heights = sorted(g.state.pos[2] for g in grains)
    low, high = (round(heights[count * i // 4] / fluid.dx) for i in (1, 3))
    return 1 - float(fluid.solidFraction[low:high].mean())


still = (0, 0, 0)
fluid = LbmEngine(upper=(side, side, height), dx=1, density=1, viscosity=nu, tau=tau, gravity=(0, 0, -gravity), ids=balls + FLOOR,
                  boundary=["periodic"] * 4 + ["velocity", "pressure"])
O.engines = contacts() + [fluid, NewtonIntegrator(gravity=(0, 0, -gravity), damping=0)]


speed, stages = 0.0, []
for target, steps in given["stages"]:
    ramp = min(1000, steps // 4)
    for k in range(1, 51):
        fluid.boundaryVelocity = [still] * 4 + [(0, 0, speed + (target - speed) * k / 50), still]
        O.run(ramp // 50 * substeps, True)
    speed = target
    O.run((steps - ramp) // 2 * substeps, True)
    drops, floors, mean = [], [], []
    for _ in range((steps - ramp) // 2 // 20):
        O.run(20 * substeps, True)
        drops.append(bed_drop() / weight)
        floors.append(floor_force() / weight)
        mean.append(np.mean([g.state.pos[2] for g in grains]))
    blocks = [block.mean() for block in np.array_split(np.array(drops), 5)]
    stages.append({"speed": target, "drop": float(np.mean(drops)), "error": float(np.std(blocks, ddof=1) / math.sqrt(5)), "noise": float(np.std(drops)), "floor": float(np.mean(floors)),
                   "porosity": porosity(), "middle": float(np.mean(mean) - bottom) / d, "rise": float(mean[-1] - mean[0]) / d,
                   "rms": float(np.sqrt(np.mean([g.state.vel.squaredNorm() for g in grains])))})
leave({"stages": stages, "count": count, "side": side, "height": height, "nu": nu, "dry_speed": dry_speed, "compression": 3 * weight / area,
       "cells": side * side * height, "steps": fluid.fluidSteps})
