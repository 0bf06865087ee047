import math
import pathlib
import tempfile

import numpy as np
from claims import *

NAN = math.nan


def refused_at_construction(text, **values):
    message = check_raises(ValueError, text, lambda: box((12, 12, 12), **values))
    check("LbmEngine" in message, "%r does not say whose value it is" % message)


def values_out_of_range_are_refused_at_construction():
    for name in ("dx", "density", "viscosity"):
        for value in (-1e-3, 0.0, math.inf):
            refused_at_construction("%s = " % name, **{name: value})
    refused_at_construction("maxMach = ", maxMach=NAN)
    refused_at_construction("magicParameter = -1", magicParameter=-1)
    refused_at_construction("magicParameter = 2: must be between 0.01 and 0.5", magicParameter=2)
    refused_at_construction("lubricationRoughness = 0: must be between", lubricationRoughness=0)
    refused_at_construction("gravity = ", gravity=(0, 0, NAN))
    refused_at_construction("acceleration = ", acceleration=(0, 0, math.inf))
    refused_at_construction("upper = ", upper=(NAN, 1, 1))
    refused_at_construction("tau = 0.5: must be between 0.505 and 20", tau=0.5)
    refused_at_construction("tau = 25", tau=25)


def the_box_is_a_whole_number_of_cells():
    refused_at_construction("is 12.5 cells of dx = 0.001, must be a whole number", upper=(12e-3, 12.5e-3, 12e-3))
    refused_at_construction("along z = -0.001: must be > 0", upper=(12e-3, 12e-3, 12e-3), lower=(0, 0, 13e-3))
    check(box((12, 12, 12), upper=(0.1, 0.1, 0.16)).cells == (100, 100, 160), "decimal input is not whole")


def choices_that_are_not_supported_are_refused():
    refused_at_construction("must be one of 'exact'", scheme="bounce-back")
    refused_at_construction("must be one of 'trt', 'bgk'", collision="mrt")
    refused_at_construction("must be one of 'D3Q19', 'D3Q27'", lattice="D3Q15")
    refused_at_construction("with collision = 'bgk'", collision="bgk", magicParameter=0.25)
    refused_at_construction("must be 'double' or 'single'", storage="half")
    refused_at_construction("only 0, the fluid in this process", ranks=2)


def faces_must_make_sense():
    six = ["noSlip"] * 6
    refused_at_construction("boundary = list of 5: must have six names", boundary=six[:5])
    refused_at_construction("boundary[xmin] = 'wall': must be 'periodic', 'noSlip', 'freeSlip'", boundary=["wall"] + six[1:])
    refused_at_construction("boundary[zmin] = 'noSlip': the opposite face is 'periodic'", boundary=six[:5] + ["periodic"])
    refused_at_construction("boundaryVelocity = list of 1", boundaryVelocity=[(0, 0, 0)])
    refused_at_construction(
        "boundaryVelocity[ymin] = (0, 1, 0): a noSlip wall moves in its own plane",
        boundaryVelocity=[(0, 0, 0)] * 2 + [(0, 1, 0)] + [(0, 0, 0)] * 3,
    )
    refused_at_construction(
        "boundaryVelocity[ymin] = (1, 0, 0): periodic faces have no velocity",
        boundary=PERIODIC,
        boundaryVelocity=[(0, 0, 0)] * 2 + [(1, 0, 0)] + [(0, 0, 0)] * 3,
    )


def velocities_and_pressures_stand_at_faces_that_have_them():
    still, zero = [(0, 0, 0)] * 6, [0] * 6
    open_box = ["velocity", "pressure"] + ["freeSlip"] * 4
    refused_at_construction("boundaryPressure = list of 5: must have six numbers", boundaryPressure=zero[:5])
    refused_at_construction(
        "boundaryPressure[zmax] = 3: freeSlip faces have no pressure", boundary=open_box, boundaryPressure=zero[:5] + [3]
    )
    refused_at_construction("boundaryPressure[xmax] = nan: must be finite", boundary=open_box, boundaryPressure=[0, NAN] + zero[:4])
    refused_at_construction(
        "boundaryVelocity[xmax] = (1, 0, 0): pressure faces have no velocity",
        boundary=open_box,
        boundaryVelocity=[(0, 0, 0), (1, 0, 0)] + still[:4],
    )
    check_raises(TypeError, "LbmEngine.boundaryPressure = 3: must be a list", lambda: box((12, 12, 12), boundaryPressure=3))


