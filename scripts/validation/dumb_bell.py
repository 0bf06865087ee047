"""A rigid body of two overlapping spheres: drag and torque against a finer grid."""

import math

from .case import Case, Figure, Row, Run, Spread, groups
from .channels import of
from .engine import lbm, offsets, sphere, stokes
from .plotting import COLOURS, MARKERS
from .report import percent, table

APART, BOX = 1.2, 5  # radii: distance of the centres, side of the periodic cube
AXIS, ACROSS = (0.8, 0.36, 0.48), (-0.6, 0.48, 0.64)  # askew to the lattice
RADII = {4: 4, 6: 2, 8: 2, 12: 1}  # cells: number of sub-cell offsets
FINE = (8, 12)
MOTIONS = ("drag along", "drag across", "torque about its axis", "torque across")


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def resistance(motion, radius, offset, tau, apart=APART, body=True):
    """Drag over 6 pi mu R U (U: superficial velocity along the drive), or torque over 8 pi mu R^3 W."""
    n = BOX * radius
    middle = [n / 2 + o for o in offset]
    arms = [[s * apart / 2 * radius * d for d in AXIS] for s in (-1, 1)]
    direction = ACROSS if "across" in motion else AXIS
    spin = [1e-6 * d for d in direction] if "torque" in motion else [0, 0, 0]
    one_body = {"body": 1} if body else {}
    solids = [sphere([m + a for m, a in zip(middle, arm)], radius, velocity=cross(spin, arm), angular_velocity=spin, **one_body) for arm in arms]
    drive = 0 if "torque" in motion else 1e-6
    case = stokes([n] * 3, solids if body else solids[:1], tau, 0, acceleration=[drive * d for d in direction])
    # twelve times the relaxation time of the mean flow, or the slowest shear in the box and the pressure inside
    case["stop"]["max_steps"] = round((23 if drive else 8) * radius**2 / ((tau - 0.5) / 3) + 2000 * (tau - 0.5))
    result = lbm(case)
    if drive:
        value = drive * n**3 / (6 * math.pi * radius * dot(result["superficial_velocity"], direction))
    else:
        torque = [0, 0, 0]
        for s, arm in zip(result["solids"], arms):
            torque = [t + own + x for t, own, x in zip(torque, s["torque"], cross(arm, s["force"]))]
        value = -dot(torque, direction) / (8 * math.pi * radius**3 * 1e-6)
    return {"value": value, "cells": result["cells"], "steps": result["steps"]}


def runs(quick):
    for motion in MOTIONS:
        for radius, count in RADII.items():
            tau = 1.2 if radius < 8 else 2.0
            for offset in offsets(1 if quick else count):
                if not quick or radius <= 8:
                    steps = (23 if "drag" in motion else 8) * radius**2 / ((tau - 0.5) / 3) + 2000 * (tau - 0.5)
                    yield Run(resistance, {"motion": motion, "radius": radius, "offset": offset, "tau": tau}, (BOX * radius) ** 3 * steps / 1e9)
    for motion in ("drag along", "torque about its axis"):
        for body in (False, True):
            yield Run(resistance, {"motion": motion, "radius": 4, "offset": [0.2, 0.3, 0.4], "tau": 1.2, "apart": 0, "body": body}, 0.02)


def pairs(results):
    """Runs of the body, without those of coincident spheres."""
    return [r for r in of(results, resistance) if "apart" not in r.arguments]


def finest(results):
    """{motion: (value at infinite resolution, what the extrapolation changed, relative)}, second order through means over offsets."""
    found = {}
    for (motion,), group in groups(pairs(results), "motion").items():
        mean = {radius: sum(r["value"] for r in g) / len(g) for (radius,), g in groups(group, "radius").items()}
        fine, finer = (FINE if FINE[1] in mean else sorted(mean)[-2:])
        value = mean[finer] + (mean[finer] - mean[fine]) / ((finer / fine) ** 2 - 1)
        found[motion] = value, abs(value / mean[finer] - 1)
    return found


def rows(results):
    found = []
    limit = finest(results)
    for (motion, radius), group in groups(pairs(results), "motion", "radius").items():
        if radius < 8:
            s = Spread.of(r["value"] / limit[motion][0] - 1 for r in group)
            found.append(Row(f"{motion}, against the fine grid", f"R = {radius}", f"{group[0]['tau']:g}", s.mean, None, s.worst, s.scatter))
    coincident = [r for r in of(results, resistance) if "apart" in r.arguments]
    for (motion,), group in groups(coincident, "motion").items():
        one, two = sorted(group, key=lambda r: r["body"])
        found.append(Row(f"{motion}: two coincident spheres, one body, against a single sphere", "R = 4", "1.2", two["value"] / one["value"] - 1, 1e-12))
    return found


def text(results):
    limit = finest(results)
    lines = []
    for (motion,), group in groups(pairs(results), "motion").items():
        by_radius = groups(group, "radius")
        spreads = {radius: Spread.of(r["value"] / limit[motion][0] - 1 for r in g) for (radius,), g in by_radius.items()}
        lines.append((motion, f"{limit[motion][0]:.4f} ± {percent(limit[motion][1], signed=False)}",
                      *(percent(s.mean) + (f" ± {percent(s.scatter, signed=False)}" if s.scatter else "") for _, s in sorted(spreads.items()))))
    sizes = [f"R = {radius}" for radius in sorted({r["radius"] for r in pairs(results)})]
    return f"""
Drag over 6 pi mu R U, torque over 8 pi mu R^3 W; error against the extrapolated value, mean ± half range over offsets. Behind ±: what the extrapolation changed.

{table(("", "extrapolated", *sizes), lines)}
"""


def figures(results):
    limit = finest(results)

    def draw(canvas):
        axis = canvas.subplots()
        for (motion,), colour, marker in zip(groups(pairs(results), "motion"), COLOURS, MARKERS):
            mine = [r for r in pairs(results) if r["motion"] == motion]
            axis.plot([r["radius"] for r in mine], [100 * (r["value"] / limit[motion][0] - 1) for r in mine], marker, color=colour, label=motion, mfc="none")
            means = sorted((radius, 100 * (sum(r["value"] for r in g) / len(g) / limit[motion][0] - 1)) for (radius,), g in groups(mine, "radius").items())
            axis.plot(*zip(*means), "-", color=colour, lw=1)
        axis.axhline(0, color="k", lw=0.8)
        axis.set(xlabel="cells per radius", ylabel="difference from the extrapolated value [%]")
        axis.legend()

    return [Figure("dumb_bell", "Two overlapping spheres as one body: all offsets (symbols), means (lines).", draw)]


DUMB_BELL = Case(
    name="dumb_bell",
    title="A body of two overlapping spheres",
    solved=f"""
Two spheres whose centres are {APART} radii apart are one rigid body (`body` of `lbm run`, a clump in YADE), askew to the lattice in a periodic cube of {BOX} radii, Stokes flow. Drag: at rest in a flow that a drive keeps up, along the axis and across. Torque: turning
about the axis and across it. The common volume counts once. Two coincident spheres must be one sphere.""",
    reference="The same with 8 and 12 cells per radius, extrapolated as an error of second order.",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
