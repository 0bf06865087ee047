"""How a load of the fluid should reach grains that make several steps per fluid step: three schemes, measured.

    scripts/yade -n -x -j1 scripts/validate.d/time_coupling.py [--study release light fall contact] [--output DIR]

With the loads L of the present and the last fluid step the grains get, until the next one,

    held            L                       what LbmEngine does
    averaged        (L + L_last) / 2        less noise, later by half a fluid step
    extrapolated    (3 L - L_last) / 2      earlier by half a fluid step

All three hand over the same impulse in the long run. The other two are put on top of LbmEngine by a runner behind it.

Studies, each against the number of grain steps per fluid step, n:
release: a sphere starts from rest in a periodic box, against the exact solution; light: the smallest density ratio that is stable; fall: a sphere falls in a closed box at a Reynolds number of
about 4; contact: a sphere lies down on the floor, its contact undamped, ringing with the frequency omega: what motion is left, against omega
times the fluid step. Prints JSON, draws a plot.
"""

import argparse
import builtins
import csv
import json
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))

from yade import O, Vector3, utils  # noqa: E402
from yade.wrapper import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, FrictMat, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider,
                          InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack,
                          NewtonIntegrator, PyRunner)

from yadelbm import LbmEngine  # noqa: E402

SCHEMES = {"held": 0.0, "averaged": -0.5, "extrapolated": 0.5}  # times (L - L_last), on top of L
COUNTS = (1, 2, 5, 10, 50)
DENSITY, VISCOSITY, DX = 1000.0, 1e-2, 1e-3
NU = VISCOSITY / DENSITY


def fluid_step(tau):
    """Time step of the fluid [s]."""
    return (tau - 0.5) * DX**2 / (3 * NU)


class Coupling:
    """Adds to the load of body 0 what makes LbmEngine's scheme another one, and keeps its motion."""

    def __init__(self, fluid, scheme):
        self.fluid, self.factor = fluid, SCHEMES[scheme]
        self.steps, self.load, self.last = 0, None, None
        self.history = []  # at the beginning of each fluid step: time, position, velocity along z

    def correct(self):
        """Called by YADE between fluid and integrator."""
        if self.fluid.fluidSteps != self.steps:
            self.steps, self.last = self.fluid.fluidSteps, self.load
            self.load = self.fluid.fluidForce(0)
            state = O.bodies[0].state
            self.history.append((O.time, *state.pos, state.vel[2]))
        if self.factor and self.last is not None:
            O.forces.addF(0, self.factor * (self.load - self.last))


def start(fluid, scheme, gravity, contacts=()):
    """Completes a scene; returns its Coupling."""
    coupling = builtins.coupling = Coupling(fluid, scheme)
    O.engines = [ForceResetter(), *contacts, fluid, PyRunner(command="coupling.correct()", iterPeriod=1, initRun=True),
                 NewtonIntegrator(gravity=gravity, damping=0)]
    return coupling


def periodic_sphere(scheme, n, density_ratio, tau, radius, box):
    """A sphere at rest under a force that the drive takes up again; its Coupling and its Stokes velocity."""
    O.reset()
    R = radius * DX
    volume, cell = 4 / 3 * math.pi * R**3, (box * DX)**3
    stokes = 1e-4 * NU / R
    force = 6 * math.pi * VISCOSITY * R * stokes
    O.bodies.append(utils.sphere([0.5 * box * DX + 2e-4] * 3, R, material=FrictMat(density=density_ratio * DENSITY)))
    fluid = LbmEngine(upper=[box * DX] * 3, dx=DX, density=DENSITY, viscosity=VISCOSITY, tau=tau, boundary=["periodic"] * 6,
                      acceleration=(0, 0, -force / (DENSITY * cell)), stopFile='')
    O.dt = fluid_step(tau) / n
    return start(fluid, scheme, (0, 0, force / (density_ratio * DENSITY * volume))), stokes