def an_inflow_without_a_way_out_is_refused():
    fluid = one_sphere(boundary=["velocity"] + ["noSlip"] * 5, boundaryVelocity=[(1e-3, 0, 0)] + [(0, 0, 0)] * 5)
    refused_by_plan_and_run("more in than out: make the velocities balance, or one of the faces a pressure face", fluid)


def a_pressure_that_the_lattice_cannot_hold_is_refused():
    fluid = one_sphere(boundary=["noSlip"] * 5 + ["pressure"], boundaryPressure=[0] * 5 + [1e6], tau=1.5)
    refused_by_plan_and_run("a static pressure of 1000000 Pa would compress", fluid)


def other_kinds_and_names_are_refused():
    for kind in (TypeError, ValueError):  # the interface promises the second, Python's users expect the first
        check_raises(kind, "LbmEngine.dx = small: must be a number, not str", lambda: box((12, 12, 12), dx="small"))
    check_raises(TypeError, "LbmEngine.boundary = noSlip: must be a list", lambda: box((12, 12, 12), boundary="noSlip"))
    check_raises(TypeError, "LbmEngine.upper = ", lambda: box((12, 12, 12), upper=(1, 2)))
    check_raises(AttributeError, "No such attribute: visc", lambda: box((12, 12, 12), visc=1))
    fluid = box((12, 12, 12))
    check_raises(ValueError, "LbmEngine.dx = -1", lambda: setattr(fluid, "dx", -1))
    for value in (None, 2, "yes", []):
        check_raises(TypeError, "LbmEngine.inertia = %s: must be True or False" % value, lambda: setattr(fluid, "inertia", value))
    check_raises(ValueError, "LbmEngine.mask = 1099511627776: must be within", lambda: setattr(fluid, "mask", 2**40))


def numpy_values_are_taken():
    from yadelbm import LbmEngine

    fluid = LbmEngine(
        dx=np.float32(0.5), density=np.float64(1000), viscosity=np.float64(1e-2), upper=np.full(3, 6.0), mask=np.int64(3), ids=np.array([0, 4]),
        boundary=np.array(PERIODIC), boundaryVelocity=np.zeros((6, 3)), inertia=np.bool_(False), lubrication=np.bool_(True),
    )
    check(fluid.cells == (12, 12, 12) and fluid.mask == 3 and fluid.ids == [0, 4] and fluid.boundary == PERIODIC, "values differ")
    check(fluid.inertia is False and fluid.lubrication is True, "truths differ")


def refused_by_plan_and_run(text, fluid):
    """Before the run as ValueError, from the run as RuntimeError, with the same words; YADE stays usable."""
    check_raises(ValueError, text, fluid.plan)
    check_raises(RuntimeError, text, lambda: O.run(3, True))
    check(fluid.fluidSteps == 0, "fluid ran on")


def missing_values_are_named():
    from yadelbm import LbmEngine

    O.bodies.append(sphere((0, 0, 0), 1))
    for name in ("upper", "dx", "density", "viscosity"):
        values = dict(FLUID, upper=(12e-3,) * 3)
        del values[name]
        fluid = LbmEngine(**values)
        O.engines = engines(fluid)
        refused_by_plan_and_run("LbmEngine.%s = " % name, fluid)


def a_fluid_without_spheres_is_refused():
    fluid = box((12, 12, 12))
    O.engines = engines(fluid)
    O.bodies.append(utils.facet([(0, 0, 0), (1, 0, 0), (0, 1, 0)]))
    refused_by_plan_and_run("no body with a Sphere or Box shape is selected", fluid)


def unknown_ids_are_refused():
    fluid = one_sphere(ids=[0, 7])
    refused_by_plan_and_run("LbmEngine.ids: body 7 does not exist", fluid)


def spheres_that_the_lattice_cannot_hold_are_refused():
    for radius, text in (
        (1.9e-3, "sphere 0: radius = 0.0019 is 1.9 cells, must be at least 2; dx <= 0.00095 would do"),
        (NAN, "sphere 0: radius = nan: must be finite and > 0"),
        (12.1e-3, "larger than twice the fluid's box"),
    ):
        O.reset()
        fluid = one_sphere()
        O.bodies[0].shape.radius = radius
        O.engines = [fluid]  # YADE's collider would be the first to stumble over NaN
        refused_by_plan_and_run(text, fluid)


def a_position_that_is_not_a_number_is_refused():
    fluid = one_sphere()
    O.bodies[0].state.pos = (NAN, 0, 0)
    O.engines = [fluid]
    refused_by_plan_and_run("sphere 0: position, velocity and angular velocity must be finite", fluid)


