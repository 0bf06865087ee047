"""Box bodies of the scene stand in the fluid as walls."""

from claims import *

from yade.utils import box as box_body

EXACT = 1e-6
DX, MU = FLUID["dx"], FLUID["viscosity"]


def a_plate_on_the_lattice_drags_a_couette_flow():
    gap, thick, U = 8, 4, 0.002
    half = 0.5 * thick * DX
    O.bodies.append(box_body((2 * DX, 2 * DX, gap * DX + half), (2 * DX, 2 * DX, half), fixed=True))
    O.bodies[0].state.vel = (U, 0, 0)
    walls = ["periodic"] * 4 + ["noSlip"] * 2
    fluid = box([4, 4, 2 * gap + thick], boundary=walls, tau=1, inertia=False)
    O.engines = engines(fluid)
    O.dt = fluid_step(1)
    O.run(1500, True)
    for z in range(gap):
        speed = fluid.getVelocity((DX, DX, (z + 0.5) * DX))[0]
        check_close(speed, U * (z + 0.5) / gap, EXACT * U, "speed in row %d" % z)
    drag = -2 * MU * U / (gap * DX) * (4 * DX) ** 2
    check_close(fluid.fluidForce(0)[0], drag, EXACT * abs(drag), "drag on the plate")


def a_turned_box_displaces_its_volume():
    g = 9.81
    extents = (3e-3, 2e-3, 2.5e-3)
    turned = Quaternion((1, 2, 3), 0.7)
    O.bodies.append(box_body((8e-3, 7.7e-3, 8.2e-3), extents, orientation=turned, fixed=True))
    fluid = box([16] * 3, gravity=(0, 0, -g), tau=1)
    O.engines = engines(fluid)
    O.dt = fluid_step(1)
    O.run(1, True)
    buoyancy = FLUID["density"] * 8 * extents[0] * extents[1] * extents[2] * g
    check_close(fluid.fluidForce(0)[2], buoyancy, 1e-10 * buoyancy, "buoyancy")


def thin_walls_may_stand_outside_but_not_inside():
    wall = lambda z: box_body((8e-3, 8e-3, z), (8e-3, 8e-3, 0), fixed=True)
    O.bodies.append([wall(0), wall(16e-3), sphere((8e-3, 8e-3, 8e-3), 3e-3, fixed=True)])
    fluid = box([16] * 3, tau=1)
    O.engines = engines(fluid)
    O.dt = fluid_step(1)
    O.run(2, True)
    check(fluid.fluidForce(0) == Vector3.Zero, "a wall outside the fluid has a load")

    O.reset()
    O.bodies.append(wall(8e-3))
    O.engines = engines(box([16] * 3, tau=1))
    O.dt = fluid_step(1)
    check_raises(RuntimeError, "two cells thick", lambda: O.run(1, True))


prove(
    a_plate_on_the_lattice_drags_a_couette_flow,
    a_turned_box_displaces_its_volume,
    thin_walls_may_stand_outside_but_not_inside,
)
