"""A sphere settles in a closed box of silicone oil: the experiments of ten Cate et al. (2002), Phys. Fluids 14, 4012.

    scripts/yade -j2 -x -n scripts/examples/ten_cate.py [--case E1 E3] [--cells-per-diameter 10] [--magic-parameter 0.0833] [--output DIR]

Released at rest 120 mm above the floor; the run ends one cell above it. Prints the peak velocities beside the measured
ones and beside the terminal velocity in the box that follows from the drag of a sphere between six walls. Writes
velocity and gap of each case against time (CSV), a summary (JSON) and a plot.
"""

import argparse
import json
import math
import os
import sys
import time

from yade import O, utils
from yade.wrapper import FrictMat, ForceResetter, NewtonIntegrator, PyRunner

from yadelbm import LbmEngine

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
import tools  # noqa: E402

CASES = ("E1", "E2", "E3", "E4")
BOX = (0.100, 0.100, 0.160)   # [m]
DIAMETER = 0.015              # [m]
DENSITY = 1120.0              # of the sphere [kg/m3]
GRAVITY = (0, 0, -9.81)       # [m/s2]
RELEASE = 0.120               # height of the lowest point above the floor [m]
TAU = 0.8                     # aimed at; lower where the Mach number asks for it
MACH = 0.08                   # at the experiment's peak velocity
SLOW, FAST = 1 / 8, 1 / 12    # Lambda for grains that move at Re below and above 10 (user guide, "Limits today")
FINE_ENOUGH = 9.5             # cells per diameter from which on the peaks have to be right
E1_NOTE = """\
E1: the measured peak (0.0360 m/s) lies above the bound that Stokes drag between the six walls puts on it (0.0355 m/s,
    reached only without inertia after an endless fall). No correct simulation gets there; 0.034 to 0.0355 is right."""


def cell_size(cells_per_diameter):
    """Nearest size that divides all edges of the box into whole cells [m]."""
    common = 0.020  # of 100 and 160 mm
    return common / round(common / DIAMETER * cells_per_diameter)


def read_cases():
    """Fluid, experiment and computed terminal velocity of each case."""
    computed = tools.reference_rows("04_tencate_terminal_computed.csv")
    terminal = {row["case"]: float(row["u_terminal_computed"]) for row in computed}
    return {
        row["case"]: {
            "density": float(row["rho_f"]),
            "viscosity": float(row["mu_Pas"]),
            "peak": float(row["umax_expt_m_s"]),
            "terminal": terminal[row["case"]],
        }
        for row in tools.reference_rows("04_tencate_cases.csv")
    }


class Fall:
    """One case: the scene, and what is recorded of it."""

    def __init__(self, name, case, dx, magic_parameter):
        self.name, self.case, self.dx = name, case, dx
        nu = case["viscosity"] / case["density"]
        viscous_step = (TAU - 0.5) / 3 * dx**2 / nu
        acoustic_step = MACH / math.sqrt(3) * dx / case["peak"]
        reynolds = case["peak"] * DIAMETER / nu
        self.magic_parameter = (FAST if reynolds > 10 else SLOW) if magic_parameter is None else magic_parameter
        O.reset()
        O.dt = min(viscous_step, acoustic_step)
        O.materials.append(FrictMat(density=DENSITY, young=1e6, poisson=0.3, frictionAngle=0.5))
        self.tau = 0.5 + 3 * nu * O.dt / dx**2
        self.fluid = LbmEngine(lower=(0, 0, 0), upper=BOX, dx=dx, density=case["density"], viscosity=case["viscosity"],
                               tau=self.tau, gravity=GRAVITY, boundary=["noSlip"] * 6, magicParameter=self.magic_parameter, label="fluid")
        self.ball = O.bodies.append(utils.sphere((BOX[0] / 2, BOX[1] / 2, RELEASE + DIAMETER / 2), DIAMETER / 2))
        O.engines = [
            ForceResetter(),
            self.fluid,
            NewtonIntegrator(gravity=GRAVITY, damping=0),
            PyRunner(command="fall.record()", iterPeriod=5),
        ]
        self.history = [(0.0, 0.0, RELEASE / DIAMETER)]
        self.progress = tools.Progress(name)

    def record(self):
        """Called by YADE every few steps."""
        state = O.bodies[self.ball].state
        speed, gap = -state.vel[2], state.pos[2] - DIAMETER / 2
        if not math.isfinite(speed):
            raise RuntimeError(f"{self.name}: the velocity of the sphere is not finite at t = {O.time:g} s")
        self.history.append((O.time, speed, gap / DIAMETER))
        landed = gap < self.dx or (O.time > 0.5 and speed < 1e-3 * self.case["peak"])
        self.progress.show(min(1, (RELEASE - gap) / (RELEASE - self.dx)),
                           f"t = {O.time:6.3f} s, velocity {speed:.5f} m/s, gap {gap / DIAMETER:6.3f} d", force=landed)
        if landed:
            O.pause()

    def run(self):
        """Runs to the floor and returns the results."""
        print(self.fluid.plan(), flush=True)
        O.run()
        O.wait()
        times, speeds, _ = zip(*self.history)
        peak = max(speeds)
        case = self.case
        cells = round(BOX[0] / self.dx) * round(BOX[1] / self.dx) * round(BOX[2] / self.dx)
        return {
            "case": self.name,
            "peak": peak,
            "peak_time": times[speeds.index(peak)],
            "experiment": case["peak"],
            "error_percent": 100 * (peak / case["peak"] - 1),
            "terminal": case["terminal"],
            "against_terminal_percent": 100 * (peak / case["terminal"] - 1),
            "tau": self.tau,
            "magic_parameter": self.magic_parameter,
            "reynolds": peak * DIAMETER * case["density"] / case["viscosity"],
            "cells_per_diameter": DIAMETER / self.dx,
            "steps": O.iter,
            "seconds": self.progress.elapsed,
            "mlups": cells * O.iter / self.progress.elapsed / 1e6,
        }


