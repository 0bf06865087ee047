"""Suspensions of many free spheres: sedimentation of random arrangements, and, through YADE, hindered settling and viscosity."""

import math

from .case import Case, Figure, Row, Run, groups
from .channels import of
from .engine import lbm, reference, sphere, stokes, yade
from .packing import packing
from .plotting import COLOURS
from .report import percent, table

SETTLING = {float(row["c"]): row for row in reference("07_hindered_settling.csv")}
REYNOLDS = 0.2  # of a sphere settling alone
CONTACTS = {"roughness": 5e-3, "overlap": 1e-3}  # in radii: of the films; of a contact under the typical force
WIDE = 24  # diameters between plates that order a small part of the spheres only
AXES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def side(phi, count, diameter):
    """Cells along the cube that holds `count` spheres."""
    return round(diameter / 2 * (4 * math.pi * count / (3 * phi)) ** (1 / 3))


def sedimentation(phi, count, diameter, seed, lubrication):
    """Mean velocity of equal free spheres under equal forces, relative to the mixture, over that of one alone; of one arrangement at rest in place, mean over three directions."""
    n, (centres, a) = side(phi, count, diameter), packing(count, phi, seed)
    radius, gravity, tau = a * n, 1e-9, 2.0  # so slow that nothing moves
    viscosity = (tau - 0.5) / 3
    velocities, steps = [], 0
    for axes in AXES:
        spheres = [sphere([n * centre[d] for d in axes], radius, free=True, density=2.0) for centre in centres]
        case = stokes([n] * 3, spheres, tau, 0, lubrication=lubrication, gravity=[0, 0, -gravity], acceleration=[0, 0, phi * gravity])
        case["stop"]["max_steps"] = round(100 + 8 * (n / (2 * math.pi)) ** 2 / viscosity)  # eight times the decay time of the box
        result = lbm(case)
        mean = sum(s["velocity"][2] for s in result["solids"]) / count
        velocities.append((result["superficial_velocity"][2] - mean) / (2 / 9 * radius**2 * gravity))
        steps += result["steps"]
    return {"K": sum(velocities) / 3, "n": n, "cells": n**3, "steps": steps}


def settling(phi, count, diameter, duration, seed):
    """Mean settling velocity over that of a sphere alone (see scenes/suspension.py)."""
    n, (centres, a) = side(phi, count, diameter), packing(count, phi, seed)
    return yade("suspension.py", {"kind": "settling", "n": n, "radius": a * n, "centres": centres, "tau": 2.0, "reynolds": REYNOLDS,
                                  "duration": duration, **CONTACTS})


def shear(phi, count, diameter, gap, duration, seed):
    """Relative viscosity between plates that move, `gap` diameters apart (see scenes/suspension.py)."""
    height = gap * diameter
    n = round(diameter * math.sqrt(math.pi / 6 * count / (phi * gap)))  # cells along the base
    centres, a = packing(count, phi, seed, gap=height / n)
    return yade("suspension.py", {"kind": "shear", "n": n, "height": height, "radius": a * n, "centres": centres, "tau": shear_tau(gap), "reynolds": 0.1 if gap < WIDE else 0.03,
                                  "duration": duration, **CONTACTS})


def shear_tau(gap):
    """Plates WIDE apart: a liquid more viscous in lattice units and a lower Reynolds number, so that the flow has come after a smaller strain."""
    return 1.0 if gap < WIDE else 1.5


