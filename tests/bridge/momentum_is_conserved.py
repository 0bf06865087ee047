"""Fluid and grains together, in a periodic box without weight or drive, looked at after every step of the grains."""

from claims import *

TAU = 0.6
ROUND_OFF = 1e-10  # of the momentum that is exchanged; thousands of cells and hundreds of steps in double precision


def scene_of_three(ratio, density_ratio, touch=False):
    fluid = box((18, 20, 16), tau=TAU, boundary=PERIODIC)
    material = FrictMat(density=1000 * density_ratio, young=1e4, poisson=0.3, frictionAngle=0.5)
    gap = 6.99e-3 if touch else 8e-3
    places = [(5e-3, 8e-3, 10e-3), (5e-3 + gap, 8e-3, 10.2e-3), (10e-3, 16e-3, 5e-3)]
    O.bodies.append([sphere(place, 3.5e-3, material=material) for place in places])
    O.bodies[0].state.vel = (2e-3, 0, 1e-3)
    O.bodies[1].state.vel = (-3e-3, 1e-3, 0)
    O.bodies[2].state.angVel = (0, 0, 2)
    O.engines = engines(fluid)
    O.dt = fluid_step(TAU) / ratio
    return fluid


def total(fluid):
    return fluid.totalMomentum() + sum((b.state.mass * b.state.vel for b in O.bodies), Vector3.Zero)


def check_conservation(ratio, steps, **more):
    fluid = scene_of_three(ratio, **more)
    start = sum((b.state.mass * b.state.vel for b in O.bodies), Vector3.Zero)
    scale = sum(b.state.mass * b.state.vel.norm() for b in O.bodies)
    worst = 0
    for i in range(steps):
        O.run(1, True)
        worst = max(worst, (total(fluid) - start).norm() / scale)
        check(worst < ROUND_OFF, "ratio %g, step %d: off by %g of the scale" % (ratio, O.iter, worst))
    moved = (O.bodies[0].state.vel - Vector3(2e-3, 0, 1e-3)).norm()
    check(moved > 1e-4, "nothing was exchanged")
    print("  ratio %g: momentum conserved to %.1e" % (ratio, worst))


def one_grain_step_per_fluid_step():
    check_conservation(1, 50, density_ratio=2.5)


def five_grain_steps_per_fluid_step():
    check_conservation(5, 100, density_ratio=1.5)


def ratios_that_are_not_whole():
    for ratio in (2.5, 0.4):
        O.reset()
        check_conservation(ratio, 30, density_ratio=2)


def grains_in_contact():
    check_conservation(5, 100, density_ratio=2, touch=True)


def a_time_step_that_changes():
    fluid = scene_of_three(5, density_ratio=2)
    start = sum((b.state.mass * b.state.vel for b in O.bodies), Vector3.Zero)
    scale = sum(b.state.mass * b.state.vel.norm() for b in O.bodies)
    step = fluid_step(TAU)
    O.engines = O.engines[:4] + [PyRunner(command="O.dt = nextDt", iterPeriod=1)] + O.engines[4:]
    import builtins

    for i in range(40):
        builtins.nextDt = step * (0.15 + 0.13 * math.sin(i))
        O.run(1, True)
        check_close((total(fluid) - start).norm() / scale, 0, ROUND_OFF, "step %d" % O.iter)


prove(
    one_grain_step_per_fluid_step,
    five_grain_steps_per_fluid_step,
    ratios_that_are_not_whole,
    grains_in_contact,
    a_time_step_that_changes,
)
