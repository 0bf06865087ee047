"""Channels: flows between faces, in ducts and in a round pipe."""

import math
import os
import tempfile

import numpy as np
from scipy.special import j0, j1, jn_zeros

from .case import Case, Figure, Row, Run, Spread, groups, observed_order
from .engine import lbm, offsets, read_vti, reference, stokes, yade
from .plotting import COLOURS
from .report import percent, table

WALLS = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
DRIVE = 1e-6
DUCTS = {float(row["AR"]): float(row["umean_over_Gb2_mu"]) for row in reference("01_duct_flowrate.csv")}


def poiseuille(n, magic_parameter, tau):
    """Mean of the velocities at the nodes between two plates n cells apart, in units of G / mu."""
    case = stokes((1, 1, n), [], tau, 1e-14, acceleration=[DRIVE, 0, 0], boundaries={"z": WALLS}, magic_parameter=magic_parameter)
    result = lbm(case)
    return {"mean": result["superficial_velocity"][0] / DRIVE, "cells": n, "steps": result["steps"]}


def duct(ratio, n, magic_parameter, tau, lattice="D3Q19"):
    """Mean velocity in a rectangular duct with n cells along its short side, in units of G b^2 / mu, b half of it."""
    case = stokes((1, round(ratio * n), n), [], tau, 1e-9, acceleration=[DRIVE, 0, 0], boundaries={"y": WALLS, "z": WALLS},
                  magic_parameter=magic_parameter, lattice=lattice)
    result = lbm(case)
    return {"mean": result["superficial_velocity"][0] / DRIVE / (n / 2) ** 2, "cells": result["cells"], "steps": result["steps"]}


def pipe(radius, offset, tau, lattice="D3Q19"):
    """Flow rate in a round pipe, in units of pi G R^4 / (8 mu)."""
    n = 2 * radius + 6
    solid = {"shape": "pipe", "axis": "x", "center": [0.5, n / 2 + offset[1], n / 2 + offset[2]], "radius": radius}
    result = lbm(stokes((1, n, n), [solid], tau, 1e-8, acceleration=[DRIVE, 0, 0], lattice=lattice))
    rate = result["superficial_velocity"][0] * n * n / DRIVE
    return {"rate": rate / (math.pi * radius**4 / 8), "cells": result["cells"], "steps": result["steps"]}


def pipe_start(radius, tau, time):
    """Start-up in a round pipe at nu t / R^2 = `time`: velocities at the centres of the cells that lie in the bore, over the steady maximum, and their distances from the axis over R."""
    n = 2 * radius + 6
    nu = (tau - 0.5) / 3
    centre = n / 2 + 0.2, n / 2 + 0.35
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "pipe.vti")
        case = stokes((1, n, n), [{"shape": "pipe", "axis": "x", "center": [0.5, *centre], "radius": radius}], tau, 0, acceleration=[DRIVE, 0, 0],
                      lattice="D3Q19", output={"vtk": path})
        case["stop"]["max_steps"] = round(time * radius**2 / nu)
        result = lbm(case)
        velocity = read_vti(path, "velocity").reshape(n, n, 3)[:, :, 0]
    z, y = np.meshgrid(np.arange(n) + 0.5 - centre[1], np.arange(n) + 0.5 - centre[0], indexing="ij")
    distance = np.hypot(y, z) / radius
    inside = distance < 1 - 0.75 / radius
    return {"s": distance[inside].round(6).tolist(), "u": (velocity[inside] / (DRIVE * radius**2 / 4)).astype(float).round(7).tolist(),
            "rate": result["superficial_velocity"][0] * n * n / DRIVE / (math.pi * radius**4 / 8), "T": result["steps"] * nu / radius**2, "cells": result["cells"], "steps": result["steps"]}


def transient(kind, n, tau, times):
    """Velocities at the nodes of a channel of n cells at dimensionless times (see scenes/channel.py)."""
    return yade("channel.py", {"kind": kind, "n": n, "tau": tau, "times": times})


