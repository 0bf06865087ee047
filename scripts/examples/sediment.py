"""Glass grains of mixed sizes settle in a box of viscous liquid and come to rest on each other.

    scripts/yade -j2 -x -n scripts/examples/sediment.py [--grains 300] [--cells-per-diameter 9] [--output DIR]

Grains of 1.6 to 2.4 mm in a water-glycerol mixture, 14 x 14 x 28 mm with six no-slip walls. YADE does the contacts
(Cundall and Strack's law with Coulomb friction), the fluid is resolved around every grain. The run ends when nothing
moves any more. Writes kinetic energy, unbalanced force and height against time (CSV), a summary (JSON) and a picture.
"""

import argparse
import json
import math
import os
import sys

import numpy as np
from yade import O, pack, utils
from yade.wrapper import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom,
                          Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
                          Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator,
                          PyRunner, Sphere)

from yadelbm import LbmEngine

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
import sediment_picture  # noqa: E402
import tools  # noqa: E402

WIDTH, HEIGHT = 14e-3, 28e-3          # [m]
DIAMETER, SPREAD = 2e-3, 0.2          # mean [m]; +- 20 %
GRAIN_DENSITY = 2500.0                # glass [kg/m3]
LIQUID_DENSITY, VISCOSITY = 1154.0, 0.0108   # water with 60 % of glycerol [kg/m3], [Pa s]
GRAVITY = 9.81                        # [m/s2]
YOUNG = 2.5e4                         # soft, so that contacts ring slower than the fluid steps; overlaps about 1 % [Pa]
TAU = 0.8                             # of the fluid
MACH = 0.08                           # of the fastest grain, estimated
REST_SPEED = 2e-3                     # of the speed of a lone grain: what counts as rest
REST_SHARE = 0.99                     # of the grains; without rolling friction a last one may roll about for long
REST_UNBALANCED = 0.02                # mean net force over mean contact force
REST_RECORDS = 5                      # so many records of rest in a row
TIME_LIMIT = 2.0                      # [s]
HIGHEST_BED_POROSITY = 0.5            # a looser bed than this would not be one


def arguments():
    """Command line, as YADE passes it on."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                     prog="scripts/yade scripts/examples/sediment.py")
    parser.add_argument("--grains", type=int, default=300, metavar="N", help="number of grains (default: 300)")
    parser.add_argument("--cells-per-diameter", type=float, default=9, metavar="N",
                        help="of the mean grain (default: 9)")
    parser.add_argument("--seed", type=int, default=1, help="of the initial cloud")
    parser.add_argument("--output", default=os.path.join("results", "sediment"), metavar="DIR",
                        help="folder for tables and the picture")
    return parser.parse_args(sys.argv[1:])


def lone_grain_speed(diameter=DIAMETER):
    """Terminal velocity of a single grain in unbounded liquid, drag after Schiller and Naumann [m/s]."""
    stokes = (GRAIN_DENSITY - LIQUID_DENSITY) * GRAVITY * diameter**2 / (18 * VISCOSITY)
    speed = stokes
    for _ in range(50):
        speed = stokes / (1 + 0.15 * (LIQUID_DENSITY * speed * diameter / VISCOSITY) ** 0.687)
    return speed


def bed_porosity(grains, bottom, top):
    """Share of the slab bottom < z < top that no grain fills, from the exact volumes of the grains' parts in it [-]."""

    def below(z, centre, r):  # volume of a sphere below the height z
        h = np.clip(z - centre + r, 0, 2 * r)
        return math.pi * h**2 * (r - h / 3)

    z, r = grains[:, 2], grains[:, 3]
    return 1 - (below(top, z, r) - below(bottom, z, r)).sum() / (WIDTH**2 * (top - bottom))


