"""The shortest useful script: three glass beads sink in honey-like syrup, one after another, and push each other along.

    scripts/yade -j2 -x -n scripts/examples/first_fluid.py
"""

from yade import O, utils
from yade.wrapper import *

from yadelbm import LbmEngine

gravity = (0, 0, -9.81)
glass = O.materials.append(FrictMat(density=2500, young=1e6, poisson=0.3, frictionAngle=0.4))
beads = O.bodies.append([utils.sphere((0.010 + 0.001 * i, 0.010, 0.025 + 0.006 * i), 0.002, material=glass)
                         for i in range(3)])
O.bodies.append(utils.wall(0, axis=2, material=glass))

fluid = LbmEngine(lower=(0, 0, 0), upper=(0.020, 0.020, 0.045), dx=0.0005,   # [m]; 8 cells across a bead
                  density=1400, viscosity=0.3, gravity=gravity,              # [kg/m3], [Pa s]
                  boundary=["noSlip"] * 6, label="fluid")

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    fluid,
    NewtonIntegrator(gravity=gravity, damping=0),
]
O.dt = 4e-5
print(fluid.plan())

for _ in range(10):
    O.run(1250, True)
    states = [O.bodies[i].state for i in beads]
    print(f"t = {O.time:.2f} s   height and velocity [mm, mm/s]:   "
          + "   ".join(f"{1e3 * s.pos[2]:5.2f} {1e3 * s.vel[2]:6.2f}" for s in states), flush=True)