def table(results):
    """The results as text."""
    lines = ["case      Re    tau   Lambda    peak [m/s]  measured    error     terminal   difference   steps    time"]
    for r in results:
        lines.append(f"{r['case']}    {r['reynolds']:5.2f}   {r['tau']:.3f}   {r['magic_parameter']:.4f}   {r['peak']:.5f}    "
                     f"{r['experiment']:.5f}   {r['error_percent']:+6.2f} %   {r['terminal']:.5f}   "
                     f"{r['against_terminal_percent']:+6.2f} %   {r['steps']:6d}  {r['seconds']:4.0f} s"
                     f"{'   (see note)' if r['case'] == 'E1' else ''}")
    if any(r["case"] == "E1" for r in results):
        lines.append(E1_NOTE)
    return "\n".join(lines)


def outside_bands(results):
    """Cases whose peak is not where it should be: within 3 % of the experiment, E1 between 0.034 and 0.0355 m/s."""
    return [r["case"] for r in results
            if not (0.034 <= r["peak"] <= 0.0355 if r["case"] == "E1" else abs(r["error_percent"]) <= 3)]


def draw(path, results, histories):
    """Velocity and gap of all cases against time, with the measured peaks."""
    figure, (left, right) = tools.plt.subplots(1, 2, figsize=(11, 4.6), constrained_layout=True)
    colours = dict(zip(CASES, ("#1b4965", "#2a9d8f", "#e9a03b", "#c8553d")))
    for r, history in zip(results, histories):
        t, speed, gap = zip(*history)
        colour = colours[r["case"]]
        left.plot(t, speed, color=colour, lw=2, label=f"{r['case']}, Re = {r['reynolds']:.1f}")
        left.plot(r["peak_time"], r["experiment"], "D", color=colour, ms=7, mfc="white", mew=1.6, clip_on=False)
        left.plot([0.72 * r["peak_time"], 1.28 * r["peak_time"]], [r["terminal"]] * 2, ":", color=colour, lw=1.2)
        right.plot(t, gap, color=colour, lw=2, label=r["case"])
    left.plot([], [], "kD", ms=6, mfc="white", mew=1.4, label="measured peak (ten Cate et al. 2002)")
    left.plot([], [], "k:", lw=1.2, label="terminal velocity in the box, computed")
    left.set(xlabel="time [s]", ylabel="settling velocity [m/s]", xlim=(0, None), ylim=(0, 0.165))
    right.set(xlabel="time [s]", ylabel="gap to the floor / diameter", xlim=(0, None), ylim=(0, None))
    left.legend(fontsize=8.5, ncol=2, loc="upper right")
    right.legend()
    cells = results[0]["cells_per_diameter"]
    figure.suptitle(f"Sphere of 15 mm settling in a box of 100 x 100 x 160 mm, {cells:.3g} cells per diameter",
                    fontsize=11)
    figure.savefig(path)
    tools.plt.close(figure)


def arguments():
    """Command line, as YADE passes it on."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                     prog="scripts/yade scripts/examples/ten_cate.py")
    parser.add_argument("--case", nargs="+", default=["all"], choices=CASES + ("all",), metavar="E1",
                        help="which experiments: E1, E2, E3, E4 or all (default)")
    parser.add_argument("--cells-per-diameter", type=float, default=10, metavar="N",
                        help="resolution (default: 10); the nearest that divides the box is taken")
    parser.add_argument("--magic-parameter", type=float, metavar="L",
                        help="Lambda of the two relaxation times (default: 1/8, above Re = 10 1/12)")
    parser.add_argument("--output", default=os.path.join("results", "ten_cate"), metavar="DIR",
                        help="folder for tables and the plot")
    return parser.parse_args(sys.argv[1:])


options = arguments()
folder = tools.output_folder(options.output)
names = CASES if "all" in options.case else [name for name in CASES if name in options.case]
cases, results, histories = read_cases(), [], []
begin = time.monotonic()
for name in names:
    fall = Fall(name, cases[name], cell_size(options.cells_per_diameter), options.magic_parameter)
    results.append(fall.run())
    histories.append(fall.history)
    tools.write_rows(os.path.join(folder, f"{name}.csv"), ("time_s", "velocity_m_s", "gap_over_d"), fall.history,
                     f"ten Cate {name}, {results[-1]['cells_per_diameter']:.4g} cells per diameter")
with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
    json.dump(results, file, indent=2)
plot = os.path.join(folder, "ten_cate.png")
draw(plot, results, histories)
print(f"\nSphere settling in a closed box (ten Cate et al. 2002), "
      f"{results[0]['cells_per_diameter']:.4g} cells per diameter, {time.monotonic() - begin:.0f} s")
print(table(results))
print(f"plot: {plot}", flush=True)
outside = outside_bands(results)
if outside and results[0]["cells_per_diameter"] > FINE_ENOUGH:
    sys.exit(f"{', '.join(outside)}: the peak velocity is off by more than 3 % (E1: outside 0.034 to 0.0355 m/s)")