def a_second_fluid_is_refused():
    fluid = one_sphere()
    O.engines = O.engines + [box((12, 12, 12), label="other")]
    refused_by_plan_and_run("two LbmEngines in O.engines", fluid)
    O.engines = engines(fluid)[:4] + [fluid, NewtonIntegrator()]
    refused_by_plan_and_run("two LbmEngines in O.engines", fluid)


def a_place_where_loads_are_lost_is_refused():
    fluid = one_sphere()
    O.engines = O.engines[:3] + [NewtonIntegrator(), fluid]
    refused_by_plan_and_run("LbmEngine stands after NewtonIntegrator", fluid)
    O.engines = [fluid] + engines(box((12, 12, 12)))[:3] + [NewtonIntegrator()]
    refused_by_plan_and_run("LbmEngine stands before ForceResetter", fluid)
    others = engines(fluid)
    O.engines = others[:2] + [fluid, others[2], others[4]]
    refused_by_plan_and_run("LbmEngine stands before InteractionLoop", fluid)
    fluid.lubrication = False
    fluid.plan()


def a_free_sphere_without_mass_is_refused():
    fluid = one_sphere(fixed=False)
    O.bodies[0].state.mass = 0
    refused_by_plan_and_run("sphere 0: mass = 0", fluid)


def a_time_step_that_is_no_number_is_refused():
    fluid = one_sphere()
    for dt in (0, NAN):  # YADE itself refuses a negative one
        O.dt = dt
        refused_by_plan_and_run("O.dt = ", fluid)


def a_time_step_of_very_many_fluid_steps_is_refused():
    """Before and during a run: nobody would see an end of it."""
    fluid = one_sphere()
    O.dt = 1e3
    refused_by_plan_and_run("time step of the grains = 1000 s: holds", fluid)
    O.dt = 1e-2
    O.run(3, True)
    O.dt = 1e3
    check_raises(RuntimeError, "O.dt = 1000: holds", lambda: O.run(3, True))
    steps = fluid.fluidSteps
    O.dt = 1e-2
    O.run(3, True)
    check(fluid.fluidSteps > steps, "fluid does not go on with a sensible step")


def too_fast_for_the_lattice_is_refused_before_the_run():
    fluid = one_sphere(tau=0.6)
    O.bodies[0].state.vel = (100, 0, 0)
    check_raises(ValueError, "Mach", fluid.plan)
    check_raises(RuntimeError, "Mach", lambda: O.run(1, True))


def too_fast_for_the_lattice_stops_the_run():
    fluid = one_sphere(tau=0.6, boundary=PERIODIC)
    O.run(10, True)
    O.bodies[0].state.vel = (0.5, 0, 0)
    folder = tempfile.mkdtemp()
    fluid.stopFile = os.path.join(folder, "state.vti")
    message = check_raises(RuntimeError, "Mach", lambda: O.run(100, True))
    check("solid 0 at (" in message and "cells per fluid step" in message, "message %r does not say where" % message)
    check(os.path.getsize(fluid.stopFile) > 0 and fluid.stopFile in message, "no state in %s: %r" % (fluid.stopFile, message))
    steps = fluid.fluidSteps
    check_raises(RuntimeError, "the fluid stopped earlier", lambda: O.run(100, True))
    check(fluid.fluidSteps == steps, "a stopped fluid ran on")
    check("\n" not in message.strip(), "message %r is more than a line" % message)


def a_state_that_cannot_be_kept_does_not_hide_the_reason():
    fluid = one_sphere(tau=0.6, boundary=PERIODIC, stopFile="/no/such/folder/state.vti")
    O.run(10, True)
    O.bodies[0].state.vel = (0.5, 0, 0)
    message = check_raises(RuntimeError, "Mach", lambda: O.run(100, True))
    check("the state is not kept: cannot write /no/such/folder/state.vti" in message, "message %r" % message)


def a_cell_that_is_not_the_box_is_refused():
    fluid = one_sphere(boundary=PERIODIC)
    O.periodic = True
    O.cell.setBox(12e-3, 12e-3, 13e-3)
    refused_by_plan_and_run("O.cell.hSize[2][2] = 0.013: must be 0.012", fluid)
    O.cell.setBox(12e-3, 12e-3, 12e-3)
    fluid.boundary = ["periodic"] * 4 + ["noSlip"] * 2
    refused_by_plan_and_run("O.cell.hSize[2][2] = 0.012: must be above 0.0", fluid)
    O.cell.setBox(12e-3, 12e-3, 25e-3)
    O.run(3, True)
    check(fluid.fluidSteps > 0, "fluid does not run once all is right")