def release(scheme, n, density_ratio, tau=0.6, radius=4.5, box=36):
    """Largest error of the velocity of a released sphere, of terminal, and of current from 0.3 R^2/nu on."""
    path = os.path.join(HERE, "..", "..", "tests", "reference", "periodic_bbo.csv")
    with open(path, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(line for line in file if not line.startswith("#"))
                if int(row["box_cells"]) == box and float(row["q"]) == density_ratio]
    coupling, stokes = periodic_sphere(scheme, n, density_ratio, tau, radius, box)
    terminal, unit = float(rows[0]["Ut_over_stokes"]) * stokes, (radius * DX)**2 / NU
    O.run(math.ceil(3 * unit / O.dt) + 2 * n, True)
    found = [row[4] for row in coupling.history]
    worst = late = 0.0
    for row in rows:
        time, ratio = float(row["t_nu_over_a2"]), float(row["U_over_Ut"])
        part, step = math.modf(time * unit / fluid_step(tau))
        if time > 3:
            break
        error = ((1 - part) * found[int(step)] + part * found[int(step) + 1]) / terminal - ratio
        worst = max(worst, abs(error))
        if time >= 0.3:
            late = max(late, abs(error / ratio))
    return {"worst_percent_of_terminal": 100 * worst, "late_percent_of_current": 100 * late}


def is_stable(scheme, density_ratio, tau, radius=4.5, box=20):
    """Whether a light sphere, released, stays below twice its Stokes velocity for 1500 steps."""
    coupling, stokes = periodic_sphere(scheme, 1, density_ratio, tau, radius, box)
    try:
        O.run(1500, True)
    except RuntimeError:
        return False
    return all(abs(row[4]) < 2 * stokes for row in coupling.history)


def light(scheme):
    """The smallest of some density ratios from which on all are stable, for each tau."""
    smallest = {}
    for tau in (0.52, 0.6, 1.0, 2.0):
        smallest[tau] = None
        for q in (1.0, 0.7, 0.5, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05):
            if not is_stable(scheme, q, tau):
                break
            smallest[tau] = q
    return smallest


def fall(scheme, n, tau=0.7, diameter=8, box=(24, 24, 48), height=36):
    """Trajectory of a sphere that falls towards the floor; the reference is `held` with n = 1."""
    O.reset()
    d = diameter * DX
    O.bodies.append(utils.sphere((0.5 * box[0] * DX, 0.5 * box[1] * DX, height * DX), d / 2, material=FrictMat(density=2.0 * DENSITY)))
    fluid = LbmEngine(upper=[c * DX for c in box], dx=DX, density=DENSITY, viscosity=VISCOSITY, tau=tau, gravity=(0, 0, -0.02))
    O.dt = fluid_step(tau) / n
    coupling = start(fluid, scheme, (0, 0, -0.02))
    while O.bodies[0].state.pos[2] > d / 2 + 2 * DX and O.iter < 1500 * n:
        O.run(20 * n, True)
    return {"times": [row[0] for row in coupling.history], "heights": [row[3] / d for row in coupling.history],
            "speeds": [-row[4] for row in coupling.history]}