class Sediment:
    """The scene, and what is recorded of it."""

    def __init__(self, options):
        self.dx = WIDTH / round(WIDTH / DIAMETER * options.cells_per_diameter)
        cells = round(HEIGHT / self.dx)
        self.height = cells * self.dx
        nu = VISCOSITY / LIQUID_DENSITY
        self.speed_scale = lone_grain_speed(DIAMETER * (1 + SPREAD))
        fluid_step = min((TAU - 0.5) / 3 * self.dx**2 / nu, MACH / math.sqrt(3) * self.dx / self.speed_scale)
        smallest = DIAMETER / 2 * (1 - SPREAD)
        contact_step = 0.25 * smallest * math.sqrt(GRAIN_DENSITY / YOUNG)
        O.dt = fluid_step / math.ceil(fluid_step / contact_step)

        glass = FrictMat(density=GRAIN_DENSITY, young=YOUNG, poisson=0.3, frictionAngle=math.radians(25))
        material = O.materials.append(glass)
        for axis, size in enumerate((WIDTH, WIDTH, self.height)):
            O.bodies.append(utils.wall(0, axis=axis, sense=1, material=material))
            O.bodies.append(utils.wall(size, axis=axis, sense=-1, material=material))
        cloud = pack.SpherePack()
        margin = 0.05 * DIAMETER
        lower, upper = (margin, margin, 0.1 * self.height), (WIDTH - margin, WIDTH - margin, self.height - margin)
        made = cloud.makeCloud(lower, upper, rMean=DIAMETER / 2, rRelFuzz=SPREAD, num=options.grains, seed=options.seed)
        if made < options.grains:
            raise ValueError(f"grains = {options.grains}: only {made} fit into the box without touching; ask for fewer")
        cloud.toSimulation(material=material)
        self.ids = [body.id for body in O.bodies if isinstance(body.shape, Sphere)]

        self.fluid = LbmEngine(lower=(0, 0, 0), upper=(WIDTH, WIDTH, self.height), dx=self.dx, density=LIQUID_DENSITY,
                               viscosity=VISCOSITY, gravity=(0, 0, -GRAVITY), boundary=["noSlip"] * 6,
                               tau=0.5 + 3 * nu * fluid_step / self.dx**2, label="fluid")
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.1 * smallest),
            InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                            [Ip2_FrictMat_FrictMat_FrictPhys()],
                            [Law2_ScGeom_FrictPhys_CundallStrack()]),
            self.fluid,
            NewtonIntegrator(gravity=(0, 0, -GRAVITY), damping=0),
            PyRunner(command="sediment.record()", iterPeriod=25 * math.ceil(fluid_step / contact_step)),
        ]
        self.cells = round(WIDTH / self.dx) ** 2 * cells
        self.fluid_step = fluid_step
        self.history, self.pictures, self.calm, self.at_rest = [], [], 0, False
        grains = self.grains()
        self.volume = (4 / 3 * math.pi * grains[:, 3] ** 3).sum()
        self.start = self.mean_height(grains)
        self.expected_drop = self.start - self.volume / (1 - HIGHEST_BED_POROSITY) / WIDTH**2 / 2
        self.progress = tools.Progress("sediment")
        self.keep_picture("released")

    def grains(self):
        """Position, radius and speed of every grain, (grains, 5)."""
        bodies = [O.bodies[i] for i in self.ids]
        return np.array([(*body.state.pos, body.shape.radius, body.state.vel.norm()) for body in bodies])

    @staticmethod
    def mean_height(grains):
        """Height of the centre of mass of the grains [m]."""
        return np.average(grains[:, 2], weights=grains[:, 3] ** 3)

    def keep_picture(self, title):
        """Keeps the grains for the picture, and once there is one the flow."""
        picture = {"title": title, "time": O.time, "grains": self.grains(), "dx": self.dx, "box": (WIDTH, self.height)}
        if O.iter > 0:
            velocity, solid = np.array(self.fluid.velocity), np.array(self.fluid.solidFraction)
            row = velocity.shape[1] // 2
            picture["plane"] = (row + 0.5) * self.dx
            picture["velocity"], picture["solid"] = velocity[:, row, :, ::2].copy(), solid[:, row].copy()
        self.pictures.append(picture)

    def record(self):
        """Called by YADE every 25 fluid steps."""
        grains = self.grains()
        if not np.isfinite(grains).all():
            raise RuntimeError(f"the motion of the grains is not finite at t = {O.time:g} s")
        energy = 0.5 * (GRAIN_DENSITY * 4 / 3 * math.pi * grains[:, 3] ** 3 * grains[:, 4] ** 2).sum()
        unbalanced = utils.unbalancedForce()
        drop = self.start - self.mean_height(grains)
        self.history.append((O.time, energy, unbalanced, self.mean_height(grains), grains[:, 4].max()))
        if len(self.pictures) == 1 and drop > 0.5 * self.expected_drop:
            self.keep_picture("settling")
        fell = drop > 0.5 * self.expected_drop
        typical = np.quantile(grains[:, 4], REST_SHARE)
        settled = fell and typical < REST_SPEED * self.speed_scale and unbalanced < REST_UNBALANCED
        self.calm = self.calm + 1 if settled else 0
        self.at_rest = self.calm == REST_RECORDS
        # two stages: the fall, a straight line in time; then the last grains slow down, straight in the logarithm
        fall = min(1, max(0, drop / self.expected_drop))
        slow = np.clip(math.log(self.speed_scale / max(typical, 1e-12)) / math.log(1 / REST_SPEED), 0, 1)
        self.progress.show(1.0 if self.at_rest else 0.75 * fall + 0.25 * fall * slow,
                           f"t = {O.time:5.3f} s, 99 % of the grains slower than {1e3 * typical:8.4f} mm/s, kinetic energy "
                           f"{1e9 * energy:9.3g} nJ, unbalanced force {unbalanced:.2g}", force=self.at_rest)
        if self.at_rest or O.time > TIME_LIMIT:
            O.pause()

    def run(self):
        """Runs until rest and returns the results."""
        print(self.fluid.plan(), flush=True)
        O.run()
        O.wait()
        self.keep_picture("at rest" if self.at_rest else "not at rest")
        grains = self.grains()
        _, energies, unbalanced, heights, speeds = np.array(self.history).T
        top = np.quantile(grains[:, 2] + grains[:, 3], 0.9)
        steps = O.time / self.fluid_step
        members = set(self.ids)
        contacts = [i for i in O.interactions if i.isReal]
        between_grains = sum(i.id1 in members and i.id2 in members for i in contacts)
        return {
            "grains": len(grains),
            "cells_per_diameter": DIAMETER / self.dx,
            "at_rest": bool(self.at_rest),
            "time": O.time,
            "kinetic_energy": energies[-1],
            "kinetic_energy_over_peak": energies[-1] / energies.max(),
            "fastest_grain": speeds[-1],
            "speed_of_99_percent": np.quantile(grains[:, 4], REST_SHARE),
            "unbalanced_force": unbalanced[-1],
            "bed_height": top,
            "porosity": bed_porosity(grains, DIAMETER, top - DIAMETER),
            "contacts_per_grain": 2 * between_grains / len(grains),
            "largest_overlap": max((i.geom.penetrationDepth for i in contacts), default=0.0) / DIAMETER,
            "mean_height": heights[-1],
            "steps": round(steps),
            "seconds": self.progress.elapsed,
            "mlups": self.cells * steps / self.progress.elapsed / 1e6,
        }


