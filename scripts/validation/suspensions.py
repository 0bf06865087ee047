"""Suspensions of many free spheres, through YADE: hindered settling and viscosity."""

import math

from .case import Case, Figure, Row, Run
from .channels import of
from .engine import reference, yade
from .packing import packing
from .plotting import COLOURS

SETTLING = {float(row["c"]): row for row in reference("07_hindered_settling.csv")}
VISCOSITY = {float(row["phi"]): row for row in reference("08_suspension_viscosity.csv")}
REYNOLDS = 0.2  # of a sphere settling alone


def settling(phi, count, diameter, duration, seed):
    """Mean settling velocity over that of a sphere alone (see scenes/suspension.py)."""
    n = round(diameter / 2 * (4 * math.pi * count / (3 * phi)) ** (1 / 3))
    centres, a = packing(count, phi, seed)
    return yade("suspension.py", {"kind": "settling", "n": n, "radius": a * n, "centres": centres, "tau": 1.0, "reynolds": REYNOLDS,
                                  "duration": duration})


def shear(phi, count, diameter, duration, seed):
    """Relative viscosity between moving plates (see scenes/suspension.py)."""
    n = round(diameter / 2 * (4 * math.pi * count / (3 * phi)) ** (1 / 3))
    centres, a = packing(count, phi, seed, plates=True)
    return yade("suspension.py", {"kind": "shear", "n": n, "radius": a * n, "centres": centres, "tau": 1.0, "reynolds": 0.1,
                                  "duration": duration})


def runs(quick):
    for phi in (0.1, 0.3) if quick else (0.1, 0.2, 0.3, 0.4):
        count, d, duration = (30, 8, 8) if quick else (100, 8, 8) if phi < 0.25 else (200, 8, 12)
        cells = count * math.pi / 6 * d**3 / phi
        yield Run(settling, {"phi": phi, "count": count, "diameter": d, "duration": duration, "seed": 1}, 1.3 * cells * duration * 960 / 1e9)
    for phi in (0.1, 0.3) if quick else (0.1, 0.2, 0.3):
        d, gap, duration = (8, 6, 2) if quick else (8, 8, 5)
        arguments = {"phi": phi, "count": round(phi * gap**3 / (math.pi / 6)), "diameter": d, "duration": duration, "seed": 1}
        yield Run(shear, arguments, 1.5 * (gap * d) ** 3 * duration * 960 / 1e9)


def exponent(points, law):
    """Slope of log(U / U_t) against log(1 - phi), free prefactor."""
    pairs = [(math.log(1 - phi), math.log(law(phi, value))) for phi, value in points]
    x, y = sum(p[0] for p in pairs) / len(pairs), sum(p[1] for p in pairs) / len(pairs)
    return sum((p[0] - x) * (p[1] - y) for p in pairs) / sum((p[0] - x) ** 2 for p in pairs)


def eilers(phi):
    return float(VISCOSITY[phi]["Eilers_063"])


def settling_rows(results):
    points = [(r["phi"], r["ratio"]) for r in of(results, settling)]
    found = [Row(f"settling velocity against Richardson & Zaki (n = 4.65), phi = {phi:g}", "d = 8", "1",
                 value / float(SETTLING[phi]["RZ_n4.65"]) - 1) for phi, value in points]
    if len(points) > 2:
        n = exponent(points, lambda phi, value: value)
        found.insert(0, Row(f"exponent n = {n:.2f} of (1 - phi)^n: n - 4.65, absolute", "d = 8", "1", n - 4.65, 0.2))
    return found


def shear_rows(results):
    return [Row(f"relative viscosity against Eilers, phi = {r['phi']:g}", "d = 8", "1", r["eta"] / eilers(r["phi"]) - 1,
                0.1) for r in of(results, shear)]