def oscillating(alpha, n, tau, periods):
    """Complex amplitude at the nodes of a channel of n cells, one plate of which oscillates (see scenes/channel.py)."""
    return yade("channel.py", {"kind": "oscillating", "alpha": alpha, "n": n, "tau": tau, "periods": periods})


TIMES = (0.02, 0.05, 0.1, 0.2, 0.5)
ALPHAS = {2: 2, 5: 4, 10: 10}  # H sqrt(omega/nu): periods until the start is forgotten


def runs(quick):
    for n in (4, 8, 16):
        for magic in (0.125, 0.1875):
            for tau in (0.6, 1.0, 5.0):
                yield Run(poiseuille, {"n": n, "magic_parameter": magic, "tau": tau}, 1e-3)
    for ratio in DUCTS:
        for n in (8, 16, 32):
            for magic in (1 / 12, 0.125, 0.1875):
                yield Run(duct, {"ratio": ratio, "n": n, "magic_parameter": magic, "tau": 2.0}, 2e-2)
            yield Run(duct, {"ratio": ratio, "n": n, "magic_parameter": 0.125, "tau": 2.0, "lattice": "D3Q27"}, 3e-2)
    for radius in (4, 8, 16) if quick else (4, 6, 8, 12, 16, 24):
        for offset in offsets(8):
            yield Run(pipe, {"radius": radius, "offset": offset, "tau": 1.0}, 0.02 * (radius / 8) ** 3)
            if radius in (8, 16):
                yield Run(pipe, {"radius": radius, "offset": offset, "tau": 1.0, "lattice": "D3Q27"}, 0.03 * (radius / 8) ** 3)
    for radius in (8, 16):
        for time in TIMES:
            yield Run(pipe_start, {"radius": radius, "tau": 0.8, "time": time}, 2e-3)
    for n in (16, 32):
        for kind in ("couette", "poiseuille"):
            yield Run(transient, {"kind": kind, "n": n, "tau": 0.8, "times": TIMES}, 0.3)
    for alpha, periods in ALPHAS.items():
        for n in (16, 32):
            yield Run(oscillating, {"alpha": alpha, "n": n, "tau": 0.8, "periods": periods}, 0.2)


def nodal_mean(n):
    """Mean over the nodes of the exact parabola between plates n cells apart, in units of G / mu."""
    y = np.arange(n) + 0.5
    return float(np.mean(y * (n - y) / 2))


def poiseuille_error(result):
    """With Lambda = 3/16 of the velocities at the nodes, with 1/8 of the flow rate."""
    n = result["n"]
    return result["mean"] / (nodal_mean(n) if result["magic_parameter"] == 0.1875 else n * n / 12) - 1


def start_up(kind, time, s):
    """Exact velocity of a start-up flow over its steady maximum: the series of 01_startup.csv, at any s."""
    k = np.arange(1, 400)[:, None]
    if kind == "couette":
        modes = 2 / np.pi * (-1.0) ** k / k * np.exp(-((k * np.pi) ** 2) * time) * np.sin(k * np.pi * s)
        return s + modes.sum(0)
    k = 2 * k - 1
    modes = 32 / (np.pi * k) ** 3 * np.exp(-((k * np.pi) ** 2) * time) * np.sin(k * np.pi * s)
    return 4 * s * (1 - s) - modes.sum(0)


ZEROS = jn_zeros(0, 60)


def pipe_start_up(time, s):
    """The same in a round pipe, s = r / R."""
    modes = 8 / (ZEROS**3 * j1(ZEROS)) * np.exp(-(ZEROS**2) * time)
    return 1 - s**2 - (modes[:, None] * j0(ZEROS[:, None] * s)).sum(0)


def pipe_rate(time):
    """Flow rate of the start-up in a pipe, over the steady one."""
    return 1 - float((32 / ZEROS**4 * np.exp(-(ZEROS**2) * time)).sum())


