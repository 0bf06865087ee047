"""A dumb-bell, a clump of two touching spheres, that turns in a shear flow."""

import math

import numpy as np

from .case import Case, Figure, Row, Run
from .engine import yade
from .plotting import COLOURS

TOUCHING = 0.406  # B of two touching spheres: their line of centres turns by gamma / 2 (1 + (1 - B) cos 2 phi) [Batchelor & Green 1972]
ASPECT = math.sqrt((2 - TOUCHING) / TOUCHING)  # of the ellipsoid that turns like them


def half_turn(aspect):
    """Strain in which an ellipsoid makes half a turn [Jeffery 1922]."""
    return math.pi * (aspect + 1 / aspect)


def rod(n, radius, tau, reynolds, strain):
    """Strains at which a free dumb-bell of two touching spheres lies along the flow (see scenes/rod.py)."""
    return yade("rod.py", {"n": n, "radius": radius, "tau": tau, "reynolds": reynolds, "strain": strain})


def runs(quick):
    for n, radius in ((36, 3),) if quick else ((48, 4),):
        yield Run(rod, {"n": n, "radius": radius, "tau": 1.0, "reynolds": 0.1, "strain": 16}, 1.1 * n**3 * 16 * 6 * radius**2 / 0.1 / 1e9)


def rows(results):
    return [Row("half a turn of two touching spheres", f"d = {2 * r['radius']}, H = {r['n'] / r['radius'] / 4:g} lengths", f"{r['tau']:g}",
                (r["aligned"][1] - r["aligned"][0]) / half_turn(ASPECT) - 1) for r in results if len(r["aligned"]) > 1]


def text(results):
    return "\n".join(f"- n = {r['n']}: along the flow at strains {', '.join(f'{s:.3f}' for s in r['aligned'])} (Jeffery: {half_turn(ASPECT):.3f} apart); "
                     f"its centre moved by {r['drift']:.1e} radii" for r in results)


def figures(results):
    def draw(canvas):
        axis = canvas.subplots()
        for r, colour in zip(results, COLOURS):
            if len(r["aligned"]) < 2:
                continue
            strain = np.linspace(0, r["strain"], len(r["angles"]))
            axis.plot(strain, np.degrees(r["angles"]), "o", ms=2.5, color=colour, label=f"d = {2 * r['radius']} cells")
            since = np.linspace(0, r["aligned"][-1] - r["aligned"][0], 300)
            phase = math.pi / 2 + since / (ASPECT + 1 / ASPECT)
            exact = np.unwrap(np.arctan2(ASPECT * np.sin(phase), np.cos(phase)))
            axis.plot(r["aligned"][0] + since, np.degrees(exact), "-", lw=1, color=colour)
        axis.plot([], [], "k-", lw=1, label="Jeffery, from where it first lies along the flow")
        axis.set(xlabel="strain", ylabel="angle from the gradient towards the flow [degrees]")
        axis.legend()

    return [Figure("rod", "A dumb-bell turns in a shear flow.", draw)]


ROD = Case(
    name="rod",
    title="A clump turns in a shear flow",
    solved="""
A free clump of two touching spheres with the density of the fluid between two plates that move, in the plane of the shear, Stokes flow (gamma a^2 / nu = 0.1 for the time dependence); the first half
turn, in which the flow sets in, is left out.""",
    reference="""
Jeffery (1922), Proc. R. Soc. A 102, 161: half a turn takes the strain pi (r + 1/r), with r = 1.98 for two touching spheres in unbounded fluid [from B = 0.406 of Batchelor & Green (1972), J. Fluid Mech. 56, 375]. The plates, 3 lengths of the clump apart, and its periodic images are not in it.""",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