def text(results):
    lines = [f"- phi = {r['phi']:g}: U / U_t = {r['ratio']:.4f} ± {r['error']:.4f} (standard error over blocks in time), cube of {r['n']} cells"
             for r in of(results, settling)]
    lines += [f"- phi = {r['phi']:g}, {r['count']} spheres: eta_r = {r['eta']:.3f} ± {r['error']:.3f} from the walls, {r['eta_stresslet'] + r['eta_contacts']:.3f} from stresslets and contacts, "
              f"contacts {r['eta_contacts']:.3f}, H / d = {r['n'] / 2 / r['radius_cells']:.1f}, "
              f"nearest centres at the end {r['nearest']:.3f} d" for r in of(results, shear)]
    return "\n".join(lines) + """

Sheared spheres touch each other across the periodic images and are held between the plates by layers of fixed spheres outside the fluid. The balance closes: the stress on the plates is the fluid's, the stresslets and the contacts. Contacts carry little,
so what the viscosity is above Eilers' correlation is in the stresslets; it grows with the strain. With films off 83 spheres at phi = 0.2 (six diameters between the plates, strain 2) have 1.86 instead of 1.95, of which contacts carry 0.11 instead of 0.01. A gap of eight diameters between smooth plates is part of it. Settling: a periodic box of 100 or 200 spheres settles slower than an endless suspension (U / U_t lower by about 0.06 and 0.025 at phi = 0.1 and 0.2 with 100 spheres, 1.76 (phi / N)^(1/3) S(0) / eta_r with the structure factor of hard spheres [Ladd 1990]); published exponents for small Reynolds numbers differ (4.65 of Richardson & Zaki, 5.1 of Garside & Al-Dibouni: 0.074 at phi = 0.4, where the first gives 0.093).
"""


def figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        phi = sorted(SETTLING)
        left.semilogy(phi, [(1 - p) ** 4.65 for p in phi], "k-", lw=1, label="(1 - phi)^4.65")
        left.semilogy(phi, [float(SETTLING[p]["SC_exact"]) for p in phi], "k:", lw=1, label="simple cubic array")
        for r in of(results, settling):
            left.errorbar(r["phi"], r["ratio"], r["error"], fmt="o", color=COLOURS[1])
        left.set(xlabel="solid fraction phi", ylabel="U / U_t", xlim=(0, 0.5), ylim=(0.02, 1))
        left.legend()
        phi = [p for p in sorted(VISCOSITY) if p <= 0.45]
        for name, style in (("Eilers_063", "k-"), ("KriegerDougherty_063", "k--"), ("Einstein", "k:")):
            right.plot(phi, [float(VISCOSITY[p][name]) for p in phi], style, lw=1, label=name.replace("_063", ""))
        right.plot([r["phi"] for r in of(results, shear)], [r["eta"] for r in of(results, shear)], "o", color=COLOURS[1], label="walls")
        right.plot([r["phi"] for r in of(results, shear)], [r["eta_stresslet"] for r in of(results, shear)], "s", mfc="none", color=COLOURS[0],
                   label="stresslets")
        right.set(xlabel="solid fraction phi", ylabel="relative viscosity", xlim=(0, 0.45), ylim=(0.9, 8))
        right.legend()

    return [Figure("suspensions", "Left: settling velocity. Right: viscosity between moving plates.", draw, (9, 4))]


SUSPENSIONS = Case(
    name="suspensions",
    title="Suspensions: hindered settling and viscosity",
    solved="""
`LbmEngine` with lubrication; YADE's frictionless contacts. Settling: free spheres (density ratio 2.5, Re of a single one 0.2) from a random hard-sphere arrangement in a periodic cube, the drive
taking up their net weight; the mean velocity relative to the mixture over the last two thirds of the time, over the unbounded velocity of one sphere. Viscosity: neutrally buoyant spheres between plates that move (gamma a^2 / nu = 0.1), stress on the plates
(contacts without friction have no part in it) over the last half of the strain, and independently from stresslets and contacts. The scene is periodic, with a cell that is higher than the fluid.""",
    reference="""
`07_hindered_settling.csv` (Richardson & Zaki 1954), `08_suspension_viscosity.csv` (Eilers, phi_m = 0.63). Both are correlations: simulations of periodic boxes settle 8 to 20 % slower than Richardson & Zaki's prefactor says
(Yin & Koch 2007), one box scatters by 5 %, and plates some diameters apart change the viscosity by 5 to 15 %. The exponent is compared with a free prefactor.""",
    runs=lambda quick: list(runs(quick)),
    rows=lambda results: settling_rows(results) + shear_rows(results),
    text=text,
    figures=figures,
)