def text(r):
    """The results as lines of text."""
    state = "at rest" if r["at_rest"] else "NOT AT REST at the time limit"
    return f"""\
Sediment: {r['grains']} grains, {r['cells_per_diameter']:.3g} cells per mean diameter
  {state} after {r['time']:.2f} s: 99 % of the grains slower than {1e3 * r['speed_of_99_percent']:.2g} mm/s, the fastest \
{1e3 * r['fastest_grain']:.2g} mm/s,
  kinetic energy {r['kinetic_energy_over_peak']:.1e} of its peak, unbalanced force {r['unbalanced_force']:.1e}
  bed {1e3 * r['bed_height']:.1f} mm high, porosity {r['porosity']:.3f}, {r['contacts_per_grain']:.1f} contacts \
per grain, largest overlap {100 * r['largest_overlap']:.2f} % of a diameter
  {r['steps']} fluid steps in {r['seconds']:.0f} s, {r['mlups']:.0f} million cell updates per second"""


options = arguments()
folder = tools.output_folder(options.output)
sediment = Sediment(options)
result = sediment.run()
tools.write_rows(os.path.join(folder, "sediment.csv"),
                 ("time_s", "kinetic_energy_J", "unbalanced_force", "mean_height_m", "fastest_grain_m_s"),
                 sediment.history, f"{result['grains']} settling grains")
with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
    json.dump(result, file, indent=2)
picture = os.path.join(folder, "sediment.png")
sediment_picture.draw(picture, sediment.pictures, sediment.history, sediment.speed_scale)
print()
print(text(result))
print(f"picture: {picture}", flush=True)
if not result["at_rest"]:
    sys.exit(f"the grains did not come to rest within {TIME_LIMIT} s")
