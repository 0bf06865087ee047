"""Grains and fluid under a load: Skempton's coefficient and Terzaghi's consolidation."""

import math

import numpy as np

from .case import Case, Figure, Row, Run
from .channels import of
from .engine import reference, yade
from .plotting import COLOURS, MARKERS, against
from .report import table

D, TAU = 8, 0.6
POROSITY = 1 - math.pi / 6  # of the touching simple cubic array
BULK = 1 / 3
PLACES = ((0.0, 0.0), (0.3, 0.45))


def stiffness(count, modulus):
    """Oedometric modulus of the dry stack, over the fluid's bulk modulus (see scenes/consolidation.py)."""
    return yade("consolidation.py", {"kind": "dry", "d": D, "count": count, "tau": TAU, "modulus": modulus, "shift": PLACES[0], "films": False, "steps": 80000})


def seepage(count, shift, tau):
    """Permeability of a stack of free grains, over dx^2."""
    return yade("consolidation.py", {"kind": "flow", "d": D, "count": count, "tau": tau, "modulus": 0.1, "shift": shift, "films": False, "steps": 500})


def loaded(count, modulus, tau, shift, films, times):
    """Settlement of the surface over the final one, pressures over the load, at given times [fluid steps]."""
    return yade("consolidation.py", {"kind": "load", "d": D, "count": count, "tau": tau, "modulus": modulus, "shift": shift, "films": films, "times": times})


def filled(d, n, tau, times):
    """Part of the box that a rise of the pressure fills, at given times after it [fluid steps] (see scenes/storage.py)."""
    return yade("storage.py", {"d": d, "n": n, "layers": 1, "tau": tau, "ramp": 20, "times": times})


def skempton(modulus, storage):
    """Pressure over the load in undrained compression to one side; storage: part of the volume that stores fluid, modulus: E_oed / K_f."""
    return 1 / (1 + storage * modulus)


def check_skempton():
    """Largest difference of `skempton` from the reference table."""
    return max(abs(skempton(1 / float(row["Kf_over_Kskel"]), storage) - float(row[column])) for row in reference("09_skempton_B.csv")
               for storage, column in ((float(row["n"]), "B"), (1.0, "B_full_volume")))


# Skempton

MODULI = (1.0, 0.5, 0.2, 0.1)
PLATEAU = [3000 + 250 * i for i in range(13)]


def skempton_runs(quick):
    for modulus in MODULI[::2] if quick else MODULI:
        yield Run(loaded, {"count": 16, "modulus": modulus, "tau": 1.0, "shift": PLACES[0], "films": False, "times": PLATEAU}, 0.25)
    for d, n, tau in ((8, 8, 1.0), (8, 10, 1.0), (8, 8, 2.0), (12, 12, 1.0)):
        unit = 800 * (tau - 0.5) * (d / 8) ** 2
        yield Run(filled, {"d": d, "n": n, "tau": tau, "times": [round(unit * x) for x in (0.1, 0.2, 0.4, 0.7, 1, 1.5, 2, 3, 5, 8)]}, 0.02)


def inside(d, tau, time):
    """Part of a sphere's volume that a rise of the pressure at its surface has filled: diffusion through a porous ball of radius R - 1/2."""
    radius, nu = d / 2, (tau - 0.5) / 3
    diffusivity = 0.02 / (9 * (2.3 + 3.5 / radius) * nu)  # permeability of a full cell times the bulk modulus over the viscosity
    m = np.arange(1, 200)
    return 1 - float((6 / (math.pi * m) ** 2 * np.exp(-((m * math.pi / (radius - 0.5)) ** 2) * diffusivity * time)).sum())


def skempton_rows(results):
    found = []
    for r in of(results, loaded):
        measured = float(np.mean(r["base"]))
        for storage, what in ((1.0, "fluid stored in the whole volume"), (POROSITY, "in the pores alone")):
            found.append(Row(f"p / q undrained, E / K_f = {r['modulus']:g}, against {what}", f"d = {D}", f"{r['tau']:g}", measured / skempton(r["modulus"], storage) - 1))
    for r in of(results, filled):
        found.append(Row(f"volume that stores fluid in the end, porosity {r['porosity']:.3f}, over that of the box", f"d = {r['d']}", f"{r['tau']:g}", r["stored"][-1] - 1))
        worst = max(abs(s - r["porosity"] - (1 - r["porosity"]) * inside(r["d"], r["tau"], t)) for s, t in zip(r["stored"][1:], r["times"][1:]))
        found.append(Row("the same on the way there, against diffusion into the spheres", f"d = {r['d']}", f"{r['tau']:g}", worst))
    return found