def runs(quick):
    for phi in (0.1, 0.3) if quick else (0.1, 0.2, 0.3, 0.4):
        for d, lubrication, seeds in [(8, True, 2 if quick else 6)] + ([(8, False, 2), (12, True, 2)] if phi > 0.25 and not quick else []):
            for seed in range(1, seeds + 1):
                arguments = {"phi": phi, "count": 30 if quick else 60, "diameter": d, "seed": seed, "lubrication": lubrication}
                yield Run(sedimentation, arguments, 1.3 * side(phi, arguments["count"], d) ** 5 / 1e9)
        count, duration = (30, 8) if quick else (100, {0.1: 20, 0.2: 30, 0.3: 40, 0.4: 50}[phi])
        for seed in range(1, 2 if quick else 4):
            yield Run(settling, {"phi": phi, "count": count, "diameter": 8, "duration": duration, "seed": seed}, 2 * side(phi, count, 8) ** 3 * duration * 320 / 1e9)
    for phi in (0.1, 0.3) if quick else (0.1, 0.2, 0.3):
        for gap, duration in ((6, 2),) if quick else ((8, 6), (12, 10), (WIDE, 16)):  # in wider gaps the flow takes longer to come
            if gap == WIDE and phi < 0.3:
                continue
            for seed in range(1, 2 if quick else 3):
                count = round(phi * (6**3 if quick else 8**3 if gap < WIDE else 25 * WIDE) / (math.pi / 6))
                arguments = {"phi": phi, "count": count, "diameter": 8, "gap": gap, "duration": duration, "seed": seed}
                yield Run(shear, arguments, 2 * math.pi / 6 * count / phi * 8**3 * duration * 960 / 1e9)


def structure_factor(phi):
    """S(0) of hard spheres in equilibrium (Carnahan & Starling 1969)."""
    return (1 - phi) ** 4 / ((1 + 2 * phi) ** 2 + phi**3 * (phi - 4))


def viscosity_at_rest(phi):
    """Relative viscosity of hard spheres in equilibrium that have not moved yet (fit of Ladd 1990)."""
    s = phi + phi**2 - 2.3 * phi**3
    return (1 + 1.5 * phi * (1 + s)) / (1 - phi * (1 + s))


def size_correction(phi, count):
    """What the velocity of an endless suspension has more than that of a periodic cube with `count` spheres (Ladd 1990)."""
    return 1.76 * (phi / count) ** (1 / 3) * structure_factor(phi) / viscosity_at_rest(phi)


def sedimentation_at_rest(phi):
    """Sedimentation coefficient of hard spheres in equilibrium (fit of Riest et al. 2015 to multipole computations)."""
    return 1 - 6.5464 * phi * (1 - 3.348 * phi + 7.426 * phi**2 - 10.034 * phi**3 + 5.882 * phi**4)


def exponent(points):
    """Slope of log(U / U_t) against log(1 - phi), free prefactor."""
    pairs = [(math.log(1 - phi), math.log(value)) for phi, value in points]
    x, y = sum(p[0] for p in pairs) / len(pairs), sum(p[1] for p in pairs) / len(pairs)
    return sum((p[0] - x) * (p[1] - y) for p in pairs) / sum((p[0] - x) ** 2 for p in pairs)


def eilers(phi):
    """As in the reference table, maximum fraction 0.63."""
    return (1 + 1.25 * phi / (1 - phi / 0.63)) ** 2


def zarraga(phi):
    """Measured by Zarraga, Hill & Leighton (2000); frictional spheres."""
    return math.exp(-2.34 * phi) / (1 - phi / 0.62) ** 3


def endless(result, key):
    """A velocity with what the periodic cube takes from it added."""
    return result[key] + size_correction(result["phi"], result["count"])


def mean(values):
    """Mean and standard error of independent values."""
    values = list(values)
    middle = sum(values) / len(values)
    return middle, math.sqrt(sum((v - middle) ** 2 for v in values) / max(1, len(values) - 1) / len(values))


def with_error(pair):
    """A mean for eyes; of a single value without an error."""
    return f"{pair[0]:.4f}" + (f" ± {pair[1]:.4f}" if pair[1] else "")


def at_rest(results, diameter=8, films=True):
    """Runs at rest: {(phi, seed): result}."""
    return {(r["phi"], r["seed"]): r for r in of(results, sedimentation) if (r["diameter"], r["lubrication"]) == (diameter, films)}


def resting(results):
    """{phi: values of single arrangements}, endless."""
    found = {}
    for (phi, _), r in at_rest(results).items():
        found.setdefault(phi, []).append(endless(r, "K"))
    return found


def moving(results):
    """{phi: results of single arrangements}."""
    return {phi: group for (phi,), group in groups(of(results, settling), "phi").items()}


