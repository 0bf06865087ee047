"""Clumps in the fluid: YADE moves them as rigid bodies, and the loads of their members add up."""

import json
import subprocess

from claims import *

RADIUS, ROUND_OFF = 3.5e-3, 1e-10


def dumb_bell(density_ratio, centre=(9e-3, 9e-3, 9e-3), half=3.6e-3):
    """Two spheres along x; returns the clump. With the default they do not overlap."""
    material = FrictMat(density=1000 * density_ratio)
    x, y, z = centre
    clump, _ = O.bodies.appendClumped([sphere((x + s * half, y, z + s * 1e-4), RADIUS, material=material) for s in (-1, 1)])
    return O.bodies[clump]


def give_spin(clump, spin):
    clump.state.angVel = spin
    clump.state.angMom = clump.state.ori * Vector3(
        *[a * b for a, b in zip(clump.state.inertia, clump.state.ori.conjugate() * Vector3(spin))])


def momentum_is_conserved_with_clumps():
    for tau, ratio, steps in ((0.6, 1, 60), (0.8, 4, 80)):
        O.reset()
        fluid = box((20, 18, 18), tau=tau, boundary=PERIODIC)
        clump = dumb_bell(0.5)
        O.bodies.append(sphere((9e-3, 16e-3, 9e-3), RADIUS, material=FrictMat(density=2000)))
        lone = O.bodies[len(O.bodies) - 1]
        clump.state.vel = (1e-3, 2e-3, 0)
        give_spin(clump, (0, 0.3, 0.5))
        O.engines, O.dt = engines(fluid), fluid_step(tau) / ratio
        grains = lambda: sum((b.state.mass * b.state.vel for b in (clump, lone)), Vector3.Zero)
        start = grains()
        scale = start.norm()
        for _ in range(steps):
            O.run(1, True)
            check_close((fluid.totalMomentum() + grains() - start).norm() / scale, 0, ROUND_OFF, "momentum")
        check((clump.state.vel - Vector3(1e-3, 2e-3, 0)).norm() > 1e-4, "nothing was exchanged")


def loads_of_the_members_turn_the_clump():
    O.reset()
    fluid = box((20, 18, 18), tau=0.6, boundary=PERIODIC)
    clump = dumb_bell(1.5)
    give_spin(clump, (0, 0, 0.5))
    O.engines, O.dt = engines(fluid), fluid_step(0.6)
    for _ in range(20):
        before = Vector3(clump.state.angMom)
        centre = Vector3(clump.state.pos)
        places = {i: Vector3(O.bodies[i].state.pos) for i in clump.shape.members}
        O.run(1, True)
        torque = sum((fluid.fluidTorque(i) + (x - centre).cross(fluid.fluidForce(i)) for i, x in places.items()), Vector3.Zero)
        check_close((clump.state.angMom - before - O.dt * torque).norm() / before.norm(), 0, 1e-6, "angular momentum")


def light_dumb_bells_come_to_rest():
    for tau in (0.6, 1.0, 2.0):
        O.reset()
        fluid = box((24, 20, 20), tau=tau, boundary=PERIODIC)
        clump = dumb_bell(0.1, (12e-3, 10e-3, 10e-3))
        step = fluid_step(tau)
        speed = 1e-3 * FLUID["dx"] / step
        clump.state.vel = (0.5 * speed, speed, 0)
        give_spin(clump, (0, 0, speed / RADIUS))
        O.engines, O.dt = engines(fluid), step
        O.run(400, True)
        check(clump.state.vel.norm() < 0.05 * speed, "tau %g: %g of the speed is left" % (tau, clump.state.vel.norm() / speed))
        check(clump.state.angVel.norm() * RADIUS < 0.05 * speed, "tau %g: spin" % tau)


def the_plan_takes_a_clump_for_one_grain():
    g = (0, 0, -0.1)
    for half, size, density in ((3.6e-3, 2 ** (1 / 3), 1500), (1e-9, 1, 3000)):  # side by side; in the same place, where masses add up
        material = FrictMat(density=density)
        speeds = []
        for make in (lambda: dumb_bell(1.5, half=half), lambda: O.bodies.append(sphere((9e-3,) * 3, size * RADIUS, material=material))):
            O.reset()
            make()
            fluid = box((20, 20, 20), gravity=g, tau=0.55)
            O.engines, O.dt = engines(fluid, g), 1e-4
            plan = fluid.plan()
            speeds.append(plan.mach / plan.fluidDt)
        check_close(speeds[0] / speeds[1], 1, 0.15, "expected speed, half %g" % half)


def a_clump_settles_as_a_free_body_of_the_engine_alone():
    tau, cells, steps, radius, g = 0.8, (20, 20, 26), 400, 3e-3, (0, 0, -0.01)
    centres = [(10e-3 + s * 0.6 * radius, 10e-3, 16e-3 + s * 0.8 * radius) for s in (-1, 1)]  # touching, askew: it turns and drifts
    densities = (3000, 2000)
    wall = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
    case = {
        "domain": {"cells": cells, "dx": FLUID["dx"]},
        "fluid": {"density": FLUID["density"], "viscosity": FLUID["viscosity"]},
        "tau": tau,
        "gravity": g,
        "boundaries": {axis: wall for axis in "xyz"},
        "solids": [{"center": c, "radius": radius, "free": True, "density": q, "body": 1} for c, q in zip(centres, densities)],
        "stop": {"max_steps": steps},
    }
    run = subprocess.run([os.environ["LBM_PROGRAM"], "run", "-"], input=json.dumps(case), stdout=subprocess.PIPE, text=True, check=True)
    alone = json.loads(run.stdout)["solids"]

    fluid = box(cells, tau=tau, gravity=g)
    spheres = [sphere(c, radius, material=FrictMat(density=q)) for c, q in zip(centres, densities)]
    clump, members = O.bodies.appendClumped(spheres, discretization=0)
    O.engines, O.dt = engines(fluid, g), fluid_step(tau)
    O.run(steps, True)
    fallen = centres[0][2] - alone[0]["position"][2]
    check(fallen > 1e-3, "it hardly moved, by %g m" % fallen)
    check(abs(O.bodies[clump].state.angVel[1]) * 300 * O.dt > 0.02, "it hardly turned")
    for member, expected in zip(members, alone):
        for d in range(3):
            check_close(O.bodies[member].state.pos[d], expected["position"][d], 1e-5 * fallen, "position")
            check_close(O.bodies[member].state.vel[d], expected["velocity"][d], 1e-5 * abs(alone[0]["velocity"][2]), "velocity")


prove(momentum_is_conserved_with_clumps, loads_of_the_members_turn_the_clump, light_dumb_bells_come_to_rest,
      the_plan_takes_a_clump_for_one_grain, a_clump_settles_as_a_free_body_of_the_engine_alone)
