"""Single spheres: between walls, turning, towed through the lattice, in shear."""

import math

import numpy as np

from .case import Case, Figure, Row, Run, Spread, groups
from .channels import of
from .engine import lbm, offsets, reference, sphere, stokes, yade
from .plotting import COLOURS, MARKERS

WALLS = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
SC_K = {float(row["c"]): float(row["K"]) for row in reference("02_cubic_arrays_stokes.csv") if row["lattice"] == "SC"}
BOX_K = {float(row["d_over_W"]): float(row["K"]) for row in reference("05_sphere_in_box.csv") if row["box"].startswith("tenCate")}
TUBE_K = {float(row["lambda_a_over_R"]): float(row["K_computed"]) for row in reference("05_sphere_in_cylinder.csv")}
COUETTE = {float(row["a_over_H"]): row for row in reference("08_couette_cell_single_sphere.csv")}


# torque of a turning sphere

TORQUE_C = 0.05


def torque(n, offset, axis, tau):
    """T / (8 pi mu a^3 Omega) of a sphere that turns in place in a periodic cube."""
    a = n * (3 * TORQUE_C / (4 * math.pi)) ** (1 / 3)
    spin = [1e-4 * (d == axis) for d in range(3)]
    result = lbm(stokes([n] * 3, [sphere([n / 2 + o for o in offset], a, angular_velocity=spin)], tau, 1e-7))
    return {"T": -result["solids"][0]["torque"][axis] / (8 * math.pi * a**3 * 1e-4), "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"]}


def torque_runs(quick):
    for n in (18, 35) if quick else (18, 26, 35, 53):
        for i, offset in enumerate(offsets(8)):
            yield Run(torque, {"n": n, "offset": offset, "axis": i % 3, "tau": 1.0}, n**3 * 2500 * (n / 35) / 1e9)


def torque_rows(results):
    found = []
    for (n,), group in groups(of(results, torque), "n").items():
        s = Spread.of(r["T"] * (1 - TORQUE_C) - 1 for r in group)
        d = group[0]["diameter"]
        found.append(Row("torque of a turning sphere", f"d = {d:.1f}", "1", s.mean, 0.015 if 15 < d < 17 else None, s.worst, s.scatter))
    return found


TORQUE = Case(
    name="torque",
    title="Torque of a turning sphere",
    solved="A sphere turns about a lattice axis at a fixed place in a periodic cube, c = 0.05, Stokes flow; 8 sub-cell offsets.",
    reference="""
T = 8 pi mu a^3 Omega / (1 - c): the images of the rotlet turn the fluid around the sphere by T / (6 mu V), their next effect is of order c^(10/3), here 5e-5.""",
    runs=lambda quick: list(torque_runs(quick)),
    rows=torque_rows,
    text=lambda results: "The constants of the scheme were fitted to drag; the torque was not fitted.",
)


# spheres between walls

def boxed(ratio, width, shift, tau):
    """K of a sphere at the centre of a closed box (width, width, 1.6 width) cells, that moves along its height."""
    height = round(1.6 * width)
    a = ratio * width / 2
    solid = sphere([width / 2 + shift[0], width / 2 + shift[1], height / 2 + shift[2]], a, velocity=[0, 0, 1e-4])
    result = lbm(stokes([width, width, height], [solid], tau, 1e-6, boundaries={axis: WALLS for axis in "xyz"}))
    return {"K": -result["solids"][0]["force"][2] / (6 * math.pi * a * 1e-4), "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"]}


def tubed(ratio, radius, shift, tau):
    """K of a sphere on the axis of a closed tube of `radius` cells, half length 2.4 radii, that moves along it."""
    length, width = 2 * round(2.4 * radius), 2 * radius + 6
    a = ratio * radius
    centre = [length / 2, width / 2 + shift[1], width / 2 + shift[2]]
    solids = [sphere([centre[0] + shift[0], *centre[1:]], a, velocity=[1e-4, 0, 0]),
              {"shape": "pipe", "axis": "x", "center": centre, "radius": radius}]
    result = lbm(stokes([length, width, width], solids, tau, 1e-6, boundaries={"x": WALLS}))
    return {"K": -result["solids"][0]["force"][0] / (6 * math.pi * a * 1e-4), "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"]}


