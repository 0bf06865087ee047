"""Free spheres: sudden pushes and spins, release from rest, settling."""

import math

from .arrays import exact_drag
from .case import Case, Figure, Row, Run, Spread, groups
from .channels import of
from .engine import RunFailed, lbm, offsets, reference, sphere, stokes, yade
from .plotting import COLOURS, MARKERS
from .report import percent, table

RADIUS = 4.5
BLOW_BOX, RELEASE_BOX = 28, 36
BLOW_RATIOS, RELEASE_RATIOS = (0.1, 0.5, 1.0, 2.5, 8.0), (0.5, 1.0, 2.5)
STARTS = (0.03, 0.1, 0.3)  # R^2 / nu
SETTLING_C = 0.064


def exact(motion, q):
    """(t nu / R^2, what is compared) of the reference: spin, way made, or velocity over Stokes velocity."""
    if motion == "release":
        return [(float(r["t_nu_over_a2"]), float(r["U_over_Ut"]) * float(r["Ut_over_stokes"])) for r in reference("periodic_bbo.csv")
                if int(r["box_cells"]) == RELEASE_BOX and float(r["q"]) == q and float(r["t_nu_over_a2"]) <= 3]
    column = "ratio" if motion == "spin" else "integral"
    return [(float(r["t_nu_over_a2"]), float(r[column])) for r in reference("impulsive_decay.csv")
            if r["motion"] == motion and int(r["box_cells"]) == BLOW_BOX and float(r["q"]) == q and 0.02 < float(r["t_nu_over_a2"]) <= 1]


def free_sphere(motion, q, tau, n=1, scheme="held"):
    """What became of a free sphere, at the times of the reference."""
    times = [time for time, _ in exact(motion, q)]
    release = motion == "release"
    offset = (0.5, 0.5, 0.5) if release else (0.3, 0.18, 0.06)
    result = yade("free_sphere.py", {"motion": motion, "q": q, "tau": tau, "n": n, "scheme": scheme, "radius": RADIUS,
                                     "box": RELEASE_BOX if release else BLOW_BOX, "offset": offset, "times": times, "until": times[-1]})
    if not result["stable"]:
        raise RunFailed("unstable")
    return result


def settling(q, offset, tau):
    """Velocity of a free sphere relative to the mean of the fluid, over that with the exact drag of its array; d = 12."""
    n = 24
    a = n * (3 * SETTLING_C / (4 * math.pi)) ** (1 / 3)
    weight = 1e-4
    case = stokes([n] * 3, [sphere([n / 2 + o for o in offset], a, free=True, density=q)], tau, 0,
                  gravity=[-weight, 0, 0], acceleration=[weight * (q - 1) * SETTLING_C, 0, 0])
    relaxation = (q + 0.5) * SETTLING_C * n**3 / (6 * math.pi * a)  # of the sphere's velocity
    steps = max(15 * relaxation, 3 * a * a) / ((tau - 0.5) / 3) + 800
    case["stop"]["max_steps"] = round(steps)
    result = lbm(case)
    relative = result["superficial_velocity"][0] - result["solids"][0]["velocity"][0]
    force = weight * (q - 1) * SETTLING_C * n**3
    return {"ratio": relative * 6 * math.pi * a * exact_drag("SC", SETTLING_C) / force, "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"]}


def runs(quick):
    for tau in (0.6, 1.0) if quick else (0.6, 1.0, 2.0):
        for q in BLOW_RATIOS:
            for motion in ("spin", "velocity"):
                yield Run(free_sphere, {"motion": motion, "q": q, "tau": tau}, 0.03)
    for tau in (0.6, 1.0) if quick else (0.55, 0.6, 0.8, 1.0):
        for q in RELEASE_RATIOS:
            yield Run(free_sphere, {"motion": "release", "q": q, "tau": tau}, 8.5e-3 / (tau - 0.5))
    for q in (0.3, 2.0) if quick else (0.1, 0.3, 2.0, 10.0):
        for offset in offsets(2 if quick else 8 if q == 2.0 else 2):
            yield Run(settling, {"q": q, "offset": offset, "tau": 0.8}, 13824 * 3000 / 1e9)
    if not quick:
        yield Run(settling, {"q": 2.0, "offset": [0, 0, 0], "tau": 1.5}, 13824 * 1500 / 1e9)


def errors(result):
    """(time, error): of the initial spin, of the way made, of the terminal velocity."""
    found = []
    solution = exact(result["motion"], result["q"])
    terminal = solution[-1][1]
    for (time, value), measured in zip(solution, result["found"]):
        scale = {"spin": 1.0, "velocity": value, "release": terminal}[result["motion"]]
        found.append((time, (measured - value) / scale))
    return found


def worst(result, start):
    return max((abs(e) for time, e in errors(result) if time >= start), default=math.nan)


def late(result):
    """Largest error of a release from 0.3 R^2 / nu on, of the current velocity."""
    return max(abs(measured / value - 1) for (time, value), measured in zip(exact("release", result["q"]), result["found"]) if time >= 0.3)


