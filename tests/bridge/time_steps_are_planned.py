"""Which time step the fluid takes, and what a change of it during a run does."""

from claims import *
from yade.utils import wall

DRIVE = dict(boundary=PERIODIC, acceleration=(0.01, 0, 0))


def planned_steps_are_whole_numbers_of_grain_steps():
    for dt in (1e-5, 7e-5, 3.3e-4):
        O.reset()
        fluid = one_sphere(**DRIVE)
        O.dt = dt
        plan = fluid.plan()
        O.run(1, True)
        check(fluid.stepsPerFluidStep == round(fluid.stepsPerFluidStep) >= 1, "not whole: %r" % fluid.stepsPerFluidStep)
        check(plan.cells == fluid.cells == (12, 12, 12), "cells of the plan: %s" % (plan.cells,))
        check_close(fluid.fluidDt, plan.fluidDt, 1e-12 * plan.fluidDt, "plan and fluid differ")
        check_close(fluid.fluidDt, fluid.stepsPerFluidStep * dt, 1e-12 * dt, "fluid step")


def suggested_steps_and_cells_are_what_the_plan_takes():
    from yadelbm import LbmEngine

    O.materials.append(FrictMat(density=2500, young=1e5, poisson=0.3, frictionAngle=0.4))
    O.bodies.append(sphere((15e-3, 15e-3, 30e-3), 5e-3))
    fluid = LbmEngine(upper=(30e-3, 30e-3, 45e-3), density=1000, viscosity=1, gravity=(0, 0, -9.81))
    check_close(fluid.suggestDx(), 1.25e-3, 1e-12, "dx")  # eight cells per diameter
    fluid.dx = fluid.suggestDx()
    largest = 0.3 * utils.PWaveTimeStep()
    O.dt = fluid.suggestDt()
    check(0.5 * largest < O.dt <= largest, "O.dt = %g, largest %g" % (O.dt, largest))
    O.engines = engines(fluid, gravity=(0, 0, -9.81))
    plan = fluid.plan()
    if plan.stepsPerFluidStep > 1:
        check(0.019 < plan.estimatedError <= 0.02, "the accuracy is not used: %g" % plan.estimatedError)
    check(plan.ranking[0]["fluidDt"] == plan.fluidDt and len(plan.ranking) > 3, "ranking %s" % plan.ranking[:2])
    check_raises(ValueError, "beyond the budget of 0.001 GB", lambda: fluid.suggestDx(memory=1e6))
    memory = fluid.plan().memory
    fluid.lattice = "D3Q27"
    check_close(fluid.plan().memory / memory, 27 / 19, 0.02, "memory of the other lattice")
    check_raises(ValueError, "beyond the budget of 0.001 s", lambda: fluid.suggestDt(seconds=1e-3))
    check_raises(ValueError, "solid fraction = 1.5", lambda: fluid.suggestDx(solidFraction=1.5))
    for none in (0, -1, math.nan):
        check_raises(ValueError, "memory = %g: must be > 0 bytes" % none, lambda: fluid.suggestDx(memory=none))
        check_raises(ValueError, "seconds = %g: must be > 0 s" % none, lambda: fluid.suggestDx(seconds=none))
        check_raises(ValueError, "seconds = %g: must be > 0 s" % none, lambda: fluid.suggestDt(seconds=none))
    O.run(30, True)
    check(fluid.plan().cost != plan.cost or "assumed" in str(fluid.plan()), "the measured throughput is not used")