def wall_runs(quick):
    sizes = {0.3: (30, 40) if quick else (30, 40, 60), 0.5: (20, 30) if quick else (20, 30, 45)}
    if not quick:
        sizes[0.15] = (60,)
    for ratio, widths in sizes.items():
        for width in widths:
            for shift in ([0, 0, 0], [0.25, 0.25, 0.5]) if width < 60 else ([0, 0, 0],):
                yield Run(boxed, {"ratio": ratio, "width": width, "shift": shift, "tau": 2.0}, 1.6 * width**3 * 2.0 * width**2 / 1e9)
    for ratio, radii in {0.3: (20,), 0.5: (12, 20)}.items():
        for radius in radii if not quick else radii[:1]:
            for shift in offsets(3):
                arguments = {"ratio": ratio, "radius": radius, "shift": shift, "tau": 2.0}
                yield Run(tubed, arguments, 4.8 * radius * (2 * radius + 6) ** 2 * 3000 / 1e9)


def wall_rows(results):
    found = []
    for function, exact, what, size in ((boxed, BOX_K, "box of ten Cate, d / W", "width"), (tubed, TUBE_K, "closed tube, a / R", "radius")):
        for (ratio, _), group in groups(of(results, function), "ratio", size).items():
            s = Spread.of(r["K"] / exact[ratio] - 1 for r in group)
            found.append(Row(f"drag K, {what} = {ratio:g}", f"d = {group[0]['diameter']:.1f}", "2", s.mean, None, s.worst,
                             s.scatter))
    return found


WALLS_CASE = Case(
    name="walls",
    title="A sphere between walls",
    solved="""
Stokes drag of a sphere in the middle of the closed box of ten Cate et al. (no-slip faces) and on the axis of a closed round tube (a solid of partially filled cells); the sphere
stands in place with a velocity, so that the flow is steady. Offsets move sphere (box) or sphere and tube by part of a cell; in the box they move it off the centre, which
changes K by the square of the shift over the width (below 1e-3 here).""",
    reference="`05_sphere_in_box.csv`, `05_sphere_in_cylinder.csv`: Lamb multipoles and fundamental solutions, computed for this project, 1e-4.",
    runs=lambda quick: list(wall_runs(quick)),
    rows=wall_rows,
)


# towed through the lattice

TOWED_C = 0.027
DIRECTIONS = ((1, 0, 0), (1, 1, 0), (1, 1, 1), (0.83, 0.48, 0.29))


def towed(n, direction, tau, scheme="exact"):
    """Mean and noise of the load of a sphere that is towed through a periodic cube (see scenes/towed.py)."""
    return yade("towed.py", {"n": n, "c": TOWED_C, "direction": direction, "tau": tau, "K": SC_K[TOWED_C], "scheme": scheme})


def towed_runs(quick):
    for tau in (0.7, 1.0, 2.0) if quick else (0.55, 0.7, 1.0, 2.0):
        for direction in DIRECTIONS[:2] if quick else DIRECTIONS:
            yield Run(towed, {"n": 24, "direction": direction, "tau": tau}, 14e-6 * 3200 / (tau - 0.5))
    if not quick:
        for direction in DIRECTIONS[1:3]:
            yield Run(towed, {"n": 40, "direction": direction, "tau": 1.0}, 0.9)


def towed_rows(results):
    found = []
    for (n, direction), group in groups([_hashable(r) for r in of(results, towed)], "n", "direction").items():
        s = Spread.of(r["K"] / SC_K[TOWED_C] - 1 for r in group)
        taus = sorted(r["tau"] for r in group)
        where = (f"d = {group[0]['diameter']:.1f}", f"{taus[0]:g} ... {taus[-1]:g}" if len(taus) > 1 else f"{taus[0]:g}")
        near9 = n == 24
        found.append(Row(f"mean drag, towed along {direction}", *where, s.mean, 0.01 if near9 else None, s.worst, s.scatter))
        found.append(Row(f"noise of the load (rms), towed along {direction}", *where, max(r["noise"] for r in group),
                         0.002 if near9 else None))
    return found


class _hashable:
    """A result whose lists can be keys."""

    def __init__(self, result):
        self.result = result

    def __getitem__(self, key):
        value = self.result[key]
        return tuple(value) if isinstance(value, list) else value