def settling_rows(results):
    found = [Row(f"sedimentation coefficient at rest, endless, against hard spheres, phi = {phi:g}, {len(values)} arrangements", "d = 8", "2",
                 mean(values)[0] / sedimentation_at_rest(phi) - 1, 0.05) for phi, values in resting(results).items()]
    usual = at_rest(results)
    for name, others, d in (("12 cells per diameter against 8", at_rest(results, diameter=12), "d = 12"), ("films off against on", at_rest(results, films=False), "d = 8")):
        for phi in sorted({phi for phi, _ in others}):
            changes = [r["K"] / usual[key]["K"] - 1 for key, r in others.items() if key[0] == phi]
            found.append(Row(f"sedimentation coefficient at rest, {name}, phi = {phi:g}, the same {len(changes)} arrangements", d, "2", mean(changes)[0]))
    late = {phi: mean(endless(r, "ratio") for r in group)[0] for phi, group in moving(results).items()}
    found += [Row(f"settling velocity, endless, against Richardson & Zaki (n = 4.65), phi = {phi:g}", "d = 8", "2", value / float(SETTLING[phi]["RZ_n4.65"]) - 1) for phi, value in late.items()]
    if len(late) > 2:
        n = exponent(late.items())
        found += [Row(f"exponent n = {n:.2f} of (1 - phi)^n, endless: n - 4.65 (Richardson & Zaki), absolute", "d = 8", "2", n - 4.65, 0.2),
                  Row("the same, n - 5.1 (Garside & Al-Dibouni, Re = 0), absolute", "d = 8", "2", n - 5.1, 0.2)]
        boxed = exponent((phi, mean(r["ratio"] for r in group)[0]) for phi, group in moving(results).items())
        found.append(Row(f"exponent n = {boxed:.2f} as in the cube, without correction for its size: n - 4.65, absolute", "d = 8", "2", boxed - 4.65))
    return found


def sheared(results):
    """{(mean phi, gap): {name of a value: (mean over arrangements, standard error)}}; `error_core` and `error_plates` are against Eilers."""
    found = {}
    for (phi, gap), group in groups(of(results, shear), "phi", "gap").items():
        values = {name: mean(r[name] for r in group) for name in ("eta", "eta_core", "phi_core", "rate_core", "eta_stresslet", "eta_contacts", "nearest")}
        values["error_core"] = mean(r["eta_core"] / eilers(r["phi_core"]) - 1 for r in group)
        values["error_plates"] = mean(r["eta"] / eilers(phi) - 1 for r in group)
        found[phi, gap] = {**values, "count": group[0]["count"]}
    return found


def shear_rows(results):
    found, means = [], sheared(results)
    for (phi, gap), values in means.items():
        widest = gap == max(g for p, g in means if p == phi)
        tau = f"{shear_tau(gap):g}"
        found += [Row(f"viscosity of the middle half against Eilers at its solid fraction {values['phi_core'][0]:.3f}, mean phi = {phi:g}, gap of {gap} d", "d = 8", tau, values["error_core"][0], 0.1),
                  Row(f"viscosity from plate to plate against Eilers at the mean phi = {phi:g}, gap of {gap} d", "d = 8", tau, values["error_plates"][0], 0.1 if widest else None)]
    return found


def settling_table(results):
    still = resting(results)
    lines = []
    for phi, group in moving(results).items():
        both = [mean(r[key] for r in group) for key in ("early", "ratio")]
        values = [mean(still[phi]) if phi in still else (math.nan, 0)]
        lines.append((f"{phi:g}", *map(with_error, values), f"{sedimentation_at_rest(phi):.4f}", *map(with_error, both),
                      f"{size_correction(phi, group[0]['count']):.4f}", f"{mean(endless(r, 'ratio') for r in group)[0]:.4f}",
                      f"{float(SETTLING[phi]['RZ_n4.65']):.4f}", f"{float(SETTLING[phi]['GA_Re0']):.4f}"))
    return table(("phi", "K at rest, endless", "K, Riest et al.", "settling, early", "late", "size correction", "late, endless", "Richardson & Zaki", "Garside & Al-Dibouni"), lines)


def shear_table(results):
    lines = []
    for (mean_phi, gap), values in sheared(results).items():
        for where, phi, eta in (("plate to plate", mean_phi, values["eta"]), ("middle half", values["phi_core"][0], values["eta_core"])):
            green = [f"{1 + 2.5 * phi + c * phi**2:.3f}" if phi < 0.16 else "" for c in (5.2, 7.6)]
            lines.append((f"{gap} d", where, f"{phi:.3f}", with_error(eta), f"{eilers(phi):.3f}", f"{zarraga(phi):.3f}", *green, f"{viscosity_at_rest(phi):.3f}"))
    return table(("gap", "where", "phi", "eta_r", "Eilers (the target)", "Zarraga et al.", "Batchelor & Green, shear", "strain", "equilibrium at rest (Ladd)"), lines)


