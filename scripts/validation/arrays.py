"""Cubic arrays of spheres in Stokes flow: drag against resolution."""

import math
from functools import lru_cache

from .case import Case, Figure, Row, Run, Spread, groups, observed_order
from .engine import lbm, offsets, reference, sphere, stokes
from .plotting import COLOURS, MARKERS
from .report import percent, table

LATTICES = {
    "SC": [(0, 0, 0)],
    "BCC": [(0, 0, 0), (0.5, 0.5, 0.5)],
    "FCC": [(0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)],
}
NEAREST = {"SC": 1.0, "BCC": math.sqrt(3) / 2, "FCC": math.sqrt(0.5)}  # distance of neighbours in sides of the cube
TOUCHING = {"SC": 0.52359878, "BCC": 0.68017476}
FRACTIONS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
DRIVE = 1e-6


@lru_cache(maxsize=None)
def exact_drag(lattice, c):
    """K of the reference tables."""
    if lattice == "FCC":
        return 1 / next(float(row["FCC_exact"]) for row in reference("07_hindered_settling.csv") if float(row["c"]) == c)
    for row in reference("02_cubic_arrays_stokes.csv"):
        if row["lattice"] == lattice and math.isclose(float(row["c"]), c, rel_tol=1e-6):
            return float(row["K"])
    raise ValueError(f"no {lattice} array with c = {c} in the reference")


def side(lattice, c, diameter):
    """Cells along the cube that come closest to this diameter."""
    return max(6, round(diameter / 2 * (4 * math.pi * len(LATTICES[lattice]) / (3 * c)) ** (1 / 3)))


def radius(lattice, c, n):
    """Radius in a cube of n cells; c of touching spheres is rounded in the table."""
    return n * min((3 * c / (4 * math.pi * len(LATTICES[lattice]))) ** (1 / 3), NEAREST[lattice] / 2)


def quick_tau(a, c, drag):
    """The relaxation time with which a bed of spheres of radius a cells becomes steady in the fewest steps, about.

    The flow needs some a^2 / (c K nu) steps, the pressure in the cells inside the solids a number that grows with tau.
    """
    return round(min(3.0, max(0.6, 0.5 + 0.06 * a / math.sqrt(c * drag))), 2)


def drag(lattice, c, n, offset, tau, direction=(1, 0, 0), **more):
    """K = F / (6 pi mu a U) of an array in a cube of n cells, displaced by `offset` cells."""
    a, sites = radius(lattice, c, n), LATTICES[lattice]
    solids = [sphere([n * (0.5 + s) + o for s, o in zip(site, offset)], a) for site in sites]
    size = math.sqrt(sum(d * d for d in direction))
    drive = [DRIVE * d / size for d in direction]
    result = lbm(stokes([n] * 3, solids, tau, acceleration=drive, **more))
    along = sum(u * d for u, d in zip(result["superficial_velocity"], drive)) / DRIVE
    return {"K": DRIVE * n**3 / (len(sites) * 6 * math.pi * a * along), "diameter": 2 * a,
            "cells": result["cells"], "steps": result["steps"], "tau": tau}


def cost(lattice, c, n, tau):
    """Expected cell updates [1e9]."""
    flow = 3 * radius(lattice, c, n) ** 2 / (4.5 * c * exact_drag(lattice, c)) / (tau - 0.5)
    return n**3 * max(2000, 12 * flow, 4000 * (tau - 0.5)) / 1e9


def runs(quick):
    """Every lattice and fraction at several resolutions, each at several offsets."""
    for lattice in LATTICES:
        fractions = FRACTIONS + ((TOUCHING[lattice],) if lattice in TOUCHING else ())
        if lattice == "FCC":
            fractions = (0.3, 0.5)
        for c in fractions:
            for diameter in (8, 16) if quick else (8, 12, 16, 24, 32):
                if lattice == "FCC" and diameter > 16:
                    continue
                n = side(lattice, c, diameter)
                tau = quick_tau(radius(lattice, c, n), c, exact_drag(lattice, c))
                for offset in offsets(3 if quick else 8 if n <= 48 else 2):
                    arguments = {"lattice": lattice, "c": c, "n": n, "offset": offset, "tau": tau}
                    yield Run(drag, arguments, cost(lattice, c, n, tau))


def error(result):
    return result["K"] / exact_drag(result["lattice"], result["c"]) - 1


def is_touching(lattice, c):
    return c == TOUCHING.get(lattice)


def name(lattice, c):
    return f"{lattice} touching" if is_touching(lattice, c) else f"{lattice} c = {c:g}"


