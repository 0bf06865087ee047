"""What is likely not meant: plan() says so, and a warning when the fluid begins."""

import warnings

from claims import *


def more_threads_than_processors_are_not_used():
    fluid = one_sphere(ompThreads=100000)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        O.run(2, True)
    check(any("ompThreads = 100000: there are" in str(warning.message) for warning in caught), "no warning")


def bodies_outside_the_box_are_pointed_out():
    fluid = one_sphere()
    text = "No body is in the fluid's box, (0, 0, 0) to (0.012, 0.012, 0.012) m"
    check(text not in str(fluid.plan()), "warning without reason")
    O.bodies[0].state.pos = (6, 6, 6)  # in millimetres
    check(text in str(fluid.plan()), "no warning: %s" % fluid.plan())
    fluid.boundary = PERIODIC
    check(text not in str(fluid.plan()), "warning without reason")


def densities_in_other_units_are_pointed_out():
    O.materials.append(FrictMat(density=2.5))  # g/cm3
    fluid = one_sphere(fixed=False)
    check("Body 0 has 0.0025 times the density of the fluid (2.5 kg/m3)" in str(fluid.plan()), "no warning: %s" % fluid.plan())
    O.bodies[0].state.blockedDOFs = "xyzXYZ"
    check("times the density" not in str(fluid.plan()), "warning for a fixed body")


def light_grains_beside_each_other_are_pointed_out():
    light = FrictMat(density=400)
    O.bodies.append([sphere((5e-3, 6e-3, 6e-3), 4e-3, material=light), sphere((14e-3, 6e-3, 6e-3), 4e-3, material=light)])
    O.engines = engines(box((20, 12, 12), tau=1.5))
    O.dt = 1e-4
    plan = str(O.engines[3].plan())
    check("unstable below 0.5 times with tau = 1.5; use tau <= 1.3" in plan, "no warning: %s" % plan)
    O.bodies[1].state.blockedDOFs = "xyzXYZ"
    check("unstable" not in str(O.engines[3].plan()), "warning for a sphere that is alone")
    O.bodies[1].state.blockedDOFs = ""
    O.engines[3].tau = 1.2
    check("unstable" not in str(O.engines[3].plan()), "warning for a short step")


def spheres_that_overlap_are_pointed_out():
    fluid = one_sphere()
    one = O.bodies[0]
    other = O.bodies.append(utils.sphere(one.state.pos + Vector3(one.shape.radius, 0, 0), one.shape.radius, fixed=True))
    text = "Spheres 0 and 1 share 31.3 % of the smaller one's volume and are not one clump"
    check(text in str(fluid.plan()), "no warning: %s" % fluid.plan())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        O.run(3, True)
    check(sum(text in str(warning.message) for warning in caught) == 1, "not said once: %s" % caught)
    O.bodies.clump([0, other])
    check("share" not in str(fluid.plan()), "warning for a clump")


def shapes_that_the_fluid_does_not_see_are_pointed_out():
    fluid = one_sphere()
    for axis, height in ((0, 0.0), (1, 12e-3)):  # at the faces of the box, as walls of the grains
        O.bodies.append(utils.wall(height, axis=axis))
    check("does not see" not in str(fluid.plan()), "warning for walls at faces: %s" % fluid.plan())
    O.bodies.append(utils.wall(6e-3, axis=2))
    O.bodies.append(utils.facet([(3e-3, 3e-3, 3e-3), (9e-3, 3e-3, 3e-3), (3e-3, 9e-3, 3e-3)]))
    for text in ("Bodies of shape Wall stand in the fluid (1, the first is 3)", "Facet stand in the fluid (1, the first is 4)"):
        check(text in str(fluid.plan()), "no warning: %s" % fluid.plan())
    fluid.ids = [0]
    check("does not see" not in str(fluid.plan()), "warning for bodies that are not chosen")


def a_body_that_is_moved_without_a_velocity_is_pointed_out():
    one_sphere((16, 12, 12), tau=0.6)
    O.dt = fluid_step(0.6)
    body = O.bodies[0]

    def warned(velocity):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for _ in range(8):
                body.state.pos += Vector3(2e-5, 0, 0)
                body.state.vel = velocity
                O.step()
        return sum("Body 0 is moved from step to step and has no velocity" in str(warning.message) for warning in caught)

    check(warned((6e-3, 0, 0)) == 0, "warning for a body with a velocity")
    check(warned((0, 0, 0)) == 1, "not said once")