def balance(results):
    """One line per mean fraction and gap."""
    lines = []
    for (phi, gap), of_run in sheared(results).items():
        value = {name: of_run[name][0] for name in ("eta", "eta_stresslet", "eta_contacts", "rate_core", "nearest")}
        lines.append(f"- phi = {phi:g}, gap of {gap} d, {of_run['count']} spheres: {value['eta']:.3f} from the plates, {value['eta_stresslet'] + value['eta_contacts']:.3f} from stresslets and contacts, contacts {value['eta_contacts']:.3f}; "
                     f"shear rate in the middle half {value['rate_core']:.3f} of the mean one; nearest centres at the end {value['nearest']:.4f} d")
    return "\n".join(lines)


def text(results):
    dense = {gap: values for (phi, gap), values in sheared(results).items() if phi == 0.3}
    fractions = " and ".join(f"{values['phi_core'][0]:.3f} in one of {gap}" for gap, values in dense.items())
    plates = ", ".join(f"{percent(values['error_plates'][0])} in a gap of {gap} d" for gap, values in dense.items())
    residues = " and ".join(f"{percent(values['error_core'][0])}" for values in dense.values())
    scatter = f"{100 * max((values['error_core'][1] for values in dense.values()), default=math.nan):.1f}"
    return f"""
**Settling.** U / U_t, mean and standard error over arrangements; "endless" has the size correction 1.76 (phi / N)^(1/3) S(0) / eta_r added (S(0) of hard spheres in equilibrium; eta_r of such at rest) [Ladd 1990].

{settling_table(results)}

Arrangements in equilibrium settle as hard spheres in equilibrium should, at rest and on their way: within 20 to 50 radii of a lone sphere's fall the velocity changes by no more than between two arrangements. Films change it little, and at rest eight and twelve
cells per diameter agree. The velocities below Richardson & Zaki are no error of the flow. Their correlation is of spheres without Brownian
motion, whose arrangement a long fall has made; a fall of hundreds of radii in a larger box was not tried. Hard spheres in equilibrium have an exponent of {exponent((p, sedimentation_at_rest(p)) for p in (0.1, 0.2, 0.3, 0.4)):.2f} at these four fractions. The exponent found
is uncertain by 0.07 from the arrangements. A cube of 100 spheres, 12 % slower than an endless suspension at phi = 0.1 and 4 % at 0.4, has an exponent 0.2 smaller: that it then comes near
Richardson & Zaki's is chance, and the agreement reported here before was of this kind.

**Viscosity.**

{shear_table(results)}

{balance(results)}

Sheared spheres touch each other across the periodic images and are held between the plates by layers of fixed spheres outside the fluid. The balance closes: the stress on the plates is the fluid's, the stresslets and the contacts.
From plate to plate the suspension is more viscous than an endless one of its mean fraction: no centre comes nearer to a plate than a radius, so the middle of the gap is denser than the mean (0.336 in a gap of six diameters, {fractions}, where the mean is 0.3),
and viscosity rises steeply there. The plates feel {plates} more than Eilers at phi = 0.3; the target is for the widest gap, narrower ones would miss it. The middle half is compared with the correlation at its own fraction and shear rate; {residues} are left at phi = 0.3, where arrangements have a standard error of up to {scatter} %. Eilers' and Zarraga's correlations differ by 22 % at 0.3; the spheres of the second were rough and rubbed. Contacts that give in by more than the films' roughness
are held together by films for several strains and add to the viscosity: with overlaps of 0.01 a and a roughness of 0.001 a the plates felt 3.68 at phi = 0.3, and it still grew. Dependence on roughness and inertia, the viscosity before anything has moved, and two spheres
that pass each other: [physics.md](physics.md#films). Over parts of the strain the viscosity varies by 5 %.

The seconds below were taken beside other work.
"""


def figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        phi = sorted(p for p in SETTLING if p <= 0.45)
        left.semilogy(phi, [(1 - p) ** 4.65 for p in phi], "k-", lw=1, label="(1 - phi)^4.65")
        left.semilogy(phi, [(1 - p) ** 5.1 for p in phi], "k--", lw=1, label="(1 - phi)^5.1")
        left.semilogy(phi, [sedimentation_at_rest(p) for p in phi], "k-.", lw=1, label="hard spheres in equilibrium")
        left.semilogy(phi, [float(SETTLING[p]["SC_exact"]) for p in phi], "k:", lw=1, label="simple cubic array")
        for points, style, fill, colour, label in (
                ([(p, mean(v)) for p, v in resting(results).items()], "s", "none", COLOURS[0], "at rest, endless"),
                ([(p, mean(endless(r, "ratio") for r in g)) for p, g in moving(results).items()], "o", None, COLOURS[1], "settling, endless"),
                ([(p, mean(r["ratio"] for r in g)) for p, g in moving(results).items()], "x", None, COLOURS[1], "settling, in the cube")):
            left.errorbar([p for p, _ in points], [m for _, (m, _) in points], [e for _, (_, e) in points], fmt=style, mfc=fill or colour, color=colour, label=label)
        left.set(xlabel="solid fraction phi", ylabel="U / U_t", xlim=(0, 0.5), ylim=(0.02, 1))
        left.legend(fontsize=7)
        phi = [i / 100 for i in range(41)]
        for law, style, name in ((eilers, "k-", "Eilers"), (zarraga, "k--", "Zarraga et al."), (viscosity_at_rest, "k:", "equilibrium at rest")):
            right.plot(phi, [law(p) for p in phi], style, lw=1, label=name)
        means = sheared(results)
        for gap, colour in zip(sorted({gap for _, gap in means}), COLOURS):
            chosen = {phi: values for (phi, g), values in means.items() if g == gap}
            right.plot(list(chosen), [m["eta"][0] for m in chosen.values()], "x", color=colour, label=f"gap of {gap} d, plate to plate")
            right.plot([m["phi_core"][0] for m in chosen.values()], [m["eta_core"][0] for m in chosen.values()], "o", mfc="none", color=colour, label="middle half")
        right.set(xlabel="solid fraction phi", ylabel="relative viscosity", xlim=(0, 0.45), ylim=(0.9, 6))
        right.legend(fontsize=7)

    return [Figure("suspensions", "Left: settling velocity. Right: viscosity between moving plates.", draw, (9, 4))]


SUSPENSIONS = Case(
    name="suspensions",
    title="Suspensions: hindered settling and viscosity",
    solved="""
At rest: 60 free spheres under equal forces, steady Stokes flow of one arrangement held in place (`lbm run`), mean over three directions. Settling and viscosity: `LbmEngine` with films (roughness 0.005 a) and
YADE's frictionless contacts, which give in by 0.001 a under 6 pi mu a U_t or 6 pi mu a^2 gamma. Settling: 100 free spheres (density ratio 2.5, Re of a single one 0.2) in a periodic cube, the drive
taking up their net weight; the mean velocity relative to the mixture over the second half of the time, over the unbounded velocity of one sphere. Viscosity: neutrally buoyant spheres between plates 8, 12 or, at the highest fraction, 24 diameters apart that move (gamma a^2 / nu = 0.1, in the widest gap 0.03),
stress on the plates over the second half of a strain of 6, 10 or 16, and independently from stresslets and contacts; beside it the same stress over the shear rate of the middle half of the gap. All start from random hard-sphere arrangements in equilibrium.""",
    reference="""
Sedimentation at rest: hard spheres in equilibrium, the fit of Riest et al. (2015, Soft Matter 11, 2821; its first two coefficients are those of Batchelor 1972 and Cichocki et al. 2002; quoted from memory).
`07_hindered_settling.csv` (Richardson & Zaki 1954, Garside & Al-Dibouni 1977), `08_suspension_viscosity.csv` (Eilers, phi_m = 0.63: the target); Zarraga, Hill & Leighton (2000). These are correlations of measurements: they differ from each other by
up to 25 %.""",
    runs=lambda quick: list(runs(quick)),
    rows=lambda results: settling_rows(results) + shear_rows(results),
    text=text,
    figures=figures,
)
