"""A sphere released from rest in a periodic box, against the exact unsteady Stokes solution with the images of the box.

The drive takes the net weight up again, so that the momentum of fluid and sphere stays zero (tests/reference/periodic_bbo.csv says
how the solution was computed).
"""

import builtins
import csv

from claims import *

TAU, RADIUS, BOX = 0.6, 4.5, 36  # cells
SLOW = 1e-4  # Reynolds number: no inertia of the flow to speak of
OF_TERMINAL = 0.02  # error of the velocity at any time, of the terminal velocity
OF_CURRENT = 0.01  # of the current velocity, from the time FROM on
FROM, UNTIL = 0.3, 3  # R^2 / nu
DENSITY_RATIOS = (1.0, 1.05, 1.5, 2.5, 8.0)


def exact(density_ratio):
    """Terminal over Stokes velocity, and (t nu / R^2, U / U_terminal)."""
    with open(os.path.join(REFERENCE, "periodic_bbo.csv"), encoding="utf-8") as file:
        rows = [
            row
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
            if int(row["box_cells"]) == BOX and float(row["q"]) == density_ratio
        ]
    return float(rows[0]["Ut_over_stokes"]), [(float(row["t_nu_over_a2"]), float(row["U_over_Ut"])) for row in rows]


def release(density_ratio):
    """Scene of a sphere under a force of which gravity is only the carrier; returns the force's Stokes velocity."""
    nu, radius = FLUID["viscosity"] / FLUID["density"], RADIUS * FLUID["dx"]
    volume, cell = 4 / 3 * math.pi * radius**3, (BOX * FLUID["dx"]) ** 3
    stokes = SLOW * nu / radius
    force = 6 * math.pi * FLUID["viscosity"] * radius * stokes
    material = FrictMat(density=density_ratio * FLUID["density"])
    O.bodies.append(sphere([0.5 * BOX * FLUID["dx"] + 2e-4] * 3, radius, material=material))
    weight = force / (density_ratio * FLUID["density"] * volume)
    fluid = box([BOX] * 3, boundary=PERIODIC, acceleration=(0, 0, -force / (FLUID["density"] * cell)), tau=TAU)
    O.engines = engines(fluid, gravity=(0, 0, weight))
    O.dt = fluid_step(TAU)
    return stokes, radius**2 / nu


def velocities(duration):
    """Velocity of the sphere after each step of a run from rest: (duration / O.dt + 1) values."""
    builtins.recorded = [0.0]  # where the commands of a PyRunner look for names
    O.engines = O.engines + [PyRunner(command="recorded.append(O.bodies[0].state.vel[2])", iterPeriod=1, initRun=True)]
    O.run(math.ceil(duration / O.dt), True)
    return builtins.recorded


def check_release(density_ratio):
    terminal_ratio, solution = exact(density_ratio)
    stokes, unit = release(density_ratio)
    found = velocities(UNTIL * unit + O.dt)
    worst = worst_late = 0
    for time, ratio in solution:
        if time > UNTIL:
            break
        part, step = math.modf(time * unit / O.dt)
        speed = (1 - part) * found[int(step)] + part * found[int(step) + 1]
        error = speed / (terminal_ratio * stokes) - ratio
        worst = max(worst, abs(error))
        if time >= FROM:
            worst_late = max(worst_late, abs(error / ratio))
    print("  density ratio %g: %.2f %% of terminal, late %.2f %% of current" % (density_ratio, 100 * worst, 100 * worst_late))
    check(worst < OF_TERMINAL, "density ratio %g: off by %g of the terminal velocity" % (density_ratio, worst))
    check(worst_late < OF_CURRENT, "density ratio %g: off by %g of the current velocity" % (density_ratio, worst_late))


def released_spheres_follow_the_exact_solution():
    for density_ratio in DENSITY_RATIOS:
        O.reset()
        check_release(density_ratio)


def a_light_sphere_reaches_its_terminal_velocity():
    O.reset()
    terminal_ratio, _ = exact(0.5)
    stokes, unit = release(0.5)
    O.run(int(8 * unit / O.dt), True)
    check_close(O.bodies[0].state.vel[2] / (terminal_ratio * stokes), 1, OF_CURRENT, "terminal velocity")


prove(released_spheres_follow_the_exact_solution, a_light_sphere_reaches_its_terminal_velocity)
