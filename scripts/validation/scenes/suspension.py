"""Many free spheres: settling in a periodic cube, or sheared between two plates. Units: dx = 1, density = 1, viscosity = 1."""

import math

import __main__
import numpy as np
from scene import arguments, leave
from yade import O, Vector3, utils
from yade.wrapper import (Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack,
                          NewtonIntegrator, PyRunner)

from yadelbm import LbmEngine

given = arguments()
n, a, tau, kind = given["n"], given["radius"], given["tau"], given["kind"]
height = given.get("height", n)  # of the gap
O.dt = (tau - 0.5) / 3
settling = kind == "settling"
ratio = 2.5 if settling else 1.0
c = len(given["centres"]) * 4 / 3 * math.pi * a**3 / (n * n * height)
if settling:
    terminal = given["reynolds"] / (2 * a)
    weight = 4.5 * terminal / a**2 / (ratio - 1)  # gravity that gives a single sphere this velocity in Stokes flow
    unit, push = a / terminal, 6 * math.pi * a * terminal
else:
    gamma = given["reynolds"] / a**2
    weight, unit, push = 0.0, 1 / gamma, 6 * math.pi * a**2 * gamma
BALLS, BEADS = 1, 2  # masks
# Contacts that give in by this part of a radius under the typical force. What a film at the roughness lets go of them takes overlap / (4 roughness) of the unit of time: it has to be small.
material = FrictMat(density=ratio, young=push / (given["overlap"] * a * a), poisson=0.3, frictionAngle=0)
O.materials.append(material)
O.periodic = True
O.cell.setBox(n, n, n if settling else height + 6 * a)
balls = [O.bodies.append(utils.sphere([x * n for x in centre], a)) for centre in given["centres"]]
if not settling:
    # The plates are faces of the fluid's box. What keeps spheres from going through them are layers of fixed spheres outside, level to an eighth of a cell: walls and
    # boxes of YADE do not touch what has left the first period. The cell is higher than the box, so that no sphere meets one at the other plate.
    bead, rows = 2 * a, round(n / 2)
    for z in (-bead, height + bead):
        for i in range(rows):
            for j in range(rows):
                O.bodies.append(utils.sphere(((i + 0.5) * n / rows, (j + 0.5) * n / rows, z), bead, fixed=True, mask=BEADS | BALLS))
speed = 0 if settling else gamma * height / 2
still = (0, 0, 0)
fluid = LbmEngine(lower=(0, 0, 0), upper=(n, n, height), dx=1, density=1, viscosity=1, tau=tau, gravity=(0, 0, -weight),
                  acceleration=(0, 0, (ratio - 1) * c * weight), lubricationRoughness=given["roughness"],
                  boundary=["periodic"] * 6 if settling else ["periodic"] * 4 + ["noSlip"] * 2,
                  boundaryVelocity=[still] * 4 + [(-speed, 0, 0), (speed, 0, 0)], ids=balls, label="fluid")
if not settling:
    for ball in balls:  # on their way with the shear already
        O.bodies[ball].state.vel = Vector3(gamma * (O.bodies[ball].state.pos[2] - height / 2), 0, 0)


def contact_stress():
    """What contacts among the spheres carry of the shear stress (Love-Weber)."""
    total = 0.0
    for contact in O.interactions:
        if contact.isReal and contact.id1 <= balls[-1] and contact.id2 <= balls[-1]:
            total -= contact.phys.normalForce[0] * contact.geom.normal[2] * (2 * a - contact.geom.penetrationDepth)
    return total / (n * n * height)


def sample_settling():
    mean = np.mean([O.bodies[b].state.vel[2] for b in balls])
    samples.append((fluid.averageVelocity()[2] - mean) / terminal)


def sample_shear():
    wall = (fluid.getBoundaryForce(4)[0] - fluid.getBoundaryForce(5)[0]) / 2
    stresslets = sum(fluid.stresslet(b)[0][2] for b in balls)
    samples.append((abs(wall) / (n * n * gamma), stresslets / (n * n * height * gamma), contact_stress() / gamma))


def sample_profile():
    """Mean velocity and solid fraction of the layers of cells."""
    profiles.append((fluid.velocity[..., 0].mean((1, 2)) / (gamma * height), fluid.solidFraction.mean((1, 2))))


samples, profiles = [], []
total = math.ceil(given["duration"] * unit / O.dt)
observers = {"sample_settling": 500} if settling else {"sample_shear": 1000, "sample_profile": 80}
for name in observers:
    setattr(__main__, name, globals()[name])  # where PyRunner looks for names
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], avoidSelfInteractionMask=BEADS),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
    fluid,
    NewtonIntegrator(gravity=(0, 0, -weight), damping=0),
    *(PyRunner(iterPeriod=max(1, total // times), command=name + "()") for name, times in observers.items()),
]
O.run(total, True)


def error(late):
    """Standard error of the mean, from blocks in time."""
    return float(np.std([block.mean() for block in np.array_split(late, 6)], ddof=1) / math.sqrt(6))


samples = np.array(samples)
result = {"n": n, "radius_cells": a, "cells": n * n * height, "steps": O.iter, "samples": len(samples)}
late = samples[len(samples) // 2:]
if settling:
    result.update(ratio=float(late.mean()), error=error(late), early=float(samples[len(samples) // 20:len(samples) // 5].mean()))
else:
    at = np.array([O.bodies[b].state.pos for b in balls])
    apart = at[:, None] - at[None, :]
    apart[..., :2] -= n * np.round(apart[..., :2] / n)
    distance = np.sqrt((apart**2).sum(-1)) + 1e9 * np.eye(len(balls))
    result["nearest"] = float(distance.min() / (2 * a))  # distance of centres in diameters
    wall, stresslet, contact = late.mean(0)
    # the middle half, away from the layers that plates order: mean solid fraction, and shear rate over the mean one
    core = slice(round(height / 4), height - round(height / 4))
    velocity, solid = np.mean(profiles[len(profiles) // 2:], 0)
    slope = np.polyfit(((np.arange(height) + 0.5) / height)[core], velocity[core], 1)[0]
    result.update(eta=float(wall), error=error(late[:, 0]), eta_stresslet=float(1 + stresslet), eta_contacts=float(contact),
                  phi_core=float(solid[core].mean()), rate_core=float(slope), eta_core=float(wall / slope),
                  solid=[round(float(x), 4) for x in solid])
result["history"] = [round(float(block.mean()), 5) for block in np.array_split(samples if settling else samples[:, 0], 24)]
leave(result)
