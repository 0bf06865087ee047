"""Independence of the relaxation time."""

import math

from .case import Case, Figure, Row, Run, groups
from .engine import lbm, sphere, stokes
from .packing import packing
from .plotting import COLOURS, MARKERS

TAUS = (0.51, 0.6, 1.0, 2.0, 5.0, 10.0)
STEADY = 1e-10
DRIVE = 1e-6
WALLS = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
SETS = {"LN": {}, "R": {"magic_parameter": 0.1875}}


def flow(cells, solids, tau, variant, lattice, direction=(1, 0, 0), **more):
    """Mean velocity along the drive, per drive, and the load of the first solid."""
    drive = [DRIVE * d for d in direction]
    result = lbm(stokes(cells, solids, tau, STEADY, acceleration=drive, lattice=lattice, **SETS[variant], **more))
    along = sum(u * d for u, d in zip(result["superficial_velocity"], direction)) / DRIVE
    first = result["solids"][0]
    return {"values": [along, *(f / DRIVE for f in first["force"] + first["torque"])], "cells": result["cells"],
            "steps": result["steps"]}


def array(lattice, tau, variant, sites, c, n, direction):
    """A cubic array, off centre."""
    a = n * (3 * c / (4 * math.pi * len(sites))) ** (1 / 3)
    solids = [sphere([n * (0.5 + s) + o for s, o in zip(site, (0.13, 0.21, 0.37))], a) for site in sites]
    return flow([n] * 3, solids, tau, variant, lattice, direction)


def pack(lattice, tau, variant):
    """100 spheres at random, c = 0.4, R = 3 cells."""
    n = 30
    centres, a = packing(100, 0.4, seed=1)
    return flow([n] * 3, [sphere([n * x for x in centre], a * n) for centre in centres], tau, variant, lattice)


def clump(lattice, tau, variant):
    """Two overlapping spheres and a third that touches, askew in a periodic box."""
    solids = [sphere((8.1, 8.3, 8.2), 3.5), sphere((11.2, 9.4, 9.1), 3.0), sphere((8.9, 12.6, 10.0), 2.5)]
    return flow((20, 18, 17), solids, tau, variant, lattice, (0.6, 0.5, 0.3))


def constriction(lattice, tau, variant):
    """A duct of faces with a sphere that stands out of a wall."""
    return flow((24, 14, 14), [sphere((12.2, 1.4, 7.3), 5.0)], tau, variant, lattice, boundaries={"y": WALLS, "z": WALLS})


def pipe(lattice, tau, variant):
    """A round pipe with a sphere in it, off centre."""
    solids = [{"shape": "pipe", "axis": "x", "center": [0, 9.1, 9.2], "radius": 7.3}, sphere((9.2, 9.8, 8.6), 3.1)]
    return flow((18, 18, 18), solids, tau, variant, lattice)


FLOWS = {
    array: [
        {"sites": [(0, 0, 0)], "c": 0.125, "n": 12, "direction": (1, 0, 0)},
        {"sites": [(0, 0, 0)], "c": 0.45, "n": 10, "direction": (1, 0, 0)},
        {"sites": [(0, 0, 0), (0.5, 0.5, 0.5)], "c": 0.3, "n": 12, "direction": (0.6, 0.5, 0.3)},
    ],
    pack: [{}],
    clump: [{}],
    constriction: [{}],
    pipe: [{}],
}


def runs(quick):
    for function, variations in FLOWS.items():
        for more in variations:
            for variant in SETS:
                for lattice in ("D3Q19", "D3Q27"):
                    for tau in (0.6, 1.0, 2.0) if quick else TAUS:
                        if function is pack and (lattice, variant) != ("D3Q19", "LN"):
                            continue
                        cells = 27000 if function is pack else 5000
                        steps = max(3000, 400 / (tau - 0.5), 8000 * (tau - 0.5))
                        yield Run(function, {"lattice": lattice, "tau": tau, "variant": variant, **more}, cells * steps / 1e9)


def describe(result):
    if result.function != "array":
        return {"pack": "random pack of 100", "clump": "three spheres that overlap", "constriction": "duct with a curved wall",
                "pipe": "sphere in a round pipe"}[result.function]
    return f"{'BCC' if len(result['sites']) > 1 else 'SC'} c = {result['c']:g}, flow along {tuple(result['direction'])}"


def deviations(group):
    """Largest difference of any value from that at tau = 1, over the size of its kind (velocity, force, torque), for each tau."""
    base = next(r for r in group if r["tau"] == 1.0)["values"]
    norms = [abs(base[0])] + [math.hypot(*base[1:4])] * 3 + [max(math.hypot(*base[4:7]), math.hypot(*base[1:4]))] * 3
    return {r["tau"]: max(abs(v - b) / n for v, b, n in zip(r["values"], base, norms)) for r in group}


def rows(results):
    found = []
    for group in by_flow(results):
        spread = max(deviations(group).values())
        taus = [r["tau"] for r in group]
        found.append(Row(f"spread, {describe(group[0])}, {group[0]['lattice']}, set {group[0]['variant']}", f"{group[0]['cells']} cells",
                         f"{min(taus):g} ... {max(taus):g}", spread, 1e-7))
    return found


def by_flow(results):
    found = {}
    for r in results:
        found.setdefault((describe(r), r["lattice"], r["variant"]), []).append(r)
    return [sorted(group, key=lambda r: r["tau"]) for group in found.values() if any(r["tau"] == 1.0 for r in group)]


def figures(results):
    def draw(canvas):
        axis = canvas.subplots()
        for group, colour, marker in zip([g for g in by_flow(results) if g[0]["lattice"] == "D3Q19" and g[0]["variant"] == "LN"],
                                         COLOURS, MARKERS):
            found = deviations(group)
            axis.loglog(list(found), [max(d, 1e-16) for d in found.values()], marker=marker, color=colour, label=describe(group[0]))
        axis.axhline(1e-7, color="k", ls=":", lw=1)
        axis.set(xlabel="tau", ylabel="largest relative difference from tau = 1", ylim=(1e-16, 1e-5))
        axis.legend(ncol=2)

    return [Figure("tau", "Velocity, force and torque at other relaxation times; dotted: the target. D3Q19, set LN.", draw)]


TAU = Case(
    name="tau",
    title="Independence of the relaxation time",
    solved="""
Steady Stokes flows, each at tau from 0.51 to 10, with both parameter sets (LN: Lambda = 1/8, the default; R: 3/16) and both lattices: mean velocity, force and torque on a solid.
The runs end when nothing changes by more than 1e-10 per window; what is left of the transient is part of the spread.""",
    reference="None is needed: the same discrete flow has to come out.",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    figures=figures,
)