def skempton_text(results):
    lines = [(f"{r['modulus']:g}", f"{np.mean(r['base']):.4f} ± {np.ptp(r['base']) / 2:.4f}", f"{skempton(r['modulus'], 1):.4f}", f"{skempton(r['modulus'], POROSITY):.4f}")
             for r in of(results, loaded)]
    return f"""
**The code follows `B_full_volume`.** The lattice's fluid is there inside the grains too, as a medium of small permeability (a full cell: 0.02 / (3 k), 1/480 of a cell squared at R = 4), and its pressure follows that around the grain. So a bed of
grains behaves as if its fluid had the bulk modulus n K_f instead of K_f, with K_f = rho dx^2 / (3 dt^2):

{table(("E_oed / K_f", "p / q measured (± half the range: sound that is left)", "whole volume", "pores alone"), lines)}

The change from one to the other takes the time of diffusion into a grain, about 15 (tau - 1/2) k (R - 1/2)^2 steps (300 at R = 4 and tau = 1): what is faster than that sees the pores alone.
The formulas agree with the reference table to {check_skempton():.0e}. The compression here is to one side, so E_oed takes the place of the skeleton's bulk modulus.
"""


def skempton_figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        ratio = np.geomspace(0.7, 20, 100)
        for storage, what, style in ((1.0, "whole volume stores", "-"), (POROSITY, "pores alone", "--")):
            left.semilogx(ratio, [skempton(1 / x, storage) for x in ratio], style, color="0.4", lw=1, label=what)
        points = [(1 / r["modulus"], float(np.mean(r["base"]))) for r in of(results, loaded)]
        if points:
            left.plot(*zip(*points), "o", color=COLOURS[0], label="column of grains")
        left.set(xlabel="K_f / E_oed", ylabel="pressure / load, undrained")
        left.legend()
        for r, colour, marker in zip(of(results, filled), COLOURS, MARKERS):
            unit = (r["tau"] - 0.5) * (r["d"] / 2 - 0.5) ** 2
            t = np.geomspace(min(r["times"]), max(r["times"]), 80)
            exact = [r["porosity"] + (1 - r["porosity"]) * inside(r["d"], r["tau"], x) for x in t]
            against(right, (t / unit, exact), (np.array(r["times"]) / unit, r["stored"]), colour, marker, label=f"d = {r['d']}, tau = {r['tau']:g}, n = {r['porosity']:.2f}")
        right.set(xscale="log", xlabel="steps / ((tau - 1/2) (R - 1/2)^2)", ylabel="part of the volume that stores")
        right.legend()

    return [Figure("skempton", "Left: undrained pressure. Right: storage after a step of the pressure; lines: diffusion into the spheres.", draw, (9, 4))]


SKEMPTON = Case(
    name="skempton",
    title="What stores fluid: Skempton's coefficient",
    solved="""
A column of 16 touching free grains with elastic contacts (springs of stiffness k: E_oed = k / d) on a closed base is loaded at its top; the pressure at the base before drainage gets there. And a closed box with one fixed
sphere, periodic sideways, whose pressure is raised at the top: the mass that goes in, over that which the empty box would take.""",
    reference="`09_skempton_B.csv`: B = 1/(1 + n K/K_f), and what it would be with fluid stored in the grains too, 1/(1 + K/K_f). The second is what the derivation says (docs/physics.md).",
    runs=lambda quick: list(skempton_runs(quick)),
    rows=skempton_rows,
    text=skempton_text,
    figures=skempton_figures,
)


# Terzaghi

SETTLEMENT = [{key: float(value) for key, value in row.items()} for row in reference("09_terzaghi_settlement.csv")]
ISOCHRONES = reference("09_terzaghi_isochrones.csv")
ISOCHRONE_TIMES = (0.1, 0.2, 0.3, 0.5, 0.8, 1.0)
TIMES = sorted({row["Tv"] for row in SETTLEMENT if 0.05 <= row["Tv"] <= 1.5} | set(ISOCHRONE_TIMES))
COLUMNS = ((8, 0.1, 0, False), (16, 0.1, 0, False), (16, 0.1, 1, False), (16, 0.1, 0, True), (16, 0.03, 0, False))  # grains, E / K_f, place, films
ROUGHNESS = 0.001  # of the films, in radii: the default
SCALE = 0.2  # permeability [dx^2] from which the times of the samples are planned; what was measured is used for the comparison