def one_fluid_step_per_grain_step_is_reached_by_choice_of_tau():
    """The spheres of ten Cate et al. (2002) at 9.75 cells per diameter."""
    import csv

    from yadelbm import LbmEngine

    with open(os.path.join(REFERENCE, "04_tencate_cases.csv"), encoding="utf-8") as file:
        cases = list(csv.DictReader(line for line in file if not line.startswith("#")))
    gains = []
    for case in cases:
        O.reset()
        material = O.materials.append(FrictMat(density=1120))
        O.bodies.append(sphere((0.05, 0.05, 0.1275), 7.5e-3, material=material))
        density, viscosity = float(case["rho_f"]), float(case["mu_Pas"])
        fluid = LbmEngine(upper=(0.1, 0.1, 0.16), dx=0.02 / 13, density=density, viscosity=viscosity, gravity=(0, 0, -9.81))
        O.engines = engines(fluid, gravity=(0, 0, -9.81))
        O.dt = fluid.suggestDt(largest=1)
        plan = fluid.plan()
        check_close(plan.stepsPerFluidStep, 1, 0, "grain steps per fluid step")
        check(plan.mach < 0.13 and 0.55 < plan.tau < 1, "Mach %g, tau %g" % (plan.mach, plan.tau))
        gains.append(float(str(plan).split("with tau = 1")[1].split("times")[0]))
    print("  work with tau = 1, over that of the plan: %s" % gains)
    check(gains[2] > 3 and gains[3] > 100, "gains %s" % gains)


def a_planned_tau_follows_a_change_of_the_time_step():
    """Steady flow past a fixed sphere; then O.dt changes by much, and by little."""
    fluid = one_sphere((10, 10, 10), radius=3e-3, inertia=False, boundary=PERIODIC, acceleration=(1e-3, 0, 0))
    O.dt = 1.2e-3  # tau 0.536
    O.run(12000, True)
    drag, first = fluid.fluidForce(0)[0], fluid.fluidDt
    for dt, follows in ((6e-3, True), (6.6e-3, False), (2e-3, True)):
        before = fluid.fluidDt
        O.dt = dt
        O.run(math.ceil(first / dt) + 8, True)
        check((fluid.fluidDt != before) == follows, "O.dt = %g: fluidDt %g after %g" % (dt, fluid.fluidDt, before))
        check_close(fluid.fluidForce(0)[0] / drag, 1, 1e-6, "drag after O.dt became %g" % dt)
        if follows:
            check_close(fluid.stepsPerFluidStep, round(fluid.stepsPerFluidStep), 1e-9, "not whole")


def a_settling_sphere_hardly_notices_a_change_of_the_time_step():
    """By a factor of 10, so that tau goes from 0.8 to 0.53; the sphere's terminal velocity is the measure."""
    fluid = one_sphere((14, 14, 24), radius=3e-3, fixed=False, inertia=False, accuracy=1)
    O.bodies[0].state.pos = (7e-3, 7e-3, 16e-3)
    O.engines = engines(fluid, gravity=(0, 0, -0.01))
    O.dt = 1e-2
    O.run(400, True)
    drag, speed, step = fluid.fluidForce(0)[2], O.bodies[0].state.vel[2], fluid.fluidDt
    O.dt = 1e-2 / 10
    for _ in range(40):
        O.run(10, True)
        check_close(fluid.fluidForce(0)[2] / drag, 1, 0.05, "drag")
        check_close(O.bodies[0].state.vel[2] / speed, 1, 0.01, "speed")
    check_close(fluid.fluidDt, step / 10, 1e-9 * step, "fluid step")


def a_change_of_tau_hardly_moves_a_sphere_that_gains_speed():
    """Three times the fluid step and back while it falls: less than 0.5 % of its diameter."""

    def fall(changes):
        O.reset()
        fluid = one_sphere((16, 16, 32), radius=4e-3, fixed=False, accuracy=1)
        O.bodies[0].state.pos = (8e-3, 8e-3, 26e-3)
        O.engines = engines(fluid, gravity=(0, 0, -0.1))
        O.dt = 1.5e-3  # tau 0.545
        O.run(300, True)
        if changes:
            O.dt = 4.5e-3  # 0.635
            O.run(100, True)
            check_close(fluid.fluidDt, 4.5e-3, 1e-9, "fluid step")
            O.dt = 1.5e-3
            O.run(300, True)
        else:
            O.run(600, True)
        check_close(fluid.fluidDt, 1.5e-3, 1e-9, "fluid step")
        check_close(O.time, 1.35, 1e-9, "time")
        return 26e-3 - O.bodies[0].state.pos[2]

    straight, changed = fall(False), fall(True)
    check(straight > 8e-3 / 2, "it has fallen %g m only" % straight)
    print("  apart by %.2g %% of d" % (100 * (changed - straight) / 8e-3))
    check_close(changed, straight, 0.005 * 8e-3, "distance fallen")