def check_series():
    """Largest difference of the start-up flows from the reference table."""
    worst = 0
    for row in reference("01_startup.csv"):
        t, s = float(row["T"]), np.array([float(row["s"])])
        worst = max(worst, abs(pipe_start_up(t, s)[0] - float(row["pipe_u_over_umax_steady"])))
        for kind, column in (("couette", "couette_u_over_U"), ("poiseuille", "poiseuille_u_over_umax_steady")):
            worst = max(worst, abs(start_up(kind, t, s)[0] - float(row[column])))
    return worst


def plate(alpha, s):
    """Complex amplitude between an oscillating plate (s = 0) and a fixed one (s = 1): the solution of 01_oscillating_plate_gap.csv."""
    root = alpha * np.sqrt(1j)
    return np.sinh(root * (1 - s)) / np.sinh(root)


def check_plate():
    """Largest difference of `plate` from the reference table."""
    return max(abs(plate(float(row["alpha_H"]), float(row["s"])) - float(row["Re"]) - 1j * float(row["Im"]))
               for row in reference("01_oscillating_plate_gap.csv"))


def transient_error(result):
    """Largest error at any node and time, over the steady maximum."""
    s = (np.arange(result["n"]) + 0.5) / result["n"]
    return max(float(np.abs(np.array(u) - start_up(result["kind"], t, s)).max()) for t, u in zip(result["times"], result["profiles"]))


def oscillating_error(result):
    """Largest error of the complex amplitude, over that of the plate."""
    s = (np.arange(result["n"]) + 0.5) / result["n"]
    found = np.array(result["real"]) + 1j * np.array(result["imaginary"])
    return float(np.abs(found - plate(result["alpha"], s)).max())


def lattice(result):
    return result.arguments.get("lattice", "D3Q19")


def of(results, function):
    return [r for r in results if r.function == function.__name__]


def pipes(results, name):
    return [r for r in of(results, pipe) if lattice(r) == name]


def rows(results):
    found = []
    for (magic,), group in groups(of(results, poiseuille), "magic_parameter").items():
        worst = max(abs(poiseuille_error(r)) for r in group)
        what = "velocities (their mean)" if magic == 0.1875 else "flow rate"
        found.append(Row(f"Poiseuille, {what}, Lambda = {magic:g}", "H = 4 ... 16", "0.6 ... 5", worst, 1e-10))
    for r in of(results, duct):
        target = 1e-3 if r["n"] == 16 and r["ratio"] == 1 else None
        found.append(Row(f"flow rate, duct {r['ratio']:g} : 1, {lattice(r)}, Lambda = {r['magic_parameter']:.3g}", f"2b = {r['n']}", "2",
                         r["mean"] / DUCTS[r["ratio"]] - 1, target))
    for name in ("D3Q19", "D3Q27"):
        for (radius,), group in groups(pipes(results, name), "radius").items():
            s = Spread.of(r["rate"] - 1 for r in group)
            found.append(Row(f"flow rate, round pipe, {name}", f"R = {radius}", "1", s.mean, {8: 0.02, 16: 0.005}.get(radius), s.worst, s.scatter))
    for (radius,), group in groups(of(results, pipe_start), "radius").items():
        worst = max((float(np.abs(np.array(r["u"]) - pipe_start_up(r["T"], np.array(r["s"]))).max()) for r in group))
        found.append(Row("start-up, pipe, largest error / steady maximum", f"R = {radius}", f"{group[0]['tau']:g}", worst))
        found.append(Row("start-up, pipe, flow rate / steady one", f"R = {radius}", f"{group[0]['tau']:g}", max((r["rate"] - pipe_rate(r["T"]) for r in group), key=abs)))
    for r in of(results, transient):
        found.append(Row(f"start-up, {r['kind']}, largest error / steady maximum", f"H = {r['n']}", f"{r['tau']:g}", transient_error(r)))
    for r in of(results, oscillating):
        found.append(Row(f"oscillating plate, H sqrt(omega/nu) = {r['alpha']:g}, largest error of the amplitude", f"H = {r['n']}",
                         f"{r['tau']:g}", oscillating_error(r)))
    return found