def unit_of_time(count, modulus, permeability, tau=TAU):
    """H^2 / cv in fluid steps, with fluid stored in the whole volume."""
    return (count * D) ** 2 * (1 + 1 / modulus) / BULK * (tau - 0.5) / 3 / permeability


def terzaghi_runs(quick):
    columns = COLUMNS[:1] if quick else COLUMNS
    yield Run(stiffness, {"count": 16, "modulus": 0.1}, 0.01)
    for shift in PLACES[:1] if quick else PLACES:
        yield Run(seepage, {"count": 8, "shift": shift, "tau": TAU}, 0.15)
    for count, modulus, place, films in columns:
        unit = unit_of_time(count, modulus, SCALE)
        yield Run(loaded, {"count": count, "modulus": modulus, "tau": TAU, "shift": PLACES[place], "films": films, "times": [round(unit * t) for t in TIMES]}, 1.6e-9 * unit * D * D * (count + 1) * D)


def series(tv, depth, delay=0.0):
    """Excess pressure over the first one, and degree of consolidation: Terzaghi's solution, whose table is 09_terzaghi_*.csv.

    delay  time of a dashpot beside each spring of the skeleton, dashpot / stiffness, in the same unit as tv: mode m decays with m^2 / (1 + delay m^2)
    """
    m = math.pi / 2 * (2 * np.arange(400) + 1)
    slower = 1 + delay * m**2
    decay = np.exp(-(m**2) * tv / slower)
    return float((2 / m * np.sin(m * depth) * decay / slower).sum()), 1 - float((2 / m**2 * decay).sum())


def dashpot(modulus):
    """Time of the film in a contact at its roughness, over the stiffness of the contact [fluid steps]."""
    return 6 * math.pi * (TAU - 0.5) / 3 * D / 2 * (1 / (4 * ROUGHNESS) + 9 / 40 * math.log(1 / ROUGHNESS)) / (modulus * BULK * D)


def check_series():
    """Largest difference of `series` from the reference tables."""
    worst = max(abs(series(row["Tv"], 1.0)[i] - row[key]) for row in SETTLEMENT for i, key in ((0, "p_base_over_p0"), (1, "U")))
    for row in ISOCHRONES:
        worst = max([worst] + [abs(series(float(key[3:]), float(row["Z"]))[0] - float(value)) for key, value in row.items() if key != "Z" and float(row["Z"]) > 0])
    return worst


def compared(results, r):
    """Times Tv of a run's samples; settlement, base pressure and profiles over the load, beside the solution: [(Tv, U, U exact, p, p exact, profile, exact profile)]."""
    permeability = next((s["permeability"] for s in of(results, seepage) if s["shift"] == r["shift"]), None)
    if permeability is None:
        return []
    unit, first = unit_of_time(r["count"], r["modulus"], permeability), skempton(r["modulus"], 1.0)
    found = []
    for time, u, p, profile in zip(r.values["times"], r["settlement"], r["base"], r["profiles"]):
        tv, delay = time / unit, dashpot(r["modulus"]) / unit if r["films"] else 0.0
        exact = [first * series(tv, 1 - i / r["count"], delay)[0] for i in range(r["count"] + 1)]
        found.append((tv, u, 1 - first + first * series(tv, 1.0, delay)[1], p, exact[1], profile, exact))
    return found


def what(r):
    return f"{r['count']} grains, E / K_f = {r['modulus']:g}{', other place on the lattice' if any(r['shift']) else ''}{', films' if r['films'] else ''}"


def terzaghi_rows(results):
    found = []
    for r in of(results, stiffness):
        found.append(Row("oedometric modulus of the dry stack against k / d", "", "", r.values["modulus"] / r.arguments["modulus"] - 1))
    for r in [r for r in results if r.function == "loaded"]:
        samples = compared(results, r)
        if not samples:
            continue
        found.append(Row(f"settlement, largest error / final, {what(r)}", f"d = {D}", f"{TAU:g}", max((s[1] - s[2] for s in samples), key=abs), 0.02))
        for since, target in ((0.04, 0.02), (0.09, None)):
            worst = max((p - e for s in samples if s[0] > since for p, e in zip(s[5], s[6])), key=abs)
            found.append(Row(f"pressures, largest error / load{'' if target else ', from c_v t / H^2 = 0.1 on'}, {what(r)}", f"d = {D}", f"{TAU:g}", worst, target))
    return found


