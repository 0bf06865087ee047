"""The mean stress of fluid, particles and contacts is the stress on the walls of a Couette cell."""

from claims import *

MU, DX = FLUID["viscosity"], FLUID["dx"]
STEADY = 2e-4  # relative; what is left of the transient


def a_free_sphere_in_a_couette_cell():
    cells = (14, 14, 16)
    shear = 1.0
    speed = 0.5 * shear * cells[2] * DX
    still = [(0, 0, 0)] * 4
    fluid = box(
        cells, boundary=["periodic"] * 4 + ["noSlip"] * 2, tau=1, inertia=False, maxMach=1,
        boundaryVelocity=still + [(-speed, 0, 0), (speed, 0, 0)],
    )  # fmt: skip
    O.bodies.append(sphere([0.5 * n * DX for n in cells], 4e-3))
    O.bodies[0].state.angVel = (0, 0.45 * shear, 0)
    O.engines = engines(fluid)
    O.dt = fluid_step(1)
    O.run(6000, True)
    area = cells[0] * cells[1] * DX**2
    wall = 0.5 * (fluid.getBoundaryForce(4)[0] - fluid.getBoundaryForce(5)[0]) / area
    parts = fluid.stress()
    check_close(parts["total"][0, 2], wall, STEADY * wall, "total and wall")
    check_close(parts["fluid"][0, 2], MU * shear, 0.01 * MU * shear, "fluid: viscosity times mean shear")
    volume = area * cells[2] * DX
    check_close(parts["particles"][0, 2], fluid.stresslet(0)[0, 2] / volume, STEADY * wall, "stresslet")
    check(1.1 * MU * shear < wall < 1.5 * MU * shear, "the sphere does not thicken the suspension: %g" % wall)


def contacts_carry_their_part():
    O.bodies.append([sphere((6e-3, 6e-3, 6e-3), 3e-3, fixed=True), sphere((6e-3, 6e-3, 11.99e-3), 3e-3, fixed=True)])
    fluid = box((12, 12, 18), boundary=PERIODIC, tau=1)
    O.engines = engines(fluid)
    O.dt = fluid_step(1)
    O.run(2, True)
    parts = fluid.stress()
    push = O.interactions[0, 1].phys.normalForce.norm()
    check(push > 0, "the spheres do not touch")
    check_close(parts["contacts"][2, 2], -push * 5.99e-3 / (12 * 12 * 18 * DX**3), 1e-9 * push / DX**2, "contact stress")
    check((parts["total"] - parts["fluid"] - parts["particles"] - parts["contacts"]).norm() < 1e-12, "sum of the parts")


prove(a_free_sphere_in_a_couette_cell, contacts_carry_their_part)