def contact(scheme, omega_step, tau=0.7, diameter=8, box=(20, 20, 20)):
    """Motion left after a sphere has lain down on the floor, over its speed at touch-down."""
    O.reset()
    d, step = diameter * DX, fluid_step(tau)
    ratio, gravity = 2.5, 0.02
    mass = ratio * DENSITY * math.pi / 6 * d**3
    stiffness = mass * (omega_step / step)**2
    material = FrictMat(density=ratio * DENSITY, young=stiffness / d, poisson=0.3, frictionAngle=0)
    O.materials.append(material)
    O.bodies.append(utils.sphere((0.5 * box[0] * DX, 0.5 * box[1] * DX, d / 2 + DX), d / 2, material=material))
    O.bodies.append(utils.wall(0, axis=2, material=material))
    fluid = LbmEngine(upper=[c * DX for c in box], dx=DX, density=DENSITY, viscosity=VISCOSITY, tau=tau, gravity=(0, 0, -gravity))
    n = max(1, math.ceil(omega_step / 0.1))
    O.dt = step / n
    coupling = start(fluid, scheme, (0, 0, -gravity),
                     [InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
                      InteractionLoop([Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                                      [Law2_ScGeom_FrictPhys_CundallStrack()])])
    O.run(1500 * n, True)
    speeds = [abs(row[4]) for row in coupling.history]
    found = next((i for i in O.interactions if i.isReal), None)
    return {"n": n, "omega_step": step * math.sqrt(found.phys.kn / mass) if found else None,
            "largest_speed": max(speeds), "speed_left": max(speeds[-100:]) / max(speeds),
            "speed_halfway": max(speeds[700:800]) / max(speeds),
            "overlap_percent": 100 * (1 - O.bodies[0].state.pos[2] / (d / 2))}


def at(times, values, t):
    """Linear interpolation."""
    i = min(max(next((k for k, time in enumerate(times) if time >= t), len(times) - 1), 1), len(times) - 1)
    part = (t - times[i - 1]) / (times[i] - times[i - 1])
    return (1 - part) * values[i - 1] + part * values[i]


def compare_falls(runs):
    """Each run against `held` with one grain step per fluid step."""
    base = dict(runs["held"][1])
    peak = max(base["speeds"])
    for by_count in runs.values():
        for run in by_count.values():
            until = min(base["times"][-1], run["times"][-1])
            apart = [abs(at(run["times"], run["heights"], t) - at(base["times"], base["heights"], t))
                     for t in base["times"] if t < until]
            run["apart_percent_of_d"] = 100 * max(apart)
            run["peak_percent"] = 100 * (max(run["speeds"]) / peak - 1)
            for name in ("times", "heights", "speeds"):
                del run[name]
    return runs


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--study", nargs="+", default=["release", "light", "fall", "contact"])
    parser.add_argument("--output", default=None, metavar="DIR", help="folder for the JSON and the plot; default: print only")
    options = parser.parse_args(sys.argv[1:])
    results = {}
    if "release" in options.study:
        results["release"] = {str(q): {s: {n: release(s, n, q) for n in COUNTS} for s in SCHEMES} for q in (0.5, 1.05, 2.5)}
    if "light" in options.study:
        results["light"] = {s: light(s) for s in SCHEMES}
    if "fall" in options.study:
        results["fall"] = compare_falls({s: {n: fall(s, n) for n in COUNTS} for s in SCHEMES})
    if "contact" in options.study:
        results["contact"] = {s: [contact(s, w) for w in (0.2, 0.5, 1, 2, 3, 5, 10, 20)] for s in SCHEMES}
    print(json.dumps(results, indent=1))
    if options.output:
        os.makedirs(options.output, exist_ok=True)
        with open(os.path.join(options.output, "time_coupling.json"), "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
        draw(os.path.join(options.output, "time_coupling.png"), results)


def draw(path, results):
    """Errors of the release against n, and what motion is left in a contact."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for scheme, colour in zip(SCHEMES, ("#1b4965", "#2a9d8f", "#c8553d")):
        for q, line in (("0.5", ":"), ("1.05", "--"), ("2.5", "-")):
            by_count = results.get("release", {}).get(q, {}).get(scheme, {})
            left.loglog(list(by_count), [r["late_percent_of_current"] for r in by_count.values()], line, marker="o", ms=4,
                        color=colour, label=f"{scheme}, density ratio {q}")
        runs = results.get("contact", {}).get(scheme, [])
        right.loglog([r["omega_step"] for r in runs], [max(r["speed_left"], 1e-12) for r in runs], "o-", color=colour, label=scheme)
    left.set(xlabel="grain steps per fluid step", ylabel="error from 0.3 R²/ν on [% of current]")
    right.set(xlabel="contact frequency x fluid step", ylabel="speed left / speed at touch-down")
    left.legend(fontsize=7)
    right.legend()
    figure.savefig(path)


main()