def rows(results):
    found = []
    for (lattice, c, n), group in groups(results, "lattice", "c", "n").items():
        d = group[0]["diameter"]
        target = scatter_target = None
        if is_touching(lattice, c):
            target = 0.02 if d > 31 else None
        elif lattice != "FCC":
            target = 0.003 if d > 31 else 0.01 if d > 15 else None
            scatter_target = 0.003 if target else None
        s = Spread.of(error(r) for r in group)
        found.append(Row(f"drag K, {name(lattice, c)}", f"d = {d:.1f}", f"{group[0]['tau']:g}", s.mean, target, s.worst, s.scatter,
                         scatter_target))
    return found


def convergence(results):
    """Observed orders, per array."""
    lines = []
    for (lattice, c), group in groups(results, "lattice", "c").items():
        sizes = groups(group, "diameter")
        spreads = [Spread.of(error(r) for r in g) for g in sizes.values()]
        order = observed_order([d for d, in sizes], [s.worst for s in spreads])
        gap = group[-1]["n"] * NEAREST[lattice] / group[-1]["diameter"] - 1
        lines.append((name(lattice, c), f"{exact_drag(lattice, c):g}", f"{max(gap, 0):.3f} d",
                      *(f"{percent(s.mean)} ± {percent(s.scatter, signed=False) or 'one offset'}" for s in spreads), f"{order:.1f}"))
    widths = [f"d ≈ {d}" for d in sorted({round(g[0]["diameter"] / 4) * 4 for g in groups(results, "lattice", "c", "n").values()})]
    lines = [line[:3] + line[3:-1] + ("",) * (len(widths) - len(line) + 4) + line[-1:] for line in lines]
    return table(("array", "K exact", "gap", *widths, "order"), lines)


def text(results):
    return f"""
Error of the drag, mean ± half range over the offsets, and the slope of the worst error against resolution:

{convergence(results)}

The strength k of spheres was chosen by the simple cubic array with c = 0.125, so errors of dilute arrays are small by
construction; a slope through them means little. In narrow pores cut cells count more (docs/physics.md, "Narrow pores"), with one constant for each Lambda that was fitted on arrays of c = 0.3 to
0.68 at 8 to 24 cells per diameter and a random pack. Cubes of more than 48 cells were run with two offsets, smaller ones with eight. The drive acts as a difference of pressure would.

How an array lies to the lattice counts up to 0.5 % (runs of their own, with earlier functions of eps): turned by 45 degrees about an axis the face-centred one of c = 0.5 (15 cells per diameter) has -0.1 and -0.2 % across and along it, upright -0.6 %.
"""


def figures(results):
    def draw(canvas):
        axes = canvas.subplots(1, 2, sharey=True)
        for axis, lattice in zip(axes, ("SC", "BCC")):
            chosen = [r for r in results if r["lattice"] == lattice]
            for (c,), colour, marker in zip(groups(chosen, "c"), COLOURS, MARKERS):
                sizes = groups([r for r in chosen if r["c"] == c], "diameter")
                worst = [100 * Spread.of(error(r) for r in g).worst for g in sizes.values()]
                axis.loglog([d for d, in sizes], worst, marker=marker, color=colour, label=name(lattice, c).split(" ", 1)[1])
            d = [8, 32]
            axis.loglog(d, [8, 0.5], "k:", lw=1, label="order 2")
            axis.set(xlabel="cells per diameter", title=lattice, xticks=[8, 12, 16, 24, 32], xticklabels=["8", "12", "16", "24", "32"])
            axis.minorticks_off()
            axis.legend(ncol=2)
        axes[0].set_ylabel("largest error of the drag over offsets [%]")

    return [Figure("arrays", "Largest error of the drag over sub-cell offsets, against resolution.", draw, (9.0, 4.2))]


ARRAYS = Case(
    name="arrays",
    title="Cubic arrays of spheres",
    solved="""
Stokes flow through a periodic cube with one, two or four spheres, driven by a mean pressure gradient, to the steady state (loads and mean velocity change by
less than 1e-6 per window). K = F / (6 pi mu a U) with F the drive on the cell per sphere and U the superficial velocity. A whole number
of cells along the cube fixes the diameter; the spheres are displaced by sub-cell offsets that fill a cell evenly.""",
    reference="""
`02_cubic_arrays_stokes.csv`: Lamb multipoles with lattice images, computed for this project, relative error 2e-7 (2e-5 close to contact). It agrees with
Zick & Homsy (1982) to their four digits; the 31-term series of Sangani & Acrivos (1982) is not good enough above chi = 0.75. For FCC the
settling ratios 1/K of `07_hindered_settling.csv`, computed in the same way; periodic Stokeslets inside the spheres, an independent method (900 of them,
the velocity on the surface below 4e-4 of the mean), give K = 12.7928 and 47.9676 at c = 0.3 and 0.5, as the table does, and BCC 44.0257.""",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