def lubrication_is_not_counted_twice():
    fluid = one_sphere()
    O.engines = O.engines[:2] + [
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_LubricationPhys(eta=1)],
            [Law2_ScGeom_ImplicitLubricationPhys()],
        ),
        fluid,
        NewtonIntegrator(damping=0),
    ]
    refused_by_plan_and_run("Law2_ScGeom_ImplicitLubricationPhys in the InteractionLoop has lubrication of its own", fluid)
    fluid.lubrication = False
    said = fluid.plan().warnings
    check(any("also the part that the lattice resolves" in warning for warning in said), "no warning: %s" % said)
    O.run(3, True)
    check(fluid.fluidSteps > 0, "fluid does not run with the other law alone")


def attributes_are_fixed_once_the_fluid_exists():
    fluid = one_sphere()
    O.run(3, True)
    for name, value in dict(dx=2e-3, upper=(1, 1, 1), gravity=(0, 0, -1), tau=1.0, maxMach=0.1).items():
        check_raises(RuntimeError, "LbmEngine.%s cannot be changed any more" % name, lambda: setattr(fluid, name, value))
    fluid.mask, fluid.ids, fluid.label = 1, [0], "still"
    check_raises(ValueError, "a noSlip wall moves in its own plane", lambda: setattr(fluid, "boundaryVelocity", [(1, 0, 0)] + [(0, 0, 0)] * 5))
    check_raises(ValueError, "noSlip faces have no pressure", lambda: setattr(fluid, "boundaryPressure", [1] + [0] * 5))
    fluid.ids = [77]
    check_raises(RuntimeError, "LbmEngine.ids: body 77 does not exist", lambda: O.run(500, True))


def queries_need_a_fluid():
    fluid = one_sphere()
    for ask in (fluid.totalMass, lambda: fluid.getBoundaryFlux(0), lambda: fluid.getBoundaryForce(0), fluid.averageVelocity, lambda: fluid.fluidForce(0), lambda: fluid.velocity):
        check_raises(RuntimeError, "there is no fluid yet", ask)
    O.run(3, True)
    check_raises(ValueError, "body 5 was not in the fluid", lambda: fluid.fluidForce(5))
    clump = O.bodies.clump([0])
    check_raises(ValueError, "body %d is a clump, whose load is that of its members" % clump, lambda: fluid.fluidForce(clump))
    check_raises(ValueError, "getBoundaryFlux(6): must be 0 to 5", lambda: fluid.getBoundaryFlux(6))
    check_raises(ValueError, "", lambda: fluid.getVelocity((1, 1, 1)))
    for path in ("/no/such/folder/file.vti", pathlib.Path("/no/such/folder/file.vti")):
        check_raises(RuntimeError, "cannot write /no/such/folder/file.vti", lambda: fluid.saveVtk(path))
    check_raises(TypeError, "not int", lambda: fluid.saveVtk(5))


prove(
    values_out_of_range_are_refused_at_construction,
    the_box_is_a_whole_number_of_cells,
    choices_that_are_not_supported_are_refused,
    faces_must_make_sense,
    velocities_and_pressures_stand_at_faces_that_have_them,
    an_inflow_without_a_way_out_is_refused,
    a_pressure_that_the_lattice_cannot_hold_is_refused,
    other_kinds_and_names_are_refused,
    numpy_values_are_taken,
    missing_values_are_named,
    a_fluid_without_spheres_is_refused,
    unknown_ids_are_refused,
    spheres_that_the_lattice_cannot_hold_are_refused,
    a_position_that_is_not_a_number_is_refused,
    a_second_fluid_is_refused,
    a_place_where_loads_are_lost_is_refused,
    a_free_sphere_without_mass_is_refused,
    a_time_step_that_is_no_number_is_refused,
    a_time_step_of_very_many_fluid_steps_is_refused,
    too_fast_for_the_lattice_is_refused_before_the_run,
    too_fast_for_the_lattice_stops_the_run,
    a_state_that_cannot_be_kept_does_not_hide_the_reason,
    a_cell_that_is_not_the_box_is_refused,
    lubrication_is_not_counted_twice,
    attributes_are_fixed_once_the_fluid_exists,
    queries_need_a_fluid,
)
