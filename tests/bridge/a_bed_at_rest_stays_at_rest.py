"""22 grains on each other in undamped contacts, with films: all that takes their energy is the fluid, and it has to take all of it."""

import random

from claims import *

SPACING, GRAVITY, RATIO = 6e-3, 0.02, 2.5
BOX = (18, 18, 30)
REST = 2e-3  # of the speed of a lone grain
WALLS = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]


def bed(phase, grain_steps, tau=0.8):
    """Layers of grains of several sizes just above each other; `phase` is the contact frequency times the fluid step."""
    step = fluid_step(tau)
    mass = RATIO * 1000 * math.pi / 6 * SPACING**3
    material = FrictMat(density=RATIO * 1000, young=mass * (phase / step) ** 2 / SPACING, poisson=0.3, frictionAngle=0.4)
    O.materials.append(material)
    sizes = random.Random(2)
    for layer in range(3):
        n, first = (3, 3e-3) if layer % 2 == 0 else (2, 6e-3)
        for x in range(n):
            for y in range(n):
                place = (first + SPACING * x, first + SPACING * y, 3.05e-3 + 4.4e-3 * layer)
                O.bodies.append(sphere(place, SPACING / 2 * (1 - 0.04 * sizes.random()), material=material))
    for axis in range(3):
        O.bodies.append(utils.wall(0, axis=axis, sense=1, material=material))
        O.bodies.append(utils.wall(BOX[axis] * 1e-3, axis=axis, sense=-1, material=material))
    fluid = box(BOX, gravity=(0, 0, -GRAVITY), tau=tau)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(WALLS),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys()],
            [Law2_ScGeom_FrictPhys_CundallStrack()],
        ),
        fluid,
        NewtonIntegrator(gravity=(0, 0, -GRAVITY), damping=0),
    ]
    O.dt = step / grain_steps


def fastest():
    """Of the grains, over the speed of a lone one."""
    lone = (RATIO - 1) * 1000 * GRAVITY * SPACING**2 / (18 * FLUID["viscosity"])
    return max(b.state.vel.norm() for b in O.bodies if isinstance(b.shape, Sphere)) / lone


def check_rest(settled=20, watched=4, **scene):
    bed(**scene)
    O.run(math.ceil(settled / O.dt), True)
    seen = []
    for _ in range(20):
        O.run(math.ceil(watched / 20 / O.dt), True)
        seen.append(fastest())
    check(max(seen) < REST, "%s: %.2g of a lone grain's speed is left" % (scene, max(seen)))
    print("  %s: %.1e of a lone grain's speed is left" % (scene, max(seen)))


def contacts_that_ring_slower_than_the_fluid_steps():
    check_rest(phase=0.5, grain_steps=1)


def contacts_that_ring_faster_than_the_fluid_steps():
    for phase in (2, 4):
        O.reset()
        check_rest(phase=phase, grain_steps=5 * phase)


def fluid_steps_shorter_than_the_grains():
    check_rest(phase=0.25, grain_steps=0.5, tau=0.65)


prove(
    contacts_that_ring_slower_than_the_fluid_steps,
    contacts_that_ring_faster_than_the_fluid_steps,
    fluid_steps_shorter_than_the_grains,
)