def rows(results):
    found = []
    for q, group in sorted({q: [r for r in of(results, settling) if r["q"] == q] for q in {r["q"] for r in of(results, settling)}}.items()):
        s = Spread.of(r["ratio"] - 1 for r in group)
        taus = sorted({r["tau"] for r in group})
        found.append(Row(f"velocity against 1/K, density ratio {q:g}", f"d = {group[0]['diameter']:.1f}", " ... ".join(f"{t:g}" for t in (taus if len(taus) < 2 else (taus[0], taus[-1]))),
                         s.mean, 0.01, s.worst, s.scatter))
    blows = of(results, free_sphere)
    moved = [r for r in blows if r["motion"] != "spin"]
    if moved:
        taus = [r["tau"] for r in moved]
        found.append(Row(f"drift of total momentum, worst of {len(moved)} runs, of mass times velocity scale", f"d = {2 * RADIUS:g}",
                         f"{min(taus):g} ... {max(taus):g}", max(r["drift"] for r in moved), 1e-10))
    for motion, what in (("spin", "spin from 0.1 R^2/nu on, of the initial spin"), ("velocity", "way made from 0.3 R^2/nu on, of itself")):
        for (q, tau), group in groups([r for r in blows if r["motion"] == motion and r["tau"] == 0.6], "q", "tau").items():
            found.append(Row(f"{what}, density ratio {q:g}", f"d = {2 * RADIUS:g}", f"{tau:g}", worst(group[0], 0.1 if motion == "spin" else 0.3)))
    for (q, tau), group in groups([r for r in blows if r["motion"] == "release" and r["tau"] == 0.6], "q", "tau").items():
        found.append(Row(f"velocity after release from 0.3 R^2/nu on, of itself, density ratio {q:g}", f"d = {2 * RADIUS:g}", f"{tau:g}", late(group[0])))
    return found


def text(results):
    blows = of(results, free_sphere)
    parts = []
    for motion, title in (("spin", "Spin after a blow: worst error in % of the initial spin, from 0.03 / 0.1 / 0.3 R^2/nu on:"),
                          ("velocity", "Way made after a blow: worst error in % of itself, from 0.1 / 0.3 R^2/nu on:")):
        starts = STARTS if motion == "spin" else STARTS[1:]
        taus = sorted({r["tau"] for r in blows if r["motion"] == motion})
        lines = []
        for q in BLOW_RATIOS:
            cells = []
            for tau in taus:
                mine = [r for r in blows if (r["motion"], r["q"], r["tau"]) == (motion, q, tau)]
                cells.append(" / ".join(f"{100 * worst(mine[0], start):.2g}" for start in starts) if mine else "unstable")
            lines.append((f"{q:g}", *cells))
        parts.append(title + "\n\n" + table(("density ratio", *(f"tau {tau:g}" for tau in taus)), lines))
    taus = sorted({r["tau"] for r in blows if r["motion"] == "release"})
    lines = []
    for q in RELEASE_RATIOS:
        mine = {r["tau"]: r for r in blows if (r["motion"], r["q"]) == ("release", q)}
        lines.append((f"{q:g}", *(f"{100 * worst(mine[t], 0):.2g} / {100 * late(mine[t]):.2g}" if t in mine else "unstable" for t in taus)))
    parts.append("Release from rest, centre half a cell off: worst error in % of the terminal velocity / from 0.3 R^2/nu on in % of the current one:\n\n"
                 + table(("density ratio", *(f"tau {tau:g}" for tau in taus)), lines))
    parts.append("""R^2/nu is 607 steps at tau = 0.6, 121 at 1 and 40 at 2: a transient that lasts a few steps is not resolved, and light solids take up their load over several
steps, so that they are stable (docs/physics.md, Loads). Sudden changes of light solids want a small tau; steady motion does not care.""")
    return "\n\n".join(parts)


def figures(results):
    blows = of(results, free_sphere)

    def draw(canvas):
        axes = canvas.subplots(1, 3)
        for axis, motion in zip(axes, ("spin", "velocity", "release")):
            ratios = RELEASE_RATIOS if motion == "release" else BLOW_RATIOS
            for q, colour, marker in zip(ratios, COLOURS, MARKERS):
                mine = [r for r in blows if (r["motion"], r["q"], r["tau"]) == (motion, q, 0.6)]
                if mine:
                    times, values = zip(*exact(motion, q))
                    axis.plot(times, values, "-", color=colour, lw=1)
                    axis.plot(times, mine[0]["found"], marker, color=colour, ms=3.5, label=f"{q:g}")
            axis.set(xscale="log", xlabel="t nu / R^2")
            axis.legend(title="density ratio")
        for axis, name in zip(axes, ("spin / initial spin", "way made after a blow / (U R^2/nu)", "velocity after release / Stokes")):
            axis.set_title(name)
        axes[1].set_yscale("log")

    return [Figure("free", "Free spheres at tau = 0.6: symbols; exact solutions: lines.", draw, (11, 3.9))]


FREE = Case(
    name="free",
    title="Free spheres",
    solved="""
Free spheres in a periodic cube at small Reynolds number. In YADE (R = 4.5 cells): given a velocity or a spin at t = 0 (box of 28 cells), or released under a constant force (36 cells), one fluid step per
grain step. A blow sends sound through the box, which makes the velocity ring about the right mean; so the way made is compared. `lbm run`: settling to the steady velocity, d = 12, c = 0.064, at sub-cell offsets; a drive holds the
box at rest.""",
    reference="""
`impulsive_decay.csv`, `periodic_bbo.csv`: unsteady Stokes flow with the images of the box, computed for this project (Laplace transform, induced forces, Ewald sums), 1e-6 and better.
Settling: K of `02_cubic_arrays_stokes.csv`.""",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