def stiff_contacts_are_warned_about():
    """By the stiffness of the contacts that there are, and before by that of the materials."""
    fluid = box((12, 12, 20), tau=0.6)
    O.materials.append(FrictMat(density=2500, young=1e4, poisson=0.3, frictionAngle=0))
    for height in (5e-3, 10.9e-3):
        O.bodies.append(sphere((6e-3, 6e-3, height), 3e-3))
    O.engines = engines(fluid)
    O.dt = 1e-5
    mass = O.bodies[0].state.mass
    pair = fluid_step(0.6) * math.sqrt(2 * 1e4 * 3e-3 / mass)
    check_close(fluid.plan().contactPhase, pair, 1e-9 * pair, "contact frequency from the material")
    check("contacts ring with up to" in str(fluid.plan()), "no warning")
    O.run(2, True)
    contact = next(i for i in O.interactions if i.isReal)
    found = fluid_step(0.6) * math.sqrt(contact.phys.kn * 2 / mass)
    check_close(fluid.plan().contactPhase, found, 1e-9 * found, "contact frequency from the contact")
    contact.phys.kn = 1e-3
    check("contacts ring with up to" not in str(fluid.plan()), "warning for soft contacts")


def what_is_likely_not_meant_is_said():
    """By the plan, and once when a fluid begins."""
    fluid = one_sphere(gravity=(0, 0, -9.81), boundary=PERIODIC)
    O.engines = O.engines[:4] + [
        GlobalStiffnessTimeStepper(active=False, defaultDt=O.dt),
        NewtonIntegrator(gravity=(0, 0, -9.8)),
    ]
    plan = fluid.plan()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        O.run(2, True)
        O.run(2, True)
    for text in (
        "damping = 0.2",
        "-9.8) and LbmEngine.gravity = (0, 0, -9.81) differ",
        "is periodic and",
        "GlobalStiffnessTimeStepper stands behind LbmEngine",
    ):
        check(any(text in warning for warning in plan.warnings), "no warning says %r: %s" % (text, plan.warnings))
        check(text in str(plan), "report does not say %r" % text)
        said = sum(text in str(warning.message) for warning in caught)
        check(said == 1, "%r is said %d times" % (text, said))
    O.reset()
    one_sphere(boundary=PERIODIC)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_raises(RuntimeError, "is periodic and", lambda: O.run(2, True))


def masses_of_overlapping_clumps_are_pointed_out():
    """YADE counts common volume twice unless it is told to look."""
    fluid = one_sphere((16, 12, 12))
    O.materials.append(FrictMat(density=2000))
    clump, _ = O.bodies.appendClumped([sphere((5e-3, 6e-3, 6e-3), 2e-3), sphere((7e-3, 6.1e-3, 6e-3), 2e-3)])
    fluid.ids = list(O.bodies[clump].shape.members)
    plan = str(fluid.plan())
    for text in ("Clump %d weighs 0.00013404" % clump, " m3 that its overlapping members fill would weigh 0.000113"):
        check(text in plan, "no warning: %s" % plan)
    O.bodies.updateClumpProperties(discretization=50)
    check("weighs" not in str(fluid.plan()), "warning for a clump that is right: %s" % fluid.plan())
    O.bodies[clump].state.mass *= 0.98
    check("weighs" in str(fluid.plan()), "no warning for a clump that is too light")
    O.bodies[clump].state.blockedDOFs = "xyzXYZ"
    check("weighs" not in str(fluid.plan()), "warning for a clump that is held")
    O.bodies[clump].state.blockedDOFs = ""
    apart, members = O.bodies.appendClumped([sphere((5e-3, 6e-3, 6e-3), 2e-3), sphere((10e-3, 6e-3, 6e-3), 2e-3)])
    O.bodies[apart].state.mass *= 0.5  # members are hollow, for instance
    fluid.ids = members
    check("weighs" not in str(fluid.plan()), "warning for members that do not overlap")


prove(
    more_threads_than_processors_are_not_used,
    bodies_outside_the_box_are_pointed_out,
    densities_in_other_units_are_pointed_out,
    light_grains_beside_each_other_are_pointed_out,
    spheres_that_overlap_are_pointed_out,
    shapes_that_the_fluid_does_not_see_are_pointed_out,
    a_body_that_is_moved_without_a_velocity_is_pointed_out,
    stiff_contacts_are_warned_about,
    what_is_likely_not_meant_is_said,
    masses_of_overlapping_clumps_are_pointed_out,
)
