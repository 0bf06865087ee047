"""Fixed spheres through YADE and through the program `lbm`, from the same numbers: the flow is the same."""

import json
import os
import subprocess
import tempfile

from claims import *

SAME = 1e-6  # relative; the time step is planned from another number on the way, which costs round-off only
CELLS, STEPS, TAU, DRIVE = 14, 300, 0.8, 1e-3
RADIUS = FLUID["dx"] * CELLS * (3 * 0.125 / (4 * math.pi)) ** (1 / 3)


def alone():
    centre = 0.5 * CELLS * FLUID["dx"]
    case = {
        "domain": {"cells": [CELLS] * 3, "dx": FLUID["dx"]},
        "fluid": {"density": FLUID["density"], "viscosity": FLUID["viscosity"]},
        "tau": TAU,
        "inertia": False,
        "boundaries": {axis: "periodic" for axis in "xyz"},
        "acceleration": [DRIVE, 0, 0],
        "solids": [{"shape": "sphere", "center": [centre] * 3, "radius": RADIUS, "moving": False}],
        "stop": {"steady": 0, "max_steps": STEPS},
    }
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "case.json")
        with open(path, "w") as file:
            json.dump(case, file)
        run = subprocess.run([os.environ["LBM_PROGRAM"], "run", path], stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(run.stdout)


def a_cubic_array_is_the_same():
    fluid = one_sphere([CELLS] * 3, RADIUS, boundary=PERIODIC, acceleration=(DRIVE, 0, 0), tau=TAU, inertia=False)
    O.dt = fluid_step(TAU)
    O.run(STEPS, True)
    result = alone()
    check(result["steps"] == fluid.fluidSteps == STEPS, "%s steps, %d steps" % (result["steps"], fluid.fluidSteps))
    force = result["solids"][0]["force"][0]
    check_close(fluid.fluidForce(0)[0], force, SAME * abs(force), "force")
    speed = result["superficial_velocity"][0]
    check_close(fluid.averageVelocity()[0], speed, SAME * abs(speed), "superficial velocity")


prove(a_cubic_array_is_the_same)
