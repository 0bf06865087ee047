"""Pretends that YADE's objects are laid out differently, in many ways; then loads for real."""

import os
import sys

from claims import *

DIFFERENCES = [
    "State.pos=96", "State.vel=160", "State.mass=184", "State.angVel=192", "State.inertia=240", "State.blockedDOFs=320",
    "sizeof State=336", "Sphere.radius=80", "Body.id=32", "Body.groupMask=32", "Body.state=64", "Body.shape=80",
    "Body.clumpId=156", "Engine.scene=32", "Engine.dead=65", "Engine.ompThreads=72", "Engine.label=80", "Scene.dt=432",
    "Scene.iter=456", "Scene.time=472", "Scene.isPeriodic=500", "Scene.engines=576", "Scene.bodies=616", "Scene.cell=704",
    "Scene.forces=40", "Cell.hSize=740", "BodyContainer.body=32", "Engine::action=96", "sizeof Scene=900",
    "NewtonIntegrator.gravity=256",
]  # fmt: skip


def forget():
    for name in [name for name in sys.modules if name.startswith("yadelbm")]:
        del sys.modules[name]


def every_difference_gives_one_clear_error():
    for difference in DIFFERENCES:
        os.environ["YADELBM_SIMULATE_LAYOUT"] = difference
        forget()

        def load():
            import yadelbm

        message = check_raises(ImportError, difference.split("=")[0], load)
        for part in ("YADE found: 2023.02a", "declared: 2023.02a", "First difference: ", "Way out: "):
            check(part in message, "%r does not say %r" % (message, part))
    print(message)


def yade_goes_on_after_a_refusal():
    import yade.wrapper

    check(not hasattr(yade.wrapper, "LbmEngine"), "class registered in spite of the refusal")
    O.bodies.append([sphere((0, 0, 0), 1), sphere((0, 0, 1.9), 1)])
    O.engines = engines(PyRunner(command="pass", iterPeriod=1), gravity=(0, 0, -1))
    O.dt = 1e-4
    O.run(100, True)
    check(O.iter == 100 and O.bodies[1].state.vel[2] > 0, "YADE does not run")


def the_true_layout_loads_afterwards():
    del os.environ["YADELBM_SIMULATE_LAYOUT"]
    forget()
    O.bodies.append([sphere((0, 0, 0), 1), sphere((0, 0, 3), 1)])
    O.dt, forces = 1.25e-4, [O.forces.f(i) for i in (0, 1)]
    import yadelbm

    check(O.dt == 1.25e-4 and O.time == 0 and O.iter == 0 and len(O.bodies) == 2, "loading left traces in the scene")
    check([O.forces.f(i) for i in (0, 1)] == forces, "loading left forces in the scene: %s" % [O.forces.f(i) for i in (0, 1)])
    O.reset()
    fluid = one_sphere()
    O.run(5, True)
    check(fluid.fluidSteps > 0, "fluid does not run")


prove(every_difference_gives_one_clear_error, yade_goes_on_after_a_refusal, the_true_layout_loads_afterwards)