def text(results):
    sizes = groups(pipes(results, "D3Q19"), "radius")
    order = observed_order([radius for radius, in sizes], [Spread.of(r["rate"] - 1 for r in g).mean for g in sizes.values()])
    orders = []
    ducts = {}
    for r in of(results, duct):
        ducts.setdefault((r["ratio"], lattice(r), r["magic_parameter"]), []).append(r)
    for (ratio, name, magic), group in ducts.items():
        group.sort(key=lambda r: r["n"])
        errors = [r["mean"] / DUCTS[ratio] - 1 for r in group]
        orders.append((f"{ratio:g} : 1", name, f"{magic:.3g}", *map(percent, errors), f"{observed_order([r['n'] for r in group], errors):.2f}"))
    return f"""
Ducts: the flow rate is the sum over cells, whose midpoint rule alone is off by 1/(2 N^2) for a parabola; walls with Lambda = 1/8 make up for it, exactly between plates. In a duct the lattice's Laplacian counts too. That of D3Q19 couples
a cell of the cross-section with four neighbours, with an error along the fourth derivatives d4/dy4 + d4/dz4; that of D3Q27, with eight, is isotropic: its error, the Laplacian of the Laplacian, vanishes for a flow whose Laplacian is uniform. So D3Q27
with Lambda = 1/8, its default, has nearly no error (`lbm run` takes it for ducts and pipes unless told otherwise), and D3Q19 has the least with a Lambda of 0.073, where the walls' error makes up for that of the corners.

{table(("duct", "lattice", "Lambda", "2b = 8", "16", "32", "order"), orders)}

Start-up in the pipe: the largest errors are next to the wall, where a velocity is off by what a wall 0.06 cells further out would give, at any radius (first order there); the flow rate converges with second order.

Round pipe: observed order {order:.1f} of the mean error (D3Q19). The series used at the nodes agree with the tables of the reference folder to {check_series():.0e}
(start-up) and {check_plate():.0e} (oscillating plate).
"""


def figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        s = np.linspace(0, 1, 200)
        chosen = [r for r in of(results, transient) if r["kind"] == "couette"][-1:]
        for r in chosen:
            for t, u, colour in zip(r["times"], r["profiles"], COLOURS):
                left.plot(start_up("couette", t, s), s, color=colour, lw=1)
                left.plot(u, (np.arange(r["n"]) + 0.5) / r["n"], "o", color=colour, ms=3, label=f"nu t / H^2 = {t:g}")
        left.set(xlabel="u / U", ylabel="z / H", title="plate set into motion")
        left.legend()
        for r, colour in zip([r for r in of(results, oscillating) if r["n"] == 32], COLOURS):
            right.plot(s, np.abs(plate(r["alpha"], s)), color=colour, lw=1)
            amplitude = np.hypot(r["real"], r["imaginary"])
            right.plot((np.arange(32) + 0.5) / 32, amplitude, "o", color=colour, ms=3, label=f"H sqrt(omega/nu) = {r['alpha']:g}")
        if not of(results, oscillating):
            right.axis("off")
            return
        right.set(xlabel="z / H", ylabel="amplitude / U", title="oscillating plate")
        right.legend()

    return [Figure("channels", "Lines: exact solutions. Points: velocities at the nodes.", draw, (9, 4))]


CHANNELS = Case(
    name="channels",
    title="Channels, ducts and a pipe",
    solved="""
Poiseuille flow between no-slip faces, in rectangular ducts of faces, and in a round pipe that is a solid of partially filled cells (8 sub-cell offsets); plane
start-up flows, that in the pipe (velocities in the bore, three quarters of a cell and more from its wall), and an oscillating plate with `LbmEngine` (a moving face whose velocity changes in every step).""",
    reference="""
Exact: `01_plane_couette_pipe_profiles.csv`, `01_duct_flowrate.csv` (Fourier series), `01_startup.csv`, `01_oscillating_plate_gap.csv`.""",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