def terzaghi_text(results):
    lines = [(f"({r['shift'][0]:g}, {r['shift'][1]:g})", f"{r['permeability']:.4f}") for r in of(results, seepage)]
    return f"""
Permeability of the stack of free grains [dx^2], by the place of the stack on the lattice (the exact one of the array is 0.161; grains have eight cells, docs/physics.md, "Narrow pores"; the
consolidation is compared with what was measured):

{table(("place in the cell", "permeability"), lines)}

With films each contact has a dashpot beside its spring, the film at its roughness, c = 6 pi mu (R/2)^2 / h (and its logarithm): the skeleton gives way with a delay of c / k, {max((dashpot(0.1) / unit_of_time(16, 0.1, r["permeability"]) for r in of(results, seepage)), default=0):.3f} H^2 / c_v here, and the solution
that the run with films is compared with has decays of m^2 / (1 + c_v c / (k H^2) m^2); against Terzaghi's own it settles up to 4 % late. What is left of the pressures' error in the first samples is the sound of the loading.

The solution is that for a compressible fluid: p_0 / q = 1 / (1 + S E), c_v = (k / mu) / (1 / E + S), with S = 1 / K_f, storage in the whole volume (case `skempton`), not n / K_f. The load rises over two periods of the
column's sound; the time is counted from the middle of this. The series agrees with the tables of the reference folder to {check_series():.0e}.
"""


def terzaghi_figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        times = np.geomspace(0.02, 2, 100)
        chosen = of(results, loaded)
        for modulus, colour in zip(sorted({r["modulus"] for r in chosen}, reverse=True), COLOURS):
            first = skempton(modulus, 1.0)
            left.semilogx(times, [1 - first + first * series(t, 1.0)[1] for t in times], color=colour, lw=1)
            for r, marker in zip([r for r in chosen if r["modulus"] == modulus], MARKERS):
                tv, settlement, with_films = zip(*(s[:3] for s in compared(results, r)))
                left.plot(tv, settlement, marker, color=colour, mfc="none", label=what(r))
                if r["films"]:
                    left.plot(tv, with_films, "--", color=colour, lw=1)
        left.set(xlabel="c_v t / H^2", ylabel="settlement / final")
        left.invert_yaxis()
        left.legend(fontsize=7)
        r = next((r for r in chosen if r["count"] == 16), chosen[0])
        depth = np.linspace(0, 1, 100)
        samples = [min(compared(results, r), key=lambda s: abs(s[0] - t)) for t in ISOCHRONE_TIMES]
        for s, colour in zip(samples, COLOURS):
            first = skempton(r["modulus"], 1.0)
            exact, height = [first * series(s[0], z)[0] for z in depth], np.arange(r["count"] + 1) / r["count"]
            against(right, (exact, 1 - depth), (s[5], height), colour, "o", ms=3, label=f"c_v t / H^2 = {s[0]:.2f}")
        right.set(xlabel="pressure / load", ylabel="z / H")
        right.legend()

    return [Figure("consolidation", "Consolidation of a column of grains; lines: Terzaghi's solution for a compressible fluid, dashed with dashpots.", draw, (9, 4.4))]


CONSOLIDATION = Case(
    name="consolidation",
    title="Consolidation under a load",
    solved="""
The same column, drained at its top by a pressure face, closed at its base: a load on the top grain, in addition to one that it bears from the start; settlement of the surface and pressures in the pores. The permeability is that of
a seepage run through free grains, the modulus that of a dry stack; nothing is fitted. Grains move along the column only (they stand on each other like pearls on a string).""",
    reference="`09_terzaghi_settlement.csv`, `09_terzaghi_isochrones.csv`: Terzaghi's series, with the finite stiffness of the fluid as their heading says.",
    runs=lambda quick: list(terzaghi_runs(quick)),
    rows=terzaghi_rows,
    text=terzaghi_text,
    figures=terzaghi_figures,
)
