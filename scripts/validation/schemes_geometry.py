"""Collision operators and solid schemes: arrays and a duct of boxes over tau, and resolution at a small tau."""

from . import arrays
from .case import Case, Figure, Row, Run, groups, observed_order
from .channels import DUCTS, of
from .engine import lbm, stokes
from .plotting import COLOURS, MARKERS
from .report import percent, table
from .schemes import COLLISIONS, SCHEMES, label

TAUS = (0.55, 0.6, 0.8, 1.0, 1.5, 2.0)
ARRAYS = {0.125: 14, 0.45: 12}  # solid fraction: cells along the cube
SIZES, SMALL_TAU = (8, 12, 16, 24), 0.6
OFFSET = (0.2, 0.3, 0.4)
SIDE, CELLS = 12, 18  # of the duct and of the section


def array(scheme, collision, tau, c, n):
    """K of a simple cubic array off centre."""
    return arrays.drag("SC", c, n, OFFSET, tau, scheme=scheme, collision=collision)


def duct(scheme, collision, tau):
    """Flow rate over the exact one of a square duct between boxes whose faces cut through cells."""
    y, z = CELLS / 2 + 0.3, CELLS / 2 + 0.2
    boxes = []
    for axis, middle in ((1, y), (2, z)):
        for sign in (-1, 1):
            center, extents = [2.0, CELLS / 2, CELLS / 2], [2.0, CELLS / 2, CELLS / 2]
            center[axis], extents[axis] = middle + sign * (SIDE / 2 + 1.5), 1.5
            boxes.append({"shape": "box", "center": center, "half_extents": extents, "body": 0})
    result = lbm(stokes((4, CELLS, CELLS), boxes, tau, 1e-7, acceleration=[1e-6, 0, 0], scheme=scheme, collision=collision, lattice="D3Q19"))
    return {"rate": result["superficial_velocity"][0] * CELLS**2 / 1e-6 / SIDE**4 / (DUCTS[1.0] / 4), "cells": result["cells"], "steps": result["steps"]}


def runs(quick):
    for scheme in SCHEMES:
        for collision in COLLISIONS:
            both = {"scheme": scheme, "collision": collision}
            for tau in (0.55, 1.0, 2.0) if quick else TAUS:
                for c, n in ARRAYS.items():
                    yield Run(array, {**both, "tau": tau, "c": c, "n": n}, n**3 * 300 / (tau - 0.5) / 1e9)
                yield Run(duct, {**both, "tau": tau}, 4 * CELLS**2 * 500 / (tau - 0.5) / 1e9)
            for n in (8, 16) if quick else SIZES:
                if n != ARRAYS[0.125]:
                    yield Run(array, {**both, "tau": SMALL_TAU, "c": 0.125, "n": n}, n**3 * 20 * n / (SMALL_TAU - 0.5) / 1e9)


def variants(results, function, **fixed):
    """{(scheme, collision): runs with these arguments}."""
    return groups([r for r in of(results, function) if all(r[key] == value for key, value in fixed.items())], "scheme", "collision")


def error(result):
    return result["rate"] - 1 if result.function == "duct" else result["K"] / arrays.exact_drag("SC", result["c"]) - 1


FLOWS = ((array, {"c": 0.125, "n": 14}, "SC array, c = 0.125, R = 4.3: drag"), (array, {"c": 0.45, "n": 12}, "SC array, c = 0.45, R = 5.7: drag"),
         (duct, {}, f"square duct of boxes, {SIDE} cells: flow rate"))


def rows(results):
    found = []
    for function, fixed, name in FLOWS:
        mine = variants(results, function, **fixed).get(("exact", "trt"), [])
        if mine:
            value = "rate" if function is duct else "K"
            taus = sorted(r["tau"] for r in mine)
            spread = max(r[value] for r in mine) / min(r[value] for r in mine) - 1
            found.append(Row(f"{name}, this scheme, TRT, spread over tau", f"{mine[0]['cells']} cells", f"{taus[0]:g} ... {taus[-1]:g}", spread))
            found.append(Row(f"{name}, this scheme, TRT, error", f"{mine[0]['cells']} cells", f"{taus[0]:g} ... {taus[-1]:g}", error(mine[0])))
    return found


def text(results):
    lines = []
    for scheme in SCHEMES:
        for collision in COLLISIONS:
            cells = []
            for function, fixed, _ in FLOWS:
                mine = {r["tau"]: error(r) for r in variants(results, function, **fixed).get((scheme, collision), [])}
                cells.append(" / ".join(f"{100 * mine[t]:+.3g}" if t in mine else "-" for t in (TAUS[1], 1.0, 2.0)))
            grid = sorted(variants(results, array, tau=SMALL_TAU, c=0.125).get((scheme, collision), []), key=lambda r: r["n"])
            grid = [r for r in grid if r["n"] in SIZES]
            lines.append((label(scheme, collision), *cells, " / ".join(f"{100 * error(r):+.3g}" for r in grid),
                          f"{observed_order([r['n'] for r in grid], [error(r) for r in grid]):.1f}"))
    sizes = " / ".join(str(n) for n in SIZES)
    return f"""
Errors in %, at tau = {TAUS[1]:g} / 1 / 2, and of the dilute array at tau = {SMALL_TAU:g} with {sizes} cells along the cube, with the slope against resolution:

{table(("scheme, collision", *(name for _, _, name in FLOWS), f"SC, c = 0.125, tau = {SMALL_TAU:g}", "order"), lines)}

A missing number is a run that diverged. Constants of this scheme are fitted to spheres in dilute arrays; flat walls that cut cells take only the part of them that is not about curvature.
"""


def figures(results):
    def each(axis, pairs):
        for scheme, colour, marker in zip(SCHEMES, COLOURS, MARKERS):
            for collision, style in (("trt", "-"), ("bgk", "--")):
                mine = sorted(pairs(scheme, collision))
                if mine:
                    axis.plot(*zip(*mine), style, color=colour, marker=marker, ms=3.5, lw=1.2, label=label(scheme, collision))

    def draw(canvas):
        axes = canvas.subplots(1, 4)
        for axis, (function, fixed, name) in zip(axes, FLOWS):
            each(axis, lambda s, c, f=function, k=fixed: [(r["tau"] - 0.5, 100 * error(r)) for r in variants(results, f, **k).get((s, c), [])])
            axis.set(xscale="log", xlabel="tau - 1/2", title=name.replace(": ", ":\n"), ylim=(-60, 60))
        axes[0].set_ylabel("error [%]")
        each(axes[3], lambda s, c: [(r["diameter"], 100 * abs(error(r))) for r in variants(results, array, tau=SMALL_TAU, c=0.125).get((s, c), []) if r["n"] in SIZES])
        axes[3].set(xscale="log", yscale="log", xlabel="cells per diameter", title=f"SC, c = 0.125, tau = {SMALL_TAU:g}:\nsize of the error [%]")
        axes[3].legend(*axes[0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(1.02, 1))

    return [Figure("schemes_geometry", "Errors of drag and flow rate against tau - 1/2, and of the drag against resolution at a small tau.", draw, (15, 3.8))]


GEOMETRY = Case(
    name="schemes_geometry",
    title="Schemes and collisions: arrays, a duct, resolution at a small tau",
    solved=f"""
More of the case `schemes`: the simple cubic array, dilute and dense, and a square duct of {SIDE} cells between boxes whose faces cut through cells (0.2 and 0.3 of a cell off), over tau; resolution at tau = {SMALL_TAU:g}.""",
    reference="`02_cubic_arrays_stokes.csv`; `01_duct_flowrate.csv`, exact series.",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
