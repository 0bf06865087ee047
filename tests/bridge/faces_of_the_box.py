from claims import *

STILL = [(0, 0, 0)] * 6
CELL = FLUID["dx"]


def same(found, expected, relative):
    check_close(found, expected, relative * abs(expected))


def what_enters_leaves():
    """An inlet below, an outlet above, a fixed sphere between, free slip and walls around."""
    inflow = [(0, 0, 0)] * 4 + [(0, 0, 2e-3), (0, 0, 0)]
    boundary = ["freeSlip"] * 2 + ["noSlip"] * 2 + ["velocity", "pressure"]
    fluid = one_sphere((12, 12, 16), boundary=boundary, boundaryVelocity=inflow, tau=1.0)
    check(fluid.plan().mach > 0, "the plan does not know the inflow")
    O.dt = fluid_step(1.0)
    O.run(4000, True)
    flux = [fluid.getBoundaryFlux(i) for i in range(6)]
    through = 2e-3 * (12 * CELL) ** 2
    same(flux[4], -through, 1e-12)
    same(flux[5], through, 1e-6)
    check(max(map(abs, flux[:4])) < 1e-12 * through, "flux through a wall: %s" % flux)
    forces = [fluid.getBoundaryForce(i) for i in range(6)]
    total = sum((f[2] for f in forces), fluid.fluidForce(0)[2])
    check(abs(total) < 1e-5 * fluid.fluidForce(0)[2], "forces do not balance: %g" % total)
    check(abs(forces[0][2]) < 1e-10 * abs(forces[2][2]), "shear stress on a free-slip face")
    same(forces[2][2], forces[3][2], 1e-9)
    check(fluid.getPorePressure((0, 0, 0)) > fluid.getPorePressure((0, 0, 16 * CELL)), "no pressure drop")


def a_column_under_gravity_rests_under_a_pressure_face():
    """The face gives the excess over hydrostatic: at 0 nothing moves, and buoyancy is that of a closed box."""
    boundary = ["noSlip"] * 5 + ["pressure"]
    fluid = one_sphere(boundary=boundary, gravity=(0, 0, -9.81), tau=0.8)
    O.run(300, True)
    check(abs(fluid.velocity).max() == 0 and abs(fluid.pressure).max() == 0, "fluid at rest moves")
    buoyancy = FLUID["density"] * 4 / 3 * math.pi * 4e-3**3 * 9.81
    same(fluid.fluidForce(0)[2], buoyancy, 1e-10)
    check(all(fluid.getBoundaryForce(i).norm() == 0 for i in range(6)), "force on a face")


def pressure_is_raised_during_a_run():
    boundary = ["pressure"] * 2 + ["periodic"] * 4
    fluid = one_sphere(boundary=boundary, tau=1.0, inertia=False, boundaryPressure=[2, 2, 0, 0, 0, 0])
    O.dt = fluid_step(1.0)
    O.run(20, True)
    same(fluid.getPorePressure(pos=(6e-3, 6e-3, 6e-3)), 2.0, 1e-9)
    check(math.isnan(fluid.permeability()), "a permeability without a drive")
    fluid.boundaryPressure = [2.001, 2, 0, 0, 0, 0]
    O.run(2000, True)
    once = fluid.getBoundaryFlux(1)
    permeability = fluid.permeability()
    fluid.boundaryPressure = [2.002, 2, 0, 0, 0, 0]
    O.run(2000, True)
    same(fluid.getBoundaryFlux(1), 2 * once, 1e-6)
    same(fluid.permeability(), permeability, 1e-6)
    gradient = 2e-3 / (12 * CELL)
    same(FLUID["viscosity"] * fluid.averageVelocity()[0] / gradient, permeability, 1e-6)


def a_wall_is_set_in_motion_during_a_run():
    boundary = ["periodic"] * 4 + ["noSlip"] * 2
    fluid = one_sphere(boundary=boundary, tau=1.0)
    O.dt = fluid_step(1.0)
    O.run(50, True)
    check(abs(fluid.velocity).max() == 0, "fluid moves by itself")
    fluid.boundaryVelocity = STILL[:5] + [(1e-3, 0, 0)]
    O.run(500, True)
    check(fluid.fluidForce(id=0)[0] > 0 and fluid.getBoundaryForce(i=5)[0] < 0, "the wall does not drag")


prove(
    what_enters_leaves,
    a_column_under_gravity_rests_under_a_pressure_face,
    pressure_is_raised_during_a_run,
    a_wall_is_set_in_motion_during_a_run,
)