def a_time_stepper_runs_from_loose_grains_to_a_bed():
    """GlobalStiffnessTimeStepper shortens O.dt once grains touch; nobody gives tau."""
    bottom = dict(density=2500, young=5e3, poisson=0.3, frictionAngle=0.5)
    O.materials.append(FrictMat(**bottom))
    for layer in range(3):
        for i in range(4):
            x, y = 6e-3 + 12e-3 * (i % 2), 6e-3 + 12e-3 * (i // 2)
            jitter = 1e-3 * math.sin(5 * i + 3 * layer)
            O.bodies.append(sphere((x + jitter, y - jitter, 8e-3 + 11e-3 * layer + jitter), 4e-3))
    for axis, length in enumerate((24e-3, 24e-3, 42e-3)):
        O.bodies.append(wall(0, axis=axis, sense=1))
        O.bodies.append(wall(length, axis=axis, sense=-1))
    fluid = box((24, 24, 42), gravity=(0, 0, -0.1))
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys()],
            [Law2_ScGeom_FrictPhys_CundallStrack()],
        ),
        fluid,
        GlobalStiffnessTimeStepper(active=True, timeStepUpdateInterval=7, timestepSafetyCoefficient=0.3, defaultDt=8e-3),
        NewtonIntegrator(gravity=(0, 0, -0.1), damping=0),
    ]
    O.dt = 8e-3
    steps, grains = set(), [b for b in O.bodies if isinstance(b.shape, Sphere)]
    fastest = 0
    while O.time < 24:  # the topmost grain tilts off the others for some ten seconds before it rests
        O.run(50, True)
        steps.add((O.dt, fluid.fluidDt))
        fastest = max(fastest, max(b.state.vel.norm() for b in grains))
        lead = fluid.fluidTime - O.time
        check(-8e-3 <= lead < 2 * fluid.fluidDt, "the fluid is %g s ahead" % lead)
    grain_steps = sorted({dt for dt, _ in steps})
    print("  O.dt %.3g to %.3g, fluidDt %s, tau NaN" % (grain_steps[0], grain_steps[-1], sorted({f for _, f in steps})))
    check(grain_steps[0] < 0.7 * grain_steps[-1], "the time stepper changed nothing: %s" % grain_steps)
    check(math.isnan(fluid.tau), "tau = %g" % fluid.tau)
    speeds = sorted(b.state.vel.norm() for b in grains)
    heights = sorted(b.state.pos[2] for b in grains)
    print("  fastest %.3g m/s, at the end %.2g; highest grain %.3g m" % (fastest, speeds[-1], heights[-1]))
    check(heights[-1] < 20e-3, "the grains are no bed: highest at %g m" % heights[-1])
    check(speeds[-1] < 1e-2 * fastest, "the bed moves at %g m/s" % speeds[-1])


prove(
    planned_steps_are_whole_numbers_of_grain_steps,
    suggested_steps_and_cells_are_what_the_plan_takes,
    one_fluid_step_per_grain_step_is_reached_by_choice_of_tau,
    a_planned_tau_follows_a_change_of_the_time_step,
    a_settling_sphere_hardly_notices_a_change_of_the_time_step,
    a_change_of_tau_hardly_moves_a_sphere_that_gains_speed,
    a_time_stepper_runs_from_loose_grains_to_a_bed,
)