def towed_figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        for (direction,), colour, marker in zip(groups([_hashable(r) for r in of(results, towed) if r["n"] == 24], "direction"), COLOURS, MARKERS):
            group = sorted((r for r in of(results, towed) if r["n"] == 24 and tuple(r["direction"]) == direction), key=lambda r: r["tau"])
            taus = [r["tau"] for r in group]
            left.plot(taus, [100 * (r["K"] / SC_K[TOWED_C] - 1) for r in group], marker=marker, color=colour, label=str(direction))
            right.plot(taus, [100 * r["noise"] for r in group], marker=marker, color=colour, label=str(direction))
        left.set(xlabel="tau", ylabel="error of the mean drag [%]", ylim=(-1.2, 1.2))
        right.set(xlabel="tau", ylabel="rms of the load about its mean [% of drag]", ylim=(0, 0.25))
        left.legend()

    return [Figure("towed", "A sphere of 8.9 cells towed through the lattice, by direction.", draw, (9, 3.8))]


TOWED = Case(
    name="towed",
    title="A sphere towed through the lattice",
    solved="""
`LbmEngine`, Stokes flow: a sphere moves through a periodic cube (c = 0.027) at a constant velocity, Re = 0.2, over four cells; a drive balances the drag, so that the mean velocity of the fluid
stays near zero. K from the mean load and the mean relative velocity; noise: rms of the load vector about its mean, over the mean drag.
(Re has to be small. In the frame of the lattice the flow is unsteady, and that is inertia even where the quadratic terms are dropped: at Re = 5 the drag is 8 % higher.)""",
    reference="`02_cubic_arrays_stokes.csv`, SC: the same flow seen from the sphere.",
    runs=lambda quick: list(towed_runs(quick)),
    rows=towed_rows,
    figures=towed_figures,
)


# shear

def couette(ratio, n, shift, tau):
    """A free sphere in the middle of a Couette cell of n cells, between plates that move to both sides."""
    a, speed = ratio * n, 1e-4
    gamma = 2 * speed / n
    walls = {"min": {"type": "noSlip", "velocity": [-speed, 0, 0]}, "max": {"type": "noSlip", "velocity": [speed, 0, 0]}}
    solid = sphere([n / 2 + shift[0], n / 2 + shift[1], n / 2], a, free=True, density=1.0)
    result = lbm(stokes([n] * 3, [solid], tau, 1e-7, boundaries={"z": walls}))
    found = result["solids"][0]
    wall = (result["boundaries"][4]["force"][0] - result["boundaries"][5]["force"][0]) / 2
    return {"eta_wall": abs(wall) / (n * n * gamma), "eta_stresslet": 1 + found["stresslet"][0][2] / (gamma * n**3),
            "spin": found["angular_velocity"][1] / gamma, "drift": found["velocity"][0] / speed, "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"]}


def couette_runs(quick):
    for ratio in COUETTE:
        for n in (32,) if quick else (32, 48):
            for shift in ([0, 0], [0.5, 0.25]):
                yield Run(couette, {"ratio": ratio, "n": n, "shift": shift, "tau": 1.0}, n**3 * 6 * n * n / 1e9)


def couette_rows(results):
    found = []
    for (ratio, n), group in groups(of(results, couette), "ratio", "n").items():
        exact, d = COUETTE[ratio], f"d = {group[0]['diameter']:.1f}"
        eta, spin = float(exact["eta_r"]), float(exact["Omega_over_gamma"])
        s = Spread.of((r["eta_wall"] - 1) / (eta - 1) - 1 for r in group)
        found.append(Row(f"eta_r - 1 from the walls, a / H = {ratio:g}", d, "1", s.mean, 0.02, s.worst, s.scatter))
        s = Spread.of(r["spin"] / spin - 1 for r in group)
        found.append(Row(f"rotation rate, a / H = {ratio:g}", d, "1", s.mean, 0.005, s.worst, s.scatter))
        s = Spread.of((r["eta_wall"] - 1) / (r["eta_stresslet"] - 1) - 1 for r in group)
        found.append(Row(f"wall stress against stresslet, a / H = {ratio:g}", d, "1", s.mean, 0.01, s.worst, s.scatter))
    return found


COUETTE_CASE = Case(
    name="couette",
    title="A free sphere in a Couette cell",
    solved="""
A free sphere in the middle of a cube, periodic in x and y, between z faces that move to both sides, to the steady state. eta_r from the force on the faces and, independently, from the stresslet
of the sphere (reciprocal theorem: eta_r - 1 = S_xz / (mu gamma V)). Errors are those of eta_r - 1.""",
    reference="`08_couette_cell_single_sphere.csv`: multipoles, images and fundamental solutions, computed for this project, 1e-4 and better.",
    runs=lambda quick: list(couette_runs(quick)),
    rows=couette_rows,
    text=lambda results: "A sphere of 6.4 cells (a / H = 0.1 in 32 cells) is below the eight that are advised; its rotation rate depends on the offset by more than the target.",
)
