"""Which bodies are in the fluid."""

from claims import *

TAU = 0.6
STEP = fluid_step(TAU)
DRIVE = dict(boundary=PERIODIC, acceleration=(0.01, 0, 0))


def bodies_may_come_and_go():
    fluid = one_sphere((12, 12, 24), radius=3e-3, tau=TAU, **DRIVE)
    O.dt = STEP / 2
    O.run(6, True)
    added = O.bodies.append(sphere((6e-3, 6e-3, 4e-3), 2.5e-3))
    O.run(6, True)
    check(fluid.fluidForce(added)[0] > 0, "the added body feels nothing")
    O.bodies.erase(0)
    O.run(6, True)
    check_raises(ValueError, "body 0 was not in the fluid", lambda: fluid.fluidForce(0))
    volume = fluid.solidFraction.sum() * FLUID["dx"] ** 3
    check_close(volume, 4 / 3 * math.pi * 2.5e-3**3, 1e-3 * volume, "solid volume after erasing")
    O.bodies.erase(added)
    O.run(6, True)
    check_close(fluid.solidFraction.sum(), 0, 1e-12, "solid volume without bodies")


def a_body_made_again_or_moved_afar_gets_no_kick():
    fluid = one_sphere((14, 14, 24), radius=3e-3, fixed=False, tau=TAU, **DRIVE)
    O.dt = STEP
    O.bodies[0].state.vel = (0, 0, 0.02)
    O.run(20, True)
    O.bodies.clear()
    O.bodies.append(sphere((7e-3, 7e-3, 5e-3), 3e-3))
    O.run(1, True)
    stokes = 6 * math.pi * FLUID["viscosity"] * 3e-3 * 0.02  # a kick would be sixty times this
    check(fluid.fluidForce(0).norm() < 5 * stokes, "kick on a body made again: %s" % fluid.fluidForce(0))
    O.bodies[0].state.pos = (7e-3, 7e-3, 19e-3)
    O.run(1, True)
    check(fluid.fluidForce(0).norm() < 5 * stokes, "kick on a body moved afar: %s" % fluid.fluidForce(0))


def an_engine_used_again_after_a_reset_starts_anew():
    fluid = one_sphere(tau=TAU, **DRIVE)
    O.dt = STEP
    O.run(10, True)
    O.reset()
    O.bodies.append(sphere((6e-3, 6e-3, 6e-3), 4e-3, fixed=True))
    O.engines = engines(fluid)
    O.dt = STEP
    O.run(3, True)
    check(fluid.fluidSteps == 3, "%d fluid steps" % fluid.fluidSteps)


def time_set_to_zero_does_not_disturb_the_fluid():
    """O.resetTime, as after a preparation; the same loads as without it."""
    forces = []
    for reset in (False, True):
        O.reset()
        fluid = one_sphere(tau=TAU, **DRIVE)
        O.dt = STEP / 3
        O.run(12, True)
        if reset:
            O.resetTime()
        O.run(12, True)
        check(fluid.fluidSteps == 8, "%d fluid steps" % fluid.fluidSteps)
        forces.append(fluid.fluidForce(0))
    check(forces[0] == forces[1], "other loads after O.resetTime: %s" % forces)


def mask_and_ids_choose_bodies_at_any_time():
    fluid = one_sphere((12, 12, 24), radius=3e-3, tau=TAU, **DRIVE)
    O.bodies.append(sphere((6e-3, 6e-3, 4e-3), 2.5e-3, fixed=True, mask=4))
    O.dt = STEP

    def seen():
        O.run(1, True)
        found = []
        for i in range(2):
            try:
                fluid.fluidForce(i)
                found.append(i)
            except ValueError:
                pass
        return found

    check(seen() == [0, 1], "all")
    fluid.mask = 4
    check(seen() == [1], "mask")
    fluid.mask = -1
    fluid.ids = [0]
    check(seen() == [0], "ids")
    fluid.ids = []
    check(seen() == [0, 1], "all again")


def members_of_a_clump_are_in_the_fluid():
    fluid = box((12, 12, 24), tau=TAU, **DRIVE)
    clump, members = O.bodies.appendClumped([sphere((6e-3, 6e-3, z), 3e-3) for z in (10e-3, 13e-3)])
    O.engines = engines(fluid)
    O.dt = STEP / 2
    O.run(40, True)
    check_raises(ValueError, "is a clump, whose load is that of its members", lambda: fluid.fluidForce(clump))
    check(all(fluid.fluidForce(i)[0] > 0 for i in members), "members feel nothing")
    check(O.bodies[clump].state.vel[0] > 0, "the clump does not answer")


prove(
    bodies_may_come_and_go,
    a_body_made_again_or_moved_afar_gets_no_kick,
    an_engine_used_again_after_a_reset_starts_anew,
    time_set_to_zero_does_not_disturb_the_fluid,
    mask_and_ids_choose_bodies_at_any_time,
    members_of_a_clump_are_in_the_fluid,
)
