from claims import *

GRAVITY = 9.81
EXACT = 1e-6  # relative: the solid fractions' error, which the engine's own tests bound


def a_fixed_sphere_feels_the_weight_of_the_fluid():
    for boundary in (["noSlip"] * 6, PERIODIC):
        O.reset()
        fluid = one_sphere((16, 16, 16), radius=4.3e-3, gravity=(0, 0, -GRAVITY), boundary=boundary)
        O.bodies[0].state.pos = (7.7e-3, 8.1e-3, 8.3e-3)
        O.run(100, True)
        weight = FLUID["density"] * 4 / 3 * math.pi * 4.3e-3**3 * GRAVITY
        for force in (fluid.fluidForce(0), O.forces.f(0, True)):
            check_close(force[2], weight, EXACT * weight, "buoyancy")
            check_close(abs(force[0]) + abs(force[1]), 0, EXACT * weight, "sideways")
        check_close(fluid.fluidTorque(0).norm(), 0, EXACT * weight * 4.3e-3, "torque")
        check_close(abs(fluid.velocity).max(), 0, 1e-15, "velocity of the fluid at rest")


def a_neutral_sphere_stays_where_it_is():
    fluid = one_sphere((16, 16, 16), fixed=False, gravity=(0, 0, -GRAVITY))
    O.engines = engines(fluid, gravity=(0, 0, -GRAVITY))
    O.bodies[0].state.mass = FLUID["density"] * 4 / 3 * math.pi * 4e-3**3
    O.run(200, True)
    fall = 0.5 * GRAVITY * O.time**2
    check_close(O.bodies[0].state.displ().norm(), 0, EXACT * fall, "displacement against free fall")


prove(a_fixed_sphere_feels_the_weight_of_the_fluid, a_neutral_sphere_stays_where_it_is)
